"""A scene: elastic rods, their supports, loads and contact pairs, as plain frozen data.

Units are N, mm, MPa; angles in radians; frames right-handed. Nothing here computes for a solver: the rod
model and the 3D reference each derive their own geometry from this data, so that a mistake in one cannot hide
in both. The little geometry here only checks that a scene can be what its author meant.

Local frame of a rod (e1, e2, t): t is the tangent of the centre line, e2 the part of `up` normal to t,
e1 = e2 x t. Section coordinates: x along e1, y along e2, origin at the centroid; s is the arc length from
the rod's start. Displacements in this frame are (u, v, w).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from cases.centre_lines import CentreLine, Helix, Line, Path, Spline
from cases.checks import SceneError, Vector, require, require_positive
from cases.contacts import (
    ContactPair,
    Gap,
    GapTable,
    Ground,
    RoundGap,
    check_gap,
    face_geometry,
    given_gap,
    require_facing,
    require_shallow,
)
from cases.loads import Gravity, LineLoad, Load, Pressure, SectionForce, SectionMoment, check_load
from cases.materials import Material, Orthotropic
from cases.rods import (
    ENDS,
    FACES,
    ROUNDED,
    End,
    Face,
    Rod,
    RodEnd,
    RodFace,
    not_beyond_end,
    require_flat_face,
    same_station,
)
from cases.sections import Box, Circle, Polygon, Rectangle, Ring, Section, section_reach
from cases.supports import COMPONENTS, Bed, Clamp, Component, Joint, Support, check_bed, check_support, station_of

__all__ = [
    "COMPONENTS",
    "ENDS",
    "FACES",
    "Bed",
    "Box",
    "CentreLine",
    "Circle",
    "Clamp",
    "Component",
    "ContactPair",
    "End",
    "Face",
    "Gap",
    "GapTable",
    "Gravity",
    "Ground",
    "Helix",
    "Joint",
    "Line",
    "LineLoad",
    "Load",
    "Material",
    "Orthotropic",
    "Path",
    "Polygon",
    "Pressure",
    "Rectangle",
    "Ring",
    "Rod",
    "RodEnd",
    "RodFace",
    "RoundGap",
    "Scene",
    "SceneError",
    "Section",
    "SectionForce",
    "SectionMoment",
    "Spline",
    "Support",
    "Vector",
    "given_gap",
    "section_reach",
    "station_of",
]


@dataclass(frozen=True)
class Scene:
    """Rods with everything that acts on them.

    A load, support or bed at the end of a rod, written with the rounded length, is set to that end.

    Raises
    ------
    SceneError
        if a name is unknown or used twice, or a position lies outside its rod.
    """

    name: str
    rods: tuple[Rod, ...]
    supports: tuple[Clamp | Support, ...]
    loads: tuple[Load, ...]
    contacts: tuple[ContactPair, ...]
    joints: tuple[Joint, ...] = ()
    beds: tuple[Bed, ...] = ()

    def __post_init__(self) -> None:
        require(len(self.rods) > 0, "rods", "none", "a scene needs at least one rod")
        for what, names in (
            ("rods", [rod.name for rod in self.rods]),
            ("contacts", [pair.name for pair in self.contacts]),
        ):
            twice = next((name for name in names if names.count(name) > 1), None)
            require(twice is None, what, f"'{twice}' twice", "give each its own name")
        self._check_supports()
        loads = []
        for number, load in enumerate(self.loads, 1):
            key = f"loads #{number}"
            rod = self._rod_at(f"{key}.face.rod" if isinstance(load, Pressure) else f"{key}.rod", load.rod)
            loads.append(not_beyond_end(load, rod))
            check_load(loads[-1], rod, key)
        object.__setattr__(self, "loads", tuple(loads))
        for pair in self.contacts:
            self._check_contact(pair)
        joined: list[RodEnd] = []
        for number, joint in enumerate(self.joints, 1):
            self._check_joint(joint, f"joints #{number}.ends", joined)
            joined += joint.ends
        beds = []
        for number, bed in enumerate(self.beds, 1):
            key = f"beds #{number}"
            rod = self._rod_at(f"{key}.face.rod", bed.rod)
            beds.append(not_beyond_end(bed, rod))
            require_flat_face(rod, bed.face.face, f"{key}.face")
            check_bed(beds[-1], rod, key)
        object.__setattr__(self, "beds", tuple(beds))

    def _check_supports(self) -> None:
        held: list[tuple[str, float]] = []
        supports = []
        for number, support in enumerate(self.supports, 1):
            key = f"supports #{number}"
            rod = self._rod_at(f"{key}.rod", support.rod)
            supports.append(not_beyond_end(support, rod))
            check_support(supports[-1], rod, key)
            station = station_of(supports[-1], rod)
            again = any(name == rod.name and same_station(other, station, rod) for name, other in held)
            where = support.end if isinstance(support, Clamp) else f"at {station:g} mm"
            require(not again, key, f"{rod.name} {where} again", "support a section once")
            held.append((rod.name, station))
        object.__setattr__(self, "supports", tuple(supports))

    def _check_joint(self, joint: Joint, key: str, joined: list[RodEnd]) -> None:
        require(len(joint.ends) >= 2, key, f"{len(joint.ends)} ends", "a joint needs at least two")
        places = []
        for number, end in enumerate(joint.ends, 1):
            rod = self._rod_at(f"{key} #{number}.rod", end.rod)
            require(end.end in ENDS, f"{key} #{number}.end", f"'{end.end}'", "write 'start' or 'end'")
            again = end in joined or end in joint.ends[: number - 1]
            require(not again, f"{key} #{number}", f"{end.rod} {end.end} again", "join an end once")
            at = 0.0 if end.end == "start" else rod.length
            held = any(
                support.rod == end.rod and same_station(station_of(support, rod), at, rod) for support in self.supports
            )
            remedy = "support it elsewhere, or join fewer"
            require(not held, f"{key} #{number}", f"{end.rod} {end.end}, which has a support", remedy)
            places.append(np.array(rod.centre_line.end_points[ENDS.index(end.end)]))
            apart = float(np.linalg.norm(places[-1] - places[0]))
            ok = apart <= ROUNDED * rod.length
            found = f"{end.rod} {end.end}, {apart:g} mm from {joint.ends[0].rod} {joint.ends[0].end}"
            require(ok, f"{key} #{number}", found, "centre lines that are joined end at one point")

    def _rod_at(self, key: str, name: str) -> Rod:
        rod = next((rod for rod in self.rods if rod.name == name), None)
        known = ", ".join(f"'{rod.name}'" for rod in self.rods)
        if rod is None:
            raise SceneError(key, f"'{name}'", f"the scene's rods are {known}")
        return rod

    def _check_contact(self, pair: ContactPair) -> None:
        key = f"contacts.{pair.name}"
        for side, face in zip(("first", "second"), pair.faces, strict=False):
            self._rod_at(f"{key}.{side}.rod", face.rod)
            require_flat_face(self.rod(face.rod), face.face, f"{key}.{side}")
        rod = self.rod(pair.first.rod)
        start, end = pair.zone
        ok = 0.0 <= start < end <= rod.length * (1.0 + 1e-9)
        remedy = f"the zone must rise and lie on rod '{rod.name}', which runs from 0 to {rod.length:g} mm"
        require(ok, f"{key}.zone", f"{start:g} .. {end:g}", remedy)
        check_gap(pair, pair.zone, f"{key}.gap")
        require_shallow(pair, [self.rod(face.rod) for face in pair.faces], f"{key}.gap")
        if pair.penalty is not None:
            require_positive(pair.penalty, f"{key}.penalty", "a penalty")
        if isinstance(pair.second, Ground):
            if pair.second.modulus is not None:
                require_positive(pair.second.modulus, f"{key}.second.modulus", "a bed modulus")
            return
        different = pair.first.rod != pair.second.rod
        require(different, f"{key}.second.rod", f"'{pair.second.rod}'", "a pair needs two different rods")
        flat = [face_geometry(self.rod(face.rod), face.face) for face in pair.faces]
        if flat[0] is not None and flat[1] is not None:
            require_facing(pair, flat[0], flat[1], key)

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
