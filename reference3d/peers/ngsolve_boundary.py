"""NGSolve's own contact, `ContactBoundary`: energy of penetration at its contact pairs, minimised by Newton's method.

It is what its user gets without further work, and factorises all unknowns in every iteration. `ngsolve_solver`
condenses contact by hand instead, and is what answers for NGSolve; this is here for its time.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from cases.scene import ContactPair, GapTable, Ground, RoundGap, Scene, SceneError
from reference3d.peers.ngsolve_contact import STIFF as RIGID
from reference3d.peers.ngsolve_contact import make_springs, modulus
from reference3d.peers.ngsolve_mesh import Hexahedra, contact_boundary, make_mesh, rectangle
from reference3d.peers.ngsolve_solver import Solved, factorise, require_treatable
from reference3d.peers.ngsolve_system import (
    BilinearForm,
    System,
    elasticity,
    given_displacement,
    load_vector,
    make_system,
)

# NGSolve's classes, which type checkers are not shown.
Function = Any
Contact = Any

# Penalty where none is given, in units of the softer rod's Young's modulus over the smallest side of a section: with it
# Newton's method ends in a few iterations, and it changes the contact force by less than 1e-5.
STIFF = 300.0
# Newton's method ends when a step has this share of the first one's energy.
_TOLERANCE = 1e-18
_MOST_ITERATIONS = 40


def solve_with_contact_boundary(scene: Scene, hexahedra: Hexahedra) -> Solved:
    """Solve a scene by Newton's method with NGSolve's `ContactBoundary`.

    Raises
    ------
    SceneError
        if the scene cannot be given to NGSolve, or has ground or a gap that is not one number.
    """
    import ngsolve

    require_treatable(scene)
    for pair in scene.contacts:
        if isinstance(pair.second, Ground) or isinstance(pair.gap, GapTable | RoundGap):
            remedy = "NGSolve's own contact is given two rods and a gap that is one number"
            raise SceneError(f"contacts.{pair.name}", "ground or a gap that varies", remedy)
    system = make_system(scene, hexahedra, make_mesh(scene, hexahedra, contact_faces=True), of_vectors=True)
    form = ngsolve.BilinearForm(system.space, symmetric=True)
    form += elasticity(system)
    function = ngsolve.GridFunction(system.space)
    displacement = function.vec
    displacement.FV().NumPy()[:] = given_displacement(system)
    contacts = [_contact(system, pair, form, function) for pair in scene.contacts]
    load, residual, step = (displacement.CreateVector() for _ in range(3))
    load.FV().NumPy()[:] = load_vector(system)
    first, outcome = 0.0, "stagnated"
    for _ in range(_MOST_ITERATIONS):
        form.Apply(displacement, residual)
        residual.data -= load
        form.AssembleLinearization(displacement)
        step.data = factorise(form, system) * residual
        displacement.data -= step
        energy = abs(ngsolve.InnerProduct(step, residual))
        first = first or energy
        if energy <= _TOLERANCE * first:
            outcome = "converged"
            break
    form.Apply(displacement, residual)
    residual.data -= load
    del contacts  # NGSolve wants them until here
    springs = {}
    for pair in scene.contacts:
        of_pair = make_springs(system, pair)
        springs[pair.name] = replace(
            of_pair, stiffness=of_pair.stiffness * (_penalty(system, pair) / modulus(system, pair))
        )
    unknowns = displacement.FV().NumPy().copy()
    force = {name: of.stiffness * np.maximum(-(of.gap + of.opening @ unknowns), 0.0) for name, of in springs.items()}
    components = (3, system.component.ndof)
    reaction = residual.FV().NumPy().reshape(components).copy()
    return Solved(system, unknowns.reshape(components), reaction, springs, force, outcome)


def _contact(system: System, pair: ContactPair, form: BilinearForm, function: Function) -> Contact:
    """NGSolve's contact of a pair: its pairs of points are found once, on the undeformed faces."""
    import ngsolve

    number = system.scene.contacts.index(pair)
    first, second = (system.mesh.ngsolve.Boundaries(contact_boundary(number, side)) for side in (0, 1))
    contact = ngsolve.ContactBoundary(first, second)
    part = system.rod(pair.first.rod)
    normal = ngsolve.CoefficientFunction(tuple(part.frame.normal(pair.first.face).tolist()))
    trial = system.space.TrialFunction()
    distance = ngsolve.InnerProduct(trial.Other() - trial, normal)
    position = ngsolve.CoefficientFunction((ngsolve.x, ngsolve.y, ngsolve.z))
    if pair.gap == "drawn":
        distance += ngsolve.InnerProduct(position.Other() - position, normal)
    else:
        distance += pair.gap
    energy = _penalty(system, pair) / 2.0 * distance * distance
    contact.AddEnergy(ngsolve.IfPos(distance, 0.0, energy))
    section = rectangle(system.scene.rod(pair.first.rod))
    order = 2 * max(system.hexahedra.orders[pair.first.rod])
    contact.Update(function, form, intorder=order, maxdist=max(section.width, section.height))
    return contact


def _penalty(system: System, pair: ContactPair) -> float:
    """Penalty of a pair, N/mm^3."""
    return pair.penalty or STIFF / RIGID * modulus(system, pair)
