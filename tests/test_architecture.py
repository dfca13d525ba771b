"""Who may import whom: rod model and 3D reference stay independent, or their comparison proves nothing."""

import ast
import subprocess
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).parent.parent
OWN = {"cases", "rodmodel", "reference3d", "reports"}


def imported(package):
    """Every module that a package's files import, wherever the import stands."""
    names = set()
    for path in (TOP / package).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 0, f"{path.name} imports by a relative name"
                names.add(str(node.module))
    return names


@pytest.mark.parametrize(
    ("package", "allowed"),
    [
        ("cases", {"cases"}),
        ("rodmodel", {"rodmodel", "cases.scene"}),
        ("reference3d", {"reference3d", "cases.scene"}),
    ],
)
def test_a_package_imports_no_other_part_of_the_project_than_it_may(package, allowed):
    own = {name for name in imported(package) if name.partition(".")[0] in OWN}

    strangers = {name for name in own if name not in allowed and name.partition(".")[0] not in allowed}
    assert strangers == set()


def test_the_rod_model_needs_numpy_and_scipy_alone():
    roots = {name.partition(".")[0] for name in imported("rodmodel")}

    assert roots - set(sys.stdlib_module_names) - OWN <= {"numpy", "scipy"}


@pytest.mark.slow
def test_importing_the_rod_model_brings_neither_mesher_nor_plots_nor_case_files():
    code = "import sys, rodmodel; print(*sys.modules)"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)

    modules = out.stdout.split()
    loaded = {name.partition(".")[0] for name in modules}
    assert "scipy.optimize" not in modules  # it takes longer than all of the rod model
    assert loaded.isdisjoint({"gmsh", "skfem", "pyvista", "plotly", "pydantic", "pint", "reference3d", "reports"})
