"""What holds rods and joins them: clamps, supports of chosen components, rigid joints and Winkler beds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from cases.checks import Vector, require, require_finite, require_positive
from cases.rods import ENDS, End, Rod, RodEnd, RodFace, require_on_rod, require_stretch

Component = Literal["x", "y", "s", "turn x", "turn y", "turn s"]

COMPONENTS: tuple[Component, ...] = ("x", "y", "s", "turn x", "turn y", "turn s")

# Rotations are linear ones, so only small ones make sense; beyond it, rad, they were likely meant in degrees.
LARGEST_ROTATION = 1.0
_SMALL = "rotations are small ones in rad, 1 at most; 1 deg is 0.01745"


@dataclass(frozen=True)
class Clamp:
    """A rod's end section is held as a rigid one: where it was, or where a given displacement takes it.

    Parameters
    ----------
    displacement : of the section's centre, global components, mm
    rotation : of the section about its centre, global components, rad, of magnitude 1 at most
    """

    rod: str
    end: End
    displacement: Vector = (0.0, 0.0, 0.0)
    rotation: Vector = (0.0, 0.0, 0.0)


@dataclass(frozen=True)
class Support:
    """Chosen components of the motion of one cross-section are held, in the rod's frame there.

    Parameters
    ----------
    position : arc length from the rod's start, mm
    components : "x", "y", "s": displacement along e1, e2, t; "turn x", "turn y", "turn s": rotation about them
    of : "section" holds the displacement at every point of the section, "mean" only its mean, so that the section may
        deform; rotations are those of the mean, conjugate to the moments of `SectionMoment`
    displacement : what the components are set to, in their order, mm and rad; all zero if empty
    """

    rod: str
    position: float
    components: tuple[Component, ...]
    of: Literal["section", "mean"] = "section"
    displacement: tuple[float, ...] = ()


def station_of(support: Clamp | Support, rod: Rod) -> float:
    """Arc length at which a support holds its rod, mm."""
    if isinstance(support, Support):
        return support.position
    return 0.0 if support.end == "start" else rod.length


def check_support(support: Clamp | Support, rod: Rod, key: str) -> None:
    """Raise a SceneError for a support that cannot be meant."""
    if isinstance(support, Clamp):
        require(support.end in ENDS, f"{key}.end", f"'{support.end}'", "write 'start' or 'end'")
        require_finite(support.displacement, f"{key}.displacement")
        require_finite(support.rotation, f"{key}.rotation")
        small = math.hypot(*support.rotation) <= LARGEST_ROTATION
        require(small, f"{key}.rotation", list(support.rotation), _SMALL)
        return
    require_on_rod(support.position, rod, f"{key}.position")
    components = support.components
    known = components != () and all(component in COMPONENTS for component in components)
    require(known, f"{key}.components", list(components), f"name some of {', '.join(COMPONENTS)}")
    require(len(set(components)) == len(components), f"{key}.components", list(components), "name each once")
    turns = [component for component in components if component.startswith("turn")]
    require(support.of in ("section", "mean"), f"{key}.of", f"'{support.of}'", "write 'section' or 'mean'")
    remedy = "only the mean rotation of a section can be held; write of = 'mean', or a clamp for the whole section"
    require(support.of == "mean" or not turns, f"{key}.components", list(components), remedy)
    given = support.displacement
    ok = len(given) in (0, len(components)) and all(math.isfinite(value) for value in given)
    require(ok, f"{key}.displacement", list(given), f"one finite number for each of the {len(components)} components")
    turned = [value for component, value in zip(components, given, strict=False) if component in turns]
    require(max(map(abs, turned), default=0.0) <= LARGEST_ROTATION, f"{key}.displacement", list(given), _SMALL)


@dataclass(frozen=True)
class Joint:
    """Ends of rods that move together as one rigid body: their end sections neither deform nor turn apart."""

    ends: tuple[RodEnd, ...]


@dataclass(frozen=True)
class Bed:
    """A Winkler bed along a face: springs that push and pull, pressure = modulus times displacement along the normal.

    Parameters
    ----------
    start, end : stretch of the rod that lies on the bed, arc length, mm
    modulus : k, N/mm^3
    """

    face: RodFace
    start: float
    end: float
    modulus: float

    @property
    def rod(self) -> str:
        """Name of the rod."""
        return self.face.rod


def check_bed(bed: Bed, rod: Rod, key: str) -> None:
    """Raise a SceneError for a bed that cannot be meant."""
    require_stretch(bed.start, bed.end, rod, f"{key}.start")
    require_positive(bed.modulus, f"{key}.modulus", "a bed modulus")
