"""What a solution tells of its own shortcomings, element by element: the energy in its highest functions.

The functions of a level or an order are the first ones of the next, so that what the highest of them carry shows how
fast the series falls off: over the section with the degree of the fields, along the rod with the order of the bubbles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rodmodel.pairing import facing_points
from rodmodel.section import axial_modulus
from rodmodel.shape import extents
from rodmodel.solution import Solution
from rodmodel.stiffness import Element

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# How far beside an element contact may press to count as pressing on it, in heights or widths of the section.
BESIDE = 0.2


@dataclass(frozen=True, eq=False)
class RodIndicators:
    """Energy in the highest functions of each element of a rod, as a part of the energy of all rods.

    Attributes
    ----------
    over_section : in the fields whose degree in (x, y) is the element's level, shape (n_elements,)
    along : what the next order would find, going by how the last two fall off, shape (n_elements,)
    """

    over_section: Array
    along: Array


def indicators(solution: Solution) -> Mapping[str, RodIndicators]:
    """By rod name."""
    whole = max(solution.stored_energy, np.finfo(float).tiny)
    result = {}
    for name, assembled in solution.system.rods.items():
        scale = axial_modulus(assembled.rod.material) / whole
        pairs = list(zip(assembled.elements, solution.states[name].coefficients, strict=True))
        over_section = np.array([unit_energy(element, _highest_fields(element, values)) for element, values in pairs])
        along = np.array([_next_order(element, values) for element, values in pairs])
        result[name] = RodIndicators(scale * over_section, scale * along)
    return result


def pressed_elements(solution: Solution) -> Mapping[str, BoolArray]:
    """By rod name, whether contact presses on an element or next to it (`BESIDE`)."""
    scene, system = solution.scene, solution.system
    found = {name: np.zeros(len(assembled.elements), dtype=bool) for name, assembled in system.rods.items()}
    for pair in scene.contacts:
        station, across = system.grids[pair.name].flat()
        facing = facing_points(scene, pair, station, across)
        pressing = solution.force[system.points[pair.name]] > 0.0
        for face, points in zip(pair.faces, (facing.first, facing.second), strict=False):
            assert points is not None  # the second of ground, which has no face
            assembled = system.rods[face.rod]
            x_min, x_max, y_min, y_max = extents(assembled.rod.section)
            reach = BESIDE * min(x_max - x_min, y_max - y_min)
            at = points[2, pressing]
            left, right = assembled.borders[:-1, None] - reach, assembled.borders[1:, None] + reach
            found[face.rod] |= ((left < at) & (at < right)).any(axis=1)
    return found


def unit_energy(element: Element, values: Array) -> float:
    """Elastic energy of an element for unit axial modulus; `values` of shape (order + 1, n_fields)."""
    nodal, bubbles = values[:2].ravel(), values[2:].ravel()
    # L^T b + L^-1 K_bn n, in which |.|^2 / 2 is what condensation leaves over of the energy.
    factors = zip(element.bubbles.groups, element.bubbles.blocks, strict=True)
    half = np.concatenate([block.T @ bubbles[group] for group, block in factors])
    half += element.half_coupling @ nodal
    return 0.5 * float(nodal @ element.condensed @ nodal + half @ half)


def _highest_fields(element: Element, values: Array) -> Array:
    _, i, j = element.fields.table
    return np.where(i + j == element.fields.level, values, 0.0)


def _next_order(element: Element, values: Array) -> float:
    """What the next order would find, going by how the last two fall off."""
    last, both = (_surplus(element, values, orders) for orders in (1, 2))
    return last * min(1.0, last / (both - last)) if both > last else last


def _surplus(element: Element, values: Array, orders: int) -> float:
    """Energy that the element would lose with its highest orders, all lower bubbles free to make up for it.

    The highest bubbles come last, so that the last block of the factor of K_bb is that of their Schur complement.
    """
    first = max(element.order - 1 - orders, 0) * element.fields.count
    bubbles, energy = values[2:].ravel(), 0.0
    for group, block in zip(element.bubbles.groups, element.bubbles.blocks, strict=True):
        start = int(np.searchsorted(group, first))
        half = block[start:, start:].T @ bubbles[group[start:]]
        energy += 0.5 * float(half @ half)
    return energy
