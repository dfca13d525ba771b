"""Element stiffness and the condensation of its bubbles."""

import numpy as np
import pytest

from cases.scene import Circle, Material, Orthotropic, Rectangle
from rodmodel.axial import axial_matrices
from rodmodel.section import (
    STRAIGHT,
    Fields,
    SectionStiffness,
    U,
    V,
    W,
    elasticity_matrix,
    product_quadrature,
    section_stiffness,
    strain_operators,
)
from rodmodel.stiffness import (
    axial_quadrature,
    condensed_element,
    element_family,
    stiffness_terms,
    varying_element,
)

SECTION = Rectangle(15.0, 10.0)
MATERIAL = Material(1.0, 0.3)
LENGTH = 40.0


def element_stiffness(length: float, order: int, section: SectionStiffness) -> np.ndarray:
    return np.tensordot([0.5 * length, 1.0, 2.0 / length], stiffness_terms(order, section), axes=1)


@pytest.mark.parametrize("turning", [STRAIGHT, (0.01, -0.02, 0.03)])
@pytest.mark.parametrize("fields", [Fields(1), Fields(3), Fields(4, mirror_x=True), Fields(4, mirror_y=True)])
@pytest.mark.parametrize("material", [MATERIAL, Orthotropic((30.0, 20.0, 50.0), (4.0, 5.0, 6.0), (0.2, 0.1, 0.15))])
def test_section_stiffness_is_the_energy_of_the_strains(material, fields, turning) -> None:
    """Assembled from shared products of functions; here from strains at points, as they are defined."""
    x, y, weight = product_quadrature(SECTION, fields.level, turning)
    b0, b1, stretch = strain_operators(SECTION, fields, x, y, turning)
    law = elasticity_matrix(material, fields.level)
    found = section_stiffness(SECTION, material, fields, turning)
    for matrix, first, second in ((found.s00, b0, b0), (found.s01, b0, b1), (found.s11, b1, b1)):
        expected = np.einsum("pri,rs,psj,p->ij", first, law, second, weight * stretch, optimize=True)
        np.testing.assert_allclose(matrix, expected, atol=1e-13 * np.abs(found.s11).max())


def test_section_stiffness_at_many_stations_is_that_at_each() -> None:
    turning = np.array([[0.01, 0.0, -0.02], [0.03, 0.0, 0.01], [0.0, 0.0, 0.05]])
    together = section_stiffness(Circle(9.0), MATERIAL, Fields(2), turning)
    for index, rates in enumerate(turning.T):
        alone = section_stiffness(Circle(9.0), MATERIAL, Fields(2), tuple(rates))
        for many, one in ((together.s00, alone.s00), (together.s01, alone.s01), (together.s11, alone.s11)):
            # a straight station among curved ones has more points than it needs
            np.testing.assert_allclose(many[index], one, atol=1e-12 * np.abs(one).max())


def test_quadrature_between_knots_is_as_exact_as_without() -> None:
    order, left, right = 5, 10.0, 30.0
    xi, weight = axial_quadrature(order, left, right, np.array([-5.0, 12.0, 25.0, 40.0]))
    # Smooth between knots at xi = -0.8 and 0.5 only.
    kinked = np.abs(xi + 0.8) + np.maximum(xi - 0.5, 0.0)
    assert weight @ kinked == pytest.approx(0.5 * (0.2**2 + 1.8**2) + 0.5 * 0.5**2, rel=1e-14)
    degrees = np.arange(2 * order + 1)
    exact = np.where(degrees % 2 == 0, 2.0 / (degrees + 1), 0.0)
    np.testing.assert_allclose(xi ** degrees[:, None] @ weight, exact, atol=1e-14)


def test_element_of_constant_turning_is_that_without_quadrature() -> None:
    turning, order, fields = (0.01, -0.02, 0.03), 4, Fields(3)
    quadrature = axial_quadrature(order, 0.0, LENGTH, np.array([15.0]))
    rates = np.repeat(np.array(turning)[:, None], len(quadrature[0]), axis=1)
    varying = varying_element(order, fields, LENGTH, quadrature, section_stiffness(SECTION, MATERIAL, fields, rates))
    section = section_stiffness(SECTION, MATERIAL, fields, turning)
    expected = condensed_element(element_family(order, fields, section, reversible=False), LENGTH)
    scale = np.abs(expected.condensed).max()
    np.testing.assert_allclose(varying.condensed, expected.condensed, atol=1e-12 * scale)
    np.testing.assert_allclose(varying.half_coupling, expected.half_coupling, atol=1e-12 * np.sqrt(scale))


def test_element_is_the_kronecker_sum() -> None:
    stiffness = section_stiffness(SECTION, MATERIAL, Fields(2), STRAIGHT)
    m00, m01, m11 = axial_matrices(4)
    mixed = np.kron(m01, stiffness.s01)
    expected = np.kron(LENGTH / 2.0 * m00, stiffness.s00) + mixed + mixed.T + np.kron(2.0 / LENGTH * m11, stiffness.s11)
    np.testing.assert_allclose(element_stiffness(LENGTH, 4, stiffness), expected, atol=1e-12)


@pytest.mark.parametrize("level", [1, 2, 5])
def test_only_the_six_rigid_motions_cost_no_energy(level: int) -> None:
    stiffness = element_stiffness(LENGTH, 3, section_stiffness(SECTION, MATERIAL, Fields(level), STRAIGHT))
    eigenvalues = np.linalg.eigvalsh(stiffness)
    scale = eigenvalues[-1]
    assert np.abs(eigenvalues[:6]).max() < 1e-13 * scale
    assert eigenvalues[6] > 1e-9 * scale


def exact_degrees(level: int, displacement: dict[tuple[int, int, int], np.ndarray]) -> np.ndarray:
    """Degrees of freedom of an element of order 2 for fields given as quadratics in xi (values at -1, 0, 1)."""
    fields = Fields(level)
    values = np.zeros((3, fields.count))
    for key, (left, middle, right) in displacement.items():
        index = fields.index(*key)
        assert index is not None
        # N_2 = sqrt(3/8) (xi^2 - 1): it carries what the middle is off the straight line
        bubble = (middle - 0.5 * (left + right)) / -np.sqrt(3.0 / 8.0)
        values[:, index] = left, right, bubble
    return values.ravel()


def test_tension_with_contraction_is_exact_at_h2() -> None:
    """w = eps s, u = -nu eps x, v = -nu eps y: no force but sigma = E eps on the two end sections."""
    half_x, half_y = SECTION.width / 2.0 / np.sqrt(3.0), SECTION.height / 2.0 / np.sqrt(3.0)
    degrees = exact_degrees(
        2,
        {
            (W, 0, 0): np.array([0.0, 0.5, 1.0]) * LENGTH,
            (U, 1, 0): np.full(3, -0.3 * half_x),
            (V, 0, 1): np.full(3, -0.3 * half_y),
        },
    )
    force = element_stiffness(LENGTH, 2, section_stiffness(SECTION, MATERIAL, Fields(2), STRAIGHT)) @ degrees
    expected = np.zeros((3, Fields(2).count))
    expected[:2, Fields(2).index(W, 0, 0)] = np.array([-1.0, 1.0]) * SECTION.width * SECTION.height
    np.testing.assert_allclose(force.reshape(3, -1), expected, atol=1e-9)


def test_pure_bending_with_its_anticlastic_shape_is_exact_at_h2() -> None:
    """w = -k s y, v = k s^2/2 + nu k (y^2 - x^2)/2, u = nu k x y: forces only from sigma_s = -E k y at the ends."""
    half_x, half_y = SECTION.width / 2.0, SECTION.height / 2.0
    station = np.array([-1.0, 0.0, 1.0]) * LENGTH / 2.0
    # y = (half_y / sqrt 3) phi_01;  x^2 = half_x^2 (1/3 + 2/(3 sqrt 5) phi_20), with mean-square-one functions
    square = 2.0 / (3.0 * np.sqrt(5.0))
    degrees = exact_degrees(
        2,
        {
            (W, 0, 1): -station * half_y / np.sqrt(3.0),
            (V, 0, 0): station**2 / 2.0 + 0.15 * (half_y**2 - half_x**2) / 3.0,
            (V, 0, 2): np.full(3, 0.15 * half_y**2 * square),
            (V, 2, 0): np.full(3, -0.15 * half_x**2 * square),
            (U, 1, 1): np.full(3, 0.3 * half_x * half_y / 3.0),
        },
    )
    force = element_stiffness(LENGTH, 2, section_stiffness(SECTION, MATERIAL, Fields(2), STRAIGHT)) @ degrees
    moment_of_area = SECTION.width * SECTION.height**3 / 12.0
    expected = np.zeros((3, Fields(2).count))
    expected[:2, Fields(2).index(W, 0, 1)] = np.array([1.0, -1.0]) * moment_of_area / (half_y / np.sqrt(3.0))
    np.testing.assert_allclose(force.reshape(3, -1), expected, atol=1e-9 * moment_of_area)


def test_condensed_element_answers_as_the_whole() -> None:
    section = section_stiffness(SECTION, MATERIAL, Fields(3), STRAIGHT)
    whole, element = (
        element_stiffness(LENGTH, 5, section),
        condensed_element(element_family(5, Fields(3), section, reversible=True), LENGTH),
    )
    n = len(element.condensed)
    schur = whole[:n, :n] - whole[:n, n:] @ np.linalg.solve(whole[n:, n:], whole[n:, :n])
    np.testing.assert_allclose(element.condensed, schur, atol=1e-11 * np.abs(schur).max())
