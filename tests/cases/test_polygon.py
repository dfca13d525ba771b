"""Polygons: areas and centroids of known shapes, crossing edges, points inside and outside."""

import pytest

from cases.polygon import centroid, crosses_itself, depth, narrowest, signed_area

L_SHAPE = ((0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0))


def test_area_has_the_sign_of_the_order():
    assert signed_area(L_SHAPE) == 5.0
    assert signed_area(L_SHAPE[::-1]) == -5.0


@pytest.mark.parametrize("corners", [L_SHAPE, L_SHAPE[::-1]])
def test_the_centroid_does_not_depend_on_the_order(corners):
    # two rectangles: 3 x 1 about (1.5, 0.5) and 1 x 2 about (0.5, 2)
    assert centroid(corners) == pytest.approx([(3 * 1.5 + 2 * 0.5) / 5, (3 * 0.5 + 2 * 2.0) / 5])


@pytest.mark.parametrize(
    ("corners", "crosses"),
    [
        pytest.param(L_SHAPE, False, id="concave"),
        pytest.param(((0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)), True, id="bow tie"),
        pytest.param(((0.0, 0.0), (4.0, 0.0), (4.0, 1.0), (2.0, 0.0), (0.0, 1.0)), True, id="corner on an edge"),
        pytest.param(((0.0, 0.0), (4.0, 0.0), (2.0, 0.0), (2.0, 1.0)), True, id="back along an edge"),
    ],
)
def test_edges_that_meet_are_found(corners, crosses):
    assert crosses_itself(corners) is crosses


@pytest.mark.parametrize(
    ("point", "expected"),
    [((0.5, 0.5), 0.5), ((2.0, 2.0), -1.0), ((1.0, 2.0), 0.0), ((4.0, 0.5), -1.0), ((0.9, 2.0), 0.1)],
)
def test_depth_is_the_distance_from_the_edges_positive_inside(point, expected):
    assert depth(L_SHAPE, point) == pytest.approx(expected, abs=1e-15)
    assert depth(L_SHAPE[::-1], point) == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(
    ("corners", "thickness"),
    [
        pytest.param(L_SHAPE, 1.0, id="two legs"),
        pytest.param(((0.0, 0.0), (20.0, 0.0), (20.0, 6.0), (6.0, 6.0), (6.0, 1e-3), (0.0, 20.0)), 1e-3, id="pinched"),
        pytest.param(((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0), (3.0, 4.0)), 0.0, id="folded back"),
    ],
)
def test_the_narrowest_place_is_that_of_a_corner_and_an_edge(corners, thickness):
    assert narrowest(corners) == pytest.approx(thickness, abs=1e-15)


def test_the_narrowest_place_between_two_polygons_is_found_from_either():
    square, beside = ((0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)), ((1.25, 0.5), (3.0, 0.0), (3.0, 1.0))

    assert narrowest(square, beside) == narrowest(beside, square) == 0.25
