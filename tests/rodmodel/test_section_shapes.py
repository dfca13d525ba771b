"""Rods of every section against closed forms of torsion and bending, computed here from their formulas."""

from __future__ import annotations

import numpy as np
import pytest

import rodmodel as rm
from rodmodel.adapt import graded
from rodmodel.section_properties import section_properties

YOUNG, POISSON, LENGTH = 200e3, 0.3, 400.0
SHEAR = YOUNG / (2.0 * (1.0 + POISSON))
SIDE = 12.0
TRIANGLE = rm.Polygon(((0.0, 0.0), (SIDE, 0.0), (SIDE / 2.0, SIDE * np.sqrt(0.75))))
ANGLE = rm.Polygon(((0.0, 0.0), (20.0, 0.0), (20.0, 4.0), (4.0, 4.0), (4.0, 30.0), (0.0, 30.0)))


def cantilever(section, *loads, poisson: float = POISSON) -> rm.Scene:
    rod = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0)),
        section,
        rm.Material(YOUNG, poisson),
        (0.0, 100.0, 250.0, LENGTH),
    )
    return graded(rm.Scene("bar", (rod,), (rm.Clamp("bar", "start"),), loads, ()))


def work(scene: rm.Scene, level: int) -> float:
    """Twice the energy: the load times its own displacement."""
    return 2.0 * rm.solve(scene, level=level, order=5).strain_energy


def square_torsion(a: float, b: float) -> float:
    """Torsion constant of a rectangle with sides a >= b (Timoshenko and Goodier, section 109)."""
    n = np.arange(1, 61, 2)
    return (
        a * b**3 / 3.0 * (1.0 - 192.0 * b / (np.pi**5 * a) * float((np.tanh(n * np.pi * a / (2.0 * b)) / n**5).sum()))
    )


@pytest.mark.parametrize(
    ("section", "level", "constant", "error"),
    [
        (rm.Circle(10.0), 1, np.pi * 10.0**4 / 32.0, 1e-9),
        (rm.Ring(10.0, 7.0), 1, np.pi * (10.0**4 - 7.0**4) / 32.0, 1e-9),
        # the warping of the triangle is a cubic; the clamp holds it over the length of one side, 1/30 of the rod
        (TRIANGLE, 3, np.sqrt(3.0) * SIDE**4 / 80.0, 1e-2),
        (rm.Rectangle(10.0, 10.0), 4, square_torsion(10.0, 10.0), 1e-2),
        (rm.Rectangle(20.0, 10.0), 6, square_torsion(20.0, 10.0), 2e-2),
    ],
)
def test_torsion(section, level: int, constant: float, error: float) -> None:
    """T^2 L / (G J)."""
    load = rm.SectionMoment("bar", LENGTH, (1000.0, 0.0, 0.0))
    expected = 1000.0**2 * LENGTH / (SHEAR * constant)
    found = work(cantilever(section, load), level)
    assert found == pytest.approx(expected, rel=error)
    assert found < expected * (1.0 + 1e-9)  # a displacement method with held warping is stiff


@pytest.mark.parametrize(
    "section",
    [rm.Circle(20.0), rm.Ring(20.0, 16.0), rm.Box(20.0, 30.0, 2.0), TRIANGLE, rm.Rectangle(7.0, 19.0)],
    ids=["circle", "ring", "box", "triangle", "rectangle"],
)
def test_pure_bending(section) -> None:
    """M^2 L / (E I), exact without Poisson's effect."""
    load = rm.SectionMoment("bar", LENGTH, (0.0, 0.0, 1000.0))
    second = section_properties(section, 2).second_moment_x
    expected = 1000.0**2 * LENGTH / (YOUNG * second)
    assert work(cantilever(section, load, poisson=0.0), 2) == pytest.approx(expected, rel=1e-9)


def test_an_angle_bends_obliquely() -> None:
    """Load along Y on an L: the deflection of its centroid by the tensor of second moments, in both directions."""
    load = rm.SectionMoment("bar", LENGTH, (0.0, 0.0, 1000.0))
    solution = rm.solve(cantilever(ANGLE, load, poisson=0.0), level=2, order=4)
    properties = section_properties(ANGLE, 2)
    tensor = np.array(
        [
            [properties.second_moment_x, properties.product_moment],
            [properties.product_moment, properties.second_moment_y],
        ]
    )
    # sigma = E (kappa_y y + kappa_x x); int sigma y = M1, int sigma x = 0; e1 = -Z, e2 = Y, and M about Z is -M1
    curvature = np.linalg.solve(YOUNG * tensor, [-1000.0, 0.0])
    # w' = (kappa_y y + kappa_x x) s is the strain of a rod that bends by v'' = -kappa_y, u'' = -kappa_x
    deflection = -0.5 * LENGTH**2 * curvature
    end = solution.displacement("bar", np.array([LENGTH]))[:, 0]
    np.testing.assert_allclose(end, [0.0, deflection[0], -deflection[1]], atol=1e-9 * np.abs(deflection).max())


def test_a_section_without_symmetry_keeps_all_fields() -> None:
    load = rm.SectionForce("bar", LENGTH, (0.0, -1.0, 0.0))
    full = rm.solve(cantilever(ANGLE, load), level=2, order=3)
    half = rm.solve(cantilever(TRIANGLE, load), level=2, order=3)
    assert full.cost.unknowns * 10 == half.cost.unknowns * 18  # fields of h2, whole and mirrored
