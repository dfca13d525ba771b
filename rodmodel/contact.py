"""Frictionless penalty contact in compliance form: the rods are reduced to their contact points.

With the forces f at the points, the gap is d = d_0 + C f; where d < 0 the penalty makes f = -c_n w d. C is small and
dense, so that trying another active set costs one small Cholesky factorisation and no solution of the rods.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, cholesky, solve_triangular

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]


def forces_on(active: BoolArray, compliance: Array, gap: Array, spring: Array) -> Array:
    """Forces when exactly the `active` points are joined by their springs, pulling ones included.

    Parameters
    ----------
    active : shape (n,)
    compliance : C, mm/N, shape (n, n)
    gap : d_0, gap without contact forces, mm, shape (n,), or several side by side, shape (n, m)
    spring : c_n w, penalty times share of the face, N/mm, shape (n,)
    """
    force = np.zeros_like(gap)
    if active.any():
        matrix = compliance[np.ix_(active, active)] + np.diag(1.0 / spring[active])
        force[active] = cho_solve(cho_factor(matrix, lower=True, check_finite=False), -gap[active])
    return force


def unilateral_contact(compliance: Array, gap: Array, spring: Array) -> Array:
    """Contact forces that only push: f >= 0, d + f / (c_n w) >= 0, and one of the two zero at every point; shape (n,).

    This is the minimum of a convex quadratic over f >= 0, solved by Lawson and Hanson's non-negative least squares on
    its Cholesky factor, which ends after finitely many sets. A primal-dual active set cycles on these problems: more
    points than an element has freedoms make sets that differ by nothing but round-off. Parameters as in `forces_on`.

    Raises
    ------
    RuntimeError
        if the iterations run out (three times the number of points).
    """
    if len(gap) == 0:
        return np.empty(0)
    # Importing it takes longer than importing all of this package, and only scenes with contact need it.
    from scipy.optimize import nnls

    factor = cholesky(compliance + np.diag(1.0 / spring), lower=True, check_finite=False)
    force, _ = nnls(factor.T, -solve_triangular(factor, gap, lower=True, check_finite=False))
    # Least squares on the factor loses digits to the factor's own condition; its set of points in contact does not.
    polished = forces_on(force > 0.0, compliance, gap, spring)
    return polished if (polished >= 0.0).all() else np.asarray(force)
