"""Every case of the library, solved both ways and held to its own tolerances: a new file is a new test."""

from __future__ import annotations

import pytest

from cases.loader import library_names, load_case
from reports.formatting import KIND_NAMES, MODEL_NAMES, measure, title
from reports.runner import run_case

pytestmark = pytest.mark.slow


@pytest.mark.parametrize("name", library_names())
def test_case_keeps_its_tolerances(name: str) -> None:
    run = run_case(load_case(name), lambda _: None)

    outcomes = [answer.quantities.outcome for answer in (run.rod, *run.references)]
    assert outcomes == ["converged"] * len(outcomes)
    # all deviations at once, so that one run tells the whole story
    deviations = [
        f"{MODEL_NAMES[found.model]} against {KIND_NAMES[found.kind]}: {title(found)}: {found.verdict} "
        f"(difference {measure(found.quantity, found.difference)}, uncertainty "
        f"{measure(found.quantity, found.uncertainty)}, tolerance {measure(found.quantity, found.tolerance)}) "
        f"{found.reason}"
        for found in run.comparisons
        if found.verdict != "pass"
    ]
    assert not deviations, "\n".join(deviations)
