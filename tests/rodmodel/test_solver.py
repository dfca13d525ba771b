"""The paper's four cases by the rod model, against the paper and against independent 3D results (cases/truth)."""

import json
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm
from cases.loader import load_case
from rodmodel.adapt import graded

PAPER = {name: load_case(f"two-cantilevers-{name}") for name in ("e50-g0", "e50-g05", "e20-g0", "e20-g05")}


@pytest.fixture(scope="module", params=list(PAPER))
def paper(request: pytest.FixtureRequest):
    """Case and its solution at h5, p = 6 on the paper's elements."""
    case = PAPER[request.param]
    return case, rm.solve(case.scene, level=5, order=6)


@pytest.fixture(scope="module", params=list(PAPER))
def best(request: pytest.FixtureRequest):
    """Truth and a solution with short elements where the fields are steep."""
    case = PAPER[request.param]
    return json.loads(case.independent.read_text()), rm.solve(graded(case.scene), level=6, order=8)


def contact_force(solution: rm.Solution) -> float:
    return float(solution.contact_points("overlap").force.sum())


def test_published_bending_stress_within_a_thousandth(paper) -> None:
    case, solution = paper
    published = next(value for value in case.published if value.quantity == "max_bending_stress")
    moment = solution.section_resultants("upper", np.array([300.0]))[3, 0]
    assert abs(moment) / (15.0**3 / 6.0) == pytest.approx(published.value[0], rel=1e-3)


def test_published_edges_within_a_millimetre_by_at_most_twelve_solutions(paper) -> None:
    case, solution = paper
    published = next(value for value in case.published if value.quantity == "contact_edges")
    assert solution.outcome == "converged"
    (stretch,) = solution.stretches
    assert (stretch.start, stretch.end) == pytest.approx(published.value, abs=1.0)
    assert solution.contact_solutions <= 12


def test_borders_sit_on_the_edges_that_are_reported(paper) -> None:
    _, solution = paper
    (stretch,) = solution.stretches
    lower, upper = solution.system.rods["lower"].borders, solution.system.rods["upper"].borders
    for edge in (stretch.start, stretch.end):
        assert np.abs(lower - edge).min() < 1e-9
        assert np.abs(upper + 200.0 - edge).min() < 1e-9


def test_supports_carry_the_load_and_the_contact_force(paper) -> None:
    _, solution = paper
    force = contact_force(solution)
    # equilibrium in the sense of virtual work: round-off of a stiffness with condition 1e7
    assert solution.reaction("lower", 0.0)[1] == pytest.approx(force, rel=1e-8)
    assert solution.reaction("upper", 300.0)[1] == pytest.approx(1000.0 - force, rel=1e-8)


def test_contact_only_pushes_and_penetrates_little(paper) -> None:
    _, solution = paper
    points = solution.contact_points("overlap")
    assert (points.force >= 0.0).all()
    # 10 MPa over 1e6 N/mm^3; the corner of the upper bar presses hardest
    assert points.gap.min() > -2e-5


def test_energy_balance(paper) -> None:
    """Twice the elastic energy and the work of contact against the gap are the work of the load."""
    case, solution = paper
    points = solution.contact_points("overlap")
    load_station = np.array([case.scene.loads[0].position])
    work = -1000.0 * solution.displacement("upper", load_station)[1, 0]
    separation = points.gap - case.scene.contacts[0].gap
    # the load works on the mean over the section, which differs from the centre by its bulge under the load
    assert 2.0 * solution.strain_energy == pytest.approx(work + points.force @ separation, rel=1e-4)


def test_best_contact_force_is_within_half_a_permille_of_3d(best) -> None:
    truth, solution = best
    assert contact_force(solution) == pytest.approx(truth["contact_force_N"], rel=5e-4)


def test_best_deflections_are_within_a_permille_of_their_maximum(best) -> None:
    truth, solution = best
    for rod, key, start in (("lower", "deflection_bar1_mm", 0.0), ("upper", "deflection_bar2_mm", 200.0)):
        position, expected = np.array(truth[key])
        found = solution.displacement(rod, position - start)[1]
        np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-3 * np.abs(expected).max())


def test_best_edges_and_centre_are_within_a_millimetre(best) -> None:
    truth, solution = best
    (stretch,) = solution.stretches
    assert (stretch.start, stretch.end) == pytest.approx(tuple(truth["edges_middle_mm"][0]), abs=1.0)
    points = solution.contact_points("overlap")
    centre = points.force @ points.position[0] / points.force.sum()
    assert centre == pytest.approx(truth["contact_centre_mm"], abs=0.1)


def test_higher_levels_come_closer_to_3d() -> None:
    case = PAPER["e20-g0"]
    truth = json.loads(case.independent.read_text())["contact_force_N"]
    scene = graded(case.scene)
    errors = [abs(contact_force(rm.solve(scene, level, 6)) / truth - 1.0) for level in (2, 3, 4, 5)]
    assert errors == sorted(errors, reverse=True)


def test_without_multipliers_a_softer_penalty_moves_the_force_less_than_the_edge() -> None:
    case = PAPER["e50-g0"]
    found = []
    for penalty in (1e4, 1e6):
        pair = replace(case.scene.contacts[0], penalty=penalty)
        solution = rm.solve(replace(case.scene, contacts=(pair,)), multipliers=False)
        found.append((contact_force(solution), solution.stretches[0].end))
    assert found[0][0] == pytest.approx(found[1][0], rel=2e-3)
    assert found[0][1] - found[1][1] > 0.5


def test_a_penalty_that_changes_the_answer_is_refused() -> None:
    """At 20 N/mm^3 the springs of contact give way by a tenth of a millimetre, and the force is off by percents."""
    case = PAPER["e50-g0"]
    pair = replace(case.scene.contacts[0], penalty=20.0)
    solution = rm.solve(replace(case.scene, contacts=(pair,)), multipliers=False)
    assert solution.outcome.startswith("refused: the penalty is too soft")


def test_with_multipliers_the_force_does_not_depend_on_the_penalty() -> None:
    """Issue 4 asks for less than 0.01 % over six decades."""
    case = PAPER["e50-g0"]
    forces = []
    for penalty in (1e2, 1e4, 1e6, 1e8):
        pair = replace(case.scene.contacts[0], penalty=penalty)
        solution = rm.solve(replace(case.scene, contacts=(pair,)))
        assert solution.outcome == "converged"
        forces.append(contact_force(solution))
    np.testing.assert_allclose(forces, forces[2], rtol=1e-4)


def test_bars_that_do_not_meet_touch_nowhere() -> None:
    case = PAPER["e50-g0"]
    pair = replace(case.scene.contacts[0], gap=50.0)
    solution = rm.solve(replace(case.scene, contacts=(pair,)))
    assert solution.outcome == "converged"
    assert solution.stretches == ()
    assert contact_force(solution) == 0.0


def test_slender_bars_meet_as_beam_theory_says() -> None:
    """Upper bar's end on the lower one: a point contact; its force from Euler-Bernoulli deflections at the point.

    F (a^3 / 3 E1 I + L^3 / 3 E2 I) = P c^2 (3 L - c) / 6 E2 I - g with a = 200, L = 300, c = 133.33, g = 1. Sides of
    3 mm: shear and the length of the zone count by (h / L)^2 and (zone / L), below half a percent.
    """
    square = rm.Rectangle(3.0, 3.0)
    case = PAPER["e50-g05"]
    lower, upper = (replace(rod, section=square) for rod in case.scene.rods)
    upper = replace(upper, centre_line=rm.Line((200.0, 3.0, 0.0), (500.0, 3.0, 0.0), (0.0, 1.0, 0.0)))
    pair = replace(case.scene.contacts[0], gap=1.0)
    load = rm.SectionForce("upper", 166.67, (0.0, -2.0, 0.0))
    solution = rm.solve(replace(case.scene, rods=(lower, upper), loads=(load,), contacts=(pair,)))
    second = 3.0**4 / 12.0
    arm = 300.0 - 166.67
    down = 2.0 * arm**2 * (3.0 * 300.0 - arm) / (6.0 * 50e3 * second) - 1.0
    expected = down / (200.0**3 / (3.0 * 200e3 * second) + 300.0**3 / (3.0 * 50e3 * second))
    assert contact_force(solution) == pytest.approx(expected, rel=5e-3)


def test_high_levels_are_needed_near_clamps_and_contact_alone() -> None:
    """h6 at clamps and in the overlap, h3 between, whose cubic warping shear needs: the force of h6 to 0.01 %."""
    scene = graded(PAPER["e50-g0"].scene)
    everywhere = rm.solve(scene, level=6, order=5)
    lower, upper = ([6] * 3 + [3, 3] + [6] * 6, [6] * 6 + [3, 3] + [6] * 3)
    somewhere = rm.solve(scene, level={"lower": lower, "upper": upper}, order=5)
    assert somewhere.outcome == "converged"
    assert contact_force(somewhere) == pytest.approx(contact_force(everywhere), rel=1e-4)
    assert somewhere.cost.unknowns < 0.9 * everywhere.cost.unknowns


def test_levels_for_some_rods_only_are_refused() -> None:
    with pytest.raises(ValueError, match="found none for rod 'upper'"):
        rm.solve(PAPER["e50-g0"].scene, level={"lower": [3] * 6})


@pytest.mark.slow
def test_a_rod_that_round_off_has_spoilt_says_so() -> None:
    """10,000 elements of 10 mm on a rod of 15 mm: the tip is off by percents, from condition and not from locking."""
    length = 1e5
    rod = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0)),
        rm.Rectangle(15.0, 15.0),
        rm.Material(200e3, 0.3),
        tuple(np.linspace(0.0, length, 10001).tolist()),
    )
    load = rm.SectionForce("bar", length, (0.0, -1e-3, 0.0))
    solution = rm.solve(rm.Scene("long", (rod,), (rm.Clamp("bar", "start"),), (load,), ()), level=2, order=4)
    assert solution.outcome.startswith("refused: round-off has taken about")
