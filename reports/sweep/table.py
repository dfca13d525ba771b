"""The rows of a sweep as CSV and Parquet: tidy, one row for each value and quantity."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from pathlib import Path

import pyarrow as pa
import pyarrow.parquet as pq

from reports.store import in_place_of, write_whole
from reports.sweep.keys import Variation
from reports.sweep.run import Row

COLUMNS = ("quantity", "of", "part", "value", "unit", "outcome", "followed")


def write_tables(rows: Sequence[Row], variations: Sequence[Variation], folder: Path, name: str) -> tuple[Path, ...]:
    """Write NAME.csv and NAME.parquet into a folder, each whole or not at all; returns their paths.

    The columns are `number`, one for every varied key, with its unit in the title, and `COLUMNS`.

    Raises
    ------
    OSError
        if the folder or a file cannot be written.
    """
    columns = columns_of(rows, variations)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(columns)
    writer.writerows(zip(*columns.values(), strict=True))
    paths = folder / f"{name}.csv", folder / f"{name}.parquet"
    write_whole(paths[0], text.getvalue())
    with in_place_of(paths[1]) as temporary:
        pq.write_table(pa.table(columns), temporary)
    return paths


def columns_of(rows: Sequence[Row], variations: Sequence[Variation]) -> dict[str, list[object]]:
    """The table by columns."""
    columns: dict[str, list[object]] = {"number": [row.number for row in rows]}
    for index, each in enumerate(variations):
        columns[each.title] = [row.values[index] for row in rows]
    return columns | {name: [getattr(row, name) for row in rows] for name in COLUMNS}
