"""Functions over the cross-section and the section stiffness matrices S_ab.

Level h_k: each displacement component (u, v, w) is a complete polynomial of degree k in (x, y), spanned by products
of Legendre polynomials, which are orthogonal over the rectangle (raw monomials lose all digits at high level).
Strain of the straight rod in the local frame, order (xx, yy, ss, ys, xs, xy):

    eps = B_0 psi + B_1 psi',   S_ab = int B_a^T D B_b dA.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material, Rectangle
from rodmodel.axial import gauss, legendre, legendre_derivatives

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

U, V, W = 0, 1, 2


@dataclass(frozen=True)
class Fields:
    """The functions over the section that a rod carries: level h_level has 3 (k + 1)(k + 2) / 2 of them.

    Parameters
    ----------
    level : k, largest total degree in (x, y)
    mirror_x : the solution is its own mirror image in the plane x = 0: only u odd in x, v and w even are carried
    mirror_y : likewise in y = 0: v odd in y, u and w even
    """

    level: int
    mirror_x: bool = False
    mirror_y: bool = False

    @cached_property
    def table(self) -> IntArray:
        """Component (0, 1, 2 for u, v, w) and degrees i, j of P_i(2x/width) P_j(2y/height), shape (3, n_fields)."""
        triples = [
            (component, total - j, j)
            for component in (U, V, W)
            for total in range(self.level + 1)
            for j in range(total + 1)
            if (not self.mirror_x or (total - j) % 2 == (component == U))
            and (not self.mirror_y or j % 2 == (component == V))
        ]
        return np.array(triples, dtype=np.int64).T

    @property
    def count(self) -> int:
        """Number of fields."""
        return int(self.table.shape[1])

    def indices(self, component: int) -> IntArray:
        """The fields of one displacement component."""
        return np.flatnonzero(self.table[0] == component)

    def index(self, component: int, degree_x: int, degree_y: int) -> int | None:
        """Where a field is; None if symmetry leaves it out."""
        wanted = np.array([[component], [degree_x], [degree_y]])
        found = np.flatnonzero(np.equal(self.table, wanted).all(axis=0))
        return int(found[0]) if len(found) else None


def section_values(section: Rectangle, chosen: Fields, x: Array, y: Array) -> Array:
    """Values of every field's scalar function at section points, shape (n_fields, n_points).

    Scaled to mean square one over the section, so that the first one is 1 and its coefficient the mean displacement.
    """
    along_x, along_y = _scaled_legendre(section, chosen, x, y)
    _, i, j = chosen.table
    return np.asarray(along_x[i] * along_y[j])


def section_slopes(section: Rectangle, chosen: Fields, x: Array, y: Array) -> tuple[Array, Array]:
    """Derivatives by x and by y of `section_values`, each of shape (n_fields, n_points)."""
    along_x, along_y = _scaled_legendre(section, chosen, x, y)
    scale = _mean_square_one(chosen.level)
    slope_x = scale * legendre_derivatives(chosen.level, 2.0 * x / section.width) * (2.0 / section.width)
    slope_y = scale * legendre_derivatives(chosen.level, 2.0 * y / section.height) * (2.0 / section.height)
    _, i, j = chosen.table
    return slope_x[i] * along_y[j], along_x[i] * slope_y[j]


def _scaled_legendre(section: Rectangle, chosen: Fields, x: Array, y: Array) -> tuple[Array, Array]:
    scale = _mean_square_one(chosen.level)
    return (
        scale * legendre(chosen.level, 2.0 * x / section.width),
        scale * legendre(chosen.level, 2.0 * y / section.height),
    )


def _mean_square_one(degree: int) -> Array:
    return np.asarray(np.sqrt(2.0 * np.arange(degree + 1) + 1.0)[:, None])


def strain_operators(section: Rectangle, chosen: Fields, x: Array, y: Array) -> tuple[Array, Array]:
    """B_0 and B_1 at section points, each of shape (n_points, 6, n_fields)."""
    value = section_values(section, chosen, x, y)
    slope_x, slope_y = section_slopes(section, chosen, x, y)
    is_u, is_v, is_w = (chosen.indices(component) for component in (U, V, W))
    b0 = np.zeros((value.shape[1], 6, chosen.count))
    b1 = np.zeros_like(b0)
    b0[:, 0, is_u] = slope_x[is_u].T
    b0[:, 1, is_v] = slope_y[is_v].T
    b0[:, 3, is_w] = slope_y[is_w].T
    b0[:, 4, is_w] = slope_x[is_w].T
    b0[:, 5, is_u] = slope_y[is_u].T
    b0[:, 5, is_v] = slope_x[is_v].T
    b1[:, 2, is_w] = value[is_w].T
    b1[:, 3, is_v] = value[is_v].T
    b1[:, 4, is_u] = value[is_u].T
    return b0, b1


def elasticity_matrix(material: Material, level: int) -> Array:
    """Hooke's law D, stress = D strain in the order (xx, yy, ss, ys, xs, xy), MPa, shape (6, 6).

    Full three-dimensional law from h2 on. h1 cannot contract sideways as bending asks, and locks with it (about 25 %
    too stiff); it gets the reduced law of rod theory: sigma_s = E eps_s, uncoupled from plane stress in the section.
    """
    young, poisson = material.young_modulus, material.poisson_ratio
    law = np.diag(np.full(6, young / (2.0 * (1.0 + poisson))))
    if level == 1:
        law[2, 2] = young
        law[:2, :2] = young / (1.0 - poisson**2) * np.array([[1.0, poisson], [poisson, 1.0]])
    else:
        lame = young * poisson / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
        law[:3, :3] = lame + np.diag(np.full(3, young / (1.0 + poisson)))
    return law


def section_quadrature(section: Rectangle, level: int) -> tuple[Array, Array, Array]:
    """Gauss points x, y (mm) and weights (mm^2) that integrate products of two level-k functions exactly."""
    xi, weight = gauss(level + 1)
    x, y = np.meshgrid(0.5 * section.width * xi, 0.5 * section.height * xi, indexing="ij")
    area_weight = 0.25 * section.width * section.height * np.outer(weight, weight)
    return x.ravel(), y.ravel(), area_weight.ravel()


@dataclass(frozen=True, eq=False)
class SectionStiffness:
    """S_ab = int B_a^T D B_b dA, each of shape (n_fields, n_fields); S_10 = S_01^T."""

    s00: Array
    s01: Array
    s11: Array


def section_stiffness(section: Rectangle, material: Material, chosen: Fields) -> SectionStiffness:
    """Section stiffness matrices of a straight rod: N, N mm and N mm^2 per unit of psi and psi'."""
    x, y, weight = section_quadrature(section, chosen.level)
    b0, b1 = (b.reshape(-1, chosen.count) for b in strain_operators(section, chosen, x, y))
    law = elasticity_matrix(material, chosen.level)
    weighted = (weight[:, None, None] * law).reshape(-1, 6, 6)
    d_b0, d_b1 = ((weighted @ b.reshape(-1, 6, chosen.count)).reshape(-1, chosen.count) for b in (b0, b1))
    return SectionStiffness(b0.T @ d_b0, b0.T @ d_b1, b1.T @ d_b1)
