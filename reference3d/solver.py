"""Solve a scene as a 3D solid: each rod's stiffness factorised once, contact in compliance form.

Straight, clamped bars of rectangular section under forces, in contact along one another or not, are solved here; all
other scenes by `solid_solver`.

Contact is located on the coarsest mesh; on finer ones compliance is computed for the nodes near it, and every
other node is seen to be open afterwards.
"""

from __future__ import annotations

import time
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_array, hstack

from cases.scene import ContactPair, Material, Rod, Scene, SceneError
from reference3d.body import Body, discretise
from reference3d.contact import (
    NODES,
    ContactNodes,
    PointsOf,
    contact_nodes,
    near_contact,
    solve_complementarity,
    solve_nested,
    without_penetration,
)
from reference3d.factor import compliance, layered_bytes
from reference3d.factor import solve as solve_layers
from reference3d.field import Field, mirrored
from reference3d.frames import is_symmetric, pair_overlap, rod_frame
from reference3d.grading import rod_borders
from reference3d.quadratic import line_nodes
from reference3d.scope import clamps, rectangle, require_treatable
from reference3d.solid_solution import SolidSolution
from reference3d.solid_solver import MEMORY_SHARE, physical_memory, solve_solid
from reference3d.solution import Cost, PairResult, RodResult, Solution

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

DEFAULT_REFINEMENT = 2
# contact is looked for where the coarse mesh found it and this many section sides around
MARGIN = 0.5
# closer to incompressible, displacement elements lock and the stiffness loses its last digits
LARGEST_POISSON_RATIO = 0.4999
# what a solution may leave over: nodal force out of balance, of the rod's largest internal nodal force, and
# difference between the gap that a contact force implies and that of the faces, of the largest displacement
RESIDUAL_TOLERANCE = 1e-8
GAP_TOLERANCE = 1e-6
# energy in the contact springs, as a part of the strain energy, above which the penalty falsifies the answer
PENALTY_SHARE = 1e-3


def solve(
    scene: Scene,
    refinement: int = DEFAULT_REFINEMENT,
    located: Solution | SolidSolution | None = None,
    contact_of: PointsOf = NODES,
) -> Solution | SolidSolution:
    """Solve a scene as a 3D solid.

    Parameters
    ----------
    refinement : k, elements along each axis of a coarse cell (`grading`); unknowns grow with its third power
    located : solution of the same scene on a coarser mesh, if there is one, which shows where contact is;
        solved here on the coarsest mesh if there is none; without contact it has no use
    contact_of : which points carry contact forces (`contact`)

    Raises
    ------
    SceneError
        if nothing holds a rod, contact included, nothing lies opposite a face that may touch, Poisson's ratio is next
        to 0.5, or the machine's memory is too small.
    ValueError
        if `refinement` is below 1, or contact is to be at other points than the first face's nodes in a scene that is
        not one of clamped bars.
    """
    if refinement < 1:
        raise ValueError(f"refinement: found {refinement}; a whole number of at least 1 is needed")
    _require_compressible(scene)
    if _is_clamped_bars(scene) and bars_bytes(scene, refinement) <= MEMORY_SHARE * physical_memory():
        return _solve_bars(scene, refinement, located if isinstance(located, Solution) else None, contact_of)
    if contact_of != NODES:
        raise ValueError(f"contact_of: found '{contact_of}'; only clamped, parallel bars have other than '{NODES}'")
    return solve_solid(scene, refinement, located if isinstance(located, SolidSolution) else None)


def _solve_bars(scene: Scene, refinement: int, located: Solution | None, contact_of: PointsOf) -> Solution:
    begin = time.perf_counter()
    symmetric = is_symmetric(scene)
    # contact is located on the coarsest mesh, so that compliance is computed only where it is needed
    solutions, steps = 0, 0
    if located is None and refinement > 1 and scene.contacts:
        located = _solve_bars(scene, 1, None, contact_of)
        solutions, steps = located.contact_solutions, located.active_sets
    bodies = {rod.name: discretise(scene, rod, refinement, symmetric) for rod in scene.rods}
    borders = {name: body.borders for name, body in bodies.items()}
    nodes = [contact_nodes(scene, pair, borders, symmetric, contact_of) for pair in scene.contacts]
    ready = time.perf_counter()

    candidates = [_candidates(pair, grid, located) for pair, grid in zip(scene.contacts, nodes, strict=True)]
    while True:
        forces, given_way, outcome, tried = _contact_forces(scene, bodies, nodes, candidates)
        solutions, steps = solutions + 1, steps + tried
        fields, gaps = _respond(scene, bodies, nodes, forces)
        missed = [~chosen & (gap < 0.0) for chosen, gap in zip(candidates, gaps, strict=True)]
        if not any(miss.any() for miss in missed):
            break
        candidates = [np.ones_like(chosen) for chosen in candidates]
    found = _Found(forces, given_way, gaps, fields, outcome, solutions, steps)
    return _collect(scene, refinement, symmetric, bodies, nodes, found, (begin, ready))


def bars_bytes(scene: Scene, refinement: int) -> float:
    """Memory that the factors of a scene of clamped bars take; `solid_solver` can do with less."""
    symmetric, need = is_symmetric(scene), 0.0
    for rod in scene.rods:
        borders = rod_borders(scene, rod, refinement, symmetric)
        across, up = 2 * len(borders.x) - 1, 2 * len(borders.y) - 1
        lengths = np.diff(borders.s)
        kinds = len(np.unique(np.round(lengths / lengths.max(), 11)))
        full = 3 * across * up
        need += layered_bytes(full, full - up * symmetric, len(lengths), kinds)
    return need


def _is_clamped_bars(scene: Scene) -> bool:
    """Whether `scope` takes the scene, every rod has a clamp and those in contact are parallel."""
    try:
        require_treatable(scene)
        _require_support(scene)
        for pair in scene.contacts:
            pair_overlap(scene, pair)
    except SceneError:
        return False
    return True


def _require_support(scene: Scene) -> None:
    clamped = {clamp.rod for clamp in clamps(scene)}
    for rod in scene.rods:
        if rod.name not in clamped:
            found = f"no clamp on rod '{rod.name}'"
            raise SceneError(
                "supports", found, "the 3D reference needs a clamp on every rod, or its stiffness is singular"
            )


def _require_compressible(scene: Scene) -> None:
    for rod in scene.rods:
        ratio = rod.material.poisson_ratio if isinstance(rod.material, Material) else 0.0
        if ratio > LARGEST_POISSON_RATIO:
            remedy = f"the displacements of the 3D reference need at most {LARGEST_POISSON_RATIO:g}"
            raise SceneError(f"rods.{rod.name}.material.poisson_ratio", f"{ratio:.10g}", remedy)


def _candidates(pair: ContactPair, nodes: ContactNodes, located: Solution | None) -> BoolArray:
    """Contact nodes that may touch, shape (n_s n_lateral,): near those that do on the coarse mesh."""
    if located is None:
        return np.ones(nodes.area.size, dtype=bool)
    coarse = located.pairs[pair.name]
    touched = coarse.station[(coarse.pressure > 0.0).any(axis=1)]
    sections = [rectangle(located.scene.rod(side.rod)) for side in pair.faces]
    margin = MARGIN * min(min(section.width, section.height) for section in sections)
    near = near_contact(nodes.station, touched, margin)
    return np.repeat(near, len(nodes.lateral))


def _sides(scene: Scene, nodes: list[ContactNodes], rod: Rod) -> list[csc_array | None]:
    """For each pair, the rows of the normal displacement of this rod's face, if it is in the pair."""
    found: list[csc_array | None] = []
    for pair, grid in zip(scene.contacts, nodes, strict=True):
        rows = zip(pair.faces, (grid.first, grid.second), strict=False)
        found.append(next((each for face, each in rows if face.rod == rod.name), None))
    return found


def _contact_forces(
    scene: Scene, bodies: dict[str, Body], nodes: list[ContactNodes], candidates: list[BoolArray]
) -> tuple[list[Array], list[Array], str, int]:
    """Nodal contact forces of each pair, how far their springs give way, outcome, and the active sets tried."""
    counts = [int(chosen.sum()) for chosen in candidates]
    starts = np.concatenate([[0], np.cumsum(counts)])
    total = int(starts[-1])
    forces = [np.zeros(grid.area.size) for grid in nodes]
    given_way = [np.zeros(grid.area.size) for grid in nodes]
    if total == 0:
        return forces, given_way, "converged", 0
    matrix, offset = np.zeros((total, total)), np.zeros(total)
    soft, rigid = np.zeros(total), np.zeros(total, dtype=bool)
    for index, (grid, chosen) in enumerate(zip(nodes, candidates, strict=True)):
        place = np.arange(starts[index], starts[index + 1])
        soft[place], rigid[place] = 1.0 / (grid.penalty * grid.area.ravel()[chosen]), grid.rigid
        matrix[place, place] += soft[place]
        offset[place] += grid.gap[chosen]
    for body in bodies.values():
        rows, places = [], []
        for index, side in enumerate(_sides(scene, nodes, body.rod)):
            if side is not None:
                rows.append(side.tocsr()[candidates[index]].T)
                places.append(np.arange(starts[index], starts[index + 1]))
        if not rows:
            continue
        columns = csc_array(hstack([*rows, csc_array(body.load.reshape(-1, 1))]))
        columns.data[body.fixed.ravel()[columns.indices]] = 0.0
        columns.eliminate_zeros()
        columns = columns.tocsr()[body.free_everywhere].tocsc()
        work = compliance(body.factor, columns)
        place = np.concatenate(places)
        matrix[np.ix_(place, place)] += work[:-1, :-1]
        offset[place] += work[:-1, -1]
    if all(chosen.all() for chosen in candidates):
        sprung = solve_nested(matrix, offset, [grid.area.shape for grid in nodes])
    else:
        sprung = solve_complementarity(matrix, offset, offset < 0.0)
    answer = without_penetration(matrix, offset, soft, rigid, sprung)
    for index, chosen in enumerate(candidates):
        forces[index][chosen] = answer.force[starts[index] : starts[index + 1]]
        given_way[index][chosen] = answer.given_way[starts[index] : starts[index + 1]]
    return forces, given_way, answer.outcome, answer.steps


def _respond(
    scene: Scene, bodies: dict[str, Body], nodes: list[ContactNodes], forces: list[Array]
) -> tuple[dict[str, tuple[Array, Array]], list[Array]]:
    """Displacement and force of each body, shape (n_planes, m), and the gaps of each pair."""
    fields: dict[str, tuple[Array, Array]] = {}
    gaps = [grid.gap.copy() for grid in nodes]
    for name, body in bodies.items():
        force = body.load.copy()
        sides = _sides(scene, nodes, body.rod)
        for side, contact_force in zip(sides, forces, strict=True):
            if side is not None:
                force += (side.T @ contact_force).reshape(force.shape)
        field = np.zeros_like(force)
        field[:, body.free] = solve_layers(body.factor, np.where(body.fixed, 0.0, force)[:, body.free])
        for index, side in enumerate(sides):
            if side is not None:
                gaps[index] += side @ field.ravel()
        fields[name] = (field, force)
    return fields, gaps


@dataclass(frozen=True)
class _Found:
    """What was found for every pair and every body.

    Attributes
    ----------
    forces : at the contact nodes of each pair, N
    given_way, gaps : how far the springs of each pair give way, and distance of its faces, mm
    fields : displacement and force of each body
    outcome, solutions, steps : of the contact iteration
    """

    forces: list[Array]
    given_way: list[Array]
    gaps: list[Array]
    fields: dict[str, tuple[Array, Array]]
    outcome: str
    solutions: int
    steps: int


def _collect(
    scene: Scene,
    refinement: int,
    symmetric: bool,
    bodies: dict[str, Body],
    nodes: list[ContactNodes],
    found: _Found,
    moments: tuple[float, float],
) -> Solution:
    """The solution of the full section from that of the bodies."""
    outcome = found.outcome
    rods: dict[str, RodResult] = {}
    energy, residual, moved, volume, elements, unknowns = 0.0, 0.0, 0.0, 0.0, 0, 0
    for name, body in bodies.items():
        displaced, force = found.fields[name]
        internal = body.stiffness.apply(displaced)
        out_of_balance = internal - force
        largest = float(np.abs(internal).max())
        if largest > 0.0:
            residual = max(residual, float(np.abs(out_of_balance[~body.fixed]).max()) / largest)
        moved = max(moved, float(np.abs(displaced).max()))
        energy += (2.0 if symmetric else 1.0) * 0.5 * float(np.vdot(displaced, internal))
        x, y, s = body.borders.x, body.borders.y, body.borders.s
        volume += float((x[-1] - x[0]) * (y[-1] - y[0]) * (s[-1] - s[0]))
        elements += (len(x) - 1) * (len(y) - 1) * (len(s) - 1)
        unknowns += int((~body.fixed).sum())
        shape = (2 * len(s) - 1, 2 * len(y) - 1, 2 * len(x) - 1, 3)
        field = Field(body.borders, displaced.reshape(shape))
        reaction = np.stack(
            [_support_reaction(scene, body, out_of_balance.reshape(shape), symmetric, end) for end in (0, -1)]
        )
        rods[name] = RodResult(body.rod, mirrored(field) if symmetric else field, reaction)
    pairs, mismatch, penetrating = {}, 0.0, 0.0
    for pair, grid, force, way, gap in zip(
        scene.contacts, nodes, found.forces, found.given_way, found.gaps, strict=True
    ):
        pairs[pair.name] = _pair_result(pair, grid, force, way, gap, symmetric)
        mismatch = max(mismatch, float(np.abs(gap + way)[force > 0.0].max(initial=0.0)))
        if grid.rigid:
            penetrating += (2.0 if symmetric else 1.0) * 0.5 * float(force @ np.abs(way))
    if outcome == "converged" and residual > RESIDUAL_TOLERANCE:
        outcome = f"refused: forces are out of balance by {residual:.1e} of the largest"
    if outcome == "converged" and mismatch > GAP_TOLERANCE * moved:
        outcome = f"refused: contact forces and displacements disagree by {mismatch:.1e} mm"
    if outcome == "converged" and penetrating > PENALTY_SHARE * energy:
        outcome = f"refused: the penalty is too soft, penetration holds {penetrating / energy:.2g} of the strain energy"
    begin, ready = moments
    return Solution(
        scene=scene,
        outcome=outcome,
        contact_solutions=found.solutions,
        active_sets=found.steps,
        strain_energy=energy,
        cost=Cost(unknowns, ready - begin, time.perf_counter() - ready),
        residual=residual,
        representative_size=(volume / elements) ** (1.0 / 3.0),
        refinement=refinement,
        rods=rods,
        pairs=pairs,
    )


def _support_reaction(scene: Scene, body: Body, nodal: Array, symmetric: bool, end: int) -> Array:
    """Force and moment about the section's centre that a clamp exerts on the rod, global, shape (6,)."""
    clamped = {clamp.end for clamp in clamps(scene) if clamp.rod == body.rod.name}
    if ("start" if end == 0 else "end") not in clamped:
        return np.zeros(6)
    force = nodal[end]
    x, y = line_nodes(body.borders.x), line_nodes(body.borders.y)
    if symmetric:
        # twice the half: what acts across the plane is internal, what acts along x cancels
        force = force * np.array([0.0, 2.0, 2.0])
        x = np.zeros_like(x)
    arm = np.zeros_like(force)
    arm[..., 0], arm[..., 1] = x, y[:, None]
    local = np.stack([force.sum(axis=(0, 1)), np.cross(arm, force).sum(axis=(0, 1))])
    return np.asarray((local @ rod_frame(body.rod).axes).ravel())


def _pair_result(
    pair: ContactPair, nodes: ContactNodes, force: Array, way: Array, gap: Array, symmetric: bool
) -> PairResult:
    # in contact the gap follows from the springs, free of the cancellation in the difference of displacements
    shape = nodes.area.shape
    area = nodes.area
    gap = np.where(force > 0.0, -way, np.maximum(gap, 0.0)).reshape(shape)
    pressure = force.reshape(shape) / area
    lateral = nodes.lateral
    if symmetric:
        # a node in the middle has half its area on either side
        middle = 1 if lateral[0] == 0.0 else 0
        half = area.copy()
        half[:, :middle] *= 2.0
        area = np.concatenate([half[:, middle:][:, ::-1], half], axis=1)
        gap = np.concatenate([gap[:, middle:][:, ::-1], gap], axis=1)
        pressure = np.concatenate([pressure[:, middle:][:, ::-1], pressure], axis=1)
        lateral = np.concatenate([-lateral[middle:][::-1], lateral])
    return PairResult(pair, nodes.station, lateral, area, gap, pressure)
