"""A scene: elastic rods, their supports, loads and contact pairs, as plain frozen data.

Units are N, mm, MPa; angles in radians; frames right-handed. Nothing here computes for a solver: the rod
model and the 3D reference each derive their own geometry from this data, so that a mistake in one cannot hide
in both. The little geometry here only checks that a scene can be what its author meant.

Local frame of a rod (e1, e2, t): t is the tangent of the centre line, e2 the part of `up` normal to t,
e1 = e2 x t. Section coordinates: x along e1, y along e2, origin at the centroid; s is the arc length from
the rod's start. Displacements in this frame are (u, v, w).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cases.polygon import centroid, crosses_itself, depth, edges_meet, signed_area

_Array = NDArray[np.float64]
Vector = tuple[float, float, float]
End = Literal["start", "end"]
Face = Literal["top", "bottom", "left", "right"]

FACES: tuple[Face, ...] = ("top", "bottom", "left", "right")
ENDS: tuple[End, ...] = ("start", "end")

# The length of a curved rod is written down with finitely many digits.
_ROUNDED = 1e-4
# Least angle between the outward normals of two faces that may touch, degrees.
_LEAST_FACING_ANGLE = 135.0


class SceneError(ValueError):
    """A scene that cannot be what its author meant, said in one sentence.

    Attributes
    ----------
    key : where in the scene, as one would say it of the case file: "rods.lower.element_borders", or
        "loads #1.force" for the first of the loads
    found : what was found there
    remedy : what would be right
    """

    def __init__(self, key: str, found: str, remedy: str) -> None:
        super().__init__(f"{key}: found {found}; {remedy}")
        self.key = key
        self.found = found
        self.remedy = remedy


def _require(condition: bool, key: str, found: object, remedy: str) -> None:
    if not condition:
        raise SceneError(key, str(found), remedy)


def _require_positive(value: float, key: str, what: str) -> None:
    _require(math.isfinite(value) and value > 0.0, key, f"{value:g}", f"{what} must be positive")


def _require_finite(vector: Vector, key: str) -> None:
    ok = len(vector) == 3 and bool(np.all(np.isfinite(vector)))
    _require(ok, key, list(vector), "three finite numbers are needed")


@dataclass(frozen=True)
class Material:
    """Isotropic linear elasticity (Hooke's law in three dimensions).

    Parameters
    ----------
    young_modulus : E, MPa
    poisson_ratio : nu, between -1 and 0.5 (both excluded)
    """

    young_modulus: float
    poisson_ratio: float

    def __post_init__(self) -> None:
        _require_positive(self.young_modulus, "young_modulus", "Young's modulus")
        ok = -1.0 < self.poisson_ratio < 0.5
        _require(ok, "poisson_ratio", f"{self.poisson_ratio:g}", "Poisson's ratio lies between -1 and 0.5")


@dataclass(frozen=True)
class Orthotropic:
    """Linear elasticity with three planes of symmetry, those of the rod's frame (e1, e2, t).

    Parameters
    ----------
    young_moduli : E_1, E_2, E_3 along e1, e2 and t, MPa
    shear_moduli : G_23, G_13, G_12 between e2 and t, e1 and t, e1 and e2, MPa
    poisson_ratios : nu_12, nu_13, nu_23; nu_ij is the contraction along j for one of extension along i
    """

    young_moduli: Vector
    shear_moduli: Vector
    poisson_ratios: Vector

    def __post_init__(self) -> None:
        for key, moduli in (("young_moduli", self.young_moduli), ("shear_moduli", self.shear_moduli)):
            _require_finite(moduli, key)
            _require(min(moduli) > 0.0, key, list(moduli), "moduli must be positive")
        _require_finite(self.poisson_ratios, "poisson_ratios")
        (e1, e2, e3), (nu12, nu13, nu23) = self.young_moduli, self.poisson_ratios
        compliance = np.array(
            [
                [1.0 / e1, -nu12 / e1, -nu13 / e1],
                [-nu12 / e1, 1.0 / e2, -nu23 / e2],
                [-nu13 / e1, -nu23 / e2, 1.0 / e3],
            ]
        )
        scale = np.sqrt(np.diag(compliance))
        stable = float(np.linalg.eigvalsh(compliance / np.outer(scale, scale))[0]) > 1e-9
        remedy = "they must leave every strain an energy: nu_ij^2 < E_i / E_j, and not all of them at once near that"
        _require(stable, "poisson_ratios", list(self.poisson_ratios), remedy)


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
        _require_positive(self.width, "width", "a width")
        _require_positive(self.height, "height", "a height")


@dataclass(frozen=True)
class Circle:
    """Full circular cross-section.

    Parameters
    ----------
    diameter : mm
    """

    diameter: float

    def __post_init__(self) -> None:
        _require_positive(self.diameter, "diameter", "a diameter")


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
        _require_positive(self.inner_diameter, "inner_diameter", "a diameter")
        ok = math.isfinite(self.outer_diameter) and self.outer_diameter > self.inner_diameter
        remedy = f"the outer diameter must be larger than the inner one, {self.inner_diameter:g} mm"
        _require(ok, "outer_diameter", f"{self.outer_diameter:g}", remedy)


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
        _require_positive(self.width, "width", "a width")
        _require_positive(self.height, "height", "a height")
        _require_positive(self.wall, "wall", "a wall thickness")
        ok = 2.0 * self.wall < min(self.width, self.height)
        _require(ok, "wall", f"{self.wall:g}", "the wall must be thinner than half the smaller side")


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
            _require(len(corners) >= 3, key, f"{len(corners)} corners", "at least three are needed")
            finite = all(len(corner) == 2 and bool(np.all(np.isfinite(corner))) for corner in corners)
            _require(finite, key, [list(corner) for corner in corners], "corners are pairs of finite numbers")
            again = next((list(a) for a, b in zip(corners, (*corners[1:], corners[0]), strict=True) if a == b), None)
            _require(again is None, key, f"{again} twice in a row", "name each corner once, the first one too")
            remedy = "name the corners in order around the section"
            _require(not crosses_itself(corners), key, "edges that cross or touch each other", remedy)
            _require(signed_area(corners) != 0.0, key, "corners along one line", remedy)
        for index, (key, hole) in enumerate(loops[1:]):
            inside = depth(self.outer, hole[0]) > 0.0 and not edges_meet(self.outer, hole).any()
            _require(inside, key, "corners on or beyond the outer edges", "a hole lies within the section")
            for other in self.holes[:index]:
                apart = not edges_meet(other, hole).any()
                apart = apart and depth(other, hole[0]) < 0.0 and depth(hole, other[0]) < 0.0
                _require(apart, key, "corners within another hole", "holes lie apart from each other")

    @property
    def centroid(self) -> tuple[float, float]:
        """Centre of area in the coordinates of the corners, mm; it is the origin of the section's x and y."""
        x, y = centroid(self.outer, self.holes)
        return float(x), float(y)


Section = Rectangle | Circle | Ring | Box | Polygon


@dataclass(frozen=True)
class Line:
    """Straight centre line, pre-twisted if asked for.

    Parameters
    ----------
    start, end : end points in global coordinates (X, Y, Z), mm
    up : direction whose part normal to the line is e2 at the start (any length)
    twist : angle by which the frame turns about t from start to end, at an even rate, rad
    """

    start: Vector
    end: Vector
    up: Vector
    twist: float = 0.0

    def __post_init__(self) -> None:
        for key, vector in (("start", self.start), ("end", self.end), ("up", self.up)):
            _require_finite(vector, key)
        _require(math.isfinite(self.twist), "twist", f"{self.twist:g}", "a finite angle is needed")
        _require(self.length > 0.0, "end", list(self.end), "the end must differ from the start")
        normal_part = np.cross(np.subtract(self.end, self.start), self.up)
        ok = float(np.linalg.norm(normal_part)) > 1e-9 * self.length * float(np.linalg.norm(self.up))
        _require(ok, "up", list(self.up), "give a direction that is not along the line")

    @property
    def length(self) -> float:
        """Length of the line, mm."""
        return float(np.linalg.norm(np.subtract(self.end, self.start)))


@dataclass(frozen=True)
class Helix:
    """Helical centre line, a circular arc where the pitch is zero.

    The frame moves along with the screw motion that makes the line, so that curvature and twist of the frame are
    constant; of an arc it is the rotation-minimising frame.

    Parameters
    ----------
    start : start point (X, Y, Z), mm
    centre : a point of the axis, mm
    axis : direction of the axis (any length); the line turns about it by the right-hand rule
    angle : angle turned from start to end, positive, rad
    up : direction whose part normal to the line at its start is e2 there (any length)
    pitch : advance along the axis in one full turn, mm, negative for a left-hand helix
    """

    start: Vector
    centre: Vector
    axis: Vector
    angle: float
    up: Vector
    pitch: float = 0.0

    def __post_init__(self) -> None:
        for key, vector in (("start", self.start), ("centre", self.centre), ("axis", self.axis), ("up", self.up)):
            _require_finite(vector, key)
        _require_positive(self.angle, "angle", "an angle")
        _require(math.isfinite(self.pitch), "pitch", f"{self.pitch:g}", "a finite length is needed")
        _require(float(np.linalg.norm(self.axis)) > 0.0, "axis", list(self.axis), "give a direction")
        from_axis = np.linalg.norm(np.subtract(self.start, self.centre))
        ok = self.radius > 1e-9 * float(from_axis)
        _require(ok, "start", list(self.start), "the start must not lie on the axis")
        normal_part = np.linalg.norm(np.cross(self.start_tangent, self.up))
        ok = float(normal_part) > 1e-9 * float(np.linalg.norm(self.up))
        _require(ok, "up", list(self.up), "give a direction that is not along the line at its start")

    @property
    def radius(self) -> float:
        """Distance of the line from the axis, mm."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        return float(np.linalg.norm(np.cross(axis, np.subtract(self.start, self.centre))))

    @property
    def start_tangent(self) -> tuple[float, float, float]:
        """Direction of the line at its start, a unit vector."""
        axis = np.asarray(self.axis) / np.linalg.norm(self.axis)
        around = np.cross(axis, np.subtract(self.start, self.centre)) + self.pitch / (2.0 * math.pi) * axis
        x, y, z = (around / np.linalg.norm(around)).tolist()
        return x, y, z

    @property
    def length(self) -> float:
        """Arc length, mm."""
        return self.angle * math.hypot(self.radius, self.pitch / (2.0 * math.pi))


CentreLine = Line | Helix


@dataclass(frozen=True)
class Rod:
    """An elastic rod.

    Parameters
    ----------
    name : how supports, loads and contacts call it
    element_borders : borders of the rod model's elements, arc length from the rod's start, mm; the first is
        0, the last the rod's length, which it is set to where it was rounded
    """

    name: str
    centre_line: CentreLine
    section: Section
    material: Material | Orthotropic
    element_borders: tuple[float, ...]

    def __post_init__(self) -> None:
        key = f"rods.{self.name}.element_borders"
        borders = self.element_borders
        _require(len(borders) >= 2, key, list(borders), "at least the two ends of the rod are needed")
        rising = all(a < b for a, b in pairwise(borders))
        _require(rising, key, list(borders), "borders must increase along the rod")
        length = self.centre_line.length
        ok = borders[0] == 0.0 and math.isclose(borders[-1], length, rel_tol=_ROUNDED)
        _require(ok, key, f"{borders[0]:g} .. {borders[-1]:g}", f"borders must run from 0 to {length:g} mm")
        rising = borders[-2] < length
        _require(rising, key, f"{borders[-2]:g} .. {borders[-1]:g}", f"the last border is the rod's end, {length:g} mm")
        object.__setattr__(self, "element_borders", (*borders[:-1], length))
        if isinstance(self.centre_line, Helix):
            _require_roomy(self.centre_line, self.section, f"rods.{self.name}.centre_line")

    @property
    def length(self) -> float:
        """Arc length of the centre line, mm."""
        return self.centre_line.length


def _require_roomy(helix: Helix, section: Section, key: str) -> None:
    """See that the sections do not overlap on the inner side of the curve, where sqrt(g) must be positive."""
    axis = np.asarray(helix.axis) / np.linalg.norm(helix.axis)
    from_centre = np.subtract(helix.start, helix.centre)
    inwards = -(from_centre - (from_centre @ axis) * axis) / helix.radius
    tangent = np.asarray(helix.start_tangent)
    e2 = np.asarray(helix.up) - (tangent @ np.asarray(helix.up)) * tangent
    e2 /= np.linalg.norm(e2)
    direction = np.array([inwards @ np.cross(e2, tangent), inwards @ e2])
    reach = section_reach(section, direction)
    advance = helix.pitch / (2.0 * math.pi)
    radius = helix.radius * (1.0 + (advance / helix.radius) ** 2)
    found = f"a radius of curvature of {radius:g} mm"
    _require(reach < radius, key, found, f"it must be larger than the section's {reach:g} mm on the inner side")


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


@dataclass(frozen=True)
class Clamp:
    """All displacements of a rod's end section are zero."""

    rod: str
    end: End


@dataclass(frozen=True)
class SectionForce:
    """A force spread evenly over one cross-section.

    Parameters
    ----------
    position : arc length from the rod's start, mm
    force : global components (X, Y, Z), N
    """

    rod: str
    position: float
    force: Vector


@dataclass(frozen=True)
class SectionMoment:
    """A moment on one cross-section, as the linear distribution of traction that makes it.

    Parameters
    ----------
    position : arc length from the rod's start, mm
    moment : global components (X, Y, Z), N mm
    """

    rod: str
    position: float
    moment: Vector


@dataclass(frozen=True)
class LineLoad:
    """A force per length of the centre line, spread evenly over the cross-sections.

    Parameters
    ----------
    start, end : stretch of the rod that it acts on, arc length from the rod's start, mm
    force : global components (X, Y, Z), N/mm
    """

    rod: str
    start: float
    end: float
    force: Vector


Load = SectionForce | SectionMoment | LineLoad


@dataclass(frozen=True)
class RodFace:
    """A lateral face of a rod: top (y = +height/2), bottom, right (x = +width/2) or left."""

    rod: str
    face: Face


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
class Scene:
    """Rods with everything that acts on them.

    A load at the end of a curved rod, written with the rounded length, is set to that end.

    Raises
    ------
    SceneError
        if a name is unknown or used twice, or a position lies outside its rod.
    """

    name: str
    rods: tuple[Rod, ...]
    supports: tuple[Clamp, ...]
    loads: tuple[Load, ...]
    contacts: tuple[ContactPair, ...]

    def __post_init__(self) -> None:
        _require(len(self.rods) > 0, "rods", "none", "a scene needs at least one rod")
        for what, names in (
            ("rods", [rod.name for rod in self.rods]),
            ("contacts", [pair.name for pair in self.contacts]),
        ):
            twice = next((name for name in names if names.count(name) > 1), None)
            _require(twice is None, what, f"'{twice}' twice", "give each its own name")
        for number, support in enumerate(self.supports, 1):
            key = f"supports #{number}"
            self._rod_at(f"{key}.rod", support.rod)
            _require(support.end in ENDS, f"{key}.end", support.end, "write 'start' or 'end'")
            again = support in self.supports[: number - 1]
            _require(not again, key, f"{support.rod} {support.end} again", "support an end once")
        loads = []
        for number, load in enumerate(self.loads, 1):
            key = f"loads #{number}"
            rod = self._rod_at(f"{key}.rod", load.rod)
            loads.append(_not_beyond_end(load, rod))
            _check_load(loads[-1], rod, key)
        object.__setattr__(self, "loads", tuple(loads))
        for pair in self.contacts:
            self._check_contact(pair)

    def _rod_at(self, key: str, name: str) -> Rod:
        rod = next((rod for rod in self.rods if rod.name == name), None)
        known = ", ".join(f"'{rod.name}'" for rod in self.rods)
        if rod is None:
            raise SceneError(key, f"'{name}'", f"the scene's rods are {known}")
        return rod

    def _check_contact(self, pair: ContactPair) -> None:
        key = f"contacts.{pair.name}"
        for side, face in (("first", pair.first), ("second", pair.second)):
            self._rod_at(f"{key}.{side}.rod", face.rod)
            remedy = f"write one of {', '.join(FACES)}"
            _require(face.face in FACES, f"{key}.{side}.face", f"'{face.face}'", remedy)
        first = _face_geometry(self.rod(pair.first.rod), pair.first.face, f"{key}.first.rod")
        second = _face_geometry(self.rod(pair.second.rod), pair.second.face, f"{key}.second.rod")
        different = pair.first.rod != pair.second.rod
        _require(different, f"{key}.second.rod", f"'{pair.second.rod}'", "a pair needs two different rods")
        rod = self.rod(pair.first.rod)
        start, end = pair.zone
        ok = 0.0 <= start < end <= rod.length * (1.0 + 1e-9)
        remedy = f"the zone must rise and lie on rod '{rod.name}', which runs from 0 to {rod.length:g} mm"
        _require(ok, f"{key}.zone", f"{start:g} .. {end:g}", remedy)
        _require(math.isfinite(pair.gap), f"{key}.gap", f"{pair.gap:g}", "a finite length is needed")
        _require_positive(pair.penalty, f"{key}.penalty", "a penalty")
        _require_facing(pair, first, second, key)

    def rod(self, name: str) -> Rod:
        """The rod called `name`; KeyError if there is none."""
        for rod in self.rods:
            if rod.name == name:
                return rod
        raise KeyError(name)

    def contact(self, name: str) -> ContactPair:
        """The contact pair called `name`; KeyError if there is none."""
        for pair in self.contacts:
            if pair.name == name:
                return pair
        raise KeyError(name)


def _not_beyond_end(load: Load, rod: Rod) -> Load:
    """The load, set to the end of a curved rod where it was written there with a rounded length."""
    if isinstance(rod.centre_line, Line):
        return load
    place = load.end if isinstance(load, LineLoad) else load.position
    if not math.isclose(place, rod.length, rel_tol=_ROUNDED):
        return load
    return replace(load, end=rod.length) if isinstance(load, LineLoad) else replace(load, position=rod.length)


def _check_load(load: Load, rod: Rod, key: str) -> None:
    name, vector = ("moment", load.moment) if isinstance(load, SectionMoment) else ("force", load.force)
    _require_finite(vector, f"{key}.{name}")
    remedy = f"rod '{rod.name}' runs from 0 to {rod.length:g} mm"
    last = rod.length * (1.0 + 1e-9)
    if isinstance(load, LineLoad):
        ok = 0.0 <= load.start < load.end <= last
        _require(ok, f"{key}.start", f"{load.start:g} .. {load.end:g}", f"a rising stretch is needed; {remedy}")
    else:
        _require(0.0 <= load.position <= last, f"{key}.position", f"{load.position:g}", remedy)


@dataclass(frozen=True)
class _FaceGeometry:
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


def _face_geometry(rod: Rod, face: Face, key: str) -> _FaceGeometry:
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
        return _FaceGeometry(start, end, e2 if face == "top" else -e2, e1, section.width / 2.0)
    return _FaceGeometry(start, end, e1 if face == "right" else -e1, e2, section.height / 2.0)


def _require_facing(pair: ContactPair, face: _FaceGeometry, other: _FaceGeometry, key: str) -> None:
    """See that the faces of a pair look at each other, over the whole zone."""
    names = (pair.first.rod, pair.second.rod)
    cosine = float(np.clip(np.dot(face.normal, other.normal), -1.0, 1.0))
    angle = math.degrees(math.acos(cosine))
    _require(
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
    _require(
        begin - slack <= start and end <= stop + slack,
        f"{key}.zone",
        f"{start:g} .. {end:g}",
        f"rod '{names[1]}' lies opposite rod '{names[0]}' {where}, and the zone must be within that",
    )
    # From the first rod's centre line to the second's, where the zone starts and ends.
    share = (np.array(pair.zone) - along[0]) / (along[1] - along[0])
    offset = ends[0] + np.outer(share, ends[1] - ends[0]) - np.outer(pair.zone, tangent)
    _require(
        bool(np.all(offset @ face.normal > 0.0)),
        f"{key}.first.face",
        f"'{pair.first.face}', while rod '{names[1]}' is drawn on the other side of rod '{names[0]}'",
        "choose the face that looks towards the second rod",
    )
    aside = float(np.max(np.abs(offset @ face.across)))
    reach = face.half_width + other.half_width
    _require(
        aside < reach,
        f"{key}.second.rod",
        f"'{names[1]}', drawn {aside:g} mm aside of rod '{names[0]}'",
        f"the faces overlap only where the centre lines are less than {reach:g} mm aside of each other",
    )
