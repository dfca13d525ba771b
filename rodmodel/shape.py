"""The shape of a cross-section: quadrature over it, extents, symmetry. Coordinates are relative to the centroid.

Every rule has positive weights and points inside the section, so that what is squared and integrated stays positive:
section matrices are semidefinite, Gram matrices definite. The divergence theorem along the edges (or a fan of
triangles from one point) would need no decomposition, but its points lie outside and its weights alternate; polygons
are cut into trapezoids between horizontals through the corners instead, which takes holes without any bridge.
"""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Section
from rodmodel.axial import gauss

Array = NDArray[np.float64]

# Corners that agree to this share of the section's size are the same; drawings give about ten digits.
_SAME = 1e-9


def section_quadrature(section: Section, degree: int) -> tuple[Array, Array, Array]:
    """Points x, y (mm) and weights (mm^2) that integrate polynomials of total degree `degree` in (x, y) exactly.

    Rectangle and box by products of Gauss rules; circle and ring by equispaced angles and a Gauss rule in r^2;
    polygon by products of Gauss rules on trapezoids. Weights are positive, points inside the section.
    """
    if isinstance(section, Rectangle):
        return _rectangles(degree, np.zeros((1, 2)), np.array([[section.width, section.height]]))
    if isinstance(section, Box):
        inner_width = section.width - 2.0 * section.wall
        across, along = 0.5 * (section.width - section.wall), 0.5 * (section.height - section.wall)
        centres = np.array([[-across, 0.0], [across, 0.0], [0.0, -along], [0.0, along]])
        web, flange = (section.wall, section.height), (inner_width, section.wall)
        return _rectangles(degree, centres, np.array([web, web, flange, flange]))
    if isinstance(section, Circle):
        return _annulus(degree, 0.0, 0.5 * section.diameter)
    if isinstance(section, Ring):
        return _annulus(degree, 0.5 * section.inner_diameter, 0.5 * section.outer_diameter)
    return _trapezoids(degree, section)


def extents(section: Section) -> tuple[float, float, float, float]:
    """Least and greatest x, least and greatest y of the section, relative to its centroid, mm."""
    if isinstance(section, Polygon):
        corners = outline(section)[0]
        (x_min, y_min), (x_max, y_max) = corners.min(axis=0), corners.max(axis=0)
        return float(x_min), float(x_max), float(y_min), float(y_max)
    if isinstance(section, Rectangle | Box):
        x_max, y_max = 0.5 * section.width, 0.5 * section.height
    else:
        x_max = y_max = 0.5 * (section.diameter if isinstance(section, Circle) else section.outer_diameter)
    return -x_max, x_max, -y_max, y_max


def has_centre(section: Section) -> bool:
    """Whether the section has material at its centroid; a point on an edge is in the material or not."""
    if not isinstance(section, Polygon):
        return isinstance(section, Rectangle | Circle)
    (x1, y1), (x2, y2) = (corners.T for corners in _edges(section))
    crossed = (y1 > 0.0) != (y2 > 0.0)
    # How many edges the half line y = 0, x > 0 crosses.
    beyond = x1[crossed] * y2[crossed] - x2[crossed] * y1[crossed]
    return bool(np.count_nonzero(beyond / (y2 - y1)[crossed] > 0.0) % 2)


@lru_cache(maxsize=32)
def mirror_planes(section: Section) -> tuple[bool, bool]:
    """Whether the section is its own mirror image in x = 0 and in y = 0.

    A polygon is if each of its edges, mirrored, is one of its edges; corners agree within 1e-9 of its size. A corner
    set on one side only, in the middle of an edge, hides the symmetry.
    """
    if not isinstance(section, Polygon):
        return True, True
    starts, ends = _edges(section)
    slack = _SAME * _size(section)

    def unchanged(mirror: tuple[float, float]) -> bool:
        # Mirrored, an edge runs the other way around.
        apart = np.abs(np.concatenate([starts, ends], 1)[:, None] - np.concatenate([ends * mirror, starts * mirror], 1))
        return bool(np.all(np.any(np.all(apart <= slack, axis=2), axis=1)))

    return unchanged((-1.0, 1.0)), unchanged((1.0, -1.0))


@lru_cache(maxsize=32)
def outline(section: Polygon) -> tuple[Array, ...]:
    """Corners of a polygon relative to its centroid, each of shape (n, 2): outer ones, then those of every hole.

    Outer corners run counter-clockwise, those of holes clockwise: the section lies to the left of every edge.
    """
    origin = np.array(section.outer[0], dtype=float)  # sums lose digits far from the origin
    loops = [np.array(corners, dtype=float) - origin for corners in (section.outer, *section.holes)]
    first_moment = np.zeros(2)
    area = 0.0
    for n, corners in enumerate(loops):
        following = np.roll(corners, -1, axis=0)
        twice = corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0]
        if (np.sum(twice) > 0.0) != (n == 0):
            loops[n] = corners[::-1]
            twice = -twice
        area += 0.5 * float(np.sum(twice))
        first_moment += twice @ (corners + following) / 6.0
    centred = tuple(corners - first_moment / area for corners in loops)
    for corners in centred:
        corners.flags.writeable = False
    return centred


def _edges(section: Polygon) -> tuple[Array, Array]:
    """Start and end points of all edges, outer ones and those of holes, each of shape (n_edges, 2)."""
    loops = outline(section)
    return np.concatenate(loops), np.concatenate([np.roll(corners, -1, axis=0) for corners in loops])


def _size(section: Polygon) -> float:
    return float(np.max(np.ptp(outline(section)[0], axis=0)))


def _rectangles(degree: int, centres: Array, sizes: Array) -> tuple[Array, Array, Array]:
    xi, weight = gauss(degree // 2 + 1)
    n = len(xi)
    x = centres[:, :1] + 0.5 * sizes[:, :1] * xi
    y = centres[:, 1:] + 0.5 * sizes[:, 1:] * xi
    area_weight = 0.25 * np.prod(sizes, axis=1)[:, None, None] * np.outer(weight, weight)
    return np.repeat(x, n, axis=1).ravel(), np.tile(y, (1, n)).ravel(), area_weight.ravel()


def _annulus(degree: int, inner: float, outer: float) -> tuple[Array, Array, Array]:
    """Equispaced angles, mirrored from one quadrant, times Gauss in q = r^2; dA = dq dtheta / 2.

    m angles are exact for cos(n theta), n < m. What they leave of x^i y^j is its even part in r, a polynomial in q.
    """
    quarter = degree // 4 + 1
    angle = (np.arange(quarter) + 0.5) * (0.5 * math.pi / quarter)
    cosine, sine = np.cos(angle), np.sin(angle)
    cosine, sine = (np.concatenate([v, s * v, -v, -s * v]) for v, s in ((cosine, -1.0), (sine, 1.0)))
    xi, weight = gauss(degree // 4 + 1)
    half_range = 0.5 * (outer**2 - inner**2)
    radius = np.sqrt(inner**2 + half_range * (1.0 + xi))
    share = 0.5 * half_range * weight * (2.0 * math.pi / (4 * quarter))
    return np.outer(radius, cosine).ravel(), np.outer(radius, sine).ravel(), np.repeat(share, 4 * quarter)


def _trapezoids(degree: int, section: Polygon) -> tuple[Array, Array, Array]:
    """Between edges, x = left(y) + (right(y) - left(y)) xi: degree d in (x, y) is d in xi and d + 1 in y."""
    heights, lefts, rights = _slabs(section)
    xi, weight_x = gauss(degree // 2 + 1)
    eta, weight_y = gauss((degree + 1) // 2 + 1)
    share = np.stack([0.5 * (1.0 - eta), 0.5 * (1.0 + eta)])
    y, left, right = heights @ share, lefts @ share, rights @ share  # (n_trapezoids, n_y)
    half = 0.5 * (right - left)
    x = (0.5 * (left + right))[..., None] + half[..., None] * xi
    weight = (0.5 * (heights[:, 1:] - heights[:, :1]) * weight_y * half)[..., None] * weight_x
    return x.ravel(), np.repeat(y, len(xi)), weight.ravel()


@lru_cache(maxsize=32)
def _slabs(section: Polygon) -> tuple[Array, Array, Array]:
    """The trapezoids: y of their parallel sides, x of the left and of the right edge there, each (n_trapezoids, 2).

    Between the heights of neighbouring corners the edges pair up, left and right.
    """
    starts, ends = _edges(section)
    levels = np.unique(starts[:, 1])
    slabs = np.stack([levels[:-1], levels[1:]], axis=1)
    slabs = slabs[np.ptp(slabs, axis=1) > 1e-13 * (levels[-1] - levels[0])]  # thinner ones: corners meant to be level

    middle = np.mean(slabs, axis=1)[:, None]
    rise = ends[:, 1] - starts[:, 1]
    crossed = (np.minimum(starts[:, 1], ends[:, 1]) < middle) & (middle < np.maximum(starts[:, 1], ends[:, 1]))
    share = np.divide(middle - starts[:, 1], rise, out=np.zeros(crossed.shape), where=crossed)
    x_middle = np.where(crossed, starts[:, 0] + share * (ends[:, 0] - starts[:, 0]), np.inf)
    order = np.argsort(x_middle, axis=1)
    last = np.arange(1, order.shape[1], 2)
    slab, pair = np.nonzero(last < np.count_nonzero(crossed, axis=1)[:, None])

    def at_sides(edge: NDArray[np.intp]) -> Array:
        along = (slabs[slab] - starts[edge, 1:]) / rise[edge, None]
        return np.asarray(starts[edge, :1] + along * (ends[edge, :1] - starts[edge, :1]))

    heights, lefts, rights = slabs[slab], at_sides(order[slab, last[pair] - 1]), at_sides(order[slab, last[pair]])
    for sides in (heights, lefts, rights):
        sides.flags.writeable = False
    return heights, lefts, rights
