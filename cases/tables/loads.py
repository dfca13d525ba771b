"""Tables of loads."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from cases.tables.places import RodFaceTable
from cases.tables.values import Acceleration, Force, ForcePerLength, Length, Moment, Stress, Table, Text


class SectionForceTable(Table):
    """A force spread evenly over one cross-section."""

    kind: Literal["section force"]
    """Kind of load: "section force"."""
    rod: Text
    """Name of one of the [rods]."""
    position: Length
    """Where the section is, a length along the rod from its start."""
    force: tuple[Force, Force, Force]
    """The force, three components [X, Y, Z] in global axes, such as [0, "-1 kN", 0]."""


class SectionMomentTable(Table):
    """A moment on one cross-section, as the linear distribution of traction that makes it."""

    kind: Literal["section moment"]
    """Kind of load: "section moment"."""
    rod: Text
    """Name of one of the [rods]."""
    position: Length
    """Where the section is, a length along the rod from its start."""
    moment: tuple[Moment, Moment, Moment]
    """The moment, three components [X, Y, Z] in global axes, such as [0, 0, "2 N m"]."""


class LineLoadTable(Table):
    """A force per length of the centre line, spread evenly over the cross-sections."""

    kind: Literal["line load"]
    """Kind of load: "line load"."""
    rod: Text
    """Name of one of the [rods]."""
    start: Length
    """Where the load begins, a length along the rod from its start."""
    end: Length
    """Where it ends, a length along the rod from its start."""
    force: tuple[ForcePerLength, ForcePerLength, ForcePerLength]
    """The force per length, three components [X, Y, Z] in global axes, such as [0, "-2 kN/m", 0]."""


class PressureTable(Table):
    """A pressure on a flat lateral face."""

    kind: Literal["pressure"]
    """Kind of load: "pressure"."""
    face: RodFaceTable
    """The face, such as { rod = "beam", face = "top" }."""
    start: Length
    """Where the pressure begins, a length along the rod from its start."""
    end: Length
    """Where it ends, a length along the rod from its start."""
    pressure: Stress
    """The pressure, a stress, such as "2 bar"; positive pushes against the face."""


class GravityTable(Table):
    """The weight of rods, by the density of their materials."""

    kind: Literal["gravity"]
    """Kind of load: "gravity"."""
    acceleration: tuple[Acceleration, Acceleration, Acceleration]
    """Acceleration of gravity with its unit, three components [X, Y, Z] in global axes, such as
    [0, "-9.81 m/s^2", 0]."""
    rods: Annotated[tuple[Text, ...], Field(min_length=1)] = ()
    """Names of the [rods] that have weight, a list of at least one, such as ["beam"]; all rods without this key."""


LoadTable = Annotated[
    SectionForceTable | SectionMomentTable | LineLoadTable | PressureTable | GravityTable, Field(discriminator="kind")
]
