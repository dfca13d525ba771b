"""Functions over the cross-section and the section stiffness matrices S_ab.

Level h_k: each displacement component (u, v, w) is a complete polynomial of degree k in (x, y), spanned by functions
that are orthonormal over the section (`rodmodel.basis`).
Strain in the local frame, order (xx, yy, ss, ys, xs, xy):

    eps = B_0 psi + B_1 psi',   S_ab = int B_a^T D B_b sqrt(g) dA.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material, Orthotropic, Section
from rodmodel.basis import basis_slopes, basis_values, section_basis
from rodmodel.shape import section_quadrature

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

U, V, W = 0, 1, 2

# k1, k2, tau: rate of turning of the frame about e1, e2, t, rad/mm
Darboux = tuple[float, float, float]

STRAIGHT: Darboux = (0.0, 0.0, 0.0)
# Degree by which the quadrature of a curved rod exceeds that of a straight one.
EXTRA_DEGREES = 16


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
        """Component (0, 1, 2 for u, v, w) and degrees i, j of the function, shape (3, n_fields)."""
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

    def within(self, larger: Fields) -> IntArray:
        """Where the fields stand among those of a level at least as high, shape (n_fields,)."""
        return _embedding(self, larger)

    def indices(self, component: int) -> IntArray:
        """The fields of one displacement component."""
        return np.flatnonzero(self.table[0] == component)

    def index(self, component: int, degree_x: int, degree_y: int) -> int | None:
        """Where a field is; None if symmetry leaves it out."""
        wanted = np.array([[component], [degree_x], [degree_y]])
        found = np.flatnonzero(np.equal(self.table, wanted).all(axis=0))
        return int(found[0]) if len(found) else None


@lru_cache(maxsize=256)
def _embedding(smaller: Fields, larger: Fields) -> IntArray:
    places = {tuple(column): index for index, column in enumerate(larger.table.T.tolist())}
    return np.array([places[tuple(column)] for column in smaller.table.T.tolist()], dtype=np.int64)


def section_values(section: Section, chosen: Fields, x: Array, y: Array) -> Array:
    """Values of every field's scalar function at section points, shape (n_fields, n_points).

    Mean square one over the section, so that the first one is 1 and its coefficient the mean displacement.
    """
    return np.asarray(basis_values(section_basis(section, chosen.level), x, y)[_functions(chosen)])


def section_slopes(section: Section, chosen: Fields, x: Array, y: Array) -> tuple[Array, Array]:
    """Derivatives by x and by y of `section_values`, each of shape (n_fields, n_points)."""
    slope_x, slope_y = basis_slopes(section_basis(section, chosen.level), x, y)
    functions = _functions(chosen)
    return slope_x[functions], slope_y[functions]


def _functions(chosen: Fields) -> IntArray:
    """Which function of the basis each field has: they stand in the order of i + j, then of j."""
    _, i, j = chosen.table
    return np.asarray((i + j) * (i + j + 1) // 2 + j)


def strain_operators(
    section: Section, chosen: Fields, x: Array, y: Array, turning: Darboux | Array
) -> tuple[Array, Array, Array]:
    """B_0 and B_1 at section points, each of shape (n_points, 6, n_fields), and sqrt(g) there, shape (n_points,).

    turning : k1, k2, tau of the frame, rad/mm; where it varies, at every point, shape (3, n_points)

    The frame (e1, e2, t) turns by omega = (k1, k2, tau) per arc length. Along s a point moves by sqrt(g) t +
    tau (x e2 - y e1) with sqrt(g) = 1 - k2 x + k1 y, and the components of a vector change by omega x (u, v, w). So the
    derivative of the displacement along t is 1 / sqrt(g) times

        (u', v', w') + omega x (u, v, w) - tau (x d/dy - y d/dx) (u, v, w).
    """
    k1, k2, tau = turning
    value = section_values(section, chosen, x, y).T
    slope_x, slope_y = (slope.T for slope in section_slopes(section, chosen, x, y))
    stretch = 1.0 - k2 * x + k1 * y
    along = value / stretch[:, None]
    swirl = -np.reshape(tau, (-1, 1)) * (x[:, None] * slope_y - y[:, None] * slope_x) / stretch[:, None]
    is_u, is_v, is_w = (chosen.indices(component) for component in (U, V, W))
    b0 = np.zeros((len(x), 6, chosen.count))
    b1 = np.zeros_like(b0)
    b0[:, 0, is_u] = slope_x[:, is_u]
    b0[:, 1, is_v] = slope_y[:, is_v]
    b0[:, 5, is_u] = slope_y[:, is_u]
    b0[:, 5, is_v] = slope_x[:, is_v]
    b0[:, 3, is_w] = slope_y[:, is_w]
    b0[:, 4, is_w] = slope_x[:, is_w]
    for row, own, others in (
        (2, is_w, ((is_v, k1), (is_u, -k2))),
        (3, is_v, ((is_u, tau), (is_w, -k1))),
        (4, is_u, ((is_w, k2), (is_v, -tau))),
    ):
        b1[:, row, own] = along[:, own]
        b0[:, row, own] += swirl[:, own]
        for other, rate in others:
            b0[:, row, other] += np.reshape(rate, (-1, 1)) * along[:, other]
    return b0, b1, stretch


def elasticity_matrix(material: Material | Orthotropic, level: int) -> Array:
    """Hooke's law D, stress = D strain in the order (xx, yy, ss, ys, xs, xy), MPa, shape (6, 6).

    Full three-dimensional law from h2 on. h1 cannot contract sideways as bending asks, and locks with it (about 25 %
    too stiff); it gets the reduced law of rod theory: sigma_s = E eps_s, uncoupled from plane stress in the section.
    """
    if isinstance(material, Material):
        young, poisson = material.young_modulus, material.poisson_ratio
        moduli, ratios, shear = (young,) * 3, (poisson,) * 3, (young / (2.0 * (1.0 + poisson)),) * 3
    else:
        moduli, ratios, shear = material.young_moduli, material.poisson_ratios, material.shear_moduli
    (e1, e2, e3), (nu12, nu13, nu23) = moduli, ratios
    compliance = np.array(
        [
            [1.0 / e1, -nu12 / e1, -nu13 / e1],
            [-nu12 / e1, 1.0 / e2, -nu23 / e2],
            [-nu13 / e1, -nu23 / e2, 1.0 / e3],
        ]
    )
    law = np.zeros((6, 6))
    law[[3, 4, 5], [3, 4, 5]] = shear
    if level == 1:
        law[:2, :2] = np.linalg.inv(compliance[:2, :2])
        law[2, 2] = e3
    else:
        law[:3, :3] = np.linalg.inv(compliance)
    return law


def axial_modulus(material: Material | Orthotropic) -> float:
    """Young's modulus along the rod, MPa."""
    return material.young_modulus if isinstance(material, Material) else material.young_moduli[2]


@lru_cache(maxsize=256)
def per_axial_modulus(material: Material | Orthotropic) -> Material | Orthotropic:
    """The material with all moduli in units of the axial one: rods that differ by it alone share their elements."""
    if isinstance(material, Material):
        return replace(material, young_modulus=1.0)
    scale = 1.0 / material.young_moduli[2]
    young, shear = ((a * scale, b * scale, c * scale) for a, b, c in (material.young_moduli, material.shear_moduli))
    return replace(material, young_moduli=young, shear_moduli=shear)


def product_quadrature(section: Section, level: int, turning: Darboux | Array) -> tuple[Array, Array, Array]:
    """Points x, y (mm) and weights (mm^2) for products of two level-k functions.

    Exact for a straight rod; a curved one divides by sqrt(g), which `EXTRA_DEGREES` more resolve to round-off down to
    a radius of the section's size.
    """
    return section_quadrature(section, 2 * level + (EXTRA_DEGREES if np.any(turning) else 0))


@dataclass(frozen=True, eq=False)
class SectionStiffness:
    """S_ab = int B_a^T D B_b sqrt(g) dA, each of shape (..., n_fields, n_fields); S_10 = S_01^T."""

    s00: Array
    s01: Array
    s11: Array


def section_stiffness(
    section: Section, material: Material | Orthotropic, chosen: Fields, turning: Darboux | Array
) -> SectionStiffness:
    """Section stiffness matrices: N, N mm and N mm^2 per unit of psi and psi'.

    The strain of a field is made of four functions of its scalar function phi: phi_x, phi_y, phi / sqrt(g) and
    (x phi_y - y phi_x) / sqrt(g), with coefficients that are constant over the section (`strain_operators`). So their
    integrals by pairs, which components and strains share, give all S_ab.

    turning : k1, k2, tau of the frame, rad/mm; at several stations of shape (3, n), for matrices of shape
        (n, n_fields, n_fields)
    """
    rates = np.reshape(turning, (3, -1))
    at_zero, at_one = _strain_coefficients(rates)
    law = elasticity_matrix(material, chosen.level)
    energies = [a.transpose(0, 2, 1) @ law @ b for a, b in ((at_zero, at_zero), (at_zero, at_one), (at_one, at_one))]
    shares = np.stack(energies, axis=1).reshape(-1, 3, 3, 4, 3, 4).transpose(0, 1, 2, 4, 3, 5).reshape(-1, 27, 16)
    pairs = _products(section, chosen.level, rates)
    count = pairs.shape[-1]
    blocks = shares @ pairs.reshape(-1, 16, count * count)
    component, function = chosen.table[0], _functions(chosen)
    place = (3 * component[:, None] + component) * count**2 + count * function[:, None] + function
    found = np.take(blocks.reshape(-1, 3, 9 * count * count), place, axis=2)
    return SectionStiffness(*(found.transpose(1, 0, 2, 3) if np.ndim(turning) == 2 else found[0]))


def _strain_coefficients(rates: Array) -> tuple[Array, Array]:
    """What the four functions of u, v, w add to each strain with psi and with psi', shape (n, 6, 3 * 4) each."""
    k1, k2, tau = rates
    at_zero, at_one = np.zeros((2, rates.shape[1], 6, 3, 4))
    slope_x, slope_y, value, swirl = range(4)
    for row, component, function in ((0, U, slope_x), (1, V, slope_y), (5, U, slope_y), (5, V, slope_x)):
        at_zero[:, row, component, function] = 1.0
    for row, function in ((3, slope_y), (4, slope_x)):
        at_zero[:, row, W, function] = 1.0
    for row, own, others in (
        (2, W, ((V, k1), (U, -k2))),
        (3, V, ((U, tau), (W, -k1))),
        (4, U, ((W, k2), (V, -tau))),
    ):
        at_one[:, row, own, value] = 1.0
        at_zero[:, row, own, swirl] = -tau
        for other, rate in others:
            at_zero[:, row, other, value] = rate
    return at_zero.reshape(-1, 6, 12), at_one.reshape(-1, 6, 12)


def _products(section: Section, level: int, rates: Array) -> Array:
    """Integrals of pairs of the four functions times sqrt(g), for all scalar ones, shape (n, 4, 4, count, count)."""
    k1, k2, _ = rates
    x, y, weight = product_quadrature(section, level, rates)
    basis = section_basis(section, level)
    slopes = np.array(basis_slopes(basis, x, y))
    value = basis_values(basis, x, y)
    others = np.array([value, x * slopes[1] - y * slopes[0]])
    count = len(value)
    slopes, others = slopes.reshape(2 * count, -1), others.reshape(2 * count, -1)
    whole = np.empty((rates.shape[1], 4 * count, 4 * count))
    # sqrt(g) = 1 - k2 x + k1 y multiplies pairs of slopes, and divides pairs of the others.
    plain, by_x, by_y = ((slopes * factor) @ slopes.T for factor in (weight, weight * x, weight * y))
    whole[:, : 2 * count, : 2 * count] = plain - k2[:, None, None] * by_x + k1[:, None, None] * by_y
    mixed = (slopes * weight) @ others.T
    whole[:, : 2 * count, 2 * count :], whole[:, 2 * count :, : 2 * count] = mixed, mixed.T
    shares = weight / (1.0 + k1[:, None] * y - k2[:, None] * x)
    divided = (shares[:, None] * others).reshape(-1, len(x)) @ others.T
    whole[:, 2 * count :, 2 * count :] = divided.reshape(-1, 2 * count, 2 * count)
    return np.ascontiguousarray(whole.reshape(-1, 4, count, 4, count).transpose(0, 1, 3, 2, 4))
