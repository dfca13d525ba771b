"""What is for boxes and what is not, and line loads as the one distributed force that boxes take."""

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
    Material,
    Orthotropic,
    Polygon,
    Pressure,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    SceneError,
    SectionForce,
    SectionMoment,
    Support,
)
from reference3d.scope import require_treatable
from reference3d.solver import solve

STRAIGHT = Line((0.0, 0.0, 90.0), (60.0, 0.0, 90.0), (0.0, 1.0, 0.0))
ARC = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
TRIANGLE = Polygon(((0.0, 0.0), (9.0, 0.0), (0.0, 9.0)))
STEEL = Material(200000.0, 0.3, 7.85e-9)
WOOD = Orthotropic((900.0, 500.0, 12000.0), (700.0, 800.0, 60.0), (0.4, 0.03, 0.02))


def with_third_rod(scene, **changes):
    """A scene with contact and a third rod aside, clamped at its start."""
    fields = {"name": "third", "centre_line": STRAIGHT, "section": Circle(5.0), "material": STEEL, **changes}
    rod = Rod(**fields, element_borders=(0.0, fields["centre_line"].length))
    return replace(scene, rods=(*scene.rods, rod), supports=(*scene.supports, Clamp("third", "start")))


@pytest.mark.parametrize(
    ("changes", "key", "found"),
    [
        ({"section": Circle(15.0)}, "section", "a circle"),
        ({"section": Ring(15.0, 10.0)}, "section", "a ring"),
        ({"section": Box(15.0, 15.0, 2.0)}, "section", "a box"),
        ({"section": TRIANGLE}, "section", "a polygon"),
        ({"centre_line": ARC}, "centre_line", "an arc"),
        ({"centre_line": replace(ARC, pitch=3.0)}, "centre_line", "a helix"),
        ({"centre_line": replace(STRAIGHT, twist=0.1)}, "centre_line", "a twisted line"),
    ],
)
def test_what_is_not_meshed_as_boxes_is_named(two_cantilevers, changes, key, found):
    with pytest.raises(SceneError) as caught:
        require_treatable(with_third_rod(two_cantilevers(50000.0, 0.0), **changes))

    assert (caught.value.key, caught.value.found) == (f"rods.third.{key}", found)
    assert "does not mesh" in caught.value.remedy
    assert "as boxes" in caught.value.remedy


def test_an_orthotropic_rod_is_not_for_boxes(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0)
    scene = replace(scene, rods=(scene.rods[0], replace(scene.rods[1], material=WOOD)))

    with pytest.raises(SceneError, match=r"rods\.upper\.material: found an orthotropic material; .* as boxes"):
        require_treatable(scene)


@pytest.mark.parametrize(
    ("load", "found"),
    [
        (SectionMoment("lower", 300.0, (0.0, 0.0, 10.0)), "a section moment"),
        (Pressure(RodFace("lower", "top"), 0.0, 100.0, 0.1), "a pressure"),
        (Gravity("lower", (0.0, -9810.0, 0.0)), "gravity"),
    ],
)
def test_other_loads_than_forces_are_not_for_boxes(two_cantilevers, load, found):
    scene = two_cantilevers(50000.0, 0.0)
    rods = (replace(scene.rods[0], material=STEEL), scene.rods[1])

    with pytest.raises(SceneError) as caught:
        require_treatable(replace(scene, rods=rods, loads=(*scene.loads, load)))

    assert (caught.value.key, caught.value.found) == ("loads #2.kind", found)


@pytest.mark.parametrize(
    ("support", "key"),
    [
        (Support("lower", 300.0, ("y",)), "supports #3.kind"),
        (Clamp("lower", "end", displacement=(0.0, 0.5, 0.0)), "supports #3.displacement"),
        (Clamp("lower", "end", rotation=(0.0, 0.0, 0.01)), "supports #3.rotation"),
    ],
)
def test_other_supports_than_clamps_at_rest_are_not_for_boxes(two_cantilevers, support, key):
    scene = two_cantilevers(50000.0, 0.0)

    with pytest.raises(SceneError, match=r"as boxes") as caught:
        require_treatable(replace(scene, supports=(*scene.supports, support)))

    assert caught.value.key == key


def test_joints_are_not_for_boxes(two_cantilevers):
    beyond = Line((300.0, 0.0, 0.0), (300.0, 0.0, 60.0), (0.0, 1.0, 0.0))
    scene = with_third_rod(two_cantilevers(50000.0, 0.0), centre_line=beyond)
    joint = Joint((RodEnd("lower", "end"), RodEnd("third", "start")))

    with pytest.raises(SceneError, match=r"joints: found 1; the 3D reference does not join rods as boxes"):
        require_treatable(
            replace(
                scene,
                rods=(*scene.rods[:2], replace(scene.rods[2], section=scene.rods[0].section)),
                supports=scene.supports[:2],
                joints=(joint,),
            )
        )


def test_beds_are_not_for_boxes(two_cantilevers):
    bed = Bed(RodFace("lower", "bottom"), 0.0, 300.0, 1.0)

    with pytest.raises(SceneError, match=r"beds: found 1; the 3D reference does not lay .* as boxes"):
        require_treatable(replace(two_cantilevers(50000.0, 0.0), beds=(bed,)))


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
