"""The nodes of a solved scene with what they carry, for those who want the whole field and not single answers."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from reference3d.frames import rod_frame
from reference3d.quadratic import line_nodes
from reference3d.solid_solution import SolidRod, SolidSolution
from reference3d.solution import RodResult, Solution

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class NodeGrid:
    """The mesh of a rod: the same section in planes along it, 27-node hexahedra between planes 2 i and 2 i + 2.

    Attributes
    ----------
    nodes : (x, y) of the section's, mm, shape (n, 2)
    quads : nodes of its elements, ordered as in `section_mesh.SectionMesh`, shape (n_elements, 9)
    station : arc length of the planes, mm, shape (n_planes,)
    displacement : global components, mm, shape (n_planes, n, 3)
    """

    nodes: Array
    quads: IntArray
    station: Array
    displacement: Array


def node_grids(solution: Solution | SolidSolution) -> dict[str, NodeGrid]:
    """The whole section's mesh and displacement of every rod, by name."""
    return {
        name: _of_solid(found) if isinstance(found, SolidRod) else _of_box(found)
        for name, found in solution.rods.items()
    }


def _of_solid(found: SolidRod) -> NodeGrid:
    body = found.body
    moved = np.einsum("pnc,pcg->png", found.nodal, body.axes)
    return NodeGrid(body.section.nodes, body.section.quads, body.stations, moved)


def _of_box(found: RodResult) -> NodeGrid:
    borders = found.field.borders
    x, y = line_nodes(borders.x), line_nodes(borders.y)
    number = np.arange(len(x) * len(y)).reshape(len(y), len(x))
    quads = [
        number[row : row + 3, column : column + 3].ravel()
        for row in range(0, len(y) - 1, 2)
        for column in range(0, len(x) - 1, 2)
    ]
    nodes = np.stack([np.tile(x, len(y)), np.repeat(y, len(x))], axis=1)
    station = line_nodes(borders.s)
    local = found.field.nodal.reshape(len(station), len(nodes), 3)
    return NodeGrid(nodes, np.array(quads), station, local @ rod_frame(found.rod).axes)
