"""`rodcheck solve` with levels of the solver's own choice: what it prints, writes and exits with."""

import json
from pathlib import Path

import jsonschema
import pytest

from cases.loader import load_case
from reports import command_line
from reports.choice import chosen_elements, sign, strip
from reports.levels_figure import levels_figure
from reports.result import Result
from rodmodel import AdaptiveSolution, solve_to

CASE = "two-cantilevers-e50-g0"


@pytest.fixture(scope="module")
def found() -> AdaptiveSolution:
    return solve_to(load_case(CASE).scene, 2e-4)


@pytest.mark.parametrize("tolerance", ["0.1%", "0.1 %", "0.001"])
def test_without_a_level_the_solver_chooses_and_says_how_sure_it_is(
    tolerance: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command_line.run(["solve", CASE, "--tolerance", tolerance, "--json"]) == 0

    printed = json.loads(capsys.readouterr().out)
    jsonschema.validate(printed, Result.model_json_schema())
    choice = printed["choice"]
    assert choice["tolerance"] == pytest.approx(1e-3)
    force = next(each for each in choice["estimates"] if each["kind"] == "contact force")
    assert 0.0 < force["error"] <= 1e-3 * force["value"]
    elements = choice["elements"]["lower"]
    assert [each["level"] for each in elements] == printed["level"]["lower"]
    assert all(each["reason"] for each in elements)
    assert elements[-1]["end"] == pytest.approx(300.0)


def test_a_given_level_is_no_choice(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["solve", CASE, "--level", "2", "--order", "3", "--json"]) == 0

    assert json.loads(capsys.readouterr().out)["choice"] is None


def test_people_see_errors_and_levels_along_the_rods(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["solve", CASE]) == 0

    shown = capsys.readouterr().out
    assert "estimated error" in shown
    assert "lower  |4|" in shown


def test_a_tolerance_that_the_rod_model_cannot_meet_exits_with_1(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["solve", "crossed-cantilevers", "--tolerance", "0.02%", "--json"]) == 1

    shown = capsys.readouterr()
    assert "3D" in shown.err
    assert json.loads(shown.out)["choice"]["outcome"].startswith("refused")


def test_the_picture_is_a_page_that_needs_no_network(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    page = tmp_path / "levels.html"

    assert command_line.run(["solve", CASE, "--picture", str(page)]) == 0

    text = page.read_text(encoding="utf-8")
    assert "arc length, mm" in text
    assert '<script src="http' not in text
    assert str(page) in capsys.readouterr().err


def test_the_figure_draws_the_level_of_every_element(found: AdaptiveSolution) -> None:
    lines = [trace for trace in levels_figure(found).data if trace.name == "level"]

    for line, elements in zip(lines, chosen_elements(found).values(), strict=True):
        assert list(line.y[:-1]) == [each.level for each in elements]


def test_a_strip_shows_every_element(found: AdaptiveSolution) -> None:
    elements = chosen_elements(found)["lower"]

    cells = strip(elements).strip("|").split("|")

    assert [cell[0] for cell in cells] == [sign(each.level) for each in elements]
