"""Centre lines of rods, each with the frame (e1, e2, t) that the section turns along with.

t is the tangent, e2 the part of `up` normal to t, e1 = e2 x t.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from cases.checks import Vector, require, require_finite, require_positive


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


CentreLine = Line | Helix
