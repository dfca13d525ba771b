"""The performance page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from reports.html import PLOTLY_FILE, rendered, write_plotly
from reports.performance import wording
from reports.performance.figures import levels_figure, memory_figure, relative_figure, seconds_figure
from reports.performance.levels import LevelStudy
from reports.performance.measure import Performance
from reports.performance.parts import QUANTITIES, TEXTS, WHOLE, Breakdown
from reports.performance.scaling import LEVEL, ORDER, RESOLUTION, Series
from reports.performance.wording import milliseconds, spread
from reports.store import write_whole
from reports.verification.wording import relative

FILE_NAME = "performance.html"


def write_performance(found: Performance, output: Path, *, in_report: bool = False) -> Path:
    """Write `performance.html` into the folder `output`; returns its path.

    Parameters
    ----------
    in_report : whether an overview stands, or will stand, beside it

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    write_plotly(output)
    write_whole(output / FILE_NAME, render(found, in_report=in_report))
    return output / FILE_NAME


def render(found: Performance, *, in_report: bool = False) -> str:
    """The page as HTML."""
    figures = {
        "seconds": seconds_figure(found.series),
        "memory": memory_figure(found.series),
        "relative": relative_figure(found.series),
        "levels": levels_figure(found.study),
    }
    return rendered(
        "performance/page.html.jinja",
        {f"figure-{name}": figure for name, figure in figures.items()},
        PLOTLY_FILE,
        heights={name: figure.layout.height for name, figure in figures.items()},
        machine=found.machine,
        level=LEVEL,
        order=ORDER,
        resolution=RESOLUTION,
        largest=wording.count(found.series[0].sizes[-1].elements),
        aims=wording.aims(found.series),
        seconds_caption=wording.seconds_caption(found.series),
        memory_caption=wording.memory_caption(found.series),
        relative_caption=wording.relative_caption(found.series),
        series=[(wording.kind(one), _size_rows(one)) for one in found.series],
        sizes_note=wording.sizes_note(found.series),
        breakdown=found.breakdown,
        parts=_part_rows(found.breakdown),
        parts_note=wording.parts_note(found.breakdown),
        study=found.study,
        study_rows=_study_rows(found.study),
        orders=sorted({setting.order for setting in found.study.settings}),
        levels_caption=wording.levels_caption(found.study),
        levels_note=wording.levels_note(found.study),
        in_report=in_report,
    )


def _size_rows(series: Series) -> list[list[str]]:
    linear = series.relative(series.seconds)
    return [
        [
            wording.count(size.elements),
            wording.count(size.unknowns),
            milliseconds(size.timing.median),
            spread(size.timing),
            str(size.timing.runs),
            f"{1e6 * size.timing.median / size.elements:.0f}",
            f"{times:.2f}",
            f"{size.resident:.1f}",
            f"{grown:.1f}" if told else f"below {RESOLUTION:g}",
            f"{-1e3 * size.deflection:.5f}",
        ]
        for size, times, grown, told in zip(series.sizes, linear, series.growth, series.resolved, strict=True)
    ]


def _part_rows(breakdown: Breakdown) -> list[dict[str, Any]]:
    """A row for each part, the rest and the whole, and below it the quantities; a share is one of the whole."""
    whole = breakdown.whole.median

    def row(name: str, text: str, median: float, quartiles: str, *, inside: bool) -> dict[str, Any]:
        return {
            "name": name,
            "text": text,
            "median": milliseconds(median),
            "spread": quartiles,
            "share": relative(median / whole),
            "bar": f"{100.0 * max(median / whole, 0.0):.1f}" if inside else "",
        }

    inside = [
        row(name, TEXTS[name], timing.median, spread(timing), inside=True) for name, timing in breakdown.inside.items()
    ]
    rest = row(
        "Everything else",
        "the whole less its parts: displacements, energy, symmetry; below zero it is noise",
        breakdown.rest,
        "",
        inside=True,
    )
    outside = [
        row(name, TEXTS[name], timing.median, spread(timing), inside=False)
        for name, timing in breakdown.timings.items()
        if name in (WHOLE, QUANTITIES)
    ]
    return [*inside, rest, *outside]


def _study_rows(study: LevelStudy) -> list[dict[str, Any]]:
    levels = sorted({setting.level for setting in study.settings})
    return [
        {
            "level": level,
            "cells": [
                {
                    "time": milliseconds(setting.timing.median),
                    "error": "finest" if setting is study.finest else relative(study.error(setting)),
                    "outcome": "" if setting.outcome == "converged" else setting.outcome,
                }
                for setting in sorted((s for s in study.settings if s.level == level), key=lambda s: s.order)
            ],
        }
        for level in levels
    ]
