"""Configurations are run in turn and told completely: what was left out is named, what is kept is not run again."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from reports.cache import Cache
from reports.chart import measure as measure_module
from reports.chart.measure import Configuration, Measured, Told, charted, make_chart, measure, run_in_turn
from reports.chart.points import ROD_AUTO, ROD_GRADED, ROD_OWN, SOLID, Point
from reports.runner import CaseRun, Failure


def configuration(label: str, ran: list[str], seconds: float = 0.0) -> Configuration:
    def run():
        ran.append(label)
        return lambda: Told("converged", 1, {})

    made = Configuration(ROD_OWN, label, run)
    once = made.once

    def timed() -> None:
        once()
        made.seconds[-1] = seconds

    made.once = timed
    return made


def test_configurations_are_run_in_turn() -> None:
    ran: list[str] = []

    run_in_turn([configuration(label, ran) for label in "ab"], enough=1.0)

    assert "".join(ran) == "ab" * measure_module.MOST_RUNS


def test_what_there_is_no_time_for_is_told_and_no_turn_is_begun_that_would_take_too_long() -> None:
    ran: list[str] = []
    slow = [configuration(label, ran, seconds=1.0) for label in "abcd"]

    left_out = run_in_turn(slow, enough=2.5)

    assert "".join(ran) == "abc"
    assert [each.label for each in left_out] == ["d"]


def test_an_answer_is_evaluated_once_and_its_seconds_are_the_median_of_its_runs() -> None:
    told: list[int] = []

    def tell():
        told.append(1)
        return Told("converged", 7, {("contact_force", "pair"): (1.0,)})

    made = Configuration(SOLID, "mesh", lambda: tell)
    for _ in range(3):
        made.once()
    made.seconds = [3.0, 1.0, 2.0]

    assert len(told) == 1
    assert made.point().median == 2.0
    assert made.point().unknowns == 7


@pytest.mark.slow
def test_all_methods_are_measured_on_a_library_case(case_run: CaseRun, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(measure_module, "LEVELS", (1, 5))
    stations = {rod.rod: rod.station for rod in case_run.rod.quantities.rods}

    found = measure(case_run.case, lambda _: None, stations, enough=1.5)

    methods = {point.method for point in found.points}
    assert {ROD_OWN, ROD_GRADED, ROD_AUTO, "Euler-Bernoulli beams", "Timoshenko beams"} <= methods
    assert all(point.outcome == "converged" and min(point.seconds) > 0.0 for point in found.points)
    forces = {point.values["contact_force", "overlap"][0] for point in found.points}
    # the true one is 322.45 N; the crudest, p = 4 on twelve elements, are 0.3 % off, beams 0.3 %
    assert min(forces) > 320.0
    assert max(forces) < 325.0


@pytest.fixture
def solved(case_run: CaseRun, monkeypatch: pytest.MonkeyPatch) -> CaseRun:
    """A case run whose configurations are measured at once."""
    values = {("contact_force", "overlap"): (320.0,)}
    made = Point(ROD_OWN, "h1", "converged", 10, (0.1,), "processor", values)
    monkeypatch.setattr(measure_module, "in_own_process", lambda _work, _case: Measured((made,), ()))
    return replace(case_run, sizes=(6.0, 3.0, 2.0))


@pytest.mark.slow
def test_a_measurement_is_kept_and_says_when_it_was_made(
    solved: CaseRun, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = make_chart(solved, cache=Cache(tmp_path))
    monkeypatch.setattr(measure_module, "in_own_process", None)  # nothing may be measured again

    again = make_chart(solved, cache=Cache(tmp_path))

    assert [point.label for point in again.points] == [point.label for point in first.points]
    assert any("measured on" in note for note in again.notes)
    assert not any("measured on" in note for note in first.notes)
    # with the meshes of the run
    assert [point.label for point in again.points if point.method == SOLID] == [f"mesh {n} of 3" for n in (1, 2, 3)]


def test_peers_that_were_not_asked_are_named(solved: CaseRun) -> None:
    assert any("CalculiX" in note and "not asked" in note for note in make_chart(solved).notes)


def test_a_case_without_a_reference_has_an_empty_chart_that_says_why_and_failures_stay(case_run: CaseRun) -> None:
    alone = replace(case_run, references=(), refusal="Rods are knotted.")
    failure = Failure(case_run.case, "broken")

    found, still = charted([alone, failure], lambda _: None, None)

    assert found.chart.points == ()
    assert found.chart.notes == (
        "There is no chart: there is no 3D reference to hold errors against. Rods are knotted.",
    )
    assert still is failure
