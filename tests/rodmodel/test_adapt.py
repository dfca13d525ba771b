"""Short elements where the fields are steep."""

from cases.loader import load_case
from rodmodel.adapt import graded

SCENE = load_case("two-cantilevers-e50-g0").scene


def test_grading_only_adds_borders() -> None:
    for rod, finer in zip(SCENE.rods, graded(SCENE).rods, strict=True):
        assert set(rod.element_borders) <= set(finer.element_borders)


def test_short_elements_stand_at_clamps_and_zone_ends() -> None:
    lower, upper = graded(SCENE).rods
    assert {3.0, 15.0, 205.0, 295.0} <= set(lower.element_borders)
    assert {5.0, 95.0, 285.0, 297.0} <= set(upper.element_borders)


def test_grading_again_adds_nothing() -> None:
    assert graded(graded(SCENE)) == graded(SCENE)
