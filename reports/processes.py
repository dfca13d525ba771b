"""Work in a process of its own, so that a crash, a kill or a leak stays there."""

from __future__ import annotations

import multiprocessing
import signal
import traceback
from collections.abc import Callable
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TypeVar

from cases.scene import SceneError
from reports.quantities import SolutionError

Progress = Callable[[str], None]

Given = TypeVar("Given")
Found = TypeVar("Found")


class ProcessFailed(Exception):
    """The work ended without a result; the message says why, in one sentence."""


def in_own_process(
    work: Callable[[Given, Progress], Found], given: Given, progress: Progress = lambda _: None
) -> Found:
    """The result of `work(given, progress)`, done in a new process.

    Parameters
    ----------
    work : a function of a module, so that the new process can import it

    Raises
    ------
    ProcessFailed
        if the work raises or its process ends before it is done.
    """
    context = multiprocessing.get_context("spawn")
    receiver, sender = context.Pipe(duplex=False)
    process = context.Process(target=_worker, args=(work, given, sender), daemon=True)
    process.start()
    sender.close()
    try:
        while True:
            try:
                kind, content = receiver.recv()
            except (EOFError, OSError):  # the latter where it ended in the middle of a message
                process.join()
                killed = " (killed, perhaps for lack of memory)" if process.exitcode == -signal.SIGKILL else ""
                raise ProcessFailed(f"its process ended early with exit code {process.exitcode}{killed}") from None
            if kind == "done":
                found: Found = content
                return found
            if kind == "failed":
                raise ProcessFailed(content)
            progress(content)
    finally:
        receiver.close()
        if process.is_alive():
            process.terminate()
        process.join()


def _worker(work: Callable[[Given, Progress], Found], given: Given, sender: Connection) -> None:
    # Ctrl-C is the parent's to answer.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    try:
        sender.send(("done", work(given, lambda what: sender.send(("progress", what)))))
    except Exception as error:  # noqa: BLE001 (whatever went wrong, the parent is to know and to go on)
        sender.send(("failed", failure_reason(error)))


def failure_reason(error: BaseException) -> str:
    """An exception in one line: what it says and, for one nobody meant to raise, where it came from."""
    text = " ".join(str(error).split())
    if isinstance(error, SceneError | SolutionError):
        return text
    where = traceback.extract_tb(error.__traceback__)[-1]
    return f"{type(error).__name__}: {text} ({Path(where.filename).name}, line {where.lineno})"
