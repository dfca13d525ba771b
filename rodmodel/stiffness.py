"""Stiffness of one element, and its bubbles condensed onto its two nodes.

For constant curvature K = sum over a, b in {0, 1} of M_ab (axial) kron S_ab (section); degrees of freedom are ordered
node, node, bubbles along the rod, and for each of them the fields of the section. Everything is for unit Young's
modulus: the modulus only scales an element, so that rods of one shape share their elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import get_lapack_funcs, solve_triangular

from rodmodel.axial import axial_matrices
from rodmodel.section import SectionStiffness

Array = NDArray[np.float64]


def element_stiffness(length: float, order: int, section: SectionStiffness) -> Array:
    """Stiffness matrix of an element, shape ((order + 1) n_fields, (order + 1) n_fields).

    Parameters
    ----------
    length : of the element, mm
    order : polynomial order p along the rod
    section : S_ab
    """
    m00, m01, m11 = axial_matrices(order)
    mixed = np.kron(m01, section.s01)
    return (
        np.kron(0.5 * length * m00, section.s00) + mixed + mixed.T + np.kron(2.0 / length * m11, section.s11)
    )


@dataclass(frozen=True, eq=False)
class Element:
    """An element with condensed bubbles; n_nodal = 2 n_fields, n_bubbles = (order - 1) n_fields.

    Attributes
    ----------
    length : mm
    condensed : K_nn - K_nb K_bb^-1 K_bn, shape (n_nodal, n_nodal)
    bubble_factor : lower Cholesky factor of K_bb, shape (n_bubbles, n_bubbles)
    half_coupling : bubble_factor^-1 K_bn, shape (n_bubbles, n_nodal)
    """

    length: float
    condensed: Array
    bubble_factor: Array
    half_coupling: Array


def condensed_element(length: float, order: int, section: SectionStiffness) -> Element:
    """Element of a given length (mm) with its bubbles eliminated."""
    stiffness = element_stiffness(length, order, section)
    n_nodal = 2 * len(section.s00)
    nodal, coupling, bubbles = (
        stiffness[:n_nodal, :n_nodal],
        stiffness[n_nodal:, :n_nodal],
        stiffness[n_nodal:, n_nodal:],
    )
    factor = cholesky(bubbles)
    half = solve_triangular(factor, coupling, lower=True, check_finite=False)
    return Element(length, nodal - half.T @ half, factor, half)


def cholesky(matrix: Array) -> Array:
    """Lower Cholesky factor; LinAlgError where the matrix is not positive definite."""
    (potrf,) = get_lapack_funcs(("potrf",), (matrix,))
    factor, info = potrf(matrix, lower=True, clean=True)
    if info != 0:
        raise np.linalg.LinAlgError(f"stiffness not positive definite at row {info}")
    return np.asarray(factor)
