"""A quick look: what it says of two rough answers, and what it does not."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cases.case import Case, Check
from cases.loader import load_case
from cases.scene import SceneError
from reports import command_line, quick
from reports.quick import Look, QuickLook, print_quick_look, quick_look

CASE = "two-cantilevers-e50-g0"
FORCE = Check("contact_force", "overlap", 0.003)


def look(difference: float | None, rod: float | None, reference: float | None) -> Look:
    return Look(FORCE, (1.0,), (1.0,), difference, rod, reference)


@pytest.mark.parametrize(
    ("difference", "rod", "reference", "reading"),
    [
        (0.01, 0.008, 0.003, "agree"),
        (0.01, 0.005, 0.003, "differ"),
        (1e-12, 0.0, 0.0, "agree"),
        (0.0, None, 0.1, "not known"),
        (0.0, 0.1, None, "not known"),
        (None, None, None, "not known"),
    ],
)
def test_two_answers_agree_where_they_are_apart_by_no_more_than_both_are_uncertain(
    difference: float | None, rod: float | None, reference: float | None, reading: str
) -> None:
    assert look(difference, rod, reference).reading == reading


def test_what_is_not_known_is_not_taken_for_a_difference_and_a_solver_that_failed_for_no_answer() -> None:
    case = load_case(CASE)

    assert QuickLook(case, (look(None, None, None),), (), (), ()).sound
    assert not QuickLook(case, (look(0.01, 0.0, 0.0),), (), (), ()).sound
    assert not QuickLook(case, (look(0.0, 0.0, 0.0),), (), (), ("3D did not converge: cycling",)).sound


@pytest.mark.slow
def test_a_quick_look_holds_the_independent_values_of_the_papers_case() -> None:
    found = quick_look(load_case(CASE), lambda _: None)

    looks = {(each.check.quantity, each.check.of): each for each in found.looks}
    force = looks["contact_force", "overlap"]
    # truth/e50_g0.json: 246.93 N, good to 0.002 %
    assert force.rod_uncertainty is not None
    assert force.reference_uncertainty is not None
    assert abs(force.rod[0] / 246.93 - 1.0) < force.rod_uncertainty
    assert abs(force.reference[0] / 246.93 - 1.0) < force.reference_uncertainty
    assert {each.reading for each in found.looks} == {"agree"}


def test_it_says_that_it_is_no_verdict_and_never_pass(capsys: pytest.CaptureFixture[str]) -> None:
    case = replace(load_case(CASE), title="[/] <b>")

    print_quick_look(QuickLook(case, (look(0.0, 0.0, 0.0),), ("3D, mesh 1: 10 unknowns",), (), ()))

    shown = capsys.readouterr().out
    assert "[/] <b> (two-cantilevers-e50-g0): a quick look, no verdict" in shown
    assert "Verdicts come from rodcheck compare" in shown
    assert "pass" not in shown


def test_3d_that_would_take_long_is_left_out_and_said(monkeypatch: pytest.MonkeyPatch) -> None:
    case = load_case("bar-lifting-off-a-bed")
    monkeypatch.setattr(quick, "MOST_UNKNOWNS", 1000)

    found = quick_look(case, lambda _: None)

    assert "3D mesh 1 is left out" in found.notes[0]
    assert {each.reading for each in found.looks} == {"not known"}


def test_a_case_that_3d_refuses_shows_the_rod_model_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object, **__: object) -> None:
        raise SceneError("contacts.bed", "nothing", "give something")

    monkeypatch.setattr("reference3d.solve", refuse)

    found = quick_look(load_case("bar-lifting-off-a-bed"), lambda _: None)

    assert found.notes == ("The 3D reference cannot treat this case: contacts.bed: found nothing; give something.",)
    assert all(each.rod and not each.reference for each in found.looks)


def test_the_rod_model_is_never_richer_than_the_cases_own() -> None:
    case = load_case(CASE)

    assert grades_of(case) == [(2, 3), (4, 4)]
    assert grades_of(replace(case, rod_model=replace(case.rod_model, level=2, order=3))) == [(1, 2), (2, 3)]
    varied = {"lower": (1, 3), "upper": (2, 2)}
    assert grades_of(replace(case, rod_model=replace(case.rod_model, level=varied)))[1] == (3, 4)


def grades_of(case: Case) -> list[tuple[int, int]]:
    return quick._grades(case)


def test_the_exit_code_says_whether_the_two_differ(monkeypatch: pytest.MonkeyPatch) -> None:
    answers = iter((look(0.0, 0.0, 0.0), look(0.5, 0.0, 0.0)))

    def answered(_: object, case: Case, __: object) -> QuickLook:
        return QuickLook(case, (next(answers),), (), (), ())

    monkeypatch.setattr("reports.processes.in_own_process", answered)

    assert [command_line.run(["compare", CASE, "--quick"]) for _ in range(2)] == [0, 1]
