"""Pictures of sweeps: ours in solid lines with filled marks, plain alternatives dashed with open ones."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import plotly.graph_objects as go

from reports.figures import AXIS, LOOK, TICKS
from reports.stability.sweep import Curve, Picture, Sweep

HEIGHT = 340
# Zero has no place on a logarithmic axis and is drawn here.
ZERO = 1e-17
_OURS = (
    ("#0072B2", "circle"),
    ("#007A5A", "square"),
    ("#5B3A8E", "diamond"),
    ("#1F2933", "triangle-up"),
    ("#3A9BD9", "triangle-down"),
)
_PLAIN = (("#D55E00", "circle"), ("#B0307A", "square"), ("#9A6A00", "diamond"), ("#A3271B", "triangle-up"))


@dataclass(frozen=True)
class Look:
    """How a method is drawn."""

    colour: str
    symbol: str
    ours: bool


def looks(sweep: Sweep, methods: Iterable[str]) -> dict[str, Look]:
    """Look of each method by name, the same in all pictures of a sweep."""
    chosen = {}
    for kind, palette in ((True, _OURS), (False, _PLAIN)):
        names = [method.name for method in sweep.methods if method.ours == kind]
        for number, name in enumerate(names):
            chosen[name] = Look(*palette[number % len(palette)], kind)
    return {name: chosen[name] for name in methods}


def figure(sweep: Sweep, picture: Picture, curves: Mapping[str, Curve]) -> go.Figure:
    """One picture; its key stands beside it on the page."""
    drawn = go.Figure()
    for name, look in looks(sweep, curves).items():
        curve = curves[name]
        drawn.add_scatter(
            x=[_rounded(value) for value in curve.x],
            y=[_placed(value, picture.log_y) for value in curve.y],
            text=["0" if value == 0.0 else f"{value:.2g}" for value in curve.y],
            name=name,
            mode="lines+markers" if len(curve.x) <= 40 else "lines",
            line={
                "color": look.colour,
                "width": 2.0 if look.ours else 1.6,
                "dash": "solid" if look.ours else "5px,3px",
            },
            marker={"symbol": look.symbol if look.ours else f"{look.symbol}-open", "size": 7, "color": look.colour},
            hovertemplate="%{x}: %{text}",
        )
    drawn.update_layout(
        **LOOK,
        height=HEIGHT,
        margin={"l": 60, "r": 12, "t": 10, "b": 46},
        showlegend=False,
        separators=".\u202f",
    )
    axis = {**AXIS, **TICKS, "zeroline": False, "ticklen": 4}
    drawn.update_xaxes(title_text=picture.x, **axis)
    drawn.update_yaxes(title_text=picture.y, automargin=True, **axis)
    if picture.log_x:
        drawn.update_xaxes(**_logarithmic(value for curve in curves.values() for value in curve.x))
    if picture.log_y:
        drawn.update_yaxes(**_logarithmic(_placed(value, True) for curve in curves.values() for value in curve.y))
    if picture.ticks:
        drawn.update_xaxes(tickvals=list(range(1, len(picture.ticks) + 1)), ticktext=list(picture.ticks))
    return drawn


def _logarithmic(values: Iterable[float | None]) -> dict[str, object]:
    """An axis of powers of ten, not too many of them."""
    sizes = [math.log10(value) for value in values if value is not None and value > 0.0]
    span = max(sizes) - min(sizes) if sizes else 1.0
    step: float | str = "D2" if span < 1.5 else float(math.ceil(span / 7.0))
    return {"type": "log", "exponentformat": "power", "dtick": step, "minexponent": 4}


def _placed(value: float, logarithmic: bool) -> float | None:
    if math.isnan(value):
        return None
    return _rounded(ZERO if logarithmic and value <= 0.0 else value)


def _rounded(value: float) -> float:
    return float(f"{value:.5g}")
