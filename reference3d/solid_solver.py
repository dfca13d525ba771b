"""Solve a scene of rods of any kind, supported, joined, loaded and in contact in any way, as 3D solids.

Each rod is factorised once (`solid_responses`), then contact is solved in compliance form (`solid_forces`). Where a
scene is its own image in a plane, half of the motions are solved for (`solid_mirror`); where a factor would not fit
into memory, conjugate gradients take its place (`solid_iterative`).
"""

from __future__ import annotations

import math
import os
import time
from collections.abc import Mapping

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import cKDTree

from cases.scene import Scene, SceneError
from reference3d.holds import Hold, Loose, holds, loose_rods, stay
from reference3d.plane_chain import HeldPlane, factor_bytes
from reference3d.section_mesh import section_extents
from reference3d.solid_body import SolidBody, solid_body
from reference3d.solid_contact import SolidContact, solid_contact
from reference3d.solid_forces import ContactForces, contact_forces, fields
from reference3d.solid_iterative import Grid, IterativeFactor, interpolation, iterative_bytes
from reference3d.solid_mirror import Mirror, contact_partners, mirror_in, scene_mirrors
from reference3d.solid_responses import (
    Factor,
    Inverse,
    Response,
    held_planes,
    on_nodes,
    respond,
    share_factor,
    skeleton,
)
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
# contact is looked for where the coarse mesh found it and this many sides of the smaller section around
MARGIN = 0.5
# difference between the gap that a contact force implies and that of the faces, of the largest displacement
GAP_TOLERANCE = 1e-6
# energy in the contact springs, as a part of the strain energy, above which the penalty falsifies the answer
PENALTY_SHARE = 1e-3


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
    contacts = [solid_contact(scene, pair, bodies) for pair in scene.contacts]
    mirrors = scene_mirrors(scene, bodies, held, contacts)
    partners = [_partners(contact, bodies, mirrors) for contact in contacts]
    possible = next(iter(mirrors.values())).motions() if mirrors else np.eye(6)
    loose = loose_rods(scene, bodies, held, possible)
    stays = {each.rods[0]: stay(bodies[each.rods[0]], held[each.rods[0]], each) for each in loose if each.alone}
    kept_still = {
        name: {**own, **({stays[name].border: stays[name]} if name in stays else {})} for name, own in held.items()
    }
    planes = {name: held_planes(own, mirrors.get(name)) for name, own in kept_still.items()}
    touching = {face.rod for pair in scene.contacts for face in pair.faces}
    coarse: dict[str, SolidBody] = {}
    kept = 0.0
    for name, body in bodies.items():
        need, instead = _memory(scene, body, mirrors.get(name), planes[name], refinement, kept)
        kept += need if name in touching else 0.0
        if instead is not None:
            coarse[name] = instead
    ready = time.perf_counter()
    responses: dict[str, Response] = {}
    factors: list[tuple[SolidBody, Mapping[int, HeldPlane], Factor]] = []
    for name, body in bodies.items():
        inverse: Inverse
        if name in coarse:
            own = [each for each in loose if each.alone and name in each.rods]
            inverse = _iterative(scene, body, kept_still[name], mirrors.get(name), coarse[name], own)
        else:
            inverse = share_factor(body, planes[name], mirrors.get(name), factors)
            if name in touching:
                factors.append((body, planes[name], inverse))
        responses[name] = respond(scene, body, kept_still[name], inverse, name in touching, loose)
    moving = skeleton(scene, responses, loose)
    candidates = [_candidates(scene, contact, located) for contact in contacts]
    candidates = [may | may[partner] for may, partner in zip(candidates, partners, strict=True)]
    while True:
        found = contact_forces(responses, moving, contacts, candidates, partners)
        solutions, steps = solutions + 1, steps + found.steps
        displaced_by = fields(responses, moving, contacts, found)
        gaps = [_gap(contact, displaced_by) for contact in contacts]
        missed = [~chosen & (gap < 0.0) for chosen, gap in zip(candidates, gaps, strict=True)]
        unbalanced = found.outcome.startswith("refused") and not all(chosen.all() for chosen in candidates)
        if not unbalanced and not any(miss.any() for miss in missed):
            break
        candidates = [np.ones_like(chosen) for chosen in candidates]
    rods: dict[str, SolidRod] = {}
    reactions: dict[tuple[str, int], Array] = {}
    energy, residual, moved, volume, elements, unknowns = 0.0, 0.0, 0.0, 0.0, 0, 6 * len(scene.joints)
    for name, body in bodies.items():
        displaced = displaced_by[name]
        solid, beds = body.internal_forces(displaced)
        out_of_balance = solid + beds - responses[name].load - _pressed(name, body, contacts, found)
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
        mirror = mirrors.get(name)
        unknowns += body.shape[0] * _plane_size(body, mirror)
        unknowns -= sum(int(plane.fixed.sum()) for plane in held_planes(held[name], mirror).values())
        rods[name] = SolidRod(body, displaced)
    pairs, mismatch, penetrating = {}, 0.0, 0.0
    for contact, force, way, gap in zip(contacts, found.forces, found.given_way, gaps, strict=True):
        # in contact the gap follows from the springs, free of the cancellation in the difference of displacements
        pairs[contact.pair.name] = SolidPair(contact, np.where(force > 0.0, -way, np.maximum(gap, 0.0)), force)
        mismatch = max(mismatch, float(np.abs(gap + way)[force > 0.0].max(initial=0.0)))
        penetrating += 0.5 * float(force @ np.abs(way)) if contact.rigid else 0.0
    outcome = found.outcome
    if outcome == "refused: unbalanced":
        names = ", ".join(f"'{name}'" for each in loose for name in each.rods)
        outcome = f"refused: contact cannot balance the loads on {names}, which nothing else holds"
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
        solver="conjugate gradients" if coarse else "direct",
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


def _partners(contact: SolidContact, bodies: Mapping[str, SolidBody], mirrors: Mapping[str, Mirror]) -> IntArray:
    """Image of every contact node, shape (n,); the node itself where nothing is mirrored."""
    found = contact_partners(contact, bodies, mirrors) if mirrors else None
    return np.arange(len(contact.place)) if found is None else found


def _memory(
    scene: Scene,
    body: SolidBody,
    mirror: Mirror | None,
    held: Mapping[int, HeldPlane],
    refinement: int,
    kept: float,
) -> tuple[float, SolidBody | None]:
    """Memory that solving for a body takes, and the coarser mesh with which it is iterated where a factor is too large.

    kept : memory in use by other bodies

    Raises
    ------
    SceneError
        with the numbers, if there is too little memory for either.
    """
    present = physical_memory() - kept
    need = factor_bytes(_plane_size(body, mirror), body.kind, held)
    if need <= MEMORY_SHARE * present:
        return need, None
    for coarser in range((refinement + 1) // 2, 0 if refinement > 1 else 1, -1):
        other = solid_body(scene, body.rod, coarser)
        iterated = iterative_bytes(int(np.prod(body.shape)))
        iterated += factor_bytes(_plane_size(other, _same(other, mirror)), other.kind, {})
        if iterated <= MEMORY_SHARE * present:
            return iterated, other
    unknowns = body.shape[0] * _plane_size(body, mirror)
    found = f"{unknowns} unknowns that take {need / 1e9:.0f} GB where there are {present / 1e9:.0f}"
    remedy = "the 3D reference needs a machine with more memory; use --model rod"
    raise SceneError(f"rods.{body.rod.name}", found, remedy)


def _plane_size(body: SolidBody, mirror: Mirror | None) -> int:
    """Unknowns of a plane that are solved for."""
    return 3 * len(body.section.nodes) if mirror is None else int(mirror.symmetric.shape[1])


def _same(body: SolidBody, mirror: Mirror | None) -> Mirror | None:
    """The mirror in the same plane on another mesh of the rod."""
    return None if mirror is None else mirror_in(body, mirror.normal, mirror.point)


def _iterative(
    scene: Scene,
    body: SolidBody,
    held: Mapping[int, Hold],
    mirror: Mirror | None,
    coarse: SolidBody,
    loose: list[Loose],
) -> IterativeFactor:
    """What iterates for a rod with its factor on a coarser mesh.

    loose : the rod, if nothing but contact holds it
    """
    on_coarse = holds(scene, coarse)
    for each in loose:
        kept_still = stay(coarse, on_coarse, each)
        on_coarse[kept_still.border] = kept_still
    other = _same(coarse, mirror)
    factor = share_factor(coarse, held_planes(on_coarse, other), other, [])
    planes = {2 * border: hold.plane for border, hold in held.items()}
    return IterativeFactor(Grid(body, planes, mirror), factor, coarse.shape, interpolation(coarse, body))


def physical_memory() -> float:
    """Memory of this machine, bytes; endless where it does not tell."""
    if not hasattr(os, "sysconf"):
        return math.inf
    return float(os.sysconf("SC_PHYS_PAGES")) * float(os.sysconf("SC_PAGE_SIZE"))


def _pressed(name: str, body: SolidBody, contacts: list[SolidContact], found: ContactForces) -> Array:
    """Contact forces on the nodes of a rod, an array of unknowns."""
    mine = [
        (contact.rows[name], force)
        for contact, force in zip(contacts, found.forces, strict=True)
        if name in contact.rows
    ]
    return on_nodes([rows for rows, _ in mine], [force for _, force in mine], body.shape)


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
