"""Meshes are made without a trace in the gmsh of whoever asks for them."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import nullcontext

import gmsh
import pytest

from reference3d.gmsh_model import new_model, sigpipe_kept

OPTIONS = {"Mesh.Algorithm": 8.0}


@pytest.fixture
def own() -> Iterator[str]:
    """A model of the caller's, with a point in it."""
    with sigpipe_kept():
        gmsh.initialize(["", "-v", "0"], interruptible=False)
    gmsh.model.add("own")
    gmsh.model.geo.addPoint(0.0, 0.0, 0.0)
    gmsh.model.geo.synchronize()
    yield gmsh.model.getCurrent()
    gmsh.finalize()


@pytest.mark.parametrize("fails", [False, True])
def test_the_callers_model_and_options_are_as_before_even_after_a_failure(own: str, fails: bool) -> None:
    models, algorithm = gmsh.model.list(), gmsh.option.getNumber("Mesh.Algorithm")
    ends = pytest.raises(RuntimeError, match="not made") if fails else nullcontext()

    with ends, new_model("mesh", OPTIONS) as module:
        assert module.model.getCurrent() == "mesh"
        assert module.option.getNumber("Mesh.Algorithm") == 8.0
        if fails:
            raise RuntimeError("the mesh is not made")

    assert (gmsh.model.list(), gmsh.model.getCurrent()) == (models, own)
    assert gmsh.option.getNumber("Mesh.Algorithm") == algorithm
    assert gmsh.model.getEntities(0) == [(0, 1)]


def test_gmsh_that_was_not_at_work_is_not_afterwards() -> None:
    assert not gmsh.isInitialized()

    with new_model("mesh", {}):
        assert gmsh.isInitialized()

    assert not gmsh.isInitialized()


@pytest.mark.slow
@pytest.mark.skipif(os.name != "posix", reason="there are no such signals")
@pytest.mark.parametrize("thread", [False, True])
def test_a_write_to_a_pipe_that_nobody_reads_is_an_exception_after_a_mesh_as_before(thread: bool) -> None:
    code = f"""
import os, threading
from reference3d.gmsh_model import new_model

def mesh():
    with new_model("mesh", {{}}):
        pass

made = threading.Thread(target=mesh) if {thread} else None
made.start() if made else mesh()
made.join() if made else None
reading, writing = os.pipe()
os.close(reading)
try:
    os.write(writing, b"x")
except BrokenPipeError:
    print("told")
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)

    assert (done.returncode, done.stdout) == (0, "told\n"), done.stderr
