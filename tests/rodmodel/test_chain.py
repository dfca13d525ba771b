"""The rod as a chain: block factorisation, functionals and compliances, against a dense solution of everything."""

from collections.abc import Callable
from itertools import pairwise

import numpy as np
import pytest

import rodmodel as rm
from rodmodel.assembly import ElementStore, assembled_rod, coefficients, combined, compliance, functionals, point_parts
from rodmodel.axial import shape_functions
from rodmodel.mesh import RodMesh
from rodmodel.section import STRAIGHT, Fields, section_stiffness
from rodmodel.stiffness import stiffness_terms

FULL = (False, False)
BORDERS = np.array([0.0, 40.0, 100.0, 130.0])


def uniform(borders: np.ndarray, level: int, order: int) -> RodMesh:
    count = len(borders) - 1
    return RodMesh(borders, np.full(count, level), np.full(count, order))


@pytest.fixture
def scene(cantilever: Callable[..., rm.Scene]) -> rm.Scene:
    return cantilever((0.0, 0.0, 0.0), length=130.0)


def dense_inverse(scene: rm.Scene, fields: Fields, order: int, borders: np.ndarray) -> np.ndarray:
    """Inverse stiffness on all nodes and bubbles of the clamped rod: node dofs first, then bubbles by element."""
    n, n_elements = fields.count, len(borders) - 1
    terms = stiffness_terms(order, section_stiffness(scene.rods[0].section, scene.rods[0].material, fields, STRAIGHT))
    size = n * (n_elements + 1 + n_elements * (order - 1))
    stiffness = np.zeros((size, size))
    for index, length in enumerate(np.diff(borders)):
        rows = np.concatenate(
            [
                np.arange(index * n, (index + 2) * n),
                n * (n_elements + 1) + np.arange(index * n * (order - 1), (index + 1) * n * (order - 1)),
            ]
        )
        stiffness[np.ix_(rows, rows)] += np.tensordot([0.5 * length, 1.0, 2.0 / length], terms, axes=1)
    inverse = np.zeros_like(stiffness)
    inverse[n:, n:] = np.linalg.inv(stiffness[n:, n:])
    return inverse


def test_compliance_is_that_of_the_dense_stiffness(scene: rm.Scene) -> None:
    order, fields = 4, Fields(2)
    rng = np.random.default_rng(2)
    station = np.array([130.0, 40.0, 71.0, 95.0, 12.0])
    direction = rng.standard_normal((fields.count, len(station)))
    assembled = assembled_rod(scene, scene.rods[0], FULL, uniform(BORDERS, 2, order), ElementStore())

    found = compliance(functionals(assembled, point_parts(assembled, station, lambda _: direction), len(station)))

    inverse = dense_inverse(scene, fields, order, BORDERS)
    rows = np.zeros((len(inverse), len(station)))
    index, xi = assembled.locate(station)
    along = shape_functions(order, xi)
    n = fields.count
    for point, element in enumerate(index):
        rows[element * n : (element + 2) * n, point] += np.kron(along[:2, point], direction[:, point])
        first = n * len(BORDERS) + element * n * (order - 1)
        rows[first : first + n * (order - 1), point] += np.kron(along[2:, point], direction[:, point])
    expected = rows.T @ inverse @ rows
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-10 * np.abs(expected).max())


def test_coefficients_answer_each_of_the_loads_they_were_solved_for(scene: rm.Scene) -> None:
    order, fields = 4, Fields(2)
    station = np.array([40.0, 95.0])
    direction = np.random.default_rng(3).standard_normal((fields.count, len(station)))
    assembled = assembled_rod(scene, scene.rods[0], FULL, uniform(BORDERS, 2, order), ElementStore())
    loads = functionals(assembled, point_parts(assembled, station, lambda _: direction), len(station))

    values = coefficients(assembled, combined(loads, np.eye(len(station))), {})

    index, xi = assembled.locate(station)
    along = shape_functions(order, xi)
    moved = [np.einsum("a,afm,f->m", along[:, n], values[index[n]], direction[:, n]) for n in range(len(station))]
    expected = compliance(loads)
    np.testing.assert_allclose(moved, expected, rtol=0.0, atol=1e-10 * np.abs(expected).max())
    assert np.abs(values[0][0]).max() == 0.0  # the clamp
    for before, after in pairwise(values):
        np.testing.assert_array_equal(before[1], after[0])  # continuity


@pytest.mark.parametrize("clamps", [("start",), ("end",), ("start", "end")])
def test_factors_taken_over_from_another_chain_change_nothing(scene: rm.Scene, clamps: tuple[str, ...]) -> None:
    held = rm.Scene("held", scene.rods, tuple(rm.Clamp("bar", end) for end in clamps), (), ())
    fields, store = Fields(2), ElementStore()
    station = np.array([12.0, 71.0, 95.0])
    direction = np.random.default_rng(4).standard_normal((fields.count, len(station)))
    for borders in (BORDERS, np.array([0.0, 40.0, 90.0, 130.0]), np.array([0.0, 35.0, 90.0, 130.0]), BORDERS):
        reused = assembled_rod(held, held.rods[0], FULL, uniform(borders, 2, 3), store)
        fresh = assembled_rod(held, held.rods[0], FULL, uniform(borders, 2, 3), ElementStore())
        answers = [
            compliance(functionals(rod, point_parts(rod, station, lambda _: direction), len(station)))
            for rod in (reused, fresh)
        ]
        np.testing.assert_allclose(answers[0], answers[1], rtol=1e-12)


def test_a_rod_without_a_clamp_has_no_factor(scene: rm.Scene) -> None:
    loose = rm.Scene("loose", scene.rods, (), (), ())
    with pytest.raises(np.linalg.LinAlgError):
        assembled_rod(loose, loose.rods[0], FULL, uniform(BORDERS, 2, 3), ElementStore())


def test_equal_elements_are_made_once(scene: rm.Scene) -> None:
    borders = np.array([0.0, 40.0, 80.0, 120.0, 130.0])
    assembled = assembled_rod(scene, scene.rods[0], FULL, uniform(borders, 2, 3), ElementStore())
    assert assembled.elements[0] is assembled.elements[1] is assembled.elements[2]
    assert assembled.elements[3] is not assembled.elements[0]


def test_unequal_levels_are_the_high_one_with_the_missing_functions_held(scene: rm.Scene) -> None:
    """Levels 3, 1, 2: the dense stiffness of level 3, order by order, with the functions the others lack removed."""
    levels, order = np.array([3, 1, 2]), 3
    station = np.array([10.0, 40.0, 60.0, 120.0])
    high = Fields(3)
    direction = np.random.default_rng(5).standard_normal((high.count, len(station)))
    mesh = RodMesh(BORDERS, levels, np.full(3, order))
    material = rm.Material(scene.rods[0].material.young_modulus, 0.0)  # the reduced law of h1 is the full one here
    bar = rm.Rod("bar", scene.rods[0].centre_line, scene.rods[0].section, material, scene.rods[0].element_borders)
    scene = rm.Scene("levels", (bar,), scene.supports, (), ())
    assembled = assembled_rod(scene, bar, FULL, mesh, ElementStore())
    parts = point_parts(assembled, station, lambda fields: direction[fields.within(high)])
    found = compliance(functionals(assembled, parts, len(station)))

    n, n_elements = high.count, 3
    carried = [Fields(int(level)).within(high) for level in levels]
    nodes = [np.empty(0, dtype=int), carried[1], carried[1], carried[2]]
    size = n * (n_elements + 1 + n_elements * (order - 1))
    terms = stiffness_terms(order, section_stiffness(bar.section, material, high, STRAIGHT))
    stiffness, rows = np.zeros((size, size)), np.zeros((size, len(station)))
    index, xi = assembled.locate(station)
    along = shape_functions(order, xi)
    free: list[int] = [node * n + int(field) for node in range(4) for field in nodes[node]]
    for element, length in enumerate(np.diff(BORDERS)):
        first = n * (n_elements + 1) + element * n * (order - 1)
        place = np.concatenate([np.arange(element * n, (element + 2) * n), np.arange(first, first + n * (order - 1))])
        stiffness[np.ix_(place, place)] += np.tensordot([0.5 * length, 1.0, 2.0 / length], terms, axes=1)
        free += [first + bubble * n + int(field) for bubble in range(order - 1) for field in carried[element]]
        for point in np.flatnonzero(index == element):
            rows[place, point] += np.kron(along[:, point], direction[:, point])
    expected = rows[free].T @ np.linalg.solve(stiffness[np.ix_(free, free)], rows[free])
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-10 * np.abs(expected).max())
