"""The paper's two cantilevers, one lying on the other, with what sweeps drive, and beam theory's answer for them."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cache

import numpy as np
from numpy.typing import NDArray

import rodmodel
from cases.loader import load_case
from cases.scene import Material, Rectangle, Scene, SectionForce
from rodmodel.assembly import ElementStore
from rodmodel.borders import natural_mesh
from rodmodel.contact import ContactProblem, unilateral_contact
from rodmodel.mesh import RodMesh
from rodmodel.section import axial_modulus
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system

Array = NDArray[np.float64]

CASE = "two-cantilevers-e50-g0"
LEVEL, ORDER = 4, 4
# Of the case: where the zone begins and ends, where the upper bar is loaded and clamped, mm along X
START, END, LOADED, CLAMPED = 200.0, 300.0, 366.67, 500.0
RATIO, FORCE = 0.25, 1000.0
PENALTY = 1e6


@cache
def _case() -> Scene:
    return load_case(CASE).scene


def two_bars(ratio: float = RATIO, gap: float = 0.0, penalty: float | None = PENALTY, force: float = FORCE) -> Scene:
    """The scene.

    Parameters
    ----------
    ratio : Young's modulus of the upper bar over that of the lower one
    gap : mm
    penalty : N/mm^3; None for the solver's own
    force : downwards on the upper bar, N
    """
    scene = _case()
    lower, upper = scene.rods
    load = scene.loads[0]
    # as the case file has them
    assert isinstance(upper.material, Material)
    assert isinstance(load, SectionForce)
    young = ratio * axial_modulus(lower.material)
    upper = replace(upper, material=replace(upper.material, young_modulus=young))
    return replace(
        scene,
        rods=(lower, upper),
        loads=(replace(load, force=(0.0, -force, 0.0)),),
        contacts=(replace(scene.contacts[0], gap=gap, penalty=penalty),),
    )


@dataclass(frozen=True)
class Answer:
    """What a contact solution comes to.

    Attributes
    ----------
    force : N
    penetration : largest, mm
    edge : where the last stretch in contact ends, mm; nan without contact
    condition : of the matrix of the points in contact
    solutions, active_sets : spent on borders, and tried by the last contact solution
    """

    outcome: str
    force: float
    penetration: float
    edge: float
    condition: float
    solutions: int
    active_sets: int


def answer(scene: Scene, *, multipliers: bool = True) -> Answer:
    """Solve and say what came of it."""
    found = rodmodel.solve(scene, LEVEL, ORDER, multipliers=multipliers)
    edge = found.stretches[-1].end if found.stretches else math.nan
    return said(found.outcome, found.system.problem, found.force, edge, found.contact_solutions)


def said(outcome: str, problem: ContactProblem, force: Array, edge: float, solutions: int) -> Answer:
    """What forces at the points of a contact problem come to."""
    joined = force > 0.0
    matrix = problem.compliance[np.ix_(joined, joined)] + np.diag(1.0 / problem.spring[joined])
    gap = problem.gap + problem.compliance @ force
    return Answer(
        outcome,
        float(force.sum()),
        max(0.0, -float(gap.min())),
        edge,
        float(np.linalg.cond(matrix)) if joined.any() else math.nan,
        solutions,
        unilateral_contact(problem).active_sets,
    )


def meshes(scene: Scene) -> dict[str, RodMesh]:
    """The rods' own elements, by name."""
    return {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}


def on_meshes(
    scene: Scene, placed: dict[str, RodMesh], store: ElementStore | None = None, *, multipliers: bool = True
) -> ContactSystem:
    """The contact system on given elements, whose borders stay."""
    return contact_system(scene, scene_mirrors(scene), placed, store or ElementStore(), (), multipliers)


def beam_theory(ratio: float, gap: float, force: float = FORCE) -> float:
    """Contact force of Euler's and Bernoulli's beams that touch at the corner of one of them, or not at all, N.

    nan where they touch in between: there beams ask for more than a force at a point. Cantilevers under a force at a
    bend x^2 (3 a - x) / (6 E I) up to it and a^2 (3 x - a) / (6 E I) beyond.
    """
    scene = _case()
    section = scene.rods[0].section
    assert isinstance(section, Rectangle)
    lower = axial_modulus(scene.rods[0].material) * section.width * section.height**3 / 12.0
    upper = ratio * lower

    def bend(at: float, by: float, stiffness: float) -> float:
        near, far = sorted((at, by))
        return near**2 * (3.0 * far - near) / (6.0 * stiffness)

    load = CLAMPED - LOADED

    def distance(at: float, pressed: float, by: float) -> float:
        """Of the two bars at X = at, pressed together by a force at X = by."""
        down = force * bend(CLAMPED - at, load, upper) - pressed * bend(CLAMPED - at, CLAMPED - by, upper)
        return gap - down + pressed * bend(at, by, lower)

    if min(distance(START, 0.0, START), distance(END, 0.0, END)) >= 0.0:
        return 0.0
    for corner, other in ((START, END), (END, START)):
        give = distance(corner, 1.0, corner) - distance(corner, 0.0, corner)
        pressed = -distance(corner, 0.0, corner) / give
        between = np.linspace(corner, other, 41)[1:]
        if pressed > 0.0 and all(distance(float(at), pressed, corner) >= 0.0 for at in between):
            return pressed
    return math.nan
