"""Templates of case files: what can be chosen of each, with units and defaults, and the text that comes of it."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from string import Template as Text

import numpy as np

from cases.building import case_from
from cases.form import FormError, checked_form
from cases.loader import TRUTH
from cases.units import Unit, UnitError, to_unit

_HERE = Path(__file__).parent


class ChoiceError(Exception):
    """A value that a template cannot take.

    Attributes
    ----------
    key : of the choice, '' where it lies in several
    """

    def __init__(self, key: str, sentence: str) -> None:
        super().__init__(sentence)
        self.key = key


@dataclass(frozen=True)
class Choice:
    """One thing that can be chosen.

    Attributes
    ----------
    words : what it is
    unit : '' for a plain number
    default : as one writes it in a case file
    positive : whether it must be
    """

    key: str
    words: str
    unit: Unit | None
    default: str
    positive: bool = True


@dataclass(frozen=True)
class Template:
    """A kind of case.

    Attributes
    ----------
    words : what it is
    derived : from the chosen values, in N, mm, MPa and rad, to the other numbers of the file
    """

    name: str
    words: str
    choices: tuple[Choice, ...]
    derived: Callable[[Mapping[str, float]], Mapping[str, object]]

    @property
    def title(self) -> str:
        """That of a case whose author gives none."""
        return self.words[0].upper() + self.words[1:]


def _borders(
    length: float, side: float, clamps: tuple[bool, bool], inner: Sequence[float] = (), even: int = 4
) -> list[float]:
    """Element borders: two short elements at each clamp, whose corners are singular, then even ones between `inner`.

    even : of those about so many
    """
    start = [0.0, 0.2 * side, side] if clamps[0] else [0.0]
    end = [length - side, length - 0.2 * side, length] if clamps[1] else [length]
    stops = [start[-1], *inner, end[0]]
    parts = [np.linspace(a, b, max(1, round(even * (b - a) / length)) + 1)[1:] for a, b in pairwise(stops)]
    return [round(float(border), 4) for border in (*start, *np.concatenate(parts), *end[1:])]


def _single_rod(values: Mapping[str, float]) -> Mapping[str, object]:
    length, side = values["length"], min(values["width"], values["height"])
    borders = _borders(length, side, (True, False))
    return {"borders": borders, "top": 0.5 * values["height"], "stress_at": 0.5 * length}


def _two_rods(values: Mapping[str, float]) -> Mapping[str, object]:
    length, overlap, side = values["length"], values["overlap"], min(values["width"], values["height"])
    if not side < overlap <= length - 2.0 * side:
        found = f"{overlap:g} mm; it must be more than {side:g} mm and at most {length - 2.0 * side:g} mm here"
        raise ChoiceError("overlap", found)
    start, third = length - overlap, overlap / 3.0
    position = round(overlap + (length - overlap) / 3.0, 2)
    within = (start, start + third, start + 2.0 * third)
    return {
        "lower_borders": _borders(length, side, (True, False), within),
        "upper_borders": _borders(length, side, (False, True), (third, 2.0 * third, overlap, position)),
        "upper_start": start,
        "upper_end": start + length,
        "upper_height": values["height"] + values["gap"],
        "position": position,
    }


def _curved_rod(values: Mapping[str, float]) -> Mapping[str, object]:
    length, side = values["radius"] * values["angle"], min(values["width"], values["height"])
    _require_slender(length, values, "angle")
    return {"length": round(length, 4), "borders": _borders(length, side, (True, False))}


def _bar_on_bed(values: Mapping[str, float]) -> Mapping[str, object]:
    length, side = values["length"], min(values["width"], values["height"])
    middle = 0.5 * length
    return {
        # The bar lifts off inside elements, which long ones follow badly.
        "borders": _borders(length, side, (True, True), (middle,), even=8),
        "middle": middle,
        "zone_start": side,
        "zone_end": length - side,
    }


def _require_slender(length: float, values: Mapping[str, float], key: str) -> None:
    side = max(values["width"], values["height"])
    if length < 5.0 * side:
        sentence = f"a rod of {length:g} mm; it must be at least five times as long as its section, {5.0 * side:g} mm"
        raise ChoiceError(key, sentence)


def _length(default: str) -> Choice:
    return Choice("length", "length of the rod", "mm", default)


_SECTION = (
    Choice("width", "width of the section, across", "mm", "15 mm"),
    Choice("height", "height of the section, upwards", "mm", "15 mm"),
)
_MATERIAL = (
    Choice("young_modulus", "Young's modulus", "MPa", "200 GPa"),
    Choice("poisson_ratio", "Poisson's ratio", None, "0.3", positive=False),
)


def _force(words: str, default: str) -> Choice:
    return Choice("force", words, "N", default, positive=False)


TEMPLATES: tuple[Template, ...] = (
    Template(
        "single-rod",
        "a straight rod, clamped at one end, a force on the other",
        (_length("300 mm"), *_SECTION, *_MATERIAL, _force("force on the free end, upwards", "-1 kN")),
        _single_rod,
    ),
    Template(
        "two-rods",
        "two cantilevers in contact, one lying on the other",
        (
            Choice("length", "length of each rod", "mm", "300 mm"),
            *_SECTION,
            *_MATERIAL,
            Choice("upper_modulus", "Young's modulus of the upper rod", "MPa", "50 GPa"),
            Choice("overlap", "overlap of the rods", "mm", "100 mm"),
            Choice("gap", "gap between them before the load", "mm", "0 mm", positive=False),
            _force("force on the upper rod, upwards", "-1 kN"),
        ),
        _two_rods,
    ),
    Template(
        "curved-rod",
        "a circular arc, clamped at one end, a force across its plane on the other",
        (
            Choice("radius", "radius of the arc", "mm", "100 mm"),
            Choice("angle", "angle of the arc", "rad", "90 deg"),
            Choice("width", "width of the section, along the radius", "mm", "10 mm"),
            Choice("height", "height of the section, across the arc's plane", "mm", "10 mm"),
            *_MATERIAL,
            _force("force on the free end, along Z", "-100 N"),
        ),
        _curved_rod,
    ),
    Template(
        "bar-on-bed",
        "a bar clamped at both ends on an elastic bed that cannot pull, pressed down in the middle",
        (
            _length("600 mm"),
            Choice("width", "width of the section, across", "mm", "10 mm"),
            Choice("height", "height of the section, upwards", "mm", "10 mm"),
            *_MATERIAL,
            Choice("bed_modulus", "modulus of the bed, a stress per length", "N/mm^3", "1 N/mm^3"),
            _force("force in the middle, upwards", "-2 kN"),
        ),
        _bar_on_bed,
    ),
)


def chosen_value(choice: Choice, given: str) -> float:
    """A given value in N, mm, MPa or rad.

    Raises
    ------
    ChoiceError
        if it is not what is needed.
    """
    try:
        value = float(given) if choice.unit is None else to_unit(_as_in_file(given), choice.unit)
    except UnitError as error:
        raise ChoiceError(choice.key, f"{given!r}; {error.remedy}") from error
    except ValueError as error:
        raise ChoiceError(choice.key, f"{given!r}; a number without unit is needed, such as 0.3") from error
    if choice.positive and not value > 0.0:
        raise ChoiceError(choice.key, f"{given!r}; it must be positive")
    return value


def case_text(template: Template, title: str, given: Mapping[str, str]) -> str:
    """The text of a case file, which has been seen to be a case.

    Parameters
    ----------
    given : by key, as one writes it in a case file; the default where a key is missing

    Raises
    ------
    ChoiceError
        if a value is not what is needed, or the values do not go together.
    """
    written = {choice.key: given.get(choice.key, choice.default).strip() for choice in template.choices}
    values = {choice.key: chosen_value(choice, written[choice.key]) for choice in template.choices}
    if "length" in values:
        _require_slender(values["length"], values, "length")
    # Lengths are added up with others, so that they are written in mm; moduli, forces and angles as they were given.
    kept = {
        choice.key: values[choice.key] if choice.unit in ("mm", None) else _as_in_file(written[choice.key])
        for choice in template.choices
    }
    content = {"title": title, **kept, **template.derived(values)}
    text = Text((_HERE / f"{template.name}.toml").read_text(encoding="utf-8"))
    filled = text.substitute({key: _toml(value) for key, value in content.items()})
    try:
        case_from("new", checked_form(tomllib.loads(filled)), TRUTH)
    except FormError as error:
        raise ChoiceError("", error.sentences[0]) from error
    except ValueError as error:  # SceneError, or a title that is no TOML
        raise ChoiceError("", str(error)) from error
    return filled


def _as_in_file(given: str) -> str | float:
    """A number where it has no unit, else the text."""
    try:
        return float(given)
    except ValueError:
        return given


def _toml(value: object) -> str:
    """A text, number or list of numbers as TOML has it."""
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return f"{value:.10g}"
