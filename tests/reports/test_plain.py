"""Frozen data survive the way to plain JSON and back bit by bit."""

from __future__ import annotations

import json
from dataclasses import dataclass, fields
from typing import Any

import numpy as np
import pytest

from cases.loader import library_names, load_case
from reports.plain import from_plain, to_plain
from reports.quantities import ContactQuantities, PressureProfile, Quantities, RodQuantities
from reports.runner import KINDS, CaseRun, ReferenceRuns, Run


@dataclass(frozen=True)
class Sample:
    name: str
    entries: tuple[Any, ...]


def through_json(value: object, kinds: tuple[type, ...] = ()) -> Any:
    return from_plain(json.loads(json.dumps(to_plain(value))), kinds)


def same(value: Any, other: Any) -> bool:
    """Equality of type, of shape and of every bit."""
    if type(value) is not type(other):
        return False
    if isinstance(value, np.ndarray):
        return (value.dtype, value.shape, value.tobytes()) == (other.dtype, other.shape, other.tobytes())
    if isinstance(value, dict):
        return list(value) == list(other) and all(same(value[name], other[name]) for name in value)
    if isinstance(value, tuple):
        return len(value) == len(other) and all(map(same, value, other))
    if isinstance(value, (*KINDS, Sample)):
        return all(same(getattr(value, field.name), getattr(other, field.name)) for field in fields(value))
    return bool(value == other) or value != value  # nan


@pytest.mark.parametrize(
    "value",
    [
        0.1 + 0.2,
        -0.0,
        5e-324,
        float("inf"),
        float("nan"),
        7,
        True,
        None,
        "naïve \ud800",
        ((1.0, 2.0), ()),
        {("lower", (0.0, 7.5, 3.75)): -101.5, "other": (1,)},
        np.linspace(0.0, 1.0, 7).reshape(7, 1) / 3.0,
        np.zeros((3, 0)),
        np.arange(4),
    ],
    ids=repr,
)
def test_a_value_comes_back_as_it_was(value: object) -> None:
    assert same(through_json(value), value)


def test_the_sign_of_zero_is_kept() -> None:
    assert str(through_json(-0.0)) == "-0.0"


def test_dataclasses_come_back_with_all_that_is_in_them() -> None:
    sample = Sample("outer", (Sample("inner", (np.array([1.0, np.nan]),)), {"a": 1}))

    assert same(through_json(sample, (Sample,)), sample)


def test_answers_of_both_models_come_back_as_they_were(case_run: CaseRun) -> None:
    kept = ReferenceRuns((case_run.rod, *case_run.references), (3.0, 1.5, 1.0))
    assert {Run, Quantities, RodQuantities, ContactQuantities, PressureProfile} < set(KINDS)

    assert same(through_json(kept, KINDS), kept)


def test_only_the_dataclasses_that_were_named_are_built() -> None:
    with pytest.raises(KeyError, match="Sample"):
        through_json(Sample("other", ()))


def test_what_has_no_plain_form_is_refused() -> None:
    with pytest.raises(TypeError, match="function"):
        to_plain((lambda x: x,))


def test_scenes_of_the_library_have_plain_forms_that_differ() -> None:
    forms = {json.dumps(to_plain(load_case(name).scene)) for name in library_names()}

    assert len(forms) == len(library_names())
