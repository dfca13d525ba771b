"""Stiffness of one element, and its bubbles condensed onto its two nodes.

For constant curvature K = sum over a, b in {0, 1} of M_ab (axial) kron S_ab (section); degrees of freedom are ordered
node, node, bubbles along the rod, and for each of them the fields of the section. Everything is for unit Young's
modulus: the modulus only scales an element, so that rods of one shape share their elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rodmodel.axial import axial_matrices
from rodmodel.section import SectionStiffness
from rodmodel.triangular import cholesky, lower_solve

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
    n_axial, n_fields = order + 1, len(section.s00)
    # Rows (a, i), columns (b, j): the four terms in one product over the pairs of derivatives.
    axial = np.stack([0.5 * length * m00, m01, m01.T, 2.0 / length * m11]).reshape(4, -1)
    over_section = np.stack([section.s00, section.s01, section.s01.T, section.s11]).reshape(4, -1)
    product = (axial.T @ over_section).reshape(n_axial, n_axial, n_fields, n_fields)
    return product.transpose(0, 2, 1, 3).reshape(n_axial * n_fields, n_axial * n_fields)


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
    half = lower_solve(factor, coupling)
    return Element(length, nodal - half.T @ half, factor, half)
