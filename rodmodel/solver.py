"""From a scene to its solution: assemble, find contact, move the borders onto its edges, solve once more."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene, SceneError
from rodmodel.assembly import ElementStore, coefficients
from rodmodel.borders import Edge, border_plan, natural_borders, placed_borders
from rodmodel.contact import unilateral_contact
from rodmodel.edges import EdgeSearch, Stretch, find_edges, moved, moving_edges, same_topology, stretches_in_contact
from rodmodel.solution import Cost, Solution
from rodmodel.symmetry import symmetric_fields
from rodmodel.system import ContactSystem, contact_system

Array = NDArray[np.float64]

# Makes the contact system on given borders, with points in all zones or in parts of them.
SystemOn = Callable[[dict[str, Array], dict[str, Array] | None], ContactSystem]

# How often the search may start anew because stretches appeared, merged or vanished.
MOST_TOPOLOGIES = 3


def solve(scene: Scene, level: int = 5, order: int = 6) -> Solution:
    """Solve a scene with the hierarchic rod model.

    Parameters
    ----------
    level : k of h_k, degree of the displacement in (x, y)
    order : p, degree along the rods, at least 2

    Raises
    ------
    SceneError
        if a rod is not held by any support.
    """
    for index, rod in enumerate(scene.rods):
        if not any(support.rod == rod.name for support in scene.supports):
            raise SceneError(
                "supports", f"none on rods[{index}] '{rod.name}'", "a rod must be clamped at one end at least"
            )
    begin = time.perf_counter()
    fields = symmetric_fields(scene, level)
    store = ElementStore(order)

    def system_on(borders: dict[str, Array], within: dict[str, Array] | None = None) -> ContactSystem:
        return contact_system(scene, fields, borders, store, within)

    natural = {rod.name: natural_borders(scene, rod) for rod in scene.rods}
    system = system_on(natural)
    ready = time.perf_counter()
    contact = moved_contact(scene, natural, system, system_on)
    values = {
        name: coefficients(assembled, contact.system.total_load(name, contact.force))
        for name, assembled in contact.system.rods.items()
    }
    unknowns = sum(assembled.unknowns for assembled in contact.system.rods.values())
    cost = Cost(unknowns, ready - begin, time.perf_counter() - ready)
    return Solution(
        scene,
        level,
        order,
        contact.outcome,
        contact.solutions,
        contact.stretches,
        contact.system,
        contact.force,
        values,
        cost,
    )


@dataclass(frozen=True, eq=False)
class MovedContact:
    """Contact on borders that sit on its edges.

    Attributes
    ----------
    outcome : 'converged', 'stagnated: ...'
    solutions : contact solutions spent
    """

    outcome: str
    solutions: int
    stretches: tuple[Stretch, ...]
    system: ContactSystem
    force: Array


def moved_contact(
    scene: Scene,
    natural: dict[str, Array],
    system: ContactSystem,
    system_on: SystemOn,
) -> MovedContact:
    """Find the stretches in contact on the natural borders, move borders onto their edges, and solve on those.

    Where stretches appear, merge or vanish on the way, the search starts anew from what the last solution shows.
    """
    force = unilateral_contact(system.compliance, system.initial_gap, system.spring)
    stretches, solutions = stretches_in_contact(system, force), 1
    for _ in range(MOST_TOPOLOGIES):
        edges, positions = moving_edges(scene, stretches)
        if not edges:
            return MovedContact("converged", solutions, stretches, system, force)
        search, borders = _search(scene, natural, stretches, edges, positions, system_on)
        system = system_on(borders, None)
        force = unilateral_contact(system.compliance, system.initial_gap, system.spring)
        solutions += len(search.steps) + 1
        found = stretches_in_contact(system, force)
        wanted = moved(stretches, edges, search.positions)
        if search.outcome == "converged" and same_topology(found, wanted):
            return MovedContact("converged", solutions, wanted, system, force)
        stretches = found
    reason = f"stagnated: the edges of contact did not settle in {solutions} solutions"
    return MovedContact(reason, solutions, stretches, system, force)


def _search(
    scene: Scene,
    natural: dict[str, Array],
    stretches: Sequence[Stretch],
    edges: Sequence[Edge],
    positions: Array,
    system_on: SystemOn,
) -> tuple[EdgeSearch, dict[str, Array]]:
    """One search with the borders that follow each edge chosen beforehand, and the borders it ended with."""
    plan = border_plan(scene, natural, edges, positions)

    def system_at(at: Array) -> ContactSystem:
        # Only what is held in contact tells where the edges are.
        held = moved(stretches, edges, at)
        within = {
            pair.name: np.array([[s.start, s.end] for s in held if s.pair == pair.name]).reshape(-1, 2)
            for pair in scene.contacts
        }
        return system_on(placed_borders(scene, plan, edges, at), within)

    search = find_edges(scene, stretches, edges, positions, system_at)
    return search, placed_borders(scene, plan, edges, search.positions)
