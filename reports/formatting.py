"""How numbers and comparisons are written, on the terminal and on the page alike."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from cases.case import QUANTITIES, Grades, Quantity
from cases.scene import Gap, GapTable, Ground, RodFace, RoundGap
from reports.comparison import Comparison, Kind
from reports.quantities import DEFINITIONS
from reports.solution import Model

MODEL_NAMES: dict[Model, str] = {"rod": "rod model", "reference": "3D"}
KIND_NAMES: dict[Kind, str] = {
    "reference": "3D of this run",
    "3d converged": "independent 3D",
    "published": "published",
}
NOTHING = "none"


def number(value: float | None, digits: int = 6) -> str:
    """A number with so many significant digits and no exponent where it can be read without one."""
    if value is None:
        return NOTHING
    magnitude = abs(value)
    if magnitude == 0.0:
        return "0"
    if not 1e-4 <= magnitude < 1e7:
        return f"{value:.{digits - 1}e}"
    decimals = digits - 1
    if magnitude >= 1.0:
        decimals = max(0, digits - len(str(int(magnitude))))
    text = f"{value:.{decimals}f}"
    return text.replace("-", "\u2212")


def grades(level_or_order: Grades | None) -> str:
    """A level or order of the rod model: one number, or from the lowest to the highest of the elements."""
    if not isinstance(level_or_order, Mapping):
        return str(level_or_order)
    each = [grade for rod in level_or_order.values() for grade in rod]
    return f"{min(each)}" if min(each) == max(each) else f"{min(each)} to {max(each)}"


def rod_model(level: Grades | None, order: Grades | None) -> str:
    """The rod model by name, with its level and order."""
    return f"rod model h{grades(level)}, p = {grades(order)}"


def capital(text: str) -> str:
    """A text as a sentence or a title begins."""
    return text[:1].upper() + text[1:]


def count(number: int) -> str:
    """A number of things in groups of three digits, which no line break parts."""
    return f"{number:,}".replace(",", "\u00a0")


def stretches(edges: Sequence[float]) -> str:
    """Contact edges, start and end of each stretch in turn, mm."""
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return ", ".join(f"{start:.2f} to {end:.2f}" for start, end in pairs) or NOTHING


def values(quantity: Quantity, numbers: Sequence[float]) -> str:
    """The numbers of a comparison, without unit."""
    if quantity in ("contact_edges", "contact_edges_outer"):
        return stretches(numbers)
    return ", ".join(number(value, 5) for value in numbers) or NOTHING


def values_with_unit(quantity: Quantity, numbers: Sequence[float]) -> str:
    """The numbers of a comparison with their unit; 'none' where there are none."""
    return f"{values(quantity, numbers)} {QUANTITIES[quantity].unit}" if numbers else NOTHING


def measure(quantity: Quantity, value: float | None) -> str:
    """A difference, uncertainty or tolerance with its unit: in per cent where the quantity's are relative."""
    if value is None:
        return "unknown"
    kind = QUANTITIES[quantity]
    return f"{100.0 * value:.3g} %" if kind.relative else f"{value:.3g} {kind.unit}"


def title(comparison: Comparison) -> str:
    """What is compared: quantity, rod or pair, and the place where there is one."""
    name = f"{DEFINITIONS[comparison.quantity].title}, {comparison.of}"
    return f"{name} at {comparison.place}" if comparison.place else name


def opposite(second: RodFace | Ground) -> str:
    """What a face may touch: a face of another rod, or ground."""
    if isinstance(second, RodFace):
        return f"{second.face} face of {second.rod}"
    return "rigid ground" if second.modulus is None else f"a bed of {second.modulus:g} N/mm³ that cannot pull"


def gap(given: Gap) -> str:
    """The gap of a contact pair in words."""
    match given:
        case GapTable():
            return f"{min(given.gaps):g} to {max(given.gaps):g} mm by a table"
        case RoundGap():
            extreme = "least" if given.radius > 0.0 else "largest"
            where = f"{extreme} ({given.least:g} mm) at {given.station:g} mm"
            return f"round with a radius of {abs(given.radius):g} mm, {where}"
        case "drawn":
            return "as drawn"
        case _:
            return f"{given:g} mm"


def seconds(value: float) -> str:
    """A duration with the unit that suits it."""
    return f"{1000.0 * value:.0f} ms" if value < 1.0 else f"{value:.1f} s"
