"""Which way loads and supports are drawn on straight and curved rods."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cases.scene import (
    Clamp,
    Gravity,
    Helix,
    Line,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SectionForce,
    Support,
    Vector,
)
from reports.quantities import RodQuantities, evaluate
from reports.view import ARROWS, face_normals, held_directions, load_arrows, view_plane
from rodmodel import solve

RADIUS = 100.0
ARC = Helix((RADIUS, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))


@pytest.fixture(scope="module")
def arc() -> RodQuantities:
    """A quarter ring about Z: e1 looks to the centre, e2 = Z; drawn by straight lines between 60 steps."""
    rod = Rod("arc", ARC, Rectangle(30.0, 20.0), Material(200_000.0, 0.3), (0.0, ARC.length))
    scene = Scene("arc", (rod,), (Clamp("arc", "start"),), (SectionForce("arc", 50.0, (1.0, 0.0, 0.0)),), ())
    return evaluate(solve(scene, 1, 2)).rods[0]


@pytest.mark.parametrize(
    ("start", "end", "up", "expected"),
    [
        ((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0), [[1, 0, 0], [0, 1, 0]]),
        ((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, -1.0, 0.0), [[1, 0, 0], [0, 1, 0]]),
        ((0.0, 0.0, 0.0), (0.0, 100.0, 0.0), (1.0, 0.0, 0.0), [[1, 0, 0], [0, 1, 0]]),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 100.0), (1.0, 0.0, 0.0), [[1, 0, 0], [0, 0, 1]]),
        ((0.0, 0.0, 0.0), (0.0, 0.0, 100.0), (0.0, 1.0, 0.0), [[0, 1, 0], [0, 0, 1]]),
    ],
)
def test_a_scene_is_seen_as_one_draws_global_axes(
    start: Vector, end: Vector, up: Vector, expected: list[list[float]]
) -> None:
    rod = Rod("rod", Line(start, end, up), Rectangle(5.0, 5.0), Material(200_000.0, 0.3), (0.0, 100.0))
    scene = Scene("rod", (rod,), (Clamp("rod", "start"),), (SectionForce("rod", 50.0, up),), ())

    assert view_plane(scene, evaluate(solve(scene, 1, 2))) == pytest.approx(np.array(expected, dtype=float))


def test_faces_look_away_from_the_centre_line(arc: RodQuantities) -> None:
    station = np.linspace(0.0, ARC.length, 5)
    angle = station / RADIUS

    outwards = np.array([np.cos(angle), np.sin(angle), 0.0 * angle])
    # chords of 1.5 degrees are 1e-4 of the radius off the arc
    assert face_normals(arc, "left", station) == pytest.approx(outwards, abs=1e-4)
    assert face_normals(arc, "right", station) == pytest.approx(-outwards, abs=1e-4)
    assert face_normals(arc, "bottom", station) == pytest.approx(np.tile([[0.0], [0.0], [-1.0]], 5))


@pytest.mark.parametrize(("pressure", "sign", "pulling"), [(2.0, -1.0, False), (-2.0, 1.0, True)])
def test_pressure_pushes_against_the_normal_and_suction_pulls_along_it(
    arc: RodQuantities, pressure: float, sign: float, pulling: bool
) -> None:
    arrows = load_arrows(Pressure(RodFace("arc", "left"), 10.0, 100.0, pressure), arc)

    assert arrows.station == pytest.approx(np.linspace(10.0, 100.0, ARROWS))
    assert arrows.direction == pytest.approx(sign * face_normals(arc, "left", arrows.station))
    assert arrows.pulling == pulling


def test_gravity_hangs_from_the_middle_of_the_rod(arc: RodQuantities) -> None:
    arrows = load_arrows(Gravity("arc", (0.0, -9810.0, 0.0)), arc)

    assert arrows.station == pytest.approx([ARC.length / 2.0])
    assert arrows.direction[:, 0] == pytest.approx([0.0, -1.0, 0.0])
    assert (arrows.pulling, arrows.text) == (True, "g")


def test_a_load_of_nothing_has_no_arrow(arc: RodQuantities) -> None:
    for load in (Gravity("arc", (0.0, 0.0, 0.0)), Pressure(RodFace("arc", "left"), 10.0, 100.0, 0.0)):
        arrows = load_arrows(load, arc)

        assert arrows.station.shape == (0,)
        assert arrows.place.shape == arrows.direction.shape == (3, 0)


def test_supports_hold_in_the_frame_of_their_section(arc: RodQuantities) -> None:
    moves, turns = held_directions(Support("arc", ARC.length, ("s", "x", "turn y"), of="mean"), arc)

    # at the end of the arc t = -X, e1 = -Y, e2 = Z
    assert moves == pytest.approx(np.array([[-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]]).T, abs=1e-12)
    assert turns == pytest.approx(np.array([[0.0, 0.0, 1.0]]).T, abs=1e-12)
