"""Outlines and section moduli of cross-sections, in closed form (any textbook on the strength of materials)."""

from __future__ import annotations

import math

import numpy as np

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Section
from reports.solution import Array

# Corners that stand for a circle in drawings.
AROUND = 48


def outline(section: Section) -> Array:
    """Corners of the outer border about the centroid, anticlockwise, mm, shape (n, 2); a circle by `AROUND` corners."""
    match section:
        case Rectangle() | Box():
            half = np.array([section.width, section.height]) / 2.0
            return np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half
        case Circle():
            return _circle(section.diameter)
        case Ring():
            return _circle(section.outer_diameter)
        case Polygon():
            corners = np.array(section.outer) - section.centroid
            return corners if _second_moment(corners) > 0.0 else corners[::-1]


def outlines(section: Section) -> list[Array]:
    """Corners of all borders as in `outline`: the outer one, then those of holes."""
    match section:
        case Box():
            half = np.array([section.width, section.height]) / 2.0 - section.wall
            return [outline(section), np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)]) * half]
        case Ring():
            return [outline(section), _circle(section.inner_diameter)]
        case Polygon():
            return [outline(section), *(np.array(hole) - section.centroid for hole in section.holes)]
        case _:
            return [outline(section)]


def _circle(diameter: float) -> Array:
    angle = np.linspace(0.0, 2.0 * math.pi, AROUND, endpoint=False)
    return diameter / 2.0 * np.column_stack([np.cos(angle), np.sin(angle)])


def section_modulus(section: Section) -> float:
    """W = I_x / y_max for bending about e1 through the centroid, mm^3."""
    match section:
        case Rectangle():
            return section.width * section.height**2 / 6.0
        case Circle():
            return math.pi * section.diameter**3 / 32.0
        case Ring():
            outer, inner = section.outer_diameter, section.inner_diameter
            return math.pi * (outer**4 - inner**4) / (32.0 * outer)
        case Box():
            width, height = section.width - 2.0 * section.wall, section.height - 2.0 * section.wall
            return (section.width * section.height**3 - width * height**3) / (6.0 * section.height)
        case Polygon():
            corners = [np.array(loop) - section.centroid for loop in (section.outer, *section.holes)]
            outer, *holes = (abs(_second_moment(loop)) for loop in corners)
            return float((outer - sum(holes)) / np.abs(corners[0][:, 1]).max())


def _second_moment(corners: Array) -> float:
    """Integral of y^2 over a polygon by the shoelace formula, mm^4, positive for anticlockwise corners."""
    x, y = corners.T
    following_x, following_y = np.roll(x, -1), np.roll(y, -1)
    turned = x * following_y - following_x * y
    return float(turned @ (y**2 + y * following_y + following_y**2)) / 12.0


def described(section: Section) -> str:
    """A section in words, with its measures in mm."""
    match section:
        case Rectangle():
            return f"{section.width:g} x {section.height:g} mm"
        case Circle():
            return f"diameter {section.diameter:g} mm"
        case Ring():
            return f"tube of diameter {section.outer_diameter:g} mm outside and {section.inner_diameter:g} mm inside"
        case Box():
            return f"box {section.width:g} x {section.height:g} mm with walls of {section.wall:g} mm"
        case Polygon():
            return f"polygon of {len(section.outer)} corners"
