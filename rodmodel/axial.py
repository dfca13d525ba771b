"""Functions along the rod: hierarchic (integrated Legendre) shape functions and the quadratures that go with them.

Szabo and Babuska, Finite Element Analysis, 1991, section 3.1. Coordinate xi in [-1, 1] on every element.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.polynomial.legendre import legder, leggauss, legroots
from numpy.typing import NDArray

Array = NDArray[np.float64]


def legendre(degree: int, xi: Array) -> Array:
    """Legendre polynomials P_0..P_degree at xi, shape (degree + 1, n).

    By n P_n = (2 n - 1) xi P_{n-1} - (n - 1) P_{n-2}, Abramowitz and Stegun 22.7.10. numpy's `legvander` is the same
    recurrence behind an overhead that shows at a few points.
    """
    values = np.empty((degree + 1, len(xi)))
    values[0] = 1.0
    if degree > 0:
        values[1] = xi
    for n in range(2, degree + 1):
        values[n] = ((2 * n - 1) / n) * xi * values[n - 1] - ((n - 1) / n) * values[n - 2]
    return values


def legendre_derivatives(degree: int, xi: Array) -> Array:
    """Derivatives P_0'..P_degree' at xi, shape (degree + 1, n), from P_n' = P_{n-2}' + (2 n - 1) P_{n-1}."""
    values = legendre(degree, xi)
    slopes = np.zeros_like(values)
    for n in range(1, degree + 1):
        slopes[n] = (2 * n - 1) * values[n - 1] + (slopes[n - 2] if n > 1 else 0.0)
    return slopes


def shape_functions(order: int, xi: Array) -> Array:
    """N_0, N_1 (nodal, linear) and the bubbles N_2..N_order at xi, shape (order + 1, n).

    N_j = (P_j - P_{j-2}) / sqrt(2 (2 j - 1)); bubbles vanish at both ends.
    """
    polynomials = legendre(order, xi)
    values = np.empty_like(polynomials)
    values[0] = 0.5 * (1.0 - xi)
    values[1] = 0.5 * (1.0 + xi)
    j = np.arange(2, order + 1)[:, None]
    values[2:] = (polynomials[2:] - polynomials[:-2]) / np.sqrt(2.0 * (2.0 * j - 1.0))
    return values


def shape_function_slopes(order: int, xi: Array) -> Array:
    """dN/dxi of `shape_functions`, shape (order + 1, n): -1/2, 1/2, sqrt((2 j - 1) / 2) P_{j-1}."""
    polynomials = legendre(order, xi)
    slopes = np.empty_like(polynomials)
    slopes[0] = -0.5
    slopes[1] = 0.5
    j = np.arange(2, order + 1)[:, None]
    slopes[2:] = np.sqrt((2.0 * j - 1.0) / 2.0) * polynomials[1:-1]
    return slopes


@lru_cache(maxsize=32)
def axial_matrices(order: int) -> tuple[Array, Array, Array]:
    """M_00 = int N N^T, M_01 = int N N'^T, M_11 = int N' N'^T over [-1, 1], each (order + 1, order + 1).

    On an element of length L they stand for L/2 M_00, M_01 and 2/L M_11.
    """
    xi, weight = gauss(order + 1)
    values, slopes = shape_functions(order, xi), shape_function_slopes(order, xi)
    matrices = (values * weight) @ values.T, (values * weight) @ slopes.T, (slopes * weight) @ slopes.T
    for matrix in matrices:
        matrix.flags.writeable = False
    return matrices


@lru_cache(maxsize=32)
def gauss(count: int) -> tuple[Array, Array]:
    """Points and weights of the Gauss rule on [-1, 1], exact to degree 2 count - 1."""
    xi, weight = leggauss(count)
    xi.flags.writeable = weight.flags.writeable = False
    return xi, weight


@lru_cache(maxsize=32)
def lobatto(count: int) -> tuple[Array, Array]:
    """Points and weights of the Gauss-Lobatto rule on [-1, 1], ends included; exact to degree 2 count - 3, count >= 3.

    Weights 2 / (n (n - 1) P_{n-1}^2); Abramowitz and Stegun 25.4.32.
    """
    inner = legroots(legder(np.eye(count)[count - 1]))
    # One Newton step on P' takes the eigenvalues to round-off: P'' = (2 xi P' - n (n - 1) P) / (1 - xi^2).
    value, slope = legendre(count - 1, inner)[-1], legendre_derivatives(count - 1, inner)[-1]
    inner = inner - slope * (1.0 - inner**2) / (2.0 * inner * slope - count * (count - 1) * value)
    xi = np.concatenate([[-1.0], 0.5 * (inner - inner[::-1]), [1.0]])
    weight = 2.0 / (count * (count - 1) * legendre(count - 1, xi)[-1] ** 2)
    xi.flags.writeable = weight.flags.writeable = False
    return xi, weight
