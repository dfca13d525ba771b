"""The page's curves as plotly figures: deflection, contact pressure and bending moment, both models in one picture.

Colours are of the palette of M. Okabe and K. Ito (2008), which colour-blind readers can tell apart; models also differ
in line style, so that a black and white print stays readable.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import plotly.graph_objects as go
from plotly.subplots import make_subplots

from reports.geometry import AXES
from reports.quantities import ContactQuantities, PressureProfile, RodQuantities
from reports.runner import CaseRun, Run
from reports.solution import Array
from reports.truth import IndependentValues

ROD, REFERENCE, TRUTH, PUBLISHED = "#0072B2", "#D55E00", "#1F2933", "#007A5A"
GRID, INK = "#E3E8EE", "#1F2933"
FONT = "system-ui, -apple-system, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"
# What all figures of the pages have in common, and all axes.
LOOK = {
    "template": "none",
    "autosize": True,
    "paper_bgcolor": "rgba(0,0,0,0)",
    "plot_bgcolor": "rgba(0,0,0,0)",
    "font": {"family": FONT, "size": 13, "color": INK},
    "hovermode": "closest",
}
AXIS = {"gridcolor": GRID, "linecolor": "#9AA5B1", "showline": True}
TICKS = {"ticks": "outside", "tickcolor": "#9AA5B1"}
ROD_NAME, REFERENCE_NAME, TRUTH_NAME = "rod model", "3D of this run", "independent 3D"

_LINES = {
    ROD_NAME: {"color": ROD, "width": 2.2},
    REFERENCE_NAME: {"color": REFERENCE, "width": 2.2, "dash": "6px,4px"},
}
_POINTS = {"symbol": "circle-open", "size": 6, "color": TRUTH, "line": {"width": 1.2}}


def deflection_figure(run: CaseRun, truth: IndependentValues | None) -> go.Figure:
    """Transverse deflection of every rod and, where there is a 3D reference, how far the others are from it below."""
    rods, rows = run.case.scene.rods, 2 if run.references else 1
    figure = _panels([rod.name for rod in rods], rows)
    for column, rod in enumerate(rods, start=1):
        curves = [(name, answer.quantities.rod(rod.name)) for name, answer in _answers(run)]
        reference = curves[-1][1]
        component = int(np.argmax(np.abs(reference.displacement).max(axis=1)))
        axis, x = _along(reference)
        first = column == 1
        for name, found in curves:
            _add_line(figure, name, x, found.displacement[component], 1, column, legend=first)
        for name, found in curves[:-1]:
            difference = 1000.0 * (found.displacement - reference.displacement)[component]
            _add_line(figure, name, x, difference, 2, column, legend=False)
        if truth is not None and rod.name in truth.stations and component == 1:
            at = np.searchsorted(reference.station, truth.stations[rod.name] - 1e-6 * rod.length)
            values = truth.estimates["deflection", rod.name].value
            _add_points(figure, x[at], values, 1, column, legend=first)
            if rows == 2:
                apart = 1000.0 * (values - reference.displacement[component, at])
                _add_points(figure, x[at], apart, 2, column, legend=False)
        figure.update_yaxes(title_text=f"u<sub>{AXES[component]}</sub>, mm", row=1, col=column)
        if rows == 2:
            figure.update_yaxes(title_text="difference, µm", row=2, col=column)
        figure.update_xaxes(title_text=f"{axis}, mm", row=rows, col=column)
    return styled(figure, 460)


def pressure_figure(run: CaseRun, pair: str, truth: IndependentValues | None) -> go.Figure:
    """Contact pressure in the middle of the width, its mean and at the outer border, where there is contact.

    Dotted upright lines are published edges.
    """
    curves = [(name, answer.quantities.contact(pair)) for name, answer in _answers(run)]
    independent = None if truth is None else truth.pressure.get(pair)
    titles = ("middle of the width", "mean over the width", "outer border")
    figure = _panels(titles, rows=1, shared_y=True)
    for column, part in enumerate(("middle", "mean", "outer"), start=1):
        first = column == 1
        for name, found in curves:
            _add_line(figure, name, *_to_the_edges(found, part), 1, column, legend=first)
        if independent is not None:
            positions, values = _thinned(independent, part)
            _add_points(figure, positions, values, 1, column, legend=first)
        figure.update_xaxes(title_text=f"{AXES[curves[0][1].axis]}, mm", row=1, col=column)
    published = [
        edge
        for entry in run.case.published
        if entry.quantity == "contact_edges" and entry.of == pair
        for edge in entry.value
    ]
    for edge in published:
        figure.add_vline(edge, line={"color": PUBLISHED, "width": 1.6, "dash": "dot"}, row=1, col=1)
    if published:
        figure.add_scatter(
            x=[None],
            y=[None],
            name="published edge",
            mode="lines",
            line={"color": PUBLISHED, "width": 1.6, "dash": "dot"},
        )
    edges = [edge for _, found in curves for stretch in found.edges_outer for edge in stretch]
    if edges:
        margin = 0.15 * (max(edges) - min(edges)) + 1.0
        figure.update_xaxes(range=[min(edges) - margin, max(edges) + margin])
    figure.update_yaxes(rangemode="tozero")
    figure.update_yaxes(title_text="p<sub>n</sub>, MPa", row=1, col=1)
    return styled(figure, 360)


def moment_figure(run: CaseRun) -> go.Figure:
    """Bending moment of every rod from equilibrium and, below, how far the moment from stress is from it.

    Of M1 and M2 it is the one that is larger in the rod.
    """
    rods = run.case.scene.rods
    figure = _panels([rod.name for rod in rods], rows=2)
    for column, rod in enumerate(rods, start=1):
        largest = np.abs(run.rod.quantities.rod(rod.name).equilibrium[3:5]).max(axis=1)
        row = 4 if largest[1] > largest[0] else 3
        for name, answer in _answers(run):
            found = answer.quantities.rod(rod.name)
            moment = found.equilibrium[row] / 1000.0
            axis, x = _along(found)
            _add_line(figure, name, x, moment, 1, column, legend=column == 1)
            _add_line(figure, name, x, found.stress[row] / 1000.0 - moment, 2, column, legend=False)
        figure.update_yaxes(title_text=f"M<sub>{row - 2}</sub>, kN mm", row=1, col=column)
        figure.update_yaxes(title_text="difference, kN mm", row=2, col=column)
        figure.update_xaxes(title_text=f"{axis}, mm", row=2, col=column)
        margin = 0.03 * rod.length
        figure.update_xaxes(range=[x.min() - margin, x.max() + margin], col=column)
    return styled(figure, 460)


def _answers(run: CaseRun) -> list[tuple[str, Run]]:
    """The rod model's answer and, if there is one, that of the 3D reference on its finest mesh."""
    return [(ROD_NAME, run.rod), *((REFERENCE_NAME, finest) for finest in run.references[-1:])]


def _along(found: RodQuantities) -> tuple[str, Array]:
    """Abscissa of a rod's curves: the global axis it follows most nearly, or the arc length s of a curved rod, mm."""
    chord = found.position[:, -1] - found.position[:, 0]
    if np.linalg.norm(chord) < (1.0 - 1e-9) * found.station[-1]:
        return "s", found.station
    axis = int(np.argmax(np.abs(chord)))
    return AXES[axis], found.position[axis]


def _to_the_edges(contact: ContactQuantities, part: str) -> tuple[Array, Array]:
    """Pressure along the zone with a zero at each edge that lies between stations, mm and MPa."""
    pressure = contact.pressure
    stretches = contact.edges if part == "middle" else contact.edges_outer
    inside = [
        edge for stretch in stretches for edge in stretch if pressure.position.min() < edge < pressure.position.max()
    ]
    x = np.concatenate([pressure.position, inside])
    y = np.concatenate([getattr(pressure, part), np.zeros(len(inside))])
    order = np.argsort(x, kind="stable")
    return x[order], y[order]


def _thinned(profile: PressureProfile, part: str, most: int = 70) -> tuple[Array, Array]:
    """Points of a profile where there is contact, at most so many, and the first open ones beside them."""
    values: Array = getattr(profile, part)
    near = np.flatnonzero(np.convolve(values > 0.0, np.ones(3), mode="same") > 0)
    chosen = near[:: max(1, -(-len(near) // most))]
    return profile.position[chosen], values[chosen]


def _panels(titles: Sequence[str], rows: int, *, shared_y: bool = False) -> go.Figure:
    figure: go.Figure = make_subplots(
        rows=rows,
        cols=len(titles),
        subplot_titles=list(titles),
        row_heights=[0.6, 0.4] if rows == 2 else [1.0],
        shared_xaxes=True,
        shared_yaxes=shared_y,
        horizontal_spacing=0.035 if shared_y else 0.09,
        vertical_spacing=0.07,
    )
    return figure


def _add_line(figure: go.Figure, name: str, x: Array, y: Array, row: int, column: int, *, legend: bool) -> None:
    _add(figure, name, x, y, row, column, legend, mode="lines", line=_LINES[name])


def _add_points(figure: go.Figure, x: Array, y: Array, row: int, column: int, *, legend: bool) -> None:
    _add(figure, TRUTH_NAME, x, y, row, column, legend, mode="markers", marker=_POINTS)


def _add(figure: go.Figure, name: str, x: Array, y: Array, row: int, column: int, legend: bool, **look: object) -> None:
    figure.add_scatter(
        x=_rounded(x),
        y=_rounded(y),
        name=name,
        legendgroup=name,
        showlegend=legend,
        hovertemplate="%{y:.5g} at %{x:.2f} mm",
        row=row,
        col=column,
        **look,
    )


def _rounded(values: Array) -> list[float]:
    """Seven significant digits are more than a figure shows, and half the page."""
    return [float(f"{value:.7g}") for value in values]


def styled(figure: go.Figure, height: int) -> go.Figure:
    """The figure in the pages' look."""
    figure.update_layout(
        **LOOK,
        height=height,
        margin={"l": 64, "r": 12, "t": 60, "b": 56},
        legend={"orientation": "h", "x": 0.0, "xanchor": "left", "y": 1.0, "yref": "container", "yanchor": "top"},
    )
    figure.update_annotations(font={"size": 14, "color": INK})
    figure.update_xaxes(**AXIS, **TICKS, zeroline=False)
    figure.update_yaxes(**AXIS, zerolinecolor="#C3CCD6", zeroline=True, automargin=True)
    return figure
