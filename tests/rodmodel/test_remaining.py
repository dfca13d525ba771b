"""From the energy that fields of each degree hold to what all further levels would add."""

import numpy as np
import pytest

from rodmodel.remaining import BELIEVED, Share, fitted_power


def falling(power: float, level: int) -> np.ndarray:
    """Energies by degree, pairs added up, of a solution whose error at level k is k^-power."""
    error = np.arange(2, level + 1, 2.0) ** -power
    by_degree = np.zeros(level + 1)
    by_degree[4::2] = -np.diff(error)
    return by_degree


@pytest.mark.parametrize("power", [0.7, 2.0, 5.0])
def test_two_pairs_of_degrees_tell_the_power_of_an_error_that_falls_by_one(power):
    last, before = falling(power, 6)[[6, 4]]

    # as near as the powers tried lie
    assert fitted_power(6, last / before) == pytest.approx(power, abs=0.01)


def test_a_known_power_tells_what_is_left_over():
    share = Share(8, falling(2.0, 8), near=True, usual=2.0, least=2.0, most=2.0)

    assert share.left_at(8) == pytest.approx(8**-2.0, rel=1e-12)
    assert share.left_at(10) == pytest.approx(10**-2.0, rel=1e-12)


def test_of_a_power_above_one_only_a_part_is_believed():
    share = Share(6, falling(5.0, 6), near=False, usual=4.0, least=1.0, most=8.0)

    assert share.power == pytest.approx(1.0 + BELIEVED * 4.0, abs=0.01)
    assert share.left_at(6) > 6**-5.0


def test_level_4_tells_no_power_yet():
    share = Share(4, falling(5.0, 4), near=False, usual=3.0, least=1.0, most=8.0)

    assert share.power == 3.0


def test_energy_that_does_not_fall_leaves_the_least_power():
    constant = np.ones(7)

    assert Share(6, constant, near=False, usual=4.0, least=1.0, most=8.0).power == 1.0


def test_nothing_is_said_of_elements_left_at_the_lowest_level():
    assert Share(2, np.ones(3), near=False, usual=4.0, least=1.0, most=8.0).left_at(2) == 0.0
