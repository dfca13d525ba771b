"""Contact of the 3D reference: Hertz's line contact, and what node-to-surface costs beside its alternatives."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache
from typing import get_args

import numpy as np

import reference3d
from cases.case import Case
from cases.loader import load_case
from cases.scene import (
    ContactPair,
    Ground,
    Line,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodFace,
    RoundGap,
    Scene,
    SectionForce,
    Support,
)
from reference3d.contact import PointsOf
from reports.contact_edges import contact_stretches
from reports.truth import SOURCE, independent_values
from reports.verification.check import Check, Group, Reference, Steps
from reports.verification.solid_elements import MESHES

# Without lateral contraction a block of any width is in plane strain and in plane stress at once.
CORK = Material(1000.0, 0.0)
HALF_WIDTH, RADIUS = 1.0, 50.0  # a and R, mm
HEIGHT, LENGTH, WIDTH, ZONE = 20.0, 40.0, 2.0, 3.0
# Force per width that makes contact 2 a wide, N/mm
LINE_FORCE = math.pi * HALF_WIDTH**2 * CORK.young_modulus / (4.0 * RADIUS)
# What a block of height H is apart from a half-space, as a part
FINITE = (HALF_WIDTH / HEIGHT) ** 2
JOHNSON = "Johnson, Contact Mechanics, 1985, section 4.2(c)"

CASE, PAIR = "two-cantilevers-e20-g0", "overlap"
REFINEMENT = 2
# Where the lower bar alone has a force within the zone, mm, and its size, N: a border of elements is all it makes
WITHIN, NOTHING = 249.3, 1e-9
KINDS = get_args(PointsOf)
KIND_STEPS = Steps("contact points", lambda number: KINDS[number - 1])


def hertz_scene() -> Scene:
    """A block pressed on a rigid cylinder that lies across it, by a pressure on its top."""
    line = Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0))
    middle = 0.5 * LENGTH
    return Scene(
        "Hertz",
        (Rod("block", line, Rectangle(WIDTH, HEIGHT), CORK, (0.0, LENGTH)),),
        (Support("block", middle, ("x", "s", "turn x", "turn y", "turn s"), "mean"),),
        (Pressure(RodFace("block", "top"), 0.0, LENGTH, LINE_FORCE / LENGTH),),
        (
            ContactPair(
                "cylinder",
                RodFace("block", "bottom"),
                Ground(),
                (middle - ZONE, middle + ZONE),
                RoundGap(RADIUS, middle),
                None,
            ),
        ),
    )


@dataclass(frozen=True)
class Hertz:
    """Largest pressure, MPa, half width by the second moment of the pressure and by its edges, mm."""

    peak: float
    by_moment: float
    by_edges: float


def _hertz_reference(value: float) -> Reference:
    return Reference(value, FINITE * value)


@cache
def _hertz(refinement: int) -> Hertz:
    solution = reference3d.solve(hertz_scene(), refinement)
    profile, points = solution.contact_profile("cylinder"), solution.contact_points("cylinder")
    middle = 0.5 * LENGTH
    away = points.position[0] - middle
    ((start, end),) = contact_stretches(profile.station, profile.middle, (middle - ZONE, middle + ZONE))
    # the second moment of a semi-ellipse is a^2 / 4 of its area
    moment = 2.0 * math.sqrt(float(points.force @ away**2 / points.force.sum()))
    return Hertz(float(profile.middle.max()), moment, 0.5 * (end - start))


@dataclass(frozen=True)
class Bars:
    """What one kind of contact points says of the paper's bars.

    Attributes
    ----------
    force, centre : N, mm
    edges : start and end of contact in the middle of the width, mm; the first and last of several
    waviness : up and down of the pressure in the middle of the width over twice its largest, 1 for a single hump
    """

    force: float
    centre: float
    edges: tuple[float, float]
    waviness: float


@cache
def _case() -> Case:
    return load_case(CASE)


@cache
def bars(kind: int, within: bool) -> Bars:
    """The paper's bars, with a force within the zone or without, in contact at the points of a kind, from 1.

    Raises
    ------
    RuntimeError
        if the solution is not one.
    """
    scene = _case().scene
    if within:
        scene = replace(scene, loads=(*scene.loads, SectionForce("lower", WITHIN, (0.0, NOTHING, 0.0))))
    solution = reference3d.solve(scene, REFINEMENT, contact_of=KINDS[kind - 1])
    if solution.outcome != "converged":
        raise RuntimeError(f"contact of {KINDS[kind - 1]}: {solution.outcome}")
    points, profile = solution.contact_points(PAIR), solution.contact_profile(PAIR)
    force, pressure = float(points.force.sum()), profile.middle
    stretches = contact_stretches(profile.position[0], pressure, (200.0, 300.0))
    rises = np.abs(np.diff(pressure, prepend=0.0, append=0.0)).sum()
    return Bars(
        force,
        float(points.position[0] @ points.force) / force,
        (stretches[0][0], stretches[-1][1]),
        float(rises / (2.0 * pressure.max())),
    )


def _truth(quantity: str, entry: int = 0) -> Reference:
    case = _case()
    assert case.independent is not None  # as the library has it
    estimate = independent_values(case.independent, case.scene).estimates[quantity, PAIR]
    assert estimate.uncertainty is not None
    return Reference(float(estimate.value[entry]), estimate.uncertainty)


def _of_truth(
    name: str,
    shows: str,
    unit: str,
    reference: Callable[[], Reference],
    value: Callable[[int], float],
    tolerance: float,
) -> Check:
    """A number of the paper's bars, by kind of contact points."""
    steps = (1, 2, 3)
    return Check(name, shows, "3d converged", SOURCE, unit, reference, value, tolerance, 1, steps, steps=KIND_STEPS)


def _waviness(name: str, shows: str, within: bool) -> Check:
    return Check(
        name,
        shows,
        "closed form",
        "up and down of a single hump over twice its height",
        "",
        lambda: Reference(1.0),
        lambda kind: bars(kind, within).waviness,
        1e-2,
        1,
        (1, 2, 3),
        steps=KIND_STEPS,
    )


GROUPS = (
    Group(
        "The 3D reference: Hertz's line contact",
        "A block 20 mm high on a rigid cylinder of radius 50 mm, pressed so that contact is 2 mm wide; nu = 0, so that "
        "plane strain is exact at any width. The block is no half-space, which leaves (a / H)^2 = 0.25 % open. On the "
        "mesh that counts nodes are 0.09 a apart.",
        (
            Check(
                "Largest pressure",
                "2 F / (pi a).",
                "closed form",
                JOHNSON,
                "MPa",
                lambda: _hertz_reference(2.0 * LINE_FORCE / (math.pi * HALF_WIDTH)),
                lambda refinement: _hertz(refinement).peak,
                5e-3,
                2,
                (1, 2),
                steps=MESHES,
            ),
            Check(
                "Half width, second moment",
                "a^2 = 4 F R / (pi E) is four times the mean square distance of the pressure.",
                "closed form",
                JOHNSON,
                "mm",
                lambda: _hertz_reference(HALF_WIDTH),
                lambda refinement: _hertz(refinement).by_moment,
                1e-2,
                2,
                (1, 2),
                steps=MESHES,
            ),
            Check(
                "Half width, edges",
                "Edges are read between nodes and found no better than those are apart.",
                "closed form",
                JOHNSON,
                "mm",
                lambda: _hertz_reference(HALF_WIDTH),
                lambda refinement: _hertz(refinement).by_edges,
                0.09,
                2,
                (1, 2),
                steps=MESHES,
            ),
        ),
    ),
    Group(
        "The 3D reference: what node-to-surface contact costs",
        "The paper's bars with E2 = 20 GPa on the default mesh, in contact at the nodes of the first face (the "
        "default), of the second, or at 2 x 2 Gauss points of every element of the first with the case's penalty. "
        "A force within the zone makes a border of elements, which the other bar gets, too, so that nodes still meet "
        "nodes. Resultants do not depend on the kind of points, pressures do: those at Gauss points may jump from "
        "point to point. Where nodes cannot meet nodes, as of bars that cross, no kind is without fault: the stability "
        "page has the patch test.",
        (
            _of_truth(
                "Contact force",
                "The force is right to the error of the mesh whatever carries it.",
                "N",
                lambda: _truth("contact_force"),
                lambda kind: bars(kind, False).force,
                5e-4,
            ),
            _of_truth(
                "Centre of contact",
                "So is where it acts.",
                "mm",
                lambda: _truth("contact_centre"),
                lambda kind: bars(kind, False).centre,
                1e-4,
            ),
            _of_truth(
                "Start of contact, middle",
                "Edges follow the points.",
                "mm",
                lambda: _truth("contact_edges"),
                lambda kind: bars(kind, False).edges[0],
                2e-3,
            ),
            _of_truth(
                "End of contact, middle",
                "The same at the other end.",
                "mm",
                lambda: _truth("contact_edges", 1),
                lambda kind: bars(kind, False).edges[1],
                2e-3,
            ),
            _waviness(
                "Waviness",
                "How the pressure in the middle of the width goes up and down: once each.",
                False,
            ),
            _of_truth(
                "Contact force, a force within the zone",
                "The force is as good.",
                "N",
                lambda: _truth("contact_force"),
                lambda kind: bars(kind, True).force,
                5e-4,
            ),
            _waviness(
                "Waviness, a force within the zone",
                "So is the pressure: it would rise and fall from node to node if one bar alone had shorter elements.",
                True,
            ),
        ),
    ),
)
