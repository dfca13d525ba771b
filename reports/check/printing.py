"""What `rodcheck check` prints."""

from __future__ import annotations

from rich.markup import escape
from rich.table import Table as Printed

from cases.case import Case
from reports.check.summary import Summary
from reports.tables import console


def print_summary(case: Case, found: Summary) -> None:
    """Print the tables of a case, its size and what may surprise."""
    out = console()
    out.print(f"[bold]{escape(case.title)}[/] ({escape(case.name)})")
    for table in found.tables:
        printed = Printed(*map(escape, table.columns))
        for row in table.rows:
            printed.add_row(*map(escape, row))
        out.print(printed)
    if found.size:
        out.print(escape(found.size))
    for warning in found.warnings:
        out.print(f"[yellow]warning[/]: {escape(warning)}")
