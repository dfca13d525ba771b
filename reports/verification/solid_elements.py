"""The elements of the 3D reference: patch test, rigid motions, and the rates at which they converge."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

import reference3d
from cases.scene import Clamp, Helix, Material, Polygon, Rod, Scene
from reference3d.elasticity import layered_stiffness
from reference3d.factor import factorise, solve
from reference3d.grading import Borders
from reference3d.mesh import box_mesh
from reference3d.quadratic import line_nodes, shape_functions
from reference3d.solid_body import SolidBody, solid_body
from reports.verification.bending import cantilever
from reports.verification.check import Check, Group, Reference, Steps
from reports.verification.scenes import STEEL

Array = NDArray[np.float64]

MATERIAL = Material(1000.0, 0.3)
LAME = (MATERIAL.young_modulus * 0.3 / (1.3 * 0.4), MATERIAL.young_modulus / 2.6)
# A section with re-entrant corners and no right angle along a line that is curved and twisted
SECTION = Polygon(((0.0, 0.0), (12.0, 1.0), (9.0, 7.0), (4.0, 5.0), (-1.0, 9.0)))
LINE = Helix((30.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0, (0.0, 0.3, 1.0), 20.0)
GRADIENT = np.array([[1.0, -2.0, 0.5], [0.3, 0.7, 1.1], [-0.8, 0.2, -0.4]]) * 1e-3
TURN = np.array([[0.0, -1.0, 2.0], [1.0, 0.0, -3.0], [-2.0, 3.0, 0.0]]) * 1e-3
SHIFT = np.array([0.3, -0.2, 0.1])
# Round-off in nodal forces, to which the displacements of a rigid motion add
EXACT, RIGID = 1e-11, 1e-9
# u = grad phi of a harmonic phi = exp(a x) cos(b y) cos(c z), a^2 = b^2 + c^2, in a unit cube: no body forces
RATES = np.array([2.0, 1.2, 1.6])
STOUT = 60.0
# Axes of elements and of nodes in them, along z, y and x, of arrays by element and by node in it
ELEMENT_AND_NODE = (
    (slice(None), None, None, slice(None), None, None),
    (None, slice(None), None, None, slice(None), None),
    (None, None, slice(None), None, None, slice(None)),
)

MESHES = Steps("mesh", "k = {}".format)
CUBES = Steps("elements along a side", "{}".format)


@cache
def _body(refinement: int) -> SolidBody:
    rod = Rod("rod", LINE, SECTION, MATERIAL, (0.0, LINE.length))
    return solid_body(Scene("patch", (rod,), (Clamp("rod", "start"),), (), ()), rod, refinement)


def _energy(body: SolidBody, gradient: Array, shift: Array) -> float:
    """Of the displacement gradient @ X + shift, N mm."""
    place = body.points[:, None] + body.section.nodes @ body.axes[:, :2]
    field = np.einsum("pnc,pbc->pnb", place @ gradient.T + shift, body.axes)
    return 0.5 * float(np.vdot(field, body.internal_forces(field)[0]))


def patch_energy(refinement: int) -> float:
    """Strain energy of a displacement that is linear in X, by that of its constant strain in the same volume."""
    body = _body(refinement)
    strain = 0.5 * (GRADIENT + GRADIENT.T)
    density = 0.5 * LAME[0] * np.trace(strain) ** 2 + LAME[1] * np.sum(strain**2)
    volume = sum(float((body.kind == kind).sum() * layer.volume.sum()) for kind, layer in enumerate(body.layers))
    return _energy(body, GRADIENT, np.zeros(3)) / float(density * volume)


def moved_energy(refinement: int) -> float:
    """Strain energy of the same with a translation and a small rotation added, by that without."""
    body = _body(refinement)
    return _energy(body, GRADIENT + TURN, SHIFT) / _energy(body, GRADIENT, np.zeros(3))


def _harmonic(x: Array, y: Array, z: Array) -> Array:
    a, b, c = RATES
    parts = a * np.cos(b * y) * np.cos(c * z), -b * np.sin(b * y) * np.cos(c * z), -c * np.cos(b * y) * np.sin(c * z)
    return np.asarray(np.exp(a * x)[..., None] * np.stack(parts, axis=-1))


def _harmonic_energy() -> float:
    """G times the integral of the squares of phi's second derivatives, as phi's Laplacian vanishes, N mm."""
    root, weight = np.polynomial.legendre.leggauss(20)
    (a, b, c), place, weight = RATES, 0.5 * (1.0 + root), 0.5 * weight

    def integral(function: Array) -> float:
        return float(weight @ function**2)

    grow = integral(np.exp(a * place))
    cos_y, sin_y = integral(np.cos(b * place)), integral(np.sin(b * place))
    cos_z, sin_z = integral(np.cos(c * place)), integral(np.sin(c * place))
    same = (a**4 + b**4 + c**4) * cos_y * cos_z
    mixed = (a * b) ** 2 * sin_y * cos_z + (a * c) ** 2 * cos_y * sin_z + (b * c) ** 2 * sin_y * sin_z
    return float(LAME[1] * grow * (same + 2.0 * mixed))


@cache
def smooth_errors(elements: int) -> tuple[float, float]:
    """Relative errors of energy and, in the mean square, of displacement, with the surface held as it should move."""
    grid = np.linspace(0.0, 1.0, elements + 1)
    stiffness = layered_stiffness(box_mesh(grid, grid, grid), Borders(grid, grid, grid), MATERIAL)
    nodes = line_nodes(grid)
    count = len(nodes)
    inside = np.zeros((count, count, count), dtype=bool)
    inside[1:-1, 1:-1, 1:-1] = True
    z, y, x = np.meshgrid(nodes, nodes, nodes, indexing="ij")
    exact = _harmonic(x, y, z)
    field = np.where(inside[..., None], 0.0, exact).reshape(count, -1)
    free = np.flatnonzero(np.repeat(inside[1].ravel(), 3))
    force = np.where(np.repeat(inside.reshape(count, -1), 3, axis=1), -stiffness.apply(field), 0.0)
    field[:, free] += solve(factorise(stiffness, free, True, True, False), force[:, free])
    energy = 0.5 * float(np.vdot(field, stiffness.apply(field)))
    root, weight = np.polynomial.legendre.leggauss(4)
    number = 2 * np.arange(elements)[:, None] + np.arange(3)
    along, up, across = (number[at] for at in ELEMENT_AND_NODE)
    values = field.reshape(count, count, count, 3)[along, up, across]
    shapes = shape_functions(root)
    found = np.einsum("abcijkd,ip,jq,kr->abcpqrd", values, shapes, shapes, shapes, optimize=True)
    place = (np.arange(elements)[:, None] + 0.5 * (1.0 + root)) / elements
    z, y, x = (place[at] for at in ELEMENT_AND_NODE)
    wanted = _harmonic(*np.broadcast_arrays(x, y, z))
    share = weight[:, None, None] * weight[:, None] * weight

    def size(difference: Array) -> float:
        return float(np.sqrt(np.sum(np.sum(difference**2, axis=-1) * share)))

    return energy / _harmonic_energy() - 1.0, size(found - wanted) / size(wanted)


def _rate(elements: int, which: int) -> float:
    """Order with which an error falls from half as many elements along a side to these."""
    coarse, fine = smooth_errors(elements // 2)[which], smooth_errors(elements)[which]
    return float(np.log2(abs(coarse / fine)))


def energy_rate(elements: int) -> float:
    """Observed order of the strain energy."""
    return _rate(elements, 0)


def displacement_rate(elements: int) -> float:
    """Observed order of the displacement in the mean square."""
    return _rate(elements, 1)


@cache
def _stout(refinement: int) -> tuple[float, float]:
    """Mesh size, mm, and strain energy of a cantilever four times as long as high, N mm."""
    found = reference3d.solve(cantilever(STOUT, STEEL), refinement)
    return found.representative_size, found.strain_energy


def clamp_rate(refinement: int) -> float:
    """Order observed on this mesh and the two before it."""
    sizes, energies = zip(*(_stout(refinement - before) for before in (2, 1, 0)), strict=True)
    found = reference3d.grid_convergence(tuple(energies), tuple(sizes), clamp_rate_reference().value)
    return found.observed_order


def clamp_rate_reference() -> Reference:
    """2 q lambda of Williams's lambda and the grading's exponent q."""
    return Reference(reference3d.formal_order(cantilever(STOUT, STEEL)))


STRANG_FIX = "Strang, Fix, An Analysis of the Finite Element Method, 1973, chapter 3"

GROUPS = (
    Group(
        "The 3D reference: patch test and rigid motions",
        "A third of a turn of a helix whose section has no right angle. Mesh k has k times as many elements "
        "along every axis.",
        (
            Check(
                "Constant strain in a curved rod",
                "A displacement linear in X has the energy of its constant strain: elements pass the patch test.",
                "closed form",
                "sigma : epsilon V / 2 with V of the mesh",
                "",
                lambda: Reference(1.0),
                patch_energy,
                EXACT,
                2,
                (1, 2),
                steps=MESHES,
            ),
            Check(
                "Rigid motion of a curved rod",
                "The same moved by 0.4 mm and turned by 0.004, as much as it is strained, has no more energy.",
                "closed form",
                "rigid motions are free of stress",
                "",
                lambda: Reference(1.0),
                moved_energy,
                RIGID,
                2,
                (1, 2),
                steps=MESHES,
            ),
        ),
    ),
    Group(
        "The 3D reference: rates of convergence, smooth",
        "On the surface of a unit cube displacement is the gradient of the harmonic exp(2 x) cos(1.2 y) cos(1.6 z), "
        "which needs no body forces. Values are orders from half as many elements to as many.",
        (
            Check(
                "Order of the strain energy",
                "27-node elements converge in energy with the fourth power of their size.",
                "closed form",
                STRANG_FIX,
                "",
                lambda: Reference(4.0),
                energy_rate,
                0.05,
                8,
                (4, 8),
                steps=CUBES,
            ),
            Check(
                "Order of the displacement",
                "In the mean square over the cube, with the third power.",
                "closed form",
                STRANG_FIX,
                "",
                lambda: Reference(3.0),
                displacement_rate,
                0.02,
                8,
                (4, 8),
                steps=CUBES,
            ),
        ),
    ),
    Group(
        "The 3D reference: rate of convergence at a clamp",
        "A cantilever of four times its height. At the edge of a clamp stress is singular, displacement r^0.71, so "
        "that on even meshes the energy converges with order 1.4 however good the elements are. Meshes graded towards "
        "the edge with exponent 2 double that.",
        (
            Check(
                "Order of energy, clamped",
                "The order that the uncertainties of the 3D reference are reckoned with is the one seen.",
                "closed form",
                "Williams, Journal of Applied Mechanics 19 (1952) 526; Babuska, Kellogg, Pitkaranta, Numerische "
                "Mathematik 33 (1979) 447",
                "",
                clamp_rate_reference,
                clamp_rate,
                0.1,
                4,
                (3, 4),
                steps=MESHES,
            ),
        ),
    ),
)
