"""What holds rods in a deck: given displacements of nodes, linear equations between them, springs to ground.

Equations say what boundary conditions alone cannot: supports in frames that do not lie along the global axes, supports
of a section's mean, joints, and the points of a face that lies on a bed.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from cases.scene import COMPONENTS, Bed, Clamp, Scene, Support, station_of
from reference3d.faces import face_points, gauss_face
from reference3d.holds import joint_point
from reference3d.peers.deck_mesh import HexRod
from reference3d.section_mesh import face_edges

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# terms of an equation, over its largest, that are round-off
NO_TERM = 1e-12
# the same of the axes of a frame
ALIGNED = 1e-12


@dataclass(frozen=True)
class Term:
    """One term of a linear equation: coefficient times the displacement of a node along an axis (1 to 3)."""

    node: int
    axis: int
    coefficient: float


@dataclass(frozen=True, eq=False)
class Holds:
    """Everything that holds nodes; lengths in mm.

    Attributes
    ----------
    clamped : nodes of every clamp and of every support of all components, by (rod, arc length)
    given : displacements by (node, axis 1 to 3); those that are zero, too
    equations : sums of terms that are zero; the first term is for elimination and in no other equation
    points : further nodes, global, mm, by number; the axes along which nothing holds them are given as zero
    springs : nodes that a spring of the stiffness of every bed (N/mm) holds along axis 1, by number of the bed
    """

    clamped: dict[tuple[str, float], IntArray] = field(default_factory=dict)
    given: dict[tuple[int, int], float] = field(default_factory=dict)
    equations: list[list[Term]] = field(default_factory=list)
    points: dict[int, Array] = field(default_factory=dict)
    springs: dict[int, list[int]] = field(default_factory=dict)


def deck_holds(scene: Scene, rods: Mapping[str, HexRod], scale: float, first_node: int) -> Holds:
    """All that holds the nodes of a scene.

    Parameters
    ----------
    scale : by which prescribed displacements are multiplied
    first_node : number of the first further node
    """
    found = _Writer(Holds(), scale, first_node)
    for support in scene.supports:
        rod = rods[support.rod]
        if isinstance(support, Clamp):
            found.clamp(rod, support)
        else:
            found.support(rod, support)
    for number, joint in enumerate(scene.joints):
        ends = [(rods[end.rod], 0 if end.end == "start" else -1) for end in joint.ends]
        found.joint(ends, joint_point(scene, number))
    for number, bed in enumerate(scene.beds):
        found.bed(rods[bed.rod], bed, number)
    return found.holds


class _Writer:
    """Collects holds and numbers the further nodes that they need."""

    def __init__(self, holds: Holds, scale: float, first_node: int) -> None:
        self.holds, self.scale, self.next_node = holds, scale, first_node

    def point(self, place: Array, held: Sequence[int] = ()) -> int:
        """A further node; held : axes along which it rests."""
        number = self.next_node
        self.next_node += 1
        self.holds.points[number] = np.asarray(place)
        for axis in held:
            self.holds.given[number, axis] = 0.0
        return number

    def clamp(self, rod: HexRod, clamp: Clamp) -> None:
        station = station_of(clamp, rod.body.rod)
        nodes, position = _section(rod, 2 * rod.body.border_at(station))
        centre = rod.body.points[2 * rod.body.border_at(station)]
        moved = np.array(clamp.displacement) + np.cross(np.array(clamp.rotation), position - centre)
        self.whole_section(rod, station, nodes, moved)

    def whole_section(self, rod: HexRod, station: float, nodes: IntArray, moved: Array) -> None:
        self.holds.clamped[rod.body.rod.name, station] = nodes
        for node, vector in zip(nodes.tolist(), (self.scale * moved).tolist(), strict=True):
            for axis, value in enumerate(vector, 1):
                self.holds.given[node, axis] = value

    def support(self, rod: HexRod, support: Support) -> None:
        body = rod.body
        border = body.border_at(support.position)
        axes = body.axes[2 * border]
        numbers = [COMPONENTS.index(component) for component in support.components]
        wanted = np.array(support.displacement or (0.0,) * len(numbers))
        nodes, position = _section(rod, 2 * border)
        if support.of == "mean":
            rows = np.zeros((body.shape[0], body.shape[1], len(numbers), 3))
            motion = body.integrals.mean_motion()[numbers]
            rows[2 * border] = np.einsum("kna,ab->nkb", motion, axes)
            sparse = rod.mesh.expansion.T @ rows.reshape(-1, 3 * len(numbers))
            weights = sparse[nodes - rod.mesh.first_node].reshape(len(nodes), len(numbers), 3)
            self.hold(weights.transpose(1, 0, 2), nodes, wanted, body.points[2 * border])
            return
        rows = axes[numbers]
        if len(numbers) == 3:
            self.whole_section(rod, support.position, nodes, np.tile(rows.T @ wanted, (len(nodes), 1)))
        elif np.sort(np.abs(rows), axis=1)[:, 1].max() < ALIGNED:
            for row, value in zip(rows, (self.scale * wanted).tolist(), strict=True):
                axis = int(np.argmax(np.abs(row)))
                for node in nodes.tolist():
                    self.holds.given[node, axis + 1] = float(np.sign(row[axis])) * value
        else:
            for node, place in zip(nodes, position, strict=True):
                self.hold(rows[:, None], np.array([node]), wanted, place)

    def hold(self, weights: Array, nodes: IntArray, wanted: Array, place: Array) -> None:
        """Hold weighted sums of displacements of nodes; weights : shape (n_sums, n_nodes, 3)."""
        matrix = weights.reshape(len(weights), -1)
        pivots, inverse = _eliminated(matrix)
        values = [self.point(place, (2, 3)) for _ in weights]
        for point, value in zip(values, (self.scale * wanted).tolist(), strict=True):
            self.holds.given[point, 1] = value
        for row, mix, pivot in zip(inverse @ matrix, inverse, pivots, strict=True):
            coefficients = np.where(np.abs(row) > NO_TERM * np.abs(row).max(), row, 0.0)
            others = [int(index) for index in np.flatnonzero(coefficients) if index not in pivots]
            terms = [
                Term(int(nodes[index // 3]), index % 3 + 1, float(coefficients[index])) for index in (pivot, *others)
            ]
            terms += [Term(point, 1, -float(part)) for point, part in zip(values, mix, strict=True) if part != 0.0]
            self.holds.equations.append(terms)

    def joint(self, ends: Sequence[tuple[HexRod, int]], pole: Array) -> None:
        """Sections that move with a node, which has their displacement, and another, which has their rotation."""
        moves, turns = self.point(pole), self.point(pole)
        for rod, plane in ends:
            for node, place in zip(*_section(rod, plane), strict=True):
                arm = place - pole
                for axis in range(3):
                    # u = U + theta x arm
                    turned = np.cross(np.eye(3), arm)[:, axis]
                    terms = [Term(int(node), axis + 1, 1.0), Term(moves, axis + 1, -1.0)]
                    terms += [
                        Term(turns, about + 1, -float(turned[about])) for about in np.flatnonzero(turned).tolist()
                    ]
                    self.holds.equations.append(terms)

    def bed(self, rod: HexRod, bed: Bed, number: int) -> None:
        """Springs at the Gauss points of the element faces on a bed: nodes that move as the root of area times u_n."""
        body = rod.body
        zeta, eta, weight = gauss_face()
        edges = face_edges(body.section, body.rod.section, bed.face.face)
        expansion = rod.mesh.expansion
        for layer in rod.layers(bed.start, bed.end).tolist():
            planes = np.arange(2 * layer, 2 * layer + 3)
            found = face_points(body.section, edges, bed.face.face, body.points[planes], body.axes[planes], zeta, eta)
            for edge, position, area in zip(edges, found.position, found.area, strict=True):
                nodes = (planes[:, None] * body.shape[1] + edge).ravel()
                values = (expansion[nodes].T @ found.values.T).T  # shape (q, n_20)
                for at, place, outward, share in zip(values, position, area, weight, strict=True):
                    size = float(np.linalg.norm(outward))
                    point = self.point(place, (2, 3))
                    terms = [Term(point, 1, -1.0)]
                    for index in np.flatnonzero(np.abs(at) > NO_TERM).tolist():
                        vector = at[index] * outward / size * np.sqrt(share * size)
                        terms += [
                            Term(rod.mesh.first_node + index, axis + 1, float(vector[axis]))
                            for axis in np.flatnonzero(np.abs(vector) > NO_TERM * np.abs(vector).max()).tolist()
                        ]
                    self.holds.equations.append(terms)
                    self.holds.springs.setdefault(number, []).append(point)


def _section(rod: HexRod, plane: int) -> tuple[IntArray, Array]:
    """Nodes of a plane, their numbers and places, shapes (n,) and (n, 3)."""
    number = rod.mesh.number[plane]
    return number[number > 0], rod.mesh.position[plane][number > 0]


def _eliminated(matrix: Array) -> tuple[list[int], Array]:
    """Pivot columns of independent rows and the inverse of the matrix in them, by elimination with full pivots."""
    left, pivots = matrix.copy(), []
    for _ in range(len(matrix)):
        row, column = np.unravel_index(int(np.argmax(np.abs(left))), left.shape)
        left -= np.outer(left[:, column], left[row]) / left[row, column]
        pivots.append(int(column))
    return pivots, np.asarray(np.linalg.inv(matrix[:, pivots]))
