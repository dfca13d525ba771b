"""Rods that contact alone holds: statics, what no contact can balance, and what nothing holds."""

import numpy as np
import pytest

from cases.scene import (
    Clamp,
    ContactPair,
    Ground,
    Joint,
    Line,
    LineLoad,
    Material,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    SectionForce,
    Support,
)
from reference3d import solve

SIDE = 10.0
UP = (0.0, 1.0, 0.0)
STEEL = Material(200e3, 0.3)


def bar(name, start, end, up=UP):
    line = Line(start, end, up)
    return Rod(name, line, Rectangle(SIDE, SIDE), STEEL, (0.0, line.length))


def on_two_pads(force, position=40.0):
    """A bar of 80 mm that lies on two pads of rigid ground and is otherwise free."""
    pads = (
        ContactPair("left", RodFace("bar", "bottom"), Ground(), (0.0, 10.0), 0.0),
        ContactPair("right", RodFace("bar", "bottom"), Ground(), (60.0, 70.0), 0.0),
    )
    rods = (bar("bar", (0.0, 0.0, 0.0), (80.0, 0.0, 0.0)),)
    return Scene("pads", rods, (), (SectionForce("bar", position, force),), pads)


@pytest.mark.parametrize("position", [40.0, 55.0])
def test_ground_alone_carries_a_bar_as_a_lever_is_carried(position):
    solution = solve(on_two_pads((0.0, -100.0, 0.0), position), 1)

    assert solution.outcome == "converged"
    points = [solution.contact_points(name) for name in ("left", "right")]
    force = np.concatenate([each.force for each in points])
    place = np.concatenate([each.position[0] for each in points])
    assert (force >= 0.0).all()
    assert force.sum() == pytest.approx(100.0, rel=1e-8)
    assert place @ force == pytest.approx(100.0 * position, rel=1e-8)
    # between the pads they are touched at their inner ends alone: reactions of a beam on two knives
    assert points[1].force.sum() == pytest.approx(100.0 * (position - 10.0) / 50.0, rel=1e-2)


@pytest.mark.parametrize(
    ("force", "position"),
    [((0.0, 100.0, 0.0), 40.0), ((0.0, -100.0, 0.0), 75.0), ((1.0, -100.0, 0.0), 40.0), ((0.0, -100.0, 1.0), 40.0)],
    ids=["lifted", "tipped over", "pushed along", "pushed aside"],
)
def test_what_contact_cannot_balance_is_refused_by_name(force, position):
    solution = solve(on_two_pads(force, position), 1)

    assert solution.outcome == "refused: contact cannot balance the loads on 'bar', which nothing else holds"


def test_joined_rods_may_lean_on_ground():
    """A post on a hinge and a beam joined to its top, whose end lies on ground: half the load each."""
    corner = (0.0, 60.0, 0.0)
    rods = bar("beam", corner, (120.0, 60.0, 0.0)), bar("post", (0.0, 0.0, 0.0), corner, (0.0, 0.0, 1.0))
    ground = ContactPair("ground", RodFace("beam", "bottom"), Ground(), (110.0, 120.0), 0.01)
    hinge = Support("post", 0.0, ("x", "y", "s"), "mean")
    joint = Joint((RodEnd("post", "end"), RodEnd("beam", "start")))
    load = LineLoad("beam", 0.0, 120.0, (0.0, -2.0, 0.0))

    solution = solve(Scene("leaning", rods, (hinge,), (load,), (ground,), (joint,)), 1)

    points = solution.contact_points("ground")
    assert solution.outcome == "converged"
    assert points.position[0] @ points.force == pytest.approx(240.0 * 60.0, rel=1e-7)
    np.testing.assert_allclose(solution.reaction("post", 0.0)[1], 240.0 - points.force.sum(), rtol=1e-7)
    np.testing.assert_allclose(solution.reaction("post", 0.0)[3:], 0.0, atol=1e-4)


@pytest.mark.slow
def test_a_bar_between_two_others_passes_on_the_force_and_the_moment_that_press_it():
    rods = tuple(
        bar(name, (start, height, 0.0), (end, height, 0.0))
        for name, start, end, height in (("low", 0, 40, 0.0), ("between", 20, 30, SIDE), ("high", 0, 40, 2 * SIDE))
    )
    pairs = (
        ContactPair("below", RodFace("between", "bottom"), RodFace("low", "top"), (0.0, 10.0), 0.0),
        ContactPair("above", RodFace("between", "top"), RodFace("high", "bottom"), (0.0, 10.0), 0.0),
    )
    clamps = (Clamp("low", "start"), Clamp("high", "start"))

    solution = solve(Scene("between", rods, clamps, (SectionForce("high", 40.0, (0.0, -500.0, 0.0)),), pairs), 1)

    below, above = (solution.contact_points(name) for name in ("below", "above"))
    assert solution.outcome == "converged"
    assert below.force.sum() == pytest.approx(above.force.sum(), rel=1e-8)
    assert below.position[0] @ below.force == pytest.approx(above.position[0] @ above.force, rel=1e-8)
    # by statics the upper bar passes on what its clamp does not carry
    assert above.force.sum() == pytest.approx(500.0 - solution.reaction("high", 0.0)[1], rel=1e-8)
    assert above.force.sum() > 100.0
