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
BoolArray = NDArray[np.bool_]

# An edge counts as found when the next step would move it by less than this, mm.
EDGE_TOLERANCE = 0.01
MOST_STEPS = 12
# First step of the search and longest step, as parts of the zone.
FIRST_STEP, LONGEST_STEP = 0.01, 0.1
# Shortest stretch as a part of the zone: contact that wants less is contact at a corner or a point, and its edges are
# known to that length. An edge as close to the zone's end is on it.
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
        station = grid.station.ravel()
        length = np.repeat(grid.station[:, -1] - grid.station[:, 0], grid.station.shape[1])
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
        middles = 0.5 * (grid.station[:, 0] + grid.station[:, -1])
        inside = (middles > stretch.start) & (middles < stretch.end)
        part = held[system.points[stretch.pair]].reshape(grid.weight.shape)
        part[inside] = True
    force = forces_on(held, system.compliance, system.initial_gap, system.spring)
    pressures = np.empty(len(edges))
    for number, edge in enumerate(edges):
        grid, stretch = system.grids[edge.pair], stretches[edge.stretch]
        pressure = force[system.points[edge.pair]].reshape(grid.weight.shape) / grid.weight
        side, border = (-1, stretch.end) if edge.outward > 0 else (0, stretch.start)
        interval = int(np.abs(grid.station[:, side] - border).argmin())
        pressures[number] = pressure[interval, side, grid.middle]
    return pressures


@dataclass(frozen=True, eq=False)
class EdgeSearch:
    """Record of a search.

    Attributes
    ----------
    outcome : 'converged', 'stagnated', or 'topology': an edge ran into the zone's end or into another stretch
    positions : last position of every edge, mm along its pair's first rod, shape (n_edges,)
    steps : every position tried, shape (n_solutions, n_edges)
    """

    outcome: str
    positions: Array
    steps: Array


def find_edges(
    scene: Scene,
    stretches: Sequence[Stretch],
    edges: Sequence[Edge],
    positions: Array,
    system_at: Callable[[Array], ContactSystem],
) -> EdgeSearch:
    """Roots of the edge pressures in the edge positions, all at once.

    Each edge makes a first step alone, which gives its column of the Jacobian; from there on Broyden's method. A single
    edge is found by inverse quadratic interpolation (as in Brent's method), kept between what its signs have shown.

    Parameters
    ----------
    positions : first guess, mm, shape (n_edges,)
    system_at : makes a contact system, with points in the stretches at least, with the borders at given positions
    """
    outward = np.array([edge.outward for edge in edges])
    zones = np.array([scene.contact(edge.pair).zone for edge in edges])
    longest = LONGEST_STEP * (zones[:, 1] - zones[:, 0])
    tried: list[Array] = []
    values: list[Array] = []

    def residual(at: Array) -> Array:
        tried.append(at)
        values.append(edge_pressures(system_at(at), moved(stretches, edges, at), edges))
        return values[-1]

    positions = _not_too_short(scene, stretches, edges, positions)
    value = residual(positions)
    jacobian = np.zeros((len(edges), len(edges)))
    bracket = Bracket().tightened(outward[0] * positions[0], value[0])
    outcome = "stagnated"
    while len(tried) < MOST_STEPS:
        retreat = _retreats(moved(stretches, edges, positions), edges)
        first = len(tried) - 1
        if first < len(edges):
            # Positive pressure at an edge: contact goes on beyond it.
            step = np.zeros(len(edges))
            step[first] = FIRST_STEP / LONGEST_STEP * longest[first] * np.sign(value[first])
        elif len(edges) == 1:
            step = outward * (_interpolated_root(tried[-3:], values[-3:]) - positions)
        else:
            step = outward * _newton_step(jacobian, value, _at_shortest(scene, stretches, edges, positions))
        if len(edges) == 1:
            step = bracket.safe(outward * positions, value, step, longest, retreat)
        new = positions + outward * np.clip(step, -retreat, longest)
        new = _not_too_short(scene, stretches, edges, new)
        if _out_of_place(scene, moved(stretches, edges, new)):
            outcome = "topology"
            break
        change = new - positions
        if np.abs(change).max() < EDGE_TOLERANCE and first >= len(edges):
            outcome = "converged"
            break
        new_value = residual(new)
        if change.any():
            jacobian = jacobian + np.outer(new_value - value - jacobian @ change, change) / (change @ change)
        positions, value = new, new_value
        bracket = bracket.tightened(outward[0] * positions[0], value[0])
    return EdgeSearch(outcome, positions, np.array(tried))


def _newton_step(jacobian: Array, value: Array, at_shortest: BoolArray) -> Array:
    """-J^-1 value for the edges that are free to move: not those of a stretch that cannot shrink any further."""
    free = ~(at_shortest & (value < 0.0))
    step = np.zeros_like(value)
    # Least squares: an edge that has not moved yet has an empty column and stays.
    step[free] = -np.linalg.lstsq(jacobian[np.ix_(free, free)], value[free])[0]
    return step


def _interpolated_root(positions: Sequence[Array], values: Sequence[Array]) -> Array:
    """Where the polynomial through position over value has value zero; the last position where values coincide."""
    value = np.concatenate(values)
    if len(np.unique(value)) < len(value):
        return positions[-1]
    # Lagrange's formula at zero.
    weights = [np.prod(others / (others - own)) for own, others in ((v, value[value != v]) for v in value)]
    return np.atleast_1d(np.dot(weights, np.concatenate(positions)))


@dataclass(frozen=True)
class Bracket:
    """What the signs seen so far say of a single edge, in a coordinate that grows out of contact.

    The pressure at an edge need not fall steadily: on a stretch much too short the held elements pull like a clamp. So
    a step is believed only where it goes the way that the sign asks for, and stays within what is known.

    Attributes
    ----------
    inner, outer : last position with positive and first with negative pressure, mm
    """

    inner: float = -np.inf
    outer: float = np.inf

    def tightened(self, position: float, value: float) -> Bracket:
        """The bracket with one more pressure known."""
        return replace(self, inner=position) if value > 0.0 else replace(self, outer=position)

    def safe(self, position: Array, value: Array, step: Array, longest: Array, retreat: Array) -> Array:
        """The step where it can be believed, else to the middle of the bracket, else far the way the sign asks for.

        longest, retreat : largest steps outward and inward, mm
        """
        target = position[0] + step[0]
        if step[0] * value[0] >= 0.0 and self.inner <= target <= self.outer:
            return step
        if np.isfinite(self.outer - self.inner):
            return np.array([0.5 * (self.inner + self.outer) - position[0]])
        return longest if value[0] > 0.0 else -retreat


def _retreats(stretches: Sequence[Stretch], edges: Sequence[Edge]) -> Array:
    """How far each edge may go inward at once: a quarter of the stretch, all of it where the other end is held.

    A stretch with one held end that wants to be shorter than it looks mostly wants to be a corner.
    """
    counts = [sum(other.stretch == edge.stretch for other in edges) for edge in edges]
    lengths = [stretches[edge.stretch].end - stretches[edge.stretch].start for edge in edges]
    return np.array([length * (1.0 if count == 1 else 0.25) for length, count in zip(lengths, counts, strict=True)])


def _at_shortest(scene: Scene, stretches: Sequence[Stretch], edges: Sequence[Edge], positions: Array) -> BoolArray:
    """Edges of stretches that have the shortest length."""
    current = moved(stretches, edges, positions)
    shortest = [_shortest(scene, stretch) for stretch in current]
    return np.array(
        [
            current[edge.stretch].end - current[edge.stretch].start < (1.0 + 1e-6) * shortest[edge.stretch]
            for edge in edges
        ]
    )


def _shortest(scene: Scene, stretch: Stretch) -> float:
    low, high = scene.contact(stretch.pair).zone
    return SHORTEST * (high - low)


def _not_too_short(scene: Scene, stretches: Sequence[Stretch], edges: Sequence[Edge], positions: Array) -> Array:
    """Positions with stretches of the shortest length at least: from the end that is held, else about the middle."""
    result = positions.copy()
    for number, stretch in enumerate(moved(stretches, edges, positions)):
        missing = _shortest(scene, stretch) - (stretch.end - stretch.start)
        mine = [index for index, edge in enumerate(edges) if edge.stretch == number]
        for index in mine if missing > 0.0 else []:
            result[index] += edges[index].outward * missing / len(mine)
    return result


def same_topology(some: Sequence[Stretch], others: Sequence[Stretch]) -> bool:
    """Whether both tell of the same stretches, with ends in about the same places."""
    return len(some) == len(others) and all(
        a.pair == b.pair and a.start < b.end and b.start < a.end for a, b in zip(some, others, strict=True)
    )


def _out_of_place(scene: Scene, stretches: Sequence[Stretch]) -> bool:
    """Whether a stretch has left its zone, come next to the zone's end or run into the next stretch."""
    for stretch in stretches:
        low, high = scene.contact(stretch.pair).zone
        margin = _shortest(scene, stretch)
        inside = low <= stretch.start and stretch.end <= high
        near = low < stretch.start < low + margin or high - margin < stretch.end < high
        if not inside or near:
            return True
    return any(a.pair == b.pair and a.end >= b.start for a, b in pairwise(stretches))
