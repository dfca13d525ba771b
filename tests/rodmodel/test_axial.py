"""Functions along the rod: hierarchic shape functions and quadratures."""

import numpy as np
import pytest
from numpy.polynomial import Polynomial

from rodmodel.axial import axial_matrices, lobatto, shape_function_slopes, shape_functions


@pytest.mark.parametrize("order", [2, 3, 6, 20])
def test_nodal_functions_are_one_at_their_node_and_bubbles_vanish_at_both(order: int) -> None:
    values = shape_functions(order, np.array([-1.0, 1.0]))
    expected = np.zeros((order + 1, 2))
    expected[0, 0] = expected[1, 1] = 1.0
    np.testing.assert_allclose(values, expected, atol=1e-14)  # round-off of the recurrence


@pytest.mark.parametrize("order", [2, 6, 20])
def test_slopes_are_the_derivatives_of_the_values(order: int) -> None:
    nodes = np.cos(np.linspace(0.0, np.pi, order + 1))
    xi = np.linspace(-0.9, 0.9, 7)
    slopes = shape_function_slopes(order, xi)
    for values, slope in zip(shape_functions(order, nodes), slopes, strict=True):
        # the polynomial through order + 1 points, differentiated
        polynomial = Polynomial.fit(nodes, values, order)
        np.testing.assert_allclose(slope, polynomial.deriv()(xi), atol=1e-10)


@pytest.mark.parametrize("order", [2, 6, 12])
def test_bubbles_are_orthonormal_in_the_energy(order: int) -> None:
    _, _, m11 = axial_matrices(order)
    np.testing.assert_allclose(m11[2:, 2:], np.eye(order - 1), atol=1e-13)


def test_mixed_matrix_integrates_by_parts() -> None:
    _, m01, _ = axial_matrices(6)
    ends = shape_functions(6, np.array([-1.0, 1.0]))
    boundary = np.outer(ends[:, 1], ends[:, 1]) - np.outer(ends[:, 0], ends[:, 0])
    np.testing.assert_allclose(m01 + m01.T, boundary, atol=1e-13)


@pytest.mark.parametrize("count", [3, 5, 8, 20])
def test_lobatto_is_exact_to_degree_two_n_minus_three_and_no_further(count: int) -> None:
    xi, weight = lobatto(count)
    assert xi[0] == -1.0
    assert xi[-1] == 1.0
    for degree in range(2 * count - 2):
        exact = 2.0 / (degree + 1) if degree % 2 == 0 else 0.0
        assert weight @ xi**degree == pytest.approx(exact, abs=1e-13)
    degree = 2 * count - 2
    assert abs(weight @ xi**degree - 2.0 / (degree + 1)) > 1e-14
