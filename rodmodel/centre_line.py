"""Centre line of a rod: its points, its local frame, and how fast the frame turns.

A straight line (turning about itself if it is pre-twisted), a circular arc and a helix are orbits of a point under a
steady screw motion. The frame takes part in the motion, so that its rate of turning, the Darboux vector
omega = k1 e1 + k2 e2 + tau t with e' = omega x e, is constant in the frame. Along a spline (`rodmodel.spline`) it
varies; a path has pieces of all kinds.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import CentreLine, Helix, Line, Path, Rod, Spline
from rodmodel.spline import curvature_jumps, spline_curve, spline_frames, spline_points, spline_turning

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ScrewMotion:
    """Steady screw motion that makes a centre line.

    Attributes
    ----------
    start : point at s = 0, mm, shape (3,)
    axes : frame there, rows e1, e2, t in global components, shape (3, 3)
    centre : a point of the axis, mm, shape (3,)
    axis : its unit direction, shape (3,)
    turning : angle per arc length, rad/mm
    advance : along the axis per arc length
    """

    start: Array
    axes: Array
    centre: Array
    axis: Array
    turning: float
    advance: float


@lru_cache(maxsize=1024)
def screw_motion(line: Line | Helix) -> ScrewMotion:
    """The motion that makes a centre line."""
    start = np.array(line.start, dtype=float)
    if isinstance(line, Line):
        tangent = np.subtract(line.end, line.start) / line.length
        return ScrewMotion(start, _axes(tangent, line.up), start, tangent, line.twist / line.length, 1.0)
    axis = np.array(line.axis, dtype=float) / np.linalg.norm(line.axis)
    turning = line.angle / line.length
    advance = turning * line.pitch / (2.0 * np.pi)
    tangent = turning * np.cross(axis, np.subtract(line.start, line.centre)) + advance * axis
    return ScrewMotion(start, _axes(tangent, line.up), np.array(line.centre, dtype=float), axis, turning, advance)


def _axes(tangent: Array, up: tuple[float, float, float]) -> Array:
    e2 = np.array(up, dtype=float)
    e2 -= (e2 @ tangent) * tangent
    e2 /= np.linalg.norm(e2)
    return np.array([np.cross(e2, tangent), e2, tangent])


def frame(line: CentreLine) -> Array:
    """Local frame at the start: rows e1, e2, t in global components, shape (3, 3). A straight line keeps it."""
    return screw_motion(line).axes if isinstance(line, Line | Helix) else frames(line, np.zeros(1))[0]


@lru_cache(maxsize=1024)
def darboux(line: Line | Helix) -> tuple[float, float, float]:
    """k1, k2 and tau: rate of turning of the frame about e1, e2 and t, rad/mm."""
    motion = screw_motion(line)
    rates = motion.turning * (motion.axes @ motion.axis)
    # An arc's twist and the curvature across its plane are zero, not round-off.
    k1, k2, tau = np.where(np.abs(rates) > 1e-12 * np.abs(motion.turning), rates, 0.0)
    return float(k1), float(k2), float(tau)


def turning_at(line: CentreLine, station: Array) -> Array:
    """k1, k2, tau at stations (mm), rad/mm, shape (3, n); where they jump, those of the piece before."""
    if isinstance(line, Path):
        return _piecewise(turning_at, line, station, (3,))
    if isinstance(line, Spline):
        return spline_turning(line, station)
    return np.repeat(np.array(darboux(line))[:, None], len(station), axis=1)


def constant_turnings(line: CentreLine, borders: Array) -> list[tuple[float, float, float] | None]:
    """k1, k2, tau between neighbouring borders (mm), each stretch on one piece of the line; None where they vary."""
    if isinstance(line, Path):
        of_pieces = [None if isinstance(piece, Spline) else darboux(piece) for piece in line.pieces]
        return [of_pieces[number] for number in _piece_at(line, 0.5 * (borders[:-1] + borders[1:]))]
    return [None if isinstance(line, Spline) else darboux(line)] * (len(borders) - 1)


def by_turning(turning: Array, evaluate: Callable[[tuple[float, float, float]], Array]) -> Array:
    """What `evaluate` makes of k1, k2, tau at stations, asked once where they are the same.

    turning : shape (3, n)
    evaluate : gives an array of any shape, for a result of shape (n, ...)
    """
    if (turning == turning[:, :1]).all():
        k1, k2, tau = turning[:, 0].tolist()
        result = evaluate((k1, k2, tau))
        return np.broadcast_to(result, (turning.shape[1], *result.shape))
    rates, places = np.unique(turning, axis=1, return_inverse=True)
    return np.stack([evaluate((k1, k2, tau)) for k1, k2, tau in rates.T.tolist()])[places.ravel()]


def kinks(line: CentreLine) -> Array:
    """Stations where the turning jumps, mm, ascending: elements end there."""
    return np.array(line.borders[1:-1]) if isinstance(line, Path) else np.empty(0)


@lru_cache(maxsize=256)
def knots(line: CentreLine) -> Array:
    """Stations between which the turning is smooth, mm, ascending: kinks and the given points of splines."""
    if isinstance(line, Path):
        within = [start + knots(piece) for start, piece in zip(line.borders, line.pieces, strict=False)]
        return np.sort(np.concatenate([kinks(line), *within]))
    return spline_curve(line).knot_stations[1:-1] if isinstance(line, Spline) else np.empty(0)


@lru_cache(maxsize=256)
def roughness(line: CentreLine) -> Array:
    """How the turning changes at the knots: the jump of its slope, 1/mm^2, infinite where it jumps itself."""
    if isinstance(line, Path):
        first, *others = (roughness(piece) for piece in line.pieces)
        return np.concatenate([first, *(np.concatenate([[np.inf], jumps]) for jumps in others)])
    return curvature_jumps(line) if isinstance(line, Spline) else np.empty(0)


def _piece_at(path: Path, station: Array) -> NDArray[np.int64]:
    """Number of the piece that stations lie in, shape (n,); where two meet, the one before."""
    return np.asarray(np.clip(np.searchsorted(path.borders, station, side="left") - 1, 0, len(path.pieces) - 1))


def _piecewise(
    evaluate: Callable[[CentreLine, Array], Array], path: Path, station: Array, shape: tuple[int, ...]
) -> Array:
    """A function of the stations of a line evaluated on the pieces of a path, shape (*shape, n)."""
    result = np.empty((*shape, len(station)))
    number = _piece_at(path, station)
    for index in np.unique(number):
        members = number == index
        result[..., members] = evaluate(path.pieces[index], station[members] - path.borders[index])
    return result


def _turned(motion: ScrewMotion, vectors: Array, station: Array) -> Array:
    """Vectors (global, shape (m, 3)) after the turn to each station, shape (n, m, 3); Rodrigues' formula."""
    if motion.turning == 0.0:
        return np.broadcast_to(vectors, (len(station), *vectors.shape))
    angle = motion.turning * station[:, None, None]
    along = (vectors @ motion.axis)[:, None] * motion.axis
    across = np.cross(motion.axis, vectors)
    return np.asarray(along + np.cos(angle) * (vectors - along) + np.sin(angle) * across)


def frames(line: CentreLine, station: Array) -> Array:
    """Local frame at stations (mm): rows e1, e2, t in global components, shape (n, 3, 3)."""
    if isinstance(line, Path):
        last = _piecewise(lambda piece, at: frames(piece, at).transpose(1, 2, 0), line, station, (3, 3))
        return np.ascontiguousarray(last.transpose(2, 0, 1))
    if isinstance(line, Spline):
        return spline_frames(line, station)
    motion = screw_motion(line)
    return _turned(motion, motion.axes, station)


def centre_points(line: CentreLine, station: Array) -> Array:
    """Points of the centre line at stations (mm), global, mm, shape (3, n)."""
    if isinstance(line, Path):
        return _piecewise(centre_points, line, station, (3,))
    if isinstance(line, Spline):
        return spline_points(line, station)
    motion = screw_motion(line)
    from_centre = _turned(motion, (motion.start - motion.centre)[None], station)[:, 0]
    return np.asarray((motion.centre + from_centre + np.multiply.outer(station * motion.advance, motion.axis)).T)


def global_points(rod: Rod, points: Array) -> Array:
    """Global coordinates of the points (x, y, s) of a rod, mm; shape (3, n) to (3, n)."""
    line = rod.centre_line
    if isinstance(line, Line) and line.twist == 0.0:
        return np.asarray(np.array(line.start, dtype=float)[:, None] + frame(line).T @ points)
    across = frames(line, points[2])[:, :2]
    return np.asarray(centre_points(line, points[2]) + np.einsum("cn,ncg->gn", points[:2], across))


def local_points(rod: Rod, points: Array) -> Array:
    """Coordinates (x, y, s) in the frame of a straight rod of global points, mm; shape (3, n) to (3, n)."""
    line = rod.centre_line
    return np.asarray(frame(line) @ (points - np.array(line.start, dtype=float)[:, None]))
