"""From a case file to a `Case`, or to one sentence that says what is wrong with the file."""

from __future__ import annotations

import json
import tomllib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cases.case import QUANTITIES, Case, Check, Published, Quantity, RodModelSettings
from cases.scene import (
    Clamp,
    ContactPair,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    Vector,
)
from cases.units import UnitError, to_unit

if TYPE_CHECKING:  # the schema brings pydantic, which listing the library does without
    from pydantic_core import ErrorDetails

    from cases.schema import CaseFile, CompareTable, PublishedTable

LIBRARY = Path(__file__).parent / "library"
TRUTH = Path(__file__).parent / "truth"


class CaseError(Exception):
    """A case that cannot be read; its message is one sentence: file, key, what was found, what is right."""


def library_names() -> tuple[str, ...]:
    """Names of the cases that come with rodcheck, sorted."""
    return tuple(sorted(path.stem for path in LIBRARY.glob("*.toml")))


def load_case(name_or_path: str | Path) -> Case:
    """Read a case.

    Parameters
    ----------
    name_or_path : name of a case of the library, or path of a case file

    Raises
    ------
    CaseError
        if there is no such case, or its file is not a complete and consistent case.
    """
    path, shown = _find(name_or_path)
    content = _read(path, shown)
    file = _checked_form(content, shown)
    try:
        return _case(path.stem, file)
    except SceneError as error:
        raise CaseError(f"{shown}: {error}") from error


def _find(name_or_path: str | Path) -> tuple[Path, str]:
    """Path of a case file, and how messages call it."""
    given = str(name_or_path)
    if given in library_names():
        return LIBRARY / f"{given}.toml", f"{given}.toml"
    path = Path(given)
    try:
        exists, is_file = path.exists(), path.is_file()
    except (OSError, ValueError):  # a name too long for a file, or with a null character
        exists, is_file = False, False
    if is_file:
        return path, given
    if exists:
        found = "a folder" if path.is_dir() else "something that is not a file"
        raise CaseError(f"{given}: found {found}; give the path of a case file or a name that `rodcheck list` prints")
    near = _nearest(path.stem, library_names())
    hint = f"did you mean '{near}'" if near else "`rodcheck list` prints the library's names"
    raise CaseError(f"{_shown(given)}: found neither a case of the library nor a file; {hint}, and a path will do too")


def _read(path: Path, shown: str) -> dict[str, Any]:
    """Content of a TOML file that is not empty."""
    try:
        content = tomllib.loads(path.read_text(encoding="utf-8-sig"))
    except OSError as error:
        raise CaseError(f"{shown}: found a file that cannot be read ({error.strerror}); give a readable one") from error
    except UnicodeDecodeError as error:
        raise CaseError(f"{shown}: found something other than text; a case file is TOML text in UTF-8") from error
    except (ValueError, RecursionError) as error:  # TOMLDecodeError, or an integer of thousands of digits
        reason = "tables nested too deeply" if isinstance(error, RecursionError) else str(error)
        raise CaseError(f"{shown}: found text that is not TOML; mend this: {reason}") from error
    if not content:
        raise CaseError(f"{shown}: found an empty file; copy a case of the library ({LIBRARY.name}/*.toml) and edit it")
    return content


def _checked_form(content: dict[str, Any], shown: str) -> CaseFile:
    """The content with every key known and every value of its kind, in N, mm and MPa."""
    from pydantic import ValidationError

    from cases.schema import CaseFile

    try:
        return CaseFile.model_validate(content)
    except ValidationError as error:
        problems = error.errors(include_url=False)
    sentences = _sentences(problems)
    others = len(sentences) - 1
    more = f" (and {others} more problem{'s' if others > 1 else ''})" if others else ""
    raise CaseError(f"{shown}: {sentences[0]}{more}")


def _sentences(problems: list[ErrorDetails]) -> list[str]:
    """What is wrong with the form of a file, misspelt keys first."""
    from cases.schema import case_schema

    schema = case_schema()
    misspelt, meant = [], set()
    for problem in problems:
        if problem["type"] == "extra_forbidden":
            *table, key = problem["loc"]
            known = _keys(schema, table)
            near = _nearest(str(key), known)
            if near:
                meant.add((*table, near))
            remedy = f"did you mean '{near}'?" if near else f"the keys here are {_listed(known)}"
            misspelt.append(f"{_key(problem['loc'])}: found an unknown key; {remedy}")
    others = [p for p in problems if p["type"] != "extra_forbidden" and p["loc"] not in meant]
    return misspelt + [_sentence(problem, schema) for problem in others]


def _sentence(problem: ErrorDetails, schema: dict[str, Any]) -> str:
    """What is wrong with one key."""
    place, kind, found = problem["loc"], problem["type"], _shown(problem["input"])
    if place[-1] == "[key]":
        remedy = "use letters, digits, and _ . - or blanks after the first"
        return f"{_key(place[:-2])}: found the name {_shown(place[-2])}; {remedy}"
    if kind == "missing" and isinstance(place[-1], int):  # too few entries in a list
        place = place[:-1]
    elif kind == "missing":
        return f"{_key(place)}: found no such key; needed: {_meaning(schema, place)}"
    if kind == "value_error":
        remedy = str(problem["ctx"]["error"])
    elif kind == "literal_error":
        remedy = f"write {problem['ctx']['expected']}"
    else:
        remedy = f"needed: {_meaning(schema, place)}"
    return f"{_key(place)}: found {found}; {remedy}"


def _key(place: Iterable[str | int]) -> str:
    """Say where in a case file: "loads #1.force #3" is the third component of the first load's force."""
    parts = [f" #{part + 1}" if isinstance(part, int) else f".{part}" for part in place]
    return "".join(parts).removeprefix(".")


def _nodes(schema: dict[str, Any], place: Iterable[str | int]) -> Iterator[dict[str, Any]]:
    """Parts of the JSON Schema from the whole file down to a place."""
    node = schema
    yield node
    for part in place:
        if isinstance(part, int):
            node = node.get("items") or node["prefixItems"][min(part, len(node["prefixItems"]) - 1)]
        else:
            named = node.get("patternProperties", {}).values()  # tables that the author names
            node = node.get("properties", {}).get(part) or next(iter(named))
        reference = node.get("$ref")
        if reference:
            # What stands beside a reference says more about this place than what it refers to.
            node = {**schema["$defs"][reference.rsplit("/", 1)[1]], **node}
        yield node


def _keys(schema: dict[str, Any], table: Iterable[str | int]) -> tuple[str, ...]:
    """Keys that a table may have."""
    *_, node = _nodes(schema, table)
    return tuple(node["properties"])


def _meaning(schema: dict[str, Any], place: Iterable[str | int]) -> str:
    """Description of a place, or of the innermost one around it that has one."""
    texts = [node["description"] for node in _nodes(schema, place) if "description" in node]
    return " ".join(texts[-1].split()).rstrip(".")


def _nearest(word: str, words: Iterable[str]) -> str | None:
    near = get_close_matches(word, list(words), n=1, cutoff=0.6)
    return near[0] if near else None


def _listed(words: Iterable[str]) -> str:
    return ", ".join(f"'{word}'" for word in words) or "none"


def _shown(value: object) -> str:
    """A value of a TOML file, on one line and not too long."""
    if isinstance(value, dict):
        return "a table"
    text = json.dumps(value, ensure_ascii=False, default=str).replace("NaN", "nan").replace("Infinity", "inf")
    return text if len(text) <= 60 else text[:57] + "..."


@contextmanager
def _inside(table: str) -> Iterator[None]:
    """Say in which table the key of a SceneError stands."""
    try:
        yield
    except SceneError as error:
        raise SceneError(f"{table}.{error.key}", error.found, error.remedy) from error


def _require(condition: bool, key: str, found: object, remedy: str) -> None:
    if not condition:
        raise SceneError(key, _shown(found), remedy)


def _require_known(name: str, names: Iterable[str], key: str, table: str) -> None:
    """See that a name is one of a table's."""
    names = list(names)
    near = _nearest(name, names)
    hint = f"; did you mean '{near}'?" if near else ""
    _require(name in names, key, name, f"the [{table}] are {_listed(names)}{hint}")


def _case(name: str, file: CaseFile) -> Case:
    scene = _scene(name, file)
    compare = tuple(_check(f"compare #{i}", table, scene) for i, table in enumerate(file.compare, 1))
    published = tuple(_published(f"published #{i}", table, scene) for i, table in enumerate(file.published, 1))
    for index, check in enumerate(compare):
        twice = any((check.quantity, check.of, check.point) == (c.quantity, c.of, c.point) for c in compare[:index])
        _require(not twice, f"compare #{index + 1}", f"{check.quantity} of {check.of} again", "compare it once")
    independent = None
    if file.independent is not None:
        truths = sorted(path.name for path in TRUTH.glob("*.json"))
        remedy = f"the files in cases/truth are {_listed(truths)}"
        _require(file.independent in truths, "independent", file.independent, remedy)
        independent = TRUTH / file.independent
    settings = RodModelSettings(file.rod_model.level, file.rod_model.order)
    return Case(name, file.title, file.description.strip(), scene, settings, compare, published, independent)


def _scene(name: str, file: CaseFile) -> Scene:
    materials, sections, rods = {}, {}, []
    for key, material in file.materials.items():
        with _inside(f"materials.{key}"):
            materials[key] = Material(material.young_modulus, material.poisson_ratio)
    for key, section in file.sections.items():
        with _inside(f"sections.{key}"):
            sections[key] = Rectangle(section.width, section.height)
    for key, rod in file.rods.items():
        _require_known(rod.section, sections, f"rods.{key}.section", "sections")
        _require_known(rod.material, materials, f"rods.{key}.material", "materials")
        with _inside(f"rods.{key}.centre_line"):
            line = Line(rod.centre_line.start, rod.centre_line.end, rod.centre_line.up)
        rods.append(Rod(key, line, sections[rod.section], materials[rod.material], rod.element_borders))
    for i, support in enumerate(file.supports, 1):
        _require_known(support.rod, file.rods, f"supports #{i}.rod", "rods")
    for i, load in enumerate(file.loads, 1):
        _require_known(load.rod, file.rods, f"loads #{i}.rod", "rods")
    for key, pair in file.contacts.items():
        _require_known(pair.first.rod, file.rods, f"contacts.{key}.first.rod", "rods")
        _require_known(pair.second.rod, file.rods, f"contacts.{key}.second.rod", "rods")
    return Scene(
        name=name,
        rods=tuple(rods),
        supports=tuple(Clamp(support.rod, support.end) for support in file.supports),
        loads=tuple(SectionForce(load.rod, load.position, load.force) for load in file.loads),
        contacts=tuple(
            ContactPair(
                key,
                RodFace(pair.first.rod, pair.first.face),
                RodFace(pair.second.rod, pair.second.face),
                pair.zone,
                pair.gap,
                pair.penalty,
            )
            for key, pair in file.contacts.items()
        ),
    )


def _of(key: str, table: CompareTable | PublishedTable, scene: Scene) -> str:
    """Name of the rod or contact pair that a quantity belongs to."""
    wanted = QUANTITIES[table.quantity].of
    other = "contact" if wanted == "rod" else "rod"
    _require(
        getattr(table, other) is None,
        f"{key}.{other}",
        getattr(table, other),
        f"{table.quantity} is of a {wanted}",
    )
    name = getattr(table, wanted)
    known = [rod.name for rod in scene.rods] if wanted == "rod" else [pair.name for pair in scene.contacts]
    if name is None:
        remedy = f"{table.quantity} is of a {wanted}, one of {_listed(known)}"
        raise SceneError(f"{key}.{wanted}", "no such key", remedy)
    _require_known(name, known, f"{key}.{wanted}", f"{wanted}s")
    return str(name)


def _tolerance(key: str, quantity: Quantity, text: str) -> float:
    relative = QUANTITIES[quantity].relative
    form = 'relative, as in "0.1 %"' if relative else 'a length, as in "1 mm"'
    remedy = f"the tolerance of {quantity} is {form}"
    try:
        tolerance = to_unit(text, "%" if relative else "mm")
    except UnitError as error:
        raise SceneError(f"{key}.tolerance", _shown(text), remedy) from error
    _require(tolerance > 0.0, f"{key}.tolerance", text, "a tolerance must be positive")
    return tolerance


def _check(key: str, table: CompareTable, scene: Scene) -> Check:
    comparable = [name for name, kind in QUANTITIES.items() if kind.comparable]
    remedy = f"it does not converge in 3D; compare one of {_listed(comparable)}"
    _require(table.quantity in comparable, f"{key}.quantity", table.quantity, remedy)
    of = _of(key, table, scene)
    if table.quantity == "stress_s":
        if table.point is None:
            raise SceneError(f"{key}.point", "no such key", "needed: the point [x, y, s] where the stress is compared")
        _require_inside(f"{key}.point", table.point, scene.rod(of))
    else:
        _require(table.point is None, f"{key}.point", table.point, "only stress_s is at a point")
    return Check(table.quantity, of, _tolerance(key, table.quantity, table.tolerance), table.point)


def _require_inside(key: str, point: Vector, rod: Rod) -> None:
    x, y, s = point
    width, height, length = rod.section.width, rod.section.height, rod.length
    inside = abs(x) <= width / 2 and abs(y) <= height / 2 and 0.0 <= s <= length
    limits = f"x is within +-{width / 2:g}, y within +-{height / 2:g} and s from 0 to {length:g} mm"
    _require(inside, key, list(point), f"in rod '{rod.name}' {limits}")


def _published(key: str, table: PublishedTable, scene: Scene) -> Published:
    kind = QUANTITIES[table.quantity]
    publishable = [name for name, each in QUANTITIES.items() if each.publishable]
    _require(
        table.quantity in publishable,
        f"{key}.quantity",
        table.quantity,
        f"write one of {_listed(publishable)}",
    )
    of = _of(key, table, scene)
    entries = table.value if isinstance(table.value, list) else [table.value]
    try:
        value = tuple(to_unit(entry, kind.unit) for entry in entries)
    except UnitError as error:
        raise SceneError(f"{key}.value", _shown(table.value), error.remedy) from error
    if table.quantity in ("contact_edges", "contact_edges_outer"):
        rising = all(a < b for a, b in pairwise(value))
        remedy = "write start and end of each stretch in contact in turn, rising"
        _require(len(value) > 0 and len(value) % 2 == 0 and rising, f"{key}.value", table.value, remedy)
    else:
        _require(len(value) == 1, f"{key}.value", table.value, "one value is needed")
    return Published(table.quantity, of, value, _tolerance(key, table.quantity, table.tolerance), table.source)
