"""The chart as figures, tables and words: nothing drawn that is not told, names of others escaped."""

from __future__ import annotations

import json
import re
from dataclasses import replace
from pathlib import Path

import pytest

from reports import site
from reports.chart.figure import LOOKS, SIGNS, chart_figure
from reports.chart.page import as_json, chart_part, write_chart
from reports.chart.points import Chart
from reports.chart.wording import print_race
from reports.runner import CaseRun


@pytest.fixture
def page(chart: Chart, case_run: CaseRun, tmp_path: Path) -> str:
    return write_chart(case_run.case, chart, tmp_path).read_text()


def test_every_drawn_quantity_has_two_panels_with_a_text_that_names_the_front(chart: Chart) -> None:
    content, figures = chart_part(chart, "case-1")

    assert len(figures) == 4  # force and deflection, against seconds and unknowns
    alternatives = [alt for figure in content["figures"] for _, alt, _ in figure["panels"]]
    assert "h5, p = 3, graded: 0.02 % with 40 ms" in alternatives[0]
    assert "800 unknowns" in alternatives[1]


def test_a_singular_peak_is_said_to_be_one_and_not_drawn(chart: Chart) -> None:
    content, _ = chart_part(chart, "case-1")

    (sentence,) = content["missing"]
    assert sentence.startswith(
        "Peak pressure in the middle of the width: there is no chart. Pair: singular at X = 0 mm"
    )


def test_seconds_have_bars_from_the_least_to_the_greatest_run(chart: Chart) -> None:
    figure = chart_figure(chart, "contact_force", "seconds")

    (solid,) = [trace for trace in figure.data if trace.name == "3D"]
    assert list(solid.x) == [5.0]
    assert list(solid.error_x.array) == [5.0]
    assert list(solid.error_x.arrayminus) == [2.5]


def test_the_band_reaches_to_the_uncertainty_in_per_cent(chart: Chart) -> None:
    figure = chart_figure(chart, "contact_force", "unknowns")

    (band,) = [trace for trace in figure.data if trace.fill == "toself"]
    assert max(band.y) == pytest.approx(100.0 * 1e-4)


def test_methods_differ_without_colour_and_have_a_sign() -> None:
    shapes = [symbol for _, symbol, _ in LOOKS.values()]

    assert len(set(shapes)) == len(shapes)
    assert set(SIGNS) == set(LOOKS)
    assert len(set(SIGNS.values())) == len(SIGNS)


def test_the_page_is_whole_and_escapes_what_it_did_not_write(page: str) -> None:
    figures = json.loads(re.search(r"const figures = (.*);\n", page).group(1))

    assert all(f'id="{place}"' in page for place in figures)
    assert 'http-equiv="Content-Security-Policy" content="default-src \'none\';' in page
    assert "All 5 configurations in numbers" in page
    assert "80 ms (40 ms to 160 ms), 4\u00a0x" in page


def test_numbers_stand_beside_the_page(page: str, chart: Chart, case_run: CaseRun, tmp_path: Path) -> None:
    written = json.loads((tmp_path / "results" / f"{case_run.case.name}-chart.json").read_text())

    assert written == json.loads(json.dumps(as_json(chart)))
    assert written["points"][0]["errors"] == {
        "contact_force": pytest.approx(0.005),
        "largest_deflection": pytest.approx(0.0005),
        "peak_pressure": None,
    }
    assert page


@pytest.mark.slow
def test_the_report_has_the_chart_of_a_case_that_has_one(chart: Chart, case_run: CaseRun) -> None:
    pictures = {case_run.case.name: site.DrawnPicture("iVBORw0KGgo=", 1800, 700, "10", "")}
    hostile = replace(chart, notes=("<script>alert(1)</script>",))

    (with_chart,) = site.case_pages([replace(case_run, chart=hostile)], pictures).values()

    assert "Speed against accuracy" in with_chart
    assert "<script>alert(1)" not in with_chart


def test_an_empty_chart_is_a_sentence(chart: Chart, case_run: CaseRun) -> None:
    pictures = {case_run.case.name: site.DrawnPicture("iVBORw0KGgo=", 1800, 700, "10", "")}
    empty = Chart("Case", (), {}, ("There is no chart: it broke",))

    (page,) = site.case_pages([replace(case_run, chart=empty)], pictures).values()

    assert "There is no chart: it broke" in page
    assert "configurations in numbers" not in page


def test_the_race_is_printed(chart: Chart, capsys: pytest.CaptureFixture[str]) -> None:
    print_race(chart)

    shown = capsys.readouterr().out
    assert "Made <up>" in shown
    assert "0.02 %, which the" in shown  # and so on, wrapped: the reference is too uncertain
    assert "h3, p = 3, graded" in shown
    assert "A note." in shown
