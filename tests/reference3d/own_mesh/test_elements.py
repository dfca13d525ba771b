"""Functions of elements are one at their node and zero at the others, and quadrature is exact where it must be."""

from __future__ import annotations

import numpy as np
import pytest

from reference3d.own_mesh.elements import KINDS, ElementKind

PLACES = np.random.default_rng(7).random((6, 3)) / 3.0


@pytest.fixture(params=KINDS)
def kind(request: pytest.FixtureRequest) -> ElementKind:
    return KINDS[request.param]


def test_a_function_is_one_at_its_node_and_zero_at_the_others(kind: ElementKind) -> None:
    assert kind.functions(kind.nodes) == pytest.approx(np.eye(len(kind.nodes)), abs=1e-12)


def test_functions_sum_to_one_and_linear_ones_are_among_them(kind: ElementKind) -> None:
    found = kind.functions(PLACES)

    assert found.sum(axis=1) == pytest.approx(np.ones(len(PLACES)))
    assert found @ kind.nodes == pytest.approx(PLACES)


def test_slopes_are_those_of_the_functions(kind: ElementKind) -> None:
    step = 1e-6
    for axis in range(3):
        move = step * np.eye(3)[axis]
        difference = (kind.functions(PLACES + move) - kind.functions(PLACES - move)) / (2.0 * step)
        assert kind.slopes(PLACES)[:, :, axis] == pytest.approx(difference, abs=1e-8)


def test_quadrature_fills_the_element_and_integrates_squares_of_its_slopes(kind: ElementKind) -> None:
    place, weight = kind.quadrature

    assert weight.sum() == pytest.approx(1.0 / 6.0 if kind.is_simplex else 8.0)
    assert kind.beyond(place).max() < 0.0
    if kind.name != "tetra":  # whose slopes are constant
        # int x^2: 2 / 5! of the simplex, 8 / 3 of the cube
        assert weight @ place**2 == pytest.approx(np.full(3, 1.0 / 60.0 if kind.is_simplex else 8.0 / 3.0))


def test_faces_look_outwards_and_enclose_the_element(kind: ElementKind) -> None:
    # divergence theorem: int x . n / 3 over all faces is the volume
    enclosed = 0.0
    for face in range(len(kind.faces)):
        place, tangents, hats, weight = kind.face_quadrature(face)
        outward = np.cross(tangents[:, 0], tangents[:, 1])
        enclosed += weight @ np.einsum("nc,nc->n", place, outward) / 3.0
        assert hats.sum(axis=1) == pytest.approx(np.ones(len(place)))
        assert (weight @ hats).min() > 0.0
    assert enclosed == pytest.approx(kind.quadrature[1].sum())
