"""From the differences between steps to all that further levels would add."""

import numpy as np
import pytest

from rodmodel.remaining import USUAL, fitted_power, remaining_errors


@pytest.mark.parametrize("power", [0.7, 1.0, 1.9])
def test_three_levels_tell_an_error_that_falls_by_a_power(power):
    levels = [2, 4, 6]
    values = np.array([[1.0 + level**-power, 5.0 - 3.0 * level**-power] for level in levels])

    errors, found = remaining_errors(levels, values)

    np.testing.assert_allclose(found, power, rtol=1e-9)
    np.testing.assert_allclose(errors, [6**-power, 3.0 * 6**-power], rtol=1e-9)


def test_two_levels_take_the_usual_power():
    values = np.array([[1.0 + level**-USUAL] for level in (2, 4)])

    errors, _ = remaining_errors([2, 4], values)

    np.testing.assert_allclose(errors, 4**-USUAL, rtol=1e-12)


def test_nothing_is_known_of_a_single_step_or_a_goal_that_has_just_appeared():
    assert np.isinf(remaining_errors([2], np.array([[1.0]]))[0]).all()
    assert np.isinf(remaining_errors([2, 4], np.array([[np.nan], [1.0]]))[0]).all()


def test_a_difference_that_happens_to_vanish_is_not_believed():
    values = np.array([[1.0, 1.0], [1.1, 1.1], [1.1, 1.14]])

    errors, _ = remaining_errors([2, 4, 6], values)

    assert errors[0] > 0.1 * errors[1]


def test_differences_that_do_not_fall_leave_a_large_error():
    values = np.array([[1.0], [2.0], [3.0]])

    errors, power = remaining_errors([2, 4, 6], values)

    assert power == 0.5
    assert errors[0] > 1.0


def test_fitted_power_stays_within_its_limits():
    assert fitted_power([2, 4, 6], 0.0) == USUAL
    assert fitted_power([2, 4, 6], 10.0) == 0.5
