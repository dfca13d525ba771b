"""The displacement, stress and contact of a solved scene as VTU files, for ParaView and its like.

Bodies are 27-node hexahedra, or the elements of a mesh made elsewhere. The stress at a node is the mean of the elements
that meet there; for the rod model, whose fields are polynomials, the mesh is only the places at which they are told.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray

import rodmodel
from reference3d.node_grids import NodeGrid, node_grids
from reference3d.own_mesh import OwnMeshSolution
from reference3d.own_mesh.solution import OwnRod
from reference3d.quadratic import line_nodes
from reference3d.section_mesh import section_mesh
from reference3d.solid_solution import SolidSolution
from reference3d.solution import Solution as BoxSolution
from reports.solution import Array, Solution
from reports.store import in_place_of

# of the sections on which the rod model's fields are told (k of `section_mesh`), and nodes at which stress is asked
# for at a time
SECTION_REFINEMENT, AT_A_TIME = 2, 4000
# Nodes of VTK's triquadratic hexahedron as places (i, j, k), 0 to 2, along its three directions: 8 corners, 12 edges,
# 6 faces, middle.
CORNERS = ((0, 0), (2, 0), (2, 2), (0, 2))
EDGES = ((1, 0), (2, 1), (1, 2), (0, 1))
PLACES = np.array(
    [
        *((*corner, k) for k, corner in product((0, 2), CORNERS)),
        *((*edge, k) for k, edge in product((0, 2), EDGES)),
        *((*corner, 1) for corner in CORNERS),
        *((0, 1, 1), (2, 1, 1), (1, 0, 1), (1, 2, 1), (1, 1, 0), (1, 1, 2)),
        (1, 1, 1),
    ]
)


@dataclass(frozen=True, eq=False)
class BodyField:
    """A rod's mesh with what its nodes carry.

    Attributes
    ----------
    position, displacement : global, mm, shape (n, 3)
    kind : meshio's name of the elements
    cells : their nodes, in VTK's order, shape (n_elements, n_nodes)
    stress : global axes: XX, YY, ZZ, XY, YZ, XZ, MPa, shape (n, 6)
    stress_s : sigma_s, along the rod, MPa, shape (n,)
    """

    position: Array
    kind: str
    cells: NDArray[np.int64]
    displacement: Array
    stress: Array
    stress_s: Array


def write_fields(solution: Solution, path: Path) -> tuple[Path, ...]:
    """Write the bodies to `path` (ending in .vtu) and, of a scene with contact, its points to NAME-contact.vtu.

    Raises
    ------
    OSError
        if a file cannot be written.
    """
    written = [_write(path, _bodies(solution))]
    if solution.scene.contacts:
        written.append(_write(path.with_name(f"{path.stem}-contact.vtu"), _contacts(solution)))
    return tuple(written)


def body_field(solution: Solution, rod: str, grid: NodeGrid) -> BodyField:
    """Place a rod's mesh in space, and ask the solution for the stress at its nodes."""
    planes, count = len(grid.station), len(grid.nodes)
    points, axes = solution.frame(rod, grid.station)
    position = points.T[:, None] + np.einsum("nc,pcg->png", grid.nodes, axes[:, :2])
    places = np.vstack([np.tile(grid.nodes.T, planes), np.repeat(grid.station, count)])
    parts = [
        solution.stress(rod, places[:, start : start + AT_A_TIME]) for start in range(0, places.shape[1], AT_A_TIME)
    ]
    local = np.hstack(parts)
    stress = _in_global_axes(local, np.repeat(axes, count, axis=0))
    in_section = grid.quads[:, 3 * PLACES[:, 1] + PLACES[:, 0]]
    first_planes = np.arange(0, planes - 1, 2)
    hexahedra = in_section + count * (first_planes[:, None, None] + PLACES[:, 2])
    return BodyField(
        position.reshape(-1, 3),
        "hexahedron27",
        hexahedra.reshape(-1, 27),
        grid.displacement.reshape(-1, 3),
        stress,
        local[2],
    )


def _in_global_axes(local: Array, axes: Array) -> Array:
    """XX, YY, ZZ, XY, YZ, XZ, shape (n, 6), of xx, yy, ss, ys, xs, xy, shape (6, n), in frames of shape (n, 3, 3)."""
    xx, yy, ss, ys, xs, xy = local
    tensor = np.array([[xx, xy, xs], [xy, yy, ys], [xs, ys, ss]])
    whole = np.einsum("nag,abn,nbh->ghn", axes, tensor, axes, optimize=True)
    return np.stack([whole[0, 0], whole[1, 1], whole[2, 2], whole[0, 1], whole[1, 2], whole[0, 2]], axis=1)


def _own_mesh_field(found: OwnRod) -> BodyField:
    mesh = found.body.mesh
    stress, axes = found.nodal_stress()
    return BodyField(mesh.nodes, mesh.kind.name, mesh.elements, found.nodal, _in_global_axes(stress, axes), stress[2])


def _fields(solution: Solution) -> list[BodyField]:
    if isinstance(solution, OwnMeshSolution):
        return [_own_mesh_field(solution.rods[rod.name]) for rod in solution.scene.rods]
    return [body_field(solution, rod, grid) for rod, grid in _grids(solution).items()]


def _grids(solution: Solution) -> dict[str, NodeGrid]:
    if isinstance(solution, BoxSolution | SolidSolution):
        return node_grids(solution)
    if not isinstance(solution, rodmodel.Solution):
        raise TypeError(f"solution: found a {type(solution).__name__}, whose fields are not known")
    return {rod.name: _rod_model_grid(solution, rod.name) for rod in solution.scene.rods}


def _rod_model_grid(solution: rodmodel.Solution, rod: str) -> NodeGrid:
    """Every element of the rod model as many hexahedra along it as the order of its shape functions."""
    assembled = solution.system.rods[rod]
    mesh = section_mesh(assembled.rod.section, SECTION_REFINEMENT)
    borders = [
        np.linspace(start, end, element.order + 1)[:-1]
        for start, end, element in zip(assembled.borders, assembled.borders[1:], assembled.elements, strict=False)
    ]
    station = line_nodes(np.append(np.concatenate(borders), assembled.borders[-1]))
    places = np.vstack([np.tile(mesh.nodes.T, len(station)), np.repeat(station, len(mesh.nodes))])
    moved = solution.displacement_at(rod, places).T.reshape(len(station), -1, 3)
    return NodeGrid(mesh.nodes, mesh.quads, station, moved)


def _bodies(solution: Solution) -> meshio.Mesh:
    found = _fields(solution)
    start = np.cumsum([0, *(len(body.position) for body in found)])
    stress = np.concatenate([body.stress for body in found])
    return meshio.Mesh(
        np.concatenate([body.position for body in found]),
        [(body.kind, body.cells + first) for body, first in zip(found, start, strict=False)],
        point_data={
            "displacement": np.concatenate([body.displacement for body in found]),
            "stress": stress,
            "stress_s": np.concatenate([body.stress_s for body in found]),
            "von_mises": von_mises(stress),
        },
        cell_data={"rod": [np.full(len(body.cells), number) for number, body in enumerate(found)]},
    )


def von_mises(stress: Array) -> Array:
    """Equivalent stress, MPa, shape (n,), of XX, YY, ZZ, XY, YZ, XZ, shape (n, 6)."""
    normal, shear = stress[:, :3], stress[:, 3:]
    deviation = normal - normal.mean(axis=1, keepdims=True)
    return np.asarray(np.sqrt(1.5 * (deviation**2).sum(axis=1) + 3.0 * (shear**2).sum(axis=1)))


def _contacts(solution: Solution) -> meshio.Mesh:
    """Points of contact on the first faces."""
    found = [solution.contact_points(pair.name) for pair in solution.scene.contacts]
    position = np.hstack([points.position for points in found]).T
    data = {
        "gap": np.concatenate([points.gap for points in found]),
        "force": np.hstack([points.normal * points.force for points in found]).T,
        "pressure": np.concatenate([points.pressure for points in found]),
    }
    number = np.repeat(np.arange(len(found)), [len(points.force) for points in found])
    cells = [("vertex", np.arange(len(position))[:, None])]
    return meshio.Mesh(position, cells, point_data=data, cell_data={"pair": [number]})


def _write(path: Path, mesh: meshio.Mesh) -> Path:
    with in_place_of(path) as temporary:
        meshio.write(temporary, mesh, "vtu")
    return path
