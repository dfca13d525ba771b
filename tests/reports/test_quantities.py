"""Every compared quantity on Euler-Bernoulli cantilevers with a prescribed contact force, in closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import Clamp, End, Line, Material, Rectangle, Rod, Scene, SectionForce
from reports.applied_forces import applied_forces, reactions
from reports.equilibrium import equilibrium_residual, equilibrium_resultants
from reports.quantities import DEFINITIONS, default_stations, evaluate, stress_residual, stress_s
from reports.solution import Array, Solution
from rodmodel import solve

ROUND_OFF = 1e-9


def residual(solution: Solution) -> float:
    held = reactions(solution)
    applied = {rod.name: applied_forces(solution, rod, default_stations(rod), held) for rod in solution.scene.rods}
    return equilibrium_residual(solution.scene, applied, held)


def test_contact_force_and_centre_are_the_resultant_and_its_place(
    beam_solution: Callable[..., Solution],
) -> None:
    contact = evaluate(beam_solution(centre=250.0, force=320.0)).contact("overlap")

    assert contact.resultant == pytest.approx([0.0, 320.0, 0.0], abs=ROUND_OFF)
    assert contact.force == pytest.approx(320.0, rel=ROUND_OFF)
    assert contact.centre == pytest.approx(250.0, rel=ROUND_OFF)  # Hertz's profile is symmetric


def test_contact_edges_are_global_coordinates(beam_solution: Callable[..., Solution]) -> None:
    contact = evaluate(beam_solution(centre=250.0, half_width=12.0)).contact("overlap")

    # stations every 0.25 mm: (spacing)^2 / half width
    assert np.ravel(contact.edges) == pytest.approx([238.0, 262.0], abs=0.25**2 / 12.0)
    assert contact.edges_outer == contact.edges


def test_penetration_is_the_largest_overlap(beam_solution: Callable[..., Solution]) -> None:
    contact = evaluate(beam_solution(half_width=12.0, force=320.0)).contact("overlap")

    largest_pressure = 2.0 * 320.0 / (np.pi * 12.0 * 15.0)
    assert contact.penetration == pytest.approx(largest_pressure / 1e6, rel=1e-6)


def test_without_contact_there_is_no_centre_and_no_edge(
    beam_scene: Scene, beam_solution: Callable[..., Solution]
) -> None:
    solution = beam_solution()
    zero = np.zeros_like(solution.contact_points("overlap").force)
    apart = replace(solution.contact_points("overlap"), force=zero, middle=zero, outer=zero, mean=zero, gap=zero + 0.5)

    contact = evaluate(replace(solution, contact=apart)).contact("overlap")

    assert (contact.force, contact.centre, contact.edges, contact.penetration) == (0.0, None, (), 0.0)


@pytest.mark.parametrize("rod", ["lower", "upper"])
def test_resultants_from_equilibrium_are_those_of_the_closed_form(
    rod: str, beam_solution: Callable[..., Solution]
) -> None:
    quantities = evaluate(beam_solution()).rod(rod)

    # shear jumps at the load and at contact points; there the two conventions for the value may differ
    smooth = np.abs(quantities.station - 166.67) > 1.0
    smooth &= (quantities.station > 100.0) if rod == "upper" else (quantities.station < 200.0)
    assert quantities.equilibrium[2][smooth] == pytest.approx(quantities.stress[2][smooth], rel=ROUND_OFF)
    assert quantities.moment == pytest.approx(quantities.stress[3], abs=ROUND_OFF * 1e5)
    assert stress_residual(quantities) < ROUND_OFF


def test_clamp_moments_and_bending_stress(beam_solution: Callable[..., Solution]) -> None:
    quantities = evaluate(beam_solution(centre=250.0, force=320.0))

    # lower: contact pushes down 250 mm from the clamp; its top is in tension there, so M1 > 0
    lower = quantities.rod("lower")
    assert lower.end_moment_equilibrium == pytest.approx(320.0 * 250.0)
    # upper: load 133.33 mm and contact 250 mm from the clamp at X = 500
    upper = quantities.rod("upper")
    moment = 1000.0 * 133.33 - 320.0 * 250.0
    assert upper.end_moment_equilibrium == pytest.approx(moment)
    assert upper.end_moment_stress == pytest.approx(moment)
    assert upper.max_bending_stress == pytest.approx(moment / 562.5)


def test_deflection_is_sampled_at_both_ends_and_the_element_borders(
    beam_scene: Scene, beam_solution: Callable[..., Solution]
) -> None:
    upper = evaluate(beam_solution()).rod("upper")

    assert (upper.station[0], upper.station[-1]) == (0.0, 300.0)
    assert all(np.isclose(upper.station, border).any() for border in beam_scene.rod("upper").element_borders)
    assert np.all(np.diff(upper.station) > 0.0)
    assert upper.position[:, 0] == pytest.approx([200.0, 15.0, 0.0])
    assert upper.displacement.shape == (3, len(upper.station))
    assert upper.displacement[:, -1] == pytest.approx([0.0, 0.0, 0.0])


def test_further_stations_are_added_once(beam_solution: Callable[..., Solution]) -> None:
    solution = beam_solution()
    rod = solution.scene.rod("lower")

    station = evaluate(solution, {"lower": np.array([0.0, 12.34, 150.0])}).rod("lower").station

    assert len(station) == len(default_stations(rod)) + 1


def test_surface_stress_is_that_of_bending(beam_solution: Callable[..., Solution]) -> None:
    top_near_the_clamp = np.array([[0.0], [7.5], [10.0]])

    stress = stress_s(beam_solution(centre=250.0, force=320.0), "lower", top_near_the_clamp)

    assert stress == pytest.approx([320.0 * 240.0 / 562.5])


def test_equilibrium_residual_vanishes_for_a_solution_in_equilibrium(
    beam_solution: Callable[..., Solution],
) -> None:
    assert residual(beam_solution()) < ROUND_OFF


def test_equilibrium_residual_shows_a_wrong_reaction(beam_solution: Callable[..., Solution]) -> None:
    class OneNewtonShort(type(beam_solution())):  # type: ignore[misc]
        def reaction(self, rod: str, station: float) -> Array:
            return super().reaction(rod, station) - np.array([0.0, 1.0, 0.0, 0.0, 0.0, 0.0])

    right = beam_solution()
    wrong = OneNewtonShort(right.scene, right.contact)

    assert residual(wrong) == pytest.approx(1.0 / 1000.0)


class HeldBothEnds:
    """A clamped-clamped beam of length 200 mm under 80 N down in its middle: reactions P/2 and P L / 8."""

    outcome = "converged"

    def __init__(self) -> None:
        rod = Rod(
            "beam",
            Line((0.0, 0.0, 0.0), (200.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
            Rectangle(10.0, 10.0),
            Material(200_000.0, 0.3),
            (0.0, 200.0),
        )
        clamps = (Clamp("beam", "start"), Clamp("beam", "end"))
        self.scene = Scene("held", (rod,), clamps, (SectionForce("beam", 100.0, (0.0, -80.0, 0.0)),), ())

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        axes = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
        return np.outer(axes[2], station), np.tile(axes, (len(station), 1, 1))

    def reaction(self, rod: str, station: float) -> Array:
        return np.array([0.0, 40.0, 0.0, 0.0, 0.0, 2000.0 if station == 0.0 else -2000.0])


def test_a_rod_held_at_both_ends_takes_the_reaction_into_its_equilibrium() -> None:
    solution = HeldBothEnds()

    beam = solution.scene.rods[0]
    station = np.array([0.0, 50.0, 100.0, 200.0])
    applied = applied_forces(solution, beam, station, reactions(solution))
    moment = equilibrium_resultants(solution, beam, applied, station)[3]

    # M1 > 0 where the top is in tension: + P L / 8 at both clamps, - P L / 8 under the load, 0 half way
    assert moment == pytest.approx([2000.0, 0.0, -2000.0, 2000.0], abs=ROUND_OFF * 2000.0)
    assert residual(solution) < ROUND_OFF


def test_all_six_resultants_of_a_tip_force_in_local_components() -> None:
    # a rod along Z whose e2 is X, so e1 = e2 x t = X x Z = -Y
    rod = Rod(
        "post",
        Line((1.0, 2.0, 3.0), (1.0, 2.0, 103.0), (1.0, 0.0, 0.0)),
        Rectangle(5.0, 10.0),
        Material(70_000.0, 0.3),
        (0.0, 100.0),
    )
    tip = SectionForce("post", 100.0, (3.0, 5.0, 7.0))

    class Held:
        scene = Scene("post", (rod,), (Clamp("post", "start"),), (tip,), ())

        def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
            axes = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
            return np.array([[1.0], [2.0], [3.0]]) + np.outer(axes[2], station), np.tile(axes, (len(station), 1, 1))

        def reaction(self, rod: str, station: float) -> Array:
            return np.array([-3.0, -5.0, -7.0, 500.0, -300.0, 0.0])

    station = np.array([0.0, 40.0, 100.0])
    applied = applied_forces(Held(), rod, station, reactions(Held()))
    resultants = equilibrium_resultants(Held(), rod, applied, station)

    axial, shear_1, shear_2, moment_1, moment_2, torque = resultants
    assert axial == pytest.approx([7.0, 7.0, 7.0])
    assert shear_1 == pytest.approx([-5.0, -5.0, -5.0])
    assert shear_2 == pytest.approx([3.0, 3.0, 3.0])
    arm = np.array([100.0, 60.0, 0.0])
    assert moment_1 == pytest.approx(-3.0 * arm)  # (arm t) x (Q2 e2) = -arm Q2 e1
    assert moment_2 == pytest.approx(-5.0 * arm)  # (arm t) x (Q1 e1) = +arm Q1 e2
    assert torque == pytest.approx([0.0, 0.0, 0.0])


def test_every_quantity_has_a_unit_and_a_definition_in_words() -> None:
    dimensionless = {"equilibrium_residual", "stress_residual", "complementarity_residual"}

    for name, definition in DEFINITIONS.items():
        assert definition.text.endswith("."), name
        assert (definition.unit == "") == (name in dimensionless), name


@pytest.mark.parametrize("ends", [("start", "end"), ("end", "start")])
def test_of_two_clamp_moments_that_differ_in_sign_alone_it_is_the_starts(ends: tuple[End, End]) -> None:
    line = Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    rod = Rod("beam", line, Rectangle(10.0, 10.0), Material(200_000.0, 0.3), (0.0, 50.0, 100.0))
    clamps = tuple(Clamp("beam", end, (0.0, 0.5, 0.0) if end == "end" else (0.0, 0.0, 0.0)) for end in ends)

    beam = evaluate(solve(Scene("settled", (rod,), clamps, (), ()), 2, 3)).rod("beam")

    assert beam.moment[0] == pytest.approx(-beam.moment[-1], rel=1e-6)
    assert beam.end_moment_equilibrium == beam.moment[0]
