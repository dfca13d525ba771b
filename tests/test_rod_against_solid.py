"""The rod model and the 3D reference on the same scenes: what neither has a closed form for, held against the other."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import pytest

import reference3d
import rodmodel
from cases.scene import (
    Bed,
    CentreLine,
    Circle,
    Clamp,
    Gravity,
    Helix,
    Joint,
    Line,
    LineLoad,
    Load,
    Material,
    Orthotropic,
    Path,
    Polygon,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    Section,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
)
from reports.verification.scenes import borders

pytestmark = pytest.mark.slow

STEEL = Material(200e3, 0.3, 7.85e-9)
WOOD = Orthotropic((900.0, 500.0, 12000.0), (700.0, 800.0, 60.0), (0.4, 0.03, 0.02))
CLAMPED = (Clamp("rod", "start"),)
LEVEL, ORDER = 6, 6


def one_rod(
    line: CentreLine,
    section: Section,
    size: float,
    loads: tuple[Load, ...],
    material: Material | Orthotropic = STEEL,
    supports: tuple[Clamp | Support, ...] = CLAMPED,
    beds: tuple[Bed, ...] = (),
    at: tuple[float, ...] = (),
    elements: int = 12,
) -> Scene:
    """One rod with elements that end where something acts (`at`), `elements` between the short ones at its ends."""
    rod = Rod("rod", line, section, material, tuple(sorted({*borders(line.length, size, elements), *at})))
    return Scene("both ways", (rod,), supports, loads, (), (), beds)


def spline() -> Scene:
    """A smooth line through points, whose section does not turn about it, pulled aside."""
    points = ((0.0, 0.0, 0.0), (50.0, 10.0, 0.0), (100.0, 0.0, 20.0), (130.0, 40.0, 60.0), (150.0, 100.0, 60.0))
    line = Spline(points, (0.0, 0.0, 1.0))
    load = SectionForce("rod", line.length, (3.0, 5.0, 10.0))
    return one_rod(line, Rectangle(8.0, 12.0), 12.0, (load,), elements=24)


def heavy_helix() -> Scene:
    """A turn of round wire that hangs from its upper end."""
    line = Helix((40.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 2.0 * math.pi, (0.0, 0.0, 1.0), -20.0)
    return one_rod(line, Circle(8.0), 8.0, (Gravity("rod", (0.0, 0.0, -9810.0)),))


def pressed_path() -> Scene:
    """A straight piece that goes over into an arc, pressed on its top and clamped at both ends, one of them moved."""
    arc = Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), math.pi / 2.0, (0.0, 0.0, 1.0))
    line = Path((Line((100.0, -60.0, 0.0), (100.0, 0.0, 0.0), (0.0, 0.0, 1.0)), arc))
    supports = (Clamp("rod", "start"), Clamp("rod", "end", (0.0, 0.0, 0.05), (0.001, 0.0, 0.0)))
    load = Pressure(RodFace("rod", "top"), 60.0, 120.0, 0.5)
    return one_rod(line, Rectangle(12.0, 8.0), 12.0, (load,), supports=supports, at=(60.0, 120.0))


def wooden_bar() -> Scene:
    """A twisted bar of wood under a force, a moment and a line load."""
    line = Line((0.0, 0.0, 0.0), (200.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.8)
    loads = (
        SectionForce("rod", 200.0, (5.0, -10.0, 3.0)),
        SectionMoment("rod", 200.0, (200.0, 30.0, 50.0)),
        LineLoad("rod", 0.0, 200.0, (0.0, 0.01, 0.02)),
    )
    return one_rod(line, Rectangle(10.0, 20.0), 20.0, loads, WOOD)


def wedge_on_supports() -> Scene:
    """A triangular bar held by the mean of two sections, one of which is set down and turned."""
    line = Line((0.0, 0.0, 0.0), (200.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    supports = (
        Support("rod", 0.0, ("x", "y", "s", "turn s"), "mean"),
        Support("rod", 150.0, ("x", "y", "turn s"), "mean", (0.0, -0.02, 0.003)),
    )
    section = Polygon(((0.0, 0.0), (20.0, 0.0), (0.0, 15.0)))
    near = (147.0, 150.0, 153.0)
    return one_rod(line, section, 20.0, (SectionForce("rod", 200.0, (0.0, -50.0, 0.0)),), STEEL, supports, at=near)


def bar_on_bed() -> Scene:
    """A twisted bar half of whose bottom lies on a bed."""
    line = Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 1.0, 0.0), 0.5)
    bed = Bed(RodFace("rod", "bottom"), 150.0, 300.0, 2.0)
    load = SectionForce("rod", 300.0, (0.0, -200.0, 20.0))
    return one_rod(line, Rectangle(12.0, 8.0), 12.0, (load,), beds=(bed,), at=(150.0,))


def frame() -> Scene:
    """Three rods that meet in a rigid joint: a bar, a tube and an arc."""
    meeting = (0.0, 150.0, 0.0)
    post = Line((0.0, 0.0, 0.0), meeting, (0.0, 0.0, 1.0))
    beam = Line(meeting, (120.0, 150.0, 30.0), (0.0, 1.0, 0.0))
    arc = Helix(meeting, (0.0, 150.0, 80.0), (1.0, 0.0, 0.0), math.pi / 2.0, (1.0, 0.0, 0.0))
    rods = tuple(
        Rod(name, line, section, STEEL, borders(line.length, 12.0, 4))
        for name, line, section in (
            ("post", post, Rectangle(12.0, 10.0)),
            ("rod", beam, Ring(12.0, 6.0)),
            ("arc", arc, Circle(10.0)),
        )
    )
    ends = (RodEnd("post", "end"), RodEnd("rod", "start"), RodEnd("arc", "start"))
    supports = (Clamp("post", "start"), Support("arc", arc.length, ("x", "y", "s"), "mean"))
    load = SectionForce("rod", beam.length, (30.0, -100.0, 20.0))
    return Scene("both ways", rods, supports, (load,), (), (Joint(ends),))


@dataclass(frozen=True)
class Pair:
    """A scene and how far the two solutions may be apart: h6 and the default mesh leave this much."""

    scene: Callable[[], Scene]
    tolerance: float


PAIRS = (
    Pair(spline, 1e-3),
    Pair(heavy_helix, 1e-3),
    Pair(pressed_path, 1e-3),
    Pair(wooden_bar, 1e-3),
    Pair(wedge_on_supports, 1e-3),
    Pair(bar_on_bed, 1e-3),
    Pair(frame, 2e-3),
)


@pytest.mark.parametrize("pair", PAIRS, ids=lambda pair: pair.scene.__name__)
def test_energy_displacements_and_reactions_agree(pair: Pair) -> None:
    scene = pair.scene()

    rod, solid = rodmodel.solve(scene, LEVEL, ORDER), reference3d.solve(scene)

    assert (rod.outcome, solid.outcome) == ("converged", "converged")
    assert rod.strain_energy == pytest.approx(solid.strain_energy, rel=2.0 * pair.tolerance)
    for each in scene.rods:
        station = np.linspace(0.0, each.length, 9)
        moved = solid.displacement(each.name, station)
        apart = np.abs(rod.displacement(each.name, station) - moved).max()
        assert apart < pair.tolerance * np.abs(moved).max(), each.name
        # off what loads and holds, where resultants jump
        station = np.linspace(0.0, each.length, 9)[2:-2] + 0.013 * each.length
        resultants = solid.section_resultants(each.name, station)
        apart = np.abs(rod.section_resultants(each.name, station) - resultants)
        # forces by the length of the section they would bend over
        scale = np.repeat([1.0, each.length], 3)[:, None]
        # both integrate stress, which converges slower than displacement
        assert (apart / scale).max() < 10.0 * pair.tolerance * np.abs(resultants / scale).max(), each.name
    for support in scene.supports:
        station = support.position if isinstance(support, Support) else 0.0 if support.end == "start" else None
        at = scene.rod(support.rod).length if station is None else station
        held, carried = rod.reaction(support.rod, at), solid.reaction(support.rod, at)
        np.testing.assert_allclose(held[:3], carried[:3], atol=pair.tolerance * np.abs(carried[:3]).max() + 1e-4)
    for number, bed in enumerate(scene.beds):
        ends = np.array([bed.start, bed.end])
        pushed = [each.bed_forces(number, ends).force.sum(axis=1) for each in (rod, solid)]
        np.testing.assert_allclose(*pushed, atol=pair.tolerance * np.abs(pushed[1]).max())
