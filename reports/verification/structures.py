"""Rods that other things than clamps hold: beams on Winkler beds and on several supports, and a frame of two bars."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

import rodmodel
from cases.scene import (
    Bed,
    Clamp,
    Joint,
    Line,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    SectionForce,
    Support,
    Vector,
)
from reports.verification.check import Check, Group, Reference
from reports.verification.scenes import ROD, STEEL, borders, work
from reports.verification.torsion import SHEAR_MODULUS, rectangle_torsion

ORDER = 6
SIDE = 10.0
YOUNG = STEEL.young_modulus
AREA, SECOND_MOMENT = SIDE**2, SIDE**4 / 12.0
# Bernoulli's beam leaves out shear, which counts by (beta h)^2 E / (10 G) or so, and the bar's own squeezing.
DECAY = 0.05 / SIDE
MODULUS = 4.0 * YOUNG * SECOND_MOMENT * DECAY**4 / SIDE
BED = "M. Hetényi, Beams on Elastic Foundation, 1946; uncertain by (β h)², as shear is left out"
WITHOUT_SHEAR = (DECAY * SIDE) ** 2


def on_bed(length: float, at: float) -> Scene:
    """A square bar lying on a bed, pressed down by a unit force, and kept from sliding along it and aside."""
    line = Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0))
    # The deflection bends over 1 / beta, twenty heights, and the force disturbs one height around it.
    near = [0.2 * SIDE, SIDE, 3.0 * SIDE]
    stations = {at + sign * distance for sign in (-1.0, 1.0) for distance in near} | {at}
    even = np.linspace(0.0, length, max(4, round(2.0 * DECAY * length)) + 1)
    every = sorted({float(s) for s in even if min(abs(s - o) for o in stations) > SIDE} | stations | {0.0, length})
    rod = Rod(ROD, line, Rectangle(SIDE, SIDE), STEEL, tuple(s for s in every if 0.0 <= s <= length))
    keep = Support(ROD, at, ("x", "s", "turn s", "turn y"), "mean")
    load = SectionForce(ROD, at, (0.0, -1.0, 0.0))
    return Scene("bed", (rod,), (keep,), (load,), (), (), (Bed(RodFace(ROD, "bottom"), 0.0, length, MODULUS),))


def sinking(length: float, at: float, level: int) -> float:
    """How far the bar sinks under the unit force, mm/N: its work, shared by bar and bed."""
    return 2.0 * rodmodel.solve(on_bed(length, at), level, ORDER).stored_energy


def moment_under_force(length: float, level: int) -> float:
    """Bending moment a height beside the unit force in the middle of a long bar, N mm per N."""
    solution = rodmodel.solve(on_bed(length, 0.5 * length), level, ORDER)
    return abs(float(solution.section_resultants(ROD, np.array([0.5 * length + SIDE]))[3, 0]))


def sinking_reference(length: float) -> Reference:
    """Bar of finite length under a force in its middle, Hetenyi's article 18.

    F beta / (2 k b) (cosh(beta l) + cos(beta l) + 2) / (sinh(beta l) + sin(beta l)); F beta / (2 k b) for a long one.
    """
    turned = DECAY * length
    share = (math.cosh(turned) + math.cos(turned) + 2.0) / (math.sinh(turned) + math.sin(turned))
    return _uncertain(DECAY / (2.0 * MODULUS * SIDE) * share)


def end_sinking_reference() -> Reference:
    """Long bar under a force on its end, 2 F beta / (k b)."""
    return _uncertain(2.0 * DECAY / (MODULUS * SIDE))


def moment_reference() -> Reference:
    """Long bar, a height from the force: F / (4 beta) e^(-beta x) (cos(beta x) - sin(beta x))."""
    x = DECAY * SIDE
    return _uncertain(math.exp(-x) * (math.cos(x) - math.sin(x)) / (4.0 * DECAY))


def _uncertain(value: float) -> Reference:
    return Reference(value, WITHOUT_SHEAR * value)


HEIGHT, WIDTH = 400.0, 300.0
SHEAR_STIFFNESS = SHEAR_MODULUS * AREA * 10.0 * 1.3 / (12.0 + 11.0 * 0.3)
# A joint holds its sections as a clamp does: 0.07 h of the length each.
RIGID_ENDS = 3.0 * 0.1 * SIDE / (HEIGHT + WIDTH)


def frame(force: Vector) -> Scene:
    """A post clamped at its foot and a beam joined to its top at right angles, under a force on the beam's end."""
    corner = (0.0, HEIGHT, 0.0)
    post = Rod("post", Line((0.0, 0.0, 0.0), corner, (0.0, 0.0, 1.0)), Rectangle(SIDE, SIDE), STEEL, _borders(HEIGHT))
    across = Line(corner, (WIDTH, HEIGHT, 0.0), (0.0, 0.0, 1.0))
    beam = Rod("beam", across, Rectangle(SIDE, SIDE), STEEL, _borders(WIDTH))
    joint = Joint((RodEnd("post", "end"), RodEnd("beam", "start")))
    load = SectionForce("beam", WIDTH, force)
    return Scene("frame", (post, beam), (Clamp("post", "start"),), (load,), (), (joint,))


def _borders(length: float) -> tuple[float, ...]:
    return borders(length, SIDE, 1)


def tip(force: Vector, level: int) -> float:
    """Displacement of the beam's end along a unit force, mm/N."""
    return work(frame(force), level, ORDER)


def tip_reference(force: Vector) -> Reference:
    """Castigliano: bending, stretching, shear, and for a force across the frame the torsion of the post."""
    bending = YOUNG * SECOND_MOMENT
    if force[2] != 0.0:
        value = (WIDTH**3 + HEIGHT**3) / (3.0 * bending) + (WIDTH + HEIGHT) / SHEAR_STIFFNESS
        value += WIDTH**2 * HEIGHT / (SHEAR_MODULUS * rectangle_torsion(SIDE, SIDE))
    elif force[1] != 0.0:
        value = (WIDTH**3 / 3.0 + WIDTH**2 * HEIGHT) / bending + WIDTH / SHEAR_STIFFNESS + HEIGHT / (YOUNG * AREA)
    else:
        value = HEIGHT**3 / (3.0 * bending) + HEIGHT / SHEAR_STIFFNESS + WIDTH / (YOUNG * AREA)
    return Reference(value, RIGID_ENDS * value)


SPAN = 200.0


def middle_reaction(level: int) -> float:
    """Share of the middle one of three supports in two forces in the middles of two equal spans."""
    length = 2.0 * SPAN
    line = Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0))
    stations = tuple(0.5 * SPAN * number for number in range(5))
    near = [s + sign * part * SIDE for s in stations for part in (0.2, 1.0) for sign in (-1.0, 1.0)]
    every = tuple(sorted(s for s in (*stations, *near) if 0.0 <= s <= length))
    rod = Rod(ROD, line, Rectangle(SIDE, SIDE), STEEL, every)
    supports = (
        Support(ROD, 0.0, ("x", "y", "s", "turn s"), "mean"),
        Support(ROD, SPAN, ("y",), "mean"),
        Support(ROD, length, ("x", "y"), "mean"),
    )
    loads = tuple(SectionForce(ROD, at, (0.0, -0.5, 0.0)) for at in (0.5 * SPAN, 1.5 * SPAN))
    solution = rodmodel.solve(Scene("spans", (rod,), supports, loads, ()), level, ORDER)
    return float(solution.reaction(ROD, SPAN)[1])


def middle_reaction_reference() -> Reference:
    """Timoshenko's beam: each span is clamped by symmetry at the middle support, propped at the other.

    The prop takes (5/16 + phi/8) / (1 + phi/4) of the span's force, phi = 12 E I / (k G A l^2).
    """
    phi = 12.0 * YOUNG * SECOND_MOMENT / (SHEAR_STIFFNESS * SPAN**2)
    value = 1.0 - (5.0 / 16.0 + phi / 8.0) / (1.0 + phi / 4.0)
    # The section above a support deforms, over about a height.
    return Reference(value, 0.1 * (SIDE / SPAN) ** 2 * value)


def settled_end_moment(level: int) -> float:
    """Moment at the foot of a bar clamped at both ends, one of which is raised by 1 mm, N mm."""
    line = Line((0.0, 0.0, 0.0), (HEIGHT, 0.0, 0.0), (0.0, 1.0, 0.0))
    rod = Rod(ROD, line, Rectangle(SIDE, SIDE), STEEL, _borders(HEIGHT))
    clamps = (Clamp(ROD, "start"), Clamp(ROD, "end", (0.0, 1.0, 0.0)))
    return abs(float(rodmodel.solve(Scene("settled", (rod,), clamps, (), ()), level, ORDER).reaction(ROD, 0.0)[5]))


def settled_reference() -> Reference:
    """6 E I / (l^2 (1 + phi)) of Timoshenko's beam; its ends are clamps."""
    phi = 12.0 * YOUNG * SECOND_MOMENT / (SHEAR_STIFFNESS * HEIGHT**2)
    value = 6.0 * YOUNG * SECOND_MOMENT / (HEIGHT**2 * (1.0 + phi))
    # Each clamp stiffens as if the bar were 0.07 h shorter; the moment goes with the length squared.
    return Reference(value, 4.0 * 0.1 * SIDE / HEIGHT * value)


LONG = 30.0 / DECAY
SHORT = 2.0 / DECAY
FRAME = "Castigliano's theorem; uncertain by 0.1 h / L for each clamped or joined end"

GROUP = Group(
    "Beds, supports and joints",
    "Bars that lie on springs, on several supports or on one another. p = 6.",
    (
        Check(
            "Long beam on a bed, force in the middle",
            "Sinking under the force, β h = 0.05.",
            "closed form",
            BED,
            "mm/N",
            partial(sinking_reference, LONG),
            partial(sinking, LONG, 0.5 * LONG),
            5e-3,
            2,
        ),
        Check(
            "Long beam on a bed, bending moment",
            "One height beside the force, from the stress there.",
            "closed form",
            BED,
            "mm",
            moment_reference,
            partial(moment_under_force, LONG),
            5e-3,
            3,
        ),
        Check(
            "Long beam on a bed, force on its end",
            "Sinking under the force.",
            "closed form",
            BED,
            "mm/N",
            end_sinking_reference,
            partial(sinking, LONG, LONG),
            5e-3,
            2,
        ),
        Check(
            "Short beam on a bed, force in the middle",
            "β l = 2: the whole bar sinks.",
            "closed form",
            BED,
            "mm/N",
            partial(sinking_reference, SHORT),
            partial(sinking, SHORT, 0.5 * SHORT),
            5e-3,
            2,
        ),
        *(
            Check(
                f"Two-bar frame, force {direction}",
                shows,
                "closed form",
                FRAME,
                "mm/N",
                partial(tip_reference, force),
                partial(tip, force),
                1e-2,
                level,
            )
            for direction, shows, force, level in (
                ("down", "The beam bends, and the post with it.", (0.0, -1.0, 0.0), 2),
                ("along the beam", "The post bends, the beam rides on it.", (1.0, 0.0, 0.0), 2),
                ("across the frame", "The post twists.", (0.0, 0.0, 1.0), 4),
            )
        ),
        Check(
            "Two spans, middle support",
            "Its share of a force on each span.",
            "closed form",
            "Timoshenko's beam; uncertain by (h / l)² / 10, as sections deform at supports",
            "",
            middle_reaction_reference,
            middle_reaction,
            2e-3,
            3,
        ),
        Check(
            "Settled clamp",
            "Moment at the foot of a bar whose other clamp is raised by 1 mm.",
            "closed form",
            "Timoshenko's beam; uncertain by 0.2 h / l for each clamp",
            "N mm",
            settled_reference,
            settled_end_moment,
            1e-2,
            3,
        ),
    ),
)
