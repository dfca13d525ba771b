"""The numbers that a solution is wanted for."""

import pytest

import rodmodel as rm
from cases.loader import load_case
from rodmodel.goals import Goal, goals

STEEL = rm.Material(200e3, 0.3)


def test_a_propped_cantilever_has_force_deflection_clamp_moment_and_edges():
    rod = rm.Rod("bar", rm.Line((0, 0, 0), (300, 0, 0), (0, 1, 0)), rm.Rectangle(10, 10), STEEL, (0, 10, 150, 280, 300))
    pair = rm.ContactPair("prop", rm.RodFace("bar", "bottom"), rm.Ground(), (280, 300), 0.0)
    load = rm.SectionForce("bar", 150, (0, -1000, 0))
    solution = rm.solve(rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (load,), (pair,)), 3, 5)

    found = goals(solution)

    force, moment = found[Goal("contact force", "prop")], found[Goal("clamp moment", "bar")]
    # the prop acts between 280 and 300 mm: equilibrium about the clamp brackets the moment
    assert 1000 * 150 - force * 300 <= moment <= 1000 * 150 - force * 280
    # 7 F L^3 / (768 E I) under the load by Bernoulli; the prop stands up to 20 mm nearer, the largest lies beside it
    assert found[Goal("deflection", "bar")] == pytest.approx(7 * 1000 * 300**3 / (768 * 200e3 * 10**4 / 12), rel=0.2)
    assert found[Goal("contact edge", "prop", 0)] >= 280


def test_a_clamp_that_the_force_s_line_of_action_passes_through_has_no_moment():
    solution = rm.solve(load_case("clip").scene, 4, 4)

    assert [goal.kind for goal in goals(solution)] == ["deflection"]
