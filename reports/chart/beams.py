"""Classical beams in unilateral contact: the cheap end of the chart, by Euler's and Bernoulli's theory or Timoshenko's.

Straight parallel beams that bend in one plane, of elements that are exact at their nodes, with shear (J. S.
Przemieniecki, Theory of Matrix Structural Analysis, 1968, section 5.6), pressed on one another by forces at points that
lie evenly over the contact zones. Sections stay as they are: beams that touch are as far apart as their axes.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.linalg import LinAlgError, cholesky, solve_triangular, solveh_banded
from scipy.optimize import nnls

from cases.contacts import face_geometry
from cases.scene import (
    Circle,
    Clamp,
    ContactPair,
    Ground,
    Line,
    LineLoad,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SectionForce,
    Vector,
    given_gap,
    station_of,
)
from reports.second_moments import area_and_second_moments
from reports.solution import Array

Theory = Literal["Euler-Bernoulli", "Timoshenko"]
THEORIES: tuple[Theory, ...] = ("Euler-Bernoulli", "Timoshenko")
# Elements of a rod besides those that points and loads ask for, so that its largest deflection is met.
ELEMENTS = 24
# Directions and lengths that differ by less are the same: share of one, and of a rod's length.
SAME = 1e-9
# Forces below this part of all of a pair's are round-off.
NO_FORCE = 1e-9
# Points that give way by less than this part of what the softest one does are held.
NO_GIVE = 1e-12


class NotBeams(Exception):
    """The scene is not one of straight parallel beams that bend in one plane; the message says why, in one sentence."""


@dataclass(frozen=True)
class BeamAnswer:
    """What beam theory says of a scene.

    Attributes
    ----------
    outcome : 'converged', or why not
    unknowns : deflections and slopes of the nodes that are free
    contact_force : by pair, N
    edges : by pair, start and end of each stretch of points that carry force, in turn, along the global axis to which
        the rods are most nearly parallel, mm, shape (n,)
    largest_deflection : by rod, mm
    clamp_moment : by rod and arc length of a clamp, mm: magnitude of the moment that it exerts, N mm
    """

    outcome: str
    unknowns: int
    contact_force: Mapping[str, float]
    edges: Mapping[str, tuple[float, ...]]
    largest_deflection: Mapping[str, float]
    clamp_moment: Mapping[tuple[str, float], float]


@dataclass(frozen=True, eq=False)
class _Plane:
    """The plane in which beams bend: direction along them and across, unit vectors of shape (3,)."""

    along: Array
    across: Array

    def place(self, rod: Rod, station: float) -> float:
        """Coordinate of a section along the plane's first direction, mm."""
        line = rod.centre_line
        start, end = np.array(line.end_points)
        return float((start + (end - start) * (station / line.length)) @ self.along)


@dataclass(frozen=True, eq=False)
class _Beam:
    """A beam of exact elements.

    Attributes
    ----------
    node : coordinates, mm, ascending, shape (n,)
    elements : stiffness, of deflection and slope at its two nodes, shape (n - 1, 4, 4)
    free : unknowns that no clamp holds
    load : on all unknowns, shape (2 n,)
    """

    rod: Rod
    node: Array
    elements: Array
    free: slice
    load: Array

    def solved(self, right: Array) -> Array:
        """Unknowns under loads, both of shape (2 n, m)."""
        banded = np.zeros((4, right.shape[0]))
        count = 2 * len(self.elements)
        for row in range(4):
            for column in range(row + 1):
                banded[row - column, column : column + count : 2] += self.elements[:, row, column]
        found = np.zeros_like(right)
        found[self.free] = solveh_banded(banded[:, self.free], right[self.free], lower=True)
        return found

    def deflection_at(self, place: Array) -> Array:
        """Indices of the deflections at the nodes that stand for places."""
        return np.asarray(2 * np.searchsorted(0.5 * (self.node[1:] + self.node[:-1]), place))

    def clamp_moment(self, clamp: Clamp, unknowns: Array, along: Array) -> float:
        """Magnitude of the moment that a clamp exerts, N mm."""
        start, end = np.array(self.rod.centre_line.end_points)
        first = (clamp.end == "start") == (float((end - start) @ along) > 0.0)
        element, part = (0, slice(0, 4)) if first else (-1, slice(-4, None))
        row, own = (1, 1) if first else (3, -1)
        return abs(float(self.elements[element, row] @ unknowns[part] - self.load[own]))


def solve_beams(scene: Scene, theory: Theory, points: int) -> BeamAnswer:
    """Solve a scene with beams.

    Parameters
    ----------
    points : over each contact zone, 2 at least

    Raises
    ------
    NotBeams
        if the scene is of another kind.
    """
    plane = _plane(scene)
    places = {pair.name: np.linspace(*_overlap(scene, pair, plane), points) for pair in scene.contacts}
    beams = {rod.name: _beam(scene, rod, plane, theory, places) for rod in scene.rods}
    pairs = [(pair, place) for pair in scene.contacts for place in places[pair.name]]
    opening = {name: np.zeros((2 * len(beam.node), len(pairs))) for name, beam in beams.items()}
    for number, (pair, place) in enumerate(pairs):
        upward = float(_normal(scene, pair) @ plane.across)
        for face, sign in zip(pair.faces, (-1.0, 1.0), strict=False):
            opening[face.rod][beams[face.rod].deflection_at(place), number] = sign * upward
    moved = {
        name: beam.solved(np.column_stack([beam.load, opening[name]])) for name, beam in beams.items()
    }  # by the loads, and by a unit force at each point
    force, outcome = np.zeros(len(pairs)), "converged"
    if pairs:
        gap = np.concatenate([_gap(scene, pair, plane, places[pair.name]) for pair in scene.contacts])
        distance = gap + sum(opening[name].T @ moved[name][:, 0] for name in beams)
        compliance = np.asarray(sum(opening[name].T @ moved[name][:, 1:] for name in beams))
        force, outcome = _pushing(compliance, distance)
    unknowns = {name: found[:, 0] + found[:, 1:] @ force for name, found in moved.items()}
    for name in beams:
        beams[name].load[:] += opening[name] @ force
    carried = dict(zip(places, force.reshape(len(places), -1), strict=True)) if pairs else {}
    return BeamAnswer(
        outcome,
        sum(beam.free.stop - beam.free.start for beam in beams.values()),
        {name: float(forces.sum()) for name, forces in carried.items()},
        {name: _edges(scene, plane, places[name], forces) for name, forces in carried.items()},
        {name: float(np.abs(found[::2]).max()) for name, found in unknowns.items()},
        {
            (clamp.rod, station_of(clamp, scene.rod(clamp.rod))): beams[clamp.rod].clamp_moment(
                clamp, unknowns[clamp.rod], plane.along
            )
            for clamp in scene.supports
            if isinstance(clamp, Clamp)
        },
    )


def _pushing(compliance: Array, distance: Array) -> tuple[Array, str]:
    """Forces >= 0 that leave no point overlapping and act only where points touch, and the outcome.

    They minimise f C f / 2 + d f, with C = L L' the least squares of L' f + L^-1 d (C. L. Lawson and R. J. Hanson,
    Solving Least Squares Problems, 1974, chapter 23).
    """
    forces = np.zeros(len(distance))
    # where clamps hold both, nothing can be pushed apart
    give = np.diag(compliance) > NO_GIVE * float(np.diag(compliance).max())
    try:
        factor = cholesky(compliance[np.ix_(give, give)], lower=True)
        forces[give], _ = nnls(factor.T, -solve_triangular(factor, distance[give], lower=True))
    except (LinAlgError, RuntimeError) as error:
        return forces, f"refused: {error}"
    return forces, "converged"


def _edges(scene: Scene, plane: _Plane, places: Array, forces: Array) -> tuple[float, ...]:
    """Start and end of each stretch of points that carry force, in turn, along a global axis, mm."""
    axis = int(np.argmax(np.abs(plane.along)))
    origin = np.array(scene.rods[0].centre_line.end_points[0])
    touching = np.concatenate([[False], forces > NO_FORCE * forces.sum(), [False]])
    changes = np.flatnonzero(np.diff(touching.astype(int)))
    last = places[changes - np.arange(len(changes)) % 2]
    return tuple(sorted((origin[axis] + (last - origin @ plane.along) * plane.along[axis]).tolist()))


def _beam(scene: Scene, rod: Rod, plane: _Plane, theory: Theory, places: Mapping[str, Array]) -> _Beam:
    """The elements of a rod and the loads on them."""
    loads = [load for load in scene.loads if load.rod == rod.name]
    wanted = [np.linspace(plane.place(rod, 0.0), plane.place(rod, rod.length), ELEMENTS + 1)]
    wanted += [places[pair.name] for pair in scene.contacts if rod.name in [face.rod for face in pair.faces]]
    for load in loads:
        stations = (load.position,) if isinstance(load, SectionForce) else (load.start, load.end)  # type: ignore[union-attr]
        wanted.append(np.array([plane.place(rod, station) for station in stations]))
    every = np.sort(np.concatenate(wanted))
    node = every[np.concatenate([[True], np.diff(every) > 1e3 * SAME * rod.length])]
    bending, shearing = _stiffness(rod, plane)
    length = np.diff(node)
    shear = 12.0 * bending / (shearing * length**2) if theory == "Timoshenko" else np.zeros(len(length))
    one, far, near = np.ones(len(length)), (2.0 - shear) * length**2, (4.0 + shear) * length**2
    rows = [
        [12.0 * one, 6.0 * length, -12.0 * one, 6.0 * length],
        [6.0 * length, near, -6.0 * length, far],
        [-12.0 * one, -6.0 * length, 12.0 * one, -6.0 * length],
        [6.0 * length, far, -6.0 * length, near],
    ]
    elements = np.moveaxis(np.array(rows), 2, 0) * (bending / ((1.0 + shear) * length**3))[:, None, None]
    held = {
        (support.end == "start") == (plane.place(rod, rod.length) > plane.place(rod, 0.0))
        for support in scene.supports
        if support.rod == rod.name and isinstance(support, Clamp)
    }  # whether it is the first node
    free = slice(2 if True in held else 0, 2 * len(node) - (2 if False in held else 0))
    beam = _Beam(rod, node, elements, free, np.zeros(2 * len(node)))
    for load in loads:
        across = float(np.array(load.force) @ plane.across)  # type: ignore[union-attr]
        if isinstance(load, SectionForce):
            beam.load[beam.deflection_at(np.array(plane.place(rod, load.position)))] += across
        elif isinstance(load, LineLoad):
            first, last = sorted(plane.place(rod, station) for station in (load.start, load.end))
            middle = 0.5 * (node[1:] + node[:-1])
            on = np.flatnonzero((middle > first) & (middle < last))
            shares = across * np.array([length[on] / 2.0, length[on] ** 2 / 12.0] * 2) * [[1.0], [1.0], [1.0], [-1.0]]
            for unknown, share in enumerate(shares):
                np.add.at(beam.load, 2 * on + unknown, share)
    return beam


def _stiffness(rod: Rod, plane: _Plane) -> tuple[float, float]:
    """E I and k G A, with k by G. R. Cowper (J. Appl. Mech. 33, 1966, 335-340), N mm^2 and N."""
    material, section = rod.material, rod.section
    if not isinstance(material, Material):
        raise NotBeams(f"the material of rod '{rod.name}' is not isotropic")
    nu = material.poisson_ratio
    match section:
        case Rectangle():
            shear_coefficient = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
        case Circle():
            shear_coefficient = 6.0 * (1.0 + nu) / (7.0 + 6.0 * nu)
        case _:
            raise NotBeams(f"rod '{rod.name}' has a section that is neither a rectangle nor a circle")
    area, moments = area_and_second_moments(section)
    axes = _axes(rod)
    across = axes[:2] @ plane.across
    aside = np.array([-across[1], across[0]])
    if abs(across @ moments @ aside) > 1e-6 * float(np.trace(moments)):
        raise NotBeams(f"rod '{rod.name}' is loaded askew to the principal axes of its section")
    shear_modulus = material.young_modulus / (2.0 * (1.0 + nu))
    bending = material.young_modulus * float(across @ moments @ across)
    return bending, shear_coefficient * shear_modulus * area


def _plane(scene: Scene) -> _Plane:
    """The plane in which the scene's beams bend; NotBeams if there is none."""
    for rod in scene.rods:
        if not isinstance(rod.centre_line, Line) or rod.centre_line.twist != 0.0:
            raise NotBeams(f"rod '{rod.name}' is not straight, or twisted")
        if not any(support.rod == rod.name for support in scene.supports):
            raise NotBeams(f"rod '{rod.name}' has no clamp")
    for support in scene.supports:
        if not isinstance(support, Clamp) or any(support.displacement) or any(support.rotation):
            raise NotBeams(f"rod '{support.rod}' has a support that is not a clamp at rest")
    if scene.joints or scene.beds:
        raise NotBeams("rods are joined, or lie on beds")
    along = _axes(scene.rods[0])[2]
    across = [_normal(scene, pair) for pair in scene.contacts]
    for pair in scene.contacts:
        if isinstance(pair.second, Ground) and pair.second.modulus is not None:
            raise NotBeams(f"contact '{pair.name}' is with a bed")
    for load in scene.loads:
        if not isinstance(load, SectionForce | LineLoad):
            raise NotBeams(f"rod '{load.rod}' has a load that is neither a force on a section nor one along the rod")
        across += [np.array(load.force) / math.hypot(*load.force)] if any(load.force) else []
    if not across:
        raise NotBeams("nothing bends them")
    first = across[0]
    origin = np.array(scene.rods[0].centre_line.end_points[0])
    for rod in scene.rods:
        aside = (np.array(rod.centre_line.end_points) - origin) @ np.cross(along, first)
        parallel = np.linalg.norm(np.cross(_axes(rod)[2], along)) < SAME
        if not parallel or float(np.abs(aside).max()) > SAME * rod.length:
            raise NotBeams("rods are not parallel, or not in one plane")
    if any(np.linalg.norm(np.cross(each, first)) > SAME for each in across) or abs(first @ along) > SAME:
        raise NotBeams("loads and contact do not act across the rods in one plane")
    plane = _Plane(along, first)
    for rod in scene.rods:
        _stiffness(rod, plane)
    return plane


def _axes(rod: Rod) -> Array:
    """Rows e1, e2, t of a straight rod, shape (3, 3)."""
    line = rod.centre_line
    assert isinstance(line, Line)  # as `_plane` looks at first
    tangent = _unit(tuple(np.subtract(line.end, line.start)))
    up = np.array(line.up)
    across = _unit(tuple(up - (up @ tangent) * tangent))
    return np.array([np.cross(across, tangent), across, tangent])


def _unit(vector: Vector) -> Array:
    return np.array(vector) / math.hypot(*vector)


def _normal(scene: Scene, pair: ContactPair) -> Array:
    """Outward normal of the pair's first face."""
    geometry = face_geometry(scene.rod(pair.first.rod), pair.first.face)
    if geometry is None:
        raise NotBeams(f"rod '{pair.first.rod}' has no flat face")
    return np.asarray(geometry.normal)


def _overlap(scene: Scene, pair: ContactPair, plane: _Plane) -> tuple[float, float]:
    """Coordinates between which the pair may touch, mm."""
    first = scene.rod(pair.first.rod)
    start, end = sorted(plane.place(first, station) for station in pair.zone)
    if isinstance(pair.second, RodFace):
        second = scene.rod(pair.second.rod)
        ends = sorted(plane.place(second, station) for station in (0.0, second.length))
        start, end = max(start, ends[0]), min(end, ends[1])
    if end <= start:
        raise NotBeams(f"nothing lies opposite in the zone of contact '{pair.name}'")
    return start, end


def _gap(scene: Scene, pair: ContactPair, plane: _Plane, places: Array) -> Array:
    """Gap before the load, mm, shape (n,)."""
    first = scene.rod(pair.first.rod)
    if pair.gap == "drawn":
        assert isinstance(pair.second, RodFace)  # ground is not drawn
        sides = [face_geometry(scene.rod(face.rod), face.face) for face in pair.faces]
        reach: list[float] = []
        for face, geometry in zip(pair.faces, sides, strict=True):
            if geometry is None:
                raise NotBeams(f"rod '{face.rod}' has no flat face")
            section = scene.rod(face.rod).section
            assert isinstance(section, Rectangle)  # it has a flat face, and `_plane` refuses boxes
            half = (section.height if face.face in ("top", "bottom") else section.width) / 2.0
            reach.append(float(np.asarray(geometry.start) @ _normal(scene, pair)) + half * (1 if not reach else -1))
        return np.full(len(places), reach[1] - reach[0])
    ends = [plane.place(first, station) for station in (0.0, first.length)]
    stations = (places - ends[0]) / (ends[1] - ends[0]) * first.length
    return np.asarray(given_gap(pair.gap, stations))
