"""Rods and ground in 20-node hexahedra: those nodes of the 27-node meshes of `solid_body` that the edges carry.

The functions of 20 nodes are among those of 27: what they are at the centres of faces and bodies gives nodal forces
and displacements of one mesh from those of the other.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from cases.scene import ContactPair, Face, Load, Scene
from reference3d.facing import face_place, surface, surface_normal
from reference3d.frames import gaps
from reference3d.quadratic import locate, shape_functions
from reference3d.section_mesh import face_edges
from reference3d.solid_body import SolidBody, nodal_loads
from reference3d.solid_solution import SolidRod

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# of the 9 nodes of a section's element, anticlockwise: corners, and the middles of the sides that follow them
CORNERS, MIDDLES, CENTRE = (0, 2, 8, 6), (1, 5, 7, 3), 4
# names of the element's faces on those sides, in Abaqus as in CalculiX
SIDES = ("S3", "S4", "S5", "S6")
# how far ground reaches beyond the face above it, over half the face's width and over a layer's length
BEYOND = 0.1


@dataclass(frozen=True, eq=False)
class Hexahedra:
    """20-node hexahedra between planes of nodes; the planes are numbered as the 27-node mesh has them.

    Attributes
    ----------
    quads : of every layer, as in `SectionMesh`, shape (n_quads, 9)
    position : of the nodes of the 27-node mesh, global, mm, shape (n_planes, n_nodes, 3)
    first_node, first_element : numbers
    """

    quads: IntArray
    position: Array
    first_node: int
    first_element: int

    @cached_property
    def number(self) -> IntArray:
        """Numbers of the nodes, 0 for those of the 27-node mesh that are none of 20; shape (n_planes, n_nodes)."""
        kept = np.zeros(self.position.shape[:2], dtype=bool)
        kept[:, self.quads[:, CORNERS]] = True
        kept[::2, self.quads[:, MIDDLES]] = True
        number = np.zeros(kept.shape, dtype=np.int64)
        number[kept] = self.first_node + np.arange(kept.sum())
        return number

    @property
    def node_count(self) -> int:
        """How many nodes there are."""
        return int((self.number > 0).sum())

    @property
    def element_count(self) -> int:
        """How many elements there are."""
        return (len(self.position) // 2) * len(self.quads)

    @property
    def coordinates(self) -> Array:
        """Of the nodes in the order of their numbers, mm, shape (node_count, 3)."""
        return np.asarray(self.position[self.number > 0])

    @property
    def elements(self) -> IntArray:
        """Numbers of the nodes of every element, as Abaqus orders them, shape (n_layers, n_quads, 20)."""
        start, middle, end = (self.number[offset : len(self.number) - 2 + offset : 2] for offset in range(3))
        corners, middles = self.quads[:, CORNERS], self.quads[:, MIDDLES]
        parts = [start[:, corners], end[:, corners], start[:, middles], end[:, middles], middle[:, corners]]
        return np.concatenate(parts, axis=2)

    def element_numbers(self, layers: IntArray) -> IntArray:
        """Numbers of the elements of layers, shape (n, n_quads)."""
        return np.asarray(self.first_element + layers[:, None] * len(self.quads) + np.arange(len(self.quads)))

    def on_sides(self, layers: IntArray, middles: IntArray) -> dict[str, list[int]]:
        """Numbers of the elements of layers that have a face on the sides with the given middles, by its name."""
        numbers = self.element_numbers(layers)
        found = {}
        for name, middle in zip(SIDES, MIDDLES, strict=True):
            on_it = np.isin(self.quads[:, middle], middles)
            if on_it.any():
                found[name] = numbers[:, on_it].ravel().tolist()
        return found

    @cached_property
    def expansion(self) -> csr_array:
        """Values at all nodes of the 27-node mesh from those at the 20 of every element, shape (n_27, n_20).

        The shape functions of a 20-node hexahedron at the centre of a face are -1/4 at its corners and 1/2 at its
        middles; at the centre of the body -1/4 at corners and 1/4 at middles.
        """
        planes, count = self.position.shape[:2]
        here = np.arange(planes * count).reshape(planes, count)
        odd = np.arange(1, planes, 2)
        corners, middles, centre = self.quads[:, CORNERS], self.quads[:, MIDDLES], self.quads[:, CENTRE]
        following = np.roll(corners, -1, axis=1)
        side, first = np.unique(middles, return_index=True)
        a, b = corners.ravel()[first], following.ravel()[first]
        terms: list[tuple[IntArray, IntArray, float]] = []

        def add(rows: IntArray, columns: Sequence[IntArray], weight: float) -> None:
            terms.extend((rows, column, weight) for column in columns)

        kept = here[self.number > 0]
        add(kept, [kept], 1.0)
        for place in range(4):
            add(here[::2, centre], [here[::2, corners[:, place]]], -0.25)
            add(here[::2, centre], [here[::2, middles[:, place]]], 0.5)
            for other in (odd - 1, odd + 1):
                add(here[odd][:, centre], [here[other][:, corners[:, place]]], -0.25)
                add(here[odd][:, centre], [here[other][:, middles[:, place]]], 0.25)
            add(here[odd][:, centre], [here[odd][:, corners[:, place]]], 0.25)
        for other in (odd - 1, odd + 1):
            add(here[odd][:, side], [here[other][:, a], here[other][:, b]], -0.25)
            add(here[odd][:, side], [here[other][:, side]], 0.5)
        add(here[odd][:, side], [here[odd][:, a], here[odd][:, b]], 0.5)
        rows, columns, weights = (
            np.concatenate([np.broadcast_to(np.asarray(term[part]), term[0].shape).ravel() for term in terms])
            for part in range(3)
        )
        place_of = np.zeros(planes * count, dtype=np.int64)
        place_of[kept] = np.arange(len(kept))
        return csr_array(coo_array((weights, (rows, place_of[columns])), shape=(planes * count, len(kept))))


@dataclass(frozen=True, eq=False)
class HexRod:
    """A rod in 20-node hexahedra."""

    body: SolidBody
    mesh: Hexahedra

    def forces(self, loads: Sequence[Load]) -> Array:
        """Nodal forces of loads, global components, N, shape (node_count, 3)."""
        local = nodal_loads(self.body, loads)
        everywhere = np.einsum("pna,pab->pnb", local, self.body.axes).reshape(-1, 3)
        return np.asarray(self.mesh.expansion.T @ everywhere)

    def centre_line(self, displacement: Array, station: Array) -> Array:
        """Displacement of the centre line at arc lengths (mm) from nodal ones, global, mm, shape (3, n).

        Of sections without material at their centroid it is the mean over the section.
        """
        layer, zeta = locate(self.body.borders, np.asarray(station, dtype=np.float64))
        everywhere = (self.mesh.expansion @ displacement).reshape(self.body.shape)
        by_plane = np.tensordot(SolidRod(self.body, everywhere).centre, everywhere, axes=(0, 1))
        planes = 2 * layer + np.arange(3)[:, None]
        return np.asarray(np.einsum("pk,pkc->ck", shape_functions(zeta), by_plane[planes]))

    def face(self, face: Face, layers: IntArray) -> dict[str, list[int]]:
        """Elements of layers on a lateral face, by the name of their own face there."""
        return self.mesh.on_sides(layers, face_edges(self.body.section, self.body.rod.section, face)[:, 1])

    def layers(self, start: float, end: float) -> IntArray:
        """Numbers of the layers between two arc lengths."""
        middle = 0.5 * (self.body.borders[1:] + self.body.borders[:-1])
        return np.flatnonzero((start < middle) & (middle < end)).astype(np.int64)


def hex_rod(body: SolidBody, first_node: int, first_element: int) -> HexRod:
    """A rod in 20-node hexahedra, numbered from given numbers on."""
    position = body.points[:, None] + np.einsum("na,pab->pnb", body.section.nodes, body.axes[:, :2])
    return HexRod(body, Hexahedra(body.section.quads, position, first_node, first_element))


def hex_ground(
    scene: Scene, pair: ContactPair, rod: HexRod, scale: float, first_node: int, first_element: int
) -> Hexahedra:
    """Ground under the zone of a pair, one element wide and high, its upper side (`GROUND_SIDE`) across the gap.

    scale : by which the gap is multiplied
    """
    body, face = rod.body, pair.first.face
    layers = rod.layers(*pair.zone)
    station = body.stations[2 * layers[0] : 2 * layers[-1] + 3]
    half_width = face_place(body.rod, face).half_width
    across = (1.0 + BEYOND) * half_width * np.array([-1.0, 0.0, 1.0])
    grid = np.repeat(station, 3), np.tile(across, len(station))
    normal = surface_normal(body.rod, face, *grid)
    gap = scale * gaps(scene, pair, grid[0])
    upper = (surface(body.rod, face, *grid) + gap[:, None] * normal).reshape(len(station), 3, 3)
    for end, inner in ((0, 1), (-1, -2)):
        upper[end] += BEYOND * (upper[end] - upper[inner])
    depth = 2.0 * half_width * normal.reshape(len(station), 3, 3)
    position = np.stack([upper + depth, upper + 0.5 * depth, upper], axis=1)
    along, sideways, upwards = upper[1, 1] - upper[0, 1], upper[0, 2] - upper[0, 0], -depth[0, 1]
    if np.linalg.det([sideways, upwards, along]) < 0.0:
        position = position[:, :, ::-1]
    return Hexahedra(np.arange(9)[None], position.reshape(len(station), 9, 3), first_node, first_element)


# the name of the face of ground's elements that looks at the rod, and the middle of that side
GROUND_SIDE = {"S5": 7}
