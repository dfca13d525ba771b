"""Winkler beds: rigid sinking, Hetenyi's infinite beam, and the balance of forces and energy."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm

YOUNG, SIDE = 200e3, 10.0


def bar_on_bed(length: float, modulus: float, loads: tuple, elements: int = 4, poisson: float = 0.3) -> rm.Scene:
    """A square bar along X lying on a bed, kept from sliding and from turning about its axis at its middle."""
    rod = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0)),
        rm.Rectangle(SIDE, SIDE),
        rm.Material(YOUNG, poisson),
        tuple(np.linspace(0.0, length, elements + 1)),
    )
    keep = rm.Support("bar", 0.5 * length, ("x", "s", "turn y"), "mean")
    bed = rm.Bed(rm.RodFace("bar", "bottom"), 0.0, length, modulus)
    return rm.Scene("on a bed", (rod,), (keep,), loads, (), (), (bed,))


def test_an_evenly_loaded_bar_sinks_as_a_rigid_one_and_bulges_none() -> None:
    """With nu = 0 an even pressure on top compresses the bar across, evenly, and the bed by p / k."""
    top = rm.Pressure(rm.RodFace("bar", "top"), 0.0, 60.0, 2.0)

    solution = rm.solve(bar_on_bed(60.0, 50.0, (top,), poisson=0.0), level=2, order=2)

    points = np.array([[0.0, 4.0, -5.0], [-5.0, 0.0, 5.0], [3.0, 30.0, 55.0]])
    depth = 2.0 / 50.0 + 2.0 / YOUNG * (points[1] + 5.0)
    np.testing.assert_allclose(solution.displacement_at("bar", points)[1], -depth, rtol=1e-9)
    np.testing.assert_allclose(solution.stress("bar", points)[1], -2.0, rtol=1e-9)


def test_a_long_beam_under_a_force_sinks_as_hetenyi_says() -> None:
    """Infinite Bernoulli beam: y = F beta / (2 k b) e^(-beta x) (cos beta x + sin beta x), beta^4 = k b / (4 E I).

    The bar is 30 / beta long and slender (beta h = 0.05), so that shear and its own squeezing stay below 0.2 %.
    """
    inertia = SIDE**4 / 12.0
    modulus = 4.0 * YOUNG * inertia * (0.05 / SIDE) ** 4 / SIDE
    beta, length, force = 0.05 / SIDE, 30.0 * SIDE / 0.05, 100.0
    scene = bar_on_bed(length, modulus, (rm.SectionForce("bar", 0.5 * length, (0.0, -force, 0.0)),), elements=24)

    solution = rm.solve(scene, level=3, order=5)

    x = np.linspace(0.0, 3.0 / beta, 7)
    wave = np.exp(-beta * x)
    sinking = force * beta / (2.0 * modulus * SIDE) * wave * (np.cos(beta * x) + np.sin(beta * x))
    moment = force / (4.0 * beta) * wave * (np.cos(beta * x) - np.sin(beta * x))
    found = solution.displacement("bar", 0.5 * length + x)[1]
    np.testing.assert_allclose(found, -sinking, atol=2e-3 * sinking[0])
    # M1 = int sigma_s y; under the load the stress has a boundary layer, a height away it has none.
    resultant = solution.section_resultants("bar", 0.5 * length + x[1:])[3]
    np.testing.assert_allclose(resultant, -moment[1:], atol=2e-3 * moment[0])


@pytest.mark.parametrize("bent", [False, True])
def test_the_bed_carries_the_load_and_stores_what_the_bar_does_not(bent: bool) -> None:
    force = np.array([40.0, -300.0, 0.0])
    scene = bar_on_bed(80.0, 30.0, (rm.SectionForce("bar", 25.0, tuple(force)),))
    if bent:
        # The same bar as a quarter circle in the plane of the bed's springs, twisted by none.
        line = rm.Helix((0.0, 0.0, 0.0), (0.0, -50.0, 0.0), (0.0, 0.0, -1.0), 80.0 / 50.0, (0.0, 1.0, 0.0))
        scene = replace(scene, rods=(replace(scene.rods[0], centre_line=line),))

    solution = rm.solve(scene, level=4, order=6)

    forces = solution.bed_forces(0, np.array([10.0, 20.0, 60.0]))
    support = solution.reaction("bar", 40.0)
    np.testing.assert_allclose(forces.force.sum(axis=1) + support[:3], -force, atol=1e-6)
    load_at, support_at = (solution.frame("bar", np.array([s]))[0][:, 0] for s in (25.0, 40.0))
    moments = np.cross(forces.position, forces.force, axis=0).sum(axis=1) + np.cross(load_at, force)
    np.testing.assert_allclose(moments + np.cross(support_at, support[:3]) + support[3:], 0.0, atol=1e-4)
    # Clapeyron: half the work of the force on the mean displacement is what bar and bed store.
    stored = solution.strain_energy + forces.energy.sum()
    assert stored == pytest.approx(solution.stored_energy, rel=1e-9)
    assert solution.strain_energy < solution.stored_energy


def test_a_bed_under_part_of_a_bar_begins_and_ends_where_it_says() -> None:
    scene = bar_on_bed(60.0, 20.0, (rm.SectionForce("bar", 30.0, (0.0, -100.0, 0.0)),), elements=2)
    part = replace(scene, beds=(replace(scene.beds[0], start=13.0, end=41.0),))

    solution = rm.solve(part, level=3, order=5)

    forces = solution.bed_forces(0, np.empty(0))
    assert forces.station.min() > 13.0
    assert forces.station.max() < 41.0
    assert forces.force[1].sum() == pytest.approx(100.0, rel=1e-8)


def test_a_stiff_bed_under_a_twisted_bar_holds_its_face() -> None:
    """A bed a thousand times stiffer than the bar leaves hardly any normal displacement of the face."""
    line = rm.Line((0.0, 0.0, 0.0), (60.0, 0.0, 0.0), (0.0, 1.0, 0.0), twist=math.pi / 3.0)
    scene = bar_on_bed(60.0, 1000.0 * YOUNG / SIDE, (rm.SectionForce("bar", 60.0, (0.0, -100.0, 30.0)),))
    twisted = replace(scene, rods=(replace(scene.rods[0], centre_line=line),))

    solution = rm.solve(twisted, level=4, order=8)

    station = np.linspace(5.0, 55.0, 6)
    points = np.array([np.full(6, 2.0), np.full(6, -0.5 * SIDE), station])
    _, axes = solution.frame("bar", station)
    tau = math.pi / 3.0 / 60.0
    normal = -axes[:, 1] + tau * points[0][:, None] * axes[:, 2]
    moved = solution.displacement_at("bar", points)
    assert np.abs(np.einsum("ng,gn->n", normal, moved)).max() < 0.02 * np.abs(moved).max()


def test_a_bed_under_many_elements_is_no_loss_of_digits() -> None:
    """The look for round-off, which rods of many elements get, leaves out what lies on beds."""
    scene = bar_on_bed(400.0, 20.0, (rm.SectionForce("bar", 200.0, (0.0, -100.0, 0.0)),), elements=200)

    assert rm.solve(scene, level=2, order=3).outcome == "converged"
