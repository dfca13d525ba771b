"""The geometry of the 3D picture, without drawing it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cases.scene import Scene
from reports.picture import deformed_surface, drawn_shifts, magnification, round_below
from reports.runner import CaseRun


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
