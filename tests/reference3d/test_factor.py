"""Block Cholesky of a row of layers, against dense solutions."""

import numpy as np
import pytest
from scipy.sparse import csc_array, random_array

from cases.scene import Material
from reference3d.elasticity import LayeredStiffness
from reference3d.factor import compliance, factorise, layered_bytes, solve

ENDS = [(True, False), (False, True), (True, True)]


@pytest.fixture
def stiffness(layered_box, graded_borders):
    return layered_box(graded_borders, Material(1.0, 0.3))


def free_unknowns(stiffness, free, clamped_start, clamped_end):
    """Which unknowns of the whole body are not fixed, and which of the factor's they are."""
    planes, size = 2 * len(stiffness.kind) + 1, stiffness.plane_size
    in_plane = np.zeros((planes, size), dtype=bool)
    in_plane[:, free] = True
    in_plane[0] &= not clamped_start
    in_plane[-1] &= not clamped_end
    return in_plane


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(("clamped_start", "clamped_end"), ENDS)
def test_displacements_are_those_of_a_dense_solution(stiffness, dense_matrix, clamped_start, clamped_end, reverse):
    free = np.arange(stiffness.plane_size)[5:]
    unfixed = free_unknowns(stiffness, free, clamped_start, clamped_end)
    force = np.where(unfixed, np.random.default_rng(1).normal(size=unfixed.shape), 0.0)
    rows = unfixed.ravel()
    expected = np.zeros(unfixed.shape)
    expected[unfixed] = np.linalg.solve(dense_matrix(stiffness)[np.ix_(rows, rows)], force[unfixed])

    factor = factorise(stiffness, free, clamped_start, clamped_end, reverse)
    found = solve(factor, force[:, free])

    np.testing.assert_allclose(found, expected[:, free], atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("reverse", [False, True])
@pytest.mark.parametrize(("clamped_start", "clamped_end"), ENDS)
def test_compliance_is_the_work_of_loads_on_displacements(stiffness, clamped_start, clamped_end, reverse):
    free = np.arange(stiffness.plane_size)
    unfixed = free_unknowns(stiffness, free, clamped_start, clamped_end)
    loads = random_array((unfixed.size, 12), density=0.01, rng=np.random.default_rng(2)).toarray()
    loads[~unfixed.ravel()] = 0.0
    loads[:, 3] = 0.0  # a load that acts nowhere
    factor = factorise(stiffness, free, clamped_start, clamped_end, reverse)
    displacements = np.stack([solve(factor, load.reshape(unfixed.shape)).ravel() for load in loads.T], axis=1)
    expected = loads.T @ displacements

    found = compliance(factor, csc_array(loads))

    np.testing.assert_allclose(found, expected, atol=1e-12 * np.abs(expected).max())


def test_a_stiffness_that_is_not_positive_definite_is_refused(stiffness):
    flipped = LayeredStiffness(-stiffness.matrices, stiffness.kind)

    with pytest.raises(np.linalg.LinAlgError, match="not positive definite"):
        factorise(flipped, np.arange(stiffness.plane_size), True, False, reverse=False)


def test_the_memory_of_a_factor_is_foreseen(stiffness):
    size, layers = stiffness.plane_size, len(stiffness.kind)

    factor = factorise(stiffness, np.arange(size), True, False, reverse=False)

    groups = (factor.middle, factor.middle_coupling, factor.border, factor.border_coupling)
    kept = stiffness.matrices.nbytes + sum(block.nbytes for group in groups for block in group)
    foreseen = layered_bytes(size, size, layers, len(stiffness.matrices))
    # besides, the condensed matrix of every kind, a second clamped kind, and what a layer takes while it is worked on
    assert kept <= foreseen <= kept + 8.0 * size**2 * (4.0 * len(factor.middle) + 7.0 + 12.0)
