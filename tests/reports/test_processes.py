"""Work in a process of its own: its result, its progress, and how its failures are told."""

from __future__ import annotations

import importlib
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType

import pytest

from cases.loader import load_case
from reports.processes import ProcessFailed, in_own_process
from reports.runner import Failure, run_cases

WORK = """
import os
from multiprocessing.connection import Connection

def double(number, progress):
    progress("halfway")
    return 2 * number, os.getpid()

def fail(number, progress):
    raise ValueError("no such\\nthing")

def die(number, progress):
    os._exit(3)

def killed(number, progress):
    os.kill(os.getpid(), 9)

def killed_in_the_middle_of_a_message(number, progress):
    whole = Connection._send

    def half(connection, message):
        whole(connection, message[: len(message) // 2])
        killed(number, progress)

    Connection._send = half
    progress("halfway")
"""


@pytest.fixture
def work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """A module that the new process can import."""
    (tmp_path / "work_of_the_test.py").write_text(WORK)
    monkeypatch.syspath_prepend(str(tmp_path))
    yield importlib.import_module("work_of_the_test")
    del sys.modules["work_of_the_test"]


def test_the_result_comes_back_from_another_process_with_its_progress(work: ModuleType) -> None:
    import os

    told = []

    found, process = in_own_process(work.double, 21, told.append)

    assert found == 42
    assert process != os.getpid()
    assert told == ["halfway"]


@pytest.mark.slow
def test_an_exception_is_told_in_one_line_with_its_place(work: ModuleType) -> None:
    with pytest.raises(ProcessFailed, match=r"^ValueError: no such thing \(work_of_the_test.py, line \d+\)$"):
        in_own_process(work.fail, 0)


@pytest.mark.slow
def test_a_process_that_ends_is_a_failure_and_not_a_wait(work: ModuleType) -> None:
    with pytest.raises(ProcessFailed, match="exit code 3"):
        in_own_process(work.die, 0)


@pytest.mark.slow
@pytest.mark.parametrize("when", ["killed", "killed_in_the_middle_of_a_message"])
def test_a_killed_process_says_so(work: ModuleType, when: str) -> None:
    with pytest.raises(ProcessFailed, match="killed"):
        in_own_process(getattr(work, when), 0)


@pytest.mark.slow
def test_a_case_that_fails_does_not_stop_the_next() -> None:
    case = load_case("two-cantilevers-e50-g0")
    unsupported = replace(case, scene=replace(case.scene, supports=(), contacts=()))

    runs = list(run_cases([unsupported, replace(unsupported, name="second")], lambda _case, _what: None))

    assert [run.case.name for run in runs] == [case.name, "second"]
    assert all(isinstance(run, Failure) and "supports" in run.reason for run in runs)
