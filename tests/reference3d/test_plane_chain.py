"""The chain of planes against a dense solution of the same equations."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from reference3d.plane_chain import HeldPlane, combinations_held, compliance, factorise, solve

SIZE, KIND = 5, np.array([0, 1, *[0] * 9, 2, *[0] * 6])
FIXED = np.arange(SIZE) < 2


@pytest.fixture
def layers():
    """Matrices of three kinds of layers that resist every motion a little."""
    rng = np.random.default_rng(3)
    roots = rng.standard_normal((3, 3 * SIZE, 3 * SIZE))
    return roots @ roots.transpose(0, 2, 1) + np.eye(3 * SIZE)


@pytest.fixture
def whole(layers):
    """The whole chain as a dense matrix."""
    matrix = np.zeros(((2 * len(KIND) + 1) * SIZE,) * 2)
    for layer, kind in enumerate(KIND):
        block = slice(2 * layer * SIZE, (2 * layer + 3) * SIZE)
        matrix[block, block] += layers[kind]
    return matrix


@pytest.mark.parametrize("borders", [(), (0,), (18,), (0, 7, 18), (1, 2)])
@pytest.mark.parametrize("combined", [False, True])
def test_held_unknowns_and_combinations_are_zero_and_all_others_in_balance(layers, whole, borders, combined):
    rng = np.random.default_rng(5)
    rows = rng.standard_normal((2, SIZE)) if combined else np.eye(SIZE)[:2]
    plane = combinations_held(rows) if combined else HeldPlane(None, FIXED)
    force = rng.standard_normal((2 * len(KIND) + 1, SIZE, 3))

    found = solve(
        factorise(lambda kind: layers[kind], KIND, dict.fromkeys((2 * border for border in borders), plane)), force
    )

    # dense, with a Lagrange multiplier for every held combination
    constraints = np.zeros((2 * len(borders), len(whole)))
    for number, border in enumerate(borders):
        constraints[2 * number : 2 * number + 2, 2 * border * SIZE : (2 * border + 1) * SIZE] = rows
    full = np.block([[whole, constraints.T], [constraints, np.zeros((len(constraints),) * 2)]])
    right = np.concatenate([force.reshape(-1, 3), np.zeros((len(constraints), 3))])
    np.testing.assert_allclose(found.reshape(-1, 3), np.linalg.solve(full, right)[: len(whole)], atol=1e-11)


def test_what_is_alike_is_eliminated_once(layers):
    asked = []

    chain = factorise(lambda kind: asked.append(kind) or layers[kind], np.zeros(37, dtype=int), {})

    # 37 layers are 18 pairs and one, these 9 pairs, these 4 and one; one pair of those would not be worth it
    assert asked == [0]
    assert len(chain.middle) == 4
    assert [stretch.end - stretch.start for stretch in chain.stretches] == [16, 16, 16, 16, 8, 2]


def test_a_chain_that_is_not_held_is_refused(layers):
    singular = layers[0].copy()
    singular[:] = 0.0
    singular[SIZE : 2 * SIZE, SIZE : 2 * SIZE] = np.eye(SIZE)

    with pytest.raises(np.linalg.LinAlgError, match="positive definite"):
        factorise(lambda _: singular, np.zeros(2, dtype=int), {})


@pytest.mark.parametrize("borders", [(), (0, 18), (0, 7, 18)])
@pytest.mark.parametrize("combined", [False, True])
def test_compliance_is_the_work_of_loads_on_displacements(layers, borders, combined):
    rng = np.random.default_rng(7)
    plane = combinations_held(rng.standard_normal((2, SIZE))) if combined else HeldPlane(None, FIXED)
    chain = factorise(lambda kind: layers[kind], KIND, dict.fromkeys((2 * border for border in borders), plane))
    planes = 2 * len(KIND) + 1
    loads = np.zeros((6, planes, SIZE))
    for load, (start, end) in zip(loads, [(0, 1), (4, 7), (36, 37), (13, 16), (5, 6), (20, 30)], strict=True):
        load[start:end] = rng.standard_normal((end - start, SIZE))

    found = compliance(chain, csr_array(loads.reshape(6, -1)))

    moved = solve(chain, np.moveaxis(loads, 0, 2))
    np.testing.assert_allclose(found, loads.reshape(6, -1) @ moved.reshape(-1, 6), atol=1e-11)
