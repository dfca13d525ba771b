"""Well-known benchmarks: MacNeal and Harder's beams, helical springs, and the square cantilever of the CUF literature.

Some published values are themselves off; they stand beside a better reference and are not what is tested against.
"""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from cases.scene import (
    Circle,
    Helix,
    Line,
    Load,
    Material,
    Rectangle,
    Scene,
    Section,
    SectionForce,
    SectionMoment,
    Vector,
)
from reports.verification.check import Check, Group, Reference, elasticity
from reports.verification.scenes import ROD, STEEL, arc, clamped, end_force, end_moment, rate, straight, work
from reports.verification.torsion import SHEAR_MODULUS, rectangle_torsion

ORDER = 7
# What a clamp takes off a deflection, in section heights over the length: 3D of the square cantilever below is 0.07 off
# Timoshenko's beam.
CLAMP = 0.1

BEAM = Material(1e7, 0.3)
BEAM_LENGTH, DEPTH, THICKNESS = 6.0, 0.2, 0.1


def straight_beam(load: str, level: int) -> float:
    """MacNeal and Harder's straight beam: displacement (in) or rotation of the end under a load of size one.

    The depth of 0.2 lies along Y, the thickness of 0.1 along Z.
    """
    line = straight(BEAM_LENGTH)
    loads = {
        "extension": end_force(line, (1.0, 0.0, 0.0)),
        "in plane": end_force(line, (0.0, 1.0, 0.0)),
        "out of plane": end_force(line, (0.0, 0.0, 1.0)),
        "twist": end_moment(line, (1.0, 0.0, 0.0)),
    }
    return work(clamped(line, Rectangle(THICKNESS, DEPTH), BEAM, DEPTH, 2, loads[load]), level, ORDER)


def straight_beam_reference(load: str) -> Reference:
    """Closed forms: F L / (E A), F L^3 / (3 E I) + F L / (k G A) with Cowper's k, T L / (G J)."""
    young, nu, length, area = BEAM.young_modulus, BEAM.poisson_ratio, BEAM_LENGTH, DEPTH * THICKNESS
    shear = young / (2.0 * (1.0 + nu))

    def bent(height: float) -> float:
        cowper = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
        return length**3 / (3.0 * young * area * height**2 / 12.0) + length / (cowper * shear * area)

    value = {
        "extension": length / (young * area),
        "in plane": bent(DEPTH),
        "out of plane": bent(THICKNESS),
        "twist": length / (shear * rectangle_torsion(DEPTH, THICKNESS)),
    }[load]
    return Reference(value, CLAMP * DEPTH / length * value)


CURVED = Material(1e7, 0.25)
INNER, OUTER = 4.12, 4.32


def curved_beam(direction: Vector, level: int) -> float:
    """MacNeal and Harder's curved beam: displacement of the end along a unit force, in."""
    line = arc((INNER + OUTER) / 2.0, math.pi / 2.0)
    scene = clamped(line, Rectangle(THICKNESS, OUTER - INNER), CURVED, OUTER - INNER, 3, end_force(line, direction))
    return work(scene, level, ORDER)


def curved_beam_reference() -> Reference:
    """Deflection pi P (a^2 + b^2) / (E t N), N = a^2 - b^2 + (a^2 + b^2) ln(b / a), in.

    Timoshenko and Goodier, article 33: plane elasticity with the clamped section free to warp and contract; uncertain
    by the clamp.
    """
    a, b = INNER, OUTER
    divisor = a**2 - b**2 + (a**2 + b**2) * math.log(b / a)
    value = math.pi * (a**2 + b**2) / (CURVED.young_modulus * THICKNESS * divisor)
    return Reference(value, CLAMP * (b - a) / (math.pi / 2.0 * (a + b) / 2.0) * value)


def twisted_beam(direction: Vector, level: int) -> float:
    """MacNeal and Harder's twisted beam, 12 x 1.1 x 0.32; the wide side along Y at the clamp, along Z at the end."""
    line = straight(12.0, twist=math.pi / 2.0)
    scene = clamped(line, Rectangle(0.32, 1.1), Material(29e6, 0.22), 1.1, 4, end_force(line, direction))
    return work(scene, level, ORDER)


RADIUS, WIRE, PITCH = 50.0, 5.0, 12.0
TURNS = (2.0, 3.0)
SPRING_ORDER = 5


def spring(section: Section, turns: float) -> Scene:
    """Helical spring about Z, clamped at one end, under a unit force on its axis that is carried to the other end."""
    line = Helix((RADIUS, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0 * math.pi * turns, (0.0, 0.0, 1.0), PITCH)
    force = (0.0, 0.0, 1.0)
    # both numbers of turns are whole: the wire ends above its start
    about_end = np.cross([-RADIUS, 0.0, 0.0], force)
    loads: tuple[Load, ...] = (
        SectionForce(ROD, line.length, force),
        SectionMoment(ROD, line.length, (float(about_end[0]), float(about_end[1]), float(about_end[2]))),
    )
    return clamped(line, section, STEEL, WIRE, int(6 * turns), loads)


def spring_flexibility(section: Section, level: int) -> float:
    """Elongation per unit force and turn, mm/N."""
    return rate(partial(spring, section), TURNS, level, SPRING_ORDER)


def wahl(torsion_constant: float, second_moment: float) -> Reference:
    """Elongation per force and turn, R^2 l (cos^2(alpha) / (G J) + sin^2(alpha) / (E I)), l the length of a turn.

    Twisting by F R cos(alpha) and bending by F R sin(alpha), alpha the pitch angle; uncertain by 1 / index^2, as the
    curvature of the wire and the direct shear count.
    """
    length = math.hypot(2.0 * math.pi * RADIUS, PITCH)
    sine, cosine = PITCH / length, 2.0 * math.pi * RADIUS / length
    twisting = cosine**2 / (SHEAR_MODULUS * torsion_constant)
    value = RADIUS**2 * length * (twisting + sine**2 / (STEEL.young_modulus * second_moment))
    return Reference(value, value / (2.0 * RADIUS / WIRE) ** 2)


def square_cantilever(level: int) -> float:
    """L = 1 m, 0.1 x 0.1 m, E = 70 GPa, nu = 0.3, F = 1000 N at the end: deflection, m (computed in mm)."""
    line = Line((0.0, 0.0, 0.0), (1000.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    force = 1000.0
    scene = clamped(line, Rectangle(100.0, 100.0), Material(70e3, 0.3), 100.0, 2, end_force(line, (0.0, force, 0.0)))
    return work(scene, level, ORDER) / force / 1000.0


MACNEAL = "R. H. MacNeal, R. L. Harder, Finite Elements in Analysis and Design 1 (1985) 3-20"
SOLID = "3D made outside this project; uncertainty: a unit of the last digit"
TIMOSHENKO = "Timoshenko's beam; uncertain by 0.1 h / L, as the clamp holds the section; benchmark of "

GROUP = Group(
    "Published benchmarks",
    "With their published values, some of which are off: those are shown, and the rod model is held against a better "
    "reference. Loads are named by the axis they act along. p = 7, springs p = 5.",
    (
        *(
            Check(
                f"Straight beam, {load}",
                shows,
                "closed form",
                source + MACNEAL,
                unit,
                partial(straight_beam_reference, load),
                partial(straight_beam, load),
                tolerance,
                level,
                published=published,
            )
            for load, shows, source, unit, tolerance, level, published in (
                ("extension", "F L / (E A).", TIMOSHENKO, "in", 5e-3, 2, 3e-5),
                ("in plane", "Bending with shear, about the stiffer axis.", TIMOSHENKO, "in", 5e-3, 2, 0.1081),
                ("out of plane", "Bending with shear, about the softer axis.", TIMOSHENKO, "in", 5e-3, 2, 0.4321),
                (
                    "twist",
                    "T L / (G J); the published value is 6 % off Saint-Venant's.",
                    elasticity(109) + "; uncertain by 0.1 h / L; benchmark of ",
                    "rad",
                    1e-2,
                    4,
                    0.03208,
                ),
            )
        ),
        Check(
            "Curved beam, in plane: plane elasticity",
            "Radial force at the free end of a quarter circle; the published value is 1.4 % off.",
            "closed form",
            elasticity(33) + "; benchmark of " + MACNEAL,
            "in",
            curved_beam_reference,
            partial(curved_beam, (0.0, 1.0, 0.0)),
            5e-3,
            2,
            published=0.08734,
        ),
        Check(
            "Curved beam, in plane: 3D",
            "The same against 3D with the clamp as it is.",
            "3d converged",
            f"{SOLID}; benchmark of {MACNEAL}",
            "in",
            lambda: Reference(0.088519, 1e-6),
            partial(curved_beam, (0.0, 1.0, 0.0)),
            1e-3,
            3,
            published=0.08734,
        ),
        Check(
            "Curved beam, out of plane",
            "Bending with torsion of a 2 : 1 rectangle.",
            "3d converged",
            "3D made outside this project; a second one (27-node hexahedra) rises to 0.4981, hence the uncertainty; "
            f"benchmark of {MACNEAL}",
            "in",
            lambda: Reference(0.498302, 2e-4),
            partial(curved_beam, (0.0, 0.0, 1.0)),
            2e-3,
            6,
            published=0.5022,
        ),
        Check(
            "Twisted beam, force along Y",
            "The section turns by 90 degrees; at the clamp its wide side lies along Y.",
            "3d converged",
            f"{SOLID}; benchmark of {MACNEAL}",
            "in",
            lambda: Reference(0.00175325, 1e-8),
            partial(twisted_beam, (0.0, 1.0, 0.0)),
            5e-4,
            6,
        ),
        Check(
            "Twisted beam, force along Z",
            "The same against the softer way at the clamp.",
            "3d converged",
            f"{SOLID}; benchmark of {MACNEAL}",
            "in",
            lambda: Reference(0.00542453, 1e-8),
            partial(twisted_beam, (0.0, 0.0, 1.0)),
            5e-4,
            6,
        ),
        Check(
            "Helical spring, round wire, index 20",
            "Twisting and bending of the wire, elongation per turn.",
            "closed form",
            "A. M. Wahl, Mechanical Springs, 1963; uncertain by 1 / index²",
            "mm/N",
            lambda: wahl(math.pi * WIRE**4 / 32.0, math.pi * WIRE**4 / 64.0),
            partial(spring_flexibility, Circle(WIRE)),
            5e-3,
            2,
            levels=(1, 2, 3, 4, 5, 6),
        ),
        Check(
            "Helical spring, square wire, index 20",
            "The same with the torsion constant of the square.",
            "closed form",
            "A. M. Wahl, Mechanical Springs, 1963; uncertain by 1 / index²",
            "mm/N",
            lambda: wahl(rectangle_torsion(WIRE, WIRE), WIRE**4 / 12.0),
            partial(spring_flexibility, Rectangle(WIRE, WIRE)),
            5e-3,
            4,
            levels=(1, 2, 3, 4, 5, 6),
        ),
        Check(
            "Square cantilever, L / h = 10",
            "Benchmark of the Carrera unified formulation; its tables give 5.66e-4 to 5.69e-4 m, 0.6 to 1 % stiff.",
            "3d converged",
            "3D made outside this project, refined; uncertainty: a unit of the last digit",
            "m",
            lambda: Reference(5.719e-4, 1e-7),
            square_cantilever,
            1e-3,
            5,
            published=5.69e-4,
        ),
    ),
)
