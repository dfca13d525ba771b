"""The report: one self-contained HTML page, and the results as JSON beside it."""

from __future__ import annotations

import base64
import json
import math
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
import plotly.graph_objects as go

from cases.case import Quantity
from cases.scene import ContactPair
from reports.chart.page import chart_part, write_chart_numbers
from reports.comparison import Comparison
from reports.figures import deflection_figure, moment_figure, pressure_figure
from reports.formatting import (
    MODEL_NAMES,
    gap,
    grades,
    measure,
    number,
    opposite,
    seconds,
    stretches,
    title,
    values_with_unit,
)
from reports.html import rendered
from reports.peers import as_json
from reports.peers_table import peers_summary, peers_table
from reports.processes import ProcessFailed, Progress, in_own_process
from reports.quantities import DEFINITIONS
from reports.result import result
from reports.runner import ROD_REPEATS, CaseRun, Failure, Run
from reports.section_table import section_table
from reports.sketch import scene_sketch
from reports.store import write_whole
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
# Pages that may stand beside the report, by file name: what they are called and what they say.
PAGES = {
    "verification.html": (
        "Verification",
        "both models against closed forms and published benchmarks, and the rod model against 3D, level by level.",
    ),
    "performance.html": (
        "Performance",
        "what the rod model costs, against the number of elements, part by part, and by level and order.",
    ),
    "stability.html": (
        "Stability",
        "every method driven to where it fails, the rod model and plain alternatives side by side.",
    ),
}


@dataclass(frozen=True)
class DrawnPicture:
    """A PNG picture ready for the page, or, with no data, why there is none."""

    data: str
    width: int
    height: int
    magnification: str
    problem: str


def write_report(
    runs: Sequence[CaseRun | Failure], output: Path, pages: Sequence[str] = (), moved: Sequence[str] | None = None
) -> Path:
    """Write `index.html` and `results/*.json` into the folder `output`; returns the page's path.

    Parameters
    ----------
    pages : file names of the pages beside it, those of `PAGES` that there are
    moved : what moved since earlier runs, a line each; None where nobody looked

    Raises
    ------
    OSError
        if the folder or a file cannot be written.
    """
    page = render(runs, pictures(runs), pages, moved)
    for run in runs:
        if isinstance(run, CaseRun):
            _write_results(run, output / "results")
    write_whole(output / "index.html", page)
    return output / "index.html"


def render(
    runs: Sequence[CaseRun | Failure],
    drawn: Mapping[str, DrawnPicture],
    pages: Sequence[str] = (),
    moved: Sequence[str] | None = None,
) -> str:
    """The page as HTML, with links to the pages beside it and, where it is known, what moved since earlier runs."""
    cases, figures = [], {}
    for index, run in enumerate(runs, start=1):
        anchor = f"case-{index}"
        if isinstance(run, Failure):
            cases.append(_failed_case(run, anchor))
            continue
        case, found = _case(run, anchor, drawn[run.case.name])
        cases.append(case)
        figures.update(found)
    return rendered(
        "page.html.jinja",
        figures,
        cases=cases,
        peers=peers_summary(runs),
        definitions=DEFINITIONS.values(),
        repeats=ROD_REPEATS,
        pages=[(page, *PAGES[page]) for page in pages],
        moved=moved,
    )


def pictures(runs: Sequence[CaseRun | Failure]) -> dict[str, DrawnPicture]:
    """3D pictures of the rod model's deformed bars by case name, drawn in a process of their own."""
    solved = [run for run in runs if isinstance(run, CaseRun)]
    try:
        return in_own_process(_draw_all, solved)
    except ProcessFailed as error:
        missing = DrawnPicture("", 0, 0, "", f"drawing failed, {error}")
        return {run.case.name: missing for run in solved}


def _draw_all(runs: Sequence[CaseRun], progress: Progress) -> dict[str, DrawnPicture]:
    from reports.picture import SIZE, draw

    drawn = {}
    for run in runs:
        progress(run.case.name)
        picture = draw(run.case.scene, run.rod.quantities)
        data = base64.b64encode(picture.png).decode("ascii")
        drawn[run.case.name] = DrawnPicture(data, *SIZE, f"{picture.magnification:g}", "")
    return drawn


def _failed_case(run: Failure, anchor: str) -> dict[str, Any]:
    return {
        "anchor": anchor,
        "name": run.case.name,
        "title": run.case.title,
        "description": run.case.description,
        "counts": {},
        "headline": [[]] * 5,
        "failure": run.reason,
        "sketch": "",
        "sketch_caption": "",
    }


def _case(run: CaseRun, anchor: str, picture: DrawnPicture) -> tuple[dict[str, Any], dict[str, go.Figure]]:
    """What the template needs to know of a case, and its figures by the id of their place."""
    case = run.case
    truth = None if case.independent is None else independent_values(case.independent, case.scene)
    drawn = [
        (
            "Deflection of the centre lines",
            ALONE_CAPTION if run.refusal else DEFLECTION_CAPTION,
            deflection_figure(run, truth),
        ),
        *(
            (
                f"Contact pressure, {pair.name}",
                PRESSURE_CAPTION,
                pressure_figure(run, pair.name, truth),
            )
            for pair in case.scene.contacts
        ),
        (
            "Bending moment",
            MOMENT_CAPTION,
            moment_figure(run),
        ),
    ]
    figures, places = {}, []
    for number_, (heading, caption, figure) in enumerate(drawn, start=1):
        place = f"{anchor}-figure-{number_}"
        figures[place] = figure
        models = "rod model" if run.refusal else "rod model and 3D"
        alt = f"{heading} of {case.title}, {models}; the numbers are in the results beside the page."
        height = figure.layout.height
        places.append({"anchor": place, "title": heading, "caption": caption, "alt": alt, "height": height})
    chart, panels = (None, {}) if run.chart is None else chart_part(run.chart, anchor)
    figures.update(panels)
    counts: dict[str, int] = dict.fromkeys(("pass", "fail", "not resolved"), 0)
    counts.update(Counter(comparison.verdict for comparison in run.comparisons))
    warnings = [f"The 3D reference cannot treat this case. {run.refusal}"] if run.refusal else []
    warnings += [
        f"{solver} did not converge: {answer.quantities.outcome}"
        for solver, answer in _solvers(run)
        if not answer.quantities.converged
    ]
    content = {
        "anchor": anchor,
        "name": case.name,
        "title": case.title,
        "description": case.description,
        "counts": counts,
        "headline": _headline(run),
        "failure": "",
        "warnings": warnings,
        "sketch": scene_sketch(case.scene, run.rod.quantities),
        "sketch_caption": _sketch_caption(case.scene.contacts),
        "level": grades(run.rod.level),
        "order": grades(run.rod.order),
        "published": [_row(found) for found in run.comparisons if found.kind == "published"],
        "figures": places,
        "picture": picture if picture.data else None,
        "no_picture": picture.problem,
        "checks": _check_groups(run.comparisons),
        "sections": section_table(case.scene.rods),
        "peers": peers_table(run),
        "chart": chart,
        "costs": [_cost_row(solver, answer) for solver, answer in _solvers(run)],
    }
    return content, figures


def _sketch_caption(contacts: Sequence[ContactPair]) -> str:
    pairs = []
    for pair in contacts:
        second, penalty = opposite(pair.second), f", penalty {pair.penalty:g} N/mm³" if pair.penalty else ""
        faces = f"{pair.first.face} face of {pair.first.rod} and {second}"
        pairs.append(f"{pair.name}: {faces} may touch in the marked zone, gap {gap(pair.gap)}{penalty}")
    return "The scene from the side. " + "; ".join(pairs) + ("." if pairs else "")


def _solvers(run: CaseRun) -> list[tuple[str, Run]]:
    rod = (f"Rod model h{grades(run.rod.level)}, p = {grades(run.rod.order)}", run.rod)
    meshes = [(f"3D, mesh {index} of {len(run.references)}", answer) for index, answer in enumerate(run.references, 1)]
    return [rod, *meshes]


def _headline(run: CaseRun) -> list[list[str]]:
    """Cells of the table of all cases: a line for the rod model and, if there is one, one for 3D.

    What the case compares has its uncertainty beside the value of the finest 3D mesh.
    """
    answers = (run.rod, *run.references[-1:])

    def largest(answer: Run) -> str:
        farthest = {
            found.rod: float(np.linalg.norm(found.displacement, axis=0).max()) for found in answer.quantities.rods
        }
        rod = max(farthest, key=lambda name: farthest[name])
        return number(farthest[rod], 5) + sure(answer, "deflection", rod)

    def sure(answer: Run, quantity: Quantity, of: str) -> str:
        known = [
            found.uncertainty
            for found in run.comparisons
            if (found.kind, found.quantity, found.of) == ("reference", quantity, of) and found.uncertainty is not None
        ]
        return f" ± {100.0 * known[0]:.1g} %" if known and answer.model == "reference" else ""

    return [
        [
            ", ".join(
                number(contact.force, 5) + sure(answer, "contact_force", contact.pair)
                for contact in answer.quantities.contacts
            )
            for answer in answers
        ],
        [
            "; ".join(stretches(np.ravel(contact.edges).tolist()) for contact in answer.quantities.contacts)
            for answer in answers
        ],
        [largest(answer) for answer in answers],
        [f"{answer.quantities.unknowns:,}".replace(",", " ") for answer in answers],
        [seconds(answer.total_seconds) for answer in answers],
    ]


def _row(found: Comparison) -> dict[str, str]:
    certain = found.kind == "published"
    return {
        "title": title(found),
        "definition": DEFINITIONS[found.quantity].text,
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
        name = MODEL_NAMES[model][0].upper() + MODEL_NAMES[model][1:]
        rows = [
            _row(found) for found in comparisons if (found.model, found.kind, found.source) == (model, kind, source)
        ]
        groups.append({"title": f"{name} against {source}", "rows": rows})
    return groups


def _cost_row(solver: str, answer: Run) -> dict[str, str]:
    quantities = answer.quantities
    return {
        "solver": solver,
        "unknowns": f"{quantities.unknowns:,}".replace(",", " "),
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


def _write_results(run: CaseRun, folder: Path) -> None:
    """Both models' result objects, the comparisons and what peers say, one JSON file each."""
    for answer in (run.rod, *run.references[-1:]):
        found = result(run.case.name, answer.model, answer.level, answer.order, answer.quantities, answer.total_seconds)
        write_whole(folder / f"{run.case.name}-{answer.model}.json", found.model_dump_json(indent=1) + "\n")
    comparisons = [
        {key: None if value == math.inf else value for key, value in asdict(found).items()} for found in run.comparisons
    ]
    text = json.dumps(comparisons, indent=1, allow_nan=False)
    write_whole(folder / f"{run.case.name}-comparisons.json", text + "\n")
    beside = as_json(run.side_by_side, run.peers, run.rod.quantities)
    write_whole(folder / f"{run.case.name}-peers.json", json.dumps(beside, indent=1, allow_nan=False) + "\n")
    if run.chart is not None:
        write_chart_numbers(run.case, run.chart, folder)
