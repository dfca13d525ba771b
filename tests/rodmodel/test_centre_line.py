"""Centre lines and their frames."""

import numpy as np
import pytest

from cases.scene import CentreLine, Helix, Line, Material, Path, Rectangle, Rod, Spline
from rodmodel.centre_line import by_turning, centre_points, darboux, frames, global_points, local_points, turning_at

SKEW = ((0.0, 0.0, 0.0), (5.0, 0.0, 0.0), (6.0, 6.0, 1.0), (2.0, 8.0, 6.0), (0.0, 10.0, 9.0))

LINES: dict[str, CentreLine] = {
    "straight": Line((1.0, 2.0, 3.0), (4.0, -2.0, 3.0), (0.0, 0.0, 1.0)),
    "pre-twisted": Line((0.0, 0.0, 0.0), (10.0, 0.0, 0.0), (0.0, 1.0, 0.0), twist=np.pi / 2),
    "arc": Helix((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 2.0), np.pi / 2, (0.0, 0.0, 1.0)),
    "arc, skew frame": Helix((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 4.0, (1.0, 0.0, 1.0)),
    "left-hand helix": Helix((3.0, 4.0, 0.0), (0.0, 0.0, 7.0), (0.0, 0.0, 1.0), 9.0, (0.2, 0.1, 1.0), pitch=-6.0),
    "spline": Spline(SKEW, (0.0, 0.0, 1.0)),
    "spline, e2 upwards": Spline(SKEW, (0.0, 0.0, 1.0), "up"),
    "parabola": Spline(SKEW[1:4], (0.0, 0.0, 1.0)),
    "path": Path(
        (
            Line((5.0, -9.0, 0.0), (5.0, 0.0, 0.0), (0.0, 0.0, 1.0)),
            Helix((5.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), np.pi / 2, (0.0, 0.0, 1.0)),
        )
    ),
}


@pytest.fixture(params=list(LINES))
def line(request: pytest.FixtureRequest) -> CentreLine:
    return LINES[request.param]


def test_frames_are_right_handed_and_orthonormal(line: CentreLine) -> None:
    axes = frames(line, np.linspace(0.0, line.length, 7))
    np.testing.assert_allclose(axes @ axes.transpose(0, 2, 1), np.broadcast_to(np.eye(3), axes.shape), atol=1e-14)
    np.testing.assert_allclose(np.linalg.det(axes), 1.0, atol=1e-14)


def test_tangent_is_the_derivative_of_the_points(line: CentreLine) -> None:
    """Unit speed: the parameter is the arc length."""
    station, step = np.linspace(0.1, 0.9, 5) * line.length, 1e-5 * line.length
    slope = (centre_points(line, station + step) - centre_points(line, station - step)) / (2.0 * step)
    np.testing.assert_allclose(slope.T, frames(line, station)[:, 2], atol=1e-8)  # step^2 of the central difference


def test_frames_turn_as_the_darboux_vector_says(line: CentreLine) -> None:
    station, step = np.linspace(0.1, 0.9, 5) * line.length, 1e-5 * line.length
    slope = (frames(line, station + step) - frames(line, station - step)) / (2.0 * step)
    axes = frames(line, station)
    omega = np.einsum("in,nig->ng", turning_at(line, station), axes)
    np.testing.assert_allclose(slope, np.cross(omega[:, None], axes), atol=1e-8)


def test_lines_end_where_they_should() -> None:
    ends = {name: centre_points(line, np.array([line.length]))[:, 0] for name, line in LINES.items()}
    for name, line in LINES.items():
        np.testing.assert_allclose(ends[name], line.end_points[1], atol=1e-12)
    np.testing.assert_allclose(ends["straight"], [4.0, -2.0, 3.0], atol=1e-14)
    np.testing.assert_allclose(ends["arc"], [0.0, 5.0, 0.0], atol=1e-14)
    np.testing.assert_allclose(ends["left-hand helix"][2], -6.0 * 9.0 / (2.0 * np.pi))


def test_a_pre_twisted_line_turns_its_frame_about_itself() -> None:
    axes = frames(LINES["pre-twisted"], np.array([10.0]))[0]
    # e2 from Y by 90 degrees about X to Z
    np.testing.assert_allclose(axes[1], [0.0, 0.0, 1.0], atol=1e-15)


def test_curvature_of_an_arc_and_a_helix() -> None:
    k1, k2, tau = darboux(LINES["arc"])
    assert np.hypot(k1, k2) == pytest.approx(1.0 / 5.0)
    assert tau == 0.0
    k1, k2, tau = darboux(LINES["left-hand helix"])
    radius, rise = 5.0, -6.0 / (2.0 * np.pi)
    assert np.hypot(k1, k2) == pytest.approx(radius / (radius**2 + rise**2))
    assert tau == pytest.approx(rise / (radius**2 + rise**2))


def test_what_depends_on_the_turning_is_asked_once_where_it_is_the_same() -> None:
    turning = np.array([[0.0, 0.1, 0.0], [0.2, 0.0, 0.2], [0.0, 0.0, 0.0]])
    asked = []

    def evaluate(rates: tuple[float, float, float]) -> np.ndarray:
        asked.append(rates)
        return np.array(rates[:2])

    np.testing.assert_array_equal(by_turning(turning, evaluate), turning[:2].T)
    assert sorted(asked) == [(0.0, 0.2, 0.0), (0.1, 0.0, 0.0)]


def test_local_and_global_points_of_a_straight_rod_are_inverse() -> None:
    rod = Rod("rod", LINES["straight"], Rectangle(1.0, 1.0), Material(1.0, 0.0), (0.0, 5.0))
    points = np.random.default_rng(0).standard_normal((3, 6))
    np.testing.assert_allclose(local_points(rod, global_points(rod, points)), points, atol=1e-14)
