"""Stiffness of a rod of 27-node hexahedra (Hooke's law, small strains), assembled by layers of elements.

Element matrices come from the basis gradients of scikit-fem's `ElementHex2` in one batched product. Boxes of
the same shape share one matrix, and layers of the same thickness share one layer matrix.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from skfem import Basis, ElementHex2, MeshHex

from cases.scene import Material
from reference3d.grading import Borders

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Gauss points exact for degree 5 along each axis; gradients of 27-node boxes multiply to degree 4
QUADRATURE_ORDER = 5


@dataclass(frozen=True)
class LayeredStiffness:
    """Stiffness of a body that is a row of layers of elements.

    Unknowns are ordered by plane (the borders and middles of the layers), then y, x and component (x, y, s).
    A layer matrix couples three planes of m unknowns: start, middle and end of the layer.

    Attributes
    ----------
    matrices : the different layer matrices, N/mm, shape (n_different, 3 m, 3 m)
    kind : which of them a layer has, shape (n_layers,)
    """

    matrices: Array
    kind: IntArray

    @property
    def plane_size(self) -> int:
        """Unknowns of one plane, m."""
        return int(self.matrices.shape[1]) // 3

    def apply(self, displacement: Array) -> Array:
        """Internal forces K u.

        displacement : mm, shape (n_planes, m); the result, N, has the same shape
        """
        layers = len(self.kind)
        gathered = np.stack([displacement[position : position + 2 * layers : 2] for position in range(3)], axis=1)
        force = np.empty((layers, 3 * self.plane_size))
        for kind in range(len(self.matrices)):
            members = self.kind == kind
            force[members] = gathered[members].reshape(-1, 3 * self.plane_size) @ self.matrices[kind]
        result = np.zeros_like(displacement)
        for position in range(3):
            block = slice(position * self.plane_size, (position + 1) * self.plane_size)
            result[position : position + 2 * layers : 2] += force[:, block]
        return result


def lame_parameters(material: Material) -> tuple[float, float]:
    """Lame's lambda and mu, MPa."""
    modulus, ratio = material.young_modulus, material.poisson_ratio
    return modulus * ratio / ((1.0 + ratio) * (1.0 - 2.0 * ratio)), modulus / (2.0 * (1.0 + ratio))


def element_stiffness(mesh: MeshHex, elements: IntArray, material: Material) -> Array:
    """Stiffness matrices of some elements of a mesh.

    Returns
    -------
    matrices : N/mm, shape (n, 81, 81); unknown 3 i + a is component a of scikit-fem's basis function i
    """
    basis = Basis(mesh, ElementHex2(), elements=elements, intorder=QUADRATURE_ORDER)
    gradients = np.stack([np.asarray(basis.basis[i][0].grad) for i in range(27)])
    flat = np.ascontiguousarray(gradients.transpose(2, 0, 1, 3)).reshape(len(elements), 81, -1)
    products = (flat * basis.dx[:, None, :]) @ flat.transpose(0, 2, 1)
    products = products.reshape(len(elements), 27, 3, 27, 3)
    lam, mu = lame_parameters(material)
    # a(u, v) = int lambda div u div v + 2 mu eps(u) : eps(v), by components of the products of gradients
    stiffness = lam * products + mu * products.transpose(0, 1, 4, 3, 2)
    laplacian = mu * np.trace(products, axis1=2, axis2=4)
    for component in range(3):
        stiffness[:, :, component, :, component] += laplacian
    return np.asarray(stiffness.reshape(len(elements), 81, 81))


def layered_stiffness(mesh: MeshHex, borders: Borders, material: Material) -> LayeredStiffness:
    """Stiffness of a box mesh (`mesh.box_mesh` with the same borders), free of supports."""
    sizes = [np.diff(axis) for axis in (borders.x, borders.y, borders.s)]
    n_x, n_y = len(sizes[0]), len(sizes[1])
    # equal up to round-off is equal
    different = [np.unique(np.round(size / size.max(), 11), return_index=True, return_inverse=True) for size in sizes]
    (_, first_x, of_x), (_, first_y, of_y), (_, first_s, of_s) = different
    shape = (len(first_s), len(first_y), len(first_x))
    representatives = ((first_s[:, None, None] * n_y + first_y[:, None]) * n_x + first_x).ravel()
    stiffness = element_stiffness(mesh, representatives, material).reshape(*shape, 81, 81)
    order = _grid_order()
    unknown = (3 * order[:, None] + np.arange(3)).ravel()
    stiffness = stiffness[..., unknown[:, None], unknown]
    planes_x, planes_y = 2 * n_x + 1, 2 * n_y + 1
    size = 3 * planes_x * planes_y
    matrices = np.zeros((shape[0], 3 * size, 3 * size))
    k, j, i = (index.ravel() for index in np.meshgrid(range(3), range(3), range(3), indexing="ij"))
    for row in range(n_y):
        for column in range(n_x):
            node = (k * planes_y + 2 * row + j) * planes_x + 2 * column + i
            unknowns = (3 * node[:, None] + np.arange(3)).ravel()
            matrices[:, unknowns[:, None], unknowns] += stiffness[:, of_y[row], of_x[column]]
    return LayeredStiffness(matrices=matrices, kind=of_s.astype(np.int64))


def _grid_order() -> IntArray:
    """Basis functions of scikit-fem's element sorted by s, y, x of their nodes, shape (27,)."""
    nodes = ElementHex2.doflocs
    return np.lexsort((nodes[:, 0], nodes[:, 1], nodes[:, 2])).astype(np.int64)
