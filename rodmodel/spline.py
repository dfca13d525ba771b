"""The curve of a spline: arc length as parameter, frames and their turning, exact to round-off.

Arc length and the angle of the frame are integrals along the curve. It is cut into cells so short that one Gauss rule
takes both to round-off from a cell's left end to any place in it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solve_banded

from cases.scene import Spline
from rodmodel.axial import gauss

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# Points of the Gauss rule, and the share of a piece's length by which halving its cells may still change it.
POINTS, SETTLED = 16, 1e-13
MOST_HALVINGS = 8
# Newton's steps from an even distribution of the length over a cell, four are usual; share of the whole that the last
# one may take.
MOST_STEPS, LAST_STEP = 20, 1e-14


@dataclass(frozen=True, eq=False)
class SplineCurve:
    """A spline ready to be evaluated. Its parameter u is the length of the chords, in the first piece from 0.

    Attributes
    ----------
    up : given direction, shape (3,)
    follows_up : whether e2 is the part of `up` normal to the tangent everywhere
    knots : parameter at the given points, mm, shape (n_pieces + 1,)
    cells : parameter at the borders of the cells, mm, shape (n_cells + 1,)
    powers : r = c_0 + c_1 v + c_2 v^2 + c_3 v^3 with v from the left end of each cell, shape (4, n_cells, 3)
    stations : arc length there, mm, shape (n_cells + 1,)
    axes : frame at the left end of every cell, rows e1, e2, t, shape (n_cells, 3, 3)
    """

    up: Array
    follows_up: bool
    knots: Array
    cells: Array
    powers: Array
    stations: Array
    axes: Array

    @property
    def knot_stations(self) -> Array:
        """Arc length at the given points, mm, shape (n_pieces + 1,)."""
        return self.stations[:: (len(self.cells) - 1) // (len(self.knots) - 1)]


@lru_cache(maxsize=256)
def spline_curve(line: Spline) -> SplineCurve:
    """The interpolating cubic spline with not-a-knot ends (C. de Boor, A Practical Guide to Splines, chapter IV)."""
    points = np.array(line.points, dtype=float)
    chord = np.linalg.norm(np.diff(points, axis=0), axis=1)
    knots = np.concatenate([[0.0], np.cumsum(chord)])
    rise = np.diff(points, axis=0) / chord[:, None]
    bend = _second_derivatives(chord, rise)
    h = chord[:, None]
    powers = np.array(
        [
            points[:-1],
            rise - h * (2.0 * bend[:-1] + bend[1:]) / 6.0,
            0.5 * bend[:-1],
            np.diff(bend, axis=0) / (6.0 * h),
        ]
    )
    up = np.array(line.up, dtype=float)
    cells, on_cells, lengths = _cells(knots, powers)
    stations = np.concatenate([[0.0], np.cumsum(lengths)])
    first, last = _tangents(on_cells, np.zeros(len(lengths))), _tangents(on_cells, np.diff(cells))
    if line.frame == "up":
        axes = _upright(first, up)
    else:
        e1 = np.empty_like(first)
        e1[0] = _upright(first[:1], up)[0, 0]
        for cell, moved in enumerate(_transport(first, last, _swept_angle(on_cells, np.diff(cells)))[:-1]):
            e1[cell + 1] = moved @ e1[cell]
        axes = np.stack([e1, np.cross(first, e1), first], axis=1)
    return SplineCurve(up, line.frame == "up", knots, cells, on_cells, stations, axes)


def _cells(knots: Array, powers: Array) -> tuple[Array, Array, Array]:
    """Borders of the cells, cubics on them and their lengths: every piece halved until its length does not change.

    Raises
    ------
    ValueError
        if it still does after the last halving.
    """
    chord = np.diff(knots)[:, None]
    found = np.full(len(chord), np.inf)
    for halvings in range(MOST_HALVINGS + 1):
        parts = 2**halvings
        starts = chord * (np.arange(parts) / parts)
        cells = np.append((knots[:-1, None] + starts).ravel(), knots[-1])
        on_cells = _shifted(powers, starts)
        lengths = _lengths(on_cells, np.diff(cells))
        before, found = found, lengths.reshape(-1, parts).sum(axis=1)
        if np.all(np.abs(found - before) <= SETTLED * found):
            return cells, on_cells, lengths
    raise ValueError("a spline nearly stops and turns back; give more points where it turns sharply")


def _second_derivatives(chord: Array, rise: Array) -> Array:
    """Second derivatives r'' at the points, shape (n_pieces + 1, 3); three points have a parabola."""
    n = len(chord) + 1
    if n == 3:
        return np.repeat(2.0 * (rise[1:] - rise[:1]) / chord.sum(), 3, axis=0)
    bands = np.zeros((5, n))
    bands[1, 2:], bands[2, 1:-1], bands[3, :-2] = chord[1:], 2.0 * (chord[:-1] + chord[1:]), chord[:-1]
    bands[[2, 1, 0], [0, 1, 2]] = chord[1], -(chord[0] + chord[1]), chord[0]
    bands[[2, 3, 4], [-1, -2, -3]] = chord[-2], -(chord[-1] + chord[-2]), chord[-1]
    right = np.zeros((n, 3))
    right[1:-1] = 6.0 * np.diff(rise, axis=0)
    return np.asarray(solve_banded((2, 2), bands, right))


def spline_points(line: Spline, station: Array) -> Array:
    """Points at arc lengths (mm), global, mm, shape (3, n)."""
    curve = spline_curve(line)
    cell, v = _located(curve, station)
    c0, c1, c2, c3 = curve.powers[:, cell]
    v = v[:, None]
    return np.asarray((c0 + v * (c1 + v * (c2 + v * c3))).T)


def spline_frames(line: Spline, station: Array) -> Array:
    """Frames at arc lengths (mm): rows e1, e2, t in global components, shape (n, 3, 3)."""
    curve = spline_curve(line)
    return _frames(curve, *_located(curve, station))


def spline_turning(line: Spline, station: Array) -> Array:
    """Rates k1, k2, tau of the frame about e1, e2, t at arc lengths (mm), rad/mm, shape (3, n).

    dt/ds = k2 e1 - k1 e2. A frame moved without turning about t has tau = 0; where e2 follows `up`,
    tau = -e1 . de2/ds = k2 (up . t) / |up normal to t|.
    """
    curve = spline_curve(line)
    cell, v = _located(curve, station)
    axes = _frames(curve, cell, v)
    slope, bend = _derivatives(curve.powers[:, cell], v)
    # The part of r'' along t does not bend the line.
    k2, against = np.einsum("nag,ng->an", axes[:, :2], bend) / (slope**2).sum(axis=1)
    tau = k2 * (axes[:, 2] @ curve.up) / (axes[:, 1] @ curve.up) if curve.follows_up else np.zeros_like(k2)
    return np.array([-against, k2, tau])


def curvature_jumps(line: Spline) -> Array:
    """Jumps of the rate of change of dt/ds at the inner given points, 1/mm^2, shape (n_pieces - 1,).

    The third derivative by the parameter jumps there; its part along t does not count.
    """
    curve = spline_curve(line)
    parts = (len(curve.cells) - 1) // (len(curve.knots) - 1)
    after, before = curve.powers[:, parts::parts], curve.powers[3, parts - 1 : -1 : parts]
    speed = np.linalg.norm(after[1], axis=1)
    jump = 6.0 * np.cross(after[1], after[3] - before)
    return np.asarray(np.linalg.norm(jump, axis=1) / speed**4)


def _shifted(powers: Array, start: Array) -> Array:
    """Coefficients about other starts of every piece, shape (n_pieces, m), as (4, n_pieces * m, 3)."""
    v = start[..., None]
    c0, c1, c2, c3 = powers[:, :, None]
    shifted = (c0 + v * (c1 + v * (c2 + v * c3)), c1 + v * (2.0 * c2 + 3.0 * v * c3), c2 + 3.0 * v * c3, c3 + 0.0 * v)
    return np.array(shifted).reshape(4, -1, 3)


def _derivatives(powers: Array, v: Array) -> tuple[Array, Array]:
    """Slopes r' and r'' at v of cubics; coefficients of shape (4, n, 3), v of shape (n,) or (n, m)."""
    _, c1, c2, c3 = powers if v.ndim == 1 else powers[:, :, None]
    v = v[..., None]
    cubic = 3.0 * v * c3
    return c1 + v * (2.0 * c2 + cubic), 2.0 * (c2 + cubic)


def _tangents(powers: Array, v: Array) -> Array:
    slope, _ = _derivatives(powers, v)
    return np.asarray(slope / np.linalg.norm(slope, axis=1)[:, None])


def _lengths(powers: Array, v: Array) -> Array:
    """Arc length of cubics from 0 to v, mm, shape (n,)."""
    xi, weight = gauss(POINTS)
    half = 0.5 * v
    slope, _ = _derivatives(powers, half[:, None] * (1.0 + xi))
    return np.asarray(half * (np.sqrt(np.einsum("nmg,nmg->nm", slope, slope)) @ weight))


def _located(curve: SplineCurve, station: Array) -> tuple[IntArray, Array]:
    """Cell and parameter from its left end at arc lengths (mm), by Newton's method with du/ds = 1 / |r'|."""
    station = np.clip(station, 0.0, curve.stations[-1])
    cell = np.clip(np.searchsorted(curve.stations, station, side="right") - 1, 0, len(curve.axes) - 1)
    beyond = station - curve.stations[cell]
    width = curve.cells[cell + 1] - curve.cells[cell]
    v = beyond * (width / (curve.stations[cell + 1] - curve.stations[cell]))
    powers = curve.powers[:, cell]
    for _ in range(MOST_STEPS):
        slope, _ = _derivatives(powers, v)
        step = (beyond - _lengths(powers, v)) / np.linalg.norm(slope, axis=1)
        v = np.clip(v + step, 0.0, width)
        if np.abs(step).max(initial=0.0) <= LAST_STEP * curve.knots[-1]:
            break
    return cell, v


def _frames(curve: SplineCurve, cell: IntArray, v: Array) -> Array:
    powers = curve.powers[:, cell]
    tangent = _tangents(powers, v)
    if curve.follows_up:
        return _upright(tangent, curve.up)
    axes = curve.axes[cell]
    e1 = np.einsum("nij,nj->ni", _transport(axes[:, 2], tangent, _swept_angle(powers, v)), axes[:, 0])
    return np.stack([e1, np.cross(tangent, e1), tangent], axis=1)


def _upright(tangent: Array, up: Array) -> Array:
    """Frames whose e2 is the part of `up` normal to t, shape (n, 3, 3)."""
    e2 = up - (tangent @ up)[:, None] * tangent
    e2 /= np.linalg.norm(e2, axis=1)[:, None]
    return np.stack([np.cross(e2, tangent), e2, tangent], axis=1)


def _swept_angle(powers: Array, v: Array) -> Array:
    """Angle from 0 to v of cubics between a frame moved along them and one turned straight to its tangent, rad, (n,).

    It is the area that the great circle from the first tangent t_0 to the tangent t sweeps on the unit sphere:
    int t_0 . (t x dt) / (1 + t_0 . t), by the theorem of Gauss and Bonnet.
    """
    xi, weight = gauss(POINTS)
    half = 0.5 * v
    slope, bend = _derivatives(powers, half[:, None] * (1.0 + xi))
    first = (powers[1] / np.linalg.norm(powers[1], axis=1)[:, None])[:, None]
    speed = np.sqrt(np.einsum("nmg,nmg->nm", slope, slope))
    swept = (np.cross(first, slope) * bend).sum(axis=2) / (speed * (speed + (first * slope).sum(axis=2)))
    return np.asarray(half * (swept @ weight))


def _transport(first: Array, tangent: Array, angle: Array) -> Array:
    """What turns vectors normal to the first tangent straight to another one, then about it; shape (n, 3, 3).

    first, tangent : unit vectors, shape (n, 3)
    angle : rad, shape (n,)
    """
    share = tangent / (1.0 + (first * tangent).sum(axis=1))[:, None]
    straight = np.eye(3) - (first + tangent)[:, :, None] * share[:, None, :]
    across = np.cross(tangent[:, None], straight.transpose(0, 2, 1)).transpose(0, 2, 1)
    return np.asarray(np.cos(angle)[:, None, None] * straight + np.sin(angle)[:, None, None] * across)
