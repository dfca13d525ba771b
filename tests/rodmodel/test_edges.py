"""Search for the edges of contact."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm
from cases.loader import load_case
from cases.scene import Material, Scene, SectionForce
from rodmodel.assembly import ElementStore
from rodmodel.borders import Rates, border_plan, edge_rates, natural_mesh, placed_meshes
from rodmodel.contact import ActiveSet
from rodmodel.edge_pressure import edge_pressures
from rodmodel.edges import EdgeSearch, find_edges
from rodmodel.mesh import lowest
from rodmodel.solver import moved_contact, systems
from rodmodel.stretches import Stretch, moving_edges
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system

LEVEL, ORDER = 3, 5


@pytest.fixture(scope="module")
def search() -> Callable[
    [str, float, float], tuple[Scene, EdgeSearch, Callable[[np.ndarray], tuple[ContactSystem, dict[str, Rates]]]]
]:
    """Search from a guessed stretch; gives the scene, the search and what makes a system with given edges."""

    def run(name, start, end):
        scene = load_case(f"two-cantilevers-{name}").scene
        mirrors, store = scene_mirrors(scene), ElementStore()
        borders = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
        stretches = (Stretch("overlap", start, end),)
        edges, positions = moving_edges(scene, stretches)
        plan = border_plan(scene, borders, edges, positions)

        def system_at(at: np.ndarray) -> tuple[ContactSystem, dict[str, Rates]]:
            meshes = placed_meshes(plan, at)
            return contact_system(scene, mirrors, meshes, store), edge_rates(plan, at)

        return scene, find_edges(scene, stretches, edges, positions, system_at), system_at

    return run


@pytest.mark.parametrize("guess", [212.0, 220.0, 226.0, 235.0])
def test_one_edge_is_found_from_any_guess(search, guess: float) -> None:
    _, found, _ = search("e50-g0", 200.0, guess)
    assert found.outcome == "converged"
    assert found.positions[0] == pytest.approx(search("e50-g0", 200.0, 221.0)[1].positions[0], abs=0.02)
    assert len(found.steps) <= 5


@pytest.mark.parametrize("guess", [(234.0, 266.0), (240.0, 258.0), (238.0, 262.0)])
def test_two_edges_are_found_together(search, guess: tuple[float, float]) -> None:
    _, found, _ = search("e20-g0", *guess)
    assert found.outcome == "converged"
    assert found.positions == pytest.approx(search("e20-g0", 237.0, 261.0)[1].positions, abs=0.03)
    assert len(found.steps) <= 5


def test_pressure_vanishes_on_the_edge_pushes_before_and_pulls_beyond_it(search) -> None:
    scene, found, system_at = search("e50-g0", 200.0, 225.0)
    pressures = []
    for shift in (-2.0, 0.0, 2.0):
        at = found.positions + shift
        stretches = (Stretch("overlap", 200.0, float(at[0])),)
        edges, _ = moving_edges(scene, stretches)
        pressures.append(edge_pressures(system_at(at)[0], stretches, edges).value[0])
    assert pressures[0] > 1.0
    assert abs(pressures[1]) < 0.02  # 1.5 MPa a millimetre times 0.01 mm
    assert pressures[2] < -1.0


def test_contact_force_hardly_depends_on_the_border(search) -> None:
    """Held elements: where the mean pressure vanishes the force is stationary; the middle's edge is close to that."""
    _, found, system_at = search("e50-g0", 200.0, 225.0)
    edge = float(found.positions[0])
    forces = []
    for shift in (-1.0, 0.0, 1.0):
        system = system_at(found.positions + shift)[0]
        grid = system.grids["overlap"]
        held = np.zeros(grid.weight.shape, dtype=bool)
        held[grid.station[:, 0] < edge + shift - 1e-6] = True
        forces.append(ActiveSet(held.ravel(), system.problem).settled_forces()[0].sum())
    assert abs(forces[2] - forces[0]) < 1e-4 * forces[1]  # over 2 mm


def test_the_search_gives_the_system_of_its_last_positions(search) -> None:
    _, found, system_at = search("e20-g0", 238.0, 262.0)
    np.testing.assert_array_equal(found.positions, found.steps[-1])
    np.testing.assert_array_equal(found.system.problem.compliance, system_at(found.positions)[0].problem.compliance)


@pytest.mark.parametrize("name", ["e50-g0", "e20-g05"])
def test_borders_that_sit_on_edges_roughly_leave_forces_and_reported_edges_as_they_are(name) -> None:
    scene = load_case(f"two-cantilevers-{name}").scene
    system_on = systems(scene, ElementStore())
    meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
    look = system_on(lowest(meshes))
    precise, rough = (moved_contact(scene, meshes, look, system_on, edge_share=share) for share in (None, 0.05))
    assert rough.solutions < precise.solutions
    # forces are stationary at the edges; slopes are exact, so that the last step, not tried any more, ends on them
    assert rough.forces.force.sum() == pytest.approx(precise.forces.force.sum(), rel=1e-5)
    ends, rough_ends = ((each.stretches[0].start, each.stretches[0].end) for each in (precise, rough))
    assert rough_ends == pytest.approx(ends, abs=0.02)
    assert rough.stretches[0].slack >= np.abs(np.subtract(rough_ends, ends)).max()


def test_contact_at_a_corner_ends_with_the_shortest_stretch() -> None:
    """A stiff upper bar digs its end into the lower one: held elements pull, however short the stretch."""
    case = load_case("two-cantilevers-e50-g0")
    stiff = replace(case.scene.rods[1], material=Material(2e6, 0.3))
    solution = rm.solve(replace(case.scene, rods=(case.scene.rods[0], stiff)), level=LEVEL, order=ORDER)
    assert solution.outcome == "converged"
    (stretch,) = solution.stretches
    assert stretch.start == 200.0
    assert stretch.end == pytest.approx(200.2)  # SHORTEST of the zone's 100 mm


def test_an_edge_that_crosses_a_load_is_found() -> None:
    """A load inside the zone holds a border of its own; the edges' borders pass it by."""
    case = load_case("two-cantilevers-e20-g0")
    loads = (*case.scene.loads, SectionForce("upper", 36.0, (0.0, 1.0, 0.0)))
    solution = rm.solve(replace(case.scene, loads=loads), level=LEVEL, order=ORDER)
    assert solution.outcome == "converged"
    (without,) = rm.solve(case.scene, level=LEVEL, order=ORDER).stretches
    (stretch,) = solution.stretches
    # 1 N among 1000 moves nothing; the extra border changes the mesh, and an edge by what order 5 leaves open
    assert (stretch.start, stretch.end) == pytest.approx((without.start, without.end), abs=1.5)
