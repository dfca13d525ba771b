"""Opposite points of two faces, and the contact points over a zone."""

from dataclasses import replace

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import Line, Scene
from rodmodel.centre_line import frame, global_points
from rodmodel.pairing import contact_grid, face_axes, facing_points, width_across


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
    assert width_across(shifted, shifted.contacts[0]) == pytest.approx((-7.5, 3.5))


def test_crossing_rods_are_refused(scene: Scene) -> None:
    pair = scene.contacts[0]
    upper = replace(scene.rods[1], centre_line=Line((250.0, 15.0, -150.0), (250.0, 15.0, 150.0), (0.0, 1.0, 0.0)))
    crossing = replace(scene, rods=(scene.rods[0], upper), contacts=())
    with pytest.raises(ValueError, match="not parallel"):
        width_across(crossing, pair)


@pytest.mark.parametrize("symmetric", [False, True])
def test_contact_points_weigh_the_whole_face(symmetric: bool) -> None:
    grid = contact_grid(np.array([[0.0, 10.0], [10.0, 40.0]]), (-3.0, 3.0), 6, 5, symmetric)
    station, across = grid.flat()
    weight = grid.weight.ravel()
    assert weight.sum() == pytest.approx(40.0 * 6.0)
    # integral of s^2 x^2 over the face, both rules exact to this degree
    assert weight @ (station**2 * across**2) == pytest.approx(40.0**3 / 3.0 * 2.0 * 27.0 / 3.0)
    assert grid.across[grid.middle] == pytest.approx(0.0, abs=1e-15)
    assert across.max() == 3.0


def test_face_axes_point_out_of_the_section(scene: Scene) -> None:
    rod = scene.rods[0]
    np.testing.assert_allclose(face_axes(rod, "top").normal, [0.0, 1.0, 0.0])
    np.testing.assert_allclose(face_axes(rod, "bottom").normal, [0.0, -1.0, 0.0])
    np.testing.assert_allclose(face_axes(rod, "right").normal, [0.0, 0.0, -1.0])
    np.testing.assert_allclose(face_axes(rod, "left").normal, [0.0, 0.0, 1.0])
