"""Where points of a scene lie along its rods and global axes, by the frames that a solution tells; faces of rods."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from cases.scene import Box, ContactPair, Face, Line, Path, Rectangle, Rod, Spline
from reports.solution import Array, Solution

# Names of the global axes.
AXES = ("X", "Y", "Z")
# The section that holds a point of a curved rod, by Newton's method: samples to begin from, steps at most, what they
# leave and, for the curvature, the distance of frames that are compared, as parts of the rod's length.
SAMPLES, MOST_STEPS, FOUND, STEP = 400, 30, 1e-12, 1e-4


def stations_of_points(solution: Solution, rod: str, points: Array) -> Array:
    """Arc length of the sections of a rod that hold the given points, mm, shape (n,); points (3, n), near the rod.

    Of several sections that do, it is the one that begins nearest.
    """
    line = solution.scene.rod(rod).centre_line
    if isinstance(line, Line):
        origin, axes = solution.frame(rod, np.zeros(1))
        along: Array = axes[0, 2] @ (points - origin)
        return along
    length = line.length
    samples = np.linspace(0.0, length, SAMPLES + 1)
    station: Array = samples[cKDTree(solution.frame(rod, samples)[0].T).query(points.T)[1]]
    for _ in range(MOST_STEPS):
        near = np.clip([station - STEP * length, station + STEP * length], 0.0, length)
        before, after = (solution.frame(rod, each)[1][:, 2] for each in near)
        position, axes = solution.frame(rod, station)
        away = points - position
        bent = np.einsum("ni,in->n", after - before, away) / (near[1] - near[0])
        step = np.einsum("ni,in->n", axes[:, 2], away) / (1.0 - bent)
        station, moved = np.clip(station + step, 0.0, length), station
        if np.abs(station - moved).max(initial=0.0) <= FOUND * length:
            break
    return station


def face_extent(rod: Rod, face: Face) -> tuple[float, float]:
    """Distance of a flat lateral face from the centre line and its width, mm."""
    if not isinstance(rod.section, Rectangle | Box):
        raise TypeError(f"a {type(rod.section).__name__.lower()} has no flat faces")
    width, height = rod.section.width, rod.section.height
    return (height / 2.0, width) if face in ("top", "bottom") else (width / 2.0, height)


def changes_of_turning(solution: Solution, rod: Rod) -> Array:
    """Arc lengths within a rod, mm, at which the turning of its frame is not smooth: in paths and splines."""
    line = rod.centre_line
    pieces, starts = (line.pieces, line.borders) if isinstance(line, Path) else ((line,), (0.0,))
    found = [np.array(starts[1:-1])]
    for start, piece in zip(starts, pieces, strict=False):
        if isinstance(piece, Spline):
            sampled, points = piece.sampled.station, np.array(piece.points[1:-1]).T
            station = start + sampled[:: (len(sampled) - 1) // (len(piece.points) - 1)][1:-1]
            # The samples tell it as well as the chords between them; Newton's method settles it.
            for _ in range(3):
                position, axes = solution.frame(rod.name, station)
                station = station + np.einsum("ni,in->n", axes[:, 2], points - position)
            found.append(station)
    return np.concatenate(found)


def pair_axis(solution: Solution, pair: ContactPair) -> int:
    """Index of the global axis to which the pair's first rod is most nearly parallel in the middle of the zone."""
    _, axes = solution.frame(pair.first.rod, np.array([0.5 * (pair.zone[0] + pair.zone[1])]))
    return int(np.argmax(np.abs(axes[0, 2])))


def contact_limits(pair: ContactPair, station: Array) -> tuple[float, float]:
    """Where the zone, or what lies opposite in it, ends, arc length along the first rod, mm.

    station : of the pair's profile, which is as long as something lies opposite, mm, ascending, shape (n,)
    """
    return max(pair.zone[0], float(station[0])), min(pair.zone[1], float(station[-1]))
