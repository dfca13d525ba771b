"""Rows of a history, and cases that are solved in no time or by nobody."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from pathlib import Path
from typing import Any

import pytest

from cases.case import Case
from cases.loader import load_case
from reports.nightly.rows import Row

FIRST = datetime(2026, 1, 1, 2, tzinfo=UTC)

TINY = """
title = "Tiny"
[materials.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3
[sections.square]
shape = "rectangle"
width = 10
height = 10
[rods.bar]
section = "square"
material = "steel"
element_borders = [0, 10, 50]
[rods.bar.centre_line]
shape = "line"
start = [0, 0, 0]
end = [50, 0, 0]
up = [0, 1, 0]
[[supports]]
kind = "clamp"
rod = "bar"
end = "start"
[[loads]]
kind = "section force"
rod = "bar"
position = 50
force = [0, -100, 0]
[rod_model]
level = 3
order = 4
[[compare]]
quantity = "deflection"
rod = "bar"
tolerance = "5 %"
"""


@pytest.fixture
def tiny_files(tmp_path: Path) -> tuple[Path, Path]:
    """Two case files of a short cantilever, under one load and under twice that load."""
    first, second = tmp_path / "tiny.toml", tmp_path / "double.toml"
    first.write_text(TINY)
    second.write_text(TINY.replace("-100", "-200"))
    return first, second


@pytest.fixture
def tiny(tiny_files: tuple[Path, Path]) -> Case:
    """A short cantilever."""
    return load_case(tiny_files[0])


def _row(night: int = 0, **entries: Any) -> Row:
    common = Row(
        run=f"{FIRST + timedelta(days=night):%Y%m%dT%H%M%SZ}-{night:08x}",
        time=FIRST + timedelta(days=night),
        case="bars",
        quantity="contact_force",
        of="overlap",
        solver="rod model",
        against="reference",
        source="3D of this run",
        unit="N",
        relative=True,
        value=(246.5,),
        reference=(246.0,),
        difference=0.002,
        uncertainty=0.001,
        tolerance=0.01,
        verdict="pass",
        seconds=1.0,
        unknowns=4536,
        memory=300.0,
        versions="python 3.11",
        commit="0123abc",
        machine="host",
    )
    return replace(common, **entries)


@pytest.fixture
def row() -> Callable[..., Row]:
    """A row of the night of a number, with entries of its own."""
    return _row
