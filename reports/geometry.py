"""Where points of a scene lie along its rods and global axes, by the frames that a solution tells; faces of rods."""

from __future__ import annotations

import numpy as np

from cases.scene import Box, ContactPair, Face, Path, Rectangle, Rod, Spline
from reports.sections import outline
from reports.solution import Array, Solution

# Names of the global axes.
AXES = ("X", "Y", "Z")


def stations_of_points(solution: Solution, rod: str, points: Array) -> Array:
    """Arc length of the sections of a straight rod that hold the given points, mm, shape (n,); points (3, n)."""
    origin, axes = solution.frame(rod, np.zeros(1))
    station: Array = axes[0, 2] @ (points - origin)
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
    """Index of the global axis to which the pair's first rod is most nearly parallel."""
    _, axes = solution.frame(pair.first.rod, np.zeros(1))
    return int(np.argmax(np.abs(axes[0, 2])))


def contact_limits(solution: Solution, pair: ContactPair) -> tuple[float, float]:
    """Where the zone or the second rod (by the corners of its ends) ends, arc length along the first rod, mm."""
    second = solution.scene.rod(pair.second.rod)
    ends, axes = solution.frame(second.name, np.array([0.0, second.length]))
    corners = ends[:, :, None] + np.einsum("nai,ca->inc", axes[:, :2], outline(second.section))
    extent = stations_of_points(solution, pair.first.rod, corners.reshape(3, -1))
    return max(pair.zone[0], float(extent.min())), min(pair.zone[1], float(extent.max()))
