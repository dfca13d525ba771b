"""Verification checks: every one meets its tolerance, closed forms have their textbook digits, the page is whole."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import pytest

import reference3d
from reference3d import grading
from reports import command_line
from reports.cache import Cache
from reports.html import PLOTLY_FILE
from reports.processes import ProcessFailed
from reports.verification import (
    bands,
    bending,
    contact_3d,
    curved,
    published,
    registry,
    solid,
    solid_elements,
    torsion,
    wording,
)
from reports.verification.check import Check, Outcome, Reference
from reports.verification.page import FILE_NAME, render, write_verification
from reports.verification.registry import CHECKS, GROUPS

ALL = [check for group in GROUPS for check in group.checks]
# 3D on several or on fine meshes
LONG = {"Short cantilever, L / h = 4"} | {
    check.name
    for group in (solid.GROUP, *solid_elements.GROUPS[1:], *contact_3d.GROUPS, bands.GROUP)
    for check in group.checks
}


def outcome_at_its_level(check: Check) -> Outcome:
    """The check solved at the level that counts alone."""
    alone = replace(check, levels=(check.at_level,))
    return Outcome(alone, alone.reference(), (alone.value(alone.at_level),))


@pytest.mark.parametrize(
    "check", [pytest.param(each, id=each.name, marks=[pytest.mark.slow] * (each.name in LONG)) for each in ALL]
)
def test_every_model_meets_the_tolerance_at_the_level_that_counts(check: Check) -> None:
    outcome = outcome_at_its_level(check)

    assert outcome.verdict == "pass", f"{outcome.error:.3g}, allowed {check.tolerance:g}"


def test_names_are_unique_and_the_level_that_counts_is_tried() -> None:
    assert len(CHECKS) == len(ALL)
    assert all(check.at_level in check.levels for check in ALL)


# Convergence that the page is there to show. The level before the one at which the theory makes a state exact must miss
# it: a check that passed there too would not look at what it claims to.
@pytest.mark.parametrize(
    ("name", "level", "at_least"),
    [
        ("Tension: lateral contraction", 1, 0.99),
        ("Pure bending: anticlastic curvature", 1, 0.99),
        ("Equilateral triangle, side 12", 2, 0.5),
        ("Square, side 10", 3, 0.15),
        ("Shear coefficient of the tip deflection", 2, 0.15),
    ],
)
def test_a_level_too_low_misses_what_it_cannot_hold(name: str, level: int, at_least: float) -> None:
    check = CHECKS[name]

    assert abs(check.value(level) / check.reference().value - 1.0) > at_least


def test_the_checks_of_a_group_go_by_the_same_steps() -> None:
    assert all(check.steps == group.steps for group in GROUPS for check in group.checks)


@pytest.mark.slow
def test_even_meshes_converge_at_a_clamp_with_the_order_that_grading_doubles(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without grading the observed order must miss the one that the page claims."""
    monkeypatch.setattr(grading, "GRADING_EXPONENT", 1.0)
    energies = [reference3d.solve(bending.cantilever(60.0, bending.STEEL), k).strain_energy for k in (2, 3, 4)]

    found = reference3d.grid_convergence(tuple(energies), (1.0 / 2.0, 1.0 / 3.0, 1.0 / 4.0), 4.0)

    # Williams: 2 x 0.711, from a mesh that is graded over its coarse cells still a little more
    assert found.observed_order < 2.0


def test_torsion_constants_have_the_digits_of_the_textbook() -> None:
    """Timoshenko and Goodier, table of article 109: k1 = 0.1406 (1 : 1), 0.229 (2 : 1), 0.312 (10 : 1)."""
    for ratio, digits in ((1.0, 0.1406), (2.0, 0.229), (10.0, 0.312)):
        assert torsion.rectangle_torsion(ratio, 1.0) / ratio == pytest.approx(digits, abs=5e-4)
    # 0.0217 a^4, the same book, article 106 (Roark: a^4 sqrt(3) / 80)
    assert torsion.triangle_torsion(1.0) == pytest.approx(0.0217, abs=5e-5)


def test_shear_coefficients_without_poissons_ratio_are_timoshenkos() -> None:
    assert bending.cowper_coefficient(0.0) == pytest.approx(5.0 / 6.0, rel=1e-15)
    assert bending.elastic_energy_coefficient(0.0) == pytest.approx(5.0 / 6.0, rel=1e-15)
    assert bending.cowper_coefficient(0.3) == pytest.approx(0.850, abs=5e-4)  # Cowper's table 1


@pytest.mark.parametrize(
    ("ratio", "golovin", "winkler"),
    # Timoshenko and Goodier, table of article 29: inner stress times a^2 / M for b / a = 1.3, 2, 3
    [(1.3, 73.05, 72.98), (2.0, 7.755, 7.725), (3.0, 2.292, 2.285)],
)
def test_stress_of_curved_bars_has_the_digits_of_the_textbook(ratio: float, golovin: float, winkler: float) -> None:
    inner = curved.HEIGHT / (ratio - 1.0)
    radius = inner + curved.HEIGHT / 2.0
    unit = curved.WIDTH * inner**2

    assert curved.golovin_inner_stress(radius) * unit == pytest.approx(golovin, rel=3e-4)
    assert curved.winkler_inner_stress(radius) * unit == pytest.approx(winkler, rel=3e-4)


def test_thick_bars_become_thin_ones() -> None:
    """R / (E I) for R much larger than h; the next term is of (h / R)^2."""
    radius = 100.0 * curved.HEIGHT
    second_moment = curved.WIDTH * curved.HEIGHT**3 / 12.0
    thin = radius / (curved.WITHOUT_CONTRACTION.young_modulus * second_moment)

    assert curved.golovin_flexibility(radius) == pytest.approx(thin, rel=1e-4)


def test_macneal_and_harders_references_have_their_known_digits() -> None:
    """What the published values should have been, recomputed by others: 0.03411 in twist, 0.08857 in plane."""
    assert published.straight_beam_reference("twist").value == pytest.approx(0.03411, abs=5e-6)
    assert published.straight_beam_reference("in plane").value == pytest.approx(0.1081, abs=5e-5)
    assert published.straight_beam_reference("out of plane").value == pytest.approx(0.4321, abs=5e-5)
    assert published.curved_beam_reference().value == pytest.approx(0.08857, abs=5e-6)


def test_wahls_spring_is_close_coiled_without_pitch(monkeypatch: pytest.MonkeyPatch) -> None:
    """8 D^3 / (G d^4) per turn."""
    monkeypatch.setattr(published, "PITCH", 0.0)
    diameter, coil = published.WIRE, 2.0 * published.RADIUS
    found = published.wahl(math.pi * diameter**4 / 32.0, math.pi * diameter**4 / 64.0).value

    assert found == pytest.approx(8.0 * coil**3 / (torsion.SHEAR_MODULUS * diameter**4), rel=1e-14)


def example(value: float, uncertainty: float = 0.0, tolerance: float = 1e-2) -> Outcome:
    """A check of a value against 1."""
    check = Check(
        "example", "Nothing.", "closed form", "none", "mm", lambda: Reference(1.0), lambda _: value, tolerance, 1
    )
    return Outcome(replace(check, levels=(1,)), Reference(1.0, uncertainty), (value,))


@pytest.mark.parametrize(
    ("outcome", "verdict"),
    [
        (example(1.009), "pass"),
        (example(0.991), "pass"),
        (example(1.011), "fail"),
        (example(0.989), "fail"),
        (example(1.0, uncertainty=0.02), "not resolved"),
        (example(math.nan), "fail"),
    ],
)
def test_verdicts(outcome: Outcome, verdict: str) -> None:
    assert outcome.verdict == verdict


@pytest.mark.parametrize(
    ("error", "text"),
    [
        (-1.0, "−100 %"),
        (0.1928, "19 %"),
        (-0.00123, "−0.12 %"),
        (1e-5, "0.001 %"),
        (-4.2e-10, "−4·10⁻¹⁰"),
        (2e-15, "0"),
    ],
)
def test_errors_are_written_readably(error: float, text: str) -> None:
    assert wording.relative(error) == text


@pytest.fixture(scope="module")
def outcomes() -> dict[str, Outcome]:
    """Every check with made-up values, the first of them a failure, so that nothing need be solved."""
    found = {
        check.name: Outcome(check, Reference(2.0), tuple(2.0 + 2.0 * check.tolerance / 3.0 for _ in check.levels))
        for check in ALL
    }
    first = ALL[0]
    return found | {first.name: replace(found[first.name], values=tuple(3.0 for _ in first.levels))}


@pytest.fixture(scope="module")
def page(outcomes: dict[str, Outcome]) -> str:
    return render(GROUPS, outcomes)


class Elements(HTMLParser):
    """What the page refers to, its ids and its tags."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.targets: list[str] = []
        self.ids: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        given = dict(attributes)
        self.targets += [given[key] or "" for key in ("href", "src", "srcset", "data", "action") if key in given]
        self.ids += [given["id"] or ""] if "id" in given else []


def test_the_page_fetches_nothing_and_its_links_lead_somewhere(page: str) -> None:
    elements = Elements(page)
    assert elements.targets.pop() == PLOTLY_FILE
    assert elements.targets
    assert {target[1:] for target in elements.targets} <= set(elements.ids)
    assert all(target.startswith("#") for target in elements.targets)
    assert len(elements.ids) == len(set(elements.ids))
    policy = re.search(r'http-equiv="Content-Security-Policy" content="([^"]*)"', page)
    assert policy is not None
    assert policy.group(1).startswith("default-src 'none'")
    styles = "".join(re.findall(r"<style>(.*?)</style>", page, re.DOTALL))
    assert "url(" not in styles
    assert "@import" not in styles


def test_every_check_stands_on_the_page_with_one_marked_cell(page: str) -> None:
    rows = re.findall(r'<th scope="row">(.*?)</th>', page)
    assert rows == [check.name for check in ALL]
    cells = re.findall(r'<td class="n"><span class="verdict ([a-z-]+)">', page)
    assert cells == ["fail"] + ["pass"] * (len(ALL) - 1)
    for check in ALL:
        assert check.source.replace("'", "&#39;") in page


def test_every_group_has_its_figure_on_a_logarithmic_scale(page: str) -> None:
    figures = json.loads(re.search(r"const figures = (.*);\n", page).group(1))
    assert len(figures) == len(GROUPS)
    for (place, figure), group in zip(figures.items(), GROUPS, strict=True):
        assert f'id="{place}"' in page
        assert figure["layout"]["yaxis"]["type"] == "log"
        assert len(figure["data"]) == 2 * len(group.checks)  # a curve and its tolerance


@pytest.fixture
def answered(monkeypatch: pytest.MonkeyPatch):
    """Answer `verify` with given outcomes, or a failure, instead of solving."""

    def answer(found: dict[str, Outcome] | Exception) -> None:
        def verify(_cache: object) -> dict[str, Outcome]:
            if isinstance(found, Exception):
                raise found
            return found

        monkeypatch.setattr("reports.verification.registry.verify", verify)

    return answer


def test_verify_prints_a_table_writes_the_page_and_exits_with_1_where_a_check_missed(
    outcomes: dict[str, Outcome], answered, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answered(outcomes)

    assert command_line.run(["verify", "--output", str(tmp_path)]) == 1
    shown = capsys.readouterr().out
    assert all(name in shown for name in outcomes)
    assert str(tmp_path / FILE_NAME) in shown
    assert (tmp_path / FILE_NAME).read_text().startswith("<!doctype html>")


def test_verify_exits_with_0_where_all_met_their_tolerance(
    outcomes: dict[str, Outcome], answered, tmp_path: Path
) -> None:
    first = ALL[0].name
    met = replace(outcomes[first], values=tuple(2.0 for _ in ALL[0].levels))
    answered(outcomes | {first: met})

    assert command_line.run(["verify", "--output", str(tmp_path)]) == 0


def test_checks_that_failed_to_run_are_one_sentence_and_leave_no_page(
    answered, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    answered(ProcessFailed("its process ended early"))

    assert command_line.run(["verify", "--output", str(tmp_path)]) == 1
    assert capsys.readouterr().err == "rodcheck: verification: its process ended early\n"
    assert not list(tmp_path.iterdir())


def test_verify_refuses_a_file_as_its_folder(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = tmp_path / "taken"
    file.write_text("")

    assert command_line.run(["verify", "--output", str(file)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.fixture
def computed(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """Numbers given instead of computed: of every check what this list has last; the list grows with each time."""
    factors = [1.0]

    def numbers(_work: object, names: tuple[str, ...], _progress: object) -> registry.Numbers:
        factors.append(factors[-1])
        return {name: (Reference(2.0), tuple(2.0 * factors[-1] for _ in CHECKS[name].levels)) for name in names}

    monkeypatch.setattr(registry, "in_own_process", numbers)
    return factors


def test_numbers_that_pass_are_taken_from_the_cache_and_the_page_says_so(computed: list[float], tmp_path: Path) -> None:
    first = registry.verify(Cache(tmp_path))

    second = registry.verify(Cache(tmp_path))

    assert len(computed) == 2  # once
    assert {outcome.kept_since for outcome in first.values()} == {""}
    assert {name: replace(outcome, kept_since="") for name, outcome in second.items()} == first
    assert "from the cache" not in render(GROUPS, first)
    assert "Numbers from the cache, computed on 20" in render(GROUPS, second)


def test_numbers_that_miss_or_are_damaged_are_computed_again(computed: list[float], tmp_path: Path) -> None:
    computed.append(1.5)
    registry.verify(Cache(tmp_path))
    assert list(tmp_path.iterdir()) == []

    computed.append(1.0)
    registry.verify(Cache(tmp_path))
    (path,) = tmp_path.iterdir()
    path.write_bytes(path.read_bytes()[:-9])
    times = len(computed)
    cache = Cache(tmp_path)
    found = registry.verify(cache)

    assert len(computed) == times + 1
    assert {outcome.verdict for outcome in found.values()} == {"pass"}
    assert ["is damaged" in note for note in cache.notes] == [True]


@pytest.mark.slow
def test_the_report_of_the_whole_library_links_to_the_verification_page(
    case_run, outcomes: dict[str, Outcome], answered, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("reports.progress.run_cases", lambda *_: iter([case_run]))
    monkeypatch.setattr("reports.site.in_own_process", lambda *_: (_ for _ in ()).throw(ProcessFailed("not drawn")))
    monkeypatch.setattr(command_line, "_write_performance", lambda _output, **_: tmp_path / "performance.html")
    monkeypatch.setattr(command_line, "_stability", lambda _cache: None)
    answered(outcomes)

    assert command_line.run(["report", "--output", str(tmp_path)]) == 1  # for want of stability
    assert 'href="index.html"' in (tmp_path / FILE_NAME).read_text()
    assert f'href="{FILE_NAME}"' in (tmp_path / "index.html").read_text()


def test_an_unwritable_folder_is_bad_input(outcomes: dict[str, Outcome], tmp_path: Path) -> None:
    file = tmp_path / "taken"
    file.write_text("")

    with pytest.raises(OSError, match="taken"):
        write_verification(GROUPS, outcomes, file / "inside")
