"""A scene on a mesh made elsewhere has the answers of the reference's own mesh, but for the discretisation."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path

import meshio
import numpy as np
import pytest

import reference3d
from cases.loader import load_case
from cases.scene import (
    Bed,
    Circle,
    Clamp,
    ContactPair,
    Ground,
    Helix,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    Support,
)
from reference3d.node_grids import node_grids
from reference3d.own_mesh import solve_own_mesh
from reference3d.own_mesh.elements import KINDS
from reports.fields import body_field, write_fields
from reports.quantities import Quantities, evaluate

STEEL = Material(200_000.0, 0.3)
UP = (0.0, 1.0, 0.0)
LOWER, UPPER = (0.0, 60.0, -5.0, 5.0, -4.0, 4.0), (40.0, 100.0, 5.0, 15.0, -4.0, 4.0)


def cantilever() -> Scene:
    rod = Rod("lower", Line((0.0, 0.0, 0.0), (60.0, 0.0, 0.0), UP), Rectangle(8.0, 10.0), STEEL, (0.0, 30.0, 60.0))
    load = SectionForce("lower", 60.0, (0.0, -300.0, 100.0))
    return Scene("cantilever", (rod,), (Clamp("lower", "start"),), (load,), ())


@cache
def own_cantilever() -> reference3d.Solution | reference3d.SolidSolution:
    """The cantilever on the reference's own mesh."""
    return reference3d.solve(cantilever(), 2)


def touching() -> Scene:
    """Two short cantilevers, one pressed onto the other."""
    lower = cantilever().rods[0]
    line = Line((40.0, 10.0, 0.0), (100.0, 10.0, 0.0), UP)
    upper = Rod("upper", line, lower.section, Material(50_000.0, 0.3), (0.0, 20.0, 60.0))
    pair = ContactPair("touch", RodFace("lower", "top"), RodFace("upper", "bottom"), (40.0, 60.0), 0.0)
    load = SectionForce("upper", 30.0, (0.0, -200.0, 0.0))
    return Scene("touching", (lower, upper), (Clamp("lower", "start"), Clamp("upper", "end")), (load,), (pair,))


def ring() -> Scene:
    """A quarter ring of round section about Z, clamped where Y = 0 and pulled out of its plane."""
    line = Helix((50.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.5 * math.pi, (0.0, 0.0, 1.0))
    rod = Rod("ring", line, Circle(10.0), STEEL, tuple(np.linspace(0.0, 25.0 * math.pi, 5)))
    load = SectionForce("ring", 25.0 * math.pi, (0.0, 0.0, 100.0))
    return Scene("ring", (rod,), (Clamp("ring", "start"),), (load,), ())


def exported(solution: reference3d.Solution | reference3d.SolidSolution, start: int, path: Path) -> Path:
    """The reference's own mesh of a rod as a file of gmsh; cells of corners alone name its start.

    start : the global axis along which the nodes of the start are the lowest
    """
    ((rod, grid),) = node_grids(solution).items()
    field = body_field(solution, rod, grid)
    faces = field.cells[:, KINDS["hexahedron27"].faces].reshape(-1, 4)
    along = field.position[:, start]
    quads = faces[(along[faces] < along.min() + 1e-9).all(axis=1)]
    tags = [np.full(len(field.cells), 1), np.full(len(quads), 2)]
    meshio.Mesh(
        field.position,
        [("hexahedron27", field.cells), ("quad", quads)],
        cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags},
        field_data={rod: np.array([1, 3]), f"{rod}.start": np.array([2, 2])},
    ).write(path, file_format="gmsh22")
    return path


@pytest.mark.parametrize(("scene", "start"), [(cantilever(), 0), (ring(), 1)], ids=["straight", "curved"])
def test_the_reference_s_own_mesh_read_back_gives_its_own_answer(tmp_path: Path, scene: Scene, start: int) -> None:
    own = reference3d.solve(scene, 1)
    rod = scene.rods[0]
    station = np.linspace(0.0, rod.length, 13)

    found = solve_own_mesh(scene, exported(own, start, tmp_path / "own.msh"))

    assert found.outcome == "converged"
    assert found.cost.unknowns >= own.cost.unknowns
    # the same elements: how the force is spread over the last section's nodes differs, and how a curved element is
    # looked up between its nodes
    expected = own.displacement(rod.name, station)
    assert np.abs(found.displacement(rod.name, station) - expected).max() < 1e-4 * np.abs(expected).max()
    assert found.strain_energy == pytest.approx(own.strain_energy, rel=1e-5)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "tolerance"), [("hexahedron27", 2e-3), ("hexahedron20", 8e-3), ("tetra10", 4e-3)])
def test_a_cantilever_of_quadratic_elements(bars: Callable[..., Path], kind: str, tolerance: float) -> None:
    reference = own_cantilever()

    found = solve_own_mesh(cantilever(), bars({"lower": LOWER}, kind, 5.0))

    end = np.array([60.0])
    # two elements across and not graded towards the clamp, against the reference's that are
    assert found.displacement("lower", end) == pytest.approx(
        reference.displacement("lower", end), rel=tolerance, abs=1e-3
    )
    assert found.reaction("lower", 0.0)[:3] == pytest.approx([0.0, 300.0, -100.0], abs=1e-6)
    assert found.reaction("lower", 0.0)[3:] == pytest.approx([0.0, 6000.0, 18_000.0], abs=1e-4)
    work = 0.5 * (np.array([0.0, -300.0, 100.0]) @ found.displacement("lower", end)[:, 0])
    assert found.strain_energy == pytest.approx(work, rel=2e-3)  # of the section's mean, not of its centre
    moment = found.section_resultants("lower", np.array([20.0, 30.0]))[3]
    assert moment == pytest.approx([300.0 * 40.0, 300.0 * 30.0], rel=5e-3)


@pytest.fixture(scope="module")
def reference() -> Quantities:
    """The two bars on the reference's own mesh."""
    return evaluate(reference3d.solve(touching(), 2), {}, ())


@pytest.mark.slow
@pytest.mark.parametrize("kind", ["hexahedron27", "hexahedron20", "tetra10"])
def test_contact_transmits_what_it_does_on_the_reference_s_own_mesh(
    bars: Callable[..., Path], kind: str, reference: Quantities
) -> None:
    mesh = bars({"lower": LOWER, "upper": UPPER}, kind, 4.0)

    quantities = evaluate(solve_own_mesh(touching(), mesh), {}, ())

    found, expected = quantities.contacts[0], reference.contacts[0]
    assert quantities.outcome == "converged"
    assert found.force == pytest.approx(expected.force, rel=1e-2)
    assert found.centre == pytest.approx(expected.centre, abs=0.1)
    assert found.penetration < 1e-9
    assert found.complementarity_residual < 1e-9
    assert quantities.equilibrium_residual < 1e-8
    # edges are told by the facets
    assert np.ravel(found.edges) == pytest.approx(np.ravel(expected.edges), abs=4.0)


def test_a_clamp_that_moves_takes_the_bar_along(bars: Callable[..., Path]) -> None:
    moved = Clamp("lower", "start", (0.1, 0.2, 0.3), (1e-3, 2e-3, -3e-3))
    scene = Scene("moved", cantilever().rods, (moved,), (), ())

    found = solve_own_mesh(scene, bars({"lower": LOWER}, "hexahedron27", 5.0))

    end = found.displacement("lower", np.array([60.0]))[:, 0]
    assert end == pytest.approx(np.array(moved.displacement) + np.cross(moved.rotation, [60.0, 0.0, 0.0]))
    assert found.strain_energy < 1e-12


def test_a_bar_pressed_onto_the_ground_is_held_by_it(bars: Callable[..., Path]) -> None:
    pair = ContactPair("floor", RodFace("lower", "bottom"), Ground(), (0.0, 60.0), 0.05)
    scene = cantilever()
    scene = Scene("ground", scene.rods, scene.supports, scene.loads, (pair,))

    found = solve_own_mesh(scene, bars({"lower": LOWER}, "tetra10", 4.0))

    points = found.contact_points("floor")
    assert found.outcome == "converged"
    assert points.gap.min() > -1e-9
    free = reference3d.solve(cantilever(), 1).displacement("lower", np.array([60.0]))[1, 0]
    assert free < -0.1
    assert found.displacement("lower", np.array([60.0]))[1, 0] == pytest.approx(-0.05, abs=0.002)
    push = points.normal @ points.force
    assert found.reaction("lower", 0.0)[1] - push[1] == pytest.approx(300.0, rel=1e-6)


def test_fields_of_an_own_mesh_are_told_on_it(bars: Callable[..., Path], tmp_path: Path) -> None:
    solution = solve_own_mesh(cantilever(), bars({"lower": LOWER}, "tetra10", 5.0))

    (path,) = write_fields(solution, tmp_path / "fields.vtu")

    mesh = meshio.read(path)
    assert {block.type for block in mesh.cells} == {"tetra10"}
    assert mesh.point_data["displacement"] == pytest.approx(solution.rods["lower"].nodal)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"supports": ()}, "no clamp of rod 'lower'"),
        ({"supports": (Clamp("lower", "start"), Support("lower", 60.0, ("y",)))}, "a support of components"),
        ({"beds": (Bed(RodFace("lower", "bottom"), 0.0, 60.0, 1.0),)}, "rods do not lie on beds"),
    ],
    ids=["loose", "support", "bed"],
)
def test_what_is_not_for_own_meshes_is_refused(tmp_path: Path, change: dict[str, object], said: str) -> None:
    whole = cantilever()
    parts = {"rods": whole.rods, "supports": whole.supports, "loads": whole.loads, "contacts": ()} | change

    with pytest.raises(SceneError, match=said):
        solve_own_mesh(Scene("refused", **parts), tmp_path / "never read.msh")


@pytest.mark.slow
def test_the_paper_s_bars(bars: Callable[..., Path]) -> None:
    scene = load_case("two-cantilevers-e50-g0").scene
    boxes = {"lower": (0.0, 300.0, -7.5, 7.5, -7.5, 7.5), "upper": (200.0, 500.0, 7.5, 22.5, -7.5, 7.5)}
    expected = evaluate(reference3d.solve(scene, 2), {}, ()).contacts[0]

    quantities = evaluate(solve_own_mesh(scene, bars(boxes, "tetra10", 7.5)), {}, ())

    found = quantities.contacts[0]
    assert quantities.outcome == "converged"
    # two elements across the bars; with three, the force is within 0.05 %
    assert found.force == pytest.approx(expected.force, rel=2e-3)
    assert found.centre == pytest.approx(expected.centre, abs=0.2)
