"""What the 3D reference refuses up front, and line loads as the one kind of distributed force that it takes."""

import math
from dataclasses import replace

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
    Orthotropic,
    Polygon,
    Pressure,
    Ring,
    RodEnd,
    RodFace,
    SceneError,
    SectionForce,
    SectionMoment,
    Support,
)
from reference3d.solver import solve

ARC = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
TRIANGLE = Polygon(((0.0, 0.0), (9.0, 0.0), (0.0, 9.0)))


def changed(scene, **changes):
    """The scene with its one rod changed."""
    rod = replace(scene.rods[0], **changes)
    return replace(scene, rods=(replace(rod, element_borders=(0.0, rod.centre_line.length)),), loads=())


@pytest.mark.parametrize(
    ("changes", "key", "found"),
    [
        ({"section": Circle(15.0)}, "rods.rod.section", "a circle"),
        ({"section": Ring(15.0, 10.0)}, "rods.rod.section", "a ring"),
        ({"section": Box(15.0, 15.0, 2.0)}, "rods.rod.section", "a box"),
        ({"section": TRIANGLE}, "rods.rod.section", "a polygon"),
        ({"centre_line": ARC, "element_borders": (0.0, ARC.length)}, "rods.rod.centre_line", "an arc"),
        (
            {"centre_line": replace(ARC, pitch=3.0), "element_borders": (0.0, replace(ARC, pitch=3.0).length)},
            "rods.rod.centre_line",
            "a helix",
        ),
        (
            {"centre_line": Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.1)},
            "rods.rod.centre_line",
            "a twisted line",
        ),
    ],
)
def test_what_is_not_meshed_yet_is_refused_with_the_way_out(cantilever, changes, key, found):
    scene = changed(cantilever((0.0, -100.0, 0.0)), **changes)

    with pytest.raises(SceneError) as caught:
        solve(scene)

    assert (caught.value.key, caught.value.found) == (key, found)
    assert "does not mesh" in caught.value.remedy
    assert "use --model rod" in caught.value.remedy


def test_an_orthotropic_rod_is_refused(cantilever):
    wood = Orthotropic((900.0, 500.0, 12000.0), (700.0, 800.0, 60.0), (0.4, 0.03, 0.02))

    with pytest.raises(SceneError, match=r"rods\.rod\.material: found an orthotropic material; .* use --model rod"):
        solve(changed(cantilever((0.0, -100.0, 0.0)), material=wood))


@pytest.mark.parametrize(
    ("load", "found"),
    [
        (SectionMoment("rod", 300.0, (0.0, 0.0, 10.0)), "a section moment"),
        (Pressure(RodFace("rod", "top"), 0.0, 300.0, 0.1), "a pressure"),
        (Gravity("rod", (0.0, -9810.0, 0.0)), "gravity"),
    ],
)
def test_other_loads_than_forces_are_refused_and_not_left_out(cantilever, load, found):
    scene = cantilever((0.0, -100.0, 0.0))
    rod = replace(scene.rods[0], material=replace(scene.rods[0].material, density=7.85e-9))
    scene = replace(scene, rods=(rod,), loads=(*scene.loads, load))

    with pytest.raises(SceneError) as caught:
        solve(scene)

    assert (caught.value.key, caught.value.found) == ("loads #2.kind", found)
    assert "use --model rod" in caught.value.remedy


@pytest.mark.parametrize(
    ("support", "key"),
    [
        (Support("rod", 300.0, ("y",)), "supports #2.kind"),
        (Clamp("rod", "end", displacement=(0.0, 0.5, 0.0)), "supports #2.displacement"),
        (Clamp("rod", "end", rotation=(0.0, 0.0, 0.01)), "supports #2.rotation"),
    ],
)
def test_other_supports_than_clamps_at_rest_are_refused(cantilever, support, key):
    scene = cantilever((0.0, -100.0, 0.0))

    with pytest.raises(SceneError, match=r"use --model rod") as caught:
        solve(replace(scene, supports=(*scene.supports, support)))

    assert caught.value.key == key


def test_joints_are_refused(cantilever):
    scene = cantilever((0.0, -100.0, 0.0))
    beyond = Line((300.0, 0.0, 0.0), (600.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    other = replace(scene.rods[0], name="other", centre_line=beyond)
    joint = Joint((RodEnd("rod", "end"), RodEnd("other", "start")))

    with pytest.raises(SceneError, match=r"joints: found 1; the 3D reference does not join rods yet; use --model rod"):
        solve(replace(scene, rods=(scene.rods[0], other), joints=(joint,)))


def test_beds_are_refused(cantilever):
    scene = cantilever((0.0, -100.0, 0.0))
    bed = Bed(RodFace("rod", "bottom"), 0.0, 300.0, 1.0)

    with pytest.raises(SceneError, match=r"beds: found 1; the 3D reference does not lay .* use --model rod"):
        solve(replace(scene, beds=(bed,)))


def test_there_are_reactions_at_the_ends_alone(cantilever):
    solution = solve(cantilever((0.0, -100.0, 0.0), length=60.0), 1)

    assert not solution.reaction("rod", 60.0).any()
    with pytest.raises(ValueError, match="station: found 30; clamps are at 0 and at 60 mm"):
        solution.reaction("rod", 30.0)


def test_a_line_load_leaves_the_moment_of_its_resultant(cantilever):
    scene = cantilever((0.0, -100.0, 0.0), poisson_ratio=0.0)
    scene = replace(scene, loads=(LineLoad("rod", 120.0, 240.0, (2.0, -1.0, 0.0)),))

    solution = solve(scene, 1)

    # 120 mm under 1 N/mm down and 2 N/mm along, about X = 0; equilibrium holds to round-off of nodal forces of 1e4 N
    np.testing.assert_allclose(solution.reaction("rod", 0.0), [-240, 120, 0, 0, 0, 120 * 180], atol=1e-5)
    # without lateral contraction the axial force is statically determined in every section
    np.testing.assert_allclose(
        solution.section_resultants("rod", np.array([60.0, 180.0, 270.0]))[0], [240.0, 120.0, 0.0], atol=1e-6 * 240
    )


def test_a_line_load_bends_a_cantilever_as_beam_theory_with_shear_says(cantilever):
    scene = cantilever((0.0, -100.0, 0.0), poisson_ratio=0.0)
    scene = replace(scene, loads=(LineLoad("rod", 0.0, 300.0, (0.0, -1.0, 0.0)),))

    tip = solve(scene).displacement("rod", np.array([300.0]))[1, 0]

    # q L^4 / (8 E I) + q L^2 / (2 kappa G A); nu = 0: kappa = 5/6, G = E / 2; the clamp hinders the warping of shear,
    # a part of about h / L of the shear term, which is 1e-3 of the whole
    stiffness, area = 200000.0 * 15.0**4 / 12.0, 15.0**2
    expected = -(300.0**4) / (8.0 * stiffness) - 300.0**2 / (2.0 * 5.0 / 6.0 * 100000.0 * area)
    assert tip == pytest.approx(expected, rel=3e-4)


def test_a_line_load_is_symmetric_only_if_it_acts_in_the_plane(cantilever):
    scene = cantilever((0.0, -100.0, 0.0), length=60.0)
    aside = replace(scene, loads=(LineLoad("rod", 0.0, 60.0, (0.0, -1.0, 0.5)), SectionForce("rod", 60.0, (0, -9, 0))))

    solution = solve(aside, 1)

    np.testing.assert_allclose(solution.reaction("rod", 0.0)[:3], [0.0, 69.0, -30.0], atol=1e-6)


def test_the_frame_of_a_straight_rod_is_the_same_everywhere(cantilever):
    solution = solve(cantilever((0.0, -100.0, 0.0)), 1)

    position, axes = solution.frame("rod", np.array([0.0, 120.0, 300.0]))

    np.testing.assert_allclose(position, [[0.0, 120.0, 300.0], [0.0] * 3, [0.0] * 3])
    # rows e1, e2, t: e1 = e2 x t = Y x X = -Z
    np.testing.assert_allclose(axes, [[[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]] * 3)
