"""Faces that may touch."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cases.centre_lines import Line
from cases.checks import SceneError, require
from cases.rods import Face, Rod, RodFace
from cases.sections import Box, Rectangle

_Array = NDArray[np.float64]

# Least angle between the outward normals of two faces that may touch, degrees.
_LEAST_FACING_ANGLE = 135.0


@dataclass(frozen=True)
class ContactPair:
    """Two faces that may touch without friction; d = u_n(2) - u_n(1) + gap, p_n = -penalty d where d < 0.

    Parameters
    ----------
    first, second : the faces; n_c is the outward normal of the first
    zone : candidate zone, arc length along the first rod (start, end), mm
    gap : g, initial distance of the faces, mm. It counts as given; the drawn distance is not used.
    penalty : c_n, N/mm^3
    """

    name: str
    first: RodFace
    second: RodFace
    zone: tuple[float, float]
    gap: float
    penalty: float


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


def face_geometry(rod: Rod, face: Face, key: str) -> FaceGeometry:
    """Where a face of a rod is; SceneError if it is not one that can be in contact."""
    line, section = rod.centre_line, rod.section
    remedy = "contact is between flat faces of straight, untwisted rods with rectangle or box sections"
    if not isinstance(line, Line) or line.twist != 0.0:
        raise SceneError(key, f"'{rod.name}', which is curved or twisted", remedy)
    if not isinstance(section, Rectangle | Box):
        raise SceneError(key, f"'{rod.name}', whose section is a {type(section).__name__.lower()}", remedy)
    start, end = np.array(line.start, dtype=float), np.array(line.end, dtype=float)
    tangent = (end - start) / line.length
    e2 = np.asarray(line.up) - np.dot(line.up, tangent) * tangent
    e2 /= np.linalg.norm(e2)
    e1 = np.cross(e2, tangent)
    if face in ("top", "bottom"):
        return FaceGeometry(start, end, e2 if face == "top" else -e2, e1, section.width / 2.0)
    return FaceGeometry(start, end, e1 if face == "right" else -e1, e2, section.height / 2.0)


def require_facing(pair: ContactPair, face: FaceGeometry, other: FaceGeometry, key: str) -> None:
    """See that the faces of a pair look at each other, over the whole zone."""
    names = (pair.first.rod, pair.second.rod)
    cosine = float(np.clip(np.dot(face.normal, other.normal), -1.0, 1.0))
    angle = math.degrees(math.acos(cosine))
    require(
        angle >= _LEAST_FACING_ANGLE,
        f"{key}.second.face",
        f"'{pair.second.face}', whose outward normal is turned by {angle:.0f} degrees from the first face's",
        f"choose faces that face each other (180 degrees, at least {_LEAST_FACING_ANGLE:.0f})",
    )
    length = float(np.linalg.norm(face.end - face.start))
    tangent = (face.end - face.start) / length
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
