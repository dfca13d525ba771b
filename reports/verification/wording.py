"""How errors, tolerances and reference values of checks are written, on the terminal and on the page alike."""

from __future__ import annotations

from reports.formatting import number
from reports.verification.check import Check, Outcome

# Relative errors from here on are written in per cent.
LEAST_PER_CENT = 1e-5
# Smaller values are written with a power of ten.
LEAST_PLAIN = 0.01
# Errors smaller than this are round-off.
ROUND_OFF = 1e-13

_SUPERSCRIPTS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


def relative(error: float) -> str:
    """A relative error with its sign: '−0.12 %', or a power of ten where it is small ('3·10⁻⁹')."""
    size = abs(error)
    if size < ROUND_OFF:
        return "0"
    sign = "−" if error < 0.0 else ""
    if size >= LEAST_PER_CENT:
        return f"{sign}{_plain(100.0 * size)} %"
    return sign + _power_of_ten(size, 1)


def _power_of_ten(value: float, digits: int) -> str:
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    return f"{mantissa}·10{str(int(exponent)).translate(_SUPERSCRIPTS)}"


def _plain(value: float) -> str:
    """Two significant digits without an exponent."""
    text = f"{value:.2g}"
    return f"{float(text):.0f}" if "e" in text and value >= 1.0 else text


def value(reference: float) -> str:
    """Six significant digits, with a power of ten where the value is small."""
    return number(reference) if abs(reference) >= LEAST_PLAIN else _power_of_ten(reference, 6)


def uncertainty(outcome: Outcome) -> str:
    """The relative uncertainty of the reference."""
    return "exact" if outcome.reference.uncertainty == 0.0 else f"± {relative(outcome.relative_uncertainty)}"


def tolerance(check: Check) -> str:
    """The tolerance and the level at which it must be met."""
    return f"{relative(check.tolerance)} at {check.steps.name(check.at_level)}"


def published(outcome: Outcome) -> str:
    """The well-known published value and how far it is from the reference; empty where there is none."""
    found = outcome.check.published
    if found is None:
        return ""
    written = f"{found:.4g}" if found >= LEAST_PLAIN else _power_of_ten(found, 3)
    return f"{written} ({relative(found / outcome.reference.value - 1.0)})"
