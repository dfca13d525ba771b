"""From where a scene is looked at, and places of its loads, for sketch and picture alike."""

from __future__ import annotations

import numpy as np

from cases.scene import LineLoad, Load, Scene, SectionMoment
from reports.quantities import Quantities, RodQuantities
from reports.solution import Array

# A load's arrow counts with this part of the scene's extent where the view is chosen.
_ARROW = 0.1
# Arrows of a line load.
ARROWS = 7


def extent(quantities: Quantities) -> float:
    """Diagonal of the box around the centre lines, mm."""
    points = np.hstack([rod.position for rod in quantities.rods])
    return float(np.linalg.norm(np.ptp(points, axis=1)))


def view_plane(scene: Scene, quantities: Quantities) -> Array:
    """Directions to the right and upwards, shape (2, 3): the plane of the first rod's frame that shows most.

    Of the three planes at the rod's start it is the one in which centre lines and loads cover the largest box; where
    none covers any, that of t and e2.
    """
    first, second, tangent = quantities.rods[0].axes[0]
    points = [rod.position for rod in quantities.rods]
    for load in scene.loads:
        size = float(np.linalg.norm(load_vector(load)))
        if size > 0.0:
            places = load_places(load, quantities.rod(load.rod))
            points.append(places - _ARROW * extent(quantities) * load_vector(load)[:, None] / size)
    planes = [np.array(pair) for pair in ((tangent, second), (tangent, first), (first, second))]
    areas = [float(np.prod(np.ptp(plane @ np.hstack(points), axis=1))) for plane in planes]
    return planes[int(np.argmax(np.array(areas) > 0.999 * max(areas)))]


def load_vector(load: Load) -> Array:
    """Force (N), force per length (N/mm) or moment (N mm) of a load, global components, shape (3,)."""
    return np.array(load.moment if isinstance(load, SectionMoment) else load.force, dtype=float)


def load_text(load: Load) -> str:
    """Magnitude of a load with its unit."""
    unit = "N mm" if isinstance(load, SectionMoment) else "N/mm" if isinstance(load, LineLoad) else "N"
    return f"{np.linalg.norm(load_vector(load)):g} {unit}"


def load_stations(load: Load) -> Array:
    """Where a load is drawn, arc length, mm, shape (n,)."""
    return np.linspace(load.start, load.end, ARROWS) if isinstance(load, LineLoad) else np.array([load.position])


def load_places(load: Load, rod: RodQuantities) -> Array:
    """Where a load is drawn, on the undeformed centre line, mm, shape (3, n)."""
    return between(rod, rod.position, load_stations(load))


def between(rod: RodQuantities, values: Array, station: Array) -> Array:
    """Vectors along a rod, shape (3, n), at other stations, by straight lines between the rod's own."""
    return np.array([np.interp(station, rod.station, component) for component in values])
