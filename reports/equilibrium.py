"""Section resultants of a rod from the equilibrium of loads, contact forces and reactions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cases.scene import End, LineLoad, Load, Rod, Scene, SectionMoment
from reports.geometry import station_of
from reports.solution import Array, Solution


@dataclass(frozen=True)
class AppliedForces:
    """Forces on one rod: station, mm, (n,); point, mm, force, N, and moment, N mm, (3, n) each."""

    station: Array
    point: Array
    force: Array
    moment: Array


def applied_forces(solution: Solution, rod: Rod, station: Array) -> AppliedForces:
    """Loads, contact forces and reactions on a rod.

    Parameters
    ----------
    station : arc lengths, mm, ascending, shape (n,), at which `equilibrium_resultants` will cut the rod: a line load
        is given by the resultant on each piece between them
    """
    scene = solution.scene
    found = [_load(solution, load, station) for load in scene.loads if load.rod == rod.name]
    for pair in scene.contacts:
        for face, sign in ((pair.first, -1.0), (pair.second, 1.0)):
            if face.rod == rod.name:
                contact = solution.contact_points(pair.name)
                force = sign * contact.normal * contact.force
                at = station_of(solution, rod.name, contact.position)
                found.append(AppliedForces(at, contact.position, force, np.zeros_like(force)))
    for end in _held_ends(scene, rod):
        at = np.array([0.0 if end == "start" else rod.length])
        reaction = solution.reaction(rod.name, end)
        point, _ = solution.frame(rod.name, at)
        found.append(AppliedForces(at, point, reaction[:3, None], reaction[3:, None]))
    nothing = np.zeros((3, 0))
    return AppliedForces(
        np.concatenate([np.zeros(0), *(each.station for each in found)]),
        np.hstack([nothing, *(each.point for each in found)]),
        np.hstack([nothing, *(each.force for each in found)]),
        np.hstack([nothing, *(each.moment for each in found)]),
    )


def _load(solution: Solution, load: Load, station: Array) -> AppliedForces:
    if isinstance(load, LineLoad):
        return _line_load(solution, load, station)
    at = np.array([load.position])
    point, _ = solution.frame(load.rod, at)
    zero = np.zeros((3, 1))
    if isinstance(load, SectionMoment):
        return AppliedForces(at, point, zero, np.array(load.moment, dtype=float)[:, None])
    return AppliedForces(at, point, np.array(load.force, dtype=float)[:, None], zero)


def _line_load(solution: Solution, load: LineLoad, station: Array) -> AppliedForces:
    """Resultants of the pieces of a line load between stations, at the centroids of the pieces (four Gauss points)."""
    inside = station[(station > load.start) & (station < load.end)]
    borders = np.concatenate([[load.start], inside, [load.end]])
    root, weight = np.polynomial.legendre.leggauss(4)
    length, middle = np.diff(borders), 0.5 * (borders[1:] + borders[:-1])
    place = middle[:, None] + 0.5 * length[:, None] * root
    points, _ = solution.frame(load.rod, place.ravel())
    centroid = points.reshape(3, len(length), len(root)) @ (0.5 * weight)
    force = np.outer(np.array(load.force, dtype=float), length)
    return AppliedForces(middle, centroid, force, np.zeros_like(force))


def _held_ends(scene: Scene, rod: Rod) -> tuple[End, ...]:
    return tuple(support.end for support in scene.supports if support.rod == rod.name)


def equilibrium_resultants(solution: Solution, rod: Rod, applied: AppliedForces, station: Array) -> Array:
    """Resultants from equilibrium: N, Q1, Q2 (N), M1, M2, T (N mm) in the local frame at s, shape (6, n).

    They are what the part beyond s exerts on the part before it, as in `Solution.section_resultants`: the sum of all
    forces on the part beyond s, or, where only the rod's end is held, minus the sum on the part before it, so that a
    reaction counts only where both ends are held. At a force's own station the value is the one just before it (at
    the start: just after).

    Parameters
    ----------
    applied, station : of `applied_forces`, with the same stations
    """
    tolerance = 1e-9 * rod.length
    beyond = applied.station[:, None] >= station - tolerance
    beyond &= ~((station <= tolerance) & (applied.station[:, None] <= tolerance))
    from_start = _held_ends(solution.scene, rod) == ("end",)
    weight = -(~beyond).astype(float) if from_start else beyond.astype(float)
    position, axes = solution.frame(rod.name, station)
    force = applied.force @ weight
    about_origin = (np.cross(applied.point, applied.force, axis=0) + applied.moment) @ weight
    moment = about_origin - np.cross(position, force, axis=0)
    local_force, local_moment = (np.einsum("nai,in->an", axes, vector) for vector in (force, moment))
    return np.vstack([local_force[2], local_force[0], local_force[1], local_moment])


def equilibrium_residual(scene: Scene, applied: Mapping[str, AppliedForces]) -> float:
    """Largest unbalanced force, or moment about a rod's start over its length, relative to the sum of the loads.

    Line loads count by their resultants, moments over the length of their rod.

    Parameters
    ----------
    applied : of each rod, by name
    """
    worst = 0.0
    for rod in scene.rods:
        forces = applied[rod.name]
        arm = forces.point - np.asarray(rod.centre_line.start, dtype=float)[:, None]
        force = forces.force.sum(axis=1)
        moment = (np.cross(arm, forces.force, axis=0) + forces.moment).sum(axis=1)
        worst = max(worst, float(np.linalg.norm(force)), float(np.linalg.norm(moment)) / rod.length)
    total = sum(_size(load, scene.rod(load.rod)) for load in scene.loads)
    return worst / total if total > 0.0 else worst


def _size(load: Load, rod: Rod) -> float:
    """Magnitude of a load as a force, N."""
    if isinstance(load, SectionMoment):
        return float(np.linalg.norm(load.moment)) / rod.length
    return float(np.linalg.norm(load.force)) * (load.end - load.start if isinstance(load, LineLoad) else 1.0)
