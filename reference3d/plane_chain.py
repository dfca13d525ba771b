"""Direct solution of a chain of planes of nodes, in any of which unknowns may be held.

As in `factor`, the middle plane of a layer is eliminated first and the border planes then are block tridiagonal. Here
border planes may be held: some of their unknowns, or some combinations of them, are given. `factor` is for rods held
at their ends alone, with many contact forces.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference3d.factor import backward, cholesky, forward

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class HeldPlane:
    """What of a plane's m unknowns is held.

    Attributes
    ----------
    basis : orthonormal columns of new unknowns, shape (m, m); None for the plane's own
    fixed : which of these are zero, shape (m,)
    """

    basis: Array | None
    fixed: BoolArray

    def into(self, values: Array) -> Array:
        """The plane's values as new unknowns, those fixed zero; shape (m, any)."""
        found = values.copy() if self.basis is None else self.basis.T @ values
        found[self.fixed] = 0.0
        return found

    def out_of(self, values: Array) -> Array:
        """New unknowns as the plane's own."""
        return values if self.basis is None else self.basis @ values


def combinations_held(rows: Array) -> HeldPlane:
    """The plane on which given combinations of unknowns are zero, shape (n_held, m)."""
    basis = np.linalg.qr(rows.T, mode="complete").Q
    return HeldPlane(np.ascontiguousarray(basis), np.arange(rows.shape[1]) < len(rows))


@dataclass(frozen=True, eq=False)
class PlaneChain:
    """Factorised chain.

    Attributes
    ----------
    kind : of each layer
    held : by number of the border plane
    middle, middle_coupling : L_m of K_mm = L_m L_m^T, and L_m^-1 K_m,(start, end), for each kind
    border, border_coupling : L_k of the border planes, last one included, and L_k^-1 K_k,k+1
    """

    kind: IntArray
    held: Mapping[int, HeldPlane]
    middle: tuple[Array, ...]
    middle_coupling: tuple[Array, ...]
    border: tuple[Array, ...]
    border_coupling: tuple[Array, ...]


def factorise(layer: Callable[[int], Array], kind: IntArray, held: Mapping[int, HeldPlane]) -> PlaneChain:
    """Factorise a chain.

    Parameters
    ----------
    layer : matrix of a kind of layer by its number, start, middle and end plane one after the other, (3 m, 3 m)
    kind : of each layer, shape (n_layers,)
    held : by number of the border plane

    Raises
    ------
    numpy.linalg.LinAlgError
        if the chain is not positive definite, as one that is not held.
    """
    condensed: dict[int, Array] = {}
    middle: dict[int, Array] = {}
    coupling_of: dict[int, Array] = {}
    last = {int(which): index for index, which in enumerate(kind)}
    border, border_coupling = [], []
    carried: Array | None = None
    for index, which in enumerate(kind.tolist()):
        if which not in condensed:
            middle[which], coupling_of[which], condensed[which] = _condense(layer(which))
        block = condensed[which] if last[which] > index else condensed.pop(which)
        size = len(block) // 2
        first, across, second = block[:size, :size], block[:size, size:], block[size:, size:]
        start, end = held.get(index), held.get(index + 1)
        if start is not None and start.basis is not None:
            first, across = start.basis.T @ first @ start.basis, start.basis.T @ across
        if end is not None and end.basis is not None:
            across, second = across @ end.basis, end.basis.T @ second @ end.basis
        own = first.copy() if carried is None else first + carried
        across = np.array(across, order="F")
        if start is not None:
            _hold(own, start.fixed)
            across[start.fixed] = 0.0
        if end is not None:
            across[:, end.fixed] = 0.0
        factor = cholesky(own.T)  # symmetric; in the order that LAPACK takes
        coupling = forward(factor, across)
        carried = second - coupling.T @ coupling
        border.append(factor)
        border_coupling.append(coupling)
    assert carried is not None  # there is at least one layer
    if len(kind) in held:
        _hold(carried, held[len(kind)].fixed)
    border.append(cholesky(carried.T))
    kinds = sorted(middle)
    return PlaneChain(
        np.searchsorted(kinds, kind).astype(np.int64),
        held,
        tuple(middle[each] for each in kinds),
        tuple(coupling_of[each] for each in kinds),
        tuple(border),
        tuple(border_coupling),
    )


def factor_bytes(unknowns: int, layers: int, kinds: int) -> float:
    """Memory that factorising a chain takes at its largest.

    Parameters
    ----------
    unknowns : m, of a plane
    layers, kinds : how many there are
    """
    # two matrices a border plane, three a kind and four while it waits; one layer's matrix with its blocks
    return 8.0 * unknowns**2 * (2.0 * layers + 7.0 * kinds + 16.0)


def _condense(matrix: Array) -> tuple[Array, Array, Array]:
    """L_m, L_m^-1 K_m,(start, end) and the matrix condensed onto start and end."""
    size = len(matrix) // 3
    ends, inside = np.r_[:size, 2 * size : 3 * size], slice(size, 2 * size)
    # symmetric, so that transposes are what LAPACK takes without turning them round
    factor = cholesky(matrix[inside, inside].T)
    coupling = forward(factor, matrix[ends, inside].T)
    return factor, coupling, matrix[np.ix_(ends, ends)] - coupling.T @ coupling


def _hold(matrix: Array, fixed: BoolArray) -> None:
    matrix[fixed] = 0.0
    matrix[:, fixed] = 0.0
    places = np.flatnonzero(fixed)
    matrix[places, places] = 1.0


def solve(chain: PlaneChain, force: Array) -> Array:
    """Displacements under several loads, with all that is held at zero.

    force : N, shape (n_planes, m, n_loads); what acts on held unknowns has no effect. The result is mm, likewise.
    """
    state = force.copy()
    for number, plane in chain.held.items():
        state[2 * number] = plane.into(state[2 * number])
    size = force.shape[1]

    def into(number: int, values: Array) -> Array:
        return chain.held[number].into(values) if number in chain.held else values

    def out_of(number: int, values: Array) -> Array:
        return chain.held[number].out_of(values) if number in chain.held else values

    for layer, which in enumerate(chain.kind):
        start, inside, end = 2 * layer, 2 * layer + 1, 2 * layer + 2
        state[inside] = forward(chain.middle[which], state[inside])
        reduced = chain.middle_coupling[which].T @ state[inside]
        state[start] = forward(chain.border[layer], state[start] - into(layer, reduced[:size]))
        state[end] -= into(layer + 1, reduced[size:]) + chain.border_coupling[layer].T @ state[start]
    state[-1] = out_of(len(chain.kind), backward(chain.border[-1], forward(chain.border[-1], state[-1])))
    for layer in range(len(chain.kind) - 1, -1, -1):
        which = chain.kind[layer]
        start, inside, end = 2 * layer, 2 * layer + 1, 2 * layer + 2
        beyond = state[end]
        if layer + 1 in chain.held:
            plane = chain.held[layer + 1]
            beyond = beyond if plane.basis is None else plane.basis.T @ beyond
        state[start] = out_of(
            layer, backward(chain.border[layer], state[start] - chain.border_coupling[layer] @ beyond)
        )
        borders = np.concatenate([state[start], state[end]])
        state[inside] = backward(chain.middle[which], state[inside] - chain.middle_coupling[which] @ borders)
    return state
