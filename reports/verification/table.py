"""What `rodcheck verify` prints."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from rich.table import Table

from reports.tables import STYLES, console
from reports.verification.check import Group, Outcome
from reports.verification.wording import relative, uncertainty, value


def print_verification(groups: Sequence[Group], outcomes: Mapping[str, Outcome]) -> None:
    """Print a line for each check: reference, uncertainty, error and tolerance at the level that counts."""
    table = Table("check", "reference", "", "uncertainty", "at", "error", "tolerance", "verdict")
    for group in groups:
        table.add_section()
        for check in group.checks:
            outcome = outcomes[check.name]
            table.add_row(
                check.name,
                f"{value(outcome.reference.value)} {check.unit}",
                check.kind,
                uncertainty(outcome),
                check.steps.name(check.at_level),
                relative(outcome.error),
                relative(check.tolerance),
                f"[{STYLES[outcome.verdict]}]{outcome.verdict}[/]",
            )
    console().print(table)
