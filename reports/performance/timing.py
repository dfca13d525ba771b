"""Wall-clock seconds of repeated work: medians and quartiles, since single runs are noisy."""

from __future__ import annotations

import statistics
import time
from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True)
class Timing:
    """Seconds of several runs of the same work, at least one, in the order they were run."""

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
    """Seconds of one run of work(*given)."""
    begin = time.perf_counter()
    work(*given)
    return time.perf_counter() - begin


def repeated(
    work: Callable[[], object], before: tuple[float, ...], seconds: float, at_least: int, at_most: int
) -> Timing:
    """Run again until so many seconds are spent, with those of runs before, but so often at least and at most."""
    spent = list(before)
    while len(spent) < at_least or (sum(spent) < seconds and len(spent) < at_most):
        spent.append(once(work))
    return Timing(tuple(spent))
