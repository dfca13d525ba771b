"""How the numbers of the stability page are written in sentences."""

from __future__ import annotations

import math
from collections.abc import Iterable

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


def number(value: float) -> str:
    """Two digits, with a power of ten where the number is very large or small."""
    if value == 0.0:
        return "0"
    rounded = float(f"{value:.1e}")
    if 1e-3 <= abs(rounded) < 1e5:
        return f"{rounded:g}".replace("-", "−")
    mantissa, exponent = f"{rounded:.1e}".split("e")
    power = f"10{str(int(exponent)).translate(_SUPERSCRIPTS)}"
    short = mantissa.removesuffix(".0")
    return power if short == "1" else f"{short}·{power}".replace("-", "−")


def and_list(words: Iterable[str]) -> str:
    """Words with commas and an 'and'."""
    listed = list(words)
    return listed[0] if len(listed) == 1 else f"{', '.join(listed[:-1])} and {listed[-1]}"
