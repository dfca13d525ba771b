"""Scenes of the verification checks: one rod, clamped at its start, with short elements at both ends."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

import rodmodel
from cases.scene import (
    CentreLine,
    Clamp,
    Helix,
    Line,
    Load,
    Material,
    Rod,
    Scene,
    Section,
    SectionForce,
    SectionMoment,
    Vector,
)

ROD = "rod"
STEEL = Material(200e3, 0.3)
WITHOUT_CONTRACTION = Material(200e3, 0.0)
# Lengths, in section sizes, from which rods are long
LONG = 10.0


def borders(length: float, size: float, elements: int) -> tuple[float, ...]:
    """Element borders with short elements at both ends: at 0.2, 1 and, in long rods, 3 times `size`.

    Between these, `elements` equal ones. What clamp and load disturb dies away over about one section height; elements
    of these sizes resolve it.
    """
    near = np.array([0.0, 0.2, 1.0] if length < LONG * size else [0.0, 0.2, 1.0, 3.0]) * size
    between = np.linspace(near[-1], length - near[-1], elements + 1)[1:-1]
    return tuple(np.concatenate([near, between, length - near[::-1]]).tolist())


def straight(length: float, twist: float = 0.0) -> Line:
    """Straight centre line along X, e2 along Y at its start, so that the sections' x runs along -Z."""
    return Line((0.0, 0.0, 0.0), (length, 0.0, 0.0), (0.0, 1.0, 0.0), twist)


def arc(radius: float, angle: float) -> Helix:
    """Arc about Z from (radius, 0, 0), e2 pointing outwards along the radius."""
    return Helix((radius, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), angle, (1.0, 0.0, 0.0))


def clamped(
    line: CentreLine,
    section: Section,
    material: Material,
    size: float,
    elements: int,
    loads: tuple[Load, ...],
) -> Scene:
    """A rod clamped at its start; `size` is the section's larger side, `elements` those between the short ones."""
    rod = Rod(ROD, line, section, material, borders(line.length, size, elements))
    return Scene("verification", (rod,), (Clamp(ROD, "start"),), loads, ())


def end_force(line: CentreLine, force: Vector) -> tuple[Load, ...]:
    """A force on the end section."""
    return (SectionForce(ROD, line.length, force),)


def end_moment(line: CentreLine, moment: Vector) -> tuple[Load, ...]:
    """A moment on the end section."""
    return (SectionMoment(ROD, line.length, moment),)


def work(scene: Scene, level: int, order: int) -> float:
    """Work that the loads, put on at once, do on their own displacements, N mm; twice the strain energy.

    Under one load of size one it is the displacement or rotation that goes with the load.
    """
    return 2.0 * rodmodel.solve(scene, level, order).strain_energy


def rate(scene: Callable[[float], Scene], extents: tuple[float, float], level: int, order: int) -> float:
    """Work per unit of extent (a length, an angle), from two rods that differ in nothing else.

    What clamp and load disturb is the same in both and cancels where the resultants do not change along the rod.
    """
    short, long = (work(scene(extent), level, order) for extent in extents)
    return (long - short) / (extents[1] - extents[0])
