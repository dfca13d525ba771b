"""Rods of the hierarchic model with what it leaves out on purpose: h1 with the full law of elasticity, and order 1."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material, Section
from rodmodel.section import STRAIGHT, Darboux, Fields, SectionStiffness, V, section_stiffness
from rodmodel.stiffness import stiffness_terms

Array = NDArray[np.float64]


def full_law(section: Section, material: Material, fields: Fields, turning: Darboux = STRAIGHT) -> SectionStiffness:
    """Section stiffness with the full law at any level, h1 included: that of the level above, restricted."""
    above = Fields(fields.level + 1, fields.mirror_x, fields.mirror_y)
    place = fields.within(above)
    whole = section_stiffness(section, material, above, turning)
    chosen = np.ix_(place, place)
    return SectionStiffness(whole.s00[chosen], whole.s01[chosen], whole.s11[chosen])


def end_deflection(section: SectionStiffness, fields: Fields, order: int, borders: Array) -> float:
    """Mean deflection along e2 of a clamped rod's end under a unit force there, mm/N; all unknowns solved densely."""
    count, nodes = fields.count, len(borders)
    bubbles = (order - 1) * count
    size = nodes * count + (nodes - 1) * bubbles
    stiffness = np.zeros((size, size))
    terms = stiffness_terms(order, section)
    for element, length in enumerate(np.diff(borders)):
        inner = nodes * count + element * bubbles + np.arange(bubbles)
        place = np.concatenate([element * count + np.arange(2 * count), inner])
        scale = np.array([0.5 * length, 1.0, 2.0 / length])
        stiffness[np.ix_(place, place)] += np.tensordot(scale, terms, axes=1)
    mean = fields.index(V, 0, 0)
    assert mean is not None  # no mirror makes a deflection along e2 vanish but that in y = 0
    end = (nodes - 1) * count + mean
    load = np.zeros(size)
    load[end] = 1.0
    return float(np.linalg.solve(stiffness[count:, count:], load[count:])[end - count])
