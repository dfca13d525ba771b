"""Splines and paths as parts of a scene: their lengths and frames, and what is refused of them."""

import math
from dataclasses import replace

import numpy as np
import pytest

from cases.centre_lines import curvatures, end_axes
from cases.scene import (
    Clamp,
    Helix,
    Line,
    LineLoad,
    Material,
    Path,
    Rectangle,
    Rod,
    Scene,
    SceneError,
    SectionForce,
    Spline,
)

STEEL = Material(200e3, 0.3)
UP = (0.0, 0.0, 1.0)
ARC = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), UP, math.pi / 2.0, UP)
STRAIGHT = Line((0.0, 100.0, 0.0), (-50.0, 100.0, 0.0), UP)
BENT = Spline(((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (20.0, 5.0, 0.0), (25.0, 15.0, 0.0)), UP)


def refusal(make, *arguments):
    with pytest.raises(SceneError) as caught:
        make(*arguments)
    return caught.value


def along_arc(count):
    angle = np.linspace(0.0, math.pi / 2.0, count)
    points = np.column_stack([100.0 * np.cos(angle), 100.0 * np.sin(angle), 0.0 * angle])
    return Spline(tuple(map(tuple, points.tolist())), UP)


def test_a_spline_through_points_of_an_arc_gets_its_length_with_the_fourth_power_of_their_distance():
    errors = [abs(along_arc(count).length - ARC.length) for count in (9, 17)]

    assert errors[0] < 1e-3
    assert errors[0] / errors[1] > 16.0


def test_points_of_a_spline_may_come_as_an_array():
    assert Spline(np.array(BENT.points), UP) == BENT


def test_a_spline_through_three_points_is_a_parabola():
    parabola = Spline(((-1.0, 1.0, 0.0), (0.0, 0.0, 0.0), (1.0, 1.0, 0.0)), UP)

    # y = x^2 from -1 to 1: sqrt(5) + asinh(2) / 2
    assert parabola.length == pytest.approx(math.sqrt(5.0) + math.asinh(2.0) / 2.0, rel=1e-13)


def test_frames_at_the_end_of_arcs_in_two_planes():
    """Tangents from X to Y in the ground plane, then up to Z; e2 = Z goes along to -Y."""
    first = Helix((0.0, -10.0, 0.0), (0.0, 0.0, 0.0), UP, math.pi / 2.0, UP)
    second = Helix((10.0, 0.0, 0.0), (10.0, 0.0, 10.0), (1.0, 0.0, 0.0), math.pi / 2.0, UP)

    tangent, e2 = end_axes(Path((first, second)).pieces[-1])
    np.testing.assert_allclose(tangent, [0.0, 0.0, 1.0], atol=1e-15)
    np.testing.assert_allclose(e2, [0.0, -1.0, 0.0], atol=1e-15)


def test_frames_at_the_end_of_a_spline_agree_with_the_line_it_follows():
    helix = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), UP, 2.0, (1.0, 0.0, 1.0))
    angle = np.linspace(0.0, 2.0, 65)
    spline = Spline(tuple((100.0 * math.cos(a), 100.0 * math.sin(a), 0.0) for a in angle), (1.0, 0.0, 1.0))

    tangent, e2 = end_axes(spline)
    expected, e2_expected = end_axes(helix)
    np.testing.assert_allclose(tangent, expected, atol=1e-5)
    np.testing.assert_allclose(e2, e2_expected, atol=1e-5)


@pytest.mark.parametrize(
    ("points", "up", "frame", "key"),
    [
        pytest.param(BENT.points[:2], UP, "up", "points", id="two points"),
        pytest.param((*BENT.points, (math.nan, 0.0, 0.0)), UP, "up", "points #5", id="not finite"),
        pytest.param((*BENT.points[:2], *BENT.points[1:]), UP, "up", "points #3", id="a point twice"),
        pytest.param(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 0.0, 0.0)), UP, "up", "points", id="turns back"),
        pytest.param(((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (2.0, 0.0, 0.0)), (1.0, 0.0, 0.0), "up", "up", id="along"),
        pytest.param(along_arc(9).points, (-1.0, 0.0, 0.0), "up", "up", id="along it later"),
        pytest.param(BENT.points, UP, "frenet", "frame", id="unknown frame"),
    ],
)
def test_splines_that_cannot_be_are_refused(points, up, frame, key):
    assert refusal(Spline, points, up, frame).key == key


def test_a_frame_of_minimal_rotation_may_pass_up():
    assert Spline(along_arc(9).points, (-1.0, 0.0, 0.0)).length > 0.0


def test_a_path_is_as_long_as_its_pieces():
    path = Path((ARC, STRAIGHT))

    assert path.borders == (0.0, ARC.length, ARC.length + 50.0)
    assert path.end_points == ((100.0, 0.0, 0.0), (-50.0, 100.0, 0.0))


@pytest.mark.parametrize(
    ("following", "key", "remedy"),
    [
        pytest.param(replace(STRAIGHT, start=(0.0, 101.0, 0.0)), "pieces #2", "[0, 100, 0]", id="gap"),
        pytest.param(replace(STRAIGHT, end=(-50.0, 90.0, 0.0)), "pieces #2", "joint", id="corner"),
        pytest.param(replace(STRAIGHT, up=(0.0, 1.0, 1.0)), "pieces #2.up", "up = [0, 0, 1]", id="frame"),
    ],
)
def test_pieces_that_do_not_continue_each_other_are_refused(following, key, remedy):
    error = refusal(Path, (ARC, following))

    assert error.key == key
    assert remedy in error.remedy


def test_the_up_that_a_refusal_names_is_right():
    twisted = Line((0.0, 0.0, 0.0), (30.0, 40.0, 0.0), (0.1, 0.2, 1.0), twist=0.7)
    bow = Spline(((30.0, 40.0, 0.0), (60.0, 80.0, 0.0), (90.0, 120.0, 0.0)), UP)
    error = refusal(Path, (twisted, bow))

    named = tuple(float(number) for number in error.remedy.partition("[")[2].partition("]")[0].split(","))
    assert Path((twisted, replace(bow, up=named))).length == pytest.approx(150.0)


def test_rounded_places_between_pieces_are_set_to_them():
    path = Path((ARC, STRAIGHT))

    rod = Rod("bow", path, Rectangle(5.0, 5.0), STEEL, (0.0, 100.0, 157.08, 207.08))
    load = LineLoad("bow", 157.0796, 207.08, (0.0, 0.0, 1.0))
    loads = Scene("bow", (rod,), (Clamp("bow", "start"),), (load, SectionForce("bow", 157.08, UP)), ()).loads

    assert rod.element_borders == (0.0, 100.0, ARC.length, path.length)
    assert (loads[0].start, loads[0].end, loads[1].position) == (ARC.length, path.length, ARC.length)


def test_of_two_borders_near_the_end_of_a_piece_the_nearer_is_set_to_it():
    path = Path((ARC, STRAIGHT))

    rod = Rod("bow", path, Rectangle(5.0, 5.0), STEEL, (0.0, 157.07, 157.08, path.length))
    assert rod.element_borders == (0.0, 157.07, ARC.length, path.length)


@pytest.mark.parametrize(
    ("line", "where"),
    [
        pytest.param(along_arc(33), "s = ", id="spline"),
        pytest.param(Path((Line((100.0, -50.0, 0.0), (100.0, 0.0, 0.0), UP), ARC)), "100 mm", id="path"),
    ],
)
def test_sections_wider_than_the_radius_are_refused_across_the_curve_alone(line, where):
    borders = (0.0, line.length)

    error = refusal(Rod, "bow", line, Rectangle(202.0, 5.0), STEEL, borders)
    assert error.key == "rods.bow.centre_line"
    assert where in error.found
    assert Rod("bow", line, Rectangle(5.0, 202.0), STEEL, borders).length == line.length


def test_a_spline_is_looked_at_where_it_is_tightest():
    """An ellipse of half axes a = 100 and b = 50 has the radius b^2 / a = 25 at the ends of its long axis."""
    angle = np.linspace(-0.6, 1.0, 41)
    line = Spline(tuple((100.0 * math.cos(a), 50.0 * math.sin(a), 0.0) for a in angle), UP)

    _, curvature = curvatures(line)
    # third derivatives jump at the points, 2 mm apart here
    assert np.linalg.norm(curvature, axis=1).max() == pytest.approx(1.0 / 25.0, rel=3e-3)
    assert Rod("bow", line, Rectangle(49.8, 5.0), STEEL, (0.0, line.length)).length == line.length
    refused = refusal(Rod, "bow", line, Rectangle(50.2, 5.0), STEEL, (0.0, line.length))
    assert refused.key == "rods.bow.centre_line"
