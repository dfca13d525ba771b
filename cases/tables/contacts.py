"""Tables of contact pairs: faces that may touch, ground, and the gap in between."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Discriminator, Field, PlainValidator, Tag, WithJsonSchema
from typing_extensions import TypeAliasType

from cases.tables.places import RodFaceTable
from cases.tables.values import Length, StressPerLength, Table
from cases.units import QUANTITY_PATTERN, UnitError, to_unit


class RigidGroundTable(Table):
    """Ground that does not yield."""

    ground: Literal["rigid"]
    """What lies opposite: "rigid"."""


class BedGroundTable(Table):
    """A Winkler bed that pushes and cannot pull."""

    ground: Literal["bed"]
    """What lies opposite: "bed"."""
    modulus: StressPerLength
    """Pressure per displacement against the bed, a stress per length, such as "50 N/mm^3"; positive."""


# Tags are the names by which the JSON Schema knows the tables.
GroundTable = TypeAliasType("GroundTable", Annotated[RigidGroundTable | BedGroundTable, Field(discriminator="ground")])
OppositeTable = Annotated[
    Annotated[RodFaceTable, Tag("RodFaceTable")] | Annotated[GroundTable, Tag("GroundTable")],
    Discriminator(lambda value: "GroundTable" if _has(value, "ground", "modulus") else "RodFaceTable"),
]


class StationGapTable(Table):
    """Gap given at stations, straight between them."""

    stations: Annotated[tuple[Length, ...], Field(min_length=2)]
    """Where the gaps are, a list of at least two rising lengths along the first rod."""
    gaps: Annotated[tuple[Length, ...], Field(min_length=2)]
    """The gaps there, a list with one length for each; negative ones are interference."""


class RoundGapTable(Table):
    """Gap between a straight face and a round one, or a cylinder lying across."""

    radius: Length
    """Radius, a length that is not zero; negative where the round face is hollow."""
    station: Length
    """Where the gap is least (hollow: largest), a length along the first rod."""
    least: Length = 0.0
    """The gap there, a length; zero without this key."""


def _gap(value: object) -> float | Literal["drawn"]:
    if value == "drawn":
        return "drawn"
    try:
        return to_unit(value, "mm")
    except UnitError as error:
        others = "write \"drawn\", a table of 'stations' and 'gaps', or one of 'radius' and 'station'"
        raise UnitError(f"{error.remedy}; or {others}") from error


GapValue = TypeAliasType(
    "GapValue",
    Annotated[
        float | Literal["drawn"],
        PlainValidator(_gap),
        WithJsonSchema({"anyOf": [{"type": "number"}, {"type": "string", "pattern": f"^drawn$|{QUANTITY_PATTERN}"}]}),
    ],
)
GapOrTable = Annotated[
    Annotated[StationGapTable, Tag("StationGapTable")]
    | Annotated[RoundGapTable, Tag("RoundGapTable")]
    | Annotated[GapValue, Tag("GapValue")],
    Discriminator(lambda value: _kind_of_gap(value)),
]


def _has(value: object, *keys: str) -> bool:
    return isinstance(value, dict) and any(key in value for key in keys)


def _kind_of_gap(value: object) -> str:
    if not isinstance(value, dict):
        return "GapValue"
    return "StationGapTable" if _has(value, "stations", "gaps") else "RoundGapTable"


class ContactTable(Table):
    """Two faces that may touch without friction, or a face and ground."""

    first: RodFaceTable
    """The first face, such as { rod = "lower", face = "top" }."""
    second: OppositeTable
    """What lies opposite: a face of another rod, such as { rod = "upper", face = "bottom" }; or what does not move,
    { ground = "rigid" } or { ground = "bed", modulus = "50 N/mm^3" }."""
    zone: tuple[Length, Length]
    """Where the faces may touch: two rising lengths [from, to] along the first rod from its start."""
    gap: GapOrTable
    """Distance of the faces before loading, negative where they overlap: a length, which counts as given whatever is
    drawn; { stations = [0, 100], gaps = [0, "0.5 mm"] }, straight in between; { radius = "500 mm", station = "50 mm",
    least = 0 } for a round face; or "drawn" for the distance of the two faces as drawn."""
    penalty: StressPerLength | None = None
    """Pressure per penetration, a stress per length, such as "1e6 N/mm^3"; positive. Without this key one that suits
    the rods is chosen; contact forces do not depend on it."""
