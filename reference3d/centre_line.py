"""Points and frames of any centre line, worked out from what `cases.centre_lines` says of it.

Local frame (e1, e2, t): t the tangent, e2 as the line has it, e1 = e2 x t. Nothing here is shared with the rod model.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.interpolate import CubicSpline
from scipy.spatial.transform import Rotation

from cases.scene import CentreLine, Helix, Line, Path, Spline

Array = NDArray[np.float64]

# parts of every piece of a spline, each integrated by this many Gauss points for the arc length
PARTS, GAUSS_POINTS = 8, 10
# relative accuracy to which the frame that does not turn about the tangent is integrated
FRAME_TOLERANCE = 1e-12


def points(line: CentreLine, station: Array) -> Array:
    """Points of the centre line at arc lengths, global, mm; shape (n,) to (n, 3)."""
    return _evaluate(line, np.asarray(station, dtype=np.float64))[0]


def frames(line: CentreLine, station: Array) -> Array:
    """Rows e1, e2, t of the local frames at arc lengths (mm) in global components; shape (n,) to (n, 3, 3)."""
    return _evaluate(line, np.asarray(station, dtype=np.float64))[1]


@dataclass(frozen=True)
class Stretch:
    """A part of a centre line, mm; where it is even, a rigid motion takes any part of it to any other as long."""

    start: float
    end: float
    even: bool


def stretches(line: CentreLine) -> tuple[Stretch, ...]:
    """The smooth pieces of a centre line, one after the other."""
    pieces = line.pieces if isinstance(line, Path) else (line,)
    borders = line.borders if isinstance(line, Path) else (0.0, line.length)
    return tuple(
        Stretch(start, end, not isinstance(piece, Spline))
        for piece, start, end in zip(pieces, borders[:-1], borders[1:], strict=True)
    )


def turning_rate(line: CentreLine, station: Array) -> Array:
    """How fast the frame turns, rad/mm, by central differences; where it turns evenly, the same to the last digit."""
    reach = 1e-4 * line.length
    station = np.array(station, dtype=np.float64)
    for stretch in stretches(line):
        if stretch.even:
            station[(stretch.start < station) & (station < stretch.end)] = 0.5 * (stretch.start + stretch.end)
    different, place = np.unique(station, return_inverse=True)
    before, after = np.clip(different - reach, 0.0, None), np.clip(different + reach, None, line.length)
    change = np.linalg.norm(frames(line, after) - frames(line, before), axis=(1, 2)) / np.sqrt(2.0)
    return np.asarray((change / (after - before))[place])


def _evaluate(line: CentreLine, station: Array) -> tuple[Array, Array]:
    match line:
        case Line():
            return _on_line(line, station)
        case Helix():
            return _on_helix(line, station)
        case Spline():
            return _on_spline(line, station)
        case Path():
            return _on_path(line, station)


def _axes(tangent: Array, up: Array) -> Array:
    """Rows e1, e2, t for tangents and up directions of shape (n, 3)."""
    e2 = up - np.sum(up * tangent, axis=-1, keepdims=True) * tangent
    e2 /= np.linalg.norm(e2, axis=-1, keepdims=True)
    return np.stack([np.cross(e2, tangent), e2, tangent], axis=-2)


def _on_line(line: Line, station: Array) -> tuple[Array, Array]:
    start, along = np.array(line.start, dtype=float), np.subtract(line.end, line.start)
    length = float(np.linalg.norm(along))
    tangent = along / length
    at_start = _axes(tangent, np.array(line.up, dtype=float))
    turn = Rotation.from_rotvec(np.outer(station * (line.twist / length), tangent)).as_matrix()
    return start + np.outer(station, tangent), at_start @ turn.transpose(0, 2, 1)


def _on_helix(helix: Helix, station: Array) -> tuple[Array, Array]:
    axis = np.array(helix.axis, dtype=float) / np.linalg.norm(helix.axis)
    centre, arm = np.array(helix.centre, dtype=float), np.subtract(helix.start, helix.centre)
    rise = helix.pitch / (2.0 * np.pi)  # per angle
    velocity = np.cross(axis, arm) + rise * axis
    speed = float(np.linalg.norm(velocity))
    angle = station / speed
    turn = Rotation.from_rotvec(np.outer(angle, axis)).as_matrix()
    at_start = _axes(velocity / speed, np.array(helix.up, dtype=float))
    return centre + turn @ arm + np.outer(rise * angle, axis), at_start @ turn.transpose(0, 2, 1)


def _on_path(path: Path, station: Array) -> tuple[Array, Array]:
    starts = np.array(path.borders[:-1])
    piece = np.clip(np.searchsorted(starts, station, side="right") - 1, 0, len(starts) - 1)
    position, axes = np.empty((len(station), 3)), np.empty((len(station), 3, 3))
    for number in np.unique(piece):
        mine = piece == number
        position[mine], axes[mine] = _evaluate(path.pieces[number], station[mine] - starts[number])
    return position, axes


class _ByParameter(Protocol):
    """A vector by a parameter; the cubic spline has derivatives too."""

    def __call__(self, x: Array | float, nu: int = ..., /) -> Array: ...


@dataclass(frozen=True, eq=False)
class _Curve:
    """A spline with its arc length at the ends of the parts of its pieces, and e2 along it (none if it follows up)."""

    cubic: _ByParameter
    parameter: Array
    arc: Array
    e2: tuple[_ByParameter, ...]
    knots: Array


@lru_cache(maxsize=64)
def _curve(spline: Spline) -> _Curve:
    """Not-a-knot cubic spline over the length of the chords; of three points, which leave no more, a parabola."""
    corners = np.array(spline.points, dtype=float)
    knots = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(corners, axis=0), axis=1))])
    cubic = CubicSpline(knots, corners, bc_type="not-a-knot")
    parameter = np.interp(np.arange(PARTS * (len(knots) - 1) + 1) / PARTS, np.arange(len(knots)), knots)
    arc = np.concatenate([[0.0], np.cumsum(_arc_between(cubic, parameter[:-1], parameter[1:]))])
    turned: list[_ByParameter] = []
    if spline.frame == "minimal rotation":
        tangent = cubic(0.0, 1) / np.linalg.norm(cubic(0.0, 1))
        e2 = _axes(tangent, np.array(spline.up, dtype=float))[1]
        for start, end in pairwise(knots.tolist()):
            turned.append(_moved_along(cubic, start, end, e2))
            e2 = turned[-1](end)
    return _Curve(cubic, parameter, arc, tuple(turned), knots)


def _moved_along(cubic: _ByParameter, start: float, end: float, e2: Array) -> _ByParameter:
    """e2 by the parameter on one cubic piece, moved without turning about the tangent: e2' = -(e2 . t') t."""

    def slope(v: float, vector: Array) -> Array:
        first, second = cubic(v, 1), cubic(v, 2)
        speed = np.linalg.norm(first)
        tangent = first / speed
        turning = (second - (second @ tangent) * tangent) / speed
        return np.asarray(-(vector @ turning) * tangent)

    found = solve_ivp(
        slope, (start, end), e2, method="DOP853", dense_output=True, rtol=FRAME_TOLERANCE, atol=FRAME_TOLERANCE
    )
    if not found.success:
        raise RuntimeError(f"the frame along a spline was not found: {found.message}")
    solution: _ByParameter = found.sol
    return solution


def _arc_between(cubic: _ByParameter, start: Array, end: Array) -> Array:
    """Arc lengths between parameters on one cubic piece each, by Gauss's rule."""
    root, weight = np.polynomial.legendre.leggauss(GAUSS_POINTS)
    half = 0.5 * (end - start)
    speed = np.linalg.norm(cubic((0.5 * (start + end))[:, None] + half[:, None] * root, 1), axis=-1)
    return np.asarray(half * (speed @ weight))


def _on_spline(spline: Spline, station: Array) -> tuple[Array, Array]:
    curve = _curve(spline)
    part = np.clip(np.searchsorted(curve.arc, station, side="right") - 1, 0, len(curve.arc) - 2)
    start, end = curve.parameter[part], curve.parameter[part + 1]
    share = (station - curve.arc[part]) / (curve.arc[part + 1] - curve.arc[part])
    parameter = start + share * (end - start)
    for _ in range(8):  # Newton; the speed hardly changes on a part
        missing = station - curve.arc[part] - _arc_between(curve.cubic, start, parameter)
        parameter = parameter + missing / np.linalg.norm(curve.cubic(parameter, 1), axis=-1)
    tangent = curve.cubic(parameter, 1)
    tangent = tangent / np.linalg.norm(tangent, axis=-1, keepdims=True)
    up = np.tile(np.array(spline.up, dtype=float), (len(station), 1))
    piece = np.clip(np.searchsorted(curve.knots, parameter, side="right") - 1, 0, len(curve.knots) - 2)
    for number in np.unique(piece) if curve.e2 else ():
        mine = piece == number
        up[mine] = curve.e2[number](parameter[mine]).T
    return np.asarray(curve.cubic(parameter)), _axes(tangent, up)
