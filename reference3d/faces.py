"""Flat lateral faces of a solid rod of any centre line: their points, area vectors and what pressure and beds make."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Face
from reference3d.quadratic import shape_derivatives, shape_functions
from reference3d.section_mesh import SectionMesh

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class FacePoints:
    """Points on the element faces of one layer.

    Attributes
    ----------
    values : the functions of the 9 nodes of an element face (3 planes, 3 section nodes in each), shape (q, 9)
    position : global, mm, shape (n_edges, q, 3)
    area : outward area vectors by d zeta d eta, mm^2, shape (n_edges, q, 3)
    """

    values: Array
    position: Array
    area: Array


def face_points(
    section: SectionMesh, edges: IntArray, face: Face, points: Array, axes: Array, zeta: Array, eta: Array
) -> FacePoints:
    """Points (zeta along the rod, eta across) on every element face of a layer.

    Parameters
    ----------
    edges : of `section_mesh.face_edges`, shape (n_edges, 3)
    points, axes : centre line, mm, and frames in the three planes, shapes (3, 3) and (3, 3, 3)
    zeta, eta : shape (q,)
    """
    place = section.nodes[edges]
    nodes = (points[:, None] + np.einsum("ean,pnc->epac", place, axes[:, :2])).reshape(len(edges), 9, 3)
    along, across = shape_functions(zeta), shape_functions(eta)

    def product(one: Array, other: Array) -> Array:
        return np.asarray(np.einsum("pq,aq->qpa", one, other).reshape(-1, 9))

    values = product(along, across)
    by_zeta = product(shape_derivatives(zeta), across) @ nodes
    by_eta = product(along, shape_derivatives(eta)) @ nodes
    # edges run along rising x or y: e2 = t x e1 on top, e1 = e2 x t on the right
    outward = np.cross(by_zeta, by_eta) if face in ("top", "bottom") else np.cross(by_eta, by_zeta)
    side = 1.0 if face in ("top", "right") else -1.0
    return FacePoints(values, values @ nodes, side * outward)


def gauss_face(count: int = 3) -> tuple[Array, Array, Array]:
    """Gauss points of an element face: zeta, eta, weight, shape (count^2,) each."""
    root, weight = np.polynomial.legendre.leggauss(count)
    zeta, eta = (grid.ravel() for grid in np.meshgrid(root, root, indexing="ij"))
    return zeta, eta, np.outer(weight, weight).ravel()


def pressure_forces(found: FacePoints, axes: Array, weight: Array) -> Array:
    """Nodal forces of a unit pressure in the frames of the planes, mm^2, shape (n_edges, 3 planes, 3 nodes, 3)."""
    force = -np.einsum("q,qi,eqc->eic", weight, found.values, found.area).reshape(-1, 3, 3, 3)
    return np.asarray(np.einsum("epac,pbc->epab", force, axes))


def normal_rows(found: FacePoints, axes: Array) -> Array:
    """Outward normal displacement at the points by nodal components, shape (n_edges, q, 27), plane, node, axis."""
    size = np.linalg.norm(found.area, axis=2, keepdims=True)
    local = np.einsum("eqc,pbc->eqpb", found.area / size, axes)
    values = found.values.reshape(-1, 3, 3)
    rows = np.einsum("qpa,eqpb->eqpab", values, local)
    return np.asarray(rows.reshape(*rows.shape[:2], 27))


def bed_matrices(found: FacePoints, axes: Array, weight: Array, modulus: float) -> Array:
    """Stiffness of the springs under every element face, N/mm, shape (n_edges, 27, 27)."""
    rows = normal_rows(found, axes)
    springs = modulus * weight * np.linalg.norm(found.area, axis=2)
    return np.asarray(np.swapaxes(rows * springs[..., None], 1, 2) @ rows)
