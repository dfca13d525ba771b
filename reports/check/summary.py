"""What a case says, in tables, and what in it may surprise its author."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from cases.case import Case, Check
from cases.scene import (
    Clamp,
    ContactPair,
    Gravity,
    Ground,
    Helix,
    Line,
    LineLoad,
    Load,
    Material,
    Orthotropic,
    Path,
    Pressure,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
    given_gap,
    section_reach,
)
from reports.check.size import reference_unknowns, rod_unknowns
from reports.check.undeformed import undeformed
from reports.formatting import gap, grades, measure, opposite
from reports.quantities import DEFINITIONS, Quantities
from reports.sections import described
from reports.view import least_gap
from rodmodel.loose import loose_rods
from rodmodel.symmetry import scene_mirrors

# Given and drawn gap may differ by this share of the thinnest section before it is said.
DRAWN = 1e-3
# An element at a clamp is long from this many section heights on.
LONG_AT_CLAMP = 1.0
# Rods shorter than this many section heights are little like rods.
STOUT = 5.0
# Unknowns of the finest 3D mesh from which on a comparison takes minutes and gigabytes.
LARGE = 250_000


@dataclass(frozen=True)
class Table:
    """Rows under headings."""

    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True)
class Summary:
    """A case before it is solved.

    Attributes
    ----------
    tables : of rods, contacts, supports, loads and comparisons, those of which there are some
    size : unknowns of the rod model and of the 3D meshes, in a sentence
    warnings : a sentence each
    problem : why the solvers will refuse the scene; '' where nothing is known against it
    """

    tables: tuple[Table, ...]
    size: str
    warnings: tuple[str, ...]
    problem: str


def summary(case: Case) -> Summary:
    """Tables, size and warnings of a case."""
    scene, drawn = case.scene, undeformed(case.scene)
    tables = [
        Table(
            ("rod", "centre line", "length, mm", "section", "material", "elements", "shortest, longest, mm"),
            tuple(_rod(rod) for rod in scene.rods),
        ),
        Table(
            ("contact", "first face", "may touch", "zone, mm", "gap", "drawn"),
            tuple(_contact(scene, pair, drawn) for pair in scene.contacts),
        ),
        Table(("support", "of", "at, mm", "holds"), tuple(_supports(scene))),
        Table(("load", "on", "at, mm", "size (X, Y, Z)"), tuple(_load(load) for load in scene.loads)),
        Table(("compared", "of", "at (x, y, s), mm", "tolerance"), tuple(_check(check) for check in case.compare)),
    ]
    warnings, size, problem = list(_warnings(case, drawn)), "", ""
    try:
        warnings += _held_by_contact(scene)
        references = reference_unknowns(scene)
        size = _size(case, references)
        if references[-1] > LARGE:
            about = f"The finest 3D mesh has about {_round(references[-1])} unknowns"
            warnings.append(f"{about}: it takes minutes, and gigabytes of memory.")
    except SceneError as error:
        problem = str(error)
    return Summary(tuple(table for table in tables if table.rows), size, tuple(warnings), problem)


def _rod(rod: Rod) -> tuple[str, ...]:
    lengths = np.diff(rod.element_borders)
    return (
        rod.name,
        _line(rod),
        f"{rod.length:.6g}",
        described(rod.section),
        _material(rod.material),
        str(len(lengths)),
        f"{lengths.min():.4g}, {lengths.max():.4g}",
    )


def _line(rod: Rod) -> str:
    match rod.centre_line:
        case Line(twist=twist):
            return f"line, twisted by {np.degrees(twist):.4g}°" if twist else "line"
        case Helix(pitch=0.0) as arc:
            return f"arc of radius {arc.radius:.5g} mm, {np.degrees(arc.angle):.4g}°"
        case Helix() as helix:
            turns = f"{helix.angle / (2.0 * np.pi):.3g} turns"
            return f"helix of radius {helix.radius:.5g} mm, pitch {helix.pitch:.4g} mm, {turns}"
        case Spline() as spline:
            return f"spline through {len(spline.points)} points"
        case Path() as path:
            return f"path of {len(path.pieces)} pieces"


def _material(material: Material | Orthotropic) -> str:
    density = "" if material.density is None else f", {material.density * 1e12:.4g} kg/m³"
    if isinstance(material, Material):
        return f"E = {material.young_modulus / 1e3:.5g} GPa, ν = {material.poisson_ratio:g}{density}"
    moduli = ", ".join(f"{modulus / 1e3:.4g}" for modulus in material.young_moduli)
    return f"orthotropic, E = {moduli} GPa{density}"


def _contact(scene: Scene, pair: ContactPair, drawn: Quantities) -> tuple[str, ...]:
    distance = "" if isinstance(pair.second, Ground) else f"{_drawn_gap(scene, pair, pair.second, drawn)[0]:.4g} mm"
    return (
        pair.name,
        f"{pair.first.face} face of {pair.first.rod}",
        opposite(pair.second),
        f"{pair.zone[0]:g} to {pair.zone[1]:g}",
        gap(pair.gap),
        distance,
    )


def _drawn_gap(scene: Scene, pair: ContactPair, second: RodFace, drawn: Quantities) -> tuple[float, float]:
    """Least distance of the faces as drawn and as given, mm; to round-off of the scene's size."""
    _, distance, given = least_gap(scene, drawn, pair, second)
    size = max(rod.length for rod in scene.rods)
    return tuple(0.0 if abs(each) < 1e-9 * size else each for each in (distance, given))  # type: ignore[return-value]


def _supports(scene: Scene) -> Iterator[tuple[str, ...]]:
    for support in scene.supports:
        match support:
            case Clamp():
                at = 0.0 if support.end == "start" else scene.rod(support.rod).length
                moved = [f"moved by {_vector(support.displacement)} mm"] if any(support.displacement) else []
                moved += [f"turned by {_vector(support.rotation)} rad"] if any(support.rotation) else []
                yield "clamp", support.rod, f"{at:.6g}", ", ".join(["the whole section", *moved])
            case Support():
                held = ", ".join(support.components)
                given = f", set to {_vector(support.displacement)}" if support.displacement else ""
                yield support.of, support.rod, f"{support.position:.6g}", held + given
    for joint in scene.joints:
        yield "joint", ", ".join(f"{end.rod} ({end.end})" for end in joint.ends), "", "rigidly joined"
    for bed in scene.beds:
        where = f"{bed.start:g} to {bed.end:g}"
        yield "bed", bed.rod, where, f"{bed.face.face} face, {bed.modulus:g} N/mm³, pushes and pulls"


def _load(load: Load) -> tuple[str, ...]:
    match load:
        case SectionForce():
            return "force", load.rod, f"{load.position:.6g}", f"{_vector(load.force)} N"
        case SectionMoment():
            return "moment", load.rod, f"{load.position:.6g}", f"{_vector(load.moment)} N mm"
        case LineLoad():
            return "line load", load.rod, f"{load.start:.6g} to {load.end:.6g}", f"{_vector(load.force)} N/mm"
        case Pressure():
            at = f"{load.start:.6g} to {load.end:.6g}"
            return "pressure", f"{load.face.face} face of {load.rod}", at, f"{load.pressure:g} MPa"
        case Gravity():
            return "gravity", load.rod, "everywhere", f"{_vector(load.acceleration)} mm/s²"


def _vector(components: Sequence[float]) -> str:
    return "(" + ", ".join(f"{each:.5g}" for each in components) + ")"


def _check(check: Check) -> tuple[str, ...]:
    at = "" if check.point is None else _vector(check.point)
    return DEFINITIONS[check.quantity].title, check.of, at, measure(check.quantity, check.tolerance)


def _size(case: Case, references: Sequence[int]) -> str:
    meshes = ", ".join(_round(count) for count in references)
    level, order = grades(case.rod_model.level), grades(case.rod_model.order)
    rod = f"{_round(rod_unknowns(case))} in the rod model (h{level}, p = {order})"
    return f"Unknowns, about: {rod}; {meshes} in 3D on its three meshes."


def _round(count: int) -> str:
    """A count to two digits, in groups of three."""
    return f"{int(float(f'{count:.1e}')):,}".replace(",", " ")


def _held_by_contact(scene: Scene) -> list[str]:
    """A sentence on the rods that contact alone holds in some way, if there are any.

    Raises
    ------
    SceneError
        if nothing can hold a rod.
    """
    names = [name for loose in loose_rods(scene, scene_mirrors(scene)) for name in loose.rods]
    if not names:
        return []
    held = f"{', '.join(names)} {'is' if len(names) == 1 else 'are'} held by contact alone in some direction"
    return [f"{held}: there is an answer only where contact can balance the loads."]


def _warnings(case: Case, drawn: Quantities) -> Iterator[str]:
    scene = case.scene
    if not case.compare:
        yield "Nothing is compared: without [[compare]] there is no verdict."
    if not _driven(scene):
        yield "Nothing loads the rods: no load, moved support or interference that is not zero."
    for number, load in enumerate(scene.loads, 1):
        if _is_zero(load):
            yield f"Load {number}, on {load.rod}, is zero."
    thinnest = min(_height(rod) for rod in scene.rods)
    for pair in scene.contacts:
        if isinstance(pair.second, RodFace) and pair.gap != "drawn":
            distance, given = _drawn_gap(scene, pair, pair.second, drawn)
            if abs(distance - given) > DRAWN * thinnest:
                faces = f"the faces of {pair.name} are drawn {distance:.4g} mm apart, and a gap of {given:.4g} mm"
                yield f"{faces[0].upper()}{faces[1:]} is given: the given one counts."
    for rod in scene.rods:
        if rod.length < STOUT * _height(rod):
            times = rod.length / _height(rod)
            yield f"{rod.name} is only {times:.2g} section heights long: rod models of low level differ from 3D there."
    long = [each for rod in scene.rods for each in _long_at_clamps(scene, rod)]
    if long:
        better = "with short ones, such as 0.2 and 1 section heights, the rod model is more exact by some 0.1 %"
        yield f"Elements at clamps are longer than a section is high ({', '.join(long)}): {better}."


def _long_at_clamps(scene: Scene, rod: Rod) -> list[str]:
    """Elements at the clamps of a rod that are longer than its section is high, in words."""
    lengths = np.diff(rod.element_borders)
    ends = [support.end for support in scene.supports if isinstance(support, Clamp) and support.rod == rod.name]
    firsts = [(end, float(lengths[0 if end == "start" else -1])) for end in ends]
    return [f"{rod.name} {end}: {length:.4g} mm" for end, length in firsts if length > LONG_AT_CLAMP * _height(rod)]


def _height(rod: Rod) -> float:
    """Smallest extent of a rod's section along its axes, mm."""
    axes = (np.array([1.0, 0.0]), np.array([0.0, 1.0]))
    return min(section_reach(rod.section, axis) + section_reach(rod.section, -axis) for axis in axes)


def _is_zero(load: Load) -> bool:
    match load:
        case SectionForce() | LineLoad():
            return not any(load.force)
        case SectionMoment():
            return not any(load.moment)
        case Pressure():
            return load.pressure == 0.0
        case Gravity():
            return not any(load.acceleration)


def _driven(scene: Scene) -> bool:
    """Whether anything moves the rods."""
    if any(not _is_zero(load) for load in scene.loads):
        return True
    for support in scene.supports:
        given = (*support.displacement, *support.rotation) if isinstance(support, Clamp) else support.displacement
        if any(given):
            return True
    stations = [np.linspace(*pair.zone, 101) for pair in scene.contacts]
    return any(
        pair.gap == "drawn" or float(given_gap(pair.gap, station).min()) < 0.0
        for pair, station in zip(scene.contacts, stations, strict=True)
    )
