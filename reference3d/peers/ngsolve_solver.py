"""NGSolve as a peer: a scene of straight rectangular rods on its p-version hexahedra, contact condensed by hand.

All of it is NGSolve's own: elements, assembly, static condensation and sparse Cholesky. Nothing is shared with
`reference3d` but the scene.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Mapping
from dataclasses import dataclass
from importlib.util import find_spec
from typing import Any

import numpy as np
from scipy.sparse import csr_array, vstack

from cases.scene import Clamp, Scene, SceneError, station_of
from reference3d.peers.answer import Array, NotInstalled, PeerAnswer
from reference3d.peers.ngsolve_contact import Springs, contact_forces, make_springs
from reference3d.peers.ngsolve_grading import COARSE, FINE, graded, is_symmetric
from reference3d.peers.ngsolve_mesh import Hexahedra, RodMesh, frame, make_mesh, rectangle
from reference3d.peers.ngsolve_system import (
    BilinearForm,
    System,
    given_displacement,
    isotropic,
    load_vector,
    make_system,
    section_arms,
    stiffness,
)

# NGSolve's classes, which type checkers are not shown.
Operator = Any
Vector = Any

# Columns of the compliance that are solved for at a time: enough for speed, few for memory.
_AT_A_TIME = 64


def installed() -> str:
    """'' where NGSolve can be imported, else one sentence: that it is absent, and how to install it."""
    if find_spec("ngsolve") is not None and find_spec("netgen") is not None:
        return ""
    return "NGSolve is not installed; pip install 'rodcheck[peers]' installs it."


def solve(scene: Scene, stations: Mapping[str, Array], hexahedra: Hexahedra | None = None) -> PeerAnswer:
    """Solve a scene with NGSolve, on a mesh that suits it or a given one.

    Parameters
    ----------
    stations : by rod, arc lengths at which the centre line's displacement is wanted, mm, shape (n,)
    hexahedra : the mesh; without one, a coarse solution finds where contact is, and elements are short there

    Raises
    ------
    NotInstalled
        if NGSolve is absent.
    ValueError
        if half of the rods is meshed and the scene is not symmetric.
    SceneError
        if the scene has what is not given to NGSolve here: rods that are curved, twisted, not isotropic or not of
        rectangular section, joints, supports by mean displacement or askew to the global axes.
    """
    if absent := installed():
        raise NotInstalled(absent)
    require_treatable(scene)
    if hexahedra is not None and hexahedra.symmetric and not is_symmetric(scene):
        raise ValueError(f"a mesh of half of the rods, but scene '{scene.name}' has no plane of symmetry x = 0")
    begun = time.perf_counter()
    if hexahedra is None:
        coarse = solve_condensed(scene, graded(scene, COARSE))
        hexahedra = graded(scene, FINE, coarse.stretches())
    solved = solve_condensed(scene, hexahedra)
    return answer(solved, stations, time.perf_counter() - begun)


def require_treatable(scene: Scene) -> None:
    """Refuse what no grid can be made for; SceneError."""
    for rod in scene.rods:
        frame(rod)
        rectangle(rod)
        isotropic(rod)
        if not any(support.rod == rod.name and isinstance(support, Clamp) for support in scene.supports):
            remedy = "NGSolve is given rods with a clamp, so that none is loose"
            raise SceneError(f"rods.{rod.name}", "a rod without a clamp", remedy)
    if scene.joints:
        raise SceneError("joints", f"{len(scene.joints)}", "NGSolve is given rods that are not joined")


@dataclass(frozen=True, eq=False)
class Solved:
    """What NGSolve found.

    Attributes
    ----------
    displacement : the unknowns, those of the three global components one after the other, shape (3, n)
    reaction : what supports exert on the unknowns, N, shape (3, n)
    springs, force : of contact, by pair; N, shape (n_points,)
    outcome : 'converged', or why not
    """

    system: System
    displacement: Array
    reaction: Array
    springs: Mapping[str, Springs]
    force: Mapping[str, Array]
    outcome: str

    def stretches(self) -> dict[str, tuple[float, float]]:
        """Where each pair touches, arc length along the first rod from the first to the last point in contact, mm."""
        found = {}
        for pair in self.system.scene.contacts:
            touching = self.springs[pair.name].position[:, self.force[pair.name] > 0.0]
            if touching.size:
                s = self.system.rod(pair.first.rod).frame.coordinates(touching)[2]
                found[pair.name] = float(s.min()), float(s.max())
        return found


def solve_condensed(scene: Scene, hexahedra: Hexahedra) -> Solved:
    """One factorisation, one solution a contact point, and an active set on the compliance of the contact points."""
    system = make_system(scene, hexahedra, make_mesh(scene, hexahedra))
    form = stiffness(system)
    inverse = factorise(form, system)
    springs = {pair.name: make_springs(system, pair) for pair in scene.contacts}
    openings = [of.opening for of in springs.values()]
    opening = csr_array(vstack(openings)) if len(openings) > 1 else next(iter(openings), None)

    load, given, residual = (form.mat.CreateColVector() for _ in range(3))
    load.FV().NumPy()[:] = load_vector(system)
    given.FV().NumPy()[:] = given_displacement(system)
    residual.data = load + form.harmonic_extension_trans * load
    displacement = given.CreateVector()
    displacement.data = given + inverse * (residual - form.mat * given)
    force, outcome = np.zeros(0), "converged"
    if opening is not None and opening.shape[0]:
        compliance = _compliance(inverse, opening, given)
        distance = np.concatenate([of.gap for of in springs.values()]) + opening @ displacement.FV().NumPy()
        force, outcome = contact_forces(compliance, distance, np.concatenate([of.stiffness for of in springs.values()]))
        pushed = given.CreateVector()
        pushed.FV().NumPy()[:] = opening.T @ force
        residual.data += pushed
        displacement.data += inverse * pushed
    reaction = given.CreateVector()
    reaction.data = form.mat * displacement - residual
    displacement.data += form.harmonic_extension * displacement
    displacement.data += form.inner_solve * load
    ends = np.cumsum([len(of.gap) for of in springs.values()])[:-1]
    forces = dict(zip(springs, np.split(force, ends), strict=True)) if springs else {}
    components = (3, system.component.ndof)
    return Solved(
        system,
        displacement.FV().NumPy().reshape(components).copy(),
        reaction.FV().NumPy().reshape(components).copy(),
        springs,
        forces,
        outcome,
    )


def factorise(form: BilinearForm, system: System) -> Operator:
    """The stiffness, or the condensed one, factorised."""
    return form.mat.Inverse(system.space.FreeDofs(coupling=form.condense), inverse="sparsecholesky")


def _compliance(inverse: Operator, opening: csr_array, like: Vector) -> Array:
    """Opening at every contact point by a unit force at every other, mm/N, shape (n_points, n_points)."""
    import ngsolve

    count = opening.shape[0]
    found = np.empty((count, count))
    for begin in range(0, count, _AT_A_TIME):
        rows = opening[begin : begin + _AT_A_TIME].toarray()
        pushed, moved = (ngsolve.MultiVector(like, len(rows)) for _ in range(2))
        for number, row in enumerate(rows):
            pushed[number].FV().NumPy()[:] = row
        moved.data = inverse * pushed
        columns = np.array([moved[number].FV().NumPy() for number in range(len(rows))])
        found[:, begin : begin + len(rows)] = opening @ columns.T
    return (found + found.T) / 2.0


def answer(solved: Solved, stations: Mapping[str, Array], seconds: float) -> PeerAnswer:
    """The quantities that every peer tells, for the full section."""
    import ngsolve

    system = solved.system
    scene, whole = system.scene, 2.0 if system.hexahedra.symmetric else 1.0
    force, centre = {}, {}
    for pair in scene.contacts:
        springs, pushes = solved.springs[pair.name], solved.force[pair.name]
        part = system.rod(pair.first.rod)
        force[pair.name] = whole * pushes.sum() * springs.normal
        centre[pair.name] = np.full(3, np.nan)
        if pushes.any():
            point = springs.position @ pushes / pushes.sum()
            centre[pair.name] = _in_plane(point, part) if system.hexahedra.symmetric else point
    return PeerAnswer(
        solver=f"NGSolve {ngsolve.__version__}",
        outcome=solved.outcome,
        unknowns=sum(system.space.FreeDofs()),
        seconds=seconds,
        peak_memory=resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
        contact_force=force,
        contact_centre=centre,
        displacement={name: _centre_line(solved, name, np.asarray(places)) for name, places in stations.items()},
        reactions=_reactions(solved),
    )


def _in_plane(point: Array, part: RodMesh) -> Array:
    """A point of the meshed half, with its mirror image's mean: moved into the plane of symmetry."""
    axis = part.frame.axes[0]
    return np.asarray(point - axis * float(axis @ (point - part.frame.start)))


def _centre_line(solved: Solved, rod: str, stations: Array) -> Array:
    """Displacement of the centre line, global, mm, shape (3, n)."""
    points = np.array([np.zeros(len(stations)), np.zeros(len(stations)), stations])
    return np.asarray((solved.system.shape_functions(rod, points) @ solved.displacement.T).T)


def _reactions(solved: Solved) -> dict[tuple[str, float], Array]:
    """What clamps exert, by rod and arc length: work of the residual in rigid motions of the section."""
    system, found = solved.system, {}
    for support in system.scene.supports:
        if not isinstance(support, Clamp):
            continue
        vertices, arm = section_arms(system, support)
        nodal = solved.reaction[:, vertices]
        total = np.concatenate([nodal.sum(axis=1), np.cross(arm, nodal, axisa=0, axisb=0).sum(axis=0)])
        if system.hexahedra.symmetric:
            total = 2.0 * _mirrored(total, system.rod(support.rod).frame.axes[0])
        found[support.rod, station_of(support, system.scene.rod(support.rod))] = total
    return found


def _mirrored(total: Array, normal: Array) -> Array:
    """Mean of a force and moment and their mirror images: no force along the plane's normal, no moment but about it."""
    force, moment = total[:3], total[3:]
    return np.concatenate([force - normal * float(normal @ force), normal * float(normal @ moment)])
