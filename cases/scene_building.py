"""From the tables of a case file to a `Scene`: names found, shapes, supports and loads made."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

from cases.scene import (
    Bed,
    Box,
    CentreLine,
    Circle,
    Clamp,
    ContactPair,
    Gap,
    GapTable,
    Gravity,
    Ground,
    Helix,
    Joint,
    Line,
    LineLoad,
    Load,
    Material,
    Orthotropic,
    Path,
    Polygon,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    RoundGap,
    Scene,
    SceneError,
    Section,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
)
from cases.schema import CaseFile
from cases.sections import thinnest
from cases.tables.centre_lines import (
    ArcTable,
    CentreLineTable,
    HelixTable,
    LineTable,
    PathTable,
    PieceTable,
    SplineTable,
)
from cases.tables.contacts import BedGroundTable, ContactTable, RigidGroundTable, RoundGapTable, StationGapTable
from cases.tables.loads import (
    GravityTable,
    LineLoadTable,
    LoadTable,
    PressureTable,
    SectionForceTable,
    SectionMomentTable,
)
from cases.tables.materials import IsotropicTable, MaterialTable, OrthotropicTable
from cases.tables.places import RodFaceTable
from cases.tables.sections import BoxTable, CircleTable, PolygonTable, RectangleTable, RingTable, SectionTable
from cases.tables.supports import ClampTable, MeanSupportTable, SectionSupportTable, SupportTable
from cases.units import UnitError, to_unit
from cases.wording import listed, nearest, shown

# Thickness of any part of a section as a part of its size. The rod model alone could do with less.
THINNEST = 1e-5


def require_found(condition: bool, key: str, found: object, remedy: str) -> None:
    """Raise a SceneError that shows what was found, as it stands in a file, unless the condition holds."""
    if not condition:
        raise SceneError(key, shown(found), remedy)


def require_known(name: str, names: Iterable[str], key: str, table: str) -> None:
    """See that a name is one of a table's."""
    names = list(names)
    if name not in names:
        near = nearest(name, names)
        hint = f"; did you mean '{near}'?" if near else ""
        raise SceneError(key, shown(name), f"the [{table}] are {listed(names)}{hint}")


def scene_from(name: str, file: CaseFile) -> Scene:
    """The scene of a case file.

    Raises
    ------
    SceneError
        if what the keys say does not go together.
    """
    _require_rods_known(file)
    remedy = "needed: one [[supports]] for each end or section that is held, or [[beds]] or [contacts]"
    if not file.supports and not file.beds and not file.contacts:
        raise SceneError("supports", "no such key", remedy)
    loads = [(number, load) for number, table in enumerate(file.loads, 1) for load in _loads(number, table, file)]
    with _numbered_as_in_file([number for number, _ in loads]):
        return Scene(
            name=name,
            rods=_rods(file),
            supports=tuple(_support(f"supports #{number}", table) for number, table in enumerate(file.supports, 1)),
            loads=tuple(load for _, load in loads),
            contacts=tuple(_contact(key, pair) for key, pair in file.contacts.items()),
            joints=tuple(Joint(tuple(RodEnd(end.rod, end.end) for end in joint.ends)) for joint in file.joints),
            beds=tuple(Bed(_face(bed.face), bed.start, bed.end, bed.modulus) for bed in file.beds),
        )


@contextmanager
def _inside(table: str) -> Iterator[None]:
    """Say in which table the key of a SceneError stands."""
    try:
        yield
    except SceneError as error:
        raise SceneError(f"{table}.{error.key}", error.found, error.remedy) from error


@contextmanager
def _numbered_as_in_file(numbers: list[int]) -> Iterator[None]:
    """Count loads in the key of a SceneError as the file does, where one table may stand for the weight of many rods.

    numbers : of the file's table, for every load of the scene
    """
    try:
        yield
    except SceneError as error:
        key = re.sub(r"^loads #(\d+)", lambda match: f"loads #{numbers[int(match[1]) - 1]}", error.key)
        raise SceneError(key, error.found, error.remedy) from error


def _require_rods_known(file: CaseFile) -> None:
    """See that supports, loads, contacts, joints and beds name rods of the file."""
    named = [(f"supports #{i}.rod", support.rod) for i, support in enumerate(file.supports, 1)]
    for i, load in enumerate(file.loads, 1):
        match load:
            case PressureTable():
                named.append((f"loads #{i}.face.rod", load.face.rod))
            case GravityTable():
                named += [(f"loads #{i}.rods #{j}", rod) for j, rod in enumerate(load.rods, 1)]
            case _:
                named.append((f"loads #{i}.rod", load.rod))
    for key, pair in file.contacts.items():
        named.append((f"contacts.{key}.first.rod", pair.first.rod))
        if isinstance(pair.second, RodFaceTable):
            named.append((f"contacts.{key}.second.rod", pair.second.rod))
    for i, joint in enumerate(file.joints, 1):
        named += [(f"joints #{i}.ends #{j}.rod", end.rod) for j, end in enumerate(joint.ends, 1)]
    named += [(f"beds #{i}.face.rod", bed.face.rod) for i, bed in enumerate(file.beds, 1)]
    for key, rod in named:
        require_known(rod, file.rods, key, "rods")


def _rods(file: CaseFile) -> tuple[Rod, ...]:
    materials, sections, rods = {}, {}, []
    for key, material in file.materials.items():
        with _inside(f"materials.{key}"):
            materials[key] = _material(material)
    for key, section in file.sections.items():
        with _inside(f"sections.{key}"):
            sections[key] = _section(section)
            _require_thick(sections[key])
    for key, rod in file.rods.items():
        require_known(rod.section, sections, f"rods.{key}.section", "sections")
        require_known(rod.material, materials, f"rods.{key}.material", "materials")
        with _inside(f"rods.{key}.centre_line"):
            line = _centre_line(rod.centre_line)
        rods.append(Rod(key, line, sections[rod.section], materials[rod.material], rod.element_borders))
    return tuple(rods)


def _material(table: MaterialTable) -> Material | Orthotropic:
    match table:
        case IsotropicTable():
            return Material(table.young_modulus, table.poisson_ratio, table.density)
        case OrthotropicTable():
            return Orthotropic(table.young_moduli, table.shear_moduli, table.poisson_ratios, table.density)


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


def _require_thick(section: Section) -> None:
    """See that no part of a section is so thin that 3D, which meshes it, would take it for none, or never end."""
    key, thickness, size = thinnest(section)
    remedy = f"more than {THINNEST:g} of the section's {size:g} mm is needed"
    if not thickness > THINNEST * size:
        raise SceneError(key, f"a part that is {thickness:.3g} mm thick", remedy)


def _centre_line(table: CentreLineTable) -> CentreLine:
    if not isinstance(table, PathTable):
        return _piece(table)
    pieces = []
    for number, piece in enumerate(table.pieces, 1):
        with _inside(f"pieces #{number}"):
            pieces.append(_piece(piece))
    return Path(tuple(pieces))


def _piece(table: PieceTable) -> Line | Helix | Spline:
    match table:
        case LineTable():
            return Line(table.start, table.end, table.up, table.twist)
        case ArcTable():
            return Helix(table.start, table.centre, table.axis, table.angle, table.up)
        case HelixTable():
            return Helix(table.start, table.centre, table.axis, table.angle, table.up, table.pitch)
        case SplineTable():
            return Spline(table.points, table.up, table.frame)


def _face(table: RodFaceTable) -> RodFace:
    return RodFace(table.rod, table.face)


def _contact(name: str, table: ContactTable) -> ContactPair:
    second: RodFace | Ground
    match table.second:
        case RodFaceTable():
            second = _face(table.second)
        case RigidGroundTable():
            second = Ground()
        case BedGroundTable():
            second = Ground(table.second.modulus)
    gap: Gap
    match table.gap:
        case StationGapTable():
            gap = GapTable(table.gap.stations, table.gap.gaps)
        case RoundGapTable():
            gap = RoundGap(table.gap.radius, table.gap.station, table.gap.least)
        case _:
            gap = table.gap
    return ContactPair(name, _face(table.first), second, table.zone, gap, table.penalty)


def _support(key: str, table: SupportTable) -> Clamp | Support:
    match table:
        case ClampTable():
            return Clamp(table.rod, table.end, table.displacement, table.rotation)
        case SectionSupportTable() | MeanSupportTable():
            displacement = _displacement(f"{key}.displacement", table)
            return Support(table.rod, table.position, table.components, table.kind, displacement)


def _displacement(key: str, table: SectionSupportTable | MeanSupportTable) -> tuple[float, ...]:
    """What the components of a support are set to: a length or, for a turn, an angle for each."""
    given, count = list(table.displacement), len(table.components)
    remedy = f"give one for each of the components {listed(table.components)}, or leave the key out"
    require_found(len(given) in (0, count), key, given, remedy)
    values = []
    for number, (component, value) in enumerate(zip(table.components, given, strict=False), 1):
        try:
            values.append(to_unit(value, "rad" if component.startswith("turn") else "mm"))
        except UnitError as error:
            raise SceneError(f"{key} #{number}", shown(value), f"for '{component}' {error.remedy}") from error
    return tuple(values)


def _loads(number: int, table: LoadTable, file: CaseFile) -> tuple[Load, ...]:
    match table:
        case SectionForceTable():
            return (SectionForce(table.rod, table.position, table.force),)
        case SectionMomentTable():
            return (SectionMoment(table.rod, table.position, table.moment),)
        case LineLoadTable():
            return (LineLoad(table.rod, table.start, table.end, table.force),)
        case PressureTable():
            return (Pressure(_face(table.face), table.start, table.end, table.pressure),)
        case GravityTable():
            return _weights(f"loads #{number}", table, file)


def _weights(key: str, table: GravityTable, file: CaseFile) -> tuple[Gravity, ...]:
    """The weight of each rod that has some; all of them where none is named."""
    for index, name in enumerate(table.rods):
        require_found(name not in table.rods[:index], f"{key}.rods #{index + 1}", name, "name each rod once")
    names = table.rods or tuple(file.rods)
    for name in names:
        material = file.rods[name].material
        require_known(material, file.materials, f"rods.{name}.material", "materials")
        if file.materials[material].density is None:
            remedy = f"rod '{name}' has weight ({key}); needed: the density with its unit, such as \"7850 kg/m^3\""
            raise SceneError(f"materials.{material}.density", "no such key", remedy)
    return tuple(Gravity(name, table.acceleration) for name in names)
