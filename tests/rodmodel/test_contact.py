"""Contact in compliance form."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rodmodel.contact import forces_on, unilateral_contact


def random_problem(seed: int, n: int, rank: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((n, rank))
    return root @ root.T, rng.standard_normal(n), rng.uniform(0.5, 1e4, n)


@settings(max_examples=200, deadline=None, derandomize=True)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 40), rank=st.integers(1, 40))
def test_forces_push_gaps_stay_open_and_one_of_them_is_zero(seed: int, n: int, rank: int) -> None:
    """Also where the compliance is singular: more contact points than the rods have freedoms."""
    compliance, gap, spring = random_problem(seed, n, rank)
    force = unilateral_contact(compliance, gap, spring)
    opening = gap + compliance @ force + force / spring
    scale = np.abs(gap).max()
    assert (force >= 0.0).all()
    assert opening.min() > -1e-7 * scale  # round-off of a matrix with condition up to 1e6
    assert np.abs(force * opening).max() < 1e-7 * scale * max(force.max(), 1.0)


@pytest.mark.parametrize("seed", range(10))
def test_the_solution_is_the_one_that_trying_every_set_finds(seed: int) -> None:
    compliance, gap, spring = random_problem(seed, 8, 8)
    found = unilateral_contact(compliance, gap, spring)
    for choice in product([False, True], repeat=8):
        active = np.array(choice)
        force = forces_on(active, compliance, gap, spring)
        opening = gap + compliance @ force
        if (force[active] >= 0.0).all() and (opening[~active] >= 0.0).all():
            np.testing.assert_allclose(found, force, atol=1e-9)
            return
    pytest.fail("no set satisfies the conditions")


def test_faces_that_stay_apart_carry_nothing() -> None:
    compliance, _, spring = random_problem(0, 5, 5)
    np.testing.assert_array_equal(unilateral_contact(compliance, np.ones(5), spring), np.zeros(5))


def test_held_points_may_pull() -> None:
    force = forces_on(np.array([True, True]), np.eye(2), np.array([1.0, -1.0]), np.full(2, 1e12))
    np.testing.assert_allclose(force, [-1.0, 1.0], rtol=1e-11)  # a spring of 1e12 against a compliance of 1
