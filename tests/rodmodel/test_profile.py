"""Pressure along the zone."""

import numpy as np
import pytest

from cases.loader import load_case
from rodmodel.pairing import contact_grid
from rodmodel.profile import pressure_profile

SCENE = load_case("two-cantilevers-e50-g0").scene
PAIR = SCENE.contacts[0]


def profile_of(pressure, symmetric: bool = True):
    """Profile of forces that stand for a pressure given as a function of station and across."""
    grid = contact_grid(SCENE, PAIR, np.array([[200.0, 230.0], [230.0, 300.0]]), (8, 7), symmetric)
    station, across = grid.flat()
    return pressure_profile(SCENE, PAIR, grid, np.maximum(pressure(station, across), 0.0) * grid.weight.ravel())


@pytest.mark.parametrize("symmetric", [True, False])
def test_lines_are_the_pressure_where_they_say(symmetric: bool) -> None:
    profile = profile_of(lambda s, x: (300.0 - s) * (1.0 + (x / 7.5) ** 2), symmetric)
    inside = profile.station <= 230.0
    expected = 300.0 - profile.station[inside]
    np.testing.assert_allclose(profile.middle[inside], expected, atol=1e-9)
    np.testing.assert_allclose(profile.outer[inside], 2.0 * expected, atol=1e-9)
    np.testing.assert_allclose(profile.mean[inside], 4.0 / 3.0 * expected, atol=1e-9)


def test_stations_cover_the_zone_once() -> None:
    profile = profile_of(lambda s, x: 230.0 - s)
    assert (np.diff(profile.station) > 0.0).all()
    assert profile.station[0] == 200.0
    assert profile.station[-1] == 300.0
    np.testing.assert_allclose(profile.position[0], profile.station)
    np.testing.assert_allclose(profile.position[1], 7.5)


def test_open_parts_carry_nothing() -> None:
    profile = profile_of(lambda s, x: 230.0 - s)
    assert (profile.middle[profile.station > 230.0] == 0.0).all()


def test_a_profile_ends_where_contact_does_though_its_last_point_may_be_open_by_round_off() -> None:
    profile = profile_of(lambda s, x: np.where(s < 230.0 - 1e-9, 230.0 - s, 0.0))

    # of 41 points that are dense at the ends of 30 mm, the last but one is at 15 (1 - cos(pi / 40)) = 0.046 mm
    assert profile.station[profile.middle > 0.0].max() > 230.0 - 0.05
