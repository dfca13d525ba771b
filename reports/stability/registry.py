"""All sweeps of the stability page, and how they are carried out."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, replace

from cases.loader import LIBRARY, TRUTH
from reports.cache import Cache
from reports.code_version import code_version, data_version
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
from reports.stability.sweep import Curve, Found, Sweep

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
    kept_since : the day it was computed on, YYYY-MM-DD, if it comes from the cache; else ''
    """

    found: Mapping[str, Found]
    seconds: float
    kept_since: str = ""

    @property
    def all_hold(self) -> bool:
        """Whether the numbers bear out every claim."""
        return all(BY_NAME[name].holds(found) for name, found in self.found.items())


def carry_out(cache: Cache | None = None) -> Stability:
    """Carry out all sweeps, in a process of their own and behind a progress bar.

    Parameters
    ----------
    cache : where numbers are looked for, and kept if they bear out every claim

    Raises
    ------
    ProcessFailed
        if a sweep raises or the process ends early.
    """
    question = code_version(__name__), data_version(LIBRARY, TRUTH)
    kept = None if cache is None else cache.find("stability", question, (Stability, Curve))
    if kept is not None:
        found: Stability = kept.value
        return replace(found, kept_since=kept.date)
    with announced("stability", len(SWEEPS)) as begun:
        found = in_own_process(_measured, tuple(BY_NAME), begun)
    if cache is not None and found.all_hold:
        cache.keep("stability", question, found)
    return found


def _measured(names: tuple[str, ...], progress: Progress) -> Stability:
    """What sweeps found, which unlike them can pass from process to process."""
    found = {}
    for name in names:
        progress(name)
        sweep = BY_NAME[name]
        found[name] = sweep.measure(sweep.values)
    return Stability(found, time.process_time())
