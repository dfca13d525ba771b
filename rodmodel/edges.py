"""Search for the edges of contact: element borders move until the pressure vanishes on them.

The elements of a stretch are held in contact, pulling or pushing, and the pressure in the middle of the width at the
stretch's end is driven to zero: it passes through zero smoothly and once, where the zero of the gap would creep. At
the root the contact force is stationary in the border's position.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from rodmodel.borders import Edge, Rates
from rodmodel.edge_pressure import EdgePressures, edge_pressures, edge_slopes
from rodmodel.stretches import Stretch, moved, shortest_length
from rodmodel.system import ContactSystem

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# An edge counts as found when the next step would move it by less than this, mm.
EDGE_TOLERANCE = 0.01
# Of short stretches it is this part of their length: their force hangs on it.
SHARE = 2e-3
MOST_STEPS = 8
# Longest step as a part of the zone.
LONGEST_STEP = 0.1
# Steps up to this part of a stretch's length are short, and do what they should if pressures fall to this part.
SHORT_STEP, FALL = 0.1, 0.3
# Pressure times this power of the stretch's length is close to linear in its length: the power 1 where a long stretch
# ends, 2 where a short one does.
POWER = 1.5


@dataclass(frozen=True, eq=False)
class EdgeSearch:
    """Record of a search.

    Attributes
    ----------
    outcome : 'converged', 'stagnated', or 'topology': an edge ran into the zone's end or into another stretch
    positions : last position of every edge, mm along its pair's first rod, shape (n_edges,)
    steps : every position tried, shape (n_solutions, n_edges)
    system : with the borders at the last position
    root : where the step from the last position, which was not tried any more, leads, mm, shape (n_edges,)
    jacobian : derivatives of what the search drives to zero, as known in the end, shape (n_edges, n_edges)
    """

    outcome: str
    positions: Array
    steps: Array
    system: ContactSystem
    root: Array
    jacobian: Array


def find_edges(
    scene: Scene,
    stretches: Sequence[Stretch],
    edges: Sequence[Edge],
    positions: Array,
    system_at: Callable[[Array], tuple[ContactSystem, Mapping[str, Rates]]],
    jacobian: Array | None = None,
    share: float | None = None,
) -> EdgeSearch:
    """Roots of the edge pressures in the edge positions, all at once, by Newton's method.

    The unknowns are pressures times a power of the stretch's length, which are closer to linear in the positions than
    pressures are: a short stretch carries its force on little length. A single edge is kept between what its signs have
    shown.

    Parameters
    ----------
    positions : first guess, mm, shape (n_edges,)
    system_at : makes the contact system with the borders at given positions, and tells how these follow the edges
    jacobian : derivatives by the positions from the search in a scene nearly the same; the first step takes them
    share : part of its stretch's length by which the next step may still move an edge that counts as found; without it
        `EDGE_TOLERANCE`, and no more than `SHARE`
    """
    outward = np.array([edge.outward for edge in edges])
    bracket = Bracket()
    tried: list[Array] = []
    values: list[Array] = []
    new = _not_too_short(scene, stretches, edges, positions)
    while True:
        positions, current = new, moved(stretches, edges, new)
        system, rates = system_at(positions)
        pressures = edge_pressures(system, current, edges)
        tried.append(positions)
        values.append(pressures.value * _lengths(current, edges) ** POWER)
        bracket = bracket.tightened(outward[0] * positions[0], values[-1][0])
        if jacobian is not None and len(tried) > 1:
            change, before = outward * (positions - tried[-2]), values[-2]
            # A short step that does what it should leaves slopes that need no more than Broyden's correction.
            short = (np.abs(change) < SHORT_STEP * _lengths(current, edges)).all()
            if short and np.abs(values[-1]).max() < FALL * np.abs(before).max():
                error = values[-1] - before - jacobian @ change
                jacobian = jacobian + np.outer(error, change) / (change @ change)
            else:
                jacobian = None
        if jacobian is None:
            jacobian = _jacobian(pressures, current, edges, rates)
        new = positions + outward * _step(scene, current, edges, values[-1], jacobian, bracket)
        if _out_of_place(scene, moved(stretches, edges, new)):
            outcome = "topology"
        elif (np.abs(new - positions) < _accepted(_lengths(current, edges), share)).all():
            outcome = "converged"
        elif len(tried) == MOST_STEPS:
            outcome = "stagnated"
        else:
            continue
        return EdgeSearch(outcome, positions, np.array(tried), system, new, jacobian)


def _accepted(lengths: Array, share: float | None) -> Array:
    """Steps, mm, that edges of stretches of these lengths need not take any more."""
    return np.minimum(EDGE_TOLERANCE, SHARE * lengths) if share is None else share * lengths


def _step(
    scene: Scene, stretches: Sequence[Stretch], edges: Sequence[Edge], value: Array, jacobian: Array, bracket: Bracket
) -> Array:
    """How far each edge goes out of contact, mm, shape (n_edges,).

    stretches : with their ends where the edges are
    value, jacobian : pressure times a power of the stretch's length at the edges, and its derivatives by their ways out
    """
    zones = np.array([scene.contact(edge.pair).zone for edge in edges])
    longest, retreat = LONGEST_STEP * (zones[:, 1] - zones[:, 0]), _retreats(stretches, edges)
    step = _newton_step(jacobian, value, _at_shortest(scene, stretches, edges))
    outward = np.array([edge.outward for edge in edges])
    ends = [(stretches[edge.stretch].start, stretches[edge.stretch].end) for edge in edges]
    positions = np.where(outward > 0, *np.array(ends)[:, ::-1].T)
    if len(edges) == 1:
        step = bracket.safe(outward * positions, value, step, longest, retreat)
    new = positions + outward * np.clip(step, -retreat, longest)
    return np.asarray(outward * (_not_too_short(scene, stretches, edges, new) - positions))


def _jacobian(
    pressures: EdgePressures, stretches: Sequence[Stretch], edges: Sequence[Edge], rates: Mapping[str, Rates]
) -> Array:
    """Derivatives of pressure times a power of length by the edges' ways out, shape (n_edges, n_edges)."""
    outward = np.array([edge.outward for edge in edges])
    number = np.array([edge.stretch for edge in edges])
    length = _lengths(stretches, edges)[:, None]
    by_length = POWER * pressures.value[:, None] * (number[:, None] == number)
    by_pressure = edge_slopes(pressures, edges, rates) * outward * length
    return np.asarray((by_pressure + by_length) * length ** (POWER - 1.0))


def _lengths(stretches: Sequence[Stretch], edges: Sequence[Edge]) -> Array:
    """Length of the stretch that each edge ends, mm."""
    return np.array([stretches[edge.stretch].end - stretches[edge.stretch].start for edge in edges])


def _newton_step(jacobian: Array, value: Array, at_shortest: BoolArray) -> Array:
    """-J^-1 value for the edges that are free to move: not those of a stretch that cannot shrink any further."""
    free = ~(at_shortest & (value < 0.0))
    step = np.zeros_like(value)
    step[free] = -np.linalg.lstsq(jacobian[np.ix_(free, free)], value[free])[0]
    return step


@dataclass(frozen=True)
class Bracket:
    """What the signs seen so far say of a single edge, in a coordinate that grows out of contact.

    The pressure at an edge need not fall steadily: on a stretch much too short the held elements pull like a clamp. So
    a step is believed only where it goes the way that the sign asks for, stays within what is known, and, once both
    signs have been seen, the one before it did what it should.

    Attributes
    ----------
    inner, outer : last position with positive and first with negative pressure, mm
    value : last value of the pressure
    falling : whether it is less than half of the one before
    """

    inner: float = -np.inf
    outer: float = np.inf
    value: float = np.inf
    falling: bool = True

    def tightened(self, position: float, value: float) -> Bracket:
        """The bracket with one more pressure known."""
        known = replace(self, value=value, falling=abs(value) < 0.5 * abs(self.value))
        return replace(known, inner=position) if value > 0.0 else replace(known, outer=position)

    def safe(self, position: Array, value: Array, step: Array, longest: Array, retreat: Array) -> Array:
        """The step where it can be believed, else to the middle of the bracket, else far the way the sign asks for.

        longest, retreat : largest steps outward and inward, mm
        """
        target, bounded = position[0] + step[0], bool(np.isfinite(self.outer - self.inner))
        if step[0] * value[0] >= 0.0 and self.inner <= target <= self.outer and (self.falling or not bounded):
            return step
        if bounded:
            return np.array([0.5 * (self.inner + self.outer) - position[0]])
        return longest if value[0] > 0.0 else -retreat


def _retreats(stretches: Sequence[Stretch], edges: Sequence[Edge]) -> Array:
    """How far each edge may go inward at once: a quarter of the stretch, all of it where the other end is held.

    A stretch with one held end that wants to be shorter than it looks mostly wants to be a corner.
    """
    counts = [sum(other.stretch == edge.stretch for other in edges) for edge in edges]
    return _lengths(stretches, edges) * np.where(np.array(counts) == 1, 1.0, 0.25)


def _at_shortest(scene: Scene, stretches: Sequence[Stretch], edges: Sequence[Edge]) -> BoolArray:
    """Edges of stretches that have the shortest length."""
    shortest = np.array([shortest_length(scene, edge.pair) for edge in edges])
    return np.asarray(_lengths(stretches, edges) < (1.0 + 1e-6) * shortest)


def _not_too_short(scene: Scene, stretches: Sequence[Stretch], edges: Sequence[Edge], positions: Array) -> Array:
    """Positions with stretches of the shortest length at least: from the end that is held, else about the middle."""
    result = positions.copy()
    for number, stretch in enumerate(moved(stretches, edges, positions)):
        missing = shortest_length(scene, stretch.pair) - (stretch.end - stretch.start)
        mine = [index for index, edge in enumerate(edges) if edge.stretch == number]
        for index in mine if missing > 0.0 else []:
            result[index] += edges[index].outward * missing / len(mine)
    return result


def _out_of_place(scene: Scene, stretches: Sequence[Stretch]) -> bool:
    """Whether a stretch has left its zone, come next to the zone's end or run into the next stretch."""
    for stretch in stretches:
        low, high = scene.contact(stretch.pair).zone
        margin = shortest_length(scene, stretch.pair)
        inside = low <= stretch.start and stretch.end <= high
        near = low < stretch.start < low + margin or high - margin < stretch.end < high
        if not inside or near:
            return True
    return any(a.pair == b.pair and a.end >= b.start for a, b in pairwise(stretches))
