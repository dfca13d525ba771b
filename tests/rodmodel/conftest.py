"""Scenes that the tests of the rod model share."""

from __future__ import annotations

from collections.abc import Callable

import pytest

import rodmodel as rm


@pytest.fixture
def cantilever() -> Callable[..., rm.Scene]:
    """A square bar along X, clamped at X = 0, under a force at its end."""

    def make(
        force: tuple[float, float, float],
        length: float = 300.0,
        side: float = 15.0,
        elements: int = 3,
        poisson: float = 0.3,
    ) -> rm.Scene:
        rod = rm.Rod(
            "bar",
            rm.Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0)),
            rm.Rectangle(side, side),
            rm.Material(200e3, poisson),
            tuple(length * i / elements for i in range(elements + 1)),
        )
        return rm.Scene("cantilever", (rod,), (rm.Clamp("bar", "start"),), (rm.SectionForce("bar", length, force),), ())

    return make
