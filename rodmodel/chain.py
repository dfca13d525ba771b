"""A rod as a chain of condensed elements: block tridiagonal Cholesky factorisation in dense blocks.

Block Cholesky (Golub and Van Loan, Matrix Computations, section 4.5.1). The cost is linear in the number of elements.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from copy import copy
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rodmodel.holds import Free, restricted, within
from rodmodel.section import Fields
from rodmodel.stiffness import Element
from rodmodel.triangular import cholesky, lower_solve, transposed_solve

Array = NDArray[np.float64]


def node_fields(elements: Sequence[Element]) -> list[Fields]:
    """Fields of every node from start to end: those that both its elements have, the lower level where they differ.

    The higher fields of the other element vanish there, and the displacement is continuous.
    """
    fields = [element.fields for element in elements]
    lower = [min(pair, key=lambda own: own.level) for pair in pairwise(fields)]
    return [fields[0], *lower, fields[-1]]


class Chain:
    """Factorised stiffness of a rod on its nodes.

    Elimination begins at the end that is held more (at the start where both are alike), so that the free part, where
    contact mostly is, comes last: what contact changes or loads is a small part of the work.

    Parameters
    ----------
    elements : condensed elements from start to end, for unit modulus
    young_modulus : E of the rod, MPa
    free : by node, from 0 at the start, what is free of its fields, where not all of them are
    previous : chain of the same rod; its factors are taken over as far as its elements are the same

    Attributes
    ----------
    elements : in the order of elimination
    fields : of every node, from start to end
    ends : for each element, from start to end, what the nodes before and after it carry of the element's fields
    rows : for each node, from start to end, its rows in arrays over all that is carried
    nodes : those that carry anything, in the order of elimination
    factors, links : diagonal blocks of the factor, and what couples each with the one before (None where nothing
        does), for unit modulus
    root : square root of E

    Raises
    ------
    numpy.linalg.LinAlgError
        if the rod is not held.
    """

    def __init__(
        self,
        elements: Sequence[Element],
        young_modulus: float,
        free: Mapping[int, Free],
        previous: Chain | None = None,
    ) -> None:
        fields = self.fields = node_fields(elements)
        self.ends = [
            (_carried(fields, index, element, free), _carried(fields, index + 1, element, free))
            for index, element in enumerate(elements)
        ]
        counts = [free[node].shape[-1] if node in free else each.count for node, each in enumerate(fields)]
        past = np.cumsum(counts)
        self.rows = [slice(int(end - count), int(end)) for end, count in zip(past, counts, strict=True)]
        self.size = int(past[-1])
        self.root = np.sqrt(young_modulus)

        backward = fields[-1].count - counts[-1] > fields[0].count - counts[0]
        order = range(len(elements), -1, -1) if backward else range(len(elements) + 1)
        self.elements = tuple(reversed(elements)) if backward else tuple(elements)
        self.nodes = [node for node in order if counts[node]]
        self.factors: list[Array] = []
        self.links: list[Array | None] = []
        if previous is not None:
            pairs = list(zip(self.elements, previous.elements, strict=False))
            same = next((index for index, (own, other) in enumerate(pairs) if own is not other), len(pairs))
            # The factor of a node knows the elements on both its sides.
            kept = sum(counts[node] > 0 for node in order[:same])
            self.factors, self.links = previous.factors[:kept], previous.links[:kept]
        for index, node in enumerate(self.nodes):
            if index < len(self.factors):
                continue
            block = np.zeros((counts[node], counts[node]))
            for element, side in ((node - 1, 1), (node, 0)):
                if 0 <= element < len(elements):
                    block += self._block(elements, element, side, side)
            link = None
            if index and abs(node - self.nodes[index - 1]) == 1:
                sides = (0, 1) if backward else (1, 0)
                coupling = self._block(elements, min(node, self.nodes[index - 1]), *sides)
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
        return restricted(restricted(block, rows).T, columns).T

    def with_modulus(self, young_modulus: float) -> Chain:
        """The same chain of a rod with another modulus (MPa): everything kept is for unit modulus."""
        chain = copy(self)
        chain.root = np.sqrt(young_modulus)
        return chain

    def half_solve(self, loads: Array) -> Array:
        """L^-1 loads with K = L L^T, whose inner products are compliances; on what is carried, shape (size, m).

        It takes the place of the loads: at these sizes a fresh array costs as much as the arithmetic.
        """
        before: Array | None = None
        for node, factor, link in zip(self.nodes, self.factors, self.links, strict=True):
            load = loads[self.rows[node]]
            if before is not None and link is not None:
                load -= link @ before
            elif not load.any():
                before = None
                continue
            before = lower_solve(factor, load)
            np.divide(before, self.root, out=load)
        return loads

    def back_solve(self, half: Array) -> Array:
        """L^-T half: displacements of what is carried, shape (size, m)."""
        result = np.zeros_like(half)
        for index in reversed(range(len(self.nodes))):
            rows = self.rows[self.nodes[index]]
            load = half[rows]
            link = self.links[index + 1] if index + 1 < len(self.nodes) else None
            if link is not None:
                load = load - link.T @ result[self.rows[self.nodes[index + 1]]]
            result[rows] = transposed_solve(self.factors[index], load)
        return np.asarray(result / self.root)


def _carried(fields: Sequence[Fields], node: int, element: Element, free: Mapping[int, Free]) -> Free:
    """What a node carries of the fields of an element beside it."""
    places = fields[node].within(element.fields)
    return within(free[node], places, element.fields.count) if node in free else places
