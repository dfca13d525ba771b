"""The geometry of the 3D picture; a scene with everything in it is drawn once."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Bed,
    Clamp,
    Gravity,
    Joint,
    Line,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    Support,
)
from reports.picture import deformed_surface
from reports.quantities import evaluate
from reports.runner import CaseRun
from reports.view import drawn_shifts, magnification, round_below
from rodmodel import solve


@pytest.mark.parametrize(("value", "rounded"), [(1.0, 1.0), (1.99, 1.0), (2.0, 2.0), (37.0, 20.0), (500.0, 500.0)])
def test_scales_are_one_two_or_five_times_a_power_of_ten(value: float, rounded: float) -> None:
    assert round_below(value) == pytest.approx(rounded)


def test_the_largest_displacement_is_drawn_visibly_and_never_smaller_than_it_is(case_run: CaseRun) -> None:
    quantities = case_run.rod.quantities
    largest = max(np.linalg.norm(rod.displacement, axis=0).max() for rod in quantities.rods)

    factor = magnification(quantities)

    assert 0.03 * 500.0 <= factor * largest <= 0.08 * 505.0
    huge = tuple(replace(rod, displacement=1e4 * rod.displacement) for rod in quantities.rods)
    assert magnification(replace(quantities, rods=huge)) == 1.0


def test_a_section_moves_and_turns_with_the_centre_line(case_run: CaseRun) -> None:
    rod = case_run.case.scene.rod("lower")
    found = case_run.rod.quantities.rod("lower")
    slope = 1e-3
    tilted = replace(found, displacement=np.vstack([0.0 * found.station, slope * found.station, 0.0 * found.station]))

    corners = deformed_surface(rod, tilted, 2.0, np.zeros(3))

    # the centre of each section follows the centre line, its top leans back by the slope (factor 2 on both)
    assert corners.mean(axis=2) == pytest.approx(tilted.position + 2.0 * tilted.displacement)
    top = corners[:, :, corners[1, -1] > corners[1, -1].mean()].mean(axis=2)
    bottom = corners[:, :, corners[1, -1] < corners[1, -1].mean()].mean(axis=2)
    assert (top - bottom)[0] == pytest.approx(-2.0 * slope * 15.0)
    assert (top - bottom)[1] == pytest.approx(15.0)


def test_gaps_are_magnified_like_displacements(beam_scene: Scene, case_run: CaseRun) -> None:
    pair = replace(beam_scene.contacts[0], gap=0.5)
    scene = replace(beam_scene, contacts=(pair,))  # drawn touching, gap given as 0.5 mm

    shifts = drawn_shifts(scene, case_run.rod.quantities, factor=10.0)

    assert shifts["lower"] == pytest.approx([0.0, 0.0, 0.0])
    assert shifts["upper"] == pytest.approx([0.0, 5.0, 0.0])


def test_rods_stay_with_those_they_are_joined_to(beam_scene: Scene, case_run: CaseRun) -> None:
    post = replace(
        beam_scene.rod("upper"),
        name="post",
        centre_line=Line((200.0, 15.0, 0.0), (200.0, 215.0, 0.0), (1.0, 0.0, 0.0)),
        element_borders=(0.0, 200.0),
    )
    joint = Joint((RodEnd("post", "start"), RodEnd("upper", "start")))
    pair = replace(beam_scene.contacts[0], gap=0.5)
    scene = replace(beam_scene, rods=(*beam_scene.rods, post), contacts=(pair,), joints=(joint,))

    shifts = drawn_shifts(scene, case_run.rod.quantities, factor=10.0)

    assert shifts["lower"] == pytest.approx([0.0, 0.0, 0.0])
    assert shifts["post"] == pytest.approx(shifts["upper"])
    assert shifts["upper"] == pytest.approx([0.0, 5.0, 0.0])


@pytest.mark.slow
def test_all_that_holds_and_loads_rods_can_be_drawn(drawn: Callable[..., list[bytes]]) -> None:
    steel = Material(200_000.0, 0.3, 7.85e-9)
    beam = Rod("beam", Line((0, 0, 0), (400, 0, 0), (0, 1, 0)), Rectangle(10.0, 20.0), steel, (0.0, 400.0))
    post = Rod("post", Line((400, 0, 0), (400, -200, 0), (1, 0, 0)), Rectangle(10.0, 20.0), steel, (0.0, 200.0))
    scene = Scene(
        "all",
        (beam, post),
        (
            Support("beam", 0.0, ("x", "y", "turn s"), of="mean"),
            Support("beam", 200.0, ("s",), of="mean", displacement=(0.1,)),
            Clamp("post", "end", (0.0, 0.1, 0.0)),
        ),
        (Pressure(RodFace("beam", "top"), 0.0, 400.0, 0.1), Gravity("post", (0.0, -9810.0, 0.0))),
        (),
        joints=(Joint((RodEnd("beam", "end"), RodEnd("post", "start"))),),
        beds=(Bed(RodFace("beam", "bottom"), 50.0, 350.0, 0.1),),
    )

    (png,) = drawn((scene, evaluate(solve(scene, 1, 3))))

    assert png.startswith(b"\x89PNG")
