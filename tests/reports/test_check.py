"""A case looked at before it is solved: tables, size, warnings, picture, and no solver asked."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

import reference3d
import rodmodel
from cases.case import Case
from cases.loader import load_case
from cases.scene import ContactPair, Ground, RodFace, Scene, SectionForce
from reports import command_line
from reports.check.size import reference_unknowns, rod_unknowns
from reports.check.summary import summary
from reports.check.undeformed import undeformed

CASE = "two-cantilevers-e50-g05"
EVERYTHING = Path(__file__).parent.parent / "cases" / "everything.toml"


@pytest.fixture
def case() -> Case:
    return load_case(CASE)


def changed(case: Case, **scene: object) -> Case:
    old = case.scene
    parts = {key: getattr(old, key) for key in ("name", "rods", "supports", "loads", "contacts", "joints", "beds")}
    return replace(case, scene=Scene(**{**parts, **scene}))


def warned(case: Case) -> str:
    return "\n".join(summary(case).warnings)


def test_everything_that_a_file_says_stands_in_a_table() -> None:
    found = summary(load_case(EVERYTHING))

    cells = {cell for table in found.tables for row in table.rows for cell in row}
    for said in (
        "helix of radius 20 mm, pitch -7.07 mm, 3 turns",
        "line, twisted by 90°",
        "spline through 5 points",
        "path of 2 pieces",
        "box 20 x 30 mm with walls of 2 mm",
        "E = 200 GPa, ν = 0.3, 7850 kg/m³",
        "y, turn x, set to (-0.5, 0.017453)",
        "the whole section, moved by (0, -1, 0) mm, turned by (0.0087266, 0, 0) rad",
        "post (end), beam (start), brace (start)",
        "bottom face, 0.05 N/mm³, pushes and pulls",
        "(0, -9810, 0) mm/s²",
        "(0, 0, 1000) N mm",
        "0.2 MPa",
        "1 mm",
    ):
        assert said in cells


@pytest.mark.parametrize(
    "name",
    [CASE, "bar-lifting-off-a-bed", pytest.param("crossed-cantilevers", marks=pytest.mark.slow), "three-leaf-spring"],
)
def test_expected_unknowns_are_about_those_of_the_solutions(name: str) -> None:
    case = load_case(name)

    rod = rodmodel.solve(case.scene, case.rod_model.level, case.rod_model.order).cost.unknowns
    coarsest = reference3d.solve(case.scene, 1).cost.unknowns

    # Elements that the search for edges adds; what supports and planes of symmetry take away.
    assert rod_unknowns(case) == pytest.approx(rod, rel=0.15)
    assert reference_unknowns(case.scene)[0] == pytest.approx(coarsest, rel=0.2)


def test_undeformed_rods_lie_where_the_solved_ones_did() -> None:
    case = load_case("curved-bar-on-straight-bar")
    solution = rodmodel.solve(case.scene, 1, 2)

    for rod in undeformed(case.scene).rods:
        position, axes = solution.frame(rod.rod, rod.station)
        np.testing.assert_allclose(rod.position, position, atol=1e-9)
        np.testing.assert_allclose(rod.axes, axes, atol=1e-12)
        assert not rod.displacement.any()


def test_a_case_with_nothing_to_remark_has_no_warning(case: Case) -> None:
    graded = replace(case, scene=rodmodel.adapt.graded(case.scene))

    assert warned(graded) == ""


def test_a_gap_that_is_not_the_drawn_one_is_said(case: Case) -> None:
    # The bars are drawn 0.5 mm apart, which is the gap that the file gives.
    (pair,) = case.scene.contacts

    assert "drawn 0.5 mm apart, and a gap of 0 mm is given: the given one counts" in warned(
        changed(case, contacts=(replace(pair, gap=0.0),))
    )
    assert "apart" not in warned(changed(case, contacts=(replace(pair, gap=0.5),)))
    assert "apart" not in warned(changed(case, contacts=(replace(pair, gap="drawn"),)))


def test_rods_that_contact_alone_holds_are_named(case: Case) -> None:
    clamp_of_lower = case.scene.supports[:1]

    assert "upper is held by contact alone in some direction" in warned(changed(case, supports=clamp_of_lower))


@pytest.mark.slow
def test_a_rod_that_nothing_holds_is_a_problem_and_the_picture_is_drawn(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = Path(str(EVERYTHING)).read_text(encoding="utf-8")
    file = tmp_path / "loose.toml"
    file.write_text(text.replace('[[supports]]\nkind = "clamp"\nrod = "snake"\nend = "start"\n', ""), encoding="utf-8")

    code = command_line.run(["check", str(file)])

    shown = capsys.readouterr()
    assert code == 2
    assert "rodcheck: loose: supports: found nothing that holds 'snake' against moving along" in shown.err
    assert (tmp_path / "loose-scene.png").is_file()


@pytest.mark.parametrize(
    ("changes", "warning"),
    [
        ({"loads": ()}, "Nothing loads the rods"),
        ({"loads": (SectionForce("upper", 100.0, (0.0, 0.0, 0.0)),)}, "Load 1, on upper, is zero."),
    ],
)
def test_what_does_nothing_is_said(case: Case, changes: dict[str, object], warning: str) -> None:
    assert warning in warned(changed(case, **changes))


def test_without_comparison_there_is_no_verdict(case: Case) -> None:
    assert "Nothing is compared" in warned(replace(case, compare=()))


def test_long_elements_at_clamps_are_named(case: Case) -> None:
    assert "(lower start: 66.67 mm, upper end: 66.67 mm)" in warned(case)


def test_an_interference_alone_loads_the_rods(case: Case) -> None:
    pair = ContactPair("press", RodFace("lower", "top"), Ground(), (250.0, 300.0), -0.1)

    assert "Nothing loads" not in warned(changed(case, loads=(), contacts=(pair,)))


@pytest.mark.slow
def test_the_command_solves_nothing_and_draws_the_scene(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def solve(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(rodmodel, "solve", solve)
    monkeypatch.setattr(reference3d, "solve", solve)

    code = command_line.run(["check", CASE, "-o", str(tmp_path / "scene.png")])

    shown = capsys.readouterr()
    assert code == 0
    assert "Two cantilevers, E2 = 50 GPa, gap 0.5 mm" in shown.out
    assert shown.out.endswith(f"{tmp_path / 'scene.png'}\n")
    colours = np.unique(np.asarray(Image.open(tmp_path / "scene.png").convert("RGB")).reshape(-1, 3), axis=0)
    assert len(colours) > 50


@pytest.mark.parametrize("output", ["scene.jpg", ".", "no-such-folder/scene.png"])
def test_a_picture_that_cannot_be_written_is_refused_before_anything_is_drawn(
    output: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command_line.run(["check", CASE, "-o", output]) == 2
    assert capsys.readouterr().out == ""
