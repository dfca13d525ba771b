"""What lies straight across the gap between faces of any rods, and where along both rods that is."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, Face, Ground, Rod, RodFace, Scene, SceneError
from reference3d.centre_line import frames, points
from reference3d.frames import gaps
from reference3d.section_mesh import section_extents

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# reach of the differences that give the slope of a face along its rod, over the rod's length
REACH = 1e-4
# places along the second rod from which the nearest begins the search, and what distance across the gap counts there
SAMPLES, ACROSS_GAP = 241, 0.1
# cosine between outward normals above which faces do not face each other
FACING = -0.5
# Newton's steps at most, and distance at which the point opposite is found, over the second rod's length
MOST_STEPS, FOUND = 30, 1e-11
# how far beyond the border of a face a point still is on it, over the face's half width
ON_FACE = 1e-6
# places of the first face, along and across, at which a patch is looked for, and halvings that find its ends
PATCH_ALONG, PATCH_ACROSS, HALVINGS = 401, 5, 27
# change of the gap over the smaller side of the sections above which its least place counts
EVEN_GAP = 1e-6
# gaps closer than this, over that change, are one
SAME_GAP = 1e-3


@dataclass(frozen=True)
class FacePlace:
    """A lateral face in its section: axis of its normal (0 for x, 1 for y), side on it, offset and half width, mm."""

    axis: int
    side: float
    offset: float
    half_width: float


def face_place(rod: Rod, face: Face) -> FacePlace:
    """Where a face lies in the section of its rod."""
    axis = 1 if face in ("top", "bottom") else 0
    extents = section_extents(rod.section)
    side = 1.0 if face in ("top", "right") else -1.0
    return FacePlace(axis, side, side * 0.5 * extents[axis], 0.5 * extents[1 - axis])


def surface(rod: Rod, face: Face, station: Array, lateral: Array) -> Array:
    """Points of a face, global, mm, shape (n, 3); station, lateral : coordinates along and across it, mm, (n,)."""
    place = face_place(rod, face)
    axes = frames(rod.centre_line, station)
    across = lateral[:, None] * axes[:, 1 - place.axis]
    return np.asarray(points(rod.centre_line, station) + across + place.offset * axes[:, place.axis])


def surface_slope(rod: Rod, face: Face, station: Array, lateral: Array) -> Array:
    """Derivative of `surface` along the rod, shape (n, 3)."""
    reach = REACH * rod.length
    middle = np.clip(station, reach, rod.length - reach)
    after, before = (surface(rod, face, middle + step, lateral) for step in (reach, -reach))
    return (after - before) / (2.0 * reach)


def surface_normal(rod: Rod, face: Face, station: Array, lateral: Array) -> Array:
    """Outward unit normals of a face, global, shape (n, 3)."""
    place = face_place(rod, face)
    axes = frames(rod.centre_line, station)
    normal = np.cross(surface_slope(rod, face, station, lateral), axes[:, 1 - place.axis])
    outward = place.side * np.sum(normal * axes[:, place.axis], axis=1, keepdims=True)
    return np.asarray(normal * np.sign(outward) / np.linalg.norm(normal, axis=1, keepdims=True))


@dataclass(frozen=True)
class Opposite:
    """Points of the second face straight across the gap.

    Attributes
    ----------
    found : where there is one, shape (n,)
    station, lateral : on the second face, mm, shape (n,)
    distance : from the first face along its normal, as drawn, mm, shape (n,)
    """

    found: BoolArray
    station: Array
    lateral: Array
    distance: Array


def opposite(position: Array, normal: Array, rod: Rod, face: Face) -> Opposite:
    """Where lines from points along normals meet a face, by Newton's method from the nearest of many of its points.

    position, normal : global, mm, shape (n, 3)
    """
    place = face_place(rod, face)
    samples = np.linspace(0.0, rod.length, SAMPLES)
    middle = np.zeros(SAMPLES)
    apart = surface(rod, face, samples, middle)[None] - position[:, None]
    across = np.einsum("nki,ni->nk", apart, normal)
    aside = np.linalg.norm(apart - across[:, :, None] * normal[:, None], axis=2)
    faces_it = normal @ surface_normal(rod, face, samples, middle).T < FACING
    far = np.where(faces_it, aside + ACROSS_GAP * np.abs(across), np.inf)
    nearest = np.argmin(far, axis=1)
    row = np.arange(len(position))
    station, lateral, distance = samples[nearest], np.zeros(len(position)), across[row, nearest]
    looking = np.flatnonzero(np.isfinite(far[row, nearest]))
    found = np.zeros(len(position), dtype=bool)
    for _ in range(MOST_STEPS):
        at, beside = station[looking], lateral[looking]
        missing = position[looking] + distance[looking, None] * normal[looking] - surface(rod, face, at, beside)
        there = np.linalg.norm(missing, axis=1) <= FOUND * rod.length
        found[looking[there]] = True
        looking, missing, at, beside = looking[~there], missing[~there], at[~there], beside[~there]
        if len(looking) == 0:
            break
        lateral_axis = frames(rod.centre_line, at)[:, 1 - place.axis]
        moves = np.stack([surface_slope(rod, face, at, beside), lateral_axis, -normal[looking]], axis=2)
        step = np.linalg.solve(moves, missing[:, :, None])[:, :, 0]
        station[looking] += np.clip(step[:, 0], -0.25 * rod.length, 0.25 * rod.length)
        lateral[looking] += step[:, 1]
        distance[looking] += step[:, 2]
    slack = ON_FACE * place.half_width
    found &= (station >= -slack) & (station <= rod.length + slack) & (np.abs(lateral) <= place.half_width + slack)
    inside = np.clip(station, 0.0, rod.length), np.clip(lateral, -place.half_width, place.half_width)
    return Opposite(found, *inside, distance)


@dataclass(frozen=True)
class Patch:
    """Where along a rod something of a pair lies opposite, arc length, mm; least : where the gap is, if it varies."""

    start: float
    end: float
    least: float | None


@lru_cache(maxsize=32)
def patches(scene: Scene, pair: ContactPair) -> tuple[Patch, ...]:
    """Patches of a pair on its rods, in the order of its faces.

    Raises
    ------
    SceneError
        if nothing lies opposite anywhere in the zone.
    """
    rod = scene.rod(pair.first.rod)
    half_width = face_place(rod, pair.first.face).half_width
    across = np.linspace(-half_width, half_width, PATCH_ACROSS)

    def facing(station: Array) -> Opposite:
        grid = np.repeat(station, PATCH_ACROSS), np.tile(across, len(station))
        position, normal = (each(rod, pair.first.face, *grid) for each in (surface, surface_normal))
        assert isinstance(pair.second, RodFace)  # asked for of two rods alone
        return opposite(position, normal, scene.rod(pair.second.rod), pair.second.face)

    station = np.linspace(*pair.zone, PATCH_ALONG)
    sections = [section_extents(scene.rod(face.rod).section) for face in pair.faces]
    even = EVEN_GAP * min(min(extents) for extents in sections)
    if isinstance(pair.second, Ground):
        gap = gaps(scene, pair, station)
        return (Patch(*pair.zone, float(station[np.argmin(gap)]) if np.ptp(gap) > even else None),)
    found = facing(station)
    covered = found.found.reshape(-1, PATCH_ACROSS).any(axis=1)
    if not covered.any():
        remedy = f"no point of rod '{pair.second.rod}' lies straight across the gap there"
        raise SceneError(f"contacts.{pair.name}.zone", f"{pair.zone[0]:g} .. {pair.zone[1]:g}", remedy)
    first, last = np.flatnonzero(covered)[[0, -1]].tolist()
    ends, beyond = station[[first, last]], station[[max(first - 1, 0), min(last + 1, PATCH_ALONG - 1)]]
    for _ in range(HALVINGS):
        middle = 0.5 * (ends + beyond)
        inside = facing(middle).found.reshape(2, -1).any(axis=1)
        ends, beyond = np.where(inside, middle, ends), np.where(inside, beyond, middle)
    at_ends = facing(ends)
    partners = np.concatenate([found.station[found.found], at_ends.station[at_ends.found]])
    own, other = None, None
    drawn = pair.gap == "drawn"
    gap = found.distance if drawn else np.repeat(gaps(scene, pair, station), PATCH_ACROSS)
    gap = np.where(found.found, gap, np.inf)
    if np.ptp(gap[found.found]) > even:
        # of several that are equally near, the one in the middle of the width
        middle_of_width = np.tile(np.abs(across), PATCH_ALONG)
        place = int(np.lexsort((middle_of_width, np.round(gap / (SAME_GAP * even))))[0])
        own, other = float(station[place // PATCH_ACROSS]), float(found.station[place])
    return Patch(float(ends[0]), float(ends[1]), own), Patch(float(partners.min()), float(partners.max()), other)
