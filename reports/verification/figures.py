"""Errors of a group's checks against the level or step, on a logarithmic scale."""

from __future__ import annotations

from collections.abc import Sequence

import plotly.graph_objects as go

from reports.figures import FONT, GRID, INK
from reports.verification.check import Outcome

# M. Okabe, K. Ito (2008), without the yellow that paper does not show; repeated with other markers and dashes
COLOURS = ("#0072B2", "#D55E00", "#007A5A", "#CC79A7", "#56B4E9", "#B07800", "#1F2933")
MARKERS = ("circle", "square", "diamond", "triangle-up", "x", "star", "cross", "triangle-down")
DASHES = ("solid", "dash", "dot")
# Nothing below round-off is drawn as if it meant something.
FLOOR = 1e-15


def error_figure(outcomes: Sequence[Outcome]) -> go.Figure:
    """Size of the relative error against the level or step; a short bar marks each tolerance at its level."""
    figure = go.Figure()
    steps = outcomes[0].check.steps
    for index, outcome in enumerate(outcomes):
        check, colour = outcome.check, COLOURS[index % len(COLOURS)]
        figure.add_scatter(
            x=list(check.levels),
            y=[float(f"{max(abs(error), FLOOR):.4g}") for error in outcome.errors],
            name=check.name,
            legendgroup=check.name,
            mode="lines+markers",
            line={"color": colour, "width": 1.8, "dash": DASHES[index // len(COLOURS)]},
            marker={"symbol": MARKERS[index % len(MARKERS)], "size": 7},
            text=[steps.name(level) for level in check.levels],
            hovertemplate="%{text}: %{y:.2e}",
        )
        figure.add_scatter(
            x=[check.at_level],
            y=[check.tolerance],
            name=f"tolerance, {check.name}",
            legendgroup=check.name,
            showlegend=False,
            mode="markers",
            marker={"symbol": "line-ew", "size": 20, "line": {"color": colour, "width": 2.5}},
            text=[steps.name(check.at_level)],
            hovertemplate="tolerance at %{text}: %{y:.2e}",
        )
    figure.update_layout(
        template="none",
        height=max(380, 150 + 22 * len(outcomes)),
        autosize=True,
        margin={"l": 72, "r": 12, "t": 16, "b": 52},
        paper_bgcolor="rgba(0,0,0,0)",
        plot_bgcolor="rgba(0,0,0,0)",
        font={"family": FONT, "size": 13, "color": INK},
        legend={"x": 1.02, "xanchor": "left", "y": 1.0, "yanchor": "top", "tracegroupgap": 0},
        hovermode="closest",
    )
    levels = sorted({level for outcome in outcomes for level in outcome.check.levels})
    ticks = {"tickvals": levels, "ticktext": [steps.name(level) for level in levels]}
    axis = {"gridcolor": GRID, "zeroline": False, "linecolor": "#9AA5B1", "showline": True}
    figure.update_xaxes(title_text=steps.title, range=[levels[0] - 0.3, levels[-1] + 0.3], **ticks, **axis)
    figure.update_yaxes(
        title_text="relative error", type="log", exponentformat="power", dtick=2, automargin=True, **axis
    )
    return figure
