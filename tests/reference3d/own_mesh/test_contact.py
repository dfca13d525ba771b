"""Contact of faces whose meshes do not match: even motions are seen as they are, and forces leave nothing over."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from cases.scene import Clamp, ContactPair, Helix, Line, Material, Rectangle, Rod, RodFace, Scene
from reference3d.centre_line import frames, points
from reference3d.own_mesh.arc_length import arc_lengths
from reference3d.own_mesh.body import OwnBody
from reference3d.own_mesh.contact import OwnContact, own_contact
from reference3d.own_mesh.reading import read_rods

STEEL = Material(200_000.0, 0.3)
UP = (0.0, 1.0, 0.0)
SLOPES = {
    "lower": 1e-3 * np.array([[1.0, 0.2, -0.3], [0.4, -0.5, 0.6], [0.1, 0.7, 0.3]]),
    "upper": 1e-3 * np.array([[-0.2, 0.9, 0.3], [0.8, 0.1, -0.4], [0.5, -0.6, 0.2]]),
}


@pytest.fixture(params=["hexahedron27", "hexahedron20", "tetra10", "tetra"])
def touching(request: pytest.FixtureRequest, bars: Callable[..., Path]) -> tuple[OwnContact, dict[str, OwnBody]]:
    """Two bars whose facets end at different places, the second not over the whole width of the first."""
    lower = Rod("lower", Line((0.0, 0.0, 0.0), (60.0, 0.0, 0.0), UP), Rectangle(8.0, 10.0), STEEL, (0.0, 60.0))
    upper = Rod("upper", Line((43.0, 10.5, 0.0), (103.0, 10.5, 0.0), UP), Rectangle(6.0, 10.0), STEEL, (0.0, 60.0))
    pair = ContactPair("touch", RodFace("lower", "top"), RodFace("upper", "bottom"), (43.0, 60.0), "drawn")
    scene = Scene("bars", (lower, upper), (Clamp("lower", "start"), Clamp("upper", "end")), (), (pair,))
    boxes = {"lower": (0.0, 60.0, -5.0, 5.0, -4.0, 4.0), "upper": (43.0, 103.0, 5.5, 15.5, -3.0, 3.0)}
    meshes = read_rods(scene, bars(boxes, request.param, 4.0))
    bodies = {name: OwnBody(mesh, STEEL) for name, mesh in meshes.items()}
    return own_contact(scene, pair, bodies), bodies


def test_corners_stand_for_the_area_that_faces_share(touching: tuple[OwnContact, dict[str, OwnBody]]) -> None:
    contact, _ = touching

    assert contact.area.min() > 0.0
    # 17 by 6 mm; quadrature points of facets that the border cuts count as in or out, which leaves half the distance
    # between them at every border: of facets of 4 mm 0.37 mm at most
    assert contact.area.sum() == pytest.approx(102.0, abs=0.37 * (6.0 + 2.0 * 17.0))
    assert contact.gap == pytest.approx(np.full(len(contact.gap), 0.5))
    assert contact.normal == pytest.approx(np.tile(UP, (len(contact.normal), 1)))


def test_even_motions_of_both_bodies_are_seen_as_they_are(touching: tuple[OwnContact, dict[str, OwnBody]]) -> None:
    contact, bodies = touching

    seen = sum(rows @ (bodies[name].mesh.nodes @ SLOPES[name].T).ravel() for name, rows in contact.rows.items())

    across = contact.position + 0.5 * contact.normal
    expected = (across @ SLOPES["upper"].T - contact.position @ SLOPES["lower"].T)[:, 1]
    assert seen == pytest.approx(expected, abs=1e-12)


def test_forces_on_both_bodies_balance(touching: tuple[OwnContact, dict[str, OwnBody]]) -> None:
    contact, bodies = touching
    force = np.random.default_rng(1).random(len(contact.area))

    nodal = {name: (rows.T @ force).reshape(-1, 3) for name, rows in contact.rows.items()}

    total = {name: each.sum(axis=0) for name, each in nodal.items()}
    turning = {name: np.cross(bodies[name].mesh.nodes, each).sum(axis=0) for name, each in nodal.items()}
    assert total["lower"] == pytest.approx([0.0, -force.sum(), 0.0], abs=1e-9)
    assert total["upper"] == pytest.approx(-total["lower"], abs=1e-9)
    assert turning["upper"] == pytest.approx(-turning["lower"], abs=1e-7)
    # as `contact_points` tells it: forces at mean positions
    at_points = np.cross(contact.position, force[:, None] * contact.normal).sum(axis=0)
    assert turning["upper"] == pytest.approx(at_points, abs=1e-7)


def test_arc_lengths_of_points_beside_a_curved_line() -> None:
    helix = Helix((50.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0, (0.0, 0.0, 1.0), 30.0)
    rod = Rod("helix", helix, Rectangle(4.0, 4.0), STEEL, (0.0, helix.length))
    station = np.linspace(0.0, rod.length, 31)
    axes = frames(helix, station)

    found = arc_lengths(rod, points(helix, station) + 1.7 * axes[:, 0] - 1.3 * axes[:, 1])

    assert found == pytest.approx(station, abs=1e-9 * rod.length)
