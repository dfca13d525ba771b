"""Quadratic Lagrange interpolation along one line of elements: nodes, location, shape functions, weights.

A 27-node box is the tensor product of three of these. Nodes of an element lie at its start, middle and end.
"""

from __future__ import annotations

from typing import Literal

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
Side = Literal["left", "right"]


def line_nodes(borders: Array) -> Array:
    """Borders and middles of the elements in ascending order.

    borders : element borders, ascending, shape (n + 1,); the result has shape (2 n + 1,)
    """
    nodes = np.empty(2 * len(borders) - 1)
    nodes[0::2] = borders
    nodes[1::2] = 0.5 * (borders[1:] + borders[:-1])
    return nodes


def locate(borders: Array, coordinate: Array, side: Side = "left") -> tuple[IntArray, Array]:
    """Element of each coordinate and the place in it.

    Coordinates beyond the ends belong to the outermost elements.

    Parameters
    ----------
    borders : element borders, shape (n + 1,)
    coordinate : shape (n_points,)
    side : which of two elements owns their common border: 'left' the one before it, 'right' the one after it

    Returns
    -------
    element : shape (n_points,)
    xi : place in the element, -1 at its start and 1 at its end, shape (n_points,)
    """
    snapped = np.array(coordinate, dtype=np.float64)
    nearest = np.clip(np.searchsorted(borders, snapped), 1, len(borders) - 1)
    nearest = np.where(snapped - borders[nearest - 1] < borders[nearest] - snapped, nearest - 1, nearest)
    # a border met up to round-off is that border, so that both sides of it can be asked for
    close = np.abs(snapped - borders[nearest]) <= 1e-10 * (borders[-1] - borders[0])
    snapped[close] = borders[nearest[close]]
    element = np.clip(np.searchsorted(borders, snapped, side=side) - 1, 0, len(borders) - 2)
    start, end = borders[element], borders[element + 1]
    return element.astype(np.int64), (2.0 * snapped - start - end) / (end - start)


def shape_functions(xi: Array) -> Array:
    """Quadratic Lagrange functions of start, middle and end node, shape (3, n)."""
    return np.stack([0.5 * xi * (xi - 1.0), 1.0 - xi**2, 0.5 * xi * (xi + 1.0)])


def shape_derivatives(xi: Array) -> Array:
    """Derivatives of `shape_functions` with respect to xi, shape (3, n)."""
    return np.stack([xi - 0.5, -2.0 * xi, xi + 0.5])


def nodal_weights(borders: Array, start: float, end: float) -> Array:
    """Integrals of the nodal functions over the elements between two borders (Simpson's rule), mm.

    Elements outside [start, end] give nothing, also to a node they share with one inside.

    Parameters
    ----------
    borders : element borders, shape (n + 1,)
    start, end : two of the borders

    Returns
    -------
    weights, shape (2 n + 1,)
    """
    middle = 0.5 * (borders[1:] + borders[:-1])
    length = np.where((middle > start) & (middle < end), np.diff(borders), 0.0)
    weights = np.zeros(2 * len(borders) - 1)
    weights[0:-1:2] += length / 6.0
    weights[1::2] += length * (2.0 / 3.0)
    weights[2::2] += length / 6.0
    return weights
