"""The set-up script: when it has work to do, and what it tells a person who has to help."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parent.parent / "tools" / "setup.py"


@pytest.fixture
def setup(tmp_path, monkeypatch):
    """The script as a module, in a project folder of its own."""
    specification = importlib.util.spec_from_file_location("setup_script", SCRIPT)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    (tmp_path / "tools").mkdir()
    for name in module.INPUTS:
        (tmp_path / name).write_text(name)
    for name, path in (
        ("TOP", tmp_path),
        ("VENV", tmp_path / ".venv"),
        ("VENV_PYTHON", tmp_path / ".venv/bin/python"),
        ("STAMP", tmp_path / ".venv/rodcheck-ready"),
    ):
        monkeypatch.setattr(module, name, path)
    return module


@pytest.fixture
def ready(setup):
    """The same after a completed set-up."""
    setup.VENV_PYTHON.parent.mkdir(parents=True)
    setup.VENV_PYTHON.symlink_to(sys.executable)
    setup.STAMP.write_text(setup.fingerprint())
    return setup


def commands(module, monkeypatch, answers=lambda _command: (True, "")):
    """Record the commands that the script would run, and answer them."""
    seen = []

    def run(command, _environment=None):
        seen.append(command)
        return answers(command)

    monkeypatch.setattr(module, "run", run)
    return seen


def apt_machine(module, monkeypatch, programs, user):
    """Pretend to be a machine with these programs, as this user."""
    monkeypatch.setattr(module.shutil, "which", lambda name: f"/usr/bin/{name}" if name in programs else None)
    monkeypatch.setattr(module.os, "geteuid", lambda: user)


def test_a_completed_setup_is_not_repeated(ready, capsys):
    assert ready.main() == 0
    assert capsys.readouterr().out == ""


@pytest.mark.parametrize("name", ["requirements.lock", "pyproject.toml", "tools/setup.py"])
def test_a_changed_input_asks_for_setup(ready, name):
    (ready.TOP / name).write_text("changed")

    assert not ready.is_ready()


def test_a_moved_project_asks_for_setup(ready, monkeypatch):
    monkeypatch.setattr(ready, "TOP", ready.TOP / "tools" / "..")

    assert not ready.is_ready()


def test_an_interrupted_setup_or_a_dead_interpreter_asks_for_setup(ready):
    ready.VENV_PYTHON.unlink()
    assert not ready.is_ready()
    ready.STAMP.unlink()
    assert not ready.is_ready()


def test_an_old_python_looks_for_a_newer_one(setup, monkeypatch):
    versions = {sys.executable: (3, 9, 2), "/usr/bin/python3.12": (3, 12, 1)}
    monkeypatch.setattr(setup, "version_of", versions.get)
    monkeypatch.setattr(setup.shutil, "which", lambda name: f"/usr/bin/{name}" if name == "python3.12" else None)

    assert setup.find_python() == "/usr/bin/python3.12"


def test_without_a_recent_python_the_message_says_how_to_name_one(setup, monkeypatch):
    monkeypatch.setattr(setup, "version_of", lambda _python: (3, 9, 2))

    with pytest.raises(setup.SetupError, match=r"Python 3\.11 or newer is needed.*\n\n    make setup PYTHON="):
        setup.find_python()


@pytest.mark.parametrize(
    ("programs", "sudo_works", "user", "prefix"),
    [
        (["apt-get"], False, 0, []),
        (["apt-get", "sudo"], True, 1000, ["sudo", "-n"]),
        (["apt-get", "sudo"], False, 1000, None),
        (["apt-get"], False, 1000, None),
        (["dnf"], False, 0, None),
    ],
)
def test_apt_is_used_only_where_it_may_be_without_a_question(setup, monkeypatch, programs, sudo_works, user, prefix):
    apt_machine(setup, monkeypatch, programs, user)
    commands(setup, monkeypatch, lambda _command: (sudo_works, ""))

    assert setup.apt_prefix() == prefix


def test_packages_are_installed_without_asking_where_that_is_allowed(setup, monkeypatch):
    apt_machine(setup, monkeypatch, ["apt-get"], user=0)
    seen = commands(setup, monkeypatch)

    setup.install_system_packages(["libone", "libtwo"], "import gmsh fails")

    assert seen[-1] == ["apt-get", "install", "-y", "--no-install-recommends", "libone", "libtwo"]


@pytest.mark.parametrize(("programs", "root"), [(["apt-get", "sudo"], "sudo sh -c"), (["apt-get"], "su -c")])
def test_otherwise_the_one_command_to_type_is_named_and_nothing_is_installed(setup, monkeypatch, programs, root):
    apt_machine(setup, monkeypatch, programs, user=1000)
    seen = commands(setup, monkeypatch, lambda _command: (False, ""))

    with pytest.raises(setup.SetupError) as caught:
        setup.install_system_packages(["libone", "libtwo"], "import gmsh fails")

    command = f"{root} 'apt-get update && apt-get install -y --no-install-recommends libone libtwo'"
    assert str(caught.value).splitlines()[-1].strip() == command
    assert not any("install" in command for command in seen)


def test_without_apt_the_packages_are_named(setup, monkeypatch):
    apt_machine(setup, monkeypatch, [], user=1000)

    with pytest.raises(setup.SetupError, match="install what Debian calls libone libtwo"):
        setup.install_system_packages(["libone", "libtwo"], "import gmsh fails")


def test_a_failure_that_the_system_packages_do_not_cure_stops_the_setup(setup, monkeypatch):
    apt_machine(setup, monkeypatch, ["apt-get"], user=0)
    commands(setup, monkeypatch, lambda command: ("-c" not in command, "one\n\x1b[31mno such library\x1b[0m\n"))

    with pytest.raises(setup.SetupError, match=r"import gmsh fails \(no such library\), although"):
        setup.check_system_libraries()


def test_a_failed_setup_prints_one_message_and_leaves_no_stamp(setup, monkeypatch, capsys):
    def fail():
        raise setup.SetupError("no way")

    monkeypatch.setattr(setup, "make_venv", fail)

    assert setup.main() == 1
    assert capsys.readouterr().err == "setup: no way\n"
    assert not setup.STAMP.exists()


@pytest.mark.slow
def test_the_probes_pass_in_the_environment_of_these_tests(setup):
    for code in setup.PROBES.values():
        subprocess.run([sys.executable, "-c", code], check=True, capture_output=True)
