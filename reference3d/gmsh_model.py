"""A model of gmsh for one mesh, which leaves the caller's gmsh, where there is one at work, as it was."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from typing import Any


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
