"""Values of a case file (numbers with units, names, vectors) and what every table has in common."""

from __future__ import annotations

import unicodedata
from typing import Annotated, Any

from pydantic import AfterValidator, BaseModel, BeforeValidator, ConfigDict, Field, StrictStr, WithJsonSchema
from typing_extensions import TypeAliasType

from cases.units import EXAMPLES, LARGEST, NEVER_BARE, QUANTITY_PATTERN, Unit, UnitError, to_unit

_WITH_UNIT = {"type": "string", "pattern": QUANTITY_PATTERN}
_FORMS = [{"type": "number"}, _WITH_UNIT]
# Controls of Unicode that write what follows backwards, so that a reader sees another text.
_TURNS_AROUND = "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"


def with_unit(unit: Unit) -> tuple[BeforeValidator, WithJsonSchema]:
    """Validation and JSON Schema of a number with a unit."""
    what, example = EXAMPLES[unit]
    forms = [{"const": 0}, _WITH_UNIT] if unit in NEVER_BARE else _FORMS
    schema = {"anyOf": forms, "description": f"{what}, such as {example}"}
    return BeforeValidator(lambda value: to_unit(value, unit)), WithJsonSchema(schema)


def _plain_number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= LARGEST:
        raise UnitError("a number without unit is needed, such as 0.3")
    return float(value)


def _tolerance(value: object) -> str:
    """Keep a tolerance as text until its quantity is known, but see that it is a number with a unit."""
    for unit in ("%", "mm"):
        try:
            to_unit(value, unit)
        except UnitError:
            continue
        if isinstance(value, str):
            return value
    raise UnitError('write a tolerance with its unit, relative as in "0.1 %" or absolute as in "1 mm"')


def _one_line(text: str) -> str:
    return _written(text, "")


def _lines(text: str) -> str:
    return _written(text, "\n\t")


def _written(text: str, allowed: str) -> str:
    """A text without characters that are no writing: they steer terminals, or turn the text around them."""
    for each in text:
        if each not in allowed and (unicodedata.category(each) in ("Cc", "Zl", "Zp") or each in _TURNS_AROUND):
            raise UnitError(f"a text without the control character U+{ord(each):04X} is needed")
    return text


# Named types are written once in the JSON Schema, and referred to.
Length = TypeAliasType("Length", Annotated[float, *with_unit("mm")])
Force = TypeAliasType("Force", Annotated[float, *with_unit("N")])
Stress = TypeAliasType("Stress", Annotated[float, *with_unit("MPa")])
Moment = TypeAliasType("Moment", Annotated[float, *with_unit("N mm")])
ForcePerLength = TypeAliasType("ForcePerLength", Annotated[float, *with_unit("N/mm")])
Angle = TypeAliasType("Angle", Annotated[float, *with_unit("rad")])
StressPerLength = TypeAliasType("StressPerLength", Annotated[float, *with_unit("N/mm^3")])
Density = TypeAliasType("Density", Annotated[float, *with_unit("t/mm^3")])
Acceleration = TypeAliasType("Acceleration", Annotated[float, *with_unit("mm/s^2")])
Number = Annotated[float, BeforeValidator(_plain_number), WithJsonSchema({"type": "number"})]
Tolerance = Annotated[str, BeforeValidator(_tolerance), WithJsonSchema(_WITH_UNIT)]
Name = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9_][A-Za-z0-9_ .-]*$")]
Text = Annotated[StrictStr, Field(min_length=1), AfterValidator(_one_line)]
Title = Annotated[Text, Field(max_length=200)]
Lines = Annotated[StrictStr, AfterValidator(_lines)]
Point = tuple[Length, Length, Length]
Direction = tuple[Number, Number, Number]
Corner = tuple[Length, Length]
# For tables that the author names: no other names than `Name` allows.
ONLY_NAMES = Field(json_schema_extra={"additionalProperties": False})
# Numbers whose unit follows from another key, so that they are converted where that is known.
Quantities = Annotated[tuple[Any, ...], WithJsonSchema({"type": "array", "items": {"anyOf": _FORMS}})]
Value = Annotated[
    Any, WithJsonSchema({"anyOf": [*_FORMS, {"type": "array", "items": {"anyOf": _FORMS}, "minItems": 1}]})
]


class Table(BaseModel):
    """A table of the file: no other keys than these."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)
