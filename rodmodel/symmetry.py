"""Mirror planes of a scene: the fields that must vanish by symmetry are not carried.

A plane counts when every rod lies in it and has it as one of its own section's planes, no load points across it,
and no contact face looks across it. Reflection then maps the scene onto itself, and with it the unique solution.
"""

from __future__ import annotations

import numpy as np

from cases.scene import Rod, Scene
from rodmodel.centre_line import frame
from rodmodel.pairing import face_axes
from rodmodel.section import Fields

# Directions and offsets are read from files with finitely many digits.
TOLERANCE = 1e-9


def symmetric_fields(scene: Scene, level: int) -> dict[str, Fields]:
    """The fields each rod has to carry at level h_level, by rod name."""
    first = frame(scene.rods[0].centre_line)
    planes = [normal for normal in first[:2] if _is_mirror_plane(scene, normal)]
    return {rod.name: Fields(level, *_mirrors(rod, planes)) for rod in scene.rods}


def _mirrors(rod: Rod, planes: list[np.ndarray]) -> tuple[bool, bool]:
    axes = frame(rod.centre_line)
    mirror_x, mirror_y = (any(abs(axis @ normal) > 1.0 - TOLERANCE for normal in planes) for axis in axes[:2])
    return mirror_x, mirror_y


def _is_mirror_plane(scene: Scene, normal: np.ndarray) -> bool:
    origin = np.asarray(scene.rods[0].centre_line.start)
    for rod in scene.rods:
        line = rod.centre_line
        for point in (line.start, line.end):
            if abs(normal @ (np.asarray(point) - origin)) > TOLERANCE * rod.length:
                return False
        if max(abs(axis @ normal) for axis in frame(line)[:2]) < 1.0 - TOLERANCE:
            return False
    if any(abs(normal @ load.force) > TOLERANCE * np.linalg.norm(load.force) for load in scene.loads):
        return False
    sides = [side for pair in scene.contacts for side in (pair.first, pair.second)]
    return all(abs(normal @ face_axes(scene.rod(side.rod), side.face).normal) < TOLERANCE for side in sides)
