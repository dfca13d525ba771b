"""The contact problem of a scene on given element borders: all rods reduced to their contact points."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, Ground, Material, Rod, RodFace, Scene, given_gap
from rodmodel.assembly import (
    AssembledRod,
    ElementStore,
    Functionals,
    Mirrors,
    Part,
    add_to,
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
from rodmodel.centre_line import frame, frames
from rodmodel.contact import ContactProblem
from rodmodel.joints import Loose, Skeleton, skeleton
from rodmodel.loads import load_parts
from rodmodel.mesh import SAME_BORDER, RodMesh
from rodmodel.pairing import (
    NO_SHARE,
    ContactGrid,
    contact_grid,
    face_axes,
    is_even,
    on_second,
    opposite_stations,
    shared_borders,
)
from rodmodel.section import Fields, section_values
from rodmodel.stiffness import Element

# Springs of multipliers are at least this part as stiff in a short interval as in the longest.
SHORT = 0.3
# By how much the penalty that suits the rods is stiffer than their sections, squeezed across.
STIFFER = 1e3
# Rods count as moved from this part of what the farthest moves on.
MOVED = 1e-6

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
        result = {}
        for name, (load, held) in self._loaded(force[:, None], free[:, None], np.ones(1)).items():
            values = coefficients(self.rods[name], load, held)
            moved = {node: each[:, 0] for node, each in held.items()}
            result[name] = RodState(load, moved, tuple(each[..., 0] for each in values))
        return result

    def displacements(self, force: Array, free: Array, given: Array) -> dict[str, tuple[Array, ...]]:
        """Degrees of freedom of every rod's elements, by name, shape (order + 1, n_fields, m) each, in m states.

        force, free : contact forces, N, shape (n, m), and free motions, shape (n_free, m)
        given : how much of the given loads and displacements acts in each, shape (m,)
        """
        loaded = self._loaded(force, free, given)
        return {name: coefficients(self.rods[name], *each) for name, each in loaded.items()}

    def _loaded(self, force: Array, free: Array, given: Array) -> dict[str, tuple[Functionals, dict[int, Array]]]:
        """What acts on the rods in the states of `displacements`, and displacements of held nodes, (n_fields, m)."""
        half = self.on_joints @ np.vstack([force, given])
        motion = np.empty((0, len(given))) if self.skeleton is None else self.skeleton.motion(half, free)
        result = {}
        for name, assembled in self.rods.items():
            load = combined(self.functionals[name], np.vstack([force[self.places[name]], given]))
            held = {node: np.outer(each, given) for node, each in given_displacement(assembled).items()}
            if self.skeleton is not None and name in self.skeleton.rods:
                joined = self.skeleton.rods[name]
                load = added(load, combined(joined.response, -motion))
                held |= {node: unit @ motion for node, unit in joined.motions.items()}
            result[name] = load, held
        return result

    def moved_by(self, free: Array) -> list[str]:
        """Names of the loose rods that free motions, shape (n_free,), move."""
        if self.skeleton is None:
            return []
        motion = self.skeleton.free @ free
        far = {
            name: max(float(np.abs(unit @ motion).max()) for unit in joined.motions.values())
            for name, joined in self.skeleton.rods.items()
        }
        return [name for name, moved in far.items() if moved > MOVED * max(far.values())]


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
    points = _points(grids)
    joints = skeleton(scene, mirrors, rods, loose)
    found, places, responses = {}, {}, {}
    for name, assembled in rods.items():
        parts, place = _gap_parts(scene, assembled, grids, points)
        parts += load_parts(assembled, scene.loads, column=len(place))
        parts += prescribed_parts(assembled, column=len(place))
        found[name], places[name] = functionals(assembled, parts, count=len(place) + 1), place
        responses[name] = compliance(found[name])
    return joined_system(scene, rods, grids, found, places, responses, joints, multipliers)


def joined_system(
    scene: Scene,
    rods: Mapping[str, AssembledRod],
    grids: Mapping[str, ContactGrid],
    found: Mapping[str, Functionals],
    places: Mapping[str, IntArray],
    responses: Mapping[str, Array],
    joints: Skeleton | None,
    multipliers: bool,
) -> ContactSystem:
    """The contact problem of rods that are reduced to their contact points.

    found, places : `functionals` and `places` of the system
    responses : compliance of the functionals, by rod name, shape (n_rod + 1, n_rod + 1)
    """
    points = _points(grids)
    count = sum(grid.weight.size for grid in grids.values())
    matrix = np.zeros((count, count))
    gap, spring = np.empty(count), np.empty(count)
    for pair in scene.contacts:
        gap[points[pair.name]] = initial_gap(pair, grids[pair.name])
    on_joints = np.zeros((0 if joints is None else len(joints.free), count + 1))
    for name, assembled in rods.items():
        place, response = places[name], responses[name]
        add_to(matrix, place, response[:-1, :-1])
        gap[place] += response[:-1, -1]
        if given_displacement(assembled):
            gap[place] += on_given(assembled, found[name])[:-1]
        if joints is not None and name in joints.rods:
            on_joints[:, [*place, -1]] += joints.rods[name].on_joints(found[name])
    free = np.zeros((0, count + 1))
    if joints is not None:
        free, on_joints = joints.free.T @ on_joints, joints.half_solve(on_joints)
        matrix += on_joints[:, :-1].T @ on_joints[:, :-1]
        gap += on_joints[:, :-1].T @ on_joints[:, -1]
    rigid = np.full(count, multipliers)
    for pair in scene.contacts:
        part = points[pair.name]
        spring[part] = _springs(scene, pair, grids[pair.name], multipliers)
        weight = grids[pair.name].weight.ravel()
        rigid[part] &= weight > NO_SHARE * weight.max()
        if pair.on_bed:
            rigid[part] = False
    problem = ContactProblem(matrix, gap, spring, np.ascontiguousarray(free[:, :-1].T), free[:, -1], rigid)
    return ContactSystem(scene, rods, grids, points, found, places, problem, joints, on_joints)


def _points(grids: Mapping[str, ContactGrid]) -> dict[str, slice]:
    """By pair name, where its contact points stand in the vector of all."""
    ends = np.cumsum([0, *(grid.weight.size for grid in grids.values())]).tolist()
    return {name: slice(start, end) for name, start, end in zip(grids, ends, ends[1:], strict=False)}


def initial_gap(pair: ContactPair, grid: ContactGrid) -> Array:
    """Gap before any load at the contact points, mm, shape (n_points,)."""
    return grid.facing.distance if pair.gap == "drawn" else given_gap(pair.gap, grid.facing.first[2])


def _springs(scene: Scene, pair: ContactPair, grid: ContactGrid, multipliers: bool) -> Array:
    """c_n w of the contact points, N/mm, shape (n_points,)."""
    weight = grid.weight.copy()
    if multipliers and not pair.on_bed:
        # What multipliers find does not depend on the springs; those of short intervals may as well be as stiff. Within
        # an interval they follow the points' shares, or a constant pressure would not be one (contact patch test).
        largest = weight.max(axis=(1, 2), keepdims=True)
        weight *= np.maximum(1.0, SHORT * largest.max() / np.maximum(largest, NO_SHARE * largest.max()))
    # Where what the faces share ends in a corner, points have no share; they must not be without a spring.
    return np.asarray(np.maximum(weight, NO_SHARE * weight.max()).ravel() * _stiffness(scene, pair, multipliers))


def _stiffness(scene: Scene, pair: ContactPair, multipliers: bool) -> float:
    """Pressure per penetration, N/mm^3: the bed's, or the penalty.

    Multipliers get the penalty that suits the rods, whatever is given: what they find does not depend on it, but a
    soft one takes many steps and a stiff one leaves equations that round-off spoils.
    """
    if isinstance(pair.second, Ground) and pair.second.modulus is not None:
        return pair.second.modulus
    if pair.penalty is not None and not multipliers:
        return pair.penalty
    squeezed = 0.0
    for face in pair.faces:
        rod = scene.rod(face.rod)
        axes = face_axes(rod, face.face)
        moduli = rod.material
        across = moduli.young_modulus if isinstance(moduli, Material) else moduli.young_moduli[axes.axis]
        squeezed += 2.0 * axes.height / across
    return STIFFER / squeezed


def _grid(
    scene: Scene,
    pair: ContactPair,
    rods: Mapping[str, AssembledRod],
    mirrors: Mapping[str, Mirrors],
) -> ContactGrid:
    """Contact points between the borders of both rods: enough of them to integrate the penalty energy exactly."""
    involved = [rods[face.rod] for face in pair.faces]
    ends = shared_borders(scene, pair)
    borders = [ends, involved[0].borders]
    if len(involved) == 2 and is_even(scene, pair):
        borders.append(opposite_stations(involved[1].rod, involved[0].rod, involved[1].borders))
    all_borders = np.sort(np.concatenate(borders))
    inside = all_borders[(all_borders > ends[0] + SAME_BORDER) & (all_borders < ends[-1] - SAME_BORDER)]
    all_borders = np.concatenate([ends[:1], inside, ends[-1:]])
    all_borders = all_borders[np.concatenate([[True], np.diff(all_borders) > SAME_BORDER])]
    intervals = np.column_stack([all_borders[:-1], all_borders[1:]])
    # What an element beyond the zone carries needs no points here.
    touching = _elements_on(involved[0], ends)
    if len(involved) == 2:
        on_other = on_second(scene, pair, ends) if is_even(scene, pair) else involved[1].borders
        touching += _elements_on(involved[1], on_other)
    n_across = max(element.fields.level for element in touching) + 2
    across_is_x = face_axes(involved[0].rod, pair.first.face).axis == 1
    symmetric = mirrors[pair.first.rod][0 if across_is_x else 1]
    n_along = max(element.order for element in touching) + 2
    return contact_grid(scene, pair, intervals, (n_along, n_across + 1 - n_across % 2), symmetric)


def _elements_on(assembled: AssembledRod, stations: Array) -> list[Element]:
    """Elements that share more than a border with the part of the rod between the first and last of its stations."""
    left, right = assembled.borders[:-1], assembled.borders[1:]
    inside = (left < stations.max() - SAME_BORDER) & (right > stations.min() + SAME_BORDER)
    return [assembled.elements[index] for index in np.flatnonzero(inside)]


def _gap_parts(
    scene: Scene, assembled: AssembledRod, grids: Mapping[str, ContactGrid], points_of: Mapping[str, slice]
) -> tuple[list[Part], IntArray]:
    """What a rod adds to the gap at all contact points on it: u_n of the second face, -u_n of the first."""
    name = assembled.rod.name
    parts: list[Part] = []
    places = [np.empty(0, dtype=np.int64)]
    count = 0
    for pair in scene.contacts:
        for face in pair.faces:
            if face.rod != name:
                continue
            grid = grids[pair.name]
            found = point_parts(assembled, *opening(assembled.rod, face, pair, grid))
            parts += [replace(part, columns=part.columns + count) for part in found]
            place = np.arange(points_of[pair.name].start, points_of[pair.name].stop)
            places.append(place)
            count += len(place)
    return parts, np.concatenate(places)


def opening(rod: Rod, face: RodFace, pair: ContactPair, grid: ContactGrid) -> tuple[Array, Callable[[Fields], Array]]:
    """How a face of a rod opens the gap of a pair at its contact points.

    Returns the points' stations along the rod, shape (n,), and what gives the value of every field there in the
    direction that opens the gap, shape (n_fields, n).
    """
    points = grid.facing.first if face is pair.first else grid.facing.second
    if points is None:
        raise ValueError(f"contact '{pair.name}': ground does not move")
    sign = -1.0 if face is pair.first else 1.0
    if grid.even:
        # Every station has the same points across, and one direction.
        count = grid.weight.shape[2]
        one_row, direction = points[:, :count], frame(rod.centre_line) @ grid.facing.normal[:, :count]
        return points[2], lambda fields: np.tile(_along(rod, fields, one_row, sign * direction), grid.station.size)
    direction = np.einsum("nci,in->cn", frames(rod.centre_line, points[2]), grid.facing.normal)
    return points[2], lambda fields: _along(rod, fields, points, sign * direction)


def _along(rod: Rod, fields: Fields, points: Array, direction: Array) -> Array:
    """Value of every field in given local directions (shape (3, n)) at points (x, y, s), shape (n_fields, n)."""
    return np.asarray(section_values(rod.section, fields, points[0], points[1]) * direction[fields.table[0]])
