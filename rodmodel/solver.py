"""From a scene to its solution: assemble, find contact, move the borders onto its edges, solve once more."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import Rod, Scene
from rodmodel.assembly import AssembledRod, ElementStore, stored_energy
from rodmodel.borders import Edge, Rates, border_plan, edge_rates, natural_mesh, placed_meshes, split_at
from rodmodel.contact import ContactForces, unilateral_contact
from rodmodel.edge_pressure import held_points
from rodmodel.edges import EDGE_TOLERANCE, EdgeSearch, find_edges
from rodmodel.loose import loose_rods
from rodmodel.mesh import RodMesh
from rodmodel.shape import extents
from rodmodel.solution import Cost, Solution
from rodmodel.soundness import lost_accuracy
from rodmodel.stretches import Stretch, moved, moving_edges, same_topology, stretches_in_contact
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, RodState, contact_system

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# A level or an order: the same everywhere, or by rod name one for each element.
Grades = int | Mapping[str, Sequence[int]]
# Makes the contact system on given meshes.
SystemOn = Callable[[dict[str, RodMesh]], ContactSystem]

# Energy in the contact springs, as a part of the strain energy, above which the penalty falsifies the answer.
PENALTY_SHARE = 1e-3
# Part of the displacements that round-off may take; how slender and finely divided rods may be that are not looked at.
LARGEST_LOSS, ORDINARY = 1e-3, 100.0
# How often the search may start anew because stretches appeared, merged or vanished.
MOST_TOPOLOGIES = 3
# Solutions where it does not settle: on the natural borders, then twice with more of them.
UNMOVED = 3


def solve(scene: Scene, level: Grades = 5, order: Grades = 6, multipliers: bool = True) -> Solution:
    """Solve a scene with the hierarchic rod model.

    Parameters
    ----------
    level : k of h_k, degree of the displacement in (x, y); by rod name, one for each element, where they differ
    order : p, degree along the rods, at least 2; likewise
    multipliers : take the penetration of the penalty's springs away, so that nothing depends on the penalty (augmented
        Lagrangian); without them the springs are what they are

    Raises
    ------
    SceneError
        if supports, joints and beds leave a rod loose that no contact could hold.
    ValueError
        if a level is below 1 or an order below 2, or there is not one for each element.
    """
    begin = time.perf_counter()
    mirrors = scene_mirrors(scene)
    loose = loose_rods(scene, mirrors)
    store = ElementStore()

    def system_on(meshes: dict[str, RodMesh]) -> ContactSystem:
        return contact_system(scene, mirrors, meshes, store, loose, multipliers)

    natural = {rod.name: natural_mesh(scene, rod, _grades_of(level, rod), _grades_of(order, rod)) for rod in scene.rods}
    # Where contact is shows at the lowest level already.
    system = system_on({name: replace(mesh, levels=np.ones_like(mesh.levels)) for name, mesh in natural.items()})
    ready = time.perf_counter()
    contact = moved_contact(scene, natural, system, system_on)
    forces = contact.forces
    states = contact.system.states(forces.force, forces.motion)
    energy = sum(
        stored_energy(contact.system.rods[name], state.load, state.coefficients) for name, state in states.items()
    )
    unknowns = sum(assembled.unknowns for assembled in contact.system.rods.values())
    cost = Cost(unknowns, ready - begin, time.perf_counter() - ready)
    return Solution(
        scene,
        _judged(contact, states, energy),
        contact.solutions,
        contact.active_sets,
        contact.stretches,
        contact.system,
        forces.force,
        forces.motion,
        states,
        energy,
        cost,
    )


def _judged(contact: MovedContact, states: Mapping[str, RodState], stored_energy: float) -> str:
    """The contact's outcome, unless springs or round-off have falsified the answer."""
    problem, forces = contact.system.problem, contact.forces
    if forces.outcome.startswith("refused"):
        names = ", ".join(f"'{name}'" for name in contact.system.moved_by(forces.motion))
        return f"refused: contact does not hold {names} against the loads, and nothing else does"
    springs = forces.force**2 / problem.spring
    penetrating = 0.5 * sum(
        float(springs[contact.system.points[pair.name]].sum())
        for pair in contact.system.scene.contacts
        if not pair.on_bed
    )
    if not problem.rigid.any() and contact.outcome == "converged" and penetrating > PENALTY_SHARE * stored_energy:
        share = penetrating / stored_energy
        return f"refused: the penalty is too soft, penetration holds {share:.2g} of the strain energy"
    for name, assembled in contact.system.rods.items():
        # The look takes it that elements move as rigid bodies without force, which beds do not let them.
        on_bed = any(bed.rod == name for bed in contact.system.scene.beds)
        if contact.outcome == "converged" and not on_bed and _may_lose_digits(assembled):
            lost = lost_accuracy(assembled, states[name].coefficients)
            if lost > LARGEST_LOSS:
                found = f"round-off has taken about {lost:.1g} of the displacement of rod '{name}'"
                return f"refused: {found}, which is too slender for so many or so short elements"
    return contact.outcome


def _may_lose_digits(assembled: AssembledRod) -> bool:
    """Whether round-off may count: it grows with the square of the length over that of the shortest element, or more.

    Looking costs a few per cent of a solution, so that ordinary rods are spared it.
    """
    x_min, x_max, y_min, y_max = extents(assembled.rod.section)
    slenderness = assembled.rod.length / min(x_max - x_min, y_max - y_min)
    return max(slenderness, assembled.rod.length / float(np.diff(assembled.borders).min())) > ORDINARY


def _grades_of(grades: Grades, rod: Rod) -> int | Sequence[int]:
    if not isinstance(grades, Mapping):
        return grades
    if rod.name not in grades:
        raise ValueError(f"level or order: found none for rod '{rod.name}'; give every rod one for each element")
    return grades[rod.name]


@dataclass(frozen=True, eq=False)
class MovedContact:
    """Contact on borders that sit on its edges.

    Attributes
    ----------
    outcome : of the last contact solution
    solutions : contact problems solved
    active_sets : sets of points tried in all of them
    """

    outcome: str
    solutions: int
    active_sets: int
    stretches: tuple[Stretch, ...]
    system: ContactSystem
    forces: ContactForces


def moved_contact(
    scene: Scene,
    natural: dict[str, RodMesh],
    system: ContactSystem,
    system_on: SystemOn,
) -> MovedContact:
    """Find the stretches in contact, move borders onto their edges, and solve on those.

    Where stretches appear, merge or vanish on the way, the search starts anew from what the last solution shows. Where
    that goes on, or the search does not settle, the natural borders stay, with more where contact seems to end: the
    stretches say how far the edges may be from there.

    system : on the natural borders, at any level: its solution tells where to begin
    """
    solutions, active_sets = 1, 0

    def solve_contact(system: ContactSystem, settled: bool = True, guess: BoolArray | None = None) -> ContactForces:
        nonlocal active_sets
        forces = unilateral_contact(system.problem, settled, guess)
        active_sets += forces.active_sets
        return forces

    forces = solve_contact(system, settled=False)
    stretches = stretches_in_contact(system, forces)
    for attempt in range(MOST_TOPOLOGIES):
        edges, positions = moving_edges(scene, stretches)
        search = _search(scene, natural, stretches, edges, positions, system_on) if edges else None
        system = system_on(natural) if search is None else search.system
        solutions += 1 if search is None else len(search.steps)
        active_sets += 0 if search is None else len(search.steps)
        guess = None if search is None else held_points(system, moved(stretches, edges, search.positions))
        forces = solve_contact(system, guess=guess)
        found = stretches_in_contact(system, forces)
        if search is not None and search.outcome == "converged":
            wanted = moved(stretches, edges, search.positions)
            if same_topology(found, wanted):
                settled = tuple(replace(stretch, slack=EDGE_TOLERANCE) for stretch in wanted)
                return MovedContact(forces.outcome, solutions, active_sets, settled, system, forces)
        stretches = found
        stagnated = search is not None and search.outcome == "stagnated"
        if stagnated and attempt == 0:
            # A better guess may help: that of the natural borders at the level asked for.
            system, solutions = system_on(natural), solutions + 1
            forces = solve_contact(system)
            stretches, stagnated = stretches_in_contact(system, forces), False
        if forces.outcome != "converged" or not moving_edges(scene, stretches)[0]:
            return MovedContact(forces.outcome, solutions, active_sets, stretches, system, forces)
        if stagnated:
            break
    meshes = natural
    for _ in range(UNMOVED):
        system = system_on(meshes)
        forces = solve_contact(system)
        stretches, solutions = stretches_in_contact(system, forces), solutions + 1
        edges, positions = moving_edges(scene, stretches)
        places = [(scene.contact(edge.pair), float(at)) for edge, at in zip(edges, positions, strict=True)]
        meshes = split_at(scene, natural, places)
    return MovedContact(forces.outcome, solutions, active_sets, stretches, system, forces)


def _search(
    scene: Scene,
    natural: dict[str, RodMesh],
    stretches: Sequence[Stretch],
    edges: Sequence[Edge],
    positions: Array,
    system_on: SystemOn,
) -> EdgeSearch:
    """One search with the borders that follow each edge chosen beforehand."""
    plan = border_plan(scene, natural, edges, positions)

    def system_at(at: Array) -> tuple[ContactSystem, dict[str, Rates]]:
        return system_on(placed_meshes(plan, at)), edge_rates(plan, at)

    return find_edges(scene, stretches, edges, positions, system_at)
