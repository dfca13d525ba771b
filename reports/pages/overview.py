"""The overview: all cases in a table that the browser filters and sorts."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any
from urllib.parse import quote

import numpy as np

from cases.case import Quantity
from reports.comparison import Comparison
from reports.formatting import count, number, seconds
from reports.nightly.drift import Drift
from reports.runner import CaseRun, Failure, Run

# From the worst on: what a case can be, and how it sorts.
STATES = ("not run", "fail", "not converged", "not resolved", "pass")
CASES = "cases"


@dataclass(frozen=True)
class Cell:
    """A cell of the table: what it shows, what stands below it, and the number that it is sorted by ('' for none)."""

    text: str
    note: str = ""
    key: str = ""


EMPTY = Cell("")


def case_file(name: str) -> PurePosixPath:
    """Where the page of a case is written, in the report's folder."""
    return PurePosixPath(CASES) / f"{name}.html"


def case_address(name: str) -> str:
    """The page of a case as the overview links to it."""
    return quote(str(case_file(name)))


def states(run: CaseRun | Failure) -> list[str]:
    """What is true of a case, of `STATES`, the worst first; it is a pass where nothing else is true."""
    if isinstance(run, Failure):
        return ["not run"]
    found: set[str] = {comparison.verdict for comparison in run.comparisons}
    if not all(answer.quantities.converged for answer in (run.rod, *run.references)):
        found.add("not converged")
    return [each for each in STATES if each in found - {"pass"}] or ["pass"]


def overview_row(run: CaseRun | Failure, drifts: Sequence[Drift] | None) -> dict[str, Any]:
    """What the template needs to know of a case.

    Parameters
    ----------
    drifts : all that moved, of any case; None where nobody looked
    """
    case, found = run.case, states(run)
    moved = sum(drift.case == case.name for drift in drifts or ())
    comparisons = () if isinstance(run, Failure) else run.comparisons
    return {
        "name": case.name,
        "title": case.title,
        "address": case_address(case.name),
        "searched": " ".join(f"{case.title} {case.name} {case.description}".lower().split()),
        "states": ",".join([*found, *(["moved"] if moved else [])]),
        "rank": STATES.index(found[0]),
        "failure": run.reason if isinstance(run, Failure) else "",
        "counts": Counter(comparison.verdict for comparison in comparisons),
        "moved": moved,
        "cells": [EMPTY] * 7 if isinstance(run, Failure) else _cells(run),
    }


def states_to_choose(runs: Sequence[CaseRun | Failure], drifts: Sequence[Drift] | None) -> list[tuple[str, str]]:
    """Values and texts of the filter by verdict: the states that some case is in."""
    here = Counter(each for run in runs for each in states(run))
    found = [(each, f"{each} ({here[each]})") for each in STATES if here[each]]
    moved = len({drift.case for drift in drifts or ()} & {run.case.name for run in runs})
    return [("", "any"), *found, *([("moved", f"moved ({moved})")] if moved else [])]


def _cells(run: CaseRun) -> list[Cell]:
    rod, finest = run.rod, run.references[-1] if run.references else None
    force = ", ".join(number(contact.force, 5) for contact in rod.quantities.contacts)
    deflection = max(float(np.linalg.norm(found.displacement, axis=0).max()) for found in rod.quantities.rods)
    return [
        _nearest_to_failing(run.comparisons),
        _held(run, "contact_force", force),
        _held(run, "deflection", number(deflection, 5)),
        _unknowns(rod),
        EMPTY if finest is None else _unknowns(finest),
        _time(rod),
        EMPTY if finest is None else _time(finest),
    ]


def _nearest_to_failing(comparisons: Sequence[Comparison]) -> Cell:
    """The largest difference over tolerance of all comparisons: above 1 it fails, infinite where a difference is."""
    shares = [found.difference / found.tolerance for found in comparisons if found.difference is not None]
    return Cell(f"{max(shares):.2g}", key=_key(max(shares))) if shares else EMPTY


def _held(run: CaseRun, quantity: Quantity, value: str) -> Cell:
    """A value of the rod model; below it the largest difference from 3D, and the uncertainty of that one."""
    held = [
        found
        for found in run.comparisons
        if (found.kind, found.quantity) == ("reference", quantity) and found.difference is not None
    ]
    if not held:
        return Cell(value)
    worst = max(held, key=lambda found: found.difference or 0.0)
    difference = worst.difference or 0.0
    sure = "" if worst.uncertainty is None else f" ± {100.0 * worst.uncertainty:.1g} %"
    return Cell(value, f"{100.0 * difference:.2g} %{sure}", _key(difference))


def _key(value: float) -> str:
    """A number as the browser's script reads it."""
    return f"{value:.6g}" if math.isfinite(value) else "Infinity"


def _unknowns(answer: Run) -> Cell:
    unknowns = answer.quantities.unknowns
    return Cell(count(unknowns), key=str(unknowns))


def _time(answer: Run) -> Cell:
    return Cell(seconds(answer.total_seconds), key=f"{answer.total_seconds:.6g}")
