"""Which configurations are worth their cost: the Pareto front, and the race to a given accuracy."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from reports.chart.points import (
    CALCULIX,
    NGSOLVE,
    NGSOLVE_BOUNDARY,
    NGSOLVE_TUNED,
    ROD_AUTO,
    ROD_GRADED,
    ROD_OWN,
    SOLID,
    Chart,
    Charted,
    Point,
)

# What a race is to: contact force and largest deflection both within it.
TOLERANCES = (0.01, 0.001, 0.0002)
RACED: tuple[Charted, ...] = ("contact_force", "largest_deflection")
ROD = "rod model, the best of those fixed"
# What points cost, by name.
COSTS: Mapping[str, Callable[[Point], float]] = {
    "seconds": lambda point: point.median,
    "unknowns": lambda point: float(point.unknowns),
}
# Who races, and the methods whose cheapest configuration counts for it.
RUNNERS = {
    ROD_AUTO: (ROD_AUTO,),
    ROD: (ROD_OWN, ROD_GRADED),
    "beam theory": ("Euler-Bernoulli beams", "Timoshenko beams"),
    NGSOLVE_TUNED: (NGSOLVE_TUNED,),
    NGSOLVE_BOUNDARY: (NGSOLVE_BOUNDARY,),
    NGSOLVE: (NGSOLVE,),
    SOLID: (SOLID,),
    CALCULIX: (CALCULIX,),
}


@dataclass(frozen=True)
class Finish:
    """How a runner did.

    Attributes
    ----------
    cheapest : its configuration with the fewest seconds that is accurate enough; None if none is
    ratio : its seconds over those of the rod model, of its own choice if that is accurate enough; None where either
        has none
    """

    runner: str
    cheapest: Point | None
    ratio: float | None


@dataclass(frozen=True)
class Race:
    """A race to a tolerance.

    Attributes
    ----------
    certain : whether the reference is known at least as well as the tolerance asks
    """

    tolerance: float
    certain: bool
    finishes: tuple[Finish, ...]


def front(chart: Chart, quantity: Charted, cost: Callable[[Point], float]) -> tuple[Point, ...]:
    """Points that no other beats in both cost and error, by cost.

    Errors within the uncertainty of the reference are equal: of those nobody can tell which is smaller.
    """
    floor = chart.references[quantity].uncertainty or 0.0
    drawn = [(cost(point), max(error, floor), point) for point, error in drawn_points(chart, quantity)]
    found: list[Point] = []
    least = float("inf")
    for _, error, point in sorted(drawn, key=lambda each: each[:2]):
        if error < least:
            found.append(point)
            least = error
    return tuple(found)


def drawn_points(chart: Chart, quantity: Charted) -> list[tuple[Point, float]]:
    """Points whose error is known, and it."""
    errors = [(point, chart.error(quantity, point)) for point in chart.points]
    return [(point, error) for point, error in errors if error is not None]


def races(chart: Chart, tolerances: Sequence[float] = TOLERANCES) -> tuple[Race, ...]:
    """The cheapest configuration of every method that took part and keeps each tolerance."""
    raced = [quantity for quantity in RACED if quantity in chart.references and chart.references[quantity].values]
    taking_part = {point.method for point in chart.points}
    found = []
    for tolerance in tolerances:
        cheapest = {
            runner: min(_accurate(chart, methods, raced, tolerance), key=lambda point: point.median, default=None)
            for runner, methods in RUNNERS.items()
            if taking_part & set(methods)
        }
        rod = cheapest.get(ROD_AUTO) or cheapest.get(ROD)
        finishes = tuple(
            Finish(runner, point, None if point is None or rod is None else point.median / rod.median)
            for runner, point in cheapest.items()
        )
        doubts = [chart.references[quantity].uncertainty for quantity in raced]
        certain = all(doubt is not None and doubt <= tolerance for doubt in doubts)
        found.append(Race(tolerance, certain, finishes))
    return tuple(found)


def asked(tolerance: float) -> str:
    """Label of the rod model's own choice for a tolerance."""
    return f"asked for {100.0 * tolerance:g} %"


def _accurate(chart: Chart, methods: Sequence[str], raced: Sequence[Charted], tolerance: float) -> list[Point]:
    """Points of some methods that keep a tolerance; of those that chose for themselves, the one asked for it alone."""
    found = []
    for point in chart.points:
        if point.method == ROD_AUTO and point.label != asked(tolerance):
            continue
        errors = [chart.error(quantity, point) for quantity in raced]
        if point.method in methods and all(error is not None and error <= tolerance for error in errors):
            found.append(point)
    return found
