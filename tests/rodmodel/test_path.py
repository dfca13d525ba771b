"""Paths of several pieces: where they lie, and rods along them."""

from __future__ import annotations

import numpy as np

import rodmodel as rm
from cases.scene import CentreLine, Path, Spline
from rodmodel.borders import natural_mesh
from rodmodel.centre_line import centre_points, constant_turnings, darboux, frames, kinks, knots, turning_at

STEEL = rm.Material(200e3, 0.3)
UP = (0.0, 0.0, 1.0)
BEFORE = rm.Line((50.0, -80.0, 0.0), (50.0, 0.0, 0.0), UP)
ARC = rm.Helix((50.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), np.pi / 2, UP)
AFTER = rm.Line((0.0, 50.0, 0.0), (-60.0, 50.0, 0.0), UP)
HOOK = Path((BEFORE, ARC, AFTER))


def clamped(line: CentreLine, borders: tuple[float, ...], force: tuple[float, float, float]) -> rm.Scene:
    rod = rm.Rod("rod", line, rm.Rectangle(12.0, 8.0), STEEL, borders)
    return rm.Scene("rod", (rod,), (rm.Clamp("rod", "start"),), (rm.SectionForce("rod", line.length, force),), ())


def test_a_path_goes_along_its_pieces() -> None:
    station = np.array([30.0, 80.0 + 20.0, 80.0 + ARC.length + 10.0])
    own = ((BEFORE, 30.0), (ARC, 20.0), (AFTER, 10.0))
    points = np.column_stack([centre_points(piece, np.array([at]))[:, 0] for piece, at in own])
    np.testing.assert_allclose(centre_points(HOOK, station), points, atol=1e-13)
    axes = np.stack([frames(piece, np.array([at]))[0] for piece, at in own])
    np.testing.assert_allclose(frames(HOOK, station), axes, atol=1e-14)


def test_its_turning_jumps_between_pieces() -> None:
    borders = np.array([80.0, 80.0 + ARC.length])
    np.testing.assert_allclose(kinks(HOOK), borders)
    before, after = turning_at(HOOK, borders - 1e-6), turning_at(HOOK, borders + 1e-6)
    np.testing.assert_array_equal(before.T, [(0.0, 0.0, 0.0), darboux(ARC)])
    np.testing.assert_array_equal(after.T, [darboux(ARC), (0.0, 0.0, 0.0)])
    assert constant_turnings(HOOK, np.array([0.0, *borders])) == [(0.0, 0.0, 0.0), darboux(ARC)]


def test_elements_end_between_pieces() -> None:
    scene = clamped(HOOK, (0.0, 100.0, HOOK.length), (1.0, 0.0, 0.0))
    borders = natural_mesh(scene, scene.rods[0], 2, 3).borders
    np.testing.assert_allclose(borders, [0.0, 80.0, 100.0, 80.0 + ARC.length, HOOK.length])


def test_knots_of_its_splines_are_where_they_are_on_the_path() -> None:
    spline = Spline(((50.0, 0.0, 0.0), (50.0, 10.0, 0.0), (50.0, 20.0, 0.0), (50.0, 30.0, 0.0)), UP)
    np.testing.assert_allclose(knots(Path((BEFORE, spline))), [80.0, 90.0, 100.0])


def test_a_straight_path_is_a_line() -> None:
    """Twisted in two pieces as in one."""
    whole = rm.Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), UP, twist=1.0)
    first = rm.Line((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), UP, twist=0.4)
    second = rm.Line((40.0, 0.0, 0.0), (100.0, 0.0, 0.0), tuple(frames(whole, np.array([40.0]))[0, 1]), twist=0.6)
    borders, force = (0.0, 40.0, 100.0), (10.0, 20.0, 30.0)
    found = [
        rm.solve(clamped(line, borders, force), 3, 5).displacement("rod", np.array([70.0, 100.0]))
        for line in (whole, Path((first, second)))
    ]
    np.testing.assert_allclose(found[1], found[0], rtol=1e-9)  # round-off of K, whose condition is 1e6


def test_forces_in_a_path_are_in_equilibrium() -> None:
    """Stress resultants inside elements, away from the clamp, on all three pieces."""
    force = np.array([100.0, 200.0, 300.0])
    borders = (0.0, 10.0, 40.0, 70.0, 80.0, 90.0, 120.0, 150.0, 80.0 + ARC.length, 170.0, 200.0, HOOK.length)
    solution = rm.solve(clamped(HOOK, borders, tuple(force)), 4, 6)
    station = np.array([55.0, 105.0, 185.0])
    points, axes = solution.frame("rod", station)
    end = centre_points(HOOK, np.array([HOOK.length]))
    moment = np.cross(end.T - points.T, force)
    expected = np.column_stack([(axes @ force)[:, [2, 0, 1]], np.einsum("ncg,ng->nc", axes, moment)]).T
    found = solution.section_resultants("rod", station)
    np.testing.assert_allclose(found[:3], expected[:3], atol=2e-3 * np.linalg.norm(force))
    np.testing.assert_allclose(found[3:], expected[3:], atol=2e-3 * np.abs(moment).max())
