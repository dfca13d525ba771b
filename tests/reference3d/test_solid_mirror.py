"""Half of the motions of a mirrored scene against all of them, and scenes that are not mirrored."""

from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Bed,
    Box,
    Circle,
    Clamp,
    ContactPair,
    Gravity,
    Helix,
    Line,
    Material,
    Rectangle,
    Ring,
    Rod,
    RodFace,
    Scene,
    SectionForce,
    SectionMoment,
    Support,
)
from reference3d import solid_solver
from reference3d.solid_solver import solve_solid

STEEL = Material(200e3, 0.3, 7.85e-9)
UP = (0.0, 1.0, 0.0)
ARC = Helix((30.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 1.5, (1.0, 0.0, 0.0))


def bar(name, start, end, section, up=UP):
    line = Line(start, end, up)
    return Rod(name, line, section, STEEL, (0.0, line.length))


def arc(section, force):
    """An arc in the plane Z = 0 that is clamped, moved aside in its plane, held in between and under its weight."""
    supports = (
        Clamp("arc", "start", (0.01, 0.02, 0.0), (0.0, 0.0, 0.001)),
        Support("arc", 0.5 * ARC.length, ("y", "turn x"), "mean", (0.01, 0.0)),
        Support("arc", ARC.length, ("s", "y"), "section"),
    )
    loads = (SectionForce("arc", 0.25 * ARC.length, force), Gravity("arc", (1e4, -2e4, 0.0)))
    return Scene("arc", (Rod("arc", ARC, section, STEEL, (0.0, ARC.length)),), supports, loads, ())


def bars(aside=0.0, load=(10.0, -300.0, 0.0)):
    """A bar on a bed and, pressed on its end, a second one of another width and the other way round."""
    rods = (
        bar("lower", (0.0, 0.0, 0.0), (40.0, 0.0, 0.0), Rectangle(8.0, 6.0)),
        bar("upper", (60.0, 6.0, aside), (30.0, 6.0, aside), Rectangle(6.0, 6.0)),
    )
    pair = ContactPair("touch", RodFace("lower", "top"), RodFace("upper", "bottom"), (30.0, 40.0), 0.001)
    bed = Bed(RodFace("lower", "bottom"), 20.0, 40.0, 50.0)
    clamps = (Clamp("lower", "start"), Clamp("upper", "start"))
    return Scene("bars", rods, clamps, (SectionForce("upper", 20.0, load),), (pair,), (), (bed,))


@pytest.mark.parametrize(
    "scene",
    [
        *(arc(section, (5.0, 20.0, 0.0)) for section in (Rectangle(4.0, 3.0), Circle(4.0), Ring(4.0, 2.0))),
        pytest.param(bars(), marks=pytest.mark.slow),
    ],
    ids=["rectangle", "circle", "ring", "contact"],
)
def test_half_of_the_motions_give_the_answer_of_all(scene, monkeypatch):
    half = solve_solid(scene, 1)
    monkeypatch.setattr(solid_solver, "scene_mirrors", lambda *_: {})

    whole = solve_solid(scene, 1)

    assert half.outcome == whole.outcome == "converged"
    # 3 (n - n_plane) / 2 + 2 n_plane of the 3 n unknowns of a section with n_plane nodes in the mirror's plane
    assert half.cost.unknowns < 0.6 * whole.cost.unknowns
    assert half.strain_energy == pytest.approx(whole.strain_energy, rel=1e-9)
    for rod in scene.rods:
        one, other = half.rods[rod.name].nodal, whole.rods[rod.name].nodal
        np.testing.assert_allclose(one, other, atol=1e-9 * np.abs(other).max())
    for key, reaction in whole.reactions.items():
        np.testing.assert_allclose(half.reactions[key], reaction, atol=1e-5)
    for pair in scene.contacts:
        one, other = (each.contact_points(pair.name) for each in (half, whole))
        np.testing.assert_allclose(one.force, other.force, atol=1e-8 * other.force.sum())
        np.testing.assert_allclose(one.gap, other.gap, atol=1e-8 * np.abs(other.gap).max())
        assert 0.0 < other.force.sum() < 300.0


def turned(scene):
    """The clamp of its first rod turns it out of the plane."""
    return replace(scene, supports=(Clamp("arc", "start", rotation=(0.001, 0.0, 0.0)), *scene.supports[1:]))


@pytest.mark.parametrize(
    "scene",
    [
        arc(Rectangle(4.0, 3.0), (5.0, 20.0, 1.0)),
        turned(arc(Rectangle(4.0, 3.0), (5.0, 20.0, 0.0))),
        replace(arc(Box(4.0, 3.0, 0.5), (0.0, 0.0, 0.0)), loads=(SectionMoment("arc", ARC.length, (1.0, 0.0, 0.0)),)),
        pytest.param(bars(aside=0.5), marks=pytest.mark.slow),
        pytest.param(bars(load=(0.0, -300.0, 1.0)), marks=pytest.mark.slow),
    ],
    ids=["force aside", "clamp turned", "moment about the plane", "rod aside", "contact and force aside"],
)
def test_what_is_not_mirrored_is_solved_as_a_whole(scene, monkeypatch):
    found = []
    look = solid_solver.scene_mirrors
    monkeypatch.setattr(solid_solver, "scene_mirrors", lambda *each: found.append(look(*each)) or found[-1])

    solution = solve_solid(scene, 1)

    assert found == [{}]
    assert solution.outcome == "converged"
