"""The command `rodcheck`, whose subcommands `rodcheck --help` lists.

Heavy imports wait until a command needs them. Bad input is answered by one sentence on standard error and
exit code 2; a verdict other than 'pass', a solver that did not converge or a case that failed by exit code 1. The
report is there to show such verdicts: it fails only where a case could not be run to its end.
"""

from __future__ import annotations

import json
import os
import sys
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal, NoReturn

from cyclopts import App, CycloptsError, Parameter, validators

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from cases.case import Case
    from reports.cache import Cache
    from reports.runner import CaseRun, Failure
    from reports.solution import Solution
    from reports.stability.registry import Stability
    from reports.verification.check import Outcome
    from rodmodel import AdaptiveSolution

BAD_INPUT = 2
NOT_PASSED = 1
INTERRUPTED = 130


class InputError(Exception):
    """What the user gave cannot be used; the message is one sentence."""


app = App(
    name="rodcheck",
    help="Rods in contact, solved by a hierarchic rod model and as a 3D solid, and held against each other.",
    help_format="plaintext",
    suppress_keyboard_interrupt=False,
)
schema_app = App(name="schema", help="Print a JSON Schema.")
app.command(schema_app)

Level = Annotated[int | None, Parameter(validator=validators.Number(gte=1, lte=12))]
NoCache = Annotated[bool, Parameter(name="--no-cache", negative=())]
NoCharts = Annotated[bool, Parameter(name="--no-charts", negative=())]
NoPeers = Annotated[bool, Parameter(name="--no-peers", negative=())]
# A value that may begin with a minus sign.
Signed = Annotated[str | None, Parameter(allow_leading_hyphen=True)]
Order = Annotated[int | None, Parameter(validator=validators.Number(gte=2, lte=20))]


def main() -> NoReturn:
    """Entry point."""
    # Seconds are those of one thread, unless the user asks for more: small matrices lose by threads.
    for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
        os.environ.setdefault(variable, "1")
    try:
        sys.exit(run(sys.argv[1:]))
    except KeyboardInterrupt:  # while modules are imported
        sys.exit(INTERRUPTED)


def run(arguments: Sequence[str]) -> int:
    """Run a command line and return its exit code."""
    try:
        code = app(list(arguments), exit_on_error=False, print_error=False, result_action="return_value")
        sys.stdout.flush()
    except KeyboardInterrupt:
        print("rodcheck: interrupted", file=sys.stderr)
        return INTERRUPTED
    except BrokenPipeError:
        # The reader has seen enough (`rodcheck schema case | head`); nothing may complain at exit either.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0
    except Exception as error:
        # Here, as they bring numpy and scipy, which `rodcheck --help` does without.
        from cases.loader import CaseError
        from cases.scene import SceneError
        from reports.quantities import SolutionError

        if not isinstance(error, CycloptsError | CaseError | SceneError | InputError | SolutionError):
            raise
        print("rodcheck:", " ".join(str(error).split()), file=sys.stderr)
        return NOT_PASSED if isinstance(error, SolutionError) else BAD_INPUT
    return code if isinstance(code, int) else 0


@app.command(name="list")
def list_cases() -> int:
    """List the cases of the library."""
    from cases.loader import library_names, load_case

    names = library_names()
    width = max(len(name) for name in names)
    for name in names:
        print(f"{name:<{width}}  {load_case(name).title}")
    return 0


@app.command(name="new")
def new_case(
    name: str,
    /,
    *,
    template: str | None = None,
    title: str | None = None,
    length: str | None = None,
    radius: str | None = None,
    angle: str | None = None,
    width: str | None = None,
    height: str | None = None,
    young_modulus: str | None = None,
    poisson_ratio: str | None = None,
    upper_modulus: str | None = None,
    overlap: str | None = None,
    gap: Signed = None,
    bed_modulus: str | None = None,
    force: Signed = None,
) -> int:
    """Make a commented case file to begin from, NAME.toml, and the JSON Schema that editors complete it by.

    What is not given is asked for on a terminal; elsewhere defaults are taken, and said. Values are as in case files:
    "300 mm", "200 GPa", or a number in mm, N, MPa or rad.

    Parameters
    ----------
    name
        of the case, or a path ending in it
    template
        single-rod, two-rods, curved-rod or bar-on-bed
    title
        one line that says what the case is
    length
        of the rod, or of each of two
    radius
        of the curved rod
    angle
        of the curved rod, such as "90 deg"
    width
        of the section, across; for the curved rod along its radius
    height
        of the section, upwards; for the curved rod across its plane
    young_modulus
        of the rod, or of the lower one of two
    poisson_ratio
        of the rods
    upper_modulus
        Young's modulus of the upper one of two rods
    overlap
        of two rods
    gap
        between two rods before the load
    bed_modulus
        of the bed, a stress per length, such as "1 N/mm^3"
    force
        on the rod, upwards; for the curved rod along Z
    """
    flags = {
        "length": length,
        "radius": radius,
        "angle": angle,
        "width": width,
        "height": height,
        "young_modulus": young_modulus,
        "poisson_ratio": poisson_ratio,
        "upper_modulus": upper_modulus,
        "overlap": overlap,
        "gap": gap,
        "bed_modulus": bed_modulus,
        "force": force,
    }
    from reports.new_case.command import NewCaseError, new_case_file

    try:
        written = new_case_file(name, template, title, {key: text for key, text in flags.items() if text is not None})
    except NewCaseError as error:
        raise InputError(str(error)) from error
    for note in written.notes:
        print(f"rodcheck: {note}", file=sys.stderr)
    print(written.path)
    return 0


@app.command
def check(case: str, /, *, output: Annotated[Path | None, Parameter(name=["--output", "-o"])] = None) -> int:
    """Look at a case before it is solved: what it says, how large it is, what may surprise, and a picture.

    Parameters
    ----------
    case
        path of a case file, or name of a case of the library
    output
        file, ending in .png, for the picture; without it CASE-scene.png beside the case file, or here for one of the
        library
    """
    from cases.loader import library_names, load_case

    loaded = load_case(case)
    beside = Path() if case in library_names() else Path(case).parent
    picture = beside / f"{loaded.name}-scene.png" if output is None else output
    if picture.suffix != ".png" or picture.is_dir() or not picture.parent.is_dir():
        raise InputError(f"--output: found {picture}; give a file whose name ends in .png, in a folder that exists")
    from concurrent.futures import ThreadPoolExecutor

    from reports.check.picture import scene_picture
    from reports.processes import ProcessFailed
    from reports.store import write_whole_bytes

    # The picture is drawn in a process of its own while the tables are made.
    with ThreadPoolExecutor(1) as waiting:
        drawing = waiting.submit(scene_picture, loaded.scene)
        from reports.check.printing import print_summary
        from reports.check.summary import summary

        found = summary(loaded)
        print_summary(loaded, found)
        try:
            drawn = drawing.result()
        except ProcessFailed as error:
            print(f"rodcheck: {loaded.name}: no picture, {error}", file=sys.stderr)
            drawn = None
    if drawn is not None:
        try:
            write_whole_bytes(picture, drawn)
        except OSError as error:
            where = f"cannot write to {error.filename or picture} ({error.strerror})"
            raise InputError(f"--output: {where}; give another place") from error
        print(picture)
    if found.problem:
        raise InputError(f"{loaded.name}: {found.problem}")
    return NOT_PASSED if drawn is None else 0


@app.command
def solve(
    case: str,
    /,
    *,
    model: Literal["rod", "reference"] = "rod",
    level: int | Literal["auto", "case"] | None = None,
    order: Order = None,
    tolerance: str | None = None,
    picture: Path | None = None,
    mesh: Path | None = None,
    vtu: Path | None = None,
    json: Annotated[bool, Parameter(name="--json", negative=())] = False,
) -> int:
    """Solve a case with one of the two models.

    Parameters
    ----------
    case
        name of a case of the library, or path of a case file
    model
        the rod model, or the 3D reference
    level
        k of the rod model h_k, 1 to 12; case for the case file's; auto, or none of level and order, for levels, orders
        and elements of the solver's own choice
    order
        order p of the rod model along the rods, 2 to 20; the case file's where only the level is given
    tolerance
        error that contact forces, largest deflections and clamp moments may have where the solver chooses, such as 0.1%
        or 0.001; 0.1% where it is not given
    picture
        file, ending in .html, for a picture of the levels and orders chosen along the rods
    mesh
        file with a mesh that the 3D reference takes instead of its own, in any format that meshio reads: hexahedra
        of 8, 20 or 27 nodes or tetrahedra of 4 or 10, in groups named after the rods (ROD for its elements, ROD.start
        and ROD.end for clamped ends, ROD.top and so on for faces that are the first of a contact pair)
    vtu
        file, ending in .vtu, for displacement and stress of the bodies (stress and von_mises in global axes, stress_s
        along the rods; N, mm, MPa); points of contact go to NAME-contact.vtu beside it
    json
        print exactly one JSON object, described by `rodcheck schema result`
    """
    from cases.loader import load_case

    loaded = load_case(case)
    if model == "reference" and not (level is None and order is None):
        raise InputError("--level and --order belong to the rod model; leave them out with --model reference")
    if isinstance(level, int) and not 1 <= level <= 12:
        raise InputError(f"--level: found {level}; give 1 to 12, auto or case")
    auto = model == "rod" and (level == "auto" or (level is None and order is None))
    if level == "auto" and order is not None:
        raise InputError(f"--order: found {order} with --level auto; give a level, or leave the order to the solver")
    if not auto and not (tolerance is None and picture is None):
        raise InputError("--tolerance and --picture belong to --level auto; leave them out, or the level and order")
    wanted = _tolerance(tolerance)
    if picture is not None and (picture.suffix != ".html" or picture.is_dir() or not picture.parent.is_dir()):
        raise InputError(f"--picture: found {picture}; give a file whose name ends in .html, in a folder that exists")
    if mesh is not None and model == "rod":
        raise InputError("--mesh belongs to the 3D reference; give it with --model reference")
    if vtu is not None and (vtu.suffix != ".vtu" or vtu.is_dir() or not vtu.parent.is_dir()):
        raise InputError(f"--vtu: found {vtu}; give a file whose name ends in .vtu, in a folder that exists")
    from reports.progress import status
    from reports.result import result
    from reports.runner import run_reference, run_rod

    solutions: list[Solution] = []
    chosen: AdaptiveSolution | None = None
    with status(f"{loaded.name}: {model}"):
        if auto:
            from reports.choice import run_auto

            answer, chosen = run_auto(loaded, wanted, solved=solutions.append)
        elif model == "rod":
            given = level if isinstance(level, int) else None
            answer = run_rod(loaded, given, order, solved=solutions.append)
        else:
            answer = run_reference(loaded, mesh, solved=solutions.append)
    if vtu is not None:
        for path in _written_fields(solutions[0], vtu):
            print(f"rodcheck: wrote {path}", file=sys.stderr)
    if picture is not None and chosen is not None:
        print(f"rodcheck: wrote {_written_picture(chosen, picture)}", file=sys.stderr)
    if json:
        quantities, choice = answer.quantities, None
        if chosen is not None:
            from reports.choice import choice_result

            choice = choice_result(chosen)
        found = result(loaded.name, model, answer.level, answer.order, quantities, answer.total_seconds, choice)
        print(found.model_dump_json())
    else:
        from reports.tables import print_run

        print_run(loaded, answer)
        if chosen is not None:
            from reports.choice import print_choice

            print_choice(chosen)
    if not answer.quantities.converged:
        print(f"rodcheck: {loaded.name}: not converged: {answer.quantities.outcome}", file=sys.stderr)
        return NOT_PASSED
    if chosen is not None and chosen.outcome != "converged":
        print(f"rodcheck: {loaded.name}: tolerance {100.0 * wanted:g} % {chosen.outcome}", file=sys.stderr)
        return NOT_PASSED
    return 0


@app.command
def compare(
    *cases: str,
    quick: Annotated[bool, Parameter(name="--quick", negative=())] = False,
    cache: Path | None = None,
    no_cache: NoCache = False,
    no_peers: NoPeers = False,
) -> int:
    """Solve cases both ways and print how far apart the answers are.

    What the same code has answered before is taken from the cache, with the seconds it took then, and says so.

    Parameters
    ----------
    cases
        names of cases of the library, or paths of case files
    quick
        look roughly instead, in seconds: a rod model of low level, 3D on coarse meshes, how uncertain both are, and no
        verdict; nothing is kept
    cache
        folder of results; without it, rodcheck in $XDG_CACHE_HOME or ~/.cache
    no_cache
        compute everything, and keep nothing
    no_peers
        leave out solvers that are not of this project, CalculiX and NGSolve, which are asked where installed
    """
    if not cases:
        raise InputError("compare: name at least one case; `rodcheck list` prints those of the library")
    if quick:
        return _quick_looks(_load_all(cases))
    from reports.tables import print_comparison

    runs = _run_all(_load_all(cases), _cache(cache, no_cache), not no_peers)
    for run in runs:
        print_comparison(run)
    return _exit_code(runs)


@app.command
def sweep(
    case: str,
    /,
    *,
    vary: Annotated[tuple[str, ...], Parameter(negative=())],
    level: Level = None,
    order: Order = None,
    output: Path = Path("sweep"),
) -> int:
    """Solve a case with the rod model for many values of a key; write tables (CSV, Parquet) and a plot (HTML).

    Every value is solved, beginning with what the ones before have left. The tables have one row for each value and
    quantity.

    Parameters
    ----------
    case
        name of a case of the library, or path of a case file
    vary
        KEY=FIRST..LAST UNIT:COUNT, such as rods.upper.E=20..200GPa:30 or "loads.1.force.2=-2..-0.1 kN:20"; with :log at
        the end the values have even ratios. The key is a path into the case file, entries of lists by their number from
        1; rods.NAME.KEY may also be a key of the rod's material (E, nu, rho for short) or section, changed for this rod
        alone. Given again for another key, all combinations are solved
    level
        k of the rod model h_k, 1 to 12; the case file's where it is not given
    order
        order p of the rod model along the rods, 2 to 20; the case file's where it is not given
    output
        folder for the files, which are named after the case
    """
    from reports.sweep.keys import SweepError, sweep_points, variation

    try:
        variations = [variation(text) for text in vary]
        points = sweep_points(case, variations, level, order)
    except SweepError as error:
        raise InputError(str(error)) from error
    _require_folder(output)
    from reports.progress import progress
    from reports.sweep.files import notes, write_sweep
    from reports.sweep.run import sweep_rows

    rows = [
        row for found in progress(sweep_rows(points, variations), len(points), points[0].case.name) for row in found
    ]
    sentences = notes(rows, len(points))
    for path in _all_written(lambda: write_sweep(rows, variations, points[0].case, output, sentences)):
        print(path)
    for sentence in sentences:
        print(f"rodcheck: {sentence}", file=sys.stderr)
    return 0 if all(row.outcome == "converged" for row in rows) else NOT_PASSED


@app.command
def report(
    *cases: str,
    output: Path = Path("report"),
    cache: Path | None = None,
    no_cache: NoCache = False,
    no_peers: NoPeers = False,
    no_charts: NoCharts = False,
) -> int:
    """Solve cases both ways and write an overview and a page a case, with the results as JSON beside them.

    With the whole library come the pages of verification, performance and stability. What the same code has answered
    before is taken from the cache, with the seconds it took then, and says so; the page of performance never is.

    Parameters
    ----------
    cases
        names of cases of the library, or paths of case files; without any, the whole library
    output
        folder for index.html and the results
    cache
        folder of results; without it, rodcheck in $XDG_CACHE_HOME or ~/.cache
    no_cache
        compute everything, and keep nothing
    no_peers
        leave out solvers that are not of this project, CalculiX and NGSolve, which are asked where installed
    no_charts
        leave out the charts of speed against accuracy, which take some ten seconds a case where the cache has none
    """
    from cases.loader import library_names

    loaded = _load_all(cases or library_names())
    _require_folder(output)
    results = _cache(cache, no_cache)
    from reports.runner import Failure
    from reports.site import write_report

    runs = _run_all(loaded, results, not no_peers)
    runs = runs if no_charts else _charted(runs, results)
    outcomes = None if cases else _verification_outcomes(results)
    verification = None if outcomes is None else _write_verification(outcomes, output, in_report=True)
    performance = None if cases else _write_performance(output, in_report=True)
    sweeps = None if cases else _stability(results)
    stability = None if sweeps is None else _write_stability(sweeps, output, in_report=True)
    chosen = None if cases or no_charts else _write_choices(runs, output)
    made = [page.name for page in (verification, performance, stability) if page is not None]
    pages = made if chosen is None else [*made, chosen.name]
    print(_written(lambda: write_report(runs, output, pages)))
    incomplete = any(isinstance(run, Failure) for run in runs) or (not cases and len(made) < 3)
    return NOT_PASSED if incomplete else 0


@app.command
def chart(
    *cases: str,
    output: Path = Path("report"),
    cache: Path | None = None,
    no_cache: NoCache = False,
    no_peers: NoPeers = False,
) -> int:
    """Chart error against seconds and unknowns of a case, every method and configuration in the same axes.

    Prints the cheapest configuration of every method that keeps 1 %, 0.1 % and 0.02 %, and writes the chart. Of several
    cases, or of the whole library, it prints and writes how well the rod model chose levels for itself in all of them.
    What the same code has measured before is taken from the cache, and says so.

    Parameters
    ----------
    cases
        names of cases of the library, or paths of case files; without any, the whole library
    output
        folder for chart-CASE.html, or choices.html of several cases, and, in results, its numbers
    cache
        folder of results; without it, rodcheck in $XDG_CACHE_HOME or ~/.cache
    no_cache
        measure everything in this run, and keep nothing
    no_peers
        leave out solvers that are not of this project, CalculiX and NGSolve on their own meshes
    """
    from cases.loader import library_names

    loaded = _load_all(cases or library_names())
    _require_folder(output)
    results = _cache(cache, no_cache)
    from reports.runner import Failure

    runs = _charted(_run_all(loaded, results, not no_peers), results)
    failures = [run for run in runs if isinstance(run, Failure)]
    for failure in failures:
        print(f"rodcheck: {failure.case.name}: {failure.reason}", file=sys.stderr)
    # `_charted` gives every other one a chart
    charts = {run.case.name: run.chart for run in runs if not isinstance(run, Failure) and run.chart is not None}
    if len(loaded) > 1:
        from reports.chart.choices_page import print_choices, write_choices

        print_choices(list(charts.values()))
        print(_written(lambda: write_choices(list(charts.values()), output, in_report=_has_overview(output))))
        return NOT_PASSED if failures else 0
    for name, found in charts.items():
        if not found.points:
            print(f"rodcheck: {name}: {' '.join(found.notes)}", file=sys.stderr)
            return NOT_PASSED
        from reports.chart.page import write_chart
        from reports.chart.wording import print_race

        print_race(found)
        print(_written(partial(write_chart, loaded[0], found, output)))
    return NOT_PASSED if failures else 0


@app.command
def nightly(
    *cases: str,
    output: Path = Path("nightly"),
    scheduler: str | None = None,
    memory_limit: str | None = None,
    time_limit: str = "20 min",
    cache: Path | None = None,
    no_cache: NoCache = False,
    no_peers: NoPeers = False,
) -> int:
    """Run cases through Dask and write report, history and a short summary; say what moved since earlier runs.

    Interrupted and started again it goes on where it was. A case that fails, hangs or takes too much memory is
    reported and stops nothing. Exit code 1 if a verdict is not 'pass' or something moved.

    Parameters
    ----------
    cases
        names of cases of the library, or paths of case files; without any, the whole library
    output
        folder for index.html, results, summary.txt and the history, a file a run
    scheduler
        address of a Dask scheduler whose workers have rodcheck installed, such as tls://host:8786; without
        it, this machine does the work
    memory_limit
        of a case with all its processes, such as 4GB; without it, an equal part of the machine's memory
    time_limit
        of a case, such as "20 min" or 3600s
    cache
        folder of results; without it, rodcheck in $XDG_CACHE_HOME or ~/.cache
    no_cache
        compute everything, and keep nothing
    no_peers
        leave out solvers that are not of this project, CalculiX and NGSolve, which are asked where installed
    """
    from cases.loader import library_names

    loaded = _load_all(cases or library_names())
    _require_folder(output)
    results = _cache(cache, no_cache)
    from reports.nightly.limits import LimitError, limits

    try:
        allowed = limits(memory_limit, time_limit)
    except LimitError as error:
        raise InputError(str(error)) from error
    from reports.nightly.cluster import ClusterError
    from reports.nightly.run import nightly as carry_out
    from reports.nightly.unfinished import Busy, locked

    try:
        with locked(output):
            outcome = carry_out(
                loaded,
                output,
                cache=None if results is None else results.folder.absolute(),
                peers=not no_peers,
                limits=allowed,
                scheduler=scheduler,
            )
    except Busy as error:
        raise InputError(
            f"--output: another nightly run is at work in {output}; wait for it, or give another"
        ) from error
    except ClusterError as error:
        raise InputError(str(error)) from error
    except OSError as error:
        where = f"cannot write to {error.filename or output} ({error.strerror})"
        raise InputError(f"--output: {where}; make room or give another folder, finished cases are kept") from error
    except KeyboardInterrupt:
        print("rodcheck: interrupted; start it again to go on", file=sys.stderr)
        return INTERRUPTED
    print(outcome.summary, end="")
    print(f"\nReport: {output / 'index.html'}")
    return 0 if outcome.as_expected else NOT_PASSED


@app.command
def history(
    case: str,
    quantity: str | None = None,
    /,
    *,
    folder: Path = Path("nightly/history"),
    json: Annotated[bool, Parameter(name="--json", negative=())] = False,
) -> int:
    """Print what nightly runs said of a case.

    Parameters
    ----------
    case
        its name
    quantity
        one of its quantities, such as contact_force
    folder
        of the history
    json
        print one JSON array, an object for each quantity of each solver in each run
    """
    if folder.exists() and not folder.is_dir():
        raise InputError(f"--folder: found the file {folder}; give a folder")
    from reports.nightly.history import read_history
    from reports.nightly.history_table import as_json, print_history

    found = read_history(folder)
    for note in found.notes:
        print(f"rodcheck: {note}", file=sys.stderr)
    rows = found.rows(case, quantity)
    if not rows:
        known = found.cases()
        if case in known:
            others = sorted({row.quantity for row in found.rows(case)})
            raise InputError(f"found no quantity {quantity!r} of {case} in {folder}; it has {', '.join(others)}")
        has = f"it has {', '.join(known)}" if known else "it has none; `rodcheck nightly` writes it"
        raise InputError(f"found no case {case!r} in {folder}; {has}")
    if json:
        print(as_json(rows))
    else:
        print_history(rows)
    return 0


@app.command
def deck(
    case: str,
    /,
    *,
    output: Annotated[Path, Parameter(name=["--output", "-o"])],
    refinement: Annotated[int, Parameter(validator=validators.Number(gte=1, lte=8))] = 1,
) -> int:
    """Write a case as an input file for Abaqus and CalculiX.

    Parameters
    ----------
    case
        name of a case of the library, or path of a case file
    output
        the file, ending in .inp
    refinement
        elements along each axis of a coarse cell; the 3D reference's meshes have 1, 2 and 3
    """
    from cases.loader import load_case

    loaded = load_case(case)
    if output.suffix != ".inp" or output.is_dir() or not output.parent.is_dir():
        raise InputError(f"--output: found {output}; give a file whose name ends in .inp, in a folder that exists")
    from reference3d.peers.deck import deck_text, make_deck
    from reports.store import write_whole

    text = deck_text(make_deck(loaded.scene, refinement))
    try:
        write_whole(output, text)
    except OSError as error:
        where = f"cannot write to {error.filename or output} ({error.strerror})"
        raise InputError(f"--output: {where}; give another place") from error
    print(output)
    return 0


@app.command
def verify(*, output: Path = Path("report")) -> int:
    """Hold both models against closed forms and published benchmarks; print and write what came of it.

    Parameters
    ----------
    output
        folder for verification.html
    """
    _require_folder(output)
    outcomes = _verification_outcomes()
    if outcomes is None:
        return NOT_PASSED
    from reports.verification.registry import GROUPS
    from reports.verification.table import print_verification

    page = _write_verification(outcomes, output, in_report=_has_overview(output))
    print_verification(GROUPS, outcomes)
    print(page)
    return 0 if all(outcome.verdict == "pass" for outcome in outcomes.values()) else NOT_PASSED


@app.command
def performance(*, output: Path = Path("report")) -> int:
    """Measure what the rod model costs; print and write what was found.

    Parameters
    ----------
    output
        folder for performance.html
    """
    _require_folder(output)
    page = _write_performance(output, in_report=_has_overview(output), aloud=True)
    if page is None:
        return NOT_PASSED
    print(page)
    return 0


@app.command
def stability(*, output: Path = Path("report")) -> int:
    """Drive methods to where they fail, the rod model beside plain alternatives; print and write what was seen.

    Parameters
    ----------
    output
        folder for stability.html
    """
    _require_folder(output)
    found = _stability()
    if found is None:
        return NOT_PASSED
    from reports.stability.page import summary

    page = _write_stability(found, output, in_report=_has_overview(output))
    print("\n".join(summary(found)))
    print(page)
    return 0 if found.all_hold else NOT_PASSED


@schema_app.command(name="result")
def schema_result() -> int:
    """Print the JSON Schema of what `rodcheck solve --json` prints."""
    from reports.result import Result

    print(json.dumps(Result.model_json_schema(), indent=2))
    return 0


@schema_app.command(name="case")
def schema_case() -> int:
    """Print the JSON Schema of a case file."""
    from cases.schema import case_schema

    print(json.dumps(case_schema(), indent=2))
    return 0


def _require_folder(output: Path) -> None:
    if output.exists() and not output.is_dir():
        raise InputError(f"--output: found the file {output}; give a folder")


def _has_overview(output: Path) -> bool:
    return (output / "index.html").is_file()


def _written(write: Callable[[], Path]) -> Path:
    """The path of what was written."""
    return _all_written(lambda: (write(),))[0]


def _all_written(write: Callable[[], tuple[Path, ...]]) -> tuple[Path, ...]:
    """The paths of what was written."""
    try:
        return write()
    except OSError as error:
        where = f"cannot write to {error.filename or 'the folder'} ({error.strerror})"
        raise InputError(f"--output: {where}; give another folder") from error


def _written_fields(solution: Solution, path: Path) -> tuple[Path, ...]:
    from reports.fields import write_fields

    try:
        return write_fields(solution, path)
    except OSError as error:
        where = f"cannot write to {error.filename or path} ({error.strerror})"
        raise InputError(f"--vtu: {where}; give another place") from error


def _written_picture(chosen: AdaptiveSolution, path: Path) -> Path:
    from reports.levels_figure import write_levels

    try:
        return write_levels(chosen, path)
    except OSError as error:
        where = f"cannot write to {error.filename or path} ({error.strerror})"
        raise InputError(f"--picture: {where}; give another place") from error


def _tolerance(given: str | None) -> float:
    """A relative tolerance written as a fraction or in per cent."""
    from rodmodel.adaptive import LARGEST, SMALLEST

    text = "0.1%" if given is None else given.strip()
    try:
        value = float(text.removesuffix("%")) * (0.01 if text.endswith("%") else 1.0)
    except ValueError:
        value = float("nan")
    if not SMALLEST <= value <= LARGEST:
        limits = f"{100.0 * SMALLEST:g}% to {100.0 * LARGEST:g}%"
        raise InputError(f"--tolerance: found {given}; give {limits}, such as 0.1% or 0.001")
    return value


def _verification_outcomes(cache: Cache | None = None) -> dict[str, Outcome] | None:
    """What came of the verification checks; None, with the reason on standard error, if a check failed to run."""
    from reports.processes import ProcessFailed
    from reports.verification.registry import verify as carry_out

    try:
        return carry_out(cache)
    except ProcessFailed as error:
        print(f"rodcheck: verification: {error}", file=sys.stderr)
        return None


def _write_verification(outcomes: Mapping[str, Outcome], output: Path, *, in_report: bool) -> Path:
    from reports.verification.page import write_verification
    from reports.verification.registry import GROUPS

    return _written(lambda: write_verification(GROUPS, outcomes, output, in_report=in_report))


def _write_performance(output: Path, *, in_report: bool, aloud: bool = False) -> Path | None:
    """The performance page, measured and written; None, with the reason on standard error, if it cannot be measured.

    aloud : whether to print what was found
    """
    from reports.performance.measure import measure
    from reports.performance.page import write_performance
    from reports.performance.wording import summary
    from reports.processes import ProcessFailed

    try:
        found = measure()
    except ProcessFailed as error:
        print(f"rodcheck: performance: {error}", file=sys.stderr)
        return None
    page = _written(lambda: write_performance(found, output, in_report=in_report))
    if aloud:
        print("\n".join(summary(found.series, found.breakdown, found.study)))
    return page


def _stability(cache: Cache | None = None) -> Stability | None:
    """What all sweeps found; None, with the reason on standard error, if one failed to run."""
    from reports.processes import ProcessFailed
    from reports.stability.registry import carry_out

    try:
        return carry_out(cache)
    except ProcessFailed as error:
        print(f"rodcheck: stability: {error}", file=sys.stderr)
        return None


def _write_stability(found: Stability, output: Path, *, in_report: bool) -> Path:
    from reports.stability.page import write_stability

    return _written(lambda: write_stability(found, output, in_report=in_report))


def _write_choices(runs: Sequence[CaseRun | Failure], output: Path) -> Path:
    from reports.chart.choices_page import write_choices
    from reports.runner import CaseRun

    charts = [run.chart for run in runs if isinstance(run, CaseRun) and run.chart is not None]
    return _written(lambda: write_choices(charts, output, in_report=True))


def _load_all(names: Sequence[str]) -> list[Case]:
    """Load every case before any is solved, so that a wrong name costs no time."""
    from cases.loader import load_case

    cases = [load_case(name) for name in names]
    for index, case in enumerate(cases):
        if any(case.name == other.name for other in cases[:index]):
            raise InputError(f"found the case '{case.name}' twice; name each case once")
    return cases


def _cache(folder: Path | None, none: bool) -> Cache | None:
    """The cache to use."""
    from reports.cache import Cache, default_folder

    if none:
        if folder is not None:
            raise InputError("--cache: found with --no-cache; give one of the two")
        return None
    if folder is not None and folder.exists() and not folder.is_dir():
        raise InputError(f"--cache: found the file {folder}; give a folder")
    try:
        return Cache(default_folder() if folder is None else folder)
    except RuntimeError as error:
        raise InputError("--cache: found no home folder to keep results in; give a folder, or --no-cache") from error


def _run_all(cases: Sequence[Case], cache: Cache | None, peers: bool) -> list[CaseRun | Failure]:
    from reports.progress import run_with_progress
    from reports.runner import CaseRun

    runs = run_with_progress(cases, cache, peers)
    notes = [note for run in runs if isinstance(run, CaseRun) for note in run.notes]
    for note in dict.fromkeys(notes):
        print(f"rodcheck: {note}", file=sys.stderr)
    return runs


def _quick_looks(cases: Sequence[Case]) -> int:
    """Print a quick look at each case, solved in a process of its own; the exit code."""
    from reports.processes import ProcessFailed, in_own_process
    from reports.progress import status
    from reports.quick import print_quick_look, quick_look

    sound = True
    for case in cases:
        try:
            with status(case.name) as shown:
                found = in_own_process(quick_look, case, shown.update)
        except ProcessFailed as error:
            print(f"rodcheck: {case.name}: {error}", file=sys.stderr)
            sound = False
            continue
        print_quick_look(found)
        sound = sound and found.sound
    return 0 if sound else NOT_PASSED


def _charted(runs: Sequence[CaseRun | Failure], cache: Cache | None) -> list[CaseRun | Failure]:
    """The runs with charts of speed against accuracy."""
    from reports.chart.measure import charted
    from reports.progress import status

    with status("charts") as shown:
        return charted(runs, lambda case: shown.update(f"{case.name}: chart"), cache)


def _exit_code(runs: Sequence[CaseRun | Failure]) -> int:
    from reports.runner import passed

    return 0 if all(passed(run) for run in runs) else NOT_PASSED
