"""Tables of centre lines."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from cases.tables.values import Angle, Direction, Length, Point, Table


class LineTable(Table):
    """A straight line through the centres of a rod's sections, in global axes X, Y, Z."""

    shape: Literal["line"]
    """Shape of the centre line: "line"."""
    start: Point
    """Where the rod starts, three lengths [X, Y, Z], such as [0, 0, 0]."""
    end: Point
    """Where the rod ends, three lengths [X, Y, Z], such as ["300 mm", 0, 0]."""
    up: Direction
    """Direction of the section's y axis at the start, three numbers [X, Y, Z], such as [0, 1, 0]; its part along the
    line is taken off."""
    twist: Angle = 0.0
    """Angle by which the section turns about the line from start to end, at an even rate and by the right-hand
    rule, such as "90 deg"; a bare number is in rad."""


class ArcTable(Table):
    """A circular arc through the centres of a rod's sections, in global axes X, Y, Z."""

    shape: Literal["arc"]
    """Shape of the centre line: "arc"."""
    start: Point
    """Where the rod starts, three lengths [X, Y, Z], such as [100, 0, 0]; its distance from the axis is the radius."""
    centre: Point
    """A point of the axis that the arc turns about, three lengths [X, Y, Z], such as [0, 0, 0]."""
    axis: Direction
    """Direction of the axis, three numbers [X, Y, Z], such as [0, 0, 1]; the arc turns about it by the right-hand
    rule."""
    angle: Angle
    """Angle turned from start to end, positive, such as "90 deg"; a bare number is in rad."""
    up: Direction
    """Direction of the section's y axis at the start, three numbers [X, Y, Z], such as [0, 0, 1]; its part along the
    line is taken off, and the section then turns along with the arc."""


class HelixTable(Table):
    """A helix through the centres of a rod's sections, in global axes X, Y, Z."""

    shape: Literal["helix"]
    """Shape of the centre line: "helix"."""
    start: Point
    """Where the rod starts, three lengths [X, Y, Z], such as [20, 0, 0]; its distance from the axis is the radius."""
    centre: Point
    """A point of the helix's axis, three lengths [X, Y, Z], such as [0, 0, 0]."""
    axis: Direction
    """Direction of the axis, three numbers [X, Y, Z], such as [0, 0, 1]; the helix turns about it by the right-hand
    rule."""
    angle: Angle
    """Angle turned from start to end, positive, such as "1080 deg" for three turns; a bare number is in rad."""
    pitch: Length
    """Advance along the axis in one full turn, a length; negative for a left-hand helix."""
    up: Direction
    """Direction of the section's y axis at the start, three numbers [X, Y, Z], such as [0, 0, 1]; its part along the
    line is taken off, and the section then moves along as a screw does."""


class SplineTable(Table):
    """A smooth line through points, along the centres of a rod's sections, in global axes X, Y, Z.

    It is a cubic spline whose parameter is the length of the chords; its first two pieces are one cubic, and so are its
    last two.
    """

    shape: Literal["spline"]
    """Shape of the centre line: "spline"."""
    points: Annotated[tuple[Point, ...], Field(min_length=3)]
    """Points in order along the rod, a list of at least three, each of three lengths [X, Y, Z], such as
    [[0, 0, 0], [100, 20, 0], [200, 0, 0]]."""
    up: Direction
    """Direction of the section's y axis at the start, three numbers [X, Y, Z], such as [0, 0, 1]; its part along the
    line is taken off."""
    frame: Literal["minimal rotation", "up"] = "minimal rotation"
    """How the section turns along the line: "minimal rotation", not about the tangent (as without this key); or "up",
    with y as near to `up` as it can be everywhere."""


PieceTable = Annotated[LineTable | ArcTable | HelixTable | SplineTable, Field(discriminator="shape")]


class PathTable(Table):
    """Smooth pieces one after the other, through the centres of a rod's sections."""

    shape: Literal["path"]
    """Shape of the centre line: "path"."""
    pieces: Annotated[tuple[PieceTable, ...], Field(min_length=1)]
    """The pieces, a list of lines, arcs, helices and splines, as tables [[rods.NAME.centre_line.pieces]]; each starts
    where the former ends, in its direction and with its y axis."""


CentreLineTable = Annotated[LineTable | ArcTable | HelixTable | SplineTable | PathTable, Field(discriminator="shape")]
