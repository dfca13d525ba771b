"""A rod as a chain of condensed elements: block tridiagonal Cholesky factorisation in dense blocks.

Block Cholesky (Golub and Van Loan, Matrix Computations, section 4.5.1). The cost is linear in the number of elements.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from rodmodel.stiffness import Element
from rodmodel.triangular import cholesky, lower_solve, transposed_solve

Array = NDArray[np.float64]


class Chain:
    """Factorised stiffness of a rod on its nodes.

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
    elements, nodes : in the order of elimination; clamped nodes are left out
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
        n_fields = len(elements[0].condensed) // 2
        backward = clamped_end and not clamped_start
        first, second = slice(None, n_fields), slice(n_fields, None)
        near, far = (second, first) if backward else (first, second)
        self.elements = tuple(reversed(elements)) if backward else tuple(elements)
        self._root = np.sqrt(young_modulus)
        begin = 1 if clamped_start or clamped_end else 0
        end = len(elements) if clamped_start and clamped_end else len(elements) + 1
        steps = range(begin, end)
        self.nodes = [len(elements) - step if backward else step for step in steps]
        self.factors: list[Array] = []
        self.links: list[Array] = []
        if previous is not None:
            pairs = list(zip(self.elements, previous.elements, strict=False))
            same = next((index for index, (own, other) in enumerate(pairs) if own is not other), len(pairs))
            # The factor of a node knows the elements on both its sides.
            kept = max(same - begin, 0)
            self.factors, self.links = previous.factors[:kept], previous.links[: max(kept - 1, 0)]
        for step in steps[len(self.factors) :]:
            block = np.zeros((n_fields, n_fields))
            if step > 0:
                block += self.elements[step - 1].condensed[far, far]
            if step < len(elements):
                block += self.elements[step].condensed[near, near]
            if step > begin:
                link = lower_solve(self.factors[-1], self.elements[step - 1].condensed[near, far]).T
                block -= link @ link.T
                self.links.append(link)
            self.factors.append(cholesky(block))

    def half_solve(self, loads: Array) -> Array:
        """L^-1 loads with K = L L^T; its inner products are compliances.

        loads : on the nodes, shape (n_nodes, n_fields, m); those on clamped nodes do not matter
        """
        result = np.zeros_like(loads)
        before: Array | None = None
        for index, (node, factor) in enumerate(zip(self.nodes, self.factors, strict=True)):
            load = loads[node]
            if before is not None:
                load = load - self.links[index - 1] @ before
            elif not load.any():
                continue
            before = lower_solve(factor, load)
            np.divide(before, self._root, out=result[node])
        return result

    def back_solve(self, half: Array) -> Array:
        """L^-T half: displacements of the nodes, zero on clamped ones, shape (n_nodes, n_fields, m)."""
        result = np.zeros_like(half)
        for index in reversed(range(len(self.nodes))):
            load = half[self.nodes[index]]
            if index + 1 < len(self.nodes):
                load = load - self.links[index].T @ result[self.nodes[index + 1]]
            result[self.nodes[index]] = transposed_solve(self.factors[index], load)
        return np.asarray(result / self._root)
