"""Given loads as linear functionals on the degrees of freedom of a rod."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import Gravity, LineLoad, Load, Pressure, Rod, SectionForce, SectionMoment
from rodmodel.assembly import AssembledRod, Part, point_parts
from rodmodel.axial import gauss, shape_functions
from rodmodel.centre_line import by_turning, frames, turning_at
from rodmodel.face import pressure_work
from rodmodel.resultants import even_traction, linear_traction
from rodmodel.section import Fields, product_quadrature, section_values

Array = NDArray[np.float64]

# Along a curved element the load's direction turns in the frame; this many points more than the order resolve it.
EXTRA_POINTS = 6


def load_parts(assembled: AssembledRod, loads: Sequence[Load], column: int) -> list[Part]:
    """Shares of the elements in the work of all loads on the rod, as functional number `column`."""
    parts: list[Part] = []
    for load in loads:
        if load.rod != assembled.rod.name:
            continue
        match load:
            case SectionForce() | SectionMoment():
                at_section = point_parts(assembled, np.array([load.position]), _section_load(assembled.rod, load))
                parts += [replace(part, columns=np.array([column])) for part in at_section]
            case LineLoad():
                parts += _spread_parts(assembled, load.start, load.end, _line_force(assembled.rod, load), column)
            case Pressure():
                parts += _spread_parts(assembled, load.start, load.end, _face_force(assembled.rod, load), column)
            case Gravity():
                parts += _spread_parts(assembled, 0.0, assembled.rod.length, _weight(assembled.rod, load), column)
    return parts


def _section_load(rod: Rod, load: SectionForce | SectionMoment) -> Callable[[Fields], Array]:
    axes = frames(rod.centre_line, np.array([load.position]))[0]
    if isinstance(load, SectionMoment):
        moment = axes @ load.moment
        return lambda fields: (moment @ linear_traction(rod.section, fields))[:, None]
    force = axes @ load.force
    return lambda fields: (force @ even_traction(fields))[:, None]


# Work of a load per arc length of the centre line on every field, at stations; shape (n_stations, n_fields).
Density = Callable[[Fields, Array], Array]


def _spread_parts(assembled: AssembledRod, start: float, end: float, density: Density, column: int) -> list[Part]:
    """A load along the rod covers whole elements: its ends are element borders."""
    parts = []
    for index, element in enumerate(assembled.elements):
        left, right = assembled.borders[index : index + 2]
        if not start < 0.5 * (left + right) < end:
            continue
        xi, weight = gauss(element.order + EXTRA_POINTS)
        station = 0.5 * (left + right) + 0.5 * (right - left) * xi
        along = shape_functions(element.order, xi) * (0.5 * (right - left) * weight)
        values = along @ density(element.fields, station)
        parts.append(Part(index, np.array([column]), values[:, :, None]))
    return parts


def _line_force(rod: Rod, load: LineLoad) -> Density:
    return lambda fields, station: frames(rod.centre_line, station) @ load.force @ even_traction(fields)


def _face_force(rod: Rod, load: Pressure) -> Density:
    def density(fields: Fields, station: Array) -> Array:
        turning = turning_at(rod.centre_line, station)
        work = by_turning(turning, lambda rates: pressure_work(rod.section, load.face.face, fields, rates))
        return load.pressure * work

    return density


def _weight(rod: Rod, load: Gravity) -> Density:
    if rod.material.density is None:
        raise ValueError(f"rod '{rod.name}': gravity needs a density")
    per_volume = rod.material.density * np.asarray(load.acceleration)

    def density(fields: Fields, station: Array) -> Array:
        k1, k2, _ = turning = turning_at(rod.centre_line, station)
        x, y, weight = product_quadrature(rod.section, fields.level, turning)
        # A unit force per volume: sqrt(g) makes it act off the centre line of a curved rod.
        stretch = 1.0 - k2[:, None] * x + k1[:, None] * y
        volume = (weight * stretch) @ section_values(rod.section, fields, x, y).T
        return np.asarray((frames(rod.centre_line, station) @ per_volume)[:, fields.table[0]] * volume)

    return density
