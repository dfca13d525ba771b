"""Centre lines of rods, each with the frame (e1, e2, t) that the section turns along with.

t is the tangent, e2 the part of `up` normal to t at the start, e1 = e2 x t.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cases import spline
from cases.checks import Vector, require, require_finite, require_positive

_Array = NDArray[np.float64]

# Least sine of the angle between `up` and the tangent where e2 follows `up`: nearer, the frame whirls.
_LEAST_OFF = 0.02
# Points of a spline, whose length may have to be sought on 8,000 places between every two of them.
MOST_POINTS = 1000
# |r'| by the length of the chords is about 1; a spline this slow has a cusp.
_LEAST_SPEED = 1e-3
# What pieces of a path may be off where they meet, written with rounded numbers: share of the length; rad.
_SAME_POINT, _SAME_DIRECTION = 1e-6, 1e-5


@dataclass(frozen=True)
class Line:
    """Straight centre line, pre-twisted if asked for.

    Parameters
    ----------
    start, end : end points in global coordinates (X, Y, Z), mm
    up : direction whose part normal to the line is e2 at the start (any length)
    twist : angle by which the frame turns about t from start to end, at an even rate, rad
    """

    start: Vector
    end: Vector
    up: Vector
    twist: float = 0.0

    def __post_init__(self) -> None:
        for key, vector in (("start", self.start), ("end", self.end), ("up", self.up)):
            require_finite(vector, key)
        require(math.isfinite(self.twist), "twist", f"{self.twist:g}", "a finite angle is needed")
        require(self.length > 0.0, "end", list(self.end), "the end must differ from the start")
        normal_part = np.cross(np.subtract(self.end, self.start), self.up)
        ok = float(np.linalg.norm(normal_part)) > 1e-9 * self.length * float(np.linalg.norm(self.up))
        require(ok, "up", list(self.up), "give a direction that is not along the line")

    @property
    def length(self) -> float:
        """Length of the line, mm."""
        return float(np.linalg.norm(np.subtract(self.end, self.start)))

    @property
    def end_points(self) -> tuple[Vector, Vector]:
        """First and last point, mm."""
        return self.start, self.end


@dataclass(frozen=True)
class Helix:
    """Helical centre line, a circular arc where the pitch is zero.

    The frame moves along with the screw motion that makes the line, so that curvature and twist of the frame are
    constant; of an arc it is the rotation-minimising frame.

    Parameters
    ----------
    start : start point (X, Y, Z), mm
    centre : a point of the axis, mm
    axis : direction of the axis (any length); the line turns about it by the right-hand rule
    angle : angle turned from start to end, positive, rad
    up : direction whose part normal to the line at its start is e2 there (any length)
    pitch : advance along the axis in one full turn, mm, negative for a left-hand helix
    """

    start: Vector
    centre: Vector
    axis: Vector
    angle: float
    up: Vector
    pitch: float = 0.0

    def __post_init__(self) -> None:
        for key, vector in (("start", self.start), ("centre", self.centre), ("axis", self.axis), ("up", self.up)):
            require_finite(vector, key)
        require_positive(self.angle, "angle", "an angle")
        require(math.isfinite(self.pitch), "pitch", f"{self.pitch:g}", "a finite length is needed")
        require(float(np.linalg.norm(self.axis)) > 0.0, "axis", list(self.axis), "give a direction")
        from_axis = np.linalg.norm(np.subtract(self.start, self.centre))
        ok = self.radius > 1e-9 * float(from_axis)
        require(ok, "start", list(self.start), "the start must not lie on the axis")
        normal_part = np.linalg.norm(np.cross(self.start_tangent, self.up))
        ok = float(normal_part) > 1e-9 * float(np.linalg.norm(self.up))
        require(ok, "up", list(self.up), "give a direction that is not along the line at its start")

    @property
    def radius(self) -> float:
        """Distance of the line from the axis, mm."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        return float(np.linalg.norm(np.cross(axis, np.subtract(self.start, self.centre))))

    @property
    def start_tangent(self) -> tuple[float, float, float]:
        """Direction of the line at its start, a unit vector."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        around = np.cross(axis, np.subtract(self.start, self.centre)) + self.pitch / (2.0 * math.pi) * axis
        x, y, z = (around / np.linalg.norm(around)).tolist()
        return x, y, z

    @property
    def length(self) -> float:
        """Arc length, mm."""
        return self.angle * math.hypot(self.radius, self.pitch / (2.0 * math.pi))

    @property
    def end_points(self) -> tuple[Vector, Vector]:
        """First and last point, mm."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        from_centre = np.subtract(self.start, self.centre)
        along = (from_centre @ axis) * axis
        turned = math.cos(self.angle) * (from_centre - along) + math.sin(self.angle) * np.cross(axis, from_centre)
        advance = self.angle * self.pitch / (2.0 * math.pi) * axis
        x, y, z = (np.asarray(self.centre) + along + turned + advance).tolist()
        return self.start, (x, y, z)


@dataclass(frozen=True)
class Spline:
    """Smooth interpolating cubic spline through points.

    The parameter is the length of the chords, the ends are not-a-knot: the first two pieces are one cubic, and so are
    the last two (three points: one parabola). Curvature is continuous, its rate of change jumps at the points.

    Parameters
    ----------
    points : at least three, global (X, Y, Z), mm, neighbours distinct; an array of shape (n, 3) will do
    up : direction whose part normal to the line at its start is e2 there (any length)
    frame : "minimal rotation" moves the frame along without turning it about the tangent; with "up", e2 is the part
        of `up` normal to the tangent everywhere
    """

    points: tuple[Vector, ...]
    up: Vector
    frame: Literal["minimal rotation", "up"] = "minimal rotation"

    def __post_init__(self) -> None:
        # Points often come as an array.
        object.__setattr__(self, "points", tuple(tuple(map(float, point)) for point in self.points))
        require(len(self.points) >= 3, "points", f"{len(self.points)} points", "a spline needs at least three")
        remedy = f"{MOST_POINTS} at most are taken; several splines make a path"
        require(len(self.points) <= MOST_POINTS, "points", f"{len(self.points)} points", remedy)
        for number, point in enumerate(self.points, 1):
            require_finite(point, f"points #{number}")
        for number, (point, following) in enumerate(pairwise(self.points), 2):
            apart = float(np.linalg.norm(np.subtract(following, point))) > 0.0
            require(apart, f"points #{number}", f"{list(following)} again", "neighbouring points must differ")
        require_finite(self.up, "up")
        known = ("minimal rotation", "up")
        require(self.frame in known, "frame", f"'{self.frame}'", "write 'minimal rotation' or 'up'")
        speed, tangent = spline.tangents(self.points)
        smooth = float(np.min(speed)) > _LEAST_SPEED
        require(smooth, "points", "a line that stops and turns back", "give more points where it turns sharply")
        normal_part = np.linalg.norm(np.cross(tangent, self.up), axis=1)
        size = float(np.linalg.norm(self.up))
        remedy = "give a direction that is not along the line at its start"
        require(float(normal_part[0]) > 1e-9 * size, "up", list(self.up), remedy)
        off = self.frame != "up" or float(np.min(normal_part)) > _LEAST_OFF * size
        remedy = "with frame 'up', give a direction that the line nowhere takes; or use 'minimal rotation'"
        require(off, "up", list(self.up), remedy)

    @property
    def start(self) -> Vector:
        """First point, mm."""
        return self.points[0]

    @cached_property
    def length(self) -> float:
        """Arc length, mm."""
        return spline.length(self.points)

    @property
    def end_points(self) -> tuple[Vector, Vector]:
        """First and last point, mm."""
        return self.points[0], self.points[-1]

    @cached_property
    def sampled(self) -> spline.Sampled:
        """The line and its frame at places close to one another."""
        return spline.sampled(self.points, self.up, self.frame == "up")


Piece = Line | Helix | Spline


@dataclass(frozen=True)
class Path:
    """Smooth pieces one after the other; curvature may jump from one to the next, the frame does not.

    Parameters
    ----------
    pieces : each starts where the former ends, with its tangent and its frame
    """

    pieces: tuple[Piece, ...]

    def __post_init__(self) -> None:
        require(len(self.pieces) > 0, "pieces", "none", "a path needs at least one piece")
        for number, (piece, following) in enumerate(pairwise(self.pieces), 1):
            self._check_meeting(number, piece, following)

    def _check_meeting(self, number: int, piece: Piece, following: Piece) -> None:
        """See that piece `number` and the following one continue each other."""
        key, former = f"pieces #{number + 1}", f"piece #{number}"
        at, from_point = np.array(piece.end_points[1]), np.array(following.start)
        apart = float(np.linalg.norm(from_point - at))
        ok = apart <= _SAME_POINT * max(piece.length, following.length)
        remedy = f"a piece starts where the former ends, at {_written(at)}"
        require(ok, key, f"its start {apart:.3g} mm from the end of {former}", remedy)
        (before, up), (after, e2) = end_axes(piece), start_axes(following)
        corner = _angle(before, after)
        found = f"a corner of {math.degrees(corner):.3g} degrees after {former}"
        remedy = "a path has no corners, model one as two rods with a joint"
        require(corner <= _SAME_DIRECTION, key, found, f"{remedy}; the former piece ends along {_written(before)}")
        turned = _angle(up, e2)
        found = f"a frame turned by {math.degrees(turned):.3g} degrees from the end of {former}"
        require(turned <= _SAME_DIRECTION, f"{key}.up", found, f"up = {_written(up)} continues it")

    @property
    def start(self) -> Vector:
        """First point, mm."""
        return self.pieces[0].start

    @cached_property
    def borders(self) -> tuple[float, ...]:
        """Arc length from the path's start to the start of every piece, and to its end, mm."""
        return tuple(np.cumsum([0.0, *(piece.length for piece in self.pieces)]).tolist())

    @property
    def length(self) -> float:
        """Arc length, mm."""
        return self.borders[-1]

    @property
    def end_points(self) -> tuple[Vector, Vector]:
        """First and last point, mm."""
        return self.pieces[0].end_points[0], self.pieces[-1].end_points[1]


CentreLine = Line | Helix | Spline | Path


def start_axes(piece: Piece) -> tuple[_Array, _Array]:
    """Tangent and e2 at the start of a piece, unit vectors."""
    if isinstance(piece, Spline):
        return piece.sampled.tangent[0], piece.sampled.e2[0]
    if isinstance(piece, Helix):
        tangent = np.array(piece.start_tangent)
    else:
        tangent = np.subtract(piece.end, piece.start) / piece.length
    e2 = np.asarray(piece.up) - (tangent @ np.asarray(piece.up)) * tangent
    return tangent, e2 / np.linalg.norm(e2)


def end_axes(piece: Piece) -> tuple[_Array, _Array]:
    """Tangent and e2 at the end of a piece, unit vectors."""
    if isinstance(piece, Spline):
        return piece.sampled.tangent[-1], piece.sampled.e2[-1]
    tangent, e2 = start_axes(piece)
    if isinstance(piece, Helix):
        axis = np.asarray(piece.axis) / np.linalg.norm(piece.axis)
        return _turned(tangent, axis, piece.angle), _turned(e2, axis, piece.angle)
    return tangent, _turned(e2, tangent, piece.twist)


def curvatures(piece: Piece) -> tuple[_Array, _Array]:
    """Stations from the piece's start, mm, shape (n,), and components of dt/ds along e1 and e2 there, 1/mm, (n, 2).

    At one station where the frame sees the same everywhere, at none along a straight line.
    """
    if isinstance(piece, Spline):
        return piece.sampled.station, piece.sampled.curvature
    if isinstance(piece, Line):
        return np.empty(0), np.empty((0, 2))
    axis = np.asarray(piece.axis) / np.linalg.norm(piece.axis)
    from_centre = np.subtract(piece.start, piece.centre)
    outwards = from_centre - (from_centre @ axis) * axis
    tangent, e2 = start_axes(piece)
    towards_axis = -outwards * (piece.angle / piece.length) ** 2
    return np.zeros(1), np.array([[towards_axis @ np.cross(e2, tangent), towards_axis @ e2]])


def _turned(vector: _Array, axis: _Array, angle: float) -> _Array:
    """A vector turned about a unit axis; Rodrigues' formula."""
    along = (vector @ axis) * axis
    return np.asarray(along + math.cos(angle) * (vector - along) + math.sin(angle) * np.cross(axis, vector))


def _angle(one: _Array, other: _Array) -> float:
    return math.atan2(float(np.linalg.norm(np.cross(one, other))), float(one @ other))


def _written(vector: _Array) -> str:
    # Round-off is shown as zero.
    size = float(np.max(np.abs(vector)))
    return "[" + ", ".join(f"{x:.9g}" if abs(x) > 1e-12 * size else "0" for x in vector.tolist()) + "]"
