"""A rod of any elements: rigid motions and even strains are exact, points are found, loads arrive whole."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cases.scene import (
    Clamp,
    Gravity,
    Line,
    LineLoad,
    Load,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
)
from reference3d.own_mesh.body import OwnBody
from reference3d.own_mesh.reading import read_rods

STEEL = Material(200_000.0, 0.3, density=7.85e-9)
LINE = Line((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (0.0, 1.0, 0.0))
ROD = Rod("bar", LINE, Rectangle(8.0, 10.0), STEEL, (0.0, 20.0, 40.0))
SCENE = Scene("bar", (ROD,), (Clamp("bar", "start"),), (), ())
SLOPE = 1e-3 * np.array([[1.0, 0.2, -0.3], [0.4, -0.5, 0.6], [0.1, 0.7, 0.3]])


@pytest.fixture(params=["hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10"])
def body(request: pytest.FixtureRequest, bars: Callable[..., Path]) -> OwnBody:
    """A bar of elements that gmsh has put where it liked, inner corners of hexahedra moved at random."""
    mesh = read_rods(SCENE, bars({"bar": (0.0, 40.0, -5.0, 5.0, -4.0, 4.0)}, request.param, 4.0))["bar"]
    corners = np.unique(mesh.elements[:, : mesh.kind.corners])
    if mesh.kind.is_simplex or len(corners) < len(mesh.nodes):
        return OwnBody(mesh, STEEL)
    inner = (np.abs(mesh.nodes - (20.0, 0.0, 0.0)) < (19.9, 4.9, 3.9)).all(axis=1)
    mesh.nodes[inner] += 0.5 * (np.random.default_rng(3).random((int(inner.sum()), 3)) - 0.5)
    return OwnBody(mesh, STEEL)


def test_an_even_strain_makes_no_force_inside_and_its_stress_everywhere(body: OwnBody) -> None:
    """The patch test: u = A x on an arbitrary mesh, with Hooke's law for its stress."""
    nodes = body.mesh.nodes
    moved = nodes @ SLOPE.T
    inner = (np.abs(nodes - (20.0, 0.0, 0.0)) < (19.9, 4.9, 3.9)).all(axis=1)
    places = np.array([[13.1, 1.7, -2.2], [31.9, -4.2, 0.6], [20.0, 0.0, 0.0]])

    force = (body.stiffness() @ moved.ravel()).reshape(-1, 3)
    stress = body.stress(moved, body.find(places), np.tile(np.eye(3), (3, 1, 1)))

    assert inner.any()
    assert np.abs(force[inner]).max() < 1e-10 * np.abs(force).max()
    strain, (lam, mu) = 0.5 * (SLOPE + SLOPE.T), (200_000.0 * 0.3 / (1.3 * 0.4), 200_000.0 / 2.6)
    tensor = 2.0 * mu * strain + lam * np.trace(strain) * np.eye(3)
    expected = tensor[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]
    assert stress == pytest.approx(np.tile(expected[:, None], 3), rel=1e-9)


def test_turning_as_a_rigid_body_makes_no_force(body: OwnBody) -> None:
    turned = 1e-3 * np.cross([0.3, -0.5, 0.8], body.mesh.nodes) + [0.1, 0.2, 0.3]

    force = body.stiffness() @ turned.ravel()

    stiffest = body.stiffness().diagonal().max() * np.abs(turned).max()
    assert np.abs(force).max() < 1e-12 * stiffest


def test_points_are_found_where_they_are(body: OwnBody) -> None:
    points = np.random.default_rng(5).random((50, 3)) * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)

    rows = body.interpolation(body.find(points))

    assert (rows @ body.mesh.nodes.ravel()).reshape(-1, 3) == pytest.approx(points, abs=1e-9)


def test_a_point_outside_is_named(body: OwnBody) -> None:
    with pytest.raises(SceneError, match=r"no element at \(20, 9, 0\) mm; the mesh is to fill rod 'bar'"):
        body.find(np.array([[20.0, 9.0, 0.0]]))


@pytest.mark.parametrize(
    ("load", "force", "moment"),
    [
        (SectionForce("bar", 17.3, (3.0, -5.0, 2.0)), (3.0, -5.0, 2.0), (0.0, -2.0 * 17.3, -5.0 * 17.3)),
        (SectionMoment("bar", 40.0, (11.0, 7.0, -5.0)), (0.0, 0.0, 0.0), (11.0, 7.0, -5.0)),
        (LineLoad("bar", 10.0, 35.0, (0.0, -2.0, 0.0)), (0.0, -50.0, 0.0), (0.0, 0.0, -50.0 * 22.5)),
        (Gravity("bar", (0.0, -9810.0, 0.0)), (0.0, -0.2464272, 0.0), (0.0, 0.0, -0.2464272 * 20.0)),
    ],
    ids=["force", "moment", "line load", "weight"],
)
def test_loads_arrive_whole(
    body: OwnBody, load: Load, force: tuple[float, float, float], moment: tuple[float, float, float]
) -> None:
    nodal = body.loads([load]).reshape(-1, 3)

    assert nodal.sum(axis=0) == pytest.approx(force, abs=1e-9)
    assert np.cross(body.mesh.nodes, nodal).sum(axis=0) == pytest.approx(moment, abs=1e-7)


def test_a_load_of_another_kind_is_refused(body: OwnBody) -> None:
    with pytest.raises(SceneError, match=r"loads #1.kind: found a pressure; .* takes section forces"):
        body.loads([Pressure(RodFace("bar", "top"), 0.0, 20.0, 1.0)])
