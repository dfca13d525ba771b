"""Stiffness of one element, and its bubbles condensed onto its two nodes.

For constant curvature K = sum over a, b in {0, 1} of M_ab (axial) kron S_ab (section); where curvature varies, the
sum of such products over the points of a quadrature along the element. Degrees of freedom are ordered node, node,
bubbles along the rod, and for each of them the fields of the section. Everything is for unit Young's modulus: the
modulus only scales an element, so that rods of one shape share their elements.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rodmodel.axial import axial_matrices, gauss, shape_function_slopes, shape_functions
from rodmodel.section import Fields, SectionStiffness, W
from rodmodel.triangular import cholesky, lower_solve, transposed_solve

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Points along an element beyond those that its order needs where section matrices vary: what these add to the degree.
EXTRA_POINTS = 4


def stiffness_terms(order: int, section: SectionStiffness) -> Array:
    """K_0, K_1, K_2 of the element stiffness K = L/2 K_0 + K_1 + 2/L K_2 with L its length.

    Shape (3, n, n) with n = (order + 1) n_fields: M_00 kron S_00, M_01 kron S_01 and its transpose, M_11 kron S_11.
    """
    m00, m01, m11 = axial_matrices(order)
    n_axial, n_fields = len(m00), len(section.s00)
    terms = np.empty((3, n_axial, n_fields, n_axial, n_fields))
    for term, axial, over_section in zip(terms, (m00, m01, m11), (section.s00, section.s01, section.s11), strict=True):
        np.multiply(axial[:, None, :, None], over_section[:, None, :], out=term)
    terms[1] += terms[1].transpose(2, 3, 0, 1).copy()
    return terms.reshape(3, n_axial * n_fields, n_axial * n_fields)


@dataclass(frozen=True, eq=False)
class BubbleFactor:
    """Cholesky factor of K_bb, block diagonal after a permutation.

    Attributes
    ----------
    groups : degrees of freedom of each block
    blocks : lower factor of each block
    """

    groups: tuple[IntArray, ...]
    blocks: tuple[Array, ...]

    def half_solve(self, right: Array) -> Array:
        """L^-1 right, group after group, shape (n_bubbles, m)."""
        parts = [lower_solve(block, right[group]) for group, block in zip(self.groups, self.blocks, strict=True)]
        return np.concatenate(parts)

    def back_solve(self, half: Array) -> Array:
        """L^-T half in the order of the degrees of freedom, shape (n_bubbles, m)."""
        result = np.empty_like(half)
        start = 0
        for group, block in zip(self.groups, self.blocks, strict=True):
            result[group] = transposed_solve(block, half[start : start + len(group)])
            start += len(group)
        return result


@dataclass(frozen=True, eq=False)
class Element:
    """An element with condensed bubbles; n_nodal = 2 n_fields, n_bubbles = (order - 1) n_fields.

    Attributes
    ----------
    fields, order : of its displacement over the section and along the rod
    length : mm
    section : its section stiffness; at the points of its quadrature where it varies along the element
    condensed : K_nn - K_nb K_bb^-1 K_bn, shape (n_nodal, n_nodal)
    bubbles : L of K_bb = L L^T
    half_coupling : L^-1 K_bn, shape (n_bubbles, n_nodal)
    """

    fields: Fields
    order: int
    length: float
    section: SectionStiffness
    condensed: Array
    bubbles: BubbleFactor
    half_coupling: Array


@dataclass(frozen=True, eq=False)
class ElementFamily:
    """All elements of one section and order: their stiffness terms, cut into the blocks that condensation needs.

    Attributes
    ----------
    fields, order : of the displacement over the section and along the rod
    section : what the terms were made from
    groups : bubbles that couple with one another alone
    nodal : terms of K_nn, shape (3, n_nodal, n_nodal)
    coupling : terms of K_bn by group, shape (3, n_group, n_nodal) each
    bubbles : terms of K_bb by group, shape (3, n_group, n_group) each
    """

    fields: Fields
    order: int
    section: SectionStiffness
    groups: tuple[IntArray, ...]
    nodal: Array
    coupling: tuple[Array, ...]
    bubbles: tuple[Array, ...]


def element_family(order: int, fields: Fields, section: SectionStiffness, reversible: bool) -> ElementFamily:
    """Terms of the elements of a rod with constant curvature.

    reversible : the rod looks the same from both ends, as one does whose frame does not turn about t. Bubbles even
        along the element for u and v and odd for w then do not couple with the others: K_bb falls into two blocks.
    """
    terms = stiffness_terms(order, section)
    n_nodal = 2 * fields.count
    parity = np.add.outer(np.arange(2, order + 1), fields.table[0] == W).ravel() % 2 * reversible
    groups = tuple(group for group in (np.flatnonzero(parity == 0), np.flatnonzero(parity == 1)) if len(group))
    rows = [n_nodal + group for group in groups]
    return ElementFamily(
        fields,
        order,
        section,
        groups,
        np.ascontiguousarray(terms[:, :n_nodal, :n_nodal]),
        tuple(np.ascontiguousarray(terms[:, row, :n_nodal]) for row in rows),
        tuple(np.ascontiguousarray(terms[:, row][:, :, row]) for row in rows),
    )


def condensed_element(family: ElementFamily, length: float) -> Element:
    """Element of a given length (mm) with its bubbles eliminated."""
    scale = np.array([0.5 * length, 1.0, 2.0 / length])

    def at_length(terms: Array) -> Array:
        return np.asarray((scale @ terms.reshape(3, -1)).reshape(terms.shape[1:]))

    factor = BubbleFactor(family.groups, tuple(cholesky(at_length(terms)) for terms in family.bubbles))
    half = np.concatenate(
        [lower_solve(block, at_length(terms)) for block, terms in zip(factor.blocks, family.coupling, strict=True)]
    )
    condensed = at_length(family.nodal) - half.T @ half
    return Element(family.fields, family.order, length, family.section, condensed, factor, half)


def length_slope(element: Element, first: Array, second: Array) -> Array:
    """Derivatives of first . K second by the length of an element of constant section stiffness, for unit modulus.

    Of m first ones, shape (m,).

    first, second : degrees of freedom, shape (order + 1, n_fields, m) and (order + 1, n_fields), that stay where they
        are on the element
    """
    m00, _, m11 = axial_matrices(element.order)
    growing, falling = m00 @ second @ element.section.s00, m11 @ second @ element.section.s11
    change = 0.5 * growing - 2.0 / element.length**2 * falling
    return np.asarray(change.ravel() @ first.reshape(change.size, -1))


def axial_quadrature(order: int, left: float, right: float, knots: Array) -> tuple[Array, Array]:
    """Points xi in [-1, 1] and weights along an element whose section matrices vary smoothly between knots.

    Gauss rules between the knots, each exact for its share of the order and 2 `EXTRA_POINTS` degrees more.

    Parameters
    ----------
    left, right : ends of the element, arc length, mm
    knots : along the whole line, mm, ascending
    """
    within = knots[(knots > left) & (knots < right)]
    borders = np.concatenate([[-1.0], (2.0 * within - left - right) / (right - left), [1.0]])
    half = 0.5 * np.diff(borders)
    rules = [gauss(int(np.ceil(order * share)) + 1 + EXTRA_POINTS) for share in half]
    points = [start + share * (1.0 + xi) for start, share, (xi, _) in zip(borders, half, rules, strict=False)]
    return np.concatenate(points), np.concatenate([share * w for share, (_, w) in zip(half, rules, strict=True)])


def varying_element(
    order: int, fields: Fields, length: float, quadrature: tuple[Array, Array], section: SectionStiffness
) -> Element:
    """Element whose section matrices vary along it, with its bubbles eliminated.

    Parameters
    ----------
    length : mm
    quadrature : points xi in [-1, 1] and weights, shape (n,) each (`axial_quadrature`)
    section : S_ab at these points, shape (n, n_fields, n_fields) each
    """
    stiffness = varying_stiffness(order, length, quadrature, section)
    n_nodal = 2 * fields.count
    bubbles = (np.arange(len(stiffness) - n_nodal),)
    factor = BubbleFactor(bubbles, (cholesky(stiffness[n_nodal:, n_nodal:]),))
    half = lower_solve(factor.blocks[0], stiffness[n_nodal:, :n_nodal])
    return Element(fields, order, length, section, stiffness[:n_nodal, :n_nodal] - half.T @ half, factor, half)


def varying_stiffness(order: int, length: float, quadrature: tuple[Array, Array], section: SectionStiffness) -> Array:
    """K = int sum over a, b of (N^(a) N^(b)T) kron S_ab ds before condensation, shape (n, n), n = (p + 1) n_fields."""
    xi, weight = quadrature
    n_axial, n_fields = order + 1, section.s00.shape[-1]
    values, slopes = shape_functions(order, xi), shape_function_slopes(order, xi) * (2.0 / length)
    pairs = ((values, values, section.s00), (2.0 * values, slopes, section.s01), (slopes, slopes, section.s11))
    axial = [np.einsum("aq,bq,q->abq", first, second, 0.5 * length * weight) for first, second, _ in pairs]
    along = np.concatenate(axial, axis=2).reshape(n_axial**2, -1)
    over_section = np.concatenate([matrices for *_, matrices in pairs]).reshape(-1, n_fields**2)
    whole = (along @ over_section).reshape(n_axial, n_axial, n_fields, n_fields).transpose(0, 2, 1, 3)
    whole = whole.reshape(n_axial * n_fields, -1)
    # Of the mixed terms N N'^T kron S_01 and their transpose, twice the first is there.
    return np.asarray(0.5 * (whole + whole.T))
