"""All sweeps of the stability page, and how they are carried out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass

from reports.processes import Progress, in_own_process
from reports.progress import announced
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
    with announced("stability", len(SWEEPS)) as begun:
        return in_own_process(_measured, tuple(BY_NAME), begun)


def _measured(names: tuple[str, ...], progress: Progress) -> Stability:
    """What sweeps found, which unlike them can pass from process to process."""
    found = {}
    for name in names:
        progress(name)
        sweep = BY_NAME[name]
        found[name] = sweep.measure(sweep.values)
    return Stability(found, time.process_time())
