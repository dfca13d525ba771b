"""What a run says of a case as rows of the history: one quantity of one case by one solver."""

from __future__ import annotations

import os
import platform
import subprocess
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from datetime import datetime
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from cases.case import QUANTITIES
from reports.code_version import DISTRIBUTIONS, TOP
from reports.comparison import Comparison
from reports.peers import UNITS, SideBySide, peer_value
from reports.runner import CaseRun, Failure, Run

ROD, REFERENCE = "rod model", "3D"
SOLVERS = {"rod": ROD, "reference": REFERENCE}
# The quantity and the verdict of a case that could not be run to its end.
RUN, FAILED = "run", "failed"
# What numbers are held against that carry no verdict.
BESIDE = "beside"


@dataclass(frozen=True)
class Night:
    """What all rows of a run have in common.

    Attributes
    ----------
    run : its name, which sorts by time
    time : when the rows were made, UTC
    versions : of this project, Python and the packages below the solvers
    commit : of the checkout, with a + where files differ from it; '' outside one
    machine : where it was started, with its processor; seconds are compared on one machine alone
    """

    run: str
    time: datetime
    versions: str
    commit: str
    machine: str


@dataclass(frozen=True, kw_only=True)
class Row:
    """One quantity of one case by one solver.

    Attributes
    ----------
    of : the pair or rod, with the arc length of a clamp (mm)
    point : (x, y, s) of a stress, mm, and of a published deflection with its axis, as text; else ''
    solver : rod model, 3D, or the name of a solver that is not of this project
    against, source : kind and words of the reference, as in `Comparison`; 'beside' for numbers that carry no verdict
    relative : whether difference, uncertainty and tolerance are fractions of the reference's largest magnitude; else
        they are in `unit`
    value, reference : as in `Comparison`
    verdict : pass, fail, not resolved; '' where there is none; failed for a case that was not run to its end
    seconds, unknowns, memory : of the solver's run (3D: on its finest mesh); s, MB
    kept_since : the day of these seconds and this memory, YYYY-MM-DD, where they come from the cache; else ''
    """

    run: str
    time: datetime
    case: str
    quantity: str
    of: str = ""
    point: str = ""
    solver: str = ""
    against: str = ""
    source: str = ""
    unit: str = ""
    relative: bool = False
    value: tuple[float, ...] = ()
    reference: tuple[float, ...] = ()
    difference: float | None = None
    uncertainty: float | None = None
    tolerance: float | None = None
    verdict: str = ""
    reason: str = ""
    seconds: float | None = None
    unknowns: int | None = None
    memory: float | None = None
    kept_since: str = ""
    versions: str
    commit: str
    machine: str

    @property
    def subject(self) -> tuple[str, ...]:
        """What the row is about, the same in every run."""
        return self.case, self.solver, self.quantity, self.of, self.point, self.against, self.source


@dataclass(frozen=True)
class Spent:
    """What a solver's run cost."""

    seconds: float
    unknowns: int
    memory: float
    kept_since: str


def this_night(run: str, time: datetime) -> Night:
    """What is common to the rows of a run on this machine."""
    versions = [f"python {platform.python_version()}"]
    for name in ("rodcheck", *DISTRIBUTIONS):
        try:
            versions.append(f"{name} {version(name)}")
        except PackageNotFoundError:
            versions.append(f"{name} absent")
    return Night(run, time, ", ".join(versions), _commit(), _machine())


def _machine() -> str:
    processor = platform.processor() or platform.machine()
    information = Path("/proc/cpuinfo")
    if information.exists():
        for line in information.read_text(encoding="utf-8", errors="replace").splitlines():
            if line.startswith("model name"):
                processor = line.partition(":")[2].strip()
                break
    return f"{platform.node()}, {processor}, {os.cpu_count()} cores"


def _commit() -> str:
    if not (TOP / ".git").exists():
        return ""
    try:
        command = ["git", "-C", str(TOP), "describe", "--always", "--abbrev=12", "--dirty=+", "--exclude=*"]
        found = subprocess.run(command, capture_output=True, text=True, check=False, stdin=subprocess.DEVNULL)
    except OSError:
        return ""
    return found.stdout.strip()


def rows_of(run: CaseRun | Failure, night: Night) -> list[Row]:
    """All rows of a case; one, with the reason, where it could not be run to its end."""
    row = partial(Row, **asdict(night), case=run.case.name)
    if isinstance(run, Failure):
        return [row(quantity=RUN, verdict=FAILED, reason=run.reason)]
    spent = {ROD: _spent(run.rod)}
    if run.references:
        spent[REFERENCE] = _spent(run.references[-1])
    rows = [_compared(row, found, spent) for found in run.comparisons]
    for found in run.side_by_side:
        rows.append(_beside(row, found, ROD, found.rod, spent[ROD]))
        if REFERENCE in spent:
            rows.append(_beside(row, found, REFERENCE, found.reference, spent[REFERENCE]))
        for peer in run.peers:
            if peer.answer is not None:
                value = peer_value(found, peer.answer, run.rod.quantities)
                cost = Spent(peer.answer.seconds, peer.answer.unknowns, peer.answer.peak_memory, peer.kept_since)
                rows.append(_beside(row, found, peer.peer, value, cost))
    return rows


def _spent(run: Run) -> Spent:
    return Spent(run.total_seconds, run.quantities.unknowns, run.peak_memory, run.kept_since)


def _compared(row: Callable[..., Row], found: Comparison, spent: Mapping[str, Spent]) -> Row:
    kind, solver = QUANTITIES[found.quantity], SOLVERS[found.model]
    return row(
        quantity=found.quantity,
        of=found.of,
        point=found.place,
        solver=solver,
        against=found.kind,
        source=found.source,
        unit=kind.unit,
        relative=kind.relative,
        value=found.value,
        reference=found.reference,
        difference=found.difference,
        uncertainty=found.uncertainty,
        tolerance=found.tolerance,
        verdict=found.verdict,
        reason=found.reason,
        **asdict(spent[solver]),
    )


def _beside(row: Callable[..., Row], found: SideBySide, solver: str, value: float | None, spent: Spent) -> Row:
    reference = None if solver == REFERENCE else found.reference
    return row(
        quantity=found.quantity,
        of=found.of if found.station is None else f"{found.of} at {found.station:g}",
        solver=solver,
        against=BESIDE,
        unit=UNITS[found.quantity],
        value=() if value is None else (value,),
        reference=() if reference is None else (reference,),
        difference=None if value is None or reference is None else abs(value - reference),
        uncertainty=found.uncertainty,
        **asdict(spent),
    )
