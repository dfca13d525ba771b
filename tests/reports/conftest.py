"""A solution in closed form, so that what reads solutions can be tested before and without any solver."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import (
    Clamp,
    ContactPair,
    End,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SectionForce,
)
from reports.case_comparison import case_comparisons, evaluation_points
from reports.comparison import Extrapolation
from reports.processes import ProcessFailed, Progress, in_own_process
from reports.quantities import Quantities, evaluate
from reports.runner import CaseRun, Run
from reports.solution import Array, Model
from reports.surface import PressedFace, RodSurface, Surface, skin

LENGTH = 300.0
SIDE = 15.0
INERTIA = SIDE**4 / 12.0


@dataclass(frozen=True)
class FakeCost:
    """Cost with distinguishable numbers."""

    unknowns: int = 4536
    setup_seconds: float = 0.01
    solve_seconds: float = 0.02


@dataclass(frozen=True)
class FakeContact:
    """Both what `contact_points` and what `contact_profile` return."""

    station: Array
    position: Array
    normal: Array
    gap: Array
    force: Array
    middle: Array
    mean: Array
    outer: Array


@dataclass(frozen=True)
class BeamSolution:
    """Euler-Bernoulli cantilevers under point forces along e2; the contact force is prescribed.

    Deflection of a cantilever under a force Q at distance a from the clamp (any textbook):
    Q s^2 (3 a - s) / (6 E I) up to the force, Q a^2 (3 s - a) / (6 E I) beyond; M1 = -E I v''.
    """

    scene: Scene
    contact: FakeContact
    outcome: str = "converged"
    contact_solutions: int = 5
    active_sets: int = 9
    strain_energy: float = 1.0
    cost: FakeCost = field(default_factory=FakeCost)

    def _forces(self, rod: str) -> tuple[Array, Array]:
        """Distances from the clamp, mm, and forces along e2 (here Y), N."""
        length = self.scene.rod(rod).length
        origin = self.scene.rod(rod).centre_line.start[0]
        loads = [(load.position, load.force[1]) for load in self.scene.loads if load.rod == rod]
        pair = self.scene.contacts[0]
        sign = -1.0 if pair.first.rod == rod else 1.0
        station = np.array([s for s, _ in loads] + list(self.contact.position[0] - origin))
        force = np.array([f for _, f in loads] + list(sign * self.contact.force))
        return (station if self._clamp(rod) == "start" else length - station), force

    def _clamp(self, rod: str) -> End:
        return next(clamp.end for clamp in self.scene.supports if clamp.rod == rod)

    def _from_clamp(self, rod: str, station: Array) -> Array:
        return station if self._clamp(rod) == "start" else self.scene.rod(rod).length - station

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        """Both rods lie along X with e2 = Y, so that e1 = e2 x t = -Z."""
        start = np.array(self.scene.rod(rod).centre_line.start)
        axes = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
        return start[:, None] + np.outer(axes[2], station), np.tile(axes, (len(station), 1, 1))

    def displacement(self, rod: str, station: Array) -> Array:
        s = self._from_clamp(rod, station)[:, None]
        a, force = self._forces(rod)
        stiffness = self.scene.rod(rod).material.young_modulus * INERTIA
        near, far = s**2 * (3 * a - s), a**2 * (3 * s - a)
        deflection = np.where(s < a, near, far) @ force / (6 * stiffness)
        return np.vstack([np.zeros_like(deflection), deflection, np.zeros_like(deflection)])

    def section_resultants(self, rod: str, station: Array) -> Array:
        s = self._from_clamp(rod, station)[:, None]
        a, force = self._forces(rod)
        beyond = s <= a
        sign = 1.0 if self._clamp(rod) == "start" else -1.0
        result = np.zeros((6, len(station)))
        result[2] = sign * (beyond @ force)
        result[3] = -np.where(beyond, a - s, 0.0) @ force
        return result

    def stress(self, rod: str, points: Array) -> Array:
        result = np.zeros((6, points.shape[1]))
        result[2] = self.section_resultants(rod, points[2])[3] * points[1] / INERTIA
        return result

    def reaction(self, rod: str, station: float) -> Array:
        a, force = self._forces(rod)
        sign = 1.0 if self._clamp(rod) == "start" else -1.0
        return np.array([0.0, -force.sum(), 0.0, 0.0, 0.0, -sign * (a @ force)])

    def contact_points(self, pair: str) -> FakeContact:
        return self.contact

    def contact_profile(self, pair: str) -> FakeContact:
        return self.contact


def _scene(young_modulus_upper: float = 50_000.0) -> Scene:
    section = Rectangle(SIDE, SIDE)
    up = (0.0, 1.0, 0.0)
    lower = Rod(
        "lower",
        Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), up),
        section,
        Material(200_000.0, 0.3),
        (0.0, 66.67, 133.33, 200.0, 233.33, 266.67, 300.0),
    )
    upper = Rod(
        "upper",
        Line((200.0, 15.0, 0.0), (500.0, 15.0, 0.0), up),
        section,
        Material(young_modulus_upper, 0.3),
        (0.0, 33.33, 66.67, 100.0, 166.67, 233.33, 300.0),
    )
    pair = ContactPair("overlap", RodFace("lower", "top"), RodFace("upper", "bottom"), (200.0, 300.0), 0.0, 1e6)
    return Scene(
        "two-cantilevers",
        (lower, upper),
        (Clamp("lower", "start"), Clamp("upper", "end")),
        (SectionForce("upper", 166.67, (0.0, -1000.0, 0.0)),),
        (pair,),
    )


def _hertz_contact(centre: float, half_width: float, force: float, stations: int = 401) -> FakeContact:
    """Hertz's profile p = p0 sqrt(1 - (X - centre)^2 / half_width^2) on the zone X = 200 .. 300 mm."""
    x = np.linspace(200.0, 300.0, stations)
    shape = np.sqrt(np.maximum(0.0, 1.0 - ((x - centre) / half_width) ** 2))
    nodal = force * shape / shape.sum()
    pressure = shape * 2.0 * force / (np.pi * half_width * SIDE)
    return FakeContact(
        station=x,
        position=np.vstack([x, np.full_like(x, SIDE / 2), np.zeros_like(x)]),
        normal=np.tile([[0.0], [1.0], [0.0]], stations),
        gap=np.where(shape > 0.0, -pressure / 1e6, 1e-3),
        force=nodal,
        middle=pressure,
        mean=pressure,
        outer=pressure,
    )


@pytest.fixture
def beam_scene() -> Scene:
    """The paper's two cantilevers."""
    return _scene()


@pytest.fixture
def hertz_contact() -> Callable[..., FakeContact]:
    """Contact of a given centre, half width (mm) and force (N)."""
    return _hertz_contact


@pytest.fixture
def beam_solution(beam_scene: Scene) -> Callable[..., BeamSolution]:
    """Closed-form solution for a contact of given centre, half width (mm) and force (N)."""

    def build(centre: float = 250.0, half_width: float = 12.0, force: float = 320.0, **changes: Any) -> BeamSolution:
        return BeamSolution(beam_scene, _hertz_contact(centre, half_width, force), **changes)

    return build


def _second_order(coarse: float, medium: float, fine: float) -> Extrapolation:
    """Richardson's extrapolation of second order with halved meshes."""
    del coarse
    return Extrapolation(fine + (fine - medium) / 3.0, abs(fine - medium), 2.0)


def _small(given: Sequence[tuple[Scene, Quantities]], progress: Progress) -> list[bytes]:
    from reports import picture

    picture.SIZE = (180, 70)  # most of the time goes into pixels
    return [picture.draw(scene, quantities).png for scene, quantities in given]


@pytest.fixture
def drawn() -> Callable[..., list[bytes]]:
    """Small pictures of scenes with their quantities, PNG, drawn in a process of their own."""

    def draw(*given: tuple[Scene, Quantities]) -> list[bytes]:
        try:
            return in_own_process(_small, given)
        except ProcessFailed as error:
            if "exit code" not in str(error):
                raise
            pytest.skip("VTK found no way to draw here and ended its process")

    return draw


@pytest.fixture(scope="session")
def case_run() -> CaseRun:
    """A case of the library as if solved: closed forms for the rod model and for three 3D meshes."""
    case = load_case("two-cantilevers-e20-g0")
    points = evaluation_points(case)

    def run(model: Model, force: float, level: int | None = None, order: int | None = None) -> Run:
        solution = BeamSolution(case.scene, _hertz_contact(250.0, 12.0, force))
        quantities = evaluate(solution, points.stations, points.stress_points)
        return Run(model, level, order, quantities, 0.05, 123.0)

    rod = run("rod", 320.0, 5, 6)
    references = tuple(run("reference", force) for force in (316.0, 319.0, 319.75))
    comparisons = case_comparisons(
        case, rod.quantities, [reference.quantities for reference in references], _second_order
    )
    return CaseRun(case, rod, references, comparisons)


@pytest.fixture(scope="session")
def drawn_run(case_run: CaseRun) -> CaseRun:
    """The same with surfaces to be drawn: plane sections, sigma_s = M1 y / I, and the pressure of the profile."""

    def drawn(run: Run) -> Run:
        rods = []
        for rod in case_run.case.scene.rods:
            found, (_, y, s) = run.quantities.rod(rod.name), skin(rod).places
            moved = np.array([np.interp(s, found.station, each) for each in found.displacement])
            rods.append(RodSurface(moved, np.interp(s, found.station, found.moment) * y / INERTIA))
        pressure = run.quantities.contacts[0].pressure
        x = np.tile(pressure.position, 2)
        z = np.repeat([-SIDE / 2, SIDE / 2], len(pressure.position))
        position = np.vstack([x, np.full_like(x, SIDE / 2), z])
        first = np.arange(len(pressure.position) - 1)
        second = first + len(pressure.position)
        triangles = np.vstack(
            [np.column_stack([first, first + 1, second]), np.column_stack([first + 1, second + 1, second])]
        )
        face = PressedFace("overlap", position, np.zeros_like(position), np.tile(pressure.middle, 2), triangles)
        return replace(run, surface=Surface(tuple(rods), (face,)))

    *coarse, finest = case_run.references
    return replace(case_run, rod=drawn(case_run.rod), references=(*coarse, drawn(finest)))
