"""Faces that may touch."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cases.centre_lines import Line
from cases.checks import require
from cases.rods import Face, Rod, RodFace
from cases.sections import Box, Rectangle, section_reach

_Array = NDArray[np.float64]

# Least angle between the outward normals of two faces that may touch, degrees.
_LEAST_FACING_ANGLE = 135.0
# Rods at a cosine below this cross each other: where their faces meet is for the solvers to find.
_LEAST_PARALLEL = 0.999


@dataclass(frozen=True)
class Ground:
    """What lies opposite a face and does not move: its shape is in the gap.

    Parameters
    ----------
    modulus : k of a Winkler bed that pushes and cannot pull, N/mm^3; None for a rigid body
    """

    modulus: float | None = None


@dataclass(frozen=True)
class GapTable:
    """Gap given at stations, straight between them and as at the last ones beyond.

    Parameters
    ----------
    stations : arc length along the first rod, ascending, mm
    gaps : there, mm
    """

    stations: tuple[float, ...]
    gaps: tuple[float, ...]


@dataclass(frozen=True)
class RoundGap:
    """Gap between a straight face and a round one, or a cylinder lying across.

    Parameters
    ----------
    radius : mm; negative where the round face is hollow
    station : where the gap is least (hollow: largest), arc length along the first rod, mm
    least : the gap there, mm
    """

    radius: float
    station: float
    least: float = 0.0


Gap = float | GapTable | RoundGap | Literal["drawn"]


@dataclass(frozen=True)
class ContactPair:
    """Two faces that may touch without friction; d = u_n(2) - u_n(1) + gap, p_n = -penalty d where d < 0.

    Parameters
    ----------
    first : a face of a rod; n_c is its outward normal
    second : a face of another rod, or ground
    zone : candidate zone, arc length along the first rod (start, end), mm
    gap : g, initial distance of the faces, mm. It counts as given and the drawn distance is not used, unless it is
        "drawn": then it is the distance from the first face along its normal to the second face as drawn.
    penalty : c_n, N/mm^3; None for one that suits the rods. It counts where a solver is told to leave the penetration
        of the springs; otherwise contact forces do not depend on it.
    """

    name: str
    first: RodFace
    second: RodFace | Ground
    zone: tuple[float, float]
    gap: Gap
    penalty: float | None = None

    @property
    def faces(self) -> tuple[RodFace, ...]:
        """The faces of rods that take part: two, or one on ground."""
        return (self.first, self.second) if isinstance(self.second, RodFace) else (self.first,)

    @property
    def on_bed(self) -> bool:
        """Whether what lies opposite is a bed, which yields."""
        return isinstance(self.second, Ground) and self.second.modulus is not None


def given_gap(gap: float | GapTable | RoundGap, station: _Array) -> _Array:
    """The gap at stations along the first rod, mm, shape (n,)."""
    match gap:
        case GapTable():
            return np.interp(station, gap.stations, gap.gaps)
        case RoundGap():
            away = (station - gap.station) / gap.radius
            # Beyond the radius there is nothing opposite: as far as a quarter turn away.
            sagitta = 1.0 - np.sqrt(np.maximum(1.0 - away**2, 0.0))
            return np.asarray(gap.least + gap.radius * sagitta)
        case _:
            return np.full(len(station), float(gap))


def check_gap(pair: ContactPair, zone: tuple[float, float], key: str) -> None:
    """Raise a SceneError for a gap that cannot be meant."""
    match pair.gap:
        case GapTable():
            stations, gaps = pair.gap.stations, pair.gap.gaps
            ok = len(stations) == len(gaps) >= 2
            require(ok, key, f"{len(stations)} stations and {len(gaps)} gaps", "give as many of both, two at least")
            ok = bool(np.all(np.isfinite([*stations, *gaps]))) and all(a < b for a, b in pairwise(stations))
            require(ok, f"{key}.stations", list(stations), "finite stations that rise are needed, and finite gaps")
        case RoundGap():
            ok = math.isfinite(pair.gap.radius) and pair.gap.radius != 0.0
            require(ok, f"{key}.radius", f"{pair.gap.radius:g}", "a radius must not be zero")
            ok = math.isfinite(pair.gap.station) and math.isfinite(pair.gap.least)
            require(ok, key, pair.gap, "finite lengths are needed")
            reach = max(abs(pair.gap.station - end) for end in zone)
            remedy = f"it must reach over the zone, which lies within {reach:g} mm of its middle"
            require(reach <= abs(pair.gap.radius), f"{key}.radius", f"{pair.gap.radius:g}", remedy)
        case "drawn":
            require(isinstance(pair.second, RodFace), key, "'drawn'", "ground is not drawn; say its gap")
        case _:
            number = isinstance(pair.gap, int | float) and math.isfinite(pair.gap)
            require(number, key, pair.gap, "a finite length is needed, a table, a round gap or 'drawn'")


def require_shallow(pair: ContactPair, rods: Sequence[Rod], key: str) -> None:
    """See that an interference is not deeper than the rods of the pair are thick."""
    if pair.gap == "drawn":
        return
    stations = {*pair.zone}
    match pair.gap:
        case GapTable():
            stations |= {min(max(station, pair.zone[0]), pair.zone[1]) for station in pair.gap.stations}
        case RoundGap():
            stations |= {min(max(pair.gap.station, pair.zone[0]), pair.zone[1])}
    deepest = -float(given_gap(pair.gap, np.array(sorted(stations))).min())
    directions = {"top": (0.0, 1.0), "bottom": (0.0, -1.0), "right": (1.0, 0.0), "left": (-1.0, 0.0)}
    for face, rod in zip(pair.faces, rods, strict=True):
        inward = -np.array(directions[face.face])
        thick = section_reach(rod.section, inward) + section_reach(rod.section, -inward)
        remedy = f"rod '{rod.name}' is {thick:g} mm thick there, and an interference must be less"
        require(deepest < thick, key, f"an interference of {deepest:g} mm", remedy)


@dataclass(frozen=True)
class FaceGeometry:
    """A flat lateral face of a straight rod.

    Attributes
    ----------
    start, end : of the rod's centre line, mm
    normal : outward
    across : direction across the face
    half_width : half its width along `across`, mm
    """

    start: _Array
    end: _Array
    normal: _Array
    across: _Array
    half_width: float


def face_geometry(rod: Rod, face: Face) -> FaceGeometry | None:
    """Where a face of a rod is; None if it is not a flat face of a straight rod."""
    line, section = rod.centre_line, rod.section
    if not isinstance(line, Line) or line.twist != 0.0 or not isinstance(section, Rectangle | Box):
        return None
    start, end = np.array(line.start, dtype=float), np.array(line.end, dtype=float)
    tangent = (end - start) / line.length
    e2 = np.asarray(line.up) - np.dot(line.up, tangent) * tangent
    e2 /= np.linalg.norm(e2)
    e1 = np.cross(e2, tangent)
    if face in ("top", "bottom"):
        return FaceGeometry(start, end, e2 if face == "top" else -e2, e1, section.width / 2.0)
    return FaceGeometry(start, end, e1 if face == "right" else -e1, e2, section.height / 2.0)


def require_facing(pair: ContactPair, face: FaceGeometry, other: FaceGeometry, key: str) -> None:
    """See that two flat faces look at each other; where their rods do not cross, over the whole zone."""
    first, second = pair.faces
    names = (first.rod, second.rod)
    cosine = float(np.clip(np.dot(face.normal, other.normal), -1.0, 1.0))
    angle = math.degrees(math.acos(cosine))
    require(
        angle >= _LEAST_FACING_ANGLE,
        f"{key}.second.face",
        f"'{second.face}', whose outward normal is turned by {angle:.0f} degrees from the first face's",
        f"choose faces that face each other (180 degrees, at least {_LEAST_FACING_ANGLE:.0f})",
    )
    length = float(np.linalg.norm(face.end - face.start))
    tangent = (face.end - face.start) / length
    other_tangent = (other.end - other.start) / np.linalg.norm(other.end - other.start)
    if abs(float(tangent @ other_tangent)) < _LEAST_PARALLEL:
        return
    ends = np.array([other.start, other.end]) - face.start
    along = ends @ tangent
    begin, stop = float(np.min(along)), float(np.max(along))
    shared = (max(0.0, begin), min(length, stop))
    where = f"from {shared[0]:g} to {shared[1]:g} mm" if shared[0] < shared[1] else "nowhere"
    start, end = pair.zone
    slack = 1e-9 * length
    require(
        begin - slack <= start and end <= stop + slack,
        f"{key}.zone",
        f"{start:g} .. {end:g}",
        f"rod '{names[1]}' lies opposite rod '{names[0]}' {where}, and the zone must be within that",
    )
    # From the first rod's centre line to the second's, where the zone starts and ends.
    share = (np.array(pair.zone) - along[0]) / (along[1] - along[0])
    offset = ends[0] + np.outer(share, ends[1] - ends[0]) - np.outer(pair.zone, tangent)
    require(
        bool(np.all(offset @ face.normal > 0.0)),
        f"{key}.first.face",
        f"'{pair.first.face}', while rod '{names[1]}' is drawn on the other side of rod '{names[0]}'",
        "choose the face that looks towards the second rod",
    )
    aside = float(np.max(np.abs(offset @ face.across)))
    reach = face.half_width + other.half_width
    require(
        aside < reach,
        f"{key}.second.rod",
        f"'{names[1]}', drawn {aside:g} mm aside of rod '{names[0]}'",
        f"the faces overlap only where the centre lines are less than {reach:g} mm aside of each other",
    )
