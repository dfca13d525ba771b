"""The surface of a solved scene: displacement and stress on the rods' skins, pressure on faces in contact.

Both models are asked at the same places, which follow from the scene alone, so that drawings of them can be held
side by side. Nothing here knows how a solution was computed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import Delaunay, QhullError

from cases.scene import ContactPair, Polygon, Rod
from reports.geometry import stations_of_points
from reports.quantities import default_stations
from reports.sections import outlines
from reports.solution import Array, Solution

IntArray = NDArray[np.int64]

# A side of a section has so many steps, or fewer where it is shorter than the section is large.
STEPS = 6
# Sections at which a rod is asked, at most.
MOST_SECTIONS = 160


class SurfaceSolution(Solution, Protocol):
    """A solution that can be asked for its displacement anywhere."""

    def displacement_at(self, rod: str, points: Array) -> Array:
        """Displacement at (x, y, s), global components, mm; shape (3, n) to (3, n)."""
        ...


@dataclass(frozen=True, eq=False)
class Skin:
    """Where a rod is asked: the borders of its section, in sections along it.

    Attributes
    ----------
    loops : number of points of each border of the section, the outer one first
    border : their (x, y), one loop after the other, mm, shape (n_around, 2)
    station : arc length, mm, shape (n_sections,)
    cap : triangles of points of the border that fill the section, shape (m, 3)
    corners : points of the border at which it has a corner
    """

    loops: tuple[int, ...]
    border: Array
    station: Array
    cap: IntArray
    corners: IntArray

    @property
    def places(self) -> Array:
        """(x, y, s) of all points, section by section, mm, shape (3, n)."""
        sections = len(self.station)
        return np.vstack([np.tile(self.border.T, sections), np.repeat(self.station, len(self.border))])


@dataclass(frozen=True, eq=False)
class RodSurface:
    """What a solution says at the points of a rod's skin.

    Attributes
    ----------
    displacement : global, mm, shape (3, n)
    stress_s : sigma_s, MPa, shape (n,)
    """

    displacement: Array
    stress_s: Array


@dataclass(frozen=True, eq=False)
class PressedFace:
    """The part of a pair's first face that is in contact, as triangles between contact points.

    Attributes
    ----------
    position, displacement : of the first face, global, mm, shape (3, n)
    pressure : MPa, shape (n,)
    triangles : shape (m, 3)
    """

    pair: str
    position: Array
    displacement: Array
    pressure: Array
    triangles: IntArray


@dataclass(frozen=True, eq=False)
class Surface:
    """The surface of a scene: its rods in their order, its pairs in theirs."""

    rods: tuple[RodSurface, ...]
    faces: tuple[PressedFace, ...]


def surface(solution: SurfaceSolution) -> Surface:
    """Ask a solution for its surface."""
    rods = []
    for rod in solution.scene.rods:
        places = skin(rod).places
        rods.append(RodSurface(solution.displacement_at(rod.name, places), solution.stress(rod.name, places)[2]))
    faces = tuple(_pressed_face(solution, pair) for pair in solution.scene.contacts)
    return Surface(tuple(rods), faces)


def skin(rod: Rod) -> Skin:
    """Where a rod is asked."""
    loops = [_stepped(loop) for loop in outlines(rod.section)]
    border = np.concatenate([loop for loop, _ in loops])
    starts = np.cumsum([0, *(len(loop) for loop, _ in loops)])
    corners = np.concatenate([start + at for start, (_, at) in zip(starts, loops, strict=False)])
    # Corners of a polygon with many, such as a circle's, are none to draw.
    if len(corners) > 16 and not isinstance(rod.section, Polygon):
        corners = corners[:0]
    station = default_stations(rod)
    station = station[np.unique(np.linspace(0, len(station) - 1, min(len(station), MOST_SECTIONS)).astype(int))]
    sizes = tuple(len(loop) for loop, _ in loops)
    return Skin(sizes, border, station, _cap(border, sizes), corners)


def _stepped(loop: Array) -> tuple[Array, IntArray]:
    """A border with its sides divided, shape (n, 2), and which of its points are the corners."""
    size = float(np.ptp(loop, axis=0).max())
    sides = np.roll(loop, -1, axis=0) - loop
    steps = np.maximum(1, np.rint(STEPS * np.linalg.norm(sides, axis=1) / size)).astype(np.int64)
    points = [
        start + np.arange(count)[:, None] / count * side for start, side, count in zip(loop, sides, steps, strict=True)
    ]
    return np.concatenate(points), np.cumsum(steps) - steps


def _cap(border: Array, sizes: tuple[int, ...]) -> IntArray:
    """Triangles that fill a section: those between points of its borders whose middle lies in it (even-odd rule)."""
    triangles = Delaunay(border).simplices.astype(np.int64)
    middle = border[triangles].mean(axis=1)
    inside = np.zeros(len(middle), dtype=bool)
    start = 0
    for size in sizes:
        loop = border[start : start + size]
        start += size
        for (x0, y0), (x1, y1) in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            if y0 != y1:
                crosses = (y0 > middle[:, 1]) != (y1 > middle[:, 1])
                inside ^= crosses & (middle[:, 0] < x0 + (middle[:, 1] - y0) * (x1 - x0) / (y1 - y0))
    return np.asarray(triangles[inside])


def _pressed_face(solution: SurfaceSolution, pair: ContactPair) -> PressedFace:
    points = solution.contact_points(pair.name)
    station = stations_of_points(solution, pair.first.rod, points.position)
    origin, axes = solution.frame(pair.first.rod, station)
    x, y = np.einsum("nai,in->an", axes[:, :2], points.position - origin)
    places = np.vstack([x, y, station])
    across = x if pair.first.face in ("top", "bottom") else y
    triangles = _between(np.column_stack([station, across]), points.pressure)
    used, triangles = np.unique(triangles, return_inverse=True)
    moved = solution.displacement_at(pair.first.rod, places[:, used])
    return PressedFace(
        pair.name, points.position[:, used], moved, points.pressure[used], triangles.reshape(-1, 3).astype(np.int64)
    )


def _between(place: Array, pressure: Array) -> IntArray:
    """Triangles between points of a plane, shape (n, 2), of which at least one is pressed."""
    if len(place) < 3 or not pressure.any():
        return np.zeros((0, 3), dtype=np.int64)
    try:
        # as a grid is denser across than along, or the other way, its directions are scaled alike
        triangles = Delaunay(place / np.maximum(np.ptp(place, axis=0), 1e-300)).simplices
    except QhullError:  # points on one line have no face
        return np.zeros((0, 3), dtype=np.int64)
    return np.asarray(triangles[(pressure[triangles] > 0.0).any(axis=1)], dtype=np.int64)
