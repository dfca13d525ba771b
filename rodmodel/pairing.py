"""Which point of one face lies opposite which point of the other, in the small-displacement sense.

Both faces are flat and parallel and face one another. A contact point is given by its station along the first rod and
its coordinate across the first face; its partner lies straight across the gap.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import FACES, Box, ContactPair, Face, Rectangle, Rod, Scene
from rodmodel.axial import lobatto
from rodmodel.centre_line import frame, global_points, local_points

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class FaceAxes:
    """A lateral face of a rod.

    Attributes
    ----------
    axis : section coordinate along the outward normal: 0 for x, 1 for y; the other one runs across the face
    sign : +1 or -1, side of the section
    height : distance of the face from the centre line, mm
    half_width : half the extent across the face, mm
    normal : outward normal in global components, shape (3,)
    """

    axis: int
    sign: float
    height: float
    half_width: float
    normal: Array


def face_axes(rod: Rod, face: Face) -> FaceAxes:
    """Geometry of a face of a rod; ValueError where its section has no flat faces."""
    axis = 1 if face in ("top", "bottom") else 0
    sign = 1.0 if face in ("top", "right") else -1.0
    section = rod.section
    if not isinstance(section, Rectangle | Box):
        raise ValueError(f"rod '{rod.name}': only rectangles and boxes have the faces {', '.join(FACES)}")
    extents = (section.width, section.height)
    normal = sign * frame(rod.centre_line)[axis]
    return FaceAxes(axis, sign, 0.5 * extents[axis], 0.5 * extents[1 - axis], normal)


@dataclass(frozen=True, eq=False)
class FacingPoints:
    """Opposite points of a contact pair, in the local coordinates of each rod.

    Attributes
    ----------
    first, second : (x, y, s) on each rod's face, mm, shape (3, n)
    """

    first: Array
    second: Array


def facing_points(scene: Scene, pair: ContactPair, station: Array, across: Array) -> FacingPoints:
    """Points of both faces at a station along the first rod and a coordinate across its face (mm, shape (n,) each)."""
    rod_1, rod_2 = scene.rod(pair.first.rod), scene.rod(pair.second.rod)
    face_1, face_2 = face_axes(rod_1, pair.first.face), face_axes(rod_2, pair.second.face)
    first = np.empty((3, len(station)))
    first[face_1.axis] = face_1.sign * face_1.height
    first[1 - face_1.axis] = across
    first[2] = station
    second = local_points(rod_2, global_points(rod_1, first))
    second[face_2.axis] = face_2.sign * face_2.height
    return FacingPoints(first, second)


def opposite_stations(origin: Rod, target: Rod, station: Array) -> Array:
    """Stations along `target` of the points opposite `station` along `origin`, mm, shape (n,)."""
    points = np.zeros((3, len(station)))
    points[2] = station
    return np.asarray(local_points(target, global_points(origin, points))[2])


def width_across(scene: Scene, pair: ContactPair) -> tuple[float, float]:
    """Range of the coordinate across the first face in which the faces lie opposite one another, mm."""
    rod_1, rod_2 = scene.rod(pair.first.rod), scene.rod(pair.second.rod)
    face_1, face_2 = face_axes(rod_1, pair.first.face), face_axes(rod_2, pair.second.face)
    across_1, across_2 = frame(rod_1.centre_line)[1 - face_1.axis], frame(rod_2.centre_line)[1 - face_2.axis]
    offset = across_1 @ (np.asarray(rod_2.centre_line.start) - np.asarray(rod_1.centre_line.start))
    if abs(across_1 @ across_2) < 1.0 - 1e-9:
        raise ValueError(f"contact '{pair.name}': rods that are not parallel cannot be paired yet")
    low = max(-face_1.half_width, offset - face_2.half_width)
    high = min(face_1.half_width, offset + face_2.half_width)
    if low >= high:
        raise ValueError(f"contact '{pair.name}': the faces lie beside one another; shift one of the rods")
    return float(low), float(high)


@dataclass(frozen=True, eq=False)
class ContactGrid:
    """Contact points of the candidate zone: Lobatto points along each interval and across the width.

    Across, Lobatto points put contact points where pressure is asked for: in the middle and on the outer borders.

    Attributes
    ----------
    station : along the first rod, mm, shape (n_intervals, n_along)
    across : mm, ascending, shape (n_across,); from the middle on where the scene is symmetric about it
    weight : share of the face, mm^2, shape (n_intervals, n_along, n_across); for the full face
    """

    station: Array
    across: Array
    weight: Array
    symmetric: bool

    def flat(self) -> tuple[Array, Array]:
        """Station and across coordinate of every point, each of shape (n_intervals * n_along * n_across,)."""
        shape = self.weight.shape
        station = np.broadcast_to(self.station[:, :, None], shape)
        return station.ravel(), np.broadcast_to(self.across, shape).ravel()

    @property
    def middle(self) -> int:
        """Index across of the points in the middle of the width."""
        return 0 if self.symmetric else len(self.across) // 2


def contact_grid(
    intervals: Array, width: tuple[float, float], n_along: int, n_across: int, symmetric: bool
) -> ContactGrid:
    """Contact points in intervals along the first rod over the shared `width` (mm).

    intervals : start and end of each, mm, shape (n_intervals, 2)
    n_across : odd, so that one point lies in the middle
    symmetric : carry only the points from the middle on, the outer ones with twice their weight
    """
    xi, weight_along = lobatto(n_along)
    eta, weight_across = lobatto(n_across)
    low, high = width
    half_width = 0.5 * (high - low)
    if symmetric:
        middle = n_across // 2
        eta, weight_across = (
            eta[middle:],
            np.where(np.arange(n_across) > middle, 2.0, 1.0)[middle:] * weight_across[middle:],
        )
    across = 0.5 * (low + high) + half_width * eta
    half_length = 0.5 * (intervals[:, 1] - intervals[:, 0])
    station = intervals.mean(axis=1)[:, None] + half_length[:, None] * xi
    weight = half_length[:, None, None] * weight_along[:, None] * (half_width * weight_across)
    return ContactGrid(station, across, weight, symmetric)
