"""Results are written whole or not at all."""

from __future__ import annotations

from pathlib import Path

import pytest

from reports.store import in_place_of, remove_left_behind, write_whole


def test_a_file_is_written_with_its_folder(tmp_path: Path) -> None:
    write_whole(tmp_path / "report" / "index.html", "whole")

    assert (tmp_path / "report" / "index.html").read_text() == "whole"
    assert [path.name for path in (tmp_path / "report").iterdir()] == ["index.html"]


def test_a_write_that_fails_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    target = tmp_path / "result.json"
    target.write_text("old")

    with pytest.raises(UnicodeEncodeError):
        write_whole(target, "half \ud800 written")

    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_an_interrupt_leaves_the_old_file_and_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "result.json"
    target.write_text("old")

    def interrupted(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(Path, "replace", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_whole(target, "new")

    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_what_a_killed_process_left_half_written_is_removed_and_nothing_else(tmp_path: Path) -> None:
    whole, foreign = tmp_path / "below" / "result.json", tmp_path / "below" / ".mine.tmp"
    foreign.parent.mkdir()
    foreign.touch()
    with in_place_of(whole) as temporary:
        name = temporary
    name.write_text("half")

    remove_left_behind(tmp_path)

    assert sorted(whole.parent.iterdir()) == [foreign, whole]
