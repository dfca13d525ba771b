"""Grid convergence on manufactured sequences."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from reference3d.uncertainty import grid_convergence

SIZES = (6.0, 3.0, 2.0)


@given(
    order=st.floats(0.3, 6.0),
    error=st.floats(-1.0, 1.0).filter(lambda error: abs(error) > 1e-3),
    sizes=st.sampled_from([SIZES, (4.0, 2.0, 1.0), (1.69, 1.3, 1.0)]),
)
def test_order_and_limit_of_a_power_law_are_found(order, error, sizes):
    values = tuple(5.0 + error * (size / sizes[0]) ** order for size in sizes)

    found = grid_convergence(values, sizes, formal_order=order)

    # differences as small as 1e-3 x 6^-6 of values of 5 carry round-off of 1e-8
    assert found.behaviour == "monotone"
    assert found.observed_order == pytest.approx(order, rel=1e-4)
    assert found.extrapolated == pytest.approx(5.0, abs=1e-6)
    assert found.uncertainty == pytest.approx(1.25 * abs(found.value - 5.0), rel=1e-3)


# three times the change covers orders down to ln(4/3) / ln(3) = 0.262 on these sizes
@given(order=st.floats(0.27, 8.0), formal=st.floats(0.3, 4.0))
def test_the_band_covers_the_limit_of_every_power_law(order, formal):
    values = tuple(5.0 + size**order / 6.0**order for size in SIZES)

    found = grid_convergence(values, SIZES, formal)

    # 1e-9: round-off in the differences of values of 5
    assert abs(found.value - 5.0) <= found.uncertainty + 1e-9


def test_an_order_above_the_formal_one_is_not_trusted():
    values = tuple(5.0 + size**4 for size in SIZES)

    trusted = grid_convergence(values, SIZES, formal_order=4.0)
    capped = grid_convergence(values, SIZES, formal_order=1.5)

    assert capped.observed_order == pytest.approx(4.0)
    assert capped.extrapolated == pytest.approx(5.0)
    assert capped.uncertainty > 3.0 * trusted.uncertainty
    # thrice the error that the larger change implies: from the coarse mesh to the next
    assert capped.uncertainty == pytest.approx(3.0 * (6.0**4 - 3.0**4) / (3.0**1.5 - 1.5**1.5))


@pytest.mark.parametrize(("order", "factor"), [(1.85, 1.25), (1.75, 3.0)])
def test_an_order_far_from_the_formal_one_is_less_certain(order, factor):
    found = grid_convergence(tuple(5.0 + size**order for size in SIZES), SIZES, formal_order=2.0)

    assert found.uncertainty == pytest.approx(factor * 2.0**order)


def test_a_last_change_that_is_small_by_chance_does_not_make_the_band_small():
    by_chance = grid_convergence((1.0, 1.1, 1.1 + 1e-6), SIZES, 2.0)

    # 0.1 = C (6^2 - 3^2), and 3 C 2^2
    assert by_chance.uncertainty == pytest.approx(3.0 * 4.0 * 0.1 / 27.0)
    assert by_chance.extrapolated == pytest.approx(by_chance.value, abs=1e-6)


def test_oscillation_is_said_and_gives_three_times_the_spread():
    found = grid_convergence((1.0, 1.2, 1.1), SIZES, 2.0)

    assert (found.behaviour, found.asymptotic) == ("oscillatory", False)
    assert found.uncertainty == pytest.approx(0.6)
    assert found.extrapolated == found.value
    assert math.isnan(found.observed_order)


def test_growing_differences_are_called_diverging():
    found = grid_convergence((1.0, 1.1, 1.4), SIZES, 2.0)

    assert (found.behaviour, found.asymptotic) == ("diverging", False)
    assert found.uncertainty == pytest.approx(1.2)


def test_slow_convergence_is_not_extrapolated():
    values = tuple(5.0 + size**0.4 for size in SIZES)

    found = grid_convergence(values, SIZES, 2.0)

    assert (found.behaviour, found.asymptotic) == ("monotone", False)
    assert found.extrapolated == found.value
    assert found.uncertainty == pytest.approx(3.0 * (6.0**0.4 - 2.0**0.4))


def test_a_change_on_the_last_mesh_only_is_called_diverging():
    assert grid_convergence((1.0, 1.0, 1.1), SIZES, 2.0).behaviour == "diverging"


@pytest.mark.parametrize("value", [0.0, 300.0])
def test_equal_values_are_constant(value):
    found = grid_convergence((value, value, value), SIZES, 2.0)

    assert (found.behaviour, found.asymptotic, found.uncertainty) == ("constant", True, 0.0)


@pytest.mark.parametrize(
    ("values", "sizes", "order", "sentence"),
    [
        ((1.0, 2.0, 3.0), (1.0, 2.0, 3.0), 2.0, "fall from coarse to fine"),
        ((1.0, 2.0, 3.0), SIZES, 0.0, "a positive order"),
        ((1.0, math.nan, 3.0), SIZES, 2.0, "must be finite"),
    ],
)
def test_misuse_is_refused(values, sizes, order, sentence):
    with pytest.raises(ValueError, match=sentence):
        grid_convergence(values, sizes, order)
