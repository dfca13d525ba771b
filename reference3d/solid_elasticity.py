"""Stiffness of layers of 27-node hexahedra between planes of nodes along any centre line.

Nodes lie where section nodes are in the planes; in between the elements are isoparametric. Displacements are the
components of every node in the frame of its own plane: where curvature and twist are constant, all layers of one
length then have the same matrices. Strain is taken in the frame of the centre line at each Gauss point, so that
materials may be orthotropic.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material, Orthotropic
from reference3d.quadratic import shape_derivatives, shape_functions
from reference3d.section_mesh import SectionMesh, gauss_square, shapes

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Gauss points along each axis: exact for the work of a constant stress, whatever the shape of the elements
GAUSS = 3


@dataclass(frozen=True, eq=False)
class LayerGeometry:
    """Three planes of a layer, and the frames in between.

    Attributes
    ----------
    points, axes : centre line, mm, and rows e1, e2, t in the planes, shape (3, 3) and (3, 3, 3)
    inside : rows e1, e2, t at the Gauss points along the layer, shape (GAUSS, 3, 3)
    """

    points: Array
    axes: Array
    inside: Array


@dataclass(frozen=True, eq=False)
class LayerMatrices:
    """What the layers of one kind have in common.

    Attributes
    ----------
    stiffness : of every element, N/mm, shape (n_elements, 81, 81); unknown 27 p + 3 a + c is component c of the
        element's node a of the section in plane p
    volume : integrals of the nodal functions, mm^3, shape (n_elements, 27)
    """

    stiffness: Array
    volume: Array


def elasticity(material: Material | Orthotropic) -> Array:
    """Hooke's law in the rod's frame, from strains xx, yy, ss, and twice ys, xs, xy; MPa, shape (6, 6)."""
    if isinstance(material, Material):
        modulus, ratio = material.young_modulus, material.poisson_ratio
        moduli, ratios = (modulus,) * 3, (ratio,) * 3
        shear = (modulus / (2.0 * (1.0 + ratio)),) * 3
    else:
        moduli, ratios, shear = material.young_moduli, material.poisson_ratios, material.shear_moduli
    (e1, e2, e3), (nu12, nu13, nu23) = moduli, ratios
    compliance = np.zeros((6, 6))
    compliance[:3, :3] = [
        [1.0 / e1, -nu12 / e1, -nu13 / e1],
        [-nu12 / e1, 1.0 / e2, -nu23 / e2],
        [-nu13 / e1, -nu23 / e2, 1.0 / e3],
    ]
    compliance[3:, 3:] = np.diag(1.0 / np.array(shear))
    return np.asarray(np.linalg.inv(compliance))


def element_nodes(section: SectionMesh, geometry: LayerGeometry) -> Array:
    """Positions of the elements' nodes, global, mm, shape (n_elements, 27, 3)."""
    place = section.nodes[section.quads]
    across = np.einsum("ean,pnc->epac", place, geometry.axes[:, :2])
    return np.asarray((geometry.points[:, None] + across).reshape(len(place), 27, 3))


def gradients(nodes: Array, slopes: Array) -> tuple[Array, Array]:
    """Derivatives of the 27 functions by global X, Y, Z, and the Jacobian, from those by xi, eta, zeta.

    Parameters
    ----------
    nodes : shape (n, 27, 3)
    slopes : shape (n, q, 27, 3), or (q, 27, 3) where they are the same for all

    Returns
    -------
    shapes (n, q, 27, 3) and (n, q)
    """
    mapping = np.swapaxes(nodes, 1, 2)[:, None] @ slopes  # dX_c / dxi_d
    return slopes @ np.linalg.inv(mapping), np.linalg.det(mapping)


def functions(xi: Array, eta: Array, zeta: Array) -> tuple[Array, Array]:
    """The 27 functions at points, shape (n, 27), and their slopes by xi, eta, zeta, shape (n, 27, 3)."""
    across, across_slopes = shapes(xi, eta)
    along, along_slope = shape_functions(zeta), shape_derivatives(zeta)
    values = np.einsum("pn,an->npa", along, across).reshape(-1, 27)
    slopes = np.stack(
        [
            *(np.einsum("pn,an->npa", along, across_slopes[:, d]).reshape(-1, 27) for d in range(2)),
            np.einsum("pn,an->npa", along_slope, across).reshape(-1, 27),
        ],
        axis=-1,
    )
    return values, slopes


def strain_matrix(gradient: Array, turned: Array) -> Array:
    """Strains in the local frame of every nodal component.

    Parameters
    ----------
    gradient : derivatives of the functions along e1, e2, t, shape (..., 27, 3)
    turned : from the frames of the three planes to the one here, shape (..., 3, 3, 3)

    Returns
    -------
    B : xx, yy, ss, 2 ys, 2 xs, 2 xy, shape (..., 6, 81)
    """
    per_node = np.repeat(turned, 9, axis=-3)  # (..., 27, 3, 3): local component b of nodal component c
    product = gradient[..., :, :, None, None] * per_node[..., :, None, :, :]  # du_b / dx_a: (..., 27, a, b, c)
    rows = [
        product[..., 0, 0, :],
        product[..., 1, 1, :],
        product[..., 2, 2, :],
        product[..., 1, 2, :] + product[..., 2, 1, :],
        product[..., 0, 2, :] + product[..., 2, 0, :],
        product[..., 0, 1, :] + product[..., 1, 0, :],
    ]
    found = np.stack(rows, axis=-3)
    return np.asarray(found.reshape(*found.shape[:-2], 81))


def layer_matrices(section: SectionMesh, geometry: LayerGeometry, hooke: Array) -> LayerMatrices:
    """Matrices of the elements of one layer.

    hooke : of `elasticity`
    """
    xi, eta, weight = gauss_square()
    root, along = np.polynomial.legendre.leggauss(GAUSS)
    count = len(xi)
    values, slopes = functions(np.tile(xi, GAUSS), np.tile(eta, GAUSS), np.repeat(root, count))
    gradient, jacobian = gradients(element_nodes(section, geometry), slopes)
    if not (jacobian > 0.0).all():
        raise RuntimeError("the mesh of a rod has elements that are turned inside out")
    volume = jacobian * np.outer(along, weight).ravel()
    frame = np.repeat(geometry.inside, count, axis=0)
    turned = frame[:, None] @ np.swapaxes(geometry.axes, 1, 2)
    strain = strain_matrix(gradient @ np.swapaxes(frame, 1, 2), np.broadcast_to(turned, (len(volume), *turned.shape)))
    scaled = np.linalg.cholesky(hooke).T @ strain * np.sqrt(volume)[..., None, None]
    flat = scaled.reshape(len(volume), -1, 81)
    return LayerMatrices(np.swapaxes(flat, 1, 2) @ flat, volume @ values)
