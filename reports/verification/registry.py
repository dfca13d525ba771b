"""All verification checks, by group, and how they are carried out."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from reports.verification import bending, curved, patch, published, torsion
from reports.verification.check import Check, Group, Outcome, carried_out

GROUPS: tuple[Group, ...] = (patch.GROUP, torsion.GROUP, bending.GROUP, curved.GROUP, published.GROUP)


def carry_out(groups: Sequence[Group], progress: Callable[[Check], None]) -> dict[str, Outcome]:
    """Solve every check of the groups; outcomes by the check's name.

    Parameters
    ----------
    progress : called before each check
    """
    outcomes = {}
    for group in groups:
        for check in group.checks:
            progress(check)
            outcomes[check.name] = carried_out(check)
    return outcomes
