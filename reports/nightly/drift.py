"""Drift: what a run says against what the runs before it said.

A verdict is held against that of the last run. A value is held against the one at which it stood when it last moved,
so that a slow creep is noticed and a jump is told once. Seconds and memory are held against the median of the last
runs on the same machine, in units of their median absolute deviation (MAD).
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from reports.comparison import CURVES
from reports.formatting import NOTHING
from reports.nightly.rows import BESIDE, FAILED, RUN, Row

# So many runs on one machine are needed to know the noise of a time, and so many of the last ones tell it.
FEWEST_RUNS = 5
LAST_RUNS = 15
# MAD of a normal distribution times this is its standard deviation.
NORMAL_MAD = 1.4826
# A time or memory within so many standard deviations is noise: of hundreds each night, none should be named by chance.
DEVIATIONS = 6.0
# So is what moved by less than this fraction, or by less than this in its unit: the MAD of few runs is small by chance.
COST_FLOORS = {"seconds": (0.25, 0.01), "memory": (0.1, 20.0)}
COST_UNITS = {"seconds": "s", "memory": "MB"}
# How far a value may move where nobody knows how sure it is: a fraction of its tolerance, or of itself.
SHARE_OF_TOLERANCE = 0.1
SHARE_OF_VALUE = 1e-3
# Another processor or library moves values by this fraction, however sure they are.
ROUND_OFF = 1e-6


@dataclass(frozen=True)
class Drift:
    """Something that moved.

    Attributes
    ----------
    of : what it is, in words
    text : from what to what, in words
    """

    case: str
    kind: Literal["verdict", "value", "seconds", "memory"]
    of: str
    text: str


def drifts(tonight: Sequence[Row], earlier: Sequence[Row]) -> list[Drift]:
    """All that moved.

    Parameters
    ----------
    earlier : rows of earlier runs, oldest first, of the same cases
    """
    before: dict[tuple[str, ...], list[Row]] = defaultdict(list)
    for row in earlier:
        before[row.subject].append(row)
    found = [*_verdicts(tonight, before), *_gone(tonight, earlier), *_values(tonight, before)]
    return [*found, *_costs(tonight, earlier)]


def named(row: Row) -> str:
    """What a row is about, in words."""
    words = [row.solver, row.quantity.replace("_", " "), row.of, row.point]
    return " ".join(word for word in words if word)


def compared(row: Row) -> str:
    """The same with what it is held against."""
    kinds = {"reference": "3D of its run", "3d converged": "independent 3D"}
    return f"{named(row)} against {kinds.get(row.against, row.source or row.against)}"


def _verdicts(tonight: Iterable[Row], before: dict[tuple[str, ...], list[Row]]) -> list[Drift]:
    found = []
    for row in tonight:
        last = before[row.subject][-1:]
        if row.quantity != RUN and last and last[0].verdict != row.verdict:
            found.append(Drift(row.case, "verdict", compared(row), f"from {last[0].verdict} to {row.verdict}"))
    return found


def _gone(tonight: Sequence[Row], earlier: Sequence[Row]) -> list[Drift]:
    """Verdicts of each case's last complete run that nobody gives any more."""
    failed = {row.case for row in tonight if row.quantity == RUN}
    last = {row.case: row.run for row in earlier if row.quantity != RUN}
    here = {row.subject for row in tonight}
    return [
        Drift(row.case, "verdict", compared(row), f"from {row.verdict} to no longer compared")
        for row in earlier
        if row.verdict
        and row.case not in failed
        and row.run == last.get(row.case)
        and row.quantity != RUN
        and row.subject not in here
    ]


def _values(tonight: Iterable[Row], before: dict[tuple[str, ...], list[Row]]) -> list[Drift]:
    """Values that moved; each once, although it may be held against several references."""
    found: dict[tuple[str, str], Drift] = {}
    for row in tonight:
        if row.verdict == FAILED or not before[row.subject]:
            continue
        anchor, *rest = before[row.subject]
        for later in rest:
            if _moved(anchor, later):
                anchor = later
        if _moved(anchor, row):
            what = "difference " if by_difference(row) else ""
            limit = _words(row, [allowed(anchor, row)], 2)
            text = f"{what}from {_words(anchor, measured(anchor))} to {_words(row, measured(row))}, more than {limit}"
            found.setdefault((row.case, named(row)), Drift(row.case, "value", named(row), text))
    return list(found.values())


def by_difference(row: Row) -> bool:
    """Whether the difference is what may move, not the value.

    Of a curve, a row has the two values where they are farthest apart: the place moves for no reason, their distance
    does not.
    """
    return row.quantity in CURVES and row.against != BESIDE


def measured(row: Row) -> tuple[float, ...]:
    """The numbers of a row that may move."""
    if by_difference(row):
        return () if row.difference is None else (row.difference,)
    return row.value


def allowed(*rows: Row) -> float:
    """How far the numbers of rows may be apart: the largest uncertainty of any."""
    return max(max(_uncertainty(row), ROUND_OFF * max(map(abs, measured(row)), default=0.0)) for row in rows)


def _uncertainty(row: Row) -> float:
    scale = max(map(abs, row.reference), default=0.0) if row.relative and not by_difference(row) else 1.0
    if row.uncertainty:
        return row.uncertainty * scale
    if row.tolerance and scale:
        return SHARE_OF_TOLERANCE * row.tolerance * scale
    return SHARE_OF_VALUE * max(map(abs, measured(row)), default=0.0)


def _moved(first: Row, second: Row) -> bool:
    one, other = np.array(measured(first)), np.array(measured(second))
    if one.shape != other.shape:
        return True
    return not np.allclose(one, other, rtol=0.0, atol=allowed(first, second), equal_nan=True)


def _words(row: Row, numbers: Sequence[float], digits: int = 6) -> str:
    """Numbers that may move, or by which, with their unit."""
    if by_difference(row) and row.relative:
        return ", ".join(f"{100.0 * value:.{digits}g}" for value in numbers) + " %" if numbers else NOTHING
    return ", ".join(f"{value:.{digits}g}" for value in numbers) + f" {row.unit}" if numbers else NOTHING


def _costs(tonight: Iterable[Row], earlier: Iterable[Row]) -> list[Drift]:
    """Seconds and memory beyond noise; what comes from the cache was not measured in its run."""
    runs: dict[tuple[str, str, str], dict[str, Row]] = defaultdict(dict)
    for row in earlier:
        if row.seconds is not None and not row.kept_since:
            runs[row.case, row.solver, row.machine].setdefault(row.run, row)
    here = {(row.case, row.solver): row for row in tonight if row.seconds is not None and not row.kept_since}
    found = []
    for (case, solver), row in here.items():
        last = list(runs[case, solver, row.machine].values())[-LAST_RUNS:]
        if len(last) < FEWEST_RUNS:
            continue
        for kind in ("seconds", "memory"):
            value, known = float(getattr(row, kind)), [float(getattr(one, kind)) for one in last]
            median, noise = usual(known)
            share, least = COST_FLOORS[kind]
            limit = max(DEVIATIONS * noise, share * median, least)
            if not math.isclose(value, median, rel_tol=0.0, abs_tol=limit):
                unit = COST_UNITS[kind]
                text = f"from {median:.3g} to {value:.3g} {unit}, beyond a noise of {limit:.2g}"
                found.append(Drift(case, kind, f"{solver} {kind}", f"{text} {unit} in {len(last)} runs"))
    return found


def usual(values: Sequence[float]) -> tuple[float, float]:
    """The median, and the standard deviation as the MAD tells it: neither heeds a few values that are far off."""
    median = float(np.median(values))
    return median, NORMAL_MAD * float(np.median(np.abs(np.array(values) - median)))
