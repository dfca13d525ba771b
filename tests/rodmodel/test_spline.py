"""Splines: the curve and its frames, and rods along them."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline

import rodmodel as rm
from cases.scene import Bed, CentreLine, Gravity, LineLoad, Load, Path, Pressure, Section, Spline
from rodmodel.borders import natural_mesh
from rodmodel.centre_line import centre_points, frames, knots, roughness, turning_at
from rodmodel.section import Fields, section_stiffness
from rodmodel.stiffness import axial_quadrature, varying_stiffness
from rodmodel.symmetry import scene_mirrors

STEEL = rm.Material(200e3, 0.3, 7.85e-9)
ARC = rm.Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), np.pi / 2, (0.0, 0.0, 1.0))
SKEW = ((0.0, 0.0, 0.0), (50.0, 0.0, 0.0), (60.0, 60.0, 10.0), (20.0, 80.0, 60.0), (0.0, 100.0, 90.0))


def through(line: CentreLine, count: int, frame: str = "minimal rotation") -> Spline:
    """The spline through points of another line, with its first frame."""
    points = centre_points(line, np.linspace(0.0, line.length, count)).T
    return Spline(tuple(map(tuple, points.tolist())), tuple(frames(line, np.zeros(1))[0, 1].tolist()), frame)


def clamped(line: CentreLine, section: Section, *loads: Load, beds: tuple[Bed, ...] = ()) -> rm.Scene:
    """A rod of sixteen equal elements behind two short ones, clamped at its start."""
    borders = (0.0, 3.0, *np.linspace(12.0, line.length, 17).tolist())
    rod = rm.Rod("bow", line, section, STEEL, borders)
    return rm.Scene("bow", (rod,), (rm.Clamp("bow", "start"),), loads, (), beds=beds)


def end_displacement(scene: rm.Scene, level: int = 3, order: int = 5) -> np.ndarray:
    return rm.solve(scene, level, order).displacement("bow", np.array([scene.rods[0].length]))[:, 0]


def test_arc_length_is_that_of_the_scene() -> None:
    """The scene integrates it by itself."""
    line = Spline(SKEW, (0.0, 0.0, 1.0))
    np.testing.assert_allclose(centre_points(line, np.array([0.0, line.length])).T, [SKEW[0], SKEW[-1]], atol=1e-11)
    np.testing.assert_allclose(centre_points(line, knots(line)).T, SKEW[1:-1], atol=1e-11)


def test_frame_is_moved_without_turning_about_the_tangent() -> None:
    """Against e1' = -(e1 . t') t along scipy's spline, solved as an ordinary differential equation."""
    line = Spline(SKEW, (0.0, 0.3, 1.0))
    chords = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(SKEW, axis=0), axis=1))])
    curve = CubicSpline(chords, SKEW)

    def slope(parameter: float, e1: np.ndarray) -> np.ndarray:
        # e1 is normal to r', so that only r'' / |r'| of t' counts
        velocity, bend = curve(parameter, 1), curve(parameter, 2)
        return -(e1 @ bend) * velocity / (velocity @ velocity)

    first, last = frames(line, np.array([0.0, line.length]))
    e1 = first[0]
    for piece in pairwise(chords):
        e1 = solve_ivp(slope, piece, e1, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    np.testing.assert_allclose(last[0], e1, atol=1e-10)


def test_frame_of_a_spline_along_a_helix_lags_behind_the_helix_own() -> None:
    """The helix' frame turns about t by tau = c / (r^2 + c^2) per arc length, c its rise per radian."""
    helix = rm.Helix((50.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 5.0, (0.0, 0.0, 1.0), 2.0 * np.pi * 20.0)
    angle = 20.0 / (50.0**2 + 20.0**2) * helix.length
    e1, e2, _ = frames(helix, np.array([helix.length]))[0]
    expected = np.array([np.cos(angle) * e1 - np.sin(angle) * e2, np.sin(angle) * e1 + np.cos(angle) * e2])
    errors = []
    for count in (33, 65):
        line = through(helix, count)
        errors.append(np.abs(frames(line, np.array([line.length]))[0, :2] - expected).max())
    # The spline's end tangent is of third order in the distance of the points.
    assert errors[1] < 1e-4
    assert errors[0] / errors[1] > 6.0


def test_frame_up_keeps_e1_level() -> None:
    line = Spline(SKEW, (0.0, 0.0, 2.0), "up")
    np.testing.assert_allclose(frames(line, np.linspace(0.0, line.length, 9))[:, 0, 2], 0.0, atol=1e-15)


@pytest.mark.parametrize("frame", ["minimal rotation", "up"])
def test_rigid_motions_cost_the_less_energy_the_higher_the_order(frame: str) -> None:
    line = Spline(SKEW, (0.0, 0.0, 1.0), frame)
    ends = (float(knots(line)[0]), float(knots(line)[0]) + 20.0)
    left = []
    for order in (3, 5, 7):
        quadrature = axial_quadrature(order, *ends, knots(line))
        turning = turning_at(line, ends[0] + 10.0 * (1.0 + quadrature[0]))
        section = section_stiffness(rm.Rectangle(12.0, 8.0), rm.Material(1.0, 0.3), Fields(2), turning)
        eigenvalues = np.linalg.eigvalsh(varying_stiffness(order, 20.0, quadrature, section))
        assert eigenvalues[6] > 1e-7 * eigenvalues[-1]
        left.append(np.abs(eigenvalues[:6]).max() / eigenvalues[-1])
    assert left[1] < 1e-2 * left[0]
    assert left[2] < 1e-2 * left[1]


def test_spline_of_a_quarter_ring_bends_as_the_ring() -> None:
    section, force = rm.Rectangle(15.0, 10.0), (100.0, 300.0, 500.0)
    expected = end_displacement(clamped(ARC, section, rm.SectionForce("bow", ARC.length, force)))
    errors = []
    for count in (17, 33, 65):
        line = through(ARC, count)
        found = end_displacement(clamped(line, section, rm.SectionForce("bow", line.length, force)))
        errors.append(np.abs(found - expected).max() / np.abs(expected).max())
    assert errors[0] < 1e-5
    # The spline is off by the fourth power of the points' distance, its ends by the third.
    assert np.all(np.divide(errors[:-1], errors[1:]) > 5.0)


def test_stress_and_resultants_of_a_spline_are_those_of_the_ring() -> None:
    section, force = rm.Rectangle(15.0, 10.0), (100.0, 300.0, 500.0)
    line = through(ARC, 65)
    ring, spline = (
        rm.solve(clamped(each, section, rm.SectionForce("bow", each.length, force)), 3, 5) for each in (ARC, line)
    )
    points = np.array([[7.0, -3.0], [4.0, 2.0], [50.0, 90.0]])
    stress = ring.stress("bow", points)
    np.testing.assert_allclose(spline.stress("bow", points), stress, atol=2e-4 * np.abs(stress).max())
    # The axial force is what is left between large stresses of bending; curvature is off by 4e-4 at the ends.
    resultants, found = (each.section_resultants("bow", points[2]) for each in (ring, spline))
    np.testing.assert_allclose(found[:3], resultants[:3], atol=3e-3 * np.abs(resultants[:3]).max())
    np.testing.assert_allclose(found[3:], resultants[3:], atol=1e-4 * np.abs(resultants[3:]).max())


def test_spline_through_points_of_a_straight_line_is_that_line() -> None:
    section, force = rm.Rectangle(15.0, 10.0), (100.0, 300.0, 500.0)
    straight = rm.Line((0.0, 0.0, 0.0), (80.0, 0.0, 60.0), (0.0, 1.0, 0.0))
    points = tuple((80.0 * part, 0.0, 60.0 * part) for part in (0.0, 0.2, 0.35, 0.8, 1.0))
    spline = Spline(points, straight.up)
    load = rm.SectionForce("bow", 100.0, force)
    expected = end_displacement(clamped(straight, section, load))
    # round-off of K, whose condition is 1e7
    np.testing.assert_allclose(end_displacement(clamped(spline, section, load)), expected, rtol=1e-8)


def test_elements_end_where_curvature_changes_its_slope_abruptly() -> None:
    """Of a sharp curve's points all inner ones but the first and last, where not-a-knot ends leave no jump."""
    for line, count in ((Spline(SKEW, (0.0, 0.0, 1.0)), 1), (through(ARC, 65), 16)):
        rod = rm.Rod("bow", line, rm.Circle(8.0), STEEL, tuple(np.linspace(0.0, line.length, count + 1).tolist()))
        borders = natural_mesh(rm.Scene("bow", (rod,), (rm.Clamp("bow", "start"),), (), ()), rod, 2, 3).borders
        expected = rod.element_borders if count > 1 else (0.0, knots(line)[1], line.length)
        np.testing.assert_allclose(borders, expected)


def test_jumps_of_the_slope_of_curvature() -> None:
    line = Spline(SKEW, (0.0, 0.0, 1.0))
    at, step = knots(line), 1e-4
    before, after = (
        turning_at(line, at + sign * step) - turning_at(line, at + 2.0 * sign * step) for sign in (-1.0, 1.0)
    )
    jump = np.linalg.norm((after + before)[:2], axis=0) / step
    np.testing.assert_allclose(roughness(line), jump, rtol=1e-3, atol=1e-7)  # one-sided differences


def test_a_load_on_a_sharp_curve_is_carried_whole() -> None:
    line = Spline(SKEW, (0.0, 0.0, 1.0))
    load = LineLoad("bow", 0.0, line.length, (0.0, 1.0, -2.0))
    rod = rm.Rod("bow", line, rm.Rectangle(8.0, 6.0), STEEL, tuple(np.linspace(0.0, line.length, 13).tolist()))
    solution = rm.solve(rm.Scene("bow", (rod,), (rm.Clamp("bow", "start"),), (load,), ()), 2, 8)
    force = line.length * np.array([0.0, -1.0, 2.0])
    np.testing.assert_allclose(solution.reaction("bow", 0.0)[:3], force, atol=1e-6 * line.length)


def test_it_does_not_matter_which_frame_a_round_rod_has() -> None:
    found = []
    for frame in ("minimal rotation", "up"):
        line = Spline(SKEW, (0.0, 0.0, 1.0), frame)
        borders = np.sort(np.concatenate([np.linspace(0.0, line.length, 13), knots(line)]))
        rod = rm.Rod("bow", line, rm.Circle(8.0), STEEL, tuple(borders.tolist()))
        load = rm.SectionForce("bow", line.length, (100.0, 300.0, -50.0))
        found.append(end_displacement(rm.Scene("bow", (rod,), (rm.Clamp("bow", "start"),), (load,), ()), 2, 8))
    # what order 8 leaves on 15 elements; 24 leave 1e-10
    np.testing.assert_allclose(found[0], found[1], atol=1e-6 * np.abs(found[0]).max())


def test_weight_of_a_spline_rests_on_its_clamp() -> None:
    line = through(ARC, 9)
    solution = rm.solve(clamped(line, rm.Rectangle(6.0, 4.0), Gravity("bow", (0.0, 0.0, -9810.0))), 2, 8)
    weight = 7.85e-9 * 9810.0 * 24.0 * line.length
    # Rigid motions are no polynomials on a curved element: order 8 holds them to this.
    np.testing.assert_allclose(solution.reaction("bow", 0.0)[:3], [0.0, 0.0, weight], atol=1e-7 * weight)


def test_pressure_and_bed_act_on_a_spline_as_on_the_ring() -> None:
    section = rm.Rectangle(15.0, 10.0)
    found = []
    for line in (ARC, through(ARC, 65)):
        face = rm.RodFace("bow", "right")
        bed = Bed(face, 12.0, line.length, 5.0)
        scene = clamped(line, section, Pressure(face, 12.0, line.length, 2.0), beds=(bed,))
        found.append(end_displacement(scene))
    np.testing.assert_allclose(found[1], found[0], atol=1e-5 * np.abs(found[0]).max())


def test_symmetry_of_a_plane_spline_is_found() -> None:
    section = rm.Rectangle(15.0, 10.0)
    flat = through(ARC, 9)
    assert scene_mirrors(clamped(flat, section))["bow"] == scene_mirrors(clamped(ARC, section))["bow"] == (False, True)
    straight = rm.Line((100.0, -50.0, 0.0), (100.0, 0.0, 0.0), (0.0, 0.0, 1.0))
    assert scene_mirrors(clamped(Path((straight, ARC)), section))["bow"] == (False, True)
    assert scene_mirrors(clamped(Spline(SKEW, (0.0, 0.0, 1.0)), section))["bow"] == (False, False)
