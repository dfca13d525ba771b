"""What the rod model chose, judged: against the reference, its own estimates and the cheapest fixed configuration."""

from __future__ import annotations

import json
import math
from dataclasses import replace
from pathlib import Path

import pytest

from reports.chart.choices import Choice, Judged, choices, rows, summary
from reports.chart.choices_page import print_choices, write_choices
from reports.chart.front import asked
from reports.chart.page import write_chart
from reports.chart.points import ROD_AUTO, Chart, Point, Reference
from reports.runner import CaseRun


def own(tolerance: float, force: float, estimate: float, seconds: float, outcome: str = "converged") -> Point:
    values = {("contact_force", "pair"): (force,), ("largest_deflection", "rod"): (2.0,)}
    estimates = {("contact_force", "pair"): (estimate,), ("largest_deflection", "rod"): (1e-8,)}
    return Point(ROD_AUTO, asked(tolerance), outcome, 500, (seconds,), "processor", values, estimates, "h2, h4")


@pytest.fixture
def chosen(chart: Chart) -> Chart:
    """The force is 100 N, certain to 0.01 %: well within 1 %, just beyond 0.1 %, refused at 0.02 %."""
    references = {
        "contact_force": Reference({"pair": (100.0,)}, 1e-4, uncertainties={"pair": 1e-4}),
        "largest_deflection": Reference({"rod": (2.0,)}, 5e-4, uncertainties={"rod": 5e-4}),
    }
    points = (
        own(0.01, 100.5, 4e-3, 0.015),
        own(0.001, 100.107, 1e-4, 0.050),
        own(0.0002, 100.05, 4e-4, 0.080, "refused: by h10"),
    )
    return replace(chart, points=(*chart.points, *points), references=references)


def test_the_cheapest_fixed_configuration_is_found_among_those_that_keep_the_tolerance(chosen: Chart) -> None:
    one, second, third = choices([chosen])

    # h1 is off by 0.5 %, h3 by 0.05 % and h5 by 0.02 % of the force
    assert one.cheapest is not None
    assert one.cheapest.label == "h1, p = 3, graded"
    assert one.ratio == pytest.approx(1.5)
    assert second.cheapest is not None
    assert second.cheapest.label == "h3, p = 3, graded"
    assert third.ratio is None  # nothing was promised


def test_what_falls_short_is_named(chosen: Chart) -> None:
    fine, beyond, refused = (choice.shortcomings for choice in choices([chosen]))

    assert fine == []
    assert beyond == [
        "contact force, pair: off by 0.11 %, which the reference is too uncertain to tell",
        "contact force, pair: estimated 0.01 %, is 0.11 %",
        "2.5 times the seconds of the cheapest",
    ]
    assert refused == ["refused, though h5, p = 3, graded keeps the tolerance"]


@pytest.mark.parametrize(
    ("error", "estimate", "good"),
    [
        (1e-3, 4e-3, True),
        (1e-3, 6e-3, False),
        (1e-3, 1.5e-4, False),
        (2e-4, 1e-4, True),
        (2e-4, 1e-5, False),  # at least 1e-4 for all that the reference tells
        (1e-9, 1e-7, True),  # both are round-off
    ],
)
def test_estimates_are_good_within_a_factor_of_five(error: float, estimate: float, good: bool) -> None:
    judged = Judged("contact_force", "pair", error, estimate, uncertainty=1e-4 if error > 1e-8 else 0.0)

    assert judged.well_estimated == good


def test_sums_count_what_was_promised_and_estimates_of_all(chosen: Chart) -> None:
    sentences = summary(choices([chosen]))

    assert sentences[0].startswith("True error within the tolerance: 3 of 4, 75.0 %")
    assert "4 of 4, 100.0 %" in sentences[1]
    assert "5 of 6" in sentences[2]
    assert "1 of 2" in sentences[3]
    assert sentences[4].startswith("Of 3 requests 1 were refused")


def test_nothing_chosen_is_no_row(chart: Chart) -> None:
    assert choices([chart]) == ()
    assert rows([]) == []


def test_the_page_names_cases_escaped_and_its_numbers_stand_beside_it(
    chosen: Chart, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    without = Chart("Knotted", (), {}, ("There is no chart: rods are knotted.",))

    page = write_choices([chosen, without], tmp_path, in_report=True).read_text()
    print_choices([chosen, without])

    assert "Made &lt;up&gt;" in page
    assert '<a href="index.html">All cases</a>' in page
    assert "<script" not in page
    assert "Knotted: There is no chart" in page
    numbers = json.loads((tmp_path / "results" / "choices.json").read_text())
    assert [entry["tolerance"] for entry in numbers] == [0.01, 0.001, 0.0002]
    shown = capsys.readouterr().out
    assert "2.5 times the seconds of the cheapest" in shown
    assert "Knotted: There is no chart" in shown


def test_a_chart_of_one_case_has_its_own_rows(chosen: Chart, case_run: CaseRun, tmp_path: Path) -> None:
    page = write_chart(case_run.case, chosen, tmp_path).read_text()

    assert "own choice</h4>" in page
    assert "h2, h4, refused" in page


def test_a_choice_without_any_fixed_configuration_has_no_ratio(chosen: Chart) -> None:
    alone = replace(chosen, points=tuple(point for point in chosen.points if point.method == ROD_AUTO))

    assert [choice.cheapest for choice in choices([alone])] == [None] * 3
    assert all(isinstance(choice, Choice) and choice.ratio is None for choice in choices([alone]))


def test_an_estimate_that_knows_nothing_does_not_keep_the_page_from_being_written(chart: Chart, tmp_path: Path) -> None:
    write_choices([replace(chart, points=(own(0.01, 100.5, math.inf, 0.015),))], tmp_path)

    (numbers,) = json.loads((tmp_path / "results" / "choices.json").read_text())
    assert [each["estimate"] for each in numbers["quantities"]] == [None, 1e-8]
