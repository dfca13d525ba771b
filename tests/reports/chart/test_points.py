"""Errors of configurations: against the extrapolated 3D reference, and none where none can be formed."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import pytest

from reports.chart.points import Chart, Point, Reference, own_values, references_of
from reports.comparison import Extrapolation
from reports.quantities import Quantities
from reports.runner import CaseRun


def second_order(coarse: float, medium: float, fine: float) -> Extrapolation:
    del coarse
    return Extrapolation(fine + (fine - medium) / 3.0, abs(fine - medium), 2.0)


@pytest.fixture
def meshes(case_run: CaseRun) -> list[Quantities]:
    """Contact forces of 316, 319 and 319.75 N, in contact from 238 to 262 mm of a zone from 200 to 300 mm."""
    return [answer.quantities for answer in case_run.references]


def test_references_are_extrapolated_and_know_how_certain_they_are(case_run: CaseRun, meshes: list[Quantities]) -> None:
    found = references_of(case_run.case.scene, meshes, second_order)

    assert found["contact_force"].values["overlap"] == pytest.approx((320.0,), rel=1e-9)
    assert found["contact_force"].uncertainty == pytest.approx(0.75 / 320.0, rel=1e-9)
    # an edge on a station lies between the two beside it, each 0.25 mm away, and cannot be extrapolated
    assert found["contact_edges"].values["overlap"] == pytest.approx((238.0, 262.0), abs=0.25)
    assert found["contact_edges"].uncertainty == pytest.approx(0.5)
    assert set(found["clamp_moment"].values) == {"lower at 0 mm", "upper at 300 mm"}
    assert found["peak_pressure"].reason == ""


def test_a_peak_at_the_end_of_a_zone_is_singular_and_has_no_reference(
    case_run: CaseRun, meshes: list[Quantities]
) -> None:
    cornered = [
        replace(mesh, contacts=tuple(replace(each, edges=((200.0, 221.3),)) for each in mesh.contacts))
        for mesh in meshes
    ]

    found = references_of(case_run.case.scene, cornered, second_order)["peak_pressure"]

    assert found.values == {}
    assert "singular at X = 200 mm" in found.reason


def test_errors_are_relative_to_each_reference_and_the_largest_counts(
    chart: Chart, point: Callable[..., Point]
) -> None:
    chart = replace(chart, references={"largest_deflection": Reference({"rod": (2.0,), "other": (10.0,)}, 0.0)})
    both = point("3D", "mesh", 1.0, 0.0, 2.1)
    both = replace(both, values={**both.values, ("largest_deflection", "other"): (9.0,)})

    assert chart.error("largest_deflection", both) == pytest.approx(0.1)


def test_edges_are_off_by_a_length_and_other_stretches_are_no_error_at_all(
    chart: Chart, point: Callable[..., Point]
) -> None:
    chart = replace(chart, references={"contact_edges": Reference({"pair": (200.0, 220.0)}, 0.1)})
    one = replace(point("3D", "mesh", 1.0, 0.0, 0.0), values={("contact_edges", "pair"): (200.5, 222.0)})
    two = replace(one, values={("contact_edges", "pair"): (200.0, 210.0, 215.0, 220.0)})

    assert chart.error("contact_edges", one) == pytest.approx(2.0)
    assert chart.error("contact_edges", two) is None


def test_nothing_is_relative_to_a_reference_that_vanishes(case_run: CaseRun, meshes: list[Quantities]) -> None:
    apart = [replace(mesh, contacts=tuple(replace(each, force=0.0) for each in mesh.contacts)) for mesh in meshes]

    found = references_of(case_run.case.scene, apart, second_order)["contact_force"]

    assert found.values == {}
    assert "vanishes" in found.reason


def test_our_solvers_tell_every_quantity(case_run: CaseRun) -> None:
    values = own_values(case_run.case.scene, case_run.rod.quantities)

    assert {quantity for quantity, _ in values} == {
        "contact_force",
        "largest_deflection",
        "contact_edges",
        "clamp_moment",
        "peak_pressure",
    }
    # 2 P / (pi a b), as the profile was made
    assert values["peak_pressure", "overlap"] == pytest.approx((2.0 * 320.0 / (3.14159265 * 12.0 * 15.0),), rel=1e-6)
