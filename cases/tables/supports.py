"""Tables of supports, joints and beds."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field

from cases.scene import Component, End
from cases.tables.places import RodEndTable, RodFaceTable
from cases.tables.values import Angle, Length, Quantities, StressPerLength, Table, Text
from cases.units import UnitError


class ClampTable(Table):
    """An end section held as a rigid one, where it was or where a displacement takes it."""

    kind: Literal["clamp"]
    """Kind of support: "clamp"."""
    rod: Text
    """Name of one of the [rods]."""
    end: End
    """Which end of the rod: "start" or "end"."""
    displacement: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    """Where the section's centre is moved, three lengths [X, Y, Z] in global axes, such as [0, "-1 mm", 0]; nowhere
    without this key."""
    rotation: tuple[Angle, Angle, Angle] = (0.0, 0.0, 0.0)
    """How the section is turned about its centre, three small angles about [X, Y, Z], such as [0, 0, "1 deg"]; not at
    all without this key."""


def _no_turn(component: object) -> object:
    if isinstance(component, str) and component.startswith("turn"):
        raise UnitError("a whole section does not turn; hold its mean rotation with kind = 'mean', or clamp the end")
    return component


class SectionSupportTable(Table):
    """Displacements along chosen axes are held at every point of a section; "s" alone makes a plane of symmetry."""

    kind: Literal["section"]
    """Kind of support: "section"."""
    rod: Text
    """Name of one of the [rods]."""
    position: Length
    """Where the section is, a length along the rod from its start."""
    components: Annotated[tuple[Annotated[Literal["x", "y", "s"], BeforeValidator(_no_turn)], ...], Field(min_length=1)]
    """What is held, a list of at least one of "x" and "y" (along the section's axes there) and "s" (along the rod)."""
    displacement: Quantities = ()
    """What the components are set to, in their order, a list with one length for each, such as ["-0.1 mm"]; zero
    without this key."""


class MeanSupportTable(Table):
    """Chosen components of the mean motion of a section are held; the section may deform.

    "x", "y" and "s" make a pin, "x" or "y" alone a roller.
    """

    kind: Literal["mean"]
    """Kind of support: "mean"."""
    rod: Text
    """Name of one of the [rods]."""
    position: Length
    """Where the section is, a length along the rod from its start."""
    components: Annotated[tuple[Component, ...], Field(min_length=1)]
    """What is held, a list of at least one of "x" and "y" (displacement along the section's axes there), "s" (along the
    rod), "turn x", "turn y" and "turn s" (rotation about them)."""
    displacement: Quantities = ()
    """What the components are set to, in their order, a list with a length or, for turns, an angle for each, such as
    ["-0.1 mm", "1 deg"]; zero without this key."""


SupportTable = Annotated[ClampTable | SectionSupportTable | MeanSupportTable, Field(discriminator="kind")]


class JointTable(Table):
    """Ends of rods that are rigidly joined."""

    ends: Annotated[tuple[RodEndTable, ...], Field(min_length=2)]
    """The ends, a list of at least two at one point, such as [{ rod = "post", end = "end" }, { rod = "beam", end =
    "start" }]."""


class BedTable(Table):
    """A Winkler bed: springs along a flat face that push and pull."""

    face: RodFaceTable
    """The face, such as { rod = "beam", face = "bottom" }."""
    start: Length
    """Where the bed begins, a length along the rod from its start."""
    end: Length
    """Where it ends, a length along the rod from its start."""
    modulus: StressPerLength
    """Pressure per displacement along the face's normal, a stress per length, such as "0.05 N/mm^3"; positive."""
