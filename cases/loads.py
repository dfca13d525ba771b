"""Loads on rods."""

from __future__ import annotations

import math
from dataclasses import dataclass

from cases.checks import Vector, require, require_finite
from cases.rods import Rod, RodFace, require_flat_face, require_on_rod, require_stretch


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


@dataclass(frozen=True)
class Pressure:
    """A pressure on a flat lateral face; positive pushes against the outward normal.

    Parameters
    ----------
    start, end : stretch of the face that it acts on, arc length from the rod's start, mm
    pressure : MPa
    """

    face: RodFace
    start: float
    end: float
    pressure: float

    @property
    def rod(self) -> str:
        """Name of the rod."""
        return self.face.rod


@dataclass(frozen=True)
class Gravity:
    """The weight of a rod, by its material's density.

    Parameters
    ----------
    acceleration : of gravity, global components (X, Y, Z), mm/s^2
    """

    rod: str
    acceleration: Vector


Load = SectionForce | SectionMoment | LineLoad | Pressure | Gravity


def check_load(load: Load, rod: Rod, key: str) -> None:
    """Raise a SceneError for a load that cannot be meant."""
    match load:
        case SectionForce():
            require_finite(load.force, f"{key}.force")
            require_on_rod(load.position, rod, f"{key}.position")
        case SectionMoment():
            require_finite(load.moment, f"{key}.moment")
            require_on_rod(load.position, rod, f"{key}.position")
        case LineLoad():
            require_finite(load.force, f"{key}.force")
            require_stretch(load.start, load.end, rod, f"{key}.start")
        case Pressure():
            require(
                math.isfinite(load.pressure), f"{key}.pressure", f"{load.pressure:g}", "a finite pressure is needed"
            )
            require_flat_face(rod, load.face.face, f"{key}.face")
            require_stretch(load.start, load.end, rod, f"{key}.start")
        case Gravity():
            require_finite(load.acceleration, f"{key}.acceleration")
            found = f"'{rod.name}', whose material has no density"
            require(rod.material.density is not None, f"{key}.rod", found, "give its material a density")
