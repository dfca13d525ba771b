"""Symbols of the sketch as SVG: arrows, walls, supports, springs. Places are in the drawing, upwards positive."""

from __future__ import annotations

import numpy as np
from markupsafe import escape

from reports.solution import Array

ARROW = 34.0
# How far the symbols of supports and beds reach from the rod.
SUPPORT = 18.0
BED = 19.0
# About the width of a letter.
LETTER = 4.8


def line(kind: str, start: Array, end: Array) -> str:
    """A straight line."""
    (x1, y1), (x2, y2) = start, end
    return f'<line class="{kind}" x1="{x1:.2f}" y1="{-y1:.2f}" x2="{x2:.2f}" y2="{-y2:.2f}"/>'


def text(kind: str, place: Array, content: str) -> str:
    """A text at a place."""
    x, y = place
    return f'<text class="{kind}" x="{x:.1f}" y="{-y:.1f}">{escape(content)}</text>'


def arrow(tip: Array, direction: Array, *, double: bool) -> list[str]:
    """A straight arrow; with two heads for a moment about its direction."""
    parts = [line("force", tip - ARROW * direction, tip - 9.0 * direction)]
    side = _turned(direction)
    for point in (tip, tip - 8.0 * direction)[: 2 if double else 1]:
        head = [point, point - 10.0 * direction + 3.6 * side, point - 10.0 * direction - 3.6 * side]
        parts.append(f'<polygon class="force-head" points="{_corners(head)}"/>')
    return parts


def turning(centre: Array, anticlockwise: bool) -> list[str]:
    """Three quarters of a circle with a head."""
    sense = 1.0 if anticlockwise else -1.0
    angle = np.linspace(0.25, 1.6, 25) * np.pi * sense
    x, y = centre[:, None] + 15.0 * np.array([np.cos(angle), np.sin(angle)])
    direction = sense * np.array([-np.sin(angle[-1]), np.cos(angle[-1])])
    head = arrow(np.array([x[-1], y[-1]]) + 6.0 * direction, direction, double=False)[1:]
    return [f'<polyline class="force" fill="none" points="{_corners(np.array([x, y]).T)}"/>', *head]


def end_on(centre: Array, towards: bool) -> list[str]:
    """A ring with a dot (out of the page) or a cross (into it)."""
    ring = _ring("force", centre, 6.0)
    if towards:
        return [ring, dot(centre, 2.0)]
    arm = 6.0 / np.sqrt(2.0) * np.array([[1.0, 1.0], [1.0, -1.0]])
    return [ring, *(line("force", centre - each, centre + each) for each in arm)]


def dot(centre: Array, radius: float) -> str:
    """A full circle."""
    x, y = centre
    return f'<circle class="force-head" cx="{x:.2f}" cy="{-y:.2f}" r="{radius:g}"/>'


def wall(centre: Array, outward: Array, across: Array) -> list[str]:
    """A hatched line from one side of a centre to the other, `across` being half of it."""
    along = across / np.linalg.norm(across)
    parts = []
    for share in np.linspace(-1.0, 1.0, 7):
        foot = centre + share * across
        parts.append(line("hatch", foot, foot + 6.0 * outward - 4.0 * along))
    return [*parts, line("wall", centre - across, centre + across)]


def support(apex: Array, outward: Array, *, rollers: bool, upright: bool) -> list[str]:
    """A triangle that stands on hatched ground or on rollers; with a plate on its apex where it holds a rotation."""
    across = _turned(outward)
    base = apex + 10.0 * outward
    triangle = _corners([apex, base + 6.0 * across, base - 6.0 * across])
    parts = [f'<polygon class="hatch" fill="none" points="{triangle}"/>']
    if rollers:
        parts += [_ring("hatch", base + 2.2 * outward + place * across, 2.0) for place in (-3.5, 3.5)]
    ground = base + (4.4 if rollers else 0.0) * outward
    for place in (-4.0, 0.0, 4.0, 8.0):
        parts.append(line("hatch", ground + place * across, ground + (place - 3.0) * across + 3.6 * outward))
    parts.append(line("hatch", ground + 8.0 * across, ground - 8.0 * across))
    if upright:
        parts.append(line("wall", apex + 7.0 * across, apex - 7.0 * across))
    return parts


def held_end_on(centre: Array) -> str:
    """A small square: held along the direction of view."""
    corners = [centre + 3.5 * np.array(corner) for corner in ((1, 1), (-1, 1), (-1, -1), (1, -1))]
    return f'<polygon class="hatch" fill="none" points="{_corners(corners)}"/>'


def bed(faces: Array, outward: Array) -> list[str]:
    """Springs from points of a face to hatched ground; both of shape (2, n)."""
    feet = faces + 14.0 * outward
    parts = []
    for face, direction in zip(faces.T, outward.T, strict=True):
        swing = 2.4 * _turned(direction)
        turns = [face + (3.0 + 1.6 * turn) * direction + (-1.0) ** turn * swing for turn in range(6)]
        spring = [face, face + 2.2 * direction, *turns, face + 11.8 * direction, face + 14.0 * direction]
        parts.append(f'<polyline class="hatch" fill="none" points="{_corners(spring)}"/>')
        foot = face + 14.0 * direction
        parts.append(line("hatch", foot, foot + 4.0 * direction - 4.0 * _turned(direction)))
    return [*parts, f'<polyline class="wall" fill="none" points="{_corners(feet.T)}"/>']


def ground(places: Array, outward: Array) -> list[str]:
    """A hatched line through places; both of shape (2, n)."""
    parts = [
        line("hatch", place, place + 5.0 * direction - 5.0 * _turned(direction))
        for place, direction in zip(places.T, outward.T, strict=True)
    ]
    return [*parts, f'<polyline class="wall" fill="none" points="{_corners(places.T)}"/>']


def bed_end_on(places: Array) -> list[str]:
    """A bed seen from above: a slanting stroke at each place, shape (2, n)."""
    stroke = np.array([3.5, 3.5])
    return [line("hatch", place - stroke, place + stroke) for place in places.T]


def _ring(kind: str, centre: Array, radius: float) -> str:
    x, y = centre
    return f'<circle class="{kind}" fill="none" cx="{x:.2f}" cy="{-y:.2f}" r="{radius:g}"/>'


def _turned(direction: Array) -> Array:
    """A direction turned by a quarter anticlockwise."""
    return np.array([-direction[1], direction[0]])


def _corners(points: Array | list[Array]) -> str:
    return " ".join(f"{x:.2f},{-y:.2f}" for x, y in points)
