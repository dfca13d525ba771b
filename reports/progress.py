"""Progress on standard error, shown where that is a terminal."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import AbstractContextManager, contextmanager
from typing import TypeVar

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.status import Status

from cases.case import Case
from reports.cache import Cache
from reports.peers import PEERS
from reports.runner import STEPS, CaseRun, Failure, run_cases

Step = TypeVar("Step")


def status(text: str) -> AbstractContextManager[Status]:
    """A spinner with a text while something of unknown length goes on."""
    return Console(stderr=True).status(text)


def run_with_progress(
    cases: Sequence[Case], cache: Cache | None = None, peers: bool = False
) -> list[CaseRun | Failure]:
    """Run cases one after the other behind a progress bar."""
    steps = STEPS + (len(PEERS) if peers else 0)
    with _bars() as bars:
        task = bars.add_task("", total=steps * len(cases))

        def begun(case: Case, what: str) -> None:
            bars.update(task, description=f"{case.name}: {what}")
            bars.advance(task)

        runs = []
        for index, run in enumerate(run_cases(cases, begun, cache, peers), start=1):
            bars.update(task, completed=steps * index)
            runs.append(run)
    return runs


def progress(steps: Iterable[Step], count: int, text: str) -> Iterator[Step]:
    """Steps one after the other behind a progress bar.

    count : how many there are
    """
    with _bars() as bars:
        yield from bars.track(steps, total=count, description=text)


@contextmanager
def announced(title: str, count: int) -> Iterator[Callable[[str], None]]:
    """A progress bar, and what is to be told of each step when it begins.

    count : how many steps there are
    """
    with _bars() as bars:
        task = bars.add_task("", total=count)

        def begun(what: str) -> None:
            bars.update(task, description=f"{title}: {what}")
            bars.advance(task)

        yield begun


def _bars() -> Progress:
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    return Progress(*columns, console=console, transient=True, disable=not console.is_terminal)
