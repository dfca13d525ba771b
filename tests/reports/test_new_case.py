"""New case files: from flags, from questions on a terminal, by default; whole, commented and never over another."""

from __future__ import annotations

import io
import json
import os
import pty
import re
import sys
import tomllib
from pathlib import Path

import jsonschema
import pytest

import rodmodel
from cases.loader import LIBRARY, load_case
from cases.schema import case_schema
from reports import command_line
from reports.new_case.command import SCHEMA, schema_text
from reports.new_case.templates import TEMPLATES, Template, case_text
from reports.processes import in_own_process
from reports.quick import quick_look

BY_NAME = [pytest.param(template, id=template.name) for template in TEMPLATES]


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """An empty folder to be in, without a terminal."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sys, "stdin", io.StringIO())
    return tmp_path


@pytest.mark.parametrize("template", BY_NAME)
def test_the_file_of_a_template_loads_and_solves_and_fits_the_schema(template: Template, folder: Path) -> None:
    assert command_line.run(["new", "mine", "--template", template.name]) == 0

    case = load_case("mine.toml")
    jsonschema.Draft202012Validator(case_schema()).validate(tomllib.loads(Path("mine.toml").read_text()))
    solution = rodmodel.solve(case.scene, level=2, order=4)
    assert solution.outcome == "converged"
    assert case.compare


@pytest.mark.parametrize("template", BY_NAME)
def test_every_key_of_a_template_is_explained_where_it_first_stands(template: Template) -> None:
    explained, seen = set(), set()
    for line in case_text(template, "A title", {}).splitlines():
        key, equals, rest = line.partition(" = ")
        if equals and not line.startswith("#") and key not in seen:
            seen.add(key)
            explained |= {key} if "#" in rest or '"""' in rest else set()
    assert seen == explained


@pytest.mark.slow
@pytest.mark.parametrize("template", BY_NAME)
def test_both_models_agree_on_every_template_as_far_as_a_quick_look_tells(template: Template, folder: Path) -> None:
    (folder / "mine.toml").write_text(case_text(template, "A title", {}), encoding="utf-8")

    found = in_own_process(quick_look, load_case("mine.toml"))

    assert found.sound
    assert {look.reading for look in found.looks} == {"agree"}


def test_flags_are_what_the_file_says(folder: Path) -> None:
    flags = [
        "--length",
        "0.4 m",
        "--width",
        "20",
        "--young-modulus",
        "70 GPa",
        "--force",
        "-2 kN",
        "--title",
        'A "bar"',
    ]

    assert command_line.run(["new", "mine", "--template", "single-rod", *flags]) == 0

    case = load_case("mine.toml")
    (rod,) = case.scene.rods
    assert (case.title, rod.length) == ('A "bar"', 400.0)
    assert rod.section.width == 20.0
    assert rod.material.young_modulus == 70e3
    assert case.scene.loads[0].force == (0.0, -2000.0, 0.0)
    assert 'young_modulus = "70 GPa"' in Path("mine.toml").read_text()


def test_without_a_terminal_nothing_is_asked_and_what_was_taken_is_said(
    folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command_line.run(["new", "mine"]) == 0

    shown = capsys.readouterr()
    assert shown.out == "mine.toml\n"
    assert "took template = single-rod, length = 300 mm, " in shown.err
    assert "next: rodcheck check mine.toml" in shown.err


@pytest.mark.parametrize(
    "arguments",
    [
        ["a/b"],
        ["<script>"],
        ["../mine\n"],
        [".."],
        ["two-cantilevers-e50-g0"],
        ["mine", "--template", "two rods"],
        ["mine", "--gap", "1"],
        ["mine", "--length", "0"],
        ["mine", "--length", "nan"],
        ["mine", "--length", "20 mm"],
        ["mine", "--force", "1 MPa"],
        ["mine", "--poisson-ratio", "0.5"],
        ["mine", "--title", "two\nlines"],
        ["mine", "--title", "\x7f"],
        ["mine", "--template", "two-rods", "--overlap", "1 m"],
        ["mine", "--template", "two-rods", "--gap", "-20"],
        ["mine", "--template", "curved-rod", "--radius", "2"],
    ],
    ids=" ".join,
)
def test_what_no_case_can_be_made_of_is_one_sentence_and_no_file(
    arguments: list[str], folder: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = command_line.run(["new", *arguments])

    shown = capsys.readouterr()
    assert (code, shown.out) == (2, "")
    assert shown.err.startswith("rodcheck: ")
    assert shown.err.count("\n") == 1
    assert list(folder.iterdir()) == []


def test_nothing_is_overwritten(folder: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (folder / "mine.toml").write_text("mine")
    (folder / "link.toml").symlink_to("nowhere")
    (folder / SCHEMA).write_text("{}")

    codes = [command_line.run(["new", name]) for name in ("mine", "link", "other")]

    assert codes == [2, 2, 0]
    assert "of another version and was left" in capsys.readouterr().err
    assert (folder / "mine.toml").read_text() == "mine"
    assert (folder / SCHEMA).read_text() == "{}"
    assert sorted(path.name for path in folder.iterdir()) == [SCHEMA, "link.toml", "mine.toml", "other.toml"]


def test_the_first_line_leads_editors_to_the_schema_beside_the_file(folder: Path) -> None:
    command_line.run(["new", "mine"])

    first = Path("mine.toml").read_text().splitlines()[0]
    assert json.loads((folder / first.removeprefix("#:schema ")).read_text()) == case_schema()


def test_the_schema_beside_the_library_is_that_of_the_code() -> None:
    same = (LIBRARY / SCHEMA).read_text(encoding="utf-8") == schema_text()
    assert same, "renew it: rodcheck schema case > cases/library/case.schema.json"


def test_on_a_terminal_what_is_missing_is_asked_and_asked_again(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    ours, theirs = pty.openpty()
    answers = ["two", "4", "A bar", "0", "80 cm", "", "", "0.25", "", "-3 kN"]
    os.write(ours, "".join(f"{answer}\n" for answer in answers).encode())
    monkeypatch.setattr(sys, "stdin", os.fdopen(theirs))

    assert command_line.run(["new", "mine", "--young-modulus", "100 GPa"]) == 0

    case = load_case("mine.toml")
    assert case.title == "A bar"
    assert case.scene.rods[0].length == 800.0
    assert (case.scene.rods[0].material.young_modulus, case.scene.rods[0].material.poisson_ratio) == (100e3, 0.25)
    assert re.search(r'force = \[0, "-3 kN", 0\]', Path("mine.toml").read_text())


def test_answers_that_end_leave_nothing(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    monkeypatch.setattr(sys, "stdin", Terminal("1\n"))

    assert command_line.run(["new", "mine"]) == 2
    assert list(folder.iterdir()) == []
