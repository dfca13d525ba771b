"""Element stiffness and the condensation of its bubbles."""

import numpy as np
import pytest

from cases.scene import Material, Rectangle
from rodmodel.axial import axial_matrices
from rodmodel.section import STRAIGHT, Fields, SectionStiffness, U, V, W, section_stiffness
from rodmodel.stiffness import condensed_element, element_family, stiffness_terms

SECTION = Rectangle(15.0, 10.0)
MATERIAL = Material(1.0, 0.3)
LENGTH = 40.0


def element_stiffness(length: float, order: int, section: SectionStiffness) -> np.ndarray:
    return np.tensordot([0.5 * length, 1.0, 2.0 / length], stiffness_terms(order, section), axes=1)


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
