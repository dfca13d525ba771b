"""Rigid joints between rods, and loose rods: rigid motions are what is left of the rods, and all else is condensed.

A joined end is held in its rod's chain like a clamp that the joint moves. The reactions of all rods on unit motions of
the joints are the stiffness of the skeleton; the functionals on the rods, condensed onto the joints, add their inner
products in its inverse to the compliance.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from rodmodel.assembly import AssembledRod, Functionals, Mirrors, functionals, held_parts
from rodmodel.centre_line import frame
from rodmodel.holds import FreeMotions, Held, joint_point
from rodmodel.triangular import cholesky, lower_solve, transposed_solve

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Loose:
    """Rods, joined or one alone, that supports, joints and beds leave free to move as a rigid body.

    Attributes
    ----------
    rods : their names
    free : the motions that are free
    stay : section of a rod alone that is held to follow these motions, so that the rest of the rod can be solved
    """

    rods: tuple[str, ...]
    free: FreeMotions
    stay: Held | None


@dataclass(frozen=True, eq=False)
class JoinedRod:
    """What a rod with joined ends, or a loose one, adds to the skeleton.

    Attributes
    ----------
    motions : of its joined or staying nodes under the skeleton's unit motions, by node, shape (n_fields, n_motions)
        each
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
    """All joints of a scene, and what moves its loose rods.

    Attributes
    ----------
    rods : those with joined ends or none that holds them, by name
    elastic : orthonormal motions that strain the rods, columns, shape (n_motions, n_elastic)
    factor : L of their stiffness L L^T, shape (n_elastic, n_elastic)
    free : motions that do not, shape (n_motions, n_free)
    """

    rods: Mapping[str, JoinedRod]
    elastic: Array
    factor: Array
    free: Array

    def half_solve(self, on_joints: Array) -> Array:
        """L^-1 of functionals on the motions, whose inner products are compliances, shape (n_elastic, m)."""
        return lower_solve(self.factor, self.elastic.T @ on_joints)

    def motion(self, half: Array, free: Array) -> Array:
        """Motions under half-solved loads (n_elastic, m), with free motions (n_free, m), shape (n_motions, m)."""
        return np.asarray(self.elastic @ transposed_solve(self.factor, half) + self.free @ free)


def skeleton(
    scene: Scene, mirrors: Mapping[str, Mirrors], rods: Mapping[str, AssembledRod], loose: Sequence[Loose] = ()
) -> Skeleton | None:
    """The scene's joints and loose rods with their stiffness factorised; None where there are neither.

    Raises
    ------
    numpy.linalg.LinAlgError
        if joined rods are not held and not said to be loose.
    """
    stays = [each for each in loose if each.stay is not None]
    if not scene.joints and not stays:
        return None
    unit = symmetric_motions(scene, mirrors)
    stay_counts = [len(each.free.motions) for each in stays]
    first_of_stay = len(scene.joints) * len(unit) + np.cumsum([0, *stay_counts])
    count = int(first_of_stay[-1])
    joined = {}
    for name, assembled in rods.items():
        motions = {}
        for node, motion, first in _moved_nodes(scene, name, assembled, unit, stays, first_of_stay):
            motions[node] = np.zeros((motion.shape[1], count))
            motions[node][:, first : first + len(motion)] = motion.T
        if motions:
            response = functionals(assembled, held_parts(assembled, motions), count)
            joined[name] = JoinedRod(assembled, motions, response)
    stiffness = np.asarray(sum(rod.on_joints(rod.response) for rod in joined.values()))
    free = [np.eye(count)[:, a:b] for a, b in pairwise(first_of_stay.tolist())]
    free += [_free_of_joints(scene, unit, each, count) for each in loose if each.stay is None]
    unstrained = np.concatenate([np.empty((count, 0)), *free], axis=1)
    basis = np.linalg.qr(unstrained, mode="complete").Q
    elastic = basis[:, unstrained.shape[1] :]
    factor = cholesky(elastic.T @ stiffness @ elastic) if elastic.shape[1] else np.empty((0, 0))
    return Skeleton(joined, elastic, factor, unstrained)


def _moved_nodes(
    scene: Scene,
    name: str,
    assembled: AssembledRod,
    unit: Array,
    stays: Sequence[Loose],
    first_of_stay: IntArray,
) -> Iterator[tuple[int, Array, int]]:
    """Nodes of a rod that joints or free motions move, their unit motions (n, n_fields), and the first one's number."""
    for number, joint in enumerate(scene.joints):
        for end in joint.ends:
            if end.rod == name:
                node = 0 if end.end == "start" else len(assembled.elements)
                yield node, unit @ assembled.holds[node].motions, number * len(unit)
    for number, each in enumerate(stays):
        if each.stay is not None and each.rods == (name,):
            node = int(np.abs(assembled.borders - each.stay.station).argmin())
            yield node, assembled.holds[node].motions, int(first_of_stay[number])


def _free_of_joints(scene: Scene, unit: Array, loose: Loose, count: int) -> Array:
    """Free motions of joined rods as motions of their joints, shape (n_motions, n_free)."""
    result = np.zeros((count, len(loose.free.motions)))
    for number, joint in enumerate(scene.joints):
        if joint.ends[0].rod in loose.rods:
            rows = slice(number * len(unit), (number + 1) * len(unit))
            result[rows] = (loose.free.at(joint_point(scene, joint)) @ unit.T).T
    return result


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
