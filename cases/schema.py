"""What a case file may contain: the keys, their meaning and their units.

These models check the form of a file, key by key. What the keys say together (names that exist, positions on
rods, faces that face each other) is for `cases.scene` and `cases.building`.
"""

from __future__ import annotations

from typing import Annotated, Any

from pydantic import Field, PlainValidator, StrictInt, WithJsonSchema

from cases.case import Axis, Quantity
from cases.tables.centre_lines import CentreLineTable
from cases.tables.contacts import ContactTable
from cases.tables.loads import LoadTable
from cases.tables.materials import MaterialTable
from cases.tables.sections import SectionTable
from cases.tables.supports import BedTable, JointTable, SupportTable
from cases.tables.values import (
    ONLY_NAMES,
    Length,
    Lines,
    Name,
    Point,
    Table,
    Text,
    Title,
    Tolerance,
    Value,
)
from cases.units import UnitError


class RodTable(Table):
    """An elastic rod; supports, loads and contacts call it by the name of its table."""

    section: Text
    """Name of one of the [sections]."""
    material: Text
    """Name of one of the [materials]."""
    element_borders: tuple[Length, ...]
    """Borders of the rod model's elements, a list of rising lengths from 0 to the rod's length, along the rod
    from its start; borders inside a contact zone move to the edges of the contact. The last border may be rounded
    to four digits, as the length of a curved or inclined rod is seldom a round number; so may places of loads, supports
    and beds at its end."""
    centre_line: CentreLineTable
    """The rod's centre line, as table [rods.NAME.centre_line]."""


def _for_elements(least: int, most: int) -> tuple[PlainValidator, WithJsonSchema]:
    """Validation and JSON Schema of a level or order of one rod: of all its elements, or one for each."""
    wanted = f"a whole number from {least} to {most}"

    def checked(value: object) -> int | tuple[int, ...]:
        entries = tuple(value) if isinstance(value, list) else (value,)
        if not entries or any(type(entry) is not int or not least <= entry <= most for entry in entries):
            raise UnitError(f"{wanted} is needed, or a list with one for each element")
        return entries if isinstance(value, list) else entries[0]

    number = {"type": "integer", "minimum": least, "maximum": most}
    forms = [number, {"type": "array", "items": number, "minItems": 1}]
    schema = {"anyOf": forms, "description": f"{wanted}, or a list with one for each element"}
    return PlainValidator(checked), WithJsonSchema(schema)


Levels = Annotated[int | tuple[int, ...], *_for_elements(1, 12)]
Orders = Annotated[int | tuple[int, ...], *_for_elements(2, 20)]


class RodModelTable(Table):
    """How the rod model solves the case."""

    level: Annotated[StrictInt, Field(ge=1, le=12)]
    """Level k of the model h_k, a whole number from 1 to 12: degree of the polynomials over the section;
    [rod_model.levels] names rods that differ."""
    order: Annotated[StrictInt, Field(ge=2, le=20)]
    """Order p of the shape functions along the rod, a whole number from 2 to 20; [rod_model.orders] names rods that
    differ."""
    levels: Annotated[dict[Name, Levels], ONLY_NAMES] = Field(default_factory=dict)
    """Levels of rods that differ from `level`, by name: a whole number, or a list with one for each element, such as
    beam = [5, 3, 3]."""
    orders: Annotated[dict[Name, Orders], ONLY_NAMES] = Field(default_factory=dict)
    """Orders of rods that differ from `order`, by name: a whole number, or a list with one for each element, such as
    beam = [6, 4, 4]."""


class CompareTable(Table):
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


class PublishedTable(Table):
    """A value printed in a source, as printed."""

    quantity: Quantity
    """Name of the quantity; not bending_moment and stress_s, which no number states; of the deflection, one component
    at a place."""
    rod: Text | None = None
    """Name of one of the [rods], for a quantity of a rod."""
    contact: Text | None = None
    """Name of one of the [contacts], for a quantity of a contact pair."""
    position: Length | None = None
    """Where on the rod a deflection is published, a length along the rod from its start."""
    axis: Axis | None = None
    """Along which global axis it is, "X", "Y" or "Z"."""
    value: Value
    """The value, such as "117.15 MPa"; for contact edges start and end of each stretch in contact, such as
    ["200 mm", "221.71 mm"], as global coordinates."""
    tolerance: Tolerance
    """How far from it a result may be, with its unit: "0.1 %" or "1 mm"."""
    source: Text
    """Where the value is printed."""


class CaseFile(Table):
    """A case of rodcheck: rods, what acts on them, and what their solutions are held against.

    A number with a unit is a string, such as "200 GPa"; a bare number is in mm, N, MPa or rad, and densities and
    accelerations are never bare. A key [rods.NAME] is a table of its own for every name.
    """

    title: Title
    """One line that says what the case is, of 200 characters at most."""
    description: Lines = ""
    """A paragraph about the case."""
    independent: Text | None = None
    """Name of a file in cases/truth with 3D values made outside this project."""
    materials: Annotated[dict[Name, MaterialTable], ONLY_NAMES]
    """The materials, one table [materials.NAME] each."""
    sections: Annotated[dict[Name, SectionTable], ONLY_NAMES]
    """The cross-sections, one table [sections.NAME] each."""
    rods: Annotated[dict[Name, RodTable], ONLY_NAMES]
    """The rods, one table [rods.NAME] each."""
    supports: tuple[SupportTable, ...] = ()
    """The supports, one [[supports]] each; at least one unless there are [[beds]] or [contacts]."""
    joints: tuple[JointTable, ...] = ()
    """Ends of rods that are rigidly joined, one [[joints]] for each joint."""
    beds: tuple[BedTable, ...] = ()
    """Elastic beds that rods lie on, one [[beds]] each."""
    loads: tuple[LoadTable, ...] = ()
    """The loads, one [[loads]] each."""
    contacts: Annotated[dict[Name, ContactTable], ONLY_NAMES] = Field(default_factory=dict)
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
