"""Level up to h12: functions orthonormal over the section against raw monomials."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cases.scene import Rectangle
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.wording import number
from reports.verification.scenes import STEEL
from rodmodel.section import (
    STRAIGHT,
    Fields,
    SectionStiffness,
    V,
    product_quadrature,
    section_stiffness,
    section_values,
)
from rodmodel.stiffness import stiffness_terms

Array = NDArray[np.float64]

LEVELS = tuple(float(level) for level in range(1, 13))
SIDE, LENGTH, ORDER = 15.0, 30.0, 3
RAW = Method("monomials in mm", ours=False)
SCALED = Method("monomials of half sides", ours=False)
OURS = Method("orthonormal (rodmodel)")
SECTION = Rectangle(SIDE, SIDE)


def measure(values: tuple[float, ...]) -> Found:
    """Conditions of S_11 and of an element clamped at one end, and what becomes of its deflection."""
    section: dict[str, list[float]] = {method.name: [] for method in (RAW, SCALED, OURS)}
    element: dict[str, list[float]] = {name: [] for name in section}
    wrong: dict[str, list[float]] = {name: [] for name in section}
    factored: dict[str, list[float]] = {name: [] for name in section}
    for value in values:
        fields = Fields(int(value), mirror_x=True)
        own = section_stiffness(SECTION, STEEL, fields, STRAIGHT)
        exact = 0.0
        for method in (OURS, SCALED, RAW):
            change = (
                np.eye(fields.count) if method is OURS else _monomials(fields, 1.0 if method is RAW else 0.5 * SIDE)
            )
            changed = SectionStiffness(*(change.T @ each @ change for each in (own.s00, own.s01, own.s11)))
            stiffness = _clamped_element(changed)
            section[method.name].append(_condition(changed.s11))
            element[method.name].append(_condition(stiffness))
            factored[method.name].append(_has_factor(stiffness))
            deflection = _end_deflection(stiffness, fields, change)
            exact = deflection if method is OURS else exact
            wrong[method.name].append(max(abs(deflection / exact - 1.0), np.finfo(float).eps / 2.0))
    return {
        "section": {name: curve(values, found) for name, found in section.items()},
        "element": {name: curve(values, found) for name, found in element.items()},
        "deflection": {name: curve(values, found) for name, found in wrong.items() if name != OURS.name},
        "factored": {name: curve(values, found) for name, found in factored.items()},
    }


def _monomials(fields: Fields, unit: float) -> Array:
    """Coefficients of (x / unit)^i (y / unit)^j in the orthonormal functions, columns by field."""
    x, y, weight = product_quadrature(SECTION, fields.level, STRAIGHT)
    values = section_values(SECTION, fields, x, y)
    component, i, j = fields.table
    powers = (x / unit) ** i[:, None] * (y / unit) ** j[:, None]
    same = component[:, None] == component
    return np.asarray(np.where(same, (values * (weight / weight.sum())) @ powers.T, 0.0))


def _clamped_element(section: SectionStiffness) -> Array:
    """Stiffness of one element without its first node, shape (n, n)."""
    scale = np.array([0.5 * LENGTH, 1.0, 2.0 / LENGTH])
    return np.asarray(
        np.tensordot(scale, stiffness_terms(ORDER, section), axes=1)[len(section.s00) :, len(section.s00) :]
    )


def _end_deflection(stiffness: Array, fields: Fields, change: Array) -> float:
    """Mean deflection of the free end under a unit force spread over it, in functions that `change` makes."""
    mean = fields.index(V, 0, 0)
    assert mean is not None
    load = np.zeros(len(stiffness))
    load[: fields.count] = change[mean]
    return float(load @ np.linalg.solve(stiffness, load))


def _has_factor(stiffness: Array) -> float:
    """1 if Cholesky's factorisation, which the rod model lives by, goes through; 0 if a pivot turns negative."""
    try:
        np.linalg.cholesky(stiffness)
    except np.linalg.LinAlgError:
        return 0.0
    return 1.0


def _condition(matrix: Array) -> float:
    """Condition number as floating point gives it; beyond about 10^17 it only says 'singular'."""
    return float(np.linalg.cond(matrix))


def claim(found: Found) -> str:
    """Monomials die."""
    section, element, wrong = found["section"], found["element"], found["deflection"]
    top = section[OURS.name].x[-1]
    return (
        f"S₁₁, the section's part of the stiffness, has the condition {number(section[OURS.name].y[-1])} at h{top:.0f} "
        "in the rod model's functions, the same from h2 on. In monomials of the half side it grows to "
        f"{number(section[SCALED.name].y[-1])}, in monomials of mm to {number(section[RAW.name].y[-1])}; a whole "
        f"clamped element has {number(element[OURS.name].y[-1])}, {number(element[SCALED.name].y[-1])} and "
        f"{number(element[RAW.name].y[-1])}. Yet the deflection suffers little: it differs by "
        f"{number(wrong[SCALED.name].largest)} and {number(wrong[RAW.name].largest)}. Most of the condition in mm is "
        f"units, which factorisation does not mind, and Cholesky's {_broken(found)}; an iterative solver would not "
        "forgive it."
    )


def _broken(found: Found) -> str:
    factored = found["factored"][RAW.name]
    levels = [level for level, whole in zip(factored.x, factored.y, strict=True) if not whole]
    return f"breaks down only from h{levels[0]:.0f} on" if levels else f"goes through up to h{factored.x[-1]:.0f}"


def own_limit(found: Found) -> str:
    """Thin walls."""
    element = found["element"][OURS.name]
    return (
        f"The condition of an element grows with the level as well, from {number(element.y[0])} to "
        f"{number(element.y[-1])}: higher functions are stiffer. On sections with thin walls or arms orthonormality "
        "itself is lost; it is measured when the functions are made, and refused where the loss exceeds 10⁻⁸."
    )


def holds(found: Found) -> bool:
    """Ours keeps its condition, monomials do not."""
    section, element = found["section"], found["element"]
    same = max(section[OURS.name].y[1:]) < 1.001 * min(section[OURS.name].y[1:])
    worse = section[SCALED.name].y[-1] > 1e3 * section[OURS.name].y[-1] and section[RAW.name].y[-1] > 1e8
    return (
        same
        and worse
        and all(found["factored"][OURS.name].y)
        and element[OURS.name].y[-1] < 1e-2 * element[RAW.name].y[-1]
    )


SWEEP = Sweep(
    "Level",
    "Square section of 15 mm: the level from h1 to h12, in the rod model's orthonormal functions and in monomials "
    "xⁱ yʲ. Conditions as floating point gives them.",
    LEVELS,
    (RAW, SCALED, OURS),
    (
        Picture("section", "S₁₁", "level", "condition", log_x=False),
        Picture("element", "Clamped element, p = 3", "level", "condition", log_x=False),
        Picture(
            "deflection",
            "Deflection of that element's end",
            "level",
            "difference from rodmodel",
            log_x=False,
        ),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
