"""Meshes of sections in 9-node quadrilaterals, systematically refined, and integrals over them.

Every section is first divided into blocks; refinement k divides each block into k times as many elements along both
of its directions. Rectangles, boxes, circles and rings are divided by hand, polygons by gmsh.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components
from scipy.spatial import cKDTree

from cases.scene import Box, Circle, Face, Polygon, Rectangle, Ring, Section
from reference3d.gmsh_model import new_model
from reference3d.grading import denser_at_one
from reference3d.quadratic import line_nodes, shape_derivatives, shape_functions

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

GMSH_QUADRANGLE = 3
# of a circle: half side of the core over the radius, and how far its sides bulge from straight to circular
CORE, BULGE = 0.45, 0.35
# blocks across a square, and across a narrow side at least
CELLS, FEWEST_CELLS = 3.0, 2
# around a ring, and along the walls of a box: blocks at least, and largest length over the wall's thickness
RING_BLOCKS, MOST_SLENDER = 8, 4.0
WALL_BLOCKS = 2
# sizes of the blocks of a polygon, over its area by half of its border (the wall's thickness where there is one): what
# gmsh is asked for, which it halves once it has made them. The next is tried where a corner's angle has a smaller sine
# than this.
POLYGON_BLOCKS = (20.0, 12.0, 8.0, 5.0)
LEAST_SINE = 0.12
# nodes closer than this, over the size of the section, are one
SAME = 1e-9


@dataclass(frozen=True, eq=False)
class SectionMesh:
    """Mesh of a section.

    Attributes
    ----------
    nodes : (x, y), mm, shape (n, 2)
    quads : nodes of every element, shape (n_elements, 9); node 3 j + i is the i-th along its first direction and the
        j-th along its second, which lies to the left of the first
    """

    nodes: Array
    quads: IntArray


@dataclass(frozen=True, eq=False)
class SectionIntegrals:
    """Integrals of the nodal functions over the section, shape (n,) each: even is N_i, of_x is N_i x, of_y is N_i y.

    xx, xy, yy are the second moments of area, mm^4.
    """

    even: Array
    of_x: Array
    of_y: Array
    xx: float
    xy: float
    yy: float

    @property
    def area(self) -> float:
        """Area, mm^2."""
        return float(self.even.sum())

    def mean_motion(self) -> Array:
        """Mean displacement along, and rotation about e1, e2, t, as `Support` defines them, shape (6, n, 3).

        Rows are also nodal forces of a unit force spread evenly and of a unit moment as linear traction.
        """
        rows = np.zeros((6, len(self.even), 3))
        for component in range(3):
            rows[component, :, component] = self.even / self.area
        # normal traction a x + b y with int t y = M1, -int t x = M2
        slopes = np.linalg.solve(np.array([[self.xy, self.yy], [-self.xx, -self.xy]]), np.eye(2))
        rows[3:5, :, 2] = slopes.T @ np.array([self.of_x, self.of_y])
        polar = self.xx + self.yy
        rows[5, :, 0], rows[5, :, 1] = -self.of_y / polar, self.of_x / polar
        return rows


def section_extents(section: Section) -> tuple[float, float]:
    """Width along x and height along y, mm."""
    match section:
        case Rectangle() | Box():
            return section.width, section.height
        case Circle():
            return section.diameter, section.diameter
        case Ring():
            return section.outer_diameter, section.outer_diameter
        case Polygon():
            width, height = np.ptp(np.array(section.outer), axis=0).tolist()
            return width, height


def section_mesh(section: Section, refinement: int) -> SectionMesh:
    """Mesh of a section, its centroid at the origin."""
    match section:
        case Rectangle():
            grids = [_rectangle(section, refinement)]
        case Box():
            grids = _box(section, refinement)
        case Circle():
            grids = _circle(section, refinement)
        case Ring():
            grids = [_ring(section, refinement)]
        case Polygon():
            grids = [_bilinear(corners, refinement) for corners in _polygon_blocks(section)]
    mesh = _joined(grids, max(section_extents(section)))
    if isinstance(section, Polygon):
        values = integrals(mesh)
        centroid = np.array([values.of_x.sum(), values.of_y.sum()]) / values.area
        mesh = SectionMesh(mesh.nodes - centroid, mesh.quads)
    return mesh


def _joined(grids: list[Array], size: float) -> SectionMesh:
    """One mesh of blocks, each a grid of nodes of shape (2 n_v + 1, 2 n_u + 1, 2)."""
    places, quads, count = [], [], 0
    for grid in grids:
        rows, columns = grid.shape[:2]
        number = count + np.arange(rows * columns).reshape(rows, columns)
        count += number.size
        places.append(grid.reshape(-1, 2))
        quads += [
            number[row : row + 3, column : column + 3].ravel()
            for row in range(0, rows - 2, 2)
            for column in range(0, columns - 2, 2)
        ]
    every = np.concatenate(places)
    pairs = cKDTree(every).query_pairs(SAME * size, output_type="ndarray")
    links = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(count, count))
    _, number = connected_components(links, directed=False)
    _, first = np.unique(number, return_index=True)
    mesh = SectionMesh(every[first], number[np.array(quads)].astype(np.int64))
    jacobian = _quadrature(mesh)[1]
    if not (jacobian > 0.0).all():
        raise RuntimeError("the mesh of a section has elements that are turned inside out")
    return mesh


def _rectangle(section: Rectangle, refinement: int) -> Array:
    between = math.sqrt(section.width * section.height)
    x, y = (
        line_nodes(_across(extent, max(FEWEST_CELLS, round(CELLS * extent / between)) * refinement))
        for extent in (section.width, section.height)
    )
    return np.stack(np.meshgrid(x, y), axis=-1)


def _across(extent: float, count: int) -> Array:
    """Borders of elements that get finer towards both sides, as in `grading`; mm, shape (count + 1,)."""
    at = np.linspace(-1.0, 1.0, count + 1)
    return np.asarray(0.5 * extent * np.sign(at) * denser_at_one(np.abs(at)))


def _box(section: Box, refinement: int) -> list[Array]:
    wall = section.wall
    parts = []
    for extent in (section.width, section.height):
        inside = extent - 2.0 * wall
        blocks = max(WALL_BLOCKS, math.ceil(inside / (MOST_SLENDER * wall)))
        outer = 0.5 * extent
        parts.append(
            [
                np.linspace(-outer, wall - outer, 2 * refinement + 1),
                np.linspace(wall - outer, outer - wall, 2 * blocks * refinement + 1),
                np.linspace(outer - wall, outer, 2 * refinement + 1),
            ]
        )
    return [
        np.stack(np.meshgrid(x, y), axis=-1)
        for column, x in enumerate(parts[0])
        for row, y in enumerate(parts[1])
        if (column, row) != (1, 1)
    ]


def _circle(section: Circle, refinement: int) -> list[Array]:
    """A core with bulging sides and four blocks around it."""
    radius = 0.5 * section.diameter
    at = np.linspace(-1.0, 1.0, 2 * refinement + 1)
    angle = 0.25 * np.pi * at
    core = CORE * radius
    # right side of the core, from below to above
    straight, circular = np.stack([np.ones_like(at), at], axis=-1), math.sqrt(2.0) * _directions(angle)
    side = core * ((1.0 - BULGE) * straight + BULGE * circular)
    right, top = side, side @ _turn(1)
    left, bottom = side @ _turn(2), side @ _turn(3)
    u, v = np.meshgrid(0.5 * (1.0 + at), 0.5 * (1.0 + at))
    corner = core * np.array([[[-1.0, -1.0], [1.0, -1.0]], [[-1.0, 1.0], [1.0, 1.0]]])
    u, v = u[..., None], v[..., None]
    # Coons patch; sides run along rising u and v
    sides = (1.0 - v) * bottom[None] + v * top[None, ::-1] + (1.0 - u) * left[::-1, None] + u * right[:, None]
    corners = (
        (1.0 - u) * (1.0 - v) * corner[0, 0]
        + u * (1.0 - v) * corner[0, 1]
        + (1.0 - u) * v * corner[1, 0]
        + u * v * corner[1, 1]
    )
    share = line_nodes(denser_at_one(np.linspace(0.0, 1.0, refinement + 1)))[None, :, None]
    outer = (1.0 - share) * side[:, None] + share * (radius * _arc(angle))[:, None]
    return [sides - corners, *(outer @ _turn(quarter) for quarter in range(4))]


def _turn(quarters: int) -> Array:
    """Matrix that turns rows anticlockwise by quarters of a turn."""
    return np.linalg.matrix_power(np.array([[0.0, 1.0], [-1.0, 0.0]]), quarters)


def _directions(angle: Array) -> Array:
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)


def _arc(angle: Array) -> Array:
    """Nodes of element edges along a circle of radius 1, at even angles, from one element border on.

    Ends lie on the circle, middles as far out as makes the area under the edges, parabolas, that under the circle.
    """
    half = angle[1] - angle[0]
    middle = np.cos(half) + 0.75 * (half - np.sin(half) * np.cos(half)) / np.sin(half)
    radius = np.ones_like(angle)
    radius[1::2] = middle
    return radius[:, None] * _directions(angle)


def _ring(section: Ring, refinement: int) -> Array:
    outer, inner = 0.5 * section.outer_diameter, 0.5 * section.inner_diameter
    wall = outer - inner
    around = max(RING_BLOCKS, 2 * math.ceil(np.pi * 0.5 * (outer + inner) / (MOST_SLENDER * wall)))
    through = 2 if wall > 0.5 * outer else 1
    radius = 0.5 * (inner + outer) + line_nodes(_across(wall, through * refinement))
    angle = np.linspace(0.0, 2.0 * np.pi, 2 * around * refinement + 1)
    return np.asarray(radius[None, :, None] * _arc(angle)[:, None])


def _bilinear(corners: Array, refinement: int) -> Array:
    """Grid over a quadrilateral with straight sides, corners anticlockwise, shape (4, 2)."""
    at = np.linspace(0.0, 1.0, 2 * refinement + 1)
    u, v = (each[..., None] for each in np.meshgrid(at, at))
    a, b, c, d = corners
    return np.asarray((1 - u) * (1 - v) * a + u * (1 - v) * b + u * v * c + (1 - u) * v * d)


@lru_cache(maxsize=32)
def _polygon_blocks(section: Polygon) -> Array:
    """Corners of quadrilaterals that fill a polygon, anticlockwise, shape (n, 4, 2): as few as have good angles."""
    best, found = -1.0, np.empty((0, 4, 2))
    for block in POLYGON_BLOCKS:
        blocks = _quadrilaterals(section, block)
        edges = np.roll(blocks, -1, axis=1) - blocks
        edges /= np.linalg.norm(edges, axis=2, keepdims=True)
        following = np.roll(edges, -1, axis=1)
        sine = float((edges[..., 0] * following[..., 1] - edges[..., 1] * following[..., 0]).min())
        if sine > best:
            best, found = sine, blocks
        if sine > LEAST_SINE:
            break
    return found


def _quadrilaterals(section: Polygon, block: float) -> Array:
    """Quadrilaterals by gmsh, of a size of about `block` in the unit of `POLYGON_BLOCKS`."""
    loops = [np.array(loop, dtype=float) for loop in (section.outer, *section.holes)]
    area, around = 0.0, 0.0
    for number, loop in enumerate(loops):
        following = np.roll(loop, -1, axis=0)
        enclosed = 0.5 * abs(float(np.sum(loop[:, 0] * following[:, 1] - loop[:, 1] * following[:, 0])))
        area += enclosed if number == 0 else -enclosed
        around += float(np.linalg.norm(following - loop, axis=1).sum())
    size = block * 2.0 * area / around
    options = {"Mesh.Algorithm": 8.0, "Mesh.RecombineAll": 1.0, "Mesh.SubdivisionAlgorithm": 1.0}
    with new_model("section", options) as gmsh:
        geometry = gmsh.model.geo
        curves = []
        for loop in loops:
            corners = [geometry.addPoint(x, y, 0.0, size) for x, y in loop.tolist()]
            lines = [geometry.addLine(a, b) for a, b in zip(corners, corners[1:] + corners[:1], strict=True)]
            curves.append(geometry.addCurveLoop(lines))
        geometry.addPlaneSurface(curves)
        geometry.synchronize()
        gmsh.model.mesh.generate(2)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        _, corners_of = gmsh.model.mesh.getElementsByType(GMSH_QUADRANGLE)
    place = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    place[tags] = np.arange(len(tags))
    blocks = coordinates.reshape(-1, 3)[place[corners_of].reshape(-1, 4), :2]
    first, second = blocks[:, 2] - blocks[:, 0], blocks[:, 3] - blocks[:, 1]
    areas = 0.5 * (first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    if not math.isclose(float(np.abs(areas).sum()), area, rel_tol=1e-9):
        raise RuntimeError(f"gmsh filled {np.abs(areas).sum():g} of a section of {area:g} mm^2")
    return np.asarray(np.where(areas[:, None, None] > 0.0, blocks, blocks[:, ::-1]))


def shapes(xi: Array, eta: Array) -> tuple[Array, Array]:
    """Functions of the 9 nodes, shape (9, n), and their derivatives by xi and eta, shape (9, 2, n)."""
    along, across = shape_functions(xi), shape_functions(eta)
    slope_along, slope_across = shape_derivatives(xi), shape_derivatives(eta)
    values = (across[:, None] * along[None]).reshape(9, -1)
    slopes = [
        (across[:, None] * slope_along[None]).reshape(9, -1),
        (slope_across[:, None] * along[None]).reshape(9, -1),
    ]
    return values, np.stack(slopes, axis=1)


def gauss_square() -> tuple[Array, Array, Array]:
    """Three by three Gauss points of the square: xi, eta, weight, shape (9,) each."""
    root, weight = np.polynomial.legendre.leggauss(3)
    eta, xi = (grid.ravel() for grid in np.meshgrid(root, root, indexing="ij"))
    return xi, eta, np.outer(weight, weight).ravel()


def _quadrature(mesh: SectionMesh) -> tuple[Array, Array]:
    """Functions at the Gauss points, shape (9, 9), and the elements' Jacobians there, shape (n_elements, 9)."""
    xi, eta, _ = gauss_square()
    values, slopes = shapes(xi, eta)
    mapping = np.einsum("eac,adg->egcd", mesh.nodes[mesh.quads], slopes)
    return values, np.linalg.det(mapping)


def integrals(mesh: SectionMesh) -> SectionIntegrals:
    """Integrals over the meshed section."""
    values, jacobian = _quadrature(mesh)
    area = jacobian * gauss_square()[2]
    place = np.einsum("ag,eac->egc", values, mesh.nodes[mesh.quads])
    x, y = place[..., 0], place[..., 1]

    def nodal(density: Array) -> Array:
        found = np.zeros(len(mesh.nodes))
        np.add.at(found, mesh.quads, (density * area) @ values.T)
        return found

    second = [float((one * other * area).sum()) for one, other in ((x, x), (x, y), (y, y))]
    return SectionIntegrals(nodal(np.ones_like(x)), nodal(x), nodal(y), *second)


def face_edges(mesh: SectionMesh, section: Section, face: Face) -> IntArray:
    """Nodes of the element edges on a flat face, in order along rising x or y, shape (n_edges, 3)."""
    width, height = section_extents(section)
    axis = 1 if face in ("top", "bottom") else 0
    place = 0.5 * (height if axis == 1 else width) * (1.0 if face in ("top", "right") else -1.0)
    on_face = np.abs(mesh.nodes[:, axis] - place) < SAME * max(width, height)
    edges = mesh.quads[:, [[0, 1, 2], [2, 5, 8], [6, 7, 8], [0, 3, 6]]].reshape(-1, 3)
    edges = edges[on_face[edges].all(axis=1)]
    along = mesh.nodes[edges, 1 - axis]
    return np.asarray(np.where((along[:, :1] < along[:, 2:]), edges, edges[:, ::-1]))


def located(mesh: SectionMesh, place: Array) -> tuple[IntArray, Array, Array]:
    """Elements that hold points: where several do, all of them.

    Points beyond the section belong to the element that is nearest in its own coordinates.

    Parameters
    ----------
    place : (x, y), mm, shape (n, 2)

    Returns
    -------
    element, local, share : shapes (n, c), (n, c, 2) and (n, c): candidates, (xi, eta) in them, and weights that sum
        to one, equal among those that hold the point and zero for the others
    """
    corners = mesh.nodes[mesh.quads]
    middle, reach = corners[:, 4], np.linalg.norm(corners - corners[:, 4:5], axis=2).max(axis=1)
    distance = np.linalg.norm(place[:, None] - middle, axis=2) / reach
    candidates = min(8, len(mesh.quads))
    element = np.argsort(distance, axis=1, kind="stable")[:, :candidates]
    nodes = corners[element.ravel()]
    target = np.repeat(place, candidates, axis=0)
    local = np.zeros((len(target), 2))
    for _ in range(25):
        values, slopes = shapes(local[:, 0], local[:, 1])
        missing = target - np.einsum("an,nac->nc", values, nodes)
        mapping = np.einsum("nac,adn->ncd", nodes, slopes)
        singular = np.abs(np.linalg.det(mapping)) < 1e-12 * reach[element.ravel()] ** 2
        mapping[singular] = np.eye(2) * reach[element.ravel()][singular, None, None]
        step = np.linalg.solve(mapping, missing[..., None])[..., 0]
        local = np.clip(local + step, -3.0, 3.0)
    # where the search found no place in an element, the point is far from it
    missing = np.linalg.norm(target - np.einsum("an,nac->nc", shapes(*local.T)[0], nodes), axis=1)
    beyond = (np.abs(local).max(axis=1) + missing / (SAME * reach[element.ravel()])).reshape(len(place), candidates)
    # round-off of what is missing, some 1e-15 of the reach, counts up to 1e-6 here
    holds = beyond <= np.maximum(1.0 + 1e-5, beyond.min(axis=1, keepdims=True))
    return element, local.reshape(len(place), candidates, 2), holds / holds.sum(axis=1, keepdims=True)
