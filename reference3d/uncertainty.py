"""Numerical uncertainty from three systematically refined meshes: observed order, limit, convergence index.

The grid convergence index of Roache as ASME V&V 20-2009, section 2, gives it. Works on three values of one
quantity that converges as a power of the mesh size; a position read between nodes, as a contact edge, does not.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from scipy.optimize import brentq

Behaviour = Literal["monotone", "oscillatory", "diverging", "constant"]

# safety factors of V&V 20: three meshes that converge as they should, and anything else
SAFETY_ASYMPTOTIC = 1.25
SAFETY_OTHERWISE = 3.0
# how far the observed order may be from the formal one, as a part of it, for meshes to converge as they should
AS_IT_SHOULD = 0.1
# observed orders outside this range are searched no further
LOWEST_ORDER, HIGHEST_ORDER = 1e-3, 50.0


@dataclass(frozen=True)
class GridConvergence:
    """How far a quantity on the finest of three meshes may be from its limit.

    Attributes
    ----------
    value : on the finest mesh
    behaviour : 'monotone'; 'oscillatory' (differences change sign); 'diverging' (the differences do not fall
        as any power of the mesh size); 'constant' (equal up to round-off)
    asymptotic : True if constant, or monotone with an observed order of at least half the formal one; only
        then is the band a grid convergence index
    observed_order : p, nan unless monotone
    extrapolated : limit for vanishing mesh size with the observed order; `value` unless asymptotic
    uncertainty : half width of the band about `value`, and about `extrapolated`, in which the limit is expected, in the
        quantity's unit
    """

    value: float
    behaviour: Behaviour
    asymptotic: bool
    observed_order: float
    extrapolated: float
    uncertainty: float


def grid_convergence(
    values: tuple[float, float, float], sizes: tuple[float, float, float], formal_order: float
) -> GridConvergence:
    """Convergence of one quantity over three meshes.

    An observed order above the formal one is not trusted, as it comes from a last change that is small by chance: the
    index then uses the formal order, and of the errors on the finest mesh that either change implies the larger one.
    The limit is extrapolated with the observed order, so that such a last change hardly moves it. The factor of safety
    is 1.25 where the observed order is within a tenth of the formal one, and 3 where it is not (W. L. Oberkampf,
    C. J. Roy, Verification and Validation in Scientific Computing, 2010, section 8.7). Where the sequence oscillates,
    diverges or converges at less than half the formal order, the band is three times the largest change between any
    two of the meshes, and nothing is extrapolated.

    Parameters
    ----------
    values : on meshes from coarse to fine
    sizes : representative mesh sizes, mm, falling
    formal_order : order with which the error is expected to fall with the mesh size

    Raises
    ------
    ValueError
        if the sizes do not fall, the order is not positive or a value is not finite.
    """
    if not sizes[0] > sizes[1] > sizes[2] > 0.0:
        raise ValueError(f"sizes: found {sizes}; they must be positive and fall from coarse to fine")
    if not formal_order > 0.0:
        raise ValueError(f"formal_order: found {formal_order}; a positive order is needed")
    if not all(math.isfinite(value) for value in values):
        raise ValueError(f"values: found {values}; they must be finite")
    coarse, medium, fine = values
    first, second = coarse - medium, medium - fine
    spread = max(abs(first), abs(second), abs(first + second))
    if spread <= 1e-13 * max(abs(value) for value in values):
        return GridConvergence(fine, "constant", True, math.nan, fine, spread)
    conservative = SAFETY_OTHERWISE * spread
    if first * second < 0.0:
        return GridConvergence(fine, "oscillatory", False, math.nan, fine, conservative)
    order = _observed_order(first, second, sizes)
    if math.isnan(order):
        return GridConvergence(fine, "diverging", False, math.nan, fine, conservative)
    if order < 0.5 * formal_order:
        return GridConvergence(fine, "monotone", False, order, fine, conservative)
    trusted = min(order, formal_order)
    errors = (
        _implied_error(first, sizes[0] / sizes[2], sizes[1] / sizes[2], trusted),
        _implied_error(second, sizes[1] / sizes[2], 1.0, trusted),
    )
    extrapolated = fine - _implied_error(second, sizes[1] / sizes[2], 1.0, order)
    safety = SAFETY_ASYMPTOTIC if abs(order - formal_order) <= AS_IT_SHOULD * formal_order else SAFETY_OTHERWISE
    return GridConvergence(fine, "monotone", True, order, extrapolated, safety * max(map(abs, errors)))


def _implied_error(change: float, larger: float, smaller: float, order: float) -> float:
    """Error on the finest mesh that the change between two meshes implies at an order; sizes over the finest one."""
    return float(change / (larger**order - smaller**order))


def _observed_order(first: float, second: float, sizes: tuple[float, float, float]) -> float:
    """Order p of value = limit + C h^p from the two differences; nan if no positive p fits."""
    if first == 0.0:
        return math.nan
    ratio = second / first

    # (h2^p - h3^p) / (h1^p - h2^p) falls from ln(h2/h3) / ln(h1/h2) at p = 0 to 0
    def mismatch(order: float) -> float:
        scaled = [(size / sizes[1]) ** order for size in sizes]
        return float((1.0 - scaled[2]) / (scaled[0] - 1.0) - ratio)

    if mismatch(LOWEST_ORDER) <= 0.0:
        return math.nan
    if mismatch(HIGHEST_ORDER) >= 0.0:
        return HIGHEST_ORDER
    return float(brentq(mismatch, LOWEST_ORDER, HIGHEST_ORDER, xtol=1e-12))
