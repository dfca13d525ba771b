"""A rod: centre line, section, material and the rod model's elements; its ends and faces."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal, TypeVar

import numpy as np

from cases.centre_lines import CentreLine, Path, curvatures
from cases.checks import require
from cases.materials import Material, Orthotropic
from cases.sections import Box, Rectangle, Section, section_reach

End = Literal["start", "end"]
Face = Literal["top", "bottom", "left", "right"]

ENDS: tuple[End, ...] = ("start", "end")
FACES: tuple[Face, ...] = ("top", "bottom", "left", "right")

# Width and height of a section as parts of its rod's length: no rod has less, but a slip of the pen has.
THINNEST = 1e-6

# The length of a curved or inclined rod is written down with finitely many digits.
ROUNDED = 1e-4


@dataclass(frozen=True)
class Rod:
    """An elastic rod.

    Parameters
    ----------
    name : how supports, loads and contacts call it
    element_borders : borders of the rod model's elements, arc length from the rod's start, mm; the first is
        0, the last the rod's length, which it is set to where it was rounded; likewise those between the pieces of
        a path
    """

    name: str
    centre_line: CentreLine
    section: Section
    material: Material | Orthotropic
    element_borders: tuple[float, ...]

    def __post_init__(self) -> None:
        key = f"rods.{self.name}.element_borders"
        borders = self.element_borders
        require(len(borders) >= 2, key, list(borders), "at least the two ends of the rod are needed")
        rising = all(a < b for a, b in pairwise(borders))
        require(rising, key, list(borders), "borders must increase along the rod")
        length = self.centre_line.length
        ok = borders[0] == 0.0 and math.isclose(borders[-1], length, rel_tol=ROUNDED)
        require(ok, key, f"{borders[0]:g} .. {borders[-1]:g}", f"borders must run from 0 to {length:g} mm")
        rising = borders[-2] < length
        require(rising, key, f"{borders[-2]:g} .. {borders[-1]:g}", f"the last border is the rod's end, {length:g} mm")
        borders = (*borders[:-1], length)
        if isinstance(self.centre_line, Path):
            borders = _on_piece_borders(borders, self.centre_line)
        object.__setattr__(self, "element_borders", borders)
        _require_roomy(self.centre_line, self.section, f"rods.{self.name}.centre_line")
        for what, axis in (("wide", np.array([1.0, 0.0])), ("high", np.array([0.0, 1.0]))):
            extent = section_reach(self.section, axis) + section_reach(self.section, -axis)
            found = f"one {extent:.3g} mm {what} on a rod {length:.3g} mm long"
            remedy = "a section is at least a millionth of its rod's length"
            require(extent >= THINNEST * length, f"rods.{self.name}.section", found, remedy)

    @property
    def length(self) -> float:
        """Arc length of the centre line, mm."""
        return self.centre_line.length


def _on_piece_borders(borders: tuple[float, ...], path: Path) -> tuple[float, ...]:
    """Borders of elements, with those that were written for the ends of the path's pieces, but rounded, set to them."""
    places = np.array(borders)
    for end in path.borders:
        nearest = np.argmin(np.abs(places - end))
        if abs(places[nearest] - end) <= ROUNDED * path.length:
            places[nearest] = end
    return tuple(places.tolist())


def _require_roomy(line: CentreLine, section: Section, key: str) -> None:
    """See that the sections do not overlap on the inner side of the curve, where sqrt(g) must be positive."""
    # No direction d reaches farther than |d_x| times that along x and |d_y| times that along y.
    farthest = math.sqrt(2.0) * max(section_reach(section, axis) for axis in (*np.eye(2), *-np.eye(2)))
    for start, piece in zip(line.borders, line.pieces, strict=False) if isinstance(line, Path) else ((0.0, line),):
        stations, bends = curvatures(piece)
        sizes = np.linalg.norm(bends, axis=1)
        if np.max(sizes, initial=0.0) * farthest < 1.0:
            continue
        reaches = [
            section_reach(section, bend / size) if size else 0.0 for bend, size in zip(bends, sizes, strict=True)
        ]
        tightest = int(np.argmax(reaches * sizes))
        reach, curvature = reaches[tightest], float(sizes[tightest])
        where = f" at s = {start + stations[tightest]:.3g} mm" if len(stations) > 1 else ""
        found = f"a radius of curvature of {1.0 / curvature:g} mm{where}"
        remedy = f"it must be larger than the section's {reach:g} mm on the inner side"
        require(reach * curvature < 1.0, key, found, remedy)


@dataclass(frozen=True)
class RodFace:
    """A lateral face of a rod: top (y = +height/2), bottom, right (x = +width/2) or left."""

    rod: str
    face: Face


@dataclass(frozen=True)
class RodEnd:
    """One end of a rod."""

    rod: str
    end: End


Placed = TypeVar("Placed")


def not_beyond_end(placed: Placed, rod: Rod) -> Placed:
    """A load, support or bed, set to the end of the rod where it was written there with a rounded length.

    Likewise to the ends of a path's pieces: a place a little beside one would cut off a sliver of an element.
    """
    inner = rod.centre_line.borders[1:-1] if isinstance(rod.centre_line, Path) else ()
    for name, ends in (("position", (*inner, rod.length)), ("start", inner), ("end", (*inner, rod.length))):
        place = getattr(placed, name, None)
        meant = [end for end in ends if isinstance(place, float) and math.isclose(place, end, rel_tol=ROUNDED)]
        if meant:
            placed = replace(placed, **{name: meant[0]})  # type: ignore[type-var]
    return placed


def same_station(one: float, other: float, rod: Rod) -> bool:
    """Whether two arc lengths are meant as one place of a rod."""
    return math.isclose(one, other, rel_tol=0.0, abs_tol=1e-6 * rod.length)


def require_flat_face(rod: Rod, face: Face, key: str) -> None:
    """Raise a SceneError unless the rod has flat faces and this is one of them."""
    require(face in FACES, f"{key}.face", f"'{face}'", f"write one of {', '.join(FACES)}")
    found = f"'{rod.name}', whose section is a {type(rod.section).__name__.lower()}"
    require(isinstance(rod.section, Rectangle | Box), f"{key}.rod", found, "rectangles and boxes have flat faces")


def require_on_rod(position: float, rod: Rod, key: str) -> None:
    """Raise a SceneError unless the arc length lies on the rod."""
    ok = 0.0 <= position <= rod.length * (1.0 + 1e-9)
    require(ok, key, f"{position:g}", f"rod '{rod.name}' runs from 0 to {rod.length:g} mm")


def require_stretch(start: float, end: float, rod: Rod, key: str) -> None:
    """Raise a SceneError unless the arc lengths rise and lie on the rod."""
    ok = 0.0 <= start < end <= rod.length * (1.0 + 1e-9)
    remedy = f"a rising stretch is needed; rod '{rod.name}' runs from 0 to {rod.length:g} mm"
    require(ok, key, f"{start:g} .. {end:g}", remedy)
