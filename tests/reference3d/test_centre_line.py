"""Points and frames of centre lines against what their definitions say, by other means than those that compute them."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from cases.scene import Helix, Line, Path, Spline
from reference3d.centre_line import frames, points, stretches, turning_rate

TWISTED = Line((1.0, 2.0, 3.0), (31.0, -8.0, 13.0), (0.0, 1.0, 0.0), twist=2.0)
HELIX = Helix((20.0, 0.0, 0.0), (1.0, 2.0, 3.0), (0.2, 0.1, 1.0), 7.0, (0.0, 0.0, 1.0), 8.0)
POINTS = ((0.0, 0.0, 0.0), (50.0, 10.0, 0.0), (100.0, 0.0, 20.0), (130.0, 40.0, 60.0), (150.0, 100.0, 60.0))
SPLINE = Spline(POINTS, (0.0, 0.0, 1.0))
PARABOLA = Spline(POINTS[:3], (0.0, 0.0, 1.0), "up")
ARC = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
PATH = Path((Line((100.0, -40.0, 0.0), (100.0, 0.0, 0.0), (0.0, 0.0, 1.0)), ARC))
ALL = {"twisted": TWISTED, "helix": HELIX, "spline": SPLINE, "parabola": PARABOLA, "path": PATH}


@pytest.mark.parametrize("line", ALL.values(), ids=ALL)
def test_the_line_runs_from_end_to_end_at_speed_one_along_its_tangent(line):
    station = np.linspace(0.0, line.length, 41)
    reach = 1e-4
    inside = station[1:-1]

    # shifted by tenths of a millimetre, off the border of the path's pieces
    slope = (points(line, inside + 0.1 + reach) - points(line, inside + 0.1 - reach)) / (2.0 * reach)

    np.testing.assert_allclose(points(line, station[[0, -1]]), line.end_points, atol=1e-10 * line.length)
    # central differences: round-off 1e-14 * 100 / 1e-4, and curvature change * reach^2
    np.testing.assert_allclose(slope, frames(line, inside + 0.1)[:, 2], atol=1e-8)


@pytest.mark.parametrize("line", ALL.values(), ids=ALL)
def test_frames_are_right_handed_and_start_along_up(line):
    axes = frames(line, np.linspace(0.0, line.length, 41))
    up = np.array([0.0, 0.0, 1.0]) if line is not TWISTED else np.array(TWISTED.up)

    np.testing.assert_allclose(axes @ np.swapaxes(axes, 1, 2), np.tile(np.eye(3), (41, 1, 1)), atol=1e-13)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    normal_part = up - (up @ axes[0, 2]) * axes[0, 2]
    np.testing.assert_allclose(axes[0, 1], normal_part / np.linalg.norm(normal_part), atol=1e-12)


def test_a_twisted_line_turns_evenly_from_e1_towards_e2():
    axes = frames(TWISTED, np.array([0.0, TWISTED.length / 4.0]))

    # a quarter of the twist of 2 rad; e1 turned about t by the right-hand rule moves towards e2
    np.testing.assert_allclose(axes[1, 0], math.cos(0.5) * axes[0, 0] + math.sin(0.5) * axes[0, 1], atol=1e-14)


def test_the_minimal_rotation_does_not_turn_about_the_tangent():
    inside, reach = np.linspace(1.0, SPLINE.length - 1.0, 33), 1e-4

    change = (frames(SPLINE, inside + reach) - frames(SPLINE, inside - reach)) / (2.0 * reach)

    # rate of turning about t is e1' . e2; differences as above
    np.testing.assert_allclose(np.einsum("nc,nc->n", change[:, 0], frames(SPLINE, inside)[:, 1]), 0.0, atol=1e-8)


def test_with_up_the_first_axis_stays_normal_to_it():
    spline = replace(SPLINE, frame="up")

    np.testing.assert_allclose(frames(spline, np.linspace(0.0, spline.length, 33))[:, 0, 2], 0.0, atol=1e-14)


@pytest.mark.parametrize("count", [3, 4])
def test_a_spline_of_up_to_four_points_is_one_polynomial_over_the_length_of_the_chords(count):
    corners = np.array(POINTS[:count])
    chords = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    through = np.polynomial.polynomial.polyfit(chords, corners, count - 1)
    slope = np.polynomial.polynomial.polyder(through)

    for v in (0.3 * chords[1], chords[1], 0.9 * chords[-1]):
        arc = quad(lambda at: float(np.linalg.norm(np.polynomial.polynomial.polyval(at, slope))), 0.0, v)[0]
        found = points(Spline(POINTS[:count], (0.0, 0.0, 1.0)), np.array([arc]))[0]
        np.testing.assert_allclose(found, np.polynomial.polynomial.polyval(v, through), atol=1e-9)


def test_pieces_where_all_layers_are_alike_are_known():
    assert [(each.start, each.even) for each in stretches(PATH)] == [(0.0, True), (40.0, True)]
    assert [each.even for each in stretches(SPLINE)] == [False]


def test_the_rate_of_turning_counts_curvature_and_twist():
    helix_rate = HELIX.angle / HELIX.length  # the screw motion turns the whole frame about the axis

    # by differences over 1e-4 of the length
    np.testing.assert_allclose(turning_rate(HELIX, np.array([0.0, 50.0])), helix_rate, rtol=1e-6)
    np.testing.assert_allclose(turning_rate(TWISTED, np.array([10.0])), TWISTED.twist / TWISTED.length, rtol=1e-6)
