"""Stretches of a zone in contact, as a contact solution shows them, and which of their ends can move."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from rodmodel.borders import Edge
from rodmodel.contact import ContactForces
from rodmodel.mesh import SAME_BORDER
from rodmodel.pairing import is_even
from rodmodel.system import ContactSystem

Array = NDArray[np.float64]

# Shortest stretch as a part of the zone: contact that wants less is contact at a corner or a point, and its edges are
# known to that length. An edge as close to the zone's end is on it.
SHORTEST = 2e-3
# Where contact may end between a closed and an open station, as parts of the way.
BETWEEN = (0.1, 0.9)


@dataclass(frozen=True)
class Stretch:
    """A part of a zone in contact, mm along the first rod.

    Attributes
    ----------
    slack : how far from its ends the edges of contact may be
    """

    pair: str
    start: float
    end: float
    slack: float = 0.0


def stretches_in_contact(system: ContactSystem, forces: ContactForces) -> tuple[Stretch, ...]:
    """Stretches closed in the middle of the width, each end where the gap beyond it points to.

    Openings shorter than an element are not believed: a mesh whose borders are not on the edges shows such ripples.
    """
    stretches = []
    problem = system.problem
    gaps = problem.gap + problem.compliance @ forces.force + problem.motion @ forces.motion
    for pair, grid in system.grids.items():
        station = grid.station.ravel()
        length = np.repeat(grid.station[:, -1] - grid.station[:, 0], grid.station.shape[1])
        force, gap = (
            values[system.points[pair]].reshape(grid.weight.shape)[:, :, grid.middle].ravel()
            for values in (forces.force, gaps)
        )
        closed = np.flatnonzero(force > 0.0)
        opening = np.diff(station[closed]) >= length[closed[1:]]
        for run in np.split(closed, np.flatnonzero(opening) + 1) if len(closed) else []:
            before, after = max(run[0] - 1, 0), min(run[-1] + 1, len(station) - 1)
            slack = max(station[run[0]] - station[before], station[after] - station[run[-1]])
            start = _end(station[run[0] :: -1], gap[run[0] :: -1])
            end = _end(station[run[-1] :], gap[run[-1] :])
            stretches.append(Stretch(pair, start, end, float(slack)))
    return snapped(system.scene, stretches)


def _end(station: Array, gap: Array) -> float:
    """Where contact ends between the first station, which is closed, and the next one.

    Beyond a smooth edge the gap opens with the power 3/2 of the distance (Johnson, Contact Mechanics, 1985, section
    5.1): the line through gap^(2/3) at the next two stations has its zero there. Half way where they do not open so.
    """
    # Elements share the station on their border.
    distance = np.abs(station - station[0])
    beyond = np.flatnonzero(np.diff(distance, prepend=0.0) > SAME_BORDER)
    if len(beyond) == 0:
        return float(station[0])
    near, share = beyond[0], 0.5
    if len(beyond) > 1 and 0.0 < gap[near] < gap[beyond[1]]:
        opening = gap[beyond[:2]] ** (2.0 / 3.0)
        zero = distance[near] - opening[0] * (distance[beyond[1]] - distance[near]) / (opening[1] - opening[0])
        share = float(np.clip(zero / distance[near], *BETWEEN))
    return float(station[0] + share * (station[near] - station[0]))


def snapped(scene: Scene, stretches: Sequence[Stretch]) -> tuple[Stretch, ...]:
    """The stretches with ends that lie next to the ends of their zones, or beyond them, on these."""
    result = []
    for each in stretches:
        (low, high), margin = scene.contact(each.pair).zone, shortest_length(scene, each.pair)
        start = low if each.start < low + margin else each.start
        result.append(replace(each, start=start, end=high if each.end > high - margin else each.end))
    return tuple(result)


def shortest_length(scene: Scene, pair: str) -> float:
    """Length of the shortest stretch of a pair, mm."""
    low, high = scene.contact(pair).zone
    return SHORTEST * (high - low)


def moving_edges(scene: Scene, stretches: Sequence[Stretch]) -> tuple[tuple[Edge, ...], Array]:
    """Ends of stretches that lie inside their zone, and where (mm along the first rod).

    Borders can follow edges between flat faces that run along each other, and on ground. Elsewhere edges stay where
    the contact points show them.
    """
    found = [
        (Edge(stretch.pair, number, outward), position)
        for number, stretch in enumerate(stretches)
        for outward, position in ((-1, stretch.start), (1, stretch.end))
        if position not in scene.contact(stretch.pair).zone and is_even(scene, scene.contact(stretch.pair))
    ]
    return tuple(edge for edge, _ in found), np.array([position for _, position in found])


def moved(stretches: Sequence[Stretch], edges: Sequence[Edge], positions: Array) -> tuple[Stretch, ...]:
    """The stretches with their moving ends at `positions`."""
    result = list(stretches)
    for edge, position in zip(edges, positions, strict=True):
        stretch, end = result[edge.stretch], float(position)
        result[edge.stretch] = replace(stretch, start=end) if edge.outward < 0 else replace(stretch, end=end)
    return tuple(result)


def same_topology(some: Sequence[Stretch], others: Sequence[Stretch]) -> bool:
    """Whether both tell of the same stretches, with ends in about the same places."""
    return len(some) == len(others) and all(
        a.pair == b.pair and a.start < b.end and b.start < a.end for a, b in zip(some, others, strict=True)
    )
