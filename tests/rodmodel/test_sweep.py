"""A sweep must answer every scene as a solution of its own does, whatever changes from one to the next."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm
from cases.loader import load_case
from cases.scene import Scene, SectionForce
from rodmodel.solution import Solution
from rodmodel.sweep import Swept, sweep

LEVEL, ORDER = 2, 4
# Borders of both solutions sit within 0.01 mm of the edge, on one side or the other; the force is stationary there.
SAME_FORCE = 1e-6
SAME_EDGE = 0.02


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_case("two-cantilevers-e50-g0").scene


def with_modulus(scene: Scene, modulus: float) -> Scene:
    rods = tuple(
        replace(rod, material=replace(rod.material, young_modulus=modulus)) if rod.name == "upper" else rod
        for rod in scene.rods
    )
    return replace(scene, rods=rods)


def with_gap(scene: Scene, gap: float) -> Scene:
    return replace(scene, contacts=(replace(scene.contacts[0], gap=gap),))


def with_load(scene: Scene, force: float) -> Scene:
    (load,) = scene.loads
    assert isinstance(load, SectionForce)
    return replace(with_gap(scene, 0.3), loads=(replace(load, force=(0.0, -force, 0.0)),))


def with_height(scene: Scene, height: float) -> Scene:
    rods = tuple(
        replace(rod, section=replace(rod.section, height=height)) if rod.name == "upper" else rod for rod in scene.rods
    )
    return replace(scene, rods=rods)


def swept(scene: Scene, change: Callable[[Scene, float], Scene], values: np.ndarray) -> list[tuple[Swept, Solution]]:
    scenes = [(float(value), change(scene, float(value))) for value in values]
    return [
        (found, rm.solve(own, LEVEL, ORDER))
        for found, (_, own) in zip(sweep(scenes, LEVEL, ORDER), scenes, strict=True)
    ]


def require_same(found: Solution, own: Solution) -> None:
    assert found.outcome == own.outcome
    np.testing.assert_allclose(found.force.sum(), own.force.sum(), rtol=SAME_FORCE)
    ends = [[end for stretch in each.stretches for end in (stretch.start, stretch.end)] for each in (found, own)]
    np.testing.assert_allclose(*ends, rtol=0.0, atol=SAME_EDGE)
    for rod in found.scene.rods:
        station = np.linspace(0.0, rod.length, 7)
        moved, expected = (each.displacement(rod.name, station) for each in (found, own))
        np.testing.assert_allclose(moved, expected, rtol=0.0, atol=2.0 * SAME_FORCE * np.abs(expected).max())
    np.testing.assert_allclose(found.strain_energy, own.strain_energy, rtol=2.0 * SAME_FORCE)


@pytest.mark.parametrize(
    ("change", "values"),
    [
        # two moving edges; then the corner touches; then no more than the corner, where no border moves
        pytest.param(
            with_modulus,
            np.array([20e3, 24e3, 28e3, 45e3, 50e3, 55e3, 100e3, 150e3, 200e3]),
            id="modulus",
            marks=pytest.mark.slow,
        ),
        pytest.param(with_gap, np.linspace(0.0, 0.3, 6), id="gap"),
        # too little to close the gap at first
        pytest.param(with_load, np.linspace(50.0, 2000.0, 6), id="load", marks=pytest.mark.slow),
        # other elements for every value
        pytest.param(with_height, np.array([14.8, 14.9, 15.0]), id="section"),
    ],
)
def test_every_answer_is_that_of_a_solution_of_its_own(
    scene: Scene, change: Callable[[Scene, float], Scene], values: np.ndarray
) -> None:
    for found, own in swept(scene, change, values):
        require_same(found.solution, own)


@pytest.mark.slow
def test_searches_follow_the_edges_of_the_scenes_before(scene: Scene) -> None:
    found = swept(scene, with_modulus, np.linspace(49e3, 55e3, 12))

    assert [each.followed for each, _ in found] == [False] + 11 * [True]
    # after a look on the given borders, one system on those where four scenes have shown that edges go
    assert [each.solution.contact_solutions for each, _ in found][4:] == 8 * [1]


def test_says_where_it_began_anew(scene: Scene) -> None:
    # From two moving edges to one.
    found = swept(scene, with_modulus, np.array([40e3, 42e3, 52e3]))

    assert [each.followed for each, _ in found] == [False, True, False]


def test_scenes_with_joints_and_beds_are_solved_too() -> None:
    for name in ("three-leaf-spring", "bar-lifting-off-a-bed"):
        scene = load_case(name).scene
        softer = [
            replace(
                scene,
                rods=tuple(replace(rod, material=replace(rod.material, young_modulus=modulus)) for rod in scene.rods),
            )
            for modulus in (200e3, 190e3)
        ]
        for found, own in zip(sweep(enumerate(softer), LEVEL, ORDER), softer, strict=True):
            require_same(found.solution, rm.solve(own, LEVEL, ORDER))
