"""The rod model is light to import and knows nothing of the 3D reference."""

import subprocess
import sys

import pytest


@pytest.mark.parametrize(
    "package",
    ["gmsh", "pyvista", "skfem", "meshio", "pydantic", "pint", "reference3d", "reports", "cases.loader"],
)
def test_importing_the_rod_model_does_not_import(package: str) -> None:
    program = f"import sys, rodmodel; sys.exit({package!r} in sys.modules)"
    assert subprocess.run([sys.executable, "-c", program], check=False).returncode == 0
