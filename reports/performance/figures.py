"""Cost against the number of elements on logarithmic scales, and error against seconds."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go

from reports.figures import AXIS, LOOK, REFERENCE, ROD
from reports.performance.levels import LevelStudy
from reports.performance.scaling import BoolArray, PowerLaw, Series
from reports.performance.wording import count, kind
from reports.solution import Array

HEIGHT = 400
# Elements of equal length, of unequal length; as in the other figures also told apart without colour
_LOOKS = {True: {"color": ROD, "symbol": "circle"}, False: {"color": REFERENCE, "symbol": "square"}}
# Errors below this are not drawn as if they meant something.
FLOOR = 1e-7
_ORDER_LOOKS = (("#0072B2", "circle", "solid"), ("#D55E00", "square", "dash"), ("#007A5A", "diamond", "dot"))


def seconds_figure(series: tuple[Series, ...]) -> go.Figure:
    """Median seconds of a solve with their quartiles, and the fitted lines."""
    figure = go.Figure()
    for one in series:
        quartiles = np.array([size.timing.quartiles for size in one.sizes])
        spread = {
            "array": _rounded(quartiles[:, 1] - one.seconds),
            "arrayminus": _rounded(one.seconds - quartiles[:, 0]),
            "thickness": 1,
            "width": 3,
        }
        all_sizes = np.full(len(one.sizes), fill_value=True)
        _curve(figure, one, one.seconds, all_sizes, one.time_law, "%{x} elements: %{y:.3g} s", error_y=spread)
    return _styled(figure, "seconds")


def memory_figure(series: tuple[Series, ...]) -> go.Figure:
    """Growth of the process that solves, where it can be told, and the fitted lines."""
    figure = go.Figure()
    for one in series:
        _curve(figure, one, one.growth, one.resolved, one.memory_law, "%{x} elements: %{y:.3g} MB")
    return _styled(figure, "MB")


def relative_figure(series: tuple[Series, ...]) -> go.Figure:
    """Cost of one element relative to that in the largest rod: seconds filled, memory open."""
    figure = go.Figure()
    for one in series:
        look = _LOOKS[one.equal]
        every = np.full(len(one.sizes), fill_value=True)
        for what, costs, drawn, mark, dash in (
            ("seconds", one.seconds, every, "", "solid"),
            ("memory", one.growth, one.resolved, "-open", "dot"),
        ):
            figure.add_scatter(
                x=one.elements[drawn].tolist(),
                y=_rounded(one.relative(costs)[drawn]),
                name=f"{what}, {kind(one)}",
                mode="lines+markers",
                line={"color": look["color"], "width": 1.6, "dash": dash},
                marker={"symbol": f"{look['symbol']}{mark}", "size": 8, "color": look["color"]},
                hovertemplate="%{x} elements: %{y:.3g}",
            )
    _styled(figure, "relative to linear")
    figure.update_yaxes(dtick=None, tickvals=[0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50], exponentformat="none")
    return figure


def levels_figure(study: LevelStudy) -> go.Figure:
    """Size of the error of the contact force against seconds, a curve for each order, a point for each level."""
    figure = go.Figure()
    orders = sorted({setting.order for setting in study.settings})
    for order, (colour, symbol, dash) in zip(orders, _ORDER_LOOKS, strict=False):
        drawn = [s for s in study.settings if s.order == order and s is not study.finest]
        figure.add_scatter(
            x=_rounded(np.array([1e3 * setting.timing.median for setting in drawn])),
            y=_rounded(np.array([100.0 * max(abs(study.error(setting)), FLOOR) for setting in drawn])),
            text=[f"h{setting.level}" for setting in drawn],
            name=f"p = {order}",
            mode="lines+markers+text",
            textposition="top center",
            textfont={"size": 11, "color": colour},
            line={"color": colour, "width": 1.4, "dash": dash},
            marker={"symbol": symbol, "size": 8},
            hovertemplate="%{text}: %{y:.2g} % in %{x:.3g} ms",
        )
    _styled(figure, "error of the contact force, %")
    figure.update_xaxes(
        title_text="ms", dtick=None, tickvals=[1, 2, 3, 5, 7, 10, 15, 20, 30, 50, 70, 100, 150, 200, 300, 500]
    )
    return figure


def _curve(
    figure: go.Figure, one: Series, costs: Array, drawn: BoolArray, law: PowerLaw | None, hover: str, **more: object
) -> None:
    """Costs of the sizes to be drawn, and the fitted line where it was fitted."""
    look = _LOOKS[one.equal]
    slope = "" if law is None else f": slope {law.slope:.2f} from {count(round(law.start))} on"
    figure.add_scatter(
        x=one.elements[drawn].tolist(),
        y=_rounded(costs[drawn]),
        name=f"{kind(one)}{slope}",
        mode="markers",
        marker={"symbol": look["symbol"], "size": 8, "color": look["color"]},
        hovertemplate=hover,
        **more,
    )
    if law is None:
        return
    ends = np.array([law.start, law.end])
    figure.add_scatter(
        x=ends.tolist(),
        y=_rounded(law.at(ends)),
        showlegend=False,
        mode="lines",
        line={"color": look["color"], "width": 1.6},
        hoverinfo="skip",
    )


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.4g}") for value in values]


def _styled(figure: go.Figure, unit: str) -> go.Figure:
    figure.update_layout(
        **LOOK,
        height=HEIGHT,
        margin={"l": 64, "r": 12, "t": 44, "b": 52},
        legend={"orientation": "h", "x": 0.0, "xanchor": "left", "y": 1.0, "yref": "container", "yanchor": "top"},
        separators=".\u202f",
    )
    axis = {**AXIS, "type": "log", "zeroline": False, "dtick": 1}
    figure.update_xaxes(title_text="elements", exponentformat="none", separatethousands=True, **axis)
    figure.update_yaxes(title_text=unit, exponentformat="none", automargin=True, **axis)
    return figure
