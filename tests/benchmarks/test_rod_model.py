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
from reports.performance.parts import TEXTS, Part, parts
from reports.performance.scaling import cantilever
from rodmodel.assembly import ElementStore, point_parts
from rodmodel.axial import shape_functions
from rodmodel.borders import natural_mesh
from rodmodel.centre_line import darboux
from rodmodel.contact import unilateral_contact
from rodmodel.section import Fields, section_stiffness
from rodmodel.stiffness import stiffness_terms
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system, opening

LEVEL, ORDER = 5, 6


@pytest.fixture(scope="module")
def scene() -> Scene:
    return load_case("two-cantilevers-e50-g0").scene


@pytest.fixture(scope="module")
def measured_parts() -> dict[str, Part]:
    return parts()


@pytest.fixture(scope="module")
def system(scene: Scene) -> ContactSystem:
    meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
    return contact_system(scene, scene_mirrors(scene), meshes, ElementStore())


@pytest.mark.benchmark(group="where the time goes: parts of one solve of the paper's case, h5, p = 6")
@pytest.mark.parametrize("name", TEXTS)
def test_part(benchmark: BenchmarkFixture, measured_parts: dict[str, Part], name: str) -> None:
    part = measured_parts[name]
    benchmark.pedantic(part.work, setup=lambda: ((part.prepare(),), {}), rounds=15, warmup_rounds=1)


class PlainSparse:
    """The same equations the plain way: all fields, one sparse matrix of both rods, factorised for every active set."""

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        mirrors = {rod.name: (False, False) for rod in scene.rods}
        meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
        # borrowed for its contact points alone
        self.system = contact_system(scene, mirrors, meshes, ElementStore(), multipliers=False)
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
        for (rod, places), face in zip(rods, pair.faces, strict=True):
            for part in point_parts(rod, *opening(rod.rod, face, pair, grid)):
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
        spring = self.system.problem.spring[active]
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
        force = unilateral_contact(full.problem).force
        gap = benchmark.pedantic(plain.iterate, args=(force > 0.0,), rounds=2)
        # the same equations: the same pressure where the points are held
        held = force > 0.0
        np.testing.assert_allclose(-full.problem.spring[held] * gap[held], force[held], rtol=1e-4)

    def test_condensed_chains_and_compliance(self, benchmark: BenchmarkFixture, scene: Scene) -> None:
        meshes = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}

        def run() -> np.ndarray:
            system = contact_system(scene, scene_mirrors(scene), meshes, ElementStore())
            return unilateral_contact(system.problem).force

        benchmark(run)


@pytest.mark.benchmark(group="cost against number of elements, h2, p = 4")
@pytest.mark.parametrize("elements", [10, 100, 1000, 10_000])
def test_cost_is_linear(benchmark: BenchmarkFixture, elements: int) -> None:
    solution = benchmark.pedantic(rm.solve, args=(cantilever(elements, equal=True), 2, 4), rounds=3, warmup_rounds=1)
    benchmark.extra_info["unknowns"] = solution.cost.unknowns
