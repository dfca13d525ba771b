"""The rod model and the 3D reference on rods in contact that are curved or held by nothing else."""

from __future__ import annotations

import math

import numpy as np
import pytest

import reference3d
import rodmodel
from cases.scene import (
    Clamp,
    Component,
    ContactPair,
    Helix,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SectionForce,
    Support,
)

pytestmark = pytest.mark.slow

STEEL = Material(200e3, 0.3)
UP = (0.0, 1.0, 0.0)


def arch_on_a_bar() -> Scene:
    """An arch on a pin and a roller whose middle is pressed on a bar on a pin and a roller, drawn touching it."""
    radius, half, height = 80.0, 0.5, 12.0
    centre = 100.0 / 2.0, height + radius, 0.0
    start = centre[0] - radius * math.sin(half), centre[1] - radius * math.cos(half), 0.0
    line = Helix(start, centre, (0.0, 0.0, 1.0), 2.0 * half, UP)
    middle = 0.5 * line.length
    near = np.array([-5.0, -2.0, -1.0, 0.0, 1.0, 2.0, 5.0])
    section = Rectangle(8.0, height)
    rods = (
        Rod(
            "lower",
            Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), UP),
            section,
            STEEL,
            (0, 20, 40, *(50.0 + near), 60, 80, 100),
        ),
        Rod("upper", line, section, STEEL, (0, 0.5 * middle, *(middle + near), 1.5 * middle, line.length)),
    )
    pair = ContactPair("touch", RodFace("lower", "top"), RodFace("upper", "bottom"), (45.0, 55.0), "drawn")
    pin: tuple[Component, ...] = ("x", "y", "s", "turn s")
    roller: tuple[Component, ...] = ("x", "y")
    supports = tuple(
        Support(rod.name, station, components, "mean")
        for rod in rods
        for station, components in ((0.0, pin), (rod.length, roller))
    )
    return Scene("arch", rods, supports, (SectionForce("upper", middle, (0.0, -300.0, 0.0)),), (pair,))


def leaf_between_leaves() -> Scene:
    """A short leaf between two long, clamped ones: it is kept from sliding and otherwise held by contact alone."""
    ends = (0.0, 2.0, 10.0, 40.0, 60.0, 80.0, 100.0, 120.0, 140.0, 160.0, 190.0, 198.0, 200.0)
    rods = tuple(
        Rod(name, Line((start, height, 0.0), (end, height, 0.0), UP), Rectangle(10.0, 10.0), STEEL, borders)
        for name, start, end, height, borders in (
            ("lower", 0.0, 200.0, 0.0, ends),
            ("between", 60.0, 140.0, 10.0, (0.0, 5.0, 20.0, 40.0, 60.0, 75.0, 80.0)),
            ("upper", 0.0, 200.0, 20.0, ends),
        )
    )
    pairs = (
        ContactPair("touch", RodFace("between", "bottom"), RodFace("lower", "top"), (0.0, 80.0), 0.0),
        ContactPair("above", RodFace("between", "top"), RodFace("upper", "bottom"), (0.0, 80.0), 0.0),
    )
    supports = (
        *(Clamp(name, "start") for name in ("lower", "upper")),
        *(Clamp(name, "end") for name in ("lower", "upper")),
        Support("between", 40.0, ("s",), "mean"),
    )
    return Scene("between", rods, supports, (SectionForce("upper", 120.0, (0.0, -1000.0, 0.0)),), pairs)


# Where rods touch along a line they yield in 3D more than polynomials over a section of this level can, and the nodes
# in contact are few: 0.5 % of the arch's force. Leaves on one another are 0.02 % apart.
@pytest.mark.parametrize(
    ("scene", "tolerance"),
    [(arch_on_a_bar(), 1e-2), (leaf_between_leaves(), 1e-3)],
    ids=lambda each: each.name if isinstance(each, Scene) else "",
)
def test_contact_force_energy_and_displacements_agree(scene: Scene, tolerance: float) -> None:
    rod, solid = rodmodel.solve(scene, 7, 6), reference3d.solve(scene)

    assert (rod.outcome, solid.outcome) == ("converged", "converged")
    pressed = [each.contact_points("touch").force.sum() for each in (rod, solid)]
    assert pressed[0] == pytest.approx(pressed[1], rel=tolerance)
    assert rod.strain_energy == pytest.approx(solid.strain_energy, rel=tolerance)
    for each in scene.rods:
        station = np.linspace(0.0, each.length, 9)
        moved = solid.displacement(each.name, station)
        apart = np.abs(rod.displacement(each.name, station) - moved).max()
        assert apart < tolerance * np.abs(moved).max(), each.name
