"""Where the rod model's time goes, what its structure saves, and how its cost grows with the number of elements."""

from __future__ import annotations

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture
from scipy.sparse import coo_array, csc_array
from scipy.sparse.linalg import splu

import rodmodel as rm
from cases.loader import load_case
from cases.scene import Scene
from reports.case_comparison import evaluation_points
from reports.quantities import evaluate
from rodmodel.assembly import ElementStore, compliance, functionals, point_parts
from rodmodel.axial import shape_functions
from rodmodel.borders import natural_mesh
from rodmodel.centre_line import darboux
from rodmodel.chain import Chain
from rodmodel.contact import unilateral_contact
from rodmodel.pairing import facing_points
from rodmodel.section import STRAIGHT, Fields, section_stiffness
from rodmodel.stiffness import condensed_element, element_family, stiffness_terms
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system, inward_directions

LEVEL, ORDER = 5, 6


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_case("two-cantilevers-e50-g0").scene


@pytest.fixture(scope="module")
def system(scene: Scene) -> ContactSystem:
    meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
    return contact_system(scene, scene_mirrors(scene), meshes, ElementStore())


@pytest.mark.benchmark(group="where the time goes: parts of one solve of the paper's case, h5, p = 6")
class TestParts:
    def test_section_matrices(self, benchmark: BenchmarkFixture, scene: Scene) -> None:
        rod = scene.rods[0]
        fields = Fields(LEVEL, mirror_x=True)
        benchmark(
            lambda: element_family(ORDER, fields, section_stiffness(rod.section, rod.material, fields, STRAIGHT), True)
        )

    def test_one_element(self, benchmark: BenchmarkFixture, scene: Scene) -> None:
        rod = scene.rods[0]
        fields = Fields(LEVEL, mirror_x=True)
        family = element_family(ORDER, fields, section_stiffness(rod.section, rod.material, fields, STRAIGHT), True)
        benchmark(condensed_element, family, 33.33)

    def test_one_chain(self, benchmark: BenchmarkFixture, system: ContactSystem) -> None:
        elements = system.rods["lower"].elements
        benchmark(lambda: Chain(elements, 200e3, {0: np.empty(0, dtype=np.int64)}))

    def test_contact_points_of_one_rod(self, benchmark: BenchmarkFixture, system: ContactSystem) -> None:
        rod, grid = system.rods["lower"], system.grids["overlap"]
        station, _ = grid.flat()
        directions = np.ones((Fields(LEVEL, mirror_x=True).count, len(station)))
        benchmark(lambda: compliance(functionals(rod, point_parts(rod, station, lambda _: directions), len(station))))

    def test_unilateral_contact(self, benchmark: BenchmarkFixture, system: ContactSystem) -> None:
        benchmark(unilateral_contact, system.compliance, system.initial_gap, system.spring)

    def test_quantities(self, benchmark: BenchmarkFixture, scene: Scene) -> None:
        solution = rm.solve(scene, LEVEL, ORDER)
        points = evaluation_points(load_case("two-cantilevers-e50-g0"))
        benchmark(evaluate, solution, points.stations, points.stress_points)

    def test_whole_solve(self, benchmark: BenchmarkFixture, scene: Scene) -> None:
        benchmark(rm.solve, scene, LEVEL, ORDER)


class PlainSparse:
    """The same equations the plain way: all fields, one sparse matrix of both rods, factorised for every active set."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        mirrors = {rod.name: (False, False) for rod in scene.rods}
        meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
        # borrowed for its contact points alone
        self.system = contact_system(scene, mirrors, meshes, ElementStore())
        self.fields = Fields(LEVEL)
        count, start = self.fields.count, 0
        rows, columns, values, gaps, self.held, self.load = [], [], [], [], [], []
        for name, rod in self.system.rods.items():
            n_elements = len(rod.elements)
            terms = stiffness_terms(
                ORDER, section_stiffness(rod.rod.section, rod.rod.material, self.fields, darboux(rod.rod.centre_line))
            )
            nodes = start + count * np.arange(n_elements + 1)
            first_bubble = start + count * (n_elements + 1)
            places = []
            for index, length in enumerate(np.diff(rod.borders)):
                bubbles = first_bubble + count * (ORDER - 1) * index
                place = np.concatenate([nodes[index] + np.arange(2 * count), bubbles + np.arange(count * (ORDER - 1))])
                places.append(place)
                matrix = np.tensordot([0.5 * length, 1.0, 2.0 / length], terms, axes=1)
                rows.append(np.repeat(place, len(place)))
                columns.append(np.tile(place, len(place)))
                values.append(matrix.ravel())
            clamp = 0 if name == "lower" else n_elements
            self.held.append(nodes[clamp] + np.arange(count))
            gaps.append((rod, places))
            start = first_bubble + count * (ORDER - 1) * n_elements
        self.size = start
        entries = (np.concatenate(values), (np.concatenate(rows), np.concatenate(columns)))
        self.stiffness = csc_array(coo_array(entries, shape=(start, start)))
        self.gap = self._gap_rows(gaps)
        upper, places = gaps[1]
        load = scene.loads[0]
        self.force = np.zeros(start)
        index, xi = upper.locate(np.array([load.position]))
        direction = np.zeros(count)
        direction[self.fields.index(1, 0, 0)] = load.force[1]
        self.force[places[index[0]]] += np.kron(shape_functions(ORDER, xi)[:, 0], direction)
        self.free = np.setdiff1d(np.arange(start), np.concatenate(self.held))

    def _gap_rows(self, rods: list) -> csc_array:
        rows, columns, values = [], [], []
        pair, grid = self.scene.contacts[0], self.system.grids["overlap"]
        facing = facing_points(self.scene, pair, *grid.flat())
        for (rod, places), side, points in zip(
            rods, (pair.first, pair.second), (facing.first, facing.second), strict=True
        ):
            direction = inward_directions(rod.rod, side.face, grid, points)
            for part in point_parts(rod, points[2], direction):
                for column, vector in zip(part.columns, part.values.reshape(-1, len(part.columns)).T, strict=True):
                    rows.append(np.full(len(vector), column))
                    columns.append(places[part.element])
                    values.append(vector)
        shape = (grid.weight.size, self.size)
        return csc_array(
            coo_array((np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))), shape=shape)
        )

    def iterate(self, active: np.ndarray) -> np.ndarray:
        """One contact iteration: matrix with the active points' springs, factorisation, gaps."""
        rows = self.gap[active]
        spring = self.system.spring[active]
        matrix = self.stiffness + rows.T @ (rows * spring[:, None])
        factor = splu(csc_array(matrix)[self.free][:, self.free], permc_spec="MMD_AT_PLUS_A")
        moved = np.zeros(self.size)
        moved[self.free] = factor.solve(self.force[self.free])
        return self.gap @ moved


@pytest.mark.benchmark(group="one contact solution on the paper's elements, h5, p = 6")
class TestAgainstPlainSparse:
    def test_plain_sparse_factorisation(self, benchmark: BenchmarkFixture, scene: Scene, system: ContactSystem) -> None:
        plain = PlainSparse(scene)
        full = plain.system
        force = unilateral_contact(full.compliance, full.initial_gap, full.spring)
        gap = benchmark.pedantic(plain.iterate, args=(force > 0.0,), rounds=2)
        # the same equations: the same pressure where the points are held
        held = force > 0.0
        np.testing.assert_allclose(-full.spring[held] * gap[held], force[held], rtol=1e-4)

    def test_condensed_chains_and_compliance(self, benchmark: BenchmarkFixture, scene: Scene) -> None:
        meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}

        def run() -> np.ndarray:
            system = contact_system(scene, scene_mirrors(scene), meshes, ElementStore())
            return unilateral_contact(system.compliance, system.initial_gap, system.spring)

        benchmark(run)


@pytest.mark.benchmark(group="cost against number of elements, h2, p = 4")
@pytest.mark.parametrize("elements", [10, 100, 1000, 10_000])
def test_cost_is_linear(benchmark: BenchmarkFixture, elements: int) -> None:
    length = 10.0 * elements
    rod = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0)),
        rm.Rectangle(15.0, 15.0),
        rm.Material(200e3, 0.3),
        tuple(np.linspace(0.0, length, elements + 1)),
    )
    load = rm.SectionForce("bar", length, (0.0, -1.0, 0.0))
    scene = rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (load,), ())
    solution = benchmark.pedantic(rm.solve, args=(scene, 2, 4), rounds=3, warmup_rounds=1)
    benchmark.extra_info["unknowns"] = solution.cost.unknowns
