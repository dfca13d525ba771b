"""All measurements of the performance page, each in a process of its own, and where they were made."""

from __future__ import annotations

import os
import platform
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from reports.performance import levels, parts, scaling
from reports.performance.levels import LevelStudy, measured_levels
from reports.performance.parts import Breakdown, measured_parts
from reports.performance.scaling import Kind, Series, Size, empty_process, measured_seconds, measured_size
from reports.processes import in_own_process
from reports.progress import announced


@dataclass(frozen=True)
class Performance:
    """What the rod model costs.

    Attributes
    ----------
    series : cost against the number of elements, with elements of one length and of lengths that all differ
    machine : what it was measured on, in words
    """

    series: tuple[Series, ...]
    breakdown: Breakdown
    study: LevelStudy
    machine: str


def measure() -> Performance:
    """Carry out all measurements behind a progress bar.

    Raises
    ------
    ProcessFailed
        if a measurement raises or its process ends early.
    """
    kinds = [(elements, True) for elements in scaling.SIZES]
    kinds += [(elements, False) for elements in scaling.UNEQUAL_SIZES]
    with announced("performance", scaling.ROUNDS + len(kinds) + 3) as begun:
        series = measured_series(kinds, begun)
        begun("parts of a solve")
        breakdown = in_own_process(measured_parts, parts.REPEATS)
        begun("levels and orders")
        study = in_own_process(measured_levels, (levels.LEVELS, levels.ORDERS, levels.REPEATS))
    return Performance(series, breakdown, study, machine())


def measured_series(kinds: Sequence[Kind], begun: Callable[[str], None]) -> tuple[Series, ...]:
    """Seconds of all numbers of elements in one process, memory of each in its own; `begun` is told what begins."""
    seconds = in_own_process(measured_seconds, kinds, begun)
    begun("memory of an empty process")
    empty = in_own_process(empty_process, None)
    sizes: dict[bool, list[Size]] = {}
    for kind in kinds:
        elements, equal = kind
        begun(f"memory of {elements} elements{'' if equal else ' of unequal length'}")
        sizes.setdefault(equal, []).append(in_own_process(measured_size, (kind, seconds[kind])))
    return tuple(Series(equal, tuple(found), empty) for equal, found in sizes.items())


def machine() -> str:
    """Versions, processor type and threads."""
    threads = os.environ.get("OPENBLAS_NUM_THREADS") or os.environ.get("OMP_NUM_THREADS")
    used = {None: "as many threads as BLAS takes", "1": "one thread"}.get(threads, f"{threads} threads")
    versions = f"Python {platform.python_version()}, NumPy {np.__version__}, SciPy {scipy.__version__}"
    return f"{versions}; {platform.system()} on {platform.machine()}, {os.cpu_count()} processors, {used}"
