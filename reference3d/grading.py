"""Where the borders of a rod's elements lie: graded towards clamps, loads and the ends of contact zones.

A rod is first divided into coarse cells, whose lengths grow linearly away from the places that need short ones. Within
a contact zone these are the same for both rods, so that nodes meet nodes. Refinement k divides every coarse cell into k
along each axis, so that meshes of different k are systematically refined: element sizes fall as 1 / k. Next to places
where stress is singular, and towards the faces of a section, cells are not divided equally: borders lie at (j / k)^q of
the distance, which gives quadratic elements back what a singularity r^lambda takes from their order, 2 q lambda instead
of 2 lambda (I. Babuska, R. B. Kellogg, J. Pitkaranta, Numerische Mathematik 33 (1979) 447-471).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, GapTable, LineLoad, Rod, RodFace, Scene
from reference3d.frames import pair_overlap
from reference3d.scope import clamps, forces, on_bed, rectangle

Array = NDArray[np.float64]

# lengths of coarse cells as multiples of the smaller side of the section; these and the grading over the section
# were chosen by how contact force and deflection of the paper's cases change with each of them
CLAMP_CELL = 0.08
LOAD_CELL = 0.3
ZONE_END_CELL = 0.15
ZONE_CELL = 0.25
# the pressure of a bed has no corners and no steep edges
BED_CELL = 0.8
LARGEST_CELL = 1.2
SECTION_CELL = 0.5
# a broad side is not divided into more coarse cells than this
MOST_ACROSS = 6
GROWTH = 0.5  # increase of the cell length per distance
# q of the module's first lines; 2 brings the order at a clamp to 2.8 for nu = 0.3, 3 would leave the middle of a
# section to a few long elements
GRADING_EXPONENT = 2.0
# places at which the lengths of cells are added up along a segment
SAMPLES = 2001


@dataclass(frozen=True)
class Borders:
    """Element borders of one rod along x, y and s, mm."""

    x: Array
    y: Array
    s: Array


@dataclass(frozen=True)
class _Zone:
    start: float
    end: float
    size: float


def rod_borders(scene: Scene, rod: Rod, refinement: int, symmetric: bool) -> Borders:
    """Element borders of a rod.

    Parameters
    ----------
    refinement : k, elements along each axis of a coarse cell
    symmetric : True for the half x >= 0 alone
    """
    section = rectangle(rod)
    side = min(section.width, section.height)
    largest = LARGEST_CELL * side
    breaks = {place: min(size, largest) for place, size in _breaks(scene)[rod.name].items()}
    across: dict[str, list[float]] = {"x": [], "y": []}
    zones: list[_Zone] = []
    for pair in scene.contacts:
        overlap = pair_overlap(scene, pair)
        for face, opposite in zip(pair.faces, (overlap.first, overlap.second), strict=False):
            if face.rod == rod.name:
                zones.append(_Zone(*opposite[0], _zone_cells(scene, pair)[1]))
                across["x" if face.face in ("top", "bottom") else "y"] += opposite[1]
    return Borders(
        x=across_borders(section.width, across["x"], side, refinement, symmetric),
        y=across_borders(section.height, across["y"], side, refinement, False),
        s=_along(breaks, zones, largest, refinement),
    )


def _zone_cells(scene: Scene, pair: ContactPair) -> tuple[float, float]:
    """Lengths of coarse cells at the ends of a pair's zone and within it, mm."""
    sections = [rectangle(scene.rod(face.rod)) for face in pair.faces]
    smaller = min(min(section.width, section.height) for section in sections)
    at_ends, within = (BED_CELL, BED_CELL) if on_bed(pair) else (ZONE_END_CELL, ZONE_CELL)
    return at_ends * smaller, within * smaller


def _breaks(scene: Scene) -> dict[str, dict[float, float]]:
    """Where each rod needs a border, mm, and the length of the cells that begin there: endless where any will do.

    What one rod needs within a contact zone the other gets, too, so that nodes meet nodes: where meshes of two faces
    differ, contact errs in single pressures (`contact`).
    """
    breaks = {rod.name: {0.0: np.inf, rod.length: np.inf} for rod in scene.rods}

    def add(rod: str, position: float, size: float = np.inf) -> bool:
        """Note a place; whether it is new, or its cells are shorter than they were."""
        own, same = breaks[rod], 1e-7 * scene.rod(rod).length
        near = next((place for place in own if abs(place - position) < same), None)
        if near is not None and own[near] <= size:
            return False
        own[position if near is None else near] = size
        return True

    sides = {rod.name: min(rectangle(rod).width, rectangle(rod).height) for rod in scene.rods}
    for clamp in clamps(scene):
        end = 0.0 if clamp.end == "start" else scene.rod(clamp.rod).length
        add(clamp.rod, end, CLAMP_CELL * sides[clamp.rod])
    for load in forces(scene):
        if isinstance(load, LineLoad):
            add(load.rod, load.start)
            add(load.rod, load.end)
        else:
            add(load.rod, load.position, LOAD_CELL * sides[load.rod])
    ways = []
    for pair in scene.contacts:
        overlap = pair_overlap(scene, pair)
        at_ends, within = _zone_cells(scene, pair)
        for face, opposite in zip(pair.faces, (overlap.first, overlap.second), strict=False):
            for place in opposite[0]:
                add(face.rod, place, at_ends)
        for place in gap_kinks(pair, *overlap.first[0]):
            add(pair.first.rod, place, within)
        if isinstance(pair.second, RodFace):
            sign, shift = float(overlap.sign[0]), float(overlap.shift[0])
            first, second = pair.first.rod, pair.second.rod
            ways.append((first, second, overlap.first[0], sign, shift))
            ways.append((second, first, overlap.second[0], sign, -sign * shift))
    passed_on = True
    while passed_on:  # through all of a stack of rods
        passed_on = False
        for rod, other, (start, end), sign, shift in ways:
            for place, size in list(breaks[rod].items()):
                if start < place < end:
                    passed_on |= add(other, sign * place + shift, size)
    return breaks


def gap_kinks(pair: ContactPair, start: float, end: float) -> list[float]:
    """Stations between two others where a gap given by a table may bend: nodes beside a ridge would miss its height."""
    stations = pair.gap.stations if isinstance(pair.gap, GapTable) else ()
    return [station for station in stations if start < station < end]


def _along(breaks: dict[float, float], zones: list[_Zone], largest: float, refinement: int) -> Array:
    places = sorted(breaks)
    parts = [np.array(places[:1])]
    for start, end in pairwise(places):
        middle = 0.5 * (start + end)
        cap = np.full(SAMPLES, min([zone.size for zone in zones if zone.start < middle < zone.end], default=largest))
        parts.append(segment_borders((start, end), (breaks[start], breaks[end]), cap, largest, refinement)[1:])
    return np.concatenate(parts)


def segment_borders(
    ends: tuple[float, float], at_ends: tuple[float, float], cap: Array, largest: float, refinement: int
) -> Array:
    """Borders of one segment: cell length min(at_start + g d, at_end + g d', cap), rounded down to fit, mm.

    Parameters
    ----------
    at_ends : cell length that each end asks for; cells at an end that asks for less than `largest` are graded
    cap : at SAMPLES even places from start to end, shape (SAMPLES,)
    """
    start, end = ends
    at_start, at_end = at_ends
    place = np.linspace(start, end, SAMPLES)
    size = np.minimum(np.minimum(at_start + GROWTH * (place - start), at_end + GROWTH * (end - place)), cap)
    density = 1.0 / size
    count = np.concatenate([[0.0], np.cumsum(0.5 * (density[1:] + density[:-1]) * np.diff(place))])
    cells = max(1, int(np.ceil(count[-1] - 1e-6)))
    borders = np.interp(np.linspace(0.0, count[-1], cells + 1), count, place)
    borders[0], borders[-1] = start, end
    return _divided(borders, refinement, (at_start < largest, at_end < largest))


def _divided(borders: Array, parts: int, graded: tuple[bool, bool]) -> Array:
    """Borders of cells each divided into parts: equal ones, but for the first and last cell where they are graded."""
    even = np.arange(parts) / parts
    at = np.tile(even, (len(borders) - 1, 1))
    if graded[0]:
        at[0] = even**GRADING_EXPONENT
    if graded[1]:
        at[-1] = denser_at_one(even)
    if all(graded) and len(at) == 1:
        at[0] = np.where(
            even < 0.5, 0.5 * (2.0 * even) ** GRADING_EXPONENT, 0.5 + 0.5 * denser_at_one(2.0 * even - 1.0)
        )
    inner = borders[:-1, None] + np.diff(borders)[:, None] * at
    return np.append(inner.ravel(), borders[-1])


def across_borders(extent: float, inner: list[float], side: float, refinement: int, half: bool) -> Array:
    """Borders over a width or height, mm, one of them in the middle and one at each border of contact.

    Parameters
    ----------
    inner : borders of contact
    side : smaller side of the section
    half : only those of the half with positive coordinates
    """
    size = max(SECTION_CELL * side, extent / MOST_ACROSS)
    candidates = sorted([-0.5 * extent, 0.0, 0.5 * extent, *inner])
    places = [candidates[0]]
    for place in candidates[1:]:
        if place - places[-1] > 1e-7 * extent:
            places.append(place)
    places[-1] = 0.5 * extent
    parts = [np.array(places[:1])]
    for start, end in pairwise(places):
        cells = max(1, int(np.ceil((end - start) / size - 1e-6)))
        at = np.linspace(0.0, 1.0, cells * refinement + 1)
        if end == places[-1]:
            at = denser_at_one(at)
        elif start == places[0]:
            at = at**GRADING_EXPONENT
        parts.append(start + (end - start) * at[1:])
    borders = np.concatenate(parts)
    return borders[borders >= 0.0] if half else borders


def denser_at_one(at: Array) -> Array:
    """Map of [0, 1] onto itself that makes even places denser towards 1."""
    return np.asarray(1.0 - np.maximum(1.0 - at, 0.0) ** GRADING_EXPONENT)
