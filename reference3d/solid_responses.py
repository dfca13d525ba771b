"""How solid rods answer loads, unit motions of joints and rigid motions, and the skeleton that these motions make.

Every rod is factorised with the ends that joints hold at rest. A rod that nothing but contact holds is held at one
section more, by the mean motions that are free; as what acts on it is in balance in the end, that takes no force, and
its rigid motions take part in the skeleton like those of joints, without stiffness.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from cases.scene import Scene
from reference3d import plane_chain
from reference3d.holds import Hold, Loose, joint_point, rigid_field
from reference3d.plane_chain import HeldPlane, PlaneChain, factorise
from reference3d.solid_body import SolidBody, nodal_loads
from reference3d.solid_mirror import Mirror

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# difference of matrices, over their largest entry, that is round-off
SAME_MATRIX = 1e-12


class Inverse(Protocol):
    """What answers loads on a rod."""

    def solve(self, force: Array) -> Array:
        """Displacements under loads (N), shape (n_planes, m, n)."""
        ...

    def compliance(self, loads: csr_array) -> Array:
        """Work of every load, a row each, on the displacement of every other, N mm, shape (n_loads, n_loads)."""
        ...


@dataclass(frozen=True, eq=False)
class Factor:
    """Factorised stiffness of a rod: of all its motions, or of those that its mirror leaves."""

    chain: PlaneChain
    mirror: Mirror | None

    def solve(self, force: Array) -> Array:
        """Displacements under loads (N), shape (n_planes, m, n)."""
        if self.mirror is None:
            return plane_chain.solve(self.chain, force)
        return self.mirror.out_of(plane_chain.solve(self.chain, self.mirror.into(force)))

    def compliance(self, loads: csr_array) -> Array:
        """`plane_chain.compliance`."""
        return plane_chain.compliance(self.chain, loads if self.mirror is None else self.mirror.rows_into(loads))


def held_planes(held: Mapping[int, Hold], mirror: Mirror | None) -> dict[int, HeldPlane]:
    """What is held of a rod's motions, or of those that its mirror leaves, by number of the plane."""
    planes = {2 * border: hold.plane for border, hold in held.items()}
    return planes if mirror is None else {number: mirror.held(plane) for number, plane in planes.items()}


@dataclass(frozen=True, eq=False)
class Response:
    """Answers of one rod to its loads with joints at rest, and to unit motions of its joined ends or of all of it.

    Attributes
    ----------
    load : nodal loads, array of unknowns
    columns : displacements, the first under loads and what supports prescribe, then one for every motion of the
        skeleton that moves the rod, shape (n_planes, n_nodes, 3, 1 + n_moving)
    places : numbers of these motions, shape (n_moving,)
    on_skeleton : forces that the rod exerts on them with every column, shape (n_moving, 1 + n_moving)
    factor : what gave the columns, where the rod takes part in contact
    """

    load: Array
    columns: Array
    places: IntArray
    on_skeleton: Array
    factor: Inverse | None


@dataclass(frozen=True, eq=False)
class Skeleton:
    """Motions of joints and of loose rods.

    Attributes
    ----------
    elastic : motions that strain rods, columns, shape (n_motions, n_elastic)
    stiffness : of these, shape (n_elastic, n_elastic)
    free : motions that do not, shape (n_motions, n_free)
    force : on the motions under loads, shape (n_motions,)
    """

    elastic: Array
    stiffness: Array
    free: Array
    force: Array

    def motion(self, force: Array) -> Array:
        """Motions that strain rods under forces on all motions, the first axis."""
        if self.elastic.shape[1] == 0:
            return np.zeros_like(force)
        return np.asarray(self.elastic @ np.linalg.solve(self.stiffness, self.elastic.T @ force))


def respond(
    scene: Scene,
    body: SolidBody,
    held: Mapping[int, Hold],
    factor: Inverse,
    touching: bool,
    loose: Sequence[Loose],
) -> Response:
    """Answers of a rod.

    Parameters
    ----------
    held : what supports and joints hold, and what is held of a loose rod alone
    touching : whether it takes part in contact
    loose : of the scene
    """
    joined = [hold for hold in held.values() if hold.joint is not None]
    joints = np.array([hold.joint for hold in joined], dtype=np.int64)
    places = (6 * joints[:, None] + np.arange(6)).ravel()
    planes, nodes, _ = body.shape
    load = nodal_loads(body, scene.loads)
    prescribed = np.zeros((planes, 3 * nodes, 1 + len(places)))
    for hold in held.values():
        prescribed[2 * hold.border, :, 0] = hold.given
    for number, hold in enumerate(joined):
        prescribed[2 * hold.border, :, 1 + 6 * number : 7 + 6 * number] = hold.motions
    force = np.zeros_like(prescribed)
    force[..., 0] = load.reshape(planes, -1)
    for column in np.flatnonzero(prescribed.any(axis=(0, 1))).tolist():
        solid, beds = body.internal_forces(prescribed[..., column].reshape(body.shape))
        force[..., column] -= (solid + beds).reshape(planes, -1)
    columns = (prescribed + factor.solve(force)).reshape(*body.shape, -1)
    on_skeleton = np.zeros((len(places), 1 + len(places)))
    for column in range(1 + len(places) if joined else 0):
        solid, beds = body.internal_forces(columns[..., column])
        nodal = solid + beds - (load if column == 0 else 0.0)
        for number, hold in enumerate(joined):
            on_skeleton[6 * number : 6 * number + 6, column] = -hold.motions.T @ nodal[2 * hold.border].ravel()
    found = Response(load, columns, places, on_skeleton, factor if touching else None)
    first = _first_places(scene, loose)
    mine = [
        (each, start) for each, start in zip(loose, first, strict=True) if each.alone and body.rod.name in each.rods
    ]
    for each, start in mine:
        rigid = rigid_field(body, each.centre) @ each.motions.T
        count = len(each.motions)
        # a rigid motion takes no force, so that loads act on it as they are
        on_rod = np.zeros((count, 1 + count))
        on_rod[:, 0] = np.tensordot(rigid, load, axes=([0, 1, 2], [0, 1, 2]))
        found = replace(
            found,
            columns=np.concatenate([columns, rigid], axis=3),
            places=start + np.arange(count),
            on_skeleton=on_rod,
        )
    return found


def _first_places(scene: Scene, loose: Sequence[Loose]) -> list[int]:
    """Number of the first motion of each that is loose alone, after those of joints."""
    counts = [len(each.motions) if each.alone else 0 for each in loose]
    return [6 * len(scene.joints) + sum(counts[:number]) for number in range(len(loose))]


def skeleton(scene: Scene, responses: Mapping[str, Response], loose: Sequence[Loose]) -> Skeleton:
    """Stiffness and forces of all motions of joints and loose rods."""
    size = 6 * len(scene.joints) + sum(len(each.motions) for each in loose if each.alone)
    stiffness, force = np.zeros((size, size)), np.zeros(size)
    for found in responses.values():
        np.add.at(force, found.places, found.on_skeleton[:, 0])
        np.add.at(stiffness, (found.places[:, None], found.places), -found.on_skeleton[:, 1:])
    free = np.zeros((size, 0))
    for each, start in zip(loose, _first_places(scene, loose), strict=True):
        own = np.zeros((size, len(each.motions)))
        if each.alone:
            own[start : start + len(each.motions)] = np.eye(len(each.motions))
        for number, joint in enumerate(scene.joints):
            if joint.ends[0].rod in each.rods:
                arm = joint_point(scene, number) - each.centre
                moved, turned = each.motions[:, :3], each.motions[:, 3:]
                own[6 * number : 6 * number + 6] = np.hstack([moved + np.cross(turned, arm), turned]).T
        free = np.hstack([free, own])
    elastic = np.linalg.qr(free, mode="complete").Q[:, free.shape[1] :] if free.shape[1] else np.eye(size)
    return Skeleton(elastic, elastic.T @ stiffness @ elastic, free, force)


def on_nodes(rows: Sequence[csr_array], forces: Sequence[Array], shape: tuple[int, ...]) -> Array:
    """Contact forces on the nodes of a rod, an array of unknowns of a shape.

    rows, forces : of the pairs in which it takes part
    """
    nodal = np.zeros(shape)
    for row, force in zip(rows, forces, strict=True):
        nodal += (row.T @ force).reshape(shape)
    return nodal


def share_factor(
    body: SolidBody,
    planes: Mapping[int, HeldPlane],
    mirror: Mirror | None,
    factors: Sequence[tuple[SolidBody, Mapping[int, HeldPlane], Factor]],
) -> Factor:
    """The factor of a rod: one of those that are there already, if the rod is alike, or a new one."""
    for other, held, factor in factors:
        same = (mirror is None) == (factor.mirror is None)
        if mirror is not None and factor.mirror is not None:
            same = mirror.axis == factor.mirror.axis
        if same and _alike(body, other, planes, held):
            return factor
    symmetric = None if mirror is None else mirror.symmetric
    return Factor(factorise(body.assembly(symmetric), body.kind, planes), mirror)


def _alike(
    body: SolidBody, other: SolidBody, held: Mapping[int, HeldPlane], other_held: Mapping[int, HeldPlane]
) -> bool:
    """Whether two rods have the same matrix, so that they can share its factor."""
    if body.shape != other.shape or not np.array_equal(body.kind, other.kind) or any(body.springs + other.springs):
        return False
    if held.keys() != other_held.keys():
        return False
    for plane, at in held.items():
        if at.basis is not None or other_held[plane].basis is not None:
            return False
        if not np.array_equal(at.fixed, other_held[plane].fixed):
            return False
    largest = max(float(layer.stiffness.max()) for layer in body.layers)
    return all(
        np.allclose(one.stiffness, two.stiffness, rtol=0.0, atol=SAME_MATRIX * largest)
        for one, two in zip(body.layers, other.layers, strict=True)
    )
