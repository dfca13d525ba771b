"""The Pareto front and the race: nobody is called nearer where the reference cannot tell."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from reports.chart.front import COSTS, ROD, asked, front, races
from reports.chart.points import NGSOLVE_TUNED, ROD_AUTO, SOLID, Chart, Point


def labels(points: tuple[Point, ...]) -> list[str]:
    return [point.label for point in points]


def test_the_front_holds_what_nothing_cheaper_is_as_near_as(chart: Chart) -> None:
    assert labels(front(chart, "contact_force", COSTS["seconds"])) == [
        "h1, p = 3, graded",
        "h3, p = 3, graded",
        "h5, p = 3, graded",
        "mesh tuned to 0.1 %",
    ]
    # with 800 unknowns it is nearer than both that have more
    assert labels(front(chart, "contact_force", COSTS["unknowns"])) == ["h1, p = 3, graded", "mesh tuned to 0.1 %"]


def test_the_front_ends_with_the_first_point_within_the_uncertainty(chart: Chart) -> None:
    """All errors of deflection are at most its uncertainty, so that the cheapest is as good as any."""
    assert labels(front(chart, "largest_deflection", COSTS["seconds"])) == ["h1, p = 3, graded"]


def test_what_did_not_converge_is_neither_on_the_front_nor_in_the_race(
    chart: Chart, point: Callable[..., Point]
) -> None:
    best = replace(point("rod model, graded elements", "h9", 1e-6, 100.0, 2.0), outcome="cycling")
    chart = replace(chart, points=(*chart.points, best))

    assert best not in front(chart, "contact_force", COSTS["seconds"])
    assert all(finish.cheapest is not best for race in races(chart) for finish in race.finishes)


def test_the_race_is_won_by_the_cheapest_that_keeps_the_tolerance_in_both(chart: Chart) -> None:
    coarse, fine, finest = races(chart)

    cheapest = {finish.runner: finish for finish in fine.finishes}
    assert cheapest[ROD].cheapest.label == "h3, p = 3, graded"
    assert cheapest[NGSOLVE_TUNED].ratio == pytest.approx(0.080 / 0.020)
    assert {finish.runner: finish.cheapest.label for finish in coarse.finishes}[ROD] == "h1, p = 3, graded"
    # 0.02 % in force would be kept, but not in deflection
    assert {finish.runner: finish.cheapest for finish in finest.finishes}[NGSOLVE_TUNED] is None


def test_an_own_choice_counts_only_for_the_tolerance_it_was_asked_for(
    chart: Chart, point: Callable[..., Point]
) -> None:
    """Who asks for 0.1 % cannot know that asking for 1 % would have been enough, nor is 0.02 % kept by having asked."""
    chosen = [
        point(ROD_AUTO, asked(0.01), 0.015, 100.05, 2.001),
        point(ROD_AUTO, asked(0.001), 0.025, 100.05, 2.001),
        point(ROD_AUTO, asked(0.0002), 0.035, 100.05, 2.001),
    ]
    chart = replace(chart, points=(*chart.points, *chosen))

    own = [next(finish for finish in race.finishes if finish.runner == ROD_AUTO) for race in races(chart)]

    assert [finish.cheapest for finish in own] == [chosen[0], chosen[1], None]
    # ratios are to it where it finished
    fixed = {finish.runner: finish.ratio for finish in races(chart)[1].finishes}
    assert fixed[ROD] == pytest.approx(0.020 / 0.025)


def test_a_race_finer_than_the_reference_is_certain_says_so(chart: Chart) -> None:
    assert [race.certain for race in races(chart)] == [True, True, False]


def test_methods_that_took_no_part_are_not_in_the_race(chart: Chart) -> None:
    for race in races(chart):
        assert {finish.runner for finish in race.finishes} == {ROD, NGSOLVE_TUNED, SOLID}
