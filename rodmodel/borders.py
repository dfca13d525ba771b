"""Element borders that follow the edges of the contact zone.

Each moving edge of a contact stretch takes the nearest element border inside the zone on both rods; the borders between
two held ones keep their proportions, so that elements never overlap and the mesh depends smoothly on the edges.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import (
    Bed,
    Clamp,
    ContactPair,
    Gravity,
    LineLoad,
    Load,
    Pressure,
    Rod,
    Scene,
    SectionForce,
    SectionMoment,
    Support,
)
from rodmodel.centre_line import knots, roughness
from rodmodel.mesh import SAME_BORDER, RodMesh, rod_mesh, split, split_where_rough, stretched
from rodmodel.pairing import on_second, shared_borders

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Edge:
    """A moving end of a stretch in contact.

    Attributes
    ----------
    pair : name of the contact pair
    stretch : number of the stretch it ends
    outward : direction along the first rod that leads out of contact: -1 at the stretch's start, +1 at its end
    """

    pair: str
    stretch: int
    outward: int


@dataclass(frozen=True, eq=False)
class RodBorders:
    """Elements of one rod and which of their borders are held or follow an edge.

    Attributes
    ----------
    base : elements before any edge moves
    anchors : indices of borders that are held or follow an edge, ascending
    places : where the anchors are with every edge at 0 along its pair's first rod, mm, shape (n_anchors,)
    rates : how far they move with the edges, mm/mm, shape (n_anchors, n_edges); zero where one is held
    """

    base: RodMesh
    anchors: tuple[int, ...]
    places: Array
    rates: Array

    def at(self, positions: Array) -> Array:
        """Where the anchors go with the edges at `positions`, in the anchors' own order, mm."""
        return np.asarray(self.places + self.rates @ positions)


def natural_mesh(scene: Scene, rod: Rod, level: int | Sequence[int], order: int | Sequence[int]) -> RodMesh:
    """The rod's elements, split where they miss loads, supports, beds, zone ends and rough places of the centre line.

    Fields have kinks there.
    """
    mesh = split(rod_mesh(rod, level, order), _held_stations(scene, rod))
    return split_where_rough(mesh, knots(rod.centre_line), roughness(rod.centre_line))


def _held_stations(scene: Scene, rod: Rod) -> Array:
    acting = [*scene.loads, *scene.supports, *scene.beds]
    acts = [at for each in acting if each.rod == rod.name for at in _acts_at(each)]
    zones = [station for pair in scene.contacts for station in _on_rod(scene, pair, rod, shared_borders(scene, pair))]
    return np.array([0.0, rod.element_borders[-1], *acts, *zones])


def _acts_at(acting: Load | Clamp | Support | Bed) -> tuple[float, ...]:
    """Sections where something on a rod acts, begins or ends; a clamp is at an end anyway."""
    match acting:
        case SectionForce() | SectionMoment() | Support():
            return (acting.position,)
        case LineLoad() | Pressure() | Bed():
            return acting.start, acting.end
        case Gravity() | Clamp():
            return ()


def _on_rod(scene: Scene, pair: ContactPair, rod: Rod, station: Array) -> Array:
    """Stations of a pair (along its first rod) on `rod`; empty where the rod has no part in the pair."""
    if rod.name == pair.first.rod:
        return station
    if rod.name == pair.faces[-1].rod:
        return on_second(scene, pair, station)
    return np.empty(0)


def split_at(
    scene: Scene, meshes: Mapping[str, RodMesh], places: Sequence[tuple[ContactPair, float]]
) -> dict[str, RodMesh]:
    """The meshes with more borders: on both rods of each pair at a place along the first one (mm)."""
    result = {}
    for rod in scene.rods:
        stations = [_on_rod(scene, pair, rod, np.array([place])) for pair, place in places]
        result[rod.name] = split(meshes[rod.name], np.concatenate([np.empty(0), *stations]))
    return result


def border_plan(
    scene: Scene, meshes: Mapping[str, RodMesh], edges: Sequence[Edge], positions: Array
) -> dict[str, RodBorders]:
    """Decide which border follows which edge: on every rod the assignment that moves the borders least.

    A rod with fewer borders in the zone than edges gets new ones.
    """
    plan = {}
    for rod in scene.rods:
        lines = _edge_lines(scene, rod, edges)
        targets = {number: start + rate * float(positions[number]) for number, (start, rate) in lines.items()}
        numbers = sorted(targets, key=lambda number: targets[number])
        wanted = np.array([targets[number] for number in numbers])
        mesh, held = meshes[rod.name], _held_stations(scene, rod)
        movable = _movable(scene, rod, mesh.borders, held, edges)
        if len(movable) < len(wanted):
            mesh = split(mesh, wanted)
            movable = [int(np.abs(mesh.borders - station).argmin()) for station in wanted]
        chosen = [movable[index] for index in nearest(mesh.borders[movable], wanted)]
        is_held = [int(np.abs(mesh.borders - station).argmin()) for station in held]
        followed = {**dict.fromkeys(is_held), **dict(zip(chosen, numbers, strict=True))}
        anchors = tuple(sorted(followed))
        places, rates = mesh.borders[list(anchors)], np.zeros((len(anchors), len(edges)))
        for index, anchor in enumerate(anchors):
            if (number := followed[anchor]) is not None:
                places[index], rates[index, number] = lines[number]
        plan[rod.name] = RodBorders(mesh, anchors, places, rates)
    return plan


def nearest(places: Array, wanted: Array) -> list[int]:
    """Which of ascending places lie nearest to ascending wanted ones, one each and in their order.

    The least sum of distances, by dynamic programming: column j of `sums` holds that of the wanted ones up to j, the
    last of them at a place.
    """
    sums = np.abs(places[:, None] - wanted)
    for column in range(1, len(wanted)):
        before = np.minimum.accumulate(sums[:, column - 1])
        sums[1:, column] += before[:-1]
        sums[0, column] = np.inf
    chosen: list[int] = []
    for column in reversed(range(len(wanted))):
        chosen.append(int(sums[: chosen[-1] if chosen else None, column].argmin()))
    return chosen[::-1]


def _edge_lines(scene: Scene, rod: Rod, edges: Sequence[Edge]) -> dict[int, tuple[float, float]]:
    """Where edges at 0 lie along `rod` and how far they go there per mm, by number, for those that it has a part in."""
    pairs = {edge.pair: _on_rod(scene, scene.contact(edge.pair), rod, np.array([0.0, 1.0])) for edge in edges}
    ends = {number: pairs[edge.pair] for number, edge in enumerate(edges)}
    return {number: (float(at[0]), float(at[1] - at[0])) for number, at in ends.items() if len(at)}


def _movable(scene: Scene, rod: Rod, borders: Array, held: Array, edges: Sequence[Edge]) -> list[int]:
    """Borders inside the zones of the edges' pairs, other than held ones."""
    zones = [
        _on_rod(scene, scene.contact(name), rod, np.array(scene.contact(name).zone)) for name in {e.pair for e in edges}
    ]
    return [
        index
        for index, border in enumerate(borders)
        if np.abs(held - border).min() > SAME_BORDER
        and any(zone.min() < border < zone.max() for zone in zones if len(zone))
    ]


def placed_meshes(plan: Mapping[str, RodBorders], positions: Array) -> dict[str, RodMesh]:
    """Elements of every rod with the edges at `positions` (mm along each pair's first rod)."""
    # An edge that has crossed a held border has changed places with it.
    return {
        name: stretched(borders.base, borders.anchors, np.sort(borders.at(positions))) for name, borders in plan.items()
    }


@dataclass(frozen=True, eq=False)
class Rates:
    """How fast every station of a rod moves with the edges; linear in between held ones and edges.

    Attributes
    ----------
    places : where the rod's anchors are, ascending, mm, shape (n_anchors,)
    of_anchors : how far each moves with every edge, mm/mm, shape (n_edges, n_anchors)
    """

    places: Array
    of_anchors: Array

    def at(self, station: Array) -> Array:
        """Rates of stations, mm/mm, shape (n_edges, n)."""
        return np.array([np.interp(station, self.places, each) for each in self.of_anchors])


def edge_rates(plan: Mapping[str, RodBorders], positions: Array) -> dict[str, Rates]:
    """By rod name, how the borders of `placed_meshes` move with the edges."""
    rates = {}
    for name, borders in plan.items():
        places = borders.at(positions)
        order = np.argsort(places, kind="stable")
        rates[name] = Rates(places[order], borders.rates[order].T)
    return rates
