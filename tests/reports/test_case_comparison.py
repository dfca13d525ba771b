"""What a case is held against, by its own checks and tolerances."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from cases.case import Check, Published
from cases.loader import library_names, load_case
from reports.case_comparison import comparisons_without_reference, evaluation_points, extract
from reports.formatting import title
from reports.quantities import DEFINITIONS
from reports.runner import CaseRun
from reports.truth import independent_values


def test_every_check_of_the_case_is_made_against_the_3d_reference(case_run: CaseRun) -> None:
    found = [(each.quantity, each.of, each.tolerance) for each in case_run.comparisons if each.kind == "reference"]

    assert found == [(check.quantity, check.of, check.tolerance) for check in case_run.case.compare]


def test_both_models_are_held_against_the_independent_values(case_run: CaseRun) -> None:
    models = {each.model for each in case_run.comparisons if each.kind == "3d converged"}

    assert models == {"rod", "reference"}


def test_published_values_judge_the_rod_model_alone(case_run: CaseRun) -> None:
    published = [each for each in case_run.comparisons if each.kind == "published"]

    assert [each.quantity for each in published] == [entry.quantity for entry in case_run.case.published]
    assert {each.model for each in published} == {"rod"}
    assert all(each.source for each in published)


def test_the_reference_value_is_extrapolated_from_the_three_meshes(case_run: CaseRun) -> None:
    force = next(each for each in case_run.comparisons if each.quantity == "contact_force")

    assert force.reference == pytest.approx((320.0,))  # 316, 319, 319.75: second order
    assert force.difference == pytest.approx(0.0, abs=1e-12)
    assert force.uncertainty == pytest.approx(0.75 / 320.0)


def test_a_deflection_is_held_against_the_independent_one_at_its_own_stations(case_run: CaseRun) -> None:
    truth = independent_values(case_run.case.independent, case_run.case.scene)
    rod = case_run.rod.quantities.rod("lower")
    expected = truth.estimates["deflection", "lower"].value
    nearest = np.abs(rod.station[:, None] - truth.stations["lower"]).argmin(axis=0)
    assert rod.station[nearest] == pytest.approx(truth.stations["lower"], abs=1e-9)

    found = next(
        each
        for each in case_run.comparisons
        if (each.quantity, each.of, each.model, each.kind) == ("deflection", "lower", "rod", "3d converged")
    )

    largest = np.abs(rod.displacement[1, nearest] - expected).max() / np.abs(expected).max()
    assert found.difference == pytest.approx(largest)


def test_a_published_deflection_is_held_against_its_component_at_its_place(case_run: CaseRun) -> None:
    published = Published("deflection", "upper", (-2.0,), 0.5, "a book", position=137.0, axis="Y")
    case = replace(case_run.case, published=(published,))
    points = evaluation_points(case)
    stations = np.linspace(0.0, 300.0, 301)
    rod = replace(
        case_run.rod.quantities.rod("upper"), station=stations, displacement=np.outer([0.0, -0.01, 1.0], stations)
    )
    quantities = replace(case_run.rod.quantities, rods=(case_run.rod.quantities.rod("lower"), rod))

    alone = comparisons_without_reference(replace(case, compare=(), independent=None), quantities)

    assert 137.0 in points.stations["upper"]
    (found,) = alone
    assert found.value == pytest.approx((-1.37,))
    assert found.difference == pytest.approx(0.63 / 2.0)
    assert title(found) == "Deflection, upper at (0, 0, 137) along Y"


@pytest.mark.parametrize("name", [name for name in library_names() if name.startswith("two-cantilevers")])
def test_every_quantity_a_case_may_name_is_defined_and_can_be_extracted(name: str, case_run: CaseRun) -> None:
    case = load_case(name)

    for entry in (*case.compare, *case.published):
        assert entry.quantity in DEFINITIONS
        point = getattr(entry, "point", None)
        values = extract(case_run.rod.quantities, Check(entry.quantity, entry.of, entry.tolerance, point))
        assert values.size > 0


def test_points_whose_stress_is_compared_are_evaluated() -> None:
    case = load_case("two-cantilevers-e20-g0")

    points = evaluation_points(case).stress_points

    assert points == tuple((check.of, check.point) for check in case.compare if check.quantity == "stress_s")
    assert points
