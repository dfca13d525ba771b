"""All verification checks, by group, and how they are carried out."""

from __future__ import annotations

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bars

from reports.processes import Progress, in_own_process
from reports.verification import (
    bands,
    bending,
    contact_3d,
    curved,
    patch,
    published,
    solid,
    solid_elements,
    structures,
    torsion,
)
from reports.verification.check import Group, Outcome, Reference

GROUPS: tuple[Group, ...] = (
    patch.GROUP,
    torsion.GROUP,
    bending.GROUP,
    curved.GROUP,
    structures.GROUP,
    published.GROUP,
    solid.GROUP,
    *solid_elements.GROUPS,
    *contact_3d.GROUPS,
    bands.GROUP,
)
CHECKS = {check.name: check for group in GROUPS for check in group.checks}


def verify() -> dict[str, Outcome]:
    """Carry out all checks, in a process of their own and behind a progress bar; outcomes by the checks' names.

    Raises
    ------
    ProcessFailed
        if a check raises or the process ends early.
    """
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Bars(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task("", total=len(CHECKS))

        def begun(name: str) -> None:
            bars.update(task, description=f"verification: {name}")
            bars.advance(task)

        found = in_own_process(_numbers, tuple(CHECKS), begun)
    return {name: Outcome(CHECKS[name], reference, values) for name, (reference, values) in found.items()}


def _numbers(names: tuple[str, ...], progress: Progress) -> dict[str, tuple[Reference, tuple[float, ...]]]:
    """Reference and values of each check, which unlike the checks can pass from process to process."""
    found = {}
    for name in names:
        progress(name)
        check = CHECKS[name]
        found[name] = check.reference(), tuple(check.value(level) for level in check.levels)
    return found
