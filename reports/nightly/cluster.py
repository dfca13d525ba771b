"""Cases through Dask: on this machine, or by a scheduler that is already there.

The local cluster is of threads, as each case has a process of its own (`reports.nightly.work`): its scheduler and
worker talk within this process and listen nowhere; Dask's status page, which cannot be left out, listens on loopback.
"""

from __future__ import annotations

import logging
import os
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import CancelledError
from contextlib import contextmanager
from dataclasses import replace

from distributed import Client, KilledWorker, LocalCluster, as_completed

from reports.nightly.task import Task
from reports.nightly.work import ProcessLost, run_on_worker
from reports.processes import failure_reason
from reports.runner import CaseRun, Failure

LOOPBACK = "127.0.0.1:0"
# How often a case is tried again whose process was killed by somebody else. Of workers that die, Dask counts three.
RETRIES = 2
# Seconds to wait for a scheduler, and for the first of its workers: a batch system may be slow to start them.
CONNECTING = 15
FIRST_WORKER = 300


class ClusterError(Exception):
    """No cluster, or no longer; the message is one sentence."""


def cores() -> int:
    """Processors that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def run_tasks(
    tasks: Sequence[Task], scheduler: str | None, expected: Mapping[str, float]
) -> Iterator[CaseRun | Failure]:
    """What came of each task, as they are done.

    Parameters
    ----------
    scheduler : address of an existing one; None for a cluster on this machine
    expected : seconds that a case may take, by name: the longest are begun first

    Raises
    ------
    ClusterError
        if the scheduler cannot be reached, has no workers or goes away.
    """
    # Dask gives the second a level of its own; the third is told of what Dask does not wait for at its end.
    for logger in ("distributed", "distributed.client", "asyncio"):
        logging.getLogger(logger).setLevel(logging.CRITICAL)  # what matters is told by us, once
    with _client(scheduler) as client:
        at_once = _at_once(client)
        cases = {}
        for task in sorted(tasks, key=lambda task: -expected.get(task.case.name, float("inf"))):
            future = client.submit(
                run_on_worker,
                replace(task, at_once=at_once),
                key=f"{task.case.name}-{os.urandom(8).hex()}",
                pure=False,
                retries=RETRIES,
            )
            cases[future.key] = task.case, future
        for future in as_completed([future for _, future in cases.values()]):
            case, _ = cases.pop(future.key)
            if future.status in ("cancelled", "lost"):
                raise ClusterError("the scheduler went away; what was finished is kept, so start again to go on")
            error = future.exception()
            if error is None:
                yield replace(future.result(), case=case)  # the worker's own has paths of the worker's machine
            else:
                yield Failure(case, _reason(error))
            future.release()


def _reason(error: BaseException) -> str:
    if isinstance(error, KilledWorker):
        return "the workers that tried it died, one after the other"
    if isinstance(error, ProcessLost):
        return f"{error}; tried {RETRIES + 1} times"
    if isinstance(error, ModuleNotFoundError):
        return f"the workers lack a package that this process has: {error}"
    return failure_reason(error)


@contextmanager
def _client(scheduler: str | None) -> Iterator[Client]:
    if scheduler is None:
        cluster = LocalCluster(
            processes=False,
            n_workers=1,
            threads_per_worker=cores(),
            memory_limit=0,  # each case has its own limit
            dashboard_address=LOOPBACK,
            worker_dashboard_address=LOOPBACK,
        )
        with cluster, Client(cluster) as client:
            yield client
        return
    try:
        client = Client(scheduler, timeout=CONNECTING)
    except (OSError, RuntimeError, TypeError, ValueError) as error:
        told = " ".join(str(error).split())
        raise ClusterError(
            f"--scheduler: found {scheduler}, where no Dask scheduler can be reached ({told})"
        ) from error
    try:
        with client:
            try:
                client.wait_for_workers(1, timeout=FIRST_WORKER)
            except TimeoutError as error:
                raise ClusterError(
                    f"--scheduler: found {scheduler}, which has had no workers for {FIRST_WORKER} s; start some"
                ) from error
            yield client
    except CancelledError as error:
        raise ClusterError("the scheduler went away; what was finished is kept, so start again to go on") from error


def _at_once(client: Client) -> int:
    """Cases that may run on one machine at the same time."""
    threads: Counter[str] = Counter()
    for worker in client.scheduler_info(n_workers=-1)["workers"].values():
        threads[worker["host"]] += worker["nthreads"]
    return max(threads.values(), default=1)
