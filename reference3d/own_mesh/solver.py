"""Solve a scene on a mesh made elsewhere: every rod factorised once, contact on the compliance of its corners."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array
from scipy.sparse.linalg import splu

from cases.scene import Clamp, Scene, SceneError
from reference3d.centre_line import points
from reference3d.contact import Complementarity, solve_complementarity, without_penetration
from reference3d.own_mesh.body import OwnBody
from reference3d.own_mesh.contact import OwnContact, own_contact
from reference3d.own_mesh.reading import RodMesh, read_rods
from reference3d.own_mesh.solution import OwnMeshSolution, OwnPair, OwnRod
from reference3d.scope import isotropic
from reference3d.solution import Cost

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# right-hand sides solved at a time, and the largest nodal force out of balance that is round-off
COLUMNS, BALANCED = 64, 1e-8


@dataclass(frozen=True, eq=False)
class _Held:
    """A rod's stiffness, its factors where it is free to move, and what clamps do to the rest."""

    body: OwnBody
    stiffness: csc_array
    free: IntArray
    factors: Any
    given: Array  # displacement where it is held, zero elsewhere, shape (unknowns,)
    load: Array

    def moved_by(self, forces: Array) -> Array:
        """Displacement without that of the clamps under forces, shape (unknowns, n) both."""
        found = np.zeros_like(forces)
        found[self.free] = self.factors.solve(np.ascontiguousarray(forces[self.free]))
        return found


def solve_own_mesh(scene: Scene, path: Path) -> OwnMeshSolution:
    """Solve a scene on the mesh in a file instead of the reference's own (`reading` says how it names its groups).

    Raises
    ------
    SceneError
        if the mesh cannot be that of the scene, or the scene has rods that clamps do not hold, joints, beds, supports
        other than clamps, pressures or materials that are not isotropic.
    """
    begin = time.perf_counter()
    _require_treatable(scene)
    meshes = read_rods(scene, path)
    bodies = {rod.name: OwnBody(meshes[rod.name], isotropic(rod)) for rod in scene.rods}
    contacts = [own_contact(scene, pair, bodies) for pair in scene.contacts]
    held = {name: _held(scene, body) for name, body in bodies.items()}
    ready = time.perf_counter()

    before = {name: rod.given + rod.moved_by(_effective(rod)[:, None])[:, 0] for name, rod in held.items()}
    answer, force = _contact(contacts, held, before)
    moved = _displacements(contacts, held, before, force)
    pressed = {name: np.zeros(body.unknowns) for name, body in bodies.items()}
    for contact, part in zip(contacts, force, strict=True):
        for name, rows in contact.rows.items():
            pressed[name] += rows.T @ part
    internal = {name: rod.stiffness @ moved[name] for name, rod in held.items()}
    unbalanced = {name: internal[name] - held[name].load - pressed[name] for name in bodies}
    residual = max(
        float(np.abs(unbalanced[name][rod.free]).max() / max(np.abs(internal[name]).max(), 1e-300))
        for name, rod in held.items()
    )
    outcome = answer.outcome
    if outcome == "converged" and residual > BALANCED:
        outcome = f"refused: nodal forces are out of balance by {residual:.1e}"
    pairs = {}
    for contact, part in zip(contacts, force, strict=True):
        gap = contact.gap + sum(rows @ moved[name] for name, rows in contact.rows.items())
        pairs[contact.pair.name] = OwnPair(contact, gap, part)
    volume = sum(float((mesh.volumes()[0] * mesh.kind.quadrature[1]).sum()) for mesh in meshes.values())
    end = time.perf_counter()
    return OwnMeshSolution(
        scene=scene,
        outcome=outcome,
        contact_solutions=1 if contacts else 0,
        active_sets=answer.steps,
        strain_energy=0.5 * sum(float(moved[name] @ internal[name]) for name in bodies),
        cost=Cost(sum(body.unknowns for body in bodies.values()), ready - begin, end - ready),
        residual=residual,
        representative_size=(volume / sum(len(mesh.elements) for mesh in meshes.values())) ** (1.0 / 3.0),
        rods={name: OwnRod(body, moved[name].reshape(-1, 3)) for name, body in bodies.items()},
        reactions=_reactions(scene, meshes, unbalanced),
        pairs=pairs,
    )


def _require_treatable(scene: Scene) -> None:
    clamped = {support.rod for support in scene.supports if isinstance(support, Clamp)}
    loose = [rod.name for rod in scene.rods if rod.name not in clamped]
    remedy = "on a mesh of one's own "
    if loose:
        raise SceneError("supports", f"no clamp of rod '{loose[0]}'", f"{remedy}every rod is held by clamps")
    for number, support in enumerate(scene.supports, 1):
        if not isinstance(support, Clamp):
            raise SceneError(f"supports #{number}.kind", "a support of components", f"{remedy}there are clamps alone")
    if scene.joints:
        raise SceneError("joints", f"{len(scene.joints)}", f"{remedy}rods are not joined")
    if scene.beds:
        raise SceneError("beds", f"{len(scene.beds)}", f"{remedy}rods do not lie on beds")


def _held(scene: Scene, body: OwnBody) -> _Held:
    rod = body.mesh.rod
    stiffness = body.stiffness()
    given, fixed = np.zeros((len(body.mesh.nodes), 3)), np.zeros(len(body.mesh.nodes), dtype=bool)
    for support in scene.supports:
        if isinstance(support, Clamp) and support.rod == rod.name:
            nodes = body.mesh.group_nodes(support.end)
            arm = body.mesh.nodes[nodes] - _end(scene, rod.name, support.end)
            given[nodes] = np.array(support.displacement) + np.cross(np.array(support.rotation), arm)
            fixed[nodes] = True
    free = np.flatnonzero(~np.repeat(fixed, 3))
    inner = csc_array(stiffness[free][:, free])
    factors = splu(inner, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    return _Held(body, stiffness, free, factors, given.ravel(), body.loads(scene.loads))


def _end(scene: Scene, rod: str, end: str) -> Array:
    line = scene.rod(rod)
    station = np.array([0.0 if end == "start" else line.length])
    return np.asarray(points(line.centre_line, station)[0])


def _effective(rod: _Held) -> Array:
    """Loads, and what moved clamps do to the free nodes."""
    return np.asarray(rod.load - rod.stiffness @ rod.given)


def _contact(
    contacts: list[OwnContact], held: Mapping[str, _Held], before: Mapping[str, Array]
) -> tuple[Complementarity, list[Array]]:
    """Forces of all pairs; d = gap + C F at the corners."""
    if not contacts:
        return Complementarity(np.zeros(0), "converged", 0), []
    count = sum(len(contact.nodes) for contact in contacts)
    starts = np.cumsum([0, *(len(contact.nodes) for contact in contacts)])
    offset = np.concatenate([contact.gap for contact in contacts])
    compliance = np.zeros((count, count))
    for name, rod in held.items():
        touching = [
            (contact.rows[name], start)
            for contact, start in zip(contacts, starts, strict=False)
            if name in contact.rows
        ]
        for rows, start in touching:
            offset[start : start + rows.shape[0]] += rows @ before[name]
            for first in range(0, rows.shape[0], COLUMNS):
                columns = rows[first : first + COLUMNS].T.toarray()
                moved = rod.moved_by(columns)
                for other, at in touching:
                    compliance[at : at + other.shape[0], start + first : start + first + columns.shape[1]] += (
                        other @ moved
                    )
    compliance = 0.5 * (compliance + compliance.T)
    soft = np.concatenate([contact.soft for contact in contacts])
    rigid = np.concatenate([np.full(len(contact.nodes), contact.rigid) for contact in contacts])
    matrix = compliance + np.diag(soft)
    first_answer = solve_complementarity(matrix, offset, offset < 0.0)
    if first_answer.outcome != "converged":
        return first_answer, np.split(first_answer.force, starts[1:-1])
    exact = without_penetration(matrix, offset, soft, rigid, first_answer)
    return Complementarity(exact.force, exact.outcome, exact.steps), np.split(exact.force, starts[1:-1])


def _displacements(
    contacts: list[OwnContact], held: Mapping[str, _Held], before: Mapping[str, Array], force: list[Array]
) -> dict[str, Array]:
    """Displacement of every rod, shape (unknowns,)."""
    moved = {}
    for name, rod in held.items():
        pressed = np.zeros(rod.body.unknowns)
        for contact, part in zip(contacts, force, strict=True):
            if name in contact.rows:
                pressed += contact.rows[name].T @ part
        moved[name] = before[name] + rod.moved_by(pressed[:, None])[:, 0]
    return moved


def _reactions(
    scene: Scene, meshes: Mapping[str, RodMesh], unbalanced: Mapping[str, Array]
) -> dict[tuple[str, float], Array]:
    found = {}
    for support in scene.supports:
        if isinstance(support, Clamp):
            mesh = meshes[support.rod]
            nodes = mesh.group_nodes(support.end)
            force = unbalanced[support.rod].reshape(-1, 3)[nodes]
            moment = np.cross(mesh.nodes[nodes] - _end(scene, support.rod, support.end), force)
            station = 0.0 if support.end == "start" else mesh.rod.length
            found[support.rod, station] = np.concatenate([force.sum(axis=0), moment.sum(axis=0)])
    return found
