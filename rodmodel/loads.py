"""Given loads as linear functionals on the degrees of freedom of a rod."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import LineLoad, Load, Rod, Section, SectionForce, SectionMoment
from rodmodel.assembly import AssembledRod, Part, point_parts
from rodmodel.axial import gauss, shape_functions
from rodmodel.centre_line import frames
from rodmodel.section import STRAIGHT, Fields, U, V, W, product_quadrature, section_values

Array = NDArray[np.float64]

# Along a curved element the load's direction turns in the frame; this many points more than the order resolve it.
EXTRA_POINTS = 6


def load_parts(assembled: AssembledRod, loads: Sequence[Load], column: int) -> list[Part]:
    """Shares of the elements in the work of all loads on the rod, as functional number `column`."""
    parts: list[Part] = []
    for load in loads:
        if load.rod != assembled.rod.name:
            continue
        if isinstance(load, LineLoad):
            parts += _line_load_parts(assembled, load, column)
        else:
            at_section = point_parts(assembled, np.array([load.position]), _section_load(assembled.rod, load))
            parts += [replace(part, columns=np.array([column])) for part in at_section]
    return parts


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
    """Work of a unit moment about e1, e2, t on every field, shape (3, n_fields).

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


def _section_load(rod: Rod, load: SectionForce | SectionMoment) -> Callable[[Fields], Array]:
    axes = frames(rod.centre_line, np.array([load.position]))[0]
    if isinstance(load, SectionMoment):
        moment = axes @ load.moment
        return lambda fields: (moment @ linear_traction(rod.section, fields))[:, None]
    force = axes @ load.force
    return lambda fields: (force @ even_traction(fields))[:, None]


def _line_load_parts(assembled: AssembledRod, load: LineLoad, column: int) -> list[Part]:
    """A line load covers whole elements: its ends are element borders."""
    parts = []
    for index, element in enumerate(assembled.elements):
        left, right = assembled.borders[index : index + 2]
        if not load.start < 0.5 * (left + right) < load.end:
            continue
        xi, weight = gauss(element.order + EXTRA_POINTS)
        station = 0.5 * (left + right) + 0.5 * (right - left) * xi
        force = frames(assembled.rod.centre_line, station) @ load.force
        values = np.einsum(
            "aq,q,qc,cf->af",
            shape_functions(element.order, xi),
            0.5 * (right - left) * weight,
            force,
            even_traction(element.fields),
        )
        parts.append(Part(index, np.array([column]), values[:, :, None]))
    return parts
