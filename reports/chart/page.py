"""The chart as a part of a case's page, and as a page of its own."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import plotly.graph_objects as go

from cases.case import Case
from reports.chart.choices import HEADINGS, choices, rows
from reports.chart.figure import chart_figure, key
from reports.chart.front import COSTS, drawn_points, races
from reports.chart.points import LENGTHS, TITLES, Chart, Charted
from reports.chart.wording import (
    RATIOS,
    alternative,
    caption,
    error_text,
    race_heading,
    race_rows,
    raced,
    seconds_text,
    told,
    unfinished,
)
from reports.formatting import capital, count
from reports.html import rendered
from reports.store import write_whole


def chart_part(chart: Chart, anchor: str) -> tuple[dict[str, Any], dict[str, go.Figure]]:
    """What the template `chart/part.html.jinja` needs to know, and the figures by the id of their place."""
    figures: dict[str, go.Figure] = {}
    places, missing = [], []
    for quantity in chart.references:
        if not drawn_points(chart, quantity):
            reason = chart.references[quantity].reason or "no configuration tells it"
            missing.append(f"{TITLES[quantity]}: there is no chart. {capital(reason)}.")
            continue
        panels = {f"{anchor}-chart-{quantity}-{panel}": chart_figure(chart, quantity, panel) for panel in COSTS}
        figures |= panels
        places.append(
            {
                "title": TITLES[quantity],
                "caption": caption(chart, quantity),
                "panels": [
                    (place, alternative(chart, quantity, panel), figure.layout.height)
                    for (place, figure), panel in zip(panels.items(), COSTS, strict=True)
                ],
            }
        )
    found = races(chart)
    content = {
        "key": key(chart),
        "figures": places,
        "missing": missing,
        "raced": raced(chart),
        "ratios": RATIOS,
        "headings": [race_heading(race) for race in found],
        "race": race_rows(found),
        "choice_headings": HEADINGS[1:],
        "choices": [("", cells, shortcomings) for _, cells, shortcomings in rows(choices([chart]))],
        "quantities": [TITLES[quantity] for quantity in chart.references],
        "points": [
            (
                told(point),
                count(point.unknowns),
                seconds_text(point),
                str(len(point.seconds)),
                [error_text(quantity, chart.error(quantity, point)) for quantity in chart.references],
                "" if point.outcome == "converged" else point.outcome,
            )
            for point in chart.points
        ],
        "notes": [*chart.notes, *(f"Not drawn: {sentence}." for sentence in unfinished(chart))],
    }
    return content, figures


def write_chart(case: Case, chart: Chart, output: Path) -> Path:
    """Write `chart-CASE.html` into the folder `output`, and its numbers beside it; returns the page's path.

    Raises
    ------
    OSError
        if the folder or a file cannot be written.
    """
    content, figures = chart_part(chart, "case")
    page = rendered("chart/page.html.jinja", figures, chart=content, title=case.title, name=case.name)
    write_chart_numbers(case, chart, output / "results")
    path = output / f"chart-{case.name}.html"
    write_whole(path, page)
    return path


def write_chart_numbers(case: Case, chart: Chart, folder: Path) -> None:
    """Write `CASE-chart.json`: every configuration with its cost and errors.

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    write_whole(folder / f"{case.name}-chart.json", json.dumps(as_json(chart), indent=1, allow_nan=False) + "\n")


def as_json(chart: Chart) -> dict[str, Any]:
    """All numbers of a chart: seconds, unknowns, and errors as fractions or, of edges, in mm."""

    def unit(quantity: Charted) -> str:
        return "mm" if quantity in LENGTHS else ""

    references = {
        quantity: {
            "values": {of: list(values) for of, values in reference.values.items()},
            "uncertainty": reference.uncertainty,
            "unit_of_errors": unit(quantity),
            "note": reference.reason,
        }
        for quantity, reference in chart.references.items()
    }
    points = [
        {
            "method": point.method,
            "label": point.label,
            "outcome": point.outcome,
            "unknowns": point.unknowns,
            "seconds": list(point.seconds),
            "clock": point.clock,
            "errors": {quantity: chart.error(quantity, point) for quantity in chart.references},
            "chosen": point.chosen,
            "estimates": [
                {"quantity": quantity, "of": of, "errors": [each if math.isfinite(each) else None for each in errors]}
                for (quantity, of), errors in point.estimates.items()
            ],
        }
        for point in chart.points
    ]
    return {"references": references, "points": points, "notes": list(chart.notes)}
