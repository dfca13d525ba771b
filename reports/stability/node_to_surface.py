"""Contact of nodes with faces in 3D: the patch test on meshes that do not match, and negative weights of corners.

Two blocks on one another under a constant pressure, which ought to arrive as a constant pressure (R. L. Taylor and P.
Papadopoulos, Computational Mechanics in Structural Engineering, 1991: the contact patch test).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import block_diag, coo_matrix, csc_matrix, diags

import rodmodel
from cases.scene import (
    Bed,
    Component,
    ContactPair,
    Line,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    Support,
)
from reference3d.grading import rod_borders
from reports.stability.solids import HEXAHEDRA, Solid, face_weights, solid, solved
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import END, START, two_bars
from reports.stability.wording import number, share

Array = NDArray[np.float64]

# Elements along each side of the upper block; the lower one has two.
LOWER = 2
DIVISIONS = (2.0, 3.0, 4.0, 5.0, 6.0)
MATERIAL = Material(1000.0, 0.3)
SIDE, PRESSURE = 10.0, 1.0
# Stiffness of the springs, times that of the blocks; what they give in evenly does not disturb a constant pressure.
STIFF = 1e3
MOST_SETS = 20
# Where multipliers stop, pressures at single points are this good, of the pressure.
PASSED = 1e-3
# All rigid motions of the rods but up and down
HELD: tuple[Component, ...] = ("x", "s", "turn x", "turn y", "turn s")
SOLIDS = {nodes: Method(f"{nodes}-node, nodes on faces", ours=nodes == 27) for nodes in HEXAHEDRA}
RODS = Method("rod model, h2, p = 3")


def measure(values: tuple[float, ...]) -> Found:
    """Largest error of the vertical stress, tension of nodes, and the nodal forces of a constant pressure."""
    errors: dict[str, list[float]] = {method.name: [] for method in (*SOLIDS.values(), RODS)}
    opened: dict[str, list[float]] = {method.name: [] for method in SOLIDS.values()}
    for value in values:
        for nodes, method in SOLIDS.items():
            error, lost = _patch(int(value), nodes)
            errors[method.name].append(error)
            opened[method.name].append(lost)
        errors[RODS.name].append(_rod_patch(int(value)))
    kinds = {method.name: _face_forces(nodes) for nodes, method in SOLIDS.items()}
    return {
        "stress": {name: curve(values, np.maximum(found, 1e-15)) for name, found in errors.items()},
        "opened": {name: curve(values, found) for name, found in opened.items()},
        "reference": {"borders": curve((0.0,), (_reference_borders_apart(),))},
        "face": {name: curve(range(1, len(found) + 1), found) for name, found in kinds.items()},
    }


def _block(elements: int, low: float, nodes: int) -> Solid:
    across = np.linspace(0.0, SIDE, elements + 1)
    return solid((across, across, np.linspace(low, low + 0.5 * SIDE, 3)), MATERIAL, nodes)


def _patch(elements: int, nodes: int) -> tuple[float, float]:
    """Largest error of the vertical stress over the pressure, and the share of contact nodes that opened."""
    lower, upper = _block(LOWER, 0.0, nodes), _block(elements, 0.5 * SIDE, nodes)
    low_count, count = 3 * lower.basis.N, 3 * (lower.basis.N + upper.basis.N)
    slaves = np.flatnonzero(upper.nodes[2] < 0.5 * SIDE + 1e-9)
    opening = _openings(lower, upper, slaves, low_count, count)
    force = np.zeros(count)
    force[low_count + 2 :: 3] = -PRESSURE * face_weights(upper, SIDE)
    fixed = np.concatenate([_symmetry(lower), _symmetry(upper)])
    fixed[2:low_count:3] |= lower.nodes[2] < 1e-9
    stiffness = block_diag([lower.stiffness, upper.stiffness], format="csc")
    # As a pressure spreads over the nodes; corners of 20-node faces would need negative ones, so all get the same.
    shares = np.full(len(slaves), SIDE**2 / len(slaves)) if nodes == 20 else _bottom_weights(upper)[slaves]
    spring = STIFF * MATERIAL.young_modulus / SIDE * shares
    joined = np.ones(len(slaves), dtype=bool)
    for _ in range(MOST_SETS):
        held = csc_matrix(opening.T @ diags(spring * joined) @ opening)
        displacement = solved(csc_matrix(stiffness + held), force, fixed, np.zeros(count))
        closed = opening @ displacement < 0.0
        if (closed == joined).all():
            break
        joined = closed
    stress = np.concatenate(
        [_vertical_stress(lower, displacement[:low_count]), _vertical_stress(upper, displacement[low_count:])]
    )
    return float(np.abs(stress / PRESSURE + 1.0).max()), float((~joined).mean())


def _bottom_weights(body: Solid) -> Array:
    return face_weights(body, 0.5 * SIDE)


def _symmetry(body: Solid) -> NDArray[np.bool_]:
    fixed = np.zeros(3 * body.basis.N, dtype=bool)
    fixed[0::3] = body.nodes[0] < 1e-9
    fixed[1::3] = body.nodes[1] < 1e-9
    return fixed


def _openings(lower: Solid, upper: Solid, slaves: NDArray[np.int64], first: int, count: int) -> csc_matrix:
    """Gap at every slave node: its own height less that of the face below it, in all unknowns, shape (n, count)."""
    mesh, mapping, element = lower.basis.mesh, lower.basis.mapping, lower.basis.elem
    corners = mesh.p[:, mesh.t]
    low, high = corners.min(axis=1), corners.max(axis=1)
    points = upper.nodes[:, slaves]
    rows, columns, values = [], [], []
    for row, point in enumerate(points.T):
        inside = ((point[:, None] >= low - 1e-9) & (point[:, None] <= high + 1e-9)).all(axis=0)
        owner = int(np.flatnonzero(inside)[0])
        place = mapping.invF(point[:, None, None], tind=np.array([owner]))[:, 0]
        shapes = [float(np.asarray(element.lbasis(place, number)[0])[0]) for number in range(lower.basis.Nbfun)]
        rows += [row] * (1 + len(shapes))
        columns += [first + 3 * int(slaves[row]) + 2, *(3 * lower.basis.element_dofs[:, owner] + 2).tolist()]
        values += [1.0, *(-shape for shape in shapes)]
    return coo_matrix((values, (rows, columns)), shape=(len(slaves), count)).tocsc()


def _vertical_stress(body: Solid, displacement: Array) -> Array:
    """At the Gauss points of all elements, MPa."""
    young, poisson = MATERIAL.young_modulus, MATERIAL.poisson_ratio
    gradients = np.stack([np.asarray(function[0].grad) for function in body.basis.basis])
    nodal = displacement.reshape(-1, 3)[body.basis.element_dofs]  # function, element, component
    strain = np.einsum("iaeq,iea->aeq", gradients, nodal)
    shear = 0.5 * young / (1.0 + poisson)
    dilating = 2.0 * shear * poisson / (1.0 - 2.0 * poisson)
    return np.asarray((dilating * strain.sum(axis=0) + 2.0 * shear * strain[2]).ravel())


def _face_forces(nodes: int) -> list[float]:
    """Share of a constant pressure on one face that a corner, the middle of an edge and of the face take."""
    one = solid((np.array([0.0, 1.0]),) * 3, MATERIAL, nodes)
    weights = face_weights(one, 1.0)
    top = one.nodes[2] > 1.0 - 1e-9
    middle = (np.abs(one.nodes[:2] - 0.5) < 1e-9).sum(axis=0)
    return [float(weights[top & (middle == kind)][0]) for kind in range(3) if (top & (middle == kind)).any()]


def _rod_patch(elements: int) -> float:
    """The same with two rods, the lower one on a bed: largest error of the pressure between them."""
    up = (0.0, 1.0, 0.0)
    section = Rectangle(SIDE, 0.5 * SIDE)
    rods, supports = [], []
    for name, height, count in (("lower", 0.0, LOWER), ("upper", 0.5 * SIDE, elements)):
        borders = tuple(np.linspace(0.0, SIDE, count + 1).tolist())
        rods.append(Rod(name, Line((0.0, height, 0.0), (SIDE, height, 0.0), up), section, MATERIAL, borders))
        supports.append(Support(name, 0.0, HELD, "mean"))
    bed = Bed(RodFace("lower", "bottom"), 0.0, SIDE, 100.0)
    pair = ContactPair("between", RodFace("lower", "top"), RodFace("upper", "bottom"), (0.0, SIDE), 0.0, 1e4)
    load = Pressure(RodFace("upper", "top"), 0.0, SIDE, PRESSURE)
    found = rodmodel.solve(Scene("patch", tuple(rods), tuple(supports), (load,), (pair,), (), (bed,)), 2, 3)
    profile = found.contact_profile("between")
    lines = np.concatenate([profile.middle, profile.mean, profile.outer])
    return float(np.abs(lines / PRESSURE - 1.0).max())


def _reference_borders_apart() -> float:
    """Largest distance between element borders of both bars within the paper's zone, as the 3D reference makes them."""
    scene = two_bars()
    lower, upper = (
        rod_borders(scene, rod, 2, True).s + offset for rod, offset in zip(scene.rods, (0.0, START), strict=True)
    )
    lower, upper = (each[(each > START - 1e-6) & (each < END + 1e-6)] for each in (lower, upper))
    return float(np.abs(lower[:, None] - upper).min(axis=1).max())


def claim(found: Found) -> str:
    """Who passes."""
    stress, face = found["stress"], found["face"]
    matching = {nodes: stress[method.name].y[0] for nodes, method in SOLIDS.items()}
    worst = {nodes: max(stress[method.name].y[1:]) for nodes, method in SOLIDS.items()}
    corners = {nodes: f"{face[method.name].y[0]:.3f}".replace("-", "−") for nodes, method in SOLIDS.items()}
    return (
        f"On matching meshes the stress is right to {number(matching[8])} with 8-node and {number(matching[27])} with "
        f"27-node elements. With 20-node ones it is {share(matching[20])} off: a constant pressure asks for tension at "
        f"the corners of their faces ({corners[20]} of the face's force each; 8-node {corners[8]}, 27-node "
        f"{corners[27]}), and contact, which cannot pull, opens there. Where meshes do not match none passes: "
        f"{share(worst[8])}, {share(worst[20])} and {share(worst[27])} off at worst with 8, 20 and 27 nodes. The rod "
        "model, whose contact points lie between the borders of both rods, is right to "
        f"{number(stress[RODS.name].largest)} on any elements."
    )


def own_limit(found: Found) -> str:
    """reference3d's contact is of this kind."""
    stress, apart = found["stress"], found["reference"]["borders"].y[0]
    return (
        "The 3D reference is of this kind (27 nodes, nodes on faces). On the paper's two bars it makes nodes meet "
        f"nodes (element borders in the zone are {number(apart)} mm apart); where bars are meshed differently, single "
        f"pressures can be off as here ({share(max(stress[SOLIDS[27].name].y[1:]))}), resultants are not. The rod "
        "model's pressures are not exact either: multipliers stop while they are still "
        f"{number(stress[RODS.name].largest)} off, the more so the more elements."
    )


def holds(found: Found) -> bool:
    """27 and 8 nodes pass where meshes match, none where they do not, 20 nodes nowhere; the rod model everywhere."""
    stress, face = found["stress"], found["face"]
    passes = all(stress[SOLIDS[nodes].name].y[0] < 1e-6 for nodes in (8, 27)) and stress[SOLIDS[20].name].y[0] > 0.1
    fails = all(max(stress[method.name].y[1:]) > 0.01 for method in SOLIDS.values())
    corners = face[SOLIDS[20].name].y[0] < 0.0 < face[SOLIDS[27].name].y[0]
    return passes and fails and corners and stress[RODS.name].largest < PASSED


SWEEP = Sweep(
    "Contact patch test",
    "Two blocks on one another, springs at the nodes of the upper one that push on the faces of the lower one: the "
    "pressure on top should arrive evenly. The lower block has 2 x 2 elements, the upper one 2 x 2 to 6 x 6.",
    DIVISIONS,
    (*SOLIDS.values(), RODS),
    (
        Picture(
            "stress",
            "Patch test",
            "elements along a side of the upper block",
            "largest error of the stress",
            log_x=False,
        ),
        Picture(
            "face",
            "Constant pressure on one face",
            "",
            "share of a node",
            log_x=False,
            log_y=False,
            ticks=("corner", "edge", "middle"),
        ),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
