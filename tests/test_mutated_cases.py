"""Mutated case files: each is a case or is refused in one sentence, soon, and nothing else happens.

More files than the suite has time for: `MUTATED_CASES=10000 pytest tests/test_mutated_cases.py -rP`.
"""

from __future__ import annotations

import os
import signal
import sys
import time
import warnings
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from cases.case import Case
from cases.loader import LIBRARY, CaseError, load_case
from reports.check.summary import summary
from reports.new_case.templates import TEMPLATES, case_text
from tests.mutated_cases import MARK, TEXTS, mutated

FILES = int(os.environ.get("MUTATED_CASES", "300"))
# Seconds of processor time that a file may take; the slowest take half a second.
LONGEST = 5.0
# Characters that a message may have: it quotes, but never all.
LONGEST_MESSAGE = 1000
# What reading a file never does, as Python announces it to those who audit.
NEVER = ("exec", "compile", "import", "os.", "shutil.", "socket.", "subprocess.", "pty.", "ctypes.", "tempfile.")
HARMLESS = ("os.listdir", "os.scandir")

done: list[str] = []
watching = False


def watch(event: str, arguments: tuple[object, ...]) -> None:
    if not watching:
        return
    if event == "open" and not isinstance(arguments[0], int):
        mode, flags = arguments[1], arguments[2]
        writes = isinstance(mode, str) and set(mode) & set("wax+")
        if writes or (isinstance(flags, int) and flags & (os.O_WRONLY | os.O_RDWR | os.O_CREAT)):
            done.append(f"{event} {arguments[0]!r}")
    elif event.startswith(NEVER) and event not in HARMLESS:
        done.append(f"{event} {arguments!r:.200}")


@contextmanager
def watched() -> Iterator[list[str]]:
    """What is done meanwhile that reading a file never does; what hangs is interrupted."""
    global watching  # as a hook of Python cannot be taken away again, only left idle

    def hang(*_: object) -> None:
        raise TimeoutError

    done.clear()
    signal.signal(signal.SIGPROF, hang)
    signal.setitimer(signal.ITIMER_PROF, 4.0 * LONGEST)
    watching = True
    try:
        yield done
    finally:
        watching = False
        signal.setitimer(signal.ITIMER_PROF, 0.0)


@pytest.fixture(scope="module")
def texts() -> list[str]:
    """The library, the case that uses everything and the templates of new cases."""
    sys.addaudithook(watch)
    everything = Path(__file__).parent / "cases" / "everything.toml"
    files = [*sorted(LIBRARY.glob("*.toml")), everything]
    return [path.read_text(encoding="utf-8") for path in files] + [case_text(each, "New", {}) for each in TEMPLATES]


@pytest.mark.slow
def test_a_mutated_file_is_a_case_that_can_be_checked_or_refused_in_one_sentence(
    texts: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "case.toml"
    for text in (*texts, "x = 1", "title = 1\n[materials.m]\nlaw = 3"):  # whatever is imported on the way is now
        path.write_text(text, encoding="utf-8")
        loaded(path)
    found: Counter[str] = Counter()

    for seed in range(FILES):
        path.write_bytes(mutated(seed, texts))
        begin = time.process_time()
        with watched() as events:
            case = loaded(path)
        assert time.process_time() - begin < LONGEST, seed
        assert not events, seed
        found["refused" if case is None else "case"] += 1
        if case is not None:
            told = summary(case)
            assert len(told.tables) >= 2, seed
            assert told.size or told.problem, seed

    print(f"{FILES} files:", dict(found))  # noqa: T201 - the count is part of what the test tells
    assert [each.name for each in tmp_path.iterdir()] == ["case.toml"]
    assert found["case"] > 0.02 * FILES
    assert found["refused"] > 0.5 * FILES


def loaded(path: Path) -> Case | None:
    """The case of a file; None if it is refused, as people read it. No warning is left to them."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            return load_case(path)
        except CaseError as error:
            sentence = str(error)
    assert sentence.startswith(f"{path}: ")
    assert sentence.isprintable()
    assert len(sentence) < LONGEST_MESSAGE
    return None


@pytest.mark.parametrize("text", TEXTS, ids=lambda text: ascii(text)[:30])
def test_no_text_is_carried_out(texts: list[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch, text: str) -> None:
    monkeypatch.chdir(tmp_path)
    path = tmp_path / "case.toml"
    quoted = '"' + "".join(f"\\U{ord(each):08X}" for each in text) + '"'
    for old in ('title = "Two cantilevers, E2 = 50 GPa, no gap"', 'width = "15 mm"', 'rod = "lower"', '"e50_g0.json"'):
        whole = (LIBRARY / "two-cantilevers-e50-g0.toml").read_text(encoding="utf-8")
        path.write_text(whole.replace(old, f"{old.partition(' = ')[0]} = {quoted}" if " = " in old else quoted, 1))

        with watched() as events:
            loaded(path)

        assert not [event for event in events if not event.startswith(("import", "compile", "exec"))]
        assert not list(tmp_path.glob(f"**/*{MARK}*"))
