"""The cache gives back what was kept, or nothing: never something damaged, and never at the price of a run."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from cases.loader import load_case
from reports import runner
from reports.cache import Cache, default_folder, key
from reports.runner import KINDS, CaseRun, Failure, ReferenceRuns, run_cases

QUESTION = ("a scene", 1.5)
PROFILE = np.linspace(0.0, 1.0, 500)


def keep(cache: Cache) -> Path:
    cache.keep("rod", QUESTION, PROFILE)
    (path,) = cache.folder.glob("*.json")
    return path


def truncate(content: bytes) -> bytes:
    return content[: len(content) // 2]


def flip(content: bytes) -> bytes:
    place = len(content) * 2 // 3
    return content[:place] + bytes([content[place] ^ 1]) + content[place + 1 :]


def test_what_was_kept_comes_back_with_its_day(tmp_path: Path) -> None:
    keep(Cache(tmp_path / "deep" / "cache"))
    cache = Cache(tmp_path / "deep" / "cache")

    found = cache.find("rod", QUESTION, ())

    assert found is not None
    assert found.value.tobytes() == PROFILE.tobytes()
    assert len(found.date) == len("2026-01-01")
    assert cache.notes == []


def test_another_question_has_no_answer(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    keep(cache)

    assert cache.find("rod", ("a scene", 1.5 + 2.3e-16), ()) is None  # the next number
    assert cache.find("reference", QUESTION, ()) is None
    assert cache.notes == []


@pytest.mark.parametrize(
    ("damage", "said"),
    [
        (truncate, "is damaged"),
        (flip, "is damaged"),
        (lambda _: b"", "is not a file that rodcheck wrote"),
        (lambda _: b"\x89PNG and so on", "is not a file that rodcheck wrote"),
        (lambda content: content.replace(b"cache 1 ", b"cache 2 "), "is not a file that rodcheck wrote"),
    ],
    ids=["truncated", "flipped", "empty", "foreign", "other format"],
)
def test_a_file_that_is_not_whole_is_named_removed_and_kept_anew(
    tmp_path: Path, damage: Callable[[bytes], bytes], said: str
) -> None:
    path = keep(Cache(tmp_path))
    path.write_bytes(damage(path.read_bytes()))
    cache = Cache(tmp_path)

    assert cache.find("rod", QUESTION, ()) is None

    (note,) = cache.notes
    assert f"{path} {said}" in note
    assert not path.exists()
    keep(cache)
    assert cache.find("rod", QUESTION, ()) is not None


def test_every_single_damaged_byte_is_noticed(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.keep("rod", QUESTION, (1.25, "text"))
    (path,) = tmp_path.iterdir()
    whole = path.read_bytes()

    for place in range(len(whole) - 1):  # the last one ends the line
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 4]) + whole[place + 1 :])
        assert cache.find("rod", QUESTION, ()) is None, place


def test_the_answer_to_another_question_under_its_name_is_not_taken(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    other = keep(cache)
    other.rename(tmp_path / f"rod-{key('another question')}.json")

    assert cache.find("rod", "another question", ()) is None
    assert f"is a copy of {other.name}" in cache.notes[0]


def test_a_full_disk_costs_a_sentence_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    cache = Cache(tmp_path)
    monkeypatch.setattr(os, "fsync", full)

    cache.keep("rod", QUESTION, PROFILE)
    cache.keep("rod", "another question", PROFILE)

    assert cache.notes == [
        f"cache: cannot write to {tmp_path} (No space left on device); results are computed without it"
    ]
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_one_costs_a_sentence(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("the user's own")
    cache = Cache(tmp_path / "file")

    assert cache.find("rod", QUESTION, ()) is None
    cache.keep("rod", QUESTION, PROFILE)
    cache.clean()

    assert all("results are computed without it" in note for note in cache.notes)
    assert (tmp_path / "file").read_text() == "the user's own"


def test_a_process_killed_while_it_writes_leaves_no_entry_and_the_next_run_cleans_up(tmp_path: Path) -> None:
    code = f"""
import os, signal
from pathlib import Path
from reports.cache import Cache
os.fsync = lambda _: os.kill(os.getpid(), signal.SIGKILL)
Cache(Path({str(tmp_path)!r})).keep("rod", {QUESTION!r}, tuple(range(1000)))
"""
    killed = subprocess.run([sys.executable, "-c", code], check=False)
    assert killed.returncode == -signal.SIGKILL
    (left,) = tmp_path.iterdir()
    cache = Cache(tmp_path)

    assert cache.find("rod", QUESTION, ()) is None
    cache.clean()
    assert left.exists()  # it might be another process, still writing
    an_hour_ago = time.time() - 3600.0
    os.utime(left, (an_hour_ago, an_hour_ago))
    cache.clean()

    assert not left.exists()
    assert cache.notes == []


@pytest.mark.slow
def test_processes_that_keep_the_same_answer_at_once_do_not_disturb_each_other(tmp_path: Path) -> None:
    code = f"""
from pathlib import Path
from reports.cache import Cache
cache = Cache(Path({str(tmp_path)!r}))
for _ in range(30):
    cache.keep("rod", {QUESTION!r}, tuple(range(3000)))
    assert cache.find("rod", {QUESTION!r}, ()).value == tuple(range(3000))
assert cache.notes == []
"""
    processes = [subprocess.Popen([sys.executable, "-c", code]) for _ in range(2)]

    assert [process.wait() for process in processes] == [0, 0]
    assert len(list(tmp_path.iterdir())) == 1


def test_entries_long_unused_are_removed_and_files_of_others_never(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    used, unused = keep(cache), tmp_path / f"rod-{key('unused')}.json"
    cache.keep("rod", "unused", PROFILE)
    others = [tmp_path / "thesis.json", tmp_path / ".notes.tmp"]
    long_ago = time.time() - 100 * 86400.0
    for path in (used, unused, *others):
        path.touch()
        os.utime(path, (long_ago, long_ago))

    assert cache.find("rod", QUESTION, ()) is not None
    cache.clean()

    assert set(tmp_path.iterdir()) == {used, *others}


def test_the_folder_is_where_the_user_keeps_such_things(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", "/somewhere")
    assert default_folder() == Path("/somewhere/rodcheck")
    monkeypatch.setenv("XDG_CACHE_HOME", "relative, to be ignored")
    monkeypatch.setenv("HOME", "/home/user")
    assert default_folder() == Path("/home/user/.cache/rodcheck")


@pytest.fixture
def solved(case_run: CaseRun, monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """Answers given instead of solving, in this process; the names of the models that were asked."""
    asked: list[str] = []

    def rod(*_: object, **__: object) -> runner.Run:
        asked.append("rod")
        return case_run.rod

    def references(*_: object) -> ReferenceRuns:
        asked.append("reference")
        return ReferenceRuns(case_run.references, (3.0, 1.5, 1.0))

    monkeypatch.setattr(runner, "run_rod", rod)
    monkeypatch.setattr(runner, "_run_references", references)
    monkeypatch.setattr(runner, "in_own_process", lambda work, given, progress: work(given, progress))
    return asked


def run(case_run: CaseRun, folder: Path, **changes: object) -> CaseRun:
    (found,) = run_cases([replace(case_run.case, **changes)], lambda _case, _what: None, Cache(folder))
    assert not isinstance(found, Failure), found.reason
    return found


@pytest.mark.slow
def test_a_second_run_repeats_nothing_and_says_the_same(case_run: CaseRun, tmp_path: Path, solved: list[str]) -> None:
    first = run(case_run, tmp_path)
    second = run(case_run, tmp_path)

    assert solved == ["rod", "reference"]
    assert first.rod.origin == ""
    assert all(
        answer.origin.startswith(", from the cache, computed on 20") for answer in (second.rod, *second.references)
    )
    assert second.comparisons == first.comparisons
    assert second.rod.total_seconds == first.rod.total_seconds


def test_another_tolerance_asks_no_solver(case_run: CaseRun, tmp_path: Path, solved: list[str]) -> None:
    run(case_run, tmp_path)
    tighter = tuple(replace(check, tolerance=1e-9) for check in case_run.case.compare)

    found = run(case_run, tmp_path, compare=tighter)

    assert solved == ["rod", "reference"]
    assert "fail" in {each.verdict for each in found.comparisons}


def test_another_level_asks_the_rod_model_alone(case_run: CaseRun, tmp_path: Path, solved: list[str]) -> None:
    run(case_run, tmp_path)

    run(case_run, tmp_path, rod_model=replace(case_run.case.rod_model, level=3))

    assert solved == ["rod", "reference", "rod"]


def test_another_scene_asks_both(case_run: CaseRun, tmp_path: Path, solved: list[str]) -> None:
    run(case_run, tmp_path)
    scene = load_case("two-cantilevers-e20-g05").scene

    run(case_run, tmp_path, scene=scene)

    assert solved == ["rod", "reference"] * 2


def test_a_damaged_answer_is_computed_again_and_the_user_told(
    case_run: CaseRun, tmp_path: Path, solved: list[str]
) -> None:
    run(case_run, tmp_path)
    (path,) = tmp_path.glob("reference-*.json")
    path.write_bytes(flip(path.read_bytes()))

    found = run(case_run, tmp_path)
    again = run(case_run, tmp_path)

    assert solved == ["rod", "reference", "reference"]
    assert [str(path) in note for note in found.notes] == [True]
    assert again.notes == ()


def test_a_result_whose_form_changed_since_is_not_taken(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    cache.keep("reference", QUESTION, ReferenceRuns((), ()))

    assert cache.find("reference", QUESTION, set(KINDS) - {ReferenceRuns}) is None
    assert "holds a result of another form" in cache.notes[0]
