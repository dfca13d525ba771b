"""A mesh made elsewhere, read by meshio: the elements of every rod and the faces that the scene speaks of, by name.

Groups are named after what they mean to the scene, where ROD is the name of a rod:

    ROD                        its elements: hexahedra of 8, 20 or 27 nodes, or tetrahedra of 4 or 10, of one kind
    ROD.start, ROD.end         its end sections, where they are clamped
    ROD.top, .bottom, .left, .right    its lateral faces, where they are the first of a contact pair

A group of faces may be one of surface cells (a physical surface of gmsh) or of nodes (a node set of Abaqus); it may
also name only the corners. Lengths are mm; the mesh lies where the scene has the rod.
"""

from __future__ import annotations

import contextlib
import io
import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import meshio
import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from cases.scene import ENDS, FACES, Clamp, Rod, Scene, SceneError
from reference3d.centre_line import frames, points
from reference3d.facing import face_place
from reference3d.own_mesh.arc_length import arc_lengths
from reference3d.own_mesh.elements import KINDS, ElementKind
from reference3d.section_mesh import integrals, section_mesh

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# how much the volume may differ from section times length, and how far the centroid may be off, over the size of the
# section (of a curved rod it is a little off the line)
VOLUME_DIFFERENCE, OFF_PLACE = 0.02, 0.03
# how far nodes may be off the face that they are said to lie on, over the size of the section
ON_FACE = 0.01
AT_A_TIME = 500  # elements
# of a cell, its corners: the first nodes of whatever order
CORNERS = {"triangle": 3, "quad": 4}
PHYSICAL = "gmsh:physical"


@dataclass(frozen=True, eq=False)
class FaceGroup:
    """Faces of a rod: numbers of the elements and of their faces (`ElementKind.faces`), shape (n,) each."""

    element: IntArray
    face: IntArray


@dataclass(frozen=True, eq=False)
class RodMesh:
    """The mesh of a rod.

    Attributes
    ----------
    nodes : global, mm, shape (n, 3)
    elements : numbers of nodes, shape (n_elements, n_nodes of the kind)
    groups : by name without the rod's
    """

    rod: Rod
    kind: ElementKind
    nodes: Array
    elements: IntArray
    groups: Mapping[str, FaceGroup]

    def volumes(self) -> tuple[Array, Array]:
        """Determinants of the Jacobian at the Gauss points, and these points, shapes (n_elements, n_points) and
        (n_elements, n_points, 3).
        """
        place = self.kind.quadrature[0]
        slopes, functions = self.kind.slopes(place), self.kind.functions(place)
        corners = [self.nodes[part] for part in parts(self.elements)]
        jacobians = [np.linalg.det(np.einsum("enc,qnd->eqcd", part, slopes, optimize=True)) for part in corners]
        return np.concatenate(jacobians), np.concatenate([functions @ part for part in corners])

    def group_nodes(self, group: str) -> IntArray:
        """Nodes of a group of faces, those of their edges and middles included."""
        found = self.groups[group]
        inside = np.array([on_face(self.kind, face) for face in range(len(self.kind.faces))])
        return np.unique(self.elements[found.element][inside[found.face]])


def on_face(kind: ElementKind, face: int) -> NDArray[np.bool_]:
    """Which nodes of an element lie on one of its faces."""
    first, second, *_, last = kind.nodes[kind.faces[face]]
    normal = np.cross(second - first, last - first)
    return np.asarray(np.abs((kind.nodes - first) @ normal) < 1e-12)


def parts(elements: IntArray) -> Iterable[IntArray]:
    """Elements a few at a time, so that what is computed of them stays small."""
    return np.array_split(elements, max(1, len(elements) // AT_A_TIME))


def read_rods(scene: Scene, path: Path) -> dict[str, RodMesh]:
    """The meshes of all rods of a scene.

    Raises
    ------
    SceneError
        if the file cannot be read, a group is missing, or a mesh cannot be that of its rod; the key is the file.
    """
    mesh = _read(path)
    wanted = {rod.name: set[str]() for rod in scene.rods}
    for support in scene.supports:
        if isinstance(support, Clamp):
            wanted[support.rod].add(support.end)
    for pair in scene.contacts:
        wanted[pair.first.rod].add(pair.first.face)
    return {rod.name: _rod_mesh(path, mesh, rod, sorted(wanted[rod.name])) for rod in scene.rods}


def _read(path: Path) -> meshio.Mesh:
    if not path.is_file():
        raise SceneError(str(path), "no such file", "give a mesh that meshio reads, such as .msh")
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            return meshio.read(path)
    except SystemExit as error:  # meshio's way of saying that it does not know the ending
        raise SceneError(str(path), "an unknown format", "give a mesh that meshio reads, such as .msh") from error
    except Exception as error:
        found = f"no mesh ({' '.join(str(error).split()) or type(error).__name__})"
        raise SceneError(str(path), found, "give a mesh that meshio reads, such as .msh") from error


def _rod_mesh(path: Path, mesh: meshio.Mesh, rod: Rod, groups: list[str]) -> RodMesh:
    where = str(path)
    kind, cells = _elements(where, mesh, rod)
    used, numbers = np.unique(cells, return_inverse=True)
    elements = numbers.reshape(cells.shape).astype(np.int64)
    bare = RodMesh(rod, kind, np.asarray(mesh.points[used], dtype=float), elements, {})
    _check(where, bare)
    boundary = _boundary(bare)
    renumbered = np.full(len(mesh.points), -1, dtype=np.int64)
    renumbered[used] = np.arange(len(used))
    found = {group: _group(where, mesh, bare, group, boundary, renumbered) for group in groups}
    return RodMesh(rod, kind, bare.nodes, elements, found)


def _elements(where: str, mesh: meshio.Mesh, rod: Rod) -> tuple[ElementKind, IntArray]:
    blocks: dict[str, list[IntArray]] = {}
    for block, chosen in zip(mesh.cells, _cells_of(where, mesh, rod.name), strict=True):
        if block.dim == 3 and len(chosen):
            blocks.setdefault(block.type, []).append(block.data[chosen])
    key = f"{where}, group '{rod.name}'"
    if not blocks:
        raise SceneError(key, "no elements in it", f"it is to hold the volume of rod '{rod.name}'")
    unknown = [name for name in blocks if name not in KINDS]
    if unknown or len(blocks) > 1:
        remedy = f"give one kind of element to a rod: one of {', '.join(KINDS)}"
        raise SceneError(key, " and ".join(blocks), remedy)
    ((name, parts),) = blocks.items()
    return KINDS[name], np.concatenate(parts).astype(np.int64)


def _cells_of(where: str, mesh: meshio.Mesh, group: str) -> list[IntArray]:
    """Numbers of the cells of a group in every block."""
    if group in mesh.cell_sets:
        return [np.asarray(chosen if chosen is not None else [], dtype=np.int64) for chosen in mesh.cell_sets[group]]
    if group in mesh.field_data and PHYSICAL in mesh.cell_data:  # gmsh's older formats
        tag, dimension = mesh.field_data[group]
        tags = zip(mesh.cells, mesh.cell_data[PHYSICAL], strict=True)
        return [np.flatnonzero((found == tag) & (block.dim == dimension)) for block, found in tags]
    raise _missing(where, mesh, group)


def _missing(where: str, mesh: meshio.Mesh, group: str) -> SceneError:
    names = sorted(
        name for name in {*mesh.cell_sets, *mesh.point_sets, *mesh.field_data} if not name.startswith("gmsh:")
    )
    found = f"no group '{group}', but {', '.join(repr(name) for name in names) or 'none at all'}"
    return SceneError(where, found, "name groups ROD, ROD.start, ROD.end, ROD.top and so on, after the scene's rods")


def _check(where: str, mesh: RodMesh) -> None:
    """Refuse a mesh that cannot be that of its rod."""
    rod, key = mesh.rod, f"{where}, group '{mesh.rod.name}'"
    corners = mesh.elements[:, : mesh.kind.corners]
    size = len(mesh.nodes)
    row = np.repeat(corners[:, 0], corners.shape[1] - 1)
    graph = coo_array((np.ones(len(row)), (row, corners[:, 1:].ravel())), shape=(size, size))
    pieces = len(np.unique(connected_components(graph, directed=False)[1][corners[:, 0]]))
    if pieces > 1:
        raise SceneError(key, f"{pieces} pieces that share no node", "a rod is one body: merge nodes at the same place")
    jacobians, places = mesh.volumes()
    turned = np.flatnonzero(jacobians.min(axis=1) <= 0.0)
    if len(turned):
        found = f"{len(turned)} of {len(mesh.elements)} elements turned inside out, or with nodes in another order"
        raise SceneError(key, found, "orient them, and order their nodes as their format has them")
    share = jacobians * mesh.kind.quadrature[1]
    volume = float(share.sum())
    expected = section_area(rod) * rod.length
    if abs(volume - expected) > VOLUME_DIFFERENCE * expected:
        found = f"a volume of {volume:.5g} mm^3"
        raise SceneError(key, found, f"section times length of rod '{rod.name}' is {expected:.5g} mm^3; lengths are mm")
    centroid = np.einsum("eq,eqc->c", share, places) / volume
    middle = points(rod.centre_line, np.linspace(0.0, rod.length, 201)).mean(axis=0)
    apart = float(np.linalg.norm(centroid - middle))
    if apart > OFF_PLACE * math.sqrt(section_area(rod)):
        found = f"a mesh whose centroid is {apart:.4g} mm from that of the rod"
        raise SceneError(key, found, "the mesh is to lie where the scene has the rod")


def _boundary(mesh: RodMesh) -> dict[tuple[int, ...], tuple[int, int]]:
    """Element and number of every face on the surface, by its corners in rising order."""
    corners = np.sort(mesh.elements[:, mesh.kind.faces], axis=2)
    every = corners.reshape(-1, corners.shape[2])
    _, first, count = np.unique(every, axis=0, return_index=True, return_counts=True)
    faces = len(mesh.kind.faces)
    return {tuple(every[at].tolist()): divmod(at, faces) for at in first[count == 1].tolist()}


def _group(
    where: str,
    mesh: meshio.Mesh,
    body: RodMesh,
    group: str,
    boundary: Mapping[tuple[int, ...], tuple[int, int]],
    renumbered: IntArray,
) -> FaceGroup:
    name = f"{body.rod.name}.{group}"
    if name in mesh.point_sets:
        inside = set(renumbered[np.asarray(mesh.point_sets[name], dtype=np.int64)].tolist())
        found = [place for corners, place in boundary.items() if inside.issuperset(corners)]
    else:
        found = []
        for block, chosen in zip(mesh.cells, _cells_of(where, mesh, name), strict=True):
            corners = next((count for start, count in CORNERS.items() if block.type.startswith(start)), 0)
            if block.dim == 2 and corners:
                keys = np.sort(renumbered[block.data[chosen][:, :corners]], axis=1).tolist()
                found += [boundary[tuple(key)] for key in keys if tuple(key) in boundary]
    if not found:
        raise SceneError(f"{where}, group '{name}'", "no face of the rod's surface in it", "name the rod's own faces")
    element, face = np.array(sorted(found)).T
    off = _off_place(body, group, body.nodes[np.unique(body.elements[element[:, None], body.kind.faces[face]])])
    if off > ON_FACE * math.sqrt(section_area(body.rod)):
        said = f"nodes {off:.3g} mm off the face of rod '{body.rod.name}' that is meant"
        raise SceneError(f"{where}, group '{name}'", said, "give a group the name of the face that it lies on")
    return FaceGroup(element, face)


def _off_place(body: RodMesh, group: str, position: Array) -> float:
    """How far points are at most from the end section or the lateral face that a group is named after, mm."""
    rod = body.rod
    if group in ENDS:
        station = np.array([0.0 if group == "start" else rod.length])
        ahead = (position - points(rod.centre_line, station)) @ frames(rod.centre_line, station)[0, 2]
        return float(np.abs(ahead).max())
    face = next(face for face in FACES if face == group)
    place, station = face_place(rod, face), arc_lengths(rod, position)
    outward = frames(rod.centre_line, station)[:, place.axis]
    away = np.einsum("nc,nc->n", position - points(rod.centre_line, station), outward)
    return float(np.abs(away - place.offset).max())


def section_area(rod: Rod) -> float:
    """Area of the rod's section, mm^2."""
    return integrals(section_mesh(rod.section, 1)).area
