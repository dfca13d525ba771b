"""Rods of all kinds as solids, against closed forms, published values and 3D results made elsewhere."""

import json
import math
from dataclasses import replace
from functools import cache
from importlib.resources import files

import numpy as np
import pytest

from cases.scene import (
    Bed,
    Box,
    Circle,
    Clamp,
    Gravity,
    Helix,
    Joint,
    Line,
    LineLoad,
    Material,
    Orthotropic,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
)
from reference3d import SolidSolution, formal_order, grid_convergence, solid_solver, solve, solve_sequence
from reference3d.solid_solver import solve_solid

YOUNG, RATIO = 200000.0, 0.3
STEEL = Material(YOUNG, RATIO, 7.85e-9)
CORK = Material(YOUNG, 0.0, 7.85e-9)
SIDE = 10.0
SQUARE = Rectangle(SIDE, SIDE)
MOMENT_OF_AREA = SIDE**4 / 12.0
ALONG_X = Line((0.0, 0.0, 0.0), (200.0, 0.0, 0.0), (0.0, 1.0, 0.0))
RING = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (1.0, 0.0, 0.0))


CLAMPED = (Clamp("rod", "start"),)


def one_rod(line, section, loads, material=STEEL, supports=CLAMPED, **more):
    rod = Rod("rod", line, section, material, (0.0, line.length))
    return Scene("one rod", (rod,), supports, loads, (), **more)


def end(rod):
    return np.array([rod.centre_line.length])


def estimated(scene, quantity):
    """Extrapolated value and uncertainty of a quantity over the three meshes."""
    solutions = solve_sequence(scene)
    assert all(each.outcome == "converged" for each in solutions)
    sizes = tuple(each.representative_size for each in solutions)
    return grid_convergence(tuple(quantity(each) for each in solutions), sizes, formal_order(scene))


def test_a_bar_solved_in_both_ways_has_the_same_answer(cantilever):
    scene = cantilever((30.0, -100.0, 20.0))

    bar, solid = solve(scene, 1), solve_solid(scene, 1)

    # the section is divided alike; along the bar the solid has longer cells: 1.5e-4 of the deflection apart
    at = np.array([300.0])
    np.testing.assert_allclose(solid.displacement("rod", at), bar.displacement("rod", at), rtol=5e-4)
    np.testing.assert_allclose(solid.reaction("rod", 0.0), bar.reaction("rod", 0.0), atol=1e-5)


@pytest.mark.parametrize(
    "section", [Circle(10.0), Ring(10.0, 7.0), Box(10.0, 12.0, 2.0)], ids=lambda s: type(s).__name__
)
def test_tension_and_bending_without_contraction_are_those_of_beams(section):
    size = 12.0
    inner = {Circle: 0.0, Ring: 7.0}.get(type(section))
    if inner is None:
        area, moment = 10.0 * 12.0 - 6.0 * 8.0, (10.0 * 12.0**3 - 6.0 * 8.0**3) / 12.0
    else:
        area, moment = math.pi / 4.0 * (100.0 - inner**2), math.pi / 64.0 * (10.0**4 - inner**4)
    loads = (SectionForce("rod", 200.0, (500.0, 0.0, 0.0)), SectionMoment("rod", 200.0, (0.0, 0.0, 3000.0)))

    solution = solve(one_rod(ALONG_X, section, loads, CORK), 1)

    # int t y = M1 about e1 = -Z: a moment about Z bends upwards; second moments of arcs are 3e-4 off at this mesh
    assert solution.displacement("rod", np.array([200.0]))[:2, 0] == pytest.approx(
        [500.0 * 200.0 / (YOUNG * area), 3000.0 * 200.0**2 / (2.0 * YOUNG * moment)], rel=3e-4
    )
    resultants = solution.section_resultants("rod", np.array([0.0, 90.0, 200.0]))
    np.testing.assert_allclose(resultants[0], 500.0, rtol=1e-6)
    np.testing.assert_allclose(resultants[3], -3000.0, rtol=1e-6)
    stress = solution.stress("rod", np.array([[0.0], [size / 2.0 - 0.5 if inner is None else 4.0], [90.0]]))
    y = size / 2.0 - 0.5 if inner is None else 4.0
    assert stress[2, 0] == pytest.approx(500.0 / area - 3000.0 * y / moment, rel=2e-3)  # pointwise


@pytest.mark.slow
def test_a_circular_cantilever_bends_and_twists_as_beam_theory_says():
    loads = (SectionForce("rod", 200.0, (0.0, -100.0, 0.0)), SectionMoment("rod", 200.0, (4000.0, 0.0, 0.0)))

    found = estimated(one_rod(ALONG_X, Circle(SIDE), loads), lambda each: 2.0 * each.strain_energy)

    moment = math.pi * SIDE**4 / 64.0
    shear = YOUNG / (2.0 * (1.0 + RATIO))
    cowper = 6.0 * (1.0 + RATIO) / (7.0 + 6.0 * RATIO)
    bent = 200.0**3 / (3.0 * YOUNG * moment) + 200.0 / (cowper * shear * math.pi * SIDE**2 / 4.0)
    expected = 100.0**2 * bent + 4000.0**2 * 200.0 / (shear * 2.0 * moment)
    # the clamp keeps the section from contracting, which takes 0.1 diameters off the length or less
    assert found.extrapolated == pytest.approx(expected, rel=0.1 * SIDE / 200.0)
    assert found.uncertainty < 1e-3 * expected


@pytest.mark.slow
@pytest.mark.parametrize(("load", "component"), [("out_of_plane", 2), ("radial", 1)])
def test_a_quarter_ring_is_that_of_other_solvers(load, component):
    truth = json.loads((files("cases") / "truth" / "quarter_ring_r100.json").read_text(encoding="utf-8"))
    values = truth["loads"][load]
    scene = one_rod(RING, Rectangle(15.0, 15.0), (SectionForce("rod", RING.length, tuple(values["force_N"])),))

    # work of the force over its size: the mean displacement of the end face
    found = estimated(scene, lambda each: 2.0 * each.strain_energy / 1000.0)

    apart = abs(found.extrapolated - values["end_face_mean_displacement_mm"][component])
    assert apart < found.uncertainty + values["uncertainty_mm"]
    assert found.uncertainty < 5e-4 * found.extrapolated


@pytest.mark.slow
@pytest.mark.parametrize(("force", "expected"), [((0.0, 1.0, 0.0), 0.00175325), ((0.0, 0.0, 1.0), 0.00542453)])
def test_the_twisted_beam_of_macneal_and_harder(force, expected):
    """R. H. MacNeal, R. L. Harder, Finite Elements in Analysis and Design 1 (1985) 3-20; 3D made elsewhere."""
    line = Line((0.0, 0.0, 0.0), (12.0, 0.0, 0.0), (0.0, 1.0, 0.0), math.pi / 2.0)
    scene = one_rod(line, Rectangle(0.32, 1.1), (SectionForce("rod", 12.0, force),), Material(29e6, 0.22))

    found = 2.0 * solve(scene).strain_energy

    # what the clamp's edge adds is known to 1e-4 only: finer meshes here give 0.00175336 and 0.00542482
    assert found == pytest.approx(expected, rel=1e-4)


@pytest.mark.slow
def test_one_turn_of_a_spring_gives_way_as_its_wire_twists():
    """R^2 l / (G J), the force on the axis; A. M. Wahl, Mechanical Springs, 1963."""
    radius, wire, pitch = 50.0, 5.0, 12.0
    line = Helix((radius, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0 * math.pi, (0.0, 0.0, 1.0), pitch)
    loads = (SectionForce("rod", line.length, (0.0, 0.0, 1.0)), SectionMoment("rod", line.length, (0.0, radius, 0.0)))

    found = 2.0 * solve(one_rod(line, Circle(wire), loads)).strain_energy

    length = math.hypot(2.0 * math.pi * radius, pitch)
    sine, cosine = pitch / length, 2.0 * math.pi * radius / length
    shear, moment = YOUNG / (2.0 * (1.0 + RATIO)), math.pi * wire**4 / 64.0
    expected = radius**2 * length * (cosine**2 / (shear * 2.0 * moment) + sine**2 / (YOUNG * moment))
    # curvature of the wire, clamp and the mesh: 1 / index^2 = 2.5e-3, and 1e-3 of a turn
    assert found == pytest.approx(expected, rel=4e-3)


@pytest.mark.parametrize(
    "line",
    [
        replace(ALONG_X, twist=1.0),
        RING,
        Spline(((0.0, 0.0, 0.0), (50.0, 10.0, 0.0), (100.0, 0.0, 20.0), (130.0, 40.0, 60.0)), (0.0, 0.0, 1.0)),
    ],
    ids=["twisted", "arc", "spline"],
)
def test_reactions_balance_all_loads(line):
    length = line.length
    loads = (
        SectionForce("rod", 0.5 * length, (1.0, 2.0, 3.0)),
        LineLoad("rod", 0.25 * length, length, (0.1, -0.2, 0.3)),
        Gravity("rod", (0.0, -9810.0, 0.0)),
    )

    solution = solve(one_rod(line, SQUARE, loads), 1)

    weight = 7.85e-9 * SIDE**2 * length * 9810.0
    total = np.array([1.0, 2.0, 3.0]) + 0.75 * length * np.array([0.1, -0.2, 0.3]) + [0.0, -weight, 0.0]
    # volumes of curved elements are off by 1e-4 at the coarsest mesh
    np.testing.assert_allclose(solution.reaction("rod", 0.0)[:3], -total, atol=1e-3 * weight + 1e-6)
    assert not solution.reaction("rod", length).any()


def test_pressure_on_a_twisted_face_pushes_against_its_area():
    line = replace(ALONG_X, twist=1.0)

    solution = solve(one_rod(line, SQUARE, (Pressure(RodFace("rod", "top"), 50.0, 200.0, 0.2),)), 1)

    # area vectors: along e2 (cos, sin of the turn towards -e1 = Z at the start), times width
    angle = np.array([0.25, 1.0])
    up, aside = np.diff(np.sin(angle))[0], -np.diff(np.cos(angle))[0]
    expected = 0.2 * SIDE * 200.0 * np.array([0.0, up, aside])
    np.testing.assert_allclose(solution.reaction("rod", 0.0)[:3], expected, atol=2e-3 * np.abs(expected).max())


def test_an_orthotropic_bar_bends_by_its_modulus_along_the_rod():
    wood = Orthotropic((900.0, 500.0, 12000.0), (700.0, 800.0, 60.0), (0.0, 0.0, 0.0))

    solution = solve(one_rod(ALONG_X, SQUARE, (SectionMoment("rod", 200.0, (0.0, 0.0, 3000.0)),), wood), 1)

    expected = 3000.0 * 200.0**2 / (2.0 * 12000.0 * MOMENT_OF_AREA)
    assert solution.displacement("rod", np.array([200.0]))[1, 0] == pytest.approx(expected, rel=1e-9)


def test_a_moved_clamp_carries_a_free_rod_along_without_stress():
    supports = (Clamp("rod", "start", (0.1, 0.2, 0.3), (0.0, 0.0, 0.01)),)

    solution = solve(one_rod(RING, Circle(SIDE), (), supports=supports), 1)

    assert solution.outcome == "converged"
    # turned by 0.01 about Z through (100, 0, 0): the end at (0, 100, 0) moves by 0.01 Z x (-100, 100, 0)
    np.testing.assert_allclose(
        solution.displacement("rod", np.array([RING.length]))[:, 0], [-0.9, -0.8, 0.3], rtol=1e-7
    )
    assert solution.strain_energy < 1e-15
    np.testing.assert_allclose(solution.stress("rod", np.array([[1.0], [2.0], [50.0]])), 0.0, atol=1e-6)


@pytest.mark.slow
def test_a_mean_support_carries_a_beam_at_both_ends_as_pin_and_roller():
    length, force = 200.0, 100.0
    supports = (
        Support("rod", 0.0, ("x", "y", "s", "turn s"), "mean"),
        Support("rod", length, ("x", "y"), "mean"),
    )
    load = SectionForce("rod", 0.5 * length, (0.0, -force, 0.0))

    solution = solve(one_rod(ALONG_X, SQUARE, (load,), CORK, supports))

    shear = 6.0 / 5.0 * force * length / (4.0 * 0.5 * YOUNG * SIDE**2)
    expected = force * length**3 / (48.0 * YOUNG * MOMENT_OF_AREA) + shear
    # work of the load; the shear strain near loads and supports is not as beam theory has it: 1e-3 of the whole
    assert 2.0 * solution.strain_energy / force == pytest.approx(expected, rel=1e-3)
    np.testing.assert_allclose(solution.reaction("rod", length)[:3], [0.0, 50.0, 0.0], atol=1e-6)
    np.testing.assert_allclose(solution.reaction("rod", 0.0)[3:], 0.0, atol=1e-5)


def test_a_support_of_a_section_gives_what_it_is_set_to():
    supports = (Clamp("rod", "start"), Support("rod", 200.0, ("y",), "section", (0.4,)))

    solution = solve(one_rod(ALONG_X, SQUARE, (), supports=supports), 1)

    assert solution.displacement("rod", np.array([200.0]))[1, 0] == pytest.approx(0.4, rel=1e-12)
    reaction = solution.reaction("rod", 200.0)
    np.testing.assert_allclose(reaction[:3], -solution.reaction("rod", 0.0)[:3], atol=1e-6)
    # work of the support is the energy
    assert solution.strain_energy == pytest.approx(0.5 * 0.4 * reaction[1], rel=1e-9)


def test_a_mean_rotation_that_is_set_bends_a_rod_as_the_moment_it_takes():
    supports = (Clamp("rod", "start"), Support("rod", 200.0, ("turn x",), "mean", (0.01,)))

    solution = solve(one_rod(ALONG_X, SQUARE, (), CORK, supports), 1)

    # about e1 = -Z: the end goes down, M = E I / L * angle
    assert solution.reaction("rod", 200.0)[5] == pytest.approx(-YOUNG * MOMENT_OF_AREA / 200.0 * 0.01, rel=1e-9)
    assert solution.displacement("rod", np.array([200.0]))[1, 0] == pytest.approx(-0.01 * 200.0 / 2.0, rel=1e-9)


@cache
def frame(force):
    """A post clamped at its foot and a beam joined to its top at right angles, under a force on the beam's end."""
    corner = (0.0, 200.0, 0.0)
    rods = (
        Rod("post", Line((0.0, 0.0, 0.0), corner, (0.0, 0.0, 1.0)), SQUARE, CORK, (0.0, 200.0)),
        Rod("beam", Line(corner, (150.0, 200.0, 0.0), (0.0, 0.0, 1.0)), SQUARE, CORK, (0.0, 150.0)),
    )
    joint = Joint((RodEnd("post", "end"), RodEnd("beam", "start")))
    load = SectionForce("beam", 150.0, force)
    return solve(Scene("frame", rods, (Clamp("post", "start"),), (load,), (), (joint,)), 1)


def test_a_frame_of_two_bars_gives_way_as_castigliano_says():
    solution = frame((0.0, -100.0, 0.0))

    bending, shear = YOUNG * MOMENT_OF_AREA, 5.0 / 6.0 * 0.5 * YOUNG * SIDE**2
    expected = (150.0**3 / 3.0 + 150.0**2 * 200.0) / bending + 150.0 / shear + 200.0 / (YOUNG * SIDE**2)
    # without contraction the rigid joint hinders the warping of shear alone, 1e-4 of the whole; mesh 1e-4
    assert 2.0 * solution.strain_energy / 100.0**2 == pytest.approx(expected, rel=3e-4)


def test_a_joint_is_in_balance_and_its_rods_move_as_one():
    solution = frame((30.0, -100.0, 20.0))

    post, beam = solution.reaction("post", 200.0), solution.reaction("beam", 0.0)
    np.testing.assert_allclose(post + beam, 0.0, atol=1e-4)
    np.testing.assert_allclose(post, [30.0, -100.0, 20.0, 0.0, -150.0 * 20.0, -150.0 * 100.0], atol=1e-4)
    np.testing.assert_allclose(
        solution.displacement("post", np.array([200.0])), solution.displacement("beam", np.array([0.0])), atol=1e-12
    )


def test_rods_joined_to_a_held_one_need_no_support_of_their_own_and_others_are_refused():
    rods = tuple(
        Rod(name, Line((0.0, height, 0.0), (100.0, height, 0.0), (0.0, 1.0, 0.0)), Circle(5.0), STEEL, (0.0, 100.0))
        for name, height in (("held", 0.0), ("loose", 50.0))
    )

    with pytest.raises(SceneError, match=r"nothing that holds 'loose' against moving along \(1, 0, 0\)"):
        solve(Scene("loose", rods, (Clamp("held", "start"), Support("loose", 0.0, ("x", "y"))), (), ()), 1)


def test_a_rod_that_can_only_turn_is_refused_with_the_axis():
    supports = (Support("rod", 0.0, ("x", "y", "s"), "mean"), Support("rod", 200.0, ("x", "y"), "mean"))
    aside = SectionForce("rod", 100.0, (0.0, -10.0, 10.0))

    with pytest.raises(SceneError, match=r"nothing that holds 'rod' against turning about \(1, 0, 0\)"):
        solve(one_rod(ALONG_X, SQUARE, (aside,), supports=supports), 1)


def test_motions_out_of_the_plane_in_which_all_of_a_scene_lies_need_no_support():
    supports = (Support("rod", 0.0, ("x", "y", "s"), "mean"), Support("rod", 200.0, ("x", "y"), "mean"))
    down = SectionForce("rod", 100.0, (0.0, -10.0, 0.0))

    solution = solve(one_rod(ALONG_X, SQUARE, (down,), supports=supports), 1)

    assert solution.outcome == "converged"
    np.testing.assert_allclose(solution.reaction("rod", 0.0)[:3], [0.0, 5.0, 0.0], atol=1e-6)


def bed_scene(length, load, line=None):
    """A bar kept from sliding and rolling, on springs of the modulus that makes 1 / beta twenty heights."""
    decay = 0.05 / SIDE
    modulus = 4.0 * YOUNG * MOMENT_OF_AREA * decay**4 / SIDE
    line = line or Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0))
    keep = Support("rod", 0.5 * length, ("x", "s", "turn s", "turn y"), "mean")
    bed = Bed(RodFace("rod", "bottom"), 0.0, length, modulus)
    return one_rod(line, SQUARE, (load,), CORK, (keep,), beds=(bed,)), decay, modulus


@pytest.mark.slow
def test_a_long_bar_on_a_bed_sinks_as_hetenyi_says_and_the_bed_carries_the_load():
    """M. Hetenyi, Beams on Elastic Foundation, 1946, article 18."""
    length, force = 1000.0, 100.0
    scene, decay, modulus = bed_scene(length, SectionForce("rod", 500.0, (0.0, -force, 0.0)))

    solution = solve(scene)

    turned = decay * length
    share = (math.cosh(turned) + math.cos(turned) + 2.0) / (math.sinh(turned) + math.sin(turned))
    expected = force * decay / (2.0 * modulus * SIDE) * share
    # shear counts by (beta h)^2 = 2.5e-3
    assert solution.displacement("rod", np.array([500.0]))[1, 0] == pytest.approx(-expected, rel=3e-3)
    springs = solution.bed_forces(0, np.array([0.0, 333.3, 1000.0]))
    np.testing.assert_allclose(springs.force.sum(axis=1), [0.0, force, 0.0], atol=1e-7 * force)
    np.testing.assert_allclose(
        np.cross(springs.position - [[500.0], [0.0], [0.0]], springs.force, axis=0).sum(axis=1), 0.0, atol=1e-4 * force
    )


def test_a_bed_pushes_as_far_as_a_rigid_bar_sinks():
    scene, _, modulus = bed_scene(50.0, Pressure(RodFace("rod", "top"), 0.0, 50.0, 0.3))

    solution = solve(scene, 1)

    # pressure over the modulus; bottom 0.3 MPa / E * h above that, without contraction
    np.testing.assert_allclose(
        solution.displacement("rod", np.array([0.0, 20.0]))[1], -0.3 / modulus - 0.3 * 5.0 / YOUNG, rtol=1e-7
    )


def test_a_mesh_that_would_not_fit_into_memory_is_refused_with_the_numbers(monkeypatch):
    monkeypatch.setattr(solid_solver, "physical_memory", lambda: 1e6)

    with pytest.raises(SceneError, match=r"rods\.rod: found \d+ unknowns that take 0 GB where there are 0; .*memory"):
        solve(one_rod(RING, SQUARE, ()), 1)


def test_hollow_sections_answer_with_their_mean_displacement():
    supports = (Clamp("rod", "start", (0.1, 0.2, 0.3)),)

    solution = solve(one_rod(ALONG_X, Ring(10.0, 8.0), (), supports=supports), 1)

    assert isinstance(solution, SolidSolution)
    np.testing.assert_allclose(solution.displacement("rod", np.array([70.0]))[:, 0], [0.1, 0.2, 0.3], rtol=1e-9)


@pytest.mark.parametrize("section", [Ring(10.0, 8.0), Box(10.0, 12.0, 2.0)], ids=lambda s: type(s).__name__)
def test_the_deflection_of_a_hollow_section_is_the_mean_on_which_an_even_force_works(section):
    load = SectionForce("rod", 60.0, (0.0, -100.0, 0.0))

    solution = solve(one_rod(ALONG_X, section, (load,)), 1)

    deflection = solution.displacement("rod", np.array([60.0]))[1, 0]
    assert deflection == pytest.approx(-2.0 * solution.strain_energy / 100.0, rel=1e-8)


def test_there_are_reactions_where_something_holds_alone():
    solution = solve(one_rod(RING, SQUARE, ()), 1)

    with pytest.raises(ValueError, match="station: found 30; nothing holds rod 'rod' there"):
        solution.reaction("rod", 30.0)
