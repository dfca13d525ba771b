"""The verification page: a table and a figure for each group of checks."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from reports.html import PLOTLY_FILE, rendered, write_plotly
from reports.store import write_whole
from reports.verification.check import Group, Outcome
from reports.verification.figures import error_figure
from reports.verification.wording import published, relative, tolerance, uncertainty, value

FILE_NAME = "verification.html"


def write_verification(
    groups: Sequence[Group], outcomes: Mapping[str, Outcome], output: Path, *, in_report: bool = False
) -> Path:
    """Write `verification.html` into the folder `output`; returns its path.

    Parameters
    ----------
    in_report : whether an overview stands, or will stand, beside it

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    write_plotly(output)
    write_whole(output / FILE_NAME, render(groups, outcomes, in_report=in_report))
    return output / FILE_NAME


def render(groups: Sequence[Group], outcomes: Mapping[str, Outcome], *, in_report: bool = False) -> str:
    """The page as HTML; `outcomes` by the checks' names."""
    content, figures = [], {}
    kept_since = next(iter(outcomes.values())).kept_since
    for index, group in enumerate(groups, start=1):
        found = [outcomes[check.name] for check in group.checks]
        anchor = f"group-{index}"
        figure = error_figure(found)
        figures[f"{anchor}-figure"] = figure
        content.append(_group(group, found, anchor, figure.layout.height))
    return rendered(
        "verification/page.html.jinja",
        figures,
        PLOTLY_FILE,
        groups=content,
        kept_since=kept_since,
        in_report=in_report,
    )


def _group(group: Group, outcomes: Sequence[Outcome], anchor: str, height: int) -> dict[str, Any]:
    levels = sorted({level for outcome in outcomes for level in outcome.check.levels})
    return {
        "anchor": anchor,
        "title": group.title,
        "text": group.text,
        "counts": Counter(outcome.verdict for outcome in outcomes),
        "levels": [group.steps.name(level) for level in levels],
        "steps": group.steps.title,
        "rows": [_row(outcome, levels) for outcome in outcomes],
        "published": any(outcome.check.published is not None for outcome in outcomes),
        "height": height,
    }


def _row(outcome: Outcome, levels: Sequence[int]) -> dict[str, Any]:
    check = outcome.check
    errors = dict(zip(check.levels, outcome.errors, strict=True))
    cells = [
        {
            "text": relative(errors[level]) if level in errors else "",
            "verdict": outcome.verdict if level == check.at_level else None,
        }
        for level in levels
    ]
    return {
        "name": check.name,
        "shows": check.shows,
        "kind": check.kind,
        "source": check.source,
        "reference": value(outcome.reference.value),
        "unit": check.unit,
        "uncertainty": uncertainty(outcome),
        "published": published(outcome),
        "tolerance": tolerance(check),
        "cells": cells,
    }
