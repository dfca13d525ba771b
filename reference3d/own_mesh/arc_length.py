"""Where along a rod points lie."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cases.scene import Rod
from reference3d.centre_line import frames, points

Array = NDArray[np.float64]

# places of a centre line from which the nearest begins the search, and Newton's steps
SAMPLES, STEPS = 2001, 4


def arc_lengths(rod: Rod, position: Array) -> Array:
    """Arc length of the sections in which points lie, mm; shape (n, 3) to (n,); beyond an end, that end."""
    samples = np.linspace(0.0, rod.length, SAMPLES)
    station = samples[cKDTree(points(rod.centre_line, samples)).query(position)[1]]
    for _ in range(STEPS):
        tangent = frames(rod.centre_line, station)[:, 2]
        ahead = np.einsum("nc,nc->n", position - points(rod.centre_line, station), tangent)
        station = np.clip(station + ahead, 0.0, rod.length)
    return np.asarray(station)
