"""Scenes that cannot be what their author meant are refused; the others are taken as they are."""

from dataclasses import replace

import pytest

from cases.scene import (
    Clamp,
    ContactPair,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
)

STEEL = Material(200000.0, 0.3)
SQUARE = Rectangle(15.0, 15.0)


def rod(name, start, end, up=(0.0, 1.0, 0.0), section=SQUARE):
    line = Line(start, end, up)
    return Rod(name, line, section, STEEL, (0.0, line.length))


LOWER = rod("lower", (0.0, 0.0, 0.0), (300.0, 0.0, 0.0))
UPPER = rod("upper", (200.0, 15.5, 0.0), (500.0, 15.5, 0.0))
OVERLAP = ContactPair("overlap", RodFace("lower", "top"), RodFace("upper", "bottom"), (200.0, 300.0), 0.5, 1e6)


def scene(rods=(LOWER, UPPER), supports=(), loads=(), contacts=(OVERLAP,)):
    return Scene("test", rods, supports, loads, contacts)


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
        pytest.param("top", rod("upper", (250.0, 15.5, -99.0), (250.0, 15.5, 99.0)), "bottom", "zone", id="across"),
    ],
)
def test_faces_that_cannot_touch_over_the_zone_are_refused(first, upper, second, key):
    pair = replace(OVERLAP, first=RodFace("lower", first), second=RodFace("upper", second))

    error = refusal(scene, rods=(LOWER, upper), contacts=(pair,))

    assert error.key == f"contacts.overlap.{key}"


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


@pytest.mark.parametrize(
    ("make", "arguments", "key"),
    [
        (Material, (0.0, 0.3), "young_modulus"),
        (Material, (1.0, 0.5), "poisson_ratio"),
        (Material, (1.0, -1.0), "poisson_ratio"),
        (Rectangle, (-1.0, 1.0), "width"),
        (Rectangle, (1.0, float("inf")), "height"),
        (Line, ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0)), "end"),
        (Line, ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), "up"),
        (Line, ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)), "up"),
        (Line, ((0.0, float("nan"), 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)), "start"),
    ],
)
def test_materials_sections_and_lines_that_cannot_be_are_refused(make, arguments, key):
    assert refusal(make, *arguments).key == key


def test_an_unknown_name_is_a_key_error():
    with pytest.raises(KeyError):
        scene().rod("nobody")
    with pytest.raises(KeyError):
        scene().contact("nothing")
