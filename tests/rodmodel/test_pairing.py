"""Opposite points of two faces, and the contact points over a zone."""

from dataclasses import replace

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import ContactPair, Ground, Helix, Line, Material, Rectangle, Rod, RodFace, Scene, SceneError
from rodmodel.centre_line import frame, global_points
from rodmodel.pairing import contact_grid, face_axes, facing_points, is_even, on_second, shared_borders, shared_width


@pytest.fixture
def scene() -> Scene:
    return load_case("two-cantilevers-e50-g0").scene


def with_upper_line(scene: Scene, line: Line) -> Scene:
    return replace(scene, rods=(scene.rods[0], replace(scene.rods[1], centre_line=line)))


def test_frame_is_right_handed_with_e2_up() -> None:
    axes = frame(Line((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (1.0, 2.0, 0.0)))
    np.testing.assert_allclose(axes, [[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]], atol=1e-15)
    assert np.linalg.det(axes) == pytest.approx(1.0)


def test_opposite_points_differ_by_the_distance_of_the_faces_alone(scene: Scene) -> None:
    pair = scene.contacts[0]
    station, across = np.array([200.0, 250.0, 300.0]), np.array([0.0, -7.5, 3.0])
    points = facing_points(scene, pair, station, across)
    first = global_points(scene.rods[0], points.first)
    second = global_points(scene.rods[1], points.second)
    np.testing.assert_allclose(first, second, atol=1e-12)  # drawn without a gap
    np.testing.assert_allclose(first[0], station, atol=1e-12)


def test_a_rod_drawn_from_its_other_end_meets_the_same_points(scene: Scene) -> None:
    turned = with_upper_line(scene, Line((500.0, 15.0, 0.0), (200.0, 15.0, 0.0), (0.0, 1.0, 0.0)))
    station, across = np.array([210.0, 290.0]), np.array([2.0, -5.0])
    points = facing_points(turned, turned.contacts[0], station, across)
    np.testing.assert_allclose(
        global_points(turned.rods[1], points.second), global_points(turned.rods[0], points.first), atol=1e-12
    )


def test_width_is_what_both_faces_share(scene: Scene) -> None:
    shifted = with_upper_line(scene, Line((200.0, 15.0, 4.0), (500.0, 15.0, 4.0), (0.0, 1.0, 0.0)))
    # x of the lower rod runs along -Z: a shift by +4 in Z takes the upper face to x = -11.5 .. 3.5
    low, high = shared_width(shifted, shifted.contacts[0], np.array([210.0, 300.0]))
    np.testing.assert_allclose([low, high], [[-7.5, -7.5], [3.5, 3.5]])


def test_faces_beside_one_another_are_refused(scene: Scene) -> None:
    """The scene lets rods pass whose sides overlap by less than nothing once their widths are counted."""
    shifted = with_upper_line(
        replace(scene, contacts=()), Line((200.0, 15.0, 15.0), (500.0, 15.0, 15.0), (0.0, 1.0, 0.0))
    )
    with pytest.raises(SceneError, match="beside one another"):
        contact_grid(shifted, scene.contacts[0], np.array([[200.0, 300.0]]), (4, 3), False)


STEEL = Material(200e3, 0.3)


def crossed(angle: float, width: float = 10.0) -> tuple[Scene, ContactPair]:
    """Two flat bars, 20 and `width` wide; the second one lies on the middle of the first at an angle (rad)."""
    along = np.array([np.cos(angle), 0.0, np.sin(angle)])
    first = Rod(
        "first", Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0)), Rectangle(20.0, 4.0), STEEL, (0, 100)
    )
    start, end = (tuple(np.array([50.0, 4.0, 0.0]) + side * along) for side in (-60.0, 60.0))
    second = Rod("second", Line(start, end, (0.0, 1.0, 0.0)), Rectangle(width, 4.0), STEEL, (0.0, 120.0))
    pair = ContactPair("cross", RodFace("first", "top"), RodFace("second", "bottom"), (10.0, 90.0), 0.0)
    return Scene("crossed", (first, second), (), (), (pair,)), pair


def area_of(scene: Scene, pair: ContactPair) -> float:
    borders = shared_borders(scene, pair)
    grid = contact_grid(scene, pair, np.column_stack([borders[:-1], borders[1:]]), (6, 5), False)
    return float(grid.weight.sum())


@pytest.mark.parametrize("angle", [np.pi / 2.0, 1.0, -0.7])
def test_crossing_bars_share_a_parallelogram(angle: float) -> None:
    scene, pair = crossed(angle)
    assert not is_even(scene, pair)
    assert area_of(scene, pair) == pytest.approx(20.0 * 10.0 / abs(np.sin(angle)), rel=1e-12)


def test_the_zone_and_the_ends_of_the_bars_cut_what_they_share() -> None:
    scene, pair = crossed(np.pi / 2.0)
    assert area_of(scene, replace(pair, zone=(47.0, 90.0))) == pytest.approx(8.0 * 20.0)
    line = Line((50.0, 4.0, -4.0), (50.0, 4.0, 60.0), (0.0, 1.0, 0.0))
    short = replace(scene.rods[1], centre_line=line, element_borders=(0.0, 64.0))
    assert area_of(replace(scene, rods=(scene.rods[0], short)), pair) == pytest.approx(10.0 * 14.0)


def test_a_zone_beside_the_other_bar_is_refused() -> None:
    scene, pair = crossed(np.pi / 2.0)
    with pytest.raises(SceneError, match="no point of rod 'second'"):
        shared_borders(scene, replace(pair, zone=(60.0, 90.0)))


def test_points_on_crossing_bars_lie_straight_across() -> None:
    scene, pair = crossed(0.8)
    points = facing_points(scene, pair, np.array([45.0, 55.0]), np.array([3.0, -9.0]))
    np.testing.assert_allclose(
        global_points(scene.rods[0], points.first), global_points(scene.rods[1], points.second), atol=1e-12
    )
    first, last = on_second(scene, pair, np.array(pair.zone))
    assert 0.0 < first < 60.0 < last < 120.0


def arch_on_bar() -> tuple[Scene, ContactPair]:
    """An arc of radius 80 whose lower face touches a straight bar's top at X = 50."""
    bar = Rod("bar", Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0)), Rectangle(10.0, 10.0), STEEL, (0, 100))
    # It runs from the left over its lowest point, the centre above.
    start = (50.0 - 80.0 * np.sin(0.5), 90.0 - 80.0 * np.cos(0.5), 0.0)
    line = Helix(start, (50.0, 90.0, 0.0), (0.0, 0.0, 1.0), 1.0, (0.0, 1.0, 0.0))
    arch = Rod("arch", line, Rectangle(10.0, 10.0), STEEL, (0.0, line.length))
    pair = ContactPair("touch", RodFace("bar", "top"), RodFace("arch", "bottom"), (20.0, 80.0), "drawn")
    return Scene("arch", (bar, arch), (), (), (pair,)), pair


def test_the_drawn_distance_of_a_curved_face_is_that_of_its_circle() -> None:
    scene, pair = arch_on_bar()
    station = np.array([30.0, 50.0, 62.0])
    points = facing_points(scene, pair, station, np.array([0.0, 4.0, -5.0]))
    # The lower face is a circle of 85 mm about (50, 90), whose lowest point is the bar's top.
    np.testing.assert_allclose(points.distance, 85.0 - np.sqrt(85.0**2 - (station - 50.0) ** 2), atol=1e-11)
    np.testing.assert_allclose(
        global_points(scene.rods[1], points.second),
        global_points(scene.rods[0], points.first) + points.distance * points.normal,
        atol=1e-10,
    )


def test_it_is_the_same_seen_from_the_curved_face() -> None:
    scene, pair = arch_on_bar()
    other_way = replace(pair, first=pair.second, second=pair.first, zone=(20.0, 60.0))
    points = facing_points(scene, other_way, np.array([40.0, 45.0]), np.array([0.0, 3.0]))
    # Along the radius from the centre, 90 - 5 above the bar's top: 85 / cos of the angle from the lowest point.
    angle = np.array([0.0, 5.0 / 80.0])
    np.testing.assert_allclose(points.distance, 85.0 / np.cos(angle) - 85.0, atol=1e-11)


def test_ground_lies_under_all_of_a_face(scene: Scene) -> None:
    pair = ContactPair("ground", RodFace("lower", "bottom"), Ground(), (50.0, 250.0), 0.0)
    assert is_even(scene, pair)
    points = facing_points(scene, pair, np.array([60.0]), np.array([2.0]))
    assert points.second is None
    np.testing.assert_allclose(points.normal[:, 0], [0.0, -1.0, 0.0])
    np.testing.assert_array_equal(shared_borders(scene, pair), [50.0, 250.0])


@pytest.mark.parametrize("symmetric", [False, True])
def test_contact_points_weigh_the_whole_face(scene: Scene, symmetric: bool) -> None:
    narrow = replace(scene, rods=(replace(scene.rods[0], section=Rectangle(6.0, 15.0)), scene.rods[1]))
    pair = ContactPair("ground", RodFace("lower", "top"), Ground(), (0.0, 40.0), 0.0)
    grid = contact_grid(narrow, pair, np.array([[0.0, 10.0], [10.0, 40.0]]), (6, 5), symmetric)
    station, across = grid.flat()
    weight = grid.weight.ravel()
    assert weight.sum() == pytest.approx(40.0 * 6.0)
    # integral of s^2 x^2 over the face, both rules exact to this degree
    assert weight @ (station**2 * across**2) == pytest.approx(40.0**3 / 3.0 * 2.0 * 27.0 / 3.0)
    np.testing.assert_allclose(grid.across[:, :, grid.middle], 0.0, atol=1e-15)
    assert across.max() == 3.0


def test_face_axes_point_out_of_the_section(scene: Scene) -> None:
    rod = scene.rods[0]
    np.testing.assert_allclose(face_axes(rod, "top").normal, [0.0, 1.0, 0.0])
    np.testing.assert_allclose(face_axes(rod, "bottom").normal, [0.0, -1.0, 0.0])
    np.testing.assert_allclose(face_axes(rod, "right").normal, [0.0, 0.0, -1.0])
    np.testing.assert_allclose(face_axes(rod, "left").normal, [0.0, 0.0, 1.0])
