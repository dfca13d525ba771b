"""Which code computes a result: the source files it is made by and the versions of what they stand on.

A result on disk is used again only while this stays the same.
"""

from __future__ import annotations

import ast
import hashlib
import os
import platform
from collections.abc import Iterable, Iterator
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

TOP = Path(__file__).parent.parent
# The project's own packages: where it is installed, others lie beside them.
OWN = ("cases", "reference3d", "reports", "rodmodel")
# Distributions that a solver or the evaluation of its result may import, optional ones included.
DISTRIBUTIONS = ("gmsh", "numpy", "scikit-fem", "scipy")
# Settings that change seconds, and results by round-off.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS")


@cache
def code_version(*modules: str) -> str:
    """Fingerprint of modules with all of the project that they import, of Python and of the packages below them.

    It is taken once a process, as the process goes on with the code that it has loaded.
    """
    digest = hashlib.sha256()
    for name, path in sorted(source_files(modules).items()):
        content = path.read_bytes()
        digest.update(f"{name} {len(content)}\n".encode() + content)
    packages = [f"{name} {_installed(name)}" for name in DISTRIBUTIONS]
    threads = [f"{name} {os.environ.get(name, '')}" for name in THREADS]
    for line in (platform.python_version(), platform.machine(), *packages, *threads):
        digest.update(f"{line}\n".encode())
    return digest.hexdigest()


def data_version(*folders: Path) -> str:
    """Fingerprint of the TOML and JSON files of folders: of their names and of all that is in them."""
    digest = hashlib.sha256()
    for path in sorted(path for folder in folders for kind in ("*.toml", "*.json") for path in folder.glob(kind)):
        content = path.read_bytes()
        digest.update(f"{path.name} {len(content)}\n".encode() + content)
    return digest.hexdigest()


def source_files(modules: Iterable[str]) -> dict[str, Path]:
    """Modules and packages of the project that the given ones need, wherever the import stands, by name."""
    found: dict[str, Path] = {}
    waiting = list(modules)
    while waiting:
        name = waiting.pop()
        path = None if name in found else _source_file(name)
        if path is None:
            continue
        found[name] = path
        waiting += _with_packages(imported_names(path)) + _with_packages([name])
    return found


@cache
def imported_names(path: Path) -> frozenset[str]:
    """Every module, and every name in a module, that a source file imports."""
    names: set[str] = set()
    for node in _statements(ast.parse(path.read_bytes())):
        if isinstance(node, ast.Import):
            names |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names |= {str(node.module)} | {f"{node.module}.{alias.name}" for alias in node.names}
    return frozenset(names)


def _statements(node: ast.AST) -> Iterator[ast.AST]:
    """A node and the statements in it, without looking into expressions: these are most of a file."""
    yield node
    for block in ("body", "orelse", "finalbody", "handlers", "cases"):
        for inner in getattr(node, block, ()):
            yield from _statements(inner)


def _with_packages(names: Iterable[str]) -> list[str]:
    """The names and those of the packages they lie in: importing a module runs these too."""
    parts = [name.split(".") for name in names]
    return sorted({".".join(part[:length]) for part in parts for length in range(1, len(part) + 1)})


def _source_file(name: str) -> Path | None:
    """The file of a module or package of the project; None for anything else."""
    root, *_ = parts = name.split(".")
    if root not in OWN:
        return None
    place = TOP.joinpath(*parts)
    candidates = (place.with_name(place.name + ".py"), place / "__init__.py")
    return next((path for path in candidates if path.is_file()), None)


def _installed(distribution: str) -> str:
    try:
        return version(distribution)
    except PackageNotFoundError:
        return "absent"
