"""Stability page: every claim borne out by its sweep at reduced size, plain alternatives against closed forms, a page.

Numbers are written here only where a closed form or a textbook gives them.
"""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from cases.scene import Material, Rectangle
from reports import command_line, site
from reports.cache import Cache
from reports.html import PLOTLY_FILE
from reports.processes import ProcessFailed
from reports.stability import plain_beams, plain_rods, registry
from reports.stability.figures import ZERO, figure, looks
from reports.stability.page import FILE_NAME, render, summary, write_stability
from reports.stability.registry import BY_NAME, SWEEPS, Stability
from reports.stability.solids import face_weights, solid, solved
from reports.stability.sweep import Curve, Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import FORCE, beam_theory
from reports.stability.wording import number, share
from rodmodel.section import STRAIGHT, Fields, section_stiffness

# Values that show what each sweep claims, in little time; those that take about a second or more are slow.
QUICK: dict[str, tuple[float, ...]] = {
    "Slenderness": (10.0, 1e3, 1e4),
    "Incompressibility": (0.3, 0.4999),
    "Curvature": (100.0, 0.75, 0.55),
    "Level": (2.0, 12.0),
    "Order": (2.0, 10.0, 20.0),
    "Element lengths": (10.0, 1e4),
    "Penalty": (10.0, 1e6),
    "Stiffness ratio": (1e-4, 0.1, 1e4),
    "Gap": (-14.0, 0.5, 10.0, 12.0),
    "Load reversals": (0.2, 1.0, 0.6, 0.2, -1.0, 0.2, 1.0),
    "Border search": (214.0, 238.0, 286.0),
    "Edge inside an element": (0.0, 1.0, 4.0, 17.0),
    "Contact patch test": (2.0, 3.0),
}
SLOW = ("Border search", "Contact patch test", "Curvature", "Incompressibility", "Load reversals")
ALL = [pytest.param(each, id=each.name, marks=pytest.mark.slow if each.name in SLOW else ()) for each in SWEEPS]


@pytest.fixture(scope="module")
def quick() -> dict[str, Found]:
    """What the sweeps find at reduced size; each is carried out once, when it is first asked for."""
    return {}


def found_of(sweep: Sweep, quick: dict[str, Found]) -> Found:
    if sweep.name not in quick:
        quick[sweep.name] = sweep.measure(QUICK[sweep.name])
    return quick[sweep.name]


@pytest.mark.parametrize("sweep", ALL)
def test_numbers_bear_the_claim_out(sweep: Sweep, quick: dict[str, Found]) -> None:
    assert sweep.holds(found_of(sweep, quick))


@pytest.mark.parametrize("sweep", ALL)
def test_pictures_show_declared_methods_and_sentences_are_whole(sweep: Sweep, quick: dict[str, Found]) -> None:
    found = found_of(sweep, quick)

    for picture in sweep.pictures:
        assert set(found[picture.key]) <= {method.name for method in sweep.methods}
        assert all(len(each.x) == len(each.y) > 0 for each in found[picture.key].values())
        json.dumps(figure(sweep, picture, found[picture.key]).to_plotly_json(), default=list, allow_nan=False)
    for sentence in (sweep.driven, sweep.claim(found), sweep.own_limit(found)):
        assert sentence.endswith(".")
        assert "nan" not in re.findall(r"[a-z]+", sentence)
        assert "inf" not in re.findall(r"[a-z]+", sentence)


@pytest.mark.slow
def test_every_claim_holds_at_full_size() -> None:
    stability = registry.carry_out()

    assert [name for name, found in stability.found.items() if not BY_NAME[name].holds(found)] == []


def test_numbers_that_do_not_show_it_do_not_hold() -> None:
    """Were the plain ones as good as ours, or ours as bad as the plain ones, the claims would fall."""
    sweep = BY_NAME["Slenderness"]
    found = sweep.measure((1e4,))
    name = "two-node beam, 16 elements"

    unlocked = dict(found) | {"straight": dict(found["straight"]) | {name: curve((1e4,), (0.0,))}}
    locked = dict(found) | {"straight": dict(found["straight"]) | {"h5, p = 6": curve((1e4,), (0.9,))}}

    assert sweep.holds(found)
    assert not sweep.holds(unlocked)
    assert not sweep.holds(locked)


class TestPlainAlternatives:
    def test_two_node_beam_of_many_elements_is_timoshenkos(self) -> None:
        bending, shearing, length = 1e6, 1e5, 20.0

        deflection = plain_beams.end_deflection(length, math.inf, bending, 1e6, shearing, 200)

        # Linear elements of 0.1 mm: the shear strain they cannot shed is (h / l)^2 of the bending's.
        assert deflection == pytest.approx(length**3 / (3.0 * bending) + length / shearing, rel=1e-3)

    def test_two_node_arc_of_many_elements_is_castiglianos(self) -> None:
        bending, stretching, shearing, radius = 1e6, 1e6, 1e5, 20.0

        deflection = plain_beams.end_deflection(0.5 * math.pi * radius, radius, bending, stretching, shearing, 400)

        expected = 0.25 * math.pi * radius * (radius**2 / bending + 1.0 / stretching + 1.0 / shearing)
        assert deflection == pytest.approx(expected, rel=1e-3)

    def test_cubic_beams_are_exact_on_equal_elements(self) -> None:
        assert plain_beams.cubic_end_deflection(np.linspace(0.0, 20.0, 5), 1e6) == pytest.approx(20.0**3 / 3e6)

    def test_full_law_is_the_law_from_the_second_level_on(self) -> None:
        fields, section, material = Fields(2), Rectangle(3.0, 2.0), Material(100.0, 0.3)

        full, usual = (
            plain_rods.full_law(section, material, fields),
            section_stiffness(section, material, fields, STRAIGHT),
        )

        np.testing.assert_allclose(full.s00, usual.s00, atol=1e-12 * np.abs(usual.s00).max())
        np.testing.assert_allclose(full.s11, usual.s11, atol=1e-12 * np.abs(usual.s11).max())

    @pytest.mark.parametrize(("nodes", "corner"), [(8, 1.0 / 4.0), (20, -1.0 / 12.0), (27, 1.0 / 36.0)])
    def test_corners_of_faces_take_their_textbook_share_of_a_constant_pressure(self, nodes: int, corner: float) -> None:
        body = solid((np.array([0.0, 1.0]),) * 3, Material(1.0, 0.3), nodes)

        weights = face_weights(body, 1.0)

        at = (body.nodes == np.array([[0.0], [0.0], [1.0]])).all(axis=0)
        assert weights[at] == pytest.approx(corner)
        assert weights.sum() == pytest.approx(1.0)

    @pytest.mark.parametrize("nodes", [8, 20, 27])
    def test_bar_of_hexahedra_in_tension_lengthens_by_hookes_law(self, nodes: int) -> None:
        body = solid(
            (np.linspace(0.0, 1.0, 3), np.linspace(0.0, 1.0, 2), np.linspace(0.0, 4.0, 4)), Material(5.0, 0.3), nodes
        )
        force = np.zeros(3 * body.basis.N)
        force[2::3] = face_weights(body, 4.0)
        fixed = (np.abs(body.nodes) < 1e-9).T.ravel()

        displacement = solved(body.stiffness, force, fixed, np.zeros(len(force)))

        assert displacement[2::3].max() == pytest.approx(4.0 / 5.0)
        assert displacement[0::3].min() == pytest.approx(-0.3 / 5.0)

    def test_beams_that_cannot_reach_each_other_do_not_touch(self) -> None:
        assert beam_theory(0.25, 20.0) == 0.0

    def test_beams_touch_harder_at_a_corner_the_smaller_the_gap(self) -> None:
        wide, narrow = beam_theory(0.25, 4.0), beam_theory(0.25, 2.0)

        assert 0.0 < wide < narrow < FORCE

    def test_beams_of_one_stiffness_as_worked_out_by_hand(self) -> None:
        """Corner at X = 200: R (200^3 + 300^3) / 3 = F a^2 (3 300 - a) / 6 with a = 500 - 366.67."""
        a = 500.0 - 366.67

        expected = FORCE * a**2 * (900.0 - a) / 6.0 / ((200.0**3 + 300.0**3) / 3.0)

        assert beam_theory(1.0, 0.0) == pytest.approx(expected)


class TestDrawing:
    SWEEP = Sweep(
        "Made up",
        "Nothing.",
        (1.0,),
        (Method("plain", ours=False), Method("ours")),
        (Picture("error", "Error", "x", "y"),),
        lambda _: {},
        lambda _: "Seen.",
        lambda _: "None.",
        lambda _: True,
    )

    def test_zero_has_a_place_on_a_logarithmic_axis_and_what_is_missing_has_none(self) -> None:
        drawn = figure(self.SWEEP, self.SWEEP.pictures[0], {"ours": Curve((1.0, 2.0, 3.0), (0.0, math.nan, 0.5))})

        assert list(drawn.data[0].y) == [ZERO, None, 0.5]

    def test_plain_methods_are_told_apart_without_colour(self) -> None:
        drawn = figure(
            self.SWEEP, self.SWEEP.pictures[0], {"plain": Curve((1.0,), (1.0,)), "ours": Curve((1.0,), (2.0,))}
        )

        assert [line.line.dash for line in drawn.data] == ["5px,3px", "solid"]
        assert drawn.data[0].marker.symbol.endswith("-open")
        assert not looks(self.SWEEP, ["plain"])["plain"].ours


@pytest.mark.parametrize(
    ("value", "written"),
    [(0.0, "0"), (12345.0, "12\u202f000"), (0.57, "0.57"), (2.44e-9, "2.4·10⁻⁹"), (1e9, "10⁹"), (-3.0, "−3")],
)
def test_numbers_are_written_short(value: float, written: str) -> None:
    assert number(value) == written


def test_errors_are_per_cent_or_powers_of_ten() -> None:
    assert [share(error) for error in (1.0, -0.0012, 3e-9, math.nan)] == ["100 %", "0.12 %", "3·10⁻⁹", "no answer"]


class Structure(HTMLParser):
    """Headings, ids and links of a page."""

    def __init__(self, page: str) -> None:
        super().__init__()
        self.ids: list[str] = []
        self.targets: list[str] = []
        self.fetched: list[str] = []
        self.feed(page)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        if given.get("id"):
            self.ids.append(str(given["id"]))
        if tag == "a" and str(given.get("href", "")).startswith("#"):
            self.targets.append(str(given["href"])[1:])
        if tag in ("link", "img", "script") and (given.get("src") or given.get("href")):
            self.fetched.append(str(given.get("src") or given.get("href")))


@pytest.fixture(scope="module")
def few() -> Stability:
    """Two quick sweeps."""
    return Stability({name: BY_NAME[name].measure(QUICK[name]) for name in ("Level", "Order")}, 1.0)


def test_numbers_that_hold_are_taken_from_the_cache_and_the_page_says_so(
    few: Stability, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(registry, "in_own_process", lambda *_: few)
    first = registry.carry_out(Cache(tmp_path))
    monkeypatch.setattr(registry, "in_own_process", lambda *_: pytest.fail("computed again"))

    second = registry.carry_out(Cache(tmp_path))

    assert replace(second, kept_since="") == first == few
    assert "numbers from the cache" not in render(first)
    assert "; numbers from the cache" in render(second)


def test_numbers_that_do_not_hold_are_not_kept(few: Stability, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bad = {name: Curve(each.x, (1e9,) * len(each.x)) for name, each in few.found["Order"]["condition"].items()}
    broken = Stability({"Order": dict(few.found["Order"]) | {"condition": bad}}, 1.0)
    monkeypatch.setattr(registry, "in_own_process", lambda *_: broken)

    assert registry.carry_out(Cache(tmp_path)) == broken
    assert list(tmp_path.iterdir()) == []


class TestPage:
    def test_page_fetches_nothing_and_its_links_lead_somewhere(self, few: Stability) -> None:
        structure = Structure(render(few))

        assert structure.fetched == [PLOTLY_FILE]
        assert set(structure.targets) <= set(structure.ids)
        assert len(structure.ids) == len(set(structure.ids))

    def test_every_sweep_has_its_title_sentences_and_a_place_for_each_picture(self, few: Stability) -> None:
        page = render(few)
        places = Structure(page).ids

        for index, name in enumerate(few.found, start=1):
            assert f">{name}</h2>" in page
            for place in range(1, len(BY_NAME[name].pictures) + 1):
                assert f"sweep-{index}-{place}" in places
        assert page.count("<dt>What is seen</dt>") == page.count("<dt>Our own limits</dt>") == len(few.found)

    def test_claim_that_fails_is_marked(self, few: Stability) -> None:
        sweep = BY_NAME["Order"]
        bad = {name: Curve(each.x, (1e9,) * len(each.x)) for name, each in few.found["Order"]["condition"].items()}
        broken = Stability({"Order": dict(few.found["Order"]) | {"condition": bad}}, 1.0)

        assert not sweep.holds(broken.found["Order"])
        assert not broken.all_hold
        assert render(broken).count("does not hold") > render(few).count("does not hold")
        assert summary(broken)[0].startswith("Order: does not hold.")

    def test_the_page_links_to_the_overview_where_there_is_one(self, few: Stability, tmp_path: Path) -> None:
        assert 'href="index.html"' in write_stability(few, tmp_path, in_report=True).read_text(encoding="utf-8")
        assert 'href="index.html"' not in render(few)

    def test_report_links_to_the_page_where_there_is_one(self) -> None:
        assert f'href="{FILE_NAME}"' in site.overview_page([], [FILE_NAME])
        assert FILE_NAME not in site.overview_page([])

    def test_page_is_written_whole(self, few: Stability, tmp_path: Path) -> None:
        path = write_stability(few, tmp_path)

        assert path == tmp_path / FILE_NAME
        assert path.read_text(encoding="utf-8").rstrip().endswith("</html>")


class TestCommand:
    def test_writes_the_page_and_prints_what_is_seen(
        self, few: Stability, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        monkeypatch.setattr(registry, "carry_out", lambda _cache: few)

        code = command_line.run(["stability", "--output", str(tmp_path)])

        assert code == 0
        assert (tmp_path / FILE_NAME).exists()
        assert "Level: holds." in capsys.readouterr().out

    def test_sweep_that_fails_to_run_is_one_sentence(
        self, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
    ) -> None:
        def failing(_cache: object) -> Stability:
            raise ProcessFailed("ValueError: no such level (section.py, line 1)")

        monkeypatch.setattr(registry, "carry_out", failing)

        assert command_line.run(["stability", "--output", str(tmp_path)]) == command_line.NOT_PASSED
        assert "rodcheck: stability: ValueError" in capsys.readouterr().err
        assert not (tmp_path / FILE_NAME).exists()
