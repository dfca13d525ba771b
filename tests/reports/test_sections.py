"""Section moduli against integrals over fine polygons, outlines against their measures."""

import math

import numpy as np
import pytest

from cases.scene import Box, Circle, Polygon, Rectangle, Ring
from reports.sections import outline, section_modulus

RECTANGLE = ((-3.0, -5.0), (3.0, -5.0), (3.0, 5.0), (-3.0, 5.0))
INNER = ((-2.0, -4.0), (2.0, -4.0), (2.0, 4.0), (-2.0, 4.0))


def circle(diameter, corners=1000):
    angle = np.linspace(0.0, 2.0 * math.pi, corners, endpoint=False)
    return tuple(zip(diameter / 2 * np.cos(angle), diameter / 2 * np.sin(angle), strict=True))


@pytest.mark.parametrize(
    ("section", "polygon", "tolerance"),
    [
        pytest.param(Rectangle(6.0, 10.0), Polygon(RECTANGLE), 1e-14, id="rectangle"),
        pytest.param(Box(6.0, 10.0, 1.0), Polygon(RECTANGLE, (INNER,)), 1e-14, id="box"),
        # the second moment of a regular polygon of n corners falls short of the circle's by (2 pi / n)^2 / 3
        pytest.param(Circle(8.0), Polygon(circle(8.0)), 1.4e-5, id="circle"),
        pytest.param(Ring(8.0, 5.0), Polygon(circle(8.0), (circle(5.0),)), 1.4e-5, id="ring"),
    ],
)
def test_the_modulus_of_a_shape_is_that_of_the_polygon_like_it(section, polygon, tolerance):
    assert section_modulus(section) == pytest.approx(section_modulus(polygon), rel=tolerance)


@pytest.mark.parametrize("shift", [0.0, 100.0])
@pytest.mark.parametrize("order", [1, -1])
def test_the_modulus_of_a_triangle_is_that_of_its_far_corner(shift, order):
    corners = tuple((x + shift, y - shift) for x, y in ((0.0, 0.0), (6.0, 0.0), (0.0, 9.0)))[::order]

    # b h^3 / 36 over 2 h / 3, about the centroid, wherever the corners are counted from
    assert section_modulus(Polygon(corners)) == pytest.approx(6.0 * 9.0**2 / 24.0)


@pytest.mark.parametrize(
    ("section", "width", "height"),
    [
        (Rectangle(6.0, 10.0), 6.0, 10.0),
        (Box(6.0, 10.0, 1.0), 6.0, 10.0),
        (Circle(8.0), 8.0, 8.0),
        (Ring(8.0, 5.0), 8.0, 8.0),
        (Polygon(tuple((x + 7.0, y + 7.0) for x, y in RECTANGLE[::-1])), 6.0, 10.0),
    ],
)
def test_outlines_go_anticlockwise_around_the_centroid(section, width, height):
    x, y = outline(section).T

    assert (np.ptp(x), np.ptp(y)) == pytest.approx((width, height))
    assert (x.mean(), y.mean()) == pytest.approx((0.0, 0.0), abs=1e-14)
    assert np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y) > 0.0
