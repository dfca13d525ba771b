"""Pressure on faces and gravity: resultants by geometry, and what they do to a bar."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm

WIDTH, HEIGHT, LENGTH = 8.0, 12.0, 90.0
STEEL = rm.Material(200e3, 0.3, density=7.85e-9)
# Rigid motions of a bar that turns are not polynomials of its frame: reactions are exact once the order resolves them.
ORDER = 14
CLAMPED = (rm.Clamp("bar", "start"),)
STRAIGHT = rm.Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0))
TWISTED = replace(STRAIGHT, twist=1.2)
ARC = rm.Helix((0.0, 0.0, 0.0), (0.0, 30.0, 0.0), (0.0, 0.0, 1.0), LENGTH / 30.0, (0.0, 1.0, 0.0))
SPRING = rm.Helix((20.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 4.0, (0.0, 0.0, 1.0), pitch=40.0)


def clamped(line: rm.Line | rm.Helix, loads: tuple) -> rm.Scene:
    rod = rm.Rod("bar", line, rm.Rectangle(WIDTH, HEIGHT), STEEL, (0.0, 0.5 * line.length, line.length))
    return rm.Scene("loaded", (rod,), CLAMPED, loads, ())


@pytest.mark.parametrize("line", [STRAIGHT, TWISTED, ARC, SPRING])
def test_even_pressure_all_around_leaves_what_the_open_ends_lack(line: rm.Line | rm.Helix) -> None:
    """Pressure on a closed surface has no resultant, so that on the lateral faces is minus that on the two ends."""
    faces = tuple(
        rm.Pressure(rm.RodFace("bar", face), 0.0, line.length, 3.0) for face in ("top", "bottom", "left", "right")
    )
    solution = rm.solve(clamped(line, faces), level=2, order=ORDER)

    (start, end), axes = (
        solution.frame("bar", np.array([0.0, line.length]))[0].T,
        solution.frame("bar", [0.0, line.length])[1],
    )
    push = 3.0 * WIDTH * HEIGHT
    on_ends = push * axes[0, 2] - push * axes[1, 2]
    moment = np.cross(end - start, -push * axes[1, 2])

    scale = push * np.array([1.0] * 3 + [line.length] * 3)
    np.testing.assert_allclose(solution.reaction("bar", 0.0) / scale, np.append(on_ends, moment) / scale, atol=1e-8)


def test_pressure_on_a_stretch_of_a_face_pushes_against_its_normal() -> None:
    solution = rm.solve(clamped(STRAIGHT, (rm.Pressure(rm.RodFace("bar", "right"), 30.0, 50.0, 2.0),)), 2, 4)

    # e1 = e2 x t = -Z: pressure on the right face pushes along +Z.
    force = 2.0 * HEIGHT * 20.0
    np.testing.assert_allclose(solution.reaction("bar", 0.0), [0.0, 0.0, -force, 0.0, force * 40.0, 0.0], atol=1e-6)


def test_pressure_squeezes_a_bar_where_a_line_load_does_not() -> None:
    """Between equal pressures on top and bottom of a bar that is free lengthways: sigma_y = -p, all else zero."""
    faces = tuple(rm.Pressure(rm.RodFace("bar", face), 0.0, LENGTH, 5.0) for face in ("top", "bottom"))
    scene = replace(clamped(STRAIGHT, faces), supports=(rm.Support("bar", 0.0, ("s",), "section"), _kept_in_place()))

    solution = rm.solve(scene, level=2, order=2)

    stress = solution.stress("bar", np.array([[1.0, -3.0], [2.0, 6.0], [20.0, 70.0]]))
    np.testing.assert_allclose(stress, np.array([[0.0, -5.0, 0.0, 0.0, 0.0, 0.0]] * 2).T, atol=1e-9)


def _kept_in_place() -> rm.Support:
    return rm.Support("bar", LENGTH, ("x", "y", "turn s"), "mean")


@pytest.mark.parametrize("line", [STRAIGHT, TWISTED, ARC, SPRING])
def test_a_bars_weight_is_that_of_its_volume_at_the_volumes_centre(line: rm.Line | rm.Helix) -> None:
    """sqrt(g) puts the weight of a curved bar's section off its centroid, outwards by I / (A R)."""
    gravity = np.array([1000.0, -9810.0, 300.0])

    solution = rm.solve(clamped(line, (rm.Gravity("bar", tuple(gravity)),)), level=2, order=ORDER)

    root, weight = np.polynomial.legendre.leggauss(24)
    station = 0.5 * line.length * (1.0 + root)
    points, axes = solution.frame("bar", station)
    rate = _rate_of_tangent(solution, station)
    # int sqrt(g) x dA = -I_y (dt/ds . e1), int sqrt(g) y dA = -I_x (dt/ds . e2)
    shift = -np.einsum("gn,ng->n", rate, axes[:, 0]) * WIDTH**2 / 12.0 * axes[:, 0].T
    shift = shift - np.einsum("gn,ng->n", rate, axes[:, 1]) * HEIGHT**2 / 12.0 * axes[:, 1].T
    per_length = STEEL.density * WIDTH * HEIGHT * gravity
    force = per_length * line.length
    moment = 0.5 * line.length * np.cross(points + shift - points_at_start(solution), per_length, axisa=0).T @ weight
    scale = np.linalg.norm(force) * np.array([1.0] * 3 + [line.length] * 3)
    np.testing.assert_allclose(solution.reaction("bar", 0.0) / scale, -np.append(force, moment) / scale, atol=1e-7)


def points_at_start(solution: rm.Solution) -> np.ndarray:
    return solution.frame("bar", np.array([0.0]))[0]


def _rate_of_tangent(solution: rm.Solution, station: np.ndarray) -> np.ndarray:
    """dt/ds by central differences, global, shape (3, n)."""
    step = 1e-4
    before, after = (solution.frame("bar", station + sign * step)[1][:, 2] for sign in (-1.0, 1.0))
    return (after - before).T / (2.0 * step)


def test_a_bar_hanging_from_its_clamp_is_stretched_by_its_weight() -> None:
    down = replace(STRAIGHT, end=(0.0, -LENGTH, 0.0), up=(0.0, 0.0, 1.0))
    scene = clamped(down, (rm.Gravity("bar", (0.0, -9810.0, 0.0)),))
    narrow = replace(scene, rods=(replace(scene.rods[0], material=replace(STEEL, poisson_ratio=0.0)),))

    solution = rm.solve(narrow, level=2, order=2)

    tip = solution.displacement("bar", np.array([LENGTH]))[1, 0]
    assert tip == pytest.approx(-7.85e-9 * 9810.0 * LENGTH**2 / (2.0 * 200e3), rel=1e-9)


def test_a_bent_bars_own_weight_turns_with_it() -> None:
    """Half a turn: gravity along X pulls the start outwards and the end inwards; by symmetry no torque about Y."""
    half = replace(ARC, angle=math.pi)

    solution = rm.solve(clamped(half, (rm.Gravity("bar", (9810.0, 0.0, 0.0)),)), level=2, order=ORDER)

    reaction = solution.reaction("bar", 0.0)
    weight = 7.85e-9 * WIDTH * HEIGHT * half.length * 9810.0
    assert reaction[0] == pytest.approx(-weight, rel=1e-9)
    assert reaction[5] == pytest.approx(weight * 30.0, rel=1e-8)
