"""One case of a nightly run on a Dask worker: in a process of its own, held to its limits of memory and time.

The process ends with whoever asked for it: when the worker dies, when Dask no longer wants the case, and when it is
over a limit. Nothing here needs more of a worker than threads.
"""

from __future__ import annotations

import os
import pickle
import selectors
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from contextlib import suppress

import psutil
from distributed import get_worker
from distributed.system import MEMORY_LIMIT

from reports.code_version import THREADS
from reports.nightly.task import Task
from reports.runner import CaseRun, Failure

# Seconds between looks at memory and time.
INTERVAL = 0.2
# What a case is run by, a module.
CASE_PROCESS = "reports.nightly.case_process"
# Of a machine's memory, what its cases may have together.
SHARE = 0.9


class ProcessLost(Exception):
    """A case's process was killed by somebody else; trying again may help."""


def run_on_worker(task: Task) -> CaseRun | Failure:
    """What a Dask worker does; the process ends when Dask no longer wants its answer.

    Raises
    ------
    ProcessLost
        if somebody killed the process.
    """
    worker = get_worker()
    key = worker.get_current_task()

    def wanted() -> bool:
        state = worker.state.tasks.get(key)
        return state is not None and state.state in ("executing", "long-running")

    return run_in_process(task, wanted)


def run_in_process(task: Task, wanted: Callable[[], bool] = lambda: True) -> CaseRun | Failure:
    """Run a case in a process of its own.

    Parameters
    ----------
    wanted : asked again and again; the process is ended as soon as it says no

    Raises
    ------
    ProcessLost
        if somebody killed the process.
    """
    environment = {**dict.fromkeys(THREADS, "1"), **os.environ}
    process = subprocess.Popen(
        [sys.executable, "-m", CASE_PROCESS],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        start_new_session=True,  # with all its own processes it can be ended at once, and Ctrl-C is not for it
        env=environment,
    )
    try:
        answer, stopped = _answer(process, task, wanted)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        for stream in (process.stdin, process.stdout):
            with suppress(BrokenPipeError):
                stream.close() if stream is not None else None
    if stopped:
        return Failure(task.case, stopped)
    try:
        found: CaseRun | Failure = pickle.loads(answer)  # noqa: S301 (from our own process, through a pipe)
    except (EOFError, pickle.UnpicklingError):
        if process.returncode < 0:
            killed = f"its process was killed ({signal.Signals(-process.returncode).name})"
            raise ProcessLost(f"{killed}, perhaps for lack of memory") from None
        return Failure(task.case, f"its process ended early with exit code {process.returncode}")
    return found


def _answer(process: subprocess.Popen[bytes], task: Task, wanted: Callable[[], bool]) -> tuple[bytes, str]:
    """All that the process says until it ends, and why it was stopped, if it was."""
    assert process.stdin is not None
    assert process.stdout is not None
    limit = task.limits.memory if task.limits.memory is not None else SHARE * MEMORY_LIMIT / task.at_once
    begin = time.monotonic()
    with suppress(BrokenPipeError):
        # stdin stays open: its end tells the process that this one has died
        process.stdin.write(pickle.dumps(task))
        process.stdin.flush()
    parts: list[bytes] = []
    with selectors.DefaultSelector() as waiting:
        waiting.register(process.stdout, selectors.EVENT_READ)
        while True:
            if waiting.select(INTERVAL):
                part = os.read(process.stdout.fileno(), 1 << 20)
                if not part:
                    # Not reaped yet: until its group is ended, no other process may get its number.
                    os.waitid(os.P_PID, process.pid, os.WEXITED | os.WNOWAIT)
                    return b"".join(parts), ""
                parts.append(part)
            if not wanted():
                return b"", "no longer wanted"
            if time.monotonic() - begin > task.limits.seconds:
                return b"", f"stopped: not done within its limit of {task.limits.seconds:g} s (--time-limit)"
            used = _memory(process.pid)
            if used > limit:
                return b"", f"stopped: more memory than its limit of {limit / 1e9:.3g} GB (--memory-limit)"


def _memory(pid: int) -> float:
    """Resident memory of a process and of all that it started, bytes."""
    total = 0.0
    with suppress(psutil.NoSuchProcess):
        process = psutil.Process(pid)
        for each in (process, *process.children(recursive=True)):
            with suppress(psutil.NoSuchProcess):
                total += each.memory_info().rss
    return total
