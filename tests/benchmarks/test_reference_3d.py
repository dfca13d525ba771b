"""Where the 3D reference spends its time: element matrices and their assembly against factorisation.

Both paths, on the finest of the three meshes; the bracketed numbers of a group are what to compare. Assembly must stay
below factorisation.
"""

from __future__ import annotations

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

from cases.loader import load_case
from reference3d import REFINEMENTS, factor, plane_chain
from reference3d.elasticity import layered_stiffness
from reference3d.grading import rod_borders
from reference3d.holds import holds
from reference3d.mesh import box_mesh
from reference3d.scope import isotropic
from reference3d.solid_body import solid_body
from reference3d.solid_mirror import scene_mirrors
from reference3d.solid_responses import held_planes

FINEST = REFINEMENTS[-1]
BARS, SOLIDS = load_case("two-cantilevers-e50-g0").scene, load_case("curved-bar-on-straight-bar").scene


@pytest.mark.benchmark(group="a clamped bar of the paper's cases, finest mesh")
class TestBar:
    def test_stiffness_of_all_kinds_of_layers(self, benchmark: BenchmarkFixture) -> None:
        rod = BARS.rods[0]
        borders = rod_borders(BARS, rod, FINEST, symmetric=True)

        def run() -> None:
            layered_stiffness(box_mesh(borders.x, borders.y, borders.s), borders, isotropic(rod))

        benchmark.pedantic(run, rounds=3, warmup_rounds=1)

    def test_factorisation(self, benchmark: BenchmarkFixture) -> None:
        rod = BARS.rods[0]
        borders = rod_borders(BARS, rod, FINEST, symmetric=True)
        stiffness = layered_stiffness(box_mesh(borders.x, borders.y, borders.s), borders, isotropic(rod))
        in_plane = np.ones((2 * len(borders.y) - 1, 2 * len(borders.x) - 1, 3), dtype=bool)
        in_plane[:, 0, 0] = False
        free = np.flatnonzero(in_plane)

        def run() -> None:
            factor.factorise(stiffness, free, clamped_start=True, clamped_end=False, reverse=False)

        benchmark.pedantic(run, rounds=3, warmup_rounds=1)


@pytest.mark.benchmark(group="a curved bar, finest mesh, half of its motions")
class TestSolid:
    def test_element_matrices_and_assembly_of_all_kinds_of_layers(self, benchmark: BenchmarkFixture) -> None:
        rod = SOLIDS.rods[1]
        symmetric = self._parts()[1].symmetric

        def run() -> None:
            body = solid_body(SOLIDS, rod, FINEST)
            matrix = body.assembly(symmetric)
            for kind in range(len(body.layers)):
                matrix(kind)

        benchmark.pedantic(run, rounds=3, warmup_rounds=1)

    def test_factorisation(self, benchmark: BenchmarkFixture) -> None:
        body, mirror, held = self._parts()
        matrix = body.assembly(mirror.symmetric)
        matrices = [matrix(kind) for kind in range(len(body.layers))]
        planes = held_planes(held, mirror)
        benchmark.pedantic(
            plane_chain.factorise, args=(matrices.__getitem__, body.kind, planes), rounds=3, warmup_rounds=1
        )

    def _parts(self):
        bodies = {rod.name: solid_body(SOLIDS, rod, FINEST) for rod in SOLIDS.rods}
        held = {name: holds(SOLIDS, body) for name, body in bodies.items()}
        name = SOLIDS.rods[1].name
        return bodies[name], scene_mirrors(SOLIDS, bodies, held, [])[name], held[name]
