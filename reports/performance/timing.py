"""Processor seconds of repeated work: medians and quartiles, since single runs are noisy.

Processor seconds, summed over threads, do not count the time in which the machine was busy with something else; on an
idle machine one thread's are those of a clock on the wall.
"""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Timing:
    """Processor seconds of several runs of the same work, at least one, in the order they were run."""

    seconds: tuple[float, ...]

    @property
    def runs(self) -> int:
        """How many runs there were."""
        return len(self.seconds)

    @property
    def median(self) -> float:
        """Median of the runs, s."""
        return statistics.median(self.seconds)

    @property
    def quartiles(self) -> tuple[float, float]:
        """Between which the middle half of the runs lies, s; least and greatest where there are fewer than four."""
        if self.runs < 4:
            return min(self.seconds), max(self.seconds)
        lower, _, upper = statistics.quantiles(self.seconds, n=4, method="inclusive")
        return lower, upper


def once(work: Callable[..., object], *given: object) -> float:
    """Processor seconds of one run of work(*given)."""
    begin = time.process_time()
    work(*given)
    return time.process_time() - begin


def repeated(work: Callable[[], object], seconds: float, at_most: int) -> tuple[float, ...]:
    """Run once and again until so many seconds are spent, but so often at most; seconds of the runs."""
    spent: list[float] = []
    while not spent or (sum(spent) < seconds and len(spent) < at_most):
        spent.append(once(work))
    return tuple(spent)
