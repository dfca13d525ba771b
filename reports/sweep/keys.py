"""What a sweep varies: keys of a case file, each over a range of values, and the cases that come of it.

A case is varied in the tables of its file, so that every value is checked as if it stood there.
"""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Iterator, Sequence
from copy import deepcopy
from dataclasses import dataclass, replace
from difflib import get_close_matches
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np

from cases.building import case_from
from cases.case import Case, RodModelSettings
from cases.form import FormError, checked_form
from cases.loader import LIBRARY, TRUTH, load_case
from cases.scene import SceneError
from cases.wording import shown

FORM = "KEY=FIRST..LAST UNIT:COUNT, such as rods.upper.E=20..200GPa:30, with :log at the end for even ratios"
MOST_VALUES = 10_000
# Tables whose keys change an answer.
TABLES = ("materials", "sections", "rods", "supports", "joints", "beds", "loads", "contacts", "rod_model")
SYMBOLS = {"E": "young_modulus", "nu": "poisson_ratio", "rho": "density"}

_NUMBER = r"[+-]?(?:\d+(?:\.\d+)?|\.\d+)(?:[eE][+-]?\d{1,3})?"
_UNIT = r"[^\d\s.:=+-][^.:=]*?"
_RANGE = re.compile(
    rf"\s*(?P<first>{_NUMBER})\s*(?P<other>{_UNIT})?\s*\.\.\s*(?P<last>{_NUMBER})\s*(?P<unit>{_UNIT})?\s*"
    r":\s*(?P<count>\d+)\s*(?P<log>:\s*log)?\s*"
)
_QUANTITY = re.compile(rf"\s*{_NUMBER}\s*.*")


class SweepError(Exception):
    """A sweep that cannot be carried out as asked for; the message is one sentence."""


@dataclass(frozen=True)
class Variation:
    """A key and its values.

    Attributes
    ----------
    key : as the user wrote it
    unit : of the values, as the user wrote it; empty for bare numbers
    """

    key: str
    unit: str
    values: tuple[float, ...]
    logarithmic: bool

    @property
    def title(self) -> str:
        """Key and unit."""
        return f"{self.key}, {self.unit}" if self.unit else self.key


def variation(text: str) -> Variation:
    """The variation that KEY=FIRST..LAST UNIT:COUNT[:log] asks for.

    Raises
    ------
    SweepError
        if the text is not of this form, or the range makes no sense.
    """
    key, equals, rest = text.partition("=")
    match = _RANGE.fullmatch(rest)
    if not equals or not key.strip() or match is None:
        raise SweepError(f"--vary: found {shown(text)}; write {FORM}")
    first, last, count = float(match["first"]), float(match["last"]), int(match["count"])
    unit, logarithmic = match["unit"] or "", match["log"] is not None
    if match["other"] is not None and match["other"].strip() != unit.strip():
        raise SweepError(
            f"--vary {key}: found the units {shown(match['other'])} and {shown(unit)}; write one, at the end"
        )
    if not 2 <= count <= MOST_VALUES:
        raise SweepError(f"--vary {key}: found {count} values; a sweep has 2 to {MOST_VALUES}")
    if first == last or not math.isfinite(last - first):
        raise SweepError(f"--vary {key}: found {first:g} .. {last:g}; give two different, finite numbers")
    if logarithmic and first * last <= 0.0:
        raise SweepError(f"--vary {key}: found {first:g} .. {last:g} with log; both must be above zero, or both below")
    values = np.geomspace(first, last, count) if logarithmic else np.linspace(first, last, count)
    return Variation(key.strip(), unit.strip(), tuple(values.tolist()), logarithmic)


@dataclass(frozen=True, eq=False)
class SweepPoint:
    """One combination of values and the case that it makes.

    Attributes
    ----------
    values : of every variation
    """

    values: tuple[float, ...]
    case: Case


def sweep_points(
    name_or_path: str, variations: Sequence[Variation], level: int | None = None, order: int | None = None
) -> list[SweepPoint]:
    """The cases of a sweep; of several variations every combination, the last one's values changing first.

    level, order : those of every case, where they are given

    Raises
    ------
    CaseError
        if the case itself cannot be read.
    SweepError
        if a key is unknown or a value does not make a case.
    """
    name = load_case(name_or_path).name
    path = LIBRARY / f"{name_or_path}.toml"
    content = tomllib.loads((path if path.is_file() else Path(name_or_path)).read_text(encoding="utf-8-sig"))
    places: list[tuple[Any, Any]] = []
    for each in variations:
        table, last = _place(content, each.key)
        for (other, same), before in zip(places, variations, strict=False):
            if table is other and last == same:
                also = "" if each.key == before.key else f", once as {before.key}"
                raise SweepError(f"--vary: found {each.key} twice{also}; vary a key once")
        places.append((table, last))
    found = []
    combinations = list(product(*(each.values for each in variations)))
    if len(combinations) > MOST_VALUES:
        raise SweepError(f"--vary: found {len(combinations)} combinations; a sweep has at most {MOST_VALUES}")
    for values in combinations:
        for (table, last), each, value in zip(places, variations, values, strict=True):
            table[last] = _written(value, each.unit)
        try:
            case = case_from(name, checked_form(content), TRUTH)
        except (FormError, SceneError) as error:
            sentence = error.sentences[0] if isinstance(error, FormError) else str(error)
            at = " and ".join(f"{each.key} = {_text(v, each.unit)}" for each, v in zip(variations, values, strict=True))
            raise SweepError(f"--vary: {at} does not make a case: {sentence}") from error
        settings = RodModelSettings(level or case.rod_model.level, order or case.rod_model.order)
        found.append(SweepPoint(values, replace(case, rod_model=settings)))
    return found


def _written(value: float, unit: str) -> float | int | str:
    """A value as a case file would hold it: levels, orders and the like are whole numbers."""
    if unit:
        return f"{value!r} {unit}"
    return int(value) if value == int(value) else value


def _text(value: float, unit: str) -> str:
    return f"{value:.6g} {unit}".strip()


def _place(content: dict[str, Any], key: str) -> tuple[Any, Any]:
    """The table or list of a case file that holds a key, and its name or number there.

    A rod's key may be one of its material or section, which the rod then has to itself.

    Raises
    ------
    SweepError
        if there is no such key, or no number stands there.
    """
    parts = re.sub(r"\s*#", ".", key)
    table, rest = _walked(content, parts)
    if table is None and parts.startswith("rods."):
        table, rest = _of_rod(content, parts)
    if table is None:
        known = list(_leaves(content))
        near = get_close_matches(parts, known, n=3, cutoff=0.0)
        raise SweepError(
            f"--vary: found the key {shown(key)}, which the case has not; the nearest are {', '.join(near)}"
        )
    value = table[rest]
    if isinstance(value, (dict, list)):
        inside = next((leaf for leaf in _leaves(content) if leaf.startswith(f"{parts}.")), None)
        remedy = "name a key that holds a number" if inside is None else f"name one of its numbers, such as {inside}"
        what = f"a {'table' if isinstance(value, dict) else 'list'}"
        raise SweepError(f"--vary: found {shown(key)}, which is {what}; {remedy}")
    if isinstance(value, bool) or (isinstance(value, str) and not _QUANTITY.fullmatch(value)):
        raise SweepError(f"--vary: found {shown(key)}, where {shown(value)} stands; name a key that holds a number")
    return table, rest


def _walked(node: object, path: str) -> tuple[Any, Any]:
    """Where a path ends: the table or list and the name or number in it; (None, None) where it leads nowhere.

    Names may have dots in them.
    """
    if isinstance(node, list):
        head, _, rest = path.partition(".")
        index = int(head) - 1 if head.isdecimal() else -1
        if not 0 <= index < len(node):
            return None, None
        return _walked(node[index], rest) if rest else (node, index)
    if isinstance(node, dict):
        if path in node:
            return node, path
        for name in sorted(node, key=len, reverse=True):
            if path.startswith(f"{name}."):
                found = _walked(node[name], path[len(name) + 1 :])
                if found[0] is not None:
                    return found
    return None, None


def _of_rod(content: dict[str, Any], path: str) -> tuple[Any, Any]:
    """The key of a rod's material or section; a copy of its own where other rods have it, too."""
    for name, rod in content["rods"].items():
        if not path.startswith(f"rods.{name}."):
            continue
        key = path.removeprefix(f"rods.{name}.")
        head, dot, rest = key.partition(".")
        key = SYMBOLS.get(head, head) + dot + rest
        for kind in ("material", "section"):
            shared = content[f"{kind}s"][rod[kind]]
            if _walked(shared, key)[0] is None:
                continue
            if any(other[kind] == rod[kind] for each, other in content["rods"].items() if each != name):
                own = f"{rod[kind]} of {name}"
                content[f"{kind}s"][own], rod[kind] = deepcopy(shared), own
            return _walked(content[f"{kind}s"][rod[kind]], key)
    return None, None


def _leaves(content: dict[str, Any]) -> Iterator[str]:
    """Paths of all numbers of a case file that may be varied."""
    for name in TABLES:
        if name in content:
            yield from (f"{name}.{path}" for path in _paths(content[name]))
    for name, rod in content["rods"].items():
        symbols = {full: symbol for symbol, full in SYMBOLS.items()}
        for kind in ("material", "section"):
            paths = _paths(content[f"{kind}s"][rod[kind]])
            yield from (f"rods.{name}.{symbols.get(path, path)}" for path in paths)


def _paths(node: dict[str, Any] | list[Any]) -> Iterator[str]:
    entries = node.items() if isinstance(node, dict) else enumerate(node, 1)
    for name, value in entries:
        if isinstance(value, (dict, list)):
            yield from (f"{name}.{path}" for path in _paths(value))
        elif not isinstance(value, bool) and (not isinstance(value, str) or _QUANTITY.fullmatch(value)):
            yield str(name)
