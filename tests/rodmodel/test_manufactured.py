"""Manufactured solution on a curved, twisted rod: rates of convergence in order and element length.

Every field of a helical rod is given a smooth course psi*(s) that vanishes at the clamp; the loads that make it the
solution are those of the weak form, f(v) = a(u*, v), integrated to round-off. Galerkin's orthogonality makes the square
of the error in energy a(u*, u*) - f(u_h).
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

import rodmodel as rm
from rodmodel.assembly import ElementStore, Part, assembled_rod, compliance, functionals
from rodmodel.axial import gauss, shape_function_slopes, shape_functions
from rodmodel.centre_line import darboux
from rodmodel.mesh import RodMesh
from rodmodel.section import Fields, section_stiffness

LEVEL = 2
LINE = rm.Helix((30.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.5, (0.3, 0.0, 1.0), pitch=60.0)
ROD = rm.Rod("coil", LINE, rm.Rectangle(10.0, 6.0), rm.Material(1.0, 0.3), (0.0, LINE.length))
SCENE = rm.Scene("manufactured", (ROD,), (rm.Clamp("coil", "start"),), (), ())
SECTION = section_stiffness(ROD.section, ROD.material, Fields(LEVEL), darboux(LINE))

# Each field its own amplitude and about one wave along the rod.
_RNG = np.random.default_rng(6)
AMPLITUDE = _RNG.uniform(0.5, 1.5, Fields(LEVEL).count)
WAVE = _RNG.uniform(4.0, 8.0, Fields(LEVEL).count) / LINE.length


def course(station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """psi* and its slope, shape (n_fields, n)."""
    phase = np.outer(WAVE, station)
    return AMPLITUDE[:, None] * np.sin(phase), (AMPLITUDE * WAVE)[:, None] * np.cos(phase)


def forces(station: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """What the energy's derivatives by psi and psi' are for psi*."""
    value, slope = course(station)
    return SECTION.s00 @ value + SECTION.s01 @ slope, SECTION.s01.T @ value + SECTION.s11 @ slope


def relative_error(n_elements: int, order: int) -> float:
    """Error in the energy norm relative to the norm of the solution."""
    borders = np.linspace(0.0, LINE.length, n_elements + 1)
    mesh = RodMesh(borders, np.full(n_elements, LEVEL), np.full(n_elements, order))
    assembled = assembled_rod(SCENE, ROD, (False, False), mesh, ElementStore())
    xi, weight = gauss(30)
    parts, energy = [], 0.0
    for index, (left, right) in enumerate(pairwise(borders)):
        half = 0.5 * (right - left)
        station = 0.5 * (left + right) + half * xi
        by_value, by_slope = forces(station)
        values = shape_functions(order, xi) * (half * weight) @ by_value.T
        values += shape_function_slopes(order, xi) * weight @ by_slope.T
        parts.append(Part(index, np.array([0]), values[:, :, None]))
        value, slope = course(station)
        energy += float(((value * by_value + slope * by_slope) * (half * weight)).sum())
    work = float(compliance(functionals(assembled, parts, 1))[0, 0])
    return float(np.sqrt(max(energy - work, 0.0) / energy))


def test_error_falls_exponentially_with_the_order() -> None:
    """On two elements every order more takes at least a factor of 2, down to the root of round-off."""
    errors = np.array([relative_error(2, order) for order in range(2, 11)])
    assert (errors[1:] < 0.5 * errors[:-1]).all()
    assert errors[-1] < 1e-6


@pytest.mark.parametrize("order", [2, 3, 4])
def test_error_falls_with_the_order_th_power_of_the_element_length(order: int) -> None:
    rate = np.log2(relative_error(16, order) / relative_error(32, order))
    assert rate == pytest.approx(order, abs=0.1)  # higher terms of the error on the coarser mesh
