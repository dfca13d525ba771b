"""Area and second moments of cross-sections about their centroid, in closed form (any textbook)."""

from __future__ import annotations

import math

import numpy as np

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Section
from reports.solution import Array


def area_and_second_moments(section: Section) -> tuple[float, Array]:
    """Area, mm^2, and the integrals of [[x x, x y], [x y, y y]] over the section, mm^4, shape (2, 2)."""
    match section:
        case Rectangle():
            return _rectangle(section.width, section.height)
        case Box():
            outer = _rectangle(section.width, section.height)
            inner = _rectangle(section.width - 2.0 * section.wall, section.height - 2.0 * section.wall)
            return outer[0] - inner[0], outer[1] - inner[1]
        case Circle():
            return _circle(section.diameter)
        case Ring():
            outer, inner = _circle(section.outer_diameter), _circle(section.inner_diameter)
            return outer[0] - inner[0], outer[1] - inner[1]
        case Polygon():
            outer = _polygon(np.array(section.outer) - section.centroid)
            holes = [_polygon(np.array(hole) - section.centroid) for hole in section.holes]
            return outer[0] - sum(hole[0] for hole in holes), outer[1] - sum(hole[1] for hole in holes)


def _rectangle(width: float, height: float) -> tuple[float, Array]:
    return width * height, width * height * np.diag([width**2, height**2]) / 12.0


def _circle(diameter: float) -> tuple[float, Array]:
    return math.pi * diameter**2 / 4.0, math.pi * diameter**4 / 64.0 * np.eye(2)


def _polygon(corners: Array) -> tuple[float, Array]:
    """By the shoelace formula, positive whichever way the corners go; corners of shape (n, 2)."""
    following = np.roll(corners, -1, axis=0)
    turned = corners[:, 0] * following[:, 1] - following[:, 0] * corners[:, 1]
    both = corners + following
    products = sum(np.einsum("n,na,nb->ab", turned, each, each) for each in (corners, following, both)) / 24.0
    area = float(turned.sum()) / 2.0
    return abs(area), math.copysign(1.0, area) * np.asarray(products)
