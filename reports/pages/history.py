"""The history of a case on its page: every quantity of every solver over the nightly runs, each as a small chart."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
from markupsafe import Markup

from reports.formatting import NOTHING, number, seconds
from reports.nightly.drift import Drift, allowed, by_difference, measured, named
from reports.nightly.rows import FAILED, RUN, Row
from reports.solution import Array

# What moved: kind and words of a drift, and its text.
Moved = dict[tuple[str, str], str]
# What a solver spends, as rows have it.
COSTS = ("seconds", "memory")
# Size of a chart and its margin, in pixels.
WIDTH, HEIGHT, MARGIN = 220, 40, 5
# A chart of seconds or memory shows at least this share of the largest, so that noise looks like noise.
LEAST_SPAN = 0.2


def history_part(case: str, rows: Sequence[Row], drifts: Sequence[Drift]) -> dict[str, Any] | None:
    """What the template `pages/history.html.jinja` needs to know; None where there is no history.

    Parameters
    ----------
    rows : of all cases and runs, oldest first, those of this run too
    drifts : all that moved in this run, of any case
    """
    mine = [row for row in rows if row.case == case]
    if not mine:
        return None
    runs = {row.run: row.time for row in mine}
    tonight = mine[-1].run
    moved: Moved = {(drift.kind, drift.of): drift.text for drift in drifts if drift.case == case}
    failed = [
        f"{row.time:%Y-%m-%d %H:%M}: {row.reason}" for row in mine if row.quantity == RUN and row.verdict == FAILED
    ]
    return {
        "runs": len(runs),
        "first": f"{min(runs.values()):%d %B %Y}",
        "groups": [
            ("Values", _values(mine, tonight, moved)),
            ("Seconds and memory", [each for kind in COSTS for each in _costs(mine, kind, tonight, moved)]),
        ],
        "moved": [f"{drift.of}: {drift.text}" for drift in drifts if drift.case == case],
        "failed": failed,
    }


def _values(rows: Sequence[Row], tonight: str, moved: Moved) -> list[dict[str, Any]]:
    """A line for each quantity of each solver; one held against several references has one."""
    series: dict[str, dict[str, Row]] = defaultdict(dict)
    for row in rows:
        if row.quantity != RUN and measured(row) and all(np.isfinite(measured(row))):
            series[named(row)].setdefault(row.run, row)
    found = []
    for what, by_run in series.items():
        each = list(by_run.values())
        last = each[-1]
        distance = by_difference(last) and last.relative
        scale = 100.0 if distance else 1.0
        values = zip(each, _liveliest([measured(row) for row in each]), strict=True)
        found.append(
            _line(
                what + (" (difference)" if by_difference(last) else ""),
                [(row, scale * value) for row, value in values],
                least=2.0 * scale * allowed(last),
                told=partial(_with_unit, "%" if distance else last.unit),
                tonight=tonight,
                moved=moved.get(("value", what), ""),
            )
        )
    return found


def _liveliest(numbers: Sequence[tuple[float, ...]]) -> list[float]:
    """Of several numbers, such as edges, the one that moves most over the runs; the first if not all have as many."""
    at = int(np.argmax(np.ptp(numbers, axis=0))) if len(set(map(len, numbers))) == 1 else 0
    return [each[at] for each in numbers]


def _with_unit(unit: str, value: float) -> str:
    return f"{number(value)} {unit}".strip()


def _costs(rows: Sequence[Row], kind: str, tonight: str, moved: Moved) -> list[dict[str, Any]]:
    """A line for each solver's seconds or memory, without runs that took them from the cache."""
    series: dict[str, dict[str, tuple[Row, float]]] = defaultdict(dict)
    for row in rows:
        spent = getattr(row, kind)
        if spent is not None and not row.kept_since:
            series[row.solver].setdefault(row.run, (row, spent))
    told: Callable[[float], str] = seconds if kind == "seconds" else lambda value: f"{value:.0f} MB"
    found = []
    for solver, by_run in series.items():
        each, what = list(by_run.values()), f"{solver} {kind}"
        least = LEAST_SPAN * max(spent for _, spent in each)
        found.append(_line(what, each, least, told, tonight, moved.get((kind, what), "")))
    return found


def _line(
    what: str, series: Sequence[tuple[Row, float]], least: float, told: Callable[[float], str], tonight: str, moved: str
) -> dict[str, Any]:
    values = np.array([value for _, value in series])
    here = series[-1][0].run == tonight
    spread = f"{told(values.min())} to {told(values.max())}" if np.ptp(values) > 0.0 else NOTHING
    labels = [f"{row.time:%Y-%m-%d %H:%M}: {told(value)}" for row, value in series]
    return {
        "what": what,
        "runs": len(values),
        "last": told(values[-1]) if here else NOTHING,
        "spread": spread,
        "moved": moved,
        "chart": _chart(what, values, labels, least, here),
    }


def _chart(what: str, values: Array, labels: Sequence[str], least: float, here: bool) -> Markup:
    """Values over runs as a line; the height stands for the span of the values, or for `least` where that is larger.

    here : whether the last value is this run's, and is marked
    """
    span = max(float(np.ptp(values)), least) or 1.0
    middle = 0.5 * float(values.min() + values.max())
    x = np.linspace(MARGIN, WIDTH - MARGIN, len(values)) if len(values) > 1 else np.array([WIDTH / 2])
    y = HEIGHT / 2 - (values - middle) / span * (HEIGHT - 2 * MARGIN)
    line = " ".join(f"{right:.1f},{down:.1f}" for right, down in zip(x, y, strict=True))
    points = Markup("").join(
        Markup('<circle class="{}" cx="{:.1f}" cy="{:.1f}" r="{}"><title>{}</title></circle>').format(
            "tonight" if mine else "point", right, down, 3.4 if mine else 2.2, label
        )
        for right, down, label, mine in zip(x, y, labels, [*[False] * (len(x) - 1), here], strict=True)
    )
    text = f"{what} over {len(values)} run{'s' if len(values) > 1 else ''}, last {labels[-1]}"
    shape = Markup('<svg viewBox="0 0 {w} {h}" width="{w}" height="{h}" role="img" aria-label="{text}">').format(
        w=WIDTH, h=HEIGHT, text=text
    )
    return shape + Markup('<polyline class="line" points="{}"/>').format(line) + points + Markup("</svg>")
