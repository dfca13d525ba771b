"""Theory and glossary: what the models are, how each quantity is defined, what verdicts mean."""

from __future__ import annotations

import re
from collections.abc import Sequence
from html import unescape

from latex2mathml.converter import convert

from reports.html import rendered
from reports.quantities import DEFINITIONS

FORMULA = re.compile(r"\\\((.+?)\\\)|\\\[(.+?)\\\]", re.DOTALL)
# Quantities that the page explains in their places; any other of `DEFINITIONS` follows them.
EXPLAINED = frozenset(
    {
        *("contact_force", "contact_centre", "contact_edges", "contact_edges_outer"),
        *("pressure_middle", "pressure_mean", "pressure_outer"),
        *("penetration", "complementarity_residual", "contact_work"),
        *("deflection", "bending_moment", "bending_moment_stress", "end_moment_equilibrium", "end_moment_stress"),
        *("max_bending_stress", "stress_s", "strain_energy", "equilibrium_residual", "stress_residual"),
    }
)
GLOSSARY = (
    ("Active set", "the contact points that touch; a solver tries sets until no point pulls and none overlaps."),
    ("Bed", "springs under a face (Winkler): a stress per displacement, N/mm³; it may pull or, as ground, not."),
    (
        "Clamp",
        "an end section whose points cannot move; at its corners stress grows without bound as meshes get finer.",
    ),
    ("Contact zone", "the part of the first face in which the pair may touch."),
    ("Element border", "where elements of a rod meet; those at the edges of contact move."),
    ("First face", "of a pair, the one that carries normals, zone and stations; the second lies opposite."),
    ("Gap", "distance of two faces before the load; negative for an interference fit."),
    ("Joint", "rigid connection of ends of rods."),
    ("Level, h1, h2, ...", "degree of the polynomials over the section."),
    ("Order, p", "order of the shape functions along an element."),
    ("Peers", "solvers not of this project, CalculiX and NGSolve; they answer on one mesh each and carry no verdict."),
    ("Reference", "what a value is held against: the 3D of the run, independent 3D values, published values."),
    ("Station", "arc length along a rod at which a curve is told, mm."),
    ("Tolerance", "the largest difference that the case file lets pass."),
    ("Unknowns", "degrees of freedom carried in the solution."),
)


def theory_page(site: Sequence[tuple[str, str]]) -> str:
    """The page as HTML.

    Parameters
    ----------
    site : addresses and names of the report's pages
    """
    page = rendered(
        "pages/theory.html.jinja",
        {},
        definitions=DEFINITIONS,
        explained=EXPLAINED,
        glossary=GLOSSARY,
        site=site,
        here="Theory and glossary",
    )
    return _typeset(page)


def _typeset(page: str) -> str:
    r"""The page with its formulas as MathML: TeX between \( and \) within a line, \[ and \] on one of its own."""

    def converted(found: re.Match[str]) -> str:
        within, alone = found.groups()
        if within:
            return convert(unescape(within))
        return f'<div class="formula">{convert(unescape(alone), display="block")}</div>'

    return FORMULA.sub(converted, page)
