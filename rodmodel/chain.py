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

    Parameters
    ----------
    elements : condensed elements from start to end, for unit modulus
    young_modulus : E of the rod, MPa
    clamped_start, clamped_end : whether all fields of the end section are held at zero

    Raises
    ------
    numpy.linalg.LinAlgError
        if the rod is not held.
    """

    def __init__(
        self, elements: Sequence[Element], young_modulus: float, clamped_start: bool, clamped_end: bool
    ) -> None:
        n_fields = len(elements[0].condensed) // 2
        n_nodes = len(elements) + 1
        self.first_free = 1 if clamped_start else 0
        self.past_free = n_nodes - 1 if clamped_end else n_nodes
        diagonal = np.zeros((n_nodes, n_fields, n_fields))
        for index, element in enumerate(elements):
            diagonal[index] += element.condensed[:n_fields, :n_fields]
            diagonal[index + 1] += element.condensed[n_fields:, n_fields:]
        self._root = np.sqrt(young_modulus)
        self._factors: list[Array] = []
        self._links: list[Array] = []
        for node in range(self.first_free, self.past_free):
            block = diagonal[node]
            if node > self.first_free:
                below = elements[node - 1].condensed[n_fields:, :n_fields]
                link = lower_solve(self._factors[-1], below.T).T
                block = block - link @ link.T
                self._links.append(link)
            self._factors.append(cholesky(block))

    def half_solve(self, loads: Array) -> Array:
        """L^-1 loads with K = L L^T; its inner products are compliances.

        loads : on the nodes, shape (n_nodes, n_fields, m); those on clamped nodes do not matter
        """
        result = np.zeros_like(loads)
        for index, factor in enumerate(self._factors):
            node = self.first_free + index
            load = loads[node] if index == 0 else loads[node] - self._links[index - 1] @ result[node - 1]
            result[node] = lower_solve(factor, load)
        return np.asarray(result / self._root)

    def back_solve(self, half: Array) -> Array:
        """L^-T half: displacements of the nodes, zero on clamped ones, shape (n_nodes, n_fields, m)."""
        result = np.zeros_like(half)
        for index in reversed(range(len(self._factors))):
            node = self.first_free + index
            load = half[node]
            if index + 1 < len(self._factors):
                load = load - self._links[index].T @ result[node + 1]
            result[node] = transposed_solve(self._factors[index], load)
        return np.asarray(result / self._root)

    def solve(self, loads: Array) -> Array:
        """K^-1 loads, shape (n_nodes, n_fields, m)."""
        return self.back_solve(self.half_solve(loads))
