"""What the report's pages have in common: look, plotly's script, figures as data, marks of verdicts.

A page fetches nothing: styles, pictures and data stand in it, plotly's script too or in one file beside the pages that
share it, and its content security policy forbids the rest.
"""

from __future__ import annotations

import json
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import cache
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import Any

import plotly.graph_objects as go
from jinja2 import Environment, FileSystemLoader, StrictUndefined, select_autoescape
from markupsafe import Markup
from plotly.offline import get_plotlyjs

from reports.comparison import Verdict
from reports.store import write_whole

HERE = Path(__file__).parent
# Plotly's script, 5 MB, as a file of the report's folder.
PLOTLY_FILE = "plotly.min.js"


def rendered(template: str, figures: Mapping[str, go.Figure], plotly_file: str = "", **content: object) -> str:
    """A page as HTML: a template with its content, and the figures by the id of their place.

    Parameters
    ----------
    plotly_file : where the page finds plotly's script, relative to itself; without it the script stands in the page
    """
    return (
        _environment()
        .get_template(template)
        .render(
            css=Markup((HERE / "page.css").read_text(encoding="utf-8")),
            plotly=Markup("" if plotly_file else get_plotlyjs()),
            plotly_file=plotly_file,
            figures=script_json({place: _plain(figure) for place, figure in figures.items()}),
            date=datetime.now(UTC).strftime("%d %B %Y, %H:%M UTC"),
            version=_version(),
            **content,
        )
    )


@cache
def _environment() -> Environment:
    """Templates, compiled once for all pages of a report."""
    environment = Environment(
        loader=FileSystemLoader(HERE),
        autoescape=select_autoescape(default=True, default_for_string=True),
        undefined=StrictUndefined,
        trim_blocks=True,
    )
    environment.globals.update(verdict=_verdict_mark, verdicts=_verdict_marks)
    return environment


def write_plotly(folder: Path) -> None:
    """Write plotly's script into a folder, unless it is there.

    Raises
    ------
    OSError
        if the folder or the file cannot be written.
    """
    script, path = get_plotlyjs(), folder / PLOTLY_FILE
    if not (path.is_file() and path.read_text(encoding="utf-8") == script):
        write_whole(path, script)


def _plain(figure: go.Figure) -> dict[str, Any]:
    plain: dict[str, Any] = json.loads(figure.to_json())
    return plain


def _version() -> str:
    try:
        return version("rodcheck")
    except PackageNotFoundError:
        return "not installed"


def script_json(value: object) -> Markup:
    """JSON that may stand inside a script element."""
    text = json.dumps(value, separators=(",", ":"), allow_nan=False)
    return Markup(text.replace("<", "\\u003c"))


def _verdict_mark(verdict: Verdict) -> Markup:
    return Markup('<span class="verdict {}">{}</span>').format(verdict.replace(" ", "-"), verdict)


def _verdict_marks(counts: Mapping[Verdict, int]) -> Markup:
    marks = [
        Markup('<span class="verdict {}">{} {}</span>').format(verdict.replace(" ", "-"), count, verdict)
        for verdict, count in counts.items()
        if count
    ]
    return Markup(" ").join(marks)
