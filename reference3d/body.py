"""A rod as a 3D body: meshed, its stiffness factorised, its loads as nodal forces."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import LineLoad, Rod, Scene
from reference3d.elasticity import LayeredStiffness, layered_stiffness
from reference3d.factor import LayeredFactor, factorise
from reference3d.frames import pair_overlap, rod_frame
from reference3d.grading import Borders, rod_borders
from reference3d.mesh import box_mesh
from reference3d.quadratic import line_nodes, nodal_weights
from reference3d.scope import clamps, forces, isotropic, rectangle

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Body:
    """A discretised and factorised rod.

    free : unknowns of a plane not zero by symmetry; fixed, load : by plane, shape (n_planes, plane size)
    """

    rod: Rod
    borders: Borders
    stiffness: LayeredStiffness
    factor: LayeredFactor
    free: IntArray
    fixed: BoolArray
    load: Array

    @property
    def free_everywhere(self) -> IntArray:
        """`free` in every plane."""
        planes, size = self.fixed.shape
        return np.asarray((size * np.arange(planes)[:, None] + self.free).ravel())


def discretise(scene: Scene, rod: Rod, refinement: int, symmetric: bool) -> Body:
    """Mesh, stiffness, factor and loads of a rod.

    Parameters
    ----------
    refinement : k of `grading`
    symmetric : True for the half x >= 0 alone
    """
    borders = rod_borders(scene, rod, refinement, symmetric)
    stiffness = layered_stiffness(box_mesh(borders.x, borders.y, borders.s), borders, isotropic(rod))
    x, y, s = (line_nodes(axis) for axis in (borders.x, borders.y, borders.s))
    fixed = np.zeros((len(s), len(y), len(x), 3), dtype=bool)
    fixed[:, :, 0, 0] = symmetric
    clamped = {clamp.end for clamp in clamps(scene) if clamp.rod == rod.name}
    fixed[0] |= "start" in clamped
    fixed[-1] |= "end" in clamped
    in_plane = np.ones((len(y), len(x), 3), dtype=bool)
    in_plane[:, 0, 0] = not symmetric
    free = np.flatnonzero(in_plane)
    load = np.zeros(fixed.shape)
    section = rectangle(rod)
    weights = np.outer(*(nodal_weights(axis, float(axis[0]), float(axis[-1])) for axis in (borders.y, borders.x)))
    weights /= section.width * section.height
    for applied in forces(scene):
        if applied.rod != rod.name:
            continue
        if isinstance(applied, LineLoad):
            along = nodal_weights(borders.s, applied.start, applied.end)
        else:
            along = np.zeros(len(s))
            along[int(np.argmin(np.abs(s - applied.position)))] = 1.0
        spread = np.multiply.outer(along, weights)
        load += np.multiply.outer(spread, rod_frame(rod).axes @ np.array(applied.force))
    reverse = _contact_near_start(scene, rod)
    return Body(
        rod=rod,
        borders=borders,
        stiffness=stiffness,
        factor=factorise(stiffness, free, "start" in clamped, "end" in clamped, reverse),
        free=free,
        fixed=fixed.reshape(len(s), -1),
        load=load.reshape(len(s), -1),
    )


def _contact_near_start(scene: Scene, rod: Rod) -> bool:
    centres = []
    for pair in scene.contacts:
        overlap = pair_overlap(scene, pair)
        for side, opposite in zip(pair.faces, (overlap.first, overlap.second), strict=False):
            if side.rod == rod.name:
                centres.append(0.5 * (opposite[0][0] + opposite[0][1]))
    return bool(centres) and float(np.mean(centres)) < 0.5 * rod.length
