"""What supports and joints hold of a solid rod's planes of nodes, and which rigid motions that leaves free."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import COMPONENTS, ENDS, Clamp, Scene, SceneError, Support, station_of
from reference3d.faces import face_points, gauss_face, normal_rows
from reference3d.plane_chain import HeldPlane, combinations_held
from reference3d.section_mesh import face_edges
from reference3d.solid_body import SolidBody

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# share of the largest singular value below which a rigid motion counts as free
FREE = 1e-7


@dataclass(frozen=True, eq=False)
class Hold:
    """How one plane is held.

    Attributes
    ----------
    border : number of the layer border that it is
    plane : what is held of its m unknowns
    given : what its unknowns are set to as far as they are held, shape (m,)
    joint : number of the joint that it takes part in, or None
    motions : its unknowns under unit motions along and about global X, Y, Z of the joint, shape (m, 6)
    """

    border: int
    plane: HeldPlane
    given: Array
    joint: int | None
    motions: Array


def holds(scene: Scene, body: SolidBody) -> dict[int, Hold]:
    """All planes of a rod that supports and joints hold, by the number of the layer border."""
    found: list[Hold] = []
    rod, size = body.rod, 3 * len(body.section.nodes)
    none, all_of_it = np.empty((size, 0)), HeldPlane(None, np.ones(size, dtype=bool))
    for support in scene.supports:
        if support.rod != rod.name:
            continue
        border = body.border_at(station_of(support, rod))
        if isinstance(support, Clamp):
            motion = np.concatenate([support.displacement, support.rotation])
            centre = body.points[2 * border]
            found.append(Hold(border, all_of_it, rigid_motions(body, border, centre) @ motion, None, none))
        else:
            plane, given = _held_by(support, body)
            found.append(Hold(border, plane, given, None, none))
    for number, joint in enumerate(scene.joints):
        for end in joint.ends:
            if end.rod == rod.name:
                border = 0 if end.end == "start" else len(body.kind)
                motions = rigid_motions(body, border, joint_point(scene, number))
                found.append(Hold(border, all_of_it, np.zeros(size), number, motions))
    return {hold.border: hold for hold in found}


def joint_point(scene: Scene, joint: int) -> Array:
    """Where the rods of a joint meet, global, mm: the end of the first."""
    first = scene.joints[joint].ends[0]
    return np.array(scene.rod(first.rod).centre_line.end_points[ENDS.index(first.end)])


def rigid_motions(body: SolidBody, border: int, pole: Array) -> Array:
    """Unknowns of a plane under unit motions along and about global X, Y, Z through a pole, shape (m, 6)."""
    return _rigid(body, np.array([2 * border]), pole).reshape(-1, 6)


def rigid_field(body: SolidBody, pole: Array) -> Array:
    """All unknowns of a rod under these motions, shape (n_planes, n_nodes, 3, 6)."""
    return _rigid(body, np.arange(len(body.points)), pole)


def _rigid(body: SolidBody, planes: IntArray, pole: Array) -> Array:
    axes = body.axes[planes]
    arm = body.points[planes][:, None] - pole + body.section.nodes @ axes[:, :2]
    turned = np.cross(np.eye(3), arm[:, :, None])  # plane, node, rotation axis, component
    moved = np.concatenate([np.broadcast_to(np.eye(3), turned.shape), turned], axis=2)
    return np.asarray(np.einsum("pnmc,pbc->pnbm", moved, axes))


def _held_by(support: Support, body: SolidBody) -> tuple[HeldPlane, Array]:
    wanted = support.displacement or (0.0,) * len(support.components)
    numbers = [COMPONENTS.index(component) for component in support.components]
    if support.of == "section":
        values = np.zeros((len(body.section.nodes), 3))
        fixed = np.zeros(values.shape, dtype=bool)
        values[:, numbers], fixed[:, numbers] = wanted, True
        return HeldPlane(None, fixed.ravel()), values.ravel()
    rows = body.integrals.mean_motion()[numbers].reshape(len(numbers), -1)
    return combinations_held(rows), np.linalg.pinv(rows) @ np.array(wanted)


@dataclass(frozen=True, eq=False)
class Loose:
    """Rods, joined or one alone, that supports, joints and beds leave free to move as a rigid body.

    Attributes
    ----------
    rods : their names
    centre : a point, global, mm, shape (3,)
    motions : the free motions: displacement of `centre` and rotation, mm and rad, rows, shape (n_free, 6)
    alone : whether it is one rod without joints
    """

    rods: tuple[str, ...]
    centre: Array
    motions: Array
    alone: bool


def require_held(
    scene: Scene,
    bodies: Mapping[str, SolidBody],
    held: Mapping[str, Mapping[int, Hold]],
    structures: Sequence[set[str]],
) -> None:
    """See that no rod, with those joined to it, can move as a rigid body.

    structures : names of rods that joints connect

    Raises
    ------
    SceneError
        if one can; it names the rods and the motion.
    """
    for names in structures:
        loose = _loose(scene, bodies, held, names, np.eye(6))
        if loose is not None:
            raise _not_held(loose, "hold it by supports, joints or beds, or its stiffness is singular")


def loose_rods(
    scene: Scene,
    bodies: Mapping[str, SolidBody],
    held: Mapping[str, Mapping[int, Hold]],
    possible: Array,
) -> tuple[Loose, ...]:
    """Rods, with those joined to them, that can move as a rigid body where contact does not hinder them.

    possible : rows of displacement and rotation that the scene's symmetry leaves, shape (n, 6)

    Raises
    ------
    SceneError
        if one takes part in no contact; it names the rods and the motion.
    """
    touching = {face.rod for pair in scene.contacts for face in pair.faces}
    found = []
    for names in structures(scene):
        loose = _loose(scene, bodies, held, names, possible)
        if loose is not None and not names & touching:
            raise _not_held(loose, "hold it by supports, joints, beds or contact, or its stiffness is singular")
        if loose is not None:
            found.append(loose)
    return tuple(found)


def _not_held(loose: Loose, remedy: str) -> SceneError:
    names = ", ".join(repr(name) for name in loose.rods)
    return SceneError("supports", f"nothing that holds {names} against {_in_words(loose)}", remedy)


def _loose(
    scene: Scene,
    bodies: Mapping[str, SolidBody],
    held: Mapping[str, Mapping[int, Hold]],
    names: set[str],
    possible: Array,
) -> Loose | None:
    """What supports, joints and beds leave free of the possible motions of rods that are joined; None if nothing."""
    centre = np.mean([bodies[name].points.mean(axis=0) for name in sorted(names)], axis=0)
    size = max(bodies[name].rod.length for name in names)
    # rotations in units of 1 / size, so that both kinds of motion displace alike
    scale = np.repeat([1.0, 1.0 / size], 3)
    rows = [np.zeros((6, 6))]
    alone = True
    for name in names:
        body = bodies[name]
        for hold in held[name].values():
            alone &= hold.joint is None
            if hold.joint is None:
                motions = rigid_motions(body, hold.border, centre)
                in_basis = motions if hold.plane.basis is None else hold.plane.basis.T @ motions
                rows.append(in_basis[hold.plane.fixed] * scale)
        rows += [each * scale for each in _resisted_by_beds(scene, body, centre)]
    _, values, vectors = np.linalg.svd(np.concatenate(rows) @ possible.T, full_matrices=False)
    free = vectors[values <= FREE * values[0]] @ possible
    return Loose(tuple(sorted(names)), centre, free * scale, alone) if len(free) else None


def stay(body: SolidBody, held: Mapping[int, Hold], loose: Loose) -> Hold:
    """Hold of one more section of a loose rod, an end if it can be: of the mean motions that are free."""
    border = next(each for each in (0, len(body.kind), *range(1, len(body.kind))) if each not in held)
    functionals = body.integrals.mean_motion().reshape(6, -1)
    free = functionals @ rigid_motions(body, border, loose.centre) @ loose.motions.T
    size = functionals.shape[1]
    return Hold(border, combinations_held(free.T @ functionals), np.zeros(size), None, np.empty((size, 0)))


def _resisted_by_beds(scene: Scene, body: SolidBody, centre: Array) -> list[Array]:
    """Normal displacements at points of the faces on beds under unit rigid motions, shape (n, 6) each."""
    zeta, eta, _ = gauss_face()
    middle = 0.5 * (body.borders[1:] + body.borders[:-1])
    found = []
    for bed in scene.beds:
        if bed.rod != body.rod.name:
            continue
        edges = face_edges(body.section, body.rod.section, bed.face.face)
        for layer in np.flatnonzero((bed.start < middle) & (middle < bed.end)).tolist():
            planes = np.arange(2 * layer, 2 * layer + 3)
            position, axes = body.points[planes], body.axes[planes]
            points = face_points(body.section, edges, bed.face.face, position, axes, zeta, eta)
            local = _rigid(body, planes, centre)
            nodal = local[:, edges].transpose(1, 0, 2, 3, 4).reshape(len(edges), 27, 6)
            found.append((normal_rows(points, axes) @ nodal).reshape(-1, 6))
    return found


def _in_words(loose: Loose) -> str:
    """One of the free motions: a displacement if there is one, else a turn."""
    moved, turned = np.split(loose.motions, 2, axis=1)
    _, values, vectors = np.linalg.svd(turned.T)
    # of a turn by an angle that moves the ends by less than this, over their displacement, nothing is seen
    without_turn = vectors[int((values > FREE * np.abs(loose.motions).max()).sum()) :]
    if len(without_turn):
        return f"moving along {_shown(without_turn[0] @ moved)}"
    return f"turning about {_shown(vectors[0] @ turned)}"


def _shown(vector: Array) -> str:
    unit = vector / vector[np.argmax(np.abs(vector))]
    return "(" + ", ".join(f"{round(float(value), 3) + 0.0:g}" for value in unit) + ")"


def structures(scene: Scene) -> list[set[str]]:
    """Names of rods that joints connect, together."""
    groups = [{rod.name} for rod in scene.rods]
    for joint in scene.joints:
        names = {end.rod for end in joint.ends}
        met = [group for group in groups if group & names]
        groups = [group for group in groups if not group & names] + [set().union(*met)]
    return groups
