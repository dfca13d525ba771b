"""Lost digits: what a solution tells of itself is what a closed form shows that it lost."""

from __future__ import annotations

import numpy as np
import pytest

import rodmodel as rm
from cases.scene import CentreLine
from rodmodel.soundness import WORTH_A_WARNING, lost_accuracy, lost_digits

SIDE = 10.0
MATERIAL = rm.Material(200e3, 0.0)
BENDING = MATERIAL.young_modulus * SIDE**4 / 12.0


def cantilever(line: CentreLine, borders: tuple[float, ...]) -> rm.Solution:
    """Without contraction, under a unit force along Y on its end."""
    rod = rm.Rod("bar", line, rm.Rectangle(SIDE, SIDE), MATERIAL, borders)
    load = rm.SectionForce("bar", line.length, (0.0, 1.0, 0.0))
    return rm.solve(rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (load,), ()), 2, 4)


def straight(length: float) -> rm.Line:
    return rm.Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0))


def equal(length: float, elements: int) -> tuple[float, ...]:
    return tuple(np.linspace(0.0, length, elements + 1).tolist())


def told(solution: rm.Solution) -> float:
    return lost_accuracy(solution.system.rods["bar"], solution.states["bar"].coefficients)


@pytest.mark.slow
@pytest.mark.parametrize("elements", [1000, 3000])
def test_many_elements_of_a_slender_rod_lose_what_is_told(elements: int) -> None:
    length = 2e4 / 3.0 * SIDE
    exact = length**3 / (3.0 * BENDING) + 1.2 * length / (0.5 * MATERIAL.young_modulus * SIDE**2)

    solution = cantilever(straight(length), equal(length, elements))

    lost = abs(float(solution.displacement("bar", np.array([length]))[1, 0]) / exact - 1.0)
    assert lost > WORTH_A_WARNING
    # Round-off is not smooth: an estimate of its order of magnitude is what there can be.
    assert 0.2 < told(solution) / lost < 5.0


def test_short_elements_of_a_slender_arc_are_worth_a_warning() -> None:
    arc = rm.Helix((1e4 * SIDE, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0.5 * np.pi, (1.0, 0.0, 0.0))
    coarse = equal(arc.length, 8)

    assert told(cantilever(arc, coarse)) < WORTH_A_WARNING
    short = (0.0, 0.2 * SIDE, *coarse[1:-1], arc.length - 0.2 * SIDE, arc.length)
    assert told(cantilever(arc, short)) > WORTH_A_WARNING


def test_usual_rods_lose_next_to_nothing() -> None:
    assert told(cantilever(straight(300.0), (0.0, 3.0, 15.0, 100.0, 200.0, 300.0))) < 1e-10


def test_rods_on_supports_of_any_kind_and_twisted_ones_tell_as_well() -> None:
    line = rm.Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 1.0, 0.0), twist=1.0)
    rod = rm.Rod("bar", line, rm.Rectangle(SIDE, 0.5 * SIDE), rm.Material(200e3, 0.3), equal(300.0, 6))
    held = (rm.Support("bar", 0.0, ("x", "y", "s", "turn s"), "mean"), rm.Support("bar", 300.0, ("x", "y"), "section"))
    load = rm.SectionForce("bar", 150.0, (0.0, 1.0, 0.5))

    assert 0.0 < told(rm.solve(rm.Scene("bar", (rod,), held, (load,), ()), 3, 5)) < 1e-10


def test_rod_at_rest_has_lost_nothing() -> None:
    rod = rm.Rod("bar", straight(100.0), rm.Rectangle(SIDE, SIDE), MATERIAL, (0.0, 100.0))
    assert told(rm.solve(rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (), ()), 2, 4)) == 0.0


def test_digits_of_sixteen() -> None:
    assert [lost_digits(error) for error in (0.0, 1e-16, 1e-10, 0.28)] == [0, 0, 6, 16]
