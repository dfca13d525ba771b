"""A case in a process of its own: held to its limits, ended with whoever asked for it, its loss told apart."""

from __future__ import annotations

import pickle
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import psutil
import pytest

from cases.case import Case
from cases.loader import TRUTH
from reports.nightly import work
from reports.nightly.case_process import _answer
from reports.nightly.cluster import run_tasks
from reports.nightly.task import Limits, Task, version
from reports.nightly.work import ProcessLost, run_in_process
from reports.runner import Failure

Processes = Callable[[str], None]

# Starts a process of its own, which tells its id, and waits as the code that stands before it says.
WITH_CHILD = """
import subprocess, sys, time
child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
open("child", "w").write(str(child.pid))
time.sleep(600)
"""
ANSWER = """
import pickle, sys
from reports.runner import Failure
task = pickle.load(sys.stdin.buffer)
sys.stdout.buffer.write(pickle.dumps(Failure(task.case, "as it was told")))
"""


@pytest.fixture
def case_process(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Processes:
    """Sets the code that cases are run by; it runs in the test's folder."""

    def set_code(code: str) -> None:
        (tmp_path / "process_of_the_test.py").write_text(code)

    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(work, "CASE_PROCESS", "process_of_the_test")
    return set_code


@pytest.fixture
def task(tiny: Case) -> Task:
    """A task with wide limits."""
    return Task(tiny, None, False, Limits(None, 60.0), 1, "")


def ends(pid: int) -> bool:
    """Whether a process is gone, or will be: a signal takes its time."""
    for _ in range(100):
        try:
            if psutil.Process(pid).status() == psutil.STATUS_ZOMBIE:
                return True
        except psutil.NoSuchProcess:
            return True
        time.sleep(0.1)
    return False


def test_the_answer_comes_back(case_process: Processes, task: Task) -> None:
    case_process(ANSWER)

    found = run_in_process(task)

    assert isinstance(found, Failure)
    assert (found.case.name, found.reason) == ("tiny", "as it was told")


def test_a_case_that_never_ends_is_stopped_with_all_that_it_started(
    case_process: Processes, task: Task, tmp_path: Path
) -> None:
    case_process(WITH_CHILD)

    found = run_in_process(replace(task, limits=Limits(None, 1.0)))

    assert isinstance(found, Failure)
    assert found.reason == "stopped: not done within its limit of 1 s (--time-limit)"
    child = int((tmp_path / "child").read_text())
    assert ends(child)


@pytest.mark.slow
def test_a_case_that_allocates_without_end_is_stopped(case_process: Processes, task: Task) -> None:
    case_process("held = []\nwhile True: held.append(bytes(2_000_000).replace(b'\\0', b'1'))")

    found = run_in_process(replace(task, limits=Limits(2e8, 60.0)))

    assert isinstance(found, Failure)
    assert found.reason == "stopped: more memory than its limit of 0.2 GB (--memory-limit)"


def test_a_case_whose_answer_nobody_wants_any_more_is_ended(case_process: Processes, task: Task) -> None:
    case_process(WITH_CHILD)
    begin = time.monotonic()

    run_in_process(task, wanted=lambda: time.monotonic() - begin < 0.5)

    assert time.monotonic() - begin < 30.0


@pytest.mark.slow
def test_a_case_ends_with_the_process_that_asked_for_it(task: Task) -> None:
    command = [sys.executable, "-m", "reports.nightly.case_process"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True) as process:
        process.communicate(pickle.dumps(task))  # which closes its standard input, as a death of this process would

    assert process.returncode == -signal.SIGKILL


def test_independent_values_are_those_of_the_worker_s_own_folder(task: Task, monkeypatch: pytest.MonkeyPatch) -> None:
    """The path that a task brings is of the machine that asks."""
    read = []

    def run_case(case: Case, *_: object) -> Failure:
        assert case.independent is not None
        read.append(case.independent.read_text(encoding="utf-8"))
        return Failure(case, "read")

    monkeypatch.setattr("reports.nightly.case_process.run_case", run_case)
    elsewhere = replace(task.case, independent=Path("/elsewhere/cases/truth/e50_g0.json"))
    _answer(replace(task, case=elsewhere, version=version()))

    assert read == [(TRUTH / "e50_g0.json").read_text(encoding="utf-8")]


def test_a_killed_process_is_told_apart_from_one_that_fails(case_process: Processes, task: Task) -> None:
    case_process("import os; os.kill(os.getpid(), 9)")
    with pytest.raises(ProcessLost, match=r"killed \(SIGKILL\)"):
        run_in_process(task)

    case_process("raise SystemExit(3)")
    found = run_in_process(task)
    assert isinstance(found, Failure)
    assert found.reason == "its process ended early with exit code 3"


@pytest.mark.slow
def test_a_killed_case_is_tried_again(case_process: Processes, task: Task, tmp_path: Path) -> None:
    once = "import os\nif not os.path.exists('tried'):\n    open('tried', 'w'); os.kill(os.getpid(), 9)\n"
    case_process(once + ANSWER)

    (found,) = run_tasks([task], None, {})

    assert isinstance(found, Failure)
    assert found.reason == "as it was told"


@pytest.mark.slow
def test_a_case_that_is_killed_every_time_is_reported_and_stops_nothing(case_process: Processes, task: Task) -> None:
    case_process(
        ANSWER.replace("from", "import os\nfrom").replace("\nsys", "\nif task.peers: os.kill(os.getpid(), 9)\nsys")
    )
    killed = replace(task, peers=True, case=replace(task.case, name="killed"))

    reasons = {run.case.name: run.reason for run in run_tasks([killed, task], None, {}) if isinstance(run, Failure)}

    assert reasons["tiny"] == "as it was told"
    assert reasons["killed"].endswith("tried 3 times")


@pytest.mark.slow
def test_a_local_cluster_listens_on_loopback_alone(case_process: Processes, task: Task) -> None:
    case_process(ANSWER)
    addresses = set()
    for _ in run_tasks([task], None, {}):
        listening = [one for one in psutil.Process().net_connections() if one.status == psutil.CONN_LISTEN]
        addresses = {one.laddr.ip for one in listening}

    assert addresses == {"127.0.0.1"}
