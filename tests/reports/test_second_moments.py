"""Areas and second moments of sections, against formulas of other sections of the same shape."""

import math

import numpy as np
import pytest

from cases.scene import Box, Circle, Polygon, Rectangle, Ring
from reports.second_moments import area_and_second_moments

CORNERS = ((0.0, 0.0), (6.0, 0.0), (6.0, 10.0), (0.0, 10.0))


@pytest.mark.parametrize("corners", [CORNERS, CORNERS[::-1]])
def test_a_polygon_of_four_corners_is_a_rectangle(corners):
    area, moments = area_and_second_moments(Polygon(corners))

    assert area == pytest.approx(60.0)
    assert moments == pytest.approx(np.diag([10.0 * 6.0**3, 6.0 * 10.0**3]) / 12.0)
    assert moments == pytest.approx(area_and_second_moments(Rectangle(6.0, 10.0))[1])


def test_a_box_is_a_polygon_with_a_hole():
    hole = ((1.0, 1.0), (1.0, 9.0), (5.0, 9.0), (5.0, 1.0))

    for found, expected in zip(
        area_and_second_moments(Box(6.0, 10.0, 1.0)), area_and_second_moments(Polygon(CORNERS, (hole,))), strict=True
    ):
        assert found == pytest.approx(expected)


def test_a_right_triangle_has_a_product_moment():
    area, moments = area_and_second_moments(Polygon(((0.0, 0.0), (6.0, 0.0), (0.0, 9.0))))

    # b^3 h / 36, b h^3 / 36, -b^2 h^2 / 72 about the centroid
    assert area == pytest.approx(27.0)
    assert moments == pytest.approx(np.array([[54.0, -40.5], [-40.5, 121.5]]))


def test_a_ring_is_what_is_left_of_a_circle():
    area, moments = area_and_second_moments(Ring(10.0, 8.0))

    assert area == pytest.approx(math.pi * (5.0**2 - 4.0**2))
    assert moments == pytest.approx(math.pi / 4.0 * (5.0**4 - 4.0**4) * np.eye(2))
    assert moments == pytest.approx(area_and_second_moments(Circle(10.0))[1] - area_and_second_moments(Circle(8.0))[1])
