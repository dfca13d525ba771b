"""The case that uses everything a case file may say, and the scene that it means."""

import math
from pathlib import Path

import pytest

from cases import scene as parts
from cases.loader import load_case
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
    RodEnd,
    RodFace,
    RoundGap,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
)

QUARTER, DEGREE = math.pi / 2.0, math.pi / 180.0

STEEL = Material(200000.0, 0.3, 7.85e-9)
SPRUCE = Orthotropic((800.0, 500.0, 11000.0), (600.0, 700.0, 40.0), (0.4, 0.03, 0.02), 4.5e-10)
SQUARE = Rectangle(20.0, 20.0)
WIRE = Circle(4.0)

# name: (material, section, centre line)
RODS = {
    "post": (SPRUCE, SQUARE, Line((0.0, 0.0, 0.0), (0.0, 300.0, 0.0), (1.0, 0.0, 0.0))),
    "beam": (STEEL, Box(20.0, 30.0, 2.0), Line((0.0, 300.0, 0.0), (400.0, 300.0, 0.0), (0.0, 1.0, 0.0))),
    "brace": (SPRUCE, SQUARE, Line((0.0, 300.0, 0.0), (300.0, 600.0, 0.0), (0.0, 0.0, 1.0))),
    "strip": (Material(5.0, 0.45), SQUARE, Line((0.0, 326.0, 0.0), (400.0, 326.0, 0.0), (0.0, 1.0, 0.0))),
    "drill": (
        STEEL,
        Polygon(((0.0, 0.0), (9.0, 0.0), (0.0, 9.0)), (((1.0, 1.0), (2.0, 1.0), (1.0, 2.0)),)),
        Line((0.0, 0.0, 500.0), (60.0, 0.0, 500.0), (0.0, 1.0, 0.0), QUARTER),
    ),
    "hook": (
        STEEL,
        Ring(10.0, 8.0),
        parts.Path(
            (
                Line((0.0, 0.0, 900.0), (100.0, 0.0, 900.0), (0.0, 1.0, 0.0)),
                Helix((100.0, 0.0, 900.0), (100.0, 100.0, 900.0), (0.0, 0.0, 1.0), QUARTER, (0.0, 1.0, 0.0)),
            )
        ),
    ),
    "spring": (
        STEEL,
        WIRE,
        Helix((20.0, 0.0, 1500.0), (0.0, 0.0, 1500.0), (0.0, 0.0, 1.0), 12.0 * QUARTER, (0.0, 0.0, 1.0), -7.07),
    ),
    "snake": (
        STEEL,
        WIRE,
        Spline(
            (
                (0.0, 0.0, 2000.0),
                (50.0, 20.0, 2000.0),
                (100.0, 0.0, 2000.0),
                (150.0, 0.0, 2020.0),
                (200.0, 0.0, 2000.0),
            ),
            (0.0, 0.0, 1.0),
            "up",
        ),
    ),
}


@pytest.fixture(scope="module")
def case():
    return load_case(Path(__file__).with_name("everything.toml"))


@pytest.fixture(scope="module")
def scene(case):
    return case.scene


@pytest.mark.parametrize("name", RODS)
def test_rods_have_the_material_section_and_line_that_are_written(scene, name):
    rod = scene.rod(name)

    assert (rod.material, rod.section, rod.centre_line) == RODS[name]


def test_no_other_rods_are_made(scene):
    assert [rod.name for rod in scene.rods] == list(RODS)


def test_borders_and_places_at_a_rounded_end_are_set_to_it(scene):
    hook, brace = scene.rod("hook"), scene.rod("brace")

    assert hook.element_borders == (0.0, 100.0, hook.length)
    assert scene.supports[3].position == hook.length == pytest.approx(100.0 + 100.0 * QUARTER)
    assert scene.loads[2].position == brace.element_borders[-1] == math.hypot(300.0, 300.0)


def test_supports_hold_what_is_written_and_angles_are_in_rad(scene):
    assert scene.supports == (
        Clamp("post", "start"),
        Clamp("drill", "end", (0.0, -1.0, 0.0), (0.5 * DEGREE, 0.0, 0.0)),
        Support("strip", 0.0, ("y", "s")),
        Support("hook", scene.rod("hook").length, ("x",), displacement=(0.1,)),
        Support("beam", 400.0, ("y", "turn x"), "mean", (-0.5, DEGREE)),
        Support("strip", 200.0, ("x",), "mean"),
        Clamp("hook", "start"),
        Clamp("spring", "start"),
        Clamp("snake", "start"),
    )


def test_joints_and_beds_are_those_written(scene):
    assert scene.joints == (Joint((RodEnd("post", "end"), RodEnd("beam", "start"), RodEnd("brace", "start"))),)
    assert scene.beds == (Bed(RodFace("beam", "bottom"), 200.0, 300.0, 0.05),)


def test_loads_are_those_written_and_gravity_pulls_each_named_rod(scene):
    down = (0.0, -9810.0, 0.0)

    assert scene.loads == (
        Gravity("post", down),
        Gravity("beam", down),
        SectionForce("brace", scene.rod("brace").length, (0.0, -1000.0, 0.0)),
        SectionMoment("spring", scene.rod("spring").length, (0.0, 0.0, 1000.0)),
        LineLoad("snake", 0.0, 100.0, (0.0, 0.0, 0.002)),
        Pressure(RodFace("strip", "top"), 100.0, 300.0, 0.2),
    )


def test_contacts_are_those_written(scene):
    rest = ContactPair("rest", RodFace("beam", "top"), RodFace("strip", "bottom"), (0.0, 400.0), 1.0, 1000.0)

    assert scene.contacts == (rest,)


GROUNDS = {'{ ground = "rigid" }': Ground(), '{ ground = "bed", modulus = "50 N/mm^3" }': Ground(50.0)}
GAPS = {
    '"-0.1 mm"': -0.1,
    '"drawn"': "drawn",
    '{ stations = [0, "0.4 m"], gaps = ["0.5 mm", -1] }': GapTable((0.0, 400.0), (0.5, -1.0)),
    '{ radius = "50 cm", station = 50 }': RoundGap(500.0, 50.0, 0.0),
    '{ radius = "-50 m", station = 50, least = "1 mm" }': RoundGap(-50e3, 50.0, 1.0),
}


@pytest.fixture
def contact(tmp_path):
    """The contact pair of the case of everything with a change."""

    def load(old, new):
        text = Path(__file__).with_name("everything.toml").read_text(encoding="utf-8")
        assert old in text
        path = tmp_path / "contact.toml"
        path.write_text(text.replace(old, new), encoding="utf-8")
        return load_case(path).scene.contact("rest")

    return load


@pytest.mark.parametrize("written", GROUNDS)
def test_ground_is_that_written(contact, written):
    assert contact('{ rod = "strip", face = "bottom" }', written).second == GROUNDS[written]


@pytest.mark.parametrize("written", GAPS)
def test_gaps_are_those_written(contact, written):
    assert contact('gap = "1 mm"', f"gap = {written}").gap == GAPS[written]


def test_a_penalty_may_be_left_out(contact):
    assert contact('penalty = "1e3 N/mm^3"\n', "").penalty is None


def test_without_names_gravity_pulls_every_rod(tmp_path):
    text = Path(__file__).with_name("everything.toml").read_text(encoding="utf-8")
    text = text.replace('rods = ["post", "beam"]\n', "").replace('"5 MPa"', '"5 MPa"\ndensity = "1 g/cm^3"')
    path = tmp_path / "heavy.toml"
    path.write_text(text, encoding="utf-8")

    scene = load_case(path).scene

    assert [load.rod for load in scene.loads if isinstance(load, Gravity)] == list(RODS)


def test_levels_and_orders_of_some_rods_leave_the_others_as_usual(case):
    levels, orders = case.rod_model.level, case.rod_model.order

    assert levels["beam"] == (5, 4, 3)
    assert levels["spring"] == (6,) * 6  # one number stands for all elements
    assert levels["post"] == (3, 3)
    assert orders["beam"] == (6, 4, 4)
    assert orders["spring"] == (5,) * 6
    assert set(levels) == set(orders) == set(RODS)
