"""Mirror planes of a scene: the fields that must vanish by symmetry are not carried.

A plane counts when every rod lies in it and has it as one of its own section's planes, no load points across it,
and no contact face looks across it. Reflection then maps the scene onto itself, and with it the unique solution.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cases.scene import Load, Rod, Scene, SectionMoment
from rodmodel.assembly import Mirrors
from rodmodel.centre_line import frame, screw_motion
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
    sides = [side for pair in scene.contacts for side in (pair.first, pair.second)]
    return all(abs(normal @ face_axes(scene.rod(side.rod), side.face).normal) < TOLERANCE for side in sides)


def _lies_in(rod: Rod, origin: Array, normal: Array) -> bool:
    """Whether a rod's centre line lies in the plane, and its section is and stays symmetric about it."""
    motion = screw_motion(rod.centre_line)
    if abs(normal @ (motion.start - origin)) > TOLERANCE * rod.length:
        return False
    across = [abs(axis @ normal) > 1.0 - TOLERANCE for axis in motion.axes[:2]]
    if not any(mirror and lies for mirror, lies in zip(mirror_planes(rod.section), across, strict=True)):
        return False
    # A line that does not turn stays in the plane; one that turns must do so about the plane's normal.
    return motion.turning == 0.0 or bool(abs(motion.axis @ normal) > 1.0 - TOLERANCE)


def _keeps(load: Load, normal: Array) -> bool:
    """Whether reflection leaves a load as it is: no force across the plane, no moment but across it."""
    vector = np.asarray(load.moment if isinstance(load, SectionMoment) else load.force)
    across = abs(float(normal @ vector))
    size = float(np.linalg.norm(vector))
    if isinstance(load, SectionMoment):
        return size - across <= TOLERANCE * size
    return across <= TOLERANCE * size
