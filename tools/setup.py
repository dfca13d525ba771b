"""Make `.venv` ready: pinned packages, this project, and the system libraries that gmsh and pyvista need.

Run by `make setup`; does nothing when `.venv` is up to date. Standard library only, and no syntax newer than
Python 3.7, so that an old interpreter gets a sentence instead of a syntax error.
"""

from __future__ import annotations

import hashlib
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

OLDEST_PYTHON = (3, 11)
TOP = Path(__file__).resolve().parent.parent
VENV = TOP / ".venv"
VENV_PYTHON = VENV / "bin" / "python"
STAMP = VENV / "rodcheck-ready"
# What decides whether `.venv` is up to date.
INPUTS = ("requirements.lock", "pyproject.toml", "tools/setup.py")

# Debian's names: what a bare system lacks for gmsh (the first eight) and for pyvista, which draws off screen
# through EGL and crashes without it.
SYSTEM_PACKAGES = [
    "libglu1-mesa",
    "libxcursor1",
    "libxft2",
    "libxinerama1",
    "libxrender1",
    "libfontconfig1",
    "libgomp1",
    "libgl1",
    "libegl1",
    "libgl1-mesa-dri",
]

PROBES = {
    "import gmsh": "import gmsh",
    "drawing with pyvista": """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Cube(), color="red")
assert plotter.screenshot(return_img=True).std() > 0, "the picture is empty"
""",
}


class SetupError(Exception):
    """Set-up cannot go on; the message says what to do."""


def say(text: str) -> None:
    """Print one line of progress."""
    print(f"setup: {text}", flush=True)


def run(command: list[str], environment: dict[str, str] | None = None) -> tuple[bool, str]:
    """Run a command in the project's folder; whether it succeeded, and all it printed."""
    try:
        done = subprocess.run(
            command,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            stdin=subprocess.DEVNULL,
            env=environment,
            cwd=str(TOP),
        )
    except OSError as error:
        return False, str(error)
    return done.returncode == 0, done.stdout.decode(errors="replace")


def run_or_stop(what: str, command: list[str], environment: dict[str, str] | None = None) -> None:
    """Run a command; stop with the end of what it printed if it fails."""
    ok, output = run(command, environment)
    if not ok:
        raise SetupError(f"{what} failed:\n{last_lines(output, 12)}")


def last_lines(text: str, count: int) -> str:
    """Return the last lines of a text that are not empty, without colours."""
    plain = re.sub("\x1b\\[[0-9;]*m", "", text)
    return "\n".join([line.strip() for line in plain.splitlines() if line.strip()][-count:])


def version_of(python: str) -> tuple[int, ...] | None:
    """Return an interpreter's version, such as (3, 11, 7); None where it does not run."""
    ok, output = run([python, "-c", "import sys; print(*sys.version_info[:3])"])
    return tuple(int(part) for part in output.split()) if ok else None


def find_python() -> str:
    """Return a Python that is recent enough: the one running this, else one on PATH."""
    names = [f"python3.{minor}" for minor in range(OLDEST_PYTHON[1], OLDEST_PYTHON[1] + 4)]
    for candidate in [sys.executable, *map(shutil.which, names)]:
        version = version_of(candidate) if candidate else None
        if version is not None and version >= OLDEST_PYTHON:
            return str(candidate)
    needed, found = ".".join(map(str, OLDEST_PYTHON)), ".".join(map(str, sys.version_info[:3]))
    raise SetupError(
        f"Python {needed} or newer is needed, found {found}; install one, or name one:\n\n"
        "    make setup PYTHON=/path/to/python3"
    )


def apt_prefix() -> list[str] | None:
    """Return what stands before apt-get to run it unasked; None where that cannot be."""
    if shutil.which("apt-get") is None:
        return None
    if os.geteuid() == 0:
        return []
    if shutil.which("sudo") and run(["sudo", "-n", "true"])[0]:
        return ["sudo", "-n"]
    return None


def install_system_packages(packages: list[str], reason: str) -> None:
    """Install Debian packages if that is allowed; otherwise stop with the one command to type."""
    prefix = apt_prefix()
    names = " ".join(packages)
    if prefix is None and shutil.which("apt-get"):
        command = f"apt-get update && apt-get install -y --no-install-recommends {names}"
        root = "sudo sh -c" if shutil.which("sudo") else "su -c"
        raise SetupError(f"{reason}; type this and run make again:\n\n    {root} '{command}'")
    if prefix is None:
        raise SetupError(f"{reason}; install what Debian calls {names}, and run make again")
    say(f"{reason}; installing {names}")
    environment = {**os.environ, "DEBIAN_FRONTEND": "noninteractive"}
    # Package lists that cannot be renewed may still serve: only a failed install stops the set-up.
    run([*prefix, "apt-get", "update"], environment)
    command = [*prefix, "apt-get", "install", "-y", "--no-install-recommends", *packages]
    run_or_stop(f"apt-get install {names}", command, environment)


def fingerprint() -> str:
    """Return what `.venv` has to match: its inputs, and the folder, which an editable install names."""
    digest = hashlib.sha256(str(TOP).encode())
    for name in INPUTS:
        digest.update((TOP / name).read_bytes())
    return digest.hexdigest()


def is_ready() -> bool:
    """Whether `.venv` was completed from the same inputs, and its interpreter still runs."""
    same = STAMP.is_file() and STAMP.read_text().strip() == fingerprint()
    return same and version_of(str(VENV_PYTHON)) is not None


def make_venv() -> None:
    """Make `.venv`, unless it has a recent interpreter with pip."""
    version = version_of(str(VENV_PYTHON))
    recent = version is not None and version >= OLDEST_PYTHON
    if recent and run([str(VENV_PYTHON), "-m", "pip", "--version"])[0]:
        return
    python = find_python()
    if not run([python, "-c", "import ensurepip, venv"])[0]:
        major, minor, *_ = version_of(python) or OLDEST_PYTHON
        install_system_packages([f"python{major}.{minor}-venv"], f"the venv module of {python} is missing")
    say("making .venv")
    run_or_stop("making .venv", [python, "-m", "venv", "--clear", str(VENV)])


def install_packages() -> None:
    """Install the pinned packages, and this project so that edits take effect at once."""
    say("installing the packages of requirements.lock (about a minute)")
    pip = [str(VENV_PYTHON), "-m", "pip", "--disable-pip-version-check"]
    run_or_stop("installing requirements.lock", [*pip, "install", "--quiet", "-r", "requirements.lock"])
    # The lock has all that this project needs, its build tool included: nothing else is fetched.
    project = [*pip, "install", "--quiet", "--no-deps", "--no-build-isolation", "-e", "."]
    run_or_stop("installing rodcheck itself", project)
    run_or_stop("checking that the packages fit together", [*pip, "check"])


def first_failure() -> str | None:
    """Say which of gmsh and off-screen drawing does not work in `.venv`; None if both do."""
    for what, code in PROBES.items():
        ok, output = run([str(VENV_PYTHON), "-c", code])
        if not ok:
            return f"{what} fails ({last_lines(output, 1) or 'it crashed without a word'})"
    return None


def check_system_libraries() -> None:
    """See gmsh and off-screen drawing work; install system libraries where they do not."""
    say("trying gmsh and pyvista")
    failure = first_failure()
    if failure is not None:
        install_system_packages(SYSTEM_PACKAGES, failure)
        failure = first_failure()
    if failure is not None:
        raise SetupError(f"{failure}, although its system libraries are installed")


def main() -> int:
    """Do what is missing; return the exit code."""
    if is_ready():
        return 0
    try:
        make_venv()
        install_packages()
        check_system_libraries()
    except SetupError as error:
        print(f"setup: {error}", file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("setup: interrupted; run make again to go on", file=sys.stderr)
        return 130
    STAMP.write_text(fingerprint() + "\n")
    say(".venv is ready")
    return 0


if __name__ == "__main__":
    sys.exit(main())
