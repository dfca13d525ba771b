"""Resultants, drawings and the page of curved rods, by a circular arc in closed form that no solver computed."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from cases.case import Case, Check, RodModelSettings
from cases.scene import (
    Circle,
    Clamp,
    Helix,
    LineLoad,
    Load,
    Material,
    Polygon,
    Rod,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
)
from reports import runner, site
from reports.applied_forces import applied_forces, reactions
from reports.case_comparison import comparisons_without_reference
from reports.equilibrium import equilibrium_residual, equilibrium_resultants
from reports.pages.case import ALONE_CAPTION
from reports.picture import deformed_surface
from reports.quantities import default_stations, evaluate
from reports.runner import CaseRun, Run, passed
from reports.sketch import scene_sketch
from reports.solution import Array
from reports.tables import print_comparison
from reports.view import view_plane

RADIUS = 100.0
ARC = Helix((RADIUS, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
WIRE = Circle(8.0)
ANGLE_IRON = Polygon(((0.0, 0.0), (9.0, 0.0), (9.0, 2.0), (2.0, 2.0), (2.0, 9.0), (0.0, 9.0)))


def ring(*loads: Load, section: object = WIRE, line: Helix = ARC) -> Scene:
    """A quarter ring in the X-Y plane, clamped at (100, 0, 0); e2 = Z, so that e1 = e2 x t looks to the centre."""
    rod = Rod("ring", line, section, Material(200_000.0, 0.3), (0.0, line.length))
    return Scene("quarter ring", (rod,), (Clamp("ring", "start"),), loads, ())


@dataclass(frozen=True)
class Cost:
    unknowns: int = 90
    setup_seconds: float = 0.01
    solve_seconds: float = 0.02


@dataclass(frozen=True)
class ArcSolution:
    """Frames of the arc; reactions by hand; displacements and stresses are not looked at here."""

    scene: Scene
    support: Array
    outcome: str = "converged"
    contact_solutions: int = 1
    active_sets: int = 1
    strain_energy: float = 1.0
    cost: Cost = field(default_factory=Cost)

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        angle = station / RADIUS
        zero, one = np.zeros_like(angle), np.ones_like(angle)
        outwards = np.array([np.cos(angle), np.sin(angle), zero])
        tangent = np.array([-np.sin(angle), np.cos(angle), zero])
        return RADIUS * outwards, np.stack([-outwards, np.array([zero, zero, one]), tangent]).transpose(2, 0, 1)

    def displacement(self, rod: str, station: Array) -> Array:
        return np.outer([0.0, 0.0, 1.0], station**2 / 1e4)

    def section_resultants(self, rod: str, station: Array) -> Array:
        return np.zeros((6, len(station)))

    def stress(self, rod: str, points: Array) -> Array:
        return np.zeros((6, points.shape[1]))

    def reaction(self, rod: str, station: float) -> Array:
        return self.support


STATION = np.linspace(0.0, ARC.length, 7)[1:-1]  # between clamp and end, every 15 degrees
ANGLE = STATION / RADIUS


def resultants(*loads: Load) -> Array:
    solution = ArcSolution(ring(*loads), np.zeros(6))
    rod = solution.scene.rods[0]
    applied = applied_forces(solution, rod, STATION, reactions(solution))
    return equilibrium_resultants(solution, rod, applied, STATION)


def test_a_force_out_of_the_plane_bends_and_twists_an_arc() -> None:
    axial, shear_1, shear_2, moment_1, moment_2, torque = resultants(SectionForce("ring", ARC.length, (0.0, 0.0, 7.0)))

    # R. J. Roark and others: M = P R sin(rest of the angle), T = P R (1 - cos(rest)); signs by the right-hand rule
    rest = math.pi / 2.0 - ANGLE
    assert shear_2 == pytest.approx([7.0] * 5)
    assert moment_1 == pytest.approx(-7.0 * RADIUS * np.sin(rest))
    assert torque == pytest.approx(7.0 * RADIUS * (1.0 - np.cos(rest)))
    assert np.abs([axial, shear_1, moment_2]).max() < 1e-12


def test_a_force_in_the_plane_turns_with_the_section_from_shear_to_pull() -> None:
    axial, shear_1, _, _, moment_2, _ = resultants(SectionForce("ring", ARC.length, (-7.0, 0.0, 0.0)))

    # at (0, R) along the arc's end tangent; its arm about the section at the angle a is R - R sin a
    assert axial == pytest.approx(7.0 * np.sin(ANGLE))
    assert shear_1 == pytest.approx(7.0 * np.cos(ANGLE))
    assert moment_2 == pytest.approx(7.0 * RADIUS * (1.0 - np.sin(ANGLE)))


def test_a_moment_is_seen_in_the_frame_of_each_section() -> None:
    found = resultants(SectionMoment("ring", ARC.length, (5.0, 0.0, 3.0)))

    assert np.abs(found[:3]).max() == 0.0
    assert found[3] == pytest.approx(-5.0 * np.cos(ANGLE))
    assert found[4] == pytest.approx([3.0] * 5)
    assert found[5] == pytest.approx(-5.0 * np.sin(ANGLE))


def test_a_line_load_counts_from_the_cut_on() -> None:
    found = resultants(LineLoad("ring", 0.0, ARC.length, (0.0, 0.0, 2.0)))

    # integrals over the rest of the arc: q R rest, q R^2 (1 - cos rest), q R^2 (rest - sin rest)
    rest = math.pi / 2.0 - ANGLE
    assert found[2] == pytest.approx(2.0 * RADIUS * rest)
    assert found[3] == pytest.approx(-2.0 * RADIUS**2 * (1.0 - np.cos(rest)))
    # twelve Gauss points on 15 degrees are exact to round-off
    assert found[5] == pytest.approx(2.0 * RADIUS**2 * (rest - np.sin(rest)))


def test_a_line_load_over_a_part_is_whole_before_it_and_nothing_beyond() -> None:
    found = resultants(LineLoad("ring", STATION[1], STATION[3], (0.0, 0.0, 2.0)))

    length = STATION[3] - STATION[1]
    assert found[2] == pytest.approx([2.0 * length, 2.0 * length, length, 0.0, 0.0])


def test_loads_of_all_kinds_balance_the_reactions() -> None:
    quarter = ARC.length
    force = SectionForce("ring", quarter, (0.0, 0.0, 7.0))
    line = LineLoad("ring", 0.0, quarter, (0.0, 0.0, 2.0))
    moment = SectionMoment("ring", quarter, (5.0, 0.0, 0.0))
    # about the clamp at (R, 0, 0): F at (0, R, 0), the line load q R pi/2 at its centroid (2 R / pi, 2 R / pi, 0)
    total, arm = 2.0 * quarter, 2.0 * RADIUS / math.pi
    about_x = 7.0 * RADIUS + total * arm + 5.0
    about_y = 7.0 * RADIUS + total * (RADIUS - arm)
    solution = ArcSolution(ring(force, line, moment), -np.array([0.0, 0.0, 7.0 + total, about_x, about_y, 0.0]))

    rod = solution.scene.rods[0]
    held = reactions(solution)
    applied = {"ring": applied_forces(solution, rod, default_stations(rod), held)}
    found = equilibrium_residual(solution.scene, applied, held)

    assert found < 1e-12


def test_a_helix_of_many_turns_has_stations_on_each() -> None:
    helix = replace(ARC, angle=20.0 * math.pi, pitch=20.0)

    station = default_stations(ring(line=helix).rods[0])

    assert len(station) == 1 + 48 * 10


def test_sections_of_a_curved_rod_stand_upright_on_its_centre_line() -> None:
    solution = ArcSolution(ring(SectionForce("ring", ARC.length, (0.0, 0.0, 7.0))), np.zeros(6))
    found = evaluate(solution).rods[0]

    corners = deformed_surface(solution.scene.rods[0], found, 0.0, np.zeros(3))

    assert corners.shape == (3, len(found.station), 48)
    away = corners - found.position[:, :, None]
    assert np.linalg.norm(away, axis=0) == pytest.approx(WIRE.diameter / 2.0)
    assert np.einsum("in,inc->nc", found.axes[:, 2].T, away) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    ("load", "seen"),
    [
        pytest.param(SectionForce("ring", 50.0, (1.0, 0.0, 0.0)), 2, id="in the plane of the ring"),
        pytest.param(SectionForce("ring", 50.0, (0.0, 0.0, 1.0)), 2, id="out of it"),
    ],
)
def test_a_ring_is_seen_along_its_axis(load: Load, seen: int) -> None:
    scene = ring(load)

    plane = view_plane(scene, evaluate(ArcSolution(scene, np.zeros(6))))

    assert np.abs(np.cross(*plane))[seen] == pytest.approx(1.0)


@pytest.mark.parametrize(
    ("load", "drawn", "text"),
    [
        (SectionForce("ring", 50.0, (0.0, 3.0, 0.0)), 'class="force-head" points', "3 N"),
        (SectionForce("ring", 50.0, (0.0, 0.0, 3.0)), "<circle", "3 N"),
        (SectionMoment("ring", 50.0, (0.0, 0.0, 3.0)), "<polyline", "3 N mm"),
        (SectionMoment("ring", 50.0, (0.0, 3.0, 0.0)), 'class="force-head" points', "3 N mm"),
        (LineLoad("ring", 50.0, 90.0, (0.0, 3.0, 0.0)), 'class="force-head" points', "3 N/mm"),
    ],
)
def test_every_load_is_drawn_with_its_magnitude(load: Load, drawn: str, text: str) -> None:
    scene = ring(load)

    sketch = scene_sketch(scene, evaluate(ArcSolution(scene, np.zeros(6))))

    assert drawn in sketch
    assert f">{text}</text>" in sketch
    assert "nan" not in sketch


def test_a_sketch_shows_the_whole_ring_at_its_size() -> None:
    scene = ring(SectionForce("ring", 50.0, (0.0, 3.0, 0.0)))

    sketch = scene_sketch(scene, evaluate(ArcSolution(scene, np.zeros(6))))

    corners = re.search(r'class="bar" points="([^"]*)"', sketch).group(1)
    points = np.array([[float(number) for number in corner.split(",")] for corner in corners.split()])
    # 100 mm both ways and half the wire beyond each end of the arc's outer side, drawn 250 high
    assert np.ptp(points, axis=0) == pytest.approx([2.5 * (RADIUS + 4.0)] * 2, abs=0.02)


@pytest.fixture
def untreated() -> CaseRun:
    """A case that the rod model answered and the 3D reference refused."""
    scene = ring(SectionForce("ring", ARC.length, (0.0, 0.0, 7.0)))
    checks = (Check("deflection", "ring", 0.01), Check("end_moment_equilibrium", "ring", 0.01))
    case = Case("ring", "A quarter ring", "", scene, RodModelSettings(3, 4), checks, (), None)
    quantities = evaluate(ArcSolution(scene, np.array([0.0, 0.0, -7.0, -700.0, -700.0, 0.0])))
    run = Run("rod", 3, 4, quantities, 0.05, 100.0)
    refusal = "rods.ring.centre_line: found an arc; the 3D reference does not mesh it yet"
    return CaseRun(case, run, (), comparisons_without_reference(case, quantities), refusal)


def test_without_3d_every_check_shows_the_rod_model_s_value_and_is_not_resolved(untreated: CaseRun) -> None:
    deflection, moment = untreated.comparisons

    assert [each.verdict for each in untreated.comparisons] == ["not resolved"] * 2
    assert deflection.value == pytest.approx((ARC.length**2 / 1e4,))  # the largest of the curve
    assert moment.value == pytest.approx((-700.0,))
    assert (moment.reference, moment.difference) == ((), None)
    assert "cannot treat" in moment.reason
    assert not passed(untreated)


def test_without_3d_the_table_says_why(untreated: CaseRun, capsys: pytest.CaptureFixture[str]) -> None:
    print_comparison(untreated)

    out = capsys.readouterr().out
    assert "The 3D reference cannot treat this case: rods.ring.centre_line: found an arc" in out
    assert "not resolved" in out


def test_without_3d_the_page_stands_and_says_why(untreated: CaseRun) -> None:
    page = site.case_pages([untreated], {"ring": site.DrawnPicture("", 0, 0, "", "not drawn")})["ring"]

    assert "The 3D reference cannot treat this case. rods.ring.centre_line: found an arc" in page
    assert ALONE_CAPTION in page
    assert page.count('class="verdict not-resolved"') >= 3


def test_without_3d_the_rod_model_s_results_are_written(untreated: CaseRun, tmp_path, monkeypatch) -> None:
    monkeypatch.setattr(site, "pictures", lambda _: {"ring": site.DrawnPicture("", 0, 0, "", "not drawn")})

    site.write_report([untreated], tmp_path)

    written = {file.name for file in (tmp_path / "results").iterdir()}
    assert written == {"ring-rod.json", "ring-comparisons.json", "ring-peers.json"}


def test_a_case_that_3d_refuses_runs_to_its_end(untreated: CaseRun, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(scene: Scene, progress: object) -> None:
        raise SceneError("rods.ring.centre_line", "an arc", "the 3D reference does not mesh it")

    monkeypatch.setattr(runner, "run_rod", lambda case, **_: untreated.rod)
    monkeypatch.setattr("reference3d.solve_sequence", refuse)

    found = runner.run_case(untreated.case, lambda _: None)

    assert found.references == ()
    assert "the 3D reference does not mesh it" in found.refusal
    assert [each.verdict for each in found.comparisons] == ["not resolved"] * 2


@pytest.mark.slow
def test_curved_rods_are_drawn(drawn: Callable[..., list[bytes]]) -> None:
    loads = (
        SectionForce("ring", ARC.length, (0.0, 0.0, 7.0)),
        SectionMoment("ring", 50.0, (0.0, 9.0, 0.0)),
        LineLoad("ring", 0.0, 90.0, (0.0, 0.0, 1.0)),
    )
    scenes = [ring(*loads, section=section) for section in (WIRE, ANGLE_IRON)]

    round_wire, angle_iron = drawn(*((scene, evaluate(ArcSolution(scene, np.zeros(6)))) for scene in scenes))

    assert round_wire.startswith(b"\x89PNG")
    assert angle_iron != round_wire
