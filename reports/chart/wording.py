"""How a chart and its race are told in words, on the terminal and on the page alike."""

from __future__ import annotations

from collections.abc import Sequence

from reports.chart.front import COSTS, ROD, Race, drawn_points, front, races
from reports.chart.points import LENGTHS, TITLES, Chart, Charted, Point

NONE = "none"
RATIOS = "x: seconds over those of the rod model that are marked 1 x."


def told(point: Point) -> str:
    """A configuration by name."""
    return f"{point.method}, {point.label}"


def duration(seconds: float) -> str:
    """Seconds with the unit that suits them."""
    return f"{1e3 * seconds:.3g} ms" if seconds < 1.0 else f"{seconds:.3g} s"


def seconds_text(point: Point) -> str:
    """Median of the seconds, and between which they lay where there are several."""
    if len(point.seconds) == 1:
        return duration(point.median)
    return f"{duration(point.median)} ({duration(min(point.seconds))} to {duration(max(point.seconds))})"


def error_text(quantity: Charted, error: float | None) -> str:
    """An error with its unit."""
    if error is None:
        return "\u2013"
    return f"{error:.2g} mm" if quantity in LENGTHS else f"{100.0 * error:.2g} %"


def caption(chart: Chart, quantity: Charted) -> str:
    """What is below a figure."""
    reference = chart.references[quantity]
    known = "unknown" if reference.uncertainty is None else error_text(quantity, reference.uncertainty)
    sentences = [f"Uncertainty of the reference: {known}."]
    if reference.reason:
        sentences.append(f"Left out: {reference.reason}.")
    silent = _silent(chart, quantity)
    if silent:
        sentences.append(f"Not drawn, as they do not tell it or touch over other stretches: {', '.join(silent)}.")
    return " ".join(sentences)


def alternative(chart: Chart, quantity: Charted, panel: str) -> str:
    """A panel in words: what is on the front."""
    errors, cost = dict(drawn_points(chart, quantity)), COSTS[panel]
    best = [
        f"{told(point)}: {error_text(quantity, errors[point])} with {_cost_text(panel, point)}"
        for point in front(chart, quantity, cost)
    ]
    what = f"{TITLES[quantity]}: error of {len(errors)} configurations against {panel}, on logarithmic scales"
    return f"{what}. None is both cheaper and nearer than: {'; '.join(best)}."


def _cost_text(panel: str, point: Point) -> str:
    return duration(point.median) if panel == "seconds" else f"{point.unknowns} unknowns"


def race_heading(race: Race) -> str:
    """The tolerance, and whether it can be told who keeps it."""
    return f"{100.0 * race.tolerance:g} %" + ("" if race.certain else ", which the reference is too uncertain for")


def race_rows(found: Sequence[Race]) -> list[tuple[str, list[tuple[str, str]]]]:
    """For each method and race: the cheapest configuration, its seconds and their ratio to the rod model's."""
    rows: dict[str, list[tuple[str, str]]] = {}
    for race in found:
        for finish in race.finishes:
            cells = rows.setdefault(finish.runner, [])
            if finish.cheapest is None:
                cells.append((NONE, ""))
                continue
            ratio = "" if finish.ratio is None else f", {_times(finish.ratio)}"
            whose = finish.cheapest.label if finish.runner in (ROD, finish.cheapest.method) else told(finish.cheapest)
            cells.append((whose, f"{seconds_text(finish.cheapest)}{ratio}"))
    return list(rows.items())


def _times(ratio: float) -> str:
    """A ratio with three digits and no exponent."""
    return f"{float(f'{ratio:.3g}'):,.10g} x".replace(",", " ").replace(" ", "\u00a0")


def print_race(chart: Chart) -> None:
    """Print the race of a chart."""
    from rich.markup import escape
    from rich.table import Table

    from reports.tables import console

    out = console()
    out.print(f"[bold]{escape(chart.title)}[/]: the cheapest of each method that keeps a tolerance in {raced(chart)}")
    found = races(chart)
    table = Table("method", *(race_heading(race) for race in found), show_lines=True)
    for runner, cells in race_rows(found):
        table.add_row(runner, *(escape("\n".join(part for part in cell if part)) for cell in cells))
    out.print(table)
    out.print(RATIOS)
    for sentence in chart.notes:
        out.print(escape(sentence))


def raced(chart: Chart) -> str:
    """What counts in a race."""
    forces = "contact_force" in chart.references and chart.references["contact_force"].values
    return "every contact force and every rod's largest deflection" if forces else "every rod's largest deflection"


def unfinished(chart: Chart) -> list[str]:
    """Configurations that did not converge, and why."""
    return [f"{told(point)}: {point.outcome}" for point in chart.points if point.outcome != "converged"]


def _silent(chart: Chart, quantity: Charted) -> list[str]:
    """Methods of which no configuration is drawn, and configurations of others that converged and are not."""
    drawn = {point for point, _ in drawn_points(chart, quantity)}
    shown = {point.method for point in chart.points if point in drawn}
    found = []
    for point in chart.points:
        if point in drawn or point.outcome != "converged":
            continue
        found.append(told(point) if point.method in shown else point.method)
    return list(dict.fromkeys(found))
