"""Seconds, unknowns and answers of every configuration of a case, in one process on one thread.

The rod model's levels, orders and meshes, beams, and NGSolve on meshes that were tuned knowing the answer are run here,
in turn, several times each; the 3D reference's meshes and the peers' own come from the run of the case.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from typing import cast

from cases.case import Case
from cases.loader import library_names, load_case
from reports.cache import Cache
from reports.case_comparison import evaluation_points
from reports.chart.beams import THEORIES, NotBeams, Theory, solve_beams
from reports.chart.front import TOLERANCES, asked
from reports.chart.points import (
    NGSOLVE_BOUNDARY,
    NGSOLVE_TUNED,
    ROD_AUTO,
    ROD_GRADED,
    ROD_OWN,
    SOLID,
    Chart,
    Point,
    Values,
    beam_values,
    own_estimates,
    own_values,
    peer_values,
    references_of,
)
from reports.code_version import code_version
from reports.peers import NOT_ASKED, PEERS, Answer, stations_of
from reports.processes import ProcessFailed, Progress, failure_reason, in_own_process
from reports.quantities import evaluate
from reports.runner import CaseRun, Failure, extrapolation
from reports.solution import Array

LEVELS = (1, 2, 3, 4, 5, 6, 7, 8, 10)
# Orders on the case's own elements and on those that are short at clamps and ends of zones, where 6 gains nothing.
ORDERS: Mapping[str, tuple[int, ...]] = {ROD_OWN: (4, 6), ROD_GRADED: (3, 4)}
MESHES: Mapping[str, str] = {ROD_OWN: "own elements", ROD_GRADED: "graded"}
# Points over a contact zone of beams.
BEAM_POINTS = (6, 21, 61)
MOST_RUNS = 5
# Processor seconds after which nothing more is begun, s.
ENOUGH = 10.0


@dataclass(frozen=True)
class Told:
    """What a run of a configuration says, as in `Point`."""

    outcome: str
    unknowns: int
    values: Values
    estimates: Values = field(default_factory=dict)
    chosen: str = ""


class NoReference(Exception):
    """The 3D reference cannot treat the case, so that there is nothing to hold errors against."""


@dataclass(frozen=True)
class Measured:
    """Configurations measured here, and sentences on those that were not."""

    points: tuple[Point, ...]
    notes: tuple[str, ...]


@dataclass
class Configuration:
    """A configuration and its runs so far.

    Attributes
    ----------
    run : solves, and returns what evaluates the answer
    """

    method: str
    label: str
    run: Callable[[], Callable[[], Told]]
    seconds: list[float] = field(default_factory=list)
    told: Told | None = None

    def once(self) -> None:
        """Run it; what it says is evaluated once, and never timed."""
        begin = time.process_time()
        tell = self.run()
        self.seconds.append(time.process_time() - begin)
        self.told = self.told or tell()

    def point(self) -> Point:
        """The point it is."""
        assert self.told is not None  # it was run
        told, seconds = self.told, tuple(self.seconds)
        return Point(
            self.method,
            self.label,
            told.outcome,
            told.unknowns,
            seconds,
            "processor",
            told.values,
            told.estimates,
            told.chosen,
        )


def make_chart(run: CaseRun, progress: Progress = lambda _: None, cache: Cache | None = None) -> Chart:
    """The chart of a case that was run.

    Parameters
    ----------
    cache : where measurements are looked for and kept

    Raises
    ------
    NoReference
        if the 3D reference cannot treat the case, so that there is nothing to hold errors against.
    """
    case = run.case
    if not run.references:
        raise NoReference(f"there is no 3D reference to hold errors against. {run.refusal}")
    references = references_of(
        case.scene, [answer.quantities for answer in run.references], extrapolation(case.scene, run.sizes)
    )
    question = _question(run)
    kept = None if cache is None else cache.find("chart", question, (Measured, Point))
    notes: list[str] = []
    if kept is not None:
        measured: Measured = kept.value
        notes.append(f"Seconds of the rod model, of beams and of tuned NGSolve were measured on {kept.date}.")
    else:
        progress("chart")
        measured = _measured(case, stations_of(run.rod.quantities), notes)
        # what failed once may not fail again
        if cache is not None and not notes:
            cache.keep("chart", question, measured)
    points, from_run = _of_the_run(run)
    return Chart(case.title, (*measured.points, *points), references, (*notes, *measured.notes, *from_run))


def charted(
    runs: Iterable[CaseRun | Failure], progress: Callable[[Case], None], cache: Cache | None
) -> list[CaseRun | Failure]:
    """The runs with their charts; where one cannot be made, it is empty and says why.

    progress : told whose chart begins
    """
    found: list[CaseRun | Failure] = []
    for run in runs:
        if isinstance(run, Failure):
            found.append(run)
            continue
        progress(run.case)
        try:
            chart = make_chart(run, cache=cache)
        except Exception as error:  # noqa: BLE001 (whatever is wrong with a chart, the case has its answers)
            reason = str(error) if isinstance(error, NoReference) else failure_reason(error)
            chart = Chart(run.case.title, (), {}, (f"There is no chart: {reason}",))
        found.append(replace(run, chart=chart))
    return found


def _question(run: CaseRun) -> tuple[object, ...]:
    """All that the measurement of a case depends on."""
    code = code_version("rodmodel", "reports.chart.measure", "reference3d.peers.ngsolve_tuned")
    return code, _ngsolve_version(), run.case.name, run.case.scene, run.case.rod_model, evaluation_points(run.case)


def _ngsolve_version() -> str:
    try:
        return version("ngsolve")
    except PackageNotFoundError:
        return ""


def _measured(case: Case, stations: Mapping[str, Array], notes: list[str]) -> Measured:
    """Everything measured here; what fails is told in `notes`."""
    try:
        return in_own_process(partial(measure, stations=stations), case)
    except ProcessFailed as error:
        notes.append(f"The rod model, beams and tuned NGSolve are left out: {error}.")
        return Measured((), ())


def measure(case: Case, _progress: Progress, stations: Mapping[str, Array], enough: float = ENOUGH) -> Measured:
    """Beams, NGSolve on tuned meshes, and the rod model by level, order and mesh, run in turn.

    Parameters
    ----------
    stations : by rod, where deflections are looked for, arc length, mm
    enough : processor seconds after which nothing more is begun
    """
    notes: list[str] = []
    rods = list(_rod_configurations(case))
    others = [*_beam_configurations(case, notes), *_ngsolve_configurations(case, stations, notes)]
    # what is loaded and computed once a process belongs to none of them: the last of a method is among its richest
    for last in {each.method: each for each in (*rods, *others)}.values():
        last.run()
    left_out = run_in_turn([*others, *rods], enough)
    if left_out:
        notes.append(
            f"{len(left_out)} of {len(rods)} configurations of the rod model were left out, as the others took "
            f"{enough:g} s: {', '.join(each.label for each in left_out)}."
        )
    load, processors = os.getloadavg()[0], os.cpu_count() or 1
    if load > processors:
        notes.append(
            f"The machine was busy while the rod model, beams and tuned NGSolve were measured: a load of {load:.1f} on "
            f"{processors} processors, which makes processor seconds longer, too."
        )
    return Measured(tuple(each.point() for each in (*rods, *others) if each.told is not None), tuple(notes))


def _rod_configurations(case: Case) -> Iterator[Configuration]:
    """Its own choice, then by level, order and mesh, low levels first, and the case's own where it is none of them."""
    import rodmodel
    from rodmodel.adapt import graded
    from rodmodel.adaptive import solve_to

    points = evaluation_points(case)
    settings = case.rod_model

    def run(scene: rodmodel.Scene, level: object, order: object) -> Callable[[], Told]:
        solution = rodmodel.solve(scene, level, order)  # type: ignore[arg-type]

        def tell() -> Told:
            quantities = evaluate(solution, points.stations, points.stress_points)
            return Told(quantities.outcome, quantities.unknowns, own_values(case.scene, quantities))

        return tell

    def choose(tolerance: float) -> Callable[[], Told]:
        found = solve_to(case.scene, tolerance)

        def tell() -> Told:
            quantities = evaluate(found.solution, points.stations, points.stress_points)
            values = own_values(case.scene, quantities)
            chosen = ", ".join(f"h{step.level}" for step in found.steps)
            return Told(found.outcome, quantities.unknowns, values, own_estimates(found.estimates, values), chosen)

        return tell

    meshes = {ROD_OWN: case.scene, ROD_GRADED: graded(case.scene)}
    if meshes[ROD_OWN] == meshes[ROD_GRADED]:
        del meshes[ROD_GRADED]
    for tolerance in TOLERANCES:
        yield Configuration(ROD_AUTO, asked(tolerance), partial(choose, tolerance))
    for level in LEVELS:
        for method, scene in meshes.items():
            for order in ORDERS[method]:
                label = f"h{level}, p = {order}, {MESHES[method]}"
                yield Configuration(method, label, partial(run, scene, level, order))
    if settings.level not in LEVELS or settings.order not in ORDERS[ROD_OWN]:
        yield Configuration(ROD_OWN, "as the case has it", partial(run, case.scene, settings.level, settings.order))


def _beam_configurations(case: Case, notes: list[str]) -> list[Configuration]:
    """Both theories with more and more points over each zone; none, told in `notes`, where they do not apply."""

    def run(theory: Theory, count: int) -> Callable[[], Told]:
        answer = solve_beams(case.scene, theory, count)
        return lambda: Told(answer.outcome, answer.unknowns, beam_values(answer))

    try:
        solve_beams(case.scene, THEORIES[0], BEAM_POINTS[0])
    except NotBeams as error:
        notes.append(f"Beam theory is left out: {error}.")
        return []
    except Exception as error:  # noqa: BLE001 (whatever is wrong with beams, the rod model is measured)
        notes.append(f"Beam theory is left out: {failure_reason(error)}.")
        return []
    # without contact there are no points
    counts = BEAM_POINTS if case.scene.contacts else BEAM_POINTS[:1]
    label = "{} points over each zone" if case.scene.contacts else "elements exact at their nodes"
    return [
        Configuration(f"{theory} beams", label.format(count), partial(run, theory, count))
        for theory in THEORIES
        for count in counts
    ]


def _ngsolve_configurations(case: Case, stations: Mapping[str, Array], notes: list[str]) -> list[Configuration]:
    """NGSolve on meshes tuned to the case, with contact condensed by hand and with its own `ContactBoundary`."""
    from reference3d.peers.ngsolve_boundary import solve_with_contact_boundary
    from reference3d.peers.ngsolve_solver import Solved, answer, installed, solve_condensed
    from reference3d.peers.ngsolve_tuned import TUNED

    tuned = {tolerance: mesh for (name, tolerance), mesh in TUNED.items() if name == case.name}
    # a case file elsewhere may have the name of one of the library
    if not tuned or case.name not in library_names() or load_case(case.name).scene != case.scene:
        return []
    if absent := installed():
        notes.append(f"{NGSOLVE_TUNED} is left out: {absent}")
        return []

    def run(solve: Callable[..., Solved], tolerance: float) -> Callable[[], Told]:
        solved = solve(case.scene, tuned[tolerance])

        def tell() -> Told:
            found = answer(solved, stations, 0.0)
            return Told(found.outcome, found.unknowns, peer_values(cast("Answer", found)))

        return tell

    return [
        Configuration(method, f"mesh tuned to {tolerance:g} %", partial(run, solve, tolerance))
        for method, solve in ((NGSOLVE_TUNED, solve_condensed), (NGSOLVE_BOUNDARY, solve_with_contact_boundary))
        for tolerance in tuned
    ]


def run_in_turn(configurations: Sequence[Configuration], enough: float) -> list[Configuration]:
    """Run all once and again, so that what disturbs the machine disturbs all alike; those there was no time for.

    enough : processor seconds after which nothing more is begun, not even another turn that would go beyond
    """
    spent = 0.0
    for turn in range(MOST_RUNS):
        if turn and spent * (turn + 1) / turn > enough:
            break
        for each in configurations:
            if turn or spent < enough:
                each.once()
                spent += each.seconds[-1]
    return [each for each in configurations if each.told is None]


def _of_the_run(run: CaseRun) -> tuple[list[Point], list[str]]:
    """The meshes of the 3D reference and what peers did on their own."""
    points, notes = [], []
    for number, answer in enumerate(run.references, start=1):
        found = answer.quantities
        seconds = found.setup_seconds + found.solve_seconds
        label = f"mesh {number} of {len(run.references)}"
        values = own_values(run.case.scene, found)
        points.append(Point(SOLID, label, found.outcome, found.unknowns, (seconds,), "wall", values))
    days = {answer.kept_since for answer in run.references if answer.kept_since}
    notes += [f"Seconds of 3D were measured on {day}." for day in sorted(days)]
    if not run.peers:
        notes.append(f"{' and '.join(PEERS)} on their own meshes: {NOT_ASKED}.")
    for peer in run.peers:
        if peer.answer is None:
            notes.append(f"{peer.peer} is left out: {peer.reason.rstrip('.')}.")
            continue
        told = peer.answer
        values = peer_values(told)
        points.append(Point(peer.peer, "its own mesh", told.outcome, told.unknowns, (told.seconds,), "wall", values))
        if peer.kept_since:
            notes.append(f"Seconds of {peer.peer} were measured on {peer.kept_since}.")
    return points, notes
