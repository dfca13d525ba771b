"""Contact on ground and of rods that nothing else holds: closed forms, statics and complementarity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm

SIDE = 10.0
STEEL = rm.Material(200e3, 0.3, density=7.85e-9)
INERTIA = SIDE**4 / 12.0


def bar(length: float, elements: int, name: str = "bar", height: float = 0.0) -> rm.Rod:
    line = rm.Line((0.0, height, 0.0), (length, height, 0.0), (0.0, 1.0, 0.0))
    return rm.Rod(name, line, rm.Rectangle(SIDE, SIDE), STEEL, tuple(np.linspace(0.0, length, elements + 1)))


def on_ground(length: float, ground: rm.Ground, loads: tuple, elements: int = 8, gap=0.0) -> rm.Scene:
    pair = rm.ContactPair("ground", rm.RodFace("bar", "bottom"), ground, (0.0, length), gap)
    return rm.Scene("on ground", (bar(length, elements),), (), loads, (pair,))


def assert_complementary(solution: rm.Solution) -> None:
    """No tension, no penetration beyond what multipliers leave (1e-5 mm), and no force across an open gap."""
    for pair in solution.scene.contacts:
        points = solution.contact_points(pair.name)
        assert (points.force >= 0.0).all()
        assert points.gap.min() > -1e-5
        assert np.abs(points.force * points.gap).max() <= 1e-5 * max(points.force.sum(), 1.0)


def test_a_long_beam_lifts_off_a_bed_that_cannot_pull_where_the_closed_form_says() -> None:
    """Weightless and infinite, it touches over pi / beta and sinks as Hetenyi's beam of that length; shear left out."""
    beta = 0.05 / SIDE
    modulus = 4.0 * STEEL.young_modulus * INERTIA * beta**4 / SIDE
    length = 8.0 / beta
    load = rm.SectionForce("bar", 0.5 * length, (0.0, -100.0, 0.0))

    solution = rm.solve(on_ground(length, rm.Ground(modulus), (load,), elements=24), level=3, order=5)

    (stretch,) = solution.stretches
    assert solution.outcome == "converged"
    assert stretch.end - stretch.start == pytest.approx(math.pi / beta, rel=3e-3)
    share = (math.cosh(math.pi) + math.cos(math.pi) + 2.0) / (math.sinh(math.pi) + math.sin(math.pi))
    sinking = solution.displacement("bar", np.array([0.5 * length]))[1, 0]
    assert -sinking == pytest.approx(100.0 * beta / (2.0 * modulus * SIDE) * share, rel=3e-3)


@pytest.mark.parametrize("borders", [np.linspace(0.0, 80.0, 9), (0.0, 1.0, 3.0, 30.0, 31.0, 60.0, 79.0, 80.0)])
def test_where_the_bed_need_not_pull_it_is_a_winkler_bed(borders: Sequence[float]) -> None:
    """On short elements too, whose springs are as soft as the bed says."""
    load = rm.LineLoad("bar", 0.0, 80.0, (0.0, -2.0, 0.0))
    lying = on_ground(80.0, rm.Ground(30.0), (load,))
    lying = replace(lying, rods=(replace(lying.rods[0], element_borders=tuple(borders)),))
    held = rm.Support("bar", 40.0, ("x", "s", "turn y"), "mean")
    bed = rm.Bed(rm.RodFace("bar", "bottom"), 0.0, 80.0, 30.0)

    free = rm.solve(lying, level=3, order=4)
    winkler = rm.solve(replace(lying, contacts=(), supports=(held,), beds=(bed,)), level=3, order=4)

    station = np.linspace(0.0, 80.0, 9)
    np.testing.assert_allclose(
        free.displacement("bar", station)[1], winkler.displacement("bar", station)[1], rtol=1e-6, atol=1e-9
    )


def test_a_free_bar_on_rigid_ground_carries_its_load_where_it_acts() -> None:
    """By statics the ground answers force and moment; a rigid flat under a stiff bar takes it in beneath the force."""
    loads = (rm.SectionForce("bar", 60.0, (0.0, -500.0, 0.0)), rm.Gravity("bar", (0.0, -9810.0, 0.0)))

    solution = rm.solve(on_ground(200.0, rm.Ground(), loads))

    points = solution.contact_points("ground")
    weight = 7.85e-9 * SIDE**2 * 200.0 * 9810.0
    assert solution.outcome == "converged"
    assert points.force.sum() == pytest.approx(500.0 + weight, rel=1e-8)
    assert points.position[0] @ points.force == pytest.approx(500.0 * 60.0 + weight * 100.0, rel=1e-8)
    assert_complementary(solution)


def test_a_bar_lifted_off_the_ground_is_refused_by_name() -> None:
    load = rm.SectionForce("bar", 60.0, (0.0, 500.0, 0.0))

    solution = rm.solve(on_ground(200.0, rm.Ground(), (load,)))

    assert solution.outcome.startswith("refused: contact does not hold 'bar'")


def test_only_the_rods_that_contact_does_not_hold_are_named() -> None:
    """The lower bar rests on the ground; the upper one is lifted off it."""
    scene = on_ground(200.0, rm.Ground(), (rm.SectionForce("bar", 100.0, (0.0, -500.0, 0.0)),))
    upper = bar(200.0, 8, "upper", height=SIDE)
    lifted = rm.SectionForce("upper", 60.0, (0.0, 5.0, 0.0))
    pair = rm.ContactPair("bars", rm.RodFace("bar", "top"), rm.RodFace("upper", "bottom"), (0.0, 200.0), 0.0)

    solution = rm.solve(
        replace(scene, rods=(*scene.rods, upper), loads=(*scene.loads, lifted), contacts=(*scene.contacts, pair))
    )

    assert solution.outcome.startswith("refused: contact does not hold 'upper' against the loads")


def test_a_cantilever_pressed_on_a_cylinder_bends_with_it() -> None:
    """Where it lies on a cylinder of radius R its moment is E I / R and does not change: it presses at the ends alone.

    Beyond, the force bends the bar alone: it lifts off where F (L - a) = E I / R, with the radius of the centre line.
    """
    radius, length, force = 4000.0, 200.0, 600.0
    load = rm.SectionForce("bar", length, (0.0, -force, 0.0))
    scene = on_ground(length, rm.Ground(), (load,), gap=rm.RoundGap(radius, 0.0))

    solution = rm.solve(replace(scene, supports=(rm.Clamp("bar", "start"),)), level=3, order=6)

    expected = length - STEEL.young_modulus * INERTIA / (radius + 0.5 * SIDE) / force
    assert solution.outcome == "converged"
    points = solution.contact_points("ground")
    far = points.position[0] > 60.0
    centre = points.position[0, far] @ points.force[far] / points.force[far].sum()
    assert centre == pytest.approx(expected, abs=0.2 * SIDE)
    inside = np.abs(points.position[0] - 60.0) < 40.0
    assert points.force[inside].sum() < 0.02 * points.force.sum()


@pytest.mark.slow
@pytest.mark.parametrize("radius", [200.0, 2000.0])
def test_a_force_concentrated_on_a_cylinder_is_found_on_coarse_elements(radius: float) -> None:
    """A border search has nothing to follow there; the natural borders with more at the contact answer as fine ones."""
    load = rm.SectionForce("bar", 300.0, (0.0, -500.0, 0.0))
    pair = rm.ContactPair("rest", rm.RodFace("bar", "bottom"), rm.Ground(), (100.0, 200.0), rm.RoundGap(radius, 150.0))

    def force(borders: tuple[float, ...]) -> float:
        rod = replace(bar(300.0, 1), element_borders=borders)
        scene = rm.Scene("rest", (rod,), (rm.Clamp("bar", "start"),), (load,), (pair,))
        solution = rm.solve(scene, level=3, order=5)
        assert solution.outcome == "converged"
        assert solution.edge_uncertainty < 5.0
        return float(solution.contact_points("rest").force.sum())

    coarse, fine = force((0.0, 3.0, 15.0, 75.0, 150.0, 200.0, 250.0, 300.0)), force(tuple(np.linspace(0.0, 300.0, 31)))
    assert coarse == pytest.approx(fine, rel=1e-3)


def test_a_gap_by_table_is_as_given_between_its_stations() -> None:
    """A wedge that opens by 0.4 mm up to the tip: the cantilever touches at its tip alone, which carries the rest."""
    table = rm.GapTable((0.0, 200.0), (0.0, 0.4))
    force = 100.0
    scene = on_ground(200.0, rm.Ground(), (rm.SectionForce("bar", 200.0, (0.0, -force, 0.0)),), gap=table)
    clamped = replace(scene, supports=(rm.Clamp("bar", "start"),))

    touching = rm.solve(clamped, level=2, order=4)
    free = rm.solve(replace(clamped, contacts=()), level=2, order=4)

    tip = np.array([200.0])
    deflection = -free.displacement("bar", tip)[1, 0]
    points = touching.contact_points("ground")
    assert deflection > 1.0
    # Linear in the force; the section squeezes a little where it touches.
    assert points.force.sum() == pytest.approx(force * (1.0 - 0.4 / deflection), rel=5e-3)
    assert touching.displacement("bar", tip)[1, 0] == pytest.approx(-0.4, rel=5e-3)
    assert_complementary(touching)


@pytest.mark.slow
def test_rods_stacked_on_ground_pass_the_load_down() -> None:
    """Three loose bars on one another, the top one pressed: every contact carries the load and the weights above."""
    lengths = (100.0, 80.0, 60.0)
    rods = tuple(bar(length, 4, f"bar {i}", SIDE * i) for i, length in enumerate(lengths))
    pairs = [rm.ContactPair("ground", rm.RodFace("bar 0", "bottom"), rm.Ground(), (0.0, 100.0), 0.0)]
    for lower, upper in ((0, 1), (1, 2)):
        faces = rm.RodFace(f"bar {lower}", "top"), rm.RodFace(f"bar {upper}", "bottom")
        pairs.append(rm.ContactPair(f"joint {upper}", *faces, (0.0, lengths[upper]), 0.0))
    loads = (rm.Pressure(rm.RodFace("bar 2", "top"), 10.0, 50.0, 0.5),)

    solution = rm.solve(rm.Scene("stack", rods, (), loads, tuple(pairs)), level=2, order=4)

    assert solution.outcome == "converged"
    for pair in solution.scene.contacts:
        points = solution.contact_points(pair.name)
        assert points.force.sum() == pytest.approx(0.5 * 40.0 * SIDE, rel=1e-8)
        assert points.position[0] @ points.force == pytest.approx(0.5 * 40.0 * SIDE * 30.0, rel=1e-6)
    assert_complementary(solution)


def test_an_interference_fit_pushes_with_no_load_at_all() -> None:
    """Two bars clamped at both ends with 0.01 mm too little room between them press on each other evenly by half."""
    rods = (bar(120.0, 6, "lower"), bar(120.0, 6, "upper", SIDE))
    clamps = tuple(rm.Clamp(rod.name, end) for rod in rods for end in ("start", "end"))
    pair = rm.ContactPair("fit", rm.RodFace("lower", "top"), rm.RodFace("upper", "bottom"), (30.0, 90.0), -0.01)

    solution = rm.solve(rm.Scene("fit", rods, clamps, (), (pair,)), level=3, order=5)

    # They bow away from each other between the zone's ends, where they touch.
    points = solution.contact_points("fit")
    touching = points.position[0][points.force > 1e-6 * points.force.sum()]
    down, up = (solution.displacement(name, np.array([30.0]))[1, 0] for name in ("lower", "upper"))
    assert solution.outcome == "converged"
    assert np.minimum(np.abs(touching - 30.0), np.abs(touching - 90.0)).max() < 2.0
    assert down == pytest.approx(-up, rel=1e-6)
    assert up - down == pytest.approx(0.01, rel=0.05)  # of the centre lines: the sections squeeze a little
    assert_complementary(solution)


def crossed_cantilevers() -> rm.Scene:
    """Two square cantilevers that cross at right angles near their tips; the upper one is pressed on the lower one."""
    along = rm.Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    across = rm.Line((80.0, SIDE, -80.0), (80.0, SIDE, 20.0), (0.0, 1.0, 0.0))
    borders = (0.0, 30.0, 60.0, 100.0)
    rods = tuple(
        rm.Rod(name, line, rm.Rectangle(SIDE, SIDE), STEEL, borders) for name, line in (("a", along), ("b", across))
    )
    pair = rm.ContactPair("cross", rm.RodFace("a", "top"), rm.RodFace("b", "bottom"), (70.0, 90.0), 0.0)
    clamps = (rm.Clamp("a", "start"), rm.Clamp("b", "start"))
    return rm.Scene("crossed", rods, clamps, (rm.SectionForce("b", 100.0, (0.0, -500.0, 0.0)),), (pair,))


def test_crossed_cantilevers_share_a_force_by_their_stiffness() -> None:
    """By Bernoulli's beams, but for shear and the sections' deformation where they touch."""
    solution = rm.solve(crossed_cantilevers(), level=4, order=5)

    points = solution.contact_points("cross")
    total = points.force.sum()
    assert solution.outcome == "converged"
    assert_complementary(solution)
    # Both deflect alike where they touch, l from each clamp: F (3 L l^2 - l^3) / 6 - P l^3 / 3 = P l^3 / 3.
    length = points.position[0] @ points.force / total
    assert total == pytest.approx(500.0 * (3.0 * 100.0 - length) / (4.0 * length), rel=0.05)
    moment = np.cross(points.position, points.force * points.normal, axis=0).sum(axis=1)
    reaction = solution.reaction("a", 0.0)
    np.testing.assert_allclose(reaction[:3], [0.0, total, 0.0], atol=1e-6)
    np.testing.assert_allclose(reaction[3:], moment, atol=1e-4)


def test_which_of_two_crossing_bars_comes_first_does_not_matter() -> None:
    scene = crossed_cantilevers()
    (pair,) = scene.contacts
    swapped = replace(pair, first=pair.second, second=pair.first)

    forces = [
        rm.solve(replace(scene, contacts=(each,)), level=4, order=5).contact_points("cross").force.sum()
        for each in (pair, swapped)
    ]

    assert forces[0] == pytest.approx(forces[1], rel=5e-3)  # two grids of points on the same square


def test_an_arch_resting_on_a_bar_is_carried_by_it() -> None:
    """A curved face on a flat one with the gap as drawn; the arch is held against all but falling."""
    line = rm.Helix((50.0 - 80.0 * math.sin(0.5), 95.0 - 85.0 * math.cos(0.5), 0.0), (50.0, 95.0, 0.0), *ARC)
    line = replace(line, start=(50.0 - 85.0 * math.sin(0.5), 95.0 - 85.0 * math.cos(0.5), 0.0))
    arch = rm.Rod("arch", line, rm.Rectangle(SIDE, SIDE), STEEL, tuple(np.linspace(0.0, line.length, 13)))
    borders = (0.0, 20.0, 40.0, 44.0, 47.0, 49.0, 50.0, 51.0, 53.0, 56.0, 60.0, 80.0, 100.0)
    straight = replace(bar(100.0, 4), element_borders=borders)
    faces = rm.RodFace("bar", "top"), rm.RodFace("arch", "bottom")
    pair = rm.ContactPair("touch", *faces, (30.0, 70.0), "drawn")
    keep = rm.Support("arch", 0.5 * line.length, ("x", "s", "turn x", "turn y", "turn s"), "mean")
    clamps = (rm.Clamp("bar", "start"), rm.Clamp("bar", "end"), keep)
    load = rm.SectionForce("arch", 0.5 * line.length, (0.0, -300.0, 0.0))

    solution = rm.solve(rm.Scene("arch", (straight, arch), clamps, (load,), (pair,)), level=3, order=5)

    points = solution.contact_points("touch")
    assert solution.outcome == "converged"
    assert points.force.sum() == pytest.approx(300.0, rel=1e-6)
    assert points.position[0] @ points.force / 300.0 == pytest.approx(50.0, abs=0.2)
    assert_complementary(solution)


ARC = ((0.0, 0.0, 1.0), 1.0, (0.0, 1.0, 0.0))
