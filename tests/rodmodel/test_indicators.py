"""Energy in the highest functions of each element."""

import numpy as np
import pytest

import rodmodel as rm
from cases.loader import load_case
from rodmodel.indicators import elements_near_corners, indicators, pressed_elements, unit_energy
from rodmodel.section import axial_modulus

STEEL = rm.Material(200e3, 0.3)


def cantilever(order: int, load: rm.SectionForce | rm.LineLoad) -> rm.Solution:
    rod = rm.Rod("bar", rm.Line((0, 0, 0), (200, 0, 0), (0, 1, 0)), rm.Rectangle(10, 10), STEEL, (0, 2, 10, 100, 200))
    return rm.solve(rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (load,), ()), level=3, order=order)


TIP = rm.SectionForce("bar", 200, (0, -100, 0))


def test_the_elements_together_hold_the_energy_of_the_rod():
    solution = cantilever(4, TIP)
    bar, state = solution.system.rods["bar"], solution.states["bar"]

    energies = [unit_energy(*pair) for pair in zip(bar.elements, state.coefficients, strict=True)]

    # round-off alone
    assert axial_modulus(STEEL) * sum(energies) == pytest.approx(solution.stored_energy, rel=1e-10)


def test_highest_fields_count_most_at_a_clamp():
    # per length: the warping of shear, of degree 3, goes on along the bar; what the clamp adds does not
    highest = indicators(cantilever(4, TIP))["bar"].by_degree[:, -1] / np.array([2, 8, 90, 100])

    assert highest.argmax() == 0


def test_energy_by_degree_counts_two_degrees_as_one_may_vanish():
    shown = indicators(cantilever(4, TIP))["bar"]

    np.testing.assert_allclose(shown.over_section, shown.by_degree[:, 2] + shown.by_degree[:, 3], rtol=1e-12)


def test_elements_next_to_the_clamp_and_the_loaded_end_are_near_corners():
    # within one height, 10 mm, of 0 and of 200 mm with their middle
    assert elements_near_corners(cantilever(4, TIP))["bar"].tolist() == [True, True, False, False]


def test_a_cubic_deflection_needs_no_more_than_order_four_away_from_the_clamp():
    along = indicators(cantilever(4, TIP))["bar"].along

    assert along[2:].max() < 1e-8 < along[:2].max()


def test_a_load_along_the_rod_needs_more_than_order_three():
    uniform = rm.LineLoad("bar", 0, 200, (0, -1, 0))

    low, high = (indicators(cantilever(order, uniform))["bar"].along[2:].max() for order in (3, 6))

    assert low > 1e-5
    assert high < 1e-3 * low


def test_contact_presses_where_the_faces_touch():
    solution = rm.solve(load_case("two-cantilevers-e50-g0").scene, 2, 4)
    pressed = pressed_elements(solution)

    for name, start in (("lower", 0.0), ("upper", 200.0)):
        borders = start + solution.system.rods[name].borders
        # in contact from X = 200 to about 218 mm at this level
        inside = (borders[:-1] < 215.0) & (borders[1:] > 200.0 + 1e-6)
        assert pressed[name][inside].all()
        assert not pressed[name][borders[:-1] > 225.0].any()
