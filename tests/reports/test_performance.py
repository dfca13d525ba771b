"""Performance page: fits of made-up costs, structure of tiny measurements, sentences made from the data, a whole page.

No test asserts how long anything takes.
"""

from __future__ import annotations

import json
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from reports import command_line
from reports.html import PLOTLY_FILE
from reports.memory import peak_memory
from reports.performance import wording
from reports.performance.levels import LevelStudy, Setting, measured_levels
from reports.performance.measure import Performance, machine, measured_series
from reports.performance.page import FILE_NAME, render, write_performance
from reports.performance.parts import QUANTITIES, TEXTS, WHOLE, Breakdown, measured_parts
from reports.performance.scaling import (
    ROUNDS,
    Series,
    Size,
    cantilever,
    empty_process,
    measured_seconds,
    measured_size,
    power_law,
)
from reports.performance.timing import Timing, repeated
from reports.processes import ProcessFailed, in_own_process


def series(fixed: float, each: float, equal: bool = True, slope: float = 1.0) -> Series:
    """Seconds of a cost fixed + each n^slope, and 100 times as many MB."""
    sizes = []
    for elements in (10, 100, 1000, 10_000):
        cost = fixed + each * elements**slope
        timing = Timing((cost, 0.9 * cost, 1.2 * cost))
        sizes.append(Size(elements, 40 * elements, "converged", 60.0 + 100.0 * cost, -0.39, timing))
    return Series(equal, tuple(sizes), empty=60.0)


def breakdown() -> Breakdown:
    """Parts of 1 ms each, ten times as long in a whole solve."""
    timings = {name: Timing((0.0009, 0.001, 0.0012)) for name in TEXTS} | {WHOLE: Timing((0.009, 0.01, 0.012))}
    return Breakdown("two-cantilevers-e50-g0", 5, 6, "converged", 6, 0.3, timings)


def study(*forces: float) -> LevelStudy:
    """Level after level at p = 4, a millisecond more a level."""
    settings = [
        Setting(level, 4, 100 * level, "converged", level + 2, Timing((1e-3 * level,)), force)
        for level, force in enumerate(forces, 1)
    ]
    return LevelStudy("Two bars", "overlap", tuple(settings))


@pytest.fixture
def performance() -> Performance:
    return Performance(
        (series(0.0, 1e-4), series(0.0, 2e-4, equal=False)),
        breakdown(),
        study(90.0, 99.95, 100.0),
        "Python, one thread",
    )


@pytest.mark.parametrize("slope", [0.5, 1.0, 2.0])
def test_the_fit_finds_the_slope_and_the_factor_of_a_power_law(slope: float) -> None:
    numbers = np.array([10.0, 30.0, 100.0, 3000.0])

    law = power_law(numbers, 3.0 * numbers**slope)

    assert (law.slope, law.factor) == pytest.approx((slope, 3.0), rel=1e-12)
    assert law.at(numbers) == pytest.approx(3.0 * numbers**slope, rel=1e-12)


def test_a_fixed_cost_flattens_the_slope_over_all_sizes_and_less_so_that_of_large_ones() -> None:
    found = series(fixed=5e-3, each=1e-4)

    assert found.time_law_of_all.slope < 0.9
    assert 0.9 < found.time_law.slope < 1.0
    assert found.relative(found.seconds)[0] > 5.0
    assert found.relative(found.seconds)[-1] == 1.0
    assert series(0.0, 1e-4).relative(series(0.0, 1e-4).seconds) == pytest.approx(1.0)


@pytest.mark.parametrize(("slope", "verdict"), [(0.89, "fail"), (0.91, "pass"), (1.09, "pass"), (1.11, "fail")])
def test_a_slope_passes_within_ten_per_cent_of_one(slope: float, verdict: str) -> None:
    seconds, memory, _ = wording.aims((series(0.0, 1e-3, slope=slope),))

    assert (seconds.found, seconds.where, seconds.verdict) == (f"{slope:.2f}", "from 100 on", verdict)
    assert (memory.found, memory.verdict) == (f"{slope:.2f}", verdict)


def test_memory_too_small_to_tell_from_an_empty_process_is_not_resolved() -> None:
    found = series(0.0, 1e-6)

    assert wording.aims((found,))[1].verdict == "not resolved"
    assert found.memory_law is None
    assert "too small to tell" in wording.memory_caption((found,))
    assert series(0.0, 1e-4).memory_law.start == 1000.0  # 10 MB there, 1 MB at 100 elements


def test_a_process_of_more_than_two_gigabytes_fails() -> None:
    found = series(0.0, 1e-4)
    greedy = replace(found, sizes=(*found.sizes[:-1], replace(found.sizes[-1], resident=2049.0)))

    assert wording.aims((found,))[-1].verdict == "pass"
    assert wording.aims((greedy,))[-1].verdict == "fail"


def test_medians_and_quartiles_of_runs() -> None:
    timing = Timing((5.0, 1.0, 2.0, 4.0, 3.0))

    assert (timing.runs, timing.median, timing.quartiles) == (5, 3.0, (2.0, 4.0))
    assert Timing((3.0, 1.0)).quartiles == (1.0, 3.0)


def test_work_is_repeated_once_at_least_and_so_often_at_most() -> None:
    done: list[int] = []

    assert len(repeated(lambda: done.append(1), seconds=0.0, at_most=5)) == len(done) == 1
    assert len(repeated(lambda: done.append(1), seconds=100.0, at_most=5)) == 5


def test_elements_of_unequal_length_all_differ() -> None:
    equal, unequal = (np.diff(cantilever(50, equal).rods[0].element_borders) for equal in (True, False))

    assert np.ptp(equal) < 1e-10
    assert len(np.unique(np.round(unequal, 9))) == 50


@pytest.mark.slow
def test_peak_memory_does_not_count_what_the_starting_process_held() -> None:
    """getrusage does on Linux; 240 MB here, and a process that solves one element takes far less."""
    held = np.ones(30_000_000)

    assert peak_memory() > held.nbytes / 2**20
    assert in_own_process(empty_process, None) < 0.7 * held.nbytes / 2**20


def test_a_size_is_measured_with_its_answer() -> None:
    found = measured_size(((8, False), Timing((1.0,))), print)

    assert (found.elements, found.outcome) == (8, "converged")
    assert found.unknowns > 8
    assert found.resident > 0.0
    # F L^3 / (3 E I); clamp and shear are of the order (h / L)
    assert found.deflection == pytest.approx(-(1000.0**3) / (3.0 * 200e3 * 15.0**4 / 12.0), rel=0.015)


def test_sizes_are_timed_in_rounds() -> None:
    told: list[str] = []

    found = measured_seconds(((2, True), (3, False)), told.append)

    assert list(found) == [(2, True), (3, False)]
    assert len(told) == ROUNDS
    assert all(timing.runs >= ROUNDS for timing in found.values())


@pytest.mark.slow
def test_every_size_has_its_own_process_and_is_announced() -> None:
    announced: list[str] = []

    (found,) = measured_series([(2, True)], announced.append)

    assert announced[-1] == "memory of 2 elements"
    assert (found.equal, found.sizes[0].elements) == (True, 2)
    assert found.growth[0] == found.sizes[0].resident - found.empty


def test_all_parts_of_the_papers_case_are_timed() -> None:
    found = measured_parts(1, print)

    assert list(found.timings) == list(TEXTS)
    assert all(timing.runs == 1 for timing in found.timings.values())
    assert (found.outcome, found.contact_solutions > 1) == ("converged", True)
    assert WHOLE not in found.inside
    assert QUANTITIES not in found.inside


def test_levels_are_held_against_the_finest() -> None:
    found = measured_levels(((1, 2), (2, 3), 1), print)

    assert [(setting.level, setting.order) for setting in found.settings] == [(1, 2), (1, 3), (2, 2), (2, 3)]
    assert found.finest is found.settings[-1]
    assert found.error(found.finest) == 0.0
    # 246.49 N of the converged 3D: tests/rodmodel hold finer settings against it; this is the right case and pair
    assert found.finest.force == pytest.approx(246.49, rel=0.02)
    assert all(setting.timing.runs == 1 for setting in found.settings)


def test_sentences_are_made_from_the_data(performance: Performance) -> None:
    slow = (series(0.0, 1e-4, slope=1.3),)

    assert "found 1.00 with equal lengths and 1.00 with unequal lengths from 100 on" in wording.seconds_caption(
        performance.series
    )
    assert "found 1.30 with equal lengths" in wording.seconds_caption(slow)
    assert "found 1.30 from 100 on with equal lengths" in wording.memory_caption(slow)
    assert "between 1.00 and 1.00" in wording.relative_caption(performance.series)
    assert "is h2, p = 4: −0.05 % in 2 ms" in wording.levels_caption(performance.study)
    assert "No other setting" in wording.levels_caption(study(90.0, 99.0, 100.0))
    assert "here 3 to 5" in wording.levels_note(performance.study)
    assert "takes 10 % of a solve" in wording.parts_note(performance.breakdown)


def test_what_did_not_converge_is_told(performance: Performance) -> None:
    size = replace(performance.series[0].sizes[0], outcome="cycling")
    broken = replace(performance.series[0], sizes=(size, *performance.series[0].sizes[1:]))
    settings = (replace(performance.study.settings[0], outcome="stagnated"), *performance.study.settings[1:])

    assert "1 of the solves did not converge" in wording.sizes_note((broken,))
    assert "stagnated" in render(replace(performance, study=replace(performance.study, settings=settings)))


class Links(HTMLParser):
    """What the page refers to, and its ids."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.ids: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.targets += [given[key] or "" for key in ("href", "src") if key in given]
        self.ids += [given["id"] or ""] if "id" in given else []


def test_the_page_fetches_nothing_and_every_figure_has_its_place_and_its_caption(performance: Performance) -> None:
    page = render(performance)

    links = Links(page)
    assert links.targets.pop() == PLOTLY_FILE
    assert all(target.startswith("#") for target in links.targets)
    assert {target[1:] for target in links.targets} <= set(links.ids)
    assert "default-src 'none'" in page
    figures = json.loads(re.search(r"const figures = (.*);\n", page).group(1))
    assert set(figures) <= set(links.ids)
    assert page.count("<figcaption>") == len(figures) == 4
    for figure in figures.values():
        assert figure["layout"]["xaxis"]["type"] == figure["layout"]["yaxis"]["type"] == "log"
    assert "slope 1.00 from 100 on" in figures["figure-seconds"]["data"][0]["name"]


def test_shares_of_the_parts_add_up_to_the_whole(performance: Performance) -> None:
    rows = re.findall(r'<td class="n">(\S+) %</td><td class="share"', render(performance))

    *inside, whole, quantities = (float(row) for row in rows)
    assert whole == 100.0
    assert sum(inside) == pytest.approx(100.0)
    assert quantities == 10.0


def test_the_machine_is_told_with_its_threads(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "1")

    assert machine().endswith("one thread")


def test_performance_prints_what_it_found_and_writes_the_page(
    performance: Performance, tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.performance.measure.measure", lambda: performance)

    assert command_line.run(["performance", "--output", str(tmp_path)]) == 0
    shown = capsys.readouterr().out
    assert "Slope of seconds, equal lengths: 1.00 from 100 on (aim 0.9 to 1.1), pass" in shown
    assert shown.endswith(f"{tmp_path / FILE_NAME}\n")
    assert (tmp_path / FILE_NAME).read_text().startswith("<!doctype html>")


def test_a_measurement_that_failed_is_one_sentence_and_leaves_no_page(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def measure() -> Performance:
        raise ProcessFailed("its process ended early")

    monkeypatch.setattr("reports.performance.measure.measure", measure)

    assert command_line.run(["performance", "--output", str(tmp_path)]) == 1
    assert capsys.readouterr().err == "rodcheck: performance: its process ended early\n"
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
def test_the_report_of_the_whole_library_links_to_the_performance_page(
    case_run, performance: Performance, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.progress.run_cases", lambda *_: iter([case_run]))
    monkeypatch.setattr("reports.site.in_own_process", lambda *_: (_ for _ in ()).throw(ProcessFailed("not drawn")))
    monkeypatch.setattr("reports.performance.measure.measure", lambda: performance)
    monkeypatch.setattr(command_line, "_verification_outcomes", lambda _cache: None)
    monkeypatch.setattr(command_line, "_stability", lambda _cache: None)

    assert command_line.run(["report", "--output", str(tmp_path)]) == 1  # for want of verification and stability
    assert 'href="index.html"' in (tmp_path / FILE_NAME).read_text()
    page = (tmp_path / "index.html").read_text()
    assert f'href="{FILE_NAME}"' in page
    assert 'href="verification.html"' not in page


def test_an_unwritable_folder_is_bad_input(performance: Performance, tmp_path: Path) -> None:
    file = tmp_path / "taken"
    file.write_text("")

    with pytest.raises(OSError, match="taken"):
        write_performance(performance, file / "inside")
