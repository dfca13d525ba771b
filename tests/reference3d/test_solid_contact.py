"""Contact of rods of any kind as solids: against the box path, statics, closed forms and complementarity."""

import math
from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from cases.scene import (
    Bed,
    Clamp,
    ContactPair,
    Gravity,
    Ground,
    Helix,
    Joint,
    Line,
    LineLoad,
    Material,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    SectionForce,
    Support,
)
from reference3d import SolidSolution, solve
from reference3d.solid_solver import solve_solid

SIDE = 10.0
SQUARE = Rectangle(SIDE, SIDE)
STEEL = Material(200e3, 0.3, 7.85e-9)
UP = (0.0, 1.0, 0.0)


def bar(name, start, end):
    line = Line(start, end, UP)
    return Rod(name, line, SQUARE, STEEL, (0.0, line.length))


@cache
def crossed(refinement):
    """Two square cantilevers that cross at right angles near their tips; the upper one is pressed on the lower one."""
    rods = bar("a", (0.0, 0.0, 0.0), (100.0, 0.0, 0.0)), bar("b", (80.0, SIDE, -80.0), (80.0, SIDE, 20.0))
    pair = ContactPair("cross", RodFace("a", "top"), RodFace("b", "bottom"), (70.0, 90.0), 0.0)
    clamps = (Clamp("a", "start"), Clamp("b", "start"))
    return solve(Scene("crossed", rods, clamps, (SectionForce("b", 100.0, (0.0, -500.0, 0.0)),), (pair,)), refinement)


def assert_complementary(solution):
    """No tension, no penetration beyond what multipliers leave (1e-6 of displacements of 0.1 mm)."""
    assert solution.outcome == "converged"
    for pair in solution.scene.contacts:
        points = solution.contact_points(pair.name)
        assert (points.force >= 0.0).all()
        assert points.gap.min() > -1e-7
        assert np.abs(points.force * points.gap).max() <= 1e-6 * points.force.sum()


@pytest.mark.slow
@pytest.mark.parametrize(("upper_modulus", "gap"), [(50000.0, 0.0), (20000.0, 0.5)])
def test_parallel_bars_solved_in_both_ways_press_on_each_other_alike(two_cantilevers, upper_modulus, gap):
    scene = two_cantilevers(upper_modulus, gap)

    boxes, solid = solve(scene, 1), solve_solid(scene, 1)

    points, others = boxes.contact_points("lower-upper"), solid.contact_points("lower-upper")
    assert_complementary(solid)
    # meshes of different grading: 2e-4 apart
    assert others.force.sum() == pytest.approx(points.force.sum(), rel=1e-3)
    assert others.position[0] @ others.force == pytest.approx(points.position[0] @ points.force, rel=1e-3)
    one, other = boxes.contact_profile("lower-upper"), solid.contact_profile("lower-upper")
    assert np.trapezoid(other.mean, other.station) == pytest.approx(np.trapezoid(one.mean, one.station), rel=0.02)
    assert (other.station[0], other.station[-1]) == pytest.approx((200.0, 300.0))


@pytest.mark.slow
def test_crossing_cantilevers_share_a_force_by_their_stiffness_and_keep_balance():
    solution = crossed(1)

    points = solution.contact_points("cross")
    total = points.force.sum()
    assert isinstance(solution, SolidSolution)
    assert_complementary(solution)
    # both deflect alike where they touch, l from each clamp: F (3 L l^2 - l^3) / 6 - P l^3 / 3 = P l^3 / 3; beams are
    # 5 % off where contact is at a corner of the sections
    length = points.position[0] @ points.force / total
    assert total == pytest.approx(500.0 * (3.0 * 100.0 - length) / (4.0 * length), rel=0.05)
    moment = np.cross(points.position, points.force * points.normal, axis=0).sum(axis=1)
    reaction = solution.reaction("a", 0.0)
    np.testing.assert_allclose(reaction[:3], [0.0, total, 0.0], atol=1e-6)
    np.testing.assert_allclose(reaction[3:], moment, atol=1e-4)
    # along the zone there is pressure where the other rod is alone
    profile = solution.contact_profile("cross")
    assert (profile.station[0], profile.station[-1]) == pytest.approx((70.0, 90.0))
    assert not profile.outer[(profile.station < 74.9) | (profile.station > 85.1)].any()


@pytest.mark.slow
def test_where_contact_was_located_and_where_not_the_answer_is_the_same():
    scene = crossed(1).scene

    located, everywhere = solve_solid(scene, 2, crossed(1)), solve_solid(scene, 2)

    forces = [each.contact_points("cross").force for each in (located, everywhere)]
    np.testing.assert_allclose(*forces, atol=1e-6)
    # the coarse mesh is 2e-3 off
    assert forces[0].sum() == pytest.approx(crossed(1).contact_points("cross").force.sum(), rel=2e-3)


@pytest.mark.slow
def test_an_arch_on_a_bar_touches_below_its_middle_and_passes_on_what_its_supports_leave():
    start = (50.0 - 85.0 * math.sin(0.5), 95.0 - 85.0 * math.cos(0.5), 0.0)
    line = Helix(start, (50.0, 95.0, 0.0), (0.0, 0.0, 1.0), 1.0, UP)
    rods = bar("bar", (0.0, 0.0, 0.0), (100.0, 0.0, 0.0)), Rod("arch", line, SQUARE, STEEL, (0.0, line.length))
    pair = ContactPair("touch", RodFace("bar", "top"), RodFace("arch", "bottom"), (45.0, 55.0), "drawn")
    ends = (Support("arch", 0.0, ("x", "y", "s", "turn s"), "mean"), Support("arch", line.length, ("x", "y"), "mean"))
    supports = (Clamp("bar", "start"), Clamp("bar", "end"), *ends)
    load = SectionForce("arch", 0.5 * line.length, (0.0, -300.0, 0.0))

    solution = solve(Scene("arch", rods, supports, (load,), (pair,)), 1)

    points = solution.contact_points("touch")
    assert_complementary(solution)
    held = [solution.reaction("bar", 0.0)[1], solution.reaction("bar", 100.0)[1]]
    assert points.force.sum() == pytest.approx(sum(held), rel=1e-8)
    ends = [solution.reaction("arch", 0.0)[1], solution.reaction("arch", line.length)[1]]
    assert sum(held) + sum(ends) == pytest.approx(300.0, rel=1e-8)
    assert points.position[0] @ points.force / points.force.sum() == pytest.approx(50.0, abs=0.1)
    # it touches the outside of the arc, which is 0.6 mm off the bar at 10 mm from its middle
    assert np.abs(points.position[0][points.force > 0.0] - 50.0).max() < 2.0


def test_ground_carries_a_bar_that_a_joint_holds():
    """A post, a beam joined to its top, and rigid ground under the beam's end: statics of the whole."""
    corner = (0.0, 60.0, 0.0)
    rods = (
        bar("beam", corner, (120.0, 60.0, 0.0)),
        Rod("post", Line((0, 0, 0), corner, (0, 0, 1)), SQUARE, STEEL, (0, 60)),
    )
    pair = ContactPair("ground", RodFace("beam", "bottom"), Ground(), (100.0, 120.0), 0.01)
    joint = Joint((RodEnd("post", "end"), RodEnd("beam", "start")))
    loads = (LineLoad("beam", 0.0, 120.0, (0.0, -2.0, 0.0)), Gravity("beam", (0.0, -9810.0, 0.0)))

    solution = solve(Scene("frame", rods, (Clamp("post", "start"),), loads, (pair,), (joint,)), 1)

    points = solution.contact_points("ground")
    weight = 7.85e-9 * SIDE**2 * 120.0 * 9810.0 + 240.0
    foot = solution.reaction("post", 0.0)
    assert_complementary(solution)
    assert points.force.sum() > 50.0
    assert foot[1] + points.force.sum() == pytest.approx(weight, rel=1e-8)
    assert foot[5] + points.position[0] @ points.force == pytest.approx(weight * 60.0, rel=1e-6)


def test_where_a_bed_of_contact_need_not_pull_it_is_a_winkler_bed():
    """The same springs, counted at nodes and at Gauss points."""
    load = LineLoad("bar", 0.0, 80.0, (0.0, -2.0, 0.0))
    keep = Clamp("bar", "start")
    pair = ContactPair("bed", RodFace("bar", "bottom"), Ground(30.0), (40.0, 80.0), 0.0)
    lying = Scene("bed", (bar("bar", (0.0, 0.0, 0.0), (80.0, 0.0, 0.0)),), (keep,), (load,), (pair,))
    bed = Bed(RodFace("bar", "bottom"), 40.0, 80.0, 30.0)

    touching, springs = solve(lying, 1), solve(replace(lying, contacts=(), beds=(bed,)), 1)

    station = np.linspace(0.0, 80.0, 9)
    assert touching.outcome == "converged"
    np.testing.assert_allclose(
        touching.displacement("bar", station)[1], springs.displacement("bar", station)[1], rtol=5e-3, atol=1e-5
    )
