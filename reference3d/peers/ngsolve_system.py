"""Linear elasticity of all rods in NGSolve: spaces, stiffness with its interior condensed, loads and supports.

Each global component of the displacement has a space of its own: NGSolve then makes an element's matrix in half the
time that it needs for one space of vectors. Loads are forces at Gauss points, exact for the polynomials at hand.
"""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from functools import cache
from typing import Any

import numpy as np
from scipy.sparse import csr_array

from cases.scene import (
    Clamp,
    Face,
    Gravity,
    LineLoad,
    Load,
    Material,
    Pressure,
    Rod,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
    Support,
    station_of,
)
from reference3d.peers.answer import Array
from reference3d.peers.ngsolve_mesh import (
    SYMMETRY,
    Grid,
    Hexahedra,
    IntArray,
    Mesh,
    RodMesh,
    bed_boundary,
    face_axis,
    rectangle,
    support_boundary,
)

# NGSolve's classes, which type checkers are not shown.
NodeId = Any
Space = Any
BilinearForm = Any
Integrals = Any
Proxy = Any

# Cosine from which two directions are one.
_ALIGNED = 1.0 - 1e-9


@dataclass(frozen=True, eq=False)
class System:
    """Spaces of displacements on a mesh.

    Attributes
    ----------
    space : of the displacement, global components one after the other
    component : one of its three scalar spaces; all have the same basis and numbering
    """

    scene: Scene
    hexahedra: Hexahedra
    mesh: Mesh
    space: Space
    component: Space

    def rod(self, name: str) -> RodMesh:
        """Where a rod's elements are."""
        return self.mesh.rods[name]

    def shape_functions(self, rod: str, points: Array) -> csr_array:
        """Values of the scalar basis at points (x, y, s) of a rod, shape (n, number of scalar basis functions)."""
        from ngsolve import VOL, ElementId

        if points.shape[1] == 0:
            return csr_array((0, self.component.ndof))
        numbers, places = self.rod(rod).locate(points)
        columns, values, counts = [], [], []
        of_element: dict[int, tuple[Any, list[int]]] = {}
        for number, place in zip(numbers.tolist(), places.T.tolist(), strict=True):
            if number not in of_element:
                element = ElementId(VOL, number)
                of_element[number] = self.component.GetFE(element), list(self.component.GetDofNrs(element))
            shape, unknowns = of_element[number]
            columns += unknowns
            values.append(np.asarray(shape.CalcShape(*place)))
            counts.append(len(unknowns))
        starts = np.concatenate([[0], np.cumsum(counts, dtype=np.int64)])
        return csr_array((np.concatenate(values), np.array(columns), starts), (len(counts), self.component.ndof))


def make_system(scene: Scene, hexahedra: Hexahedra, mesh: Mesh, *, of_vectors: bool = False) -> System:
    """The spaces, held where supports and symmetry hold them.

    Parameters
    ----------
    of_vectors : whether the displacement has one space of vectors, with the same basis and numbering: what NGSolve's
        own contact wants
    """
    import ngsolve

    # Times are compared on one thread. Not told so, NGSolve takes four times as long to factorise, even on one.
    ngsolve.SetNumThreads(1)
    counts = Counter(order for orders in hexahedra.orders.values() for order in orders)
    most = counts.most_common(1)[0][0]
    others = _other_orders(hexahedra, mesh, most) if len(counts) > 1 else {}

    def with_orders(space: Space) -> Space:
        for node, order in others.items():
            space.SetOrder(node, order)
        if others:
            space.Update()
        return space

    held = ["|".join(names) for names in _held(scene, hexahedra, mesh)]
    shared = {"order": most, "order_policy": ngsolve.ORDER_POLICY.VARIABLE}
    if of_vectors:
        x, y, z = held
        space = ngsolve.VectorH1(mesh.ngsolve, dirichletx=x, dirichlety=y, dirichletz=z, **shared)
        space = with_orders(space)
        return System(scene, hexahedra, mesh, space, space.components[0])
    spaces = [with_orders(ngsolve.H1(mesh.ngsolve, dirichlet=names, **shared)) for names in held]
    return System(scene, hexahedra, mesh, ngsolve.FESpace(spaces), spaces[0])


def _other_orders(hexahedra: Hexahedra, mesh: Mesh, most: int) -> dict[NodeId, int]:
    """Edges, faces and cells whose order is not that of most elements: it is the highest of the elements there."""
    import ngsolve

    found: dict[NodeId, int] = {}
    for name, part in mesh.rods.items():
        in_layer = part.grid.cells[0] * part.grid.cells[1]
        for number, order in enumerate(np.repeat(hexahedra.orders[name], in_layer).tolist(), start=part.element):
            element = mesh.ngsolve[ngsolve.ElementId(ngsolve.VOL, number)]
            for node in (*element.edges, *element.faces, ngsolve.NodeId(ngsolve.CELL, number)):
                found[node] = max(order, found.get(node, 1))
    return {node: order for node, order in found.items() if order != most}


def _held(scene: Scene, hexahedra: Hexahedra, mesh: Mesh) -> list[list[str]]:
    """Names of the boundaries that hold each global component of the displacement."""
    held: list[list[str]] = [[], [], []]
    if hexahedra.symmetric:
        for number, rod in enumerate(scene.rods, start=1):
            held[_global_axis(mesh.rods[rod.name].frame.axes[0])].append(f"{SYMMETRY}{number}")
    for number, support in enumerate(scene.supports):
        for axis in _held_axes(support, mesh.rods[support.rod], f"supports #{number + 1}"):
            held[axis].append(support_boundary(number))
    return held


def _held_axes(support: Clamp | Support, part: RodMesh, key: str) -> list[int]:
    """Global components that a support holds, each once; SceneError for supports that are not of this kind."""
    if isinstance(support, Clamp):
        return [0, 1, 2]
    if support.of == "mean":
        raise SceneError(f"{key}.of", "'mean'", "NGSolve is given supports of whole sections")
    axes = [_global_axis(part.frame.axes["xys".index(component)]) for component in support.components]
    if -1 in axes:
        remedy = "NGSolve is given supports along the global axes, or clamps"
        raise SceneError(f"{key}.components", "one that is not along a global axis", remedy)
    return axes


def _global_axis(direction: Array) -> int:
    """The global axis that a unit direction lies along, -1 if none."""
    axis = int(np.argmax(np.abs(direction)))
    return axis if abs(direction[axis]) >= _ALIGNED else -1


def stiffness(system: System) -> BilinearForm:
    """The stiffness of all rods and beds, its interior unknowns condensed: an NGSolve bilinear form, assembled."""
    import ngsolve

    form = ngsolve.BilinearForm(system.space, condense=True, symmetric=True)
    form += elasticity(system)
    form.Assemble()
    return form


def elasticity(system: System) -> Integrals:
    """Hooke's law in three dimensions in all rods, and the springs of beds, as NGSolve's integrals."""
    import ngsolve

    trial, test = system.space.TnT()
    gradient, of_test = _gradient(trial), _gradient(test)
    materials = [isotropic(rod) for rod in system.scene.rods]
    shear = [of.young_modulus / (2.0 * (1.0 + of.poisson_ratio)) for of in materials]
    lame = [2.0 * g * of.poisson_ratio / (1.0 - 2.0 * of.poisson_ratio) for g, of in zip(shear, materials, strict=True)]
    strain = ngsolve.Sym(gradient)
    mu, lam = ngsolve.CoefficientFunction(shear), ngsolve.CoefficientFunction(lame)
    stress = 2.0 * mu * strain + lam * ngsolve.Trace(strain) * ngsolve.Id(3)
    integrals = ngsolve.InnerProduct(stress, of_test).Compile() * ngsolve.dx
    for number, bed in enumerate(system.scene.beds):
        axis = system.rod(bed.rod).frame.axes[face_axis(bed.face.face)]
        moved = [sum(float(axis[n]) * function[n] for n in range(3)) for function in (trial, test)]
        integrals += bed.modulus * moved[0] * moved[1] * ngsolve.ds(bed_boundary(number))
    return integrals


def _gradient(function: Proxy) -> Proxy:
    """Gradient of a displacement, of one space of vectors or of three spaces of components."""
    import ngsolve

    if isinstance(function, list | tuple):
        return ngsolve.CoefficientFunction(tuple(ngsolve.grad(part) for part in function), dims=(3, 3))
    return ngsolve.Grad(function)


def isotropic(rod: Rod) -> Material:
    """The material of a rod; SceneError if it is not isotropic."""
    if not isinstance(rod.material, Material):
        raise SceneError(f"rods.{rod.name}.material", "orthotropic", "NGSolve is given isotropic materials")
    return rod.material


def load_vector(system: System) -> Array:
    """Forces of all loads on the unknowns, N; of the meshed half where a plane of symmetry is used."""
    total = np.zeros((3, system.component.ndof))
    for load in system.scene.loads:
        points, force = load_forces(system, load)
        total += (system.shape_functions(load.rod, points).T @ force.T).T
    return total.ravel()


def load_forces(system: System, load: Load) -> tuple[Array, Array]:
    """A load as forces at points (x, y, s) of its rod: mm and N (global), both of shape (3, n)."""
    rod = system.scene.rod(load.rod)
    part, section = system.rod(load.rod), rectangle(rod)
    area = section.width * section.height
    count = max(system.hexahedra.orders[load.rod]) // 2 + 1
    match load:
        case SectionForce():
            points, weight = _gauss_points(part.grid, count, s=load.position)
            traction = np.tile(np.array(load.force)[:, None] / area, len(weight))
        case SectionMoment():
            points, weight = _gauss_points(part.grid, count + 1, s=load.position)
            inertia = section.width * section.height / 12.0 * np.array([section.height**2, section.width**2])
            turn = part.frame.axes @ load.moment / np.array([*inertia, inertia.sum()])
            arm = np.array([*points[:2], np.zeros(len(weight))])
            traction = part.frame.axes.T @ np.cross(turn, arm, axisb=0, axisc=0)
        case LineLoad():
            points, weight = _gauss_points(part.grid, count, s=(load.start, load.end))
            traction = np.tile(np.array(load.force)[:, None] / area, len(weight))
        case Gravity():
            points, weight = _gauss_points(part.grid, count, s=(0.0, rod.length))
            density = isotropic(rod).density or 0.0
            traction = np.tile(density * np.array(load.acceleration)[:, None], len(weight))
        case Pressure():
            face = load.face.face
            at = face_position(part.grid, face)
            stretch = (load.start, load.end)
            if face_axis(face) == 1:
                points, weight = _gauss_points(part.grid, count, y=at, s=stretch)
            else:
                points, weight = _gauss_points(part.grid, count, x=at, s=stretch)
            traction = np.tile(-load.pressure * part.frame.normal(face)[:, None], len(weight))
    return points, traction * weight


def face_position(grid: Grid, face: Face) -> float:
    """Coordinate of a lateral face along the section's axis that is normal to it, mm."""
    borders = (grid.x, grid.y)[face_axis(face)]
    return float(borders[-1] if face in ("top", "right") else borders[0])


def _gauss_points(
    grid: Grid,
    count: int,
    x: float | None = None,
    y: float | None = None,
    s: float | tuple[float, float] | None = None,
) -> tuple[Array, Array]:
    """Gauss points of a rod's section, face or volume, (x, y, s), shape (3, n), and their weights, shape (n,).

    count : of the points in each element and direction
    x, y, s : where a coordinate has one value, or s a stretch
    """
    axes, weights = [], []
    for borders, given in ((grid.x, x), (grid.y, y), (grid.s, s)):
        if isinstance(given, float):
            axes.append(np.array([given]))
            weights.append(np.ones(1))
            continue
        if given is not None:
            inner = borders[(borders > given[0]) & (borders < given[1])]
            borders = np.array([given[0], *inner, given[1]])
        places, weight = gauss(borders, count)
        axes.append(places)
        weights.append(weight)
    points = np.array([of.ravel() for of in np.meshgrid(*axes, indexing="ij")])
    return points, np.einsum("i,j,k->ijk", *weights).ravel()


def gauss(borders: Array, count: int) -> tuple[Array, Array]:
    """Places and weights of `count` Gauss points between every two borders."""
    places, weights = _legendre(count)
    half = np.diff(borders)[:, None] / 2.0
    return (borders[:-1, None] + half * (1.0 + places)).ravel(), (half * weights).ravel()


@cache
def _legendre(count: int) -> tuple[Array, Array]:
    """Places and weights of Gauss's rule between -1 and 1."""
    places, weights = np.polynomial.legendre.leggauss(count)
    return places, weights


def given_displacement(system: System) -> Array:
    """The unknowns that supports set to other values than zero, all else zero, shape (n_unknowns,).

    What supports give is linear over the section, so that the basis functions of its vertices suffice.
    """
    values = np.zeros((3, system.component.ndof))
    for number, support in enumerate(system.scene.supports):
        part = system.rod(support.rod)
        if isinstance(support, Clamp):
            vertices, arm = section_arms(system, support)
            moved = np.array(support.displacement)[:, None] + np.cross(support.rotation, arm, axisb=0, axisc=0)
            values[:, vertices] = moved
            continue
        vertices = part.section_vertices(support.position)
        axes = _held_axes(support, part, f"supports #{number + 1}")
        for axis, component, given in zip(axes, support.components, support.displacement, strict=False):
            values[axis, vertices] = given * part.frame.axes["xys".index(component), axis]
    return values.ravel()


def section_arms(system: System, support: Clamp | Support) -> tuple[IntArray, Array]:
    """The vertices of a supported section and where they are from its centre, global, mm, shape (3, n)."""
    part = system.rod(support.rod)
    station = station_of(support, system.scene.rod(support.rod))
    y, x = (of.ravel() for of in np.meshgrid(part.grid.y, part.grid.x, indexing="ij"))
    return part.section_vertices(station), part.frame.axes[:2].T @ np.array([x, y])
