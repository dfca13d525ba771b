"""Rigid joints between rods: each joint's rigid motion is what its rods have in common, and all else is condensed.

A joined end is held in its rod's chain like a clamp that the joint moves. The reactions of all rods on unit motions of
the joints are the stiffness of the skeleton; the functionals on the rods, condensed onto the joints, add their inner
products in its inverse to the compliance.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from rodmodel.assembly import AssembledRod, Functionals, Mirrors, functionals, held_parts
from rodmodel.centre_line import frame
from rodmodel.triangular import cholesky, lower_solve, transposed_solve

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class JoinedRod:
    """What a rod with joined ends adds to the skeleton.

    Attributes
    ----------
    motions : of its joined nodes under unit motions of the joints, by node, shape (n_fields, n_motions) each
    response : the rod's stiffness times these motions, as functionals
    """

    assembled: AssembledRod
    motions: Mapping[int, Array]
    response: Functionals

    def on_joints(self, functionals: Functionals) -> Array:
        """Functionals on the joints' motions, the rest of the rod condensed, shape (n_motions, m)."""
        result = -self.response.nodal.T @ functionals.nodal
        for node, unit in self.motions.items():
            result += unit.T @ functionals.held[node]
        return np.asarray(result)


@dataclass(frozen=True, eq=False)
class Skeleton:
    """All joints of a scene.

    Attributes
    ----------
    rods : those with joined ends, by name
    factor : L of the stiffness S = L L^T of the joints' motions, shape (n_motions, n_motions)
    """

    rods: Mapping[str, JoinedRod]
    factor: Array

    def half_solve(self, on_joints: Array) -> Array:
        """L^-1 of functionals on the joints, whose inner products are compliances, shape (n_motions, m)."""
        return lower_solve(self.factor, on_joints)

    def motion(self, half: Array) -> Array:
        """Motions of the joints under a half-solved load, shape (n_motions,)."""
        return transposed_solve(self.factor, half[:, None])[:, 0]


def skeleton(scene: Scene, mirrors: Mapping[str, Mirrors], rods: Mapping[str, AssembledRod]) -> Skeleton | None:
    """The scene's joints with their stiffness factorised; None without joints.

    Raises
    ------
    numpy.linalg.LinAlgError
        if joined rods are not held.
    """
    if not scene.joints:
        return None
    unit = symmetric_motions(scene, mirrors)
    joined = {}
    for name, assembled in rods.items():
        motions = {}
        for number, joint in enumerate(scene.joints):
            for end in joint.ends:
                if end.rod != name:
                    continue
                node = 0 if end.end == "start" else len(assembled.elements)
                own = np.zeros((len(assembled.holds[node].given), len(scene.joints), len(unit)))
                own[:, number] = assembled.holds[node].motions.T @ unit.T
                motions[node] = own.reshape(len(own), -1)
        if motions:
            count = len(scene.joints) * len(unit)
            response = functionals(assembled, held_parts(assembled, motions), count)
            joined[name] = JoinedRod(assembled, motions, response)
    stiffness = sum(rod.on_joints(rod.response) for rod in joined.values())
    return Skeleton(joined, cholesky(np.asarray(stiffness)))


def symmetric_motions(scene: Scene, mirrors: Mapping[str, Mirrors]) -> Array:
    """Rigid motions that the scene's mirror planes leave, rows of displacement and rotation, shape (n, 6)."""
    axes = frame(scene.rods[0].centre_line)
    mirror_x, mirror_y = mirrors[scene.rods[0].name]
    # A mirror image turns displacement across the plane and rotation about lines in the plane round.
    displaced = [axis for axis, gone in zip(axes, (mirror_x, mirror_y, False), strict=True) if not gone]
    turned = [axis for axis, gone in zip(axes, (mirror_y, mirror_x, mirror_x or mirror_y), strict=True) if not gone]
    nothing = np.zeros(3)
    return np.array(
        [np.concatenate([axis, nothing]) for axis in displaced] + [np.concatenate([nothing, axis]) for axis in turned]
    )
