"""Why borders move: the pressure where contact ends inside an element."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import rodmodel
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import END, LEVEL, PENALTY, START, on_meshes, two_bars
from reports.stability.wording import number, share
from rodmodel.contact import unilateral_contact
from rodmodel.mesh import RodMesh, rod_mesh, split
from rodmodel.system import ContactSystem

Array = NDArray[np.float64]

# How far the border lies beyond the edge, mm
BEYOND = (0.0, 0.5, 1.0, 2.0, 4.0, 7.0, 11.0, 17.0, 25.0, 40.0)
ORDER = 8
FIXED, PLAIN, MOVED = (
    Method("fixed borders, multipliers", ours=False),
    Method("fixed borders, plain penalty", ours=False),
    Method("borders on the edge"),
)
# Drawn with the border so far beyond the edge, mm
DRAWN = 4.0
# What is compared lies so far (mm) from the corner, where the pressure is singular, and from the edge, where it is
# steep.
CLEAR = 0.8


def measure(values: tuple[float, ...]) -> Found:
    """Pressure on borders 11 mm beyond the edge, and how much it rings by where the border is."""
    best = rodmodel.solve(two_bars(), LEVEL, ORDER)
    edge = best.stretches[-1].end
    smooth = best.contact_profile("overlap")
    profiles = {MOVED.name: curve(smooth.station, smooth.middle)}
    ringing: dict[str, list[float]] = {FIXED.name: [], PLAIN.name: []}
    off: dict[str, list[float]] = {name: [] for name in ringing}
    for value in values:
        for name, penalty, multipliers in ((FIXED.name, PENALTY, True), (PLAIN.name, PENALTY, False)):
            system = _system(edge + value, penalty, multipliers=multipliers)
            force = unilateral_contact(system.problem).force
            station, pressure = _middle(system, force)
            inside = (station > START + CLEAR) & (station < edge - CLEAR)
            expected = np.interp(station, smooth.station, smooth.middle)
            largest = float(expected[inside].max())
            ringing[name].append(float(np.abs(pressure - expected)[inside].max()) / largest)
            off[name].append(abs(float(force.sum()) / float(best.force.sum()) - 1.0))
            if value == DRAWN:
                drawn = station < END - 50.0
                profiles[name] = curve(station[drawn], pressure[drawn])
    near = [(x, y) for x, y in zip(*(profiles[MOVED.name].x, profiles[MOVED.name].y), strict=True) if x < END - 50.0]
    profiles[MOVED.name] = curve(*zip(*near, strict=True))
    return {
        "profile": profiles,
        "ringing": {name: curve(np.maximum(values, 0.1), found) for name, found in ringing.items()},
        "force": {name: curve(np.maximum(values, 0.1), np.maximum(found, 1e-9)) for name, found in off.items()},
    }


def _system(border: float, penalty: float, *, multipliers: bool) -> ContactSystem:
    """The two bars with borders of both at X = border that do not move."""
    scene = two_bars(penalty=penalty)
    placed = {}
    for rod, offset in zip(scene.rods, (0.0, START), strict=True):
        own = rod_mesh(rod, LEVEL, ORDER)
        outside = (own.borders < START - offset + 1e-6) | (own.borders > END - offset - 1e-6)
        borders = own.borders[outside]
        count = len(borders) - 1
        kept = RodMesh(borders, np.full(count, LEVEL), np.full(count, ORDER))
        placed[rod.name] = split(kept, np.array([border, START, END, 366.67]) - offset)
    return on_meshes(scene, placed, multipliers=multipliers)


def _middle(system: ContactSystem, force: Array) -> tuple[Array, Array]:
    """Pressure at the contact points in the middle of the width."""
    grid = system.grids["overlap"]
    pressure = (force.reshape(grid.weight.shape) / grid.weight)[:, :, grid.middle]
    return grid.station.ravel(), pressure.ravel()


def claim(found: Found) -> str:
    """Ringing."""
    ringing, force = found["ringing"], found["force"]
    return (
        "With the border on the edge the pressure is smooth, and on fixed elements as well if that is where their "
        f"border is ({share(ringing[FIXED.name].y[0])} apart). With the border beyond the edge the same polynomials "
        "must be pressed in one part of the element and free in the other: the pressure at single points zigzags, by "
        f"up to {share(ringing[FIXED.name].largest)} of its largest value with multipliers and "
        f"{share(ringing[PLAIN.name].largest)} with plain springs of {number(PENALTY)} N/mm³. The resultant hides it: "
        f"it is off by no more than {share(force[FIXED.name].largest)}."
    )


def own_limit(found: Found) -> str:
    """Where borders cannot move."""
    ringing = found["ringing"][FIXED.name]
    return (
        f"The pressure at single points is meaningless wherever borders cannot follow the edges ({share(ringing.y[1])} "
        f"off at {ringing.x[1]:g} mm already): on crossing rods and where the search does not settle. The stretches "
        "then state how far the edge may be; trust resultants there, not pressures."
    )


def holds(found: Found) -> bool:
    """The pressure rings on fixed borders, the more the farther they are; the resultant hides it."""
    ringing, force = found["ringing"][FIXED.name], found["force"][FIXED.name]
    return ringing.largest > 0.2 and ringing.y[0] < 0.3 * ringing.largest and force.largest < 0.05


SWEEP = Sweep(
    "Edge inside an element",
    "The two cantilevers (E2 = 50 GPa) on fixed elements: the border lies up to 40 mm beyond the edge of contact "
    "instead of on it (p = 8).",
    BEYOND,
    (FIXED, PLAIN, MOVED),
    (
        Picture("profile", "Pressure, middle of the width", "X, mm", "MPa", log_x=False, log_y=False),
        Picture(
            "ringing", "Pressure off the smooth one", "border beyond the edge, mm (0 at 0.1)", "part of the largest"
        ),
        Picture("force", "Contact force", "border beyond the edge, mm (0 at 0.1)", "relative difference"),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
