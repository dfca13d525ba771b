"""Theory and glossary: what the models are, how each quantity is defined, what verdicts mean."""

from __future__ import annotations

from collections.abc import Sequence

from latex2mathml.converter import convert
from markupsafe import Markup

from reports.html import rendered
from reports.quantities import DEFINITIONS


def theory_page(site: Sequence[tuple[str, str]]) -> str:
    """The page as HTML.

    Parameters
    ----------
    site : addresses and names of the report's pages
    """
    return rendered(
        "pages/theory.html.jinja",
        {},
        definitions=DEFINITIONS,
        formula=_formula,
        symbol=_symbol,
        site=site,
        here="Theory and glossary",
    )


def _formula(tex: str) -> Markup:
    """A formula in TeX as MathML on a line of its own."""
    return Markup(convert(tex, display="block"))


def _symbol(tex: str) -> Markup:
    """A formula in TeX as MathML within a line."""
    return Markup(convert(tex))
