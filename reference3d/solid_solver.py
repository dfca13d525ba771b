"""Solve a scene of rods of any kind, supported, joined, loaded and in contact in any way, as 3D solids.

Each rod is factorised with the ends that joints hold at rest; unit motions of the joints then give the stiffness of
the skeleton, whose motion completes the answer. Contact is solved in compliance form as in `solver`: the gaps under
contact forces of one are those with the joints at rest and what the joints' motion under them adds.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import vstack
from scipy.spatial import cKDTree

from cases.scene import Scene, SceneError
from reference3d.contact import solve_complementarity, without_penetration
from reference3d.holds import Hold, holds, require_held, structures
from reference3d.plane_chain import HeldPlane, PlaneChain, compliance, factor_bytes, factorise, solve
from reference3d.section_mesh import section_extents
from reference3d.solid_body import SolidBody, nodal_loads, solid_body
from reference3d.solid_contact import SolidContact, solid_contact
from reference3d.solid_solution import SolidPair, SolidRod, SolidSolution
from reference3d.solution import Cost

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# nodal force out of balance that a solution may leave, of the rod's largest internal nodal force; where that is all but
# zero, as in a rod that moves as a rigid one, of this share of the largest stiffness times the largest displacement
RESIDUAL_TOLERANCE = 1e-7
STIFFNESS_SHARE = 1e-6
# share of the machine's memory that a factor may take
MEMORY_SHARE = 0.8
# difference of matrices, over their largest entry, that is round-off
SAME_MATRIX = 1e-12
# contact is looked for where the coarse mesh found it and this many sides of the smaller section around
MARGIN = 0.5
# difference between the gap that a contact force implies and that of the faces, of the largest displacement
GAP_TOLERANCE = 1e-6
# energy in the contact springs, as a part of the strain energy, above which the penalty falsifies the answer
PENALTY_SHARE = 1e-3


@dataclass(frozen=True, eq=False)
class _Responses:
    """Answers of one rod to its loads with the joints at rest, and to unit motions of its joined ends.

    Attributes
    ----------
    load : nodal loads, array of unknowns
    columns : displacements, the first under loads and what supports prescribe, then 6 for every joined end, shape
        (n_planes, n_nodes, 3, 1 + 6 n_joined)
    joined : holds of the joined ends, in the order of the columns
    chain : factorised, where the rod takes part in contact
    """

    load: Array
    columns: Array
    joined: tuple[Hold, ...]
    chain: PlaneChain | None


def solve_solid(scene: Scene, refinement: int, located: SolidSolution | None = None) -> SolidSolution:
    """Solve a scene.

    Parameters
    ----------
    refinement : k of `section_mesh` and `layers`
    located : solution of the same scene on a coarser mesh, if there is one, which shows where contact is; solved here
        on the coarsest mesh if there is none

    Raises
    ------
    SceneError
        if a rod is not held, the machine's memory is too small, or nothing lies opposite a face that may touch.
    """
    begin = time.perf_counter()
    solutions, steps = 0, 0
    if located is None and refinement > 1 and scene.contacts:
        located = solve_solid(scene, 1)
        solutions, steps = located.contact_solutions, located.active_sets
    bodies = {rod.name: solid_body(scene, rod, refinement) for rod in scene.rods}
    held = {name: holds(scene, body) for name, body in bodies.items()}
    require_held(scene, bodies, held, structures(scene))
    planes = {name: {2 * border: hold.plane for border, hold in own.items()} for name, own in held.items()}
    touching = {face.rod for pair in scene.contacts for face in pair.faces}
    kept = 0.0
    for name, body in bodies.items():
        need = _require_memory(body, planes[name], kept)
        kept += need if name in touching else 0.0
    contacts = [solid_contact(scene, pair, bodies) for pair in scene.contacts]
    ready = time.perf_counter()
    responses: dict[str, _Responses] = {}
    factors: list[tuple[SolidBody, Mapping[int, HeldPlane], PlaneChain]] = []
    for name, body in bodies.items():
        alike = (chain for other, at, chain in factors if _alike(body, other, planes[name], at))
        chain = next(alike, None) or factorise(body.layer_matrix, body.kind, planes[name])
        responses[name] = _respond(scene, body, held[name], chain, name in touching)
        if name in touching:
            factors.append((body, planes[name], chain))
    skeleton = _skeleton(scene, bodies, responses)
    candidates = [_candidates(scene, contact, located) for contact in contacts]
    while True:
        found = _contact_forces(responses, skeleton, contacts, candidates)
        solutions, steps = solutions + 1, steps + found.steps
        fields = _fields(responses, skeleton, contacts, found.forces)
        gaps = [_gap(contact, fields) for contact in contacts]
        missed = [~chosen & (gap < 0.0) for chosen, gap in zip(candidates, gaps, strict=True)]
        if not any(miss.any() for miss in missed):
            break
        candidates = [np.ones_like(chosen) for chosen in candidates]
    rods: dict[str, SolidRod] = {}
    reactions: dict[tuple[str, int], Array] = {}
    energy, residual, moved, volume, elements, unknowns = 0.0, 0.0, 0.0, 0.0, 0, 6 * len(scene.joints)
    for name, body in bodies.items():
        displaced = fields[name]
        solid, beds = body.internal_forces(displaced)
        out_of_balance = solid + beds - responses[name].load - _on_nodes(name, body.shape, contacts, found.forces)
        stiffest = max(float(layer.stiffness.max()) for layer in body.layers)
        largest = max(float(np.abs(solid).max()), STIFFNESS_SHARE * stiffest * float(np.abs(displaced).max()))
        free = out_of_balance.copy()
        for hold in held[name].values():
            plane = free[2 * hold.border].reshape(-1, 1)
            free[2 * hold.border] = hold.plane.out_of(hold.plane.into(plane)).reshape(-1, 3)
            reactions[name, hold.border] = _resultant(body, hold.border, out_of_balance[2 * hold.border])
        if largest > 0.0:
            residual = max(residual, float(np.abs(free).max()) / largest)
        moved = max(moved, float(np.abs(displaced).max()))
        energy += 0.5 * float(np.vdot(displaced, solid))
        volume += float(sum((body.kind == kind).sum() * layer.volume.sum() for kind, layer in enumerate(body.layers)))
        elements += len(body.kind) * len(body.section.quads)
        unknowns += displaced.size - sum(int(hold.plane.fixed.sum()) for hold in held[name].values())
        rods[name] = SolidRod(body, displaced)
    pairs, mismatch, penetrating = {}, 0.0, 0.0
    for contact, force, way, gap in zip(contacts, found.forces, found.given_way, gaps, strict=True):
        # in contact the gap follows from the springs, free of the cancellation in the difference of displacements
        pairs[contact.pair.name] = SolidPair(contact, np.where(force > 0.0, -way, np.maximum(gap, 0.0)), force)
        mismatch = max(mismatch, float(np.abs(gap + way)[force > 0.0].max(initial=0.0)))
        penetrating += 0.5 * float(force @ np.abs(way)) if contact.rigid else 0.0
    outcome = found.outcome
    if outcome == "converged" and not residual <= RESIDUAL_TOLERANCE:
        outcome = f"refused: forces are out of balance by {residual:.1e} of the largest"
    if outcome == "converged" and mismatch > GAP_TOLERANCE * moved:
        outcome = f"refused: contact forces and displacements disagree by {mismatch:.1e} mm"
    if outcome == "converged" and penetrating > PENALTY_SHARE * max(energy, 0.0):
        outcome = f"refused: the penalty is too soft, penetration holds {penetrating / energy:.2g} of the strain energy"
    return SolidSolution(
        scene=scene,
        outcome=outcome,
        contact_solutions=solutions,
        active_sets=steps,
        strain_energy=energy,
        cost=Cost(unknowns, ready - begin, time.perf_counter() - ready),
        residual=residual,
        representative_size=(volume / elements) ** (1.0 / 3.0),
        refinement=refinement,
        rods=rods,
        reactions=reactions,
        pairs=pairs,
    )


def _candidates(scene: Scene, contact: SolidContact, located: SolidSolution | None) -> BoolArray:
    """Contact nodes that may touch, shape (n,): near those that do on the coarse mesh."""
    if located is None:
        return np.ones(len(contact.place), dtype=bool)
    coarse = located.pairs[contact.pair.name]
    touched = coarse.contact.position[coarse.force > 0.0]
    if len(touched) == 0:
        return np.zeros(len(contact.place), dtype=bool)
    margin = MARGIN * min(min(section_extents(scene.rod(face.rod).section)) for face in contact.pair.faces)
    return np.asarray(cKDTree(touched).query(contact.position)[0] <= margin)


def _require_memory(body: SolidBody, held: Mapping[int, HeldPlane], kept: float) -> float:
    """Memory that a body's factor takes; SceneError with the numbers if there is too little beside what is kept."""
    need = factor_bytes(3 * len(body.section.nodes), body.kind, held)
    present = physical_memory() - kept
    if need > MEMORY_SHARE * present:
        found = f"{np.prod(body.shape)} unknowns that take {need / 1e9:.0f} GB where there are {present / 1e9:.0f}"
        remedy = "the 3D reference needs a machine with more memory; use --model rod"
        raise SceneError(f"rods.{body.rod.name}", found, remedy)
    return need


def physical_memory() -> float:
    """Memory of this machine, bytes; endless where it does not tell."""
    if not hasattr(os, "sysconf"):
        return math.inf
    return float(os.sysconf("SC_PHYS_PAGES")) * float(os.sysconf("SC_PAGE_SIZE"))


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


def _respond(scene: Scene, body: SolidBody, held: Mapping[int, Hold], chain: PlaneChain, touching: bool) -> _Responses:
    joined = tuple(hold for hold in held.values() if hold.joint is not None)
    planes, nodes, _ = body.shape
    load = nodal_loads(body, scene.loads)
    prescribed = np.zeros((planes, 3 * nodes, 1 + 6 * len(joined)))
    for hold in held.values():
        prescribed[2 * hold.border, :, 0] = hold.given
    for number, hold in enumerate(joined):
        prescribed[2 * hold.border, :, 1 + 6 * number : 7 + 6 * number] = hold.motions
    force = np.zeros_like(prescribed)
    force[..., 0] = load.reshape(planes, -1)
    for column in np.flatnonzero(prescribed.any(axis=(0, 1))).tolist():
        solid, beds = body.internal_forces(prescribed[..., column].reshape(body.shape))
        force[..., column] -= (solid + beds).reshape(planes, -1)
    columns = prescribed + solve(chain, force)
    return _Responses(load, columns.reshape(*body.shape, -1), joined, chain if touching else None)


@dataclass(frozen=True, eq=False)
class _Skeleton:
    """Stiffness of the joints' motions and the forces on them under loads, shapes (6 n_joints, 6 n_joints), (.,)."""

    stiffness: Array
    force: Array

    def motion(self, force: Array) -> Array:
        """Motions of the joints under forces on them, the first axis."""
        return np.asarray(np.linalg.solve(self.stiffness, force)) if len(force) else force


def _skeleton(scene: Scene, bodies: Mapping[str, SolidBody], responses: Mapping[str, _Responses]) -> _Skeleton:
    size = 6 * len(scene.joints)
    stiffness, force = np.zeros((size, size)), np.zeros(size)
    for name, found in responses.items():
        place = _joint_places(found)
        if len(place) == 0:
            continue
        body = bodies[name]
        # reactions of the joined ends on every column, as forces on the joints
        on_joints = np.zeros((6 * len(found.joined), found.columns.shape[-1]))
        for column in range(found.columns.shape[-1]):
            solid, beds = body.internal_forces(found.columns[..., column])
            nodal = solid + beds - (found.load if column == 0 else 0.0)
            for number, hold in enumerate(found.joined):
                on_joints[6 * number : 6 * number + 6, column] = hold.motions.T @ nodal[2 * hold.border].ravel()
        np.add.at(force, place, -on_joints[:, 0])
        np.add.at(stiffness, (place[:, None], place), on_joints[:, 1:])
    return _Skeleton(stiffness, force)


def _joint_places(found: _Responses) -> IntArray:
    """Numbers of the motions of joints that the columns after the first answer, shape (6 n_joined,)."""
    joints = np.array([hold.joint for hold in found.joined if hold.joint is not None], dtype=np.int64)
    return np.asarray((6 * joints[:, None] + np.arange(6)).ravel())


@dataclass(frozen=True)
class _Contact:
    """Contact forces, N, and how far springs give way, mm, of every pair; outcome, and the active sets tried."""

    forces: list[Array]
    given_way: list[Array]
    outcome: str
    steps: int


def _contact_forces(
    responses: Mapping[str, _Responses], skeleton: _Skeleton, contacts: list[SolidContact], candidates: list[BoolArray]
) -> _Contact:
    counts = [int(chosen.sum()) for chosen in candidates]
    starts = np.concatenate([[0], np.cumsum(counts)])
    total = int(starts[-1])
    forces = [np.zeros(len(contact.place)) for contact in contacts]
    given_way = [np.zeros(len(contact.place)) for contact in contacts]
    if total == 0:
        return _Contact(forces, given_way, "converged", 0)
    soft = np.concatenate([contact.soft[chosen] for contact, chosen in zip(contacts, candidates, strict=True)])
    offset = np.concatenate([contact.gap[chosen] for contact, chosen in zip(contacts, candidates, strict=True)])
    rigid = np.repeat([contact.rigid for contact in contacts], counts)
    matrix = np.diag(soft)
    by_joints = np.zeros((total, len(skeleton.force)))  # gaps under unit motions of the joints
    for name, found in responses.items():
        if found.chain is None:
            continue
        mine = [index for index, contact in enumerate(contacts) if name in contact.rows]
        place = np.concatenate([np.arange(starts[index], starts[index + 1]) for index in mine])
        rows = vstack([contacts[index].rows[name][candidates[index]] for index in mine], format="csr")
        matrix[np.ix_(place, place)] += compliance(found.chain, rows)
        moved = rows @ found.columns.reshape(rows.shape[1], -1)
        offset[place] += moved[:, 0]
        by_joints[np.ix_(place, _joint_places(found))] += moved[:, 1:]
    # a contact force acts on the joints as the gap yields to their motion
    offset += by_joints @ skeleton.motion(skeleton.force)
    matrix += by_joints @ skeleton.motion(by_joints.T)
    sprung = solve_complementarity(matrix, offset, offset < 0.0)
    answer = without_penetration(matrix, offset, soft, rigid, sprung)
    for index, chosen in enumerate(candidates):
        forces[index][chosen] = answer.force[starts[index] : starts[index + 1]]
        given_way[index][chosen] = answer.given_way[starts[index] : starts[index + 1]]
    return _Contact(forces, given_way, answer.outcome, answer.steps)


def _fields(
    responses: Mapping[str, _Responses], skeleton: _Skeleton, contacts: list[SolidContact], forces: list[Array]
) -> dict[str, Array]:
    """Displacement of every rod under all loads and contact forces, arrays of unknowns."""
    fields, on_joints = {}, skeleton.force.copy()
    for name, found in responses.items():
        shape = found.load.shape
        fields[name] = found.columns[..., 0]
        if found.chain is not None:
            force = _on_nodes(name, shape, contacts, forces)
            fields[name] = fields[name] + solve(found.chain, force.reshape(shape[0], -1, 1)).reshape(shape)
            np.add.at(on_joints, _joint_places(found), np.tensordot(force, found.columns[..., 1:], axes=3))
    motion = skeleton.motion(on_joints)
    return {
        name: field + responses[name].columns[..., 1:] @ motion[_joint_places(responses[name])]
        for name, field in fields.items()
    }


def _on_nodes(name: str, shape: tuple[int, ...], contacts: list[SolidContact], forces: list[Array]) -> Array:
    """Contact forces on the nodes of a rod, an array of unknowns of a shape."""
    nodal = np.zeros(shape)
    for contact, force in zip(contacts, forces, strict=True):
        if name in contact.rows:
            nodal += (contact.rows[name].T @ force).reshape(shape)
    return nodal


def _gap(contact: SolidContact, fields: Mapping[str, Array]) -> Array:
    """Distance of the faces after deformation at the contact nodes, mm, shape (n,)."""
    gap = contact.gap.copy()
    for name, rows in contact.rows.items():
        gap += rows @ fields[name].ravel()
    return gap


def _resultant(body: SolidBody, border: int, nodal: Array) -> Array:
    """Force and moment about the section's centre of nodal forces of a plane, global, shape (6,)."""
    arm = np.column_stack([body.section.nodes, np.zeros(len(body.section.nodes))])
    local = np.stack([nodal.sum(axis=0), np.cross(arm, nodal).sum(axis=0)])
    return np.asarray((local @ body.axes[2 * border]).ravel())
