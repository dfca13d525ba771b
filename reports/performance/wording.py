"""What the measurements show, in sentences made from them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reports.comparison import Verdict
from reports.performance.levels import LevelStudy, Setting
from reports.performance.parts import Breakdown
from reports.performance.scaling import PowerLaw, Series, apart
from reports.performance.timing import Timing
from reports.verification.wording import relative

# Slopes aimed at: 1 within 10 %; and memory of the process that solves the largest rod, MB.
SLOPE_TOLERANCE = 0.1
MOST_MEMORY = 2048.0
# A contact force this near that of the finest setting is near enough for the sentence under the figure.
NEAR = 1e-3


@dataclass(frozen=True)
class Aim:
    """Something aimed at and what was found.

    Attributes
    ----------
    where : of slopes, from which number of elements on
    over_all : of seconds, the slope over all sizes, for which nothing is aimed at
    """

    what: str
    aim: str
    found: str
    where: str
    over_all: str
    verdict: Verdict


def count(number: int) -> str:
    """A number of things with its thousands apart."""
    return f"{number:,}".replace(",", "\u202f")


def duration(seconds: float) -> str:
    """Seconds in the unit that suits them, two digits: more would be noise."""
    for unit, scale in (("s", 1.0), ("ms", 1e3)):
        if abs(seconds) * scale >= 1.0:
            return f"{_digits(seconds * scale, 2)} {unit}"
    return f"{_digits(seconds * 1e6, 2)} µs"


def megabytes(size: float) -> str:
    """Memory in MB without the unit, three digits."""
    return f"{size:#.3g}".rstrip(".") if size < 1000.0 else f"{size:.0f}"


def milliseconds(seconds: float) -> str:
    """Milliseconds without the unit: two decimals below 10, one below 100."""
    decimals = 2 if abs(seconds) < 0.01 else 1 if abs(seconds) < 0.1 else 0
    return f"{1e3 * seconds:.{decimals}f}".replace("-", "\u2212")


def spread(timing: Timing) -> str:
    """Quartiles in ms."""
    lower, upper = timing.quartiles
    return f"{milliseconds(lower)} to {milliseconds(upper)}"


def _digits(value: float, digits: int) -> str:
    return f"{float(f'{value:.{digits}g}'):g}"


def kind(series: Series) -> str:
    """What kind of elements it is about."""
    return "equal lengths" if series.equal else "unequal lengths"


def _kinds(values: list[tuple[Series, str]]) -> str:
    """A value for each kind of elements in a phrase."""
    return " and ".join(f"{value} with {kind(series)}" for series, value in values)


def aims(series: tuple[Series, ...]) -> list[Aim]:
    """What was aimed at of the cost against the number of elements, and what came of it."""
    bounds = f"{1.0 - SLOPE_TOLERANCE:g} to {1.0 + SLOPE_TOLERANCE:g}"
    found = []
    for one in series:
        law = one.time_law
        of_all = f"{one.time_law_of_all.slope:.2f}"
        found.append(Aim(f"Slope of seconds, {kind(one)}", bounds, _slope(law), _from(law), of_all, _linear(law)))
    for one in series:
        memory = one.memory_law
        found.append(Aim(f"Slope of memory, {kind(one)}", bounds, _slope(memory), _from(memory), "", _linear(memory)))
    for one in series:
        largest = one.sizes[-1]
        met: Verdict = "pass" if largest.resident <= MOST_MEMORY and largest.outcome == "converged" else "fail"
        what = f"Memory of a process with {count(largest.elements)} elements, {kind(one)}"
        found.append(Aim(what, "within 2 GB", f"{megabytes(largest.resident)} MB", "", "", met))
    return found


def _slope(law: PowerLaw | None) -> str:
    return "too small to tell" if law is None else f"{law.slope:.2f}"


def _from(law: PowerLaw | None) -> str:
    return "" if law is None else f"from {count(round(law.start))} on"


def _linear(law: PowerLaw | None) -> Verdict:
    """Whether a slope is near enough to 1."""
    if law is None:
        return "not resolved"
    return "pass" if abs(law.slope - 1.0) <= SLOPE_TOLERANCE else "fail"


def seconds_caption(series: tuple[Series, ...]) -> str:
    """What the figure of seconds shows."""
    smallest, largest = series[0].sizes[0], series[0].sizes[-1]
    slopes = _kinds([(one, _slope(one.time_law)) for one in series])
    of_all = _kinds([(one, _slope(one.time_law_of_all)) for one in series])
    return (
        f"Aim: slope 1 within {relative(SLOPE_TOLERANCE)}; found {slopes} {_from(series[0].time_law)}, and {of_all} "
        f"over all sizes, where what a solve costs whatever its size weighs: {duration(smallest.timing.median)} for "
        f"{smallest.elements} elements, {duration(largest.timing.median)} for {count(largest.elements)}."
    )


def memory_caption(series: tuple[Series, ...]) -> str:
    """What the figure of memory shows."""
    laws = [(one, one.memory_law) for one in series]
    slopes = _kinds([(one, f"{_slope(law)} {_from(law)}".strip()) for one, law in laws])
    grown = _kinds([(one, f"{megabytes(one.growth[-1])} MB") for one in series])
    return (
        f"Aim: slope 1 within {relative(SLOPE_TOLERANCE)}; found {slopes}: {count(series[0].sizes[-1].elements)} "
        f"elements make the process grow by {grown}, above the {megabytes(series[0].empty)} MB of one that solved a "
        "single element."
    )


def relative_caption(series: tuple[Series, ...]) -> str:
    """What the figure of the cost relative to linear shows."""
    times = [(one, one.relative(one.seconds)) for one in series]
    large = np.concatenate([ratios[one.elements >= one.fitted_from] for one, ratios in times])
    small = " or ".join(f"{ratios[0]:.2g}" for _, ratios in times)
    return (
        f"Were cost proportional to the number of elements, all points would be at 1: those of seconds from "
        f"{series[0].fitted_from} elements on lie between {large.min():.2f} and {large.max():.2f}, and at "
        f"{series[0].sizes[0].elements} "
        f"elements an element takes {small} times as long as in the largest rod."
    )


def sizes_note(series: tuple[Series, ...]) -> str:
    """How sure the numbers are, and whether the answers agree."""
    runs = [size.timing.runs for one in series for size in one.sizes]
    failed = [size for one in series for size in one.sizes if size.outcome != "converged"]
    agree = (
        f"The end's deflection is the same to {relative(apart(series))} in all rods of {series[0].fitted_from} "
        "elements and more."
    )
    outcome = f" {len(failed)} of the solves did not converge." if failed else ""
    return f"Seconds are medians of {min(runs)} to {max(runs)} runs, with their quartiles. {agree}{outcome}"


def parts_note(breakdown: Breakdown) -> str:
    """Where the time goes, in a sentence or two."""
    inside = sorted(breakdown.inside.items(), key=lambda item: -item[1].median)
    whole = breakdown.whole.median
    (first, most), (second, next_most) = inside[:2]
    return (
        f"{first} takes {relative(most.median / whole)} of a solve and {second.lower()} "
        f"{relative(next_most.median / whole)}; in all it takes {breakdown.contact_solutions} contact "
        f"solutions. Medians and quartiles of {breakdown.whole.runs} runs, with tables of quadrature and basis "
        f"functions at hand; the first solve in a new process took {duration(breakdown.first)}."
    )


def levels_caption(study: LevelStudy) -> str:
    """What the figure of error against seconds shows."""
    near = [
        setting
        for setting in study.settings
        if setting is not study.finest and abs(study.error(setting)) <= NEAR and setting.outcome == "converged"
    ]
    finest = study.finest
    against = f"of h{finest.level}, p = {finest.order}, which takes {duration(finest.timing.median)}"
    if not near:
        return f"No other setting comes within {relative(NEAR)} of the contact force {against}."
    cheapest: Setting = min(near, key=lambda setting: setting.timing.median)
    return (
        f"The cheapest setting within {relative(NEAR)} of the contact force {against}, is h{cheapest.level}, "
        f"p = {cheapest.order}: {relative(study.error(cheapest))} in {duration(cheapest.timing.median)}."
    )


def levels_note(study: LevelStudy) -> str:
    """What the cells of the table of levels and orders hold."""
    runs = study.settings[0].timing.runs
    spent = [setting.contact_solutions for setting in study.settings]
    return (
        f"Each cell: milliseconds of a solve (median of {runs}) and, below, the difference of the contact force from "
        f"that of h{study.finest.level}, p = {study.finest.order}, {study.finest.force:.3f} N. All on the elements of "
        "the case file: what those leave out, all settings share. Times depend also on how many contact solutions it "
        f"takes to find the edges, here {min(spent)} to {max(spent)}."
    )


def summary(series: tuple[Series, ...], breakdown: Breakdown, study: LevelStudy) -> list[str]:
    """What `rodcheck performance` prints."""
    found = [
        " ".join(f"{aim.what}: {aim.found} {aim.where} (aim {aim.aim}), {aim.verdict}".split()) for aim in aims(series)
    ]
    whole = f"{breakdown.case}, h{breakdown.level}, p = {breakdown.order}: {duration(breakdown.whole.median)}."
    return [*found, f"{whole} {parts_note(breakdown)}", levels_caption(study)]
