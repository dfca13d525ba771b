"""What sweeps of 200 values cost, from the case file to the rows of the table, beside one solution of the same case.

Seconds are of the processor. The table's bracketed numbers are the ratios within this run.
"""

from __future__ import annotations

import time

import pytest
from pytest_benchmark.fixture import BenchmarkFixture

import rodmodel as rm
from cases.loader import load_case
from reports.quantities import evaluate
from reports.sweep.keys import sweep_points, variation
from reports.sweep.run import Row, sweep_rows

CASE = "two-cantilevers-e50-g0"
GROUP = "200 values of a key, each solved, beside one solution with its quantities"


@pytest.mark.benchmark(group=GROUP, timer=time.process_time)
def test_one_solution(benchmark: BenchmarkFixture) -> None:
    case = load_case(CASE)
    benchmark(lambda: evaluate(rm.solve(case.scene, case.rod_model.level, case.rod_model.order)))


@pytest.mark.benchmark(group=GROUP, timer=time.process_time)
@pytest.mark.parametrize(
    "varied",
    ["rods.upper.E=20..200GPa:200", "contacts.overlap.gap=0..1mm:200", "loads.1.force.2=-2..-0.1kN:200"],
    ids=["moduli", "gaps", "loads"],
)
def test_sweep(benchmark: BenchmarkFixture, varied: str) -> None:
    variations = [variation(varied)]

    def swept() -> list[Row]:
        return [row for found in sweep_rows(sweep_points(CASE, variations), variations) for row in found]

    rows = benchmark.pedantic(swept, rounds=2, warmup_rounds=0)
    assert all(row.outcome == "converged" for row in rows)
