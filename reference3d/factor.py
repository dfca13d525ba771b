"""Direct solution of a row of layers: block Cholesky factorisation from one end to the other.

The middle plane of a layer touches only its two border planes, so it is eliminated first; the border planes
then form a block tridiagonal matrix. All work is on dense blocks (LAPACK), and layers of one kind share the
elimination of their middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dtrsm
from scipy.linalg.lapack import dpotrf
from scipy.sparse import csc_array

from reference3d.elasticity import LayeredStiffness

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class LayeredFactor:
    """Factorised stiffness; planes are counted in the order of elimination.

    Attributes
    ----------
    reverse : True if that order runs from the rod's end to its start
    kind : kind of each layer
    middle : L_m of K_mm = L_m L_m^T for each kind
    middle_coupling : L_m^-1 K_m,(start, end) for each kind
    border : L_k of the border planes, last plane included
    border_coupling : L_k^-1 K_k,k+1
    """

    reverse: bool
    kind: IntArray
    middle: tuple[Array, ...]
    middle_coupling: tuple[Array, ...]
    border: tuple[Array, ...]
    border_coupling: tuple[Array, ...]

    @property
    def plane_size(self) -> int:
        """Unknowns of one plane, m."""
        return len(self.border[0])


def cholesky(matrix: Array) -> Array:
    """L of a symmetric matrix L L^T; numpy.linalg.LinAlgError if it is not positive definite."""
    factor, info = dpotrf(matrix, lower=1, clean=1)
    if info != 0:
        raise np.linalg.LinAlgError("the stiffness is not positive definite")
    return np.asarray(factor)


def forward(factor: Array, right_side: Array) -> Array:
    """L^-1 times the right sides, the columns."""
    return np.asarray(dtrsm(1.0, factor, right_side, lower=1))


def backward(factor: Array, right_side: Array) -> Array:
    """L^-T times the right sides, the columns."""
    return np.asarray(dtrsm(1.0, factor, right_side, lower=1, trans_a=1))


def _condense(blocks: list[list[Array]], clamped: tuple[bool, bool]) -> tuple[Array, Array, Array]:
    """Eliminate the middle of a layer whose 3 x 3 blocks are given in the order of elimination.

    Returns L_m, L_m^-1 K_m,(first, last) and the stiffness condensed onto the first and last plane. A clamped
    plane does not couple and gets the identity, so that its displacement is zero under zero force.
    """
    size = len(blocks[1][1])
    factor = cholesky(blocks[1][1])
    coupling = forward(factor, np.concatenate([blocks[1][0], blocks[1][2]], axis=1))
    for position, is_clamped in enumerate(clamped):
        if is_clamped:
            coupling[:, position * size : (position + 1) * size] = 0.0
    condensed = -(coupling.T @ coupling)
    condensed[:size, :size] += np.eye(size) if clamped[0] else blocks[0][0]
    condensed[size:, size:] += np.eye(size) if clamped[1] else blocks[2][2]
    if not any(clamped):
        condensed[:size, size:] += blocks[0][2]
    return factor, coupling, condensed


def factorise(
    stiffness: LayeredStiffness, free: IntArray, clamped_start: bool, clamped_end: bool, reverse: bool
) -> LayeredFactor:
    """Factorise the stiffness of a supported rod.

    Parameters
    ----------
    free : unknowns of a plane that are not zero everywhere by symmetry; the factor knows these alone
    clamped_start, clamped_end : whether all unknowns of the first and last plane are zero
    reverse : start the elimination at the rod's end; choose it so that contact comes last, which makes
        `compliance` cheap

    Raises
    ------
    numpy.linalg.LinAlgError
        if the stiffness is not positive definite in double precision.
    """
    size, full, layers = len(free), stiffness.plane_size, len(stiffness.kind)
    kind = stiffness.kind[::-1] if reverse else stiffness.kind
    clamped_first, clamped_last = (clamped_end, clamped_start) if reverse else (clamped_start, clamped_end)
    # a layer at a clamp is a kind of its own
    key = np.stack([kind, np.zeros(layers, dtype=np.int64), np.zeros(layers, dtype=np.int64)])
    key[1, 0], key[2, -1] = clamped_first, clamped_last
    different, kind = np.unique(key, axis=1, return_inverse=True)
    order = (2, 1, 0) if reverse else (0, 1, 2)
    parts = []
    for which, at_first, at_last in different.T:
        matrix = stiffness.matrices[which]
        blocks = [[matrix[np.ix_(full * row + free, full * column + free)] for column in order] for row in order]
        parts.append(_condense(blocks, (bool(at_first), bool(at_last))))
    middle, middle_coupling, condensed = zip(*parts, strict=True)
    border, border_coupling = [], []
    carried = np.zeros((size, size))
    for which in kind:
        block = condensed[which]
        factor = cholesky(block[:size, :size] + carried)
        coupling = forward(factor, block[:size, size:])
        carried = block[size:, size:] - coupling.T @ coupling
        border.append(factor)
        border_coupling.append(coupling)
    border.append(cholesky(carried))
    return LayeredFactor(
        reverse,
        kind.astype(np.int64),
        tuple(middle),
        tuple(middle_coupling),
        tuple(border),
        tuple(border_coupling),
    )


def layered_bytes(plane_size: int, unknowns: int, layers: int, kinds: int) -> float:
    """Memory that the stiffness of a rod and its factor take at their largest.

    Parameters
    ----------
    plane_size, unknowns : unknowns of a plane, all of them and those not zero by symmetry
    layers, kinds : number of layers, and of different thicknesses among them
    """
    # one matrix of three planes a kind; of each kind and the two at clamps seven blocks, of each layer two, and some
    # while one is worked on
    return 8.0 * (9.0 * kinds * plane_size**2 + (7.0 * (kinds + 2.0) + 2.0 * layers + 12.0) * unknowns**2)


def solve(factor: LayeredFactor, force: Array) -> Array:
    """Displacement under nodal forces.

    force : N, of the free unknowns, zero on clamped planes, shape (n_planes, m); the result, mm, likewise
    """
    size = factor.plane_size
    state = (force[::-1] if factor.reverse else force).copy()[:, :, None]
    for layer, which in enumerate(factor.kind):
        start, inside, end = 2 * layer, 2 * layer + 1, 2 * layer + 2
        coupling = factor.middle_coupling[which]
        state[inside] = forward(factor.middle[which], state[inside])
        reduced = coupling.T @ state[inside]
        state[start] = forward(factor.border[layer], state[start] - reduced[:size])
        state[end] -= reduced[size:] + factor.border_coupling[layer].T @ state[start]
    state[-1] = backward(factor.border[-1], forward(factor.border[-1], state[-1]))
    for layer in range(len(factor.kind) - 1, -1, -1):
        which = factor.kind[layer]
        start, inside, end = 2 * layer, 2 * layer + 1, 2 * layer + 2
        state[start] = backward(factor.border[layer], state[start] - factor.border_coupling[layer] @ state[end])
        borders = np.concatenate([state[start], state[end]])
        state[inside] = backward(factor.middle[which], state[inside] - factor.middle_coupling[which] @ borders)
    result = state[:, :, 0]
    return result[::-1].copy() if factor.reverse else result


def compliance(factor: LayeredFactor, forces: csc_array) -> Array:
    """Work of every load on the displacement of every other, F^T K^-1 F, by forward elimination alone.

    Parameters
    ----------
    forces : F, one load a column, N, on the free unknowns, zero on clamped planes,
        shape (n_planes m, n_loads)

    Returns
    -------
    matrix : N mm, shape (n_loads, n_loads)
    """
    size, planes = factor.plane_size, 2 * len(factor.kind) + 1
    entries = forces.tocoo()
    plane, unknown = np.divmod(entries.coords[0], size)
    plane = planes - 1 - plane if factor.reverse else plane
    count = forces.shape[1]
    reached = np.full(count, planes)
    np.minimum.at(reached, entries.coords[1], plane)
    # columns in the order in which the elimination reaches them, so that those not reached yet cost nothing
    order = np.argsort(reached, kind="stable")
    rank = np.empty(count, dtype=np.int64)
    rank[order] = np.arange(count)
    loads = csc_array((entries.data, (plane * size + unknown, rank[entries.coords[1]])), shape=forces.shape).tocsr()
    known = np.searchsorted(reached[order], np.arange(planes), side="right")

    result = np.zeros((count, count))
    carried = np.zeros((size, 0))
    for layer, which in enumerate(factor.kind):
        active = int(known[2 * layer + 1])
        if active == 0:
            continue
        start = _rows(loads, 2 * layer, size, active)
        start[:, : carried.shape[1]] += carried
        carried = np.zeros((size, active), order="F")
        inside = loads[(2 * layer + 1) * size : (2 * layer + 2) * size]
        columns = np.unique(inside.indices)
        if len(columns):
            state = forward(factor.middle[which], inside[:, columns].toarray())
            reduced = factor.middle_coupling[which].T @ state
            start[:, columns] -= reduced[:size]
            carried[:, columns] -= reduced[size:]
            result[np.ix_(columns, columns)] += state.T @ state
        state = forward(factor.border[layer], start)
        carried -= factor.border_coupling[layer].T @ state
        result[:active, :active] += state.T @ state
    last = _rows(loads, planes - 1, size, count)
    last[:, : carried.shape[1]] += carried
    state = forward(factor.border[-1], last)
    result += state.T @ state
    return np.asarray(result[np.ix_(rank, rank)])


def _rows(loads: csc_array, plane: int, size: int, columns: int) -> Array:
    return np.asarray(loads[plane * size : (plane + 1) * size, :columns].toarray(order="F"))
