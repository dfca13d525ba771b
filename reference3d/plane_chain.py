"""Direct solution of a chain of planes of nodes, in any of which unknowns may be held.

As in `factor`, the middle plane of a layer is eliminated first and the border planes then are block tridiagonal. Here
border planes may be held: some of their unknowns, or some combinations of them, are given; and where many layers are
alike, the plane between two of them is eliminated once for all such pairs, then that between two pairs, and so on, so
that a long helix costs little more than a short one. `factor` is for rods held at their ends alone, with many contact
forces.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from reference3d.factor import backward, cholesky, forward

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# pairs of layers that must be alike for one elimination to cost less than one for each
FEWEST_PAIRS = 3


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


@dataclass(frozen=True)
class Stretch:
    """Layers of which only the first and last plane are left.

    Attributes
    ----------
    which : kind of the stretch
    start, end : planes
    """

    which: int
    start: int
    end: int


@dataclass(frozen=True)
class Step:
    """Elimination of a plane from between two others; which : kind of the stretch from `start` to `end`."""

    which: int
    start: int
    inside: int
    end: int


@dataclass(frozen=True, eq=False)
class PlaneChain:
    """Factorised chain.

    Attributes
    ----------
    held : by number of the plane
    steps : eliminations of planes inside stretches, in their order
    middle, middle_coupling : L of the plane eliminated, and L^-1 K_(inside),(start, end), by kind of stretch
    stretches : what is left after these, one after the other
    border, border_coupling : L_k of the planes between stretches, both ends included, and L_k^-1 K_k,k+1
    """

    held: Mapping[int, HeldPlane]
    steps: tuple[Step, ...]
    middle: Mapping[int, Array]
    middle_coupling: Mapping[int, Array]
    stretches: tuple[Stretch, ...]
    border: tuple[Array, ...]
    border_coupling: tuple[Array, ...]


class _Condensed:
    """Kinds of stretches with their matrices on their two end planes, made when they are asked for."""

    def __init__(self, layer: Callable[[int], Array], kinds: int) -> None:
        self.layer, self.count = layer, kinds
        self.pair_of: dict[int, int] = {}
        self.half: dict[int, int] = {}
        self.middle: dict[int, Array] = {}
        self.coupling: dict[int, Array] = {}
        self.matrix: dict[int, Array] = {}

    def pair(self, which: int) -> int:
        """Kind of two stretches of a kind, one after the other."""
        if which not in self.pair_of:
            self.pair_of[which], self.half[self.count] = self.count, which
            self.count += 1
        return self.pair_of[which]

    def on_ends(self, which: int) -> Array:
        """Matrix of a kind of stretch on its first and last plane, shape (2 m, 2 m)."""
        if which not in self.matrix:
            if which in self.half:
                one = self.on_ends(self.half[which])
                size = len(one) // 2
                whole = np.zeros((3 * size, 3 * size))
                whole[: 2 * size, : 2 * size] += one
                whole[size:, size:] += one
            else:
                whole = self.layer(which)
            self.middle[which], self.coupling[which], self.matrix[which] = _condense(whole)
        return self.matrix[which]


def _merged(
    stretches: list[Stretch], condensed: _Condensed, held: Mapping[int, HeldPlane]
) -> tuple[list[Stretch], list[Step]]:
    """Neighbouring stretches of one kind joined in pairs, where there are enough of them."""
    pairs: list[int] = []
    index = 0
    while index + 1 < len(stretches):
        one, other = stretches[index : index + 2]
        alike = one.which == other.which and one.end not in held
        pairs += [index] * alike
        index += 2 if alike else 1
    often = Counter(stretches[index].which for index in pairs)
    chosen = {index for index in pairs if often[stretches[index].which] >= FEWEST_PAIRS}
    found: list[Stretch] = []
    steps: list[Step] = []
    for index, stretch in enumerate(stretches):
        if index in chosen:
            which, end = condensed.pair(stretch.which), stretches[index + 1].end
            found.append(Stretch(which, stretch.start, end))
            steps.append(Step(which, stretch.start, stretch.end, end))
        elif index - 1 not in chosen:
            found.append(stretch)
    return found, steps


def _plan(condensed: _Condensed, kind: IntArray, held: Mapping[int, HeldPlane]) -> tuple[list[Stretch], list[Step]]:
    """Stretches that are left when all that is worth it is joined, and the steps to there."""
    stretches = [Stretch(which, 2 * index, 2 * index + 2) for index, which in enumerate(kind.tolist())]
    steps = [Step(each.which, each.start, each.start + 1, each.end) for each in stretches]
    while True:
        stretches, joined = _merged(stretches, condensed, held)
        if not joined:
            return stretches, steps
        steps += joined


def factorise(layer: Callable[[int], Array], kind: IntArray, held: Mapping[int, HeldPlane]) -> PlaneChain:
    """Factorise a chain.

    Parameters
    ----------
    layer : matrix of a kind of layer by its number, start, middle and end plane one after the other, (3 m, 3 m)
    kind : of each layer, shape (n_layers,)
    held : by number of the plane; the even ones are borders of layers, which alone may be held

    Raises
    ------
    numpy.linalg.LinAlgError
        if the chain is not positive definite, as one that is not held.
    """
    condensed = _Condensed(layer, int(kind.max()) + 1)
    stretches, steps = _plan(condensed, kind, held)
    last = {each.which: index for index, each in enumerate(stretches)}
    border, border_coupling = [], []
    carried: Array | None = None
    for index, stretch in enumerate(stretches):
        block = condensed.on_ends(stretch.which)
        if last[stretch.which] == index:
            condensed.matrix.pop(stretch.which)
        size = len(block) // 2
        first, across, second = block[:size, :size], block[:size, size:], block[size:, size:]
        start, end = held.get(stretch.start), held.get(stretch.end)
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
    if stretches[-1].end in held:
        _hold(carried, held[stretches[-1].end].fixed)
    border.append(cholesky(carried.T))
    return PlaneChain(
        held,
        tuple(steps),
        condensed.middle,
        condensed.coupling,
        tuple(stretches),
        tuple(border),
        tuple(border_coupling),
    )


def factor_bytes(unknowns: int, kind: IntArray, held: Mapping[int, HeldPlane]) -> float:
    """Memory that factorising a chain takes at its largest.

    Parameters
    ----------
    unknowns : m, of a plane
    kind, held : of `factorise`
    """
    stretches, steps = _plan(_Condensed(lambda _: np.empty((0, 0)), int(kind.max()) + 1), kind, held)
    # two matrices a stretch, three a kind and four while it waits; one layer's matrix with its blocks
    return 8.0 * unknowns**2 * (2.0 * len(stretches) + 7.0 * len({step.which for step in steps}) + 16.0)


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
    size = force.shape[1]
    for number, plane in chain.held.items():
        state[number] = plane.into(state[number])

    def into(number: int, values: Array) -> Array:
        return chain.held[number].into(values) if number in chain.held else values

    for step in chain.steps:
        state[step.inside] = forward(chain.middle[step.which], state[step.inside])
        reduced = chain.middle_coupling[step.which].T @ state[step.inside]
        state[step.start] -= into(step.start, reduced[:size])
        state[step.end] -= into(step.end, reduced[size:])
    for stretch, factor, coupling in zip(chain.stretches, chain.border[:-1], chain.border_coupling, strict=True):
        state[stretch.start] = forward(factor, state[stretch.start])
        state[stretch.end] -= coupling.T @ state[stretch.start]
    last = chain.stretches[-1].end
    state[last] = backward(chain.border[-1], forward(chain.border[-1], state[last]))
    for stretch, factor, coupling in zip(
        chain.stretches[::-1], chain.border[-2::-1], chain.border_coupling[::-1], strict=True
    ):
        state[stretch.start] = backward(factor, state[stretch.start] - coupling @ state[stretch.end])
    for number, plane in chain.held.items():
        state[number] = plane.out_of(state[number])
    for step in chain.steps[::-1]:
        borders = np.concatenate([state[step.start], state[step.end]])
        coupling = chain.middle_coupling[step.which]
        state[step.inside] = backward(chain.middle[step.which], state[step.inside] - coupling @ borders)
    return state


def compliance(chain: PlaneChain, loads: csr_array) -> Array:
    """Work of every load on the displacement of every other, by elimination alone, with all that is held at zero.

    loads : N, one a row, shape (n_loads, n_planes m); the result is N mm, shape (n_loads, n_loads)
    """
    size = chain.border[0].shape[0]
    count = loads.shape[0]
    result = np.zeros((count, count))
    # by plane: loads that reach it, ascending, and their forces there, shape (m, n)
    waiting: dict[int, tuple[IntArray, Array]] = {}

    def into(plane: int, force: Array) -> Array:
        return chain.held[plane].into(force) if plane in chain.held else force

    def put(plane: int, which: IntArray, force: Array) -> None:
        if plane in waiting:
            before, already = waiting[plane]
            every = np.union1d(before, which)
            together = np.zeros((size, len(every)), order="F")
            together[:, np.searchsorted(every, before)] = already
            together[:, np.searchsorted(every, which)] += force
            which, force = every, together
        waiting[plane] = which, force

    def taken(plane: int, factor: Array) -> tuple[IntArray, Array]:
        which, force = waiting.pop(plane)
        state = forward(factor, force)
        if len(which) == count:
            result[:] += state.T @ state
        else:
            result[np.ix_(which, which)] += state.T @ state
        return which, state

    by_plane = loads.tocsc()
    for plane in np.unique(by_plane.tocoo().coords[1] // size).tolist():
        part = by_plane[:, plane * size : (plane + 1) * size]
        which = np.unique(part.tocoo().coords[0]).astype(np.int64)
        put(plane, which, into(plane, np.asfortranarray(part.tocsr()[which].toarray().T)))
    for step in chain.steps:
        if step.inside in waiting:
            which, state = taken(step.inside, chain.middle[step.which])
            reduced = chain.middle_coupling[step.which].T @ state
            put(step.start, which, into(step.start, -reduced[:size]))
            put(step.end, which, into(step.end, -reduced[size:]))
    for stretch, factor, coupling in zip(chain.stretches, chain.border[:-1], chain.border_coupling, strict=True):
        if stretch.start in waiting:
            which, state = taken(stretch.start, factor)
            put(stretch.end, which, -(coupling.T @ state))
    if waiting:
        taken(chain.stretches[-1].end, chain.border[-1])
    return result
