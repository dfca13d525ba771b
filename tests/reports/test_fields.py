"""VTU files hold the solution's own field, in the order of nodes that VTK reads."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

# Names alone: where pytest finds the module and looks for fixtures in it, pyvista loads matplotlib.
from pyvista import CellType, PolyData, UnstructuredGrid, read

import reference3d
import rodmodel
from cases.scene import (
    Circle,
    Clamp,
    ContactPair,
    Helix,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SectionForce,
)
from reports.fields import von_mises, write_fields
from reports.solution import Solution

STEEL = Material(200_000.0, 0.3)
UP = (0.0, 1.0, 0.0)


def ring() -> Scene:
    """A quarter ring of round section, clamped and pulled out of its plane: solved as a solid of any kind."""
    line = Helix((50.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.5 * math.pi, (0.0, 0.0, 1.0))
    rod = Rod("ring", line, Circle(10.0), STEEL, tuple(np.linspace(0.0, 25.0 * math.pi, 5)))
    load = SectionForce("ring", 25.0 * math.pi, (0.0, 0.0, 100.0))
    return Scene("ring", (rod,), (Clamp("ring", "start"),), (load,), ())


def bars() -> Scene:
    """Two short cantilevers, one pressed onto the other: solved as boxes."""
    section = Rectangle(8.0, 10.0)
    lower = Rod("lower", Line((0.0, 0.0, 0.0), (60.0, 0.0, 0.0), UP), section, STEEL, (0.0, 30.0, 60.0))
    upper = Rod("upper", Line((40.0, 10.0, 0.0), (100.0, 10.0, 0.0), UP), section, STEEL, (0.0, 20.0, 60.0))
    pair = ContactPair("touch", RodFace("lower", "top"), RodFace("upper", "bottom"), (40.0, 60.0), 0.0)
    load = SectionForce("upper", 20.0, (0.0, -200.0, 0.0))
    return Scene("bars", (lower, upper), (Clamp("lower", "start"), Clamp("upper", "end")), (load,), (pair,))


SOLVED = {
    "rod model, bars": lambda: rodmodel.solve(bars(), level=2, order=4),
    "3d boxes": lambda: reference3d.solve(bars(), 1),
    "rod model, ring": lambda: rodmodel.solve(ring(), level=2, order=4),
    "3d solids": lambda: reference3d.solve(ring(), 1),
}
VOLUME = {"bars": 2 * 80.0 * 60.0, "ring": 25.0 * math.pi * 25.0 * math.pi}


@pytest.fixture(scope="module", params=SOLVED)
def solution(request: pytest.FixtureRequest) -> Solution:
    return SOLVED[request.param]()


@pytest.fixture
def bodies(solution: Solution, tmp_path: Path) -> UnstructuredGrid:
    return read(write_fields(solution, tmp_path / "fields.vtu")[0])


def test_elements_fill_the_volume_of_the_rods(solution: Solution, bodies: UnstructuredGrid) -> None:
    assert set(bodies.celltypes) == {CellType.TRIQUADRATIC_HEXAHEDRON}
    volume = bodies.compute_cell_sizes()["Volume"]

    assert volume.min() > 0.0
    # VTK adds up tetrahedra between the nodes: exact for boxes, while it cuts off much of a round section
    assert volume.sum() == pytest.approx(
        VOLUME[solution.scene.name], rel=1e-9 if solution.scene.name == "bars" else 0.1
    )


def test_the_displacement_between_nodes_is_that_of_the_solution(solution: Solution, bodies: UnstructuredGrid) -> None:
    for rod in solution.scene.rods:
        station = np.linspace(0.03, 0.97, 23) * rod.length  # not where nodes are
        expected = solution.displacement(rod.name, station).T
        points = PolyData(solution.frame(rod.name, station)[0].T)

        found = points.sample(bodies.extract_cells(bodies["rod"] == solution.scene.rods.index(rod)))

        assert found["vtkValidPointMask"].all()
        # The elements are those of the 3D model; the rod model's polynomials are told at places along and across, and
        # the centre line of a ring lies between the places by which its elements are curved.
        exact = isinstance(solution, reference3d.Solution)
        assert np.abs(found["displacement"] - expected).max() < (1e-9 if exact else 2e-3) * np.abs(expected).max()


def in_section(solution: Solution, position: np.ndarray) -> np.ndarray:
    """(x, y, s) of points of the first rod, shape (3, n)."""
    across, up, along = position.T[[2, 1, 0]]
    if solution.scene.name == "bars":
        return np.stack([-across, up, along])
    return np.stack([50.0 - np.hypot(along, up), across, 50.0 * np.arctan2(up, along)])


def test_stress_is_in_global_axes_in_the_order_of_vtk(solution: Solution, bodies: UnstructuredGrid) -> None:
    first = bodies.extract_cells(bodies["rod"] == 0)
    places = in_section(solution, np.asarray(first.points, dtype=float))
    inner = first.cells.reshape(-1, 28)[:, 27]  # the middle of every element, where no others meet
    xx, yy, zz, xy, yz, xz = first["stress"][inner].T
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
    rod = solution.scene.rods[0].name
    axes = solution.frame(rod, places[2, inner])[1]

    local = np.einsum("nag,ghn,nbh->abn", axes, tensor, axes)

    expected = solution.stress(rod, places[:, inner])
    found = np.stack([local[0, 0], local[1, 1], local[2, 2], local[1, 2], local[0, 2], local[0, 1]])
    size = np.abs(expected).max()
    assert found == pytest.approx(expected, abs=1e-9 * size)
    assert first["stress_s"][inner] == pytest.approx(found[2], abs=1e-9 * size)


def test_forces_and_gaps_of_contact_stand_beside_the_bodies(tmp_path: Path) -> None:
    solution = SOLVED["3d boxes"]()

    bodies, contact = write_fields(solution, tmp_path / "fields.vtu")

    assert contact == tmp_path / "fields-contact.vtu"
    points, known = read(contact), solution.contact_points("touch")
    assert points["force"].sum(axis=0) == pytest.approx(known.normal @ known.force)
    assert points["gap"] == pytest.approx(known.gap)
    profile = solution.contact_profile("touch")
    assert points["pressure"].max() == pytest.approx(max(profile.middle.max(), profile.outer.max()))
    assert read(bodies)["rod"].max() == 1


def test_the_rod_models_contact_points_tell_their_pressure_too(tmp_path: Path) -> None:
    solution = SOLVED["rod model, bars"]()

    points = read(write_fields(solution, tmp_path / "fields.vtu")[1])

    known = solution.contact_points("touch")
    assert known.pressure.max() > 0.0
    assert points["pressure"] == pytest.approx(known.pressure)


def test_a_scene_without_contact_has_no_file_of_it(tmp_path: Path) -> None:
    assert write_fields(SOLVED["rod model, ring"](), tmp_path / "ring.vtu") == (tmp_path / "ring.vtu",)
    assert [path.name for path in tmp_path.iterdir()] == ["ring.vtu"]


def test_the_equivalent_stress_is_that_of_tension_and_of_shear_and_none_of_pressure() -> None:
    tension, shear, pressure = [100.0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 60.0, 0], [-7.0, -7.0, -7.0, 0, 0, 0]

    found = von_mises(np.array([tension, shear, pressure]))

    assert found == pytest.approx([100.0, 60.0 * math.sqrt(3.0), 0.0])
