"""Where the planes of nodes of any rod lie along its centre line: layers graded towards what holds and loads it.

As in `grading`, coarse cells grow away from the places that need short ones, and refinement k divides each into k,
unequally next to those places.
"""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import ENDS, Clamp, Gravity, Line, Rod, Scene, SectionForce, SectionMoment, Support, station_of
from reference3d.centre_line import stretches, turning_rate
from reference3d.facing import patches
from reference3d.grading import (
    BED_CELL,
    CLAMP_CELL,
    LARGEST_CELL,
    LOAD_CELL,
    SAMPLES,
    ZONE_CELL,
    ZONE_END_CELL,
    gap_kinks,
    segment_borders,
)
from reference3d.scope import on_bed
from reference3d.section_mesh import section_extents

Array = NDArray[np.float64]

# angle by which the frame turns over a coarse cell at most, rad
LARGEST_TURN = 0.25
# coarse cells that a straight, untwisted rod has at least; slender ones need no more away from what disturbs
FEWEST_CELLS = 24
# cell where a gap that varies is least, of the smallest side of the sections
LEAST_GAP_CELL = 0.1


def layer_borders(scene: Scene, rod: Rod, refinement: int) -> Array:
    """Borders of the layers of elements, arc length, mm, ascending.

    refinement : k, layers a coarse cell
    """
    extents = section_extents(rod.section)
    side, between = min(extents), math.sqrt(extents[0] * extents[1])
    straight = isinstance(rod.centre_line, Line) and rod.centre_line.twist == 0.0
    largest = LARGEST_CELL * between
    if straight:
        largest = max(largest, rod.length / FEWEST_CELLS)
    breaks: dict[float, float] = {0.0: largest, rod.length: largest}

    def add(position: float, size: float) -> None:
        near = next((place for place in breaks if abs(place - position) < 1e-7 * rod.length), position)
        breaks[near] = min(size, breaks.get(near, np.inf))

    for stretch in stretches(rod.centre_line)[1:]:
        add(stretch.start, largest)
    for support in scene.supports:
        if support.rod == rod.name:
            add(station_of(support, rod), (CLAMP_CELL if is_rigid(support) else LOAD_CELL) * side)
    for joint in scene.joints:
        for joined in joint.ends:
            if joined.rod == rod.name:
                add((0.0, rod.length)[ENDS.index(joined.end)], CLAMP_CELL * side)
    for bed in scene.beds:
        if bed.rod == rod.name:
            add(bed.start, LARGEST_CELL * between)
            add(bed.end, LARGEST_CELL * between)
    for load in scene.loads:
        if load.rod != rod.name or isinstance(load, Gravity):
            continue
        if isinstance(load, SectionForce | SectionMoment):
            add(load.position, LOAD_CELL * side)
        else:
            add(load.start, LARGEST_CELL * between)
            add(load.end, LARGEST_CELL * between)
    close: list[tuple[float, float, float]] = []  # start, end and largest cell of what may touch
    for pair in scene.contacts:
        if all(face.rod != rod.name for face in pair.faces):
            continue
        smaller = min(min(section_extents(scene.rod(face.rod).section)) for face in pair.faces)
        at_ends, within = (BED_CELL, BED_CELL) if on_bed(pair) else (ZONE_END_CELL, ZONE_CELL)
        if pair.first.rod == rod.name:
            for place in pair.zone:
                add(place, largest)
        for face, patch in zip(pair.faces, patches(scene, pair), strict=True):
            if face.rod == rod.name:
                add(patch.start, at_ends * smaller)
                add(patch.end, at_ends * smaller)
                close.append((patch.start, patch.end, within * smaller))
                for place in gap_kinks(pair, patch.start, patch.end) if face == pair.first else ():
                    add(place, within * smaller)
                if patch.least is not None:
                    add(patch.least, LEAST_GAP_CELL * smaller)
    parts = [np.zeros(1)]
    for start, end in pairwise(sorted(breaks)):
        rate = turning_rate(rod.centre_line, np.linspace(start, end, SAMPLES + 2)[1:-1])
        cap = np.minimum(largest, LARGEST_TURN / np.maximum(rate, LARGEST_TURN / largest))
        middle = 0.5 * (start + end)
        cap = np.minimum(cap, min((size for begin, stop, size in close if begin < middle < stop), default=largest))
        parts.append(segment_borders((start, end), (breaks[start], breaks[end]), cap, largest, refinement)[1:])
    return np.concatenate(parts)


def is_rigid(support: Clamp | Support) -> bool:
    """Whether a support holds displacements at every point of a section, which makes stress singular at its edge."""
    return isinstance(support, Clamp) or support.of == "section"
