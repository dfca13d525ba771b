"""Pressure, gravity and beds summed up on arcs, helices and twisted lines, against closed forms."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace

import numpy as np
import pytest

from cases.scene import (
    FACES,
    Bed,
    Box,
    CentreLine,
    Clamp,
    Gravity,
    Helix,
    Joint,
    Line,
    Load,
    Material,
    Path,
    Polygon,
    Pressure,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    Section,
    SectionForce,
    Spline,
    Support,
)
from reports.applied_forces import AppliedForces, applied_forces, magnitude, reactions
from reports.solution import Array
from rodmodel.centre_line import centre_points, frames

RADIUS = 100.0
ARC = Helix((RADIUS, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
HELIX = replace(ARC, angle=3.0 * math.pi, pitch=50.0)
SPLINE = Spline(
    ((0.0, 0.0, 0.0), (80.0, 30.0, 0.0), (150.0, 0.0, 40.0), (250.0, 20.0, 60.0), (300.0, 80.0, 0.0)), (0.0, 0.0, 1.0)
)
BEND = Path((ARC, Line((0.0, RADIUS, 0.0), (-120.0, RADIUS, 0.0), (0.0, 0.0, 1.0))))
TWISTED = Line((5.0, 6.0, 7.0), (5.0, 6.0, 407.0), (1.0, 0.0, 0.0), 4.0)
STEEL = Material(200_000.0, 0.3, 7.85e-9)
# Twelve Gauss points follow these frames to round-off; sums of some hundred terms leave a few digits less.
ROUND_OFF = 1e-12


@dataclass(frozen=True)
class Springs:
    station: Array
    position: Array
    force: Array


@dataclass(frozen=True)
class Framed:
    """Frames in closed form (of splines and paths the rod model's) and given reactions; no more is asked for here."""

    scene: Scene
    held: dict[tuple[str, float], Array] = field(default_factory=dict)

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        line = self.scene.rod(rod).centre_line
        if isinstance(line, Spline | Path):
            return centre_points(line, station), frames(line, station)
        zero, one = np.zeros_like(station), np.ones_like(station)
        if isinstance(line, Line):
            angle = line.twist * station / line.length
            e2 = np.array([np.cos(angle), np.sin(angle), zero])
            e1 = np.array([np.sin(angle), -np.cos(angle), zero])
            points = np.array(line.start)[:, None] + np.array([zero, zero, station])
            return points, np.stack([e1, e2, np.array([zero, zero, one])]).transpose(2, 0, 1)
        angle = line.angle * station / line.length
        advance = line.pitch / (2.0 * math.pi)
        outwards = np.array([np.cos(angle), np.sin(angle), zero])
        tangent = np.array([-RADIUS * np.sin(angle), RADIUS * np.cos(angle), advance * one])
        tangent /= math.hypot(RADIUS, advance)
        e2 = np.cross(tangent, -outwards, axis=0)
        points = RADIUS * outwards + np.array([zero, zero, advance * angle])
        return points, np.stack([-outwards, e2, tangent]).transpose(2, 0, 1)

    def reaction(self, rod: str, station: float) -> Array:
        return self.held[rod, station]

    def bed_forces(self, bed: int, borders: Array) -> Springs:
        station = 0.5 * (borders[1:] + borders[:-1])
        position, _ = self.frame(self.scene.beds[bed].rod, station)
        return Springs(station, position, np.outer([0.0, 1.0, 0.0], np.diff(borders)))


def scene(line: CentreLine, *loads: Load, section: Section = Rectangle(30.0, 20.0)) -> Scene:  # noqa: B008
    rod = Rod("rod", line, section, STEEL, (0.0, line.length))
    return Scene("scene", (rod,), (Clamp("rod", "start"),), loads, ())


def acting(line: CentreLine, *loads: Load, section: Section = Rectangle(30.0, 20.0)) -> AppliedForces:  # noqa: B008
    """All loads on a rod cut at some stations."""
    station = np.linspace(0.0, line.length, 42)
    solution = Framed(scene(line, *loads, section=section))
    return applied_forces(solution, solution.scene.rods[0], station, {})


def sums(applied: AppliedForces) -> tuple[Array, Array]:
    """Force and moment about the origin."""
    moment = np.cross(applied.point, applied.force, axis=0) + applied.moment
    return applied.force.sum(axis=1), moment.sum(axis=1)


def test_pressure_inside_a_ring_pushes_outwards() -> None:
    # e1 looks to the centre, so the right face is the inner cylinder of radius 85 and height 20
    force, moment = sums(acting(ARC, Pressure(RodFace("rod", "right"), 0.0, ARC.length / 2.0, 2.0)))

    angle = math.pi / 4.0
    each = 2.0 * 20.0 * 85.0
    assert force == pytest.approx([each * math.sin(angle), each * (1.0 - math.cos(angle)), 0.0], abs=ROUND_OFF * each)
    # all of it points away from the origin, in its plane
    assert moment == pytest.approx(0.0, abs=ROUND_OFF * each * RADIUS)


def test_pressure_on_the_flat_of_a_ring_acts_on_its_sector() -> None:
    force, moment = sums(acting(ARC, Pressure(RodFace("rod", "top"), 0.0, ARC.length, 2.0)))

    area = math.pi / 4.0 * (115.0**2 - 85.0**2)
    assert force == pytest.approx([0.0, 0.0, -2.0 * area], rel=ROUND_OFF, abs=1e-9)
    # first moments of the sector about X and Y: (R_o^3 - R_i^3) / 3
    first = (115.0**3 - 85.0**3) / 3.0
    assert moment == pytest.approx([-2.0 * first, 2.0 * first, 0.0], rel=ROUND_OFF, abs=ROUND_OFF * first)


@pytest.mark.parametrize(
    "line", [ARC, HELIX, TWISTED, BEND, SPLINE], ids=["arc", "helix", "twisted line", "path", "spline"]
)
@pytest.mark.parametrize("section", [Rectangle(30.0, 20.0), Box(30.0, 20.0, 2.0)])
def test_pressure_all_around_a_rod_and_on_its_ends_is_in_equilibrium(line: CentreLine, section: Section) -> None:
    # a fluid at rest holds every body in it: force and moment of a constant pressure on a closed surface vanish
    pressure = 3.0
    applied = acting(
        line, *(Pressure(RodFace("rod", face), 0.0, line.length, pressure) for face in FACES), section=section
    )
    force, moment = sums(applied)
    points, axes = Framed(scene(line)).frame("rod", np.array([0.0, line.length]))
    ends = pressure * 600.0 * np.array([1.0, -1.0]) * axes[:, 2].T

    force += ends.sum(axis=1)
    moment += np.cross(points, ends, axis=0).sum(axis=1)

    size = pressure * 30.0 * line.length
    assert np.abs(force).max() < ROUND_OFF * size
    assert np.abs(moment).max() < ROUND_OFF * size * line.length


def test_the_weight_of_a_ring_acts_outside_its_centre_line() -> None:
    force, moment = sums(acting(ARC, Gravity("rod", (0.0, 0.0, -9810.0))))

    weight = 7.85e-9 * 9810.0 * 600.0 * ARC.length
    assert force == pytest.approx([0.0, 0.0, -weight], rel=ROUND_OFF)
    # rho times the first moments of the solid about X and Y: height (R_o^3 - R_i^3) / 3
    first = 7.85e-9 * 9810.0 * 20.0 * (115.0**3 - 85.0**3) / 3.0
    assert moment == pytest.approx([-first, first, 0.0], rel=ROUND_OFF, abs=ROUND_OFF * first)


def test_the_weight_of_a_ring_with_an_oblique_section_acts_out_of_its_plane() -> None:
    triangle = Polygon(((0.0, 0.0), (30.0, 0.0), (0.0, 20.0)))
    _, moment = sums(acting(ARC, Gravity("rod", (9810.0, 0.0, 0.0)), section=triangle))

    # int z dV = R-angle times int (R - x) y dA = -angle * int x y dA; b^2 h^2 / 72 = -int x y
    height = 7.85e-9 * 9810.0 * 0.5 * math.pi * 30.0**2 * 20.0**2 / 72.0
    assert moment[1] == pytest.approx(height, rel=ROUND_OFF)


def test_the_sizes_of_loads_are_forces() -> None:
    rod = scene(ARC).rods[0]

    assert magnitude(Pressure(RodFace("rod", "left"), 10.0, 40.0, -2.0), rod) == pytest.approx(2.0 * 20.0 * 30.0)
    weight = 7.85e-9 * 5.0 * 600.0 * ARC.length
    assert magnitude(Gravity("rod", (0.0, 3.0, -4.0)), rod) == pytest.approx(weight)


def test_beds_act_between_the_stations() -> None:
    line = replace(TWISTED, twist=0.0)
    plain = scene(line)
    solution = Framed(replace(plain, beds=(Bed(RodFace("rod", "left"), 50.0, 350.0, 1.0),)))

    found = applied_forces(solution, plain.rods[0], np.linspace(0.0, 400.0, 5), {})

    assert found.station == pytest.approx([75.0, 150.0, 250.0, 325.0])
    assert found.force[1] == pytest.approx([50.0, 100.0, 100.0, 50.0])
    assert not found.is_reaction.any()


def test_there_is_a_reaction_at_every_support_and_every_joined_end() -> None:
    first, second = Line((0, 0, 0), (0, 0, 100), (1, 0, 0)), Line((0, 0, 100), (0, 0, 250), (1, 0, 0))
    rods = tuple(
        Rod(name, line, Rectangle(3.0, 3.0), STEEL, (0.0, line.length))
        for name, line in (("lower", first), ("upper", second))
    )
    places = [("lower", 0.0), ("upper", 40.0), ("lower", 100.0), ("upper", 0.0)]
    held = {place: np.full(6, float(number)) for number, place in enumerate(places)}
    solution = Framed(
        Scene(
            "post",
            rods,
            (Clamp("lower", "start"), Support("upper", 40.0, ("y",))),
            (SectionForce("upper", 150.0, (1.0, 0.0, 0.0)),),
            (),
            joints=(Joint((RodEnd("lower", "end"), RodEnd("upper", "start"))),),
        ),
        held,
    )

    found = reactions(solution)

    assert list(found) == places
    upper = applied_forces(solution, rods[1], np.array([0.0, 150.0]), found)
    assert upper.station == pytest.approx([150.0, 40.0, 0.0])
    assert upper.is_reaction.tolist() == [False, True, True]
    assert upper.force[0] == pytest.approx([1.0, 1.0, 3.0])
