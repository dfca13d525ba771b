"""Results are used again only while the code that made them stays the same."""

from __future__ import annotations

import ast
import sys
from collections.abc import Mapping
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from reports import code_version as module
from reports.code_version import DISTRIBUTIONS, OWN, code_version, imported_names, source_files

SOLVERS = ("rodmodel", "reference3d")


@pytest.fixture
def project(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A project of which `model` needs all but `other`."""
    files = {
        "model/__init__.py": "from model.solver import solve\n",
        "model/solver.py": "def solve():\n    if True:\n        from scene import (\n            Scene,\n        )\n",
        "model/unused.py": "",
        "scene.py": "import numpy\nfrom shared import shape\n",
        "shared/__init__.py": "",
        "shared/shape.py": "",
        "other.py": "import model\n",
        "numpy/__init__.py": "",  # as beside an installed project
    }
    for name, text in files.items():
        path = tmp_path / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(text)
    monkeypatch.setattr(module, "TOP", tmp_path)
    monkeypatch.setattr(module, "OWN", ("model", "scene", "shared", "other"))
    code_version.cache_clear()
    yield tmp_path
    code_version.cache_clear()


def test_files_are_those_that_the_modules_import_at_any_place(project: Path) -> None:
    assert set(source_files(["model"])) == {"model", "model.solver", "scene", "shared", "shared.shape"}


@pytest.mark.parametrize("name", ["model/solver.py", "scene.py", "shared/__init__.py", "shared/shape.py"])
def test_a_changed_file_changes_the_version(project: Path, name: str) -> None:
    before = code_version("model")

    (project / name).write_text((project / name).read_text() + "# changed\n")
    code_version.cache_clear()

    assert code_version("model") != before


@pytest.mark.parametrize("name", ["model/unused.py", "other.py"])
def test_a_file_that_takes_no_part_does_not(project: Path, name: str) -> None:
    before = code_version("model")

    (project / name).write_text("# changed\n")
    code_version.cache_clear()

    assert code_version("model") == before


def test_another_version_of_a_package_changes_it(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    before = code_version("model")

    monkeypatch.setattr(module, "version", lambda _: "99")
    code_version.cache_clear()

    assert code_version("model") != before


def test_another_number_of_threads_changes_it(project: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("OMP_NUM_THREADS", "1")
    before = code_version("model")

    monkeypatch.setenv("OMP_NUM_THREADS", "2")
    code_version.cache_clear()

    assert code_version("model") != before


@pytest.mark.parametrize("solver", SOLVERS)
def test_a_solver_counts_with_the_scene_and_the_quantities_but_not_with_the_other_solver(solver: str) -> None:
    files = set(source_files([solver, "reports.quantities"]))

    assert {f"{solver}.solver", "cases.scene", "reports.quantities", "reports.contact_edges"} <= files
    (other,) = set(SOLVERS) - {solver}
    assert not any(name.startswith((other, "reports.site", "reports.command_line")) for name in files)


@pytest.fixture(scope="module")
def distributions() -> Mapping[str, list[str]]:
    """What brings each package that is installed."""
    return packages_distributions()


@pytest.mark.slow
@pytest.mark.parametrize("solver", SOLVERS)
def test_no_import_is_overlooked_and_every_package_below_counts_with_its_version(
    solver: str, distributions: Mapping[str, list[str]]
) -> None:
    files = source_files([solver, "reports.quantities"])
    roots = {name.partition(".")[0] for path in files.values() for name in imported_names(path)}
    everything = set()
    for path in files.values():
        for node in ast.walk(ast.parse(path.read_bytes())):
            if isinstance(node, ast.Import):
                everything |= {alias.name.partition(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom):
                everything.add(str(node.module).partition(".")[0])
    assert roots == everything

    below = roots - set(OWN) - set(sys.stdlib_module_names)

    assert {distributions[name][0] for name in below if name in distributions} <= set(DISTRIBUTIONS)
    assert {name for name in below if name not in distributions} <= set(DISTRIBUTIONS)
