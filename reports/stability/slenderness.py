"""Slenderness: shear locking of straight rods, membrane locking of curved ones, and digits lost by many elements."""

from __future__ import annotations

import math

import numpy as np

import rodmodel
from cases.scene import CentreLine, Clamp, Material, Rectangle, Rod, Scene
from reports.stability import plain_beams, plain_rods
from reports.stability.sweep import Curve, Found, Method, Picture, Sweep, curve
from reports.stability.wording import number, share
from reports.verification.bending import cowper_coefficient
from reports.verification.scenes import ROD, STEEL, WITHOUT_CONTRACTION, arc, end_force, straight
from rodmodel.section import STRAIGHT, Fields, section_stiffness
from rodmodel.soundness import WORTH_A_WARNING, lost_accuracy

SIDE = 10.0
SECTION = Rectangle(SIDE, SIDE)
AREA, SECOND_MOMENT = SIDE**2, SIDE**4 / 12.0
BENDING, STRETCHING = STEEL.young_modulus * SECOND_MOMENT, STEEL.young_modulus * AREA
SHEARING = STRETCHING / (2.0 * (1.0 + STEEL.poisson_ratio))
PLAIN_ELEMENTS, ELEMENTS, ORDER = 16, 4, 6
ORDERS = (2, 3, 4, 6)
SLENDERNESSES = (2.0, 5.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 1e4)
# Of the rod that is cut into ever more elements
LONG = 1e4 * 2.0 / 3.0
COUNTS = (1, 10, 100, 1000, 10_000)

TWO_NODES = Method("two-node beam, 16 elements", ours=False)
LINEAR = Method("h2, p = 1, 16 elements", ours=False)
FULL = Method("h1 with the full law, p = 6", ours=False)
LEVELS = tuple(Method(f"h{level}, p = 6") for level in (1, 2, 5))
RING_TWO_NODES = Method("two-node arc, 16 elements", ours=False)
RINGS = tuple(Method(f"h2, p = {order}, {ELEMENTS} elements") for order in ORDERS)
SHORT_ENDS = Method("h2, p = 6, with elements of 0.2 h")
MEASURED, TOLD = Method("error of the deflection"), Method("what the solution tells")


def timoshenko(length: float) -> float:
    """F L^3 / (3 E I) + F L / (k G A) per unit force, k by Cowper, mm/N."""
    return length**3 / (3.0 * BENDING) + length / (cowper_coefficient(STEEL.poisson_ratio) * SHEARING)


def castigliano(radius: float) -> float:
    """Deflection of a quarter ring's end along the radius there, per unit force, mm/N.

    pi / 4 (R^2 / (A E e) - R / (A E) + 1.2 R / (A G)): Winkler's and Bach's eccentricity e, by its series in h / R
    where the closed form loses its digits.
    """
    ratio = SIDE / radius
    eccentric = radius - SIDE / math.log((2.0 + ratio) / (2.0 - ratio))
    if ratio < 0.05:
        eccentric = radius * (ratio**2 / 12.0 + ratio**4 / 180.0)
    return 0.25 * math.pi * radius * (radius / eccentric / STRETCHING - 1.0 / STRETCHING + 1.2 / SHEARING)


def solved(
    line: CentreLine, material: Material, borders: tuple[float, ...], level: int, order: int
) -> tuple[float, float]:
    """Deflection of a cantilever's end along Y per unit force, mm/N, and the accuracy that it says it lost."""
    rod = Rod(ROD, line, SECTION, material, borders)
    scene = Scene("slender", (rod,), (Clamp(ROD, "start"),), end_force(line, (0.0, 1.0, 0.0)), ())
    found = rodmodel.solve(scene, level, order)
    lost = lost_accuracy(found.system.rods[ROD], found.states[ROD].coefficients)
    return float(found.displacement(ROD, np.array([line.length]))[1, 0]), lost


def equal(length: float, elements: int) -> tuple[float, ...]:
    """Borders of equal elements."""
    return tuple(np.linspace(0.0, length, elements + 1).tolist())


def measure(values: tuple[float, ...]) -> Found:
    """Errors of deflections, straight and curved, and of the slenderest rod by its number of elements."""
    errors: dict[str, list[float]] = {method.name: [] for method in (TWO_NODES, LINEAR, FULL, *LEVELS)}
    rings: dict[str, list[float]] = {method.name: [] for method in (RING_TWO_NODES, *RINGS, SHORT_ENDS)}
    one, two = Fields(1, mirror_x=True), Fields(2, mirror_x=True)
    for value in values:
        length = value * SIDE
        found = [
            plain_beams.end_deflection(length, math.inf, BENDING, STRETCHING, 5.0 / 6.0 * SHEARING, PLAIN_ELEMENTS),
            plain_rods.end_deflection(
                section_stiffness(SECTION, STEEL, two, STRAIGHT), two, 1, np.linspace(0.0, length, PLAIN_ELEMENTS + 1)
            ),
            plain_rods.end_deflection(
                plain_rods.full_law(SECTION, STEEL, one), one, ORDER, np.linspace(0.0, length, ELEMENTS + 1)
            ),
            *(solved(straight(length), STEEL, equal(length, ELEMENTS), level, ORDER)[0] for level in (1, 2, 5)),
        ]
        for name, deflection in zip(errors, found, strict=True):
            errors[name].append(abs(deflection / timoshenko(length) - 1.0))
        line = arc(length, 0.5 * math.pi)
        plain = plain_beams.end_deflection(
            line.length, length, BENDING, STRETCHING, 5.0 / 6.0 * SHEARING, PLAIN_ELEMENTS
        )
        ours = [solved(line, STEEL, equal(line.length, ELEMENTS), 2, order)[0] for order in ORDERS]
        short = solved(line, STEEL, short_ends(line.length), 2, ORDER)[0]
        for name, deflection in zip(rings, (plain, *ours, short), strict=True):
            rings[name].append(abs(deflection / castigliano(length) - 1.0))
    lost = [_lost(count) for count in COUNTS if len(values) > 3 or count <= 1000]
    counts = COUNTS[: len(lost)]
    return {
        "straight": {name: curve(values, found) for name, found in errors.items()},
        "arc": {name: curve(values, found) for name, found in rings.items()},
        "elements": {
            MEASURED.name: curve(counts, (error for error, _ in lost)),
            TOLD.name: curve(counts, (told for _, told in lost)),
        },
    }


def short_ends(length: float) -> tuple[float, ...]:
    """Equal elements with one of 0.2 h at either end."""
    return (0.0, 0.2 * SIDE, *equal(length, ELEMENTS)[1:-1], length - 0.2 * SIDE, length)


def _lost(count: int) -> tuple[float, float]:
    """Error of the deflection of a rod of so many elements without contraction, whose closed form is exact."""
    length = LONG * SIDE
    exact = length**3 / (3.0 * BENDING) + 1.2 * length / (0.5 * STRETCHING)
    deflection, told = solved(straight(length), WITHOUT_CONTRACTION, equal(length, count), 2, 4)
    return abs(deflection / exact - 1.0), told


def _last(found: Curve) -> float:
    return found.y[-1]


def claim(found: Found) -> str:
    """Who locks, and who does not."""
    beams, rings = found["straight"], found["arc"]
    two_nodes, linear, full, one, two, five = (
        share(_last(beams[each.name])) for each in (TWO_NODES, LINEAR, FULL, *LEVELS)
    )
    second, third = (share(_last(rings[each.name])) for each in RINGS[:2])
    higher = share(max(_last(rings[each.name]) for each in RINGS[2:]))
    slender = number(beams[TWO_NODES.name].x[-1])
    return (
        f"At L / h = {slender} the two-node beam has lost {two_nodes} of its deflection (the rod model at order 1: "
        f"{linear}); h1 with the full law loses {full} at any slenderness (Poisson locking). h1 with its reduced law "
        f"is off by {one}, h2 by {two}, h5 by {five}. On the arc order 2 locks as well ({second} at R / h = "
        f"{slender}), order 3 is off by {third}; orders 4 and 6 stay within {higher} of Castigliano's theorem."
    )


def own_limit(found: Found) -> str:
    """Orders 2 and 3 on slender arcs; short elements and many elements lose digits."""
    lost, told = found["elements"][MEASURED.name], found["elements"][TOLD.name]
    clamp = found["straight"][LEVELS[-1].name]
    return (
        "Order 2 on slender arcs is no good. A long element at a clamp keeps the section from contracting over all "
        f"its length: {share(_last(clamp))} too stiff with four equal ones, at any slenderness. Elements of 0.2 h "
        f"there cure that, but digits run out: they make the arc of R / h = {number(clamp.x[-1])} wrong by "
        f"{share(_last(found['arc'][SHORT_ENDS.name]))}, and the rod of L / h = {LONG:.0f} is off by "
        f"{share(lost.y[-1])} on {number(lost.x[-1])} elements, as short elements are stiffer than the rod by about "
        "the cube of the ratio of lengths. The solution can tell: put through the stiffness and back "
        f"(rodmodel.soundness), its displacements are off by {share(told.y[-1])}. From {share(WORTH_A_WARNING)} on "
        "that is worth a warning."
    )


def holds(found: Found) -> bool:
    """The plain ones lock, ours do not where their order suffices, and what the solution tells is what it lost."""
    beams, rings = found["straight"], found["arc"]
    locked = all(_last(curve_) > 0.2 for curve_ in (beams[TWO_NODES.name], beams[LINEAR.name], beams[FULL.name]))
    locked = locked and all(_last(rings[name]) > 0.2 for name in (RING_TWO_NODES.name, RINGS[0].name))
    # Equal elements are not fine enough at the clamp for more.
    free = all(_last(beams[each.name]) < 0.02 for each in LEVELS)
    free = free and all(_last(rings[each.name]) < 0.02 for each in RINGS[2:])
    lost, told = found["elements"][MEASURED.name], found["elements"][TOLD.name]
    felt = [(one, other) for one, other in zip(lost.y, told.y, strict=True) if one > WORTH_A_WARNING]
    return locked and free and bool(felt) and all(0.1 < other / one < 10.0 for one, other in felt)


SWEEP = Sweep(
    "Slenderness",
    "A cantilever and a quarter ring of square section, clamped at one end, force across the other: length or radius "
    "over height from 2 to 10 000, nu = 0.3, against Timoshenko's beam and Castigliano's theorem, which leave out the "
    "clamp (about 0.1 h / L).",
    SLENDERNESSES,
    (TWO_NODES, LINEAR, FULL, *LEVELS, RING_TWO_NODES, *RINGS, SHORT_ENDS, MEASURED, TOLD),
    (
        Picture("straight", "Straight: shear locking", "L / h", "error of the deflection"),
        Picture("arc", "Quarter ring: membrane locking", "R / h", "error of the deflection"),
        Picture("elements", "Digits lost at L / h = 6667, nu = 0, h2, p = 4", "elements", "relative error"),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
