"""Files written whole or not at all."""

from __future__ import annotations

import os
import re
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

# What `in_place_of` writes to.
TEMPORARY_NAME = re.compile(r"\..+\.[a-z0-9_]{8}\.tmp")


@contextmanager
def in_place_of(path: Path) -> Iterator[Path]:
    """A temporary file beside `path`, to be written, that takes its place at the end; the folder is made if missing.

    An interrupted or failed write leaves what was there before.

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".tmp")
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        with temporary.open("rb") as stream:
            os.fsync(stream.fileno())
        temporary.chmod(0o644)
        temporary.replace(path)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def remove_left_behind(folder: Path) -> None:
    """Remove what killed processes left half written in a folder and those below; nobody else may be writing there."""
    for path in list(folder.rglob(".*.tmp")):
        if TEMPORARY_NAME.fullmatch(path.name):
            path.unlink(missing_ok=True)


def write_whole(path: Path, text: str) -> None:
    """Write a text file, whole or not at all.

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    with in_place_of(path) as temporary:
        temporary.write_text(text, encoding="utf-8")


def write_whole_bytes(path: Path, data: bytes) -> None:
    """Write a file, whole or not at all.

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    with in_place_of(path) as temporary:
        temporary.write_bytes(data)


def write_new(path: Path, text: str) -> None:
    """Write a text file that does not exist yet, whole or not at all.

    Raises
    ------
    FileExistsError
        if there is something of this name.
    OSError
        if the folder or the file cannot be written.
    """
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.name}.", suffix=".tmp")
    os.close(handle)
    temporary = Path(name)
    try:
        temporary.write_text(text, encoding="utf-8")
        temporary.chmod(0o644)
        # A link is made at once and never takes the place of a file, which a check before a rename could.
        os.link(temporary, path)
    finally:
        temporary.unlink(missing_ok=True)
