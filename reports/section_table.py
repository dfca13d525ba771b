"""Properties of a scene's cross-sections as a table for the case pages; they come from the rod model."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache

from markupsafe import Markup

from cases.scene import Rod, Section
from reports.formatting import number
from reports.sections import described
from rodmodel import SectionProperties, section_properties

# Degrees of the warping functions tried, from the highest on; a section too thin for one of them is left to the next.
DEGREES = (12, 10, 8, 6, 4)
# A shear centre this close to the centroid, as a part of the section's radius of gyration, is on it.
_AT_CENTROID = 1e-9
# A change of the torsion constant below this is round-off.
_ROUND_OFF = 1e-10
_X, _Y = Markup("I<sub>x</sub>"), Markup("I<sub>y</sub>")


@dataclass(frozen=True)
class SectionTable:
    """A column for each distinct section, a row for each property.

    Attributes
    ----------
    columns : the section in words, and the rods that have it
    rows : what and its unit, and a value for each section
    note : how far the torsion constants can be trusted
    """

    columns: tuple[tuple[str, str], ...]
    rows: tuple[tuple[str, tuple[str, ...]], ...]
    note: str


def section_table(rods: Sequence[Rod]) -> SectionTable:
    """The properties of the rods' sections, each section once."""
    sections = dict.fromkeys(rod.section for rod in rods)
    columns = [
        (described(section), ", ".join(rod.name for rod in rods if rod.section == section)) for section in sections
    ]
    found = [_properties(section) for section in sections]
    properties = [item.properties for item in found]
    rows = [
        ("Area A, mm²", [_digits(p.area) for p in properties]),
        ("Second moment " + _X + ", mm⁴", [_digits(p.second_moment_x) for p in properties]),
        ("Second moment " + _Y + ", mm⁴", [_digits(p.second_moment_y) for p in properties]),
        ("Principal moments I₁, I₂, mm⁴", [_pair(*p.principal_moments) for p in properties]),
        ("Angle from x to axis 1, degrees", [_digits(math.degrees(p.principal_angle)) for p in properties]),
        ("Section moduli W₁, W₂, mm³", [_pair(*p.section_moduli) for p in properties]),
        ("Torsion constant J, mm⁴", [_digits(p.torsion_constant) for p in properties]),
        ("Shear centre x, y, mm", [_shear_centre(p) for p in properties]),
    ]
    degrees = sorted({item.degree for item in found})
    fall = max(item.fall for item in found)
    settled = "nothing" if fall < _ROUND_OFF else f"{'' if len(found) == 1 else 'up to '}{100.0 * fall:.1g} %"
    note = (
        "About the centroid; axis 1 is that of the largest second moment. J is an upper bound, from warping functions "
        f"of degree {' or '.join(str(degree) for degree in degrees)}: the last two degrees took {settled} off it."
    )
    return SectionTable(tuple(columns), tuple((what, tuple(cells)) for what, cells in rows), note)


@dataclass(frozen=True)
class _Found:
    """Properties, the degree of their warping functions, and what its last two degrees took off J, relative to it."""

    properties: SectionProperties
    degree: int
    fall: float


@cache
def _properties(section: Section) -> _Found:
    """The properties with the highest degree the section allows.

    Raises
    ------
    ValueError
        if the section is too thin for any.
    """
    for degree in DEGREES:
        try:
            found = section_properties(section, degree)
        except ValueError:
            if degree == DEGREES[-1]:
                raise
            continue
        coarser = section_properties(section, degree - 2).torsion_constant
        break
    return _Found(found, degree, coarser / found.torsion_constant - 1.0)


def _pair(first: float, second: float) -> str:
    return f"{_digits(first)}, {_digits(second)}"


def _digits(value: float) -> str:
    """Six digits without zeros at their end."""
    text = number(value)
    return text.rstrip("0").rstrip(".") if "." in text and "e" not in text else text


def _shear_centre(properties: SectionProperties) -> str:
    x, y = properties.shear_centre
    radius = math.sqrt(properties.polar_moment / properties.area)
    if math.hypot(x, y) < _AT_CENTROID * radius:
        return "centroid"
    return _pair(x if abs(x) > _AT_CENTROID * radius else 0.0, y if abs(y) > _AT_CENTROID * radius else 0.0)
