"""docs/adding-a-case.md: its commands run as printed, and a file in the library is a case, a test and a page."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from cases.loader import load_case
from reports import command_line

ROOT = Path(__file__).parent.parent
TEXT = (ROOT / "docs" / "adding-a-case.md").read_text(encoding="utf-8")
COMMANDS = [line for block in re.findall(r"```sh\n(.*?)```", TEXT, flags=re.DOTALL) for line in block.splitlines()]
# Those that install, solve in 3D on three meshes or run such a test.
LONG = ("make setup", "rodcheck compare stacked-bars.toml", "rodcheck report", ".venv/bin/python -m pytest")


def edited(file: Path) -> None:
    """Put the tutorial's title and description in place of the template's."""
    (new,) = re.findall(r"```toml\n(.*?)```", TEXT, flags=re.DOTALL)
    text = file.read_text(encoding="utf-8")
    file.write_text(re.sub(r'title = .*?\n"""\n', lambda _: new, text, count=1, flags=re.DOTALL), encoding="utf-8")


@pytest.mark.slow
def test_the_quick_commands_run_as_printed_up_to_a_case_of_the_library(tmp_path: Path) -> None:
    # A checkout of its own, so that the library of this one stays as it is.
    for package in ("cases", "rodmodel", "reference3d", "reports", "tests"):
        shutil.copytree(ROOT / package, tmp_path / package, ignore=shutil.ignore_patterns("__pycache__"))
    environment = {**os.environ, "PYTHONPATH": str(tmp_path), "OMP_NUM_THREADS": "1"}
    environment["PATH"] = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"

    def run(command: str) -> str:
        done = subprocess.run(
            ["bash", "-c", command], cwd=tmp_path, env=environment, capture_output=True, text=True, check=False
        )
        assert done.returncode == 0, f"{command}: {done.stderr}"
        assert "Traceback" not in done.stderr
        return done.stdout

    said = {}
    for command in COMMANDS:
        if command not in LONG and not command.startswith(LONG[2:]):
            said[command] = run(command)
        if command.startswith("rodcheck new"):
            edited(tmp_path / "stacked-bars.toml")

    assert (tmp_path / "stacked-bars-scene.png").is_file()
    assert "agree" in said["rodcheck compare stacked-bars.toml --quick"]
    assert re.search(r"^stacked-bars +Stacked bars$", said["rodcheck list"], flags=re.MULTILINE)
    collected = run("python -m pytest tests/test_library_cases.py -k stacked-bars --collect-only -q -o addopts=")
    assert "test_case_keeps_its_tolerances[stacked-bars]" in collected


def test_the_new_case_is_the_one_that_the_tutorial_speaks_of(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (command,) = (line for line in COMMANDS if line.startswith("rodcheck new"))
    arguments = [each.strip('"') for each in re.findall(r'"[^"]*"|\S+', command)[1:]]

    assert command_line.run(arguments) == 0

    edited(Path("stacked-bars.toml"))
    case = load_case("stacked-bars.toml")
    assert case.title == "Stacked bars"
    moduli = [rod.material.young_modulus for rod in case.scene.rods]
    assert moduli[0] == 4.0 * moduli[1]


def test_the_commands_left_out_of_the_test_are_in_the_tutorial() -> None:
    assert all(any(command.startswith(each) for command in COMMANDS) for each in LONG)
