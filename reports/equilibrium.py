"""Section resultants of a rod from the equilibrium of all that acts on it, and how well that is in balance."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from cases.scene import ENDS, Joint, Rod, Scene
from reports.applied_forces import AppliedForces, Reactions, magnitude
from reports.solution import Array, Solution


def equilibrium_resultants(solution: Solution, rod: Rod, applied: AppliedForces, station: Array) -> Array:
    """Resultants from equilibrium: N, Q1, Q2 (N), M1, M2, T (N mm) in the local frame at s, shape (6, n).

    They are what the part beyond s exerts on the part before it, as in `Solution.section_resultants`: the sum of all
    forces on the part beyond s, or minus the sum on the part before it, whichever side has fewer reactions of supports
    and joints (beyond, where they are as many). At a force's own station the value is the one just before it (at the
    start: just after).

    Parameters
    ----------
    applied, station : of `applied_forces`, with the same stations
    """
    tolerance = 1e-9 * rod.length
    order = np.argsort(applied.station, kind="stable")
    place = applied.station[order]
    # Number of forces before each station.
    before = np.searchsorted(place, station - tolerance, side="left")
    before[station <= tolerance] = np.searchsorted(place, tolerance, side="right")
    held = np.concatenate([[0], np.cumsum(applied.is_reaction[order])])
    from_start = held[before] < held[-1] - held[before]
    position, axes = solution.frame(rod.name, station)
    pole = position[:, :1]
    moment = np.cross(applied.point - pole, applied.force, axis=0) + applied.moment
    acting = np.vstack([applied.force, moment])[:, order]
    nothing = np.zeros((6, 1))
    sums_before = np.hstack([nothing, np.cumsum(acting, axis=1)])
    sums_beyond = np.hstack([np.cumsum(acting[:, ::-1], axis=1)[:, ::-1], nothing])
    sums = np.where(from_start, -sums_before[:, before], sums_beyond[:, before])
    force = sums[:3]
    about_section = sums[3:] - np.cross(position - pole, force, axis=0)
    local_force, local_moment = (np.einsum("nai,in->an", axes, vector) for vector in (force, about_section))
    return np.vstack([local_force[2], local_force[0], local_force[1], local_moment])


def equilibrium_residual(
    scene: Scene, applied: Mapping[str, AppliedForces], reactions: Reactions, contact: float = 0.0
) -> float:
    """Largest unbalanced force on any rod or joint, relative to the loads or, where they are larger, the reactions.

    Moments count about a rod's start or the joint, over the length of the rod (of a joint: the longest of its rods).
    The measure is the sum of the magnitudes of the loads (distributed ones in all), or the largest reaction of a
    support or joint or force of a contact pair where that is larger: supports that are moved, or rods that are pressed
    together, need no load, and rods held by contact alone no support.

    Parameters
    ----------
    applied : of each rod, by name
    reactions : of `reports.applied_forces.reactions`
    contact : largest force of a contact pair, N
    """
    worst = 0.0
    for rod in scene.rods:
        forces = applied[rod.name]
        arm = forces.point - np.array(rod.centre_line.end_points[0])[:, None]
        moment = np.cross(arm, forces.force, axis=0) + forces.moment
        worst = max(worst, _as_force(forces.force.sum(axis=1), moment.sum(axis=1), rod.length))
    worst = max([worst, *(_joint_residual(scene, joint, reactions) for joint in scene.joints)])
    loads = sum(magnitude(load, scene.rod(load.rod)) for load in scene.loads)
    largest = max(
        (_as_force(found[:3], found[3:], scene.rod(name).length) for (name, _), found in reactions.items()), default=0.0
    )
    measure = max(loads, largest, contact)
    return worst / measure if measure > 0.0 else worst


def _joint_residual(scene: Scene, joint: Joint, reactions: Reactions) -> float:
    """Unbalanced force on a joint, N, or moment about it over the length of its longest rod."""
    total, length, pole = np.zeros(6), 0.0, np.zeros(3)
    for number, end in enumerate(joint.ends):
        rod, index = scene.rod(end.rod), ENDS.index(end.end)
        point = np.array(rod.centre_line.end_points[index])
        pole = point if number == 0 else pole
        reaction = reactions[end.rod, (0.0, rod.length)[index]]
        total += reaction + np.concatenate([np.zeros(3), np.cross(point - pole, reaction[:3])])
        length = max(length, rod.length)
    return _as_force(total[:3], total[3:], length)


def _as_force(force: Array, moment: Array, length: float) -> float:
    """The larger of a force and a moment over a length, N."""
    return max(float(np.linalg.norm(force)), float(np.linalg.norm(moment)) / length)
