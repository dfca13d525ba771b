"""From a scene to its solution: assemble, find contact, move the borders onto its edges, solve once more."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from cases.scene import Rod, Scene
from rodmodel.assembly import AssembledRod, ElementStore, stored_energy
from rodmodel.borders import Edge, Rates, border_plan, edge_rates, natural_mesh, placed_meshes, split_at
from rodmodel.contact import ContactForces, unilateral_contact
from rodmodel.edge_pressure import held_points
from rodmodel.edges import EDGE_TOLERANCE, EdgeSearch, find_edges
from rodmodel.loose import loose_rods
from rodmodel.mesh import RodMesh, lowest
from rodmodel.shape import extents
from rodmodel.solution import Cost, Solution
from rodmodel.soundness import lost_accuracy
from rodmodel.stretches import Stretch, moved, moving_edges, same_topology, snapped, stretches_in_contact
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system

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
    system_on = systems(scene, ElementStore(), multipliers)
    natural = {rod.name: natural_mesh(scene, rod, grades_of(level, rod), grades_of(order, rod)) for rod in scene.rods}
    # Where contact is shows at the lowest level already.
    look = system_on(lowest(natural)) if scene.contacts else ()
    ready = time.perf_counter()
    return checked(solution_of(scene, moved_contact(scene, natural, look, system_on), begin, ready))


def systems(scene: Scene, store: ElementStore, multipliers: bool = True) -> SystemOn:
    """What makes the scene's contact system on given meshes; elements are taken from the store and added to it.

    Raises
    ------
    SceneError
        if supports, joints and beds leave a rod loose that no contact could hold.
    """
    mirrors = scene_mirrors(scene)
    loose = loose_rods(scene, mirrors)

    def system_on(meshes: dict[str, RodMesh]) -> ContactSystem:
        return contact_system(scene, mirrors, meshes, store, loose, multipliers)

    return system_on


def solution_of(scene: Scene, contact: MovedContact, begin: float, ready: float) -> Solution:
    """The rods under the contact forces found; round-off is left to `checked`.

    begin, ready : `time.perf_counter()` of when work began and was ready to look for contact
    """
    forces = contact.forces
    states = contact.system.states(forces.force, forces.motion)
    energy = sum(
        stored_energy(contact.system.rods[name], state.load, state.coefficients) for name, state in states.items()
    )
    unknowns = sum(assembled.unknowns for assembled in contact.system.rods.values())
    cost = Cost(unknowns, ready - begin, time.perf_counter() - ready)
    return Solution(
        scene,
        _judged(contact, energy),
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


def checked(solution: Solution) -> Solution:
    """The solution, refused if round-off has falsified it."""
    begin = time.perf_counter()
    outcome = _lost_digits(solution) if solution.outcome == "converged" else ""
    cost = replace(solution.cost, solve_seconds=solution.cost.solve_seconds + time.perf_counter() - begin)
    return replace(solution, outcome=outcome or solution.outcome, cost=cost)


def _judged(contact: MovedContact, stored_energy: float) -> str:
    """The contact's outcome, unless springs have falsified the answer."""
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
    return contact.outcome


def _lost_digits(solution: Solution) -> str:
    """Why round-off refuses the solution; empty where it does not."""
    for name, assembled in solution.system.rods.items():
        # The look takes it that elements move as rigid bodies without force, which beds do not let them.
        on_bed = any(bed.rod == name for bed in solution.scene.beds)
        if not on_bed and _may_lose_digits(assembled):
            lost = lost_accuracy(assembled, solution.states[name].coefficients)
            if lost > LARGEST_LOSS:
                found = f"round-off has taken about {lost:.1g} of the displacement of rod '{name}'"
                return f"refused: {found}, which is too slender for so many or so short elements"
    return ""


def _may_lose_digits(assembled: AssembledRod) -> bool:
    """Whether round-off may count: it grows with the square of the length over that of the shortest element, or more.

    Looking costs a few per cent of a solution, so that ordinary rods are spared it.
    """
    x_min, x_max, y_min, y_max = extents(assembled.rod.section)
    slenderness = assembled.rod.length / min(x_max - x_min, y_max - y_min)
    return max(slenderness, assembled.rod.length / float(np.diff(assembled.borders).min())) > ORDINARY


def grades_of(grades: Grades, rod: Rod) -> int | Sequence[int]:
    """The levels or orders of a rod, or the one of all rods."""
    if not isinstance(grades, Mapping):
        return grades
    if rod.name not in grades:
        raise ValueError(f"level or order: found none for rod '{rod.name}'; give every rod one for each element")
    return grades[rod.name]


class Begin(Protocol):
    """What scenes nearly the same tell of where contact is."""

    def edges(self, edges: Sequence[Edge], positions: Array) -> tuple[Array, Array | None]:
        """Where the search for edges that seem to be at `positions` begins, and with which slopes (None: not known)."""
        ...

    def points(self, held: BoolArray | None) -> BoolArray | None:
        """Points that may be in contact, where borders on the edges hold these (None: no borders are there)."""
        ...


@dataclass(frozen=True, eq=False)
class MovedContact:
    """Contact on borders that sit on its edges.

    Attributes
    ----------
    outcome : of the last contact solution
    solutions : contact problems solved
    active_sets : sets of points tried in all of them
    edges, search : those that moved and their search, where it settled
    """

    outcome: str
    solutions: int
    active_sets: int
    stretches: tuple[Stretch, ...]
    system: ContactSystem
    forces: ContactForces
    edges: tuple[Edge, ...] = ()
    search: EdgeSearch | None = None


def unmoved_contact(system: ContactSystem) -> MovedContact:
    """Contact on the borders as they are: forces are good to some 0.01 %, edges as the contact points show them."""
    forces = unilateral_contact(system.problem)
    found = stretches_in_contact(system, forces)
    return MovedContact(forces.outcome, 1, forces.active_sets, found, system, forces)


def moved_contact(
    scene: Scene,
    natural: dict[str, RodMesh],
    look: ContactSystem | Sequence[Stretch],
    system_on: SystemOn,
    begin: Begin | None = None,
    edge_share: float | None = None,
) -> MovedContact:
    """Find the stretches in contact, move borders onto their edges, and solve on those.

    Where stretches appear, merge or vanish on the way, the search starts anew from what the last solution shows. Where
    that goes on, or the search does not settle, the natural borders stay, with more where contact seems to end: the
    stretches say how far the edges may be from there.

    look : where to begin: stretches, or a system on the natural borders, at any level, whose solution shows them
    edge_share : as `share` of `find_edges`: how precisely borders sit on edges. Forces are stationary there; 0.03 of
        the stretch's length changes them by some 1e-6
    """
    solutions, active_sets = 0, 0

    def solve_contact(system: ContactSystem, settled: bool = True, guess: BoolArray | None = None) -> ContactForces:
        nonlocal active_sets
        forces = unilateral_contact(system.problem, settled, guess)
        active_sets += forces.active_sets
        return forces

    if isinstance(look, ContactSystem):
        solutions = 1
        stretches = stretches_in_contact(look, solve_contact(look, settled=False))
    else:
        stretches = tuple(look)
    for attempt in range(MOST_TOPOLOGIES):
        edges, positions = moving_edges(scene, stretches)
        start = begin if attempt == 0 else None
        search = _search(scene, natural, stretches, edges, positions, system_on, start, edge_share) if edges else None
        system = system_on(natural) if search is None else search.system
        solutions += 1 if search is None else len(search.steps)
        active_sets += 0 if search is None else len(search.steps)
        guess = None if search is None else held_points(system, moved(stretches, edges, search.positions))
        forces = solve_contact(system, guess=guess if start is None else start.points(guess))
        found = stretches_in_contact(system, forces)
        if search is not None and search.outcome == "converged":
            wanted = moved(stretches, edges, search.positions)
            if same_topology(found, wanted):
                settled = _settled(stretches, edges, search, edge_share)
                return MovedContact(forces.outcome, solutions, active_sets, settled, system, forces, edges, search)
        if search is not None and search.outcome == "topology":
            # At the end of a zone the corner point may stay open where the search has contact reach the end.
            led = snapped(scene, moved(stretches, edges, search.root))
            found = led if same_topology(found, led) else found
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
    begin: Begin | None,
    share: float | None,
) -> EdgeSearch:
    """One search with the borders that follow each edge chosen beforehand."""
    plan = border_plan(scene, natural, edges, positions)

    def system_at(at: Array) -> tuple[ContactSystem, dict[str, Rates]]:
        return system_on(placed_meshes(plan, at)), edge_rates(plan, at)

    start, jacobian = (positions, None) if begin is None else begin.edges(edges, positions)
    return find_edges(scene, stretches, edges, start, system_at, jacobian, share)


def _settled(
    stretches: Sequence[Stretch], edges: Sequence[Edge], search: EdgeSearch, share: float | None
) -> tuple[Stretch, ...]:
    """The stretches with their ends on the borders; where these sit roughly only, where the search's last step leads.

    How long that step was bounds what they are off; slopes being exact, they are off by 1 % of it.
    """
    if share is None:
        return tuple(replace(each, slack=EDGE_TOLERANCE) for each in moved(stretches, edges, search.positions))
    slack = max(EDGE_TOLERANCE, float(np.abs(search.root - search.positions).max()))
    return tuple(replace(each, slack=slack) for each in moved(stretches, edges, search.root))
