"""Centre line of a rod: its local frame and the points on it."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import Line, Rod

Array = NDArray[np.float64]


@lru_cache(maxsize=1024)
def frame(line: Line) -> Array:
    """Local frame of a straight line: rows e1, e2, t in global components, shape (3, 3)."""
    tangent = np.subtract(line.end, line.start) / line.length
    up = np.asarray(line.up, dtype=float)
    e2 = up - (up @ tangent) * tangent
    e2 /= np.linalg.norm(e2)
    axes = np.array([np.cross(e2, tangent), e2, tangent])
    axes.flags.writeable = False
    return axes


def global_points(rod: Rod, points: Array) -> Array:
    """Global coordinates of the points (x, y, s) of a rod, mm; shape (3, n) to (3, n)."""
    return np.asarray(rod.centre_line.start)[:, None] + frame(rod.centre_line).T @ points


def local_points(rod: Rod, points: Array) -> Array:
    """Coordinates (x, y, s) in a rod's frame of global points, mm; shape (3, n) to (3, n)."""
    return np.asarray(frame(rod.centre_line) @ (points - np.asarray(rod.centre_line.start)[:, None]))
