"""Where the sections of a straight rod are: its frame, points on its centre line, stations of points."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from cases.scene import ContactPair, Rod, Scene
from reports.solution import Array

# Names of the global axes.
AXES = ("X", "Y", "Z")


@lru_cache
def frame(rod: Rod) -> Array:
    """Rows e1, e2, t of the rod's local frame in global components, shape (3, 3), read-only (`cases.scene`)."""
    line = rod.centre_line
    tangent = np.subtract(line.end, line.start) / line.length
    up = np.asarray(line.up, dtype=float)
    second = up - (up @ tangent) * tangent
    second /= np.linalg.norm(second)
    axes = np.array([np.cross(second, tangent), second, tangent])
    axes.setflags(write=False)  # every caller gets the same array
    return axes


def centre_line_points(rod: Rod, station: Array) -> Array:
    """Points of the undeformed centre line, global, mm, shape (3, n)."""
    start = np.asarray(rod.centre_line.start, dtype=float)
    points: Array = start[:, None] + np.outer(frame(rod)[2], station)
    return points


def station_of(rod: Rod, points: Array) -> Array:
    """Arc length of the sections that hold the given points, mm, shape (n,); points has shape (3, n)."""
    start = np.asarray(rod.centre_line.start, dtype=float)
    station: Array = frame(rod)[2] @ (points - start[:, None])
    return station


def pair_axis(scene: Scene, pair: ContactPair) -> int:
    """Index of the global axis to which the pair's first rod is most nearly parallel."""
    return int(np.argmax(np.abs(frame(scene.rod(pair.first.rod))[2])))


def contact_limits(scene: Scene, pair: ContactPair) -> tuple[float, float]:
    """Where the zone or the second rod (by its eight corners) ends, arc length along the first rod, mm."""
    first, second = scene.rod(pair.first.rod), scene.rod(pair.second.rod)
    half = np.array([second.section.width, second.section.height]) / 2.0
    signs = np.array([(-1.0, -1.0), (-1.0, 1.0), (1.0, -1.0), (1.0, 1.0)])
    offsets = frame(second)[:2].T @ (signs * half).T
    ends = centre_line_points(second, np.array([0.0, second.length]))
    corners = (ends[:, :, None] + offsets[:, None, :]).reshape(3, -1)
    extent = station_of(first, corners)
    return max(pair.zone[0], float(extent.min())), min(pair.zone[1], float(extent.max()))
