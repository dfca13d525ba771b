"""The plot of a sweep: one self-contained page, a panel for each quantity."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import plotly.graph_objects as go

from reports.figures import styled
from reports.html import rendered
from reports.store import write_whole
from reports.sweep.keys import Variation
from reports.sweep.run import SWEPT, Row

# Okabe and Ito (2008), dark enough on white.
COLOURS = ("#0072B2", "#D55E00", "#007A5A", "#B5548A", "#56789A", "#8A6D00")
HEIGHT = 320
# In the tables alone: checks of the solution, and edges that the search knows better.
NOT_DRAWN = ("equilibrium_residual", "penetration", "contact_edges")
# Up to so many points a line shows where they are.
MOST_MARKED = 60


def write_page(
    rows: Sequence[Row], variations: Sequence[Variation], title: str, folder: Path, name: str, notes: Sequence[str]
) -> Path:
    """Write NAME.html into a folder, whole or not at all; returns its path.

    notes : sentences about the sweep

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    shown = [quantity for quantity in dict.fromkeys(row.quantity for row in rows) if quantity not in NOT_DRAWN]
    figures = {f"plot-{quantity}": _figure(rows, variations, quantity) for quantity in shown}
    panels = [
        {"anchor": f"plot-{quantity}", "title": SWEPT[quantity].title, "text": SWEPT[quantity].text}
        for quantity in shown
    ]
    path = folder / f"{name}.html"
    varied = "; ".join(
        f"{each.title} from {each.values[0]:g} to {each.values[-1]:g}, {len(each.values)} values" for each in variations
    )
    page = rendered(
        "sweep/page.html.jinja",
        figures,
        title=title,
        name=name,
        varied=varied,
        panels=panels,
        notes=notes,
        height=HEIGHT,
    )
    write_whole(path, page)
    return path


def _figure(rows: Sequence[Row], variations: Sequence[Variation], quantity: str) -> go.Figure:
    """One quantity against the values that change first; a line for each rod or pair, part, and further value."""
    *others, along = variations
    lines: dict[str, list[Row]] = {}
    for row in rows:
        if row.quantity == quantity:
            fixed = [f"{each.key} = {value:g} {each.unit}" for each, value in zip(others, row.values, strict=False)]
            lines.setdefault(", ".join(filter(None, [row.of, row.part, *fixed])), []).append(row)
    figure = go.Figure()
    for number, (label, line) in enumerate(lines.items()):
        # Where a row is missing, as an edge of contact that is not there, the line is open.
        by_number = {row.number: row for row in line}
        numbers = range(line[0].number, line[-1].number + 1)
        present = [by_number.get(each) for each in numbers]
        figure.add_scatter(
            x=[None if row is None else row.values[-1] for row in present],
            y=[None if row is None or row.outcome != "converged" else row.value for row in present],
            name=label,
            showlegend=len(lines) > 1,
            mode="lines+markers" if len(along.values) <= MOST_MARKED else "lines",
            line={"color": COLOURS[number % len(COLOURS)], "width": 2},
            marker={"size": 5},
            hovertemplate="%{y:.6g} at %{x:.6g}",
        )
    unit = SWEPT[quantity].unit
    figure.update_xaxes(title_text=along.title, type="log" if along.logarithmic and along.values[0] > 0 else "linear")
    figure.update_yaxes(title_text=unit)
    return styled(figure, HEIGHT)
