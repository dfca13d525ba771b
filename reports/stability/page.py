"""The stability page: a section for each sweep."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

from markupsafe import Markup

from reports.html import PLOTLY_FILE, rendered, write_plotly
from reports.stability.figures import HEIGHT, Look, figure, looks
from reports.stability.registry import SWEEPS, Stability
from reports.stability.sweep import Found, Picture, Sweep
from reports.stability.wording import number
from reports.store import write_whole

FILE_NAME = "stability.html"
# Marks of the figures' symbols in the key, within 30 x 12
_MARKS = {
    "circle": '<circle cx="15" cy="6" r="3.6"/>',
    "square": '<rect x="11.6" y="2.6" width="6.8" height="6.8"/>',
    "diamond": '<path d="M15 1.5 19.5 6 15 10.5 10.5 6Z"/>',
    "triangle-up": '<path d="M15 2 19.2 9.4H10.8Z"/>',
    "triangle-down": '<path d="M15 10 10.8 2.6h8.4Z"/>',
}


def write_stability(stability: Stability, output: Path, *, in_report: bool = False) -> Path:
    """Write `stability.html` into the folder `output`; returns its path.

    Parameters
    ----------
    in_report : whether an overview stands, or will stand, beside it

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    write_plotly(output)
    write_whole(output / FILE_NAME, render(stability, in_report=in_report))
    return output / FILE_NAME


def render(stability: Stability, *, in_report: bool = False) -> str:
    """The page as HTML, of the sweeps that were carried out."""
    content, figures = [], {}
    for index, sweep in enumerate((each for each in SWEEPS if each.name in stability.found), start=1):
        found = stability.found[sweep.name]
        section = _section(sweep, found, f"sweep-{index}")
        content.append(section)
        for picture, place in zip(sweep.pictures, section["pictures"], strict=True):
            figures[place["anchor"]] = figure(sweep, picture, found[picture.key])
    return rendered(
        "stability/page.html.jinja",
        figures,
        PLOTLY_FILE,
        sweeps=content,
        height=HEIGHT,
        seconds=f"{stability.seconds:.0f}",
        kept_since=stability.kept_since,
        in_report=in_report,
    )


def summary(stability: Stability) -> list[str]:
    """What `rodcheck stability` prints."""
    carried_out = [(sweep, stability.found[sweep.name]) for sweep in SWEEPS if sweep.name in stability.found]
    return [
        f"{sweep.name}: {'holds' if sweep.holds(found) else 'does not hold'}. {sweep.claim(found)}"
        for sweep, found in carried_out
    ]


def _section(sweep: Sweep, found: Found, anchor: str) -> dict[str, Any]:
    return {
        "anchor": anchor,
        "name": sweep.name,
        "driven": _unbroken(sweep.driven),
        "claim": _unbroken(sweep.claim(found)),
        "own_limit": _unbroken(sweep.own_limit(found)),
        "holds": sweep.holds(found),
        "pictures": [
            _picture(sweep, picture, found, f"{anchor}-{number_}") for number_, picture in enumerate(sweep.pictures, 1)
        ],
    }


def _unbroken(text: str) -> str:
    """A sentence whose formulas and numbers with their units stay on one line."""
    for joint in (" / ", " = ", " x "):
        text = text.replace(joint, joint.replace(" ", "\u00a0"))
    return re.sub(r"(?<=[0-9⁰¹²³⁴⁵⁶⁷⁸⁹]) (?=(%|mm|N|MPa)\b|%)", "\u00a0", text)


def _picture(sweep: Sweep, picture: Picture, found: Found, anchor: str) -> dict[str, Any]:
    curves = found[picture.key]
    keys = [(name, _swatch(look)) for name, look in looks(sweep, curves).items()]
    first = next(iter(curves.values()))
    shared = not picture.ticks and all(curve.x == first.x for curve in curves.values())
    rows = []
    if shared:
        rows = [
            [number(x, 4), *(_cell(curve.y[place]) for curve in curves.values())] for place, x in enumerate(first.x)
        ]
    return {
        "anchor": anchor,
        "title": picture.title,
        "x": picture.x,
        "y": picture.y,
        "key": keys,
        "methods": list(curves),
        "rows": rows,
    }


def _cell(value: float) -> str:
    return "" if math.isnan(value) else number(value, 3)


def _swatch(look: Look) -> Markup:
    dash = "" if look.ours else ' stroke-dasharray="5 3"'
    fill = look.colour if look.ours else "#fff"
    return Markup(
        f'<svg width="30" height="12" aria-hidden="true" stroke="{look.colour}" stroke-width="1.8" fill="{fill}">'
        f'<path d="M0 6H30"{dash}/>{_MARKS[look.symbol]}</svg>'
    )
