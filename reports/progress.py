"""Progress on standard error, shown where that is a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from contextlib import AbstractContextManager

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

from cases.case import Case
from reports.cache import Cache
from reports.peers import PEERS
from reports.runner import STEPS, CaseRun, Failure, run_cases


def status(text: str) -> AbstractContextManager[object]:
    """A spinner with a text while something of unknown length goes on."""
    return Console(stderr=True).status(text)


def run_with_progress(
    cases: Sequence[Case], cache: Cache | None = None, peers: bool = False
) -> list[CaseRun | Failure]:
    """Run cases one after the other behind a progress bar."""
    console = Console(stderr=True)
    steps = STEPS + (len(PEERS) if peers else 0)
    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeElapsedColumn(),
    )
    with Progress(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task("", total=steps * len(cases))

        def begun(case: Case, what: str) -> None:
            bars.update(task, description=f"{case.name}: {what}")
            bars.advance(task)

        runs = []
        for index, run in enumerate(run_cases(cases, begun, cache, peers), start=1):
            bars.update(task, completed=steps * index)
            runs.append(run)
    return runs
