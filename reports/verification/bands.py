"""Whether the bands of uncertainty hold: of many quantities on many triples of meshes, how many bands hold the limit.

The limit is extrapolated from the finest three meshes, and every coarser three consecutive ones must hold it.
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

import reference3d
from cases.scene import Circle, Clamp, ContactPair, Line, Material, Rectangle, Rod, RodFace, Scene, SectionForce
from reports.quantities import Quantities, evaluate
from reports.verification.bending import cantilever
from reports.verification.check import Check, Group, Reference, Steps
from reports.verification.scenes import STEEL, clamped, end_force, straight

Array = NDArray[np.float64]

LENGTH, SIDE, OVERLAP = 45.0, 15.0, 20.0
# Entries smaller than this part of the largest of their kind, and changes smaller than this, are round-off.
SMALL, EXACT = 1e-6, 1e-9


def _short_bars() -> Scene:
    """Two stout cantilevers of 200 and 50 GPa, the upper one pushed down on the lower one."""
    up, section = (0.0, 1.0, 0.0), Rectangle(SIDE, SIDE)
    lower = Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), up)
    upper = Line((LENGTH - OVERLAP, SIDE, 0.0), (2.0 * LENGTH - OVERLAP, SIDE, 0.0), up)
    return Scene(
        "short bars",
        (
            Rod("lower", lower, section, STEEL, (0.0, LENGTH)),
            Rod("upper", upper, section, Material(50e3, 0.3), (0.0, LENGTH)),
        ),
        (Clamp("lower", "start"), Clamp("upper", "end")),
        (SectionForce("upper", OVERLAP, (0.0, -1000.0, 0.0)),),
        (
            ContactPair(
                "overlap", RodFace("lower", "top"), RodFace("upper", "bottom"), (LENGTH - OVERLAP, LENGTH), 0.0, None
            ),
        ),
    )


def _round_bar() -> Scene:
    """A stout cantilever of circular section."""
    line = straight(LENGTH)
    return clamped(line, Circle(SIDE), STEEL, SIDE, 2, end_force(line, (0.0, -100.0, 0.0)))


SCENES = (("cantilever", cantilever(LENGTH, STEEL), 4), ("two bars", _short_bars(), 4), ("round bar", _round_bar(), 4))
ALL = len(SCENES) + 1
BY_SCENE = Steps("scene", lambda number: "all" if number == ALL else SCENES[number - 1][0])
KINDS = ("displacements", "resultants of stress", "reactions, energy")


def _values(quantities: Quantities) -> Iterator[tuple[str, Array]]:
    """Numbers by kind; numbers of one array have one scale."""
    for rod in quantities.rods:
        inside = slice(1, -1, 3)
        yield KINDS[0], rod.displacement[:, inside].ravel()
        for rows in (slice(0, 3), slice(3, 6)):
            yield KINDS[1], rod.stress[rows, inside].ravel()
    for reaction in quantities.reactions.values():
        yield KINDS[2], reaction[:3]
        yield KINDS[2], reaction[3:]
    for contact in quantities.contacts:
        yield KINDS[2], np.array([contact.force])
    yield KINDS[2], np.array([quantities.strain_energy])


@cache
def _held(number: int) -> dict[str, tuple[int, int]]:
    """By kind: how many bands hold the limit, about the finest value and about the extrapolated one, and of how many.

    number : of the scene, from 1
    """
    _, scene, finest = SCENES[number - 1]
    solutions = [reference3d.solve(scene, refinement) for refinement in range(1, finest + 1)]
    sizes = [solution.representative_size for solution in solutions]
    order = reference3d.formal_order(scene)
    counts = dict.fromkeys(KINDS, (0, 0))

    def band(values: Array, first: int) -> reference3d.GridConvergence:
        coarse, medium, fine = values[first : first + 3].tolist()
        large, middle, small = sizes[first : first + 3]
        return reference3d.grid_convergence((coarse, medium, fine), (large, middle, small), order)

    for entries in zip(*(_values(evaluate(solution)) for solution in solutions), strict=True):
        kind, scale = entries[0][0], float(np.abs(entries[-1][1]).max())
        for values in np.stack([found for _, found in entries], axis=1):
            if abs(values[-1]) <= SMALL * scale or np.ptp(values) <= EXACT * scale:
                continue
            limit = band(values, finest - 3).extrapolated
            for first in range(finest - 3):
                found = band(values, first)
                apart = max(abs(found.value - limit), abs(found.extrapolated - limit))
                held, of = counts[kind]
                counts[kind] = held + (apart <= found.uncertainty + EXACT * scale), of + 1
    return counts


def share(kinds: tuple[str, ...], scene: int) -> float:
    """Part of the bands of some kinds that hold the limit, in one scene or in all."""
    numbers = range(1, ALL) if scene == ALL else (scene,)
    counts = [_held(number)[kind] for number in numbers for kind in kinds]
    return sum(held for held, _ in counts) / sum(of for _, of in counts)


def _check(name: str, shows: str, kinds: tuple[str, ...], tolerance: float) -> Check:
    return Check(
        f"Bands of {name}",
        shows,
        "3d converged",
        "the finest three meshes of this run",
        "",
        lambda: Reference(1.0),
        partial(share, kinds),
        tolerance,
        ALL,
        tuple(range(1, ALL + 1)),
        steps=BY_SCENE,
    )


GROUP = Group(
    "The 3D reference: bands that hold",
    "Three meshes give each quantity a band of uncertainty. Here are a few hundred quantities of three scenes on all "
    "triples of consecutive meshes but the finest three, whose extrapolated value is the limit, with no allowance for "
    "how uncertain that is itself. Cells are how many bands miss it, about the finest value or about the extrapolated "
    "one: -1 % means that 99 of 100 hold it. Bands are meant to hold in 95 of 100.",
    (
        _check("all quantities", "What a band of 95 % promises.", KINDS, 0.05),
        *(_check(kind, "No kind falls far below; of few, one that misses is much.", (kind,), 0.15) for kind in KINDS),
    ),
)
