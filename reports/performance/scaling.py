"""Cost against the number of elements: one cantilever cut into ever more elements, each number in its own process."""

from __future__ import annotations

import time
import tracemalloc
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import rodmodel as rm
from reports.memory import peak_memory
from reports.performance.timing import Timing, repeated
from reports.processes import Progress
from reports.solution import Array

LEVEL, ORDER = 2, 4
SIZES = (10, 30, 100, 300, 1000, 3000, 10_000)
UNEQUAL_SIZES = (10, 100, 1000, 10_000)
# The slope that counts is fitted from here on; below, what a solve costs whatever its size weighs too much.
FITTED_FROM = 100
# Each number of elements is solved until so many seconds are spent, but so often.
SECONDS, AT_LEAST, AT_MOST = 0.2, 3, 11

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
    """What one number of elements costs.

    Attributes
    ----------
    allocated : largest memory that Python and NumPy held for the solve, MB, as tracemalloc counts it
    resident : largest resident memory of the process that solved it, MB
    deflection : of the loaded end, mm
    """

    elements: int
    unknowns: int
    outcome: str
    timing: Timing
    allocated: float
    resident: float
    deflection: float


@dataclass(frozen=True)
class Series:
    """The same cantilever in ever more elements.

    Attributes
    ----------
    equal : whether the elements are all of one length
    sizes : with rising numbers of elements, two at least
    empty : largest resident memory of a process that solved a single element, MB
    fitted_from : number of elements from which on slopes are fitted; two sizes are as large at least
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
        """Median seconds of a solve, shape (n_sizes,)."""
        return np.array([size.timing.median for size in self.sizes])

    @property
    def allocated(self) -> Array:
        """Memory held for a solve, MB, shape (n_sizes,)."""
        return np.array([size.allocated for size in self.sizes])

    @property
    def growth(self) -> Array:
        """Largest resident memory above that of an empty process, MB, shape (n_sizes,)."""
        return np.array([size.resident - self.empty for size in self.sizes])

    def fit(self, costs: Array) -> PowerLaw:
        """Fit of `costs` from `fitted_from` elements on."""
        large = self.elements >= self.fitted_from
        return power_law(self.elements[large], costs[large])

    def fit_of_all(self, costs: Array) -> PowerLaw:
        """Fit of `costs` to all sizes."""
        return power_law(self.elements, costs)

    def relative(self, costs: Array) -> Array:
        """Cost of one element relative to that in the largest size: 1 where cost is proportional to the number."""
        each = costs / self.elements
        return np.asarray(each / each[-1])


@dataclass(frozen=True)
class PowerLaw:
    """cost = factor * n^slope: a straight line on logarithmic scales."""

    slope: float
    factor: float

    def at(self, numbers: Array) -> Array:
        """The line at numbers n."""
        return np.asarray(self.factor * numbers**self.slope)


def power_law(numbers: Array, costs: Array) -> PowerLaw:
    """The straight line through log cost against log n that is nearest in the least squares."""
    slope, intercept = np.polyfit(np.log(numbers), np.log(costs), 1)
    return PowerLaw(float(slope), float(np.exp(intercept)))


def measured_size(given: tuple[int, bool], progress: Progress) -> Size:
    """Solve so many elements, equal or not, again and again, and see what it takes; meant for a process of its own."""
    del progress
    elements, equal = given
    rm.solve(cantilever(1, equal=True), LEVEL, ORDER)
    scene = cantilever(elements, equal)
    begin = time.perf_counter()
    solution = rm.solve(scene, LEVEL, ORDER)
    first = time.perf_counter() - begin
    deflection = float(solution.displacement("bar", np.array([LENGTH]))[1, 0])
    unknowns, outcome = solution.cost.unknowns, solution.outcome
    del solution
    resident = peak_memory()
    timing = repeated(lambda: rm.solve(scene, LEVEL, ORDER), (first,), SECONDS, AT_LEAST, AT_MOST)
    tracemalloc.start()
    rm.solve(scene, LEVEL, ORDER)
    _, allocated = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    return Size(elements, unknowns, outcome, timing, allocated / 1e6, resident, deflection)


def empty_process(given: None, progress: Progress) -> float:
    """Largest resident memory of a process that solved a single element, MB: what importing and beginning takes."""
    del given, progress
    rm.solve(cantilever(1, equal=True), LEVEL, ORDER)
    return peak_memory()


def apart(series: Sequence[Series]) -> float:
    """Greatest relative difference of the end's deflection from that in the finest elements of its series' fit."""
    return max(
        abs(size.deflection / found.sizes[-1].deflection - 1.0)
        for found in series
        for size in found.sizes
        if size.elements >= found.fitted_from
    )
