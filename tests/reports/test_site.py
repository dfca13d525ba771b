"""The report's pages: self-contained, complete, and honest about what is missing."""

from __future__ import annotations

import base64
import json
import math
import re
import struct
from dataclasses import astuple, replace
from datetime import UTC, datetime
from html.parser import HTMLParser
from itertools import pairwise
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import numpy as np
import pytest
from markupsafe import escape

from reports import site
from reports.nightly.drift import Drift
from reports.nightly.rows import rows_of, this_night
from reports.pages.history import history_part
from reports.pages.overview import overview_row
from reports.pages.turning import turning_part
from reports.processes import ProcessFailed
from reports.quantities import DEFINITIONS
from reports.runner import CaseRun, Failure

PICTURE = site.DrawnPicture("iVBORw0KGgo=", 1800, 700, "10", "")


def case_page(run: CaseRun, **others: Any) -> str:
    return site.case_pages([run], {run.case.name: PICTURE}, **others)[run.case.name]


@pytest.fixture(scope="module")
def page(case_run: CaseRun) -> str:
    return case_page(case_run)


@pytest.fixture(scope="module")
def overview(case_run: CaseRun) -> str:
    return site.overview_page([case_run])


@pytest.fixture(scope="module")
def report(case_run: CaseRun, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A report of two cases, one of which failed, in a folder; for reading alone."""
    failed = Failure(replace(case_run.case, name="other case, (2)", title="Another case"), "the mesh is singular")
    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(site, "pictures", lambda _: {case_run.case.name: PICTURE})
        return site.write_report([case_run, failed], tmp_path_factory.mktemp("report")).parent


class Links(HTMLParser):
    """Everything the page's elements refer to, and the ids there are."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.ids: list[str] = []
        self.images_without_text = 0
        self.feed(page)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.targets += [given[key] or "" for key in ("href", "src", "srcset", "data", "action") if key in given]
        self.ids += [given["id"] or ""] if "id" in given else []
        self.images_without_text += tag == "img" and not given.get("alt")


def test_no_page_refers_to_anything_outside_the_report(report: Path) -> None:
    pages = {path.resolve(): Links(path.read_text(encoding="utf-8")) for path in report.rglob("*.html")}

    assert {path.name for path in pages} >= {"index.html", "theory.html", "other case, (2).html"}
    for path, links in pages.items():
        for target in links.targets:
            address, _, anchor = target.partition("#")
            if target.startswith("data:"):
                continue
            found = (path.parent / unquote(address)).resolve() if address else path
            assert found.is_relative_to(report.resolve()), target
            assert found.is_file(), target
            assert not anchor or anchor in pages[found].ids, target
        styles = "".join(re.findall(r"<style>(.*?)</style>", path.read_text(encoding="utf-8"), re.DOTALL))
        assert "url(" not in styles
        assert "@import" not in styles


def test_pages_forbid_the_browser_to_fetch_anything_but_their_own_script(report: Path) -> None:
    for path in report.rglob("*.html"):
        policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', path.read_text(encoding="utf-8"))

        assert policy is not None
        assert policy.group(1).startswith("default-src 'none'; script-src 'self'")
        assert "http" not in policy.group(1)


def test_pages_are_light_and_share_one_plotly_script(report: Path) -> None:
    sizes = {path.name: path.stat().st_size for path in report.rglob("*.html")}

    assert max(sizes.values()) < 1_000_000
    assert (report / "plotly.min.js").stat().st_size > 1_000_000


def test_ids_are_unique_images_have_texts_and_headings_are_in_order(report: Path) -> None:
    for path in report.rglob("*.html"):
        text = path.read_text(encoding="utf-8")
        links = Links(text)
        levels = [int(level) for level in re.findall(r"<h([1-6])[ >]", text)]

        assert len(links.ids) == len(set(links.ids))
        assert links.images_without_text == 0
        assert levels[0] == 1
        assert levels.count(1) == 1
        assert all(after <= before + 1 for before, after in pairwise(levels))


def test_every_comparison_stands_on_the_page(page: str, case_run: CaseRun) -> None:
    assert page.count('<td><span class="verdict') >= len(case_run.comparisons)
    for entry in case_run.case.published:
        assert entry.source in page


def test_every_figure_has_its_place_and_finite_data(page: str) -> None:
    figures = json.loads(re.search(r"const figures = (.*);\n", page).group(1))

    assert len(figures) == 3
    for anchor, figure in figures.items():
        assert f'id="{anchor}"' in page
        assert figure["data"]


def test_axes_of_every_figure_name_their_unit(page: str) -> None:
    figures = json.loads(re.search(r"const figures = (.*);\n", page).group(1))

    for figure in figures.values():
        titles = [
            axis["title"]["text"] for axis in figure["layout"].values() if isinstance(axis, dict) and "title" in axis
        ]
        assert titles
        assert all(title.endswith((", mm", ", µm", ", MPa", ", kN mm")) for title in titles)


def test_text_of_a_case_file_cannot_become_markup(case_run: CaseRun) -> None:
    script = '"><script>alert(1)</script>'
    hostile = replace(case_run, case=replace(case_run.case, title=script, text=script, description=script))

    for page in (case_page(hostile), site.overview_page([hostile])):
        assert "<script>alert(1)" not in page


def test_a_failed_case_has_a_page_with_its_reason(report: Path) -> None:
    assert "not run" in (report / "index.html").read_text(encoding="utf-8")
    assert "the mesh is singular" in (report / "cases" / "other case, (2).html").read_text(encoding="utf-8")


def test_what_moved_since_earlier_runs_stands_at_the_top_where_somebody_looked(
    case_run: CaseRun, overview: str
) -> None:
    drift = Drift(case_run.case.name, "value", "force", "from <1> to 2 N")

    moved = site.overview_page([case_run], moved=[drift])
    still = site.overview_page([case_run], moved=[])

    assert "<li>force: from &lt;1&gt; to 2 N</li>" in moved
    assert moved.index('id="moved"') < moved.index('id="cases"')
    assert "Nothing: verdicts" in still
    assert 'id="moved"' not in overview


def test_the_history_has_a_chart_for_each_quantity_and_solver(case_run: CaseRun) -> None:
    nights = [this_night(f"2026110{day}T000000Z-00000000", datetime(2026, 11, day, tzinfo=UTC)) for day in (1, 2, 3)]
    rows = [row for night in nights for row in rows_of(case_run, night)]

    page = case_page(case_run, rows=rows, moved=[])

    subjects = {(row.solver, row.quantity, row.of, row.point) for row in rows if row.value}
    assert page.count('<polyline class="line"') >= len(subjects)
    assert "3 runs since 01 November 2026" in page
    assert 'id="history"' not in case_page(case_run)


def test_a_history_takes_no_earlier_value_for_one_of_this_run(case_run: CaseRun) -> None:
    nights = [this_night(f"2026110{day}T000000Z-00000000", datetime(2026, 11, day, tzinfo=UTC)) for day in (1, 2)]
    first, second = ([*rows_of(case_run, night)] for night in nights)
    only = [row for row in second if row.quantity == "contact_force"]
    kept = [replace(row, kept_since="2026-11-01") for row in only]

    history = history_part(case_run.case.name, [*first, *kept], ())

    assert history is not None
    lines = {line["what"]: line for _, group in history["groups"] for line in group}
    force, centre = lines["rod model contact force overlap"], lines["rod model contact centre overlap"]
    assert force["last"] != "none"
    assert force["chart"].count('class="tonight"') == 1
    for line in (centre, lines["rod model seconds"]):
        assert (line["last"], line["chart"].count('class="tonight"')) == ("none", 0)


def test_the_theory_page_defines_every_quantity_and_its_formulas_are_typeset(report: Path) -> None:
    text = (report / "theory.html").read_text(encoding="utf-8")

    assert set(DEFINITIONS) <= set(Links(text).ids)
    assert text.count("<math") > 50
    assert "merror" not in text
    assert not re.search(r"\\[()\[\]a-z]", text.split("<main", 1)[1])


def test_the_3d_view_holds_the_surface_of_both_models_to_16_bits(drawn_run: CaseRun) -> None:
    part = turning_part(drawn_run)
    data = json.loads(part["data"])

    def values(text: str) -> np.ndarray:
        return np.frombuffer(base64.b64decode(text), "<i2") / 32767

    # Euler's beam bends in the XY plane: Z, the third coordinate, is that of the section, 15 mm wide.
    for model, answer in zip(data["models"], (drawn_run.rod, drawn_run.references[-1]), strict=True):
        for packed, rod in zip(model["rods"], answer.surface.rods, strict=True):
            largest = np.abs(rod.stress_s).max()
            assert packed["scale"] * values(packed["value"]) == pytest.approx(rod.stress_s, abs=largest / 32767)
            depth = values(packed["position"]).reshape(-1, 3)[:, 2]
            half = 7.5 / depth.max()  # mm, of the longest side of the whole
            along = values(packed["position"]).reshape(-1, 3)[:, 0]
            assert half * np.ptp(along) == pytest.approx(300.0, rel=1e-3)
    assert len(part["data"]) < 300_000


def test_the_case_file_stands_on_the_page_as_it_is(case_run: CaseRun, page: str) -> None:
    assert case_run.case.text
    assert escape(case_run.case.text) in page


def test_a_solver_that_did_not_converge_is_named(case_run: CaseRun) -> None:
    quantities = replace(case_run.rod.quantities, outcome="cycling")

    run = replace(case_run, rod=replace(case_run.rod, quantities=quantities))
    page = case_page(run)

    assert "did not converge: cycling" in page
    assert "not converged (1)" in site.overview_page([run])


def test_where_nothing_can_be_drawn_the_page_says_so(case_run: CaseRun, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_graphics(*_: object) -> None:
        raise ProcessFailed("its process ended early with exit code -11")

    monkeypatch.setattr(site, "in_own_process", no_graphics)

    page = site.case_pages([case_run], site.pictures([case_run]))[case_run.case.name]

    assert "There is no picture: drawing failed" in page


def test_a_difference_from_nothing_is_the_largest_of_all_and_sorts_so(case_run: CaseRun) -> None:
    infinite = [replace(found, difference=math.inf, verdict="fail") for found in case_run.comparisons[:1]]

    text, _, key = astuple(overview_row(replace(case_run, comparisons=tuple(infinite)), None)["cells"][0])

    assert (text, key) == ("inf", "Infinity")  # what Number() of the browser reads


def test_results_are_written_beside_the_page(
    case_run: CaseRun, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(site, "pictures", lambda _: {case_run.case.name: PICTURE})

    path = site.write_report([case_run], tmp_path / "report")

    assert path == tmp_path / "report" / "index.html"
    results = {file.name: json.loads(file.read_text()) for file in (tmp_path / "report" / "results").iterdir()}
    name = case_run.case.name
    kinds = ("rod", "reference", "comparisons", "peers")
    assert set(results) == {f"{name}-{kind}.json" for kind in kinds}
    assert len(results[f"{name}-comparisons.json"]) == len(case_run.comparisons)


@pytest.mark.slow
def test_the_deformed_bars_are_drawn(case_run: CaseRun) -> None:
    picture = site.pictures([case_run])[case_run.case.name]

    # Where VTK finds no way to draw, the page must say why instead.
    if picture.problem:
        assert not picture.data
        return
    png = base64.b64decode(picture.data)
    width, height = struct.unpack(">II", png[16:24])  # the header of a PNG file
    assert png.startswith(b"\x89PNG")
    assert (width, height) == (picture.width, picture.height)
    assert len(png) > 20_000  # a blank image of this size is smaller than 10 kB
