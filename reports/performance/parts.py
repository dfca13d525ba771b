"""Where the time of one solve of the paper's case goes, by plain calls of the rod model's parts."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

import rodmodel as rm
from cases.loader import load_case
from reports.case_comparison import evaluation_points
from reports.performance.timing import Timing, once
from reports.processes import Progress
from reports.quantities import evaluate
from rodmodel.assembly import ElementStore, assembled_rod
from rodmodel.borders import natural_mesh
from rodmodel.centre_line import darboux
from rodmodel.contact import unilateral_contact
from rodmodel.section import Fields, per_axial_modulus, section_stiffness
from rodmodel.solver import moved_contact
from rodmodel.stiffness import condensed_element, element_family
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system

CASE, LEVEL, ORDER = "two-cantilevers-e50-g0", 5, 6
REPEATS = 9

WHOLE, LOOK, SEARCH, QUANTITIES = "Whole solve", "First look", "Border search", "Quantities"
# What every part does, in a few words
TEXTS = {
    LOOK: "the contact system at level h1, which tells about where contact is",
    "Section matrices": "stiffness over the section, times that along an element",
    "Elements": "bubbles condensed, once for each length",
    "Chains": "both rods factorised, block by block",
    "Contact points": "gaps at the contact points, and their compliances",
    "Unilateral contact": "which of the points touch, and with what forces",
    SEARCH: "elements, chains and compliances again until borders sit on the edges; how pressures change on the way",
    WHOLE: "from the scene to the solution",
    QUANTITIES: "all that the report asks of the solution",
}


@dataclass(frozen=True)
class Part:
    """One part of a solve.

    Attributes
    ----------
    prepare : makes what the work needs, untimed
    work : what is timed, given what was prepared
    """

    prepare: Callable[[], Any]
    work: Callable[[Any], object]


def nothing() -> None:
    """Nothing need be prepared."""


def parts(name: str = CASE, level: int = LEVEL, order: int = ORDER) -> dict[str, Part]:
    """The parts of one solve of a case by name, in their order; the whole and the quantities come last.

    The border search is timed with one contact system and its solution, which are parts of their own.
    """
    case = load_case(name)
    scene, points = case.scene, evaluation_points(case)
    mirrors = scene_mirrors(scene)
    meshes = {rod.name: natural_mesh(scene, rod, level, order) for rod in scene.rods}
    kinds: dict[Any, None] = {}
    lengths: dict[Any, set[float]] = {}
    for rod in scene.rods:
        # As the solver has it: rods of one shape share their elements whatever their modulus.
        fields = Fields(level, *mirrors[rod.name])
        kind = (rod.section, per_axial_modulus(rod.material), fields, darboux(rod.centre_line))
        kinds[kind] = None
        lengths.setdefault(kind, set()).update(float(f"{length:.11e}") for length in np.diff(meshes[rod.name].borders))

    def families() -> list[Any]:
        return [
            element_family(
                order, fields, section_stiffness(section, material, fields, turning), reversible=turning[2] == 0.0
            )
            for section, material, fields, turning in kinds
        ]

    def elements(families: list[Any]) -> None:
        for family, kind in zip(families, kinds, strict=True):
            for length in lengths[kind]:
                condensed_element(family, length)

    def assemble(store: ElementStore) -> None:
        for rod in scene.rods:
            assembled_rod(scene, rod, mirrors[rod.name], meshes[rod.name], store)

    def store_with_elements() -> ElementStore:
        store = store_with_chains()
        store.chains.clear()
        return store

    def store_with_chains() -> ElementStore:
        store = ElementStore()
        assemble(store)
        return store

    def system_of(store: ElementStore) -> ContactSystem:
        return contact_system(scene, mirrors, meshes, store)

    def looked(store: ElementStore) -> ContactSystem:
        lowest = {name: replace(mesh, levels=np.ones_like(mesh.levels)) for name, mesh in meshes.items()}
        return contact_system(scene, mirrors, lowest, store)

    def prepared_search() -> tuple[ElementStore, ContactSystem]:
        store = ElementStore()
        return store, looked(store)

    def search(prepared: tuple[ElementStore, ContactSystem]) -> None:
        store, system = prepared
        moved_contact(scene, meshes, system, lambda placed: contact_system(scene, mirrors, placed, store))

    solution = rm.solve(scene, level, order)
    return {
        LOOK: Part(ElementStore, looked),
        "Section matrices": Part(nothing, lambda _: families()),
        "Elements": Part(families, elements),
        "Chains": Part(store_with_elements, assemble),
        "Contact points": Part(store_with_chains, system_of),
        "Unilateral contact": Part(
            lambda: system_of(ElementStore()),
            lambda system: unilateral_contact(system.problem),
        ),
        SEARCH: Part(prepared_search, search),
        WHOLE: Part(nothing, lambda _: rm.solve(scene, level, order)),
        QUANTITIES: Part(
            nothing,
            lambda _: evaluate(solution, points.stations, points.stress_points),
        ),
    }


@dataclass(frozen=True)
class Breakdown:
    """Processor seconds of the parts of one solve.

    Attributes
    ----------
    case : its name
    contact_solutions : spent on the way
    first : seconds of the first solve in a new process
    timings : by the parts' names; of the border search without the first contact system and its solution
    """

    case: str
    level: int
    order: int
    outcome: str
    contact_solutions: int
    first: float
    timings: Mapping[str, Timing]

    @property
    def whole(self) -> Timing:
        """Seconds of a whole solve."""
        return self.timings[WHOLE]

    @property
    def inside(self) -> dict[str, Timing]:
        """The parts that make up the solve."""
        return {name: timing for name, timing in self.timings.items() if name not in (WHOLE, QUANTITIES)}

    @property
    def rest(self) -> float:
        """What of a whole solve's median its parts do not explain, s; negative where noise does."""
        return self.whole.median - sum(timing.median for timing in self.inside.values())


def measured_parts(given: int, progress: Progress) -> Breakdown:
    """Time every part `given` times, in turn, so that a slow spell of the machine meets them all."""
    del progress
    scene = load_case(CASE).scene
    first = once(rm.solve, scene, LEVEL, ORDER)
    solution = rm.solve(scene, LEVEL, ORDER)
    measured = parts()
    seconds: dict[str, list[float]] = {name: [] for name in measured}
    for _ in range(given):
        for name, part in measured.items():
            prepared = part.prepare()
            seconds[name].append(once(part.work, prepared))
    apart = [seconds[name] for name in measured if name not in (LOOK, SEARCH, WHOLE, QUANTITIES)]
    seconds[SEARCH] = [search - sum(others) for search, *others in zip(seconds[SEARCH], *apart, strict=True)]
    timings = {name: Timing(tuple(values)) for name, values in seconds.items()}
    return Breakdown(CASE, LEVEL, ORDER, solution.outcome, solution.contact_solutions, first, timings)
