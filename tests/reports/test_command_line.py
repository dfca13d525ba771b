"""The command line: what stands on which stream, and exit codes."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import replace
from importlib.resources import files
from pathlib import Path

import jsonschema
import pytest

from cases.loader import LIBRARY, library_names
from reports import command_line
from reports.processes import ProcessFailed
from reports.runner import CaseRun, Failure

CASE = "two-cantilevers-e50-g0"


def passing(run: CaseRun) -> CaseRun:
    return replace(run, comparisons=tuple(replace(found, verdict="pass") for found in run.comparisons))


@pytest.fixture
def solved(monkeypatch: pytest.MonkeyPatch):
    """Answer `compare` and `report` with given runs instead of solving, and draw nothing."""

    def answer(*runs: CaseRun | Failure) -> None:
        monkeypatch.setattr("reports.progress.run_cases", lambda *_: iter(runs))
        monkeypatch.setattr("reports.site.in_own_process", lambda *_: (_ for _ in ()).throw(ProcessFailed("not drawn")))

    return answer


@pytest.mark.parametrize(
    "arguments",
    [
        ["solve"],
        ["solve", "no-such-case"],
        ["solve", CASE, "--lvel", "3"],
        ["solve", CASE, "--level", "0"],
        ["solve", CASE, "--level", "99"],
        ["solve", CASE, "--level", "five"],
        ["solve", CASE, "--order", "1"],
        ["solve", CASE, "--level", "auto", "--order", "5"],
        ["solve", CASE, "--level", "5", "--tolerance", "0.1%"],
        ["solve", CASE, "--tolerance", "fine"],
        ["solve", CASE, "--tolerance", "0"],
        ["solve", CASE, "--tolerance", "50%"],
        ["solve", CASE, "--picture", "levels.png"],
        ["solve", CASE, "--model", "abaqus"],
        ["solve", CASE, "--model", "reference", "--level", "3"],
        ["solve", CASE, CASE],
        ["compare"],
        ["solve", CASE, "--mesh", "bars.msh"],
        ["solve", CASE, "--model", "reference", "--mesh", "no such file.msh"],
        ["solve", CASE, "--vtu", "fields.vtk"],
        ["solve", CASE, "--vtu", f"{__file__}/below/a/file.vtu"],
        ["compare", CASE, CASE],
        ["compare", CASE, "--cache", __file__],
        ["report", CASE, "--no-cache", "--cache", "folder"],
        ["compare", CASE, "no-such-case"],
        ["report", "no-such-case"],
        ["deck", CASE],
        ["deck", CASE, "-o", "deck.txt"],
        ["deck", CASE, "-o", "no-such-folder/deck.inp"],
        ["deck", CASE, "-o", "deck.inp", "--refinement", "0"],
        ["schema", "nothing"],
        ["nonsense"],
    ],
    ids=" ".join,
)
def test_bad_input_is_one_sentence_on_standard_error_and_exit_code_2(
    arguments: Sequence[str], capsys: pytest.CaptureFixture[str]
) -> None:
    code = command_line.run(arguments)

    shown = capsys.readouterr()
    assert code == 2
    assert shown.out == ""
    assert shown.err.startswith("rodcheck: ")
    assert shown.err.count("\n") == 1
    assert "Traceback" not in shown.err


def test_a_case_file_with_a_fault_is_bad_input(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "broken.toml"
    file.write_text("title = ")

    code = command_line.run(["solve", str(file)])

    shown = capsys.readouterr()
    assert (code, shown.out) == (2, "")
    assert "broken.toml" in shown.err
    assert shown.err.count("\n") == 1


def test_a_deck_is_written_whole(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = command_line.run(["deck", "crossed-cantilevers", "-o", str(tmp_path / "deck.inp")])

    assert (code, capsys.readouterr().out) == (0, f"{tmp_path / 'deck.inp'}\n")
    text = (tmp_path / "deck.inp").read_text()
    assert text.startswith("*HEADING\n")
    assert text.endswith("*END STEP\n")


def test_a_case_that_a_deck_cannot_express_leaves_no_file(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    case = Path(str(files("cases").joinpath("library", "three-leaf-spring.toml"))).read_text()
    (tmp_path / "round.toml").write_text(case.replace("gap = 0", "gap = { radius = 500, station = 185 }", 1))

    code = command_line.run(["deck", str(tmp_path / "round.toml"), "-o", str(tmp_path / "deck.inp")])

    shown = capsys.readouterr()
    assert (code, shown.out) == (2, "")
    assert "contacts.upper.gap" in shown.err
    assert [path.name for path in tmp_path.iterdir()] == ["round.toml"]


def test_list_prints_every_case_with_its_title(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["list"]) == 0

    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == list(library_names())


def test_solve_json_prints_exactly_one_object_that_the_schema_describes(
    capsys: pytest.CaptureFixture[str],
) -> None:
    assert command_line.run(["schema", "result"]) == 0
    schema = json.loads(capsys.readouterr().out)

    code = command_line.run(["solve", CASE, "--level", "2", "--order", "3", "--json"])

    shown = capsys.readouterr()
    printed = json.loads(shown.out)
    assert code == 0
    jsonschema.validate(printed, schema)
    assert (printed["case"], printed["model"], printed["level"], printed["order"]) == (CASE, "rod", 2, 3)
    assert printed["converged"] is True


@pytest.fixture
def graded(tmp_path: Path) -> str:
    """Path of a case whose levels and orders differ element by element."""
    case = (LIBRARY / f"{CASE}.toml").read_text(encoding="utf-8")
    case = case.replace("level = 5", "level = 2").replace("order = 6", "order = 3")
    path = tmp_path / "graded.toml"
    path.write_text(case + "\n[rod_model.levels]\nlower = [3, 2, 1, 1, 1, 1]\n[rod_model.orders]\nupper = 4\n")
    return str(path)


def test_solve_takes_levels_and_orders_of_elements_from_the_case(
    graded: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command_line.run(["schema", "result"]) == 0
    schema = json.loads(capsys.readouterr().out)

    assert command_line.run(["solve", graded, "--level", "case", "--json"]) == 0

    printed = json.loads(capsys.readouterr().out)
    jsonschema.validate(printed, schema)
    assert printed["level"] == {"lower": [3, 2, 1, 1, 1, 1], "upper": [2] * 6}
    assert printed["order"] == {"lower": [3] * 6, "upper": [4] * 6}


def test_level_and_order_that_are_given_hold_for_all_elements(graded: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["solve", graded, "--level", "2", "--order", "3"]) == 0

    assert "h2, p = 3" in capsys.readouterr().out


def test_solve_for_people_names_units(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["solve", CASE, "--level", "2", "--order", "3"]) == 0

    shown = capsys.readouterr().out
    for text in ("force, N", "edges middle, mm", "M/W, MPa", "h2, p = 3", "converged"):
        assert text in shown


def test_an_unconverged_solve_shows_its_result_and_exits_with_1(
    case_run: CaseRun, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    unfinished = replace(case_run.rod, quantities=replace(case_run.rod.quantities, outcome="cycling"))
    monkeypatch.setattr("reports.runner.run_rod", lambda *_, **__: unfinished)

    code = command_line.run(["solve", CASE, "--level", "case", "--json"])

    shown = capsys.readouterr()
    assert code == 1
    assert json.loads(shown.out)["converged"] is False
    assert "not converged: cycling" in shown.err


def test_case_schema_is_json(capsys: pytest.CaptureFixture[str]) -> None:
    assert command_line.run(["schema", "case"]) == 0

    assert "rods" in json.loads(capsys.readouterr().out)["properties"]


def test_compare_exits_with_0_if_everything_passed(
    case_run: CaseRun, solved, capsys: pytest.CaptureFixture[str]
) -> None:
    solved(passing(case_run))

    assert command_line.run(["compare", CASE]) == 0
    assert "pass" in capsys.readouterr().out


@pytest.mark.parametrize("verdict", ["fail", "not resolved"])
def test_compare_exits_with_1_if_one_comparison_did_not_pass(
    verdict: str, case_run: CaseRun, solved, capsys: pytest.CaptureFixture[str]
) -> None:
    first, *others = passing(case_run).comparisons
    solved(replace(case_run, comparisons=(replace(first, verdict=verdict), *others)))

    assert command_line.run(["compare", CASE]) == 1
    assert verdict in capsys.readouterr().out


def test_a_case_that_failed_is_shown_with_its_reason_beside_the_others(
    case_run: CaseRun, solved, capsys: pytest.CaptureFixture[str]
) -> None:
    solved(Failure(case_run.case, "the mesh is singular"), passing(case_run))

    assert command_line.run(["compare", CASE]) == 1
    shown = capsys.readouterr().out
    assert "the mesh is singular" in shown
    assert "pass" in shown


@pytest.mark.slow
@pytest.mark.parametrize("verdict", ["fail", "not resolved"])
def test_report_shows_verdicts_and_fails_on_none_of_them(
    verdict: str, case_run: CaseRun, solved, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    first, *others = passing(case_run).comparisons
    solved(replace(case_run, comparisons=(replace(first, verdict=verdict), *others)))

    assert command_line.run(["report", CASE, "--no-charts", "--output", str(tmp_path)]) == 0
    assert verdict in (tmp_path / "index.html").read_text()


@pytest.mark.slow
def test_report_exits_with_1_where_a_case_failed_to_run(case_run: CaseRun, solved, tmp_path: Path) -> None:
    solved(Failure(case_run.case, "the mesh is singular"), passing(case_run))

    assert command_line.run(["report", CASE, "--no-charts", "--output", str(tmp_path)]) == 1
    assert "the mesh is singular" in (tmp_path / "index.html").read_text()


@pytest.mark.slow
def test_a_reader_that_stops_reading_is_no_error() -> None:
    command = f"{sys.executable} -c 'from reports.command_line import main; main()' schema case | head -n 1"
    done = subprocess.run(["bash", "-o", "pipefail", "-c", command], capture_output=True, text=True, check=False)

    assert done.stdout == "{\n"
    assert done.stderr == ""
    assert done.returncode == 0


def test_report_refuses_a_file_as_its_folder_before_solving(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "taken"
    file.write_text("")

    assert command_line.run(["report", CASE, "--output", str(file)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


def test_fields_are_written_where_asked_and_named_on_the_error_stream(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "fields.vtu"

    code = command_line.run(["solve", CASE, "--level", "1", "--order", "2", "--json", "--vtu", str(path)])

    shown = capsys.readouterr()
    assert code == 0
    assert json.loads(shown.out)["converged"] is True
    assert shown.err == f"rodcheck: wrote {path}\nrodcheck: wrote {tmp_path / 'fields-contact.vtu'}\n"
    assert {file.name for file in tmp_path.iterdir()} == {"fields.vtu", "fields-contact.vtu"}


def test_an_interrupt_exits_with_130_and_no_traceback(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("reports.runner.run_rod", interrupted)

    assert command_line.run(["solve", CASE, "--level", "case", "--json"]) == 130
    shown = capsys.readouterr()
    assert shown.out == ""
    assert "Traceback" not in shown.err


@pytest.mark.slow
def test_the_command_itself_keeps_its_streams_apart() -> None:
    call = "from reports.command_line import main; main()"

    done = subprocess.run(
        [sys.executable, "-c", call, "solve", "no-such-case", "--json"],
        capture_output=True,
        text=True,
        check=False,
    )

    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.count("\n") == 1


def test_help_says_what_every_argument_is() -> None:
    commands = {name: command_line.app[name] for name in command_line.app if not name.startswith("-")}
    for name, command in commands.items():
        arguments = command.assemble_argument_collection(parse_docstring=True) if command.default_command else ()
        assert all(argument.parameter.help for argument in arguments), name


@pytest.mark.slow
@pytest.mark.parametrize(
    ("command", "needless"),
    [
        ("--help", {"numpy", "scipy", "pydantic"}),
        ("schema", {"numpy", "scipy", "pydantic"}),
        ("list", {"rodmodel", "reference3d", "gmsh", "pyvista", "plotly"}),
    ],
)
def test_what_solves_nothing_imports_nothing_that_solves_or_draws(command: str, needless: set[str]) -> None:
    call = (
        f"import sys; from reports.command_line import run; run(['{command}']);"
        f"print(sorted({needless} & set(sys.modules)), file=sys.stderr)"
    )

    done = subprocess.run([sys.executable, "-c", call], capture_output=True, text=True, check=True)

    assert done.stderr.strip() == "[]"
