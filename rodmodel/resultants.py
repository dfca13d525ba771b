"""A section as a rigid one: its mean displacement and rotation, the tractions that work on them, and its rigid motions.

Rows are in the order: along e1, e2, t, then about e1, e2, t.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import Section
from rodmodel.section import STRAIGHT, Fields, U, V, W, product_quadrature, section_values

Array = NDArray[np.float64]


def even_traction(fields: Fields) -> Array:
    """Work of a unit force along e1, e2, t, spread evenly over the section, on every field, shape (3, n_fields).

    It works on the mean displacement alone, which is the coefficient of the constant function.
    """
    work = np.zeros((3, fields.count))
    for component in (U, V, W):
        index = fields.index(component, 0, 0)
        if index is not None:
            work[component, index] = 1.0
    return work


def linear_traction(section: Section, fields: Fields) -> Array:
    """Work of a unit moment about e1, e2, t on every field: the section's mean rotation, shape (3, n_fields).

    Bending moments as a normal traction linear in x and y, torque as T / I_p (-y, x).
    """
    x, y, weight = product_quadrature(section, fields.level, STRAIGHT)
    values = section_values(section, fields, x, y) * weight
    xx, xy, yy = weight @ (x * x), weight @ (x * y), weight @ (y * y)
    # t = a x + b y with int t y = M1 and -int t x = M2
    slopes = np.linalg.solve(np.array([[xy, yy], [-xx, -xy]]), np.eye(2))
    is_u, is_v, is_w = (fields.indices(component) for component in (U, V, W))
    work = np.zeros((3, fields.count))
    work[:2, is_w] = (slopes.T @ np.array([x, y])) @ values[is_w].T
    work[2, is_u] = values[is_u] @ (-y) / (xx + yy)
    work[2, is_v] = values[is_v] @ x / (xx + yy)
    return work


@lru_cache(maxsize=64)
def rigid_motions(section: Section, fields: Fields) -> Array:
    """Unit translations along, then rotations about e1, e2, t of a section, as its fields, shape (6, n_fields)."""
    x, y, weight = product_quadrature(section, fields.level, STRAIGHT)
    values = section_values(section, fields, x, y) * (weight / weight.sum())
    motions = np.zeros((6, fields.count))
    for motion, component, function in (
        (0, U, np.ones_like(x)),
        (1, V, np.ones_like(x)),
        (2, W, np.ones_like(x)),
        (3, W, y),
        (4, W, -x),
        (5, U, -y),
        (5, V, x),
    ):
        mine = fields.indices(component)
        motions[motion, mine] = values[mine] @ function
    motions.setflags(write=False)  # as it is handed out again
    return motions
