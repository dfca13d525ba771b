"""Functions over the section and section stiffness matrices."""

import numpy as np
import pytest

from cases.scene import Material, Rectangle
from rodmodel.section import (
    STRAIGHT,
    Fields,
    U,
    V,
    W,
    elasticity_matrix,
    product_quadrature,
    section_slopes,
    section_stiffness,
    section_values,
    strain_operators,
)

SECTION = Rectangle(width=12.0, height=20.0)
STEEL = Material(200e3, 0.3)


@pytest.mark.parametrize(("level", "count"), [(1, 9), (2, 18), (3, 30), (4, 45), (5, 63), (6, 84)])
def test_a_level_has_the_complete_polynomials_of_pascals_triangle(level: int, count: int) -> None:
    assert Fields(level).count == count


@pytest.mark.parametrize("level", [1, 4, 12])
def test_functions_are_orthonormal_over_the_section(level: int) -> None:
    fields = Fields(level)
    x, y, weight = product_quadrature(SECTION, level, STRAIGHT)
    values = section_values(SECTION, fields, x, y)
    one = values[fields.indices(U)]
    gram = (one * weight) @ one.T / (SECTION.width * SECTION.height)
    np.testing.assert_allclose(gram, np.eye(len(gram)), atol=1e-12)  # round-off at degree 24


def test_slopes_are_the_derivatives_of_the_values() -> None:
    fields, x, y, step = Fields(5), np.array([1.0, -3.0]), np.array([4.0, 9.0]), 1e-5
    slope_x, slope_y = section_slopes(SECTION, fields, x, y)
    for slope, dx, dy in ((slope_x, step, 0.0), (slope_y, 0.0, step)):
        ahead = section_values(SECTION, fields, x + dx, y + dy)
        behind = section_values(SECTION, fields, x - dx, y - dy)
        # central differences: step^2 times a third derivative of order 1
        np.testing.assert_allclose((ahead - behind) / (2.0 * step), slope, atol=1e-7)


@pytest.mark.parametrize(("mirror_x", "mirror_y"), [(True, False), (False, True), (True, True)])
def test_mirrored_fields_are_those_that_reflection_leaves(mirror_x: bool, mirror_y: bool) -> None:
    fields = Fields(5, mirror_x, mirror_y)
    x, y = np.array([2.0, 5.0]), np.array([3.0, 7.0])
    values = section_values(SECTION, fields, x, y)
    for mirrored, across, point in ((mirror_x, U, (-x, y)), (mirror_y, V, (x, -y))):
        if mirrored:
            reflected = section_values(SECTION, fields, *point)
            sign = np.where(fields.table[0] == across, -1.0, 1.0)[:, None]
            np.testing.assert_allclose(reflected, sign * values, atol=1e-13)


def test_halves_of_the_fields_make_the_whole() -> None:
    all_fields = {tuple(column) for column in Fields(4).table.T}
    even = {tuple(column) for column in Fields(4, mirror_x=True).table.T}
    odd = {(c, i, j) for c, i, j in all_fields if i % 2 != (c == U)}
    assert even | odd == all_fields
    assert not even & odd


def test_hookes_law_gives_uniaxial_stress_under_uniaxial_strain_with_contraction() -> None:
    stress = elasticity_matrix(STEEL, 2) @ np.array([-0.3, -0.3, 1.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(stress, [0.0, 0.0, 200e3, 0.0, 0.0, 0.0], atol=1e-9)


def test_first_level_gets_the_reduced_law() -> None:
    stress = elasticity_matrix(STEEL, 1) @ np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(stress, [0.0, 0.0, 200e3, 0.0, 0.0, 0.0], atol=1e-9)


@pytest.mark.slow
def test_stiffness_integrates_the_energy_of_any_strain() -> None:
    """Energy density by brute force at many points against psi^T S psi."""
    fields = Fields(3)
    rng = np.random.default_rng(1)
    psi, slope = rng.standard_normal((2, fields.count))
    stiffness = section_stiffness(SECTION, STEEL, fields, STRAIGHT)
    n = 400
    x, y = (side * (np.arange(n) + 0.5) / n - side / 2.0 for side in (SECTION.width, SECTION.height))
    grid_x, grid_y = (axis.ravel() for axis in np.meshgrid(x, y))
    b0, b1, _ = strain_operators(SECTION, fields, grid_x, grid_y, STRAIGHT)
    strain = b0 @ psi + b1 @ slope
    energy = np.einsum("pi,ij,pj->", strain, elasticity_matrix(STEEL, 3), strain)
    energy *= SECTION.width * SECTION.height / n**2
    quadratic = psi @ stiffness.s00 @ psi + 2.0 * psi @ stiffness.s01 @ slope + slope @ stiffness.s11 @ slope
    assert quadratic == pytest.approx(energy, rel=1e-4)  # midpoint rule with n^2 points


def test_fields_are_found_by_what_they_are() -> None:
    fields = Fields(2, mirror_x=True)
    assert fields.index(U, 0, 0) is None
    index = fields.index(W, 0, 1)
    assert index is not None
    assert tuple(fields.table[:, index]) == (W, 0, 1)
