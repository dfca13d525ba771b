"""The active set on the compliance of contact points."""

import numpy as np
import pytest

from reference3d.peers.ngsolve_contact import contact_forces


@pytest.mark.parametrize("seed", range(20))
def test_forces_push_where_springs_are_pressed_and_nowhere_else(seed):
    random = np.random.default_rng(seed)
    factor = random.normal(size=(30, 12))
    compliance = factor @ factor.T  # of few unknowns and many points, hence singular
    distance = random.normal(size=30)
    stiffness = 10.0 ** random.uniform(0.0, 6.0, 30)

    force, outcome = contact_forces(compliance, distance, stiffness)

    gap = distance + compliance @ force
    scale = np.abs(compliance).max() * force.max()
    assert outcome == "converged"
    assert (force >= 0.0).all()
    assert gap == pytest.approx(np.where(force > 0.0, -force / stiffness, np.maximum(gap, 0.0)), abs=1e-9 * scale)


def test_no_force_where_all_points_stay_apart():
    force, outcome = contact_forces(np.eye(3), np.array([0.1, 0.0, 2.0]), np.ones(3))

    assert outcome == "converged"
    assert not force.any()
