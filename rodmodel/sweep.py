"""One scene after another that differ little: every one is solved, with what the ones before have left.

Three things are taken over. Elements, as everywhere. Whole rods, reduced to their contact points, where their elements
are the same and only moduli, loads or gaps differ: an isotropic rod's compliance goes with 1/E. And the edges of
contact, continued over the scenes before to where the search then begins. Where and how the search looks first is that
of a solution of its own, so that the elements and the answer are, too, up to the tolerance of the edges.
"""

from __future__ import annotations

import time
from collections.abc import Hashable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import Load, Scene
from rodmodel.assembly import (
    ElementStore,
    Functionals,
    Mirrors,
    compliance,
    cross_compliance,
    functionals,
    given_displacement,
    last_replaced,
    scaled,
)
from rodmodel.borders import Edge, natural_mesh
from rodmodel.contact import unilateral_contact
from rodmodel.edges import EdgeSearch
from rodmodel.joints import Loose
from rodmodel.loads import load_parts
from rodmodel.loose import loose_rods
from rodmodel.mesh import RodMesh, lowest
from rodmodel.section import axial_modulus, per_axial_modulus
from rodmodel.solution import Solution
from rodmodel.solver import Grades, MovedContact, SystemOn, checked, grades_of, moved_contact, solution_of
from rodmodel.stiffness import Element
from rodmodel.stretches import Stretch, stretches_in_contact
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system, joined_system

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# Systems kept, and elements: some 0.2 MB each at h5, p = 6.
MOST_SYSTEMS, MOST_ELEMENTS = 8, 200
# Edges are continued over so many scenes before, by a polynomial.
MOST_PAST = 4
# A scene farther from the last than this many times what lies between those before begins at the last one's edges.
FARTHEST = 2.0
# Decimal places of borders, mm, that tell meshes apart, and of positions that edges are continued to.
DIGITS, PLACES = 9, 6


@dataclass(frozen=True, eq=False)
class Swept:
    """A solution of a sweep.

    Attributes
    ----------
    followed : whether the edges of contact were continued from the scenes before, or there was nothing to follow; False
        where the search had to begin anew
    """

    solution: Solution
    followed: bool


def sweep(
    scenes: Iterable[tuple[float, Scene]], level: Grades = 5, order: Grades = 6, multipliers: bool = True
) -> Iterator[Swept]:
    """Solve scenes in turn.

    Parameters
    ----------
    scenes : each with a number along which its answer changes smoothly, such as the modulus that is varied
    level, order, multipliers : as in `solve`

    Raises
    ------
    SceneError, ValueError
        as `solve`.
    """
    store, look, trail = SystemStore(level, order, multipliers), Look(), Trail()
    for at, scene in scenes:
        begin = time.perf_counter()
        systems, meshes = store.systems(scene), store.common(scene).meshes
        ready = time.perf_counter()
        stretches = look.stretches(systems(lowest(meshes))) if scene.contacts else ()
        contact = moved_contact(scene, meshes, stretches, systems, trail.at(at))
        followed = trail.followed
        if followed and contact.search is None:
            # What was continued may have led astray.
            contact, followed = moved_contact(scene, meshes, stretches, systems), False
        trail.add(at, contact)
        solution = solution_of(scene, contact, begin, ready)
        yield Swept(store.checked(solution), followed or contact.search is None)
        store.forget()


@dataclass(eq=False)
class Look:
    """Where contact seems to be on the borders as they are given, beginning with the points of the scene before."""

    _touching: BoolArray = field(default_factory=lambda: np.empty(0, dtype=bool))

    def stretches(self, system: ContactSystem) -> tuple[Stretch, ...]:
        """Stretches in contact as a solution on the system's elements shows them."""
        guess = self._touching if len(self._touching) == len(system.problem.gap) else None
        forces = unilateral_contact(system.problem, settled=False, guess=guess)
        self._touching = forces.force > 0.0
        return stretches_in_contact(system, forces)


@dataclass(frozen=True, eq=False)
class Step:
    """Edges found in one scene: where the scene stands in the sweep, and what the search ended with."""

    at: float
    edges: tuple[Edge, ...]
    search: EdgeSearch


@dataclass(eq=False)
class Trail:
    """Edges of the last scenes, continued to the next one.

    Attributes
    ----------
    followed : whether the last search began where they lead
    """

    followed: bool = False
    _next: float = 0.0
    _steps: list[Step] = field(default_factory=list)
    _touching: BoolArray = field(default_factory=lambda: np.empty(0, dtype=bool))

    def at(self, number: float) -> Trail:
        """Make ready for the scene at a number."""
        self._next, self.followed = number, False
        return self

    def edges(self, edges: Sequence[Edge], positions: Array) -> tuple[Array, Array | None]:
        """Where the search for edges begins, and its slopes: where the trail leads if it is that of these edges."""
        steps = [step for step in self._steps if step.edges == tuple(edges)]
        if not steps or steps[-1] is not self._steps[-1]:
            return positions, None
        self.followed = True
        apart = max((abs(late.at - early.at) for early, late in pairwise(steps)), default=0.0)
        near = abs(self._next - steps[-1].at) <= FARTHEST * apart
        return _continued(steps if near else steps[-1:], self._next), steps[-1].search.jacobian

    def points(self, held: BoolArray | None) -> BoolArray | None:
        """The points in contact in the scene before, where as many may be."""
        return self._touching if held is not None and self._touching.shape == held.shape else held

    def add(self, number: float, contact: MovedContact) -> None:
        """Note the edges of a solved scene."""
        self._touching = contact.forces.force > 0.0
        if contact.search is None:
            self._steps = []
            return
        step = Step(number, contact.edges, contact.search)
        same = [past for past in self._steps if past.edges == step.edges and past.at != number]
        self._steps = [*same[1 - MOST_PAST :], step]


def _continued(steps: Sequence[Step], number: float) -> Array:
    """The polynomial through the edges of all steps at a number (Lagrange's form), mm, shape (n_edges,)."""
    places = np.array([step.at for step in steps])
    weights = [
        np.prod((number - np.delete(places, index)) / (places[index] - np.delete(places, index)))
        for index in range(len(places))
    ]
    # Digits beyond those of the mesh keys would grow from scene to scene where edges stay.
    return np.asarray((weights @ np.array([step.search.root for step in steps])).round(PLACES))


@dataclass(eq=False)
class KeptSystem:
    """A contact system to be used again, and the compliance of its rods, by name, once asked for."""

    system: ContactSystem
    responses: dict[str, Array] = field(default_factory=dict)

    def response(self, name: str) -> Array:
        """Compliance of a rod's functionals."""
        if name not in self.responses:
            self.responses[name] = compliance(self.system.functionals[name])
        return self.responses[name]


@dataclass(frozen=True, eq=False)
class Common:
    """What scenes have in common that differ in moduli, loads of the same directions, and gaps.

    Attributes
    ----------
    shape : tells such scenes from others
    reusable : whether a rod's compliance goes with its modulus: beds and joints come in between
    """

    shape: Hashable
    mirrors: Mapping[str, Mirrors]
    loose: Sequence[Loose]
    meshes: dict[str, RodMesh]
    reusable: bool


@dataclass(eq=False)
class SystemStore:
    """Elements, and the contact systems of the last meshes."""

    level: Grades
    order: Grades
    multipliers: bool
    _common: Common | None = None
    _sound: tuple[Element, ...] | None = None
    _elements: ElementStore = field(default_factory=ElementStore)
    _kept: dict[Hashable, KeptSystem] = field(default_factory=dict)

    def common(self, scene: Scene) -> Common:
        """Mirrors, natural meshes and the like of a scene.

        Raises
        ------
        SceneError
            if supports, joints and beds leave a rod loose that no contact could hold.
        """
        shape = _shape(scene)
        if self._common is None or self._common.shape != shape:
            mirrors = scene_mirrors(scene)
            loose = loose_rods(scene, mirrors)
            meshes = {
                rod.name: natural_mesh(scene, rod, grades_of(self.level, rod), grades_of(self.order, rod))
                for rod in scene.rods
            }
            self._common = Common(shape, mirrors, loose, meshes, not (loose or scene.joints or scene.beds))
        return self._common

    def systems(self, scene: Scene) -> SystemOn:
        """What makes the scene's contact systems, as those of `rodmodel.solver.systems`."""
        common = self.common(scene)

        def system_on(meshes: dict[str, RodMesh]) -> ContactSystem:
            key = (common.shape, *(_mesh_key(meshes[rod.name]) for rod in scene.rods))
            kept = self._kept.pop(key, None) if common.reusable else None
            if kept is None:
                system = contact_system(scene, common.mirrors, meshes, self._elements, common.loose, self.multipliers)
                kept = KeptSystem(system)
            else:
                system = _with_scene(kept, scene, self.multipliers)
            if common.reusable and not any(given_displacement(rod) for rod in system.rods.values()):
                self._kept[key] = kept
            return system

        return system_on

    def checked(self, solution: Solution) -> Solution:
        """The solution, refused if round-off has falsified it: that is a matter of its elements, looked at once."""
        elements = tuple(element for rod in solution.system.rods.values() for element in rod.elements)
        if elements == self._sound:  # elements are equal to themselves alone
            return solution
        result = checked(solution)
        self._sound = elements if result.outcome == "converged" else None
        return result

    def forget(self) -> None:
        """Let go of the systems and elements that were not used for long."""
        for key in list(self._kept)[:-MOST_SYSTEMS]:
            del self._kept[key]
        self._elements.forget(MOST_ELEMENTS)


def _shape(scene: Scene) -> Hashable:
    """All that elements, symmetry and compliance at the contact points depend on, but for moduli and levels.

    Of loads it is where they act and in which directions, of gaps whether they are drawn.
    """
    rods = tuple(
        (rod.name, rod.centre_line, rod.section, per_axial_modulus(rod.material), rod.element_borders)
        for rod in scene.rods
    )
    loads = tuple(tuple(_direction(value) for value in vars(load).values()) for load in scene.loads)
    pairs = tuple((pair.name, pair.first, pair.second, pair.zone, pair.gap == "drawn") for pair in scene.contacts)
    return rods, scene.supports, scene.joints, scene.beds, loads, pairs


def _direction(value: object) -> object:
    """Signs of a vector, which is a force, moment or acceleration; anything else as it is."""
    return tuple(np.sign(value).tolist()) if isinstance(value, tuple) else value


def _mesh_key(mesh: RodMesh) -> Hashable:
    return mesh.borders.round(DIGITS).tobytes(), mesh.levels.tobytes(), mesh.orders.tobytes()


def _with_scene(kept: KeptSystem, scene: Scene, multipliers: bool) -> ContactSystem:
    """A kept system with the moduli, loads and gaps of another scene."""
    old = kept.system
    rods, responses, softer, loads = {}, {}, {}, {}
    for rod in scene.rods:
        name, assembled = rod.name, old.rods[rod.name]
        rods[name] = replace(assembled, rod=rod, chain=assembled.chain.with_modulus(axial_modulus(rod.material)))
        softer[name] = axial_modulus(assembled.rod.material) / axial_modulus(rod.material)
        responses[name] = softer[name] * kept.response(name)
        if _loads(scene, name) != _loads(old.scene, name):
            loads[name] = functionals(assembled, load_parts(assembled, scene.loads, column=0), count=1)
            on_points = cross_compliance(old.functionals[name], loads[name])
            responses[name][:-1, -1] = softer[name] * on_points[:-1, 0]
    found = ScaledFunctionals(old.functionals, softer, loads)
    return joined_system(scene, rods, old.grids, found, old.places, responses, None, multipliers)


@dataclass(frozen=True, eq=False)
class ScaledFunctionals(Mapping[str, Functionals]):
    """Functionals of rods, made when they are asked for: of the same rods with other moduli and loads.

    Attributes
    ----------
    softer : by rod name, modulus of the rods they are of by that of the others
    loads : of rods with another load, on the rods they are of
    """

    of: Mapping[str, Functionals]
    softer: Mapping[str, float]
    loads: Mapping[str, Functionals]

    def __getitem__(self, name: str) -> Functionals:
        """Functionals of one rod."""
        found = self.of[name] if name not in self.loads else last_replaced(self.of[name], self.loads[name])
        return scaled(found, float(np.sqrt(self.softer[name])))

    def __iter__(self) -> Iterator[str]:
        """Names of the rods."""
        return iter(self.of)

    def __len__(self) -> int:
        """How many rods there are."""
        return len(self.of)


def _loads(scene: Scene, rod: str) -> list[Load]:
    return [load for load in scene.loads if load.rod == rod]
