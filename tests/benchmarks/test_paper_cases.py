"""What one solve of the paper's cases costs, from the scene to all quantities: rod model and 3D reference side by side.

The table's bracketed numbers are the ratios within this run; compare those, not seconds of different machines.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import reference3d
import rodmodel as rm
from cases.case import Case
from cases.loader import library_names, load_case
from reports.case_comparison import evaluation_points
from reports.quantities import Quantities, evaluate
from reports.solution import Solution
from rodmodel.adapt import graded

PAPER = [name for name in library_names() if name.startswith("two-cantilevers")]


def quantities(case: Case, solve: Callable[[], Solution]) -> Quantities:
    """Solve and evaluate all that the report asks for."""
    points = evaluation_points(case)
    return evaluate(solve(), points.stations, points.stress_points)


def record(benchmark: BenchmarkFixture, found: Quantities) -> None:
    """Keep beside the seconds what they bought."""
    benchmark.extra_info["unknowns"] = found.unknowns
    benchmark.extra_info["contact_force_N"] = found.contacts[0].force
    assert found.outcome == "converged"


@pytest.mark.parametrize("name", PAPER)
def test_rod_as_in_the_case_file(benchmark: BenchmarkFixture, name: str) -> None:
    case = load_case(name)
    settings = case.rod_model
    benchmark.group = name
    found = benchmark(lambda: quantities(case, lambda: rm.solve(case.scene, settings.level, settings.order)))
    record(benchmark, found)


@pytest.mark.parametrize("name", PAPER)
def test_rod_h4_with_short_elements_at_clamps_and_zone_ends(benchmark: BenchmarkFixture, name: str) -> None:
    case = load_case(name)
    case = replace(case, scene=graded(case.scene))
    benchmark.group = name
    record(benchmark, benchmark(lambda: quantities(case, lambda: rm.solve(case.scene, 4, 4))))


@pytest.mark.parametrize("refinement", reference3d.REFINEMENTS)
@pytest.mark.parametrize("name", PAPER)
def test_3d_reference(benchmark: BenchmarkFixture, name: str, refinement: int) -> None:
    case = load_case(name)
    benchmark.group = name

    def run() -> Quantities:
        return quantities(case, lambda: reference3d.solve(case.scene, refinement))

    record(benchmark, benchmark.pedantic(run, rounds=3, warmup_rounds=1))
