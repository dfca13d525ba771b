"""Displacement field of a rod of 27-node boxes: its value, its stress and the integrals of its stress."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material
from reference3d.elasticity import lame_parameters
from reference3d.grading import Borders
from reference3d.quadratic import Side, locate, shape_derivatives, shape_functions

Array = NDArray[np.float64]

SIDES: tuple[Side, Side] = ("left", "right")


@dataclass(frozen=True)
class Field:
    """Displacement of one rod in its local frame, for the full section.

    Attributes
    ----------
    borders : element borders, mm
    nodal : (u, v, w) at the nodes, mm, shape (2 n_s + 1, 2 n_y + 1, 2 n_x + 1, 3)
    """

    borders: Borders
    nodal: Array


def mirrored(field: Field) -> Field:
    """The field of the full section from that of the half x >= 0, symmetric about x = 0."""
    borders = field.borders
    opposite = field.nodal[:, :, :0:-1] * np.array([-1.0, 1.0, 1.0])
    x = np.concatenate([-borders.x[:0:-1], borders.x])
    return Field(Borders(x, borders.y, borders.s), np.concatenate([opposite, field.nodal], axis=2))


def _sample(field: Field, points: Array, sides: tuple[Side, Side, Side]) -> tuple[Array, Array]:
    """Displacement, shape (3, n), and gradient du_a/dx_b, shape (3, 3, n), in one of the elements there."""
    axes = (field.borders.x, field.borders.y, field.borders.s)
    values, derivatives, nodes = [], [], []
    for axis, coordinate, side in zip(axes, points, sides, strict=True):
        element, xi = locate(axis, coordinate, side)
        length = axis[element + 1] - axis[element]
        values.append(shape_functions(xi))
        derivatives.append(shape_derivatives(xi) * (2.0 / length))
        nodes.append(2 * element + np.arange(3)[:, None])
    local = field.nodal[nodes[2][:, None, None], nodes[1][None, :, None], nodes[0][None, None, :]]
    displacement = np.einsum("kjina,in,jn,kn->an", local, *values, optimize=True)
    gradient = np.stack(
        [
            np.einsum(
                "kjina,in,jn,kn->an",
                local,
                *(derivatives[a] if a == b else values[a] for a in range(3)),
                optimize=True,
            )
            for b in range(3)
        ],
        axis=1,
    )
    return displacement, gradient


def _sides(borders: Array, coordinate: Array) -> tuple[Side, ...]:
    """Sides to sample along one axis: both only if a point lies where two elements meet."""
    left, right = (locate(borders, coordinate, side)[0] for side in SIDES)
    return ("left",) if np.array_equal(left, right) else SIDES


def displacement(field: Field, points: Array) -> Array:
    """Displacement in the local frame at (x, y, s), mm, shape (3, n)."""
    return _sample(field, points, ("left", "left", "left"))[0]


def stress(field: Field, material: Material, points: Array) -> Array:
    """Stress at (x, y, s): xx, yy, ss, ys, xs, xy, MPa, shape (6, n); where elements meet, their mean."""
    axes = (field.borders.x, field.borders.y, field.borders.s)
    in_x, in_y, in_s = (_sides(axis, coordinate) for axis, coordinate in zip(axes, points, strict=True))
    gradient = np.mean([_sample(field, points, choice)[1] for choice in product(in_x, in_y, in_s)], axis=0)
    lam, mu = lame_parameters(material)
    strain = 0.5 * (gradient + gradient.transpose(1, 0, 2))
    tensor = 2.0 * mu * strain + lam * np.einsum("aan->n", strain) * np.eye(3)[:, :, None]
    return np.stack([tensor[0, 0], tensor[1, 1], tensor[2, 2], tensor[1, 2], tensor[0, 2], tensor[0, 1]])


def section_resultants(field: Field, material: Material, station: Array) -> Array:
    """N, Q1, Q2, M1, M2, T (`reports.solution`) from the finite element stress, shape (6, n).

    The stress of quadratic elements is most accurate at the two Gauss points along the element (J. Barlow,
    International Journal for Numerical Methods in Engineering 10 (1976) 243-251): the section integrals are taken
    there and are linear along the element. Where two elements meet, the result is their mean.
    """
    borders, place = field.borders.s, 1.0 / np.sqrt(3.0)
    found = []
    for side in SIDES:
        element, xi = locate(borders, np.asarray(station, dtype=np.float64), side)
        middle, half = 0.5 * (borders[element + 1] + borders[element]), 0.5 * np.diff(borders)[element]
        before, after = (_integrals(field, material, middle + sign * place * half) for sign in (-1.0, 1.0))
        found.append(0.5 * (before + after) + (after - before) * (xi / (2.0 * place)))
    return np.asarray(np.mean(found, axis=0))


def _integrals(field: Field, material: Material, station: Array) -> Array:
    """Integrals of the stress over the section, shape (6, n), by three Gauss points along each axis, exactly."""
    root, weight = np.polynomial.legendre.leggauss(3)
    places, weights = [], []
    for axis in (field.borders.x, field.borders.y):
        half = 0.5 * np.diff(axis)
        places.append((0.5 * (axis[1:] + axis[:-1])[:, None] + half[:, None] * root).ravel())
        weights.append((half[:, None] * weight).ravel())
    x, y = (place.ravel() for place in np.meshgrid(*places, indexing="ij"))
    area = np.outer(*weights).ravel()
    points = np.stack([np.tile(x, len(station)), np.tile(y, len(station)), np.repeat(station, len(x))])
    _, _, ss, ys, xs, _ = stress(field, material, points).reshape(6, len(station), len(x))
    return np.stack([ss @ area, xs @ area, ys @ area, ss @ (area * y), -ss @ (area * x), (ys * x - xs * y) @ area])
