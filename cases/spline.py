"""Smooth interpolating cubic spline through points: its shape, length and frames, as far as a scene is checked by them.

The parameter is the length of the chords, the ends are not-a-knot (the first two pieces are one cubic, and so are the
last two): four points or more follow a circle better than with natural ends, which have no curvature. Three points
have a parabola.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.checks import Vector

_Array = NDArray[np.float64]

# Points sampled on a piece, and of the Gauss rule on each of its parts.
SAMPLES, _GAUSS = 32, 16
# Share of the length by which halving all parts may still change it.
_SETTLED = 1e-13


@dataclass(frozen=True, eq=False)
class Cubics:
    """Pieces r(v) = c_0 + c_1 v + c_2 v^2 + c_3 v^3 with v in [0, chord].

    Attributes
    ----------
    chord : range of the parameter, mm, shape (n_pieces,)
    powers : c_0..c_3, shape (4, n_pieces, 3)
    """

    chord: _Array
    powers: _Array

    def derivatives(self, share: _Array) -> tuple[_Array, _Array]:
        """Slopes r' and r'' by the parameter, at shares of every piece; shape (n,) to (n_pieces, n, 3)."""
        v = (self.chord[:, None] * share)[..., None]
        _, c1, c2, c3 = self.powers[:, :, None]
        return c1 + v * (2.0 * c2 + 3.0 * v * c3), 2.0 * c2 + 6.0 * v * c3

    def points(self, share: _Array) -> _Array:
        """Points at shares of every piece, mm; shape (n,) to (n_pieces, n, 3)."""
        v = (self.chord[:, None] * share)[..., None]
        c0, c1, c2, c3 = self.powers[:, :, None]
        return np.asarray(c0 + v * (c1 + v * (c2 + v * c3)))


@lru_cache(maxsize=128)
def cubics(points: tuple[Vector, ...]) -> Cubics:
    """The pieces between neighbouring points, of which there are at least three."""
    corners = np.array(points, dtype=float)
    chord = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    rise = np.diff(corners, axis=0) / chord[:, None]
    slope = _slopes(chord, rise)
    c2 = (3.0 * rise - 2.0 * slope[:-1] - slope[1:]) / chord[:, None]
    c3 = (slope[:-1] + slope[1:] - 2.0 * rise) / chord[:, None] ** 2
    return Cubics(chord, np.array([corners[:-1], slope[:-1], c2, c3]))


def _slopes(chord: _Array, rise: _Array) -> _Array:
    """Slopes r' at the points, shape (n_pieces + 1, 3), so that r'' is continuous.

    C. de Boor, A Practical Guide to Splines, chapter IV.
    """
    h, n = chord, len(chord)
    if n == 2:
        middle = (h[1] * rise[0] + h[0] * rise[1]) / (h[0] + h[1])
        return np.array([2.0 * rise[0] - middle, middle, 2.0 * rise[1] - middle])
    below, diagonal, above = np.empty(n), np.empty(n + 1), np.empty(n)
    right = np.empty((n + 1, 3))
    below[:-1], diagonal[1:-1], above[1:] = h[1:], 2.0 * (h[:-1] + h[1:]), h[:-1]
    right[1:-1] = 3.0 * (h[1:, None] * rise[:-1] + h[:-1, None] * rise[1:])
    for end, (near, far), (first, second) in ((0, (h[0], h[1]), rise[:2]), (-1, (h[-1], h[-2]), rise[:-3:-1])):
        diagonal[end] = far
        (above if end == 0 else below)[end] = near + far
        right[end] = ((3.0 * near + 2.0 * far) * far * first + near**2 * second) / (near + far)
    for i in range(n):
        share = below[i] / diagonal[i]
        diagonal[i + 1] -= share * above[i]
        right[i + 1] -= share * right[i]
    right[n] /= diagonal[n]
    for i in range(n - 1, -1, -1):
        right[i] = (right[i] - above[i] * right[i + 1]) / diagonal[i]
    return right


def length(points: tuple[Vector, ...]) -> float:
    """Arc length by Gauss's rule on parts of the pieces, halved until it does not change, mm."""
    curve = cubics(points)
    xi, weight = np.polynomial.legendre.leggauss(_GAUSS)
    found = np.inf
    for halvings in range(10):
        parts = 2**halvings
        share = (np.arange(parts)[:, None] + 0.5 * (1.0 + xi)) / parts
        speed = np.linalg.norm(curve.derivatives(share.ravel())[0], axis=2).reshape(len(curve.chord), parts, -1)
        before, found = found, float(curve.chord @ (speed @ weight).sum(axis=1)) / (2.0 * parts)
        if abs(found - before) <= _SETTLED * found:
            break
    return found


@dataclass(frozen=True, eq=False)
class Sampled:
    """A curve with its frames at places close to one another, from start to end.

    Attributes
    ----------
    station : arc length, mm, shape (n,), as good as the chords between the samples
    speed : |r'|, shape (n,)
    tangent, e2 : unit vectors, shape (n, 3)
    curvature : components of dt/ds along e1 and e2, 1/mm, shape (n, 2)
    """

    station: _Array
    speed: _Array
    tangent: _Array
    e2: _Array
    curvature: _Array


def tangents(points: tuple[Vector, ...]) -> tuple[_Array, _Array]:
    """Speed |r'|, shape (n,), and unit tangents, shape (n, 3), at samples from start to end."""
    slope = _strung(cubics(points).derivatives(_shares())[0])
    speed = np.linalg.norm(slope, axis=1)
    return speed, slope / np.where(speed > 0.0, speed, 1.0)[:, None]


def sampled(points: tuple[Vector, ...], up: Vector, follows_up: bool) -> Sampled:
    """Frames along the spline, whose tangent is defined everywhere.

    follows_up : e2 is the part of `up` normal to the tangent everywhere; otherwise at the start, and from there on
        the frame is moved without turning about the tangent, by double reflection (W. Wang, B. Juettler, D. Zheng,
        Y. Liu, Computation of rotation minimizing frames, ACM Transactions on Graphics 27, 2008).
    """
    curve = cubics(points)
    places = _strung(curve.points(_shares()))
    speed, tangent = tangents(points)
    bend = _strung(curve.derivatives(_shares())[1])
    step = np.diff(places, axis=0)
    normal_part = np.asarray(up) - (tangent @ np.asarray(up))[:, None] * tangent
    e2 = normal_part / np.linalg.norm(normal_part if follows_up else normal_part[:1], axis=1)[:, None]
    if not follows_up:
        first = _reflections(step)
        second = _reflections(tangent[1:] - (first @ tangent[:-1, :, None])[..., 0])
        for i, moved in enumerate(second @ first):
            e2[i + 1] = moved @ e2[i]
    normal = (bend - (bend * tangent).sum(axis=1)[:, None] * tangent) / speed[:, None] ** 2
    curvature = np.stack([(normal * np.cross(e2, tangent)).sum(axis=1), (normal * e2).sum(axis=1)], axis=1)
    station = np.concatenate([[0.0], np.cumsum(np.linalg.norm(step, axis=1))])
    return Sampled(station, speed, tangent, e2, curvature)


def _shares() -> _Array:
    return np.linspace(0.0, 1.0, SAMPLES + 1)


def _strung(on_pieces: _Array) -> _Array:
    """Values at the samples of all pieces one after the other, where two pieces meet once; shape (n, 3)."""
    return np.concatenate([on_pieces[:, :-1].reshape(-1, 3), on_pieces[-1, -1:]])


def _reflections(normals: _Array) -> _Array:
    """Reflections in planes with these normals, of any length, shape (n, 3) to (n, 3, 3)."""
    unit = normals / np.linalg.norm(normals, axis=1)[:, None]
    return np.asarray(np.eye(3) - 2.0 * unit[:, :, None] * unit[:, None, :])
