"""What a sweep costs beside one solution of the same case: the ratio within one run counts, not the seconds."""

from __future__ import annotations

import time

import numpy as np
import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import rodmodel as rm
from cases.loader import load_case
from reports.quantities import evaluate
from reports.sweep.keys import sweep_points, variation
from reports.sweep.run import sweep_rows

CASE = "two-cantilevers-e50-g0"
COUNT = 200


def one_solution() -> float:
    """Processor time of one solution with its quantities, s: the median of several."""
    case, seconds = load_case(CASE), []
    for _ in range(9):
        begin = time.process_time()
        evaluate(rm.solve(case.scene, case.rod_model.level, case.rod_model.order))
        seconds.append(time.process_time() - begin)
    return float(np.median(seconds))


@pytest.mark.benchmark(group=f"sweeps of {COUNT} values, from the case file to the rows of the table")
@pytest.mark.parametrize(
    "varied",
    [
        f"rods.upper.E=20..200GPa:{COUNT}",
        f"contacts.overlap.gap=0..1mm:{COUNT}",
        f"loads.1.force.2=-2..-0.1kN:{COUNT}",
    ],
)
def test_sweep_beside_one_solution(benchmark: BenchmarkFixture, varied: str) -> None:
    variations = [variation(varied)]

    def swept() -> float:
        begin = time.process_time()
        rows = [row for found in sweep_rows(sweep_points(CASE, variations), variations) for row in found]
        assert all(row.outcome == "converged" for row in rows)
        return time.process_time() - begin

    before = one_solution()
    seconds = benchmark.pedantic(swept, rounds=1)
    benchmark.extra_info["solutions"] = round(2.0 * seconds / (before + one_solution()), 1)
    print(f"{varied}: {benchmark.extra_info['solutions']} times one solution")
