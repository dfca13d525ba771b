"""Plain two-node beams: straight and on an arc with full integration, which lock, and Euler's and Bernoulli's.

T. J. R. Hughes, The Finite Element Method, 1987, sections 1.16 and 5.4; on arcs, with membrane strain u' + w / R.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from rodmodel.axial import gauss

Array = NDArray[np.float64]


def end_deflection(
    length: float, radius: float, bending: float, stretching: float, shearing: float, elements: int
) -> float:
    """Deflection across the axis of a cantilever's end per unit force there, mm/N.

    Unknowns at a node: u along, w across, rotation. Strains, with k = 1 / R: membrane u' + k w, shear w' - k u +
    rotation, bending rotation'.

    Parameters
    ----------
    length, radius : mm, along the arc; the radius may be infinite
    bending, stretching, shearing : E I, E A, k G A
    """
    size, k = length / elements, 1.0 / radius
    xi, weight = gauss(2)
    stiffness = np.zeros((6, 6))
    for point, share in zip(xi, weight, strict=True):
        n, slope = np.array([0.5 * (1.0 - point), 0.5 * (1.0 + point)]), np.array([-1.0, 1.0]) / size
        zero = np.zeros(2)
        rows = (
            (stretching, np.stack([slope, k * n, zero], axis=1).ravel()),
            (shearing, np.stack([-k * n, slope, n], axis=1).ravel()),
            (bending, np.stack([zero, zero, slope], axis=1).ravel()),
        )
        stiffness += sum(share * 0.5 * size * modulus * np.outer(row, row) for modulus, row in rows)
    whole = np.zeros((3 * elements + 3, 3 * elements + 3))
    for element in range(elements):
        whole[3 * element : 3 * element + 6, 3 * element : 3 * element + 6] += stiffness
    load = np.zeros(len(whole))
    load[-2] = 1.0
    return float(np.linalg.solve(whole[3:, 3:], load[3:])[-2])


def cubic_end_deflection(borders: Array, bending: float) -> float:
    """Deflection of a cantilever's end per unit force there by cubic elements, mm/N: exact but for round-off.

    Unknowns at a node: deflection in mm and slope, as textbooks have them.

    Parameters
    ----------
    borders : of the elements, mm
    bending : E I
    """
    whole = np.zeros((2 * len(borders), 2 * len(borders)))
    for element, length in enumerate(np.diff(borders)):
        deflections, mixed, slopes = 12.0 / length**3, 6.0 / length**2, 2.0 / length
        whole[2 * element : 2 * element + 4, 2 * element : 2 * element + 4] += bending * np.array(
            [
                [deflections, mixed, -deflections, mixed],
                [mixed, 2.0 * slopes, -mixed, slopes],
                [-deflections, -mixed, deflections, -mixed],
                [mixed, slopes, -mixed, 2.0 * slopes],
            ]
        )
    load = np.zeros(len(whole))
    load[-2] = 1.0
    return float(np.linalg.solve(whole[2:, 2:], load[2:])[-2])
