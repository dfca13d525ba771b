"""Cross-sections in the coordinates x along e1 and y along e2, origin at the centroid."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.checks import require, require_positive
from cases.polygon import centroid, crosses_itself, depth, edges_meet, narrowest, signed_area

_Array = NDArray[np.float64]

# Every edge is held against every other: 1000 corners take 0.2 s and 100 MB.
MOST_CORNERS = 1000


@dataclass(frozen=True)
class Rectangle:
    """Rectangular cross-section, sides along the local axes.

    Parameters
    ----------
    width : b, extent along e1 (coordinate x), mm
    height : a, extent along e2 (coordinate y), mm
    """

    width: float
    height: float

    def __post_init__(self) -> None:
        require_positive(self.width, "width", "a width")
        require_positive(self.height, "height", "a height")


@dataclass(frozen=True)
class Circle:
    """Full circular cross-section.

    Parameters
    ----------
    diameter : mm
    """

    diameter: float

    def __post_init__(self) -> None:
        require_positive(self.diameter, "diameter", "a diameter")


@dataclass(frozen=True)
class Ring:
    """Circular tube.

    Parameters
    ----------
    outer_diameter, inner_diameter : mm
    """

    outer_diameter: float
    inner_diameter: float

    def __post_init__(self) -> None:
        require_positive(self.inner_diameter, "inner_diameter", "a diameter")
        ok = math.isfinite(self.outer_diameter) and self.outer_diameter > self.inner_diameter
        remedy = f"the outer diameter must be larger than the inner one, {self.inner_diameter:g} mm"
        require(ok, "outer_diameter", f"{self.outer_diameter:g}", remedy)


@dataclass(frozen=True)
class Box:
    """Rectangular tube of constant wall thickness.

    Parameters
    ----------
    width, height : outer extents along e1 (x) and e2 (y), mm
    wall : wall thickness, mm
    """

    width: float
    height: float
    wall: float

    def __post_init__(self) -> None:
        require_positive(self.width, "width", "a width")
        require_positive(self.height, "height", "a height")
        require_positive(self.wall, "wall", "a wall thickness")
        ok = 2.0 * self.wall < min(self.width, self.height)
        require(ok, "wall", f"{self.wall:g}", "the wall must be thinner than half the smaller side")


@dataclass(frozen=True)
class Polygon:
    """Cross-section bounded by straight edges, with holes; its centroid is laid on the centre line.

    Parameters
    ----------
    outer : corners (x, y) in order around the section, mm, without repeating the first
    holes : corners of each hole, likewise
    """

    outer: tuple[tuple[float, float], ...]
    holes: tuple[tuple[tuple[float, float], ...], ...] = ()

    def __post_init__(self) -> None:
        loops = (("outer", self.outer), *((f"holes #{n}", hole) for n, hole in enumerate(self.holes, 1)))
        for key, corners in loops:
            require(len(corners) >= 3, key, f"{len(corners)} corners", "at least three are needed")
            require(len(corners) <= MOST_CORNERS, key, f"{len(corners)} corners", f"{MOST_CORNERS} at most are taken")
            finite = all(len(corner) == 2 and bool(np.all(np.isfinite(corner))) for corner in corners)
            require(finite, key, [list(corner) for corner in corners], "corners are pairs of finite numbers")
            again = next((list(a) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True) if a == b), None)
            require(again is None, key, f"{again} twice in a row", "name each corner once, the first one too")
            remedy = "name the corners in order around the section"
            require(not crosses_itself(corners), key, "edges that cross or touch each other", remedy)
            require(signed_area(corners) != 0.0, key, "corners along one line", remedy)
        for index, (key, hole) in enumerate(loops[1:]):
            inside = depth(self.outer, hole[0]) > 0.0 and not edges_meet(self.outer, hole).any()
            require(inside, key, "corners on or beyond the outer edges", "a hole lies within the section")
            for other in self.holes[:index]:
                apart = not edges_meet(other, hole).any()
                apart = apart and depth(other, hole[0]) < 0.0 and depth(hole, other[0]) < 0.0
                require(apart, key, "corners within another hole", "holes lie apart from each other")

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre of area in the coordinates of the corners, mm; it is the origin of the section's x and y."""
        x, y = centroid(self.outer, self.holes)
        return float(x), float(y)


Section = Rectangle | Circle | Ring | Box | Polygon


def section_reach(section: Section, direction: _Array) -> float:
    """How far a section reaches from its centroid along a unit direction (x, y), mm."""
    match section:
        case Circle():
            return section.diameter / 2.0
        case Ring():
            return section.outer_diameter / 2.0
        case Polygon():
            return float(np.max((np.array(section.outer) - section.centroid) @ direction))
        case Rectangle() | Box():
            return float(np.abs(direction) @ (section.width, section.height)) / 2.0


def thinnest(section: Section) -> tuple[str, float, float]:
    """Key and thickness of the thinnest part of a section, and the section's size, mm."""
    match section:
        case Rectangle():
            key = "width" if section.width < section.height else "height"
            return key, min(section.width, section.height), max(section.width, section.height)
        case Circle():
            return "diameter", section.diameter, section.diameter
        case Ring():
            wall = 0.5 * (section.outer_diameter - section.inner_diameter)
            return "inner_diameter", wall, section.outer_diameter
        case Box():
            return "wall", section.wall, max(section.width, section.height)
        case Polygon():
            loops = (section.outer, *section.holes)
            keys = ["outer", *(f"holes #{number}" for number in range(1, len(loops)))]
            parts = [(narrowest(loop), key) for loop, key in zip(loops, keys, strict=True)]
            parts += [
                (narrowest(loop, other), keys[index]) for index, loop in enumerate(loops) for other in loops[:index]
            ]
            thickness, key = min(parts)
            return key, thickness, float(np.ptp(np.array(section.outer), axis=0).max())
