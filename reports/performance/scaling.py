"""Cost against the number of elements: one cantilever cut into ever more elements, each number in its own process."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import NDArray

import rodmodel as rm
from reports.memory import peak_memory
from reports.performance.timing import Timing, repeated
from reports.processes import Progress
from reports.solution import Array

BoolArray = NDArray[np.bool_]

LEVEL, ORDER = 2, 4
SIZES = (10, 30, 100, 300, 1000, 3000, 10_000)
UNEQUAL_SIZES = (10, 100, 300, 1000, 10_000)
# The slope that counts is fitted from here on; below, what a solve costs whatever its size weighs too much.
FITTED_FROM = 100
# All numbers of elements are timed in turn, so many times over; small ones each time until so many processor seconds
# are spent, but so often at most.
ROUNDS = 3
SECONDS, AT_MOST = 0.05, 5
# What a process grows by less than this, MB, is lost in what the operating system and Python hand out at once.
RESOLUTION = 2.0

LENGTH, SIDE = 1000.0, 15.0


def cantilever(elements: int, equal: bool) -> rm.Scene:
    """Square bar of 1 m under a unit force at its end.

    equal : whether all elements have the same length, so that they share one element matrix; otherwise no two do
    """
    weights = np.ones(elements) if equal else 1.0 + 0.5 * np.sin(np.arange(elements))
    borders = LENGTH * np.concatenate([[0.0], np.cumsum(weights)]) / np.sum(weights)
    rod = rm.Rod(
        "bar",
        rm.Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0)),
        rm.Rectangle(SIDE, SIDE),
        rm.Material(200e3, 0.3),
        tuple(borders.tolist()),
    )
    load = rm.SectionForce("bar", LENGTH, (0.0, -1.0, 0.0))
    return rm.Scene("cantilever", (rod,), (rm.Clamp("bar", "start"),), (load,), ())


@dataclass(frozen=True)
class Size:
    """One number of elements, solved in a process of its own.

    Attributes
    ----------
    resident : largest resident memory of the process, MB
    deflection : of the loaded end, mm
    timing : processor seconds of a solve
    """

    elements: int
    unknowns: int
    outcome: str
    resident: float
    deflection: float
    timing: Timing


@dataclass(frozen=True)
class Series:
    """The same cantilever in ever more elements.

    Attributes
    ----------
    equal : whether the elements are all of one length
    sizes : with rising numbers of elements, two at least
    empty : largest resident memory of a process that solved a single element, MB
    fitted_from : number of elements from which on the slope of seconds is fitted; two sizes are as large at least
    """

    equal: bool
    sizes: tuple[Size, ...]
    empty: float
    fitted_from: int = FITTED_FROM

    @property
    def elements(self) -> Array:
        """Numbers of elements, shape (n_sizes,)."""
        return np.array([float(size.elements) for size in self.sizes])

    @property
    def seconds(self) -> Array:
        """Median processor seconds of a solve, shape (n_sizes,)."""
        return np.array([size.timing.median for size in self.sizes])

    @property
    def growth(self) -> Array:
        """Largest resident memory above that of an empty process, MB, shape (n_sizes,)."""
        return np.array([size.resident - self.empty for size in self.sizes])

    @property
    def resolved(self) -> BoolArray:
        """Sizes whose memory can be told from that of an empty process, shape (n_sizes,)."""
        return self.growth > RESOLUTION

    @property
    def time_law(self) -> PowerLaw:
        """Seconds from `fitted_from` elements on."""
        large = self.elements >= self.fitted_from
        return power_law(self.elements[large], self.seconds[large])

    @property
    def time_law_of_all(self) -> PowerLaw:
        """Seconds of all sizes."""
        return power_law(self.elements, self.seconds)

    @property
    def memory_law(self) -> PowerLaw | None:
        """Growth of the process where it can be told; None where two sizes cannot."""
        if np.count_nonzero(self.resolved) < 2:
            return None
        return power_law(self.elements[self.resolved], self.growth[self.resolved])

    def relative(self, costs: Array) -> Array:
        """Cost of one element relative to that in the largest size: 1 where cost is proportional to the number."""
        each = costs / self.elements
        return np.asarray(each / each[-1])


@dataclass(frozen=True)
class PowerLaw:
    """cost = factor * n^slope: a straight line on logarithmic scales.

    Attributes
    ----------
    start, end : least and greatest n it was fitted to
    """

    slope: float
    factor: float
    start: float
    end: float

    def at(self, numbers: Array) -> Array:
        """The line at numbers n."""
        return np.asarray(self.factor * numbers**self.slope)


def power_law(numbers: Array, costs: Array) -> PowerLaw:
    """The straight line through log cost against log n that is nearest in the least squares."""
    slope, intercept = np.polyfit(np.log(numbers), np.log(costs), 1)
    return PowerLaw(float(slope), float(np.exp(intercept)), float(numbers.min()), float(numbers.max()))


Kind = tuple[int, bool]
"""How many elements, and whether they are equal."""


def measured_seconds(given: Sequence[Kind], progress: Progress) -> dict[Kind, Timing]:
    """Processor seconds of solves, all in turn, so that a slow spell of the machine meets them all."""
    rm.solve(cantilever(1, equal=True), LEVEL, ORDER)
    scenes = {kind: cantilever(*kind) for kind in given}
    seconds: dict[Kind, tuple[float, ...]] = dict.fromkeys(given, ())
    for number in range(ROUNDS):
        progress(f"seconds of a solve, round {number + 1} of {ROUNDS}")
        for kind, scene in scenes.items():
            seconds[kind] += repeated(partial(rm.solve, scene, LEVEL, ORDER), SECONDS, AT_MOST)
    return {kind: Timing(found) for kind, found in seconds.items()}


def measured_size(given: tuple[Kind, Timing], progress: Progress) -> Size:
    """Solve so many elements once, and see what memory it takes; meant for a process of its own."""
    del progress
    kind, timing = given
    rm.solve(cantilever(1, equal=True), LEVEL, ORDER)
    solution = rm.solve(cantilever(*kind), LEVEL, ORDER)
    deflection = float(solution.displacement("bar", np.array([LENGTH]))[1, 0])
    return Size(kind[0], solution.cost.unknowns, solution.outcome, peak_memory(), deflection, timing)


def empty_process(given: None, progress: Progress) -> float:
    """Largest resident memory of a process that solved a single element, MB: what importing and beginning takes."""
    del given, progress
    rm.solve(cantilever(1, equal=True), LEVEL, ORDER)
    return peak_memory()


def apart(series: Sequence[Series]) -> float:
    """Greatest relative difference of the end's deflection, from `fitted_from` elements on, from the largest rod's."""
    return max(
        abs(size.deflection / found.sizes[-1].deflection - 1.0)
        for found in series
        for size in found.sizes
        if size.elements >= found.fitted_from
    )
