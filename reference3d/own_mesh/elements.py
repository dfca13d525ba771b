"""The elements a mesh made elsewhere may consist of: their functions, faces and quadrature.

Functions come from their monomials and nodes alone: f(xi) = m(xi) V^-1 with V the monomials at the nodes. Nodes are in
the order of VTK, which meshio gives whatever the file's. Reference elements are the cube [-1, 1]^3 and the tetrahedron
xi, eta, zeta >= 0, xi + eta + zeta <= 1.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

CUBE = np.array(
    [(-1, -1, -1), (1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, -1, 1), (1, -1, 1), (1, 1, 1), (-1, 1, 1)], dtype=float
)
CUBE_EDGES = ((0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7))
# faces by corners, anticlockwise from outside; their middles are nodes 20 to 25 in this order
CUBE_FACES = ((0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7))
SIMPLEX = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], dtype=float)
SIMPLEX_EDGES = ((0, 1), (1, 2), (2, 0), (0, 3), (1, 3), (2, 3))
SIMPLEX_FACES = ((0, 2, 1), (0, 1, 3), (1, 2, 3), (0, 3, 2))
# Gauss points along an edge of a face: where contact ends inside it, they count as in or out
FACE_POINTS = 8


@dataclass(frozen=True, eq=False)
class ElementKind:
    """A kind of element.

    Attributes
    ----------
    name : meshio's
    nodes : in the reference element, shape (n_nodes, 3)
    exponents : of the monomials, shape (n_nodes, 3)
    faces : corners of every face, anticlockwise from outside, shape (n_faces, 3 or 4)
    points : Gauss points along an axis that integrate the stiffness
    """

    name: str
    nodes: Array
    exponents: IntArray
    faces: IntArray
    points: int

    @property
    def corners(self) -> int:
        """Number of the corners, which are the first nodes."""
        return 4 if self.is_simplex else 8

    @property
    def is_simplex(self) -> bool:
        """Whether it is a tetrahedron."""
        return len(self.faces[0]) == 3

    @cached_property
    def _coefficients(self) -> Array:
        return np.asarray(np.linalg.inv(_monomials(self.exponents, self.nodes)))

    def functions(self, place: Array) -> Array:
        """Nodal functions at places of the reference element; shape (n, 3) to (n, n_nodes)."""
        return np.asarray(_monomials(self.exponents, place) @ self._coefficients)

    def slopes(self, place: Array) -> Array:
        """Their derivatives by xi, eta, zeta; shape (n, 3) to (n, n_nodes, 3)."""
        found = []
        for axis in range(3):
            power = self.exponents[:, axis]
            lowered = self.exponents.copy()
            lowered[:, axis] = np.maximum(power - 1, 0)
            found.append((power * _monomials(lowered, place)) @ self._coefficients)
        return np.stack(found, axis=2)

    @cached_property
    def quadrature(self) -> tuple[Array, Array]:
        """Places, shape (n, 3), and weights over the reference element."""
        return _over_simplex(3, self.points) if self.is_simplex else _over_cube(3, self.points)

    def beyond(self, place: Array) -> Array:
        """How far places lie outside the reference element, in its own coordinates; not positive inside, shape (n,)."""
        if self.is_simplex:
            return np.asarray(np.maximum(-place.min(axis=1), place.sum(axis=1) - 1.0))
        return np.asarray(np.abs(place).max(axis=1) - 1.0)

    def face_quadrature(self, face: int) -> tuple[Array, Array, Array, Array]:
        """Quadrature over a face.

        Returns
        -------
        place, tangents, hats, weight : places in the element, shape (n, 3); how they move with the face's two
            coordinates, (n, 2, 3); linear functions of the face's corners, (n, n_corners); weights (n,)
        """
        corners = self.nodes[self.faces[face]]
        if self.is_simplex:
            at, weight = _over_simplex(2, FACE_POINTS)
            hats = np.column_stack([1.0 - at.sum(axis=1), at])
            slopes = np.broadcast_to(np.array([[-1.0, 1.0, 0.0], [-1.0, 0.0, 1.0]]), (len(at), 2, 3))
        else:
            at, weight = _over_cube(2, FACE_POINTS)
            signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)], dtype=float)
            along = 1.0 + at[:, None] * signs
            hats = 0.25 * along.prod(axis=2)
            slopes = 0.25 * np.swapaxes(signs * along[:, :, ::-1], 1, 2)
        return hats @ corners, slopes @ corners, hats, weight


def _monomials(exponents: IntArray, place: Array) -> Array:
    powers = np.stack([np.ones_like(place), place, place**2])
    first, second, third = exponents.T
    return np.asarray((powers[first, :, 0] * powers[second, :, 1] * powers[third, :, 2]).T)


def _over_cube(dimension: int, points: int) -> tuple[Array, Array]:
    root, weight = np.polynomial.legendre.leggauss(points)
    place = np.array(list(product(root, repeat=dimension)))
    return place, np.prod(np.array(list(product(weight, repeat=dimension))), axis=1)


def _over_simplex(dimension: int, points: int) -> tuple[Array, Array]:
    """Gauss's rule on the cube, collapsed (A. H. Stroud, Approximate Calculation of Multiple Integrals, 1971)."""
    place, weight = _over_cube(dimension, points)
    unit, weight = 0.5 * (place + 1.0), weight / 2.0**dimension
    left = np.ones(len(unit))
    found = np.empty_like(unit)
    for axis in range(dimension):
        found[:, axis] = left * unit[:, axis]
        weight = weight * left
        left = left - found[:, axis]
    return found, weight


def _cube(midpoints: bool, middles: bool) -> Array:
    parts = [CUBE]
    if midpoints:
        parts.append(np.array([CUBE[list(edge)].mean(axis=0) for edge in CUBE_EDGES]))
    if middles:
        parts += [np.array([CUBE[list(face)].mean(axis=0) for face in CUBE_FACES]), np.zeros((1, 3))]
    return np.concatenate(parts)


def _kinds() -> tuple[ElementKind, ...]:
    powers = np.array(list(product(range(3), repeat=3)))
    squares = (powers == 2).sum(axis=1)
    halves = np.array([SIMPLEX[list(edge)].mean(axis=0) for edge in SIMPLEX_EDGES])
    cube, simplex = np.array(CUBE_FACES), np.array(SIMPLEX_FACES)
    return (
        ElementKind("hexahedron", _cube(False, False), powers[squares == 0], cube, 2),
        # of superlinear degree 2 (D. N. Arnold, G. Awanou, Foundations of Computational Mathematics 11 (2011) 337-344)
        ElementKind("hexahedron20", _cube(True, False), powers[squares <= 1], cube, 3),
        ElementKind("hexahedron27", _cube(True, True), powers, cube, 3),
        ElementKind("tetra", SIMPLEX, powers[powers.sum(axis=1) <= 1], simplex, 2),
        ElementKind("tetra10", np.concatenate([SIMPLEX, halves]), powers[powers.sum(axis=1) <= 2], simplex, 3),
    )


KINDS: Mapping[str, ElementKind] = {kind.name: kind for kind in _kinds()}
