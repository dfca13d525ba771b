"""Mirror planes found in the scene, and what leaving out fields by them must not change."""

from dataclasses import replace

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import Line, Scene, SectionForce
from rodmodel.assembly import ElementStore
from rodmodel.borders import natural_borders
from rodmodel.contact import unilateral_contact
from rodmodel.section import Fields
from rodmodel.symmetry import symmetric_fields
from rodmodel.system import contact_system


@pytest.fixture
def scene() -> Scene:
    return load_case("two-cantilevers-e20-g05").scene


def test_the_papers_bars_bend_in_their_common_plane(scene: Scene) -> None:
    assert symmetric_fields(scene, 3) == {
        "lower": Fields(3, mirror_x=True),
        "upper": Fields(3, mirror_x=True),
    }


def test_a_turned_frame_has_its_own_mirror_axis(scene: Scene) -> None:
    """The same plane is x = 0 for one rod and y = 0 for a rod whose `up` points across."""
    lower = replace(scene.rods[0], centre_line=Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    pair = replace(scene.contacts[0], first=replace(scene.contacts[0].first, face="right"))
    turned = replace(scene, rods=(lower, scene.rods[1]), contacts=(pair,))
    assert symmetric_fields(turned, 3) == {
        "lower": Fields(3, mirror_y=True),
        "upper": Fields(3, mirror_x=True),
    }


def test_a_load_across_the_plane_breaks_the_symmetry(scene: Scene) -> None:
    skew = replace(scene, loads=(SectionForce("upper", 166.67, (0.0, -1000.0, 1.0)),))
    assert symmetric_fields(skew, 3)["upper"] == Fields(3)


def test_a_rod_beside_the_plane_breaks_the_symmetry(scene: Scene) -> None:
    upper = replace(scene.rods[1], centre_line=Line((200.0, 15.5, 1.0), (500.0, 15.5, 1.0), (0.0, 1.0, 0.0)))
    shifted = replace(scene, rods=(scene.rods[0], upper))
    assert symmetric_fields(shifted, 3)["lower"] == Fields(3)


def test_a_bar_pulled_along_its_axis_has_two_planes(scene: Scene) -> None:
    pulled = replace(scene, rods=scene.rods[:1], supports=scene.supports[:1], contacts=(), loads=())
    assert symmetric_fields(pulled, 3)["lower"] == Fields(3, mirror_x=True, mirror_y=True)


def test_the_symmetric_solution_is_the_full_one_to_round_off(scene: Scene) -> None:
    borders = {rod.name: natural_borders(scene, rod) for rod in scene.rods}
    forces = []
    for fields in (symmetric_fields(scene, 3), {rod.name: Fields(3) for rod in scene.rods}):
        system = contact_system(scene, fields, borders, ElementStore(4))
        force = unilateral_contact(system.compliance, system.initial_gap, system.spring)
        grid = system.grids["overlap"]
        forces.append(force.reshape(grid.weight.shape).sum(axis=2))
    np.testing.assert_allclose(forces[0], forces[1], atol=1e-8 * forces[0].sum())  # condition 1e7 of the rods
