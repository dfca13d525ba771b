"""Polygons in a plane: area, centroid, whether edges cross, whether points lie inside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]
_BoolArray = NDArray[np.bool_]
Corners = tuple[tuple[float, float], ...]


def signed_area(corners: Corners) -> float:
    """Area by the shoelace formula, positive for corners in anticlockwise order."""
    x, y = np.array(corners, dtype=float).T
    return 0.5 * float(np.dot(x, np.roll(y, -1)) - np.dot(y, np.roll(x, -1)))


def centroid(outer: Corners, holes: tuple[Corners, ...] = ()) -> _Array:
    """Centre of area of a polygon with holes, shape (2,)."""
    area, moment = 0.0, np.zeros(2)
    for loop, sign in ((outer, 1.0), *((hole, -1.0) for hole in holes)):
        points = np.array(loop, dtype=float)
        following = np.roll(points, -1, axis=0)
        crossed = points[:, 0] * following[:, 1] - following[:, 0] * points[:, 1]
        turn = sign * np.sign(crossed.sum())
        area += turn * crossed.sum() / 2.0
        moment += turn * crossed @ (points + following) / 6.0
    return np.asarray(moment / area)


def edges_meet(first: Corners, second: Corners) -> _BoolArray:
    """Which edges of two closed polygons have a point in common, shape (n_first, n_second).

    Edges start at their corner. Edges along the same line meet where they overlap.
    """
    a, c = np.array(first, dtype=float)[:, None], np.array(second, dtype=float)[None, :]
    b, d = np.roll(a, -1, axis=0), np.roll(c, -1, axis=1)

    def side(start: _Array, end: _Array, point: _Array) -> _Array:
        along, away = end - start, point - start
        return np.asarray(np.sign(along[..., 0] * away[..., 1] - along[..., 1] * away[..., 0]))

    apart = (np.maximum(a, b) < np.minimum(c, d)) | (np.maximum(c, d) < np.minimum(a, b))
    straddle = (side(a, b, c) * side(a, b, d) <= 0.0) & (side(c, d, a) * side(c, d, b) <= 0.0)
    return np.asarray(straddle & ~apart.any(axis=-1))


def narrowest(first: Corners, second: Corners | None = None) -> float:
    """Least distance of a corner of one polygon from an edge of another, or from one of its own that it does not end.

    It is zero for edges that fold back on the one before them, too, which `crosses_itself` leaves out.
    """
    if second is not None:
        return min(float(_distances(first, second).min()), float(_distances(second, first).min()))
    count = len(first)
    other = (np.arange(count)[:, None] - np.arange(count)) % count > 1
    return float(_distances(first, first)[other].min())


def _distances(corners: Corners, edges: Corners) -> _Array:
    """Distances of corners from the edges of a polygon, shape (n_corners, n_edges); edges start at their corner."""
    point, start = np.array(corners, dtype=float)[:, None], np.array(edges, dtype=float)[None, :]
    along, away = np.roll(start, -1, axis=1) - start, point - start
    squared = np.maximum((along**2).sum(axis=-1), np.finfo(float).tiny)  # lengths may underflow
    share = np.clip((away * along).sum(axis=-1) / squared, 0.0, 1.0)
    return np.asarray(np.linalg.norm(away - share[..., None] * along, axis=-1))


def crosses_itself(corners: Corners) -> bool:
    """Whether edges that are not neighbours meet."""
    count = len(corners)
    apart = (np.arange(count)[:, None] - np.arange(count)) % count
    met = edges_meet(corners, corners)
    return bool(met[(apart > 1) & (apart < count - 1)].any())


def depth(corners: Corners, point: tuple[float, float]) -> float:
    """Distance of a point from the edges of a polygon, positive inside and negative outside."""
    start = np.array(corners, dtype=float) - np.array(point, dtype=float)
    end = np.roll(start, -1, axis=0)
    along = end - start
    squared = np.maximum((along**2).sum(axis=1), np.finfo(float).tiny)  # lengths may underflow
    share = np.clip(-(start * along).sum(axis=1) / squared, 0.0, 1.0)
    distance = float(np.linalg.norm(start + share[:, None] * along, axis=1).min())
    # The corners turn once around a point inside, and not at all around one outside.
    turned = np.arctan2(start[:, 0] * end[:, 1] - start[:, 1] * end[:, 0], (start * end).sum(axis=1)).sum()
    return distance if abs(turned) > np.pi else -distance
