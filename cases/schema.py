"""What a case file may contain: the keys, their meaning and their units.

These models check the form of a file, key by key. What the keys say together (names that exist, positions on
rods, faces that face each other) is for `cases.scene` and `cases.loader`.
"""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, StrictInt, StrictStr, WithJsonSchema
from typing_extensions import TypeAliasType

from cases.case import Quantity
from cases.scene import End, Face
from cases.units import EXAMPLES, LARGEST, QUANTITY_PATTERN, Unit, UnitError, to_unit

_FORMS = [{"type": "number"}, {"type": "string", "pattern": QUANTITY_PATTERN}]


def _with_unit(unit: Unit) -> tuple[BeforeValidator, WithJsonSchema]:
    """Validation and JSON Schema of a number with a unit."""
    what, example = EXAMPLES[unit]
    schema = {"anyOf": _FORMS, "description": f"{what}, such as {example}"}
    return BeforeValidator(lambda value: to_unit(value, unit)), WithJsonSchema(schema)


def _plain_number(value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not abs(value) <= LARGEST:
        raise UnitError("a number without unit is needed, such as 0.3")
    return float(value)


def _tolerance(value: object) -> str:
    """Keep a tolerance as text until its quantity is known, but see that it is a number with a unit."""
    for unit in ("%", "mm"):
        try:
            to_unit(value, unit)
        except UnitError:
            continue
        if isinstance(value, str):
            return value
    raise UnitError('write a tolerance with its unit, relative as in "0.1 %" or absolute as in "1 mm"')


# Named types are written once in the JSON Schema, and referred to.
Length = TypeAliasType("Length", Annotated[float, *_with_unit("mm")])
Force = TypeAliasType("Force", Annotated[float, *_with_unit("N")])
Stress = TypeAliasType("Stress", Annotated[float, *_with_unit("MPa")])
Moment = TypeAliasType("Moment", Annotated[float, *_with_unit("N mm")])
ForcePerLength = TypeAliasType("ForcePerLength", Annotated[float, *_with_unit("N/mm")])
Angle = TypeAliasType("Angle", Annotated[float, *_with_unit("rad")])
StressPerLength = TypeAliasType("StressPerLength", Annotated[float, *_with_unit("N/mm^3")])
Number = Annotated[float, BeforeValidator(_plain_number), WithJsonSchema({"type": "number"})]
Tolerance = Annotated[str, BeforeValidator(_tolerance), WithJsonSchema({"type": "string", "pattern": QUANTITY_PATTERN})]
Name = Annotated[str, Field(strict=True, pattern=r"^[A-Za-z0-9_][A-Za-z0-9_ .-]*$")]
Text = Annotated[StrictStr, Field(min_length=1)]
Point = tuple[Length, Length, Length]
Direction = tuple[Number, Number, Number]
Corner = tuple[Length, Length]
# For tables that the author names: no other names than `Name` allows.
_ONLY_NAMES = Field(json_schema_extra={"additionalProperties": False})
# The unit of a published value follows from its quantity, so the loader converts it.
Value = Annotated[
    Any, WithJsonSchema({"anyOf": [*_FORMS, {"type": "array", "items": {"anyOf": _FORMS}, "minItems": 1}]})
]


class _Table(BaseModel):
    """A table of the file: no other keys than these."""

    model_config = ConfigDict(extra="forbid", frozen=True, use_attribute_docstrings=True)


class MaterialTable(_Table):
    """A linear elastic, isotropic material."""

    young_modulus: Stress
    """Young's modulus E, a stress, such as "200 GPa"; positive."""
    poisson_ratio: Number
    """Poisson's ratio, between -1 and 0.5."""


class RectangleTable(_Table):
    """A rectangular cross-section, in coordinates x (across) and y (towards the centre line's `up`)."""

    shape: Literal["rectangle"]
    """Shape of the section: "rectangle"."""
    width: Length
    """Extent along x, a length; positive."""
    height: Length
    """Extent along y, a length; positive."""


class CircleTable(_Table):
    """A full circular cross-section."""

    shape: Literal["circle"]
    """Shape of the section: "circle"."""
    diameter: Length
    """Diameter, a length; positive."""


class RingTable(_Table):
    """The cross-section of a circular tube."""

    shape: Literal["ring"]
    """Shape of the section: "ring"."""
    outer_diameter: Length
    """Outer diameter, a length."""
    inner_diameter: Length
    """Inner diameter, a length; positive, and smaller than the outer one."""


class BoxTable(_Table):
    """The cross-section of a rectangular tube, in coordinates x (across) and y (towards `up`)."""

    shape: Literal["box"]
    """Shape of the section: "box"."""
    width: Length
    """Outer extent along x, a length; positive."""
    height: Length
    """Outer extent along y, a length; positive."""
    wall: Length
    """Thickness of the walls, a length; positive, and less than half the smaller side."""


class PolygonTable(_Table):
    """A cross-section with straight edges; its centroid is laid on the centre line."""

    shape: Literal["polygon"]
    """Shape of the section: "polygon"."""
    outer: tuple[Corner, ...]
    """Corners in order around the section, a list of pairs of lengths [x, y], such as [[0, 0], [20, 0], [0, 10]]; the
    first is not repeated."""
    holes: tuple[tuple[Corner, ...], ...] = ()
    """Holes, a list of lists of corners like `outer`, within it and apart from each other."""


SectionTable = RectangleTable | CircleTable | RingTable | BoxTable | PolygonTable


class LineTable(_Table):
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


class ArcTable(_Table):
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


class HelixTable(_Table):
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


CentreLineTable = LineTable | ArcTable | HelixTable


class RodTable(_Table):
    """An elastic rod; supports, loads and contacts call it by the name of its table."""

    section: Text
    """Name of one of the [sections]."""
    material: Text
    """Name of one of the [materials]."""
    element_borders: tuple[Length, ...]
    """Borders of the rod model's elements, a list of rising lengths from 0 to the rod's length, along the rod
    from its start; borders inside a contact zone move to the edges of the contact. The last border may be rounded
    to four digits, as the length of a curved rod is seldom a round number; a load's place at its end likewise."""
    centre_line: Annotated[CentreLineTable, Field(discriminator="shape")]
    """The rod's centre line, as table [rods.NAME.centre_line]."""


class SupportTable(_Table):
    """A support; a "clamp" holds all displacements of an end section."""

    kind: Literal["clamp"]
    """Kind of support: "clamp"."""
    rod: Text
    """Name of one of the [rods]."""
    end: End
    """Which end of the rod: "start" or "end"."""


class SectionForceTable(_Table):
    """A force spread evenly over one cross-section."""

    kind: Literal["section force"]
    """Kind of load: "section force"."""
    rod: Text
    """Name of one of the [rods]."""
    position: Length
    """Where the section is, a length along the rod from its start."""
    force: tuple[Force, Force, Force]
    """The force, three components [X, Y, Z] in global axes, such as [0, "-1 kN", 0]."""


class SectionMomentTable(_Table):
    """A moment on one cross-section, as the linear distribution of traction that makes it."""

    kind: Literal["section moment"]
    """Kind of load: "section moment"."""
    rod: Text
    """Name of one of the [rods]."""
    position: Length
    """Where the section is, a length along the rod from its start."""
    moment: tuple[Moment, Moment, Moment]
    """The moment, three components [X, Y, Z] in global axes, such as [0, 0, "2 N m"]."""


class LineLoadTable(_Table):
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


LoadTable = SectionForceTable | SectionMomentTable | LineLoadTable


class RodFaceTable(_Table):
    """A lateral face of a rod."""

    rod: Text
    """Name of one of the [rods]."""
    face: Face
    """Which face: "top" (y = +height/2), "bottom", "right" (x = +width/2) or "left"."""


class ContactTable(_Table):
    """Two faces that may touch without friction."""

    first: RodFaceTable
    """The first face, such as { rod = "lower", face = "top" }."""
    second: RodFaceTable
    """The second face, such as { rod = "upper", face = "bottom" }."""
    zone: tuple[Length, Length]
    """Where the faces may touch: two rising lengths [from, to] along the first rod from its start."""
    gap: Annotated[float, *_with_unit("mm"), Field(ge=0.0)]
    """Distance of the faces before loading, a length, not negative; it counts as given, whatever is drawn."""
    penalty: StressPerLength
    """Pressure per penetration, a stress per length, such as "1e6 N/mm^3"; positive."""


class RodModelTable(_Table):
    """How the rod model solves the case."""

    level: Annotated[StrictInt, Field(ge=1, le=12)]
    """Level k of the model h_k, a whole number from 1 to 12: degree of the polynomials over the section."""
    order: Annotated[StrictInt, Field(ge=2, le=20)]
    """Order p of the shape functions along the rod, a whole number from 2 to 20."""


class CompareTable(_Table):
    """A quantity by which the rod model is held against the 3D reference."""

    quantity: Quantity
    """Name of the quantity; not max_bending_stress, which does not converge in 3D."""
    rod: Text | None = None
    """Name of one of the [rods], for a quantity of a rod."""
    contact: Text | None = None
    """Name of one of the [contacts], for a quantity of a contact pair."""
    point: Point | None = None
    """Point of a rod, three lengths [x, y, s]: x and y in the section, s along the rod; for stress_s."""
    tolerance: Tolerance
    """Largest difference that passes, with its unit: "0.3 %" of the value (of a curve's largest value), or
    "1 mm" for positions."""


class PublishedTable(_Table):
    """A value printed in a source, as printed."""

    quantity: Quantity
    """Name of the quantity; one that a number or a list of numbers states, so no curve and no stress_s."""
    rod: Text | None = None
    """Name of one of the [rods], for a quantity of a rod."""
    contact: Text | None = None
    """Name of one of the [contacts], for a quantity of a contact pair."""
    value: Value
    """The value, such as "117.15 MPa"; for contact edges start and end of each stretch in contact, such as
    ["200 mm", "221.71 mm"], as global coordinates."""
    tolerance: Tolerance
    """How far from it a result may be, with its unit: "0.1 %" or "1 mm"."""
    source: Text
    """Where the value is printed."""


class CaseFile(_Table):
    """A case of rodcheck: rods, what acts on them, and what their solutions are held against.

    A number with a unit is a string, such as "200 GPa"; a bare number is in mm, N, MPa or rad. A key [rods.NAME]
    is a table of its own for every name.
    """

    title: Text
    """One line that says what the case is."""
    description: StrictStr = ""
    """A paragraph about the case."""
    independent: Text | None = None
    """Name of a file in cases/truth with 3D values made outside this project."""
    materials: Annotated[dict[Name, MaterialTable], _ONLY_NAMES]
    """The materials, one table [materials.NAME] each."""
    sections: Annotated[dict[Name, Annotated[SectionTable, Field(discriminator="shape")]], _ONLY_NAMES]
    """The cross-sections, one table [sections.NAME] each."""
    rods: Annotated[dict[Name, RodTable], _ONLY_NAMES]
    """The rods, one table [rods.NAME] each."""
    supports: tuple[SupportTable, ...]
    """The supports, one [[supports]] each."""
    loads: tuple[Annotated[LoadTable, Field(discriminator="kind")], ...] = ()
    """The loads, one [[loads]] each."""
    contacts: Annotated[dict[Name, ContactTable], _ONLY_NAMES] = {}
    """The contact pairs, one table [contacts.NAME] each."""
    rod_model: RodModelTable
    """Settings of the rod model."""
    compare: tuple[CompareTable, ...] = ()
    """What is compared, one [[compare]] each."""
    published: tuple[PublishedTable, ...] = ()
    """Published values, one [[published]] each."""


def case_schema() -> dict[str, Any]:
    """JSON Schema of a case file as a dictionary of its TOML content."""
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", **CaseFile.model_json_schema()}
