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
        then is the band a grid convergence index with factor 1.25
    observed_order : p, nan unless monotone
    extrapolated : limit for vanishing mesh size with the order used; `value` unless asymptotic
    uncertainty : half width of the band about `value` in which the limit is expected, in the quantity's unit
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

    An observed order above the formal one is not trusted: the index then uses the formal order. Where the
    sequence oscillates, diverges or converges at less than half the formal order, the band is three times the
    largest change between any two of the meshes, and nothing is extrapolated.

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
    correction = -second / ((sizes[1] / sizes[2]) ** min(order, formal_order) - 1.0)
    uncertainty = SAFETY_ASYMPTOTIC * abs(correction)
    return GridConvergence(fine, "monotone", True, order, fine + correction, uncertainty)


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


def clamp_singularity_exponent(poisson_ratio: float) -> float:
    """Exponent lambda of the displacement r^lambda at the edge where a free face meets a clamp at 90 degrees.

    Smallest root of (3 - 4 nu) sin^2(lambda pi / 2) = 4 (1 - nu)^2 - lambda^2 (M. L. Williams, Journal of
    Applied Mechanics 19 (1952) 526-528, plane strain); 0.711 for nu = 0.3. It is 1 (no singularity)
    for nu = 0.
    """

    def mismatch(exponent: float) -> float:
        left = (3.0 - 4.0 * poisson_ratio) * math.sin(0.5 * math.pi * exponent) ** 2
        return left + exponent**2 - 4.0 * (1.0 - poisson_ratio) ** 2

    if mismatch(1.0) <= 0.0:
        return 1.0
    return float(brentq(mismatch, 0.0, 1.0, xtol=1e-14))
