"""Tables of cross-sections."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from cases.tables.values import Corner, Length, Table


class RectangleTable(Table):
    """A rectangular cross-section, in coordinates x (across) and y (towards the centre line's `up`)."""

    shape: Literal["rectangle"]
    """Shape of the section: "rectangle"."""
    width: Length
    """Extent along x, a length; positive."""
    height: Length
    """Extent along y, a length; positive."""


class CircleTable(Table):
    """A full circular cross-section."""

    shape: Literal["circle"]
    """Shape of the section: "circle"."""
    diameter: Length
    """Diameter, a length; positive."""


class RingTable(Table):
    """The cross-section of a circular tube."""

    shape: Literal["ring"]
    """Shape of the section: "ring"."""
    outer_diameter: Length
    """Outer diameter, a length."""
    inner_diameter: Length
    """Inner diameter, a length; positive, and smaller than the outer one."""


class BoxTable(Table):
    """The cross-section of a rectangular tube, in coordinates x (across) and y (towards `up`)."""

    shape: Literal["box"]
    """Shape of the section: "box"."""
    width: Length
    """Outer extent along x, a length; positive."""
    height: Length
    """Outer extent along y, a length; positive."""
    wall: Length
    """Thickness of the walls, a length; positive, and less than half the smaller side."""


class PolygonTable(Table):
    """A cross-section with straight edges; its centroid is laid on the centre line."""

    shape: Literal["polygon"]
    """Shape of the section: "polygon"."""
    outer: tuple[Corner, ...]
    """Corners in order around the section, a list of pairs of lengths [x, y], such as [[0, 0], [20, 0], [0, 10]]; the
    first is not repeated."""
    holes: tuple[tuple[Corner, ...], ...] = ()
    """Holes, a list of lists of corners like `outer`, within it and apart from each other."""


SectionTable = Annotated[
    RectangleTable | CircleTable | RingTable | BoxTable | PolygonTable, Field(discriminator="shape")
]
