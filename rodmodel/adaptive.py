"""The solver's own choice of level, order and elements for a wanted tolerance, and what error it then expects.

Solve at a low level on elements that are short where fields are steep; raise levels and orders where the highest
functions hold energy (`rodmodel.indicators`); go on until the differences from step to step, continued over all levels
to come, are within the tolerance. Nothing outside the rod model is asked.
"""

from __future__ import annotations

import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from rodmodel.adapt import graded
from rodmodel.assembly import ElementStore
from rodmodel.borders import natural_mesh
from rodmodel.goals import Goal, goals
from rodmodel.indicators import RodIndicators, indicators, pressed_elements
from rodmodel.mesh import RodMesh, lowest
from rodmodel.remaining import remaining_errors
from rodmodel.solution import Solution
from rodmodel.solver import checked, moved_contact, solution_of, systems, unmoved_contact
from rodmodel.stretches import Stretch

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

FIRST_LEVEL, FIRST_ORDER = 2, 4
LEVEL_STEP, ORDER_STEP = 2, 2
HIGHEST_LEVEL, HIGHEST_ORDER = 8, 10
MOST_STEPS = 6
# From this tolerance on borders need not move onto the edges of contact: what that changes is some 0.01 %, of small
# moments 0.3 %.
UNMOVED_ENOUGH = 5e-3
# Steps after which what the last level would reach is believed, and by how much it may miss the tolerance.
CERTAIN, HOPELESS = 3, 1.5
# Energy in highest functions that need not be raised, as a part of the tolerance.
BUDGET = 0.03
# Tolerances that make sense: below, round-off and the tolerance of contact edges show; above, nothing is asked for.
SMALLEST, LARGEST = 1e-5, 0.2


@dataclass(frozen=True)
class Estimate:
    """A goal, its value in the last step, and how far the rod model's limit may be from it, in the goal's unit."""

    goal: Goal
    value: float
    error: float
    scale: float

    @property
    def relative(self) -> float:
        """The error as a part of the goal's scale: its value, or that of the largest of its kind where it is tiny."""
        return self.error / self.scale


@dataclass(frozen=True, eq=False)
class Step:
    """One solution on the way.

    Attributes
    ----------
    meshes : elements by rod name, as contact moved them
    values : of the goals
    seconds : that it took, wall clock
    """

    meshes: Mapping[str, RodMesh]
    values: Mapping[Goal, float]
    outcome: str
    unknowns: int
    seconds: float

    @property
    def level(self) -> int:
        """Highest level of any element."""
        return max(int(mesh.levels.max()) for mesh in self.meshes.values())


@dataclass(frozen=True, eq=False)
class AdaptiveSolution:
    """What `solve_to` found.

    Attributes
    ----------
    solution : of the last step
    tolerance : asked for, relative
    outcome : 'converged', 'refused: ...' where the tolerance cannot be reached, or that of a solution that did not
        converge
    estimates : of every goal
    steps : all solutions
    """

    solution: Solution
    tolerance: float
    outcome: str
    estimates: tuple[Estimate, ...]
    steps: tuple[Step, ...]

    @property
    def seconds(self) -> float:
        """Of all steps."""
        return sum(step.seconds for step in self.steps)


def solve_to(scene: Scene, tolerance: float) -> AdaptiveSolution:
    """Solve a scene to a tolerance, with levels, orders and elements of the solver's choice.

    Parameters
    ----------
    tolerance : largest relative error of every contact force, largest deflection and clamp moment; contact edges come
        with an estimate, too, but ask for nothing

    Raises
    ------
    SceneError
        if supports, joints and beds leave a rod loose that no contact could hold.
    ValueError
        if the tolerance is out of reach.
    """
    if not SMALLEST <= tolerance <= LARGEST:
        raise ValueError(f"tolerance: found {tolerance:g}; give {SMALLEST:g} to {LARGEST:g}")
    finer = graded(scene)
    meshes = {rod.name: natural_mesh(finer, rod, FIRST_LEVEL, FIRST_ORDER) for rod in finer.rods}
    system_on = systems(scene, ElementStore())
    steps: list[Step] = []
    stretches: tuple[Stretch, ...] = ()
    while True:
        begin = time.perf_counter()
        if len(steps) == 0 or tolerance > UNMOVED_ENOUGH:
            contact = unmoved_contact(system_on(meshes))
        else:
            # Where contact is shows most reliably at the lowest level.
            look = stretches if len(steps) > 1 else system_on(lowest(meshes))
            contact = moved_contact(scene, meshes, look, system_on)
        solution = solution_of(scene, contact, begin, begin)
        stretches = solution.stretches
        meshes = {name: _mesh_of(solution, name) for name in meshes}
        unknowns, found = solution.cost.unknowns, goals(solution)
        steps.append(Step(meshes, found, solution.outcome, unknowns, time.perf_counter() - begin))
        if solution.outcome != "converged":
            return AdaptiveSolution(solution, tolerance, solution.outcome, (), tuple(steps))
        estimates, power = estimated(steps)
        worst = max((each for each in estimates if each.goal.kind != "contact edge"), key=lambda each: each.relative)
        if worst.relative <= tolerance:
            solution = checked(solution)
            return AdaptiveSolution(solution, tolerance, solution.outcome, estimates, tuple(steps))
        highest = steps[-1].level
        at_best = worst.relative * (highest / HIGHEST_LEVEL) ** power
        raised = None
        if len(steps) < MOST_STEPS and (len(steps) < CERTAIN or at_best <= tolerance * HOPELESS):
            step = level_step(highest, worst.relative / tolerance, power)
            raised = next_meshes(meshes, indicators(solution), pressed_elements(solution), tolerance, step)
        if raised is None:
            outcome = _refusal(worst, highest, at_best)
            return AdaptiveSolution(solution, tolerance, outcome, estimates, tuple(steps))
        meshes = raised


def _mesh_of(solution: Solution, rod: str) -> RodMesh:
    assembled = solution.system.rods[rod]
    levels = np.array([element.fields.level for element in assembled.elements])
    return RodMesh(assembled.borders, levels, np.array([element.order for element in assembled.elements]))


def _refusal(worst: Estimate, level: int, at_best: float) -> str:
    found = f"the {worst.goal.kind} of '{worst.goal.of}' is uncertain by {_percent(worst.relative)} at h{level}"
    best = f" and would be by {_percent(at_best)} at h{HIGHEST_LEVEL}" if level < HIGHEST_LEVEL else ""
    return f"refused: {found}{best}; polynomials over the section do not get there, a 3D solution is needed"


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if share < 1.0 else "100 % or more"


def estimated(steps: Sequence[Step]) -> tuple[tuple[Estimate, ...], float]:
    """Every goal of the last step with what the steps say of its error, and the power of the level it falls with.

    All is unknown after a single step.
    """
    last = steps[-1].values
    scales = {goal: _scale(goal, last) for goal in last}
    # Of steps with the same highest level, the last counts: what they differ by tells nothing of levels to come.
    reached = {step.level: step.values for step in steps}
    history = [[values.get(goal, np.nan) / scales[goal] for goal in last] for values in reached.values()]
    edges = np.array([goal.kind == "contact edge" for goal in last], dtype=bool)
    errors = np.empty(len(last))
    errors[edges], _ = remaining_errors(list(reached), np.array(history)[:, edges])
    errors[~edges], power = remaining_errors(list(reached), np.array(history)[:, ~edges])
    estimates = tuple(
        Estimate(goal, value, float(error) * scales[goal], scales[goal])
        for (goal, value), error in zip(last.items(), errors, strict=True)
    )
    return estimates, power


def _scale(goal: Goal, values: Mapping[Goal, float]) -> float:
    if goal.kind == "contact edge":
        return 1.0
    alike = max(abs(value) for other, value in values.items() if other.kind == goal.kind)
    return max(abs(values[goal]), 1e-3 * alike) or 1.0


def level_step(level: int, excess: float, power: float) -> int:
    """By how much to raise the highest level: as far as its error must fall, but not before two steps tell of it.

    excess : the error over the tolerance
    """
    step = LEVEL_STEP
    while np.isfinite(excess) and level + step < HIGHEST_LEVEL and excess > (1.0 + step / level) ** power:
        step += LEVEL_STEP
    return step


def next_meshes(
    meshes: Mapping[str, RodMesh],
    shown: Mapping[str, RodIndicators],
    pressed: Mapping[str, BoolArray],
    tolerance: float,
    level_step: int,
) -> dict[str, RodMesh] | None:
    """Raise levels and orders where much energy is in the highest functions; None where all are at the highest.

    pressed : elements that contact presses on, whose levels are raised in any case: they hold little energy but shape
        the pressure and its edges
    """
    over_section = np.concatenate([each.over_section for each in shown.values()])
    along = np.concatenate([each.along for each in shown.values()])
    for budget in (BUDGET * tolerance, 0.1 * BUDGET * tolerance, -1.0):
        # Where little is in the highest functions, but steps still differ, more is raised, and at last everything.
        limits = _limit(over_section, budget), _limit(along, budget)
        raised = {name: _raised(mesh, shown[name], pressed[name], limits, level_step) for name, mesh in meshes.items()}
        if any(
            (raised[name].levels > mesh.levels).any() or (raised[name].orders > mesh.orders).any()
            for name, mesh in meshes.items()
        ):
            return raised
    return None


def _raised(
    mesh: RodMesh, shown: RodIndicators, pressed: BoolArray, limits: tuple[float, float], level_step: int
) -> RodMesh:
    levels = mesh.levels + level_step * ((shown.over_section > limits[0]) | pressed)
    orders = mesh.orders + ORDER_STEP * (shown.along > limits[1])
    return replace(mesh, levels=np.minimum(levels, HIGHEST_LEVEL), orders=np.minimum(orders, HIGHEST_ORDER))


def _limit(energy: Array, budget: float) -> float:
    """Energy of a single element up to which all together hold no more than the budget."""
    ascending = np.sort(energy)
    kept = np.flatnonzero(np.cumsum(ascending) <= budget)
    return float(ascending[kept[-1]]) if len(kept) else -1.0
