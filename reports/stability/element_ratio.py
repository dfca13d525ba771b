"""Very short elements beside long ones."""

from __future__ import annotations

import numpy as np

import rodmodel
from cases.scene import Clamp, Rectangle, Rod, Scene
from reports.stability.plain_beams import cubic_end_deflection
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import LEVEL, ORDER, START, on_meshes, two_bars
from reports.stability.wording import number, share
from reports.verification.scenes import ROD, WITHOUT_CONTRACTION, end_force, straight
from rodmodel.contact import unilateral_contact
from rodmodel.mesh import rod_mesh, split
from rodmodel.soundness import WORTH_A_WARNING, lost_accuracy

RATIOS = (3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 3000.0, 1e4)
LENGTH, SIDE = 300.0, 15.0
ELEMENTS = 6
# Least error that is drawn: half a unit of the last digit.
EXACT = 1e-16
CUBIC = Method("cubic beam elements, every other short", ours=False)
MOVED = Method("deflection, one short element")
ALL = Method("deflection, every other element short")
TOLD = Method("what the solution tells, every other")
FORCE = Method("contact force, short element in the zone")


def measure(values: tuple[float, ...]) -> Found:
    """Changes of deflection and contact force against elements of like lengths, and what the solution tells."""
    single, several, told, forces, cubic = [], [], [], [], []
    exact = LENGTH**3 / 3.0
    reference = _deflection(_alternating(1.0))[0]
    plain = _contact_force(1.0)
    one = _deflection(_one_short(1.0))[0]
    for value in values:
        cubic.append(max(abs(cubic_end_deflection(np.array(_alternating(value)), 1.0) / exact - 1.0), EXACT))
        single.append(abs(_deflection(_one_short(value))[0] / one - 1.0))
        deflection, lost = _deflection(_alternating(value))
        several.append(abs(deflection / reference - 1.0))
        told.append(lost)
        forces.append(abs(_contact_force(value) / plain - 1.0))
    found = {CUBIC.name: cubic, MOVED.name: single, ALL.name: several, TOLD.name: told, FORCE.name: forces}
    return {"change": {name: curve(values, changes) for name, changes in found.items()}}


def _one_short(ratio: float) -> tuple[float, ...]:
    """Equal elements, one of which has a piece cut off that is shorter than the rest of it by the ratio."""
    borders = np.linspace(0.0, LENGTH, ELEMENTS + 1)
    cut = borders[3] + (borders[4] - borders[3]) / (1.0 + ratio)
    return tuple(sorted([*borders.tolist(), float(cut)]))


def _alternating(ratio: float) -> tuple[float, ...]:
    """Equal elements, each of which has such a piece cut off."""
    borders = np.linspace(0.0, LENGTH, ELEMENTS + 1)
    cuts = borders[:-1] + np.diff(borders) / (1.0 + ratio)
    return tuple(np.sort(np.concatenate([borders, cuts])).tolist())


def _deflection(borders: tuple[float, ...]) -> tuple[float, float]:
    """Deflection of a cantilever per unit force without contraction, and the accuracy that it says it lost."""
    line = straight(LENGTH)
    rod = Rod(ROD, line, Rectangle(SIDE, SIDE), WITHOUT_CONTRACTION, borders)
    scene = Scene("short elements", (rod,), (Clamp(ROD, "start"),), end_force(line, (0.0, 1.0, 0.0)), ())
    found = rodmodel.solve(scene, LEVEL, 6)
    lost = lost_accuracy(found.system.rods[ROD], found.states[ROD].coefficients)
    return float(found.displacement(ROD, np.array([LENGTH]))[1, 0]), lost


def _contact_force(ratio: float) -> float:
    """Contact force of the two cantilevers with a short element on either bar beside the edge, borders fixed."""
    scene = two_bars()
    at = 222.12
    cut = at + 10.0 / ratio
    placed = {}
    for rod, offset in zip(scene.rods, (0.0, START), strict=True):
        placed[rod.name] = split(rod_mesh(rod, LEVEL, ORDER), np.array([at, cut, at + 11.0, 266.67, 300.0]) - offset)
        placed[rod.name] = split(placed[rod.name], np.array([200.0, 366.67]) - offset)
    return float(unilateral_contact(on_meshes(scene, placed).problem).force.sum())


def claim(found: Found) -> str:
    """Short elements do no harm until digits run out."""
    change = found["change"]
    worst = change[MOVED.name].x[-1]
    return (
        f"One element {number(worst)} times shorter than its neighbour changes the deflection by "
        f"{share(change[MOVED.name].y[-1])} and, beside the edge of contact, the contact force by "
        f"{share(change[FORCE.name].y[-1])}. With one beside each of the {ELEMENTS} elements the deflection changes by "
        f"{share(change[ALL.name].y[-1])}, and by {share(change[ALL.name].y[0])} at a ratio of "
        f"{number(change[ALL.name].x[0])} already: more elements are better, and short ones do no harm. The textbook's "
        f"cubic beam elements, exact on any mesh in exact arithmetic, are off by {share(change[CUBIC.name].y[-1])} on "
        "the same borders: their deflections and slopes must cancel to what bends."
    )


def own_limit(found: Found) -> str:
    """Digits."""
    change = found["change"]
    return (
        f"Short elements cost digits, here up to {share(change[TOLD.name].largest)} as the solution itself tells "
        f"(rodmodel.soundness), far below the {share(WORTH_A_WARNING)} from which on a warning is due. In slender rods "
        "it is more: see the first sweep."
    )


def holds(found: Found) -> bool:
    """Nothing changes by more than a warning is due for, unless the solution tells so."""
    change = found["change"]
    quiet = change[MOVED.name].largest < 1e-4 and change[FORCE.name].largest < 1e-3
    pairs = zip(change[ALL.name].y, change[TOLD.name].y, strict=True)
    lossy = change[CUBIC.name].y[-1] > 10.0 * change[TOLD.name].y[-1]
    return lossy and quiet and all(moved < max(WORTH_A_WARNING, 10.0 * told) for moved, told in pairs)


SWEEP = Sweep(
    "Element lengths",
    "A cantilever of 300 mm, nu = 0, and the paper's two cantilevers: neighbouring elements differ in length by up to "
    "10 000 times.",
    RATIOS,
    (CUBIC, MOVED, ALL, TOLD, FORCE),
    (Picture("change", "Change by short elements", "ratio of neighbouring lengths", "relative"),),
    measure,
    claim,
    own_limit,
    holds,
)
