"""Run cases: the rod model, the 3D reference on three meshes, and everything they are held against.

Every case runs in a process of its own, so that its peak memory can be told and a case that fails, or is
killed, never stops the others. What the same code has answered before, a cache may tell.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from inspect import getsource
from pathlib import Path

from cases.case import Case, Grades
from cases.scene import Scene, SceneError
from reports.cache import Cache
from reports.case_comparison import case_comparisons, comparisons_without_reference, evaluation_points
from reports.chart.points import Chart
from reports.code_version import code_version
from reports.comparison import Comparison, Extrapolate, Extrapolation
from reports.memory import peak_memory
from reports.peers import PeerRun, SideBySide, ask_peers, side_by_side, stations_of
from reports.processes import ProcessFailed, Progress, failure_reason, in_own_process
from reports.quantities import ContactQuantities, PressureProfile, Quantities, RodQuantities, evaluate
from reports.solution import Model, Solution
from reports.surface import PressedFace, RodSurface, Surface, surface

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
    kept_since : the day it was computed on, YYYY-MM-DD, if it comes from the cache, with the seconds and the memory of
        then; else ''
    surface : to be drawn; None where nobody asked for it
    """

    model: Model
    level: Grades | None
    order: Grades | None
    quantities: Quantities
    total_seconds: float
    peak_memory: float
    kept_since: str = ""
    surface: Surface | None = None

    @property
    def origin(self) -> str:
        """Words to add where it comes from the cache."""
        return f", from the cache, computed on {self.kept_since}" if self.kept_since else ""


@dataclass(frozen=True)
class ReferenceRuns:
    """The 3D reference on three meshes, coarse to fine, and their representative element sizes, mm."""

    runs: tuple[Run, ...]
    sizes: tuple[float, ...]


# What results on disk are made of.
KINDS = (
    Run,
    ReferenceRuns,
    Quantities,
    ContactQuantities,
    PressureProfile,
    RodQuantities,
    Surface,
    RodSurface,
    PressedFace,
)


@dataclass(frozen=True)
class CaseRun:
    """A case answered by both models.

    Attributes
    ----------
    references : of the 3D reference on three meshes, coarse to fine; none where it cannot treat the scene
    refusal : then why, in one sentence; else ''
    side_by_side : numbers that solvers not written here can tell, too
    peers : what came of asking those solvers; none where they are not asked
    notes : what the user should know of the cache, a sentence each
    sizes : representative element sizes of the 3D reference's meshes, mm
    chart : error against cost of every configuration; None where none was made
    """

    case: Case
    rod: Run
    references: tuple[Run, ...]
    comparisons: tuple[Comparison, ...]
    refusal: str = ""
    side_by_side: tuple[SideBySide, ...] = ()
    peers: tuple[PeerRun, ...] = ()
    notes: tuple[str, ...] = ()
    sizes: tuple[float, ...] = ()
    chart: Chart | None = None


@dataclass(frozen=True)
class Failure:
    """A case that could not be run to its end, and why, in one sentence."""

    case: Case
    reason: str


def run_rod(
    case: Case,
    level: int | None = None,
    order: int | None = None,
    repeats: int = 1,
    solved: Callable[[Solution], None] = lambda _: None,
    *,
    drawn: bool = False,
) -> Run:
    """Solve a case with the rod model; level and order are the case's where they are not given.

    Parameters
    ----------
    solved : called with every solution, for those who want more than the quantities
    drawn : whether the surface is wanted, too

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
        solved(solution)
    quantities = replace(
        runs[-1][0],
        setup_seconds=statistics.median(quantities.setup_seconds for quantities, _ in runs),
        solve_seconds=statistics.median(quantities.solve_seconds for quantities, _ in runs),
    )
    total = statistics.median(seconds for _, seconds in runs)
    found = Run("rod", levels, orders, quantities, total, peak_memory())
    return replace(found, surface=surface(solution)) if drawn else found


def run_reference(case: Case, mesh: Path | None = None, solved: Callable[[Solution], None] = lambda _: None) -> Run:
    """Solve a case as a 3D solid, on the reference's default mesh or on one made elsewhere.

    Parameters
    ----------
    mesh : file with the mesh made elsewhere (`reference3d.own_mesh`)
    solved : called with the solution, for those who want more than the quantities

    Raises
    ------
    SceneError
        if the 3D reference cannot treat the scene, or the mesh is not the scene's.
    """
    import reference3d
    from reference3d.own_mesh import solve_own_mesh

    points = evaluation_points(case)
    begin = time.perf_counter()
    solution: Solution = reference3d.solve(case.scene) if mesh is None else solve_own_mesh(case.scene, mesh)
    quantities = evaluate(solution, points.stations, points.stress_points)
    found = Run("reference", None, None, quantities, time.perf_counter() - begin, peak_memory())
    solved(solution)
    return found


def run_case(case: Case, progress: Progress, cache: Cache | None = None) -> CaseRun:
    """Solve a case both ways and compare; `progress` is told what begins.

    Parameters
    ----------
    cache : where answers are looked for and kept; without one, everything is computed

    Raises
    ------
    SceneError
        if the rod model cannot treat the scene.
    """
    rod = _kept_rod(case, cache)
    if rod is None:
        progress("rod model")
        rod = run_rod(case, repeats=ROD_REPEATS, drawn=True)
        if cache is not None:
            cache.keep("rod", _rod_question(case), rod)

    references = _kept_references(case, cache)
    if references is None:
        try:
            references = _run_references(case, progress)
        except SceneError as error:
            alone = comparisons_without_reference(case, rod.quantities)
            beside = side_by_side(case, rod.quantities, (), None)
            return CaseRun(case, rod, (), alone, str(error), beside, notes=_notes(cache))
        if cache is not None:
            cache.keep("reference", _reference_question(case), references)

    progress("comparison")
    extrapolate = extrapolation(case.scene, references.sizes)
    quantities = [run.quantities for run in references.runs]
    comparisons = case_comparisons(case, rod.quantities, quantities, extrapolate)
    beside = side_by_side(case, rod.quantities, quantities, extrapolate)
    notes, sizes = _notes(cache), references.sizes
    return CaseRun(case, rod, references.runs, comparisons, side_by_side=beside, notes=notes, sizes=sizes)


def extrapolation(scene: Scene, sizes: tuple[float, ...]) -> Extrapolate:
    """What three numbers say of a scene, those of the 3D reference on meshes of these element sizes, coarse to fine."""
    import reference3d

    coarse, medium, fine = sizes
    order = reference3d.formal_order(scene)

    def extrapolate(first: float, second: float, third: float) -> Extrapolation:
        found = reference3d.grid_convergence((first, second, third), (coarse, medium, fine), order)
        return Extrapolation(found.extrapolated, found.uncertainty, found.observed_order if found.asymptotic else None)

    return extrapolate


def _run_references(case: Case, progress: Progress) -> ReferenceRuns:
    import reference3d

    points = evaluation_points(case)
    solutions = reference3d.solve_sequence(case.scene, lambda done, of: progress(f"3D mesh {done + 1} of {of}"))
    runs = []
    for solution in solutions:
        begin = time.perf_counter()
        quantities = evaluate(solution, points.stations, points.stress_points)
        total = solution.cost.setup_seconds + solution.cost.solve_seconds + time.perf_counter() - begin
        runs.append(Run("reference", None, None, quantities, total, peak_memory()))
        finest = solution
    runs[-1] = replace(runs[-1], surface=surface(finest))
    return ReferenceRuns(tuple(runs), tuple(solution.representative_size for solution in solutions))


def _rod_question(case: Case) -> tuple[object, ...]:
    """All that the rod model's answer to a case depends on."""
    code = code_version("rodmodel", "reports.quantities", "reports.surface"), getsource(Run), getsource(run_rod)
    return code, case.scene, case.rod_model, evaluation_points(case), ROD_REPEATS


def _reference_question(case: Case) -> tuple[object, ...]:
    """All that the 3D reference's answer to a case depends on; the meshes are a matter of its code."""
    code = (
        code_version("reference3d", "reports.quantities", "reports.surface"),
        getsource(Run),
        getsource(_run_references),
    )
    return code, case.scene, evaluation_points(case)


def _kept_rod(case: Case, cache: Cache | None) -> Run | None:
    kept = None if cache is None else cache.find("rod", _rod_question(case), KINDS)
    return None if kept is None else replace(kept.value, kept_since=kept.date)


def _kept_references(case: Case, cache: Cache | None) -> ReferenceRuns | None:
    kept = None if cache is None else cache.find("reference", _reference_question(case), KINDS)
    if kept is None:
        return None
    found: ReferenceRuns = kept.value
    return replace(found, runs=tuple(replace(run, kept_since=kept.date) for run in found.runs))


def _notes(cache: Cache | None) -> tuple[str, ...]:
    return () if cache is None else tuple(cache.notes)


def passed(run: CaseRun | Failure) -> bool:
    """Whether a case ran to its end, the models converged and every comparison passed."""
    return (
        isinstance(run, CaseRun)
        and all(answer.quantities.converged for answer in (run.rod, *run.references))
        and all(comparison.verdict == "pass" for comparison in run.comparisons)
    )


def run_cases(
    cases: Sequence[Case], progress: Callable[[Case, str], None], cache: Cache | None = None, peers: bool = False
) -> Iterator[CaseRun | Failure]:
    """Run cases one after the other; a failure is yielded, not raised.

    Each is solved in its own process; one whose answers the cache holds needs none. With `peers`, solvers that are not
    of this project are asked, too.
    """
    if cache is not None:
        cache.clean()
    for case in cases:
        told = partial(progress, case)
        try:
            if _kept_rod(case, cache) is None or _kept_references(case, cache) is None:
                run = in_own_process(partial(run_case, cache=cache), case, told)
            else:
                run = run_case(case, told, cache)
            if peers:
                run = replace(run, peers=ask_peers(case.scene, stations_of(run.rod.quantities), told, cache))
            yield run
        except ProcessFailed as error:
            yield Failure(case, str(error))
        except Exception as error:  # noqa: BLE001 (whatever went wrong, the next case is to be run)
            yield Failure(case, failure_reason(error))
