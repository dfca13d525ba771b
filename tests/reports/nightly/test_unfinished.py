"""A run at work: one at a time, and one that was killed goes on where it was."""

from __future__ import annotations

import subprocess
import sys
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path

import numpy as np
import pytest

from cases.case import Case
from reports.nightly.task import Limits, Task
from reports.nightly.unfinished import Busy, Unfinished, locked
from reports.runner import CaseRun, Failure

NOW = datetime(2026, 1, 1, 2, tzinfo=UTC)


def task_of(case: Case) -> Task:
    return Task(case, None, False, Limits(None, 60.0), 1, "version")


def test_a_folder_is_for_one_run_at_a_time(tmp_path: Path) -> None:
    with locked(tmp_path / "output"), pytest.raises(Busy), locked(tmp_path / "output"):
        pass
    with locked(tmp_path / "output"):
        pass


@pytest.mark.slow
def test_a_killed_process_leaves_no_lock(tmp_path: Path) -> None:
    code = (
        "import sys, os; from pathlib import Path; from reports.nightly.unfinished import locked\n"
        "with locked(Path(sys.argv[1])): print('locked', flush=True); sys.stdin.read()"
    )
    command = [sys.executable, "-c", code, str(tmp_path)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "locked\n"
        with pytest.raises(Busy), locked(tmp_path):
            pass
        process.kill()
        process.wait()

    with locked(tmp_path):
        pass


def test_finished_cases_come_back_in_the_same_run(tmp_path: Path, case_run: CaseRun, tiny: Case) -> None:
    begun = Unfinished(tmp_path, NOW)
    asked = task_of(case_run.case)
    begun.keep(case_run, asked)
    begun.keep(Failure(tiny, "too slow"), task_of(tiny))

    again = Unfinished(tmp_path, NOW + timedelta(hours=1))
    found = again.find(asked)

    assert again.run == begun.run
    assert again.find(task_of(tiny)) == Failure(tiny, "too slow")
    assert isinstance(found, CaseRun)
    assert found.comparisons == case_run.comparisons
    np.testing.assert_array_equal(
        found.rod.quantities.rods[0].displacement, case_run.rod.quantities.rods[0].displacement
    )
    assert again.find(replace(asked, peers=True)) is None
    assert again.find(replace(asked, version="another")) is None


def test_what_failed_is_tried_again_under_other_limits_and_what_was_done_is_kept(
    tmp_path: Path, case_run: CaseRun, tiny: Case
) -> None:
    unfinished = Unfinished(tmp_path, NOW)
    unfinished.keep(case_run, task_of(case_run.case))
    unfinished.keep(Failure(tiny, "too slow"), task_of(tiny))
    more = Limits(None, 120.0)

    assert unfinished.find(replace(task_of(tiny), limits=more)) is None
    assert isinstance(unfinished.find(replace(task_of(case_run.case), limits=more)), CaseRun)


def test_another_case_of_the_same_name_is_not_finished(tmp_path: Path, tiny: Case) -> None:
    unfinished = Unfinished(tmp_path, NOW)
    unfinished.keep(Failure(tiny, "too slow"), task_of(tiny))

    assert unfinished.find(task_of(replace(tiny, compare=()))) is None


@pytest.mark.parametrize("later", [timedelta(hours=21), timedelta(hours=-1)])
def test_a_run_of_another_night_is_not_gone_on_with(tmp_path: Path, tiny: Case, later: timedelta) -> None:
    begun = Unfinished(tmp_path, NOW)
    begun.keep(Failure(tiny, "too slow"), task_of(tiny))

    again = Unfinished(tmp_path, NOW + later)

    assert again.run != begun.run
    assert again.find(task_of(tiny)) is None
    assert [path.name for path in tmp_path.iterdir()] == ["run.json"]


@pytest.mark.parametrize("content", ["", "{}", "[]", '{"run": 5}', '{"run": "../x"}', "\x00"])
def test_a_damaged_name_begins_a_new_run(tmp_path: Path, content: str) -> None:
    (tmp_path / "run.json").write_text(content)

    assert Unfinished(tmp_path, NOW).run.startswith("20260101T020000Z-")


def test_an_ended_run_is_forgotten(tmp_path: Path) -> None:
    Unfinished(tmp_path / "unfinished", NOW).end()

    assert list(tmp_path.iterdir()) == []
