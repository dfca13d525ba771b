"""Functions over a cross-section: polynomials of total degree up to the level, orthonormal over the section.

(1/A) int phi_m phi_n dA = delta_mn. They are graded: level k + 1 adds the functions of degree k + 1 to those of level
k. Rectangle: products of Legendre polynomials. Circle and ring: Zernike's circle polynomials and their annular kin,
stable for any wall (Mahajan, J. Opt. Soc. Am. 71, 1981, 75-85). Box and polygon: x and y times earlier functions,
orthogonalised over quadrature points (multivariate Vandermonde with Arnoldi; Brubeck, Nakatsukasa and Trefethen, SIAM
Review 63, 2021, 405-415), and the same recurrence for values and slopes anywhere.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Section
from rodmodel.axial import gauss, legendre, legendre_derivatives
from rodmodel.shape import extents, mirror_planes, section_quadrature

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Beyond this loss of orthonormality, seen at points other than those it was built on, a basis is refused.
_LARGEST_LOSS = 1e-8


@dataclass(frozen=True, eq=False)
class ProductRecurrence:
    """Box and polygon: phi_n = scale_n z_n phi_parent - sum_m<n projection_nm phi_m, z_n = x or y; phi_0 = 1.

    Parameters
    ----------
    parent : which earlier function is multiplied, shape (n_functions,); of the first, 0 and unused
    by_x : whether it is multiplied by x, shape (n_functions,)
    scale : 1/mm, shape (n_functions,)
    projection : shape (n_functions, n_functions), strictly lower triangle
    """

    parent: IntArray
    by_x: NDArray[np.bool_]
    scale: Array
    projection: Array


@dataclass(frozen=True, eq=False)
class RadialRecurrence:
    """Circle and ring: phi = Re or Im ((x + iy) / R)^m times R_mn(t), t = (2 r^2 - R^2 - R_i^2) / (R^2 - R_i^2).

    after_mn R_m,n+1 = (t - centre_mn) R_mn - after_m,n-1 R_m,n-1, R_m0 = first_m.

    Parameters
    ----------
    outer, inner : R, R_i, mm
    first : shape (level + 1,)
    centre, after : row m, column n, each of shape (level + 1, level // 2 + 1)
    """

    outer: float
    inner: float
    first: Array
    centre: Array
    after: Array


@dataclass(frozen=True, eq=False)
class SectionBasis:
    """Orthonormal functions over a section; made by `section_basis`.

    Parameters
    ----------
    level : k, greatest total degree
    degrees : i and j of each function, shape (2, n_functions): in the order of i + j, then of j. Where the section is
        symmetric about x = 0 (y = 0), the function is even or odd in x (y) as x^i (y^j) is. On a rectangle, box and
        polygon it is x^i y^j and terms before it in this order; on a circle and ring it is r^(m + 2 n) cos(m theta),
        (i, j) = (m, 2 n), or r^(m + 2 n) sin(m theta), (i, j) = (m - 1, 2 n + 1), and terms of lower degree.
    """

    section: Section
    level: int
    degrees: IntArray
    recurrence: ProductRecurrence | RadialRecurrence | None

    @property
    def count(self) -> int:
        """Number of functions, (k + 1)(k + 2) / 2."""
        return int(self.degrees.shape[1])


@lru_cache(maxsize=64)
def section_basis(section: Section, level: int) -> SectionBasis:
    """The orthonormal functions of total degree up to `level` over a section.

    Raises
    ------
    ValueError
        if polynomials are so nearly dependent on the section that round-off costs more than 1e-8 of their
        orthonormality.

    Notes
    -----
    Measured loss of orthonormality. By thin walls: below 1e-12 for walls of 1 % of the size of a ring, box, I or L,
    about 1e-10 for 0.1 %, at any level up to 20; refused from about 1e-6 (I) or 1e-8 (ring, box). By the level, on
    sections with arms, a T being the worst: 2e-12 at h12, 3e-10 at h16, refused at h19.
    """
    degrees = np.array([(total - j, j) for total in range(level + 1) for j in range(total + 1)], dtype=np.int64).T
    recurrence: ProductRecurrence | RadialRecurrence | None = None
    if isinstance(section, Circle):
        recurrence = _radial_recurrence(level, 0.0, 0.5 * section.diameter)
    elif isinstance(section, Ring):
        recurrence = _radial_recurrence(level, 0.5 * section.inner_diameter, 0.5 * section.outer_diameter)
    elif isinstance(section, Box | Polygon):
        recurrence = _product_recurrence(section, level, degrees)
    basis = SectionBasis(section, level, degrees, recurrence)
    if recurrence is not None:
        _require_orthonormal(basis)
    return basis


def basis_values(basis: SectionBasis, x: Array, y: Array) -> Array:
    """Values of the functions at section points (mm), shape (n_functions, n_points)."""
    recurrence = basis.recurrence
    if isinstance(recurrence, ProductRecurrence):
        return _product_values(recurrence, x, y)
    if isinstance(recurrence, RadialRecurrence):
        return _radial_values(basis, recurrence, x, y)
    return _legendre_values(basis, x, y)


def basis_slopes(basis: SectionBasis, x: Array, y: Array) -> tuple[Array, Array]:
    """Derivatives of the functions by x and by y, 1/mm, each of shape (n_functions, n_points)."""
    recurrence = basis.recurrence
    if isinstance(recurrence, ProductRecurrence):
        return _product_slopes(recurrence, x, y)
    if isinstance(recurrence, RadialRecurrence):
        return _radial_slopes(basis, recurrence, x, y)
    return _legendre_slopes(basis, x, y)


def _legendre_values(basis: SectionBasis, x: Array, y: Array) -> Array:
    xi, eta, scale = _scaled(basis, x, y)
    i, j = basis.degrees
    return np.asarray((scale * legendre(basis.level, xi))[i] * (scale * legendre(basis.level, eta))[j])


def _legendre_slopes(basis: SectionBasis, x: Array, y: Array) -> tuple[Array, Array]:
    section, level = basis.section, basis.level
    assert isinstance(section, Rectangle)
    xi, eta, scale = _scaled(basis, x, y)
    along_x, along_y = scale * legendre(level, xi), scale * legendre(level, eta)
    slope_x = scale * legendre_derivatives(level, xi) * (2.0 / section.width)
    slope_y = scale * legendre_derivatives(level, eta) * (2.0 / section.height)
    i, j = basis.degrees
    return slope_x[i] * along_y[j], along_x[i] * slope_y[j]


def _scaled(basis: SectionBasis, x: Array, y: Array) -> tuple[Array, Array, Array]:
    """2 x / width, 2 y / height, and the factors sqrt(2 n + 1) that give Legendre polynomials mean square one."""
    assert isinstance(basis.section, Rectangle)
    scale = np.sqrt(2.0 * np.arange(basis.level + 1) + 1.0)[:, None]
    return 2.0 * x / basis.section.width, 2.0 * y / basis.section.height, scale


def _product_recurrence(section: Box | Polygon, level: int, degrees: IntArray) -> ProductRecurrence:
    """That of the level below and one more degree.

    Functions of opposite parity are orthogonal by symmetry: their projection is zero, not round-off. x phi_(i-1)j and
    y phi_i(j-1) lead to the same function; the one that keeps more of its length loses fewer digits.
    """
    count = degrees.shape[1]
    parent, by_x = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.bool_)
    scale, projection = np.zeros(count), np.zeros((count, count))
    if level == 0:
        return ProductRecurrence(parent, by_x, scale, projection)
    below = section_basis(section, level - 1)
    known, lower = below.count, below.recurrence
    assert isinstance(lower, ProductRecurrence)
    parent[:known], by_x[:known], scale[:known] = lower.parent, lower.by_x, lower.scale
    projection[:known, :known] = lower.projection

    x, y, weight = section_quadrature(section, 2 * level)
    share = weight / np.sum(weight)
    values = np.empty((count, len(x)))
    values[:known] = _product_values(lower, x, y)
    parity = degrees % 2 * np.array(mirror_planes(section))[:, None]
    for n in range(known, count):
        j = int(degrees[1, n])
        same_parity = np.all(parity[:, :n] == parity[:, n : n + 1], axis=0)
        largest = 0.0
        # One degree lower, (i - 1, j) stands as many places earlier as the degree has, (i, j - 1) one more.
        for multiply_x, source in ((True, n - level), (False, n - level - 1)):
            if (multiply_x and j == level) or (not multiply_x and j == 0):
                continue
            product = (x if multiply_x else y) * values[source]
            length = np.sqrt(share @ product**2)
            coefficient = np.zeros(n)
            for _ in range(2):
                correction = same_parity * (values[:n] @ (share * product))
                product -= correction @ values[:n]
                coefficient += correction
            rest = np.sqrt(share @ product**2)
            if rest > largest * length:
                largest = rest / length
                parent[n], by_x[n], scale[n] = source, multiply_x, 1.0 / rest
                projection[n, :n] = coefficient / rest
                values[n] = product / rest
    return ProductRecurrence(parent, by_x, scale, projection)


def _require_orthonormal(basis: SectionBasis) -> None:
    x, y, weight = section_quadrature(basis.section, 2 * basis.level + 2)
    values = basis_values(basis, x, y)
    loss = float(np.max(np.abs((values * (weight / np.sum(weight))) @ values.T - np.eye(basis.count))))
    if not loss <= _LARGEST_LOSS:
        x_min, x_max, y_min, y_max = extents(basis.section)
        shape = f"{type(basis.section).__name__.lower()} of {x_max - x_min:g} x {y_max - y_min:g} mm"
        raise ValueError(
            f"{shape}: found walls so thin that functions of level {basis.level} are orthonormal to {loss:.1g} only; "
            f"{_LARGEST_LOSS:g} is needed, by thicker walls or a lower level"
        )


def _product_values(recurrence: ProductRecurrence, x: Array, y: Array) -> Array:
    values = np.empty((len(recurrence.parent), len(x)))
    values[0] = 1.0
    for n in range(1, len(values)):
        factor = recurrence.scale[n] * (x if recurrence.by_x[n] else y)
        values[n] = factor * values[recurrence.parent[n]] - recurrence.projection[n, :n] @ values[:n]
    return values


def _product_slopes(recurrence: ProductRecurrence, x: Array, y: Array) -> tuple[Array, Array]:
    """The recurrence differentiated; value, slope by x and slope by y run side by side."""
    points = len(x)
    jet = np.zeros((len(recurrence.parent), 3 * points))
    jet[0, :points] = 1.0
    for n in range(1, len(jet)):
        multiply_x, scale = recurrence.by_x[n], recurrence.scale[n]
        before = jet[recurrence.parent[n]]
        jet[n] = scale * np.tile(x if multiply_x else y, 3) * before - recurrence.projection[n, :n] @ jet[:n]
        slope = jet[n, points : 2 * points] if multiply_x else jet[n, 2 * points :]
        slope += scale * before[:points]
    return jet[:, points : 2 * points], jet[:, 2 * points :]


def _radial_recurrence(level: int, inner: float, outer: float) -> RadialRecurrence:
    """Stieltjes procedure for the weight r^2m d(r^2), all m at once; Gauss points in t are Gauss points in r^2."""
    t, weight = gauss(level + 1)
    squared = 0.5 * (1.0 + (inner / outer) ** 2) + 0.5 * (1.0 - (inner / outer) ** 2) * t
    m = np.arange(level + 1)[:, None]
    # Mean over the section: 1/2 of the integral over t; cos^2 and sin^2 have mean 1/2 over the angles.
    share = np.where(m == 0, 0.5, 0.25) * weight * squared**m
    first = 1.0 / np.sqrt(np.sum(share, axis=1))
    count = level // 2 + 1
    centre, after = np.zeros((level + 1, count)), np.zeros((level + 1, count))
    before, value = np.zeros_like(share), np.broadcast_to(first[:, None], share.shape)
    for n in range(count):
        centre[:, n] = np.sum(share * t * value**2, axis=1)
        following = (t - centre[:, n : n + 1]) * value - (after[:, n - 1 : n] * before if n else 0.0)
        after[:, n] = np.sqrt(np.sum(share * following**2, axis=1))
        before, value = value, following / after[:, n : n + 1]
    return RadialRecurrence(outer, inner, first, centre, after)


def _radial_values(basis: SectionBasis, recurrence: RadialRecurrence, x: Array, y: Array) -> Array:
    radial, _ = _radial_factors(recurrence, x, y)
    return _angular(basis, _powers(basis.level, recurrence.outer, x, y)) * _chosen(basis, radial)


def _radial_slopes(basis: SectionBasis, recurrence: RadialRecurrence, x: Array, y: Array) -> tuple[Array, Array]:
    radial, radial_slope = (_chosen(basis, factor) for factor in _radial_factors(recurrence, x, y))
    power = _powers(basis.level, recurrence.outer, x, y)
    # d/dx z^m = m z^(m - 1) / R, d/dy z^m = i m z^(m - 1) / R.
    power_slope = np.zeros_like(power)
    power_slope[1:] = (np.arange(1, basis.level + 1)[:, None] / recurrence.outer) * power[:-1]
    angular = _angular(basis, power)
    t_slope = 4.0 / (recurrence.outer**2 - recurrence.inner**2)
    slope_x = _angular(basis, power_slope) * radial + angular * radial_slope * (t_slope * x)
    slope_y = _angular(basis, 1j * power_slope) * radial + angular * radial_slope * (t_slope * y)
    return slope_x, slope_y


def _powers(level: int, outer: float, x: Array, y: Array) -> NDArray[np.complex128]:
    """((x + iy) / R)^m for m = 0..level, shape (level + 1, n_points)."""
    power = np.ones((level + 1, len(x)), dtype=np.complex128)
    power[1:] = (x + 1j * y) / outer
    return np.asarray(np.cumprod(power, axis=0))


def _angular(basis: SectionBasis, power: NDArray[np.complex128]) -> Array:
    """Re z^m where j is even, Im z^m where it is odd, shape (n_functions, n_points)."""
    i, j = basis.degrees
    odd = j % 2
    return np.asarray(np.where(odd[:, None] == 1, power.imag[i + odd], power.real[i + odd]))


def _chosen(basis: SectionBasis, radial: Array) -> Array:
    i, j = basis.degrees
    return np.asarray(radial[i + j % 2, j // 2])


def _radial_factors(recurrence: RadialRecurrence, x: Array, y: Array) -> tuple[Array, Array]:
    """R_mn and dR_mn/dt, each of shape (level + 1, level // 2 + 1, n_points)."""
    inner, outer = recurrence.inner**2, recurrence.outer**2
    t = ((x**2 + y**2 - inner) + (x**2 + y**2 - outer)) / (outer - inner)
    count = recurrence.centre.shape[1]
    value = np.zeros((*recurrence.centre.shape, len(t)))
    slope = np.zeros_like(value)
    value[:, 0] = recurrence.first[:, None]
    for n in range(count - 1):
        from_centre, after = t - recurrence.centre[:, n, None], recurrence.after[:, n, None]
        value[:, n + 1] = from_centre * value[:, n]
        slope[:, n + 1] = from_centre * slope[:, n] + value[:, n]
        if n > 0:
            before = recurrence.after[:, n - 1, None]
            value[:, n + 1] -= before * value[:, n - 1]
            slope[:, n + 1] -= before * slope[:, n - 1]
        value[:, n + 1] /= after
        slope[:, n + 1] /= after
    return value, slope
