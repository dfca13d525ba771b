"""Small solids of one kind of hexahedra each: the plain 8-node element, 20 nodes, 27 nodes.

Element functions are scikit-fem's; matrices are made at once from their gradients. Bodies are boxes, small enough for
a direct solution without further ado.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_matrix, csc_matrix
from scipy.sparse.linalg import splu
from skfem import Basis, ElementHex1, ElementHex2, ElementHexS2, MeshHex
from skfem.element import Element

from cases.scene import Material

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
Divisions = tuple[Array, Array, Array]

HEXAHEDRA: dict[int, Callable[[], Element]] = {8: ElementHex1, 20: ElementHexS2, 27: ElementHex2}


@dataclass(frozen=True, eq=False)
class Solid:
    """A box of hexahedra with one kind of element.

    Attributes
    ----------
    basis : scalar, on all elements
    nodes : where the functions are one, mm, shape (3, n)
    stiffness : unknown 3 i + c is component c of node i, N/mm
    """

    basis: Basis
    nodes: Array
    stiffness: csc_matrix


def solid(divisions: Divisions, material: Material, nodes: int) -> Solid:
    """Mesh a box and assemble it.

    Parameters
    ----------
    divisions : planes between elements along X, Y, Z, mm
    nodes : of an element: 8, 20 or 27
    """
    basis = Basis(MeshHex.init_tensor(*divisions), HEXAHEDRA[nodes](), intorder=2 if nodes == 8 else 4)
    gradients = np.stack([np.asarray(function[0].grad) for function in basis.basis])  # function, axis, element, point
    young, poisson = material.young_modulus, material.poisson_ratio
    shear = 0.5 * young / (1.0 + poisson)
    dilating = 2.0 * shear * poisson / (1.0 - 2.0 * poisson)
    products = np.einsum("iaeq,jbeq,eq->eiajb", gradients, gradients, basis.dx, optimize=True)
    matrices = dilating * products + shear * products.transpose(0, 1, 4, 3, 2)
    matrices += shear * np.einsum("eicjc,ab->eiajb", products, np.eye(3))
    count = len(gradients)
    unknown = (3 * basis.element_dofs.T[:, :, None] + np.arange(3)).reshape(-1, 3 * count)
    rows = np.repeat(unknown, 3 * count, axis=1)
    columns = np.tile(unknown, (1, 3 * count))
    size = 3 * basis.N
    whole = coo_matrix((matrices.ravel(), (rows.ravel(), columns.ravel())), shape=(size, size)).tocsc()
    return Solid(basis, np.asarray(basis.doflocs), whole)


def solved(stiffness: csc_matrix, force: Array, fixed: NDArray[np.bool_], given: Array) -> Array:
    """Displacements of all unknowns; those of the fixed ones are given."""
    free = np.flatnonzero(~fixed)
    right = force - stiffness @ np.where(fixed, given, 0.0)
    factor = splu(stiffness[free][:, free], permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True})
    result = np.where(fixed, given, 0.0)
    result[free] = factor.solve(right[free])
    return np.asarray(result)


def face_weights(body: Solid, height: float) -> Array:
    """Nodal forces of a unit pressure on the top face Z = height, mm^2, shape (n,)."""
    facets = body.basis.mesh.facets_satisfying(lambda x: np.abs(x[2] - height) < 1e-9)
    face = body.basis.boundary(facets)
    values = np.stack([np.asarray(function[0]) for function in face.basis])
    weights = np.zeros(body.basis.N)
    np.add.at(weights, face.element_dofs, (values * face.dx).sum(axis=-1))
    return weights
