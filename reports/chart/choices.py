"""How well the rod model chooses for itself: its errors, its estimates of them and its seconds, case by case.

Held against the 3D reference and against the cheapest of all configurations with fixed level, order and mesh, which
the charts have measured anyway. A sum over all cases comes with the names of those that fall short.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from statistics import median

from reports.chart.front import TOLERANCES, asked
from reports.chart.points import ROD_AUTO, ROD_GRADED, ROD_OWN, TITLES, Chart, Charted, Point
from reports.chart.wording import duration

# What the choice keeps its tolerance in.
PROMISED: tuple[Charted, ...] = ("contact_force", "largest_deflection", "clamp_moment")
# An estimate is good within this factor of the true error; a choice is quick within this one of the cheapest.
ESTIMATE_FACTOR, SECONDS_FACTOR = 5.0, 2.0
# Errors below are those of round-off, and no estimate need tell them.
ROUND_OFF = 1e-6
# What is asked for of all quantities: within tolerance, well estimated.
KEPT_ASKED, ESTIMATED_ASKED = 0.95, 0.90


@dataclass(frozen=True)
class Judged:
    """A quantity of a choice.

    Attributes
    ----------
    error, estimate : relative
    uncertainty : of the reference, relative; 0 where it is unknown
    """

    quantity: Charted
    of: str
    error: float
    estimate: float
    uncertainty: float

    @property
    def name(self) -> str:
        """The quantity and what it is of."""
        return f"{TITLES[self.quantity].lower()}, {self.of}"

    def kept(self, tolerance: float) -> bool:
        """Whether the error is within a tolerance."""
        return self.error <= tolerance

    def may_be_kept(self, tolerance: float) -> bool:
        """Whether it may be, for all that the reference tells."""
        return self.error - self.uncertainty <= tolerance

    @property
    def well_estimated(self) -> bool:
        """Whether the estimate is within `ESTIMATE_FACTOR` of an error that the reference leaves possible."""
        least, most = max(self.error - self.uncertainty, 0.0), self.error + self.uncertainty
        high_enough = ESTIMATE_FACTOR * self.estimate >= least or least < ROUND_OFF
        return high_enough and (self.estimate <= ESTIMATE_FACTOR * most or self.estimate < ROUND_OFF)


@dataclass(frozen=True)
class Choice:
    """What the rod model chose for a case and a tolerance.

    Attributes
    ----------
    case : its title
    point : its own
    judged : quantities that have a reference
    cheapest : the fixed configuration with the fewest seconds of those that keep the tolerance in all of them; None if
        none does
    """

    case: str
    tolerance: float
    point: Point
    judged: tuple[Judged, ...]
    cheapest: Point | None

    @property
    def promised(self) -> bool:
        """Whether it says that it keeps the tolerance."""
        return self.point.outcome == "converged"

    @property
    def ratio(self) -> float | None:
        """Its seconds over those of the cheapest; None where there is no such or nothing was promised."""
        return None if self.cheapest is None or not self.promised else self.point.median / self.cheapest.median

    @property
    def shortcomings(self) -> list[str]:
        """In what it falls short, a clause each."""
        found = []
        for each in self.judged:
            if self.promised and not each.kept(self.tolerance):
                doubt = ", which the reference is too uncertain to tell" if each.may_be_kept(self.tolerance) else ""
                found.append(f"{each.name}: off by {_percent(each.error)}{doubt}")
            if not each.well_estimated:
                found.append(f"{each.name}: estimated {_percent(each.estimate)}, is {_percent(each.error)}")
        if self.ratio is not None and self.ratio > SECONDS_FACTOR:
            found.append(f"{self.ratio:.3g} times the seconds of the cheapest")
        if not self.promised and self.cheapest is not None:
            found.append(f"refused, though {self.cheapest.label} keeps the tolerance")
        return found


def choices(charts: Sequence[Chart]) -> tuple[Choice, ...]:
    """The choices of all charts that have any, one a case and tolerance."""
    found = []
    for chart in charts:
        for tolerance in TOLERANCES:
            own = [each for each in chart.points if (each.method, each.label) == (ROD_AUTO, asked(tolerance))]
            found += [_choice(chart, tolerance, point) for point in own]
    return tuple(found)


def _choice(chart: Chart, tolerance: float, point: Point) -> Choice:
    judged = []
    for quantity in PROMISED:
        reference = chart.references.get(quantity)
        for of in () if reference is None else reference.values:
            error, estimate = chart.error_of(quantity, of, point), point.estimates.get((quantity, of))
            if reference is not None and error is not None and estimate is not None:
                uncertainty = reference.uncertainties.get(of) or 0.0
                judged.append(Judged(quantity, of, error, estimate[0], uncertainty))
    fixed = [each for each in chart.points if each.method in (ROD_OWN, ROD_GRADED) and _keeps(chart, each, tolerance)]
    return Choice(chart.title, tolerance, point, tuple(judged), min(fixed, key=lambda each: each.median, default=None))


def _keeps(chart: Chart, point: Point, tolerance: float) -> bool:
    wanted = [quantity for quantity in PROMISED if quantity in chart.references and chart.references[quantity].values]
    errors = [chart.error(quantity, point) for quantity in wanted]
    return len(errors) > 0 and all(error is not None and error <= tolerance for error in errors)


def summary(found: Sequence[Choice]) -> list[str]:
    """What comes out over all choices, a sentence each."""
    told = [(choice, each) for choice in found for each in choice.judged]
    kept = [each.kept(choice.tolerance) for choice, each in told if choice.promised]
    may_be = [each.may_be_kept(choice.tolerance) for choice, each in told if choice.promised]
    good = [each.well_estimated for _, each in told]
    ratios = [choice.ratio for choice in found if choice.ratio is not None]
    refused = sum(not choice.promised for choice in found)
    quick = [ratio <= SECONDS_FACTOR for ratio in ratios]
    sentences = [
        f"True error within the tolerance: {_part(kept)} ({KEPT_ASKED:.0%} asked).",
        f"True error within the tolerance for all that the reference tells: {_part(may_be)}.",
        f"Estimate within a factor {ESTIMATE_FACTOR:g} of the true error: {_part(good)} ({ESTIMATED_ASKED:.0%} asked).",
        f"At most {SECONDS_FACTOR:g} times the seconds of the cheapest fixed configuration: {_part(quick)} (all).",
    ]
    if ratios:
        sentences[-1] += f" Half of them take at most {median(ratios):.3g} times as long."
    if refused:
        sentences.append(f"Of {len(found)} requests {refused} were refused: the rod model does not get there.")
    return sentences


def rows(found: Sequence[Choice]) -> list[tuple[str, list[str], list[str]]]:
    """For each choice its case, the cells of its row in words, and in what it falls short."""
    result = []
    for choice in found:
        errors, estimates = [each.error for each in choice.judged], [each.estimate for each in choice.judged]
        cheapest = choice.cheapest
        cells = [
            f"{100.0 * choice.tolerance:g} %",
            choice.point.chosen if choice.promised else f"{choice.point.chosen}, refused",
            _percent(max(estimates)) if estimates else "\u2013",
            _percent(max(errors)) if errors else "\u2013",
            duration(choice.point.median),
            "none" if cheapest is None else f"{duration(cheapest.median)} ({cheapest.label})",
            "\u2013" if choice.ratio is None else f"{choice.ratio:.3g}",
        ]
        result.append((choice.case, cells, choice.shortcomings))
    return result


HEADINGS = (
    "Case",
    "Tolerance",
    "Levels, step by step",
    "Largest estimated error",
    "Largest true error",
    "Seconds",
    "Cheapest fixed configuration",
    "Ratio",
)


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if share < 1.0 else "100 % or more"


def _part(flags: Sequence[bool]) -> str:
    return f"{sum(flags)} of {len(flags)}" + (f", {100.0 * sum(flags) / len(flags):.1f} %" if flags else "")
