"""What `rodcheck new` does: choose, ask on a terminal, write the case file and the schema beside it."""

from __future__ import annotations

import json
import sys
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rich.console import Console

from cases.loader import FILE_NAME, library_names
from cases.schema import case_schema
from cases.wording import listed, nearest
from reports.new_case.asking import asked_choices, asked_template, asked_title
from reports.new_case.templates import TEMPLATES, ChoiceError, Template, case_text
from reports.store import write_new

# The first line of every template names it, so that editors find it beside the case.
SCHEMA = "case.schema.json"


class NewCaseError(Exception):
    """No case file can be made; the message says why, in one sentence."""


@dataclass(frozen=True)
class Written:
    """The new case file, and what its author should know, a sentence each."""

    path: Path
    notes: tuple[str, ...]


def new_case_file(name: str, template: str | None, title: str | None, given: Mapping[str, str]) -> Written:
    """Write a case file and, where there is none beside it, its schema.

    Parameters
    ----------
    name : of the case, or a path ending in it
    template, title : None to have them asked for on a terminal, or else the first template and its words
    given : values by key

    Raises
    ------
    NewCaseError
        if there is such a file already, or a value cannot be taken.
    """
    path = _path(name)
    chosen = None if template is None else _template(template)
    if chosen is not None:
        _require_choices(chosen, given)
    notes = []
    if sys.stdin is not None and sys.stdin.isatty():
        console = Console(stderr=True, highlight=False)
        try:
            chosen = asked_template(console) if chosen is None else chosen
            _require_choices(chosen, given)
            title = asked_title(console, chosen) if title is None else title
            given = asked_choices(console, chosen, given)
        except EOFError as error:
            raise NewCaseError("found the end of input instead of an answer; nothing was written") from error
    else:
        chosen = TEMPLATES[0] if chosen is None else chosen
        _require_choices(chosen, given)
        missing = [f"{choice.key} = {choice.default}" for choice in chosen.choices if choice.key not in given]
        kept = [*([] if template else [f"template = {chosen.name}"]), *missing]
        notes = [f"not a terminal, so that nothing was asked: took {', '.join(kept)}"] if kept else []
    try:
        text = case_text(chosen, chosen.title if title is None else title, given)
    except ChoiceError as error:
        flag = f"--{error.key.replace('_', '-')}: found " if error.key else ""
        raise NewCaseError(f"{flag}{error}") from error
    try:
        write_new(path, text)
    except FileExistsError as error:
        raise NewCaseError(_exists(path)) from error
    except OSError as error:
        raise NewCaseError(f"cannot write {path} ({error.strerror}); give another place") from error
    notes += _schema_beside(path)
    return Written(path, (*notes, f"next: rodcheck check {path}"))


def _path(name: str) -> Path:
    path = Path(name if name.endswith(".toml") else f"{name}.toml")
    if not FILE_NAME.fullmatch(path.stem):
        remedy = "use letters, digits and _ . , = ( ) + - or blanks after the first, 100 at most"
        raise NewCaseError(f"found the name {path.stem!r}; {remedy}")
    if path.stem in library_names():
        raise NewCaseError(f"found the name {path.stem!r}, which a case of the library has; take another")
    if not path.parent.is_dir():
        raise NewCaseError(f"found no folder {path.parent}; make it first")
    if path.exists() or path.is_symlink():
        raise NewCaseError(_exists(path))
    return path


def _exists(path: Path) -> str:
    return f"found {path} already there, and nothing is overwritten; take another name"


def _template(name: str) -> Template:
    names = [template.name for template in TEMPLATES]
    if name not in names:
        near = nearest(name, names)
        hint = f"; did you mean '{near}'?" if near else ""
        raise NewCaseError(f"--template: found {name!r}; the templates are {listed(names)}{hint}")
    return TEMPLATES[names.index(name)]


def _require_choices(template: Template, given: Mapping[str, str]) -> None:
    keys = [choice.key for choice in template.choices]
    for key in given:
        if key not in keys:
            flags = ", ".join(f"--{each.replace('_', '-')}" for each in keys)
            flag = f"--{key.replace('_', '-')}"
            raise NewCaseError(f"{flag}: found with template {template.name}, which has {flags}; leave it out")


def _schema_beside(path: Path) -> list[str]:
    """Write the schema where there is none; what to say about it."""
    schema, text = path.parent / SCHEMA, schema_text()
    try:
        write_new(schema, text)
    except FileExistsError:
        if schema.is_file() and schema.read_bytes() == text.encode():
            return []
        return [f"{schema} is of another version and was left; `rodcheck schema case > {schema}` renews it"]
    except OSError as error:
        return [f"cannot write {schema} ({error.strerror}), without which editors complete nothing"]
    return [f"wrote {schema}, by which editors complete case files"]


def schema_text() -> str:
    """The JSON Schema as `rodcheck schema case` prints it."""
    return json.dumps(case_schema(), indent=2) + "\n"
