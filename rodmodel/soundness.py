"""How many digits a solution of a rod has lost to round-off, told from the solution itself.

Two things are lost. The elements' matrices are rounded, so that a rigid motion of an element, which ought to need no
force, needs some; and the chain's factors are rounded, so that forces made from displacements do not give these back
(N. J. Higham, Accuracy and Stability of Numerical Algorithms, 2002, sections 7.1 and 10.1). Both are magnified by the
condition of the rod: where there are very many or very short elements, its bending stiffness stands beside element
stiffnesses larger by the square of (length of the rod / length of the element) and more.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import CentreLine, Section
from rodmodel.assembly import AssembledRod
from rodmodel.centre_line import centre_points, constant_turnings, frames
from rodmodel.holds import extended, restricted
from rodmodel.resultants import rigid_motions
from rodmodel.section import Fields, axial_modulus

Array = NDArray[np.float64]

# Relative error of displacements by round-off from which on a solution is worth a warning.
WORTH_A_WARNING = 1e-6
# What an element may leave out of rigid motions, of their size, for a force by them to be round-off.
UNSEEN = 1e-16
# Singular values of rigid motions below this, of the largest, are zero.
NO_MOTION = 1e-12


def lost_accuracy(assembled: AssembledRod, coefficients: Sequence[Array]) -> float:
    """Relative error of the displacements of a rod that round-off has made, as an estimate; 0 for a rod at rest.

    Costs a product with each condensed element and one solution, linear in their number. Elements that turn so far
    that polynomials along them hold rigid motions only nearly count with what the factors lose alone.

    Parameters
    ----------
    coefficients : degrees of freedom of every element, shape (order + 1, n_fields) each
    """
    chain = assembled.chain
    carried = np.zeros(chain.size)
    for index, values in enumerate(coefficients):
        for side in (0, 1):
            carried[chain.rows[index + side]] = restricted(values[side], chain.ends[index][side])
    size = float(np.abs(carried).max(initial=0.0))
    if size == 0.0:
        return 0.0
    force = np.zeros((chain.size, 1))
    for kind in _alike(assembled):
        element = assembled.elements[kind[0]]
        count = element.fields.count
        own, given = np.zeros((2, len(kind), 2, count))
        for place, index in enumerate(kind):
            given[place] = coefficients[index][:2]
            for side in (0, 1):
                at_node = carried[chain.rows[index + side], None]
                own[place, side] = extended(at_node, chain.ends[index][side], count)[:, 0]
        internal = (own.reshape(len(kind), -1) + _rigid_part(assembled, kind[0], given)) @ element.condensed
        for place, index in enumerate(kind):
            for side, nodal in enumerate(internal[place].reshape(2, count)):
                force[chain.rows[index + side], 0] += restricted(nodal, chain.ends[index][side])
    # The factors are for unit Young's modulus, solutions by them for the rod's.
    again = chain.back_solve(chain.half_solve(force))[:, 0] * axial_modulus(assembled.rod.material)
    return float(np.abs(again - carried).max() / size)


def lost_digits(error: float) -> int:
    """Decimal digits, of the 16 that numbers have, that are lost where the relative error is this."""
    return 0 if error <= 0.0 else max(0, math.ceil(16.0 + math.log10(error)))


def _alike(assembled: AssembledRod) -> list[list[int]]:
    """Numbers of the elements that share one matrix."""
    kinds: dict[int, list[int]] = {}
    for index, element in enumerate(assembled.elements):
        kinds.setdefault(id(element), []).append(index)
    return list(kinds.values())


def _rigid_part(assembled: AssembledRod, index: int, nodal: Array) -> Array:
    """Rigid motions nearest to displacements of an element's nodes; zero where its order does not hold them.

    nodal : of elements like number `index`, shape (n, 2, n_fields); the result has shape (n, 2 n_fields)
    """
    flat = nodal.reshape(len(nodal), -1)
    element, line = assembled.elements[index], assembled.rod.centre_line
    turning = constant_turnings(line, assembled.borders[index : index + 2])[0]
    if turning is None or _left_out(math.hypot(*turning) * element.length, element.order) > UNSEEN:
        return np.zeros_like(flat)
    start, end = assembled.borders[index : index + 2].tolist()
    kept = _rigid_basis(line, assembled.rod.section, element.fields, start, end)
    return np.asarray((flat @ kept.T) @ kept)


@lru_cache(maxsize=64)
def _rigid_basis(line: CentreLine, section: Section, fields: Fields, start: float, end: float) -> Array:
    """Orthonormal rigid motions of the nodes of an element between two stations, shape (n_motions, 2 n_fields)."""
    borders = np.array([start, end])
    points, local = centre_points(line, borders), rigid_motions(section, fields)
    # About the start: there rotations displace nothing, at the end they move the centre by axis x arm.
    a1, a2, a3 = points[:, 1] - points[:, 0]
    by_arm = np.array([[0.0, -a3, a2], [a3, 0.0, -a1], [-a2, a1, 0.0]])
    at_start, at_end = (np.kron(np.eye(2), axes.T) @ local for axes in frames(line, borders))
    at_end[3:] += by_arm @ at_end[:3]
    basis = np.linalg.svd(np.concatenate([at_start, at_end], axis=1), full_matrices=False)
    # Symmetry leaves some motions out.
    return np.asarray(basis.Vh[NO_MOTION * basis.S[0] < basis.S])


def _left_out(angle: float, order: int) -> float:
    """What polynomials of an order leave out of the cosine or sine of angles over a range, at most (Chebyshev)."""
    return 2.0 * (0.25 * angle) ** (order + 1) / math.factorial(order + 1)
