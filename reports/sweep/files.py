"""What a sweep leaves: two tables and a page, and what is to be said about them."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from cases.case import Case
from reports.sweep.keys import Variation
from reports.sweep.page import write_page
from reports.sweep.run import Row
from reports.sweep.table import write_tables


def write_sweep(
    rows: Sequence[Row], variations: Sequence[Variation], case: Case, folder: Path, notes: Sequence[str]
) -> tuple[Path, ...]:
    """Write CASE.csv, CASE.parquet and CASE.html into a folder, each whole or not at all; returns their paths.

    Raises
    ------
    OSError
        if the folder or a file cannot be written.
    """
    tables = write_tables(rows, variations, folder, case.name)
    return *tables, write_page(rows, variations, case.title, folder, case.name, notes)


def notes(rows: Sequence[Row], count: int) -> list[str]:
    """Sentences on how `count` values were solved."""
    anew = {row.number for row in rows if not row.followed}
    failed = {row.number: row.outcome for row in rows if row.outcome != "converged"}
    searched = f"the search for contact began {len(anew)} times anew, else where the values before led"
    sentences = [f"{count} values, each solved; {searched}."]
    if failed:
        first, outcome = next(iter(failed.items()))
        sentences.append(f"{len(failed)} values did not converge, the first of them number {first}: {outcome}")
    return sentences
