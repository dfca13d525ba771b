"""The solver's own choice of levels, orders and elements: within the tolerance, or honest about it."""

import json

import numpy as np
import pytest

import rodmodel as rm
from cases.loader import load_case
from cases.scene import Scene
from rodmodel.adaptive import AdaptiveSolution, Look, levels_for, solve_to
from rodmodel.remaining import Share

STEEL = rm.Material(200e3, 0.3)


def paper(name: str) -> Scene:
    return load_case(f"two-cantilevers-{name}").scene


def value(found: AdaptiveSolution, kind: str, of: str) -> float:
    return next(each.value for each in found.estimates if (each.goal.kind, each.goal.of) == (kind, of))


def independent_force(name: str) -> float:
    """3D value made outside this project, certain to 0.005 %."""
    path = load_case(f"two-cantilevers-{name}").independent
    assert path is not None
    return float(json.loads(path.read_text(encoding="utf-8"))["contact_force_N"])


@pytest.mark.parametrize("name", ["e50-g0", "e20-g05"])
@pytest.mark.parametrize("tolerance", [1e-2, 1e-3, 2e-4])
def test_contact_force_is_within_the_tolerance_of_3d(name, tolerance):
    found = solve_to(paper(name), tolerance)

    assert found.outcome == "converged"
    assert value(found, "contact force", "overlap") == pytest.approx(independent_force(name), rel=tolerance)
    assert all(each.relative <= tolerance for each in found.estimates if each.goal.kind != "contact edge")


def test_a_smaller_tolerance_takes_more_unknowns():
    rough, fine = (solve_to(paper("e50-g0"), tolerance).steps[-1].unknowns for tolerance in (1e-2, 2e-4))

    assert rough < fine


def test_high_levels_stand_where_fields_are_steep():
    lower = solve_to(paper("e50-g0"), 2e-4).steps[-1].meshes["lower"]

    # at the clamp, not half way to the contact
    middle = np.searchsorted(lower.borders, 100.0) - 1
    assert lower.levels[0] > lower.levels[middle]


def test_what_equilibrium_fixes_is_known():
    """The moment in a cantilever's clamp is force times length at every level, and no error may be invented."""
    rod = rm.Rod("bar", rm.Line((0, 0, 0), (100, 0, 0), (0, 1, 0)), rm.Rectangle(10, 10), STEEL, (0, 50, 100))
    load = rm.SectionForce("bar", 100, (0, -500, 0))
    found = solve_to(rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), (load,), ()), 1e-2)

    moment = next(each for each in found.estimates if each.goal.kind == "clamp moment")
    assert moment.value == pytest.approx(500.0 * 100.0, rel=1e-9)
    assert moment.relative < 1e-7


def test_a_twisted_bar_whose_centre_line_stays_is_solved_to_its_energy():
    rod = rm.Rod("bar", rm.Line((0, 0, 0), (100, 0, 0), (0, 1, 0)), rm.Rectangle(10, 10), STEEL, (0, 50, 100))
    holds = rm.Support("bar", 0.0, ("x", "y", "s", "turn x", "turn y", "turn s"), of="mean")
    twist = rm.SectionMoment("bar", 100, (1e4, 0, 0))
    found = solve_to(rm.Scene("bar", (rod,), (holds,), (twist,), ()), 1e-2)

    # Saint-Venant: T^2 l / (2 G J), J = 0.1406 a^4 (Timoshenko, Goodier, Theory of Elasticity, section 109); the end
    # that is loaded and the one that is held warp otherwise within a height
    exact = 1e4**2 * 100.0 / (2.0 * 200e3 / 2.6 * 0.1406 * 10.0**4)
    (energy,) = found.estimates
    assert found.outcome == "converged"
    assert energy.value == pytest.approx(exact, rel=0.02)


def test_most_of_what_is_paid_for_is_the_last_step():
    assert [step.level for step in solve_to(paper("e50-g0"), 1e-3).steps] == [2, 4]


def test_estimates_hold_for_a_bar_that_is_known_exactly():
    """Saint-Venant's bar in tension with free sides: h1 has it exactly, and the estimate must not invent an error."""
    rod = rm.Rod("bar", rm.Line((0, 0, 0), (100, 0, 0), (0, 1, 0)), rm.Rectangle(10, 10), STEEL, (0, 50, 100))
    holds = rm.Support("bar", 0.0, ("x", "y", "s", "turn x", "turn y", "turn s"), of="mean")
    found = solve_to(rm.Scene("bar", (rod,), (holds,), (rm.SectionForce("bar", 100, (2000, 0, 0)),), ()), 1e-3)

    deflection = next(each for each in found.estimates if each.goal.kind == "deflection")
    # F L / (E A)
    assert deflection.value == pytest.approx(2000.0 * 100.0 / (200e3 * 100.0), rel=1e-6)
    assert deflection.relative < 1e-6


def test_a_short_thin_tube_pinched_on_a_small_spot_is_recognised():
    tube = rm.Rod("tube", rm.Line((0, 0, 0), (60, 0, 0), (0, 1, 0)), rm.Box(40, 40, 1), STEEL, (0, 30, 60))
    die = rm.Rod("die", rm.Line((26, 24, 0), (34, 24, 0), (0, 1, 0)), rm.Rectangle(8, 8), STEEL, (0, 8))
    clamps = (rm.Clamp("tube", "start"), rm.Clamp("tube", "end"), rm.Clamp("die", "start"))
    pinch = rm.ContactPair("pinch", rm.RodFace("tube", "top"), rm.RodFace("die", "bottom"), (26, 34), 0.0)
    scene = rm.Scene("tube", (tube, die), clamps, (rm.SectionForce("die", 8, (0, -500, 0)),), (pinch,))

    found = solve_to(scene, 0.05)

    assert found.outcome.startswith("refused")
    assert "3D" in found.outcome


def test_rods_that_touch_at_a_point_are_not_said_to_be_known_better_than_they_are():
    # 3D differs from the highest levels by 0.14 % in the upper rod's deflection
    found = solve_to(load_case("crossed-cantilevers").scene, 2e-4)

    assert found.outcome.startswith("refused")


@pytest.mark.parametrize("tolerance", [0.0, -1.0, 1.0, float("nan")])
def test_tolerances_out_of_reach_are_refused(tolerance):
    with pytest.raises(ValueError, match="tolerance"):
        solve_to(paper("e50-g0"), tolerance)


def test_the_next_level_is_as_high_as_the_error_asks_for():
    # all near corners: an error e at h4 is (4 / k)^2 e at hk, of which 0.8 of the tolerance is asked
    corners = Share(4, np.array([0.0, 0.0, 0.0, 0.0, 3e-3]), near=True, usual=2.0, least=2.0, most=2.0)
    seen = Look({}, {}, {}, (corners,), ())

    assert levels_for(seen, 1.7e-3, 1e-3)[0][0] == 6  # 0.76e-3
    assert levels_for(seen, 3.0e-3, 1e-3)[0][0] == 8  # 0.75e-3
    (near, _), at_best = levels_for(seen, 1.0, 1e-3)
    assert near == 10
    assert at_best == pytest.approx(0.16)
