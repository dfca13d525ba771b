"""A nightly run from its cases to report, history and summary.

Everything is written in an order in which a kill between any two writes loses nothing: a case's answer as soon as it
is there, then the history, summary and report, and only then is the run forgotten. Started again, the run goes on.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path

from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

from cases.case import Case
from cases.loader import library_names
from reports.nightly.cluster import run_tasks
from reports.nightly.drift import LAST_RUNS, Drift, drifts
from reports.nightly.history import has_run, read_history, write_run
from reports.nightly.pages import Pages, write_pages
from reports.nightly.rows import Row, rows_of, this_night
from reports.nightly.summary import summary
from reports.nightly.task import Limits, Task, version
from reports.nightly.unfinished import Unfinished
from reports.runner import CaseRun, Failure, passed
from reports.site import write_report
from reports.store import remove_left_behind, write_whole

HISTORY = "history"
# Drift looks back so many runs: more than it needs for a noise, as some took their seconds from the cache.
LOOKED_BACK = 4 * LAST_RUNS


@dataclass(frozen=True)
class Outcome:
    """What came of a nightly run.

    Attributes
    ----------
    as_expected : every verdict is a pass, every case ran to its end, every page's claim holds, and nothing moved
    summary : lines of plain text
    """

    runs: tuple[CaseRun | Failure, ...]
    drifts: tuple[Drift, ...]
    as_expected: bool
    summary: str


def nightly(
    cases: Sequence[Case],
    output: Path,
    *,
    cache: Path | None,
    peers: bool,
    limits: Limits,
    scheduler: str | None = None,
) -> Outcome:
    """Run cases and write `index.html`, `results`, `history` and `summary.txt` into a folder that is locked.

    With the whole library come the pages of verification and stability.

    Raises
    ------
    ClusterError
        if there is no cluster to run them on.
    OSError
        if something cannot be written; the finished cases are kept.
    """
    begin = time.perf_counter()
    remove_left_behind(output)
    unfinished = Unfinished(output / "unfinished", datetime.now(UTC))
    tasks = [Task(case, cache, peers, limits, 1, version()) for case in cases]
    if has_run(output / HISTORY, unfinished.run) and not all(unfinished.find(task) for task in tasks):
        # It was killed after its history was written, and now other cases are asked, or another code: another run.
        unfinished.end()
        unfinished = Unfinished(output / "unfinished", datetime.now(UTC))
    history = read_history(output / HISTORY)
    earlier = history.latest([case.name for case in cases], LOOKED_BACK, besides=unfinished.run)
    runs = _run_all(tasks, unfinished, scheduler, _expected(earlier))

    night = this_night(unfinished.run, datetime.now(UTC))
    rows = [row for run in runs for row in rows_of(run, night)]
    moved = drifts(rows, earlier)
    if not has_run(output / HISTORY, night.run):
        write_run(output / HISTORY, rows)
    whole_library = {case.name for case in cases} >= set(library_names())
    pages = write_pages(output, cache) if whole_library else Pages()
    notes = [*history.notes, *unfinished.notes, *pages.notes]
    notes += [note for run in runs if isinstance(run, CaseRun) for note in run.notes]
    text = summary(
        runs,
        moved,
        night,
        missed=pages.missed,
        earlier=len({row.run for row in earlier}),
        notes=list(dict.fromkeys(notes)),
        seconds=time.perf_counter() - begin,
    )
    write_whole(output / "summary.txt", text)
    write_report(runs, output, pages.files, moved, [*earlier, *rows])
    unfinished.end()
    as_expected = not moved and not pages.missed and all(passed(run) for run in runs)
    return Outcome(tuple(runs), tuple(moved), as_expected, text)


def _expected(earlier: Sequence[Row]) -> dict[str, float]:
    """Seconds that each case's solvers took together when they were last measured."""
    last: dict[tuple[str, str], float] = {}
    for row in earlier:
        if row.seconds is not None:
            last[row.case, row.solver] = row.seconds
    together: dict[str, float] = {}
    for (case, _), seconds in last.items():
        together[case] = together.get(case, 0.0) + seconds
    return together


def _run_all(
    tasks: Sequence[Task], unfinished: Unfinished, scheduler: str | None, expected: Mapping[str, float]
) -> list[CaseRun | Failure]:
    """What came of every case, in their order; cases that the unfinished run has are not run again."""
    finished = {task.case.name: unfinished.find(task) for task in tasks}
    waiting = [task for task in tasks if finished[task.case.name] is None]
    usual = sum(expected.values()) / len(expected) if expected else 1.0
    console = Console(stderr=True)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        TextColumn("{task.fields[done]} of {task.fields[of]}"),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        total = sum(expected.get(task.case.name, usual) for task in waiting)
        done = len(tasks) - len(waiting)
        bar = bars.add_task("cases", total=total, done=done, of=len(tasks))
        for run in run_tasks(waiting, scheduler, expected) if waiting else ():
            task = next(task for task in waiting if task.case.name == run.case.name)
            unfinished.keep(run, task)
            finished[run.case.name] = run
            done += 1
            bars.update(bar, advance=expected.get(run.case.name, usual), done=done, description=run.case.name)
    return [run for run in finished.values() if run is not None]
