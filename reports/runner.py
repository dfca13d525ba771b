"""Run cases: the rod model, the 3D reference on three meshes, and everything they are held against.

Every case runs in a process of its own, so that its peak memory can be told and a case that fails, or is
killed, never stops the others.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

from cases.case import Case, Grades
from cases.scene import SceneError
from reports.case_comparison import case_comparisons, comparisons_without_reference, evaluation_points
from reports.comparison import Comparison, Extrapolation
from reports.memory import peak_memory
from reports.processes import ProcessFailed, Progress, in_own_process
from reports.quantities import Quantities, evaluate
from reports.solution import Model

# The rod model answers in milliseconds; its seconds are the median of this many runs.
ROD_REPEATS = 5
# How often `run_case` tells its progress: the rod model, three meshes, the comparison.
STEPS = 5


@dataclass(frozen=True)
class Run:
    """One model's answer to a case.

    Attributes
    ----------
    level, order : of the rod model; None for the 3D reference
    total_seconds : wall-clock time from the scene to all quantities
    peak_memory : largest resident memory of the process so far, MB
    """

    model: Model
    level: Grades | None
    order: Grades | None
    quantities: Quantities
    total_seconds: float
    peak_memory: float


@dataclass(frozen=True)
class CaseRun:
    """A case answered by both models.

    Attributes
    ----------
    references : of the 3D reference on three meshes, coarse to fine; none where it cannot treat the scene
    refusal : then why, in one sentence; else ''
    """

    case: Case
    rod: Run
    references: tuple[Run, ...]
    comparisons: tuple[Comparison, ...]
    refusal: str = ""


@dataclass(frozen=True)
class Failure:
    """A case that could not be run to its end, and why, in one sentence."""

    case: Case
    reason: str


def run_rod(case: Case, level: int | None = None, order: int | None = None, repeats: int = 1) -> Run:
    """Solve a case with the rod model; level and order are the case's where they are not given.

    Raises
    ------
    SceneError
        if the rod model cannot treat the scene.
    """
    import rodmodel

    levels = case.rod_model.level if level is None else level
    orders = case.rod_model.order if order is None else order
    points = evaluation_points(case)
    runs = []
    for _ in range(repeats):
        begin = time.perf_counter()
        solution = rodmodel.solve(case.scene, level=levels, order=orders)
        quantities = evaluate(solution, points.stations, points.stress_points)
        runs.append((quantities, time.perf_counter() - begin))
    quantities = replace(
        runs[-1][0],
        setup_seconds=statistics.median(quantities.setup_seconds for quantities, _ in runs),
        solve_seconds=statistics.median(quantities.solve_seconds for quantities, _ in runs),
    )
    total = statistics.median(seconds for _, seconds in runs)
    return Run("rod", levels, orders, quantities, total, peak_memory())


def run_reference(case: Case) -> Run:
    """Solve a case as a 3D solid, on the reference's default mesh.

    Raises
    ------
    SceneError
        if the 3D reference cannot treat the scene.
    """
    import reference3d

    points = evaluation_points(case)
    begin = time.perf_counter()
    solution = reference3d.solve(case.scene)
    quantities = evaluate(solution, points.stations, points.stress_points)
    return Run("reference", None, None, quantities, time.perf_counter() - begin, peak_memory())


def run_case(case: Case, progress: Progress) -> CaseRun:
    """Solve a case both ways and compare; `progress` is told what begins.

    Raises
    ------
    SceneError
        if the rod model cannot treat the scene.
    """
    import reference3d

    progress("rod model")
    rod = run_rod(case, repeats=ROD_REPEATS)

    points = evaluation_points(case)
    try:
        solutions = reference3d.solve_sequence(case.scene, lambda done, of: progress(f"3D mesh {done + 1} of {of}"))
    except SceneError as error:
        return CaseRun(case, rod, (), comparisons_without_reference(case, rod.quantities), str(error))
    progress("comparison")
    references = []
    for solution in solutions:
        begin = time.perf_counter()
        quantities = evaluate(solution, points.stations, points.stress_points)
        total = solution.cost.setup_seconds + solution.cost.solve_seconds + time.perf_counter() - begin
        references.append(Run("reference", None, None, quantities, total, peak_memory()))

    coarse, medium, fine = (solution.representative_size for solution in solutions)
    order = reference3d.formal_order(case.scene)

    def extrapolate(first: float, second: float, third: float) -> Extrapolation:
        found = reference3d.grid_convergence((first, second, third), (coarse, medium, fine), order)
        return Extrapolation(found.extrapolated, found.uncertainty, found.observed_order if found.asymptotic else None)

    comparisons = case_comparisons(case, rod.quantities, [run.quantities for run in references], extrapolate)
    return CaseRun(case, rod, tuple(references), comparisons)


def passed(run: CaseRun | Failure) -> bool:
    """Whether a case ran to its end, the models converged and every comparison passed."""
    return (
        isinstance(run, CaseRun)
        and all(answer.quantities.converged for answer in (run.rod, *run.references))
        and all(comparison.verdict == "pass" for comparison in run.comparisons)
    )


def run_cases(cases: Sequence[Case], progress: Callable[[Case, str], None]) -> Iterator[CaseRun | Failure]:
    """Run cases one after the other, each in its own process; a failure is yielded, not raised."""
    for case in cases:
        try:
            yield in_own_process(run_case, case, partial(progress, case))
        except ProcessFailed as error:
            yield Failure(case, str(error))
