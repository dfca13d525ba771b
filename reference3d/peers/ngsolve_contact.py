"""Unilateral contact condensed by hand: springs at Gauss points of the faces, solved by their compliance alone.

d = u_n(2) - u_n(1) + g at every point, force = c_n w (-d) where d < 0. With the compliance C of the rods at the points
and d_0 the distances without contact, (C + 1 / (c_n w)) f = -d_0 at the points in contact: an active set on a small
dense system, while the rods are factorised once.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve, cholesky, solve_triangular
from scipy.optimize import nnls
from scipy.sparse import csr_array

from cases.scene import ContactPair, Ground, RodFace, given_gap
from reference3d.peers.answer import Array
from reference3d.peers.ngsolve_mesh import RodMesh, face_axis, rectangle
from reference3d.peers.ngsolve_system import System, face_position, gauss, isotropic

# Springs of contact, in units of the softer rod's Young's modulus over the smallest side of a section: what they let
# through is 1e-5 of what a rod is squeezed by its own height.
STIFF = 1e5
# Cosine from which two faces' borders are parallel, and below which a direction has no part along an axis.
_PARALLEL, _ACROSS = 1.0 - 1e-9, 1e-12
_MOST_SETS = 50


@dataclass(frozen=True, eq=False)
class Springs:
    """The contact points of one pair.

    Attributes
    ----------
    position : on the first face, global, mm, shape (3, n)
    normal : n_c, outward normal of the first face, shape (3,)
    gap : g, before the load, mm, shape (n,)
    stiffness : c_n w, N/mm, shape (n,)
    opening : the change of d by the unknowns, shape (n, n_unknowns)
    """

    position: Array
    normal: Array
    gap: Array
    stiffness: Array
    opening: csr_array


def make_springs(system: System, pair: ContactPair) -> Springs:
    """The contact points of a pair where its faces lie opposite each other."""
    first = system.rod(pair.first.rod)
    points, weight = _points(system, pair)
    position, normal = first.frame.place(points), first.frame.normal(pair.first.face)
    gap = np.zeros(len(weight))
    if isinstance(pair.second, RodFace):
        second, opposite = _opposite(system, pair.second, position, normal)
        inside = _within(system.rod(pair.second.rod), pair.second, second)
        position, weight, points = position[:, inside], weight[inside], points[:, inside]
        second, gap = second[:, inside], opposite[inside]
    opening = _along(system, pair.first.rod, points, -normal)
    if isinstance(pair.second, RodFace):
        opening = opening + _along(system, pair.second.rod, second, normal)
    if pair.gap != "drawn":
        gap = given_gap(pair.gap, points[2])
    return Springs(position, normal, gap, weight * modulus(system, pair), opening)


def modulus(system: System, pair: ContactPair) -> float:
    """That of a bed, else of springs so stiff that they stand for rigid contact, N/mm^3."""
    if isinstance(pair.second, Ground) and pair.second.modulus is not None:
        return pair.second.modulus
    rods = [system.scene.rod(face.rod) for face in pair.faces]
    sections = [rectangle(rod) for rod in rods]
    smallest = min(min(section.width, section.height) for section in sections)
    return STIFF * min(isotropic(rod).young_modulus for rod in rods) / smallest


def _along(system: System, rod: str, points: Array, direction: Array) -> csr_array:
    """The displacement along a direction at points of a rod, by the unknowns."""
    shapes = system.shape_functions(rod, points)
    count, basis = shapes.shape
    total = csr_array((count, 3 * basis))
    for axis in np.flatnonzero(np.abs(direction) > _ACROSS):
        columns = shapes.indices + axis * basis
        part = csr_array((direction[axis] * shapes.data, columns, shapes.indptr), (count, 3 * basis))
        total = part if total.nnz == 0 else total + part
    return total


def _opposite(system: System, face: RodFace, position: Array, normal: Array) -> tuple[Array, Array]:
    """Points (x, y, s) of a face that lie along the normal from given positions, and how far they are as drawn, mm."""
    part = system.rod(face.rod)
    axis = face_axis(face.face)
    direction = part.frame.axes @ normal
    points = part.frame.coordinates(position)
    distance = (face_position(part.grid, face.face) - points[axis]) / direction[axis]
    return points + direction[:, None] * distance, distance


def _within(part: RodMesh, face: RodFace, points: Array) -> NDArray[np.bool_]:
    across = part.grid.x if face_axis(face.face) == 1 else part.grid.y
    side = points[1 - face_axis(face.face)]
    s, slack = part.grid.s, 1e-9 * part.grid.s[-1]
    along = (s[0] - slack <= points[2]) & (points[2] <= s[-1] + slack)
    return np.asarray(along & (across[0] - slack <= side) & (side <= across[-1] + slack))


def _points(system: System, pair: ContactPair) -> tuple[Array, Array]:
    """Gauss points (x, y, s) on the first face within the zone, and the area that each stands for.

    They lie between the borders of both faces' elements where these are parallel or at right angles; faces that cross
    askew have those of the first alone.
    """
    part = system.rod(pair.first.rod)
    axis = face_axis(pair.first.face)
    across = part.grid.x if axis == 1 else part.grid.y
    start, end = system.hexahedra.zones[pair.name]
    borders = {0: across, 1: part.grid.s}
    limits = {0: (across[0], across[-1]), 1: (max(start, 0.0), min(end, part.grid.s[-1]))}
    if isinstance(pair.second, RodFace):
        for direction, places in _borders_seen(system, pair):
            borders[direction] = np.concatenate([borders[direction], places])
            low, high = limits[direction]
            limits[direction] = max(low, places.min()), min(high, places.max())
    axes = []
    count = _order(system, pair) + 1
    for direction in (0, 1):
        low, high = limits[direction]
        if high <= low:
            return np.empty((3, 0)), np.empty(0)
        axes.append(gauss(_distinct(borders[direction], low, high), count))
    (side, side_weight), (along, along_weight) = axes
    points = np.empty((3, len(side) * len(along)))
    points[1 - axis], points[2] = (of.ravel() for of in np.meshgrid(side, along))
    points[axis] = face_position(part.grid, pair.first.face)
    return points, np.outer(along_weight, side_weight).ravel()


def _order(system: System, pair: ContactPair) -> int:
    """The highest order of the first face's elements in the zone."""
    s, orders = system.rod(pair.first.rod).grid.s, np.array(system.hexahedra.orders[pair.first.rod])
    start, end = system.hexahedra.zones[pair.name]
    slack = 1e-6 * s[-1]
    return int(orders[(s[1:] > start + slack) & (s[:-1] < end - slack)].max())


def _borders_seen(system: System, pair: ContactPair) -> list[tuple[int, Array]]:
    """Borders of the second face's elements in coordinates of the first: 0 across or 1 along, and where, mm."""
    assert isinstance(pair.second, RodFace)
    first, second = system.rod(pair.first.rod), system.rod(pair.second.rod)
    own = (1 - face_axis(pair.first.face), 2)
    seen = []
    for axis, borders in ((1 - face_axis(pair.second.face), _side(second, pair.second)), (2, second.grid.s)):
        cosine = first.frame.axes[list(own)] @ second.frame.axes[axis]
        for direction in (0, 1):
            if abs(cosine[direction]) >= _PARALLEL:
                places = np.zeros((3, len(borders)))
                places[axis] = borders
                seen.append((direction, first.frame.coordinates(second.frame.place(places))[own[direction]]))
    return seen


def _side(part: RodMesh, face: RodFace) -> Array:
    return part.grid.x if face_axis(face.face) == 1 else part.grid.y


def _distinct(borders: Array, low: float, high: float) -> Array:
    """Borders between two limits, the limits included, without those that are nearly the same."""
    least = 1e-7 * (high - low)
    kept = [low]
    for border in np.sort(borders).tolist():
        if border - kept[-1] > least and high - border > least:
            kept.append(border)
    return np.array([*kept, high])


def contact_forces(compliance: Array, distance: Array, stiffness: Array) -> tuple[Array, str]:
    """Forces f >= 0 of springs that only push, N, shape (n,), and how the search for them ended.

    Parameters
    ----------
    compliance : C, opening at one point by a force at another, mm/N, shape (n, n)
    distance : d_0, without contact, mm, shape (n,)
    stiffness : c_n w of each spring, N/mm, shape (n,)
    """
    matrix = compliance + np.diag(1.0 / stiffness)
    active = distance < 0.0
    tried: set[bytes] = set()
    while active.tobytes() not in tried and len(tried) < _MOST_SETS:
        tried.add(active.tobytes())
        force = np.zeros(len(distance))
        if active.any():
            force[active] = cho_solve(cho_factor(matrix[np.ix_(active, active)]), -distance[active])
        following = np.where(active, force > 0.0, distance + compliance @ force < 0.0)
        if np.array_equal(following, active):
            return force, "converged"
        active = following
    # The active set came back to itself: the same problem as min |L^T f + L^-1 d_0| over f >= 0, which always ends.
    lower = cholesky(matrix, lower=True)
    force, _ = nnls(lower.T, -solve_triangular(lower, distance, lower=True))
    return force, "converged"
