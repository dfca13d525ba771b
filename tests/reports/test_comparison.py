"""Differences, uncertainties and the verdicts that follow."""

from __future__ import annotations

import math

import numpy as np
import pytest

from cases.case import Check
from reports.comparison import (
    Estimate,
    Extrapolation,
    compare,
    edges_estimate,
    judge,
    sequence_estimate,
)


def second_order(coarse: float, medium: float, fine: float) -> Extrapolation:
    """Richardson's extrapolation of second order with halved meshes."""
    step = fine - medium
    return Extrapolation(fine + step / 3.0, abs(step), 2.0)


@pytest.mark.parametrize(
    ("difference", "uncertainty", "verdict"),
    [
        (0.5, 0.1, "pass"),
        (1.0, 1.0, "pass"),
        (1.5, 0.1, "fail"),
        (1.05, 0.9, "fail"),
        (0.5, 1.1, "not resolved"),
        (1.5, 1.1, "not resolved"),
        (2.2, 1.1, "fail"),  # no reference within its uncertainty would be close enough
        (0.0, math.inf, "not resolved"),
        (0.0, None, "not resolved"),
        (math.inf, 0.0, "fail"),
    ],
)
def test_verdict_for_a_tolerance_of_one(difference: float, uncertainty: float | None, verdict: str) -> None:
    assert judge(difference, uncertainty, 1.0)[0] == verdict


def test_a_solver_that_did_not_converge_never_passes() -> None:
    verdict, reason = judge(0.0, 0.0, 1.0, ["converged", "cycling"])

    assert verdict == "not resolved"
    assert reason == "a solver did not converge: cycling"


def held(quantity: str, value: list[float], reference: list[float], uncertainty: float | None = 0.0, **changes):
    check = Check(quantity, "overlap", changes.pop("tolerance", 0.01))
    estimate = Estimate(np.array(reference), uncertainty)
    return compare(check, "rod", np.array(value), estimate, kind="reference", source="test", **changes)


def test_a_force_is_compared_relative_to_the_reference() -> None:
    found = held("contact_force", [101.0], [100.0], uncertainty=0.5, tolerance=0.02)

    assert found.difference == pytest.approx(0.01)
    assert found.uncertainty == pytest.approx(0.005)
    assert found.verdict == "pass"


def test_edges_are_compared_in_millimetres_and_the_worst_counts() -> None:
    found = held("contact_edges", [200.0, 222.0], [200.0, 221.3], uncertainty=0.3, tolerance=1.0)

    assert found.difference == pytest.approx(0.7)
    assert found.uncertainty == 0.3
    assert found.value == (200.0, 222.0)


def test_another_number_of_stretches_is_a_fail() -> None:
    found = held("contact_edges", [200.0, 222.0, 240.0, 250.0], [200.0, 221.3], tolerance=1.0)

    assert (found.verdict, found.difference) == ("fail", None)
    assert "4 values against 2" in found.reason


def test_another_number_of_stretches_fails_no_model_where_the_references_own_meshes_differ_in_it() -> None:
    found = held("contact_edges", [200.0, 222.0], [200.0, 210.0, 215.0, 222.0], uncertainty=None, tolerance=1.0)

    assert (found.verdict, found.difference) == ("not resolved", None)


def test_no_contact_on_either_side_is_agreement() -> None:
    assert held("contact_edges", [], [], tolerance=1.0).verdict == "pass"


def test_a_curve_is_compared_relative_to_its_largest_magnitude() -> None:
    reference = np.array([[0.0, 0.0, 0.0], [0.0, -1.0, -2.0], [0.0, 0.0, 0.0]])
    value = reference + np.array([[0.0, 0.003, 0.0], [0.0, 0.0, 0.0], [0.0, 0.004, 0.0]])
    check = Check("deflection", "lower", 0.01)

    found = compare(check, "rod", value, Estimate(reference, 0.002), kind="reference", source="test")

    assert found.difference == pytest.approx(0.005 / 2.0)  # |(3, 4)| um over 2 mm
    assert found.uncertainty == pytest.approx(0.001)
    assert found.reference == (1.0,)  # where they are farthest apart


def test_a_relative_difference_from_zero_is_not_a_number_to_pass_on() -> None:
    assert held("contact_force", [0.1], [0.0]).verdict == "fail"
    assert held("contact_force", [0.0], [0.0]).verdict == "pass"


def test_numbers_are_extrapolated_one_by_one_and_the_largest_uncertainty_counts() -> None:
    meshes = [np.array([10.0, 116.0]), np.array([10.0, 104.0]), np.array([10.0, 101.0])]

    estimate = sequence_estimate(meshes, second_order, curve=False)

    assert estimate.value == pytest.approx([10.0, 100.0])
    assert estimate.uncertainty == pytest.approx(3.0)


def test_a_curve_is_extrapolated_as_a_whole() -> None:
    exact = np.array([[0.0, 0.0, 0.0], [0.0, -1.0, -4.0], [0.0, 0.0, 0.0]])
    meshes = [exact * (1.0 - error) for error in (0.16, 0.04, 0.01)]

    estimate = sequence_estimate(meshes, second_order, curve=True)

    assert estimate.value == pytest.approx(exact)
    assert estimate.uncertainty == pytest.approx(0.03 * 4.0)


def test_meshes_that_disagree_on_the_number_of_stretches_leave_the_reference_unresolved() -> None:
    meshes = [np.array([1.0, 2.0]), np.array([1.0, 2.0, 3.0, 4.0]), np.array([1.0, 2.0])]

    estimate = sequence_estimate(meshes, second_order, curve=False)

    assert estimate.uncertainty is None
    check = Check("contact_edges", "overlap", 1.0)
    found = compare(check, "rod", np.array([1.0, 2.0]), estimate, kind="reference", source="test")
    assert found.verdict == "not resolved"


@pytest.mark.parametrize(("resolution", "uncertainty"), [(0.8, 0.8), (0.1, 0.4)])
def test_edges_are_as_uncertain_as_stations_are_apart_or_meshes_disagree(resolution: float, uncertainty: float) -> None:
    meshes = [np.array([200.0, 221.2]), np.array([200.0, 221.3]), np.array([200.0, 221.6])]

    estimate = edges_estimate(meshes, resolution)

    assert estimate.value == pytest.approx([200.0, 221.6])
    assert estimate.uncertainty == pytest.approx(uncertainty)


def test_edges_whose_number_depends_on_the_mesh_are_unresolved() -> None:
    meshes = [np.array([1.0, 2.0]), np.array([1.0, 2.0]), np.array([1.0, 2.0, 3.0, 4.0])]

    assert edges_estimate(meshes, resolution=0.1).uncertainty is None
