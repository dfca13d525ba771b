"""Error against seconds and against unknowns on logarithmic scales, with the front and the reference's uncertainty.

Methods differ in colour and in shape; points of the rod model carry the number of their level.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping
from typing import Any

import plotly.graph_objects as go

from reports.chart.front import COSTS, drawn_points, front
from reports.chart.points import (
    CALCULIX,
    LENGTHS,
    NGSOLVE,
    NGSOLVE_BOUNDARY,
    NGSOLVE_TUNED,
    ROD_AUTO,
    ROD_GRADED,
    ROD_OWN,
    SOLID,
    Chart,
    Charted,
    Point,
)
from reports.chart.wording import error_text, seconds_text, told
from reports.figures import AXIS, LOOK, REFERENCE, ROD, TICKS

HEIGHT = 380
NGSOLVE_COLOUR, CALCULIX_COLOUR, BEAM_COLOUR = "#007A5A", "#A23B72", "#52606D"
BAND, FRONT = "#D9DEE4", "#1F2933"
# How many times below the uncertainty points are still told apart, and errors that are round-off.
BELOW, ROUND_OFF = 20.0, 1e-9
# A sign of text that looks like each method's, for the key of all panels.
SIGNS: Mapping[str, str] = {
    ROD_OWN: "\u25cb",
    ROD_GRADED: "\u25cf",
    ROD_AUTO: "\u2605",
    "Euler-Bernoulli beams": "\u00d7",
    "Timoshenko beams": "+",
    SOLID: "\u25a0",
    NGSOLVE: "\u25c7",
    NGSOLVE_TUNED: "\u25c6",
    NGSOLVE_BOUNDARY: "\u25ca",
    CALCULIX: "\u25b2",
}
# Colour, shape and size; a shape ending in -open is not filled.
LOOKS: dict[str, tuple[str, str, int]] = {
    ROD_OWN: (ROD, "circle-open", 15),
    ROD_GRADED: (ROD, "circle", 15),
    ROD_AUTO: (ROD, "star", 15),
    "Euler-Bernoulli beams": (BEAM_COLOUR, "x-thin-open", 9),
    "Timoshenko beams": (BEAM_COLOUR, "cross-thin-open", 10),
    SOLID: (REFERENCE, "square", 10),
    NGSOLVE: (NGSOLVE_COLOUR, "diamond-open", 11),
    NGSOLVE_TUNED: (NGSOLVE_COLOUR, "diamond", 11),
    NGSOLVE_BOUNDARY: (NGSOLVE_COLOUR, "diamond-tall-open", 12),
    CALCULIX: (CALCULIX_COLOUR, "triangle-up", 11),
}
FRONT_NAME, BAND_NAME = "none is both cheaper and nearer", "the reference itself is uncertain"


def chart_figure(chart: Chart, quantity: Charted, panel: str) -> go.Figure:
    """A panel of the chart of a quantity that some configuration tells and that there is a reference for."""
    figure, cost = go.Figure(), COSTS[panel]
    points = drawn_points(chart, quantity)
    factor = 1.0 if quantity in LENGTHS else 100.0
    uncertainty = chart.references[quantity].uncertainty or 0.0
    least = max(uncertainty / BELOW, ROUND_OFF)
    lowest = factor * max(least, min(min(error for _, error in points), uncertainty or 1.0)) / 1.6
    highest = factor * max(max(error for _, error in points), uncertainty) * 2.0
    costs = [cost(point) for point, _ in points]
    ends = [min(costs) / 1.8, max(costs) * 1.8]
    if uncertainty > 0.0:
        _band(figure, ends, lowest, factor * uncertainty)
    for method, (colour, symbol, size) in LOOKS.items():
        own = [(point, error) for point, error in points if point.method == method]
        if own:
            marker = {"color": colour, "symbol": symbol, "size": size, "line": {"width": 1.6, "color": colour}}
            _points(figure, quantity, own, panel, (factor, least), marker)
    edge = front(chart, quantity, cost)
    errors = dict(points)
    figure.add_scatter(
        x=_rounded([*(cost(point) for point in edge), ends[1]]),
        y=_rounded([factor * max(errors[point], uncertainty, least) for point in (*edge, edge[-1])]),
        name=FRONT_NAME,
        mode="lines",
        line={"color": FRONT, "width": 1.3, "shape": "hv"},
        hoverinfo="skip",
    )
    figure.update_xaxes(title_text=panel, range=_decades(ends))
    figure.update_yaxes(title_text=f"error, {'mm' if quantity in LENGTHS else '%'}", range=_decades([lowest, highest]))
    return _styled(figure)


def key(chart: Chart) -> list[tuple[str, str, str]]:
    """Colour, sign and name of everything that is drawn."""
    methods = {point.method for point in chart.points}
    marks = [(look[0], SIGNS[method], method) for method, look in LOOKS.items() if method in methods]
    return [*marks, (FRONT, "\u2514", FRONT_NAME), (BAND, "\u25ac", BAND_NAME)]


def _band(figure: go.Figure, ends: list[float], lowest: float, uncertainty: float) -> None:
    """Errors within which nobody can tell what is nearer."""
    left, right = ends
    figure.add_scatter(
        x=_rounded([left, right, right, left]),
        y=_rounded([lowest, lowest, uncertainty, uncertainty]),
        name=BAND_NAME,
        mode="lines",
        line={"width": 0},
        fill="toself",
        fillcolor=BAND,
        hoverinfo="skip",
    )


def _points(
    figure: go.Figure,
    quantity: Charted,
    points: list[tuple[Point, float]],
    panel: str,
    scale: tuple[float, float],
    marker: dict[str, Any],
) -> None:
    """All configurations of one method; scale: factor of errors, and the least that is drawn."""
    factor, least = scale
    method = points[0][0].method
    levels = [_level(point) for point, _ in points]
    spread = None
    if panel == "seconds":
        spread = {
            "array": _rounded([max(point.seconds) - point.median for point, _ in points]),
            "arrayminus": _rounded([point.median - min(point.seconds) for point, _ in points]),
            "thickness": 1,
            "width": 2,
        }
    filled = not str(marker["symbol"]).endswith("-open")
    figure.add_scatter(
        x=_rounded([COSTS[panel](point) for point, _ in points]),
        y=_rounded([factor * max(error, least) for _, error in points]),
        error_x=spread,
        name=method,
        mode="markers+text" if any(levels) else "markers",
        text=levels,
        textfont={"size": 10, "color": "#FFFFFF" if filled else marker["color"]},
        textposition="middle center",
        marker=marker,
        hovertext=[
            f"{told(point)}: {error_text(quantity, error)} in {seconds_text(point)}, {point.unknowns} unknowns"
            for point, error in points
        ],
        hoverinfo="text",
    )


def _level(point: Point) -> str:
    """The number of a rod model's level."""
    found = re.match(r"h(\d+),", point.label)
    return found.group(1) if found and point.method in (ROD_OWN, ROD_GRADED) else ""


def _decades(ends: list[float]) -> list[float]:
    return [math.log10(end) for end in ends]


def _rounded(values: list[float]) -> list[float]:
    return [float(f"{value:.5g}") for value in values]


def _styled(figure: go.Figure) -> go.Figure:
    figure.update_layout(**LOOK, height=HEIGHT, margin={"l": 64, "r": 12, "t": 10, "b": 50}, showlegend=False)
    logarithmic = {**AXIS, "type": "log", "dtick": 1, "zeroline": False, "tickformat": "~g"}
    figure.update_xaxes(**logarithmic, **TICKS)
    figure.update_yaxes(**logarithmic, automargin=True)
    return figure
