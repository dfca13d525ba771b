"""How the numbers of the stability page are written in sentences."""

from __future__ import annotations

import math

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
# Relative errors from here on are written in per cent.
LEAST_PER_CENT = 1e-5


def share(value: float) -> str:
    """Size of a relative error: '0.12 %', '100 %', or a power of ten where it is small."""
    if math.isnan(value):
        return "no answer"
    if abs(value) >= LEAST_PER_CENT:
        return f"{number(100.0 * abs(value))} %"
    return number(abs(value))


def number(value: float, digits: int = 2) -> str:
    """A few digits, with a power of ten where the number is very large or small."""
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.{digits - 1}e}")
    if 1e4 <= abs(rounded) < 1e6:
        return f"{rounded:,.0f}".replace(",", "\u202f").replace("-", "−")
    if 1e-3 <= abs(rounded) < 1e6:
        return f"{rounded:.6g}".replace("-", "−")
    mantissa, exponent = f"{rounded:.{digits - 1}e}".split("e")
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    short = mantissa.rstrip("0").rstrip(".") if "." in mantissa else mantissa
    return power if short == "1" else f"{short}·{power}".replace("-", "−")
