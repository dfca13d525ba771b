"""Mirror planes found in the scene, and what leaving out fields by them must not change."""

from dataclasses import replace

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import Clamp, Helix, Line, LineLoad, Material, Rectangle, Rod, Scene, SectionForce, SectionMoment
from rodmodel.assembly import ElementStore, assembled_rod, compliance, functionals
from rodmodel.borders import natural_mesh
from rodmodel.contact import unilateral_contact
from rodmodel.loads import load_parts
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import contact_system


@pytest.fixture
def scene() -> Scene:
    return load_case("two-cantilevers-e20-g05").scene


def test_the_papers_bars_bend_in_their_common_plane(scene: Scene) -> None:
    assert scene_mirrors(scene) == {"lower": (True, False), "upper": (True, False)}


def test_a_turned_frame_has_its_own_mirror_axis(scene: Scene) -> None:
    """The same plane is x = 0 for one rod and y = 0 for a rod whose `up` points across."""
    lower = replace(scene.rods[0], centre_line=Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 0.0, 1.0)))
    pair = replace(scene.contacts[0], first=replace(scene.contacts[0].first, face="right"))
    turned = replace(scene, rods=(lower, scene.rods[1]), contacts=(pair,))
    assert scene_mirrors(turned) == {"lower": (False, True), "upper": (True, False)}


def test_a_load_across_the_plane_breaks_the_symmetry(scene: Scene) -> None:
    skew = replace(scene, loads=(SectionForce("upper", 166.67, (0.0, -1000.0, 1.0)),))
    assert scene_mirrors(skew)["upper"] == (False, False)


def test_a_rod_beside_the_plane_breaks_the_symmetry(scene: Scene) -> None:
    upper = replace(scene.rods[1], centre_line=Line((200.0, 15.5, 1.0), (500.0, 15.5, 1.0), (0.0, 1.0, 0.0)))
    shifted = replace(scene, rods=(scene.rods[0], upper))
    assert scene_mirrors(shifted)["lower"] == (False, False)


def test_a_bar_pulled_along_its_axis_has_two_planes(scene: Scene) -> None:
    pulled = replace(scene, rods=scene.rods[:1], supports=scene.supports[:1], contacts=(), loads=())
    assert scene_mirrors(pulled)["lower"] == (True, True)


def test_the_symmetric_solution_is_the_full_one_to_round_off(scene: Scene) -> None:
    meshes = {rod.name: natural_mesh(scene, rod, 3, 4) for rod in scene.rods}
    forces = []
    for mirrors in (scene_mirrors(scene), {rod.name: (False, False) for rod in scene.rods}):
        system = contact_system(scene, mirrors, meshes, ElementStore())
        force = unilateral_contact(system.problem).force
        grid = system.grids["overlap"]
        forces.append(force.reshape(grid.weight.shape).sum(axis=2))
    np.testing.assert_allclose(forces[0], forces[1], atol=1e-8 * forces[0].sum())  # condition 1e7 of the rods


TWISTED = Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0), twist=1.0)
ARC = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 1.0, (0.0, 0.0, 1.0))


@pytest.mark.parametrize(
    ("line", "load", "mirrors"),
    [
        (ARC, SectionForce("rod", 100.0, (1.0, 2.0, 0.0)), (False, True)),
        (ARC, SectionForce("rod", 100.0, (0.0, 0.0, 1.0)), (False, False)),
        (ARC, SectionMoment("rod", 100.0, (0.0, 0.0, 1.0)), (False, True)),
        (ARC, SectionMoment("rod", 100.0, (1.0, 0.0, 0.0)), (False, False)),
        (replace(ARC, pitch=5.0), SectionForce("rod", 50.0, (1.0, 2.0, 0.0)), (False, False)),
        (
            Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0), 1.0),
            LineLoad("rod", 0.0, 50.0, (0.0, 1.0, 0.0)),
            (False, False),
        ),
    ],
)
def test_planes_of_curved_rods_are_those_that_keep_line_and_load(line, load, mirrors) -> None:
    """In the plane of an arc lie forces, across it moments; a helix or a twisted line lies in no plane."""
    rod = Rod("rod", line, Rectangle(5.0, 5.0), Material(1.0, 0.3), (0.0, line.length))
    scene = Scene("curved", (rod,), (Clamp("rod", "start"),), (load,), ())
    assert scene_mirrors(scene)["rod"] == mirrors


def test_halving_a_curved_rod_by_its_plane_changes_nothing() -> None:
    rod = Rod("rod", ARC, Rectangle(15.0, 10.0), Material(2e5, 0.3), (0.0, 20.0, ARC.length))
    loads = (SectionForce("rod", ARC.length, (100.0, 200.0, 0.0)), SectionMoment("rod", ARC.length, (0.0, 0.0, 500.0)))
    scene = Scene("arc", (rod,), (Clamp("rod", "start"),), loads, ())
    found = []
    for mirrors in (scene_mirrors(scene)["rod"], (False, False)):
        assembled = assembled_rod(scene, rod, mirrors, natural_mesh(scene, rod, 4, 5), ElementStore())
        found.append(compliance(functionals(assembled, load_parts(assembled, loads, 0), 1))[0, 0])
    assert found[0] == pytest.approx(found[1], rel=1e-10)
