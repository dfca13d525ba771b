"""Saint-Venant torsion: torsion constants recovered from the twist per length of rods with two lengths."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import partial

import numpy as np

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Scene, Section
from reports.verification.check import Check, Group, Reference, elasticity
from reports.verification.scenes import STEEL, clamped, end_moment, rate, straight

SHEAR_MODULUS = STEEL.young_modulus / (2.0 * (1.0 + STEEL.poisson_ratio))
ORDER = 5


def torsion_constant(section: Section, size: float, level: int) -> float:
    """J = T / (G theta') from the end rotations of two rods, mm^4."""

    def scene(length: float) -> Scene:
        line = straight(length)
        return clamped(line, section, STEEL, size, 1, end_moment(line, (1.0, 0.0, 0.0)))

    return 1.0 / (SHEAR_MODULUS * rate(scene, (12.0 * size, 20.0 * size), level, ORDER))


def rectangle_torsion(long: float, short: float) -> float:
    """J of a rectangle, sides long >= short, mm^4 (Timoshenko and Goodier, article 109)."""
    n = np.arange(1, 41, 2)
    series = float((np.tanh(n * math.pi * long / (2.0 * short)) / n**5).sum())
    return long * short**3 / 3.0 * (1.0 - 192.0 * short / (math.pi**5 * long) * series)


def triangle_torsion(side: float) -> float:
    """J of an equilateral triangle, sqrt(3) side^4 / 80, mm^4."""
    return math.sqrt(3.0) * side**4 / 80.0


def square_box_torsion(side: float, wall: float) -> Reference:
    """Bredt's J = 4 A_m^2 t / U_m of a square tube, mm^4, uncertain by what he leaves out.

    That is the wall's own U_m t^3 / 3, and at each sharp corner the membrane's slope: a corner conducts as 0.54 t of
    wall, not as the t of middle line it has (I. Langmuir, E. Adams, G. Meikle, Transactions of the American
    Electrochemical Society 24 (1913) 53, for heat).
    """
    middle = side - wall
    bredt = middle**3 * wall
    return Reference(bredt, 4.0 * middle * wall**3 / 3.0 + bredt * (1.0 - 0.54) * wall / middle)


def _check(
    name: str,
    shows: str,
    source: str,
    section: Section,
    size: float,
    reference: Callable[[], Reference],
    tolerance: float,
    at_level: int,
) -> Check:
    value = partial(torsion_constant, section, size)
    return Check(name, shows, "closed form", source, "mm⁴", reference, value, tolerance, at_level)


GROUP = Group(
    "Torsion",
    "Torsion constant from the difference of the end rotations of two clamped rods, 12 and 20 section sides long; what "
    "clamp and load disturb cancels. p = 5, nu = 0.3.",
    (
        _check(
            "Circle, diameter 10",
            "A circle does not warp: any level is exact.",
            elasticity(101),
            Circle(10.0),
            10.0,
            lambda: Reference(math.pi * 10.0**4 / 32.0),
            1e-9,
            1,
        ),
        _check(
            "Tube, diameters 10 and 7",
            "A tube does not warp: any level is exact.",
            elasticity(101),
            Ring(10.0, 7.0),
            10.0,
            lambda: Reference(math.pi * (10.0**4 - 7.0**4) / 32.0),
            1e-9,
            1,
        ),
        _check(
            "Equilateral triangle, side 12",
            "Its warping is a cubic: exact from h3 on.",
            elasticity(106),
            Polygon(((0.0, 0.0), (12.0, 0.0), (6.0, 6.0 * math.sqrt(3.0)))),
            12.0,
            lambda: Reference(triangle_torsion(12.0)),
            1e-7,
            3,
        ),
        _check(
            "Square, side 10",
            "0.1406 side⁴; the warping begins at degree 4.",
            elasticity(109),
            Rectangle(10.0, 10.0),
            10.0,
            lambda: Reference(rectangle_torsion(10.0, 10.0)),
            1e-3,
            8,
        ),
        _check(
            "Rectangle, 20 x 10",
            "0.229 b h³; the warping begins with x y.",
            elasticity(109),
            Rectangle(20.0, 10.0),
            20.0,
            lambda: Reference(rectangle_torsion(20.0, 10.0)),
            1e-3,
            8,
        ),
        _check(
            "Square box, 30 x 30, wall 1.5",
            "Bredt's formula for thin walls, an approximation. Warping has a kink at each corner, which polynomials "
            "approach slowly.",
            "R. Bredt, VDI-Zeitschrift 40 (1896) 785; " + elasticity(116),
            Box(30.0, 30.0, 1.5),
            30.0,
            lambda: square_box_torsion(30.0, 1.5),
            6e-2,
            8,
        ),
    ),
)
