"""How far apart two answers are, how sure the reference is, and the verdict that follows.

A difference within the tolerance passes only if the reference is at least as certain as the tolerance asks
and both solvers converged; otherwise it is 'not resolved' (as in ASME V&V 20).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal, NamedTuple

import numpy as np

from cases.case import QUANTITIES, Axis, Check, Quantity
from cases.scene import Vector
from reports.solution import Array, Model

Verdict = Literal["pass", "fail", "not resolved"]
Kind = Literal["reference", "3d converged", "published"]


class Extrapolation(NamedTuple):
    """What three numbers on three meshes say (ASME V&V 20).

    Attributes
    ----------
    value : extrapolated where the sequence converges, else the finest
    uncertainty : in the unit of the value
    order : observed order of convergence; None where there is none
    """

    value: float
    uncertainty: float
    order: float | None


Extrapolate = Callable[[float, float, float], Extrapolation]

CURVES = frozenset({"deflection", "bending_moment"})


@dataclass(frozen=True)
class Estimate:
    """A reference value and how sure it is.

    Attributes
    ----------
    value : one number, several (edges), or a curve, shape (n,) or (3, n)
    uncertainty : in the unit of the value; None where it is unknown
    order : observed order of convergence; None where the sequence shows none
    """

    value: Array
    uncertainty: float | None
    order: float | None = None


@dataclass(frozen=True)
class Comparison:
    """One quantity of one model held against one reference.

    Attributes
    ----------
    quantity : key of `cases.case.QUANTITIES` and `reports.quantities.DEFINITIONS`
    of : the pair or rod
    point : (x, y, s), mm, for a stress and a published deflection
    axis : global axis of a published deflection
    model : whose value is judged
    kind, source : against what: the 3D reference of this run, an independent 3D value, a published one
    value, reference : the numbers compared; of a curve the two magnitudes where they are farthest apart
    difference, uncertainty, tolerance : fractions where the quantity's kind is relative, else in its unit;
        None where they cannot be formed
    reason : why a comparison is not resolved, or what else the reader must know; may be empty
    """

    quantity: Quantity
    of: str
    point: Vector | None
    model: Model
    kind: Kind
    source: str
    value: tuple[float, ...]
    reference: tuple[float, ...]
    difference: float | None
    uncertainty: float | None
    tolerance: float
    verdict: Verdict
    reason: str
    axis: Axis | None = None

    @property
    def place(self) -> str:
        """The point and the axis in words; '' where there are none."""
        if self.point is None:
            return ""
        point = f"({', '.join(f'{coordinate:g}' for coordinate in self.point)})"
        return point if self.axis is None else f"{point} along {self.axis}"


def magnitude(values: Array) -> Array:
    """Absolute values of numbers, shape (n,), or lengths of vectors, shape (3, n)."""
    sizes: Array = np.linalg.norm(values, axis=0) if values.ndim == 2 else np.abs(values)
    return sizes


def judge(
    difference: float, uncertainty: float | None, tolerance: float, outcomes: Sequence[str] = ()
) -> tuple[Verdict, str]:
    """The verdict on a difference, and its reason where it is 'not resolved'.

    Parameters
    ----------
    uncertainty : of the reference, in the measure of the difference; None where it is unknown
    outcomes : of the solvers whose numbers stand on either side

    Notes
    -----
    'fail' needs certainty too: the difference exceeds the tolerance by more than the uncertainty, or the
    uncertainty is within the tolerance.
    """
    unfinished = [outcome for outcome in outcomes if outcome != "converged"]
    if unfinished:
        return "not resolved", f"a solver did not converge: {unfinished[0]}"
    if uncertainty is None:
        return "not resolved", "the uncertainty of the reference is not known"
    if difference > tolerance + uncertainty:
        return "fail", ""
    if uncertainty > tolerance:
        return "not resolved", "the uncertainty of the reference is larger than the tolerance"
    return ("pass" if difference <= tolerance else "fail"), ""


def compare(
    check: Check,
    model: Model,
    value: Array,
    reference: Estimate,
    *,
    kind: Kind,
    source: str,
    outcomes: Sequence[str] = (),
    axis: Axis | None = None,
) -> Comparison:
    """Hold a value, shape (n,) or (3, n), against a reference of the same quantity.

    Parameters
    ----------
    check : what is compared and to which tolerance
    outcomes : of the solvers whose numbers stand on either side
    axis : where the value is one component of a deflection

    Notes
    -----
    The difference is the largest over all entries; relative ones refer to the reference's largest
    magnitude. Where the numbers of entries differ (one stretch in contact against two), no difference can be
    formed: a fail, unless the reference's own meshes differ in it, too, so that its uncertainty is not known.
    """
    difference: float | None
    if value.shape != reference.value.shape:
        difference = uncertainty = None
        certain = None if reference.uncertainty is None else 0.0
        verdict, reason = judge(math.inf, certain, check.tolerance, outcomes)
        reason = reason or f"{value.size} values against {reference.value.size}"
        shown = value.ravel(), reference.value.ravel()
    else:
        apart = magnitude(value - reference.value)
        relative = QUANTITIES[check.quantity].relative
        scale = float(magnitude(reference.value).max(initial=0.0)) if relative else 1.0
        difference = _ratio(float(apart.max(initial=0.0)), scale)
        uncertainty = None if reference.uncertainty is None else _ratio(reference.uncertainty, scale)
        verdict, reason = judge(difference, uncertainty, check.tolerance, outcomes)
        shown = value, reference.value
        if check.quantity in CURVES and axis is None:
            worst = int(np.argmax(apart))
            shown = magnitude(value)[worst : worst + 1], magnitude(reference.value)[worst : worst + 1]
    return Comparison(
        quantity=check.quantity,
        of=check.of,
        point=check.point,
        model=model,
        kind=kind,
        source=source,
        value=tuple(shown[0].tolist()),
        reference=tuple(shown[1].tolist()),
        difference=difference,
        uncertainty=uncertainty,
        tolerance=check.tolerance,
        verdict=verdict,
        reason=reason,
        axis=axis,
    )


def untreated(check: Check, value: Array, reason: str, *, kind: Kind, source: str) -> Comparison:
    """The rod model's value where the solver that it should be held against cannot treat the scene."""
    largest = magnitude(value)
    shown = largest[largest.argmax() :][:1] if check.quantity in CURVES and value.size else value
    return Comparison(
        quantity=check.quantity,
        of=check.of,
        point=check.point,
        model="rod",
        kind=kind,
        source=source,
        value=tuple(shown.tolist()),
        reference=(),
        difference=None,
        uncertainty=None,
        tolerance=check.tolerance,
        verdict="not resolved",
        reason=reason,
    )


def _ratio(numerator: float, denominator: float) -> float:
    if numerator == 0.0:
        return 0.0
    return numerator / denominator if denominator > 0.0 else math.inf


def edges_estimate(values: Sequence[Array], resolution: float) -> Estimate:
    """Estimate of contact edges from three meshes.

    Parameters
    ----------
    values : coarse to fine, mm, shape (n,) each
    resolution : widest interval of stations that holds an edge on the finest mesh, mm

    Notes
    -----
    An edge follows the mesh in steps of its stations and not as a power of their distance, so that no order can be
    observed. The value is that of the finest mesh. It is known no better than the interval of stations it lies in
    there, nor than it moves with the mesh: the uncertainty is the larger of the two.
    """
    coarse, medium, fine = values
    if not coarse.shape == medium.shape == fine.shape:
        return Estimate(fine, None)
    change = np.abs([fine - medium, fine - coarse, medium - coarse]).max(initial=0.0)
    return Estimate(fine, max(float(change), resolution))


def sequence_estimate(values: Sequence[Array], extrapolate: Extrapolate, *, curve: bool) -> Estimate:
    """Estimate from one quantity on three meshes.

    Parameters
    ----------
    values : coarse to fine, shape (n,) or (3, n) each
    curve : whether the values are one curve rather than separate numbers
    extrapolate : what three numbers on these meshes say

    Notes
    -----
    Numbers are extrapolated one by one and the largest uncertainty counts. A curve is extrapolated as a
    whole, with the order observed where the two finest meshes differ most. Where the meshes do not even agree
    on the number of values, the uncertainty is unknown.
    """
    coarse, medium, fine = values
    if not coarse.shape == medium.shape == fine.shape:
        return Estimate(fine, None)
    if not fine.size:
        return Estimate(fine, 0.0)
    if not curve:
        parts = [
            extrapolate(*(float(number) for number in numbers)) for numbers in zip(coarse, medium, fine, strict=True)
        ]
        orders = [part.order for part in parts if part.order is not None]
        return Estimate(
            np.array([part.value for part in parts]),
            max(part.uncertainty for part in parts),
            min(orders) if len(orders) == len(parts) else None,
        )
    steps = fine - medium
    worst = np.unravel_index(int(np.argmax(np.abs(steps))), steps.shape)
    part = extrapolate(float(coarse[worst]), float(medium[worst]), float(fine[worst]))
    step = float(steps[worst])
    share = (part.value - float(fine[worst])) / step if step != 0.0 else 0.0
    return Estimate(fine + share * steps, part.uncertainty, part.order)
