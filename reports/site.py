"""The report: a folder of pages that need no network, and the results as JSON beside them."""

from __future__ import annotations

import base64
import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from urllib.parse import quote

from reports.chart.page import write_chart_numbers
from reports.html import rendered, write_plotly
from reports.nightly.drift import Drift
from reports.nightly.rows import Row
from reports.pages.case import DrawnPicture, case_page
from reports.pages.history import history_part
from reports.pages.overview import case_address, case_file, overview_row, states_to_choose
from reports.pages.theory import theory_page
from reports.peers import as_json
from reports.peers_table import peers_summary
from reports.processes import ProcessFailed, Progress, in_own_process
from reports.result import result
from reports.runner import CaseRun, Failure
from reports.store import write_whole

OVERVIEW, THEORY = "index.html", "theory.html"
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
    "choices.html": (
        "Choice of levels",
        "what the rod model chooses for a tolerance, how sure it is, how near it comes, and what it costs.",
    ),
    "stability.html": (
        "Stability",
        "every method driven to where it fails, the rod model and plain alternatives side by side.",
    ),
}


def write_report(
    runs: Sequence[CaseRun | Failure],
    output: Path,
    pages: Sequence[str] = (),
    moved: Sequence[Drift] | None = None,
    rows: Sequence[Row] = (),
) -> Path:
    """Write the overview, the cases' pages and that of theory into the folder `output`; returns the overview's path.

    The overview is written last: whoever finds it finds the pages that it leads to.

    Parameters
    ----------
    pages : file names of the pages beside it, those of `PAGES` that there are
    moved : what moved since earlier runs; None where nobody looked
    rows : the history of these cases, oldest run first, this run included

    Raises
    ------
    OSError
        if the folder or a file cannot be written.
    """
    write_plotly(output)
    for run in runs:
        if isinstance(run, CaseRun):
            _write_results(run, output / "results")
    for name, page in case_pages(runs, pictures(runs), pages, moved, rows).items():
        write_whole(output / case_file(name), page)
    write_whole(output / THEORY, theory_page(_site(pages)))
    write_whole(output / OVERVIEW, overview_page(runs, pages, moved))
    return output / OVERVIEW


def overview_page(
    runs: Sequence[CaseRun | Failure], pages: Sequence[str] = (), moved: Sequence[Drift] | None = None
) -> str:
    """The overview as HTML, with links to the pages beside it and, where it is known, what moved since earlier runs."""
    return rendered(
        "pages/overview.html.jinja",
        {},
        cases=[overview_row(run, moved) for run in runs],
        states=states_to_choose(runs, moved),
        peers=peers_summary(runs),
        pages=[(page, *PAGES[page]) for page in pages],
        moved=None if moved is None else _moved(runs, moved),
        site=_site(pages),
        here="All cases",
    )


def case_pages(
    runs: Sequence[CaseRun | Failure],
    drawn: Mapping[str, DrawnPicture],
    pages: Sequence[str] = (),
    moved: Sequence[Drift] | None = None,
    rows: Sequence[Row] = (),
) -> dict[str, str]:
    """The pages of all cases as HTML, by the case's name."""
    site = [(f"../{address}", name) for address, name in _site(pages)]
    found = {}
    for index, run in enumerate(runs):
        beside = [(index - 1, "prev"), (index + 1, "next")]
        neighbours = [
            (quote(case_file(runs[other].case.name).name), runs[other].case.title, way)
            for other, way in beside
            if 0 <= other < len(runs)
        ]
        history = history_part(run.case.name, rows, moved or ())
        found[run.case.name] = case_page(run, drawn.get(run.case.name), site, neighbours, history)
    return found


def _site(pages: Sequence[str]) -> list[tuple[str, str]]:
    """Addresses and names of the report's pages, besides those of cases."""
    return [(OVERVIEW, "All cases"), (THEORY, "Theory and glossary"), *((page, PAGES[page][0]) for page in pages)]


def _moved(runs: Sequence[CaseRun | Failure], drifts: Sequence[Drift]) -> list[tuple[str, str, list[str]]]:
    """What moved, case by case: its name, the address of its page, a line for everything that moved."""
    here = {run.case.name for run in runs}
    lines: dict[str, list[str]] = {}
    for drift in drifts:
        lines.setdefault(drift.case, []).append(f"{drift.of}: {drift.text}")
    return [(name, case_address(name) if name in here else "", found) for name, found in lines.items()]


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
