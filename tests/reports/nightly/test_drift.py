"""What counts as drift: verdicts at once, values beyond their uncertainty, costs beyond their noise."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import pytest

from reports.nightly.drift import drifts, usual
from reports.nightly.rows import FAILED, RUN, Row

RowMaker = Callable[..., Row]
# The uncertainty of the rows' values: 0.1 % of the reference of 246 N.
UNCERTAINTY = 0.246


def of_values(row: RowMaker, values: Sequence[float]) -> list[list[str]]:
    """What each night tells of a value."""
    rows = [row(night, value=(value,)) for night, value in enumerate(values)]
    return [[found.kind for found in drifts([one], rows[:night])] for night, one in enumerate(rows)]


def of_seconds(row: RowMaker, earlier: Sequence[float], tonight: float, **entries: object) -> list[str]:
    rows = [row(night, seconds=value) for night, value in enumerate(earlier)]
    return [found.text for found in drifts([row(99, seconds=tonight, **entries)], rows)]


def test_the_first_run_has_nothing_to_drift_from(row: RowMaker) -> None:
    assert drifts([row()], []) == []


def test_a_changed_verdict_is_told_against_the_last_run(row: RowMaker) -> None:
    earlier = [row(0, verdict="fail"), row(1)]

    (found,) = drifts([row(2, verdict="not resolved")], earlier)

    assert (found.kind, found.text) == ("verdict", "from pass to not resolved")
    assert found.of == "rod model contact force overlap against 3D of its run"


def test_a_comparison_that_nobody_makes_any_more_is_told(row: RowMaker) -> None:
    (found,) = drifts([row(1, of="other")], [row(0), row(0, of="other")])

    assert found.text == "from pass to no longer compared"
    assert drifts([row(2, of="other")], [row(0), row(0, of="other"), row(1, of="other")]) == []


def test_a_case_that_was_not_run_is_not_drift_by_itself(row: RowMaker) -> None:
    assert drifts([row(1, quantity=RUN, verdict=FAILED, value=())], [row(0)]) == []
    assert drifts([row(2)], [row(0), row(1, quantity=RUN, verdict=FAILED, value=())]) == []


def test_a_jump_beyond_the_uncertainty_is_told_once(row: RowMaker) -> None:
    jump = 1.1 * UNCERTAINTY

    assert of_values(row, [246.5, 246.5 + jump, 246.5 + jump]) == [[], ["value"], []]
    assert of_values(row, [246.5, 246.5 + 0.9 * UNCERTAINTY]) == [[], []]


def test_a_creep_is_told_when_it_has_come_that_far(row: RowMaker) -> None:
    values = [246.5 + night * 0.4 * UNCERTAINTY for night in range(6)]

    assert of_values(row, values) == [[], [], [], ["value"], [], []]


def test_another_number_of_values_is_told(row: RowMaker) -> None:
    (found,) = drifts([row(1, value=(1.0, 2.0))], [row(0)])

    assert found.text.startswith("from 246.5 N to 1, 2 N")


@pytest.mark.parametrize(
    ("known", "allowed"),
    [
        ({"uncertainty": 0.0}, 0.1 * 0.01 * 246.0),  # a tenth of the tolerance
        ({"uncertainty": None}, 0.1 * 0.01 * 246.0),
        ({"uncertainty": None, "tolerance": None}, 1e-3 * 246.5),
        ({"uncertainty": 1e-12}, 1e-6 * 246.5),  # round-off
        ({"uncertainty": 0.2, "relative": False}, 0.2),
    ],
)
def test_where_the_uncertainty_says_nothing_a_small_share_may_move(
    row: RowMaker, known: dict[str, object], allowed: float
) -> None:
    earlier = [row(0, **known)]

    assert drifts([row(1, value=(246.5 + 0.98 * allowed,), **known)], earlier) == []
    assert len(drifts([row(1, value=(246.5 + 1.02 * allowed,), **known)], earlier)) == 1


def test_of_a_curve_the_difference_counts_as_its_place_moves(row: RowMaker) -> None:
    earlier = [row(0, quantity="deflection", value=(1.0,), difference=0.002)]

    assert drifts([row(1, quantity="deflection", value=(9.0,), difference=0.0025)], earlier) == []
    (found,) = drifts([row(1, quantity="deflection", value=(1.0,), difference=0.0035)], earlier)
    assert found.text == "difference from 0.2 % to 0.35 %, more than 0.1 %"


def test_one_value_that_moved_is_one_line_however_many_references_it_has(row: RowMaker) -> None:
    earlier = [row(0), row(0, against="published", uncertainty=0.0)]
    tonight = [row(1, value=(250.0,)), row(1, value=(250.0,), against="published", uncertainty=0.0)]

    assert len(drifts(tonight, earlier)) == 1
    assert len(drifts([*tonight, row(1, value=(250.0,), case="x")], [*earlier, row(0, case="x")])) == 2


def test_median_and_mad_do_not_heed_a_few_that_are_far_off() -> None:
    assert usual([1.0, 1.1, 0.9, 50.0, 1.0]) == (1.0, pytest.approx(1.4826 * 0.1))


def test_seconds_beyond_noise_are_told_either_way(row: RowMaker) -> None:
    noisy = [1.0, 1.1, 0.9, 1.0, 1.05, 30.0]

    assert of_seconds(row, noisy, 1.2) == []
    assert len(of_seconds(row, noisy, 2.0)) == 1
    assert len(of_seconds(row, noisy, 0.3)) == 1


def test_noise_is_measured_and_not_assumed(row: RowMaker) -> None:
    quiet, loud = [1.0, 1.01, 0.99, 1.0, 1.02], [1.0, 1.5, 0.6, 1.2, 0.8]

    assert len(of_seconds(row, quiet, 1.5)) == 1
    assert of_seconds(row, loud, 1.5) == []


def test_fewer_than_five_runs_tell_no_noise(row: RowMaker) -> None:
    assert of_seconds(row, [1.0] * 4, 100.0) == []
    assert len(of_seconds(row, [1.0] * 5, 100.0)) == 1


def test_seconds_from_the_cache_or_of_another_machine_do_not_count(row: RowMaker) -> None:
    kept = [row(night, kept_since="2026-01-01") for night in range(9)]

    assert drifts([row(99, seconds=100.0)], kept) == []
    assert of_seconds(row, [1.0] * 9, 100.0, kept_since="2026-01-01") == []
    assert of_seconds(row, [1.0] * 9, 100.0, machine="another") == []


def test_memory_is_watched_too(row: RowMaker) -> None:
    earlier = [row(night) for night in range(5)]

    assert drifts([row(9, memory=315.0)], earlier) == []
    (found,) = drifts([row(9, memory=600.0)], earlier)
    assert (found.kind, found.of) == ("memory", "rod model memory")
