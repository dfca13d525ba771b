"""Everything that acts on a rod: loads, contact forces, beds, and the reactions of supports and joints.

Distributed loads are summed up between stations by Gauss points, on the geometry that the solution's frames tell.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import (
    ENDS,
    Gravity,
    LineLoad,
    Load,
    Pressure,
    Rod,
    SectionForce,
    SectionMoment,
    station_of,
)
from reports.geometry import changes_of_turning, face_extent, stations_of_points
from reports.second_moments import area_and_second_moments
from reports.solution import Array, Solution

# Gauss points between two stations. They follow frames that turn steadily, as those of a helix or a twisted line, to
# round-off where they turn by no more than a radian in between.
GAUSS_POINTS = 12


@dataclass(frozen=True)
class AppliedForces:
    """Forces on one rod.

    Attributes
    ----------
    station : where the rod is cut to have them on one side or the other, arc length, mm, shape (n,)
    point, force, moment : mm, N, N mm, global, shape (3, n) each; the moment is about the point
    is_reaction : whether a support or joint exerts it, shape (n,)
    """

    station: Array
    point: Array
    force: Array
    moment: Array
    is_reaction: NDArray[np.bool_]


Reactions = Mapping[tuple[str, float], Array]


def reactions(solution: Solution) -> dict[tuple[str, float], Array]:
    """What supports and joints exert on the rods, by rod and arc length (mm): force and moment, global, shape (6,)."""
    scene = solution.scene
    places = [(support.rod, station_of(support, scene.rod(support.rod))) for support in scene.supports]
    for joint in scene.joints:
        places += [(end.rod, (0.0, scene.rod(end.rod).length)[ENDS.index(end.end)]) for end in joint.ends]
    return {place: solution.reaction(*place) for place in places}


def applied_forces(solution: Solution, rod: Rod, station: Array, reactions: Reactions) -> AppliedForces:
    """Loads, contact forces, bed forces and reactions on a rod.

    Parameters
    ----------
    station : arc lengths, mm, ascending, shape (n,), at which the rod will be cut: distributed loads are given by
        their resultants on the pieces between them
    reactions : of `reactions`
    """
    scene = solution.scene
    smooth = np.union1d(station, changes_of_turning(solution, rod))
    found = [_load(solution, load, rod, smooth) for load in scene.loads if load.rod == rod.name]
    for pair in scene.contacts:
        for face, sign in zip(pair.faces, (-1.0, 1.0), strict=False):
            if face.rod == rod.name:
                contact = solution.contact_points(pair.name)
                force = sign * contact.normal * contact.force
                found.append(_forces(stations_of_points(solution, rod.name, contact.position), contact.position, force))
    for number, bed in enumerate(scene.beds):
        if bed.rod == rod.name:
            springs = solution.bed_forces(number, _borders(bed.start, bed.end, station))
            found.append(_forces(springs.station, springs.position, springs.force))
    for (name, place), reaction in reactions.items():
        if name == rod.name:
            at = np.array([place])
            point, _ = solution.frame(name, at)
            found.append(AppliedForces(at, point, reaction[:3, None], reaction[3:, None], np.array([True])))
    nothing = np.zeros((3, 0))
    return AppliedForces(
        np.concatenate([np.zeros(0), *(each.station for each in found)]),
        np.hstack([nothing, *(each.point for each in found)]),
        np.hstack([nothing, *(each.force for each in found)]),
        np.hstack([nothing, *(each.moment for each in found)]),
        np.concatenate([np.zeros(0, dtype=bool), *(each.is_reaction for each in found)]),
    )


def magnitude(load: Load, rod: Rod) -> float:
    """A load as a force, N: line loads, pressures and weights in all, moments over the length of the rod."""
    match load:
        case SectionForce():
            return float(np.linalg.norm(load.force))
        case SectionMoment():
            return float(np.linalg.norm(load.moment)) / rod.length
        case LineLoad():
            return float(np.linalg.norm(load.force)) * (load.end - load.start)
        case Pressure():
            _, width = face_extent(rod, load.face.face)
            return abs(load.pressure) * width * (load.end - load.start)
        case Gravity():
            return float(np.linalg.norm(_weight_per_length(load, rod))) * rod.length


def _forces(station: Array, point: Array, force: Array, moment: Array | None = None) -> AppliedForces:
    moment = np.zeros_like(force) if moment is None else moment
    return AppliedForces(station, point, force, moment, np.zeros(len(station), dtype=bool))


def _load(solution: Solution, load: Load, rod: Rod, smooth: Array) -> AppliedForces:
    """One load; `smooth`: arc lengths, ascending, between which it is summed up and the frames turn smoothly."""
    match load:
        case SectionForce() | SectionMoment():
            at = np.array([load.position])
            point, _ = solution.frame(load.rod, at)
            zero = np.zeros((3, 1))
            if isinstance(load, SectionMoment):
                return _forces(at, point, zero, np.array(load.moment, dtype=float)[:, None])
            return _forces(at, point, np.array(load.force, dtype=float)[:, None])
        case LineLoad():
            pieces = _pieces(solution, rod, _borders(load.start, load.end, smooth))
            return _resultants(pieces, pieces.position, np.multiply.outer(load.force, pieces.weight))
        case Pressure():
            return _pressure(_pieces(solution, rod, _borders(load.start, load.end, smooth)), load, rod)
        case Gravity():
            return _gravity(_pieces(solution, rod, _borders(0.0, rod.length, smooth)), load, rod)


def _borders(start: float, end: float, station: Array) -> Array:
    """Start, the stations inside, end."""
    inside = station[(station > start) & (station < end)]
    return np.concatenate([[start], inside, [end]])


@dataclass(frozen=True)
class _Pieces:
    """Gauss points on m pieces of a rod, q on each.

    Attributes
    ----------
    middle : of each piece, arc length, mm, shape (m,)
    weight : mm, shape (m, q)
    position : on the centre line, mm, shape (3, m, q)
    axes, slopes : rows e1, e2, t and their derivatives along s (1/mm), shape (m, q, 3, 3)
    """

    middle: Array
    weight: Array
    position: Array
    axes: Array
    slopes: Array


def _pieces(solution: Solution, rod: Rod, borders: Array) -> _Pieces:
    root, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    # Derivatives at the Gauss points of the polynomial through them.
    legendre = np.polynomial.legendre.legvander(root, GAUSS_POINTS - 1)
    derivative = np.polynomial.legendre.legder(np.eye(GAUSS_POINTS), axis=0)
    slope = np.polynomial.legendre.legvander(root, GAUSS_POINTS - 2) @ derivative @ np.linalg.inv(legendre)
    half, middle = 0.5 * np.diff(borders), 0.5 * (borders[1:] + borders[:-1])
    position, axes = solution.frame(rod.name, (middle[:, None] + half[:, None] * root).ravel())
    axes = axes.reshape(len(middle), GAUSS_POINTS, 3, 3)
    return _Pieces(
        middle,
        np.outer(half, weight),
        position.reshape(3, len(middle), GAUSS_POINTS),
        axes,
        np.einsum("pq,m,mqai->mpai", slope, 1.0 / half, axes),
    )


def _resultants(pieces: _Pieces, position: Array, force: Array) -> AppliedForces:
    """Force and moment of each piece about the mean of its centre line; positions and forces of shape (3, m, any)."""
    centre = np.einsum("imq,mq->im", pieces.position, pieces.weight) / pieces.weight.sum(axis=1)
    moment = np.cross(position - centre[:, :, None], force, axis=0).sum(axis=2)
    return _forces(pieces.middle, centre, force.sum(axis=2), moment)


def _pressure(pieces: _Pieces, load: Pressure, rod: Rod) -> AppliedForces:
    """-p dA with dA = X_s x e1 dx ds on top, e2 x X_s dy ds on the right (outwards), X the points of the face.

    dA is linear across the face and its moment quadratic, so that two Gauss points across are exact.
    """
    offset, width = face_extent(rod, load.face.face)
    upright = load.face.face in ("top", "bottom")
    side = 1.0 if load.face.face in ("top", "right") else -1.0
    normal, lateral = (1, 0) if upright else (0, 1)
    along = np.moveaxis(pieces.axes, -1, 0), np.moveaxis(pieces.slopes, -1, 0)  # (3, m, q, axis)
    positions, forces = [], []
    for place in np.array([-0.5, 0.5]) * width / np.sqrt(3.0):
        out, out_slope = (side * offset * each[..., normal] + place * each[..., lateral] for each in along)
        tangent = along[0][..., 2] + out_slope
        across = along[0][..., lateral]
        area = np.cross(tangent, across, axis=0) if upright else np.cross(across, tangent, axis=0)
        positions.append(pieces.position + out)
        forces.append(-load.pressure * side * area * (0.5 * width * pieces.weight))
    return _resultants(pieces, np.concatenate(positions, axis=2), np.concatenate(forces, axis=2))


def _gravity(pieces: _Pieces, load: Gravity, rod: Rod) -> AppliedForces:
    """Weight between stations, at the centroid of its mass.

    With the volume element sqrt(g) = 1 + x t . e1' + y t . e2' a slice's mass is that of a straight rod and its
    centroid lies off the centre line by the second moments of the section times (t . e1', t . e2') over the area.
    """
    area, moments = area_and_second_moments(rod.section)
    stretch = np.einsum("mqi,mqai->amq", pieces.axes[:, :, 2], pieces.slopes[:, :, :2])
    offset = np.einsum("ab,bmq->amq", moments / area, stretch)
    centroid = pieces.position + np.einsum("amq,mqai->imq", offset, pieces.axes[:, :, :2])
    return _resultants(pieces, centroid, np.multiply.outer(_weight_per_length(load, rod), pieces.weight))


def _weight_per_length(load: Gravity, rod: Rod) -> Array:
    """Global components, N/mm, shape (3,)."""
    density = rod.material.density
    if density is None:
        raise ValueError(f"the material of rod '{rod.name}' has no density")
    area, _ = area_and_second_moments(rod.section)
    return density * area * np.array(load.acceleration, dtype=float)
