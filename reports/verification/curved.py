"""Curved rods: thick bars in pure bending, and a quarter of a ring under an end force."""

from __future__ import annotations

import json
import math
from functools import cache, partial

import numpy as np

import rodmodel
from cases.loader import TRUTH
from cases.scene import Rectangle, Scene, Vector
from reports.verification.check import Check, Group, Reference, elasticity
from reports.verification.scenes import ROD, STEEL, WITHOUT_CONTRACTION, arc, clamped, end_force, end_moment, rate, work
from reports.verification.torsion import SHEAR_MODULUS, rectangle_torsion

HEIGHT, WIDTH = 20.0, 5.0
ORDER = 7
RING_ORDER = 6
ANGLES = (math.pi, 1.9 * math.pi)


def bent_bar(radius: float, angle: float) -> Scene:
    """Curved bar under a unit moment that opens it: about -Z at the end of a turn about +Z."""
    line = arc(radius, angle)
    load = end_moment(line, (0.0, 0.0, -1.0))
    return clamped(line, Rectangle(WIDTH, HEIGHT), WITHOUT_CONTRACTION, HEIGHT, 4, load)


def bending_flexibility(radius: float, level: int) -> float:
    """Rotation of the end per unit moment and per radian of the arc, from two arcs, 1/(N mm)."""
    return rate(partial(bent_bar, radius), ANGLES, level, ORDER)


def inner_stress(radius: float, level: int) -> float:
    """Hoop stress at the inner face in the middle of the arc, MPa."""
    solution = rodmodel.solve(bent_bar(radius, ANGLES[1]), level, ORDER)
    points = np.array([[0.0], [-HEIGHT / 2.0], [radius * ANGLES[1] / 2.0]])
    return float(solution.stress(ROD, points)[2, 0])


def golovin_divisor(inner: float, outer: float) -> float:
    """N = (b^2 - a^2)^2 - 4 a^2 b^2 ln(b / a)^2, mm^4 (Timoshenko and Goodier, article 29)."""
    return (outer**2 - inner**2) ** 2 - 4.0 * inner**2 * outer**2 * math.log(outer / inner) ** 2


def golovin_flexibility(radius: float) -> float:
    """Rotation per moment and radian, 8 (b^2 - a^2) / (E N): the displacement's term that grows with the angle."""
    inner, outer = radius - HEIGHT / 2.0, radius + HEIGHT / 2.0
    young = WITHOUT_CONTRACTION.young_modulus * WIDTH
    return 8.0 * (outer**2 - inner**2) / (young * golovin_divisor(inner, outer))


def golovin_inner_stress(radius: float) -> float:
    """Hoop stress at r = a under a unit moment that opens the bar, MPa."""
    a, b = radius - HEIGHT / 2.0, radius + HEIGHT / 2.0
    bracket = -(b**2) * math.log(b / a) + b**2 * math.log(a / b) + b**2 - a**2
    return -4.0 / (WIDTH * golovin_divisor(a, b)) * bracket


def winkler_inner_stress(radius: float) -> float:
    """Winkler and Bach: M (r_n - a) / (A e a), r_n = h / ln(b / a), e = R - r_n, MPa."""
    a, b = radius - HEIGHT / 2.0, radius + HEIGHT / 2.0
    neutral = HEIGHT / math.log(b / a)
    return (neutral - a) / (WIDTH * HEIGHT * (radius - neutral) * a)


def winkler_reference(radius: float) -> Reference:
    """Winkler's and Bach's stress, uncertain by its distance from Golovin's."""
    approximate = winkler_inner_stress(radius)
    return Reference(approximate, abs(approximate - golovin_inner_stress(radius)))


def quarter_ring(radius: float, side: float, force: Vector) -> Scene:
    """Quarter ring from (R, 0, 0) to (0, R, 0) about the origin, force at the free end."""
    line = arc(radius, math.pi / 2.0)
    return clamped(line, Rectangle(side, side), STEEL, side, 3, end_force(line, force))


def ring_deflection(radius: float, side: float, direction: Vector, level: int) -> float:
    """Deflection of the free end along a unit force, mm/N."""
    return work(quarter_ring(radius, side, direction), level, RING_ORDER)


@cache
def solid_ring(load: str) -> Reference:
    """Deflection along the force per unit force of the quarter ring with R = 100, 15 x 15, from 3D, mm/N."""
    found = json.loads((TRUTH / "quarter_ring_r100.json").read_text(encoding="utf-8"))["loads"][load]
    force = np.array(found["force_N"], dtype=float)
    size = float(np.linalg.norm(force))
    along = float(np.array(found["end_face_mean_displacement_mm"]) @ force) / size
    return Reference(along / size, float(found["uncertainty_mm"]) / size)


THIN_RADIUS, THIN_SIDE = 1000.0, 10.0


def thin_ring(in_plane: bool) -> Reference:
    """Castigliano's deflections of a thin quarter ring per unit force, mm/N, uncertain by h / R.

    In its plane along the radius at the free end pi R^3 / (4 E I); across it
    R^3 (pi / (4 E I) + (3 pi / 4 - 2) / (G J)), from M = F R sin(phi), T = F R (1 - cos(phi)).
    """
    bending = STEEL.young_modulus * THIN_SIDE**4 / 12.0
    deflection = math.pi / 4.0 * THIN_RADIUS**3 / bending
    if not in_plane:
        torsion = SHEAR_MODULUS * rectangle_torsion(THIN_SIDE, THIN_SIDE)
        deflection += (0.75 * math.pi - 2.0) * THIN_RADIUS**3 / torsion
    return Reference(deflection, 0.1 * deflection * THIN_SIDE / THIN_RADIUS)


GOLOVIN = elasticity(29) + " (H. Golovin 1881)"
WINKLER = "S. P. Timoshenko, Strength of Materials, part 2, 1956 (E. Winkler 1858, C. Bach 1889)"
SOLID_RING = "3D made outside this project: 27-node hexahedra, five refinements, extrapolated"
CASTIGLIANO = "A. Castigliano 1879; exact for a thin ring, uncertain by 0.1 h / R"

# Radius against height, and the level that makes the error smaller than the tolerance.
RATIOS = ((5.0, 3), (1.0, 5), (0.75, 7))


def _golovin_checks() -> tuple[Check, ...]:
    flexible = (
        Check(
            f"Thick bar, R / h = {ratio:g}: rotation",
            "Pure bending of a curved bar, stiffness: plane elasticity.",
            "closed form",
            GOLOVIN,
            "rad/(N mm)",
            partial(lambda radius: Reference(golovin_flexibility(radius)), ratio * HEIGHT),
            partial(bending_flexibility, ratio * HEIGHT),
            1e-4,
            level,
        )
        for ratio, level in RATIOS
    )
    stressed = (
        Check(
            f"Thick bar, R / h = {ratio:g}: stress inside",
            "Pure bending of a curved bar, hoop stress at the inner face: plane elasticity.",
            "closed form",
            GOLOVIN,
            "MPa",
            partial(lambda radius: Reference(golovin_inner_stress(radius)), ratio * HEIGHT),
            partial(inner_stress, ratio * HEIGHT),
            1e-3,
            level,
        )
        for ratio, level in RATIOS
    )
    return (*flexible, *stressed)


GROUP = Group(
    "Curved rods",
    "Bars of 20 mm height in the plane of curvature under end moments, nu = 0, so that plane elasticity is exact; "
    "quarter rings of square section under a force at the free end, nu = 0.3.",
    (
        *_golovin_checks(),
        Check(
            "Curved bar, R / h = 5: Winkler and Bach",
            "Plane sections without radial stress, an approximation that h1 equals: hoop stress at the inner face.",
            "closed form",
            WINKLER,
            "MPa",
            lambda: winkler_reference(5.0 * HEIGHT),
            partial(inner_stress, 5.0 * HEIGHT),
            5e-3,
            4,
        ),
        Check(
            "Curved bar, R / h = 1: Winkler and Bach",
            "The same where the bar is thick.",
            "closed form",
            WINKLER,
            "MPa",
            lambda: winkler_reference(HEIGHT),
            partial(inner_stress, HEIGHT),
            2e-2,
            6,
        ),
        Check(
            "Quarter ring, R / h = 6.7, radially",
            "Bending in the plane of the ring.",
            "3d converged",
            SOLID_RING,
            "mm/N",
            partial(solid_ring, "radial"),
            partial(ring_deflection, 100.0, 15.0, (0.0, 1.0, 0.0)),
            1e-4,
            6,
        ),
        Check(
            "Quarter ring, R / h = 6.7, out of plane",
            "Bending with torsion.",
            "3d converged",
            SOLID_RING,
            "mm/N",
            partial(solid_ring, "out_of_plane"),
            partial(ring_deflection, 100.0, 15.0, (0.0, 0.0, 1.0)),
            5e-4,
            6,
        ),
        Check(
            "Thin quarter ring, R / h = 100, radially",
            "No membrane locking.",
            "closed form",
            CASTIGLIANO,
            "mm/N",
            lambda: thin_ring(in_plane=True),
            partial(ring_deflection, THIN_RADIUS, THIN_SIDE, (0.0, 1.0, 0.0)),
            1e-3,
            2,
        ),
        Check(
            "Thin quarter ring, R / h = 100, out of plane",
            "Bending with torsion, thin.",
            "closed form",
            CASTIGLIANO,
            "mm/N",
            lambda: thin_ring(in_plane=False),
            partial(ring_deflection, THIN_RADIUS, THIN_SIDE, (0.0, 0.0, 1.0)),
            1e-3,
            4,
        ),
    ),
)
