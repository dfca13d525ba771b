"""What importing parts of `cases` costs: scenes need numpy alone, listing the library needs not even units."""

import subprocess
import sys

import pytest


def modules_after(statement):
    code = f"{statement}\nimport sys; print(*sys.modules)"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    return {name.partition(".")[0] for name in out.stdout.split()}


@pytest.mark.parametrize("statement", ["import cases.scene", "from cases.loader import library_names; library_names()"])
def test_neither_pydantic_nor_pint_is_imported(statement):
    assert modules_after(statement).isdisjoint({"pydantic", "pint"})


def test_a_scene_needs_no_third_party_package_but_numpy():
    more = modules_after("import cases.scene") - modules_after("import numpy")

    assert more - sys.stdlib_module_names == {"cases"}
