"""Contact nodes of a pair of faces of any rods: their areas, gaps and the rows that make gaps of displacements.

Contact is the one of `contact`: every node of the first face in the zone that has a point of the second straight
across the gap, along the normal of the first, may carry a force along that normal.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from cases.scene import ContactPair, RodFace, Scene
from reference3d.faces import face_points, gauss_face
from reference3d.facing import Opposite, face_place, opposite, surface, surface_normal
from reference3d.frames import gaps
from reference3d.quadratic import locate, shape_functions
from reference3d.scope import on_bed, penalty
from reference3d.section_mesh import face_edges
from reference3d.solid_body import SolidBody

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class SolidContact:
    """Nodes of the first face of a pair that may touch, n of a grid along and across it.

    Attributes
    ----------
    station, lateral : of the grid, mm, shapes (n_s,), (n_lateral,)
    place : numbers of the nodes in the grid, shape (n,)
    position, normal : points of the first face and its outward normals, global, mm, shape (n, 3)
    area : that a node stands for, mm^2, shape (n,)
    gap : at first, mm, shape (n,)
    penalty : N/mm^3
    rigid : whether penetration is to be taken away: the penalty is not a bed's modulus
    rows : by rod, so that the gap is gap + sum of rows @ displacement, shape (n, unknowns of the rod)
    """

    pair: ContactPair
    station: Array
    lateral: Array
    place: IntArray
    position: Array
    normal: Array
    area: Array
    gap: Array
    penalty: float
    rigid: bool
    rows: Mapping[str, csr_array]

    @property
    def soft(self) -> Array:
        """1 / (c_n A), mm/N, shape (n,)."""
        return 1.0 / (self.penalty * self.area)


def solid_contact(scene: Scene, pair: ContactPair, bodies: Mapping[str, SolidBody]) -> SolidContact:
    """Contact nodes of a pair."""
    body = bodies[pair.first.rod]
    rod, face = body.rod, pair.first.face
    edges = _in_order(body, face_edges(body.section, rod.section, face), face_place(rod, face).axis)
    line = np.append(edges[:, :2].ravel(), edges[-1, 2])
    lateral = body.section.nodes[line, 1 - face_place(rod, face).axis]
    middle = 0.5 * (body.borders[1:] + body.borders[:-1])
    layers = np.flatnonzero((pair.zone[0] < middle) & (middle < pair.zone[1]))
    planes = np.arange(2 * layers[0], 2 * layers[-1] + 3)
    station = body.stations[planes]
    grid = np.repeat(station, len(lateral)), np.tile(lateral, len(station))
    position, normal = surface(rod, face, *grid), surface_normal(rod, face, *grid)
    found, distance = np.ones(len(position), dtype=bool), np.zeros(len(position))
    across: Opposite | None = None
    if isinstance(pair.second, RodFace):
        across = opposite(position, normal, scene.rod(pair.second.rod), pair.second.face)
        found, distance = across.found, across.distance
    area = _areas(body, pair, edges, layers, found.reshape(len(station), len(lateral)))
    place = np.flatnonzero(found & (area > 0.0))
    own = np.divmod(place, len(lateral))
    rows = {rod.name: _own_rows(body, planes[own[0]], line[own[1]], normal[place])}
    if across is not None and isinstance(pair.second, RodFace):
        other = bodies[pair.second.rod]
        rows[other.rod.name] = _opposite_rows(other, pair.second, across, normal, place)
    return SolidContact(
        pair=pair,
        station=station,
        lateral=lateral,
        place=place,
        position=position[place],
        normal=normal[place],
        area=area[place],
        gap=distance[place] if pair.gap == "drawn" else gaps(scene, pair, grid[0][place]),
        penalty=penalty(scene, pair),
        rigid=not on_bed(pair),
        rows=rows,
    )


def _in_order(body: SolidBody, edges: IntArray, axis: int) -> IntArray:
    """Element edges one after the other across a face."""
    return edges[np.argsort(body.section.nodes[edges[:, 1], 1 - axis])]


def _areas(body: SolidBody, pair: ContactPair, edges: IntArray, layers: IntArray, found: NDArray[np.bool_]) -> Array:
    """Integrals of the nodal functions over the element faces whose middle has a partner, mm^2, over the grid."""
    zeta, eta, weight = gauss_face()
    area = np.zeros(found.shape)
    for number, layer in enumerate(layers.tolist()):
        planes = slice(2 * layer, 2 * layer + 3)
        points = face_points(body.section, edges, pair.first.face, body.points[planes], body.axes[planes], zeta, eta)
        nodal = (np.linalg.norm(points.area, axis=2) * weight) @ points.values
        for edge in np.flatnonzero(found[2 * number + 1, 1::2]).tolist():
            area[2 * number : 2 * number + 3, 2 * edge : 2 * edge + 3] += nodal[edge].reshape(3, 3)
    return area.ravel()


def _own_rows(body: SolidBody, plane: IntArray, node: IntArray, normal: Array) -> csr_array:
    """Displacement of nodes against normals by unknowns of the body."""
    local = -np.einsum("nbc,nc->nb", body.axes[plane], normal)
    unknown = 3 * (plane * len(body.section.nodes) + node)[:, None] + np.arange(3)
    return _rows(body, local, unknown)


def _opposite_rows(body: SolidBody, face: RodFace, across: Opposite, normal: Array, place: IntArray) -> csr_array:
    """Displacement of points of the second face along normals by unknowns of the body."""
    axis = face_place(body.rod, face.face).axis
    edges = _in_order(body, face_edges(body.section, body.rod.section, face.face), axis)
    borders = np.append(body.section.nodes[edges[:, 0], 1 - axis], body.section.nodes[edges[-1, 2], 1 - axis])
    layer, zeta = locate(body.borders, across.station[place])
    edge, eta = locate(borders, across.lateral[place])
    plane = 2 * layer[:, None] + np.arange(3)
    local = np.einsum("npbc,nc->npb", body.axes[plane], normal[place])
    value = np.einsum("pn,an,npb->npab", shape_functions(zeta), shape_functions(eta), local)
    node = plane[:, :, None] * len(body.section.nodes) + edges[edge][:, None, :]
    unknown = 3 * node[..., None] + np.arange(3)
    return _rows(body, value.reshape(len(place), -1), unknown.reshape(len(place), -1))


def _rows(body: SolidBody, value: Array, unknown: IntArray) -> csr_array:
    count = len(value)
    row = np.repeat(np.arange(count), value.shape[1] if count else 0)
    return csr_array((value.ravel(), (row, unknown.ravel())), shape=(count, int(np.prod(body.shape))))
