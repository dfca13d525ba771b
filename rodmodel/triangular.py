"""Cholesky factors and triangular solutions of C-ordered matrices, straight to LAPACK and BLAS.

The same calls through scipy.linalg cost several times the arithmetic at the sizes of one element (30 to 300 rows).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.linalg.blas import dtrsm
from scipy.linalg.lapack import dpotrf, dpotrs

Array = NDArray[np.float64]


def cholesky(matrix: Array) -> Array:
    """Lower factor L of a symmetric positive definite matrix = L L^T.

    Raises
    ------
    numpy.linalg.LinAlgError
        if the matrix is not positive definite.
    """
    # The transpose of a C-ordered array is Fortran-ordered and needs no copy into LAPACK's layout.
    upper, info = dpotrf(matrix.T, lower=False, clean=True)
    if info != 0:
        raise np.linalg.LinAlgError(f"not positive definite from row {info} on")
    return np.asarray(upper.T)


def lower_solve(factor: Array, right: Array) -> Array:
    """L^-1 right, shape (n, m)."""
    return np.asarray(dtrsm(1.0, factor.T, right.T, side=1, lower=0).T)


def transposed_solve(factor: Array, right: Array) -> Array:
    """L^-T right, shape (n, m)."""
    return np.asarray(dtrsm(1.0, factor.T, right.T, side=1, lower=0, trans_a=1).T)


def cholesky_solve(factor: Array, right: Array) -> Array:
    """(L L^T)^-1 right, shape (n,) or (n, m)."""
    return np.asarray(dpotrs(factor.T, right, lower=0)[0]).reshape(right.shape)
