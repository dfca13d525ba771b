"""Texts of a case file stand in every page and on the terminal as text, whatever they look like."""

from __future__ import annotations

import re
from dataclasses import replace
from datetime import UTC, datetime
from html.parser import HTMLParser
from pathlib import Path

import pytest

from cases.case import Case
from cases.loader import LIBRARY, CaseError, load_case
from reports import command_line, site
from reports.chart.page import write_chart
from reports.chart.points import Chart
from reports.check.summary import summary
from reports.nightly.drift import Drift
from reports.nightly.rows import rows_of, this_night
from reports.nightly.summary import summary as nightly_summary
from reports.runner import CaseRun, Failure
from reports.tables import print_comparison

ATTACK = (
    "</title></textarea></style></script><hostile-tag onerror=hostile()>\"'`&lt;{{ 7 * 7 }}%7B[red]x[/] "
    "javascript:hostile()"
)
PICTURE = site.DrawnPicture("iVBORw0KGgo=", 1800, 700, "10", "")


class Elements(HTMLParser):
    """Elements and attributes of a page as a browser would find them, and what stands in its scripts and as text."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.tags: set[str] = set()
        self.attributes: list[tuple[str, str]] = []
        self.scripts = self.text = ""
        self._in_script = False
        self.feed(page)
        self.close()

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        self.tags.add(tag)
        self.attributes += [(key, value or "") for key, value in attributes]
        self._in_script = tag in ("script", "style")

    def handle_endtag(self, tag: str) -> None:
        self._in_script = False

    def handle_data(self, data: str) -> None:
        if self._in_script:
            self.scripts += data
        else:
            self.text += data


@pytest.fixture
def case(tmp_path: Path) -> Case:
    """A case all of whose texts are attacks, comments included."""
    text = (LIBRARY / "two-cantilevers-e20-g0.toml").read_text(encoding="utf-8")
    quoted = '"""' + ATTACK.replace('"', '\\"') + '"""'
    text = re.sub(r'^title = ".*"', lambda _: f"title = {quoted}", text, flags=re.MULTILINE)
    text = re.sub(
        r'^description = """.*?"""', lambda _: f"description = {quoted}", text, flags=re.MULTILINE | re.DOTALL
    )
    text = re.sub(r'^source = ".*"', lambda _: f"source = {quoted}", text, flags=re.MULTILINE)
    path = tmp_path / "hostile.toml"
    path.write_text(f"{text}\n# {ATTACK}\n", encoding="utf-8")
    return load_case(path)


@pytest.fixture
def run(case_run: CaseRun, case: Case) -> CaseRun:
    comparisons = tuple(replace(found, source=ATTACK, reason=ATTACK) for found in case_run.comparisons)
    chart = Chart(ATTACK, (), {}, (ATTACK,))
    return replace(case_run, case=case, comparisons=comparisons, refusal=ATTACK, notes=(ATTACK,), chart=chart)


def assert_harmless(path: Path) -> None:
    page = path.read_text(encoding="utf-8")
    found = Elements(page)
    assert "hostile-tag" not in found.tags, path.name
    assert not [key for key, _ in found.attributes if key.startswith("on")], path.name
    assert not [value for key, value in found.attributes if key in ("href", "src") and "hostile()" in value], path.name
    # In scripts texts are JSON whose every < is escaped.
    assert "<hostile-tag" not in found.scripts, path.name
    assert ">49<" not in page


def test_pages_of_the_report_show_texts_as_text(
    run: CaseRun, case: Case, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(site, "pictures", lambda _: {case.name: PICTURE})
    failed = Failure(replace(case, name="failed"), ATTACK)
    drifts = [Drift(case.name, "value", ATTACK, ATTACK)]
    night = this_night("20261101T000000Z-00000000", datetime(2026, 11, 1, tzinfo=UTC))

    site.write_report([run, failed], tmp_path / "report", moved=drifts, rows=list(rows_of(run, night)))

    pages = list((tmp_path / "report").rglob("*.html"))
    assert len(pages) >= 4
    for page in pages:
        assert_harmless(page)
    mine = next(page for page in pages if page.name == "hostile.html")
    # Title, description, source, reason and the file itself are all there.
    assert Elements(mine.read_text(encoding="utf-8")).text.count("<hostile-tag onerror=hostile()>") >= 5


def test_a_chart_shows_texts_as_text(case: Case, tmp_path: Path) -> None:
    assert_harmless(write_chart(case, Chart(case.title, (), {}, (ATTACK,)), tmp_path))


@pytest.mark.slow
def test_a_sweep_shows_texts_as_text(case: Case, tmp_path: Path) -> None:
    file = tmp_path / "hostile.toml"

    code = command_line.run(
        ["sweep", str(file), "--vary", "loads.1.force.2=-2..-1 kN:2", "--level", "1", "--output", str(tmp_path / "out")]
    )

    assert code == 0
    assert_harmless(tmp_path / "out" / "hostile.html")


def test_the_terminal_shows_texts_as_text(run: CaseRun, capsys: pytest.CaptureFixture[str]) -> None:
    print_comparison(run)
    print_comparison(Failure(run.case, ATTACK))

    shown = capsys.readouterr().out
    assert shown.replace("\n", " ").count("[red]x[/]") >= 4


def test_the_nightly_summary_is_lines_of_text(run: CaseRun) -> None:
    night = this_night("20261101T000000Z-00000000", datetime(2026, 11, 1, tzinfo=UTC))

    text = nightly_summary([run], [], night, missed=(), earlier=0, notes=(ATTACK,), seconds=1.0)

    assert all(line.isprintable() for line in text.splitlines())


def test_a_check_takes_no_text_for_more(case: Case) -> None:
    found = summary(case)

    assert "hostile" not in " ".join(found.warnings)


@pytest.mark.parametrize("name", [ATTACK.replace("/", ""), "..", "a\nb", "con<b>"])
def test_names_that_could_be_more_than_names_never_get_as_far_as_a_page(case: Case, tmp_path: Path, name: str) -> None:
    file = tmp_path / f"{name[:200]}.toml"
    file.write_text(case.text, encoding="utf-8")

    with pytest.raises(CaseError, match="found the file name"):
        load_case(file)
