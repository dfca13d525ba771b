"""From the tables of a case file to a `Case`: a scene, and what its results are held against in their units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

from cases.case import QUANTITIES, Case, Check, Grades, Published, Quantity, RodModelSettings
from cases.polygon import depth
from cases.rods import not_beyond_end, require_on_rod
from cases.scene import Box, Circle, Polygon, Rectangle, Ring, Rod, Scene, SceneError, Section, Vector
from cases.scene_building import require_found, require_known, scene_from
from cases.schema import CaseFile, CompareTable, PublishedTable
from cases.units import UnitError, to_unit
from cases.wording import listed, shown


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
    scene = scene_from(name, file)
    compare = tuple(_check(f"compare #{i}", table, scene) for i, table in enumerate(file.compare, 1))
    published = tuple(_published(f"published #{i}", table, scene) for i, table in enumerate(file.published, 1))
    for index, check in enumerate(compare):
        twice = any((check.quantity, check.of, check.point) == (c.quantity, c.of, c.point) for c in compare[:index])
        require_found(not twice, f"compare #{index + 1}", f"{check.quantity} of {check.of} again", "compare it once")
    independent = None
    if file.independent is not None:
        truths = sorted(path.name for path in truth.glob("*.json"))
        remedy = f"the files in cases/truth are {listed(truths)}"
        require_found(file.independent in truths, "independent", file.independent, remedy)
        independent = truth / file.independent
    settings = RodModelSettings(
        _grades("level", file.rod_model.level, file.rod_model.levels, scene),
        _grades("order", file.rod_model.order, file.rod_model.orders, scene),
    )
    return Case(name, file.title, file.description.strip(), scene, settings, compare, published, independent)


def _grades(kind: str, usual: int, by_rod: Mapping[str, int | tuple[int, ...]], scene: Scene) -> Grades:
    """The level or order of every element: one number, or where rods have their own, by rod one for each element."""
    if not by_rod:
        return usual
    for name in by_rod:
        require_known(name, [rod.name for rod in scene.rods], f"rod_model.{kind}s.{name}", "rods")
    found = {}
    for rod in scene.rods:
        count = len(rod.element_borders) - 1
        given = by_rod.get(rod.name, usual)
        found[rod.name] = (given,) * count if isinstance(given, int) else given
        remedy = f"give one for each element; rod '{rod.name}' has {count}"
        key = f"rod_model.{kind}s.{rod.name}"
        require_found(len(found[rod.name]) == count, key, found[rod.name], remedy)
    return found


def _of(key: str, table: CompareTable | PublishedTable, scene: Scene) -> str:
    """Name of the rod or contact pair that a quantity belongs to."""
    wanted = QUANTITIES[table.quantity].of
    other = "contact" if wanted == "rod" else "rod"
    require_found(
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
    require_known(name, known, f"{key}.{wanted}", f"{wanted}s")
    return str(name)


def _tolerance(key: str, quantity: Quantity, text: str) -> float:
    relative = QUANTITIES[quantity].relative
    form = 'relative, as in "0.1 %"' if relative else 'a length, as in "1 mm"'
    remedy = f"the tolerance of {quantity} is {form}"
    try:
        tolerance = to_unit(text, "%" if relative else "mm")
    except UnitError as error:
        raise SceneError(f"{key}.tolerance", shown(text), remedy) from error
    require_found(tolerance > 0.0, f"{key}.tolerance", text, "a tolerance must be positive")
    return tolerance


def _check(key: str, table: CompareTable, scene: Scene) -> Check:
    comparable = [name for name, kind in QUANTITIES.items() if kind.comparable]
    remedy = f"it does not converge in 3D; compare one of {listed(comparable)}"
    require_found(table.quantity in comparable, f"{key}.quantity", table.quantity, remedy)
    of = _of(key, table, scene)
    if table.quantity == "stress_s":
        if table.point is None:
            raise SceneError(f"{key}.point", "no such key", "needed: the point [x, y, s] where the stress is compared")
        _require_inside(f"{key}.point", table.point, scene.rod(of))
    else:
        require_found(table.point is None, f"{key}.point", table.point, "only stress_s is at a point")
    return Check(table.quantity, of, _tolerance(key, table.quantity, table.tolerance), table.point)


def _require_inside(key: str, point: Vector, rod: Rod) -> None:
    x, y, s = point
    inside, limits = _inside_section(rod.section, x, y)
    remedy = f"in rod '{rod.name}' {limits} and s from 0 to {rod.length:g} mm"
    require_found(inside and 0.0 <= s <= rod.length, key, list(point), remedy)


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
    require_found(
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
        require_found(len(value) > 0 and len(value) % 2 == 0 and rising, f"{key}.value", table.value, remedy)
    else:
        require_found(len(value) == 1, f"{key}.value", table.value, "one value is needed")
    tolerance = _tolerance(key, table.quantity, table.tolerance)
    found = Published(table.quantity, of, value, tolerance, table.source, table.position, table.axis)
    for name, given in (("position", table.position), ("axis", table.axis)):
        if table.quantity != "deflection":
            require_found(given is None, f"{key}.{name}", given, "only a deflection has a place and a direction")
        elif given is None:
            raise SceneError(f"{key}.{name}", "no such key", "say where on the rod, and along which axis")
    if table.quantity == "deflection":
        found = not_beyond_end(found, scene.rod(of))
    if found.position is not None:
        require_on_rod(found.position, scene.rod(of), f"{key}.position")
    return found
