"""Every case of the library, solved both ways and held to its own tolerances: a new file is a new test.

Cases whose finest 3D mesh is large are looked at on the first two meshes, which are uncertain by what they are apart:
the rod model may not miss by more than that and the tolerance. On three meshes nightly runs hold them all, and
`LIBRARY_IN_FULL=1 pytest tests/test_library_cases.py`.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence

import pytest

import reference3d
from cases.case import Case
from cases.loader import library_names, load_case
from reports.case_comparison import case_comparisons, evaluation_points
from reports.check.size import reference_unknowns
from reports.comparison import Comparison, Extrapolation
from reports.formatting import KIND_NAMES, MODEL_NAMES, measure, title
from reports.quantities import Quantities, evaluate
from reports.runner import run_case, run_rod

pytestmark = pytest.mark.slow

# Unknowns of the finest mesh up to which a case is solved on all three: about four seconds.
SMALL = float("inf") if os.environ.get("LIBRARY_IN_FULL") else 40_000


@pytest.mark.parametrize("name", library_names())
def test_case_keeps_its_tolerances(name: str) -> None:
    case = load_case(name)
    if reference_unknowns(case.scene)[-1] <= SMALL:
        run = run_case(case, lambda _: None)
        solved: Sequence[Quantities] = [answer.quantities for answer in (run.rod, *run.references)]
        missed = [found for found in run.comparisons if found.verdict != "pass"]
    else:
        solved = on_two_meshes(case)
        missed = missed_on_two_meshes(case, *solved)

    assert [found.outcome for found in solved] == ["converged"] * len(solved)
    # all deviations at once, so that one run tells the whole story
    assert not missed, "\n".join(deviations(missed))


def on_two_meshes(case: Case) -> tuple[Quantities, Quantities, Quantities]:
    """Quantities of the rod model and of the 3D reference on its first two meshes."""
    points = evaluation_points(case)
    coarse, medium = (
        evaluate(reference3d.solve(case.scene, mesh), points.stations, points.stress_points) for mesh in (1, 2)
    )
    return run_rod(case).quantities, coarse, medium


def missed_on_two_meshes(case: Case, rod: Quantities, coarse: Quantities, medium: Quantities) -> list[Comparison]:
    """What the rod model misses: of 3D where that is certain, of all else wherever it is no pass."""

    def extrapolate(first: float, _: float, second: float) -> Extrapolation:
        return Extrapolation(second, abs(second - first), None)

    comparisons = case_comparisons(case, rod, (coarse, coarse, medium), extrapolate)
    return [
        found
        for found in comparisons
        if found.model == "rod" and found.verdict not in ("pass", *(["not resolved"] * (found.kind == "reference")))
    ]


def deviations(missed: Iterable[Comparison]) -> list[str]:
    return [
        f"{MODEL_NAMES[found.model]} against {KIND_NAMES[found.kind]}: {title(found)}: {found.verdict} "
        f"(difference {measure(found.quantity, found.difference)}, uncertainty "
        f"{measure(found.quantity, found.uncertainty)}, tolerance {measure(found.quantity, found.tolerance)}) "
        f"{found.reason}"
        for found in missed
    ]
