"""Rods as they are before anything is solved, in the shape that drawings ask for."""

from __future__ import annotations

import numpy as np

from cases.scene import Rod, Scene
from reports.quantities import Quantities, RodQuantities
from rodmodel.centre_line import centre_points, frames

# Stations of a drawn rod; what is between them is drawn straight.
STATIONS = 201


def undeformed(scene: Scene) -> Quantities:
    """Quantities of a scene that nothing has moved yet: places and frames along the rods, all else zero or none."""
    rods = tuple(_still(rod) for rod in scene.rods)
    return Quantities("not solved", (), rods, {}, {}, 0.0, 0.0, 0, 0, 0, 0.0, 0.0)


def _still(rod: Rod) -> RodQuantities:
    station = np.linspace(0.0, rod.length, STATIONS)
    nothing = np.zeros((6, STATIONS))
    position, axes = centre_points(rod.centre_line, station), frames(rod.centre_line, station)
    return RodQuantities(rod.name, station, position, axes, np.zeros((3, STATIONS)), nothing, nothing, None, None, None)
