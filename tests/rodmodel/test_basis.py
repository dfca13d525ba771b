"""Functions over sections of any shape: orthonormal, graded, of the right parity, complete."""

import math

import numpy as np
import pytest
from scipy.special import eval_jacobi, eval_legendre

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Section
from rodmodel.basis import basis_slopes, basis_values, section_basis
from rodmodel.shape import extents, mirror_planes, section_quadrature


def i_shape(width: float, height: float, wall: float) -> Polygon:
    b, a, t = width / 2, height / 2, wall / 2
    lower = ((-b, -a), (b, -a), (b, wall - a), (t, wall - a))
    return Polygon(
        (
            *lower,
            (t, a - wall),
            (b, a - wall),
            (b, a),
            (-b, a),
            (-b, a - wall),
            (-t, a - wall),
            (-t, wall - a),
            (-b, wall - a),
        )
    )


L_SHAPE = Polygon(((0.0, 0.0), (10.0, 0.0), (10.0, 1.0), (1.0, 1.0), (1.0, 15.0), (0.0, 15.0)))
PIERCED = Polygon(((0, 0), (12, 1), (11, 9), (2, 8)), (((3, 3), (3, 5), (5, 4)), ((7, 3), (9, 3), (8, 6))))
STOUT = {
    "rectangle": Rectangle(12.0, 20.0),
    "circle": Circle(10.0),
    "ring": Ring(20.0, 14.0),
    "box": Box(12.0, 20.0, 1.5),
    "I": i_shape(10.0, 20.0, 2.0),
    "L": L_SHAPE,
    "T": Polygon(((-5, 0), (5, 0), (5, 2), (1, 2), (1, 9), (-1, 9), (-1, 2), (-5, 2))),
    "pierced": PIERCED,
}
# Walls of 1 % of the radius, or of the width.
THIN = {
    "thin ring": Ring(20.0, 19.8),
    "thin box": Box(10.0, 20.0, 0.1),
    "thin I": i_shape(10.0, 10.0, 0.1),
    "thin L": Polygon(((0.0, 0.0), (10.0, 0.0), (10.0, 0.1), (0.1, 0.1), (0.1, 10.0), (0.0, 10.0))),
}
SECTIONS = STOUT | THIN


def gram_matrix(section: Section, level: int) -> np.ndarray:
    """Of the functions over the section, by a rule other than those they are made with."""
    x, y, weight = section_quadrature(section, 2 * level + 5)
    values = basis_values(section_basis(section, level), x, y)
    return (values * (weight / np.sum(weight))) @ values.T


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize(("level", "loss"), [(1, 1e-12), (6, 1e-12), (12, 1e-11), (16, 1e-9)])
def test_functions_are_orthonormal_over_the_section(name: str, level: int, loss: float) -> None:
    gram = gram_matrix(SECTIONS[name], level)

    # round-off, times the loss by thin walls and, on sections with arms at high level, by the recurrence; the worst
    # measured: 3e-13 (thin I), 3e-13 (thin I), 2e-12 (T), 3e-10 (T)
    np.testing.assert_allclose(gram, np.eye(len(gram)), atol=loss)


@pytest.mark.parametrize("section", [Ring(20.0, 19.98), Box(10.0, 10.0, 0.01), i_shape(10.0, 10.0, 0.01)])
def test_walls_of_a_thousandth_keep_nine_digits_far_above_h6(section: Section) -> None:
    gram = gram_matrix(section, 12)

    np.testing.assert_allclose(gram, np.eye(len(gram)), atol=1e-9)  # measured 1e-10 for the I


@pytest.mark.parametrize(
    "section", [Ring(20.0, 20.0 - 2e-8), Box(10.0, 10.0, 1e-8), i_shape(10.0, 10.0, 1e-6)], ids=["ring", "box", "I"]
)
def test_walls_too_thin_for_the_level_are_refused(section: Section) -> None:
    with pytest.raises(ValueError, match=r"(ring|box|polygon) of \d+ x \d+ mm: found walls so thin .* a lower level"):
        section_basis(section, 6)


@pytest.mark.parametrize(("level", "count"), [(0, 1), (1, 3), (2, 6), (6, 28)])
def test_a_level_has_all_degrees_of_pascals_triangle_in_its_order(level: int, count: int) -> None:
    basis = section_basis(PIERCED, level)

    assert basis.count == basis.degrees.shape[1] == count
    pairs = [tuple(pair) for pair in basis.degrees.T]
    assert pairs == sorted(pairs, key=lambda pair: (sum(pair), pair[1]))
    assert all(sum(pair) <= level for pair in pairs)
    assert len(set(pairs)) == count


@pytest.mark.parametrize("name", SECTIONS)
def test_the_first_function_is_one_and_the_next_are_linear(name: str) -> None:
    section = SECTIONS[name]
    x, y, weight = section_quadrature(section, 2)
    values = basis_values(section_basis(section, 1), x, y)

    share = weight / np.sum(weight)
    np.testing.assert_allclose(values[0], 1.0, atol=1e-12)
    np.testing.assert_allclose(values[1], x / math.sqrt(share @ x**2), atol=1e-11)
    # y less its part along x, which is none for principal axes
    rest = y - (share @ (x * y)) / (share @ x**2) * x
    np.testing.assert_allclose(values[2], rest / math.sqrt(share @ rest**2), atol=1e-11)


@pytest.mark.parametrize("name", SECTIONS)
def test_a_level_adds_functions_and_leaves_those_below(name: str) -> None:
    section = SECTIONS[name]
    x, y, _ = section_quadrature(section, 9)
    below = basis_values(section_basis(section, 4), x, y)

    above = basis_values(section_basis(section, 7), x, y)
    # boxes and polygons to the last bit; rings by a rule of its own for each level
    np.testing.assert_allclose(above[: len(below)], below, atol=1e-11)


@pytest.mark.parametrize("name", SECTIONS)
def test_symmetry_gives_each_function_the_parity_of_its_monomial(name: str) -> None:
    section = SECTIONS[name]
    basis = section_basis(section, 8)
    x, y, _ = section_quadrature(section, 7)
    values = basis_values(basis, x, y)

    for axis, (is_mirror, image) in enumerate(zip(mirror_planes(section), ((-x, y), (x, -y)), strict=True)):
        if is_mirror:
            sign = (-1.0) ** basis.degrees[axis]
            np.testing.assert_array_equal(basis_values(basis, *image), sign[:, None] * values)


@pytest.mark.parametrize("name", SECTIONS)
def test_every_monomial_of_the_level_is_a_combination_of_the_functions(name: str) -> None:
    section, level = SECTIONS[name], 6
    basis = section_basis(section, level)
    x, y, weight = section_quadrature(section, 2 * level)
    values, share = basis_values(basis, x, y), weight / np.sum(weight)
    x_min, x_max, y_min, y_max = extents(section)

    for i, j in basis.degrees.T:
        monomial = (2.0 * x / (x_max - x_min)) ** i * (2.0 * y / (y_max - y_min)) ** j
        coefficient = values @ (share * monomial)
        np.testing.assert_allclose(coefficient @ values, monomial, atol=1e-10)  # round-off of thin sections
        # and of none above its degree
        np.testing.assert_allclose(coefficient[np.sum(basis.degrees, axis=0) > i + j], 0.0, atol=1e-11)


@pytest.mark.parametrize("name", ["rectangle", "box", "I", "L", "pierced"])
def test_functions_are_their_monomial_and_those_before_it(name: str) -> None:
    section, level = SECTIONS[name], 5
    basis = section_basis(section, level)
    x, y, weight = section_quadrature(section, 2 * level)
    values = basis_values(basis, x, y)

    monomials = (x / 10.0) ** basis.degrees[:1].T * (y / 10.0) ** basis.degrees[1:].T
    coefficient = (monomials * weight) @ values.T / np.sum(weight)
    np.testing.assert_allclose(np.triu(coefficient, 1), 0.0, atol=1e-13)
    assert np.all(np.diag(coefficient) > 0.0)


def test_rectangles_have_products_of_legendre_polynomials() -> None:
    section = Rectangle(12.0, 20.0)
    basis, (x, y, _) = section_basis(section, 7), section_quadrature(section, 7)

    for (i, j), values in zip(basis.degrees.T, basis_values(basis, x, y), strict=True):
        expected = math.sqrt((2 * i + 1) * (2 * j + 1)) * eval_legendre(i, x / 6.0) * eval_legendre(j, y / 10.0)
        np.testing.assert_allclose(values, expected, atol=1e-13)


def test_a_polygon_with_four_corners_of_a_rectangle_has_the_rectangles_functions() -> None:
    corners = Polygon(((3.0, 1.0), (15.0, 1.0), (15.0, 21.0), (3.0, 21.0)))
    x, y, _ = section_quadrature(Rectangle(12.0, 20.0), 9)

    values = basis_values(section_basis(corners, 8), x, y)
    np.testing.assert_allclose(values, basis_values(section_basis(Rectangle(12.0, 20.0), 8), x, y), atol=1e-12)


def test_circles_have_zernikes_polynomials() -> None:
    """Born and Wolf, Principles of Optics, 1999, section 9.2.1: R_n^m(r) = r^m P_(n - m)/2^(0, m)(2 r^2 - 1)."""
    basis, (x, y, _) = section_basis(Circle(10.0), 8), section_quadrature(Circle(10.0), 8)
    radius, angle = np.hypot(x, y) / 5.0, np.arctan2(y, x)

    for (i, j), values in zip(basis.degrees.T, basis_values(basis, x, y), strict=True):
        m, n = i + j % 2, j // 2
        turning = np.sin(m * angle) if j % 2 else np.cos(m * angle)
        norm = math.sqrt((1 if m == 0 else 2) * (m + 2 * n + 1))
        expected = norm * radius**m * eval_jacobi(n, 0, m, 2.0 * radius**2 - 1.0) * turning
        np.testing.assert_allclose(values, expected, atol=1e-12)


@pytest.mark.parametrize("name", STOUT)
def test_slopes_are_the_derivatives_of_the_values(name: str) -> None:
    basis, step = section_basis(STOUT[name], 6), 1e-5
    x, y, _ = section_quadrature(STOUT[name], 5)
    slopes = basis_slopes(basis, x, y)

    for slope, dx, dy in zip(slopes, (step, 0.0), (0.0, step), strict=True):
        ahead, behind = basis_values(basis, x + dx, y + dy), basis_values(basis, x - dx, y - dy)
        # step^2 / 6 of a third derivative, which is about 1000 in the corners, and round-off / step
        np.testing.assert_allclose((ahead - behind) / (2.0 * step), slope, atol=1e-7)


@pytest.mark.parametrize("name", THIN)
@pytest.mark.parametrize("power", [1, 4])
def test_slopes_in_thin_walls_are_those_of_the_monomials_they_combine_to(name: str, power: int) -> None:
    basis = section_basis(THIN[name], 6)
    x, y, weight = section_quadrature(THIN[name], 12)
    values, share = basis_values(basis, x, y), weight / np.sum(weight)

    for coordinate, slopes in zip((x, y), basis_slopes(basis, x, y), strict=True):
        slope = (values @ (share * coordinate**power)) @ slopes
        size = np.max(np.abs(coordinate))
        # the coefficients' round-off times slopes of several hundred a millimetre; measured 1e-10
        expected = power * (coordinate / size) ** (power - 1)
        np.testing.assert_allclose(slope / size ** (power - 1), expected, atol=1e-9)


def test_no_points_give_no_values() -> None:
    none = np.empty(0)

    for section in (Rectangle(1.0, 1.0), Circle(1.0), L_SHAPE):
        basis = section_basis(section, 3)
        assert basis_values(basis, none, none).shape == (10, 0)
        assert [slope.shape for slope in basis_slopes(basis, none, none)] == [(10, 0), (10, 0)]
