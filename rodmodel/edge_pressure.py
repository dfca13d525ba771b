"""Pressure at the edges of contact while their stretches are held, and how it changes as the edges move.

The contact points and the degrees of freedom stay where they are on their elements while these get longer or shorter.
So the change of a pressure p = q . f (q picks it from the forces f of A f = -d_0, A = C + 1 / (c_n w)) is that of the
elements' stiffness between the displacements u under f and the loads, and v under the adjoint forces A^-1 q:

    dp = v . dK u + what the changes of the points' shares w of the face, and of loads spread over elements, make.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Rod, SectionForce, SectionMoment
from rodmodel.assembly import AssembledRod
from rodmodel.axial import shape_function_slopes
from rodmodel.borders import Edge, Rates
from rodmodel.contact import ActiveSet
from rodmodel.loads import load_parts
from rodmodel.mesh import SAME_BORDER
from rodmodel.pairing import opposite_stations
from rodmodel.section import Fields, axial_modulus
from rodmodel.stiffness import length_slope
from rodmodel.stretches import Stretch
from rodmodel.system import ContactSystem, opening

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

# Points that slide less than this along an element, mm per mm of an edge, do so by round-off.
SLIDING = 1e-6
# Steps of the multipliers that make the adjoint forces those of rigid points, as the forces are. With the springs' own
# alone, slopes at the end of a stretch of half a height are off by 14 %, with these by 1 %.
ADJOINT_STEPS = 3


@dataclass(frozen=True, eq=False)
class EdgePressures:
    """Pressures at the edges of held stretches.

    Attributes
    ----------
    value : in the middle of the width, MPa, shape (n_edges,)
    points : contact points at the edges in the middle of the width, shape (n_edges,)
    force, motion : at the contact points of the system, N, shape (n,), and of loose rods, shape (n_motions,)
    adjoint, adjoint_motion : by how much a force at a point would raise each pressure, MPa/mm, shape (n, n_edges), and
        the motions that go with it, shape (n_motions, n_edges)
    """

    system: ContactSystem
    value: Array
    points: IntArray
    force: Array
    motion: Array
    adjoint: Array
    adjoint_motion: Array


def held_points(system: ContactSystem, stretches: Sequence[Stretch]) -> BoolArray:
    """Contact points of the intervals within the stretches, shape (n,)."""
    held = np.zeros(len(system.problem.gap), dtype=bool)
    for stretch in stretches:
        grid = system.grids[stretch.pair]
        middles = 0.5 * (grid.station[:, 0] + grid.station[:, -1])
        inside = (middles > stretch.start) & (middles < stretch.end)
        part = held[system.points[stretch.pair]].reshape(grid.weight.shape)
        part[inside] = True
    return held


def edge_pressures(system: ContactSystem, stretches: Sequence[Stretch], edges: Sequence[Edge]) -> EdgePressures:
    """Pressures in the middle of the width at each edge while the stretches are held, pulling or pushing."""
    problem = system.problem
    held = held_points(system, stretches)
    right = np.zeros((len(held), len(edges)))
    chosen = np.empty(len(edges), dtype=np.int64)
    for number, edge in enumerate(edges):
        grid, stretch = system.grids[edge.pair], stretches[edge.stretch]
        side, border = (-1, stretch.end) if edge.outward > 0 else (0, stretch.start)
        interval = int(np.abs(grid.station[:, side] - border).argmin())
        point = (interval, side % grid.station.shape[1], grid.middle)
        chosen[number] = system.points[edge.pair].start + np.ravel_multi_index(point, grid.weight.shape)
        right[chosen[number], number] = -1.0 / grid.weight[point]
    joined = ActiveSet(held, problem)
    force, motion = joined.settled_forces()
    multiplier = np.zeros_like(right)
    for _ in range(ADJOINT_STEPS):
        on_motions = np.zeros((len(problem.motion_load), len(edges)))
        adjoint, adjoint_motion = joined.respond(right - multiplier / problem.spring[:, None], on_motions)
        multiplier = np.where(problem.rigid[:, None], adjoint, 0.0)
    value = -right[chosen, np.arange(len(edges))] * force[chosen]
    return EdgePressures(system, value, chosen, force, motion, adjoint, adjoint_motion)


def edge_slopes(pressures: EdgePressures, edges: Sequence[Edge], rates: Mapping[str, Rates]) -> Array:
    """Derivatives of the pressures (rows) by the edges' positions (columns), MPa/mm, shape (n_edges, n_edges)."""
    system = pressures.system
    # The state under the loads, and what the adjoint forces alone do.
    states = system.displacements(
        np.column_stack([pressures.force, pressures.adjoint]),
        np.column_stack([pressures.motion, pressures.adjoint_motion]),
        np.append(1.0, np.zeros(len(edges))),
    )
    moving = {pair: _station_rates(system, pair, rates) for pair in system.grids}
    slopes = np.zeros((len(edges), len(edges)))
    for name, rod in system.rods.items():
        longer = np.diff(rates[name].at(rod.borders))
        modulus = axial_modulus(rod.rod.material)
        for index in np.flatnonzero(longer.any(axis=0)):
            displacement, responses = states[name][index][..., 0], states[name][index][..., 1:]
            of_length = modulus * length_slope(rod.elements[index], responses, displacement)
            slopes += np.outer(of_length, longer[:, index])
        spread = [load for load in system.scene.loads if not isinstance(load, SectionForce | SectionMoment)]
        for part in load_parts(rod, spread, column=0):
            growth = longer[:, part.element] / rod.elements[part.element].length
            slopes -= np.outer(
                part.values.ravel() @ states[name][part.element][..., 1:].reshape(part.values.size, -1), growth
            )
        for pair, sliding, station, direction in _slidings(system, rod, moving, rates[name]):
            points = system.points[pair]
            slope, *response_slopes = _slopes_at(rod, states[name], station, direction)
            of_sliding = pressures.adjoint[points].T * slope + pressures.force[points] * np.array(response_slopes)
            slopes -= of_sliding @ sliding.T
    for pair, grid in system.grids.items():
        points = system.points[pair]
        # Growth of every interval, and with it of its points' shares of the face, 1/mm, shape (n_edges, n_points).
        growth = (moving[pair][:, :, -1] - moving[pair][:, :, 0]) / (grid.station[:, -1] - grid.station[:, 0])
        of_points = np.repeat(growth, grid.weight[0].size, axis=1)
        problem = system.problem
        penetration = np.where(problem.rigid[points], 0.0, pressures.force[points] / problem.spring[points])
        slopes += pressures.adjoint[points].T @ (of_points * penetration).T
        mine = [number for number, edge in enumerate(edges) if edge.pair == pair]
        slopes[mine] -= pressures.value[mine, None] * of_points[:, pressures.points[mine] - points.start].T
    return slopes


def _station_rates(system: ContactSystem, pair: str, rates: Mapping[str, Rates]) -> Array:
    """How the contact stations move with the edges, along the first rod, shape (n_edges, n_intervals, n_along).

    They keep their places between the ends of their interval, which are borders of the first rod or of the second.
    """
    contact, grid = system.scene.contact(pair), system.grids[pair]
    involved = [system.rods[face.rod] for face in contact.faces]
    ends = grid.station[:, [0, -1]].ravel()
    at_ends = rates[involved[0].rod.name].at(ends)
    if len(involved) == 2 and grid.even:
        first, second = involved
        on_first = np.abs(first.borders[:, None] - ends).min(axis=0) < 2.0 * SAME_BORDER
        opposite = opposite_stations(first.rod, second.rod, ends)
        of_second = rates[second.rod.name].at(opposite) * _sense(first.rod, second.rod)
        at_ends = np.where(on_first, at_ends, of_second)
    start, end = np.moveaxis(at_ends.reshape(len(at_ends), -1, 2), 2, 0)[..., None]
    place = (grid.station - grid.station[:, :1]) / (grid.station[:, -1:] - grid.station[:, :1])
    return np.asarray(start + (end - start) * place)


def _slidings(
    system: ContactSystem, rod: AssembledRod, moving: Mapping[str, Array], rates: Rates
) -> Iterator[tuple[str, Array, Array, Callable[[Fields], Array]]]:
    """Pairs whose points slide along the elements of a rod, as they do where only one rod has a held border in a zone.

    With each, how far the points slide per mm of every edge, shape (n_edges, n_points), their stations along the rod,
    and the directions that -u_n has there.
    """
    for pair, grid in system.grids.items():
        contact = system.scene.contact(pair)
        for face in contact.faces:
            if face.rod != rod.rod.name or not grid.even:
                continue
            station, direction = opening(rod.rod, face, contact, grid)
            sense = 1.0 if face is contact.first else _sense(system.scene.rod(contact.first.rod), rod.rod)
            along = sense * np.repeat(moving[pair].reshape(len(moving[pair]), -1), grid.weight.shape[2], axis=1)
            sliding = along - rates.at(station)
            if np.abs(sliding).max() > SLIDING:
                yield pair, sliding, station, direction


def _sense(first: Rod, second: Rod) -> float:
    """+1 where the second rod runs along with the first, -1 where against it."""
    here, ahead = opposite_stations(first, second, np.array([0.0, 1.0]))
    return float(ahead - here)


def _slopes_at(
    rod: AssembledRod, values: Sequence[Array], station: Array, direction: Callable[[Fields], Array]
) -> Array:
    """Derivatives along the rod of -u_n at its contact points in m states, shape (m, n_points)."""
    index, xi = rod.locate(station)
    slopes = np.empty((values[0].shape[2], len(station)))
    directions: dict[Fields, Array] = {}
    for number in np.unique(index):
        element, members = rod.elements[number], np.flatnonzero(index == number)
        if element.fields not in directions:
            directions[element.fields] = direction(element.fields)
        along = shape_function_slopes(element.order, xi[members]) * (2.0 / element.length)
        of_fields = np.einsum("an,afm->mfn", along, values[number])
        slopes[:, members] = (of_fields * directions[element.fields][:, members]).sum(axis=1)
    return slopes
