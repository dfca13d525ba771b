"""Scenes that cannot be what their author meant are refused; the others are taken as they are."""

import math
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Bed,
    Box,
    Circle,
    Clamp,
    ContactPair,
    GapTable,
    Gravity,
    Ground,
    Helix,
    Joint,
    Line,
    LineLoad,
    Material,
    Orthotropic,
    Polygon,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    RoundGap,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
    given_gap,
)

STEEL = Material(200000.0, 0.3)
SQUARE = Rectangle(15.0, 15.0)


def rod(name, start, end, up=(0.0, 1.0, 0.0), section=SQUARE):
    line = Line(start, end, up)
    return Rod(name, line, section, STEEL, (0.0, line.length))


LOWER = rod("lower", (0.0, 0.0, 0.0), (300.0, 0.0, 0.0))
UPPER = rod("upper", (200.0, 15.5, 0.0), (500.0, 15.5, 0.0))
OVERLAP = ContactPair("overlap", RodFace("lower", "top"), RodFace("upper", "bottom"), (200.0, 300.0), 0.5, 1e6)


def scene(rods=(LOWER, UPPER), supports=(), loads=(), contacts=(OVERLAP,), joints=(), beds=()):
    return Scene("test", rods, supports, loads, contacts, joints, beds)


def refusal(make, *arguments, **keywords):
    with pytest.raises(SceneError) as caught:
        make(*arguments, **keywords)
    return caught.value


def test_a_refusal_says_key_find_and_remedy():
    error = refusal(scene, contacts=(replace(OVERLAP, zone=(100.0, 300.0)),))

    assert error.key == "contacts.overlap.zone"
    assert error.found == "100 .. 300"
    assert str(error) == f"{error.key}: found {error.found}; {error.remedy}"


@pytest.mark.parametrize(
    ("upper", "second"),
    [
        pytest.param(UPPER, "bottom", id="as drawn"),
        pytest.param(rod("upper", (500.0, 15.5, 0.0), (200.0, 15.5, 0.0)), "bottom", id="drawn backwards"),
        pytest.param(
            rod("upper", (200.0, 15.5, 0.0), (500.0, 15.5, 0.0), up=(0.0, -1.0, 0.0)), "top", id="upside down"
        ),
        pytest.param(
            rod("upper", (200.0, 15.5, 0.0), (500.0, 15.5, 0.0), up=(0.0, 0.0, 1.0)), "left", id="on its side"
        ),
        pytest.param(rod("upper", (200.0, 15.5, 0.0), (500.0, 45.5, 0.0)), "bottom", id="inclined"),
        pytest.param(rod("upper", (200.0, 15.5, 14.9), (500.0, 15.5, 14.9)), "bottom", id="just overlapping"),
        pytest.param(rod("upper", (200.0, 20.0, 0.0), (500.0, 20.0, 0.0)), "bottom", id="drawn at another distance"),
    ],
)
def test_faces_that_face_each_other_are_taken(upper, second):
    pair = replace(OVERLAP, second=RodFace("upper", second))

    assert scene(rods=(LOWER, upper), contacts=(pair,)).contact("overlap") is pair


@pytest.mark.parametrize(
    ("first", "upper", "second", "key"),
    [
        pytest.param("top", UPPER, "top", "second.face", id="same way"),
        pytest.param("top", UPPER, "left", "second.face", id="at a right angle"),
        pytest.param("bottom", UPPER, "top", "first.face", id="back to back"),
        pytest.param(
            "top", rod("upper", (200.0, 15.5, 15.0), (500.0, 15.5, 15.0)), "bottom", "second.rod", id="side by side"
        ),
        pytest.param(
            "top", rod("upper", (200.0, 15.5, 0.0), (500.0, 515.5, 0.0)), "bottom", "second.face", id="too steep"
        ),
        pytest.param("top", rod("upper", (201.0, 15.5, 0.0), (500.0, 15.5, 0.0)), "bottom", "zone", id="too late"),
        pytest.param("top", rod("upper", (100.0, 15.5, 0.0), (299.0, 15.5, 0.0)), "bottom", "zone", id="too short"),
        pytest.param("top", rod("upper", (400.0, 15.5, 0.0), (700.0, 15.5, 0.0)), "bottom", "zone", id="nowhere"),
        pytest.param(
            "top",
            rod("upper", (250.0, 15.5, -99.0), (250.0, 15.5, 99.0)),
            "left",
            "second.face",
            id="across, but with its side",
        ),
    ],
)
def test_faces_that_cannot_touch_over_the_zone_are_refused(first, upper, second, key):
    pair = replace(OVERLAP, first=RodFace("lower", first), second=RodFace("upper", second))

    error = refusal(scene, rods=(LOWER, upper), contacts=(pair,))

    assert error.key == f"contacts.overlap.{key}"


@pytest.mark.parametrize("end", [(250.0, 15.5, 99.0), (350.0, 15.5, 99.0)], ids=["at a right angle", "askew"])
def test_rods_may_cross(end):
    crossing = rod("upper", (250.0, 15.5, -99.0), end)

    assert scene(rods=(LOWER, crossing)).contacts == (OVERLAP,)


@pytest.mark.parametrize("modulus", [None, 50.0], ids=["rigid", "bed"])
def test_a_face_may_lie_on_ground(modulus):
    resting = ContactPair("rest", RodFace("lower", "bottom"), Ground(modulus), (0.0, 300.0), 0.0)

    assert scene(contacts=(resting,)).contact("rest").faces == (resting.first,)


@pytest.mark.parametrize("gap", [-0.2, 3.0, GapTable((200.0, 260.0), (0.0, -0.1)), RoundGap(-500.0, 250.0), "drawn"])
def test_gaps_may_be_negative_vary_and_be_as_drawn(gap):
    assert scene(contacts=(replace(OVERLAP, gap=gap),)).contact("overlap").gap == gap


@pytest.mark.parametrize(
    ("gap", "expected"),
    [
        (-0.2, [-0.2, -0.2, -0.2]),
        (GapTable((10.0, 20.0), (1.0, 3.0)), [1.0, 2.0, 3.0]),
        # 5 - sqrt(25 - x^2) at x = -4, 1, and beyond the radius
        (RoundGap(5.0, 14.0, 0.5), [2.5, 5.5 - 24.0**0.5, 5.5]),
        (RoundGap(-5.0, 14.0, 0.5), [-1.5, 24.0**0.5 - 4.5, -4.5]),
    ],
)
def test_a_gap_is_told_at_any_station(gap, expected):
    np.testing.assert_allclose(given_gap(gap, np.array([10.0, 15.0, 20.0])), expected, rtol=1e-14)


def test_half_the_width_counts_along_the_faces_not_across_them():
    flat = Rectangle(width=40.0, height=5.0)
    lower = rod("lower", (0.0, 0.0, 0.0), (300.0, 0.0, 0.0), section=flat)
    beside = rod("upper", (200.0, 5.0, 39.0), (500.0, 5.0, 39.0), section=flat)
    beyond = rod("upper", (200.0, 5.0, 41.0), (500.0, 5.0, 41.0), section=flat)

    assert scene(rods=(lower, beside)).rods == (lower, beside)
    assert refusal(scene, rods=(lower, beyond)).key == "contacts.overlap.second.rod"


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"zone": (300.0, 200.0)}, "zone"),
        ({"zone": (200.0, 300.1)}, "zone"),
        ({"zone": (-1.0, 300.0)}, "zone"),
        ({"zone": (float("nan"), 300.0)}, "zone"),
        ({"gap": float("inf")}, "gap"),
        ({"gap": "as drawn"}, "gap"),
        ({"gap": "drawn", "second": Ground()}, "gap"),
        ({"gap": GapTable((200.0, 300.0), (0.0,))}, "gap"),
        ({"gap": GapTable((200.0,), (0.0,))}, "gap"),
        ({"gap": GapTable((300.0, 200.0), (0.0, 0.0))}, "gap.stations"),
        ({"gap": GapTable((200.0, 300.0), (0.0, math.nan))}, "gap.stations"),
        ({"gap": RoundGap(0.0, 250.0)}, "gap.radius"),
        ({"gap": RoundGap(49.0, 250.0)}, "gap.radius"),  # does not reach over the zone
        ({"gap": RoundGap(500.0, math.inf)}, "gap"),
        ({"gap": -15.0}, "gap"),  # as deep as the bars are thick
        ({"gap": GapTable((150.0, 250.0, 350.0), (0.0, -16.0, 0.0))}, "gap"),
        ({"gap": RoundGap(500.0, 250.0, -16.0)}, "gap"),
        ({"second": Ground(0.0)}, "second.modulus"),
        ({"second": Ground(), "zone": (200.0, 300.1)}, "zone"),
        ({"second": Ground(), "first": RodFace("lower", "under")}, "first.face"),
        ({"penalty": 0.0}, "penalty"),
        ({"first": RodFace("nobody", "top")}, "first.rod"),
        ({"second": RodFace("lower", "bottom")}, "second.rod"),
        ({"second": RodFace("upper", "under")}, "second.face"),
    ],
)
def test_contact_pairs_that_make_no_sense_are_refused(change, key):
    error = refusal(scene, contacts=(replace(OVERLAP, **change),))

    assert error.key == f"contacts.overlap.{key}"


@pytest.mark.parametrize(
    ("parts", "key"),
    [
        ({"rods": (), "contacts": ()}, "rods"),
        ({"rods": (LOWER, UPPER, UPPER)}, "rods"),
        ({"contacts": (OVERLAP, OVERLAP)}, "contacts"),
        ({"supports": (Clamp("nobody", "start"),)}, "supports #1.rod"),
        ({"supports": (Clamp("lower", "middle"),)}, "supports #1.end"),
        ({"supports": (Clamp("lower", "start"), Clamp("lower", "start"))}, "supports #2"),
        ({"loads": (SectionForce("nobody", 0.0, (0.0, 1.0, 0.0)),)}, "loads #1.rod"),
        ({"loads": (SectionForce("upper", 300.1, (0.0, 1.0, 0.0)),)}, "loads #1.position"),
        ({"loads": (SectionForce("upper", -0.1, (0.0, 1.0, 0.0)),)}, "loads #1.position"),
        ({"loads": (SectionForce("upper", 0.0, (0.0, float("nan"), 0.0)),)}, "loads #1.force"),
        ({"loads": (SectionMoment("upper", 300.1, (0.0, 1.0, 0.0)),)}, "loads #1.position"),
        ({"loads": (SectionMoment("upper", 0.0, (0.0, float("nan"), 0.0)),)}, "loads #1.moment"),
        ({"loads": (LineLoad("upper", 200.0, 100.0, (0.0, 1.0, 0.0)),)}, "loads #1.start"),
        ({"loads": (LineLoad("upper", 200.0, 300.1, (0.0, 1.0, 0.0)),)}, "loads #1.start"),
        ({"loads": (LineLoad("upper", 0.0, 1.0, (0.0, float("nan"), 0.0)),)}, "loads #1.force"),
        ({"loads": (Pressure(RodFace("nobody", "top"), 0.0, 1.0, 1.0),)}, "loads #1.face.rod"),
        ({"loads": (Pressure(RodFace("upper", "under"), 0.0, 1.0, 1.0),)}, "loads #1.face.face"),
        ({"loads": (Pressure(RodFace("upper", "top"), 0.0, 300.1, 1.0),)}, "loads #1.start"),
        ({"loads": (Pressure(RodFace("upper", "top"), 0.0, 300.0, float("inf")),)}, "loads #1.pressure"),
        ({"loads": (Gravity("nobody", (0.0, -9810.0, 0.0)),)}, "loads #1.rod"),
        ({"supports": (Clamp("lower", "start", (0.0, float("nan"), 0.0)),)}, "supports #1.displacement"),
        ({"supports": (Clamp("lower", "start", rotation=(0.0, 0.0)),)}, "supports #1.rotation"),
        ({"supports": (Clamp("lower", "start", rotation=(0.0, 0.0, 5.0)),)}, "supports #1.rotation"),
        ({"supports": (Support("nobody", 0.0, ("x",)),)}, "supports #1.rod"),
        ({"beds": (Bed(RodFace("nobody", "top"), 0.0, 1.0, 1.0),)}, "beds #1.face.rod"),
        ({"beds": (Bed(RodFace("upper", "under"), 0.0, 1.0, 1.0),)}, "beds #1.face.face"),
        ({"beds": (Bed(RodFace("upper", "top"), 200.0, 100.0, 1.0),)}, "beds #1.start"),
        ({"beds": (Bed(RodFace("upper", "top"), 0.0, 300.0, 0.0),)}, "beds #1.modulus"),
    ],
)
def test_names_and_positions_that_do_not_exist_are_refused(parts, key):
    assert refusal(scene, **parts).key == key


@pytest.mark.parametrize(
    ("borders", "remedy"),
    [
        ((0.0,), "two ends"),
        ((0.0, 200.0, 100.0, 300.0), "increase"),
        ((0.0, 100.0, 100.0, 300.0), "increase"),
        ((0.0, float("nan"), 300.0), "increase"),
        ((1.0, 300.0), "from 0 to 300"),
        ((0.0, 299.0), "from 0 to 300"),
    ],
)
def test_element_borders_run_along_the_whole_rod(borders, remedy):
    error = refusal(replace, LOWER, element_borders=borders)

    assert error.key == "rods.lower.element_borders"
    assert remedy in error.remedy


ORIGIN, RADIAL, AXIS = (0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 0.0, 1.0)
SHARP = ((0.0, 0.0), (9.0, 0.0), (0.0, 9.0))


def small(x, y):
    """A square hole of 1 mm."""
    return ((x, y), (x + 1.0, y), (x + 1.0, y + 1.0), (x, y + 1.0))


@pytest.mark.parametrize(
    ("make", "arguments", "key"),
    [
        (Material, (0.0, 0.3), "young_modulus"),
        (Material, (1.0, 0.5), "poisson_ratio"),
        (Material, (1.0, -1.0), "poisson_ratio"),
        (Material, (1.0, 0.3, 0.0), "density"),
        (Material, (1.0, 0.3, 7850.0), "density"),  # kg/m^3
        (Material, (1.0, 0.3, 7.85e-6), "density"),  # kg/mm^3
        (Orthotropic, ((1.0, 1.0, 0.0), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)), "young_moduli"),
        (Orthotropic, ((1.0, 1.0, 1.0), (1.0, 1.0), (0.0, 0.0, 0.0)), "shear_moduli"),
        (Orthotropic, ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (1.0, 0.0, 0.0)), "poisson_ratios"),
        (Orthotropic, ((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (0.0, 0.0, 0.0), -1.0), "density"),
        (Rectangle, (-1.0, 1.0), "width"),
        (Rectangle, (1.0, float("inf")), "height"),
        (Line, ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)), "end"),
        (Line, ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), "up"),
        (Line, ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "up"),
        (Line, ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), float("nan")), "twist"),
        (Circle, (0.0,), "diameter"),
        (Ring, (10.0, 0.0), "inner_diameter"),
        (Ring, (10.0, 10.0), "outer_diameter"),
        (Box, (10.0, 20.0, 5.0), "wall"),
        (Polygon, (SHARP[:2],), "outer"),
        (Polygon, ((*SHARP, SHARP[0]),), "outer"),
        (Polygon, (((0.0, 0.0), (1.0, 0.0), (2.0, 0.0)),), "outer"),
        (Polygon, (((0.0, 0.0), (9.0, 9.0), (9.0, 0.0), (0.0, 9.0)),), "outer"),
        (Polygon, (SHARP, (small(1.0, 1.0), small(8.0, 8.0))), "holes #2"),
        (Polygon, (SHARP, (small(1.0, 1.0), small(1.2, 1.2))), "holes #2"),
        (Polygon, (SHARP, (small(0.0, 1.0),)), "holes #1"),
        (Helix, (RADIAL, ORIGIN, (0.0, 0.0, 0.0), 1.0, AXIS), "axis"),
        (Helix, (ORIGIN, (0.0, 0.0, 3.0), AXIS, 1.0, AXIS), "start"),
        (Helix, (RADIAL, ORIGIN, AXIS, 0.0, AXIS), "angle"),
        (Helix, (RADIAL, ORIGIN, AXIS, 1.0, (0.0, 2.0, 0.0)), "up"),
        (Helix, (RADIAL, ORIGIN, AXIS, 1.0, AXIS, float("inf")), "pitch"),
        (Line, ((0.0, float("nan"), 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), "start"),
    ],
)
def test_materials_sections_and_lines_that_cannot_be_are_refused(make, arguments, key):
    assert refusal(make, *arguments).key == key


def test_a_full_turn_of_a_helix_is_as_long_as_its_development():
    helix = Helix(RADIAL, ORIGIN, AXIS, 2.0 * math.pi, AXIS, pitch=-30.0)

    assert helix.radius == 100.0
    assert helix.length == pytest.approx(math.hypot(2.0 * math.pi * 100.0, 30.0))
    assert helix.start_tangent == pytest.approx(np.array([0.0, 200.0 * math.pi, -30.0]) / helix.length)


def test_a_polygon_s_centroid_leaves_out_its_holes():
    square = ((0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0))
    clockwise = ((2.0, 1.0), (2.0, 3.0), (3.0, 3.0), (3.0, 1.0))

    # area 16 at x = 2 less area 2 at x = 2.5
    assert Polygon(square, (clockwise,)).centroid == pytest.approx(((32.0 - 5.0) / 14.0, 2.0))


@pytest.mark.parametrize(
    ("section", "up", "fits"),
    [
        pytest.param(Rectangle(19.0, 60.0), AXIS, True, id="flat across the curve"),
        pytest.param(Rectangle(21.0, 1.0), AXIS, False, id="wide across the curve"),
        pytest.param(Rectangle(19.0, 60.0), RADIAL, False, id="upright in the curve"),
        pytest.param(Circle(19.9), AXIS, True, id="thick bar"),
        pytest.param(Ring(20.1, 1.0), AXIS, False, id="thick tube"),
        # x looks inwards (e1 = e2 x t); the centroid lies 6 mm from the back and 12 mm from the edge
        pytest.param(Polygon(((0.0, 0.0), (18.0, 9.0), (18.0, -9.0))), AXIS, True, id="back inwards"),
        pytest.param(Polygon(((0.0, 0.0), (-18.0, 9.0), (-18.0, -9.0))), AXIS, False, id="edge inwards"),
    ],
)
def test_sections_fit_into_their_radius_of_curvature(section, up, fits):
    arc = Helix((10.0, 0.0, 0.0), ORIGIN, AXIS, 1.0, up)

    if fits:
        assert Rod("bow", arc, section, STEEL, (0.0, 10.0)).length == 10.0
    else:
        assert refusal(Rod, "bow", arc, section, STEEL, (0.0, 10.0)).key == "rods.bow.centre_line"


def test_a_spline_may_be_straight():
    straight = Spline(((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (300.0, 0.0, 0.0)), (0.0, 1.0, 0.0))

    assert Rod("ruler", straight, SQUARE, STEEL, (0.0, 300.0)).length == pytest.approx(300.0)


def test_a_rounded_last_border_is_set_to_the_length():
    arc = Helix(RADIAL, ORIGIN, AXIS, math.pi / 2.0, AXIS)

    assert Rod("bow", arc, SQUARE, STEEL, (0.0, 50.0, 157.08)).element_borders == (0.0, 50.0, arc.length)
    error = refusal(Rod, "bow", arc, SQUARE, STEEL, (0.0, 157.0799, 157.08))
    assert error.key == "rods.bow.element_borders"


@pytest.mark.parametrize(
    ("support", "key"),
    [
        (Support("lower", 300.1, ("x",)), "position"),
        (Support("lower", -1.0, ("x",)), "position"),
        (Support("lower", float("nan"), ("x",)), "position"),
        (Support("lower", 100.0, ()), "components"),
        (Support("lower", 100.0, ("z",)), "components"),
        (Support("lower", 100.0, ("x", "y", "x")), "components"),
        (Support("lower", 100.0, ("x", "turn s")), "components"),
        (Support("lower", 100.0, ("x",), "centre"), "of"),
        (Support("lower", 100.0, ("x", "y"), displacement=(1.0,)), "displacement"),
        (Support("lower", 100.0, ("x",), displacement=(1.0, 0.0)), "displacement"),
        (Support("lower", 100.0, ("x",), displacement=(float("nan"),)), "displacement"),
        (Support("lower", 100.0, ("x", "turn y"), "mean", (0.0, 5.0)), "displacement"),
    ],
)
def test_supports_that_make_no_sense_are_refused(support, key):
    assert refusal(scene, supports=(support,)).key == f"supports #1.{key}"


def test_whole_sections_do_not_turn_but_their_mean_does():
    turned = Support("lower", 100.0, ("x", "turn s"), "mean", (5.0, 0.1))

    assert scene(supports=(turned,)).supports == (turned,)
    assert "of = 'mean'" in refusal(scene, supports=(replace(turned, of="section"),)).remedy


ARCH = Helix(RADIAL, ORIGIN, AXIS, math.pi / 2.0, AXIS)
BOW = Rod("bow", ARCH, SQUARE, STEEL, (0.0, ARCH.length))


def test_a_support_at_the_rounded_end_of_a_rod_is_at_its_end():
    mean = Support("bow", 157.08, ("x",), "mean")

    assert scene(rods=(BOW,), contacts=(), supports=(mean,)).supports[0].position == ARCH.length
    error = refusal(scene, rods=(BOW,), contacts=(), supports=(Clamp("bow", "end"), mean))
    assert error.key == "supports #2"


@pytest.mark.parametrize("written", [100.0, 100.0 + 1e-9])
def test_a_section_is_supported_once(written):
    supports = (Support("lower", 100.0, ("x",)), Support("lower", written, ("y",), "mean"))

    assert refusal(scene, supports=supports).key == "supports #2"


def test_different_sections_of_a_rod_may_be_supported():
    supports = (Clamp("lower", "start"), Support("lower", 150.0, ("y",), "mean"), Support("lower", 300.0, ("s",)))

    assert scene(supports=supports).supports == supports


BRACE = rod("brace", (300.0, 0.0, 0.0), (400.0, 100.0, 0.0))
CORNER = Joint((RodEnd("lower", "end"), RodEnd("brace", "start")))


def frame(joints=(CORNER,), supports=(), loads=()):
    return scene(rods=(LOWER, BRACE, UPPER), contacts=(), joints=joints, supports=supports, loads=loads)


def test_ends_at_one_point_are_joined():
    assert frame(supports=(Clamp("lower", "start"), Clamp("brace", "end"))).joints == (CORNER,)


@pytest.mark.parametrize(
    ("ends", "key"),
    [
        pytest.param((), "", id="nothing"),
        pytest.param((RodEnd("lower", "end"),), "", id="one end"),
        pytest.param((RodEnd("lower", "end"), RodEnd("nobody", "start")), " #2.rod", id="unknown rod"),
        pytest.param((RodEnd("lower", "middle"), RodEnd("brace", "start")), " #1.end", id="unknown end"),
        pytest.param((RodEnd("lower", "end"), RodEnd("brace", "end")), " #2", id="not at one point"),
        pytest.param((RodEnd("lower", "end"), RodEnd("lower", "end")), " #2", id="an end with itself"),
    ],
)
def test_joints_that_make_no_sense_are_refused(ends, key):
    assert refusal(frame, joints=(Joint(ends),)).key == f"joints #1.ends{key}"


def test_an_end_is_joined_once():
    assert refusal(frame, joints=(CORNER, CORNER)).key == "joints #2.ends #1"


@pytest.mark.parametrize(
    "support",
    [
        Clamp("brace", "start"),
        Support("brace", 0.0, ("y",), "mean"),
        Support("brace", 1e-9, ("y",), "mean"),
        Support("lower", 300.0, ("y",)),
        Support("lower", 299.99, ("y",)),  # the end, rounded
    ],
)
def test_an_end_is_joined_or_supported(support):
    error = refusal(frame, supports=(support,))

    assert error.key.startswith("joints #1.ends #")
    assert "which has a support" in error.found


def test_a_rod_may_close_onto_itself():
    full = Helix(RADIAL, ORIGIN, AXIS, 2.0 * math.pi, AXIS)
    hoop = Rod("hoop", full, SQUARE, STEEL, (0.0, full.length))
    closed = Joint((RodEnd("hoop", "start"), RodEnd("hoop", "end")))

    assert scene(rods=(hoop,), contacts=(), joints=(closed,)).joints == (closed,)


@pytest.mark.parametrize(
    "section", [Circle(10.0), Ring(10.0, 8.0), Polygon(SHARP)], ids=lambda section: type(section).__name__
)
def test_beds_and_pressures_need_a_flat_face(section):
    face = RodFace("lower", "bottom")
    flat = {"rods": (LOWER,), "contacts": ()}
    bent = {"rods": (replace(LOWER, section=section),), "contacts": ()}
    bed, pressure = Bed(face, 0.0, 300.0, 0.05), Pressure(face, 0.0, 300.0, 0.2)

    assert (scene(**flat, beds=(bed,)).beds, scene(**flat, loads=(pressure,)).loads) == ((bed,), (pressure,))
    assert refusal(scene, **bent, beds=(bed,)).key == "beds #1.face.rod"
    assert refusal(scene, **bent, loads=(pressure,)).key == "loads #1.face.rod"


def test_weight_needs_a_density():
    heavy = replace(LOWER, material=replace(STEEL, density=7.85e-9))
    weight = Gravity("lower", (0.0, -9810.0, 0.0))

    assert scene(rods=(heavy,), contacts=(), loads=(weight,)).loads == (weight,)
    error = refusal(scene, rods=(LOWER,), contacts=(), loads=(weight,))
    assert (error.key, error.found) == ("loads #1.rod", "'lower', whose material has no density")
    assert refusal(scene, rods=(heavy,), contacts=(), loads=(replace(weight, acceleration=(0.0, math.inf, 0.0)),))


def test_a_place_at_the_rounded_end_of_an_inclined_rod_is_set_to_it():
    force = SectionForce("brace", 141.42, (0.0, 1.0, 0.0))

    assert frame(loads=(force,)).loads[0].position == math.hypot(100.0, 100.0)


@pytest.mark.parametrize("written", [157.08, 157.0796])
def test_loads_at_the_rounded_end_of_a_curved_rod_are_set_to_it(written):
    arc = Helix(RADIAL, ORIGIN, AXIS, math.pi / 2.0, AXIS)
    bow = Rod("bow", arc, SQUARE, STEEL, (0.0, arc.length))
    up = (0.0, 0.0, 1.0)
    loads = (SectionForce("bow", written, up), SectionMoment("bow", written, up), LineLoad("bow", 50.0, written, up))

    force, moment, line = scene(rods=(bow,), loads=loads, contacts=()).loads

    assert force.position == moment.position == line.end == arc.length
    error = refusal(scene, rods=(bow,), loads=(replace(force, position=157.2),), contacts=())
    assert error.key == "loads #1.position"


@pytest.mark.parametrize("section", [Circle(15.0), Ring(15.0, 10.0), Polygon(SHARP)], ids=["bar", "tube", "polygon"])
def test_contact_is_between_faces_that_are_flat_across(section):
    error = refusal(scene, rods=(LOWER, replace(UPPER, section=section)))

    assert error.key == "contacts.overlap.second.rod"
    assert "flat faces" in error.remedy


@pytest.mark.parametrize(
    "other",
    [
        pytest.param({"centre_line": replace(UPPER.centre_line, twist=0.1)}, id="twisted"),
        pytest.param(
            {
                "centre_line": Helix((200.0, 15.5, 0.0), (200.0, 200.0, 0.0), AXIS, 1.0, (0.0, 1.0, 0.0)),
                "element_borders": (0.0, 184.5),
            },
            id="curved",
        ),
    ],
)
def test_faces_of_twisted_and_curved_rods_may_touch(other):
    assert scene(rods=(LOWER, replace(UPPER, **other))).contacts == (OVERLAP,)


def test_boxes_may_touch_like_rectangles():
    assert scene(rods=(LOWER, replace(UPPER, section=Box(15.0, 15.0, 2.0)))).contacts == (OVERLAP,)


def test_an_unknown_name_is_a_key_error():
    with pytest.raises(KeyError):
        scene().rod("nobody")
    with pytest.raises(KeyError):
        scene().contact("nothing")


@pytest.mark.parametrize(
    ("section", "fits"),
    [
        (Rectangle(1e-3, 1e-3), True),
        (Rectangle(1e-9, 1e-9), False),
        (Circle(5e-324), False),
    ],
)
def test_a_section_of_next_to_nothing_is_refused(section, fits):
    def rod():
        line = Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0))
        return Rod("wire", line, section, Material(200e3, 0.3), (0.0, 100.0))

    if fits:
        assert rod().length == 100.0
    else:
        with pytest.raises(SceneError, match=r"rods.wire.section: found one .* a millionth of its rod's length"):
            rod()
