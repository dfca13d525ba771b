"""What a Winkler bed does to its rod in a solved scene."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Bed, Rod
from rodmodel.axial import gauss
from rodmodel.centre_line import frames, global_points, turning_at
from rodmodel.face import face_strip

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class BedForces:
    """Forces of a bed on its rod, point by point.

    Attributes
    ----------
    station : arc length, mm, shape (n,)
    position : on the face, global, mm, shape (3, n)
    force : global components, N, shape (3, n)
    energy : stored in the bed there, N mm, shape (n,)
    """

    station: Array
    position: Array
    force: Array
    energy: Array


def bed_forces(
    bed: Bed, rod: Rod, displacement_at: Callable[[Array], Array], borders: Array, level: int, order: int
) -> BedForces:
    """Forces at Gauss points of every piece of the bed between borders, enough to integrate force and energy.

    displacement_at : of points (x, y, s), global components, mm, shape (3, n) to (3, n)
    borders : arc lengths that cut the bed, mm; where the displacement has kinks there should be one
    level, order : highest degree of the displacement over the section and along the rod
    """
    inside = np.unique(borders[(borders > bed.start) & (borders < bed.end)])
    cuts = np.concatenate([[bed.start], inside, [bed.end]])
    root, weight = gauss(order + 4)
    half = 0.5 * np.diff(cuts)
    along = (0.5 * (cuts[:-1] + cuts[1:])[:, None] + half[:, None] * root).ravel()
    length = (half[:, None] * weight).ravel()
    turning = turning_at(rod.centre_line, along).T.tolist()
    strips = [face_strip(rod.section, bed.face.face, (k1, k2, tau), level) for k1, k2, tau in turning]
    counts = [len(strip.x) for strip in strips]
    station = np.repeat(along, counts)
    points = np.array([*np.concatenate([[strip.x, strip.y] for strip in strips], axis=1), station])
    size = np.concatenate([strip.size for strip in strips])
    area = size * np.repeat(length, counts)
    unit = np.concatenate([strip.area for strip in strips], axis=1) / size
    normal = np.einsum("ncg,cn->gn", frames(rod.centre_line, station), unit)
    outward = np.einsum("gn,gn->n", normal, displacement_at(points))
    force = -bed.modulus * area * outward * normal
    return BedForces(station, global_points(rod, points), force, 0.5 * bed.modulus * area * outward**2)
