"""Processor seconds and error of a library case by level and order, against the finest of them."""

from __future__ import annotations

from dataclasses import dataclass

import rodmodel as rm
from cases.loader import load_case
from reports.case_comparison import evaluation_points
from reports.performance.timing import Timing, once
from reports.processes import Progress
from reports.quantities import evaluate

CASE = "two-cantilevers-e50-g0"
LEVELS, ORDERS = (1, 2, 3, 4, 5, 6), (4, 6, 8)
REPEATS = 3


@dataclass(frozen=True)
class Setting:
    """One level and order.

    Attributes
    ----------
    contact_solutions : spent on the way
    force : magnitude of the contact force, N
    """

    level: int
    order: int
    unknowns: int
    outcome: str
    contact_solutions: int
    timing: Timing
    force: float


@dataclass(frozen=True)
class LevelStudy:
    """A case by level and order.

    Attributes
    ----------
    title : of the case
    pair : whose contact force it is
    settings : every order of every level
    """

    title: str
    pair: str
    settings: tuple[Setting, ...]

    @property
    def finest(self) -> Setting:
        """The highest order of the highest level."""
        return max(self.settings, key=lambda setting: (setting.level, setting.order))

    def error(self, setting: Setting) -> float:
        """Relative difference of the contact force from that of the finest."""
        return setting.force / self.finest.force - 1.0


def measured_levels(given: tuple[tuple[int, ...], tuple[int, ...], int], progress: Progress) -> LevelStudy:
    """Solve the case with all of some levels and orders, so often each, in turn."""
    del progress
    levels, orders, repeats = given
    case = load_case(CASE)
    pair, points = case.scene.contacts[0].name, evaluation_points(case)
    chosen = [(level, order) for level in levels for order in orders]
    solutions = {key: rm.solve(case.scene, *key) for key in chosen}
    seconds: dict[tuple[int, int], list[float]] = {key: [] for key in chosen}
    for _ in range(repeats):
        for key in chosen:
            seconds[key].append(once(rm.solve, case.scene, *key))
    settings = []
    for (level, order), solution in solutions.items():
        force = evaluate(solution, points.stations, points.stress_points).contact(pair).force
        timing = Timing(tuple(seconds[level, order]))
        spent = solution.contact_solutions
        settings.append(Setting(level, order, solution.cost.unknowns, solution.outcome, spent, timing, force))
    return LevelStudy(case.title, pair, tuple(settings))
