"""The process of one case of a nightly run: reads its task from standard input, writes the answer to standard output.

It ends with the process that started it, which keeps standard input open for as long as it lives.
"""

from __future__ import annotations

import os
import pickle
import signal
import sys
from dataclasses import replace
from threading import Thread

from reports.cache import Cache
from reports.nightly.task import Task, on_this_machine, version
from reports.peers import ask_peers, stations_of
from reports.processes import failure_reason
from reports.runner import CaseRun, Failure, run_case


def main() -> None:
    """Answer one task."""
    # What solvers print goes where nobody reads it.
    answers = os.fdopen(os.dup(sys.stdout.fileno()), "wb")
    os.dup2(sys.stderr.fileno(), sys.stdout.fileno())
    task: Task = pickle.load(sys.stdin.buffer)  # noqa: S301 (from our own process, through a pipe)
    Thread(target=_end_with_starter, daemon=True).start()
    found = pickle.dumps(_answer(task))
    answers.write(found)
    answers.close()


def _end_with_starter() -> None:
    while os.read(sys.stdin.fileno(), 1 << 16):
        pass
    os.killpg(os.getpgrp(), signal.SIGKILL)


def _answer(task: Task) -> CaseRun | Failure:
    if version() != task.version:
        return Failure(
            task.case,
            "the worker has another version of rodcheck, Python or a package, or another number of threads, "
            "or the code was changed during the run",
        )
    cache = None if task.cache is None else Cache(task.cache)
    try:
        run = run_case(on_this_machine(task.case), lambda _: None, cache)
        if task.peers:
            run = replace(run, peers=ask_peers(task.case.scene, stations_of(run.rod.quantities), cache=cache))
    except Exception as error:  # noqa: BLE001 (whatever went wrong, it is this case's alone)
        return Failure(task.case, failure_reason(error))
    return run


if __name__ == "__main__":
    main()
