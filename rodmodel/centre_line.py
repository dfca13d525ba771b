"""Centre line of a rod: its points, its local frame, and how fast the frame turns.

Every centre line here is the orbit of a point under a steady screw motion: a straight line (turning about itself if it
is pre-twisted), a circular arc, a helix. The frame takes part in the motion, so that its rate of turning, the Darboux
vector omega = k1 e1 + k2 e2 + tau t with e' = omega x e, is constant in the frame.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import CentreLine, Line, Rod

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
def screw_motion(line: CentreLine) -> ScrewMotion:
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
    return screw_motion(line).axes


@lru_cache(maxsize=1024)
def darboux(line: CentreLine) -> tuple[float, float, float]:
    """k1, k2 and tau: rate of turning of the frame about e1, e2 and t, rad/mm."""
    motion = screw_motion(line)
    rates = motion.turning * (motion.axes @ motion.axis)
    # An arc's twist and the curvature across its plane are zero, not round-off.
    k1, k2, tau = np.where(np.abs(rates) > 1e-12 * np.abs(motion.turning), rates, 0.0)
    return float(k1), float(k2), float(tau)


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
    motion = screw_motion(line)
    return _turned(motion, motion.axes, station)


def centre_points(line: CentreLine, station: Array) -> Array:
    """Points of the centre line at stations (mm), global, mm, shape (3, n)."""
    motion = screw_motion(line)
    from_centre = _turned(motion, (motion.start - motion.centre)[None], station)[:, 0]
    return np.asarray((motion.centre + from_centre + np.multiply.outer(station * motion.advance, motion.axis)).T)


def global_points(rod: Rod, points: Array) -> Array:
    """Global coordinates of the points (x, y, s) of a rod, mm; shape (3, n) to (3, n)."""
    across = frames(rod.centre_line, points[2])[:, :2]
    return np.asarray(centre_points(rod.centre_line, points[2]) + np.einsum("cn,ncg->gn", points[:2], across))


def local_points(rod: Rod, points: Array) -> Array:
    """Coordinates (x, y, s) in the frame of a straight rod of global points, mm; shape (3, n) to (3, n)."""
    motion = screw_motion(rod.centre_line)
    return np.asarray(motion.axes @ (points - motion.start[:, None]))
