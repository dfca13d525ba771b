"""Solve a scene of rods of any kind, supported, joined and loaded in any way but by contact, as 3D solids.

Each rod is factorised with the ends that joints hold at rest; unit motions of the joints then give the stiffness of
the skeleton, whose motion completes the answer.
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene, SceneError
from reference3d.holds import Hold, holds, require_held, structures
from reference3d.plane_chain import HeldPlane, factor_bytes, factorise, solve
from reference3d.solid_body import SolidBody, nodal_loads, solid_body
from reference3d.solid_solution import SolidRod, SolidSolution
from reference3d.solution import Cost

Array = NDArray[np.float64]

# nodal force out of balance that a solution may leave, of the rod's largest internal nodal force; where that is all but
# zero, as in a rod that moves as a rigid one, of this share of the largest stiffness times the largest displacement
RESIDUAL_TOLERANCE = 1e-7
STIFFNESS_SHARE = 1e-6
# share of the machine's memory that a factor may take
MEMORY_SHARE = 0.8


@dataclass(frozen=True, eq=False)
class _Responses:
    """Answers of one rod to its loads with the joints at rest, and to unit motions of its joined ends.

    Attributes
    ----------
    load : nodal loads, array of unknowns
    columns : displacements, the first under loads and what supports prescribe, then 6 for every joined end, shape
        (n_planes, n_nodes, 3, 1 + 6 n_joined)
    joined : holds of the joined ends, in the order of the columns
    """

    load: Array
    columns: Array
    joined: tuple[Hold, ...]


def solve_solid(scene: Scene, refinement: int) -> SolidSolution:
    """Solve a scene without contact.

    refinement : k of `section_mesh` and `layers`

    Raises
    ------
    SceneError
        if a rod is not held, or the machine's memory is too small.
    """
    begin = time.perf_counter()
    bodies = {rod.name: solid_body(scene, rod, refinement) for rod in scene.rods}
    held = {name: holds(scene, body) for name, body in bodies.items()}
    require_held(scene, bodies, held, structures(scene))
    planes = {name: {2 * border: hold.plane for border, hold in own.items()} for name, own in held.items()}
    for name, body in bodies.items():
        _require_memory(body, planes[name])
    ready = time.perf_counter()
    responses = {name: _respond(scene, body, held[name], planes[name]) for name, body in bodies.items()}
    motion = _joint_motions(scene, bodies, responses)
    rods: dict[str, SolidRod] = {}
    reactions: dict[tuple[str, int], Array] = {}
    energy, residual, volume, elements, unknowns = 0.0, 0.0, 0.0, 0, 6 * len(scene.joints)
    for name, body in bodies.items():
        found = responses[name]
        share = np.concatenate([[1.0], *(motion[hold.joint] for hold in found.joined if hold.joint is not None)])
        displaced = found.columns @ share
        solid, beds = body.internal_forces(displaced)
        out_of_balance = solid + beds - found.load
        stiffest = max(float(layer.stiffness.max()) for layer in body.layers)
        largest = max(float(np.abs(solid).max()), STIFFNESS_SHARE * stiffest * float(np.abs(displaced).max()))
        free = out_of_balance.copy()
        for hold in held[name].values():
            plane = free[2 * hold.border].reshape(-1, 1)
            free[2 * hold.border] = hold.plane.out_of(hold.plane.into(plane)).reshape(-1, 3)
            reactions[name, hold.border] = _resultant(body, hold.border, out_of_balance[2 * hold.border])
        if largest > 0.0:
            residual = max(residual, float(np.abs(free).max()) / largest)
        energy += 0.5 * float(np.vdot(displaced, solid))
        volume += float(sum((body.kind == kind).sum() * layer.volume.sum() for kind, layer in enumerate(body.layers)))
        elements += len(body.kind) * len(body.section.quads)
        unknowns += displaced.size - sum(int(hold.plane.fixed.sum()) for hold in held[name].values())
        rods[name] = SolidRod(body, displaced)
    outcome = "converged"
    if not residual <= RESIDUAL_TOLERANCE:
        outcome = f"refused: forces are out of balance by {residual:.1e} of the largest"
    return SolidSolution(
        scene=scene,
        outcome=outcome,
        contact_solutions=0,
        strain_energy=energy,
        cost=Cost(unknowns, ready - begin, time.perf_counter() - ready),
        residual=residual,
        representative_size=(volume / elements) ** (1.0 / 3.0),
        refinement=refinement,
        rods=rods,
        reactions=reactions,
    )


def _require_memory(body: SolidBody, held: Mapping[int, HeldPlane]) -> None:
    """Refuse a body whose factor would not fit into this machine's memory; SceneError with the numbers."""
    need = factor_bytes(3 * len(body.section.nodes), body.kind, held)
    present = physical_memory()
    if need > MEMORY_SHARE * present:
        found = f"{np.prod(body.shape)} unknowns that take {need / 1e9:.0f} GB where there are {present / 1e9:.0f}"
        remedy = "the 3D reference needs a machine with more memory; use --model rod"
        raise SceneError(f"rods.{body.rod.name}", found, remedy)


def physical_memory() -> float:
    """Memory of this machine, bytes; endless where it does not tell."""
    if not hasattr(os, "sysconf"):
        return math.inf
    return float(os.sysconf("SC_PHYS_PAGES")) * float(os.sysconf("SC_PAGE_SIZE"))


def _respond(
    scene: Scene, body: SolidBody, held: Mapping[int, Hold], held_planes: Mapping[int, HeldPlane]
) -> _Responses:
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
    chain = factorise(body.layer_matrix, body.kind, held_planes)
    columns = prescribed + solve(chain, force)
    return _Responses(load, columns.reshape(*body.shape, -1), joined)


def _joint_motions(scene: Scene, bodies: Mapping[str, SolidBody], responses: Mapping[str, _Responses]) -> Array:
    """Displacement and rotation of every joint, global, shape (n_joints, 6)."""
    size = 6 * len(scene.joints)
    stiffness, force = np.zeros((size, size)), np.zeros(size)
    for name, found in responses.items():
        unknown = [6 * hold.joint + np.arange(6) for hold in found.joined if hold.joint is not None]
        if not unknown:
            continue
        body = bodies[name]
        # reactions of the joined ends on every column, as forces on the joints
        on_joints = np.zeros((6 * len(found.joined), found.columns.shape[-1]))
        for column in range(found.columns.shape[-1]):
            solid, beds = body.internal_forces(found.columns[..., column])
            nodal = solid + beds - (found.load if column == 0 else 0.0)
            for number, hold in enumerate(found.joined):
                on_joints[6 * number : 6 * number + 6, column] = hold.motions.T @ nodal[2 * hold.border].ravel()
        place = np.concatenate(unknown)
        np.add.at(force, place, -on_joints[:, 0])
        np.add.at(stiffness, (place[:, None], place), on_joints[:, 1:])
    return np.asarray(np.linalg.solve(stiffness, force).reshape(-1, 6) if size else np.zeros((0, 6)))


def _resultant(body: SolidBody, border: int, nodal: Array) -> Array:
    """Force and moment about the section's centre of nodal forces of a plane, global, shape (6,)."""
    arm = np.column_stack([body.section.nodes, np.zeros(len(body.section.nodes))])
    local = np.stack([nodal.sum(axis=0), np.cross(arm, nodal).sum(axis=0)])
    return np.asarray((local @ body.axes[2 * border]).ravel())
