"""From a case file to a `Case`, or to one sentence that says what is wrong with the file."""

from __future__ import annotations

import re
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

from cases.case import Case
from cases.scene import SceneError
from cases.wording import in_one_line, nearest, shown

LIBRARY = Path(__file__).parent / "library"
TRUTH = Path(__file__).parent / "truth"

# Files of results and pages are named after the case, in commands and addresses, too.
FILE_NAME = re.compile(r"\w[\w .,=()+-]{0,99}")
# Elements by the ten thousand have room in it. Larger or deeper files would keep the parser busy for minutes.
LARGEST_FILE = 1_000_000
_DEEPEST = 30
_DEEP_KEY = re.compile(rf"""(?<![\w-])(?:(?:[\w-]+|"[^"\n]*"|'[^'\n]*')[ \t]*\.[ \t]*){{{_DEEPEST}}}""")


class CaseError(Exception):
    """A case that cannot be read; its message is one sentence: file, key, what was found, what is right."""

    def __init__(self, sentence: str) -> None:
        super().__init__(in_one_line(sentence))


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
    # Here, since the schema brings pydantic, which listing the library's names does without.
    from cases.building import case_from
    from cases.form import FormError, checked_form

    path, source = _find(name_or_path)
    if not FILE_NAME.fullmatch(path.stem):
        remedy = "rename it with letters, digits and _ . , = ( ) + - or blanks after the first, 100 at most"
        raise CaseError(f"{source}: found the file name {shown(path.name)}; {remedy}")
    text, content = _read(path, source)
    try:
        return replace(case_from(path.stem, checked_form(content), TRUTH), text=text)
    except FormError as error:
        others = error.count - 1
        more = f" (and {others} more problem{'s' if others > 1 else ''})" if others else ""
        raise CaseError(f"{source}: {error.sentences[0]}{more}") from error
    except SceneError as error:
        raise CaseError(f"{source}: {error}") from error


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
    near = nearest(path.stem, library_names())
    hint = f"did you mean '{near}'" if near else "`rodcheck list` prints the library's names"
    raise CaseError(f"{shown(given)}: found neither a case of the library nor a file; {hint}, and a path will do too")


def _read(path: Path, source: str) -> tuple[str, dict[str, Any]]:
    """Text and content of a TOML file that is not empty, nor deeper than any case."""
    try:
        size = path.stat().st_size
        if size > LARGEST_FILE:
            raise CaseError(f"{source}: found {size / 1e6:.3g} MB; a case file has at most {LARGEST_FILE / 1e6:g} MB")
        text = path.read_text(encoding="utf-8-sig")
        deep = _DEEP_KEY.search(text) is not None
        content = {} if deep else tomllib.loads(text)
    except OSError as error:
        raise CaseError(
            f"{source}: found a file that cannot be read ({error.strerror}); give a readable one"
        ) from error
    except UnicodeDecodeError as error:
        raise CaseError(f"{source}: found something other than text; a case file is TOML text in UTF-8") from error
    except RecursionError:
        deep = True
    except ValueError as error:  # TOMLDecodeError, or an integer of thousands of digits
        raise CaseError(f"{source}: found text that is not TOML; mend this: {error}") from error
    if deep or _is_deep(content):
        raise CaseError(f"{source}: found tables or lists nested too deeply; no key of a case needs {_DEEPEST} levels")
    if not content:
        raise CaseError(
            f"{source}: found an empty file; copy a case of the library ({LIBRARY.name}/*.toml) and edit it"
        )
    return text, content


def _is_deep(content: dict[str, Any]) -> bool:
    """Whether tables and lists are nested deeper than anything that reads them need follow."""
    level: list[Any] = [content]
    for _ in range(_DEEPEST):
        level = [
            each
            for node in level
            for each in (node.values() if isinstance(node, dict) else node)
            if isinstance(each, dict | list)
        ]
        if not level:
            return False
    return True
