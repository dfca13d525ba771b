"""From the content of a case file to tables whose every key is known, or to sentences that say what is wrong."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from functools import cache
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from cases.schema import CaseFile, case_schema
from cases.wording import listed, nearest, shown

# Problems of a file that are put into words; the others are counted.
_WORDED = 100


class FormError(Exception):
    """A file that has not the form of a case.

    Attributes
    ----------
    sentences : what is wrong with which key, the most helpful first; not of every key where very many are wrong
    count : of all that is wrong
    """

    def __init__(self, sentences: list[str], count: int) -> None:
        super().__init__(*sentences)
        self.sentences = sentences
        self.count = count


def checked_form(content: dict[str, Any]) -> CaseFile:
    """The content with every key known and every value of its kind, in N, mm, MPa and rad.

    Raises
    ------
    FormError
        if a key is unknown or missing, or a value not of its kind.
    """
    try:
        return CaseFile.model_validate(content)
    except ValidationError as error:
        problems = error.errors(include_url=False)
    sentences = _sentences(problems[:_WORDED])
    raise FormError(sentences, len(sentences) + max(0, len(problems) - _WORDED))


@cache
def _schema() -> dict[str, Any]:
    return case_schema()


def _sentences(problems: list[ErrorDetails]) -> list[str]:
    """What is wrong with the form of a file, misspelt keys first."""
    schema = _schema()
    misspelt, meant = [], set()
    for problem in problems:
        if problem["type"] == "extra_forbidden":
            *table, key = problem["loc"]
            known, other_keys = _keys(schema, table), _keys_of_others(schema, table)
            elsewhere = other_keys.get(str(key))
            near = nearest(str(key), known) or (None if elsewhere else nearest(str(key), tuple(other_keys)))
            if near:
                meant.add((*table, near))
            remedy = f"did you mean '{near}'?" if near else f"the keys here are {listed(known)}"
            remedy = f"it belongs to {elsewhere}; {remedy}" if elsewhere else remedy
            misspelt.append(f"{_key(problem['loc'], schema)}: found an unknown key; {remedy}")
    others = [p for p in problems if p["type"] != "extra_forbidden" and p["loc"] not in meant]
    return misspelt + [_sentence(problem, schema) for problem in others]


def _sentence(problem: ErrorDetails, schema: dict[str, Any]) -> str:
    """What is wrong with one key."""
    place, kind, found = problem["loc"], problem["type"], shown(problem["input"])
    if place[-1] == "[key]":
        remedy = "use letters, digits, and _ . - or blanks after the first"
        return f"{_key(place[:-2], schema)}: found the name {shown(place[-2])}; {remedy}"
    if kind in ("union_tag_invalid", "union_tag_not_found"):
        return _sentence_of_tag(problem, schema)
    if kind == "missing" and isinstance(place[-1], int):  # too few entries in a list
        place = place[:-1]
    elif kind == "missing":
        return f"{_key(place, schema)}: found no such key; needed: {_meaning(schema, place)}"
    if kind == "value_error":
        remedy = str(problem["ctx"]["error"])
    elif kind == "literal_error":
        remedy = f"write {problem['ctx']['expected']}"
    else:
        remedy = f"needed: {_meaning(schema, place)}"
    return f"{_key(place, schema)}: found {found}; {remedy}"


def _sentence_of_tag(problem: ErrorDetails, schema: dict[str, Any]) -> str:
    """What is wrong with the key that says which of several tables this is."""
    *_, table = _nodes(schema, problem["loc"])
    tag, known = table["discriminator"]["propertyName"], tuple(table["discriminator"]["mapping"])
    key = f"{_key(problem['loc'], schema)}.{tag}"
    if problem["type"] == "union_tag_not_found":
        return f"{key}: found no such key; needed: one of {listed(known)}"
    found = problem["input"][tag]
    near = nearest(found, known) if isinstance(found, str) else None
    hint = f"; did you mean '{near}'?" if near else ""
    return f"{key}: found {shown(found)}; write one of {listed(known)}{hint}"


def _key(place: Iterable[str | int], schema: dict[str, Any]) -> str:
    """Say where in a case file: "loads #1.force #3" is the third component of the first load's force."""
    parts = [
        f" #{part + 1}" if isinstance(part, int) else f".{part}"
        for part, table in zip(place, _nodes(schema, place), strict=False)
        if "oneOf" not in table  # there the place only says which of several forms was chosen
    ]
    return "".join(parts).removeprefix(".")


def _nodes(schema: dict[str, Any], place: Iterable[str | int]) -> Iterator[dict[str, Any]]:
    """Parts of the JSON Schema from the whole file down to a place."""
    node = schema
    yield node
    for part in place:
        if "discriminator" in node:
            node = {"$ref": node["discriminator"]["mapping"][part]}
        elif "oneOf" in node:  # forms that no key names are named as in the schema
            node = {"$ref": f"#/$defs/{part}"}
        elif isinstance(part, int):
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


def _properties(schema: dict[str, Any], form: dict[str, Any]) -> tuple[str, ...]:
    """Keys that a table of a form, or of one of several, may have."""
    node = schema["$defs"][form["$ref"].rsplit("/", 1)[1]]
    keys = dict.fromkeys(key for each in node.get("oneOf", ()) for key in _properties(schema, each))
    return (*node.get("properties", ()), *keys)


def _keys_of_others(schema: dict[str, Any], table: Iterable[str | int]) -> dict[str, str]:
    """Where one of several tables was chosen: the keys that the others have, and which of them has each."""
    *_, union, chosen = ({}, *_nodes(schema, table))
    if "oneOf" in union and "discriminator" not in union:
        forms = [_properties(schema, form) for form in union["oneOf"]]
        return {key: f"a table of {listed(form)}" for form in forms for key in form if key not in chosen["properties"]}
    if "discriminator" not in union:
        return {}
    tag, mapping = union["discriminator"]["propertyName"], union["discriminator"]["mapping"]
    others: dict[str, list[str]] = {}
    for name, reference in mapping.items():
        for key in schema["$defs"][reference.rsplit("/", 1)[1]]["properties"].keys() - chosen["properties"].keys():
            others.setdefault(key, []).append(name)
    return {key: f"{tag} = {', '.join(shown(name) for name in names)}" for key, names in others.items()}


def _meaning(schema: dict[str, Any], place: Iterable[str | int]) -> str:
    """Description of a place, or of the innermost one around it that has one."""
    texts = [node["description"] for node in _nodes(schema, place) if "description" in node]
    return " ".join(texts[-1].split()).rstrip(".")
