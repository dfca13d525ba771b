"""Any rod as a 3D body: planes of nodes along its centre line, element matrices by kinds of layers, nodal loads.

Unknowns are the components of displacement in the frame of each plane, in arrays of shape (n_planes, n_nodes, 3).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array

from cases.scene import Bed, Gravity, LineLoad, Load, Pressure, Rod, Scene, SectionForce, SectionMoment
from reference3d.centre_line import frames, points, stretches
from reference3d.faces import bed_matrices, face_points, gauss_face, pressure_forces
from reference3d.layers import layer_borders
from reference3d.quadratic import line_nodes, nodal_weights
from reference3d.section_mesh import SectionIntegrals, SectionMesh, face_edges, integrals, section_mesh
from reference3d.solid_elasticity import GAUSS, LayerGeometry, LayerMatrices, elasticity, layer_matrices

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# layers of lengths that differ by less, over the longest, are alike
SAME_LENGTH = 1e-9


@dataclass(frozen=True, eq=False)
class Springs:
    """Element faces on a bed: their section nodes, shape (n, 3), and stiffness, shape (n, 27, 27)."""

    edges: IntArray
    stiffness: Array


@dataclass(frozen=True, eq=False)
class SolidBody:
    """A meshed rod.

    Attributes
    ----------
    borders : of the layers, arc length, mm, shape (n_layers + 1,)
    points, axes : centre line, global, mm, and rows e1, e2, t in the planes, shapes (n_planes, 3), (n_planes, 3, 3)
    kind : of each layer
    layers, springs : of each kind; springs of every bed under it
    """

    rod: Rod
    section: SectionMesh
    integrals: SectionIntegrals
    hooke: Array
    borders: Array
    points: Array
    axes: Array
    kind: IntArray
    layers: tuple[LayerMatrices, ...]
    springs: tuple[tuple[Springs, ...], ...]

    @property
    def stations(self) -> Array:
        """Arc lengths of the planes, mm, shape (n_planes,)."""
        return line_nodes(self.borders)

    @property
    def shape(self) -> tuple[int, int, int]:
        """Of arrays of unknowns."""
        return 2 * len(self.kind) + 1, len(self.section.nodes), 3

    def border_at(self, station: float) -> int:
        """Number of the layer border at an arc length, where something acts or holds."""
        return int(np.argmin(np.abs(self.borders - station)))

    def assembly(self, motions: csr_array | None = None) -> Callable[[int], Array]:
        """Gives the stiffness of the layers of a kind, beds included, on their start, middle and end plane, N/mm.

        motions : of a plane that are possible, orthonormal columns with one entry a row at most, shape (m, n); all
            unknowns if None. Matrices have shape (3 n, 3 n).
        """
        count = 3 * len(self.section.nodes)
        size, column, value = count, np.arange(count), np.ones(count)
        if motions is not None:
            size, column, value = motions.shape[1], np.zeros(count, dtype=np.int64), np.zeros(count)
            rows, columns = motions.tocoo().coords
            column[rows], value[rows] = columns, motions.tocoo().data

        def places(nodes: IntArray) -> tuple[IntArray, Array]:
            unknown = (3 * nodes[:, None, :, None] + np.arange(3)).repeat(3, axis=1).reshape(len(nodes), -1)
            place = column[unknown] + size * np.repeat(np.arange(3), unknown.shape[1] // 3)
            share = value[unknown]
            entry = 3 * size * place[:, :, None] + place[:, None, :]
            return entry.ravel(), share[:, :, None] * share[:, None, :]

        solid_entry, solid_share = places(self.section.quads)

        def matrix(kind: int) -> Array:
            forces = (self.layers[kind].stiffness * solid_share).ravel()
            found = np.zeros(9 * size * size)
            found += np.bincount(solid_entry, forces, len(found))
            for springs in self.springs[kind]:
                entry, share = places(springs.edges)
                found += np.bincount(entry, (springs.stiffness * share).ravel(), len(found))
            return found.reshape(3 * size, 3 * size)

        return matrix

    def internal_forces(self, displacement: Array) -> tuple[Array, Array]:
        """Nodal forces that the solid and that the beds need for a displacement; arrays of unknowns."""
        solid, beds = np.zeros(self.shape), np.zeros(self.shape)
        for kind, layer in enumerate(self.layers):
            planes = 2 * np.flatnonzero(self.kind == kind)[:, None] + np.arange(3)
            self._add(solid, displacement, planes, self.section.quads, layer.stiffness)
            for springs in self.springs[kind]:
                self._add(beds, displacement, planes, springs.edges, springs.stiffness)
        return solid, beds

    def _add(self, force: Array, displacement: Array, planes: IntArray, nodes: IntArray, matrices: Array) -> None:
        """Add the forces of the elements on `nodes` (n, k) between the planes of layers (n_layers, 3)."""
        place = planes[:, None, :, None], nodes[None, :, None, :]
        moved = displacement[place].reshape(len(planes), len(nodes), -1)
        found = np.einsum("eij,lej->lei", matrices, moved, optimize=True)
        np.add.at(force, place, found.reshape(len(planes), len(nodes), 3, -1, 3))


def solid_body(scene: Scene, rod: Rod, refinement: int) -> SolidBody:
    """Mesh of a rod and its element matrices.

    refinement : k of `section_mesh` and `layers`
    """
    section = section_mesh(rod.section, refinement)
    borders = layer_borders(scene, rod, refinement)
    stations = line_nodes(borders)
    position, axes = points(rod.centre_line, stations), frames(rod.centre_line, stations)
    root = np.polynomial.legendre.leggauss(GAUSS)[0]
    half, middle = 0.5 * np.diff(borders), 0.5 * (borders[1:] + borders[:-1])
    inside = frames(rod.centre_line, (middle[:, None] + half[:, None] * root).ravel()).reshape(-1, GAUSS, 3, 3)
    beds = [bed for bed in scene.beds if bed.rod == rod.name]
    kind, first = _kinds(rod, borders, beds)
    hooke = elasticity(rod.material)
    layers, springs = [], []
    for layer in first:
        planes = slice(2 * layer, 2 * layer + 3)
        geometry = LayerGeometry(position[planes], axes[planes], inside[layer])
        layers.append(layer_matrices(section, geometry, hooke))
        here = [bed for bed in beds if bed.start < middle[layer] < bed.end]
        springs.append(tuple(_springs(section, rod, bed, geometry) for bed in here))
    return SolidBody(
        rod,
        section,
        integrals(section),
        hooke,
        borders,
        position,
        axes,
        kind,
        tuple(layers),
        tuple(springs),
    )


def _kinds(rod: Rod, borders: Array, beds: Sequence[Bed]) -> tuple[IntArray, IntArray]:
    """Kind of every layer, and the first layer of every kind: alike are those of one length, stretch and bed."""
    length, middle = np.diff(borders), 0.5 * (borders[1:] + borders[:-1])
    parts = stretches(rod.centre_line)
    part = np.searchsorted([each.start for each in parts], middle) - 1
    even = np.array([each.even for each in parts])[part]
    rounded = np.round(length / (SAME_LENGTH * length.max()))
    alone = np.where(even, -1, np.arange(len(length)))
    under = [np.where((bed.start < middle) & (middle < bed.end), 1, 0) for bed in beds]
    key = np.stack([part, alone, rounded, *under])
    _, first, kind = np.unique(key, axis=1, return_index=True, return_inverse=True)
    return kind.ravel().astype(np.int64), first.astype(np.int64)


def _springs(section: SectionMesh, rod: Rod, bed: Bed, geometry: LayerGeometry) -> Springs:
    edges = face_edges(section, rod.section, bed.face.face)
    zeta, eta, weight = gauss_face()
    found = face_points(section, edges, bed.face.face, geometry.points, geometry.axes, zeta, eta)
    return Springs(edges, bed_matrices(found, geometry.axes, weight, bed.modulus))


def nodal_loads(body: SolidBody, loads: Sequence[Load]) -> Array:
    """All loads on a body as forces of its nodes, N, an array of unknowns."""
    force = np.zeros(body.shape)
    for load in loads:
        if load.rod != body.rod.name:
            continue
        match load:
            case SectionForce() | SectionMoment():
                plane = 2 * body.border_at(load.position)
                vector = load.force if isinstance(load, SectionForce) else load.moment
                rows = body.integrals.mean_motion()[0 if isinstance(load, SectionForce) else 3 :][:3]
                force[plane] += np.tensordot(body.axes[plane] @ np.array(vector), rows, axes=1)
            case LineLoad():
                along = nodal_weights(body.borders, load.start, load.end)
                spread = body.integrals.even / body.integrals.area
                force += np.einsum("p,pac,c,n->pna", along, body.axes, np.array(load.force), spread)
            case Pressure():
                _add_pressure(force, body, load)
            case Gravity():
                _add_weight(force, body, load)
    return force


def _add_pressure(force: Array, body: SolidBody, load: Pressure) -> None:
    edges = face_edges(body.section, body.rod.section, load.face.face)
    zeta, eta, weight = gauss_face()
    middle = 0.5 * (body.borders[1:] + body.borders[:-1])
    for layer in np.flatnonzero((load.start < middle) & (middle < load.end)).tolist():
        planes = np.arange(2 * layer, 2 * layer + 3)
        axes = body.axes[planes]
        found = face_points(body.section, edges, load.face.face, body.points[planes], axes, zeta, eta)
        nodal = load.pressure * pressure_forces(found, axes, weight)
        np.add.at(force, (planes[:, None], edges[:, None, :]), nodal)


def _add_weight(force: Array, body: SolidBody, load: Gravity) -> None:
    assert body.rod.material.density is not None  # a scene with gravity asks for it
    pull = body.axes @ (body.rod.material.density * np.array(load.acceleration))  # N/mm^3 by plane
    for layer, kind in enumerate(body.kind.tolist()):
        planes = np.arange(2 * layer, 2 * layer + 3)
        volume = body.layers[kind].volume.reshape(-1, 3, 9)
        nodal = volume[..., None] * pull[planes][None, :, None, :]
        np.add.at(force, (planes[:, None], body.section.quads[:, None, :]), nodal)
