"""Results on disk, found again by content: by what was asked and by the code that answered.

An entry is a text file: a line with the checksum of all that follows, then the result in plain JSON. A damaged entry is
removed and named, and its result computed again; a folder that cannot be used costs one sentence, never a run.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import time
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from reports.plain import from_plain, to_plain
from reports.store import write_whole

MAGIC = "rodcheck cache 1"
# An entry that nobody asked for in so many days is removed; code that changes leaves many behind.
KEPT_DAYS = 30
# Writing takes milliseconds: a temporary file as old as this, in seconds, was left by a process that was killed.
LEFT_BEHIND = 60
OWN_NAME = re.compile(r"[a-z]+-[0-9a-f]{64}\.json")
TEMPORARY_NAME = re.compile(r"\.[a-z]+-[0-9a-f]{64}\.json\..*\.tmp")


@dataclass(frozen=True)
class Kept:
    """A result from the cache.

    Attributes
    ----------
    value : what was computed
    date : the day it was computed on, YYYY-MM-DD
    """

    value: Any
    date: str


class UnusableEntry(Exception):
    """A file in the place of an entry cannot be used; the message says why."""


def default_folder() -> Path:
    """The folder `rodcheck` in the user's cache folder (XDG Base Directory Specification).

    Raises
    ------
    RuntimeError
        if the user has no home.
    """
    given = Path(os.environ.get("XDG_CACHE_HOME", ""))
    return (given if given.is_absolute() else Path.home() / ".cache") / "rodcheck"


def key(question: object) -> str:
    """Fingerprint of a question: of all that its answer depends on, every bit of every number included."""
    return hashlib.sha256(json.dumps(to_plain(question)).encode()).hexdigest()


class Cache:
    """A folder of results.

    Attributes
    ----------
    notes : what the user should know of it, a sentence each
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.notes: list[str] = []

    def find(self, model: str, question: object, kinds: Iterable[type]) -> Kept | None:
        """The result kept for a question, or None.

        Parameters
        ----------
        model : who answers it, a word in small letters
        kinds : the dataclasses that the result is made of
        """
        path = self._path(model, question)
        try:
            content = path.read_bytes()
        except FileNotFoundError:
            return None
        except OSError as error:
            self._unusable("read", error)
            return None
        try:
            found = _read(content, path.name, kinds)
        except UnusableEntry as error:
            self._note(f"cache: {path} {error}; it was removed, and its result is computed again")
            self._remove(path)
            return None
        with suppress(OSError):
            os.utime(path)
        return found

    def keep(self, model: str, question: object, value: object) -> None:
        """Keep the result of a question; a folder that cannot be written is noted."""
        try:
            self.write(model, question, value)
        except OSError as error:
            self._unusable("write to", error)

    def write(self, model: str, question: object, value: object) -> None:
        """Keep the result of a question.

        Raises
        ------
        OSError
            if it cannot be written.
        """
        path = self._path(model, question)
        body = json.dumps({"of": path.name, "date": datetime.now(UTC).date().isoformat(), "value": to_plain(value)})
        write_whole(path, f"{MAGIC} {hashlib.sha256(body.encode()).hexdigest()}\n{body}\n")

    def clean(self) -> None:
        """Remove what killed processes left behind, and entries that have not been asked for in a long time."""
        now = time.time()
        limits = ((OWN_NAME, KEPT_DAYS * 86400.0), (TEMPORARY_NAME, LEFT_BEHIND))
        # a folder or file that is not there, or no longer, or not ours to look at, needs no cleaning
        with suppress(OSError):
            for path in list(self.folder.iterdir()):
                for name, limit in limits:
                    if name.fullmatch(path.name) and now - path.stat().st_mtime > limit:
                        path.unlink(missing_ok=True)

    def _path(self, model: str, question: object) -> Path:
        return self.folder / f"{model}-{key(question)}.json"

    def _remove(self, path: Path) -> None:
        try:
            path.unlink(missing_ok=True)
        except OSError as error:
            self._unusable("remove a file from", error)

    def _unusable(self, what: str, error: OSError) -> None:
        self._note(f"cache: cannot {what} {self.folder} ({error.strerror}); results are computed without it")

    def _note(self, sentence: str) -> None:
        if sentence not in self.notes:
            self.notes.append(sentence)


def _read(content: bytes, name: str, kinds: Iterable[type]) -> Kept:
    """The result in a file's content, if it is an entry of that name, and whole."""
    head, _, rest = content.partition(b"\n")
    magic, _, checksum = head.rpartition(b" ")
    if magic != MAGIC.encode():
        raise UnusableEntry("is not a file that rodcheck wrote")
    body = rest.removesuffix(b"\n")
    if hashlib.sha256(body).hexdigest().encode() != checksum:
        raise UnusableEntry("is damaged")
    entry = json.loads(body)
    if entry["of"] != name:
        raise UnusableEntry(f"is a copy of {entry['of']}")
    try:
        return Kept(from_plain(entry["value"], kinds), entry["date"])
    except (KeyError, TypeError, ValueError) as error:
        raise UnusableEntry("holds a result of another form") from error
