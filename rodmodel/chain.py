"""A rod as a chain of condensed elements: block tridiagonal Cholesky factorisation in dense blocks.

Block Cholesky (Golub and Van Loan, Matrix Computations, section 4.5.1). The cost is linear in the number of elements.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rodmodel.section import Fields
from rodmodel.stiffness import Element
from rodmodel.triangular import cholesky, lower_solve, transposed_solve

Array = NDArray[np.float64]


class Chain:
    """Factorised stiffness of a rod on its nodes.

    A node carries the fields that both its elements have, the lower level where they differ: the higher fields of the
    other element vanish there, and the displacement is continuous. A held node carries none.

    Elimination begins at the clamp (at the start where neither or both ends are clamped), so that the free part, where
    contact mostly is, comes last: what contact changes or loads is a small part of the work.

    Parameters
    ----------
    elements : condensed elements from start to end, for unit modulus
    young_modulus : E of the rod, MPa
    clamped_start, clamped_end : whether all fields of the end section are held at zero
    previous : chain of the same rod; its factors are taken over as far as its elements are the same

    Attributes
    ----------
    elements : in the order of elimination
    ends : for each element, from start to end, its fields that the nodes before and after it carry
    rows : for each node, from start to end, its rows in arrays over all carried fields
    nodes : those that carry fields, in the order of elimination
    factors, links : diagonal and off-diagonal blocks of the factor, for unit modulus

    Raises
    ------
    numpy.linalg.LinAlgError
        if the rod is not held.
    """

    def __init__(
        self,
        elements: Sequence[Element],
        young_modulus: float,
        clamped_start: bool,
        clamped_end: bool,
        previous: Chain | None = None,
    ) -> None:
        carried = _carried_fields(elements, clamped_start, clamped_end)
        none = np.empty(0, dtype=np.int64)
        self.ends = [
            tuple(none if node is None else node.within(element.fields) for node in carried[index : index + 2])
            for index, element in enumerate(elements)
        ]
        counts = np.array([0 if node is None else node.count for node in carried])
        past = np.cumsum(counts)
        self.rows = [slice(int(end - count), int(end)) for end, count in zip(past, counts, strict=True)]
        self.size = int(past[-1])
        self._root = np.sqrt(young_modulus)

        backward = clamped_end and not clamped_start
        order = range(len(elements), -1, -1) if backward else range(len(elements) + 1)
        self.elements = tuple(reversed(elements)) if backward else tuple(elements)
        self.nodes = [node for node in order if counts[node]]
        self.factors: list[Array] = []
        self.links: list[Array] = []
        first = list(order).index(self.nodes[0]) if self.nodes else 0
        if previous is not None:
            pairs = list(zip(self.elements, previous.elements, strict=False))
            same = next((index for index, (own, other) in enumerate(pairs) if own is not other), len(pairs))
            # The factor of a node knows the elements on both its sides.
            kept = max(same - first, 0)
            self.factors, self.links = previous.factors[:kept], previous.links[: max(kept - 1, 0)]
        for node in self.nodes[len(self.factors) :]:
            block = np.zeros((counts[node], counts[node]))
            for element, side in ((node - 1, 1), (node, 0)):
                if 0 <= element < len(elements):
                    block += self._block(elements, element, side, side)
            if self.factors:
                near = node + 1 if backward else node - 1
                sides = (0, 1) if backward else (1, 0)
                coupling = self._block(elements, min(node, near), *sides)
                link = lower_solve(self.factors[-1], coupling.T).T
                block -= link @ link.T
                self.links.append(link)
            self.factors.append(cholesky(block))

    def _block(self, elements: Sequence[Element], index: int, row_side: int, column_side: int) -> Array:
        """Part of an element's condensed stiffness that couples its two nodes, or one with itself."""
        element = elements[index]
        count = element.fields.count
        rows, columns = self.ends[index][row_side], self.ends[index][column_side]
        block = element.condensed[row_side * count :, column_side * count :][:count, :count]
        if len(rows) == len(columns) == count:
            return block
        return np.asarray(block[rows[:, None], columns])

    def half_solve(self, loads: Array) -> Array:
        """L^-1 loads with K = L L^T, whose inner products are compliances; on the carried fields, shape (size, m)."""
        result = np.zeros_like(loads)
        before: Array | None = None
        for index, (node, factor) in enumerate(zip(self.nodes, self.factors, strict=True)):
            load = loads[self.rows[node]]
            if before is not None:
                load = load - self.links[index - 1] @ before
            elif not load.any():
                continue
            before = lower_solve(factor, load)
            np.divide(before, self._root, out=result[self.rows[node]])
        return result

    def back_solve(self, half: Array) -> Array:
        """L^-T half: displacements of the carried fields, shape (size, m)."""
        result = np.zeros_like(half)
        for index in reversed(range(len(self.nodes))):
            rows = self.rows[self.nodes[index]]
            load = half[rows]
            if index + 1 < len(self.nodes):
                load = load - self.links[index].T @ result[self.rows[self.nodes[index + 1]]]
            result[rows] = transposed_solve(self.factors[index], load)
        return np.asarray(result / self._root)


def _carried_fields(elements: Sequence[Element], clamped_start: bool, clamped_end: bool) -> list[Fields | None]:
    """Fields of every node from start to end; None where it is held."""
    fields = [element.fields for element in elements]
    lower = [min(pair, key=lambda own: own.level) for pair in pairwise(fields)]
    return [None if clamped_start else fields[0], *lower, None if clamped_end else fields[-1]]
