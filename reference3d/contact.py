"""Frictionless penalty contact of points with a surface: of the nodes of the first face of every pair, or of others.

A point i with tributary area A_i and gap d_i (the other face is interpolated opposite it) carries the force
F_i = c_n A_i max(-d_i, 0). With the rods condensed onto the contact points, d = d0 + C F, so that F solves the
linear complementarity problem

    F >= 0,   w = d0 + (C + diag(1 / (c_n A))) F >= 0,   F^T w = 0.

Where the springs stand for rigid contact, the problem is solved again with the springs moved by what they gave way,
d0 - F / (c_n A), until the forces stay: then F depends on the penalty no more (augmented Lagrangian: M. J. D. Powell,
in Optimization, ed. R. Fletcher, Academic Press 1969, 283-298).

Instead of the nodes of the first face, those of the second may be the points (the other pass of node-to-surface
contact), or Gauss points of the first face's elements (surface quadrature), to see what node-to-surface costs. Where
meshes differ neither pass is the better one: nodes of the finer face get pressures that jump, nodes of the coarser one
are farther off in the patch test. Gauss points keep the springs as given: pressures free of them would not settle where
displacements cannot tell them apart.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse import csc_array

from cases.scene import ContactPair, RodFace, Scene
from reference3d.frames import face_frame, gaps, pair_overlap
from reference3d.grading import Borders
from reference3d.quadratic import line_nodes, locate, nodal_weights, shape_functions
from reference3d.scope import on_bed, penalty

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# What carries contact forces
PointsOf = Literal["first nodes", "second nodes", "first Gauss points"]
NODES: PointsOf = "first nodes"
# Gauss points of an element of a face along each of its axes: as many as there are nodes to an element in the mean, as
# more would ask for more pressures than the displacements of the face can tell apart
GAUSS = 2
# block pivoting steps without progress before single pivoting takes over (Judice and Pires 1994)
PATIENCE = 5
# how often springs are moved at most, and the change of the forces, of their sum, at which they stay
MOST_MOVES, STAYING = 50, 1e-6


@dataclass(frozen=True)
class ContactNodes:
    """Points in which a pair may touch inside the overlap, a grid along s and across: nodes of a face or Gauss points.

    Attributes
    ----------
    station, lateral : coordinates of the grid on the first face, mm, shapes (n_s,), (n_lateral,)
    area : tributary areas, mm^2, shape (n_s, n_lateral)
    gap : initial distance of the faces, mm, shape (n_s n_lateral,)
    penalty : N/mm^3
    rigid : whether penetration is to be taken away: the penalty is not a bed's modulus
    first, second : rows of the normal displacement against n_c at the node and along n_c opposite it, so that
        d = g + first @ u_1 + second @ u_2, shape (n_s n_lateral, unknowns of the rod); no second on ground
    """

    station: Array
    lateral: Array
    area: Array
    gap: Array
    penalty: float
    rigid: bool
    first: csc_array
    second: csc_array | None


@dataclass(frozen=True)
class Complementarity:
    """Solution of the complementarity problem.

    Attributes
    ----------
    force : F, N, shape (n,)
    outcome : 'converged' or 'cycling'
    steps : active sets tried
    """

    force: Array
    outcome: str
    steps: int


def contact_nodes(
    scene: Scene, pair: ContactPair, borders: dict[str, Borders], symmetric: bool, of: PointsOf = NODES
) -> ContactNodes:
    """Contact nodes of a pair on meshes with the given element borders.

    Parameters
    ----------
    borders : of each rod, by name
    symmetric : whether they are those of the halves x >= 0
    of : which points carry contact forces; on ground, which has no nodes, not those of the second face

    Raises
    ------
    ValueError
        if nodes of ground are asked for.
    """
    overlap = pair_overlap(scene, pair)
    first = face_frame(scene.rod(pair.first.rod), pair.first.face)
    own = borders[pair.first.rod]
    if of == "second nodes":
        if not isinstance(pair.second, RodFace):
            raise ValueError(f"of: found '{of}' for pair '{pair.name}', whose second face is ground and has no nodes")
        there = face_frame(scene.rod(pair.second.rod), pair.second.face)
        along, across = _rules(borders[pair.second.rod], there.lateral_axis, overlap.second, of)
        along = _mapped(*along, float(overlap.sign[0]), float(overlap.shift[0]))
        across = across if symmetric else _mapped(*across, float(overlap.sign[1]), float(overlap.shift[1]))
    else:
        along, across = _rules(own, first.lateral_axis, overlap.first, of)
    (station, along_weight), (lateral, across_weight) = along, across
    points = np.stack([np.repeat(station, len(lateral)), np.tile(lateral, len(station))])
    opposite = overlap.sign[:, None] * points + overlap.shift[:, None]
    if symmetric:  # rods with opposite tangents have opposite x
        opposite[1] = np.abs(opposite[1])
    opposite_rows = None
    if isinstance(pair.second, RodFace):
        second = face_frame(scene.rod(pair.second.rod), pair.second.face)
        other = borders[pair.second.rod]
        opposite_rows = _face_rows(other, second.normal_axis, second.side, -float(second.side), opposite)
    return ContactNodes(
        station=station,
        lateral=lateral,
        area=np.outer(along_weight, across_weight),
        gap=np.repeat(gaps(scene, pair, station), len(lateral)),
        penalty=penalty(scene, pair),
        rigid=not on_bed(pair) and of != "first Gauss points",
        first=_face_rows(own, first.normal_axis, first.side, -float(first.side), points),
        second=opposite_rows,
    )


def _rules(
    borders: Borders, lateral_axis: int, extent: tuple[tuple[float, float], tuple[float, float]], of: PointsOf
) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
    """Points and weights along a face and across it, mm."""
    across = borders.x if lateral_axis == 0 else borders.y
    rule = _gauss_points if of == "first Gauss points" else _nodes
    return rule(borders.s, *extent[0]), rule(across, max(extent[1][0], float(across[0])), extent[1][1])


def _nodes(borders: Array, start: float, end: float) -> tuple[Array, Array]:
    nodes, weights = line_nodes(borders), nodal_weights(borders, start, end)
    used = weights > 0.0
    return nodes[used], weights[used]


def _gauss_points(borders: Array, start: float, end: float) -> tuple[Array, Array]:
    root, weight = np.polynomial.legendre.leggauss(GAUSS)
    middle, half = 0.5 * (borders[1:] + borders[:-1]), 0.5 * np.diff(borders)
    used = (middle > start) & (middle < end)
    middle, half = middle[used, None], half[used, None]
    return (middle + half * root).ravel(), (half * weight).ravel()


def _mapped(place: Array, weight: Array, sign: float, shift: float) -> tuple[Array, Array]:
    """Points of the second face on the first one, ascending, and their weights."""
    on_first = sign * (place - shift)
    order = np.argsort(on_first)
    return on_first[order], weight[order]


def _face_rows(borders: Borders, normal_axis: int, side: int, sign: float, points: Array) -> csc_array:
    """Normal displacement of a face, times `sign`, interpolated at (s, lateral); shape (n, unknowns)."""
    n_x, n_y, n_s = (2 * len(axis) - 1 for axis in (borders.x, borders.y, borders.s))
    along, xi_along = locate(borders.s, points[0])
    across, xi_across = locate(borders.x if normal_axis == 1 else borders.y, points[1])
    plane = 2 * along + np.arange(3)[:, None]
    line = 2 * across + np.arange(3)[:, None]
    if normal_axis == 1:
        node = (n_y - 1 if side > 0 else 0) * n_x + line
    else:
        node = line * n_x + (n_x - 1 if side > 0 else 0)
    unknown = 3 * (plane[:, None] * (n_x * n_y) + node[None, :]) + normal_axis
    value = sign * shape_functions(xi_along)[:, None] * shape_functions(xi_across)[None, :]
    row = np.broadcast_to(np.arange(points.shape[1]), value.shape)
    rows = csc_array((value.ravel(), (row.ravel(), unknown.ravel())), shape=(points.shape[1], 3 * n_x * n_y * n_s))
    rows.data[np.abs(rows.data) < 1e-13] = 0.0
    rows.eliminate_zeros()
    return rows


def solve_complementarity(matrix: Array, offset: Array, active: NDArray[np.bool_]) -> Complementarity:
    """F >= 0, w = offset + matrix F >= 0, F^T w = 0 for a symmetric positive definite matrix.

    Block principal pivoting: all nodes of the wrong sign change sides at once; when that stops making
    progress, only the last of them does, which ends for every positive definite matrix (J. J. Judice,
    F. M. Pires, Computers and Operations Research 21 (1994) 587-596).

    Parameters
    ----------
    active : nodes assumed in contact at first, shape (n,)
    """
    active = active.copy()
    best, patience = len(offset) + 1, PATIENCE
    limit = 20 + 2 * len(offset)
    force = np.zeros(len(offset))
    for step in range(1, limit + 1):
        force = np.zeros(len(offset))
        if active.any():
            block = matrix[np.ix_(active, active)]
            force[active] = cho_solve(cho_factor(block, lower=True), -offset[active])
        w = offset + matrix @ force
        w[active] = 0.0
        # signs are certain only beyond round-off
        wrong = np.flatnonzero(
            (force < -1e-12 * np.abs(force).max(initial=0.0)) | (w < -1e-12 * np.abs(offset).max(initial=0.0))
        )
        if len(wrong) == 0:
            return Complementarity(np.maximum(force, 0.0), "converged", step)
        if len(wrong) < best:
            best, patience = len(wrong), PATIENCE
        else:
            patience -= 1
        changing = wrong if patience >= 0 else wrong[-1:]
        active[changing] = ~active[changing]
    return Complementarity(np.maximum(force, 0.0), "cycling", limit)


def solve_nested(matrix: Array, offset: Array, shapes: list[tuple[int, int]], coarsest: int = 12) -> Complementarity:
    """The complementarity problem of whole grids of contact nodes, first on every 2^j-th station along s.

    Each coarser answer tells the finer one which nodes touch, so that few active sets of many nodes are tried.

    Parameters
    ----------
    shapes : (n_s, n_lateral) of the grid of each pair, in the order of the unknowns
    coarsest : stations of the longest grid to begin with, about
    """
    longest = max(stations for stations, _ in shapes)
    stride = 2 ** max(0, int(np.log2(longest / coarsest)))
    number = np.arange(len(offset))
    grids = [
        part.reshape(shape)
        for part, shape in zip(
            np.split(number, np.cumsum([stations * across for stations, across in shapes])[:-1]),
            shapes,
            strict=True,
        )
    ]
    touching, steps = offset < 0.0, 0
    while True:
        nodes = np.concatenate([grid[::stride].ravel() for grid in grids])
        answer = solve_complementarity(matrix[np.ix_(nodes, nodes)], offset[nodes], touching[nodes])
        steps += answer.steps
        if stride == 1:
            return Complementarity(answer.force, answer.outcome, steps)
        force = np.zeros(len(offset))
        force[nodes] = answer.force
        stride //= 2
        # a new station takes over what the coarser one before it says
        for grid in grids:
            coarse = force[grid[:: 2 * stride]] > 0.0
            fine = grid[::stride]
            touching[fine] = np.repeat(coarse, 2, axis=0)[: len(fine)]


@dataclass(frozen=True)
class RigidContact:
    """Solution of a contact problem whose springs stand for rigid contact.

    Attributes
    ----------
    force : F, N, shape (n,)
    given_way : by how much springs are still pressed in, mm, shape (n,)
    outcome : 'converged', 'cycling' or 'refused: ...'
    steps : active sets tried in all solutions
    """

    force: Array
    given_way: Array
    outcome: str
    steps: int


def without_penetration(
    matrix: Array, offset: Array, soft: Array, rigid: NDArray[np.bool_], first: Complementarity
) -> RigidContact:
    """Take the penetration away that the springs of rigid contact leave.

    Parameters
    ----------
    matrix : C + diag(soft), shape (n, n)
    soft : 1 / (c_n A), mm/N, shape (n,)
    rigid : nodes in rigid contact; at the others the springs are meant, shape (n,)
    first : solution with the springs as they are
    """
    answer, steps = first, first.steps
    moved = np.zeros(len(offset))
    for _ in range(MOST_MOVES):
        before = answer.force
        # springs that have moved so far push this much before they are pressed in
        moved = np.where(rigid, soft * before, 0.0)
        answer = solve_complementarity(matrix, offset - moved, before > 0.0)
        steps += answer.steps
        changed = float(np.abs(answer.force - before)[rigid].sum())
        if answer.outcome != "converged" or changed <= STAYING * before.sum():
            break
    else:
        share = changed / float(before.sum())
        outcome = f"refused: the penalty is too soft, forces still change by {share:.1e} after {MOST_MOVES} corrections"
        return RigidContact(answer.force, soft * answer.force - moved, outcome, steps)
    return RigidContact(answer.force, soft * answer.force - moved, answer.outcome, steps)


def near_contact(station: Array, touched: Array, margin: float) -> NDArray[np.bool_]:
    """Which stations lie within a margin of one that is touched, shape (n,); all in mm."""
    distance = np.abs(station[:, None] - touched).min(axis=1, initial=np.inf)
    return np.asarray(distance <= margin)
