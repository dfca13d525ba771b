"""Numbers with units, as case files write them: `15` and `"15 mm"` and `"0.015 m"` are the same length.

Conversion is pint's. Its import takes a quarter of a second, so it waits until a unit is met, and its
registry holds only the units of mechanics.
"""

from __future__ import annotations

import math
import re
from decimal import Decimal
from functools import lru_cache
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    import pint

Unit = Literal["mm", "N", "MPa", "N mm", "N/mm", "N/mm^3", "t/mm^3", "mm/s^2", "rad", "%"]

# Beyond any length, force or stress, and far from where their products overflow.
LARGEST = 1e30

# What each unit measures, and how it may be written.
EXAMPLES: dict[Unit, tuple[str, str]] = {
    "mm": ("a length", '15 (mm) or "0.5 mm"'),
    "N": ("a force", '1000 (N) or "1 kN"'),
    "MPa": ("a stress", '200000 (MPa) or "200 GPa"'),
    "N mm": ("a moment", '1000 (N mm) or "1 N m"'),
    "N/mm": ("a force per length", '2 (N/mm) or "2 kN/m"'),
    "N/mm^3": ("a stress per length", '1e6 (N/mm^3) or "1e6 N/mm^3"'),
    "t/mm^3": ("a density with its unit", '"7850 kg/m^3"'),
    "mm/s^2": ("an acceleration with its unit", '"9.81 m/s^2"'),
    "rad": ("an angle", '1.5708 (rad) or "90 deg"'),
    "%": ("a relative tolerance", '"0.1 %"'),
}

# A bare number of these could be meant in another unit: 0.1 as 10 %, 7850 in kg/m^3, 9.81 in m/s^2.
NEVER_BARE: frozenset[Unit] = frozenset({"%", "t/mm^3", "mm/s^2"})

# These have no dimension, but neither have mm/m: only their own signs count.
_SIGNS: dict[Unit, tuple[str, ...]] = {"%": ("%", "percent"), "rad": ("rad", "radian", "deg", "degree")}

_DEFINITIONS = """
micro- = 1e-6 = µ- = u-
milli- = 1e-3 = m-
centi- = 1e-2 = c-
kilo- = 1e3 = k-
mega- = 1e6 = M-
giga- = 1e9 = G-
tera- = 1e12 = T-
meter = [length] = m = metre
inch = 0.0254 * meter = in
gram = [mass] = g
tonne = 1e6 * gram = t
second = [time] = s
newton = 1000 * gram * meter / second ** 2 = N
pound_force = 4.4482216152605 * newton = lbf
pascal = newton / meter ** 2 = Pa
bar = 1e5 * pascal
psi = pound_force / inch ** 2
ksi = 1000 * psi
percent = 0.01 = %
radian = [] = rad
degree = 0.017453292519943295769236907684886 * radian = deg
"""

_NUMBER = r"[+-]?(?:\d+(?:\.\d*)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_NAME = r"[A-Za-zµ%_]+(?:(?:\^|\*\*)\d)?"
_QUANTITY = re.compile(rf"\s*(?P<number>{_NUMBER})\s*(?P<unit>{_NAME}(?:\s*[*/ ]\s*{_NAME})*)\s*", re.ASCII)

# The same for readers of the JSON Schema; it cannot tell which unit fits.
QUANTITY_PATTERN = rf"^\s*{_NUMBER}\s*[A-Za-zµ%].*$"


class UnitError(ValueError):
    """A value that is not what its key needs.

    Attributes
    ----------
    remedy : what would be right
    """

    def __init__(self, remedy: str) -> None:
        super().__init__(remedy)
        self.remedy = remedy


@lru_cache(maxsize=1)
def _registry() -> pint.UnitRegistry[Decimal]:
    import pint

    # Decimal: powers of ten stay exact, so that "0.2 TPa" is 200000 MPa to the last digit.
    registry: pint.UnitRegistry[Decimal] = pint.UnitRegistry(None, non_int_type=Decimal)
    for line in _DEFINITIONS.strip().splitlines():
        registry.define(line)
    return registry


@lru_cache(maxsize=256)
def _factor(unit: str, wanted: Unit) -> Decimal | None:
    """How many `wanted` one `unit` is; None if it measures something else or is unknown."""
    from pint import DimensionalityError, UndefinedUnitError

    registry = _registry()
    try:
        return Decimal(registry.convert(Decimal(1), registry.parse_units(unit), registry.parse_units(wanted)))
    except (DimensionalityError, UndefinedUnitError):
        return None


def to_unit(value: object, wanted: Unit) -> float:
    """A value of a case file in the unit `wanted`.

    Parameters
    ----------
    value : a number, taken to be in `wanted` already, or a string of a number and a unit; a string alone where
        `wanted` is `NEVER_BARE`, unless the number is 0

    Returns
    -------
    A finite number; percentages as fractions.

    Raises
    ------
    UnitError
        if `value` is anything else, has a unit that does not fit, or is not finite.
    """
    what, example = EXAMPLES[wanted]
    remedy = f"{what} is needed, such as {example}"
    if isinstance(value, str):
        match = _QUANTITY.fullmatch(value)
        fits = match is not None and (wanted not in _SIGNS or match["unit"] in _SIGNS[wanted])
        factor = _factor(match["unit"], wanted) if match and fits else None
        if match is None or factor is None:
            raise UnitError(remedy)
        number = float(Decimal(match["number"]) * factor)
        number = number / 100.0 if wanted == "%" else number
    elif isinstance(value, (int, float)) and not isinstance(value, bool) and (value == 0 or wanted not in NEVER_BARE):
        try:
            number = float(value)
        except OverflowError:
            number = math.inf
    else:
        raise UnitError(remedy)
    if not abs(number) <= LARGEST:
        raise UnitError(f"{what} must be finite, and at most {LARGEST:g} {wanted}")
    return number
