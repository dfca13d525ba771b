"""Quadratic interpolation along a line of elements."""

import numpy as np
import pytest

from reference3d.quadratic import line_nodes, locate, nodal_weights, shape_derivatives, shape_functions

BORDERS = np.array([0.0, 1.0, 3.0, 3.5])


def interpolate(values, coordinate, side="left"):
    element, xi = locate(BORDERS, coordinate, side)
    return np.einsum("in,in->n", shape_functions(xi), values[2 * element + np.arange(3)[:, None]])


def test_quadratic_polynomials_are_interpolated_exactly():
    nodes, places = line_nodes(BORDERS), np.linspace(0.0, 3.5, 50)

    interpolated = interpolate(2.0 - nodes + 3.0 * nodes**2, places)

    np.testing.assert_allclose(interpolated, 2.0 - places + 3.0 * places**2, rtol=1e-13)


def test_derivatives_are_those_of_the_shape_functions():
    xi, step = np.linspace(-1.0, 1.0, 7), 1e-5

    # central differences of quadratics are exact up to cancellation, 1e-16 / 1e-5
    differences = (shape_functions(xi + step) - shape_functions(xi - step)) / (2.0 * step)

    np.testing.assert_allclose(shape_derivatives(xi), differences, atol=1e-10)


@pytest.mark.parametrize(("side", "element"), [("left", 0), ("right", 1)])
def test_a_common_border_belongs_to_the_element_on_the_side_asked_for(side, element):
    # 1e-12 off the border: still the border, up to round-off
    found, xi = locate(BORDERS, np.array([1.0 + 1e-12]), side)

    assert found[0] == element
    assert abs(xi[0]) == 1.0


def test_weights_integrate_cubic_polynomials_between_two_borders():
    nodes = line_nodes(BORDERS)

    weights = nodal_weights(BORDERS, 1.0, 3.5)

    # Simpson's rule is exact up to degree 3
    assert weights @ nodes**3 == pytest.approx((3.5**4 - 1.0) / 4.0, rel=1e-14)


def test_elements_outside_give_no_weight_to_the_node_they_share():
    inner, everywhere = nodal_weights(BORDERS, 1.0, 3.0), nodal_weights(BORDERS, 0.0, 3.5)

    assert inner[2] == pytest.approx(2.0 / 6.0)
    assert everywhere[2] == pytest.approx(2.0 / 6.0 + 1.0 / 6.0)
    assert not inner[[0, 1, 5, 6]].any()
    assert (inner[2:5] > 0.0).all()
