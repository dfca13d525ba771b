"""Straight rods in space: local frame, lateral faces, and the rectangle in which the faces of a pair overlap."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, Face, Rod, Scene, SceneError

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
    """Where two faces of a pair face each other: a rectangle in the coordinates of both.

    Coordinates on a face are (s, lateral), mm. A point of the first face lies on the second at
    `matrix @ (s, lateral) + shift`.

    Attributes
    ----------
    first, second : ((s_start, s_end), (lateral_start, lateral_end))
    matrix : shape (2, 2), a rotation by a multiple of 90 degrees, possibly mirrored
    shift : mm, shape (2,)
    """

    first: tuple[tuple[float, float], tuple[float, float]]
    second: tuple[tuple[float, float], tuple[float, float]]
    matrix: Array
    shift: Array


def rod_frame(rod: Rod) -> Frame:
    """Frame (e1, e2, t) of a rod as `cases.scene` defines it."""
    start = np.array(rod.centre_line.start, dtype=np.float64)
    tangent = np.array(rod.centre_line.end, dtype=np.float64) - start
    tangent /= np.linalg.norm(tangent)
    up = np.array(rod.centre_line.up, dtype=np.float64)
    e2 = up - (up @ tangent) * tangent
    e2 /= np.linalg.norm(e2)
    return Frame(origin=start, axes=np.stack([np.cross(e2, tangent), e2, tangent]))


def face_frame(rod: Rod, face: Face) -> FaceFrame:
    """Axes and extent of one lateral face."""
    axes = rod_frame(rod).axes
    normal_axis = 1 if face in ("top", "bottom") else 0
    side = 1 if face in ("top", "right") else -1
    extents = (rod.section.width, rod.section.height)
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


def _bounds(corners: Array) -> tuple[tuple[float, float], tuple[float, float]]:
    low, high = corners.min(axis=1), corners.max(axis=1)
    return (float(low[0]), float(high[0])), (float(low[1]), float(high[1]))


def _corners(rectangle: tuple[tuple[float, float], tuple[float, float]]) -> Array:
    return np.array([[a, b] for a in rectangle[0] for b in rectangle[1]]).T


def pair_overlap(scene: Scene, pair: ContactPair) -> Overlap:
    """Rectangle of the candidate zone in which the second face lies opposite the first.

    Raises
    ------
    SceneError
        if the faces are not parallel and facing, the rods neither parallel nor at right angles, or the faces do
        not overlap in the zone.
    """
    rod_1, rod_2 = scene.rod(pair.first.rod), scene.rod(pair.second.rod)
    face_1, face_2 = face_frame(rod_1, pair.first.face), face_frame(rod_2, pair.second.face)
    key = f"contacts.{pair.name}"
    if np.linalg.norm(face_1.normal + face_2.normal) > ANGLE_TOLERANCE:
        found = (
            f"outward normals {np.round(face_1.normal, 6).tolist()} and {np.round(face_2.normal, 6).tolist()}"
        )
        raise SceneError(
            f"{key}.second.face", found, "the 3D reference needs parallel faces that face each other"
        )
    basis_1 = np.stack([face_1.tangent, face_1.lateral])
    basis_2 = np.stack([face_2.tangent, face_2.lateral])
    matrix = basis_2 @ basis_1.T
    if np.abs(matrix - np.round(matrix)).max() > ANGLE_TOLERANCE:
        angle = np.degrees(np.arctan2(abs(matrix[0, 1]), abs(matrix[0, 0])))
        remedy = "the 3D reference needs rods in contact to be parallel or at right angles"
        raise SceneError(key, f"rods at {angle:.4g} degrees", remedy)
    matrix = np.round(matrix)
    shift = basis_2 @ (rod_frame(rod_1).origin - rod_frame(rod_2).origin)
    rectangle_2 = ((0.0, rod_2.length), (-face_2.half_width, face_2.half_width))
    opposite = _bounds(matrix.T @ (_corners(rectangle_2) - shift[:, None]))
    s_range = (max(pair.zone[0], opposite[0][0]), min(pair.zone[1], opposite[0][1]))
    lateral_range = (max(-face_1.half_width, opposite[1][0]), min(face_1.half_width, opposite[1][1]))
    smallest = 1e-6 * rod_1.length
    if s_range[1] - s_range[0] < smallest or lateral_range[1] - lateral_range[0] < smallest:
        found = f"{pair.zone[0]:g} .. {pair.zone[1]:g}"
        raise SceneError(f"{key}.zone", found, f"rod '{rod_2.name}' must lie opposite the zone")
    first = (s_range, lateral_range)
    return Overlap(first, _bounds(matrix @ _corners(first) + shift[:, None]), matrix, shift)


def is_symmetric(scene: Scene) -> bool:
    """Whether geometry, loads and supports are mirrored in the plane x = 0 of every rod."""
    for load in scene.loads:
        force = np.array(load.force)
        across = rod_frame(scene.rod(load.rod)).axes[0] @ force
        if abs(across) > 1e-12 * np.linalg.norm(force):
            return False
    for pair in scene.contacts:
        if not {pair.first.face, pair.second.face} <= {"top", "bottom"}:
            return False
        overlap = pair_overlap(scene, pair)
        parallel = abs(overlap.matrix[0, 0]) == 1.0
        if not parallel or abs(overlap.shift[1]) > 1e-9 * scene.rod(pair.first.rod).section.width:
            return False
    return True
