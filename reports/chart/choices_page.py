"""The choices of all cases as a page of their own, and on a terminal."""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from pathlib import Path

from reports.chart.choices import HEADINGS, choices, rows, summary
from reports.chart.points import Chart
from reports.html import rendered
from reports.store import write_whole

PAGE = "choices.html"


def write_choices(charts: Sequence[Chart], output: Path, *, in_report: bool = False) -> Path:
    """Write `choices.html` into the folder `output`, and its numbers beside it; returns the page's path.

    Parameters
    ----------
    in_report : whether an overview stands, or will stand, beside it

    Raises
    ------
    OSError
        if the folder or a file cannot be written.
    """
    found = choices(charts)
    content = {
        "headings": HEADINGS,
        "rows": rows(found),
        "summary": summary(found),
        "without": _without(charts),
        "in_report": in_report,
    }
    numbers = [
        {
            "case": choice.case,
            "tolerance": choice.tolerance,
            "outcome": choice.point.outcome,
            "levels": choice.point.chosen,
            "seconds": list(choice.point.seconds),
            "cheapest": None if choice.cheapest is None else choice.cheapest.label,
            "seconds_of_cheapest": None if choice.cheapest is None else list(choice.cheapest.seconds),
            "quantities": [
                {
                    "quantity": each.quantity,
                    "of": each.of,
                    "error": each.error,
                    "estimate": each.estimate if math.isfinite(each.estimate) else None,
                    "uncertainty": each.uncertainty,
                }
                for each in choice.judged
            ],
            "shortcomings": choice.shortcomings,
        }
        for choice in found
    ]
    write_whole(output / "results" / "choices.json", json.dumps(numbers, indent=1, allow_nan=False) + "\n")
    path = output / PAGE
    # nothing is drawn: no script is needed
    write_whole(path, rendered("chart/choices.html.jinja", {}, plotly_file="none", **content))
    return path


def print_choices(charts: Sequence[Chart]) -> None:
    """Print the table of choices, in what they fall short, and what comes out over all."""
    from rich.markup import escape
    from rich.table import Table

    from reports.tables import console

    out = console()
    found = choices(charts)
    table = Table(*HEADINGS)
    for case, cells, _ in rows(found):
        table.add_row(escape(case), *map(escape, cells))
    out.print(table)
    for choice in found:
        for clause in choice.shortcomings:
            out.print(escape(f"{choice.case}, {100.0 * choice.tolerance:g} %: {clause}"))
    for title, reason in _without(charts):
        out.print(escape(f"{title}: {reason}"))
    for sentence in summary(found):
        out.print(escape(sentence))


def _without(charts: Sequence[Chart]) -> list[tuple[str, str]]:
    """Titles of cases without a choice, and why there is none."""
    return [(chart.title, " ".join(chart.notes)) for chart in charts if not choices([chart])]
