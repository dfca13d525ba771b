"""Rods that supports, joints and beds leave loose: rigid motions that none of them resists."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from cases.scene import COMPONENTS, Bed, Clamp, Joint, Rod, Scene, SceneError, Support
from rodmodel.assembly import Mirrors
from rodmodel.centre_line import centre_points, frames, turning_at
from rodmodel.face import face_strip
from rodmodel.holds import FreeMotions, Held, held_sections
from rodmodel.joints import Loose, symmetric_motions
from rodmodel.mesh import SAME_BORDER

Array = NDArray[np.float64]

# Share of the largest singular value below which a motion counts as free.
FREE = 1e-9


def loose_rods(scene: Scene, mirrors: Mapping[str, Mirrors]) -> tuple[Loose, ...]:
    """Rods, with those joined to them, that can move unresisted in ways that the scene's symmetry leaves.

    Raises
    ------
    SceneError
        if one can that no contact could hold; it names the rods and the motion.
    """
    clamped = {support.rod for support in scene.supports if isinstance(support, Clamp)}
    motions = symmetric_motions(scene, mirrors)
    touched = {side.rod for pair in scene.contacts for side in pair.faces}
    result = []
    for rods in _structures(scene):
        if any(rod.name in clamped for rod in rods):
            continue
        centre = np.mean([np.mean(rod.centre_line.end_points, axis=0) for rod in rods], axis=0)
        size = max(rod.length for rod in rods)
        # Turning in units of the rods' length, so that both kinds of motion displace alike.
        scale = np.repeat([1.0, 1.0 / size], 3)
        rows = [row * scale for rod in rods for row in _resisted(scene, rod, centre)]
        matrix = np.array(rows).reshape(-1, 6) @ motions.T
        _, values, vectors = np.linalg.svd(matrix, full_matrices=True)
        rank = int((values > FREE * values.max(initial=0.0)).sum())
        if rank == len(motions):
            continue
        free = vectors[rank:] @ motions
        names = tuple(rod.name for rod in rods)
        if not touched & set(names):
            found = f"nothing that holds {_listed(names)} against {_in_words(free.T, centre, size)}"
            remedy = "hold it by supports, joints, beds or contact, or its stiffness is singular"
            raise SceneError("supports", found, remedy)
        freely = FreeMotions(centre, free * scale)
        stay = _stay(scene, rods[0], freely) if len(rods) == 1 else None
        result.append(Loose(names, freely, stay))
    return tuple(result)


def _stay(scene: Scene, rod: Rod, free: FreeMotions) -> Held:
    """A section of a loose rod that nothing holds yet: an end, else an element border between."""
    taken = [held.station for held in held_sections(scene, rod)]
    ends_first = (rod.element_borders[0], rod.element_borders[-1], *rod.element_borders[1:-1])
    station = next((at for at in ends_first if all(abs(at - each) > SAME_BORDER for each in taken)), None)
    if station is None:
        remedy = "give it one more, so that one section is free of supports"
        raise SceneError(f"rods.{rod.name}.element_borders", "supports at all of them", remedy)
    return Held(station, free)


def _listed(names: Sequence[str]) -> str:
    return ", ".join(f"'{name}'" for name in names)


def _structures(scene: Scene) -> list[list[Rod]]:
    """Rods that joints connect, together."""
    groups = [{rod.name} for rod in scene.rods]
    for joint in scene.joints:
        names = {end.rod for end in joint.ends}
        met = [group for group in groups if group & names]
        groups = [group for group in groups if not group & names] + [set().union(*met)]
    return [[rod for rod in scene.rods if rod.name in group] for group in groups]


def _resisted(scene: Scene, rod: Rod, centre: Array) -> list[Array]:
    """Components of a rigid motion (displacement of `centre`, rotation) that are resisted, shape (6,) each."""
    rows: list[Array] = []
    for held in held_sections(scene, rod):
        if isinstance(held.by, Joint):
            continue
        point, axes = _section(rod, held.station)
        components: tuple[str, ...] = COMPONENTS
        if isinstance(held.by, Support):
            components = _resisted_by(held.by)
        for component in components:
            axis = axes["xys".index(component[-1])]
            if component.startswith("turn"):
                rows.append(np.concatenate([np.zeros(3), axis]))
            else:
                rows.append(_along(axis, point - centre))
    for bed in scene.beds:
        if bed.rod == rod.name:
            rows += _resisted_by_bed(bed, rod, centre)
    return rows


def _resisted_by(support: Support) -> tuple[str, ...]:
    """A component held all over the section resists turns as well."""
    if support.of == "mean":
        return support.components
    turns = {"x": ("turn s",), "y": ("turn s",), "s": ("turn x", "turn y")}
    return tuple(each for component in support.components for each in (component, *turns[component]))


def _resisted_by_bed(bed: Bed, rod: Rod, centre: Array) -> list[Array]:
    rows = []
    stations = np.linspace(bed.start, bed.end, 5)
    for station, (k1, k2, tau) in zip(stations, turning_at(rod.centre_line, stations).T.tolist(), strict=True):
        strip = face_strip(rod.section, bed.face.face, (k1, k2, tau), 1)
        point, axes = _section(rod, station)
        for x, y, area in zip(strip.x, strip.y, strip.area.T, strict=True):
            rows.append(_along(axes.T @ area / np.linalg.norm(area), point + x * axes[0] + y * axes[1] - centre))
    return rows


def _section(rod: Rod, station: float) -> tuple[Array, Array]:
    at = np.array([station])
    return centre_points(rod.centre_line, at)[:, 0], frames(rod.centre_line, at)[0]


def _along(direction: Array, arm: Array) -> Array:
    """Displacement along a direction at a point, in terms of displacement and rotation about a point `arm` away."""
    return np.concatenate([direction, np.cross(arm, direction)])


def _in_words(free: Array, centre: Array, size: float) -> str:
    """One of the free motions, the columns of `free`: a displacement if there is one, else a turn.

    free : displacement of `centre` and rotation in units of 1 / size, shape (6, n_free)
    """
    _, values, vectors = np.linalg.svd(free[3:], full_matrices=True)
    without_turn = vectors[int((values > FREE).sum()) :]
    if len(without_turn):
        return f"moving along {_shown(free[:3] @ without_turn[0])}"
    displacement, rotation = free[:3] @ vectors[0], free[3:] @ vectors[0] / size
    through = centre + np.cross(rotation, displacement) / (rotation @ rotation)
    return f"turning about the axis through {_shown(through, unit=False)} along {_shown(rotation)}"


def _shown(vector: Array, unit: bool = True) -> str:
    shown = vector / np.abs(vector).max() if unit else vector
    return "(" + ", ".join(f"{round(float(value), 3) + 0.0:g}" for value in shown) + ")"
