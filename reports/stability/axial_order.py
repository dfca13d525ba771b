"""Order up to 20 along the rod: Lobatto's functions against Lagrange's on equidistant points and monomials."""

from __future__ import annotations

import math

import numpy as np
from numpy.polynomial import polynomial
from numpy.typing import NDArray

import rodmodel
from cases.scene import Clamp, Rectangle, Rod, Scene
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.wording import number, share
from reports.verification.scenes import ROD, STEEL, arc, end_force
from rodmodel.axial import gauss, shape_function_slopes

Array = NDArray[np.float64]

ORDERS = tuple(float(order) for order in range(2, 21))
MONOMIALS = Method("monomials", ours=False)
EQUIDISTANT = Method("Lagrange, equidistant points", ours=False)
OURS = Method("Lobatto (rodmodel)")
ONE, FOUR = Method("one element"), Method("four elements")
RADIUS, SIDE, LEVEL = 150.0, 15.0, 2
# Orders up to here are held against this one.
BEST = 24


def measure(values: tuple[float, ...]) -> Found:
    """Condition of int N' N'^T without rigid motion, and the error of a ring's deflection."""
    conditions: dict[str, list[float]] = {method.name: [] for method in (MONOMIALS, EQUIDISTANT, OURS)}
    for value in values:
        order = int(value)
        xi, weight = gauss(order + 1)
        for name, slopes in zip(
            conditions,
            (_monomial_slopes(order, xi), _lagrange_slopes(order, xi), shape_function_slopes(order, xi)[1:]),
            strict=True,
        ):
            conditions[name].append(float(np.linalg.cond((slopes * weight) @ slopes.T)))
    errors = {}
    for method, elements in ((ONE, 1), (FOUR, 4)):
        best = _ring_deflection(elements, BEST)
        errors[method.name] = [abs(_ring_deflection(elements, int(value)) / best - 1.0) for value in values]
    return {
        "condition": {name: curve(values, found) for name, found in conditions.items()},
        "error": {name: curve(values, found) for name, found in errors.items()},
    }


def _monomial_slopes(order: int, xi: Array) -> Array:
    """Of xi, xi^2, ..., shape (order, n)."""
    return np.array([power * xi ** (power - 1) for power in range(1, order + 1)])


def _lagrange_slopes(order: int, xi: Array) -> Array:
    """Of Lagrange's functions of all equidistant points but the first, shape (order, n)."""
    points = np.linspace(-1.0, 1.0, order + 1)
    slopes = []
    for own in range(1, order + 1):
        others = np.delete(points, own)
        coefficients = polynomial.polyfromroots(others) / np.prod(points[own] - others)
        slopes.append(polynomial.polyval(xi, polynomial.polyder(coefficients)))
    return np.array(slopes)


def _ring_deflection(elements: int, order: int) -> float:
    """Of a quarter ring's end per unit force along the radius there."""
    line = arc(RADIUS, 0.5 * math.pi)
    rod = Rod(ROD, line, Rectangle(SIDE, SIDE), STEEL, tuple(np.linspace(0.0, line.length, elements + 1).tolist()))
    scene = Scene("ring", (rod,), (Clamp(ROD, "start"),), end_force(line, (0.0, 1.0, 0.0)), ())
    return 2.0 * rodmodel.solve(scene, LEVEL, order).strain_energy


def claim(found: Found) -> str:
    """Conditions and decay."""
    condition, error = found["condition"], found["error"]
    top = condition[OURS.name].x[-1]
    one, four = error[ONE.name], error[FOUR.name]
    return (
        f"At p = {top:.0f} the functions of the rod model have the condition {number(condition[OURS.name].y[-1])} "
        "(their slopes are orthonormal but for the linear one), Lagrange's on equidistant points "
        f"{number(condition[EQUIDISTANT.name].y[-1])}, monomials {number(condition[MONOMIALS.name].y[-1])}. With them "
        f"the error of a quarter ring falls without end: from {share(one.y[0])} at p = {one.x[0]:.0f} to "
        f"{share(one.y[-1])} at p = {one.x[-1]:.0f} on one element, {share(four.y[0])} to {share(four.y[-1])} on four."
    )


def own_limit(found: Found) -> str:
    """The clamp keeps the decay algebraic."""
    one = found["error"][ONE.name]
    return (
        "At a clamp the section cannot contract, which dies away within about a section's height; that layer, not the "
        f"ring, is what high orders are busy with on one long element ({share(one.at(10.0))} at p = 10). Short "
        "elements at clamps are cheaper than orders. No order loses digits."
    )


def holds(found: Found) -> bool:
    """Ours stays small, the others grow by decades; errors fall to less than a thousandth."""
    condition, error = found["condition"], found["error"]
    ours = max(condition[OURS.name].y) < 10.0
    others = all(condition[each.name].y[-1] > 1e3 * condition[OURS.name].y[-1] for each in (EQUIDISTANT, MONOMIALS))
    return ours and others and all(each.y[-1] < 1e-2 * each.y[0] for each in error.values())


SWEEP = Sweep(
    "Order",
    "The order along the rod from 2 to 20: condition of ∫ N′ N′ᵀ without the rigid motion, and the deflection of a "
    "quarter ring (R / h = 10, h2) against that at p = 24.",
    ORDERS,
    (MONOMIALS, EQUIDISTANT, OURS, ONE, FOUR),
    (
        Picture("condition", "Functions along the rod", "p", "condition", log_x=False),
        Picture("error", "Error of the deflection", "p", "relative error", log_x=False),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
