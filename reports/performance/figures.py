"""Cost against the number of elements on logarithmic scales, and error against seconds."""

from __future__ import annotations

import numpy as np
import plotly.graph_objects as go

from reports.figures import FONT, GRID, INK, REFERENCE, ROD
from reports.performance.levels import LevelStudy
from reports.performance.scaling import Series
from reports.performance.wording import kind
from reports.solution import Array

HEIGHT = 400
# Elements of equal length, of unequal length; as in the other figures also told apart without colour
_LOOKS = {True: {"color": ROD, "symbol": "circle"}, False: {"color": REFERENCE, "symbol": "square"}}
# Growth of the resident memory is known to about this, MB; less of it is not drawn.
RESOLUTION = 1.0
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
        _points(figure, one, one.seconds, kind(one), "%{x} elements: %{y:.3g} s", error_y=spread)
        _line(figure, one, one.seconds)
    return _styled(figure, "seconds")


def memory_figure(series: tuple[Series, ...]) -> go.Figure:
    """Memory held for a solve with the fitted lines, and the growth of the process where it can be told."""
    figure = go.Figure()
    for one in series:
        _points(figure, one, one.allocated, f"held, {kind(one)}", "%{x} elements: %{y:.3g} MB")
        _line(figure, one, one.allocated)
    for one in series:
        grown = one.growth > RESOLUTION
        look = _LOOKS[one.equal]
        figure.add_scatter(
            x=one.elements[grown].tolist(),
            y=_rounded(one.growth[grown]),
            name=f"growth of the process, {kind(one)}",
            mode="markers",
            marker={"symbol": f"{look['symbol']}-open", "size": 10, "color": look["color"], "line": {"width": 1.6}},
            hovertemplate="%{x} elements: %{y:.3g} MB",
        )
    return _styled(figure, "MB")


def relative_figure(series: tuple[Series, ...]) -> go.Figure:
    """Cost of one element relative to that in the largest rod: seconds filled, memory open."""
    figure = go.Figure()
    for one in series:
        look = _LOOKS[one.equal]
        for what, costs, mark, dash in (
            ("seconds", one.seconds, "", "solid"),
            ("memory", one.allocated, "-open", "dot"),
        ):
            figure.add_scatter(
                x=one.elements.tolist(),
                y=_rounded(one.relative(costs)),
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


def _points(figure: go.Figure, one: Series, costs: Array, name: str, hover: str, **more: object) -> None:
    look = _LOOKS[one.equal]
    slope = one.fit(costs).slope
    figure.add_scatter(
        x=one.elements.tolist(),
        y=_rounded(costs),
        name=f"{name}: slope {slope:.2f} from {one.fitted_from} on",
        mode="markers",
        marker={"symbol": look["symbol"], "size": 8, "color": look["color"]},
        hovertemplate=hover,
        **more,
    )


def _line(figure: go.Figure, one: Series, costs: Array) -> None:
    """The fitted line, where it was fitted."""
    ends = np.array([float(one.fitted_from), one.elements[-1]])
    figure.add_scatter(
        x=ends.tolist(),
        y=_rounded(one.fit(costs).at(ends)),
        showlegend=False,
        mode="lines",
        line={"color": _LOOKS[one.equal]["color"], "width": 1.6},
        hoverinfo="skip",
    )


def _rounded(values: Array) -> list[float]:
    return [float(f"{value:.4g}") for value in values]


def _styled(figure: go.Figure, unit: str) -> go.Figure:
    figure.update_layout(
        template="none",
        height=HEIGHT,
        autosize=True,
        margin={"l": 64, "r": 12, "t": 44, "b": 52},
        paper_bgcolor="rgba(0,0,0,0)",
        plot_bgcolor="rgba(0,0,0,0)",
        font={"family": FONT, "size": 13, "color": INK},
        legend={"orientation": "h", "x": 0.0, "xanchor": "left", "y": 1.0, "yref": "container", "yanchor": "top"},
        hovermode="closest",
        separators=".\u202f",
    )
    axis = {"type": "log", "gridcolor": GRID, "zeroline": False, "linecolor": "#9AA5B1", "showline": True, "dtick": 1}
    figure.update_xaxes(title_text="elements", exponentformat="none", separatethousands=True, **axis)
    figure.update_yaxes(title_text=unit, exponentformat="none", automargin=True, **axis)
    return figure
