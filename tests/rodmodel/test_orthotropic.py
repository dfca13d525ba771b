"""Orthotropic rods."""

from __future__ import annotations

import numpy as np
import pytest

import rodmodel as rm
from rodmodel.section import elasticity_matrix

WOOD = rm.Orthotropic((900.0, 500.0, 12000.0), (700.0, 800.0, 60.0), (0.4, 0.03, 0.02))


def test_equal_moduli_are_the_isotropic_law() -> None:
    shear = 200e3 / 2.6
    same = rm.Orthotropic((200e3,) * 3, (shear,) * 3, (0.3,) * 3)
    for level in (1, 2):
        expected = elasticity_matrix(rm.Material(200e3, 0.3), level)
        np.testing.assert_allclose(elasticity_matrix(same, level), expected, rtol=1e-12, atol=1e-9)


def test_uniaxial_stress_contracts_as_the_ratios_say() -> None:
    """nu_31 = nu_13 E_3 / E_1 and nu_32 = nu_23 E_3 / E_2 across the grain."""
    strain = np.array([-0.03 / 900.0, -0.02 / 500.0, 1.0 / 12000.0, 0.0, 0.0, 0.0])
    np.testing.assert_allclose(elasticity_matrix(WOOD, 2) @ strain, [0, 0, 1, 0, 0, 0], atol=1e-12)


def test_a_law_without_energy_is_refused() -> None:
    with pytest.raises(rm.SceneError, match="poisson_ratios"):
        rm.Orthotropic((1.0, 1.0, 1.0), (1.0, 1.0, 1.0), (0.9, 0.9, 0.9))
    with pytest.raises(rm.SceneError, match="shear_moduli"):
        rm.Orthotropic((1.0, 1.0, 1.0), (1.0, 0.0, 1.0), (0.0, 0.0, 0.0))


@pytest.mark.parametrize(("force", "shear"), [((0.0, 1.0, 0.0), 700.0), ((0.0, 0.0, 1.0), 800.0)])
def test_a_wooden_bar_bends_by_its_own_shear_modulus(force: tuple[float, float, float], shear: float) -> None:
    """F L^3 / (3 E_3 I) + F L / (k G A), k = 5/6, G_23 for a load along e2 and G_13 along e1; no contraction."""
    wood = rm.Orthotropic(WOOD.young_moduli, WOOD.shear_moduli, (0.0, 0.0, 0.0))
    rod = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (200.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
        rm.Rectangle(20.0, 20.0),
        wood,
        (0, 60, 200),
    )
    scene = rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (rm.SectionForce("bar", 200.0, force),), ())
    end = rm.solve(scene, level=3, order=5).displacement("bar", np.array([200.0]))[:, 0]
    expected = 200.0**3 / (3.0 * 12000.0 * 20.0**4 / 12.0) + 200.0 / (5.0 / 6.0 * shear * 400.0)
    # the clamp holds the warping of the section, over a length sqrt(E / G) times its height
    assert np.dot(end, force) == pytest.approx(expected, rel=5e-3)
