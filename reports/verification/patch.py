"""Patch tests: states of constant strain and of pure bending, which every level from h2 on must hold exactly.

A clamp would disturb them, so that here one element floats free under tractions in equilibrium on its two ends. Its
stiffness has the six rigid motions for a null space and is inverted on the rest.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material, Rectangle
from reports.verification.check import Check, Group, Reference, elasticity
from rodmodel.axial import shape_functions
from rodmodel.resultants import even_traction, linear_traction
from rodmodel.section import STRAIGHT, Fields, U, V, W, section_stiffness, section_values
from rodmodel.stiffness import stiffness_terms

Array = NDArray[np.float64]

SECTION = Rectangle(15.0, 10.0)
AREA, SECOND_MOMENT = 15.0 * 10.0, 15.0 * 10.0**3 / 12.0
MATERIAL = Material(200e3, 0.3)
LENGTH = 40.0
# v is quadratic along s in pure bending
ORDER = 2
# smaller singular values, relative to the largest, belong to rigid motions
RIGID = 1e-11
EXACT = 1e-9


@dataclass(frozen=True, eq=False)
class FreeElement:
    """One element under tractions in equilibrium on its ends.

    Attributes
    ----------
    work : of the tractions on the displacement, N mm
    coefficients : degrees of freedom, shape (order + 1, n_fields)
    """

    fields: Fields
    work: float
    coefficients: Array

    def displacement(self, component: int, x: float, y: float, xi: float) -> float:
        """A local displacement component, mm, at (x, y) mm and xi in [-1, 1]."""
        over = section_values(SECTION, self.fields, np.array([x]), np.array([y]))[:, 0]
        along = shape_functions(ORDER, np.array([xi]))[:, 0]
        mine = self.fields.indices(component)
        return float(along @ self.coefficients[:, mine] @ over[mine])


def free_element(level: int, bending: bool) -> FreeElement:
    """The element under unit force (tension) or unit moment about e1 (pure bending)."""
    fields = Fields(level)
    terms = stiffness_terms(ORDER, section_stiffness(SECTION, MATERIAL, fields, STRAIGHT))
    stiffness = np.tensordot([0.5 * LENGTH, 1.0, 2.0 / LENGTH], terms, axes=1)
    traction = linear_traction(SECTION, fields)[0] if bending else even_traction(fields)[2]
    load = np.zeros((ORDER + 1, fields.count))
    load[0], load[1] = -traction, traction
    found = np.linalg.lstsq(stiffness, load.ravel(), rcond=RIGID)[0]
    return FreeElement(fields, float(load.ravel() @ found), found.reshape(load.shape))


def elongation(level: int) -> float:
    """Work of the unit force, the elongation."""
    return free_element(level, bending=False).work


def contraction(level: int) -> float:
    """Contraction of the width per elongation of the length, in the middle of the element."""
    element, edge = free_element(level, bending=False), SECTION.width / 2.0
    across = element.displacement(U, edge, 0.0, 0.0) - element.displacement(U, -edge, 0.0, 0.0)
    along = element.displacement(W, 0.0, 0.0, 1.0) - element.displacement(W, 0.0, 0.0, -1.0)
    return -(across / SECTION.width) / (along / LENGTH)


def rotation(level: int) -> float:
    """Work of the unit moment, the rotation of one end against the other."""
    return free_element(level, bending=True).work


def anticlastic_curvature(level: int) -> float:
    """Curvature of the section's middle line against that of the rod, from second differences of v."""
    element, edge = free_element(level, bending=True), SECTION.width / 2.0

    def v(x: float, xi: float) -> float:
        return element.displacement(V, x, 0.0, xi)

    across = (v(edge, 0.0) - 2.0 * v(0.0, 0.0) + v(-edge, 0.0)) / edge**2
    along = (v(0.0, 1.0) - 2.0 * v(0.0, 0.0) + v(0.0, -1.0)) / (LENGTH / 2.0) ** 2
    return -across / along


GROUP = Group(
    "Patch tests",
    "One free element of 15 x 10 x 40 mm under end tractions in equilibrium; p = 2, nu = 0.3. Exact from h2 on. h1 "
    "has the reduced law, which cannot tell how the section contracts.",
    (
        Check(
            "Tension: elongation",
            "A state of constant strain is held exactly: F L / (E A).",
            "closed form",
            elasticity(99),
            "mm",
            lambda: Reference(LENGTH / (MATERIAL.young_modulus * AREA)),
            elongation,
            EXACT,
            2,
        ),
        Check(
            "Tension: lateral contraction",
            "The section contracts freely by Poisson's ratio.",
            "closed form",
            elasticity(99),
            "",
            lambda: Reference(MATERIAL.poisson_ratio),
            contraction,
            EXACT,
            2,
        ),
        Check(
            "Pure bending: rotation",
            "Pure bending is held exactly: M L / (E I).",
            "closed form",
            elasticity(102),
            "rad",
            lambda: Reference(LENGTH / (MATERIAL.young_modulus * SECOND_MOMENT)),
            rotation,
            EXACT,
            2,
        ),
        Check(
            "Pure bending: anticlastic curvature",
            "The section curves across by Poisson's ratio times the curvature along.",
            "closed form",
            elasticity(102),
            "",
            lambda: Reference(MATERIAL.poisson_ratio),
            anticlastic_curvature,
            EXACT,
            2,
        ),
    ),
)
