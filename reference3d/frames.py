"""Straight rods in space: local frame, lateral faces, and the rectangle in which faces of a pair overlap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, Face, GapTable, Ground, Rod, RoundGap, Scene, SceneError
from reference3d.scope import forces, rectangle, straight_line

Array = NDArray[np.float64]

# directions of faces are compared to this accuracy (an angle of 1e-6 over 1 m is 1 micrometre)
ANGLE_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Frame:
    """Local frame of a straight rod.

    Attributes
    ----------
    origin : start of the centre line, global, mm, shape (3,)
    axes : rows e1, e2, t in global components, shape (3, 3); local = axes @ global
    """

    origin: Array
    axes: Array


@dataclass(frozen=True)
class FaceFrame:
    """A lateral face of a rod.

    Attributes
    ----------
    normal_axis, lateral_axis : which local axis (0 for x, 1 for y) is normal to the face and which lies in it
    side : +1 if the outward normal is along the normal axis, -1 if against it
    normal, lateral, tangent : global unit vectors, shape (3,)
    offset : distance of the face from the centre line, mm
    half_width : half its extent along `lateral`, mm
    """

    normal_axis: int
    lateral_axis: int
    side: int
    normal: Array
    lateral: Array
    tangent: Array
    offset: float
    half_width: float


@dataclass(frozen=True)
class Overlap:
    """Where the faces of a pair face each other in its zone: a rectangle in the coordinates of both.

    Coordinates on a face are (s, lateral), mm; a point of the first face lies on the second at
    sign * (s, lateral) + shift.

    Attributes
    ----------
    first, second : ((s_start, s_end), (lateral_start, lateral_end))
    sign : +1 or -1 for each coordinate, shape (2,)
    shift : mm, shape (2,)
    """

    first: tuple[tuple[float, float], tuple[float, float]]
    second: tuple[tuple[float, float], tuple[float, float]]
    sign: Array
    shift: Array


def rod_frame(rod: Rod) -> Frame:
    """Frame (e1, e2, t) of a rod as `cases.scene` defines it."""
    line = straight_line(rod)
    start = np.array(line.start, dtype=np.float64)
    tangent = np.array(line.end, dtype=np.float64) - start
    tangent /= np.linalg.norm(tangent)
    up = np.array(line.up, dtype=np.float64)
    e2 = up - (up @ tangent) * tangent
    e2 /= np.linalg.norm(e2)
    return Frame(origin=start, axes=np.stack([np.cross(e2, tangent), e2, tangent]))


def face_frame(rod: Rod, face: Face) -> FaceFrame:
    """Axes and extent of one lateral face."""
    axes = rod_frame(rod).axes
    normal_axis = 1 if face in ("top", "bottom") else 0
    side = 1 if face in ("top", "right") else -1
    extents = (rectangle(rod).width, rectangle(rod).height)
    return FaceFrame(
        normal_axis=normal_axis,
        lateral_axis=1 - normal_axis,
        side=side,
        normal=side * axes[normal_axis],
        lateral=axes[1 - normal_axis],
        tangent=axes[2],
        offset=0.5 * extents[normal_axis],
        half_width=0.5 * extents[1 - normal_axis],
    )


def pair_overlap(scene: Scene, pair: ContactPair) -> Overlap:
    """Part of the candidate zone in which the second face lies opposite the first: all of it on ground.

    A scene already sees to it that the second rod accompanies the whole zone.

    Raises
    ------
    SceneError
        if the rods or the faces are not parallel.
    """
    rod_1 = scene.rod(pair.first.rod)
    face_1 = face_frame(rod_1, pair.first.face)
    if isinstance(pair.second, Ground):
        whole = (pair.zone, (-face_1.half_width, face_1.half_width))
        return Overlap(whole, whole, sign=np.ones(2), shift=np.zeros(2))
    rod_2 = scene.rod(pair.second.rod)
    face_2 = face_frame(rod_2, pair.second.face)
    key = f"contacts.{pair.name}"
    if np.linalg.norm(face_1.normal + face_2.normal) > ANGLE_TOLERANCE:
        angle = np.degrees(np.arccos(np.clip(face_1.normal @ face_2.normal, -1.0, 1.0)))
        found = f"'{pair.second.face}', turned by {angle:.4g} degrees from the first face"
        remedy = "the 3D reference needs parallel faces that face each other (180 degrees)"
        raise SceneError(f"{key}.second.face", found, remedy)
    along = float(face_1.tangent @ face_2.tangent)
    if abs(along) < 1.0 - 0.5 * ANGLE_TOLERANCE**2:
        angle = np.degrees(np.arccos(abs(along)))
        remedy = "the 3D reference needs rods in contact to be parallel"
        raise SceneError(f"{key}.second.rod", f"'{rod_2.name}' at {angle:.4g} degrees to '{rod_1.name}'", remedy)
    sign = np.sign(np.array([along, float(face_1.lateral @ face_2.lateral)]))
    between = rod_frame(rod_1).origin - rod_frame(rod_2).origin
    shift = np.array([face_2.tangent @ between, face_2.lateral @ between])
    opposite = np.sort(sign[1] * (np.array([-1.0, 1.0]) * face_2.half_width - shift[1]))
    lateral = (max(-face_1.half_width, float(opposite[0])), min(face_1.half_width, float(opposite[1])))
    corners = sign[:, None] * np.array([pair.zone, lateral]) + shift[:, None]
    (s_start, s_end), (lateral_start, lateral_end) = np.sort(corners, axis=1).tolist()
    return Overlap(
        first=(pair.zone, lateral),
        second=((s_start, s_end), (lateral_start, lateral_end)),
        sign=sign,
        shift=shift,
    )


def gaps(scene: Scene, pair: ContactPair, station: Array) -> Array:
    """Initial distance of the faces of a pair at arc lengths of the first rod, mm; shape (n,) to (n,)."""
    match pair.gap:
        case GapTable():
            return np.interp(station, pair.gap.stations, pair.gap.gaps)
        case RoundGap():
            # the circle through the least gap, as far as a quarter of it
            radius, away = pair.gap.radius, station - pair.gap.station
            rise = np.sqrt(np.maximum(radius**2 - away**2, 0.0))
            return np.asarray(pair.gap.least + radius - np.copysign(rise, radius))
        case "drawn":
            sides = [(scene.rod(side.rod), face_frame(scene.rod(side.rod), side.face)) for side in pair.faces]
            first, second = (rod_frame(rod).origin + face.offset * face.normal for rod, face in sides)
            return np.full(len(station), float((second - first) @ sides[0][1].normal))
        case _:
            return np.full(len(station), float(pair.gap))


def is_symmetric(scene: Scene) -> bool:
    """Whether geometry, loads and supports are mirrored in the plane x = 0 of every rod."""
    for load in forces(scene):
        force = np.array(load.force)
        across = rod_frame(scene.rod(load.rod)).axes[0] @ force
        if abs(across) > 1e-12 * np.linalg.norm(force):
            return False
    for pair in scene.contacts:
        if not {face.face for face in pair.faces} <= {"top", "bottom"}:
            return False
        overlap = pair_overlap(scene, pair)
        if abs(overlap.shift[1]) > 1e-9 * rectangle(scene.rod(pair.first.rod)).width:
            return False
    return True
