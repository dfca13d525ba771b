"""Quadrature over sections of any shape, against closed forms and the divergence theorem along the edges."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import gamma

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Section
from rodmodel.shape import extents, has_centre, mirror_planes, outline, section_quadrature

DEGREE = 9

L_SHAPE = Polygon(((0.0, 0.0), (10.0, 0.0), (10.0, 2.0), (3.0, 2.0), (3.0, 15.0), (0.0, 15.0)))
I_SHAPE = Polygon(
    ((-5, 0), (5, 0), (5, 2), (1, 2), (1, 18), (5, 18), (5, 20), (-5, 20), (-5, 18), (-1, 18), (-1, 2), (-5, 2))
)
PIERCED = Polygon(((0, 0), (12, 1), (11, 9), (2, 8)), (((3, 3), (3, 5), (5, 4)), ((7, 3), (9, 3), (8, 6))))
SECTIONS = {
    "rectangle": Rectangle(12.0, 20.0),
    "box": Box(12.0, 20.0, 1.5),
    "circle": Circle(10.0),
    "ring": Ring(20.0, 14.0),
    "thin ring": Ring(20.0, 19.9),
    "L": L_SHAPE,
    "I": I_SHAPE,
    "pierced": PIERCED,
}
MONOMIALS = [(total - j, j) for total in range(DEGREE + 1) for j in range(total + 1)]


def rectangle_moment(width: float, height: float, i: int, j: int) -> float:
    def along(length: float, degree: int) -> float:
        return 0.0 if degree % 2 else 2.0 * (length / 2.0) ** (degree + 1) / (degree + 1)

    return along(width, i) * along(height, j)


def disc_moment(diameter: float, i: int, j: int) -> float:
    """int r^(i + j + 1) dr times int cos^i sin^j, the beta function 2 B((i + 1)/2, (j + 1)/2) for even i and j."""
    if i % 2 or j % 2:
        return 0.0
    angles = 2.0 * gamma((i + 1) / 2) * gamma((j + 1) / 2) / gamma((i + j + 2) / 2)
    return float((diameter / 2.0) ** (i + j + 2) / (i + j + 2) * angles)


def polygon_moments(section: Polygon, degree: int) -> dict[tuple[int, int], float]:
    """Divergence theorem: int x^i y^j dA = 1/(i + 1) times the integral of x^(i + 1) y^j dy around the edges.

    About the centroid, whichever way around the corners are given.
    """
    loops = [np.array(corners, dtype=float) for corners in (section.outer, *section.holes)]
    xi, weight = np.polynomial.legendre.leggauss(degree // 2 + 2)

    def around(loop: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        following = np.roll(loop, -1, axis=0)
        x, y = ((loop[:, [k]] * (1 - xi) + following[:, [k]] * (1 + xi)) / 2 for k in (0, 1))
        dy = (following - loop)[:, [1]] / 2 * weight
        return x, y, dy if np.sum(x * dy) > 0.0 else -dy

    x, y, dy = (np.concatenate(parts) for parts in zip(*map(around, loops), strict=True))
    dy[len(loops[0]) :] *= -1.0
    x, y = x - loops[0][0, 0], y - loops[0][0, 1]  # sums lose digits far from the origin
    area = np.sum(x * dy)
    x, y = x - np.sum(x**2 * dy) / 2.0 / area, y - np.sum(x * y * dy) / area
    return {(i, j): float(np.sum(x ** (i + 1) * y**j * dy) / (i + 1)) for i, j in MONOMIALS if i + j <= degree}


def exact_moments(section: Section, degree: int) -> dict[tuple[int, int], float]:
    pairs = [(i, j) for i, j in MONOMIALS if i + j <= degree]
    match section:
        case Rectangle(width, height):
            return {pair: rectangle_moment(width, height, *pair) for pair in pairs}
        case Box(width, height, wall):
            hollow = {pair: rectangle_moment(width - 2 * wall, height - 2 * wall, *pair) for pair in pairs}
            return {pair: rectangle_moment(width, height, *pair) - hollow[pair] for pair in pairs}
        case Circle(diameter):
            return {pair: disc_moment(diameter, *pair) for pair in pairs}
        case Ring(outer, inner):
            return {pair: disc_moment(outer, *pair) - disc_moment(inner, *pair) for pair in pairs}
    return polygon_moments(section, degree)


def assert_exact(section: Section, degree: int) -> None:
    x, y, weight = section_quadrature(section, degree)
    for (i, j), exact in exact_moments(section, degree).items():
        term = x**i * y**j
        # round-off, of the sum and of the closed form's own sum or difference over the whole extent
        slack = 1e-12 * float(weight @ np.abs(term)) + 1e-14 * np.max(np.abs(term)) * np.ptp(x) * np.ptp(y)
        assert float(weight @ term) == pytest.approx(exact, abs=slack), (i, j)


@pytest.mark.parametrize("name", SECTIONS)
@pytest.mark.parametrize("degree", [0, 1, 2, 5, 8, DEGREE])
def test_polynomials_of_the_degree_are_integrated_exactly(name: str, degree: int) -> None:
    assert_exact(SECTIONS[name], degree)


@st.composite
def polygons(draw: st.DrawFn) -> Polygon:
    """Star-shaped about a point far from the origin, in either direction, with or without a hole of its own shape."""
    count = draw(st.integers(3, 9))
    radii = draw(st.lists(st.floats(2.0, 10.0), min_size=count, max_size=count))
    turn = draw(st.floats(0.0, 6.0))
    angles = turn + 2.0 * math.pi * np.arange(count) / count
    corners = np.stack([radii * np.cos(angles), radii * np.sin(angles)], axis=1)
    if draw(st.booleans()):
        corners = corners[::-1]
    middle = np.array([draw(st.floats(-30.0, 30.0)), draw(st.floats(-30.0, 30.0))])
    shrink = draw(st.sampled_from([0.0, 0.3, 0.9]))
    holes = (tuple(map(tuple, (middle + shrink * corners).tolist())),) if shrink else ()
    return Polygon(tuple(map(tuple, (middle + corners).tolist())), holes)


@pytest.mark.slow
@given(polygons())
def test_any_polygon_is_integrated_as_the_divergence_theorem_says(section: Polygon) -> None:
    assert_exact(section, 6)


@pytest.mark.parametrize("name", SECTIONS)
def test_weights_are_positive_and_points_inside(name: str) -> None:
    section = SECTIONS[name]
    x, y, weight = section_quadrature(section, DEGREE)

    assert np.all(weight > 0.0)
    match section:
        case Rectangle(width, height):
            inside = (np.abs(x) < width / 2) & (np.abs(y) < height / 2)
        case Box(width, height, wall):
            inside = (np.abs(x) < width / 2) & (np.abs(y) < height / 2)
            inside &= (np.abs(x) > width / 2 - wall) | (np.abs(y) > height / 2 - wall)
        case Circle(diameter):
            inside = np.hypot(x, y) < diameter / 2
        case Ring(outer, inner):
            inside = (np.hypot(x, y) < outer / 2) & (np.hypot(x, y) > inner / 2)
        case Polygon():
            # outer corners turn once around a point inside, those of a hole not at all
            turns = np.array([winding_number(corners, x, y) for corners in outline(section)])
            inside = (turns[0] == 1) & np.all(turns[1:] == 0, axis=0)
    assert np.all(inside)


def winding_number(corners: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    to_corner = (corners[:, 0] + 1j * corners[:, 1])[:, None] - (x + 1j * y)
    return np.rint(np.sum(np.angle(np.roll(to_corner, -1, axis=0) / to_corner), axis=0) / (2.0 * math.pi))


@pytest.mark.parametrize("name", ["rectangle", "box", "circle", "ring"])
def test_rules_of_symmetric_shapes_are_their_own_mirror_images(name: str) -> None:
    x, y, weight = section_quadrature(SECTIONS[name], DEGREE)
    points = set(zip(np.abs(x), np.abs(y), weight, strict=True))

    # four images of a point, two on an axis, one in the middle: the same numbers to the last bit
    images = sum((1 + (px != 0.0)) * (1 + (py != 0.0)) for px, py, _ in points)
    assert images == len(x)


@pytest.mark.parametrize("name", SECTIONS)
def test_the_centroid_is_the_origin_and_extents_reach_around_it(name: str) -> None:
    section = SECTIONS[name]
    x, y, weight = section_quadrature(section, 40)
    x_min, x_max, y_min, y_max = extents(section)

    size = max(x_max - x_min, y_max - y_min)
    assert weight @ x == pytest.approx(0.0, abs=1e-13 * size * np.sum(weight))
    assert weight @ y == pytest.approx(0.0, abs=1e-13 * size * np.sum(weight))
    assert x_min <= np.min(x) < 0.0 < np.max(x) <= x_max
    assert y_min <= np.min(y) < 0.0 < np.max(y) <= y_max
    # rules of degree 40 come within 2 % of the border
    assert np.ptp(x) == pytest.approx(x_max - x_min, rel=0.02)
    assert np.ptp(y) == pytest.approx(y_max - y_min, rel=0.02)


def turned(section: Polygon, angle: float) -> Polygon:
    turn = np.array([[math.cos(angle), math.sin(angle)], [-math.sin(angle), math.cos(angle)]])
    return Polygon(tuple(map(tuple, (np.array(section.outer) @ turn).tolist())))


@pytest.mark.parametrize(
    ("section", "planes"),
    [
        (Rectangle(1.0, 2.0), (True, True)),
        (Box(3.0, 2.0, 0.1), (True, True)),
        (Circle(1.0), (True, True)),
        (Ring(2.0, 1.0), (True, True)),
        (I_SHAPE, (True, True)),
        (turned(I_SHAPE, math.pi / 2.0), (True, True)),
        (turned(I_SHAPE, 0.1), (False, False)),
        (L_SHAPE, (False, False)),
        (Polygon(((0, 0), (4, 0), (2, 3))), (True, False)),
        (Polygon(((0, 0), (3, 2), (0, 4))), (False, True)),
        # point symmetric only
        (Polygon(((0, 0), (4, 0), (5, 3), (1, 3))), (False, False)),
        # the hole breaks one of the rectangle's symmetries
        (Polygon(((0, 0), (6, 0), (6, 4), (0, 4)), (((1, 1), (2, 1), (2, 3), (1, 3)),)), (False, True)),
        # corners that mirror onto corners, edges that do not
        (Polygon(((0, 0), (4, 0), (3, 1), (4, 4), (0, 4), (1, 3), (1, 1))), (False, False)),
    ],
)
def test_mirror_planes_are_those_that_map_edges_onto_edges(section: Section, planes: tuple[bool, bool]) -> None:
    assert mirror_planes(section) == planes


def test_corners_may_run_either_way_around() -> None:
    backwards = Polygon(PIERCED.outer[::-1], (PIERCED.holes[0], PIERCED.holes[1][::-1]))

    for rule, other in zip(section_quadrature(PIERCED, 4), section_quadrature(backwards, 4), strict=True):
        np.testing.assert_allclose(other, rule, atol=1e-13)  # round-off of the centroid


def test_corners_that_are_level_but_for_round_off_do_no_harm() -> None:
    skewed = Polygon(((0.0, 0.0), (10.0, 1e-15), (10.0, 5.0), (0.0, 5.0 + 1e-15)))

    _, y, weight = section_quadrature(skewed, 2)
    assert np.sum(weight) == pytest.approx(50.0, rel=1e-12)
    assert weight @ y**2 == pytest.approx(10.0 * 5.0**3 / 12.0, rel=1e-12)


@pytest.mark.parametrize("name", SECTIONS)
def test_hollow_sections_have_no_material_at_their_centroid(name: str) -> None:
    """That of the L lies at (2.7, 6.0) from its corner, just within the leg, which is 3 wide."""
    assert has_centre(SECTIONS[name]) == (name not in ("box", "ring", "thin ring"))


def test_the_centroid_of_a_channel_lies_beside_its_web() -> None:
    channel = ((0.0, 0.0), (12.0, 0.0), (12.0, 2.0), (2.0, 2.0), (2.0, 18.0), (12.0, 18.0), (12.0, 20.0), (0.0, 20.0))

    assert not has_centre(Polygon(channel))
    assert has_centre(Polygon(((0.0, 0.0), (12.0, 0.0), (12.0, 20.0), (0.0, 20.0))))
    assert not has_centre(Polygon((*channel[:2], (12.0, 20.0), (0.0, 20.0)), (((4, 8), (8, 8), (8, 12), (4, 12)),)))
