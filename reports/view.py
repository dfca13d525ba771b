"""From where a scene is looked at, how much larger it is drawn, and where loads and supports are: for all drawings."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cases.scene import (
    ContactPair,
    Face,
    Gravity,
    LineLoad,
    Load,
    Pressure,
    RodFace,
    Scene,
    SectionForce,
    SectionMoment,
    Support,
    given_gap,
)
from reports.geometry import face_extent
from reports.quantities import Quantities, RodQuantities
from reports.solution import Array

# A load's arrow counts with this part of the scene's extent where the view is chosen.
_ARROW = 0.1
# The largest displacement is drawn about this long, as a part of the scene's extent.
DRAWN_DISPLACEMENT = 0.08
# Arrows of a line load or a pressure, and springs of a bed.
ARROWS = 7
SPRINGS = 13
# The section's axis normal to each face, and the side of it on which the face lies.
_NORMALS: dict[Face, tuple[int, float]] = {"top": (1, 1.0), "bottom": (1, -1.0), "right": (0, 1.0), "left": (0, -1.0)}


@dataclass(frozen=True)
class LoadArrows:
    """Arrows that stand for a load; none for a load of nothing.

    Attributes
    ----------
    station : arc length, mm, shape (n,)
    place : on the undeformed centre line, global, mm, shape (3, n)
    direction : global unit vectors, shape (3, n)
    turning : whether they are axes of a moment
    pulling : whether they begin at the rod's surface instead of ending there
    text : magnitude with unit
    """

    station: Array
    place: Array
    direction: Array
    turning: bool
    pulling: bool
    text: str


def extent(quantities: Quantities) -> float:
    """Diagonal of the box around the centre lines, mm."""
    points = np.hstack([rod.position for rod in quantities.rods])
    return float(np.linalg.norm(np.ptp(points, axis=1)))


def view_plane(scene: Scene, quantities: Quantities) -> Array:
    """Directions to the right and upwards, shape (2, 3): the plane of the first rod's frame that shows most.

    Of the three planes at the rod's start it is the one in which centre lines and loads cover the largest box; where
    none covers any, that of t and e2. It is turned as one draws global axes: X to the right, Z upwards, and Y where
    the other one is not.
    """
    first, second, tangent = quantities.rods[0].axes[0]
    points = [rod.position for rod in quantities.rods]
    for load in scene.loads:
        arrows = load_arrows(load, quantities.rod(load.rod))
        points.append(arrows.place - _ARROW * extent(quantities) * arrows.direction)
    planes = [np.array(pair) for pair in ((tangent, second), (tangent, first), (first, second))]
    areas = [float(np.prod(np.ptp(plane @ np.hstack(points), axis=1))) for plane in planes]
    return _upright(planes[int(np.argmax(np.array(areas) > 0.999 * max(areas)))])


def _upright(plane: Array) -> Array:
    """Two directions, shape (2, 3), in the order and with the signs that point most to the right and upwards."""
    rightwards, upwards = np.array([1.0, 0.5, 0.25]), np.array([0.25, 0.5, 1.0])
    right, up = plane[::-1] if abs(plane[1] @ rightwards) > abs(plane[0] @ rightwards) else plane
    return np.array([right if right @ rightwards > 0.0 else -right, up if up @ upwards > 0.0 else -up])


def load_arrows(load: Load, rod: RodQuantities) -> LoadArrows:
    """How a load is drawn: at its section, evenly over its stretch, or in the middle of the rod that has weight."""
    match load:
        case SectionForce():
            station, vector, unit = np.array([load.position]), load.force, "N"
        case SectionMoment():
            station, vector, unit = np.array([load.position]), load.moment, "N mm"
        case LineLoad():
            station, vector, unit = np.linspace(load.start, load.end, ARROWS), load.force, "N/mm"
        case Gravity():
            station, vector, unit = np.array([0.5 * rod.station[-1]]), load.acceleration, ""
        case Pressure():
            station = np.linspace(load.start, load.end, ARROWS if load.pressure else 0)
            direction = -np.sign(load.pressure) * face_normals(rod, load.face.face, station)
            place = between(rod, rod.position, station)
            return LoadArrows(station, place, direction, False, load.pressure < 0.0, f"{load.pressure:g} MPa")
    size = float(np.linalg.norm(vector))
    if size == 0.0:
        station = station[:0]
    direction = np.tile(np.array(vector, dtype=float)[:, None] / (size or 1.0), len(station))
    text = "g" if isinstance(load, Gravity) else f"{size:g} {unit}"
    place = between(rod, rod.position, station)
    return LoadArrows(station, place, direction, isinstance(load, SectionMoment), isinstance(load, Gravity), text)


def face_normals(rod: RodQuantities, face: Face, station: Array) -> Array:
    """Outward normals in the middle of a face, global, shape (3, n)."""
    axis, side = _NORMALS[face]
    normals = side * between(rod, rod.axes[:, axis].T, station)
    return np.asarray(normals / np.linalg.norm(normals, axis=0))


def held_directions(support: Support, rod: RodQuantities) -> tuple[Array, Array]:
    """Directions in which and about which a support holds its section, global, shapes (3, n) and (3, m)."""
    axes = rod.axes[int(np.argmin(np.abs(rod.station - support.position)))]
    moves = [axes["xys".index(component)] for component in support.components if len(component) == 1]
    turns = [axes["xys".index(component[-1])] for component in support.components if len(component) > 1]
    nothing = np.zeros((0, 3))
    return np.vstack([nothing, *moves]).T, np.vstack([nothing, *turns]).T


def between(rod: RodQuantities, values: Array, station: Array) -> Array:
    """Vectors along a rod, shape (3, n), at other stations, by straight lines between the rod's own."""
    return np.array([np.interp(station, rod.station, component) for component in values])


def least_gap(scene: Scene, quantities: Quantities, pair: ContactPair, opposite: RodFace) -> tuple[Array, float, float]:
    """Normal of the first face, distance as drawn and given gap where that is least in the zone, mm.

    The distance is that to the point of the other centre line that is seen nearest along the normal.
    """
    found, other = quantities.rod(pair.first.rod), quantities.rod(opposite.rod)
    station = np.linspace(*pair.zone, 101)
    normal = face_normals(found, pair.first.face, station)
    apart = other.position[:, None, :] - between(found, found.position, station)[:, :, None]
    along = np.einsum("in,inm->nm", normal, apart)
    nearest = np.argmin(np.einsum("inm,inm->nm", apart, apart) - along**2, axis=1)
    half, other_half = (face_extent(scene.rod(face.rod), face.face)[0] for face in pair.faces)
    drawn = along[np.arange(len(station)), nearest] - half - other_half
    gap = drawn if pair.gap == "drawn" else given_gap(pair.gap, station)
    least = int(np.argmin(gap))
    return normal[:, least], float(drawn[least]), float(gap[least])


def round_below(value: float) -> float:
    """The largest of 1, 2 or 5 times a power of ten that is not above a positive value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-12)))


def magnification(quantities: Quantities) -> float:
    """A round factor, at least 1, by which displacements are drawn larger."""
    largest = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in quantities.rods)
    if largest <= 0.0:
        return 1.0
    return max(1.0, round_below(DRAWN_DISPLACEMENT * extent(quantities) / largest))


def drawn_shifts(scene: Scene, quantities: Quantities, factor: float) -> dict[str, Array]:
    """How far each rod is moved so that gaps are magnified like displacements, mm.

    The second rod of a pair is moved along the first face's normal from the drawn to the magnified given gap where that
    is least, with the rods that it is joined to or that already lie at a gap from it; the gap between rods that are
    joined to each other stays as drawn.
    """
    shifts = {rod.name: np.zeros(3) for rod in scene.rods}
    groups = _joined(scene)
    for pair in scene.contacts:
        if not isinstance(pair.second, RodFace) or groups[pair.first.rod] == groups[pair.second.rod]:
            continue
        normal, drawn, gap = least_gap(scene, quantities, pair, pair.second)
        move = shifts[pair.first.rod] + (factor * gap - drawn) * normal - shifts[pair.second.rod]
        kept, moved = groups[pair.first.rod], groups[pair.second.rod]
        for name in shifts:
            if groups[name] == moved:
                shifts[name], groups[name] = shifts[name] + move, kept
    return shifts


def _joined(scene: Scene) -> dict[str, int]:
    """Number of the group of joined rods that each rod belongs to."""
    groups = {rod.name: number for number, rod in enumerate(scene.rods)}
    for joint in scene.joints:
        members = {groups[end.rod] for end in joint.ends}
        groups = {name: min(members) if group in members else group for name, group in groups.items()}
    return groups
