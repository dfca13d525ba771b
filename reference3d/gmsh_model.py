"""A model of gmsh for one mesh, which leaves the caller's gmsh, where there is one at work, as it was."""

from __future__ import annotations

import ctypes
import signal
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any

# Bytes that hold a `struct sigaction` of any system.
SIGACTION = 1024


@contextmanager
def new_model(name: str, options: Mapping[str, float]) -> Iterator[Any]:
    """The module gmsh, quiet, with an empty model; afterwards model and options are those from before.

    Parameters
    ----------
    options : numbers by the names that gmsh gives them
    """
    import gmsh  # its wheel needs X libraries, so only making a mesh asks for it

    started_here = not gmsh.isInitialized()
    if started_here:
        with sigpipe_kept():
            gmsh.initialize(interruptible=False)
    wanted = {"General.Terminal": 0.0, **options}
    before, current = {each: gmsh.option.getNumber(each) for each in wanted}, gmsh.model.getCurrent()
    try:
        for each, value in wanted.items():
            gmsh.option.setNumber(each, value)
        gmsh.model.add(name)
        yield gmsh
    finally:
        gmsh.model.remove()
        gmsh.model.setCurrent(current)
        for each, value in before.items():
            gmsh.option.setNumber(each, value)
        if started_here:
            gmsh.finalize()


@contextmanager
def sigpipe_kept() -> Iterator[None]:
    """What a write to a pipe without a reader does stays as it was: for Python, an exception.

    Initialising gmsh sets SIGPIPE to the system's default, which is to end the whole process without a word.
    """
    if not hasattr(signal, "SIGPIPE"):
        yield
        return
    # Python's own module may set handlers in the main thread alone, and meshes are made in others, too.
    sigaction = ctypes.CDLL(None).sigaction
    before = ctypes.create_string_buffer(SIGACTION)
    sigaction(signal.SIGPIPE, None, before)
    try:
        yield
    finally:
        sigaction(signal.SIGPIPE, before, None)
