"""Contact of rods of any elements: pressure linear on the first face's facets, gaps as means weighted alike.

With phi_i the linear function of corner i and A_i its integral over the facets in the zone, p = sum phi_i F_i / A_i and
d_i = int phi_i d / A_i are conjugate, so that F >= 0, d >= 0, F d = 0 is the problem of `contact`. Nodes of quadratic
faces would not do: the functions of corners of 8-node and 6-node faces have integrals that are negative or zero, while
phi_i is positive on every face, and pressure of one degree less than displacement does not oscillate.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from cases.scene import ContactPair, RodFace, Scene, SceneError
from reference3d.facing import opposite
from reference3d.frames import gaps
from reference3d.own_mesh.arc_length import arc_lengths
from reference3d.own_mesh.body import OwnBody
from reference3d.scope import on_bed, penalty

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# corners that stand for less, over the largest area of one, take no part
LEAST_AREA = 1e-6
# points whose opposite is looked for at a time
AT_A_TIME = 2000


@dataclass(frozen=True, eq=False)
class OwnContact:
    """Corners of the facets of the first face that may carry pressure.

    Attributes
    ----------
    nodes : of the first rod's mesh, shape (n,)
    position, normal : mean point and outward normal of what a corner stands for, global, mm, shape (n, 3)
    area : mm^2, shape (n,)
    gap : at first, mm, shape (n,)
    soft : 1 / (c_n A), mm/N, shape (n,)
    rigid : whether penetration is to be taken away: the penalty is not a bed's modulus
    rows : by rod, so that the gap is gap + sum of rows @ displacement, shape (n, unknowns of the rod)
    """

    pair: ContactPair
    nodes: IntArray
    position: Array
    normal: Array
    area: Array
    gap: Array
    soft: Array
    rigid: bool
    rows: Mapping[str, csr_array]


@dataclass(frozen=True, eq=False)
class _Facets:
    """Quadrature points of facets: positions, outward normals, areas, and functions of the element's corners there."""

    element: IntArray
    local: Array
    position: Array
    normal: Array
    area: Array
    corners: IntArray
    hats: Array


def own_contact(scene: Scene, pair: ContactPair, bodies: Mapping[str, OwnBody]) -> OwnContact:
    """Corners of the first face and what their gaps are made of.

    Raises
    ------
    SceneError
        if nothing of the first face in the zone has anything opposite.
    """
    body = bodies[pair.first.rod]
    facets = _facets(body, pair.first.face)
    station = arc_lengths(body.mesh.rod, facets.position)
    inside = (station >= pair.zone[0]) & (station <= pair.zone[1])
    distance, across = np.zeros(len(station)), np.zeros_like(facets.position)
    if isinstance(pair.second, RodFace):
        other = scene.rod(pair.second.rod)
        for part in np.array_split(np.flatnonzero(inside), max(1, int(inside.sum()) // AT_A_TIME)):
            there = opposite(facets.position[part], facets.normal[part], other, pair.second.face)
            inside[part], distance[part] = there.found, there.distance
        across = facets.position + distance[:, None] * facets.normal
    area = np.where(inside, facets.area, 0.0)
    used = np.flatnonzero(area)
    if len(used) == 0:
        found = f"{pair.zone[0]:g} .. {pair.zone[1]:g}"
        raise SceneError(f"contacts.{pair.name}.zone", found, "no facet of the first face there has anything opposite")
    functions = coo_array(
        (
            (facets.hats * area[:, None]).ravel(),
            (facets.corners.ravel(), np.repeat(np.arange(len(area)), facets.corners.shape[1])),
        ),
        shape=(len(body.mesh.nodes), len(area)),
    ).tocsr()
    whole = np.asarray(functions.sum(axis=1)).ravel()
    nodes = np.flatnonzero(whole > LEAST_AREA * whole.max())
    mean = csr_array(functions[nodes][:, used] / whole[nodes, None])
    normal = facets.normal[used]
    rows = {body.mesh.rod.name: -mean @ _along(normal, body, facets, used)}
    if isinstance(pair.second, RodFace):
        opposed = bodies[pair.second.rod]
        rows[pair.second.rod] = mean @ _normal_rows(normal, opposed.interpolation(opposed.find(across[used])))
    gap = distance if pair.gap == "drawn" else gaps(scene, pair, station)
    stiffness = penalty(scene, pair)
    return OwnContact(
        pair,
        nodes,
        mean @ facets.position[used],
        _unit(mean @ normal),
        whole[nodes],
        mean @ gap[used],
        1.0 / (stiffness * whole[nodes]),
        not on_bed(pair),
        rows,
    )


def _facets(body: OwnBody, face: str) -> _Facets:
    """Every quadrature point of a group of facets."""
    mesh, group = body.mesh, body.mesh.groups[face]
    parts = []
    for number in np.unique(group.face).tolist():
        elements = group.element[group.face == number]
        place, tangents, hats, weight = mesh.kind.face_quadrature(number)
        nodes = mesh.nodes[mesh.elements[elements]]
        position = np.einsum("qn,enc->eqc", mesh.kind.functions(place), nodes)
        mapping = np.einsum("enc,qnd->eqcd", nodes, mesh.kind.slopes(place))
        along = np.einsum("eqcd,qtd->eqtc", mapping, tangents)
        outward = np.cross(along[:, :, 0], along[:, :, 1])
        size = np.linalg.norm(outward, axis=2)
        count = len(elements)
        shape = (count * len(weight), -1)
        parts.append(
            (
                np.repeat(elements, len(weight)),
                np.tile(place, (count, 1)),
                position.reshape(shape),
                (outward / size[:, :, None]).reshape(shape),
                (size * weight).ravel(),
                np.repeat(mesh.elements[elements][:, mesh.kind.faces[number]], len(weight), axis=0),
                np.tile(hats, (count, 1)),
            )
        )
    return _Facets(*(np.concatenate(each) for each in zip(*parts, strict=True)))


def _along(normal: Array, body: OwnBody, facets: _Facets, used: IntArray) -> csr_array:
    """Displacement of the body along normals at its own quadrature points, shape (n, unknowns)."""
    functions = body.mesh.kind.functions(facets.local[used])
    nodes = body.mesh.elements[facets.element[used]]
    columns = 3 * nodes[:, :, None] + np.arange(3)
    values = functions[:, :, None] * normal[:, None]
    rows = np.broadcast_to(np.arange(len(used))[:, None, None], columns.shape)
    shape = (len(used), body.unknowns)
    return coo_array((values.ravel(), (rows.ravel(), columns.ravel())), shape=shape).tocsr()


def _normal_rows(normal: Array, interpolation: csr_array) -> csr_array:
    """Displacement along normals from the rows of its three components at every point."""
    count = len(normal)
    pick = coo_array((normal.ravel(), (np.repeat(np.arange(count), 3), np.arange(3 * count))))
    return csr_array(pick.tocsr() @ interpolation)


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
