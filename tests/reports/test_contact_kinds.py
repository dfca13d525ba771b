"""Contact on ground, of crossing, curved and loose rods: what is told, summed up and drawn of every kind of pair."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Clamp,
    ContactPair,
    GapTable,
    Gravity,
    Ground,
    Helix,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    RoundGap,
    Scene,
    SectionForce,
)
from reports.formatting import gap, opposite
from reports.geometry import contact_limits, stations_of_points
from reports.pages.case import _sketch_caption
from reports.quantities import Quantities, evaluate
from reports.sketch import scene_sketch
from reports.view import SPRINGS, drawn_shifts
from rodmodel import solve

STEEL = Material(200_000.0, 0.3, 7.85e-9)
SQUARE = Rectangle(10.0, 10.0)
UP = (0.0, 1.0, 0.0)
DOWN = (0.0, -500.0, 0.0)
TOP, BOTTOM = RodFace("bar", "top"), RodFace("bar", "bottom")


def bar(name: str, start: tuple[float, float, float], end: tuple[float, float, float]) -> Rod:
    line = Line(start, end, UP)
    return Rod(name, line, SQUARE, STEEL, (0.0, 0.25 * line.length, 0.5 * line.length, line.length))


BAR = bar("bar", (0.0, 0.0, 0.0), (200.0, 0.0, 0.0))
# A quarter of a ring in the plane of X and Y that turns upwards from its lowest point above the bar.
ARC = Helix((150.0, 10.0, 0.0), (150.0, 160.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 1.0, 0.0))
BOW = Rod("other", ARC, SQUARE, STEEL, (0.0, 60.0, ARC.length))


def grounded(second: Ground, given: object, zone: tuple[float, float] = (20.0, 200.0)) -> Scene:
    pair = ContactPair("rest", BOTTOM, second, zone, given)  # type: ignore[arg-type]
    return Scene("grounded", (BAR,), (Clamp("bar", "start"),), (SectionForce("bar", 100.0, DOWN),), (pair,))


def paired(other: Rod, given: object, zone: tuple[float, float], at: float) -> Scene:
    """Another rod over the bar, clamped at its far end from the bar and pressed onto it."""
    pair = ContactPair("touch", TOP, RodFace("other", "bottom"), zone, given)  # type: ignore[arg-type]
    supports = (Clamp("bar", "start"), Clamp("other", "end"))
    return Scene("paired", (BAR, other), supports, (SectionForce("other", at, DOWN),), (pair,))


LOOSE = Scene(
    "loose",
    (BAR,),
    (),
    (Gravity("bar", (0.0, -9810.0, 0.0)), SectionForce("bar", 80.0, DOWN)),
    (ContactPair("rest", BOTTOM, Ground(), (0.0, 200.0), 0.0),),
)
SQUEEZED = Scene(  # no load at all: the bar is 0.1 mm too thick
    "squeezed",
    (BAR, bar("other", (0.0, 10.0, 0.0), (200.0, 10.0, 0.0))),
    (Clamp("bar", "start"), Clamp("other", "start")),
    (),
    (ContactPair("touch", TOP, RodFace("other", "bottom"), (100.0, 200.0), -0.1),),
)
SCENES = {
    "rigid ground": grounded(Ground(), 0.1),
    "bed": grounded(Ground(5.0), 0.0),
    "cylinder": grounded(Ground(), RoundGap(500.0, 120.0), (60.0, 180.0)),
    "table": grounded(Ground(), GapTable((0.0, 200.0), (0.4, -0.1))),
    "crossing": paired(bar("other", (150.0, 10.0, 80.0), (150.0, 10.0, -120.0)), 0.0, (100.0, 200.0), 10.0),
    "curved": paired(BOW, "drawn", (151.0, 199.0), 0.0),
    "loose": LOOSE,
    "interference": SQUEEZED,
}


@pytest.fixture(scope="module")
def found() -> dict[str, Quantities]:
    # polynomials along a curved rod follow its turning frame only to their order
    return {name: evaluate(solve(scene, 2, 10 if name == "curved" else 4)) for name, scene in SCENES.items()}


@pytest.mark.parametrize("name", SCENES)
def test_every_rod_is_in_equilibrium(found: dict[str, Quantities], name: str) -> None:
    assert found[name].outcome == "converged"
    assert found[name].contacts[0].force > 1.0
    assert found[name].equilibrium_residual < 1e-8


def test_a_loose_bar_presses_with_its_weight_and_load(found: dict[str, Quantities]) -> None:
    weight = 7.85e-9 * 100.0 * 200.0 * 9810.0

    assert found["loose"].contacts[0].resultant == pytest.approx([0.0, -(500.0 + weight), 0.0], rel=1e-9)


@pytest.mark.parametrize("name", [name for name in SCENES if name != "bed"])
def test_forces_act_only_where_faces_touch(found: dict[str, Quantities], name: str) -> None:
    contact = found[name].contacts[0]

    # what the multipliers leave: they stop when forces change by 1e-6 of their sum
    assert contact.complementarity_residual < 1e-3
    assert abs(contact.work) < 1e-3 * found[name].strain_energy


def test_a_bed_keeps_energy_and_is_pressed_in_on_purpose(found: dict[str, Quantities]) -> None:
    contact = found["bed"].contacts[0]

    assert contact.complementarity_residual == 0.0
    # half of all that the load does: Clapeyron
    load = -0.5 * 500.0 * np.interp(100.0, found["bed"].rods[0].station, found["bed"].rods[0].displacement[1])
    assert contact.work + found["bed"].strain_energy == pytest.approx(load, rel=2e-3)  # of the centre line


def test_a_given_overlap_of_faces_in_contact_is_no_distance(beam_solution) -> None:  # type: ignore[no-untyped-def]
    plain = beam_solution(force=400.0)

    contact = evaluate(plain).contacts[0]

    points = plain.contact_points("overlap")
    assert contact.work == pytest.approx(0.5 * float(points.force @ -points.gap))
    largest = np.abs(points.force * points.gap).max()
    moved = max(np.linalg.norm(rod.displacement, axis=0).max() for rod in evaluate(plain).rods)
    assert contact.complementarity_residual == pytest.approx(largest / (400.0 * moved))


@pytest.mark.parametrize(
    "line",
    [
        ARC,
        replace(ARC, angle=1.9 * math.pi, pitch=60.0),
        replace(ARC, centre=(150.0, 17.0, 0.0), angle=3.0),  # the sections reach far towards the centre
        Line((0.0, 0.0, 0.0), (100.0, 50.0, 20.0), UP, twist=1.0),
    ],
    ids=["arc", "helix", "tight arc", "twisted"],
)
def test_the_sections_that_hold_points_are_found(line: Helix | Line) -> None:
    rod = Rod("other", line, SQUARE, STEEL, (0.0, line.length))
    scene = Scene("line", (rod,), (Clamp("other", "start"),), (), ())
    solution = solve(scene, 1, 2)
    station = np.linspace(0.0, line.length, 7)
    position, axes = solution.frame("other", station)
    points = position + 5.0 * axes[:, 1].T - 3.0 * axes[:, 0].T

    assert stations_of_points(solution, "other", points) == pytest.approx(station, abs=1e-8 * line.length)


def test_limits_are_where_something_lies_opposite() -> None:
    pair = SCENES["crossing"].contacts[0]

    assert contact_limits(pair, np.linspace(145.0, 155.0, 5)) == (145.0, 155.0)
    assert contact_limits(pair, np.linspace(0.0, 155.0, 5)) == (100.0, 155.0)


def test_texts_say_what_lies_opposite_and_how_far() -> None:
    caption = _sketch_caption(SCENES["bed"].contacts)

    assert "bottom face of bar and a bed of 5 N/mm³ that cannot pull may touch" in caption
    assert caption.endswith("gap 0 mm.")
    assert opposite(Ground()) == "rigid ground"
    assert gap(GapTable((0.0, 1.0), (-0.1, 0.4))) == "-0.1 to 0.4 mm by a table"
    assert gap(RoundGap(-500.0, 50.0, 2.0)) == "round with a radius of 500 mm, largest (2 mm) at 50 mm"
    assert gap("drawn") == "as drawn"


@pytest.mark.parametrize("name", SCENES)
def test_every_kind_has_a_sketch(found: dict[str, Quantities], name: str) -> None:
    svg = str(scene_sketch(SCENES[name], found[name]))
    ground = isinstance(SCENES[name].contacts[0].second, Ground)

    # a wall for every clamp, and a line for ground
    walls = len(re.findall(r'class="wall"', svg))
    assert walls == len(SCENES[name].supports) + int(ground)
    assert "nan" not in svg
    if name == "bed":
        assert svg.count('<polyline class="hatch"') == SPRINGS
        assert "5 N/mm³" in svg


def test_rods_of_a_stack_are_moved_to_their_gaps_once(found: dict[str, Quantities]) -> None:
    names = ("bar", "middle", "other")
    rods = tuple(bar(name, (0.0, 10.0 * level, 0.0), (200.0, 10.0 * level, 0.0)) for level, name in enumerate(names))
    faces = [(names[0], names[1]), (names[1], names[2])]
    pairs = [
        ContactPair(first, RodFace(first, "top"), RodFace(second, "bottom"), (50.0, 200.0), 0.3)
        for first, second in faces
    ]
    again = replace(pairs[0], name="again", gap=0.5)
    scene = Scene("stack", rods, tuple(Clamp(name, "start") for name in names), (), (pairs[1], pairs[0], again))

    shifts = drawn_shifts(scene, evaluate(solve(scene, 1, 2)), factor=10.0)

    assert shifts["middle"][1] - shifts["bar"][1] == pytest.approx(3.0)
    assert shifts["other"][1] - shifts["middle"][1] == pytest.approx(3.0)


def test_a_gap_as_drawn_is_magnified_from_where_it_is_least(found: dict[str, Quantities]) -> None:
    scene = SCENES["curved"]
    higher = replace(ARC, start=(150.0, 11.0, 0.0), centre=(150.0, 161.0, 0.0))
    scene = replace(scene, rods=(BAR, replace(BOW, centre_line=higher)))

    shifts = drawn_shifts(scene, evaluate(solve(scene, 1, 2)), factor=10.0)

    # 1 mm at the lowest point; the centre line is seen at its stations
    assert shifts["other"] == pytest.approx([0.0, 9.0, 0.0], abs=0.3)


@pytest.mark.slow
def test_every_kind_has_a_picture(found: dict[str, Quantities], drawn: Callable[..., list[bytes]]) -> None:
    pictures = drawn(*((SCENES[name], found[name]) for name in SCENES))

    assert len(set(pictures)) == len(SCENES)
