"""Which point of one face lies opposite which point of the other, in the small-displacement sense.

A contact point is given by its station along the first rod and its coordinate across the first face. Its partner lies
straight across the gap, along the first face's normal: on a face of another rod, parallel or crossing, straight or
curved, or on ground, which has no displacement of its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import FACES, Box, ContactPair, Face, Line, Rectangle, Rod, RodFace, Scene, SceneError
from rodmodel.axial import lobatto
from rodmodel.centre_line import centre_points, frame, frames, global_points, local_points, turning_at

Array = NDArray[np.float64]

# Rods at a cosine above this are parallel.
PARALLEL = 1.0 - 1e-9
# Steps of Newton's method for the point opposite, on a curved rod; and what it leaves, as a part of the rod's length.
MOST_STEPS, FOUND = 30, 1e-12
# Contact points with less than this part of the largest share of the face have none.
NO_SHARE = 1e-12
# Points along a curved rod among which it begins.
SAMPLES = 200


@dataclass(frozen=True, eq=False)
class FaceAxes:
    """A lateral face of a rod.

    Attributes
    ----------
    axis : section coordinate along the outward normal: 0 for x, 1 for y; the other one runs across the face
    sign : +1 or -1, side of the section
    height : distance of the face from the centre line, mm
    half_width : half the extent across the face, mm
    normal : outward normal at the rod's start in global components, shape (3,)
    """

    axis: int
    sign: float
    height: float
    half_width: float
    normal: Array

    def points(self, across: Array, station: Array) -> Array:
        """(x, y, s) of points of the face, mm, shape (3, n)."""
        points = np.empty((3, len(station)))
        points[self.axis] = self.sign * self.height
        points[1 - self.axis] = across
        points[2] = station
        return points


@lru_cache(maxsize=256)
def face_axes(rod: Rod, face: Face) -> FaceAxes:
    """Geometry of a face of a rod; ValueError where its section has no flat faces."""
    axis = 1 if face in ("top", "bottom") else 0
    sign = 1.0 if face in ("top", "right") else -1.0
    section = rod.section
    if not isinstance(section, Rectangle | Box):
        raise ValueError(f"rod '{rod.name}': only rectangles and boxes have the faces {', '.join(FACES)}")
    extents = (section.width, section.height)
    normal = sign * frame(rod.centre_line)[axis]
    normal.flags.writeable = False
    return FaceAxes(axis, sign, 0.5 * extents[axis], 0.5 * extents[1 - axis], normal)


def is_flat(rod: Rod) -> bool:
    """Whether a rod is straight and does not turn about itself, so that its faces are flat."""
    return isinstance(rod.centre_line, Line) and rod.centre_line.twist == 0.0


def is_even(scene: Scene, pair: ContactPair) -> bool:
    """Whether all stations are alike: flat faces, parallel and running along each other, or one of them on ground.

    Only along such pairs element borders can follow the edges of contact on both rods.
    """
    return _are_even(tuple((scene.rod(face.rod), face.face) for face in pair.faces))


@lru_cache(maxsize=256)
def _are_even(faces: tuple[tuple[Rod, Face], ...]) -> bool:
    if not all(is_flat(rod) for rod, _ in faces):
        return False
    normals = [face_axes(rod, face).normal for rod, face in faces]
    tangents = [frame(rod.centre_line)[2] for rod, _ in faces]
    return all(abs(each[0] @ each[-1]) > PARALLEL for each in (normals, tangents))


@dataclass(frozen=True, eq=False)
class Facing:
    """Opposite points of a contact pair.

    Attributes
    ----------
    first : (x, y, s) on the first face, mm, shape (3, n)
    second : (x, y, s) on the second rod's face straight across the gap, mm, shape (3, n); None on ground
    normal : outward normal of the first face, global, shape (3, n)
    distance : from the first face along its normal to the second, as drawn, mm, shape (n,); zero on ground
    """

    first: Array
    second: Array | None
    normal: Array
    distance: Array


def facing_points(scene: Scene, pair: ContactPair, station: Array, across: Array) -> Facing:
    """Points of both faces at a station along the first rod and a coordinate across its face (mm, shape (n,) each).

    Raises
    ------
    SceneError
        if a point of the second face is not found straight across the gap.
    """
    rod = scene.rod(pair.first.rod)
    first = face_axes(rod, pair.first.face).points(across, station)
    normal = face_normals(rod, pair.first.face, first)
    if not isinstance(pair.second, RodFace):
        return Facing(first, None, normal, np.zeros(len(station)))
    other = scene.rod(pair.second.rod)
    position = global_points(rod, first)
    if is_flat(other):
        second, distance = _straight_across(other, pair.second.face, position, normal)
    else:
        second, distance = _across(pair, other, position, normal)
    return Facing(first, second, normal, distance)


def face_normals(rod: Rod, face: Face, points: Array) -> Array:
    """Outward unit normals of a face at its points (x, y, s), global, shape (3, n)."""
    axes = face_axes(rod, face)
    if is_flat(rod):
        return np.repeat(axes.normal[:, None], points.shape[1], axis=1)
    # The face moves by e1 or e2 across it, and by sqrt(g) t + tau (x e2 - y e1) along it.
    k1, k2, tau = turning_at(rod.centre_line, points[2])
    stretch = 1.0 - k2 * points[0] + k1 * points[1]
    local = np.zeros_like(points)
    local[axes.axis] = stretch
    local[2] = -tau * points[0] if axes.axis == 1 else tau * points[1]
    local *= axes.sign / np.linalg.norm(local, axis=0)
    return np.asarray(np.einsum("nci,cn->in", frames(rod.centre_line, points[2]), local))


def _straight_across(rod: Rod, face: Face, position: Array, normal: Array) -> tuple[Array, Array]:
    """Where lines from `position` along `normal` meet a flat face: (x, y, s), and how far along the lines."""
    axes = face_axes(rod, face)
    points = local_points(rod, position)
    direction = frame(rod.centre_line) @ normal
    distance = (axes.sign * axes.height - points[axes.axis]) / direction[axes.axis]
    second = points + distance * direction
    second[axes.axis] = axes.sign * axes.height
    return second, distance


def _across(pair: ContactPair, rod: Rod, position: Array, normal: Array) -> tuple[Array, Array]:
    """The same for a face that is not flat, by Newton's method from the nearest of many points of the centre line."""
    axes = face_axes(rod, pair.faces[1].face)
    samples = np.linspace(0.0, rod.length, SAMPLES + 1)
    points = centre_points(rod.centre_line, samples)
    # Nearest to the line along the normal, not to the point.
    apart = points[:, None, :] - position[:, :, None]
    aside = apart - np.einsum("in,inm->nm", normal, apart)[None] * normal[:, :, None]
    station = samples[np.argmin(np.einsum("inm,inm->nm", aside, aside), axis=1)]
    across, distance = np.zeros_like(station), np.zeros_like(station)
    for _ in range(MOST_STEPS):
        second = axes.points(across, station)
        missing = position + distance * normal - global_points(rod, second)
        local = frames(rod.centre_line, station)
        k1, k2, tau = turning_at(rod.centre_line, station)
        stretch = 1.0 - k2 * second[0] + k1 * second[1]
        along = np.stack([-tau * second[1], tau * second[0], stretch])
        moves = np.stack([local[:, 1 - axes.axis].T, np.einsum("nci,cn->in", local, along), -normal])
        step = np.linalg.solve(moves.transpose(2, 1, 0), missing.T[:, :, None])[:, :, 0]
        # A step of more than a quarter of the rod would leave the neighbourhood where the linear picture holds.
        step[:, 1] = np.clip(step[:, 1], -0.25 * rod.length, 0.25 * rod.length)
        across, station, distance = across + step[:, 0], station + step[:, 1], distance + step[:, 2]
        if np.abs(step).max(initial=0.0) <= FOUND * rod.length:
            return axes.points(across, station), distance
    found = f"{pair.zone[0]:g} .. {pair.zone[1]:g}"
    remedy = f"rod '{rod.name}' is not straight across the gap from all of it; shorten the zone"
    raise SceneError(f"contacts.{pair.name}.zone", found, remedy)


def opposite_stations(origin: Rod, target: Rod, station: Array) -> Array:
    """Stations along the straight rod `target` of the points opposite `station` along `origin`, mm, shape (n,)."""
    points = np.zeros((3, len(station)))
    points[2] = station
    return np.asarray(local_points(target, global_points(origin, points))[2])


def shared_width(scene: Scene, pair: ContactPair, station: Array) -> tuple[Array, Array]:
    """Range across the first face in which something lies opposite, at stations along the first rod, mm, (n,) each.

    Low is not below high where nothing does.
    """
    rod = scene.rod(pair.first.rod)
    half_width = face_axes(rod, pair.first.face).half_width
    low, high = np.full(len(station), -half_width), np.full(len(station), half_width)
    if not isinstance(pair.second, RodFace):
        return low, high
    other = scene.rod(pair.second.rod)
    axes = face_axes(other, pair.second.face)
    sides = [np.full(len(station), side) for side in (-half_width, half_width)]
    ends = [facing_points(scene, pair, station, side).second for side in sides]
    for coordinate, least, most in ((1 - axes.axis, -axes.half_width, axes.half_width), (2, 0.0, other.length)):
        # Flat faces make the partner's coordinates linear across the first face; others nearly so.
        begin, end = (points[coordinate] for points in ends if points is not None)
        rate = (end - begin) / (2.0 * half_width)
        with np.errstate(divide="ignore", invalid="ignore"):
            bounds = np.sort([(limit - begin) / rate - half_width for limit in (least, most)], axis=0)
        still = np.abs(end - begin) < 1e-9 * half_width
        # Stations that `shared_borders` gives are on the limits up to round-off.
        slack = 1e-9 * (most - least)
        inside = (least - slack <= begin) & (begin <= most + slack)
        low = np.maximum(low, np.where(still, np.where(inside, -half_width, half_width), bounds[0]))
        high = np.minimum(high, np.where(still, np.where(inside, half_width, -half_width), bounds[1]))
    return low, high


def shared_borders(scene: Scene, pair: ContactPair) -> Array:
    """Stations along the first rod where faces begin and end to lie opposite, and corners of what they share between.

    Within the zone, ascending, mm; of curved faces without the corners, and to a thousandth of the zone.

    Raises
    ------
    SceneError
        if nothing lies opposite anywhere in the zone.
    """
    if is_even(scene, pair):
        return np.array(pair.zone)
    if all(is_flat(scene.rod(face.rod)) for face in pair.faces):
        stations = _shared_corners(scene, pair)[0]
    else:
        samples = np.linspace(*pair.zone, 1001)
        low, high = shared_width(scene, pair, samples)
        stations = samples[high > low][[0, -1]] if (high > low).any() else np.empty(0)
    if np.ptp(stations) <= 0.0 if len(stations) else True:
        remedy = f"no point of rod '{pair.faces[-1].rod}' lies straight across the gap there"
        raise SceneError(f"contacts.{pair.name}.zone", f"{pair.zone[0]:g} .. {pair.zone[1]:g}", remedy)
    return np.unique(stations)


def _shared_corners(scene: Scene, pair: ContactPair) -> Array:
    """Corners (s, across) on the flat first face of what it shares with a flat second one, mm, shape (2, n)."""
    rod, other = (scene.rod(face.rod) for face in pair.faces)
    own, axes = (face_axes(each, face.face) for each, face in zip((rod, other), pair.faces, strict=True))
    around = np.array([[-1.0, -1.0, 1.0, 1.0], [0.0, 1.0, 1.0, 0.0]])
    position = global_points(other, axes.points(axes.half_width * around[0], other.length * around[1]))
    corners, _ = _straight_across(rod, pair.first.face, position, np.repeat(own.normal[:, None], 4, axis=1))
    polygon = corners[[2, 1 - own.axis]].T
    # Sutherland and Hodgman: cut by one side of the first face after the other.
    for coordinate, limit, sign in ((0, pair.zone[0], 1.0), (0, pair.zone[1], -1.0)):
        polygon = _cut(polygon, coordinate, limit, sign)
    for limit, sign in ((-own.half_width, 1.0), (own.half_width, -1.0)):
        polygon = _cut(polygon, 1, limit, sign)
    return polygon.T


def _cut(polygon: Array, coordinate: int, limit: float, sign: float) -> Array:
    """The part of a convex polygon, corners of shape (n, 2), where sign (coordinate - limit) >= 0."""
    height = sign * (polygon[:, coordinate] - limit)
    kept = []
    for index, corner in enumerate(polygon):
        before, at_corner = height[index - 1], height[index]
        if before * at_corner < 0.0:
            kept.append(polygon[index - 1] + before / (before - at_corner) * (corner - polygon[index - 1]))
        if at_corner >= 0.0:
            kept.append(corner)
    return np.array(kept).reshape(-1, 2)


def on_second(scene: Scene, pair: ContactPair, station: Array) -> Array:
    """Stations along the second rod that lie opposite the shared part of the first face, mm: of `station` where all
    stations are alike, else the two ends of what is shared.
    """
    first, second = (scene.rod(face.rod) for face in pair.faces)
    if is_even(scene, pair):
        return opposite_stations(first, second, station)
    borders = shared_borders(scene, pair)
    within = np.linspace(borders[0], borders[-1], 101)
    low, high = shared_width(scene, pair, within)
    sides = [facing_points(scene, pair, within, side).second for side in (low, high)]
    along = np.concatenate([points[2] for points in sides if points is not None])
    return np.asarray(np.clip([along.min(), along.max()], 0.0, second.length))


@dataclass(frozen=True, eq=False)
class ContactGrid:
    """Contact points of the candidate zone: Lobatto points along each interval and across what the faces share.

    Across, Lobatto points put contact points where pressure is asked for: in the middle and on the outer borders.

    Attributes
    ----------
    station : along the first rod, mm, shape (n_intervals, n_along)
    across : mm, ascending, shape (n_intervals, n_along, n_across); from the middle on where the scene is symmetric
        about it
    weight : share of the face, mm^2, same shape; for the full face
    symmetric : whether only the points from the middle on are carried
    even : whether all stations have the same points across, and the two faces are flat
    facing : where the points lie on both faces
    """

    station: Array
    across: Array
    weight: Array
    symmetric: bool
    even: bool
    facing: Facing

    def flat(self) -> tuple[Array, Array]:
        """Station and across coordinate of every point, each of shape (n_intervals * n_along * n_across,)."""
        station = np.broadcast_to(self.station[:, :, None], self.weight.shape)
        return station.ravel(), self.across.ravel()

    @property
    def middle(self) -> int:
        """Index across of the points in the middle of the width."""
        return 0 if self.symmetric else self.weight.shape[2] // 2


def contact_grid(
    scene: Scene, pair: ContactPair, intervals: Array, points: tuple[int, int], symmetric: bool
) -> ContactGrid:
    """Contact points in intervals along the first rod over what the faces share.

    intervals : start and end of each, mm, shape (n_intervals, 2)
    points : how many along each interval and, an odd number so that one lies in the middle, across
    symmetric : carry only the points from the middle on, the outer ones with twice their weight
    """
    xi, weight_along = lobatto(points[0])
    eta, weight_across = lobatto(points[1])
    if symmetric:
        middle = points[1] // 2
        eta, weight_across = eta[middle:], weight_across[middle:] * np.append(1.0, np.full(middle, 2.0))
    half_length = 0.5 * (intervals[:, 1] - intervals[:, 0])
    station = intervals.mean(axis=1)[:, None] + half_length[:, None] * xi
    even = is_even(scene, pair)
    low, high = (side.reshape(-1, 1) for side in shared_width(scene, pair, station[:1, 0] if even else station.ravel()))
    if even and low[0, 0] >= high[0, 0]:
        remedy = "the faces lie beside one another; shift one of the rods"
        raise SceneError(f"contacts.{pair.name}.second.rod", f"'{pair.faces[-1].rod}'", remedy)
    half_width = np.maximum(0.5 * (high - low), 0.0)
    shape = (*station.shape, len(eta))
    across = np.broadcast_to((0.5 * (low + high) + half_width * eta).reshape(-1, len(eta)), (station.size, len(eta)))
    widths = np.broadcast_to(half_width * weight_across, (station.size, len(eta))).reshape(shape)
    weight = (half_length[:, None] * weight_along)[:, :, None] * widths
    stations = np.repeat(station.ravel(), len(eta))
    return ContactGrid(
        station, across.reshape(shape), weight, symmetric, even, facing_points(scene, pair, stations, across.ravel())
    )
