"""`rodcheck chart CASE`: race and page, or one sentence."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from reports import progress
from reports.chart import measure
from reports.chart.points import Chart
from reports.command_line import BAD_INPUT, NOT_PASSED, run
from reports.pages.overview import case_file
from reports.runner import CaseRun, Failure

NAME = "two-cantilevers-e20-g0"


@pytest.fixture
def solved(case_run: CaseRun, chart: Chart, monkeypatch: pytest.MonkeyPatch) -> None:
    """The case is solved and its chart measured already."""
    monkeypatch.setattr(progress, "run_with_progress", lambda *_: [case_run])
    monkeypatch.setattr(measure, "make_chart", lambda *_, **__: chart)


@pytest.mark.usefixtures("solved")
def test_it_prints_the_race_and_writes_the_page_with_its_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = run(["chart", NAME, "--output", str(tmp_path), "--no-cache"])

    shown = capsys.readouterr().out
    assert code == 0
    assert "the cheapest of each method" in shown
    assert shown.splitlines()[-1] == str(tmp_path / f"chart-{NAME}.html")
    assert (tmp_path / "results" / f"{NAME}-chart.json").is_file()


def test_a_case_that_failed_or_has_no_reference_is_one_sentence_and_writes_nothing(
    case_run: CaseRun, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    alone = replace(case_run, references=(), refusal="Rods are knotted.")
    for found, why in ((Failure(case_run.case, "It broke."), "It broke."), (alone, "Rods are knotted.")):
        monkeypatch.setattr(progress, "run_with_progress", lambda *_, found=found: [found])

        code = run(["chart", NAME, "--output", str(tmp_path), "--no-cache"])

        told = capsys.readouterr().err.splitlines()
        assert code == NOT_PASSED
        assert len(told) == 1
        assert told[0].endswith(why)
    assert list(tmp_path.iterdir()) == []


def test_an_unknown_case_is_bad_input(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(["chart", "no-such-case"]) == BAD_INPUT
    assert "no-such-case" in capsys.readouterr().err


def test_several_cases_make_the_table_of_choices_and_one_that_failed_is_a_sentence(
    case_run: CaseRun, chart: Chart, monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    failure = Failure(replace(case_run.case, name="two-cantilevers-e20-g05"), "It broke.")
    monkeypatch.setattr(progress, "run_with_progress", lambda *_: [case_run, failure])
    monkeypatch.setattr(measure, "make_chart", lambda *_, **__: chart)

    code = run(["chart", NAME, "two-cantilevers-e20-g05", "--output", str(tmp_path), "--no-cache"])

    shown = capsys.readouterr()
    assert code == NOT_PASSED
    assert shown.out.splitlines()[-1] == str(tmp_path / "choices.html")
    assert shown.err == "rodcheck: two-cantilevers-e20-g05: It broke.\n"


@pytest.mark.slow
@pytest.mark.usefixtures("solved")
def test_the_report_has_charts_unless_told_otherwise(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from reports import site

    undrawn = site.DrawnPicture("", 0, 0, "", "")
    monkeypatch.setattr(site, "pictures", lambda runs: {each.case.name: undrawn for each in runs})
    for option, there in (([], True), (["--no-charts"], False)):
        run(["report", NAME, "--output", str(tmp_path), "--no-cache", *option])

        assert ("Speed against accuracy" in (tmp_path / case_file(NAME)).read_text()) == there
    capsys.readouterr()
