"""The history of a case as a table for people and as JSON for programs."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from typing import Any

from rich.markup import escape
from rich.table import Table

from reports.formatting import NOTHING, seconds
from reports.nightly.drift import named
from reports.nightly.rows import FAILED, Row
from reports.tables import STYLES, console


def as_json(rows: Sequence[Row]) -> str:
    """Rows as a JSON array; numbers that are not finite as null, times in ISO 8601."""
    return json.dumps([_plain(asdict(row) | {"time": row.time.isoformat()}) for row in rows], allow_nan=False)


def _plain(value: Any) -> Any:  # noqa: ANN401 (JSON)
    if isinstance(value, dict):
        return {key: _plain(entry) for key, entry in value.items()}
    if isinstance(value, tuple):
        return [_plain(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def print_history(rows: Sequence[Row]) -> None:
    """Print rows, oldest run first under each of what they are about."""
    out = console()
    table = Table("of", "against", "time, UTC", "value", "reference", "difference", "verdict", "time", "MB", "commit")
    styles = {**{str(verdict): style for verdict, style in STYLES.items()}, FAILED: "bold red"}
    last = None
    for row in sorted(rows, key=lambda row: (row.subject, row.run)):
        first = row.subject != last
        if first and last is not None:
            table.add_section()
        last = row.subject
        style = styles.get(row.verdict, "")
        shown = escape(row.verdict if row.verdict != FAILED else f"{row.verdict}: {row.reason}")
        table.add_row(
            escape(named(row)) if first else "",
            escape(row.against) if first else "",
            f"{row.time:%Y-%m-%d %H:%M}",
            _values(row.value, row.unit),
            _values(row.reference, row.unit),
            _measure(row),
            f"[{style}]{shown}[/]" if style else shown,
            NOTHING if row.seconds is None else seconds(row.seconds) + ("*" if row.kept_since else ""),
            NOTHING if row.memory is None else f"{row.memory:.0f}",
            row.commit,
        )
    out.print(table)
    if any(row.kept_since for row in rows):
        out.print("* from the cache, not measured in that run")


def _values(values: Sequence[float], unit: str) -> str:
    return ", ".join(f"{value:.6g}" for value in values) + f" {unit}" if values else NOTHING


def _measure(row: Row) -> str:
    if row.difference is None:
        return NOTHING
    return f"{100.0 * row.difference:.3g} %" if row.relative else f"{row.difference:.3g} {row.unit}"
