"""Rods for which neither closed forms nor published values are near enough, held against 3D of the same run."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from cases.scene import Helix, Load, Rectangle, Scene, SectionForce, SectionMoment
from reports.verification.bending import solid_work
from reports.verification.check import Check, Group, Reference
from reports.verification.scenes import ROD, STEEL, clamped, work

ORDER = 6
RADIUS, WIRE, PITCH = 30.0, 10.0, 20.0


def half_turn() -> Scene:
    """Half a turn of a spring about Z, clamped at one end, under a unit force on its axis, carried to the other end."""
    line = Helix((RADIUS, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi, (0.0, 0.0, 1.0), PITCH)
    force = (0.0, 0.0, 1.0)
    x, y, z = np.cross([RADIUS, 0.0, 0.0], force).tolist()
    loads: tuple[Load, ...] = (SectionForce(ROD, line.length, force), SectionMoment(ROD, line.length, (x, y, z)))
    return clamped(line, Rectangle(WIRE, WIRE), STEEL, WIRE, 4, loads)


def spring(level: int) -> float:
    """Elongation per unit force, mm/N."""
    return work(half_turn(), level, ORDER)


@cache
def spring_reference() -> Reference:
    """The same in 3D on three meshes."""
    return solid_work(half_turn())


GROUP = Group(
    "3D of this run",
    "Both models solve the same scene; the reference is extrapolated from three meshes, with the uncertainty that they "
    "show (ASME V&V 20). p = 6.",
    (
        Check(
            "Helical spring, square wire, against 3D",
            "Half a turn of index 6, so stout that Wahl's formula is 0.7 % off: torsion, bending, shear and curvature.",
            "3d converged",
            "27-node hexahedra along the helix, by reference3d in this run",
            "mm/N",
            spring_reference,
            spring,
            2e-3,
            6,
        ),
    ),
)
