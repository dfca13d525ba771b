"""Contact in compliance form."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from rodmodel.contact import ActiveSet, ContactProblem, unilateral_contact


def random_problem(seed: int, n: int, rank: int, rigid: bool = False) -> ContactProblem:
    rng = np.random.default_rng(seed)
    root = rng.standard_normal((n, rank))
    gap, spring = rng.standard_normal(n), rng.uniform(0.5, 1e4, n)
    return ContactProblem(root @ root.T, gap, spring, np.empty((n, 0)), np.empty(0), np.full(n, rigid))


@settings(max_examples=200, deadline=None, derandomize=True)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 40), rank=st.integers(1, 40))
def test_forces_push_gaps_stay_open_and_one_of_them_is_zero(seed: int, n: int, rank: int) -> None:
    """Also where the compliance is singular: more contact points than the rods have freedoms."""
    problem = random_problem(seed, n, rank)
    found = unilateral_contact(problem)
    force = found.force
    opening = problem.gap + problem.compliance @ force + force / problem.spring
    scale = np.abs(problem.gap).max()
    assert found.outcome == "converged"
    assert (force >= 0.0).all()
    assert opening.min() > -1e-7 * scale  # round-off of a matrix with condition up to 1e6
    assert np.abs(force * opening).max() < 1e-7 * scale * max(force.max(), 1.0)


@pytest.mark.slow
@settings(max_examples=200, deadline=None, derandomize=True)
@given(seed=st.integers(0, 10**6), n=st.integers(1, 40), more=st.integers(2, 20))
def test_multipliers_leave_no_penetration(seed: int, n: int, more: int) -> None:
    problem = random_problem(seed, n, n + more, rigid=True)
    found = unilateral_contact(problem)
    opening = problem.gap + problem.compliance @ found.force
    scale = np.abs(problem.gap).max()
    assert found.outcome == "converged"
    assert (found.force >= 0.0).all()
    assert opening.min() > -1e-6 * scale  # what a hundred steps with springs as soft as 0.5 leave
    assert np.abs(found.force * opening).max() < 1e-6 * scale * max(found.force.max(), 1.0)


@pytest.mark.parametrize("penalty", [1e-1, 1e1, 1e3, 1e5])
def test_with_multipliers_the_forces_do_not_depend_on_the_springs(penalty: float) -> None:
    problem = random_problem(3, 12, 30, rigid=True)
    stiff = unilateral_contact(replace(problem, spring=np.full(12, 1e9))).force

    found = unilateral_contact(replace(problem, spring=np.full(12, penalty))).force

    np.testing.assert_allclose(found, stiff, atol=1e-5 * stiff.max())


@pytest.mark.parametrize("seed", range(10))
def test_the_solution_is_the_one_that_trying_every_set_finds(seed: int) -> None:
    problem = random_problem(seed, 8, 8)
    found = unilateral_contact(problem).force
    for choice in product([False, True], repeat=8):
        active = np.array(choice)
        force, _ = ActiveSet(active, problem).settled_forces()
        opening = problem.gap + problem.compliance @ force
        if (force[active] >= 0.0).all() and (opening[~active] >= 0.0).all():
            np.testing.assert_allclose(found, force, atol=1e-9)
            return
    pytest.fail("no set satisfies the conditions")


def test_faces_that_stay_apart_carry_nothing() -> None:
    problem = replace(random_problem(0, 5, 5), gap=np.ones(5))
    np.testing.assert_array_equal(unilateral_contact(problem).force, np.zeros(5))


def test_held_points_may_pull() -> None:
    stiff = ContactProblem(np.eye(2), np.array([1.0, -1.0]), np.full(2, 1e12), np.empty((2, 0)), np.empty(0), NO)
    force, _ = ActiveSet(np.array([True, True]), stiff).settled_forces()
    np.testing.assert_allclose(force, [-1.0, 1.0], rtol=1e-11)  # a spring of 1e12 against a compliance of 1


NO = np.array([False, False])


def floating(load: list[float], seed: int = 1) -> ContactProblem:
    """Twenty points under a loose bar, -1 <= x <= 1, pressed by a force and a moment on rigid motions 1 and x."""
    rng = np.random.default_rng(seed)
    root, x = rng.standard_normal((20, 6)), np.linspace(-1.0, 1.0, 20)
    motion = np.column_stack([np.ones(20), x])
    return ContactProblem(
        1e-3 * root @ root.T, np.full(20, 0.1), np.full(20, 1e5), motion, np.array(load), np.full(20, True)
    )


@pytest.mark.parametrize("load", [[-100.0, 0.0], [-100.0, 40.0], [-100.0, -99.0]])
def test_contact_alone_balances_a_loose_bar_that_is_pressed(load: list[float]) -> None:
    problem = floating(load)
    found = unilateral_contact(problem)
    opening = problem.gap + problem.compliance @ found.force + problem.motion @ found.motion
    assert found.outcome == "converged"
    np.testing.assert_allclose(problem.motion.T @ found.force, -problem.motion_load, atol=1e-7)
    assert opening.min() > -1e-9
    assert np.abs(found.force * opening).max() < 1e-6


@pytest.mark.parametrize("load", [[100.0, 0.0], [-100.0, 101.0]])
def test_a_loose_bar_that_is_lifted_or_tipped_over_is_not_held(load: list[float]) -> None:
    assert unilateral_contact(floating(load)).outcome.startswith("refused")
