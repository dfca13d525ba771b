"""What a solution tells of its own shortcomings, element by element: the energy in its highest functions.

The functions of a level or an order are the first ones of the next, so that what the highest of them carry shows how
fast the series falls off: over the section with the degree of the fields, along the rod with the order of the bubbles.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from cases.scene import SectionForce, SectionMoment
from rodmodel.assembly import AssembledRod
from rodmodel.holds import held_sections
from rodmodel.pairing import facing_points, on_second
from rodmodel.section import Fields, axial_modulus
from rodmodel.shape import extents
from rodmodel.solution import Solution
from rodmodel.stiffness import Element

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]

# How far beside an element contact may press to count as pressing on it, in heights or widths of the section.
BESIDE = 0.2
# Energy from one order to the next falls at least by this; slower series have a corner, which orders do not resolve.
SLOWEST = 0.8


@dataclass(frozen=True, eq=False)
class RodIndicators:
    """What the elements of a rod hold in their highest functions, as parts of the energy of all rods.

    Attributes
    ----------
    energy : of each element in all, shape (n_elements,)
    by_degree : energy in the fields of each degree in (x, y), shape (n_elements, highest level + 1)
    levels : shape (n_elements,)
    along : energy that all further orders would find, going by how the last two fall off, shape (n_elements,)
    fall : by what factor it falls with each order, shape (n_elements,)
    """

    energy: Array
    by_degree: Array
    levels: NDArray[np.int64]
    along: Array
    fall: Array

    @property
    def over_section(self) -> Array:
        """Energy in the fields of the element's two highest degrees, as one alone may vanish, shape (n_elements,)."""
        number = np.arange(len(self.levels))
        return np.asarray(self.by_degree[number, self.levels] + self.by_degree[number, self.levels - 1])


def indicators(solution: Solution) -> Mapping[str, RodIndicators]:
    """By rod name."""
    whole = max(solution.stored_energy, np.finfo(float).tiny)
    result = {}
    for name, assembled in solution.system.rods.items():
        scale = axial_modulus(assembled.rod.material) / whole
        levels = np.array([element.fields.level for element in assembled.elements])
        by_degree = np.zeros((len(levels), levels.max() + 1))
        energy, along, fall = np.empty((3, len(levels)))
        coefficients = solution.states[name].coefficients
        for number, (element, values) in enumerate(zip(assembled.elements, coefficients, strict=True)):
            degrees = by_degree[number, : element.fields.level + 1]
            energy[number], degrees[:], along[number], fall[number] = _looked_at(element, values)
        result[name] = RodIndicators(scale * energy, scale * by_degree, levels, scale * along, fall)
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


def elements_near_corners(solution: Solution) -> Mapping[str, BoolArray]:
    """By rod name, whether an element's middle is within a section's height of where fields are singular.

    Held and loaded sections, ends of zones and of stretches in contact.
    """
    scene = solution.scene
    found = {}
    for name, assembled in solution.system.rods.items():
        places = [held.station for held in held_sections(scene, assembled.rod)]
        loads = [load for load in scene.loads if isinstance(load, SectionForce | SectionMoment)]
        places += [load.position for load in loads if load.rod == name]
        for pair in scene.contacts:
            ends = [at for each in solution.stretches if each.pair == pair.name for at in (each.start, each.end)]
            stations = np.array([*pair.zone, *ends])
            if name == pair.first.rod:
                places += stations.tolist()
            elif name == pair.faces[-1].rod:
                places += on_second(scene, pair, stations).tolist()
        found[name] = _within(_height(assembled), places, assembled)
    return found


def _within(reach: float, places: list[float], assembled: AssembledRod) -> BoolArray:
    middle = 0.5 * (assembled.borders[1:] + assembled.borders[:-1])
    return np.asarray((np.abs(middle[:, None] - np.array(places)) < reach).any(axis=1))


def _height(assembled: AssembledRod) -> float:
    x_min, x_max, y_min, y_max = extents(assembled.rod.section)
    return max(x_max - x_min, y_max - y_min)


def unit_energy(element: Element, values: Array) -> float:
    """Elastic energy of an element for unit axial modulus; `values` of shape (order + 1, n_fields)."""
    return _looked_at(element, values)[0]


def _looked_at(element: Element, values: Array) -> tuple[float, Array, float, float]:
    """Unit energy of an element in all and in the fields of each degree alone, and what `_further_orders` says."""
    of_degree = _of_degree(element.fields)
    each = values[..., None] * of_degree
    nodal, bubbles = each[:2].reshape(-1, of_degree.shape[1]), each[2:].reshape(-1, of_degree.shape[1])
    groups = element.bubbles.groups
    half = np.concatenate(
        [block.T @ bubbles[group] for group, block in zip(groups, element.bubbles.blocks, strict=True)]
    )
    surplus = np.empty(len(half))
    surplus[np.concatenate(groups)] = 0.5 * half[:, 0] ** 2
    further = _further_orders(surplus.reshape(element.order - 1, -1).sum(axis=1))
    # L^T b + L^-1 K_bn n, in which |.|^2 / 2 is what condensation leaves over of the energy.
    half += element.half_coupling @ nodal
    energies = 0.5 * ((nodal * (element.condensed @ nodal)).sum(axis=0) + (half**2).sum(axis=0))
    return float(energies[0]), energies[1:], *further


@lru_cache(maxsize=64)
def _of_degree(fields: Fields) -> Array:
    """1 for all fields, then for those of each degree from 0 on, else 0; shape (n_fields, level + 2)."""
    _, i, j = fields.table
    chosen = np.column_stack([np.ones(fields.count), (i + j)[:, None] == np.arange(fields.level + 1)])
    chosen.flags.writeable = False
    return chosen


def _further_orders(surplus: Array) -> tuple[float, float]:
    """Unit energy that all further orders would find, and by what factor it falls with each, going by the last two.

    surplus : |L^T b|^2 / 2 of the bubbles of each order from 2 on. The highest bubbles come last in the factor of K_bb,
        whose last block is that of their Schur complement: their part is what the element would lose without them, all
        lower ones free to make up for it
    """
    last = float(surplus[-1])
    before = float(surplus[-2]) if len(surplus) > 1 else 0.0
    fall = min(SLOWEST, last / before) if before > 0.0 else SLOWEST
    return last * fall / (1.0 - fall), fall
