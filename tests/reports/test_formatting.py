"""How numbers are written for people."""

from __future__ import annotations

import pytest

from reports.formatting import grades, measure, number, seconds, stretches


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (246.92912, "246.929"),
        (62201.13, "62201.1"),
        (-0.8494852, "\N{MINUS SIGN}0.84949"),
        (0.0, "0"),
        (1.8e-6, "1.80000e-06"),
        (None, "none"),
    ],
)
def test_numbers_keep_six_significant_digits_or_so(value: float | None, text: str) -> None:
    assert number(value) == text


def test_relative_quantities_are_measured_in_per_cent_and_others_in_their_unit() -> None:
    assert measure("contact_force", 0.00304) == "0.304 %"
    assert measure("contact_edges", 0.3634) == "0.363 mm"
    assert measure("contact_edges", None) == "unknown"


def test_stretches_are_read_as_from_and_to() -> None:
    assert stretches([200.0, 221.664, 240.0, 250.0]) == "200.00 to 221.66, 240.00 to 250.00"
    assert stretches([]) == "none"


def test_levels_that_differ_are_told_from_the_lowest_to_the_highest() -> None:
    assert grades(5) == grades({"lower": (5, 5)}) == "5"
    assert grades({"lower": (3, 4), "upper": (2, 6)}) == "2 to 6"


def test_durations_have_the_unit_that_suits_them() -> None:
    assert seconds(0.0123) == "12 ms"
    assert seconds(12.34) == "12.3 s"
