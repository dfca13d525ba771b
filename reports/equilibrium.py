"""Section resultants of a rod from the equilibrium of loads, contact forces and reactions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from cases.scene import End, Rod, Scene
from reports.geometry import centre_line_points, frame, station_of
from reports.solution import Array, Solution


@dataclass(frozen=True)
class AppliedForces:
    """Forces on one rod: station, mm, (n,); point, mm, force, N, and moment, N mm, (3, n) each."""

    station: Array
    point: Array
    force: Array
    moment: Array


def applied_forces(solution: Solution, rod: Rod) -> AppliedForces:
    """Loads, contact forces and reactions on a rod."""
    scene = solution.scene
    loads = [load for load in scene.loads if load.rod == rod.name]
    stations = [np.array([load.position for load in loads], dtype=float)]
    points = [centre_line_points(rod, stations[0])]
    forces = [np.array([load.force for load in loads], dtype=float).reshape(-1, 3).T]
    moments = [np.zeros_like(forces[0])]
    for pair in scene.contacts:
        for face, sign in ((pair.first, -1.0), (pair.second, 1.0)):
            if face.rod == rod.name:
                contact = solution.contact_points(pair.name)
                stations.append(station_of(rod, contact.position))
                points.append(contact.position)
                forces.append(sign * contact.normal * contact.force)
                moments.append(np.zeros_like(contact.normal))
    for end in _held_ends(scene, rod):
        station = np.array([0.0 if end == "start" else rod.length])
        reaction = solution.reaction(rod.name, end)
        stations.append(station)
        points.append(centre_line_points(rod, station))
        forces.append(reaction[:3, None])
        moments.append(reaction[3:, None])
    return AppliedForces(np.concatenate(stations), np.hstack(points), np.hstack(forces), np.hstack(moments))


def _held_ends(scene: Scene, rod: Rod) -> tuple[End, ...]:
    return tuple(support.end for support in scene.supports if support.rod == rod.name)


def equilibrium_resultants(scene: Scene, rod: Rod, applied: AppliedForces, station: Array) -> Array:
    """Resultants from equilibrium: N, Q1, Q2 (N), M1, M2, T (N mm) in the local frame, shape (6, n).

    They are what the part beyond s exerts on the part before it, as in `Solution.section_resultants`: the sum of all
    forces on the part beyond s, or, where only the rod's end is held, minus the sum on the part before it, so that a
    reaction counts only where both ends are held. At a force's own station the value is the one just before it (at
    the start: just after).
    """
    tolerance = 1e-9 * rod.length
    beyond = applied.station[:, None] >= station - tolerance
    beyond &= ~((station <= tolerance) & (applied.station[:, None] <= tolerance))
    from_start = _held_ends(scene, rod) == ("end",)
    weight = -(~beyond).astype(float) if from_start else beyond.astype(float)
    force = applied.force @ weight
    about_origin = (np.cross(applied.point, applied.force, axis=0) + applied.moment) @ weight
    moment = about_origin - np.cross(centre_line_points(rod, station), force, axis=0)
    axes = frame(rod)
    local_force, local_moment = axes @ force, axes @ moment
    return np.vstack([local_force[2], local_force[0], local_force[1], local_moment])


def equilibrium_residual(scene: Scene, applied: Mapping[str, AppliedForces]) -> float:
    """Largest unbalanced force, or moment about a rod's start over its length, relative to the sum of the loads.

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
    total = sum(float(np.linalg.norm(load.force)) for load in scene.loads)
    return worst / total if total > 0.0 else worst
