"""Hexahedra of straight rods of rectangular section, as an NGSolve mesh: one grid a rod, all rods in one mesh.

A grid follows the section's coordinates (x, y) and the arc length s. Where x = 0 is a plane of symmetry of the scene,
what lies on one side of it is meshed. Which borders a grid has is said by the caller; those that suit a scene are in
`ngsolve_grading`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from cases.scene import Face, Line, Rectangle, Rod, Scene, SceneError, station_of
from reference3d.peers.answer import Array

IntArray = NDArray[np.int64]

# Corners of a hexahedron and of a quadrilateral in the mesher's order, in steps along x, y, s and along two of them.
_CORNERS = ((0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1))
_AROUND = ((0, 0), (1, 0), (1, 1), (0, 1))


@dataclass(frozen=True, eq=False)
class Grid:
    """Borders of a rod's hexahedra, mm, ascending.

    Attributes
    ----------
    x, y : across the section; x begins or ends at 0 where half a rod is meshed
    s : along the rod, from 0 to its length
    """

    x: Array
    y: Array
    s: Array

    @property
    def cells(self) -> tuple[int, int, int]:
        """Number of hexahedra along x, y and s."""
        return len(self.x) - 1, len(self.y) - 1, len(self.s) - 1


@dataclass(frozen=True, eq=False)
class Hexahedra:
    """Elements of all rods of a scene.

    Attributes
    ----------
    grids : by rod
    orders : by rod, p of the polynomials in each layer of elements along s; a section between two layers has the higher
    symmetric : whether half of every rod is meshed, on one side of the plane x = 0 that is all rods'
    zones : by pair, where contact is looked for, arc length along the first rod, mm
    """

    grids: Mapping[str, Grid]
    orders: Mapping[str, tuple[int, ...]]
    symmetric: bool
    zones: Mapping[str, tuple[float, float]]


@dataclass(frozen=True, eq=False)
class Frame:
    """Where a straight rod is: its start, mm, shape (3,), and rows e1, e2, t, shape (3, 3)."""

    start: Array
    axes: Array

    def place(self, points: Array) -> Array:
        """Global coordinates of points (x, y, s), mm, both of shape (3, n)."""
        return np.asarray(self.start[:, None] + self.axes.T @ points)

    def coordinates(self, places: Array) -> Array:
        """The points (x, y, s) at global coordinates, mm, both of shape (3, n)."""
        return np.asarray(self.axes @ (places - self.start[:, None]))

    def normal(self, face: Face) -> Array:
        """Outward normal of a lateral face, global, shape (3,)."""
        sign = 1.0 if face in ("top", "right") else -1.0
        return np.asarray(sign * self.axes[face_axis(face)])


def face_axis(face: Face) -> int:
    """Number of the section's axis that a face is normal to: 0 for x, 1 for y."""
    return 1 if face in ("top", "bottom") else 0


def frame(rod: Rod) -> Frame:
    """The frame of a straight rod that is not twisted.

    Raises
    ------
    SceneError
        if the rod is curved or twisted.
    """
    line, key = rod.centre_line, f"rods.{rod.name}.centre_line"
    remedy = "NGSolve is given straight rods without twist"
    if not isinstance(line, Line):
        raise SceneError(key, f"a {type(line).__name__.lower()}", remedy)
    if line.twist != 0.0:
        raise SceneError(f"{key}.twist", f"{line.twist:g}", remedy)
    start = np.array(line.start, dtype=float)
    tangent = (np.array(line.end) - start) / line.length
    towards = np.asarray(line.up) - np.dot(line.up, tangent) * tangent
    e2 = towards / np.linalg.norm(towards)
    return Frame(start, np.array([np.cross(e2, tangent), e2, tangent]))


def rectangle(rod: Rod) -> Rectangle:
    """The section of a rod; SceneError if it is not a rectangle."""
    if not isinstance(rod.section, Rectangle):
        found = f"a {type(rod.section).__name__.lower()}"
        raise SceneError(f"rods.{rod.name}.section", found, "NGSolve is given rectangular sections")
    return rod.section


@dataclass(frozen=True, eq=False)
class RodMesh:
    """Where a rod's hexahedra are in the mesh.

    Attributes
    ----------
    frame, grid : the rod's
    element, vertex : number of its first element and of its first vertex; they go on along x, then y, then s
    """

    frame: Frame
    grid: Grid
    element: int
    vertex: int

    def locate(self, points: Array) -> tuple[IntArray, Array]:
        """The elements that hold points (x, y, s), and the points' coordinates in them, 0 to 1, shape (3, n).

        Points outside are taken to the nearest element, in coordinates beyond 0 or 1.
        """
        cells, inside = [], []
        for borders, places in zip((self.grid.x, self.grid.y, self.grid.s), points, strict=True):
            cell = np.clip(np.searchsorted(borders, places, side="right") - 1, 0, len(borders) - 2)
            cells.append(cell)
            inside.append((places - borders[cell]) / (borders[cell + 1] - borders[cell]))
        along_x, along_y, _ = self.grid.cells
        return self.element + (cells[2] * along_y + cells[1]) * along_x + cells[0], np.array(inside)

    def section_vertices(self, station: float) -> IntArray:
        """The vertices of the section at a border of the grid."""
        in_section = len(self.grid.x) * len(self.grid.y)
        layer = int(np.argmin(np.abs(self.grid.s - station)))
        return self.vertex + layer * in_section + np.arange(in_section)

    def points(self) -> Array:
        """Coordinates (x, y, s) of the vertices, shape (3, n)."""
        s, y, x = np.meshgrid(self.grid.s, self.grid.y, self.grid.x, indexing="ij")
        return np.array([x.ravel(), y.ravel(), s.ravel()])


@dataclass(frozen=True, eq=False)
class Mesh:
    """An NGSolve mesh of all rods; boundaries are called by `support_boundary` and its like.

    Attributes
    ----------
    ngsolve : the mesh; material number n is that of the scene's rod number n
    rods : by name
    """

    ngsolve: Any
    rods: Mapping[str, RodMesh]


SYMMETRY = "symmetry"


def support_boundary(number: int) -> str:
    """What the section held by support number `number` is called in the mesh."""
    return f"support{number}"


def bed_boundary(number: int) -> str:
    """What the faces on bed number `number` are called in the mesh."""
    return f"bed{number}"


def contact_boundary(number: int, side: int) -> str:
    """What the faces of contact pair number `number` are called in the mesh; sides are 0 and 1."""
    return f"contact{number}side{side}"


def make_mesh(scene: Scene, hexahedra: Hexahedra, *, contact_faces: bool = False) -> Mesh:
    """The mesh of a scene.

    Parameters
    ----------
    contact_faces : whether the faces that may touch are boundaries of the mesh, as NGSolve's own contact wants
    """
    import ngsolve
    from netgen.meshing import Element2D, Element3D, FaceDescriptor, MeshPoint, Pnt
    from netgen.meshing import Mesh as Netgen

    netgen = Netgen(dim=3)
    corners = np.array(_CORNERS)
    rods: dict[str, RodMesh] = {}
    vertices: list[Any] = []
    elements = 0
    for material, rod in enumerate(scene.rods, start=1):
        part = RodMesh(frame(rod), hexahedra.grids[rod.name], elements, len(vertices))
        rods[rod.name] = part
        vertices += [netgen.Add(MeshPoint(Pnt(*place))) for place in part.frame.place(part.points()).T.tolist()]
        along_x, along_y, along_s = part.grid.cells
        k, j, i = (n.ravel() for n in np.meshgrid(*map(np.arange, (along_s, along_y, along_x)), indexing="ij"))
        cells = np.array([i, j, k])[:, :, None] + corners.T[:, None, :]
        for numbers in _vertex(part, cells).tolist():
            netgen.Add(Element3D(material, [vertices[number] for number in numbers]))
        elements += along_x * along_y * along_s
        netgen.SetMaterial(material, f"rod{material}")
    boundaries = _boundaries(scene, hexahedra, rods, contact_faces)
    for number, (name, (material, quadrilaterals)) in enumerate(boundaries.items(), start=1):
        descriptor = netgen.Add(FaceDescriptor(surfnr=number, domin=material, domout=0, bc=number))
        netgen.SetBCName(number - 1, name)
        for vertex_numbers in quadrilaterals.tolist():
            netgen.Add(Element2D(descriptor, [vertices[number] for number in vertex_numbers]))
    return Mesh(ngsolve.Mesh(netgen), rods)


def _boundaries(
    scene: Scene, hexahedra: Hexahedra, rods: Mapping[str, RodMesh], contact_faces: bool
) -> dict[str, tuple[int, IntArray]]:
    """What is held, lies on a bed or may touch: material and vertices of the quadrilaterals, by name."""
    materials = {rod.name: number for number, rod in enumerate(scene.rods, start=1)}
    found: dict[str, tuple[int, IntArray]] = {}
    if hexahedra.symmetric:
        for name, part in rods.items():
            plane = int(np.argmin(np.abs(part.grid.x)))
            found[f"{SYMMETRY}{materials[name]}"] = materials[name], _quadrilaterals(part, 0, plane)
    for number, support in enumerate(scene.supports):
        part = rods[support.rod]
        layer = int(np.argmin(np.abs(part.grid.s - station_of(support, scene.rod(support.rod)))))
        found[support_boundary(number)] = materials[support.rod], _quadrilaterals(part, 2, layer)
    for number, bed in enumerate(scene.beds):
        quadrilaterals = _face_quadrilaterals(rods[bed.rod], bed.face.face, (bed.start, bed.end))
        found[bed_boundary(number)] = materials[bed.rod], quadrilaterals
    for number, pair in enumerate(scene.contacts if contact_faces else ()):
        first = rods[pair.first.rod].frame
        ends = first.place(np.array([[0.0, 0.0], [0.0, 0.0], hexahedra.zones[pair.name]]))
        for side, face in enumerate(pair.faces):
            part = rods[face.rod]
            start, end = sorted(part.frame.coordinates(ends)[2].tolist())
            quadrilaterals = _face_quadrilaterals(part, face.face, (start, end))
            found[contact_boundary(number, side)] = materials[face.rod], quadrilaterals
    return found


def _vertex(part: RodMesh, steps: IntArray) -> IntArray:
    """Numbers of the vertices that lie the given numbers of steps along x, y and s; steps has shape (3, ...)."""
    per_row, rows = len(part.grid.x), len(part.grid.y)
    return np.asarray(part.vertex + (steps[2] * rows + steps[1]) * per_row + steps[0])


def _quadrilaterals(part: RodMesh, axis: int, step: int, stretch: tuple[float, float] | None = None) -> IntArray:
    """Vertices of the faces at one border of the grid, normal to an axis (0 x, 1 y, 2 s), shape (n, 4).

    They go around so that the normal points away from the first border, outwards, and along the axis at all others.
    """
    first, second = (other for other in range(3) if other != axis)
    cells = part.grid.cells
    a, b = (n.ravel() for n in np.meshgrid(np.arange(cells[first]), np.arange(cells[second]), indexing="ij"))
    if stretch is not None:
        middle = (part.grid.s[b] + part.grid.s[b + 1]) / 2.0
        inside = (stretch[0] < middle) & (middle < stretch[1])
        a, b = a[inside], b[inside]
    steps = np.empty((3, len(a), 4), dtype=np.int64)
    around = np.array(_AROUND)
    if (step == 0) != (axis == 1):
        around = around[::-1]
    steps[axis] = step
    steps[first] = a[:, None] + around[:, 0]
    steps[second] = b[:, None] + around[:, 1]
    return _vertex(part, steps)


def _face_quadrilaterals(part: RodMesh, face: Face, stretch: tuple[float, float]) -> IntArray:
    """Vertices of the quadrilaterals of a lateral face whose middle lies within a stretch along s, mm, shape (n, 4)."""
    axis = face_axis(face)
    return _quadrilaterals(part, axis, part.grid.cells[axis] if face in ("top", "right") else 0, stretch)
