"""Grids that suit a scene: elements short at clamps, loads and ends of contact, and long between."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cases.scene import (
    Clamp,
    Gravity,
    LineLoad,
    Load,
    Pressure,
    RodFace,
    Scene,
    SectionForce,
    SectionMoment,
    Vector,
    station_of,
)
from reference3d.peers.answer import Array
from reference3d.peers.ngsolve_mesh import Frame, Grid, Hexahedra, face_axis, frame, rectangle

# Cosine from which two directions are one.
_ALIGNED = 1.0 - 1e-9


@dataclass(frozen=True)
class Fineness:
    """How fine a mesh is; lengths in units of the section's height.

    Attributes
    ----------
    order : p, of the polynomials
    skin : thickness of the outermost of three elements over the height and over the width; 0 for a single element
    clamp, load, edge : length of elements at clamps, at loads on a section and at the ends of contact
    zone : length of elements where contact is looked for
    longest : length of elements far from all of these
    growth : growth of the length by the distance
    """

    order: int
    skin: float
    clamp: float
    load: float
    edge: float
    zone: float
    longest: float
    growth: float


COARSE = Fineness(order=3, skin=0.0, clamp=0.5, load=2.0, edge=1.0, zone=1.0, longest=12.0, growth=1.5)
FINE = Fineness(order=3, skin=0.15, clamp=0.05, load=2.0, edge=0.5, zone=1.0, longest=12.0, growth=1.2)


def graded(scene: Scene, fineness: Fineness, touching: Mapping[str, tuple[float, float]] | None = None) -> Hexahedra:
    """A mesh of straight rods of rectangular section.

    Parameters
    ----------
    touching : by pair, where it is known to touch, arc length along the first rod, mm: contact is looked for there and
        one height farther, and elements are short at its ends; without, contact is looked for in the whole zone
    """
    symmetric = is_symmetric(scene)
    zones = {pair.name: pair.zone for pair in scene.contacts}
    if touching is not None:
        for pair in scene.contacts:
            height = rectangle(scene.rod(pair.first.rod)).height
            low, high = touching.get(pair.name, pair.zone)
            zones[pair.name] = max(pair.zone[0], low - height), min(pair.zone[1], high + height)
    grids = {}
    for rod in scene.rods:
        section = rectangle(rod)
        stretches = _stretches(scene, rod.name, fineness, zones, touching or {})
        sizes = [(start, end, size * section.height) for start, end, size in stretches]
        s = _borders(rod.length, sizes, fineness.longest * section.height, fineness.growth)
        x, y = (_across(size, fineness.skin) for size in (section.width, section.height))
        if symmetric:
            x = np.concatenate([[0.0], x[x > 0.0]])
            if np.dot(frame(rod).axes[0], frame(scene.rods[0]).axes[0]) < 0.0:
                x = -x[::-1]
        grids[rod.name] = Grid(x, y, s)
    orders = {name: (fineness.order,) * grid.cells[2] for name, grid in grids.items()}
    return Hexahedra(grids, orders, symmetric, zones)


def _across(size: float, skin: float) -> Array:
    """Borders over the height or the width of a section, mm."""
    inner = [skin - 0.5, 0.5 - skin] if skin else []
    return size * np.array([-0.5, *inner, 0.5])


def _stretches(
    scene: Scene,
    rod: str,
    fineness: Fineness,
    zones: Mapping[str, tuple[float, float]],
    touching: Mapping[str, tuple[float, float]],
) -> list[tuple[float, float, float]]:
    """Where a rod's elements are to be short: start and end, mm, and their length in heights."""
    found = [
        (station_of(support, scene.rod(rod)),) * 2 + (fineness.clamp,)
        for support in scene.supports
        if support.rod == rod
    ]
    for load in (load for load in scene.loads if load.rod == rod):
        found += [(place, place, fineness.load) for place in _ends(load)]
    for bed in (bed for bed in scene.beds if bed.rod == rod):
        found += [(place, place, fineness.load) for place in (bed.start, bed.end)]
    for pair in scene.contacts:
        if rod not in [face.rod for face in pair.faces]:
            continue
        on_rod = _seen_from(scene, pair.first, rod, zones[pair.name])
        found.append((*on_rod, fineness.zone))
        if pair.name in touching:
            edges = _seen_from(scene, pair.first, rod, touching[pair.name])
            found += [(place, place, fineness.edge) for place in edges]
    return found


def _ends(load: Load) -> tuple[float, ...]:
    """Stations at which a load acts or begins and ends, mm."""
    match load:
        case SectionForce() | SectionMoment():
            return (load.position,)
        case LineLoad() | Pressure():
            return load.start, load.end
        case Gravity():
            return ()


def _seen_from(scene: Scene, first: RodFace, rod: str, stretch: tuple[float, float]) -> tuple[float, float]:
    """What lies opposite a stretch of a face, on a rod: arc lengths, mm."""
    if rod == first.rod:
        return stretch
    section, own = rectangle(scene.rod(first.rod)), frame(scene.rod(first.rod))
    axis = face_axis(first.face)
    half = (section.width if axis == 1 else section.height) / 2.0
    corners = np.zeros((3, 4))
    corners[1 - axis], corners[2] = (-half, half, -half, half), np.repeat(stretch, 2)
    length = scene.rod(rod).length
    opposite = np.clip(frame(scene.rod(rod)).coordinates(own.place(corners))[2], 0.0, length)
    return float(opposite.min()), float(opposite.max())


def _borders(length: float, stretches: list[tuple[float, float, float]], longest: float, growth: float) -> Array:
    """Borders from 0 to a length, between which elements are as long as asked for, growing away from short ones."""
    fixed = [0.0]
    for place in sorted({place for start, end, _ in stretches for place in (start, end)}):
        if place - fixed[-1] > 1e-6 * length and length - place > 1e-6 * length:
            fixed.append(place)
    fixed.append(length)
    borders = [0.0]
    for start, end in pairwise(fixed):
        s = np.linspace(start, end, 201)
        size = np.full(len(s), longest)
        for low, high, least in stretches:
            away = np.maximum(np.maximum(low - s, s - high), 0.0)
            size = np.minimum(size, least + growth * away)
        count = np.concatenate([[0.0], np.cumsum(np.diff(s) * (1.0 / size[1:] + 1.0 / size[:-1]) / 2.0)])
        elements = max(1, round(count[-1]))
        borders += np.interp(np.linspace(0.0, count[-1], elements + 1)[1:], count, s).tolist()
    return np.array(borders)


def is_symmetric(scene: Scene) -> bool:
    """Whether x = 0 is one plane of all rods, along global axes, and nothing acts across it."""
    frames = {rod.name: frame(rod) for rod in scene.rods}
    first = frames[scene.rods[0].name]
    normal = first.axes[0]
    if max(abs(normal)) < _ALIGNED:
        return False
    for name, own in frames.items():
        length = scene.rod(name).length
        off = abs(float(normal @ (own.start - first.start)))
        if abs(float(normal @ own.axes[0])) < _ALIGNED or off > 1e-9 * length:
            return False
    faces = [face for pair in scene.contacts for face in pair.faces] + [bed.face for bed in scene.beds]
    if any(face_axis(face.face) == 0 for face in faces):
        return False
    return all(_along(normal, force, moment) for force, moment in _actions(scene, frames))


def _along(normal: Array, force: Vector, moment: Vector) -> bool:
    """Whether a force lies in the plane of symmetry and a moment is about its normal."""
    across = abs(float(normal @ force)) <= 1e-12 * float(np.linalg.norm(force))
    return across and float(np.linalg.norm(np.cross(normal, moment))) <= 1e-9 * float(np.linalg.norm(moment))


def _actions(scene: Scene, frames: Mapping[str, Frame]) -> Iterable[tuple[Vector, Vector]]:
    """Force and moment, or displacement and rotation, of everything that acts, in any measure."""
    still = (0.0, 0.0, 0.0)
    for load in scene.loads:
        match load:
            case SectionForce() | LineLoad():
                yield load.force, still
            case SectionMoment():
                yield still, load.moment
            case Gravity():
                yield load.acceleration, still
            case Pressure():
                x, y, z = frames[load.rod].normal(load.face.face).tolist()
                yield (x, y, z), still
    for support in scene.supports:
        if isinstance(support, Clamp):
            yield support.displacement, support.rotation
        else:
            for component, given in zip(support.components, support.displacement, strict=False):
                x, y, z = (given * frames[support.rod].axes["xys".index(component)]).tolist()
                yield (x, y, z), still
