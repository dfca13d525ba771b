"""The report page: self-contained, complete, and honest about what is missing."""

from __future__ import annotations

import base64
import json
import re
import struct
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

from reports import site
from reports.processes import ProcessFailed
from reports.runner import CaseRun, Failure

PICTURE = site.DrawnPicture("iVBORw0KGgo=", 1800, 700, "10", "")


@pytest.fixture
def page(case_run: CaseRun) -> str:
    return site.render([case_run], {case_run.case.name: PICTURE})


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


def test_the_page_refers_to_nothing_outside_itself(page: str) -> None:
    links = Links(page)

    assert links.targets
    assert all(target.startswith(("#", "data:")) for target in links.targets)
    styles = "".join(re.findall(r"<style>(.*?)</style>", page, re.DOTALL))
    assert "url(" not in styles
    assert "@import" not in styles


def test_the_page_forbids_the_browser_to_fetch_anything(page: str) -> None:
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)

    assert policy is not None
    assert policy.group(1).startswith("default-src 'none'")
    assert "http" not in policy.group(1)


def test_links_inside_the_page_lead_somewhere_and_ids_are_unique(page: str) -> None:
    links = Links(page)

    assert {target[1:] for target in links.targets if target.startswith("#")} <= set(links.ids)
    assert len(links.ids) == len(set(links.ids))
    assert links.images_without_text == 0


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
    hostile = replace(case_run, case=replace(case_run.case, title="<script>alert(1)</script>"))

    page = site.render([hostile], {hostile.case.name: PICTURE})

    assert "<script>alert(1)" not in page


def test_a_failed_case_is_on_the_page_with_its_reason(case_run: CaseRun) -> None:
    failed = Failure(replace(case_run.case, name="other", title="Another case"), "the mesh is singular")

    page = site.render([failed, case_run], {case_run.case.name: PICTURE})

    assert "the mesh is singular" in page
    assert "not run" in page
    assert case_run.case.title in page


def test_what_moved_since_earlier_runs_stands_at_the_top_where_somebody_looked(case_run: CaseRun, page: str) -> None:
    drawn = {case_run.case.name: PICTURE}

    moved = site.render([case_run], drawn, moved=["bars: force: from <1> to 2 N"])
    still = site.render([case_run], drawn, moved=[])

    assert "<li>bars: force: from &lt;1&gt; to 2 N</li>" in moved
    assert moved.index('id="moved"') < moved.index('id="cases"')
    assert "Nothing: verdicts" in still
    assert 'id="moved"' not in page


def test_a_solver_that_did_not_converge_is_named(case_run: CaseRun) -> None:
    quantities = replace(case_run.rod.quantities, outcome="cycling")

    page = site.render(
        [replace(case_run, rod=replace(case_run.rod, quantities=quantities))], {case_run.case.name: PICTURE}
    )

    assert "did not converge: cycling" in page


def test_where_nothing_can_be_drawn_the_page_says_so(case_run: CaseRun, monkeypatch: pytest.MonkeyPatch) -> None:
    def no_graphics(*_: object) -> None:
        raise ProcessFailed("its process ended early with exit code -11")

    monkeypatch.setattr(site, "in_own_process", no_graphics)

    page = site.render([case_run], site.pictures([case_run]))

    assert "There is no picture: drawing failed" in page


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
