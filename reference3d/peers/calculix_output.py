"""What CalculiX prints, read back: the tables of its .dat file and its account of the increments (.sta)."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

# Fortran leaves out the E where an exponent has three digits
THREE_DIGITS = re.compile(r"(\d)([+-]\d{3})\b")
# how the headings begin, in lower case
DISPLACEMENTS, FORCES, CONTACT = "displacements", "forces", "statistics for slave set"
RESULTANT, CENTRE = "total surface force", "center of gravity"


@dataclass(frozen=True, eq=False)
class SurfaceForce:
    """Force (N) on the slave surface of a contact pair, its moment about the origin (N mm), and a point in the middle
    of the area in contact (mm; nan without contact), shape (3,) each.
    """

    force: Array
    moment: Array
    middle: Array


@dataclass(frozen=True, eq=False)
class Printed:
    """Tables of the last increment.

    Attributes
    ----------
    displacements, forces : by number of the node, mm and N, shape (largest number + 1, 3); nan where none is printed
    contacts : by name of the slave surface, in capitals
    """

    displacements: Array
    forces: Array
    contacts: dict[str, SurfaceForce]


def read_dat(path: Path) -> Printed:
    """Read a .dat file.

    Raises
    ------
    ValueError
        if it is not as CalculiX writes it, or holds no displacements.
    """
    tables: dict[str, list[list[float]]] = {DISPLACEMENTS: [], FORCES: []}
    contacts: dict[str, dict[str, list[float]]] = {}
    into: list[list[float]] = []
    surface: dict[str, list[float]] = {}
    heading = ""
    for line in path.read_text(encoding="ascii", errors="replace").splitlines():
        text = THREE_DIGITS.sub(r"\1E\2", line).split()
        if not text:
            continue
        if not _is_number(text[0]):
            heading = line.strip().lower()
            kind = next((kind for kind in tables if heading.startswith(kind)), "")
            if kind:
                into = tables[kind] = []
            elif heading.startswith(CONTACT):
                surface = contacts[heading[len(CONTACT) :].split(",")[0].strip().upper()] = {}
        elif heading.startswith((DISPLACEMENTS, FORCES)):
            into.append([float(number) for number in text])
        elif heading.startswith((RESULTANT, CENTRE)):
            surface[RESULTANT if heading.startswith(RESULTANT) else CENTRE] = [float(number) for number in text]
    if not tables[DISPLACEMENTS]:
        raise ValueError(f"{path.name} holds no displacements")
    found = {}
    for name, numbers in contacts.items():
        resultant, middle = np.array(numbers[RESULTANT]), np.array(numbers.get(CENTRE, [np.nan] * 6))
        found[name] = SurfaceForce(resultant[:3], resultant[3:6], middle[:3])
    return Printed(_by_node(tables[DISPLACEMENTS]), _by_node(tables[FORCES]), found)


def _is_number(text: str) -> bool:
    try:
        float(text)
    except ValueError:
        return False
    return True


def _by_node(rows: list[list[float]]) -> Array:
    table = np.array(rows).reshape(-1, 4)
    values = np.full((int(table[:, 0].max(initial=0.0)) + 1, 3), np.nan)
    values[table[:, 0].astype(np.int64)] = table[:, 1:]
    return values


def increments(path: Path) -> list[float]:
    """Time at the end of every converged increment that a .sta file tells of."""
    times = []
    for line in path.read_text(encoding="ascii", errors="replace").splitlines():
        words = line.split()
        # a letter after the attempt marks one that did not converge
        if len(words) == 7 and words[0].isdigit() and words[2].isdigit():
            times.append(float(words[4]))
    return times


def unknowns(output: str) -> int:
    """Number of equations that CalculiX tells; 0 if it does not."""
    found = re.search(r"number of equations\s+(\d+)", output)
    return int(found[1]) if found else 0


def complaint(output: str) -> str:
    """The first error that CalculiX tells, in one line; '' if there is none."""
    found = re.search(r"\*ERROR[: ]*(.*?)(?:\n\s*\n|\n \*|\Z)", output, re.DOTALL)
    return " ".join(found[1].split()) if found else ""
