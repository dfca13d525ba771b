"""Stress and its integrals from a nodal field."""

import numpy as np
import pytest

from cases.scene import Material
from reference3d.field import Field, displacement, mirrored, section_resultants, stress
from reference3d.grading import Borders
from reference3d.quadratic import line_nodes

MATERIAL = Material(1000.0, 0.25)


def field_of(borders, function):
    s, y, x = np.meshgrid(*(line_nodes(axis) for axis in (borders.s, borders.y, borders.x)), indexing="ij")
    return Field(borders, np.stack(np.broadcast_arrays(*function(x, y, s)), axis=-1))


def pure_bending(x, y, s, curvature=1e-3, ratio=0.25):
    """Saint-Venant bending about e1 with stress sigma_s = E curvature y, quadratic and so exact here."""
    return (
        -ratio * curvature * x * y,
        0.5 * curvature * (ratio * (x**2 - y**2) - s**2),
        curvature * y * s,
    )


def test_pure_bending_has_its_moment_and_no_other_resultant(graded_borders):
    """Section 7 by 4 mm with its axes off the centroid: N = E k int y dA, M1 = E k int y^2 dA, M2 = -E k int x y dA."""
    borders = Borders(graded_borders.x, np.array([-2.0, 0.5, 2.0]), graded_borders.s)
    field = field_of(borders, pure_bending)
    station = np.array([0.0, 1.0, 2.2, 8.0])

    resultants = section_resultants(field, MATERIAL, station)

    moment = 1000.0 * 1e-3 * 7.0 * 4.0**3 / 12.0
    expected = np.zeros((6, 4))
    expected[3] = moment
    np.testing.assert_allclose(resultants, expected, atol=1e-10 * moment)


def test_torsion_and_shear_have_the_signs_of_the_protocol():
    """u = -theta s y, v = theta s x: tau_xs = -mu theta y, tau_ys = mu theta x, T = mu theta Ip > 0."""
    line = np.array([-1.0, 1.0])
    borders, twist = Borders(line, line, np.array([0.0, 2.0])), 1e-3
    twisted = field_of(borders, lambda x, y, s: (-twist * s * y, twist * s * x, 0 * x))
    sheared = field_of(borders, lambda x, y, s: (1e-3 * s, 2e-3 * s, 0 * x))

    torque = section_resultants(twisted, MATERIAL, np.array([1.0]))[:, 0]
    shear = section_resultants(sheared, MATERIAL, np.array([1.0]))[:, 0]

    mu, area, polar = 400.0, 4.0, 16.0 / 6.0
    np.testing.assert_allclose(torque, [0, 0, 0, 0, 0, mu * twist * polar], atol=1e-12)
    np.testing.assert_allclose(shear, [0, 1e-3 * mu * area, 2e-3 * mu * area, 0, 0, 0], atol=1e-12)


def test_stress_where_elements_meet_is_their_mean():
    """A kink of w at s = 1: sigma_s jumps from E' to 3 E' there."""
    line = np.array([-1.0, 1.0])
    borders = Borders(line, line, np.array([0.0, 1.0, 2.0]))
    field = field_of(borders, lambda x, y, s: (0 * x, 0 * x, 1e-3 * np.where(s < 1.0, s, 3.0 * s - 2.0)))

    left, at, right = stress(field, MATERIAL, np.array([[0.0] * 3, [0.0] * 3, [0.5, 1.0, 1.5]]))[2]

    assert right == pytest.approx(3.0 * left)
    assert at == pytest.approx(2.0 * left)


def test_the_mirrored_half_is_the_full_field():
    x = np.array([-2.0, -0.5, 0.0, 0.5, 2.0])
    y, s = np.array([-1.0, 1.0]), np.array([0.0, 3.0])
    half = field_of(Borders(x[2:], y, s), pure_bending)
    full = field_of(Borders(x, y, s), pure_bending)
    points = np.array([[-1.7, 0.2, 1.1], [0.3, -0.9, 0.0], [0.1, 2.0, 3.0]])

    both = mirrored(half)

    np.testing.assert_allclose(both.nodal, full.nodal, atol=1e-15)
    np.testing.assert_array_equal(both.borders.x, x)
    np.testing.assert_allclose(displacement(both, points), np.stack(pure_bending(*points)), atol=1e-15)
