"""Linear elastic materials."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cases.checks import Vector, require, require_finite, require_positive

# Four times the density of osmium, t/mm^3: beyond it, a density was given in another unit.
DENSEST = 1e-7


@dataclass(frozen=True)
class Material:
    """Isotropic linear elasticity (Hooke's law in three dimensions).

    Parameters
    ----------
    young_modulus : E, MPa
    poisson_ratio : nu, between -1 and 0.5 (both excluded)
    density : rho, t/mm^3; only gravity asks for it
    """

    young_modulus: float
    poisson_ratio: float
    density: float | None = None

    def __post_init__(self) -> None:
        require_positive(self.young_modulus, "young_modulus", "Young's modulus")
        ok = -1.0 < self.poisson_ratio < 0.5
        require(ok, "poisson_ratio", f"{self.poisson_ratio:g}", "Poisson's ratio lies between -1 and 0.5")
        _require_density(self.density)


@dataclass(frozen=True)
class Orthotropic:
    """Linear elasticity with three planes of symmetry, those of the rod's frame (e1, e2, t).

    Parameters
    ----------
    young_moduli : E_1, E_2, E_3 along e1, e2 and t, MPa
    shear_moduli : G_23, G_13, G_12 between e2 and t, e1 and t, e1 and e2, MPa
    poisson_ratios : nu_12, nu_13, nu_23; nu_ij is the contraction along j for one of extension along i
    density : rho, t/mm^3; only gravity asks for it
    """

    young_moduli: Vector
    shear_moduli: Vector
    poisson_ratios: Vector
    density: float | None = None

    def __post_init__(self) -> None:
        for key, moduli in (("young_moduli", self.young_moduli), ("shear_moduli", self.shear_moduli)):
            require_finite(moduli, key)
            require(min(moduli) > 0.0, key, list(moduli), "moduli must be positive")
        require_finite(self.poisson_ratios, "poisson_ratios")
        (e1, e2, e3), (nu12, nu13, nu23) = self.young_moduli, self.poisson_ratios
        compliance = np.array(
            [
                [1.0 / e1, -nu12 / e1, -nu13 / e1],
                [-nu12 / e1, 1.0 / e2, -nu23 / e2],
                [-nu13 / e1, -nu23 / e2, 1.0 / e3],
            ]
        )
        scale = np.sqrt(np.diag(compliance))
        stable = float(np.linalg.eigvalsh(compliance / np.outer(scale, scale))[0]) > 1e-9
        remedy = "they must leave every strain an energy: nu_ij^2 < E_i / E_j, and not all of them at once near that"
        require(stable, "poisson_ratios", list(self.poisson_ratios), remedy)
        _require_density(self.density)


def _require_density(density: float | None) -> None:
    if density is not None:
        require_positive(density, "density", "a density")
        remedy = "no material is denser than 1e-7 t/mm^3; steel has 7.85e-9 t/mm^3, which is 7850 kg/m^3"
        require(density <= DENSEST, "density", f"{density:g} t/mm^3", remedy)
