"""Element borders that follow the edges of contact."""

from dataclasses import replace
from itertools import combinations

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from cases.loader import load_case
from cases.scene import Scene, SectionForce
from rodmodel.borders import Edge, border_plan, edge_rates, natural_mesh, nearest, placed_meshes


@pytest.fixture
def scene() -> Scene:
    return load_case("two-cantilevers-e20-g0").scene


def placed(scene: Scene, edges: list[Edge], positions: list[float]) -> dict[str, np.ndarray]:
    borders = {rod.name: natural_mesh(scene, rod, 3, 4) for rod in scene.rods}
    at = np.array(positions)
    meshes = placed_meshes(border_plan(scene, borders, edges, at), at)
    return {name: mesh.borders for name, mesh in meshes.items()}


BOTH = [Edge("overlap", 0, -1), Edge("overlap", 0, 1)]


@pytest.mark.slow
@given(places=st.lists(st.floats(201.0, 299.0), min_size=1, max_size=7, unique=True), data=st.data())
def test_edges_take_the_borders_that_move_least_in_all(places: list[float], data: st.DataObject) -> None:
    """Of all choices of as many borders in their order."""
    least_apart = 1e-3
    borders = np.sort(places)
    assume(np.diff(borders).min(initial=1.0) > least_apart)
    count = data.draw(st.integers(1, len(places)))
    edges = np.sort(data.draw(st.lists(st.floats(200.0, 300.0), min_size=count, max_size=count)))

    chosen = borders[nearest(borders, edges)]

    moved = min(float(np.abs(np.array(some) - edges).sum()) for some in combinations(borders, count))
    assert (np.diff(chosen) > 0.0).all()
    assert np.abs(chosen - edges).sum() == pytest.approx(moved, abs=1e-9)


def test_two_edges_take_the_two_inner_borders_of_both_rods(scene: Scene) -> None:
    borders = placed(scene, BOTH, [237.5, 262.0])
    np.testing.assert_allclose(borders["lower"], [0, 66.67, 133.33, 200, 237.5, 262, 300])
    np.testing.assert_allclose(borders["upper"], [0, 37.5, 62, 100, 166.67, 233.33, 300])


def test_borders_between_held_ones_keep_their_proportions(scene: Scene) -> None:
    borders = placed(scene, BOTH[1:], [220.0])
    # 233.33 goes to 220; 266.67 stays half way between it and the zone's end at 300
    np.testing.assert_allclose(borders["lower"][3:], [200, 220, 260.006, 300], atol=1e-3)


def test_elements_never_overlap_however_far_an_edge_goes(scene: Scene) -> None:
    for position in (200.5, 230.0, 270.0, 299.5):
        for borders in placed(scene, BOTH[1:], [position]).values():
            assert (np.diff(borders) > 0.0).all()


def test_a_rod_with_too_few_borders_gets_new_ones(scene: Scene) -> None:
    lower = replace(scene.rods[0], element_borders=(0.0, 200.0, 300.0))
    coarse = replace(scene, rods=(lower, scene.rods[1]))
    borders = placed(coarse, BOTH, [237.5, 262.0])
    np.testing.assert_allclose(borders["lower"], [0, 200, 237.5, 262, 300])


def test_loads_and_zone_ends_are_borders_and_do_not_move(scene: Scene) -> None:
    load = SectionForce("lower", 240.0, (0.0, -1.0, 0.0))
    loaded = replace(scene, loads=(*scene.loads, load))
    assert 240.0 in natural_mesh(loaded, loaded.rods[0], 3, 4).borders
    borders = placed(loaded, BOTH, [239.0, 262.0])["lower"]
    assert 240.0 in borders
    assert 239.0 in borders


@pytest.mark.parametrize("position", [236.0, 243.0])
def test_rates_tell_how_borders_follow_the_edges(scene: Scene, position: float) -> None:
    """Also where an edge has crossed a border that a load holds, and has changed places with it."""
    load = SectionForce("lower", 240.0, (0.0, -1.0, 0.0))
    loaded = replace(scene, loads=(*scene.loads, load))
    natural = {rod.name: natural_mesh(loaded, rod, 3, 4) for rod in loaded.rods}
    plan = border_plan(loaded, natural, BOTH, np.array([236.0, 262.0]))
    at = np.array([position, 262.0])
    before = placed_meshes(plan, at)
    rates = edge_rates(plan, at)
    for number, step in enumerate(np.eye(2)):
        for name, mesh in placed_meshes(plan, at + step).items():
            moved = mesh.borders - before[name].borders
            np.testing.assert_allclose(rates[name].at(before[name].borders)[number], moved, atol=1e-12)
