"""A nightly run in a few lines of plain text, for a mail or a chat."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence

from reports.comparison import Verdict
from reports.formatting import measure, title
from reports.nightly.drift import Drift
from reports.nightly.rows import Night
from reports.runner import CaseRun, Failure

VERDICTS: tuple[Verdict, ...] = ("pass", "fail", "not resolved")
# So many lines of one kind are printed; a broken solver has hundreds.
MOST_LINES = 20


def not_passed(runs: Sequence[CaseRun | Failure]) -> list[str]:
    """Cases that did not run to their end, solvers that did not converge and verdicts that are no pass, a line each."""
    lines = []
    for run in runs:
        name = run.case.name
        if isinstance(run, Failure):
            lines.append(f"{name}: not run: {run.reason}")
            continue
        for answer in (run.rod, *run.references):
            if not answer.quantities.converged:
                solver = "rod model" if answer.model == "rod" else "3D"
                lines.append(f"{name}: {solver} did not converge: {answer.quantities.outcome}")
        for found in run.comparisons:
            if found.verdict != "pass":
                apart = f"difference {measure(found.quantity, found.difference)}"
                sure = f"uncertainty {measure(found.quantity, found.uncertainty)}"
                limit = f"tolerance {measure(found.quantity, found.tolerance)}"
                lines.append(f"{name}: {title(found)}: {found.verdict}: {apart}, {sure}, {limit}")
    return lines


def headline(runs: Sequence[CaseRun | Failure], missed: Sequence[str], drifts: Sequence[Drift]) -> str:
    """The whole run in one line."""
    done = [run for run in runs if isinstance(run, CaseRun)]
    counts = Counter(found.verdict for run in done for found in run.comparisons)
    verdicts = ", ".join(f"{counts[verdict]} {verdict}" for verdict in VERDICTS if counts[verdict])
    missing = f", {len(runs) - len(done)} not run" if len(done) < len(runs) else ""
    moved = f"{len(drifts)} moved" if drifts else "nothing moved"
    pages = f"; {len(missed)} missed on the pages beside the report" if missed else ""
    return f"{_counted(len(runs), 'case')}{missing}; {verdicts or 'no verdicts'}{pages}; {moved}"


def drift_lines(drifts: Sequence[Drift]) -> list[str]:
    """A line for everything that moved."""
    return [f"{drift.case}: {drift.of}: {drift.text}" for drift in drifts]


def summary(
    runs: Sequence[CaseRun | Failure],
    drifts: Sequence[Drift],
    night: Night,
    *,
    missed: Sequence[str],
    earlier: int,
    notes: Sequence[str],
    seconds: float,
) -> str:
    """The summary, lines that end with a line feed.

    Parameters
    ----------
    missed : what does not hold on the pages beside the report, a line each
    earlier : number of runs in the history before this one
    seconds : wall-clock time since this process began the run, or went on with it
    """
    commit = f", commit {night.commit}" if night.commit else ""
    against = f"drift against {_counted(earlier, 'earlier run')}" if earlier else "no earlier run to tell drift by"
    lines = [
        f"rodcheck nightly: {headline(runs, missed, drifts)}",
        f"run {night.run}{commit}, {night.machine}, {seconds / 60.0:.1f} min; {against}",
    ]
    not_held = [*not_passed(runs), *missed]
    for heading, found in (("Not passed", not_held), ("Moved", drift_lines(drifts)), ("Notes", list(notes))):
        if found:
            lines += ["", f"{heading}:", *(f"- {line}" for line in found[:MOST_LINES])]
            if len(found) > MOST_LINES:
                lines.append(f"- and {len(found) - MOST_LINES} more")
    return "\n".join(lines) + "\n"


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'' if number == 1 else 's'}"
