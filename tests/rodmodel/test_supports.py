"""Supports that hold chosen components, and prescribed displacements: against closed forms and statics."""

from __future__ import annotations

import math

import numpy as np
import pytest

import rodmodel as rm

LENGTH, SIDE, YOUNG = 120.0, 10.0, 200e3
AREA, SECOND_MOMENT = SIDE**2, SIDE**4 / 12.0


def bar(poisson: float = 0.3, elements: int = 2) -> rm.Rod:
    """A square bar along Z whose local axes are the global X, Y, Z."""
    return rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (0.0, 0.0, LENGTH), (0.0, 1.0, 0.0)),
        rm.Rectangle(SIDE, SIDE),
        rm.Material(YOUNG, poisson),
        tuple(np.linspace(0.0, LENGTH, elements + 1)),
    )


def scene(supports: tuple[rm.Clamp | rm.Support, ...], loads: tuple[rm.SectionForce | rm.SectionMoment, ...] = ()):
    return rm.Scene("supported", (bar(),), supports, loads, ())


PINNED = rm.Support("bar", 0.0, ("x", "y", "s", "turn s"), "mean")
ROLLER = rm.Support("bar", LENGTH, ("x", "y"), "mean")


def test_a_beam_on_two_mean_supports_bends_to_the_exact_parabola() -> None:
    """Pure bending is of second degree in (x, y, s): h2 has it, anticlastic shape and all, between end moments."""
    moment = 1e5
    ends = tuple(rm.SectionMoment("bar", s, (m, 0.0, 0.0)) for s, m in ((0.0, -moment), (LENGTH, moment)))

    solution = rm.solve(scene((PINNED, ROLLER), ends), level=2, order=3)

    station = np.linspace(0.0, LENGTH, 7)
    # M1 = int sigma_s y = -E I v''
    expected = moment / (2.0 * YOUNG * SECOND_MOMENT) * station * (LENGTH - station)
    found = solution.displacement("bar", station)[1]
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())


def test_reactions_of_a_beam_are_those_of_statics() -> None:
    loads = (rm.SectionForce("bar", 40.0, (300.0, -900.0, 50.0)), rm.SectionMoment("bar", 80.0, (0.0, 0.0, 700.0)))

    solution = rm.solve(scene((PINNED, ROLLER), loads), level=3, order=4)

    # Moments about the supports, by hand: the roller takes a third of the force, the pin all torque.
    roller = [-100.0, 300.0, 0.0, 0.0, 0.0, 0.0]
    pin = [-200.0, 600.0, -50.0, 0.0, 0.0, -700.0]
    np.testing.assert_allclose(solution.reaction("bar", LENGTH), roller, atol=1e-6)
    np.testing.assert_allclose(solution.reaction("bar", 0.0), pin, atol=1e-6)


def test_a_support_between_the_ends_takes_its_share() -> None:
    """Two equal spans under equal forces, as beam theory shares them but for the sections' deformation."""
    supports = (PINNED, rm.Support("bar", 0.5 * LENGTH, ("x", "y"), "mean"), ROLLER)
    loads = tuple(rm.SectionForce("bar", s, (0.0, -100.0, 0.0)) for s in (0.25 * LENGTH, 0.75 * LENGTH))

    solution = rm.solve(scene(supports, loads), level=3, order=6)

    reactions = [solution.reaction("bar", support_at)[1] for support_at in (0.0, 0.5 * LENGTH, LENGTH)]
    assert sum(reactions) == pytest.approx(200.0, rel=1e-9)
    # Timoshenko: each span is a propped cantilever; with phi = 12 E I / (kappa G A l^2) it takes F (5 + 2 phi) / 16
    # at the pin. The section deforms at the supports, which is not in this theory.
    span, shear = 0.5 * LENGTH, 5.0 / 6.0 * YOUNG / 2.6 * AREA
    phi = 12.0 * YOUNG * SECOND_MOMENT / (shear * span**2)
    pin = 100.0 * (5.0 / 16.0 + phi / 8.0) / (1.0 + phi / 4.0)
    assert reactions[0] == pytest.approx(pin, rel=0.02)


def test_half_a_bar_held_in_its_plane_of_symmetry_is_half_of_the_whole() -> None:
    whole = scene((PINNED, ROLLER), (rm.SectionForce("bar", 0.5 * LENGTH, (0.0, -1000.0, 0.0)),))
    half_bar = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (0.0, 0.0, 0.5 * LENGTH), (0.0, 1.0, 0.0)),
        rm.Rectangle(SIDE, SIDE),
        rm.Material(YOUNG, 0.3),
        (0.0, 0.5 * LENGTH),
    )
    mirror = rm.Support("bar", 0.5 * LENGTH, ("s",), "section")
    pin = rm.Support("bar", 0.0, ("x", "y", "turn s"), "mean")
    half = rm.Scene("half", (half_bar,), (pin, mirror), (rm.SectionForce("bar", 0.5 * LENGTH, (0.0, -500.0, 0.0)),), ())

    found, expected = (rm.solve(each, level=4, order=5) for each in (half, whole))

    station = np.linspace(0.0, 0.5 * LENGTH, 5)
    np.testing.assert_allclose(
        found.displacement("bar", station)[1], expected.displacement("bar", station)[1], rtol=1e-9, atol=1e-12
    )


def test_a_stretched_bar_carries_what_hookes_law_asks_for() -> None:
    pulled = rm.Clamp("bar", "end", displacement=(0.0, 0.0, 0.06))
    free_sideways = rm.Support("bar", 0.0, ("s",), "section")
    against_the_rest = rm.Support("bar", LENGTH, ("x", "y", "s", "turn s"), "mean", (0.0, 0.0, 0.06, 0.0))

    clamped = rm.solve(rm.Scene("pulled", (bar(0.0),), (rm.Clamp("bar", "start"), pulled), (), ()), level=2, order=2)
    free = rm.solve(scene((free_sideways, against_the_rest)), level=2, order=2)

    expected = YOUNG * AREA * 0.06 / LENGTH
    for solution in (clamped, free):
        assert solution.reaction("bar", LENGTH)[2] == pytest.approx(expected, rel=1e-9)
        assert solution.reaction("bar", 0.0)[2] == pytest.approx(-expected, rel=1e-9)
        assert solution.strain_energy == pytest.approx(0.5 * expected * 0.06, rel=1e-9)


def test_clamps_that_move_as_one_rigid_body_take_the_bar_along_without_stress() -> None:
    displacement, rotation = np.array([0.1, -0.2, 0.3]), np.array([1e-3, 2e-3, -3e-3])
    far = displacement + np.cross(rotation, [0.0, 0.0, LENGTH])
    clamps = (
        rm.Clamp("bar", "start", tuple(displacement), tuple(rotation)),
        rm.Clamp("bar", "end", tuple(far), tuple(rotation)),
    )

    solution = rm.solve(scene(clamps), level=2, order=2)

    points = np.array([[5.0, -3.0], [2.0, 5.0], [30.0, 90.0]])
    expected = displacement[:, None] + np.cross(rotation, points, axisb=0, axisc=0)
    np.testing.assert_allclose(solution.displacement_at("bar", points), expected, atol=1e-12)
    assert np.abs(solution.stress("bar", points)).max() < 1e-9 * YOUNG * 1e-3


def test_a_prescribed_end_asks_for_the_force_that_would_have_brought_it_there() -> None:
    forced = rm.solve(
        scene((rm.Clamp("bar", "start"),), (rm.SectionForce("bar", LENGTH, (0.0, -100.0, 0.0)),)), level=3, order=5
    )
    tip = -2.0 * forced.strain_energy / 100.0

    taken = rm.solve(
        scene((rm.Clamp("bar", "start"), rm.Support("bar", LENGTH, ("y",), "mean", (tip,)))), level=3, order=5
    )

    assert taken.reaction("bar", LENGTH)[1] == pytest.approx(-100.0, rel=1e-9)
    assert taken.strain_energy == pytest.approx(forced.strain_energy, rel=1e-9)


def test_a_turned_end_asks_for_the_moment_that_would_have_turned_it() -> None:
    moment = rm.SectionMoment("bar", LENGTH, (0.0, 0.0, 500.0))
    forced = rm.solve(scene((rm.Clamp("bar", "start"),), (moment,)), level=4, order=4)
    angle = 2.0 * forced.strain_energy / 500.0

    taken = rm.solve(
        scene((rm.Clamp("bar", "start"), rm.Support("bar", LENGTH, ("turn s",), "mean", (angle,)))), level=4, order=4
    )

    assert taken.reaction("bar", LENGTH)[5] == pytest.approx(500.0, rel=1e-9)


def test_levels_may_change_at_a_support() -> None:
    """Only what both elements carry is there to be held: reactions stay those of statics."""
    supports = (PINNED, rm.Support("bar", 60.0, ("y", "turn x"), "mean"), ROLLER)
    loads = (rm.SectionForce("bar", 30.0, (0.0, -100.0, 0.0)),)
    levels, orders = {"bar": [4, 3, 2, 2]}, {"bar": [3, 4, 5, 5]}

    solution = rm.solve(rm.Scene("levels", (bar(elements=4),), supports, loads, ()), level=levels, order=orders)

    forces = sum(solution.reaction("bar", at) for at in (0.0, 60.0, LENGTH))
    assert forces[1] == pytest.approx(100.0, rel=1e-9)
    moment = solution.reaction("bar", 60.0)[3] - 60.0 * solution.reaction("bar", 60.0)[1]
    moment += -LENGTH * solution.reaction("bar", LENGTH)[1] + 30.0 * 100.0
    assert math.isclose(moment, 0.0, abs_tol=1e-6)


@pytest.mark.parametrize(
    ("supports", "motion"),
    [
        ((), "moving along"),
        (
            (rm.Support("bar", 0.0, ("x", "y", "s"), "mean"),),
            "turning about the axis through (0, 0, 60) along (0, 0, 1)",
        ),
        ((rm.Support("bar", 0.0, ("x", "y"), "section"), ROLLER), "moving along (0, 0, "),
        (
            (rm.Support("bar", 0.0, ("x", "y", "s"), "mean"), ROLLER),
            "turning about the axis through (0, 0, 60) along (0, 0, 1)",
        ),
    ],
)
def test_a_loose_rod_is_refused_with_the_motion_that_nothing_resists(supports, motion) -> None:
    loads = (rm.SectionForce("bar", 50.0, (1.0, 2.0, 3.0)),)

    with pytest.raises(rm.SceneError, match="'bar'") as caught:
        rm.solve(scene(supports, loads))

    assert motion in caught.value.found
