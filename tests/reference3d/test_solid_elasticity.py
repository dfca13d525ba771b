"""Patch tests: constant strain and rigid motions on curved, twisted elements of distorted sections."""

import numpy as np
import pytest

from cases.scene import Clamp, Helix, Material, Orthotropic, Polygon, Rod, Scene, Spline
from reference3d.solid_body import SolidBody, solid_body
from reference3d.solid_elasticity import elasticity
from reference3d.solid_solution import SolidRod

STEEL = Material(200000.0, 0.3)
WOOD = Orthotropic((900.0, 500.0, 12000.0), (700.0, 800.0, 60.0), (0.4, 0.03, 0.02))
SECTION = Polygon(((0.0, 0.0), (12.0, 1.0), (9.0, 7.0), (4.0, 5.0), (-1.0, 9.0)))
HELIX = Helix((30.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0, (0.0, 0.3, 1.0), 20.0)
SPLINE = Spline(((0.0, 0.0, 0.0), (20.0, 10.0, 0.0), (50.0, 0.0, 20.0), (70.0, 20.0, 30.0)), (0.0, 0.0, 1.0))
GRADIENT = np.array([[1.0, -2.0, 0.5], [0.3, 0.7, 1.1], [-0.8, 0.2, -0.4]]) * 1e-3


def body_of(line, material=STEEL) -> SolidBody:
    rod = Rod("rod", line, SECTION, material, (0.0, line.length))
    return solid_body(Scene("patch", (rod,), (Clamp("rod", "start"),), (), ()), rod, 1)


def linear_field(body, gradient):
    """Nodal components of the displacement gradient @ X."""
    place = body.points[:, None] + body.section.nodes @ body.axes[:, :2]
    return np.einsum("pnc,dc,pbd->pnb", place, gradient, body.axes)


def interior(body):
    """Nodes that no free surface has: those of every section element's middle, off the end planes."""
    return body.section.quads[:, 4]


@pytest.mark.parametrize("line", [HELIX, SPLINE], ids=["helix", "spline"])
def test_a_constant_strain_is_in_balance_and_has_its_constant_stress(line):
    body = body_of(line)
    field = linear_field(body, GRADIENT)
    strain = 0.5 * (GRADIENT + GRADIENT.T)
    lam, mu = 200000.0 * 0.3 / (1.3 * 0.4), 200000.0 / 2.6
    stress = lam * np.trace(strain) * np.eye(3) + 2.0 * mu * strain

    forces, beds = body.internal_forces(field)

    # round-off of the largest nodal force; the Gauss rule integrates constant stress exactly on any element
    assert np.abs(forces[1:-1][:, interior(body)]).max() < 1e-11 * np.abs(forces).max()
    assert not beds.any()
    volume = sum(float((body.kind == kind).sum() * layer.volume.sum()) for kind, layer in enumerate(body.layers))
    assert 0.5 * np.vdot(field, forces) == pytest.approx(0.5 * np.sum(stress * strain) * volume, rel=1e-12)

    layer = np.array([0, 3, 5])
    quads, local = np.array([0, 1, 2]), np.array([[0.1, -0.7], [1.0, 1.0], [-0.3, 0.2]])
    found = SolidRod(body, field).stress_at(layer, np.array([-0.5, 0.9, 0.0]), quads, local)
    # invariants do not depend on the frame
    assert found[:3].sum(axis=0) == pytest.approx(np.trace(stress), rel=1e-11)
    squared = (found[:3] ** 2).sum(axis=0) + 2.0 * (found[3:] ** 2).sum(axis=0)
    assert squared == pytest.approx(np.sum(stress**2), rel=1e-11)


@pytest.mark.parametrize("material", [STEEL, WOOD], ids=["isotropic", "orthotropic"])
@pytest.mark.parametrize("line", [HELIX, SPLINE], ids=["helix", "spline"])
def test_rigid_motions_are_free_of_stress(line, material):
    body = body_of(line, material)
    turn = np.array([[0.0, -1.0, 2.0], [1.0, 0.0, -3.0], [-2.0, 3.0, 0.0]]) * 1e-3
    field = linear_field(body, turn) + np.array([0.3, -0.2, 0.1]) @ np.swapaxes(body.axes, 1, 2)[:, None]

    forces, _ = body.internal_forces(field)
    strained, _ = body.internal_forces(linear_field(body, GRADIENT))

    # layers that are alike to 1e-11 of their length share their matrices
    assert np.abs(forces).max() < 1e-10 * np.abs(strained).max()


def test_an_orthotropic_material_with_equal_moduli_is_the_isotropic_one():
    equal = Orthotropic((200000.0,) * 3, (200000.0 / 2.6,) * 3, (0.3,) * 3)

    np.testing.assert_allclose(elasticity(equal), elasticity(STEEL), rtol=1e-13, atol=1e-9)


def test_along_a_helix_layers_of_one_length_share_their_matrices():
    body = body_of(HELIX)

    assert len(body.layers) == len(np.unique(np.round(np.diff(body.borders), 8)))
    assert len(body.layers) < len(body.kind)
