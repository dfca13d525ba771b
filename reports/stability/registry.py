"""All sweeps of the stability page, and how they are carried out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, TextColumn, TimeElapsedColumn
from rich.progress import Progress as Bars

from reports.processes import Progress, in_own_process
from reports.stability import (
    axial_order,
    border_search,
    curvature,
    element_ratio,
    fixed_borders,
    gap,
    incompressible,
    node_to_surface,
    penalty,
    reversals,
    section_functions,
    slenderness,
    stiffness_ratio,
)
from reports.stability.sweep import Found, Sweep

SWEEPS: tuple[Sweep, ...] = (
    slenderness.SWEEP,
    incompressible.SWEEP,
    curvature.SWEEP,
    section_functions.SWEEP,
    axial_order.SWEEP,
    element_ratio.SWEEP,
    penalty.SWEEP,
    stiffness_ratio.SWEEP,
    gap.SWEEP,
    reversals.SWEEP,
    border_search.SWEEP,
    fixed_borders.SWEEP,
    node_to_surface.SWEEP,
)
BY_NAME = {sweep.name: sweep for sweep in SWEEPS}


@dataclass(frozen=True)
class Stability:
    """What all sweeps found.

    Attributes
    ----------
    found : by the sweeps' names
    seconds : of processor time that it took
    """

    found: Mapping[str, Found]
    seconds: float


def carry_out() -> Stability:
    """Carry out all sweeps, in a process of their own and behind a progress bar.

    Raises
    ------
    ProcessFailed
        if a sweep raises or the process ends early.
    """
    console = Console(stderr=True)
    columns = (TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeElapsedColumn())
    with Bars(*columns, console=console, transient=True, disable=not console.is_terminal) as bars:
        task = bars.add_task("", total=len(SWEEPS))

        def begun(name: str) -> None:
            bars.update(task, description=f"stability: {name}")
            bars.advance(task)

        return in_own_process(_measured, tuple(BY_NAME), begun)


def _measured(names: tuple[str, ...], progress: Progress) -> Stability:
    """What sweeps found, which unlike them can pass from process to process."""
    found = {}
    for name in names:
        progress(name)
        sweep = BY_NAME[name]
        found[name] = sweep.measure(sweep.values)
    return Stability(found, time.process_time())
