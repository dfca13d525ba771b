"""Radius of curvature down to the section: sqrt(g) kept, against the thin rod's and Winkler's and Bach's formulas."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np

import rodmodel
from cases.scene import Clamp, Rectangle, Rod, Scene
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.wording import number, share
from reports.verification.curved import (
    HEIGHT,
    WIDTH,
    golovin_flexibility,
    golovin_inner_stress,
    winkler_inner_stress,
)
from reports.verification.scenes import ROD, WITHOUT_CONTRACTION, arc, end_moment

RATIOS = (100.0, 30.0, 10.0, 5.0, 2.0, 1.0, 0.75, 0.6, 0.55)
LEVELS = (2, 4, 7, 10)
ORDER = 7
# Arcs of two lengths, in heights: what clamp and load disturb is the same on both. Elements are as long as it is high.
LENGTHS = (6, 10)
YOUNG, AREA = WITHOUT_CONTRACTION.young_modulus, WIDTH * HEIGHT

THIN = Method("thin rod, sqrt(g) = 1", ours=False)
WINKLER = Method("Winkler and Bach", ours=False)
RODS = tuple(Method(f"h{level}, p = 7") for level in LEVELS)


def bent(radius: float, heights: int, level: int) -> rodmodel.Solution:
    """An arc of so many heights, clamped at its start, under a unit moment that opens it."""
    line = arc(radius, heights * HEIGHT / radius)
    rod = Rod(
        ROD,
        line,
        Rectangle(WIDTH, HEIGHT),
        WITHOUT_CONTRACTION,
        tuple(np.linspace(0.0, line.length, heights + 1).tolist()),
    )
    scene = Scene("bent", (rod,), (Clamp(ROD, "start"),), end_moment(line, (0.0, 0.0, -1.0)), ())
    return rodmodel.solve(scene, level, ORDER)


def rotation_and_stress(radius: float, level: int) -> tuple[float, float]:
    """Rotation per unit moment and radian, and the hoop stress at the inner face in the middle of the longer arc."""
    short, long = (bent(radius, heights, level) for heights in LENGTHS)
    angle = (LENGTHS[1] - LENGTHS[0]) * HEIGHT / radius
    middle = np.array([[0.0], [-0.5 * HEIGHT], [0.5 * LENGTHS[1] * HEIGHT]])
    return 2.0 * (long.strain_energy - short.strain_energy) / angle, float(long.stress(ROD, middle)[2, 0])


def measure(values: tuple[float, ...]) -> Found:
    """Errors of the rotation and of the stress at the inner face in pure bending, against Golovin."""
    turned: dict[str, list[float]] = {method.name: [] for method in (THIN, WINKLER, *RODS)}
    stressed: dict[str, list[float]] = {name: [] for name in turned}
    for value in values:
        radius = value * HEIGHT
        eccentric = radius - HEIGHT / math.log((2.0 * value + 1.0) / (2.0 * value - 1.0))
        ours = [rotation_and_stress(radius, level) for level in LEVELS]
        rotations = [12.0 * radius / (YOUNG * AREA * HEIGHT**2), 1.0 / (YOUNG * AREA * eccentric)]
        stresses = [6.0 / (AREA * HEIGHT), winkler_inner_stress(radius)]
        rotations += [rotation for rotation, _ in ours]
        stresses += [stress for _, stress in ours]
        for name, rotation, stress in zip(turned, rotations, stresses, strict=True):
            turned[name].append(abs(rotation / golovin_flexibility(radius) - 1.0))
            stressed[name].append(abs(stress / golovin_inner_stress(radius) - 1.0))
    return {
        "rotation": {name: curve(values, errors) for name, errors in turned.items()},
        "stress": {name: curve(values, errors) for name, errors in stressed.items()},
    }


def claim(found: Found) -> str:
    """How far the formulas are off where the radius is small, and how the levels follow."""
    turned, stressed = found["rotation"], found["stress"]
    tightest = turned[THIN.name].x[-1]
    levels = ", ".join(
        f"h{level} {share(turned[each.name].y[-1])} and {share(stressed[each.name].y[-1])}"
        for level, each in zip(LEVELS, RODS, strict=True)
    )
    thin, winkler = (
        f"{share(turned[each.name].y[-1])} in rotation and {share(stressed[each.name].y[-1])} in stress"
        for each in (THIN, WINKLER)
    )
    return (
        f"At R / h = {tightest:g}, where the inner face has a radius of {number((tightest - 0.5) * HEIGHT)} mm, the "
        f"thin rod is off by {thin}, Winkler's and Bach's plane sections by {winkler}; {levels}. The thin rod's stress "
        f"is within 1 % only from R / h = {number(_good_from(found))} on."
    )


def _good_from(found: Found) -> float:
    thin = found["stress"][THIN.name]
    return min((x for x, error in zip(thin.x, thin.y, strict=True) if error < 0.01), default=math.inf)


def own_limit(found: Found) -> str:
    """Low levels, and the formula's own digits."""
    stressed = found["stress"]
    worst = ", ".join(
        f"h{level} by up to {share(stressed[each.name].largest)}" for level, each in zip(LEVELS, RODS, strict=True)
    )
    return (
        f"The stress at the inner face needs degrees as it grows like 1 / r: {worst}. A radius that reaches the inner "
        "face is refused when the scene is made."
    )


def holds(found: Found) -> bool:
    """The formulas fail at the smallest radius; at R / h = 0.75 every level is five times better than the one below."""
    turned, stressed = found["rotation"], found["stress"]
    plain = turned[THIN.name].y[-1] > 0.1 and stressed[THIN.name].y[-1] > 0.3 and turned[WINKLER.name].y[-1] > 0.1
    errors = [[each[method.name].at(0.75) for method in RODS] for each in (turned, stressed)]
    better = all(5.0 * high < low for levels in errors for low, high in pairwise(levels))
    return plain and better and turned[RODS[-1].name].largest < 1e-3


SWEEP = Sweep(
    "Curvature",
    "Pure bending of an arc, 20 mm high in the plane of curvature, nu = 0: radius over height from 100 to 0.55 "
    "(at 0.5 no inner face is left). Golovin's solution of plane elasticity is exact.",
    RATIOS,
    (THIN, WINKLER, *RODS),
    (
        Picture("rotation", "Rotation", "R / h", "relative error"),
        Picture("stress", "Stress at the inner face", "R / h", "relative error"),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
