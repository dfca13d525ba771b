"""A nightly run as a whole: what it writes, how it says what came of it, and that a killed one goes on."""

from __future__ import annotations

import errno
import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import pytest

from cases.case import Case
from reports import command_line
from reports.nightly import run as nightly_run
from reports.nightly.history import read_history
from reports.nightly.task import Task
from reports.nightly.unfinished import locked
from reports.processes import ProcessFailed
from reports.runner import CaseRun, Failure
from reports.store import write_whole
from reports.verification import registry as checks
from reports.verification.check import Outcome, Reference

CASE = "two-cantilevers-e20-g0"
Answered = Callable[..., None]


def passing(run: CaseRun) -> CaseRun:
    return replace(run, comparisons=tuple(replace(found, verdict="pass") for found in run.comparisons))


@pytest.fixture
def answered(monkeypatch: pytest.MonkeyPatch) -> Answered:
    """Sets what comes of the tasks, instead of solving; and leaves the page out."""

    def set_answer(answer: Callable[[Case], CaseRun | Failure]) -> None:
        def run_tasks(tasks: Sequence[Task], *_: object) -> Iterator[CaseRun | Failure]:
            return (answer(task.case) for task in tasks)

        monkeypatch.setattr(nightly_run, "run_tasks", run_tasks)

    monkeypatch.setattr(nightly_run, "write_report", lambda _runs, output, *_: output / "index.html")
    return set_answer


def test_a_night_as_expected_is_exit_code_0_and_a_short_summary(
    tmp_path: Path, case_run: CaseRun, answered: Answered, capsys: pytest.CaptureFixture[str]
) -> None:
    answered(lambda case: replace(passing(case_run), case=case))

    code = command_line.run(["nightly", CASE, "--no-peers", "--no-cache", "--output", str(tmp_path)])

    shown = capsys.readouterr()
    assert (code, shown.err) == (0, "")
    verdicts = len(case_run.comparisons)
    assert shown.out.startswith(f"rodcheck nightly: 1 case; {verdicts} pass; nothing moved\n")
    assert (tmp_path / "summary.txt").read_text() == shown.out.partition("\n\nReport:")[0] + "\n"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["history", "lock", "summary.txt"]


def test_what_moved_and_what_failed_is_said_and_is_exit_code_1(
    tmp_path: Path, case_run: CaseRun, answered: Answered, capsys: pytest.CaptureFixture[str]
) -> None:
    command = ["nightly", CASE, "crossed-cantilevers", "--no-peers", "--no-cache", "--output", str(tmp_path)]
    good = passing(case_run)
    answered(lambda case: replace(good, case=case))
    command_line.run(command)
    changed = (replace(good.comparisons[0], verdict="fail", difference=0.5), *good.comparisons[1:])
    answered(
        lambda case: replace(good, case=case, comparisons=changed) if case.name == CASE else Failure(case, "it broke")
    )
    capsys.readouterr()

    code = command_line.run(command)

    lines = capsys.readouterr().out.splitlines()
    assert code == 1
    assert ", 1 not run; 1 fail" in lines[0].replace(f"{len(changed) - 1} pass, ", "")
    assert "- crossed-cantilevers: not run: it broke" in lines
    assert any(line.startswith(f"- {CASE}: ") and "from pass to fail" in line for line in lines)


def test_a_full_disk_is_one_sentence_and_what_was_computed_is_kept(
    tmp_path: Path,
    case_run: CaseRun,
    answered: Answered,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    command = ["nightly", CASE, "--no-peers", "--no-cache", "--output", str(tmp_path)]
    asked = []

    def answer(case: Case) -> CaseRun:
        asked.append(case.name)
        return replace(passing(case_run), case=case)

    def full(_folder: Path, _rows: object) -> None:
        raise OSError(errno.ENOSPC, "No space left on device", str(tmp_path / "history"))

    answered(answer)
    with monkeypatch.context() as patched:
        patched.setattr(nightly_run, "write_run", full)
        code = command_line.run(command)

    shown = capsys.readouterr()
    assert (code, shown.out) == (2, "")
    assert shown.err.count("\n") == 1
    assert "No space left on device" in shown.err
    assert command_line.run(command) == 0
    assert asked == [CASE]  # once, not again
    assert len(list((tmp_path / "history").iterdir())) == 1


def test_a_run_that_ends_after_its_history_is_written_writes_it_once(
    tmp_path: Path, case_run: CaseRun, answered: Answered, monkeypatch: pytest.MonkeyPatch
) -> None:
    command = ["nightly", CASE, "--no-peers", "--no-cache", "--output", str(tmp_path)]
    answered(lambda case: replace(passing(case_run), case=case))

    def killed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(nightly_run, "write_report", killed)
        assert command_line.run(command) == 130
    (first,) = (tmp_path / "history").iterdir()

    assert command_line.run(command) == 0

    assert list((tmp_path / "history").iterdir()) == [first]


def test_other_cases_after_a_run_whose_history_is_written_are_another_run(
    tmp_path: Path, case_run: CaseRun, answered: Answered, monkeypatch: pytest.MonkeyPatch
) -> None:
    answered(lambda case: replace(passing(case_run), case=case))
    options = ["--no-peers", "--no-cache", "--output", str(tmp_path)]

    def killed(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    with monkeypatch.context() as patched:
        patched.setattr(nightly_run, "write_report", killed)
        command_line.run(["nightly", CASE, *options])

    assert command_line.run(["nightly", "crossed-cantilevers", *options]) == 0

    assert read_history(tmp_path / "history").cases() == ["crossed-cantilevers", CASE]


def test_an_answer_that_cannot_be_kept_ends_the_run_at_once(
    tmp_path: Path,
    case_run: CaseRun,
    answered: Answered,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    """Computing on would end without a history, and with nothing kept."""
    command = ["nightly", CASE, "crossed-cantilevers", "--no-peers", "--no-cache", "--output", str(tmp_path)]
    asked = []

    def answer(case: Case) -> CaseRun:
        asked.append(case.name)
        return replace(passing(case_run), case=case)

    def full(path: Path, _text: str) -> None:
        if asked[1:]:
            raise OSError(errno.ENOSPC, "No space left on device", str(path))
        write_whole(path, _text)

    answered(answer)
    with monkeypatch.context() as patched:
        patched.setattr("reports.cache.write_whole", full)
        code = command_line.run(command)

    assert code == 2
    assert "No space left on device" in capsys.readouterr().err
    assert command_line.run(command) == 0
    assert asked == [CASE, "crossed-cantilevers", "crossed-cantilevers"]


def test_the_whole_library_has_its_pages_and_what_they_miss_is_said(
    tmp_path: Path,
    case_run: CaseRun,
    answered: Answered,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    answered(lambda case: replace(passing(case_run), case=case))
    monkeypatch.setattr(nightly_run, "library_names", lambda: (CASE,))
    check = next(iter(checks.CHECKS.values()))
    missed = Outcome(replace(check, levels=(1,), at_level=1), Reference(2.0), (3.0,))
    monkeypatch.setattr(checks, "verify", lambda _cache: {check.name: missed})
    monkeypatch.setattr("reports.verification.page.write_verification", lambda *_, **__: tmp_path / "verification.html")

    def failing(_cache: object) -> None:
        raise ProcessFailed("it broke")

    monkeypatch.setattr("reports.stability.registry.carry_out", failing)
    code = command_line.run(["nightly", CASE, "--no-peers", "--no-cache", "--output", str(tmp_path)])

    lines = capsys.readouterr().out.splitlines()
    assert code == 1
    assert lines[0].endswith("; 2 missed on the pages beside the report; nothing moved")
    assert any(line.startswith(f"- verification: {check.name}: fail: error 50 %") for line in lines)
    assert "- stability: not run: it broke" in lines


@pytest.mark.parametrize(
    "arguments",
    [
        ["nightly", "no-such-case"],
        ["nightly", CASE, "--memory-limit", "4"],
        ["nightly", CASE, "--memory-limit", "0GB"],
        ["nightly", CASE, "--time-limit", "soon"],
        ["nightly", CASE, "--output", __file__],
        ["nightly", CASE, "--output", f"{__file__}/below"],
        ["history", CASE, "--folder", "no such folder"],
        ["history", CASE, "--folder", __file__],
    ],
    ids=" ".join,
)
def test_bad_input_is_one_sentence_and_exit_code_2(
    arguments: Sequence[str], capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)

    code = command_line.run([*arguments, "--no-cache"] if arguments[0] == "nightly" else arguments)

    shown = capsys.readouterr()
    assert (code, shown.out, shown.err.count("\n")) == (2, "", 1)
    assert list(tmp_path.iterdir()) == []


def test_the_history_of_a_case_is_a_table_and_json(
    tmp_path: Path, case_run: CaseRun, answered: Answered, capsys: pytest.CaptureFixture[str]
) -> None:
    answered(lambda case: replace(case_run, case=case))
    command_line.run(["nightly", CASE, "--no-peers", "--no-cache", "--output", str(tmp_path)])
    (tmp_path / "history" / "stranger").touch()
    capsys.readouterr()
    asked = ["history", CASE, "contact_force", "--folder", str(tmp_path / "history")]

    assert command_line.run(asked) == 0
    table = capsys.readouterr()
    assert command_line.run([*asked, "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)

    assert "rod model contact force" in table.out
    assert (
        table.err
        == f"rodcheck: history: {tmp_path}/history/stranger is not a file that rodcheck wrote; it is skipped\n"
    )
    assert {row["quantity"] for row in rows} == {"contact_force"}
    assert {row["solver"] for row in rows} == {"rod model", "3D"}
    assert command_line.run([*asked[:2], "mass", *asked[3:]]) == 2
    assert "it has bending_moment" in capsys.readouterr().err


def test_a_second_run_in_the_same_folder_says_so(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with locked(tmp_path):
        code = command_line.run(["nightly", CASE, "--no-cache", "--output", str(tmp_path)])

    shown = capsys.readouterr()
    assert (code, shown.out, shown.err.count("\n")) == (2, "", 1)
    assert "another nightly run is at work" in shown.err
