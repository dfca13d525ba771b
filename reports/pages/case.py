"""The page of a case: verdicts, curves, deformed rods, other solvers, cost, history, the scene."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import plotly.graph_objects as go

from cases.scene import ContactPair
from reports.chart.page import chart_part
from reports.comparison import Comparison
from reports.figures import deflection_figure, moment_figure, pressure_figure
from reports.formatting import (
    MODEL_NAMES,
    capital,
    count,
    gap,
    measure,
    opposite,
    rod_model,
    seconds,
    title,
    values_with_unit,
)
from reports.html import PLOTLY_FILE, rendered
from reports.pages.turning import turning_part
from reports.peers_table import peers_table
from reports.runner import ROD_REPEATS, CaseRun, Failure, Run
from reports.section_table import section_table
from reports.sketch import scene_sketch
from reports.truth import independent_values

DEFLECTION_CAPTION = "Below: difference from the 3D of this run on its finest mesh, in micrometres."
ALONE_CAPTION = "There is no 3D of this run to draw differences from."
PRESSURE_CAPTION = (
    "At an edge inside the zone the pressure falls like the square root of the distance; at the corner of a bar "
    "it is singular, and no mesh gives its value there."
)
MOMENT_CAPTION = (
    "Above: from equilibrium of loads and contact forces. Below: how far the moment of the computed stress is from "
    "it, a check of each model on itself; it is largest at clamps, whose corners are singular."
)


@dataclass(frozen=True)
class DrawnPicture:
    """A PNG picture ready for the page, or, with no data, why there is none."""

    data: str
    width: int
    height: int
    magnification: str
    problem: str


def case_page(
    run: CaseRun | Failure,
    picture: DrawnPicture | None,
    site: Sequence[tuple[str, str]],
    neighbours: Sequence[tuple[str, str, str]] = (),
    history: dict[str, Any] | None = None,
) -> str:
    """The page as HTML.

    Parameters
    ----------
    picture : of a case that was run
    site : addresses and names of the report's other pages
    neighbours : address, title and 'prev' or 'next' of the cases before and after this one
    history : of `history_part`; None where there is none
    """
    content: dict[str, Any]
    figures: dict[str, go.Figure] = {}
    if isinstance(run, Failure):
        content = {"failure": run.reason, "warnings": [], "sketch": "", "sections": None}
    else:
        assert picture is not None  # as it was run
        content, figures = _answered(run, picture)
    content |= {
        "name": run.case.name,
        "title": run.case.title,
        "description": run.case.description,
        "neighbours": neighbours,
        "text": run.case.text,
        "history": history,
    }
    content["contents"] = _contents(content)
    up = f"../{PLOTLY_FILE}"
    return rendered("pages/case.html.jinja", figures, up, case=content, repeats=ROD_REPEATS, site=site, here="")


def _contents(content: dict[str, Any]) -> list[tuple[str, str]]:
    """Anchors and names of what stands on the page."""
    answered = [
        ("verdicts", "Verdicts"),
        ("curves", "Curves"),
        ("deformed", "Deformed rods"),
        ("solvers", "Other solvers"),
        ("cost", "Cost"),
    ]
    history = [("history", "History")] if content["history"] else []
    return [*([] if content["failure"] else answered), *history, ("scene", "The scene")]


def _answered(run: CaseRun, picture: DrawnPicture) -> tuple[dict[str, Any], dict[str, go.Figure]]:
    """What the template needs to know of a case that was run, and its figures by the id of their place."""
    case = run.case
    figures, places = _figures(run)
    chart, panels = (None, {}) if run.chart is None else chart_part(run.chart, "case")
    counts: dict[str, int] = dict.fromkeys(("pass", "fail", "not resolved"), 0)
    counts.update(Counter(comparison.verdict for comparison in run.comparisons))
    warnings = [f"The 3D reference cannot treat this case. {run.refusal}"] if run.refusal else []
    warnings += [
        f"{solver} did not converge: {answer.quantities.outcome}"
        for solver, answer in _solvers(run)
        if not answer.quantities.converged
    ]
    content = {
        "counts": counts,
        "failure": "",
        "warnings": warnings,
        "sketch": scene_sketch(case.scene, run.rod.quantities),
        "sketch_caption": _sketch_caption(case.scene.contacts),
        "rod_model": _rod_model(run),
        "published": [_row(found) for found in run.comparisons if found.kind == "published"],
        "numbers": f"../results/{case.name}-rod.json",
        "figures": places,
        "picture": picture if picture.data else None,
        "no_picture": picture.problem,
        "turning": turning_part(run),
        "checks": _check_groups(run.comparisons),
        "sections": section_table(case.scene.rods),
        "peers": peers_table(run),
        "chart": chart,
        "costs": [_cost_row(solver, answer) for solver, answer in _solvers(run)],
    }
    return content, figures | panels


def _figures(run: CaseRun) -> tuple[dict[str, go.Figure], list[dict[str, Any]]]:
    """The curves by the id of their place, and what stands around them."""
    case = run.case
    truth = None if case.independent is None else independent_values(case.independent, case.scene)
    deflection = ALONE_CAPTION if run.refusal else DEFLECTION_CAPTION
    drawn = [
        ("Deflection of the centre lines", deflection, deflection_figure(run, truth)),
        *(
            (f"Contact pressure, {pair.name}", PRESSURE_CAPTION, pressure_figure(run, pair.name, truth))
            for pair in case.scene.contacts
        ),
        ("Bending moment", MOMENT_CAPTION, moment_figure(run)),
    ]
    figures, places = {}, []
    models = "rod model" if run.refusal else "rod model and 3D"
    for number, (heading, caption, figure) in enumerate(drawn, start=1):
        place = f"figure-{number}"
        figures[place] = figure
        alt = f"{heading} of {case.title}, {models}; the numbers are in the results beside the page."
        height = figure.layout.height
        places.append({"anchor": place, "title": heading, "caption": caption, "alt": alt, "height": height})
    return figures, places


def _sketch_caption(contacts: Sequence[ContactPair]) -> str:
    pairs = []
    for pair in contacts:
        second, penalty = opposite(pair.second), f", penalty {pair.penalty:g} N/mm³" if pair.penalty else ""
        faces = f"{pair.first.face} face of {pair.first.rod} and {second}"
        pairs.append(f"{pair.name}: {faces} may touch in the marked zone, gap {gap(pair.gap)}{penalty}")
    return "The scene from the side. " + "; ".join(pairs) + ("." if pairs else "")


def _solvers(run: CaseRun) -> list[tuple[str, Run]]:
    meshes = [(f"3D, mesh {index} of {len(run.references)}", answer) for index, answer in enumerate(run.references, 1)]
    return [(_rod_model(run), run.rod), *meshes]


def _rod_model(run: CaseRun) -> str:
    return capital(rod_model(run.rod.level, run.rod.order))


def _row(found: Comparison) -> dict[str, str]:
    certain = found.kind == "published"
    return {
        "quantity": found.quantity,
        "title": title(found),
        "value": values_with_unit(found.quantity, found.value),
        "reference": values_with_unit(found.quantity, found.reference),
        "difference": measure(found.quantity, found.difference),
        "uncertainty": "as printed" if certain else measure(found.quantity, found.uncertainty),
        "tolerance": measure(found.quantity, found.tolerance),
        "verdict": found.verdict,
        "reason": found.reason,
        "source": found.source,
    }


def _check_groups(comparisons: Sequence[Comparison]) -> list[dict[str, Any]]:
    """Rows under a heading for each model and what it is held against; published values have their own table."""
    headings = dict.fromkeys(
        (found.model, found.kind, found.source) for found in comparisons if found.kind != "published"
    )
    groups = []
    for model, kind, source in headings:
        rows = [
            _row(found) for found in comparisons if (found.model, found.kind, found.source) == (model, kind, source)
        ]
        groups.append({"title": f"{capital(MODEL_NAMES[model])} against {source}", "rows": rows})
    return groups


def _cost_row(solver: str, answer: Run) -> dict[str, str]:
    quantities = answer.quantities
    return {
        "solver": solver,
        "unknowns": count(quantities.unknowns),
        "setup": seconds(quantities.setup_seconds),
        "solve": seconds(quantities.solve_seconds),
        "total": seconds(answer.total_seconds),
        "contact_solutions": f"{quantities.contact_solutions} ({quantities.active_sets})",
        "edges": f"{max((contact.edges_resolution for contact in quantities.contacts), default=0.0):.2g} mm",
        "memory": f"{answer.peak_memory:.0f} MB",
        "residual": f"{quantities.equilibrium_residual:.1e}",
        "penetration": f"{max((contact.penetration for contact in quantities.contacts), default=0.0):.1e} mm",
        "complementarity": f"{max((each.complementarity_residual for each in quantities.contacts), default=0.0):.1e}",
        "contact_work": f"{sum(contact.work for contact in quantities.contacts):.1e} N mm",
        "outcome": quantities.outcome + answer.origin,
    }
