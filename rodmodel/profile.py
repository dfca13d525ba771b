"""Contact pressure along the zone, from the forces at the contact points."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial.legendre import legvander
from numpy.typing import NDArray

from cases.scene import ContactPair, Scene
from rodmodel.axial import lobatto
from rodmodel.centre_line import global_points
from rodmodel.pairing import ContactGrid, face_axes

Array = NDArray[np.float64]

# Points drawn along an interval in contact, from -1 to 1; its pressure is a polynomial of about the axial order. They
# are dense at the ends: where contact ends there, round-off decides whether the end itself is in contact.
DRAWN = -np.cos(np.linspace(0.0, np.pi, 41))


@dataclass(frozen=True, eq=False)
class ContactProfile:
    """Pressure along a zone.

    Attributes
    ----------
    station : along the first rod, mm, ascending, shape (n,)
    position : middle of the first face, global, mm, shape (3, n)
    middle, mean, outer : pressure in the middle of the width, averaged over it, and at its outer border, MPa, (n,)
    """

    station: Array
    position: Array
    middle: Array
    mean: Array
    outer: Array


def pressure_profile(scene: Scene, pair: ContactPair, grid: ContactGrid, force: Array) -> ContactProfile:
    """Profile of a pair from the forces at its contact points (N, shape (n_points,)).

    Along an interval closed from end to end the pressure is the polynomial through its Lobatto points; along one that
    is closed in parts, nothing is known between them, and they are joined by straight lines.
    """
    pressure = np.divide(
        force.reshape(grid.weight.shape), grid.weight, out=np.zeros_like(grid.weight), where=grid.weight > 0.0
    )
    width = grid.weight.sum(axis=2, keepdims=True)
    share = np.divide(grid.weight, width, out=np.zeros_like(grid.weight), where=width > 0.0)
    outer = pressure[:, :, -1] if grid.symmetric else np.maximum(pressure[:, :, 0], pressure[:, :, -1])
    lines = np.array([pressure[:, :, grid.middle], (share * pressure).sum(axis=2), outer])
    stations, values = [], []
    for index, station in enumerate(grid.station):
        # The ends may be open by round-off: the pressure is zero there where a border sits on an edge.
        closed = bool((lines[:, index, 1:-1] > 0.0).all())
        start, end = station[0], station[-1]
        drawn = np.clip(0.5 * (start + end) + 0.5 * (end - start) * DRAWN, start, end) if closed else station
        if closed:
            drawn_values = np.maximum(lines[:, index] @ _interpolation(len(station)), 0.0)
        else:
            drawn_values = lines[:, index]
        first = 0 if index == 0 else 1
        stations.append(drawn[first:])
        values.append(drawn_values[:, first:])
    station = np.concatenate(stations)
    middle, mean, outer_values = np.concatenate(values, axis=1)
    rod = scene.rod(pair.first.rod)
    across = np.interp(station, grid.station.ravel(), grid.across[:, :, grid.middle].ravel())
    position = global_points(rod, face_axes(rod, pair.first.face).points(across, station))
    return ContactProfile(station, position, middle, mean, outer_values)


@lru_cache(maxsize=16)
def _interpolation(count: int) -> Array:
    """From values at so many Lobatto points to the polynomial through them where it is drawn, (count, n_drawn)."""
    points, _ = lobatto(count)
    return np.asarray(np.linalg.solve(legvander(points, count - 1).T, legvander(DRAWN, count - 1).T))
