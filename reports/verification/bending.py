"""Straight rods in bending: no locking, the clamp's three-dimensional effect, and three shear coefficients."""

from __future__ import annotations

import math
from functools import cache

import numpy as np
from numpy.typing import NDArray

import reference3d
import rodmodel
from cases.scene import Material, Rectangle, Scene
from reports.verification.check import Check, Group, Reference, elasticity
from reports.verification.scenes import ROD, STEEL, WITHOUT_CONTRACTION, clamped, end_force, straight, work

Array = NDArray[np.float64]

SIDE = 10.0
SECTION = Rectangle(SIDE, SIDE)
AREA, SECOND_MOMENT = SIDE**2, SIDE**4 / 12.0
ORDER = 6
# Gauss points across the section for mean displacements and for the energy of the shear stress
ACROSS = 16


def cantilever(length: float, material: Material) -> Scene:
    """Square section, unit force along Y at the end."""
    line = straight(length)
    return clamped(line, SECTION, material, SIDE, 1, end_force(line, (0.0, 1.0, 0.0)))


def slender_deflection(level: int) -> float:
    """Tip deflection at L / h = 1000, mm."""
    return work(cantilever(1000.0 * SIDE, STEEL), level, ORDER)


def slender_reference() -> Reference:
    """F L^3 / (3 E I), uncertain by 0.1 h / L, as the clamp holds the section."""
    length = 1000.0 * SIDE
    deflection = length**3 / (3.0 * STEEL.young_modulus * SECOND_MOMENT)
    return Reference(deflection, 0.1 * deflection * SIDE / length)


def short_deflection(level: int) -> float:
    """Mean deflection of the loaded end section at L / h = 4, mm."""
    return work(cantilever(4.0 * SIDE, STEEL), level, ORDER)


@cache
def short_reference() -> Reference:
    """The same from 3D on three meshes, extrapolated, with its grid convergence index."""
    return solid_work(cantilever(4.0 * SIDE, STEEL))


def solid_work(scene: Scene) -> Reference:
    """Work of the loads in 3D, extrapolated from three meshes (ASME V&V 20)."""
    solutions = reference3d.solve_sequence(scene)
    coarse, medium, fine = (2.0 * solution.strain_energy for solution in solutions)
    sizes = tuple(solution.representative_size for solution in solutions)
    found = reference3d.grid_convergence(
        (coarse, medium, fine), (sizes[0], sizes[1], sizes[2]), reference3d.formal_order(scene)
    )
    return Reference(found.extrapolated, found.uncertainty)


def deflection_shear_coefficient(level: int) -> float:
    """K from the tip deflections of two cantilevers less their bending part, F L / (k G A) in the difference.

    With nu = 0 the clamp disturbs neither tension nor bending; what it does to the shear does not grow with the length.
    """
    material = WITHOUT_CONTRACTION
    lengths = (4.0 * SIDE, 8.0 * SIDE)
    shear_part = [
        work(cantilever(length, material), level, ORDER) - length**3 / (3.0 * material.young_modulus * SECOND_MOMENT)
        for length in lengths
    ]
    shear_modulus = material.young_modulus / 2.0
    return (lengths[1] - lengths[0]) / (shear_modulus * AREA * (shear_part[1] - shear_part[0]))


def _square_points(station: float) -> tuple[Array, Array]:
    """Gauss points (x, y, s) over the section at a station, shape (3, n), and weights that sum to one."""
    node, weight = np.polynomial.legendre.leggauss(ACROSS)
    x, y = (grid.ravel() for grid in np.meshgrid(node * SIDE / 2.0, node * SIDE / 2.0, indexing="ij"))
    return np.array([x, y, np.full_like(x, station)]), np.outer(weight, weight).ravel() / 4.0


def kinematic_shear_coefficient(level: int) -> float:
    """K = F / (G A (W' + Phi)) in the middle of a cantilever, W the mean deflection, Phi the mean rotation.

    Phi = -int w y dA / I with w along the rod: Cowper's definitions.
    """
    solution = rodmodel.solve(cantilever(12.0 * SIDE, STEEL), level, ORDER)
    middle, step = 6.0 * SIDE, 0.25 * SIDE

    def mean_deflection(station: float) -> float:
        points, weight = _square_points(station)
        return float(weight @ solution.displacement_at(ROD, points)[1])

    # five-point formula, exact here: W is a cubic
    ahead, behind = (mean_deflection(middle + sign * step) for sign in (1.0, -1.0))
    far_ahead, far_behind = (mean_deflection(middle + 2.0 * sign * step) for sign in (1.0, -1.0))
    slope = (8.0 * (ahead - behind) - (far_ahead - far_behind)) / (12.0 * step)
    points, weight = _square_points(middle)
    rotation = float(weight @ (solution.displacement_at(ROD, points)[0] * points[1])) * AREA / SECOND_MOMENT
    shear_modulus = STEEL.young_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
    return 1.0 / (shear_modulus * AREA * (slope + rotation))


def energy_shear_coefficient(level: int) -> float:
    """K = F^2 / (A int tau^2 dA) from the shear stress in the middle of a cantilever."""
    solution = rodmodel.solve(cantilever(12.0 * SIDE, STEEL), level, ORDER)
    points, weight = _square_points(6.0 * SIDE)
    shear = solution.stress(ROD, points)[3:5]
    return 1.0 / (AREA * float(weight @ (shear**2).sum(axis=0)) * AREA)


def cowper_coefficient(poisson_ratio: float) -> float:
    """10 (1 + nu) / (12 + 11 nu), rectangle."""
    return 10.0 * (1.0 + poisson_ratio) / (12.0 + 11.0 * poisson_ratio)


def elastic_energy_coefficient(poisson_ratio: float) -> float:
    """Coefficient of the shear energy of a square in Saint-Venant's flexure.

    Timoshenko and Goodier, article 122: tau_xz = phi_y + P (a^2 - x^2) / (2 I), tau_yz = -phi_x, and phi = 0 on the
    border with Laplacian nu / (1 + nu) P y / I. Then int tau^2 = P^2 (6 / 5) / A + int |grad phi|^2, which the sine
    series of phi in y sums up (J. D. Renton, International Journal of Solids and Structures 27 (1991) 1707-1713).
    """
    n = np.arange(1, 41)
    series = 0.2 - 18.0 / math.pi**5 * float((np.tanh(n * math.pi) / n**5).sum())
    return 1.0 / (1.2 + (poisson_ratio / (1.0 + poisson_ratio)) ** 2 * series)


GROUP = Group(
    "Straight rods in bending",
    "Cantilevers of square section under a force spread over the end section; p = 6. A shear coefficient has no value "
    "before it is said of what: three are recovered here, each by its own definition.",
    (
        Check(
            "Slender cantilever, L / h = 1000",
            "No shear or membrane locking: F L³ / (3 E I) at p = 6, nu = 0.3.",
            "closed form",
            "L. Euler, J. Bernoulli; uncertain by 0.1 h / L, as the clamp holds the section",
            "mm",
            slender_reference,
            slender_deflection,
            1e-3,
            1,
        ),
        Check(
            "Short cantilever, L / h = 4",
            "The clamp's hold on the section, which beam theory leaves out: nu = 0.3.",
            "3d converged",
            "3D of this run: 27-node hexahedra, three meshes, extrapolated",
            "mm",
            short_reference,
            short_deflection,
            2e-3,
            5,
        ),
        Check(
            "Shear coefficient of the tip deflection",
            "Timoshenko's 5/6, from tip deflections at L / h = 4 and 8 less their bending part; nu = 0.",
            "closed form",
            elasticity(122) + ", with nu = 0",
            "",
            lambda: Reference(5.0 / 6.0),
            deflection_shear_coefficient,
            1e-6,
            3,
        ),
        Check(
            "Shear coefficient of mean displacements",
            "Cowper's 10 (1 + nu) / (12 + 11 nu), from mean deflection and mean rotation inside the rod; nu = 0.3.",
            "closed form",
            "G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335-340",
            "",
            lambda: Reference(cowper_coefficient(STEEL.poisson_ratio)),
            kinematic_shear_coefficient,
            1e-5,
            3,
        ),
        Check(
            "Shear coefficient of the energy",
            "Exact elasticity, from the energy of the shear stress inside the rod; nu = 0.3.",
            "closed form",
            elasticity(122),
            "",
            lambda: Reference(elastic_energy_coefficient(STEEL.poisson_ratio)),
            energy_shear_coefficient,
            1e-3,
            5,
        ),
    ),
)
