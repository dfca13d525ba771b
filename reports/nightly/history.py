"""The history: one Parquet file a run, never rewritten, asked through DuckDB.

A file is named by its run and by the SHA-256 of its content, so that every damaged byte is noticed. What is not whole
and of this form is named in one sentence and left where it is.
"""

from __future__ import annotations

import hashlib
import io
import os
import re
from collections.abc import Sequence
from dataclasses import asdict, dataclass, fields
from pathlib import Path
from typing import Any

import duckdb
import pyarrow as pa
import pyarrow.parquet as pq

from reports.nightly.rows import Row
from reports.store import TEMPORARY_NAME, in_place_of

OWN_NAME = re.compile(r"(?P<run>\d{8}T\d{6}Z-[0-9a-f]{8})-(?P<checksum>[0-9a-f]{64})\.parquet")
NUMBERS = pa.list_(pa.float64())
TYPES = {
    "time": pa.timestamp("us", tz="UTC"),
    "relative": pa.bool_(),
    "value": NUMBERS,
    "reference": NUMBERS,
    "difference": pa.float64(),
    "uncertainty": pa.float64(),
    "tolerance": pa.float64(),
    "seconds": pa.float64(),
    "unknowns": pa.int64(),
    "memory": pa.float64(),
}
SCHEMA = pa.schema([(field.name, TYPES.get(field.name, pa.string())) for field in fields(Row)])
LISTS = ("value", "reference")
# All that `Row.subject` tells apart.
SUBJECT = '"case", solver, quantity, "of", point, against, source'


@dataclass(frozen=True)
class History:
    """What a folder of runs holds.

    Attributes
    ----------
    table : all rows of all whole files
    notes : files that were skipped and why, a sentence each
    """

    table: pa.Table
    notes: tuple[str, ...]

    def rows(self, case: str, quantity: str | None = None) -> list[Row]:
        """The rows of a case, or of one of its quantities, oldest run first."""
        return self._asked('WHERE "case" = $1 AND ($2 IS NULL OR quantity = $2)', [case, quantity])

    def latest(self, cases: Sequence[str], count: int, besides: str = "") -> list[Row]:
        """Of everything that the cases' rows are about, the last `count` rows, oldest first.

        besides : a run that is left out
        """
        last = f"QUALIFY row_number() OVER (PARTITION BY {SUBJECT} ORDER BY run DESC) <= $3"
        return self._asked(f'WHERE list_contains($1, "case") AND run != $2 {last}', [list(cases), besides, count])

    def cases(self) -> list[str]:
        """Names of all cases."""
        return [entry["case"] for entry in self._fetched('SELECT DISTINCT "case" FROM history ORDER BY 1', [])]

    def _asked(self, which: str, parameters: list[Any]) -> list[Row]:
        found = self._fetched(f"SELECT * FROM history {which} ORDER BY run, {SUBJECT}", parameters)
        return [Row(**row | {name: tuple(row[name]) for name in LISTS}) for row in found]

    def _fetched(self, query: str, parameters: list[Any]) -> list[dict[str, Any]]:
        with duckdb.connect(config={"threads": 1}) as connection:
            connection.execute("SET TimeZone = 'UTC'")  # or times come in the zone of this machine
            connection.register("history", self.table)
            found: list[dict[str, Any]] = connection.sql(query, params=parameters).to_arrow_table().to_pylist()
            return found


def write_run(folder: Path, rows: Sequence[Row]) -> Path:
    """Write the rows of one run as a file of the history, whole or not at all.

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    (run,) = {row.run for row in rows}
    content = io.BytesIO()
    pq.write_table(pa.Table.from_pylist([asdict(row) for row in rows], schema=SCHEMA), content, compression="zstd")
    whole = content.getvalue()
    path = folder / f"{run}-{hashlib.sha256(whole).hexdigest()}.parquet"
    with in_place_of(path) as temporary:
        temporary.write_bytes(whole)
    _keep_name(folder)
    return path


def _keep_name(folder: Path) -> None:
    """See to it that the folder knows the file after a power cut, too."""
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)


def has_run(folder: Path, run: str) -> bool:
    """Whether there is a whole file of that run."""
    names = [path for path in folder.glob(f"{run}-*.parquet") if OWN_NAME.fullmatch(path.name)]
    return any(isinstance(_read(path), pa.Table) for path in names)


def read_history(folder: Path) -> History:
    """All runs of a folder; one that is not there has none.

    Raises
    ------
    OSError
        if the folder cannot be listed.
    """
    tables, notes = [], []
    for path in sorted(folder.iterdir()) if folder.is_dir() else []:
        if TEMPORARY_NAME.fullmatch(path.name):
            continue  # a run at work, or a killed one: no part of the history yet
        found = _read(path)
        if isinstance(found, str):
            notes.append(f"history: {path} {found}; it is skipped")
        else:
            tables.append(found)
    return History(pa.concat_tables(tables) if tables else SCHEMA.empty_table(), tuple(notes))


def _read(path: Path) -> pa.Table | str:
    """The content of a file, or why it is none of the history's."""
    name = OWN_NAME.fullmatch(path.name)
    if name is None:
        return "is not a file that rodcheck wrote"
    try:
        content = path.read_bytes()
    except OSError as error:
        return f"cannot be read ({error.strerror})"
    if hashlib.sha256(content).hexdigest() != name["checksum"]:
        return "is damaged"
    try:
        table = pq.read_table(io.BytesIO(content))
    except (pa.ArrowException, OSError):
        return "is not a Parquet file"
    return table if table.schema.equals(SCHEMA) else "holds rows of another form"
