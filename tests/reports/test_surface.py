"""The surface that drawings show: where it is asked for, and that both models answer there."""

from __future__ import annotations

import numpy as np
import pytest

import reference3d
import rodmodel
from cases.loader import load_case
from cases.scene import Box, Circle, Line, Material, Polygon, Rectangle, Ring, Rod, Section
from reports.surface import PressedFace, skin, surface

L_SECTION = Polygon(((0, 0), (30, 0), (30, 5), (5, 5), (5, 40), (0, 40)))


def area(corners: np.ndarray) -> float:
    """Of triangles, shape (n, 3, d)."""
    sides = corners[:, 1:] - corners[:, :1]
    if corners.shape[2] == 2:
        return float(np.abs(np.linalg.det(sides)).sum() / 2.0)
    return float(np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2.0)


@pytest.mark.parametrize(
    ("section", "expected"),
    [
        (Rectangle(15.0, 10.0), 150.0),
        (Box(30.0, 20.0, 2.0), 30.0 * 20.0 - 26.0 * 16.0),
        # polygons of 48 corners
        (Circle(20.0), 48 / 2 * np.sin(2 * np.pi / 48) * 100.0),
        (Ring(20.0, 16.0), 48 / 2 * np.sin(2 * np.pi / 48) * 36.0),
        (L_SECTION, 30 * 5 + 5 * 35),
    ],
    ids=lambda value: type(value).__name__ if not isinstance(value, float) else "",
)
def test_the_triangles_of_a_cap_fill_the_section_and_leave_its_holes(section: Section, expected: float) -> None:
    rod = Rod("rod", Line((0, 0, 0), (100, 0, 0), (0, 1, 0)), section, Material(1.0, 0.3), (0.0, 100.0))

    found = skin(rod)

    assert sum(found.loops) == len(found.border)
    assert area(found.border[found.cap]) == pytest.approx(expected, rel=1e-12)


@pytest.mark.slow
def test_both_models_have_nearly_the_same_surface_and_their_pressure_makes_the_contact_force() -> None:
    scene = load_case("two-cantilevers-e20-g0").scene
    solutions = rodmodel.solve(scene, level=3, order=5), reference3d.solve(scene)

    rod, solid = (surface(solution) for solution in solutions)

    for one, other, of in zip(rod.rods, solid.rods, scene.rods, strict=True):
        largest = np.abs(other.displacement).max()
        # h3 is within 1 % of 3D here; stress differs at the singular clamp
        assert np.abs(one.displacement - other.displacement).max() < 0.01 * largest
        assert np.median(np.abs(one.stress_s - other.stress_s)) < 0.01 * np.abs(other.stress_s).max()
        places = skin(of).places
        centre = places * np.array([[0.0], [0.0], [1.0]])
        for solution in solutions:
            along = solution.displacement(of.name, places[2])
            assert solution.displacement_at(of.name, centre) == pytest.approx(along, abs=1e-9 * largest)
    for solution, found in zip(solutions, (rod, solid), strict=True):
        # Triangles end at the outermost contact points, Gauss points of the width in the rod model; within them the
        # pressure is taken as linear: 15 % of the force.
        force = solution.contact_points("overlap").force.sum()
        assert force_of(found.faces[0]) == pytest.approx(force, rel=0.15)


def force_of(face: PressedFace) -> float:
    return sum(
        area(face.position.T[corners][None]) * float(face.pressure[corners].mean()) for corners in face.triangles
    )
