"""The history keeps every run as it was written, and reads what is whole, whatever else lies beside it."""

from __future__ import annotations

import errno
import io
import math
import shutil
from collections.abc import Callable
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from reports.nightly.history import has_run, read_history, write_run
from reports.nightly.rows import Row

RowMaker = Callable[..., Row]


def test_rows_come_back_as_they_were_written(tmp_path: Path, row: RowMaker) -> None:
    rows = [row(), row(quantity="contact_edges", value=(1.5, 2.25), uncertainty=math.inf), row(of="none", value=())]

    path = write_run(tmp_path / "deep" / "history", rows)

    found = read_history(tmp_path / "deep" / "history")
    assert sorted(found.rows("bars"), key=str) == sorted(rows, key=str)
    assert found.notes == ()
    assert [each.name for each in path.parent.iterdir()] == [path.name]


def test_a_case_and_a_quantity_are_found_in_the_order_of_runs(tmp_path: Path, row: RowMaker) -> None:
    for night in (2, 0, 1):
        write_run(tmp_path, [row(night), row(night, quantity="deflection"), row(night, case="other")])

    found = read_history(tmp_path)

    assert [each.time.day for each in found.rows("bars", "deflection")] == [1, 2, 3]
    assert len(found.rows("bars")) == 6
    assert found.cases() == ["bars", "other"]
    assert found.rows("no such case' OR 1=1 --") == []


def test_the_latest_are_counted_for_everything_by_itself(tmp_path: Path, row: RowMaker) -> None:
    write_run(tmp_path, [row(0), row(0, of="early")])
    for night in (1, 2, 3):
        write_run(tmp_path, [row(night)])

    found = read_history(tmp_path).latest(["bars"], 2, besides=row(3).run)

    assert [(each.of, each.time.day) for each in found] == [("early", 1), ("overlap", 2), ("overlap", 3)]


@pytest.mark.slow
def test_a_damaged_byte_anywhere_is_noticed_and_the_file_named_and_left(tmp_path: Path, row: RowMaker) -> None:
    path = write_run(tmp_path, [row()])
    write_run(tmp_path, [row(1)])
    whole = path.read_bytes()

    for place in range(0, len(whole), len(whole) // 9):
        path.write_bytes(whole[:place] + bytes([whole[place] ^ 1]) + whole[place + 1 :])
        found = read_history(tmp_path)
        assert found.notes == (f"history: {path} is damaged; it is skipped",)
        assert len(found.rows("bars")) == 1
    assert not has_run(tmp_path, row().run)
    assert path.exists()


def test_foreign_files_are_named_and_skipped(tmp_path: Path, row: RowMaker) -> None:
    path = write_run(tmp_path, [row()])
    shutil.copy(path, tmp_path / "copy.parquet")
    (tmp_path / "notes.txt").write_text("mine")
    (tmp_path / "folder").mkdir()

    found = read_history(tmp_path)

    assert len(found.rows("bars")) == 1
    assert [note.split("history: ")[1].split(" is not")[0] for note in found.notes] == [
        str(tmp_path / name) for name in ("copy.parquet", "folder", "notes.txt")
    ]


def test_rows_of_another_form_are_named_and_skipped(
    tmp_path: Path, row: RowMaker, monkeypatch: pytest.MonkeyPatch
) -> None:
    def other(_table: pa.Table, where: io.BytesIO, **_options: object) -> None:
        where.write(b"no Parquet")

    with monkeypatch.context() as patched:
        patched.setattr(pq, "write_table", other)
        write_run(tmp_path, [row(0)])
    with monkeypatch.context() as patched:
        patched.setattr("reports.nightly.history.SCHEMA", pa.schema([("run", pa.string())]))
        write_run(tmp_path, [row(1)])

    notes = read_history(tmp_path).notes

    assert [note.split(".parquet ")[1] for note in notes] == [
        "is not a Parquet file; it is skipped",
        "holds rows of another form; it is skipped",
    ]


def test_a_full_disk_leaves_no_file(tmp_path: Path, row: RowMaker, monkeypatch: pytest.MonkeyPatch) -> None:
    write_run(tmp_path, [row(0)])

    def full(_path: Path, _content: bytes) -> int:
        raise OSError(errno.ENOSPC, "No space left on device")

    monkeypatch.setattr(Path, "write_bytes", full)
    with pytest.raises(OSError, match="No space"):
        write_run(tmp_path, [row(1)])

    assert len(list(tmp_path.iterdir())) == 1
    assert len(read_history(tmp_path).rows("bars")) == 1


def test_what_a_killed_run_left_half_written_is_no_part_of_the_history(tmp_path: Path, row: RowMaker) -> None:
    path = write_run(tmp_path, [row()])
    half = path.with_name(f".{path.name}.abc_1234.tmp")
    half.write_bytes(path.read_bytes()[:100])

    assert read_history(tmp_path).notes == ()


def test_no_folder_is_an_empty_history(tmp_path: Path) -> None:
    assert read_history(tmp_path / "none").rows("bars") == []
