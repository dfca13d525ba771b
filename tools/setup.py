"""Make `.venv` ready: pinned packages, this project, and the system libraries that gmsh and pyvista need.

Standard library only, and no syntax newer than Python 3.6, so that an old interpreter gets a sentence instead
of a syntax error. Run by `make setup`; does nothing when `.venv` is up to date.
"""

import hashlib
import os
import shutil
import subprocess
import sys

OLDEST_PYTHON = (3, 11)
TOP = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
VENV = os.path.join(TOP, ".venv")
VENV_PYTHON = os.path.join(VENV, "bin", "python")
STAMP = os.path.join(VENV, "rodcheck-ready")
# What decides whether `.venv` is up to date.
INPUTS = ("requirements.lock", "pyproject.toml", os.path.join("tools", "setup.py"))

# Debian's names. gmsh's wheel links X and GL libraries; pyvista draws off screen through EGL on Mesa.
SYSTEM_PACKAGES = (
    "libglu1-mesa libxcursor1 libxft2 libxinerama1 libxrender1 libfontconfig1 libgomp1 "  # gmsh
    "libegl1 libgl1 libgl1-mesa-dri libxext6"  # pyvista
).split()

GMSH_PROBE = "import gmsh"
RENDER_PROBE = """
import pyvista
plotter = pyvista.Plotter(off_screen=True, window_size=(64, 64))
plotter.add_mesh(pyvista.Cube(), color="red")
picture = plotter.screenshot(return_img=True)
assert picture.std() > 0, "the off-screen picture is empty"
"""


class SetupError(Exception):
    """Set-up cannot go on; the message says what to do."""


def is_recent(version):
    """Whether an interpreter's version, such as (3, 11, 7), will do."""
    return tuple(version[:2]) >= OLDEST_PYTHON


def version_of(python):
    """Version of the interpreter `python` as a tuple, or None where it does not run."""
    code = "import sys; print(*sys.version_info[:3])"
    try:
        out = subprocess.run([python, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
    except OSError:
        return None
    return tuple(int(part) for part in out.stdout.split()) if out.returncode == 0 else None


def find_python():
    """Path of a Python that is recent enough: the one running this, else one on PATH."""
    names = ["python3.%d" % minor for minor in range(OLDEST_PYTHON[1], OLDEST_PYTHON[1] + 4)]
    for candidate in [sys.executable] + [shutil.which(name) for name in names]:
        version = version_of(candidate) if candidate else None
        if version is not None and is_recent(version):
            return candidate
    found = ".".join(map(str, sys.version_info[:3]))
    raise SetupError(
        "rodcheck needs Python %d.%d or newer, found only %s; install one (Debian, Ubuntu: python3.11 or newer) "
        "and run make again, or name it: make setup PYTHON=/path/to/python3" % (OLDEST_PYTHON + (found,))
    )


def may_install():
    """The prefix with which apt-get may be run here without asking anybody, or None if it may not."""
    if shutil.which("apt-get") is None:
        return None
    if os.geteuid() == 0:
        return []
    if shutil.which("sudo") and run_quietly(["sudo", "-n", "true"])[0]:
        return ["sudo", "-n"]
    return None


def install_command(packages):
    """The one command that installs Debian packages, as a person would type it."""
    prefix = "" if os.geteuid() == 0 else "sudo "
    return "%sapt-get update && %sapt-get install -y %s" % (prefix, prefix, " ".join(packages))


def install_system_packages(packages, reason):
    """Install Debian packages if that is allowed; otherwise stop with the one command to type."""
    prefix = may_install()
    if prefix is None:
        if shutil.which("apt-get"):
            advice = "run\n\n    %s\n\nand then make again." % install_command(packages)
        else:
            advice = "install what Debian calls %s, and run make again." % " ".join(packages)
        raise SetupError("%s; %s" % (reason, advice))
    say("%s: installing %s" % (reason, " ".join(packages)))
    environment = dict(os.environ, DEBIAN_FRONTEND="noninteractive")
    # A list that cannot be renewed may still serve: only a failed install stops the set-up.
    run_quietly(prefix + ["apt-get", "update"], environment)
    arguments = ["apt-get", "install", "-y", "--no-install-recommends"] + packages
    ok, output = run_quietly(prefix + arguments, environment)
    if not ok:
        raise SetupError("apt-get could not install them:\n%s" % tail(output, 8))


def run_quietly(command, environment=None, timeout=None):
    """Run a command; return whether it succeeded, and all it printed."""
    try:
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=environment, timeout=timeout, cwd=TOP
        )
    except subprocess.TimeoutExpired:
        return False, "no answer within %d s" % timeout
    return done.returncode == 0, done.stdout.decode(errors="replace")


def tail(text, lines):
    """The last non-empty lines of a text."""
    return "\n".join([line for line in text.splitlines() if line.strip()][-lines:])


def say(text):
    """One line of progress."""
    print("setup: " + text, flush=True)


def fingerprint():
    """What `.venv` has to match: the content of the inputs and the folder, which an editable install names."""
    digest = hashlib.sha256(TOP.encode())
    for name in INPUTS:
        with open(os.path.join(TOP, name), "rb") as file:
            digest.update(file.read())
    return digest.hexdigest()


def is_ready():
    """Whether `.venv` was completed from the same inputs, and its interpreter still runs."""
    try:
        with open(STAMP) as file:
            same = file.read().strip() == fingerprint()
    except OSError:
        return False
    return same and version_of(VENV_PYTHON) is not None


def make_venv():
    """Make `.venv`, unless it has a working, recent interpreter."""
    version = version_of(VENV_PYTHON)
    if version is not None and is_recent(version) and run_quietly([VENV_PYTHON, "-m", "pip", "--version"])[0]:
        return
    python = find_python()
    if not run_quietly([python, "-c", "import ensurepip, venv"])[0]:
        package = "python%d.%d-venv" % version_of(python)[:2]
        install_system_packages([package], "Python's venv module is missing")
    say("making .venv")
    ok, output = run_quietly([python, "-m", "venv", "--clear", VENV])
    if not ok:
        raise SetupError("could not make .venv:\n%s" % tail(output, 8))


def install_packages():
    """Install the pinned packages, and this project so that edits take effect at once."""
    say("installing the packages of requirements.lock")
    pip = [VENV_PYTHON, "-m", "pip", "--disable-pip-version-check", "install", "--quiet"]
    # The project itself: nothing but what the lock names, the build tool included.
    for what in (["-r", "requirements.lock"], ["--no-deps", "--no-build-isolation", "-e", "."]):
        ok, output = run_quietly(pip + what)
        if not ok:
            raise SetupError("pip could not install %s:\n%s" % (" ".join(what), tail(output, 12)))
    ok, output = run_quietly([VENV_PYTHON, "-m", "pip", "--disable-pip-version-check", "check"])
    if not ok:
        raise SetupError("the packages of requirements.lock do not fit together:\n%s" % tail(output, 12))


def failing_probe():
    """(what, output) of the first thing that does not work in `.venv`, or None."""
    for what, code in (("import gmsh", GMSH_PROBE), ("drawing with pyvista", RENDER_PROBE)):
        ok, output = run_quietly([VENV_PYTHON, "-c", code], timeout=300)
        if not ok:
            return what, tail(output, 1)
    return None


def check_system_libraries():
    """See gmsh and off-screen drawing work; install system libraries where they do not."""
    say("trying gmsh and pyvista")
    failure = failing_probe()
    if failure is None:
        return
    install_system_packages(SYSTEM_PACKAGES, "%s fails (%s)" % failure)
    failure = failing_probe()
    if failure is not None:
        raise SetupError("%s still fails with the system libraries installed: %s" % failure)


def main():
    """Do what is missing; return the exit code."""
    if is_ready():
        return 0
    try:
        make_venv()
        install_packages()
        check_system_libraries()
    except SetupError as error:
        print("setup: %s" % error, file=sys.stderr)
        return 1
    except KeyboardInterrupt:
        print("setup: interrupted; run make again to go on", file=sys.stderr)
        return 130
    with open(STAMP, "w") as file:
        file.write(fingerprint() + "\n")
    say(".venv is ready")
    return 0


if __name__ == "__main__":
    sys.exit(main())
