"""Search for the edges of contact: element borders move until the pressure vanishes on them.

The elements of a stretch are held in contact, pulling or pushing, and the pressure in the middle of the width at the
stretch's end is driven to zero: it passes through zero smoothly and once, where the zero of the gap would creep. At
the root the contact force is stationary in the border's position.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from rodmodel.borders import Edge
from rodmodel.contact import forces_on
from rodmodel.system import ContactSystem

Array = NDArray[np.float64]

# An edge counts as found when the next step would move it by less than this, mm.
EDGE_TOLERANCE = 0.01
MOST_STEPS = 12
# First step of the search and longest step, as parts of the zone.
FIRST_STEP, LONGEST_STEP = 0.01, 0.1
# An edge that comes closer than this part of the zone to the zone's end or to the stretch's other end is gone.
SHORTEST = 2e-3


@dataclass(frozen=True)
class Stretch:
    """A part of a zone in contact, mm along the first rod."""

    pair: str
    start: float
    end: float


def stretches_in_contact(system: ContactSystem, force: Array) -> tuple[Stretch, ...]:
    """Stretches closed in the middle of the width, each end half way between a closed and an open station.

    Openings shorter than an element are not believed: a mesh whose borders are not on the edges shows such ripples.
    """
    stretches = []
    for pair, grid in system.grids.items():
        station, length = grid.station.ravel(), np.repeat(np.diff(grid.borders), grid.station.shape[1])
        closed = np.flatnonzero(force[system.points[pair]].reshape(grid.weight.shape)[:, :, grid.middle] > 0.0)
        opening = np.diff(station[closed]) >= length[closed[1:]]
        for run in np.split(closed, np.flatnonzero(opening) + 1) if len(closed) else []:
            before, after = max(run[0] - 1, 0), min(run[-1] + 1, len(station) - 1)
            start, end = 0.5 * (station[run[0]] + station[before]), 0.5 * (station[run[-1]] + station[after])
            stretches.append(Stretch(pair, *_snapped(system.scene, pair, float(start), float(end))))
    return tuple(stretches)


def _snapped(scene: Scene, pair: str, start: float, end: float) -> tuple[float, float]:
    """Ends next to the zone's end lie on it."""
    low, high = scene.contact(pair).zone
    margin = SHORTEST * (high - low)
    return low if start < low + margin else start, high if end > high - margin else end


def moving_edges(scene: Scene, stretches: Sequence[Stretch]) -> tuple[tuple[Edge, ...], Array]:
    """Ends of stretches that lie inside their zone, and where (mm along the first rod)."""
    found = [
        (Edge(stretch.pair, number, outward), position)
        for number, stretch in enumerate(stretches)
        for outward, position in ((-1, stretch.start), (1, stretch.end))
        if position not in scene.contact(stretch.pair).zone
    ]
    return tuple(edge for edge, _ in found), np.array([position for _, position in found])


def moved(stretches: Sequence[Stretch], edges: Sequence[Edge], positions: Array) -> tuple[Stretch, ...]:
    """The stretches with their moving ends at `positions`."""
    result = list(stretches)
    for edge, position in zip(edges, positions, strict=True):
        stretch, end = result[edge.stretch], float(position)
        result[edge.stretch] = replace(stretch, start=end) if edge.outward < 0 else replace(stretch, end=end)
    return tuple(result)


def edge_pressures(system: ContactSystem, stretches: Sequence[Stretch], edges: Sequence[Edge]) -> Array:
    """Pressure in the middle of the width at each edge while the stretches are held, pulling or pushing, MPa."""
    held = np.zeros(len(system.spring), dtype=bool)
    for stretch in stretches:
        grid = system.grids[stretch.pair]
        middles = 0.5 * (grid.borders[:-1] + grid.borders[1:])
        inside = (middles > stretch.start) & (middles < stretch.end)
        part = held[system.points[stretch.pair]].reshape(grid.weight.shape)
        part[inside] = True
    force = forces_on(held, system.compliance, system.initial_gap, system.spring)
    pressures = np.empty(len(edges))
    for number, edge in enumerate(edges):
        grid, stretch = system.grids[edge.pair], stretches[edge.stretch]
        pressure = force[system.points[edge.pair]].reshape(grid.weight.shape) / grid.weight
        border = stretch.end if edge.outward > 0 else stretch.start
        nearest = int(np.abs(grid.borders - border).argmin())
        pressures[number] = (
            pressure[nearest - 1, -1, grid.middle] if edge.outward > 0 else pressure[nearest, 0, grid.middle]
        )
    return pressures


@dataclass(frozen=True, eq=False)
class EdgeSearch:
    """Record of a search.

    Attributes
    ----------
    outcome : 'converged', 'stagnated', or 'topology': an edge ran into the zone's end or into another
    positions : last position of every edge, mm along its pair's first rod, shape (n_edges,)
    steps : every position tried, shape (n_solutions, n_edges)
    system : contact system with the borders at `positions`
    """

    outcome: str
    positions: Array
    steps: Array
    system: ContactSystem


def find_edges(
    scene: Scene,
    stretches: Sequence[Stretch],
    edges: Sequence[Edge],
    positions: Array,
    system_at: Callable[[Array], ContactSystem],
) -> EdgeSearch:
    """Roots of the edge pressures in the edge positions, all at once, by Broyden's method (a secant for one edge).

    Parameters
    ----------
    positions : first guess, mm, shape (n_edges,)
    system_at : makes the contact system with the borders at given positions
    """
    outward = np.array([edge.outward for edge in edges])
    zones = np.array([scene.contact(edge.pair).zone for edge in edges])
    size = zones[:, 1] - zones[:, 0]
    tried: list[Array] = []

    def residual(at: Array) -> tuple[Array, ContactSystem]:
        tried.append(at)
        system = system_at(at)
        return edge_pressures(system, moved(stretches, edges, at), edges), system

    value, system = residual(positions)
    # Positive pressure at an edge: contact goes on beyond it.
    step = outward * np.sign(value) * FIRST_STEP * size
    jacobian: Array | None = None
    outcome = "stagnated"
    while len(tried) < MOST_STEPS:
        new = positions + np.clip(step, -LONGEST_STEP * size, LONGEST_STEP * size)
        if _out_of_place(scene, moved(stretches, edges, new)):
            outcome = "topology"
            break
        new_value, system = residual(new)
        change, difference = new - positions, new_value - value
        if jacobian is None:
            jacobian = np.diag(difference / change)
        else:
            jacobian = jacobian + np.outer(difference - jacobian @ change, change) / (change @ change)
        positions, value = new, new_value
        step = -np.linalg.solve(jacobian, value)
        if np.abs(step).max() < EDGE_TOLERANCE:
            outcome = "converged"
            break
    return EdgeSearch(outcome, positions, np.array(tried), system)


def same_topology(some: Sequence[Stretch], others: Sequence[Stretch]) -> bool:
    """Whether both tell of the same stretches, with ends in about the same places."""
    return len(some) == len(others) and all(
        a.pair == b.pair and a.start < b.end and b.start < a.end for a, b in zip(some, others, strict=True)
    )


def _out_of_place(scene: Scene, stretches: Sequence[Stretch]) -> bool:
    """Whether a stretch has vanished, left its zone or run into the next one."""
    for stretch in stretches:
        low, high = scene.contact(stretch.pair).zone
        margin = SHORTEST * (high - low)
        inside = low <= stretch.start and stretch.end <= high
        near = low < stretch.start < low + margin or high - margin < stretch.end < high
        if not inside or near or stretch.end - stretch.start < margin:
            return True
    return any(a.pair == b.pair and a.end >= b.start for a, b in pairwise(stretches))
