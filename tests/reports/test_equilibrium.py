"""Resultants from equilibrium and their residual, on the rod model's solutions of scenes that statics determines."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Bed,
    CentreLine,
    Clamp,
    Gravity,
    Helix,
    Joint,
    Line,
    LineLoad,
    Load,
    Material,
    Path,
    Pressure,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    SectionForce,
    Spline,
    Support,
)
from reports.applied_forces import applied_forces, reactions
from reports.equilibrium import equilibrium_residual
from reports.geometry import changes_of_turning
from reports.quantities import Quantities, default_stations, evaluate
from rodmodel import solve

STEEL = Material(200_000.0, 0.3, 7.85e-9)
LENGTH = 400.0
ARC = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
# What round-off leaves of the equations of a rod with some hundred unknowns. Curved and twisted rods at p = 8: an
# element that turns by 15 degrees follows the rigid motion, against which its forces balance, to 1e-13.
ROUND_OFF = 1e-9

HINGE = Support("rod", 0.0, ("x", "y", "s", "turn s"), of="mean")


def rod(line: CentreLine, name: str = "rod", elements: int = 4) -> Rod:
    return Rod(name, line, Rectangle(10.0, 20.0), STEEL, tuple(np.linspace(0.0, line.length, elements + 1)))


def beam(*loads: Load, supports: tuple[Clamp | Support, ...], beds: tuple[Bed, ...] = ()) -> Scene:
    """A rod of 400 mm along X with e2 = Y, 10 mm wide and 20 mm high."""
    line = Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0))
    return Scene("beam", (rod(line),), supports, loads, (), beds=beds)


def frame(*loads: Load) -> Scene:
    """A post of 300 mm, clamped on the ground, and a beam of 400 mm joined to its top."""
    post = rod(Line((0.0, 0.0, 0.0), (0.0, 300.0, 0.0), (0.0, 0.0, 1.0)), "post")
    top = rod(Line((0.0, 300.0, 0.0), (400.0, 300.0, 0.0), (0.0, 0.0, 1.0)), "beam")
    joint = Joint((RodEnd("post", "end"), RodEnd("beam", "start")))
    return Scene("frame", (post, top), (Clamp("post", "start"),), loads, (), joints=(joint,))


def solved(scene: Scene, order: int = 5) -> Quantities:
    return evaluate(solve(scene, 2, order))


def test_a_simply_supported_beam_carries_a_line_load() -> None:
    roller = Support("rod", LENGTH, ("y",), of="mean")

    found = solved(beam(LineLoad("rod", 0.0, LENGTH, (0.0, -2.0, 0.0)), supports=(HINGE, roller)))

    of_rod, s = found.rod("rod"), found.rod("rod").station
    # the bottom is in tension, which is M1 < 0; the shear from the part beyond s is what acts upwards there
    assert of_rod.moment == pytest.approx(-2.0 * s * (LENGTH - s) / 2.0, abs=ROUND_OFF * 4e4)
    assert of_rod.equilibrium[2] == pytest.approx(2.0 * (s - LENGTH / 2.0), abs=ROUND_OFF * 400.0)
    assert found.reactions["rod", 0.0] == pytest.approx([0, 400, 0, 0, 0, 0], abs=ROUND_OFF * 4e4)
    assert found.reactions["rod", LENGTH] == pytest.approx([0, 400, 0, 0, 0, 0], abs=ROUND_OFF * 4e4)
    assert found.equilibrium_residual < ROUND_OFF


def test_a_rod_without_clamps_has_no_clamp_moment() -> None:
    roller = Support("rod", LENGTH, ("y",), of="mean")

    found = solved(beam(LineLoad("rod", 0.0, LENGTH, (0.0, -2.0, 0.0)), supports=(HINGE, roller))).rod("rod")

    assert (found.end_moment_equilibrium, found.end_moment_stress, found.max_bending_stress) == (None, None, None)


def test_a_support_within_the_rod_counts_on_its_side() -> None:
    within = Support("rod", 300.0, ("y",), of="mean")

    found = solved(beam(LineLoad("rod", 0.0, LENGTH, (0.0, -2.0, 0.0)), supports=(HINGE, within)))

    moment, s = found.rod("rod").moment, found.rod("rod").station
    # reactions 2 N/mm * 400 mm * (200, 100) / 300
    at_start = 800.0 / 3.0
    expected = np.where(s < 300.0, s**2 - at_start * s, (LENGTH - s) ** 2)
    assert moment == pytest.approx(expected, abs=ROUND_OFF * 1e4)
    assert found.reactions["rod", 300.0][1] == pytest.approx(2.0 * at_start)


def test_a_pressure_bends_a_cantilever() -> None:
    found = solved(beam(Pressure(RodFace("rod", "top"), 100.0, 300.0, 0.3), supports=(Clamp("rod", "end"),)))

    moment, s = found.rod("rod").moment, found.rod("rod").station
    # 3 N/mm downwards from 100 to 300 mm, clamped at 400: the top is in tension
    loaded = np.clip(s - 100.0, 0.0, 200.0)
    assert moment == pytest.approx(3.0 * loaded * (np.maximum(s - 100.0, 0.0) - loaded / 2.0), abs=ROUND_OFF * 1e5)
    assert found.rod("rod").end_moment_equilibrium == pytest.approx(600.0 * 200.0)
    assert found.equilibrium_residual < ROUND_OFF


def test_gravity_bends_and_twists_a_curved_cantilever() -> None:
    scene = Scene("arc", (rod(ARC, elements=6),), (Clamp("rod", "start"),), (Gravity("rod", (0.0, 0.0, -9810.0)),), ())

    found = solved(scene, 8)

    of_rod = found.rod("rod")
    rest = (ARC.length - of_rod.station) / 100.0
    # the weight beyond s, at the radius R + I / (A R) of the centroids of the slices
    weight = 7.85e-9 * 9810.0 * 200.0 * 100.0
    centre = 100.0 + 10.0**2 / 12.0 / 100.0
    assert of_rod.equilibrium[2] == pytest.approx(-weight * rest, abs=ROUND_OFF * weight)
    assert of_rod.moment == pytest.approx(weight * centre * (1.0 - np.cos(rest)), abs=ROUND_OFF * weight * 100.0)
    torque = -weight * (100.0 * rest - centre * np.sin(rest))
    assert of_rod.equilibrium[5] == pytest.approx(torque, abs=ROUND_OFF * weight * 100.0)
    assert found.equilibrium_residual < ROUND_OFF


@pytest.mark.parametrize(
    "line",
    [
        ARC,
        replace(ARC, pitch=60.0),
        Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0), math.pi / 2.0),
        Path((ARC, Line((0.0, 100.0, 0.0), (-90.0, 100.0, 0.0), (0.0, 0.0, 1.0)))),
    ],
    ids=["arc", "helix", "twisted line", "path"],
)
def test_pressure_and_weight_balance_the_reaction_on_curved_and_twisted_rods(line: CentreLine) -> None:
    loads = (
        Pressure(RodFace("rod", "top"), 10.0, 90.0, 2.0),
        Pressure(RodFace("rod", "right"), 30.0, 0.9 * line.length, -1.0),
        Gravity("rod", (9810.0, -3000.0, 500.0)),
    )
    scene = Scene("curved", (rod(line, elements=6),), (Clamp("rod", "start"),), loads, ())

    assert solved(scene, 8).equilibrium_residual < ROUND_OFF


def test_pressure_and_weight_balance_the_reaction_on_a_spline() -> None:
    points = ((0.0, 0.0, 0.0), (80.0, 30.0, 0.0), (150.0, 0.0, 40.0), (250.0, 20.0, 60.0), (300.0, 80.0, 0.0))
    line = Spline(points, (0.0, 0.0, 1.0))
    loads = (Pressure(RodFace("rod", "top"), 10.0, 90.0, 2.0), Gravity("rod", (9810.0, -3000.0, 500.0)))
    scene = Scene("spline", (rod(line),), (Clamp("rod", "start"),), loads, ())
    # Elements that end where the turning is not smooth follow rigid motions; a quarter of a piece at p = 8 to 2e-10.
    inner = changes_of_turning(solve(scene, 1, 2), scene.rods[0])
    pieces = np.array([0.0, *inner, line.length])
    borders = np.interp(np.arange(4 * len(pieces) - 3) / 4.0, np.arange(len(pieces)), pieces)

    found = solved(replace(scene, rods=(replace(scene.rods[0], element_borders=tuple(borders)),)), 8)

    assert found.equilibrium_residual < ROUND_OFF


def test_a_propped_cantilever_shares_its_load() -> None:
    prop = Support("rod", LENGTH, ("y",), of="mean")

    found = solved(beam(LineLoad("rod", 0.0, LENGTH, (0.0, -2.0, 0.0)), supports=(Clamp("rod", "start"), prop)))

    # the beam without its prop sinks by what the prop lifts it; Timoshenko's beam, uncertain by 0.1 h / L, as the
    # clamp holds the section
    bending, shear = LENGTH**3 / 3.0 / (10.0 * 20.0**3 / 12.0), 2.6 * LENGTH * 6.0 / 5.0 / 200.0
    deflection = LENGTH**4 / 8.0 / (10.0 * 20.0**3 / 12.0) + 2.6 * LENGTH**2 / 2.0 * 6.0 / 5.0 / 200.0
    force = 2.0 * deflection / (bending + shear)
    assert found.reactions["rod", LENGTH][1] == pytest.approx(force, rel=0.1 * 20.0 / LENGTH)
    assert found.equilibrium_residual < ROUND_OFF


def test_supports_that_move_without_a_load_are_measured_by_their_reactions() -> None:
    moved = Clamp("rod", "end", (0.0, 0.5, 0.0))

    found = solved(beam(supports=(Clamp("rod", "start"), moved)))

    force = found.reactions["rod", LENGTH][1]
    # 12 E I delta / L^3 of a slender beam; shear makes it 1 % softer, and the clamps as much stiffer
    assert force == pytest.approx(12.0 * 200_000.0 * 10.0 * 20.0**3 / 12.0 * 0.5 / LENGTH**3, rel=0.02)
    of_rod = found.rod("rod")
    assert of_rod.moment == pytest.approx(force * (of_rod.station - LENGTH / 2.0), abs=ROUND_OFF * force * LENGTH)
    assert found.equilibrium_residual < ROUND_OFF


def test_a_frame_turns_the_corner() -> None:
    found = solved(frame(SectionForce("beam", 400.0, (0.0, -500.0, 70.0)), Gravity("post", (0.0, -9810.0, 0.0))))

    post, top = found.rod("post"), found.rod("beam")
    # post: e2 = Z, t = Y, e1 = e2 x t = -X; beam: e2 = Z, t = X, e1 = e2 x t = Y
    weight = 7.85e-9 * 9810.0 * 200.0 * (300.0 - post.station)
    assert post.equilibrium[0] == pytest.approx(-500.0 - weight)
    assert post.moment == pytest.approx(-70.0 * (300.0 - post.station), abs=ROUND_OFF * 2e5)
    assert post.equilibrium[4] == pytest.approx(np.full_like(post.station, -500.0 * 400.0))
    assert post.equilibrium[5] == pytest.approx(np.full_like(post.station, -70.0 * 400.0))
    assert top.equilibrium[4] == pytest.approx(-500.0 * (400.0 - top.station), abs=ROUND_OFF * 2e5)
    assert found.reactions["beam", 0.0] == pytest.approx([0, 500, -70, 0, 70.0 * 400, 500.0 * 400], abs=1e-4)
    assert found.equilibrium_residual < ROUND_OFF


def test_a_joint_that_keeps_a_force_to_itself_shows() -> None:
    solution = solve(frame(SectionForce("beam", 400.0, (0.0, -500.0, 0.0))), 2, 4)
    held = reactions(solution)
    applied = {each.name: applied_forces(solution, each, default_stations(each), held) for each in solution.scene.rods}

    wrong = {**held, ("beam", 0.0): held["beam", 0.0] + np.array([6.0, 0.0, 0.0, 0.0, 0.0, 0.0])}
    shown = equilibrium_residual(solution.scene, applied, wrong)

    # against the largest reaction, the moment of the clamp over the length of the post, 500 N * 400 / 300
    assert shown == pytest.approx(6.0 / (500.0 * 4.0 / 3.0))


def test_a_bed_carries_what_the_beam_does_not() -> None:
    still = Support("rod", 0.0, ("x", "s", "turn y", "turn s"), of="mean")
    scene = beam(
        SectionForce("rod", 200.0, (0.0, -500.0, 0.0)),
        supports=(still,),
        beds=(Bed(RodFace("rod", "bottom"), 0.0, LENGTH, 0.5),),
    )

    found = solved(scene)

    of_rod = found.rod("rod")
    # all of it, with no moment left at the free ends
    assert found.reactions["rod", 0.0] == pytest.approx(0.0, abs=ROUND_OFF * 500.0 * LENGTH)
    assert of_rod.equilibrium[[2, 3]][:, [0, -1]] == pytest.approx(0.0, abs=ROUND_OFF * 500.0 * LENGTH)
    # the pressures of modulus times displacement on 10 mm; the bottom moves a little less far than the centre line
    springs = -10.0 * 0.5 * np.trapezoid(of_rod.displacement[1], of_rod.station)
    assert springs == pytest.approx(500.0, rel=5e-3)
    assert found.equilibrium_residual < ROUND_OFF
