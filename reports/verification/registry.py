"""All verification checks, by group, and how they are carried out."""

from __future__ import annotations

from reports.processes import Progress, in_own_process
from reports.progress import announced
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
    with announced("verification", len(CHECKS)) as begun:
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
