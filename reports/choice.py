"""What the rod model chose by itself: how sure it is of every quantity, and why each element has its level."""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

from rich.table import Table

from cases.case import Case
from reports.case_comparison import evaluation_points
from reports.formatting import number, seconds
from reports.memory import peak_memory
from reports.quantities import evaluate
from reports.result import Choice, ElementChoice, GoalEstimate, StepCost
from reports.runner import Run
from reports.solution import Solution
from reports.tables import console
from rodmodel.adaptive import AdaptiveSolution, solve_to
from rodmodel.indicators import indicators, pressed_elements

# Characters of the picture of levels in a terminal.
WIDTH = 72


@dataclass(frozen=True)
class ChosenElement:
    """One element of a rod and what its level and order left over.

    Attributes
    ----------
    start, end : arc length, mm
    level, order : k of h_k and p
    over_section : energy in the fields of the two highest degrees, as a part of the energy of all rods
    along : energy that further orders would find, likewise
    pressed : whether contact presses on it, or next to it
    """

    start: float
    end: float
    level: int
    order: int
    over_section: float
    along: float
    pressed: bool

    @property
    def reason(self) -> str:
        """Why it has its level and order."""
        pressed = "contact presses on it or beside it; " if self.pressed else ""
        share = f"its fields of degree {self.level - 1} and {self.level} hold {100.0 * self.over_section:.2g} %"
        return f"{pressed}{share} of the energy, orders above {self.order} would find {100.0 * self.along:.2g} %"


def run_auto(case: Case, tolerance: float, solved: Callable[[Solution], None]) -> tuple[Run, AdaptiveSolution]:
    """Solve a case with the rod model to a tolerance.

    Set-up seconds are those of all steps but the last.

    Parameters
    ----------
    tolerance : relative, of contact forces, largest deflections and clamp moments
    solved : called with the solution

    Raises
    ------
    SceneError
        if the rod model cannot treat the scene.
    """
    points = evaluation_points(case)
    begin = time.perf_counter()
    found = solve_to(case.scene, tolerance)
    quantities = evaluate(found.solution, points.stations, points.stress_points)
    total = time.perf_counter() - begin
    solved(found.solution)
    last = found.steps[-1]
    quantities = replace(quantities, setup_seconds=found.seconds - last.seconds, solve_seconds=last.seconds)
    levels = {name: tuple(mesh.levels.tolist()) for name, mesh in last.meshes.items()}
    orders = {name: tuple(mesh.orders.tolist()) for name, mesh in last.meshes.items()}
    return Run("rod", levels, orders, quantities, total, peak_memory()), found


def chosen_elements(found: AdaptiveSolution) -> dict[str, tuple[ChosenElement, ...]]:
    """The elements of the last step by rod name."""
    shown, pressed = indicators(found.solution), pressed_elements(found.solution)
    result = {}
    for name, mesh in found.steps[-1].meshes.items():
        columns = (
            mesh.borders[:-1],
            mesh.borders[1:],
            mesh.levels,
            mesh.orders,
            shown[name].over_section,
            shown[name].along,
            pressed[name],
        )
        result[name] = tuple(
            ChosenElement(*values) for values in zip(*(column.tolist() for column in columns), strict=True)
        )
    return result


def choice_result(found: AdaptiveSolution) -> Choice:
    """The choice as the JSON object tells it."""
    return Choice(
        tolerance=found.tolerance,
        outcome=found.outcome,
        estimates=[
            GoalEstimate(
                kind=each.goal.kind,
                of=each.goal.of,
                unit=each.goal.unit,
                value=each.value,
                error=each.error if math.isfinite(each.error) else None,
            )
            for each in found.estimates
        ],
        elements={
            name: [
                ElementChoice(start=each.start, end=each.end, level=each.level, order=each.order, reason=each.reason)
                for each in elements
            ]
            for name, elements in chosen_elements(found).items()
        },
        steps=[StepCost(level=step.level, unknowns=step.unknowns, seconds=step.seconds) for step in found.steps],
    )


def print_choice(found: AdaptiveSolution) -> None:
    """Print how sure the rod model is of what it found, and its levels along the rods."""
    out = console()
    table = Table("quantity", "of", "value", "estimated error", "relative")
    for each in found.estimates:
        edge = each.goal.kind == "contact edge"
        relative = "" if edge else f"{100.0 * each.relative:.2g} %"
        value = f"{number(each.value)} {each.goal.unit}"
        table.add_row(each.goal.kind, each.goal.of, value, f"{each.error:.2g} {each.goal.unit}", relative)
    if found.estimates:
        out.print(table)
    out.print(f"Levels along the rods (tolerance {100.0 * found.tolerance:g} %; X: level 10)")
    width = max(len(name) for name in found.steps[-1].meshes)
    for name, elements in chosen_elements(found).items():
        out.print(f"{name:<{width}}  {strip(elements)}", markup=False)
    steps = ", ".join(f"h{step.level} {seconds(step.seconds)}" for step in found.steps)
    out.print(f"{len(found.steps)} steps: {steps}")
    if found.outcome != "converged":
        out.print(found.outcome, markup=False)


def strip(elements: tuple[ChosenElement, ...]) -> str:
    """Levels along a rod, to scale where elements are long enough, between bars where they end: |X|6|4444|22222|."""
    length = elements[-1].end - elements[0].start
    cells = [sign(each.level) * max(1, round(WIDTH * (each.end - each.start) / length)) for each in elements]
    return f"|{'|'.join(cells)}|"


def sign(level: int) -> str:
    """A level as one character."""
    return "X" if level == 10 else str(level)
