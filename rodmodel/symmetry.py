"""Mirror planes of a scene: the fields that must vanish by symmetry are not carried.

A plane counts when every rod lies in it and has it as one of its own section's planes, no load points across it,
and no contact face looks across it. Reflection then maps the scene onto itself, and with it the unique solution.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cases.scene import (
    Clamp,
    Gravity,
    Helix,
    Line,
    LineLoad,
    Load,
    Path,
    Pressure,
    Rod,
    Scene,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
    Vector,
)
from rodmodel.assembly import Mirrors
from rodmodel.centre_line import centre_points, frame, frames, screw_motion
from rodmodel.pairing import face_axes
from rodmodel.shape import mirror_planes

Array = NDArray[np.float64]

# Directions and offsets are read from files with finitely many digits.
TOLERANCE = 1e-9


def scene_mirrors(scene: Scene) -> dict[str, Mirrors]:
    """By rod name, whether the solution is its own mirror image in x = 0 and in y = 0 of the rod's sections."""
    first = frame(scene.rods[0].centre_line)
    planes = [normal for normal in first[:2] if _is_mirror_plane(scene, normal)]
    return {rod.name: _mirrors(rod, planes) for rod in scene.rods}


def _mirrors(rod: Rod, planes: list[Array]) -> Mirrors:
    axes = frame(rod.centre_line)
    mirror_x, mirror_y = (any(abs(axis @ normal) > 1.0 - TOLERANCE for normal in planes) for axis in axes[:2])
    return mirror_x, mirror_y


def _is_mirror_plane(scene: Scene, normal: Array) -> bool:
    origin = np.asarray(scene.rods[0].centre_line.start)
    if not all(_lies_in(rod, origin, normal) for rod in scene.rods):
        return False
    if not all(_keeps(load, normal) for load in scene.loads):
        return False
    if not all(_holds(support, scene.rod(support.rod), normal) for support in scene.supports):
        return False
    faces = [side for pair in scene.contacts for side in pair.faces]
    faces += [bed.face for bed in scene.beds] + [load.face for load in scene.loads if isinstance(load, Pressure)]
    return all(abs(normal @ face_axes(scene.rod(face.rod), face.face).normal) < TOLERANCE for face in faces)


def _lies_in(rod: Rod, origin: Array, normal: Array) -> bool:
    """Whether a rod's centre line lies in the plane, and its section is and stays symmetric about it."""
    across = np.abs(frame(rod.centre_line)[:2] @ normal) > 1.0 - TOLERANCE
    if not np.any(across & mirror_planes(rod.section)):
        return False
    pieces = rod.centre_line.pieces if isinstance(rod.centre_line, Path) else (rod.centre_line,)
    return all(_piece_lies_in(piece, origin, normal, TOLERANCE * rod.length) for piece in pieces)


def _piece_lies_in(piece: Line | Helix | Spline, origin: Array, normal: Array, slack: float) -> bool:
    """Whether a piece of a centre line, whose frame has an axis along the normal at its start, lies in the plane."""
    if abs(normal @ (np.array(piece.start) - origin)) > slack:
        return False
    if isinstance(piece, Spline):
        # A cubic lies in the plane if four of its points do; with a frame that stays aligned, the section does.
        station = np.linspace(0.0, piece.length, 4 * len(piece.points))
        aligned = np.abs(frames(piece, station)[:, :2] @ normal).max(axis=1) > 1.0 - TOLERANCE
        height = normal @ centre_points(piece, station) - normal @ origin
        return bool(np.all(aligned) and np.all(np.abs(height) <= slack))
    # A line that does not turn stays in the plane; one that turns must do so about the plane's normal.
    motion = screw_motion(piece)
    return motion.turning == 0.0 or bool(abs(motion.axis @ normal) > 1.0 - TOLERANCE)


def _keeps(load: Load, normal: Array) -> bool:
    """Whether reflection leaves a load as it is: no force across the plane, no moment but across it."""
    match load:
        case SectionForce() | LineLoad():
            return _lies(load.force, normal)
        case Gravity():
            return _lies(load.acceleration, normal)
        case SectionMoment():
            return _crosses(load.moment, normal)
        case Pressure():
            return True  # its face is looked at


def _holds(support: Clamp | Support, rod: Rod, normal: Array) -> bool:
    """Whether reflection leaves what a support prescribes as it is."""
    if isinstance(support, Clamp):
        return _lies(support.displacement, normal) and _crosses(support.rotation, normal)
    axes = frames(rod.centre_line, np.array([support.position]))[0]
    for component, value in zip(support.components, support.displacement, strict=False):
        vector = value * axes["xys".index(component[-1])]
        if not (_crosses(vector, normal) if component.startswith("turn") else _lies(vector, normal)):
            return False
    return True


def _lies(vector: Vector | Array, normal: Array) -> bool:
    """Whether a vector lies in the plane."""
    return abs(float(normal @ vector)) <= TOLERANCE * float(np.linalg.norm(vector))


def _crosses(vector: Vector | Array, normal: Array) -> bool:
    """Whether a vector stands on the plane."""
    size = float(np.linalg.norm(vector))
    return size - abs(float(normal @ vector)) <= TOLERANCE * size
