"""Where a sampled pressure profile says that contact starts and ends."""

from __future__ import annotations

import numpy as np
import pytest

from reports.contact_edges import contact_stretches, edge_resolution

LIMITS = (0.0, 100.0)


def hertz(station: np.ndarray, centre: float, half_width: float) -> np.ndarray:
    """p / p0 of a cylinder on a half space."""
    return np.sqrt(np.maximum(0.0, 1.0 - ((station - centre) / half_width) ** 2))


@pytest.mark.parametrize("centre", [50.0, 50.13, 49.71, 50.37])
def test_edges_of_a_hertz_profile_are_found_far_inside_the_station_spacing(centre: float) -> None:
    spacing = 1.0
    station = np.arange(0.0, 100.0 + spacing / 2, spacing)

    ((start, end),) = contact_stretches(station, hertz(station, centre, 12.0), LIMITS)

    # p^2 is a parabola here; a straight line through its last two stations misses its zero by at most
    # spacing^2 / half width = 0.083 mm (distances d <= spacing and spacing more, curvature 1 / half_width).
    assert start == pytest.approx(centre - 12.0, abs=spacing**2 / 12.0)
    assert end == pytest.approx(centre + 12.0, abs=spacing**2 / 12.0)


def test_edges_converge_with_the_square_of_the_spacing() -> None:
    errors = []
    for spacing in (1.0, 0.5, 0.25, 0.125):
        # the edges stay at the same place between two stations, so that the errors are comparable
        station = np.arange(0.0, 100.0 + spacing / 2, spacing)
        centre = 50.0 + 0.4 * spacing
        ((_, end),) = contact_stretches(station, hertz(station, centre, 12.0), LIMITS)
        errors.append(abs(end - centre - 12.0))

    rates = np.log2(np.array(errors[:-1]) / errors[1:])

    # the next term of the error is of third order: at these spacings it adds up to 0.06 to the rate
    assert rates == pytest.approx(2.0, abs=0.1)


def test_contact_up_to_the_end_of_the_zone_ends_there() -> None:
    station = np.linspace(0.0, 100.0, 101)
    pressure = np.where(station <= 20.5, 5.0 - 0.2 * station, 0.0)

    ((start, end),) = contact_stretches(station, pressure, LIMITS)

    assert start == 0.0
    assert 20.0 <= end <= 21.0


def test_pressure_that_rises_to_a_rods_corner_ends_at_the_corner() -> None:
    station = np.linspace(0.0, 100.0, 101)
    pressure = np.where((station >= 30.5) & (station <= 40.0), 45.0 - station, 0.0)

    ((start, _),) = contact_stretches(station, pressure, (30.2, 100.0))

    assert start == 30.2


def test_an_edge_is_never_beyond_the_next_open_station() -> None:
    station = np.array([0.0, 1.0, 2.0, 3.0, 4.0, 5.0])
    slowly_falling = np.array([0.0, 1.0, 0.999, 0.998, 0.0, 0.0])

    ((start, end),) = contact_stretches(station, slowly_falling, (0.0, 5.0))

    assert end == 4.0
    assert start == 0.5  # the pressure does not fall towards this edge: half way


def test_a_repeated_station_counts_once_with_its_larger_pressure() -> None:
    station = np.array([0.0, 1.0, 2.0, 2.0, 3.0, 4.0])
    pressure = np.array([0.0, 3.0, 2.0, 0.0, 0.0, 0.0])

    stretches = contact_stretches(station, pressure, (0.0, 4.0))

    assert stretches == ((0.5, pytest.approx(2.0 + 4.0 / (9.0 - 4.0))),)


def test_two_stretches_are_reported_apart() -> None:
    station = np.linspace(0.0, 100.0, 401)
    pressure = hertz(station, 20.0, 5.0) + hertz(station, 70.0, 8.0)

    stretches = contact_stretches(station, pressure, LIMITS)

    # (spacing 0.25 mm)^2 over the half width
    assert np.ravel(stretches) == pytest.approx([15.0, 25.0, 62.0, 78.0], abs=0.25**2 / 5.0)


def test_a_weak_single_station_inside_the_zone_is_flicker() -> None:
    station = np.linspace(0.0, 100.0, 101)
    pressure = hertz(station, 20.0, 5.0)
    pressure[60] = 0.005

    assert len(contact_stretches(station, pressure, LIMITS)) == 1


def test_a_strong_single_station_is_a_stretch_between_the_midpoints() -> None:
    station = np.linspace(0.0, 100.0, 101)
    pressure = np.zeros_like(station)
    pressure[60] = 7.0

    assert contact_stretches(station, pressure, LIMITS) == ((59.5, 60.5),)


def test_no_pressure_means_no_stretch() -> None:
    station = np.linspace(0.0, 100.0, 11)

    assert contact_stretches(station, np.zeros_like(station), LIMITS) == ()


def test_an_edge_is_as_sharp_as_the_stations_around_it() -> None:
    station = np.array([0.0, 1.0, 2.0, 4.0, 8.0])

    assert edge_resolution(station, ((0.0, 2.5),), (0.0, 8.0)) == 2.0
    assert edge_resolution(station, ((0.5, 2.5),), (0.0, 8.0)) == 2.0
    assert edge_resolution(station, ((0.5, 8.0),), (0.0, 8.0)) == 1.0


def test_an_edge_at_the_end_of_the_zone_is_exact() -> None:
    assert edge_resolution(np.array([0.0, 1.0, 2.0]), ((0.0, 2.0),), (0.0, 2.0)) == 0.0


def test_an_edge_on_a_station_may_lie_on_either_side() -> None:
    assert edge_resolution(np.array([0.0, 1.0, 3.0, 4.0]), ((0.0, 1.0),), (0.0, 4.0)) == 3.0
