"""From the tables of a case file to a `Case`: names found, shapes and loads made, tolerances in their units."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from itertools import pairwise
from pathlib import Path

from cases.case import QUANTITIES, Case, Check, Published, Quantity, RodModelSettings
from cases.polygon import depth
from cases.scene import (
    Box,
    CentreLine,
    Circle,
    Clamp,
    ContactPair,
    Helix,
    Line,
    LineLoad,
    Load,
    Material,
    Polygon,
    Rectangle,
    Ring,
    Rod,
    RodFace,
    Scene,
    SceneError,
    Section,
    SectionForce,
    SectionMoment,
    Vector,
)
from cases.schema import (
    ArcTable,
    BoxTable,
    CaseFile,
    CentreLineTable,
    CircleTable,
    CompareTable,
    HelixTable,
    LineLoadTable,
    LineTable,
    LoadTable,
    PolygonTable,
    PublishedTable,
    RectangleTable,
    RingTable,
    SectionForceTable,
    SectionMomentTable,
    SectionTable,
)
from cases.units import UnitError, to_unit
from cases.wording import listed, nearest, shown


@contextmanager
def _inside(table: str) -> Iterator[None]:
    """Say in which table the key of a SceneError stands."""
    try:
        yield
    except SceneError as error:
        raise SceneError(f"{table}.{error.key}", error.found, error.remedy) from error


def _require(condition: bool, key: str, found: object, remedy: str) -> None:
    if not condition:
        raise SceneError(key, shown(found), remedy)


def _require_known(name: str, names: Iterable[str], key: str, table: str) -> None:
    """See that a name is one of a table's."""
    names = list(names)
    near = nearest(name, names)
    hint = f"; did you mean '{near}'?" if near else ""
    _require(name in names, key, name, f"the [{table}] are {listed(names)}{hint}")


def case_from(name: str, file: CaseFile, truth: Path) -> Case:
    """The case of a file.

    Parameters
    ----------
    name : of the file, without folder and ending
    truth : folder of the independent values

    Raises
    ------
    SceneError
        if what the keys say does not go together.
    """
    scene = _scene(name, file)
    compare = tuple(_check(f"compare #{i}", table, scene) for i, table in enumerate(file.compare, 1))
    published = tuple(_published(f"published #{i}", table, scene) for i, table in enumerate(file.published, 1))
    for index, check in enumerate(compare):
        twice = any((check.quantity, check.of, check.point) == (c.quantity, c.of, c.point) for c in compare[:index])
        _require(not twice, f"compare #{index + 1}", f"{check.quantity} of {check.of} again", "compare it once")
    independent = None
    if file.independent is not None:
        truths = sorted(path.name for path in truth.glob("*.json"))
        remedy = f"the files in cases/truth are {listed(truths)}"
        _require(file.independent in truths, "independent", file.independent, remedy)
        independent = truth / file.independent
    settings = RodModelSettings(file.rod_model.level, file.rod_model.order)
    return Case(name, file.title, file.description.strip(), scene, settings, compare, published, independent)


def _scene(name: str, file: CaseFile) -> Scene:
    materials, sections, rods = {}, {}, []
    for key, material in file.materials.items():
        with _inside(f"materials.{key}"):
            materials[key] = Material(material.young_modulus, material.poisson_ratio)
    for key, section in file.sections.items():
        with _inside(f"sections.{key}"):
            sections[key] = _section(section)
    for key, rod in file.rods.items():
        _require_known(rod.section, sections, f"rods.{key}.section", "sections")
        _require_known(rod.material, materials, f"rods.{key}.material", "materials")
        with _inside(f"rods.{key}.centre_line"):
            line = _centre_line(rod.centre_line)
        rods.append(Rod(key, line, sections[rod.section], materials[rod.material], rod.element_borders))
    for i, support in enumerate(file.supports, 1):
        _require_known(support.rod, file.rods, f"supports #{i}.rod", "rods")
    for i, load in enumerate(file.loads, 1):
        _require_known(load.rod, file.rods, f"loads #{i}.rod", "rods")
    for key, pair in file.contacts.items():
        _require_known(pair.first.rod, file.rods, f"contacts.{key}.first.rod", "rods")
        _require_known(pair.second.rod, file.rods, f"contacts.{key}.second.rod", "rods")
    return Scene(
        name=name,
        rods=tuple(rods),
        supports=tuple(Clamp(support.rod, support.end) for support in file.supports),
        loads=tuple(_load(load) for load in file.loads),
        contacts=tuple(
            ContactPair(
                key,
                RodFace(pair.first.rod, pair.first.face),
                RodFace(pair.second.rod, pair.second.face),
                pair.zone,
                pair.gap,
                pair.penalty,
            )
            for key, pair in file.contacts.items()
        ),
    )


def _section(table: SectionTable) -> Section:
    match table:
        case RectangleTable():
            return Rectangle(table.width, table.height)
        case CircleTable():
            return Circle(table.diameter)
        case RingTable():
            return Ring(table.outer_diameter, table.inner_diameter)
        case BoxTable():
            return Box(table.width, table.height, table.wall)
        case PolygonTable():
            return Polygon(table.outer, table.holes)


def _centre_line(table: CentreLineTable) -> CentreLine:
    match table:
        case LineTable():
            return Line(table.start, table.end, table.up, table.twist)
        case ArcTable():
            return Helix(table.start, table.centre, table.axis, table.angle, table.up)
        case HelixTable():
            return Helix(table.start, table.centre, table.axis, table.angle, table.up, table.pitch)


def _load(table: LoadTable) -> Load:
    match table:
        case SectionForceTable():
            return SectionForce(table.rod, table.position, table.force)
        case SectionMomentTable():
            return SectionMoment(table.rod, table.position, table.moment)
        case LineLoadTable():
            return LineLoad(table.rod, table.start, table.end, table.force)


def _of(key: str, table: CompareTable | PublishedTable, scene: Scene) -> str:
    """Name of the rod or contact pair that a quantity belongs to."""
    wanted = QUANTITIES[table.quantity].of
    other = "contact" if wanted == "rod" else "rod"
    _require(
        getattr(table, other) is None,
        f"{key}.{other}",
        getattr(table, other),
        f"{table.quantity} is of a {wanted}",
    )
    name = getattr(table, wanted)
    known = [rod.name for rod in scene.rods] if wanted == "rod" else [pair.name for pair in scene.contacts]
    if name is None:
        remedy = f"{table.quantity} is of a {wanted}, one of {listed(known)}"
        raise SceneError(f"{key}.{wanted}", "no such key", remedy)
    _require_known(name, known, f"{key}.{wanted}", f"{wanted}s")
    return str(name)


def _tolerance(key: str, quantity: Quantity, text: str) -> float:
    relative = QUANTITIES[quantity].relative
    form = 'relative, as in "0.1 %"' if relative else 'a length, as in "1 mm"'
    remedy = f"the tolerance of {quantity} is {form}"
    try:
        tolerance = to_unit(text, "%" if relative else "mm")
    except UnitError as error:
        raise SceneError(f"{key}.tolerance", shown(text), remedy) from error
    _require(tolerance > 0.0, f"{key}.tolerance", text, "a tolerance must be positive")
    return tolerance


def _check(key: str, table: CompareTable, scene: Scene) -> Check:
    comparable = [name for name, kind in QUANTITIES.items() if kind.comparable]
    remedy = f"it does not converge in 3D; compare one of {listed(comparable)}"
    _require(table.quantity in comparable, f"{key}.quantity", table.quantity, remedy)
    of = _of(key, table, scene)
    if table.quantity == "stress_s":
        if table.point is None:
            raise SceneError(f"{key}.point", "no such key", "needed: the point [x, y, s] where the stress is compared")
        _require_inside(f"{key}.point", table.point, scene.rod(of))
    else:
        _require(table.point is None, f"{key}.point", table.point, "only stress_s is at a point")
    return Check(table.quantity, of, _tolerance(key, table.quantity, table.tolerance), table.point)


def _require_inside(key: str, point: Vector, rod: Rod) -> None:
    x, y, s = point
    inside, limits = _inside_section(rod.section, x, y)
    remedy = f"in rod '{rod.name}' {limits} and s from 0 to {rod.length:g} mm"
    _require(inside and 0.0 <= s <= rod.length, key, list(point), remedy)


def _inside_section(section: Section, x: float, y: float) -> tuple[bool, str]:
    """Whether a point lies in a section, and in words where it may lie; borders belong to it up to round-off."""
    slack = 1.0 + 1e-9
    match section:
        case Rectangle() | Box():
            half_width, half_height = section.width / 2, section.height / 2
            inside = abs(x) <= half_width * slack and abs(y) <= half_height * slack
            limits = f"x is within +-{half_width:g}, y within +-{half_height:g}"
            if isinstance(section, Box):
                wall = section.wall * slack
                inside = inside and (abs(x) >= half_width - wall or abs(y) >= half_height - wall)
                limits += f", in the wall of {section.wall:g} mm"
            return inside, limits
        case Circle():
            radius = section.diameter / 2
            return math.hypot(x, y) <= radius * slack, f"(x, y) is within {radius:g} mm of the centre"
        case Ring():
            inner, outer = section.inner_diameter / 2, section.outer_diameter / 2
            limits = f"(x, y) is between {inner:g} and {outer:g} mm from the centre"
            return inner <= math.hypot(x, y) * slack and math.hypot(x, y) <= outer * slack, limits
        case Polygon():
            place = (x + section.centroid[0], y + section.centroid[1])
            margin = 1e-9 * max(abs(coordinate) for corner in section.outer for coordinate in corner)
            inside = depth(section.outer, place) >= -margin
            inside = inside and all(depth(hole, place) <= margin for hole in section.holes)
            return inside, "(x, y), counted from the centroid, is within the corners"


def _published(key: str, table: PublishedTable, scene: Scene) -> Published:
    kind = QUANTITIES[table.quantity]
    publishable = [name for name, each in QUANTITIES.items() if each.publishable]
    _require(
        table.quantity in publishable,
        f"{key}.quantity",
        table.quantity,
        f"write one of {listed(publishable)}",
    )
    of = _of(key, table, scene)
    entries = table.value if isinstance(table.value, list) else [table.value]
    try:
        value = tuple(to_unit(entry, kind.unit) for entry in entries)
    except UnitError as error:
        raise SceneError(f"{key}.value", shown(table.value), error.remedy) from error
    if table.quantity in ("contact_edges", "contact_edges_outer"):
        rising = all(a < b for a, b in pairwise(value))
        remedy = "write start and end of each stretch in contact in turn, rising"
        _require(len(value) > 0 and len(value) % 2 == 0 and rising, f"{key}.value", table.value, remedy)
    else:
        _require(len(value) == 1, f"{key}.value", table.value, "one value is needed")
    return Published(table.quantity, of, value, _tolerance(key, table.quantity, table.tolerance), table.source)
