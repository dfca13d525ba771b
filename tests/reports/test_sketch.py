"""What holds and loads a scene is drawn in its sketch: each kind by its own sign, all of it inside the drawing."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Bed,
    Clamp,
    Gravity,
    Joint,
    Line,
    Load,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    Support,
)
from reports.quantities import evaluate
from reports.sketch import scene_sketch
from reports.sketch_symbols import LETTER
from reports.view import SPRINGS
from rodmodel import solve

STEEL = Material(200_000.0, 0.3, 7.85e-9)
CLAMP = Clamp("beam", "start")


def scene(*supports: Clamp | Support, loads: tuple[Load, ...] = (), beds: tuple[Bed, ...] = ()) -> Scene:
    """A beam along X, 400 mm long, seen from the side of e1: e2 = Y is upwards."""
    line = Line((0.0, 0.0, 0.0), (400.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    rod = Rod("beam", line, Rectangle(10.0, 20.0), STEEL, (0.0, 400.0))
    return Scene("beam", (rod,), supports, loads, (), beds=beds)


def sketch(drawn: Scene) -> str:
    return str(scene_sketch(drawn, evaluate(solve(drawn, 1, 2))))


def rings(svg: str) -> int:
    """Rollers of supports."""
    return len(re.findall(r'<circle class="hatch"', svg))


@pytest.mark.parametrize(
    ("support", "rollers", "triangles", "text"),
    [
        (Support("beam", 300.0, ("x", "y", "s")), 0, 1, "x, y, s"),
        (Support("beam", 300.0, ("y",), of="mean"), 2, 1, "mean y"),
        (Support("beam", 400.0, ("s",), displacement=(0.5,)), 2, 1, "s moved"),
        (Support("beam", 300.0, ("x",)), 0, 0, "x"),
    ],
    ids=["pin", "roller", "moved roller along the rod", "held along the view"],
)
def test_supports_of_components_stand_on_ground_or_rollers(
    support: Support, rollers: int, triangles: int, text: str
) -> None:
    svg = sketch(scene(CLAMP, support))

    assert rings(svg) == rollers
    corners = [found.count(",") for found in re.findall(r'<polygon class="hatch" fill="none" points="([^"]*)"', svg)]
    assert corners == ([3] if triangles else [4])
    assert f">{text}</text>" in svg


def test_a_support_that_keeps_a_section_from_turning_has_a_plate() -> None:
    symmetry = Support("beam", 400.0, ("s", "turn x", "turn y"), of="mean")

    walls = [sketch(scene(CLAMP, *more)).count('class="wall"') for more in ((), (symmetry,))]

    assert walls == [1, 2]


def test_a_clamp_that_moves_says_so() -> None:
    assert ">moved</text>" not in sketch(scene(CLAMP))
    assert ">moved</text>" in sketch(scene(CLAMP, Clamp("beam", "end", (0.0, 0.5, 0.0))))


def test_supports_and_beds_are_marked_on_the_axis() -> None:
    svg = sketch(scene(CLAMP, Support("beam", 310.0, ("y",)), beds=(Bed(RodFace("beam", "bottom"), 60.0, 290.0, 0.5),)))

    assert {"0", "60", "290", "310", "400"} <= set(re.findall(r'<text class="tick"[^>]*>([\d.]+)</text>', svg))


@pytest.mark.parametrize(("face", "springs"), [("bottom", SPRINGS), ("top", SPRINGS), ("left", 0)])
def test_a_bed_is_a_row_of_springs_where_it_is_seen_from_the_side(face: str, springs: int) -> None:
    svg = sketch(scene(CLAMP, beds=(Bed(RodFace("beam", face), 50.0, 350.0, 0.5),)))  # type: ignore[arg-type]

    assert svg.count('<polyline class="hatch"') == springs
    assert ">0.5 N/mm³</text>" in svg


@pytest.mark.parametrize(
    ("load", "downwards", "text"),
    [
        (Pressure(RodFace("beam", "top"), 0.0, 400.0, 0.2), 7, "0.2 MPa"),
        (Pressure(RodFace("beam", "bottom"), 0.0, 400.0, -0.2), 7, "-0.2 MPa"),
        (Pressure(RodFace("beam", "top"), 0.0, 400.0, -0.2), 0, "-0.2 MPa"),
        (Gravity("beam", (0.0, -9810.0, 0.0)), 1, "g"),
        (Pressure(RodFace("beam", "top"), 0.0, 400.0, 0.0), 0, None),
    ],
)
def test_pressure_is_a_row_of_arrows_and_gravity_one(load: Load, downwards: int, text: str | None) -> None:
    svg = sketch(scene(CLAMP, loads=(load,)))

    arrows = [
        float(y2) - float(y1)
        for y1, y2 in re.findall(r'class="force" x1="[^"]*" y1="([^"]*)" x2="[^"]*" y2="([^"]*)"', svg)
    ]
    assert sum(each > 0.0 for each in arrows) == downwards
    assert (f">{text}</text>" in svg) if text else not arrows


def test_a_joint_is_a_dot_between_its_rods() -> None:
    beam = scene(CLAMP)
    post = Rod(
        "post", Line((400.0, 0.0, 0.0), (400.0, 90.0, 0.0), (1.0, 0.0, 0.0)), Rectangle(9.0, 9.0), STEEL, (0.0, 90.0)
    )
    joint = Joint((RodEnd("beam", "end"), RodEnd("post", "start")))

    svg = sketch(replace(beam, rods=(*beam.rods, post), joints=(joint,)))

    # 500 wide for 400 mm
    assert '<circle class="force-head" cx="500.00" cy="-0.00" r="4.5"/>' in svg


def test_nothing_is_drawn_outside_the_picture() -> None:
    drawn = scene(
        Support("beam", 0.0, ("s", "turn x", "turn y", "turn s"), of="mean"),
        Support("beam", 400.0, ("x", "y"), displacement=(0.1, 0.2)),
        loads=(Pressure(RodFace("beam", "bottom"), 100.0, 200.0, 0.2), Gravity("beam", (9810.0, 0.0, 0.0))),
        beds=(Bed(RodFace("beam", "bottom"), 200.0, 400.0, 0.5),),
    )

    svg = sketch(drawn)

    assert "nan" not in svg
    left, top, width, height = (float(each) for each in re.search(r'viewBox="([^"]*)"', svg).group(1).split())
    for kind, x, y, text in re.findall(r'<text class="(\w+)" x="([^"]*)" y="([^"]*)"[^>]*>([^<]*)<', svg):
        half = LETTER * len(text) / 2.0
        middle = float(x) + (half if kind == "load" else 0.0)
        assert left <= middle - half, text
        assert middle + half <= left + width, text
        assert top + 8.0 <= float(y) <= top + height, text
    points = [pair.split(",") for found in re.findall(r'points="([^"]*)"', svg) for pair in found.split()]
    places = np.array(points, dtype=float)
    assert (places > [left, top]).all()
    assert (places < [left + width, top + height]).all()


def test_a_support_stands_on_its_rod_where_another_one_lies_below() -> None:
    line = Line((0.0, 20.0, 0.0), (400.0, 20.0, 0.0), (0.0, 1.0, 0.0))
    upper = Rod("upper", line, Rectangle(10.0, 20.0), STEEL, (0.0, 400.0))
    supports = (Support("beam", 200.0, ("y",)), Support("upper", 200.0, ("y",)), CLAMP, Clamp("upper", "start"))
    drawn = replace(scene(), rods=(*scene(CLAMP).rods, upper), supports=supports)

    svg = sketch(drawn)

    # 500 wide for 400 mm; upwards is negative
    tips = [
        float(points.split()[0].split(",")[1])
        for points in re.findall(r'<polygon class="hatch" fill="none" points="([^"]*)"', svg)
    ]
    assert tips == pytest.approx([12.5, -37.5])


def test_numbers_on_the_axis_do_not_cover_one_another() -> None:
    supports = [Support("beam", position, ("y",)) for position in (100.0, 100.05, 104.0, 108.0)]

    svg = sketch(scene(CLAMP, *supports))

    found = re.findall(r'<text class="tick" x="([^"]*)" y="([^"]*)">([\d.]+)</text>', svg)
    assert {"100", "104", "108"} <= {text for _, _, text in found}
    assert "100.05" not in {text for _, _, text in found}  # all but where 100 is
    rows = {text: y for _, y, text in found}
    assert len({rows["100"], rows["104"], rows["108"]}) == 3


@pytest.mark.parametrize(("height", "beside"), [(20.0, False), (2.0, True)])
def test_the_name_of_a_slim_rod_stands_beside_it(height: float, beside: bool) -> None:
    (rod,) = scene(CLAMP).rods
    drawn = replace(scene(CLAMP), rods=(replace(rod, section=Rectangle(10.0, height)),))

    y = float(re.search(r'<text class="name" x="[^"]*" y="([^"]*)"', sketch(drawn)).group(1))

    assert (y < -0.5 * height * 500.0 / 400.0 - 2.0) == beside
