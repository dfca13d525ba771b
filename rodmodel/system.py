"""The contact problem of a scene on given element borders: all rods reduced to their contact points."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, Face, Rod, Scene
from rodmodel.assembly import (
    AssembledRod,
    ElementStore,
    Functionals,
    Mirrors,
    Part,
    added,
    assembled_rod,
    coefficients,
    combined,
    compliance,
    functionals,
    given_displacement,
    on_given,
    point_parts,
    prescribed_parts,
)
from rodmodel.contact import ContactProblem
from rodmodel.joints import Loose, Skeleton, skeleton
from rodmodel.loads import load_parts
from rodmodel.mesh import SAME_BORDER, RodMesh
from rodmodel.pairing import (
    ContactGrid,
    contact_grid,
    face_axes,
    facing_points,
    opposite_stations,
    width_across,
)
from rodmodel.section import Fields, section_values

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class RodState:
    """A rod under its loads, contact forces and joints.

    Attributes
    ----------
    load : all that acts on it as one functional, what held nodes do to the rest included
    held : displacement of held nodes where it is not zero, by node, shape (n_fields,) each
    coefficients : degrees of freedom of every element, shape (order + 1, n_fields) each
    """

    load: Functionals
    held: Mapping[int, Array]
    coefficients: tuple[Array, ...]


@dataclass(frozen=True, eq=False)
class ContactSystem:
    """The contact problem of the points of all pairs, and what it was made from.

    Attributes
    ----------
    rods : assembled rods by name
    grids : contact points by pair name; the points of all pairs follow one another in one long vector
    points : by pair name, which part of the vector is the pair's
    functionals : by rod name, -u_n of its contact points (n the outward normal of its own face), and last its loads
    places : by rod name, where in the vector its contact points are
    problem : its gap is that under the given loads and prescribed displacements
    skeleton : the scene's joints and loose rods, if it has any
    on_joints : contact points, and last the loads, on the skeleton's motions, half solved, shape (n_elastic, n + 1)
    """

    scene: Scene
    rods: Mapping[str, AssembledRod]
    grids: Mapping[str, ContactGrid]
    points: Mapping[str, slice]
    functionals: Mapping[str, Functionals]
    places: Mapping[str, IntArray]
    problem: ContactProblem
    skeleton: Skeleton | None
    on_joints: Array

    def states(self, force: Array, free: Array) -> dict[str, RodState]:
        """The rods under the given loads, contact forces (N, shape (n,)) and free motions (n_free,), by name."""
        half = self.on_joints @ np.append(force, 1.0)
        motion = np.empty(0) if self.skeleton is None else self.skeleton.motion(half, free)
        result = {}
        for name, assembled in self.rods.items():
            load = combined(self.functionals[name], np.append(force[self.places[name]], 1.0)[:, None])
            held = given_displacement(assembled)
            if self.skeleton is not None and name in self.skeleton.rods:
                joined = self.skeleton.rods[name]
                load = added(load, combined(joined.response, -motion[:, None]))
                held |= {node: unit @ motion for node, unit in joined.motions.items()}
            result[name] = RodState(load, held, coefficients(assembled, load, held))
        return result


def contact_system(
    scene: Scene,
    mirrors: Mapping[str, Mirrors],
    meshes: Mapping[str, RodMesh],
    store: ElementStore,
    loose: Sequence[Loose] = (),
    multipliers: bool = True,
) -> ContactSystem:
    """Assemble the rods on their meshes (by rod name) and reduce them to their contact points.

    loose : rods that only contact can hold
    multipliers : take the penetration of the penalty's springs away
    """
    rods = {}
    for rod in scene.rods:
        stays = [each.stay for each in loose if each.stay is not None and each.rods == (rod.name,)]
        rods[rod.name] = assembled_rod(scene, rod, mirrors[rod.name], meshes[rod.name], store, stays)
    grids = {pair.name: _grid(scene, pair, rods, mirrors) for pair in scene.contacts}
    counts = [grid.weight.size for grid in grids.values()]
    ends = np.cumsum([0, *counts])
    points = {name: slice(ends[i], ends[i + 1]) for i, name in enumerate(grids)}
    matrix = np.zeros((ends[-1], ends[-1]))
    gap, spring = np.empty(ends[-1]), np.empty(ends[-1])
    for pair in scene.contacts:
        gap[points[pair.name]] = pair.gap
        spring[points[pair.name]] = pair.penalty * grids[pair.name].weight.ravel()
    joints = skeleton(scene, mirrors, rods, loose)
    on_joints = np.zeros((0 if joints is None else len(joints.free), ends[-1] + 1))
    found, places = {}, {}
    for name, assembled in rods.items():
        parts, place = _gap_parts(scene, assembled, grids, points)
        parts += load_parts(assembled, scene.loads, column=len(place))
        parts += prescribed_parts(assembled, column=len(place))
        found[name], places[name] = functionals(assembled, parts, count=len(place) + 1), place
        response = compliance(found[name])
        matrix[np.ix_(place, place)] += response[:-1, :-1]
        gap[place] += response[:-1, -1] + on_given(assembled, found[name])[:-1]
        if joints is not None and name in joints.rods:
            on_joints[:, [*place, -1]] += joints.rods[name].on_joints(found[name])
    free = np.zeros((0, ends[-1] + 1))
    if joints is not None:
        free, on_joints = joints.free.T @ on_joints, joints.half_solve(on_joints)
        matrix += on_joints[:, :-1].T @ on_joints[:, :-1]
        gap += on_joints[:, :-1].T @ on_joints[:, -1]
    rigid = np.full(ends[-1], multipliers)
    problem = ContactProblem(matrix, gap, spring, np.ascontiguousarray(free[:, :-1].T), free[:, -1], rigid)
    return ContactSystem(scene, rods, grids, points, found, places, problem, joints, on_joints)


def _grid(
    scene: Scene,
    pair: ContactPair,
    rods: Mapping[str, AssembledRod],
    mirrors: Mapping[str, Mirrors],
) -> ContactGrid:
    """Contact points between the borders of both rods: enough of them to integrate the penalty energy exactly."""
    first, second = rods[pair.first.rod], rods[pair.second.rod]
    start, end = pair.zone
    borders = np.sort(np.concatenate([first.borders, opposite_stations(second.rod, first.rod, second.borders)]))
    inside = borders[(borders > start + SAME_BORDER) & (borders < end - SAME_BORDER)]
    borders = np.concatenate([[start], inside, [end]])
    borders = borders[np.concatenate([[True], np.diff(borders) > SAME_BORDER])]
    intervals = np.column_stack([borders[:-1], borders[1:]])
    n_across = max(first.level, second.level) + 2
    across_is_x = face_axes(first.rod, pair.first.face).axis == 1
    symmetric = mirrors[pair.first.rod][0 if across_is_x else 1]
    n_along = max(first.order, second.order) + 2
    return contact_grid(intervals, width_across(scene, pair), n_along, n_across + 1 - n_across % 2, symmetric)


def _gap_parts(
    scene: Scene, assembled: AssembledRod, grids: Mapping[str, ContactGrid], points_of: Mapping[str, slice]
) -> tuple[list[Part], IntArray]:
    """-u_n at all contact points on one rod, n being the outward normal of the face that they lie on."""
    name = assembled.rod.name
    parts: list[Part] = []
    places = [np.empty(0, dtype=np.int64)]
    count = 0
    for pair in scene.contacts:
        for side in (pair.first, pair.second):
            if side.rod != name:
                continue
            grid = grids[pair.name]
            facing = facing_points(scene, pair, *grid.flat())
            points = facing.first if side is pair.first else facing.second
            found = point_parts(assembled, points[2], inward_directions(assembled.rod, side.face, grid, points))
            parts += [replace(part, columns=part.columns + count) for part in found]
            place = np.arange(points_of[pair.name].start, points_of[pair.name].stop)
            places.append(place)
            count += len(place)
    return parts, np.concatenate(places)


def inward_directions(rod: Rod, face: Face, grid: ContactGrid, points: Array) -> Callable[[Fields], Array]:
    """Value of every field in the direction -n of a face at its contact points, shape (n_fields, n_points)."""
    axes = face_axes(rod, face)
    # Parallel rods: every station has the same points across.
    x, y = points[:2, : len(grid.across)]

    def direction(fields: Fields) -> Array:
        values = section_values(rod.section, fields, x, y)
        across = np.where((fields.table[0] == axes.axis)[:, None], -axes.sign * values, 0.0)
        return np.tile(across, grid.station.size)

    return direction
