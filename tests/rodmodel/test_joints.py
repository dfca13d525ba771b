"""Rigid joints: frames against closed forms, against the unbroken rod, and in equilibrium."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm
from rodmodel import solver
from rodmodel.symmetry import scene_mirrors

YOUNG, SIDE = 200e3, 10.0
AREA, SECOND_MOMENT = SIDE**2, SIDE**4 / 12.0
SHEAR_STIFFNESS = 5.0 / 6.0 * YOUNG / 2.0 * AREA


def bar(name: str, start: np.ndarray, end: np.ndarray, up: np.ndarray, poisson: float = 0.0, side: float = SIDE):
    length = float(np.linalg.norm(np.subtract(end, start)))
    return rm.Rod(
        name,
        rm.Line(tuple(start), tuple(end), tuple(up)),
        rm.Rectangle(side, side),
        rm.Material(YOUNG, poisson),
        (0.0, 0.1 * length, 0.9 * length, length),
    )


def joint(*ends: tuple[str, str]) -> rm.Joint:
    return rm.Joint(tuple(rm.RodEnd(rod, end) for rod, end in ends))


def portal(turn: np.ndarray, poisson: float = 0.3) -> rm.Scene:
    """A post, clamped below, and a beam at right angles on its top, pushed at its tip out of and in the plane."""
    points = np.array([[0.0, 0.0, 0.0], [0.0, 100.0, 0.0], [80.0, 100.0, 0.0]]) @ turn.T
    post = bar("post", points[0], points[1], turn @ [0.0, 0.0, 1.0], poisson)
    beam = bar("beam", points[1], points[2], turn @ [0.0, 0.0, 1.0], poisson)
    loads = (rm.SectionForce("beam", 80.0, tuple(turn @ [100.0, -300.0, 50.0])),)
    joints = (joint(("post", "end"), ("beam", "start")),)
    return rm.Scene("portal", (post, beam), (rm.Clamp("post", "start"),), loads, (), joints)


UPRIGHT = np.eye(3)


def test_a_straight_bar_that_is_cut_and_joined_is_as_before() -> None:
    """With nu = 0 tension and pure bending keep sections rigid, so that a rigid joint changes nothing."""
    whole = bar("left", np.zeros(3), np.array([120.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    left = bar("left", np.zeros(3), np.array([50.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    right = bar("right", np.array([50.0, 0.0, 0.0]), np.array([120.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0]))
    clamp = (rm.Clamp("left", "start"),)

    def loads(rod: str, at: float) -> tuple[rm.SectionForce, rm.SectionMoment]:
        return (rm.SectionForce(rod, at, (500.0, 0.0, 0.0)), rm.SectionMoment(rod, at, (0.0, 3e4, -1e4)))

    found = rm.solve(
        rm.Scene("cut", (left, right), clamp, loads("right", 70.0), (), (joint(("left", "end"), ("right", "start")),)),
        level=2,
        order=2,
    )
    expected = rm.solve(rm.Scene("whole", (whole,), clamp, loads("left", 120.0), ()), level=2, order=2)

    np.testing.assert_allclose(
        found.displacement("right", np.array([0.0, 30.0, 70.0])),
        expected.displacement("left", np.array([50.0, 80.0, 120.0])),
        rtol=1e-9,
        atol=1e-12,
    )
    assert found.strain_energy == pytest.approx(expected.strain_energy, rel=1e-9)


def test_a_two_bar_frame_bends_as_castigliano_says() -> None:
    """A slender frame: bending, stretching and shear of both bars by hand; what is left is the stiffening at the ends,
    where sections cannot warp, of the order of (side / length)^2."""
    post = bar("post", np.zeros(3), np.array([0.0, 400.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    beam = bar("beam", np.array([0.0, 400.0, 0.0]), np.array([300.0, 400.0, 0.0]), np.array([0.0, 0.0, 1.0]))
    force, height, width = 10.0, 400.0, 300.0
    loads = (rm.SectionForce("beam", width, (0.0, -force, 0.0)),)
    frame = rm.Scene(
        "frame", (post, beam), (rm.Clamp("post", "start"),), loads, (), (joint(("post", "end"), ("beam", "start")),)
    )

    tip = rm.solve(frame, level=3, order=4).displacement("beam", np.array([width]))[:, 0]

    bending = YOUNG * SECOND_MOMENT
    down = force * (width**3 / 3.0 + width**2 * height) / bending + force * width / SHEAR_STIFFNESS
    down += force * height / (YOUNG * AREA)
    across = force * width * height**2 / (2.0 * bending)
    np.testing.assert_allclose(tip, [across, -down, 0.0], atol=2e-4 * down)


def test_rods_at_a_joint_are_in_equilibrium() -> None:
    solution = rm.solve(portal(UPRIGHT), level=3, order=4)

    on_post, on_beam = solution.reaction("post", 100.0), solution.reaction("beam", 0.0)

    scale = np.repeat([300.0, 300.0 * 100.0], 3)
    np.testing.assert_allclose((on_post + on_beam) / scale, 0.0, atol=1e-9)
    np.testing.assert_allclose(on_beam[:3], [-100.0, 300.0, -50.0], rtol=1e-9)
    np.testing.assert_allclose(on_beam[3:], -np.cross([80.0, 0.0, 0.0], [100.0, -300.0, 50.0]), rtol=1e-8, atol=1e-5)
    foot = np.concatenate([[-100.0, 300.0, -50.0], -np.cross([80.0, 100.0, 0.0], [100.0, -300.0, 50.0])])
    np.testing.assert_allclose(solution.reaction("post", 0.0) / scale, foot / scale, atol=1e-9)


def test_a_frame_turned_in_space_answers_turned() -> None:
    axis, angle = np.array([1.0, 2.0, -2.0]) / 3.0, 0.7
    cross = np.cross(np.eye(3), axis)
    turn = np.cos(angle) * np.eye(3) + np.sin(angle) * cross.T * -1.0 + (1.0 - np.cos(angle)) * np.outer(axis, axis)

    station = np.array([0.0, 40.0, 80.0])
    upright, turned = (
        rm.solve(portal(each), level=3, order=3).displacement("beam", station) for each in (UPRIGHT, turn)
    )

    np.testing.assert_allclose(turned, turn @ upright, rtol=1e-8, atol=1e-9 * np.abs(upright).max())


def test_leaving_out_what_vanishes_by_symmetry_changes_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = portal(UPRIGHT)
    plane = replace(scene, loads=(rm.SectionForce("beam", 80.0, (100.0, -300.0, 0.0)),))
    assert scene_mirrors(plane) == {"post": (False, True), "beam": (False, True)}
    fewer = rm.solve(plane, level=3, order=3)

    monkeypatch.setattr(solver, "scene_mirrors", lambda scene: {rod.name: (False, False) for rod in scene.rods})
    full = rm.solve(plane, level=3, order=3)

    assert fewer.cost.unknowns < 0.6 * full.cost.unknowns
    for rod in ("post", "beam"):
        station = np.linspace(0.0, 80.0, 5)
        expected = full.displacement(rod, station)
        np.testing.assert_allclose(
            fewer.displacement(rod, station), expected, rtol=1e-8, atol=1e-10 * np.abs(expected).max()
        )


def test_a_closed_frame_between_two_clamps_shares_its_load_evenly() -> None:
    """A symmetric portal: both feet take half of the beam's load, and pull or push sideways alike."""
    corners = np.array([[0.0, 0.0, 0.0], [0.0, 60.0, 0.0], [100.0, 60.0, 0.0], [100.0, 0.0, 0.0]])
    up = np.array([0.0, 0.0, 1.0])
    rods = tuple(bar(name, corners[i], corners[i + 1], up, 0.3) for i, name in enumerate(("left", "top", "right")))
    joints = (joint(("left", "end"), ("top", "start")), joint(("top", "end"), ("right", "start")))
    clamps = (rm.Clamp("left", "start"), rm.Clamp("right", "end"))
    loads = (rm.SectionForce("top", 50.0, (0.0, -1000.0, 0.0)),)

    solution = rm.solve(rm.Scene("portal", rods, clamps, loads, (), joints), level=3, order=5)

    left, right = solution.reaction("left", 0.0), solution.reaction("right", 60.0)
    assert left[1] == pytest.approx(500.0, rel=1e-8)
    np.testing.assert_allclose(left, right * [-1.0, 1.0, 1.0, 1.0, 1.0, -1.0], rtol=1e-6, atol=1e-5)


def test_three_rods_may_meet_and_a_settling_support_bends_them_all() -> None:
    """A star of three bars, two clamped: moving the third one's clamp strains all, and the work done is the energy."""
    tips = 80.0 * np.array([[1.0, 0.0, 0.0], [-0.5, 0.8, 0.0], [-0.5, -0.8, 0.3]])
    up = np.array([0.0, 0.0, 1.0])
    rods = tuple(bar(f"arm {i}", np.zeros(3), tip, up, 0.3) for i, tip in enumerate(tips))
    moved = rm.Clamp("arm 2", "end", displacement=(0.0, 0.1, 0.2), rotation=(0.0, 1e-3, 0.0))
    clamps = (rm.Clamp("arm 0", "end"), rm.Clamp("arm 1", "end"), moved)
    star = joint(*((rod.name, "start") for rod in rods))

    solution = rm.solve(rm.Scene("star", rods, clamps, (), (), (star,)), level=3, order=4)

    reaction = solution.reaction("arm 2", rods[2].length)
    work = reaction[:3] @ moved.displacement + reaction[3:] @ moved.rotation
    assert solution.strain_energy == pytest.approx(0.5 * work, rel=1e-8)
    forces = sum(solution.reaction(rod.name, 0.0)[:3] for rod in rods)
    np.testing.assert_allclose(forces, 0.0, atol=1e-8 * np.abs(reaction[:3]).max())


def test_joined_rods_that_nothing_holds_are_refused_together() -> None:
    scene = portal(UPRIGHT)

    with pytest.raises(rm.SceneError, match="'post', 'beam'"):
        rm.solve(replace(scene, supports=()))
