"""A picture of the levels and orders chosen along the rods, with the energy that decided on them."""

from __future__ import annotations

from pathlib import Path

import plotly.graph_objects as go
from plotly.subplots import make_subplots

from reports.choice import ChosenElement, chosen_elements
from reports.figures import REFERENCE, ROD, styled
from reports.store import write_whole
from rodmodel.adaptive import AdaptiveSolution

PRESSED = "rgba(213, 94, 0, 0.12)"


def levels_figure(found: AdaptiveSolution) -> go.Figure:
    """Level and order of every element along each rod; elements that contact presses on are shaded."""
    rods = chosen_elements(found)
    figure = make_subplots(len(rods), 1, subplot_titles=list(rods), vertical_spacing=0.28 / len(rods))
    for row, elements in enumerate(rods.values(), start=1):
        borders = [elements[0].start, *(each.end for each in elements)]
        for name, colour, dash, values in (
            ("level", ROD, "solid", [each.level for each in elements]),
            ("order", REFERENCE, "4px,3px", [each.order for each in elements]),
        ):
            figure.add_scatter(
                x=borders,
                y=[*values, values[-1]],
                mode="lines",
                line={"shape": "hv", "color": colour, "dash": dash, "width": 2.2},
                name=name,
                legendgroup=name,
                showlegend=row == 1,
                text=[*map(_hover, elements), _hover(elements[-1])],
                hovertemplate="%{text}<extra></extra>",
                row=row,
                col=1,
            )
        for each in elements:
            if each.pressed:
                figure.add_vrect(
                    x0=each.start, x1=each.end, fillcolor=PRESSED, line_width=0, layer="below", row=row, col=1
                )
        figure.update_yaxes(range=[0, 10.5], dtick=2, row=row, col=1)
    shade = {"color": PRESSED, "size": 14, "symbol": "square"}
    figure.add_scatter(x=[None], y=[None], mode="markers", marker=shade, name="contact presses on it or beside it")
    figure.update_xaxes(title_text="arc length, mm", row=len(rods), col=1)
    return styled(figure, 110 + 190 * len(rods))


def _hover(element: ChosenElement) -> str:
    where = f"{element.start:.4g} to {element.end:.4g} mm: h{element.level}, p = {element.order}"
    return f"{where}<br>{element.reason.replace('; ', '<br>').replace(', orders', '<br>orders')}"


def write_levels(found: AdaptiveSolution, path: Path) -> Path:
    """Write the picture as a page of its own that needs no network.

    Raises
    ------
    OSError
        if it cannot be written.
    """
    write_whole(path, levels_figure(found).to_html(include_plotlyjs=True, full_html=True))
    return path
