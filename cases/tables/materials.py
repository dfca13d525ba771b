"""Tables of materials."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from cases.tables.values import Density, Number, Stress, Table


class IsotropicTable(Table):
    """A linear elastic, isotropic material."""

    law: Literal["isotropic"] = "isotropic"
    """Law of elasticity: "isotropic" (as without this key) or "orthotropic"."""
    young_modulus: Stress
    """Young's modulus E, a stress, such as "200 GPa"; positive."""
    poisson_ratio: Number
    """Poisson's ratio, between -1 and 0.5."""
    density: Density | None = None
    """Density with its unit, such as "7850 kg/m^3"; needed for gravity alone."""


class OrthotropicTable(Table):
    """A linear elastic material with three planes of symmetry, those of the rod's section axes x, y and its line s."""

    law: Literal["orthotropic"]
    """Law of elasticity: "orthotropic" or "isotropic"."""
    young_moduli: tuple[Stress, Stress, Stress]
    """Young's moduli along x, y and s, three stresses, such as ["1 GPa", "1 GPa", "40 GPa"]; positive."""
    shear_moduli: tuple[Stress, Stress, Stress]
    """Shear moduli G_ys, G_xs, G_xy, three stresses, such as ["3 GPa", "3 GPa", "0.5 GPa"]; positive."""
    poisson_ratios: tuple[Number, Number, Number]
    """Poisson's ratios nu_xy, nu_xs, nu_ys, three numbers; nu_ij is the contraction along j for an extension of one
    along i, so that nu_xs = nu_sx E_x / E_s."""
    density: Density | None = None
    """Density with its unit, such as "600 kg/m^3"; needed for gravity alone."""


def _isotropic_unless_said(table: object) -> object:
    return {"law": "isotropic", **table} if isinstance(table, dict) else table


MaterialTable = Annotated[
    IsotropicTable | OrthotropicTable, Field(discriminator="law"), BeforeValidator(_isotropic_unless_said)
]
