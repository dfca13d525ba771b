"""All verification checks, by group, and how they are carried out."""

from __future__ import annotations

from cases.loader import LIBRARY, TRUTH
from reports.cache import Cache
from reports.code_version import code_version, data_version
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
# Reference and values of checks, by their names.
Numbers = dict[str, tuple[Reference, tuple[float, ...]]]


def verify(cache: Cache | None = None) -> dict[str, Outcome]:
    """Carry out all checks, in a process of their own and behind a progress bar; outcomes by the checks' names.

    Parameters
    ----------
    cache : where numbers are looked for, and kept if every check passes

    Raises
    ------
    ProcessFailed
        if a check raises or the process ends early.
    """
    question = code_version(__name__), data_version(LIBRARY, TRUTH)
    kept = None if cache is None else cache.find("verification", question, (Reference,))
    if kept is not None:
        return _outcomes(kept.value, kept.date)
    with announced("verification", len(CHECKS)) as begun:
        found = in_own_process(_numbers, tuple(CHECKS), begun)
    outcomes = _outcomes(found)
    if cache is not None and all(outcome.verdict == "pass" for outcome in outcomes.values()):
        cache.keep("verification", question, found)
    return outcomes


def _outcomes(numbers: Numbers, kept_since: str = "") -> dict[str, Outcome]:
    return {name: Outcome(CHECKS[name], reference, values, kept_since) for name, (reference, values) in numbers.items()}


def _numbers(names: tuple[str, ...], progress: Progress) -> Numbers:
    """What checks come to, which unlike the checks can pass from process to process."""
    found: Numbers = {}
    for name in names:
        progress(name)
        check = CHECKS[name]
        found[name] = check.reference(), tuple(check.value(level) for level in check.levels)
    return found
