"""A scene from the side as SVG: rods, all that holds and loads them, candidate zones and places that matter, in mm."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from markupsafe import Markup, escape

from cases.polygon import depth
from cases.scene import COMPONENTS, Clamp, Gravity, Load, Material, Rod, RodFace, Scene, Support, given_gap, station_of
from reports import sketch_symbols as symbols
from reports.geometry import AXES, face_extent
from reports.quantities import Quantities, RodQuantities
from reports.sections import described, outline
from reports.solution import Array
from reports.view import (
    SPRINGS,
    between,
    face_normals,
    held_directions,
    load_arrows,
    view_plane,
)

MARGIN = 46.0
# Scenes are drawn this wide, and at most half as high, whatever their size; the text is made for it.
WIDTH = 500.0
# An arrow whose part in the plane of the drawing is less than this of its length is drawn end on.
END_ON = 0.3
# The largest gap to ground that is drawn.
FARTHEST = 40.0
# A rod that is seen slimmer than this has its name beside it.
LEAST_FOR_NAME = 11.0
# Half the height of a letter.
HALF_LETTER = 3.0
# Places nearer to each other than this have one tick.
ONE_TICK = 1.5
# Rows of numbers below the axis.
ROWS = 3
# Room below the foot of a text.
DESCENT = np.array([0.0, 3.0])


@dataclass(frozen=True)
class _Band:
    """A rod as it is seen: centre, unit tangent and normal along it, shape (2, n), and its border on either side."""

    centre: Array
    tangent: Array
    normal: Array
    left: Array
    right: Array

    @property
    def border(self) -> Array:
        """Corners around the band, shape (2, 2 n)."""
        return np.hstack([self.centre + self.right * self.normal, (self.centre + self.left * self.normal)[:, ::-1]])

    def covers(self, place: Array, margin: float = 0.0) -> bool:
        """Whether a place, shape (2,), lies within the band made broader by a margin all around."""
        corners = tuple((float(x), float(y)) for x, y in self.border.T)
        return depth(corners, (float(place[0]), float(place[1]))) > -margin


@dataclass(frozen=True)
class _Drawn:
    """Parts of the drawing, and points that it must have room for, shape (2,) each."""

    parts: list[str]
    room: list[Array]

    def add(self, parts: list[str], *room: Array) -> None:
        self.parts.extend(parts)
        self.room.extend(room)


def scene_sketch(scene: Scene, quantities: Quantities) -> Markup:
    """SVG of the scene in the plane of `view_plane`."""
    plane = view_plane(scene, quantities)
    across, upwards = np.ptp(plane @ np.hstack([rod.position for rod in quantities.rods]), axis=1)
    scale = WIDTH / max(float(across), 2.0 * float(upwards))
    bands = {rod.name: _band(rod, quantities.rod(rod.name), scale * plane) for rod in scene.rods}
    symbols_drawn = [_supports(scene, quantities, bands, scale * plane), _beds(scene, quantities, scale * plane)]
    symbols_drawn.append(_grounds(scene, quantities, scale * plane))
    symbols_drawn += [_load(load, scene.rod(load.rod), quantities.rod(load.rod), scale * plane) for load in scene.loads]
    points = np.hstack([band.border for band in bands.values()])
    low, high = points.min(axis=1), points.max(axis=1)
    room = [place for drawn in symbols_drawn for place in drawn.room]
    low = np.min([low, *(place + np.array([MARGIN - 6.0, 0.0]) for place in room)], axis=0)
    high[0] = max([high[0], *(place[0] - MARGIN + 6.0 for place in room)])
    base = float(-low[1]) + 12.0
    parts = [_bar(rod, bands[rod.name]) for rod in scene.rods]
    parts += _zones(scene, quantities, scale * plane)
    for drawn in symbols_drawn:
        parts += drawn.parts
    parts += _joints(scene, quantities, scale * plane)
    parts += _positions(scene, quantities, plane, scale, base)
    spare = max(0.0, WIDTH - float(high[0] - low[0])) / 2.0  # text keeps its size beside a slim scene
    left, top = low[0] - MARGIN - spare, -high[1] - 48.0
    width, height = high[0] - low[0] + 2 * (MARGIN + spare), base + 36.0 + 11.0 * (ROWS - 2) - top
    label = f"Side view of the scene {scene.name}: " + "; ".join(_described(rod) for rod in scene.rods)
    body = "".join(parts)
    return Markup(
        f'<svg class="sketch" role="img" aria-label="{escape(label)}" '
        f'viewBox="{left:.1f} {top:.1f} {width:.1f} {height:.1f}">{body}</svg>'
    )


def _named(rod: Rod) -> str:
    """A rod's name and its modulus along the rod."""
    material = rod.material
    modulus = material.young_modulus if isinstance(material, Material) else material.young_moduli[2]
    return f"{rod.name}, E = {modulus / 1000.0:.4g} GPa"


def _described(rod: Rod) -> str:
    return f"{_named(rod)}, {described(rod.section)}, {rod.length:g} mm long"


def _band(rod: Rod, found: RodQuantities, plane: Array) -> _Band:
    """The rod swept by its section's outline, seen in the plane of the drawing."""
    centre = plane @ found.position
    tangent = plane @ found.axes[:, 2].T
    length = np.linalg.norm(tangent, axis=0)
    # Where the rod is seen end on, any direction will do.
    end_on = length < 1e-6 * np.linalg.norm(plane[0])
    tangent = np.where(end_on, [[1.0], [0.0]], tangent / np.where(end_on, 1.0, length))
    normal = np.array([-tangent[1], tangent[0]])
    corners = np.einsum("xi,nai,ca->xnc", plane, found.axes[:, :2], outline(rod.section))
    reach = np.einsum("xnc,xn->nc", corners, normal)
    return _Band(centre, tangent, normal, reach.max(axis=1), reach.min(axis=1))


def _bar(rod: Rod, band: _Band) -> str:
    corners = " ".join(f"{x:.2f},{-y:.2f}" for x, y in band.border.T)
    text = _named(rod)
    (x, y), angle = _place_of_name(band, 0.5 * symbols.LETTER * len(text))
    turn = f' transform="rotate({-angle:.1f} {x:.1f} {-y:.1f})"' if angle else ""
    return (
        f'<polygon class="bar" points="{corners}"/>'
        f'<text class="name" x="{x:.1f}" y="{-y + 3.2:.1f}"{turn}>{escape(text)}</text>'
    )


def _place_of_name(band: _Band, half: float) -> tuple[Array, float]:
    """Where a text that reaches half to either side is put, and its angle, degrees.

    Along the rod in its middle; beside it where the rod is slim, and level where it bends away from the text.
    """
    middle = band.centre.shape[1] // 2
    centre, along, across = band.centre[:, middle], band.tangent[:, middle], band.normal[:, middle]
    along, across = (along, across) if along[0] > 1e-6 or abs(along[0]) <= 1e-6 < along[1] else (-along, -across)
    angle = float(np.degrees(np.arctan2(along[1], along[0])))
    left, right = band.left[middle], band.right[middle]
    if abs(left - right) < LEAST_FOR_NAME:
        quarter = band.centre[:, band.centre.shape[1] // 4]  # loads and zones are often in the middle
        return quarter + (0.5 * abs(left - right) + 6.0) * across, angle
    place = centre + 0.5 * (left + right) * band.normal[:, middle]
    inside = all(band.covers(place + end * along, -HALF_LETTER) for end in (-half, half))
    if inside or abs(along[0]) < 0.1:
        return place, angle
    between_ends = 0.5 * (band.centre[:, 0] + band.centre[:, -1])
    parts = between_ends + np.outer((-half, 0.0, half), (1.0, 0.0))
    clear = not any(band.covers(part, HALF_LETTER) for part in parts)
    return between_ends if clear else band.border.mean(axis=1), 0.0


def _zones(scene: Scene, quantities: Quantities, plane: Array) -> list[str]:
    """A heavy line on the first face along each candidate zone."""
    parts = []
    for pair in scene.contacts:
        face, _ = _on_face(scene, quantities, pair.first, np.array(pair.zone), plane)
        parts.append(symbols.line("zone", *face.T))
    return parts


def _on_face(scene: Scene, quantities: Quantities, face: RodFace, station: Array, plane: Array) -> tuple[Array, Array]:
    """Points in the middle of a face and the outward normals there, as they are seen, shape (2, n) each."""
    found = quantities.rod(face.rod)
    normal = face_normals(found, face.face, station)
    offset = face_extent(scene.rod(face.rod), face.face)[0] * normal
    return plane @ (between(found, found.position, station) + offset), plane @ normal / np.linalg.norm(plane[0])


def _supports(scene: Scene, quantities: Quantities, bands: dict[str, _Band], plane: Array) -> _Drawn:
    drawn = _Drawn([], [])
    for support in scene.supports:
        band = bands[support.rod]
        if isinstance(support, Clamp):
            index = 0 if support.end == "start" else -1
            outward = band.tangent[:, index] * (-1.0 if support.end == "start" else 1.0)
            across = (0.5 * (band.left[index] - band.right[index]) + 7.0) * band.normal[:, index]
            centre = band.centre[:, index] + 0.5 * (band.left[index] + band.right[index]) * band.normal[:, index]
            ends = (centre + 8.0 * outward - across, centre + 8.0 * outward + across)
            drawn.add(symbols.wall(centre, outward, across), *ends)
            if any(support.displacement) or any(support.rotation):
                sideways = abs(outward[0]) > abs(outward[1])
                beside = np.array([0.0, -float(np.linalg.norm(across)) - 10.0]) if sideways else 12.0 * outward
                place = centre + 4.0 * outward + beside
                drawn.add([symbols.text("tick", place, "moved")], place - DESCENT)
        else:
            others = [other for name, other in bands.items() if name != support.rod]
            rod, found = scene.rod(support.rod), quantities.rod(support.rod)
            parts, room = _component_support(support, rod, found, band, others, plane)
            drawn.add(parts, *room)
    return drawn


def _component_support(
    support: Support, rod: Rod, found: RodQuantities, band: _Band, others: Sequence[_Band], plane: Array
) -> tuple[list[str], list[Array]]:
    """A pin, a roller, or a square where it holds along the view alone; its components in words; where that ends.

    It stands below the rod, or on it where it would cover another one.
    """
    index = int(np.argmin(np.abs(found.station - support.position)))
    scale = float(np.linalg.norm(plane[0]))
    moves, turns = held_directions(support, found)
    seen = plane @ moves / scale
    seen = seen[:, np.linalg.norm(seen, axis=0) > END_ON]
    upright = bool((np.abs(np.cross(*plane) / scale**2 @ turns) > END_ON).any())
    centre, tangent, normal = band.centre[:, index], band.tangent[:, index], band.normal[:, index]
    down = -1.0 if normal[1] > 0.0 or (normal[1] == 0.0 and normal[0] > 0.0) else 1.0
    sides = [(down * normal, band.left[index] if down > 0.0 else band.right[index])]
    sides.append((-down * normal, band.right[index] if down > 0.0 else band.left[index]))
    middles = [centre + reach * normal + 0.5 * symbols.SUPPORT * side for side, reach in sides]
    covers = [any(other.covers(middle, 0.3 * symbols.SUPPORT) for other in others) for middle in middles]
    outward, reach = sides[1 if covers[0] and not covers[1] else 0]
    apex = centre + reach * normal
    pinned = np.linalg.matrix_rank(seen, tol=END_ON) > 1
    if seen.shape[1] and not pinned and abs(seen[:, 0] @ tangent) > abs(seen[:, 0] @ normal):
        at_end = index in (0, len(found.station) - 1)
        outward = tangent if support.position > 0.5 * rod.length else -tangent
        apex = centre if at_end else apex
    kind = "mean " if support.of == "mean" else ""
    held = "motion" if len(support.components) == len(COMPONENTS) else ", ".join(support.components)
    words = kind + held + (" moved" if any(support.displacement) else "")
    if seen.shape[1]:
        parts = symbols.support(apex, outward, rollers=not pinned, upright=upright)
        end = apex + symbols.SUPPORT * outward
    else:
        parts, end = [symbols.held_end_on(apex + 4.0 * outward)], apex + 8.0 * outward
    half = 0.5 * symbols.LETTER * len(words)
    if abs(outward[0]) > abs(outward[1]):
        place = end + np.array([np.sign(outward[0]) * half, -17.0 if seen.shape[1] else -3.0])
    else:
        place = end + (10.0 if outward[1] < 0.0 else 4.0) * outward
    reach = np.array([half, 0.0])
    return [*parts, symbols.text("tick", place, words)], [place - DESCENT - reach, place - DESCENT + reach]


def _beds(scene: Scene, quantities: Quantities, plane: Array) -> _Drawn:
    """Springs along the face to hatched ground, and the modulus."""
    drawn = _Drawn([], [])
    for bed in scene.beds:
        station = np.linspace(bed.start, bed.end, SPRINGS)
        face, normal = _on_face(scene, quantities, bed.face, station, plane)
        flat = np.linalg.norm(normal, axis=0)
        words = f"{bed.modulus:g} N/mm³"
        if flat.min() < END_ON:
            place = face[:, SPRINGS // 2] - np.array([0.0, 14.0])
            drawn.add([*symbols.bed_end_on(face), symbols.text("tick", place, words)], place)
        else:
            outward = normal / flat
            # A spring off the middle, so that the text does not stand where a load in the middle is drawn.
            place = (face + symbols.BED * outward)[:, SPRINGS // 4]
            place = place + (10.0 if outward[1, SPRINGS // 4] < 0.0 else 4.0) * outward[:, SPRINGS // 4]
            drawn.add([*symbols.bed(face, outward), symbols.text("tick", place, words)], place - DESCENT)
    return drawn


def _grounds(scene: Scene, quantities: Quantities, plane: Array) -> _Drawn:
    """A hatched line for rigid ground, springs and their modulus for a bed, at the gap from the face.

    What is farther away than there is room for is drawn nearer.
    """
    drawn = _Drawn([], [])
    for pair in scene.contacts:
        if isinstance(pair.second, RodFace) or pair.gap == "drawn":
            continue
        station = np.linspace(*pair.zone, SPRINGS)
        face, normal = _on_face(scene, quantities, pair.first, station, plane)
        flat = np.linalg.norm(normal, axis=0)
        modulus = pair.second.modulus
        if flat.min() < END_ON:
            drawn.add(symbols.bed_end_on(face))
            continue
        outward = normal / flat
        surface = face + np.minimum(given_gap(pair.gap, station) * np.linalg.norm(plane[0]), FARTHEST) * outward
        if modulus is None:
            drawn.add(symbols.ground(surface, outward), *(surface + 6.0 * outward).T)
            continue
        place = (surface + symbols.BED * outward)[:, SPRINGS // 4]
        place = place + (10.0 if outward[1, SPRINGS // 4] < 0.0 else 4.0) * outward[:, SPRINGS // 4]
        words = symbols.text("tick", place, f"{modulus:g} N/mm³")
        drawn.add([*symbols.bed(surface, outward), words], place - DESCENT, *(surface + symbols.BED * outward).T)
    return drawn


def _joints(scene: Scene, quantities: Quantities, plane: Array) -> list[str]:
    """A dot where rods are joined."""
    places = [(quantities.rod(joint.ends[0].rod), joint.ends[0].end) for joint in scene.joints]
    return [symbols.dot(plane @ rod.position[:, 0 if end == "start" else -1], 4.5) for rod, end in places]


def _load(load: Load, rod: Rod, found: RodQuantities, plane: Array) -> _Drawn:
    """Arrows of a load; a turning arrow for a moment; a ringed dot or cross for what points out of or into the page."""
    arrows = load_arrows(load, found)
    drawn = _Drawn([], [])
    if len(arrows.station) == 0:
        return drawn
    scale = float(np.linalg.norm(plane[0]))
    seen = plane @ arrows.direction / scale
    flat = np.linalg.norm(seen, axis=0)
    towards = np.cross(*plane) / scale**2 @ arrows.direction
    places = plane @ arrows.place
    ends = places.copy()
    pulling = arrows.pulling or _pulls_an_end(rod, found, arrows.station[0], arrows.direction[:, 0])
    for index, place in enumerate(places.T):
        if arrows.turning and abs(towards[index]) > flat[index]:
            drawn.add(symbols.turning(place, towards[index] > 0.0))
        elif flat[index] < END_ON:
            drawn.add(symbols.end_on(place, towards[index] > 0.0))
        else:
            direction = seen[:, index] / flat[index]
            side = direction if pulling else -direction
            surface = place + _reach(found, outline(rod.section), plane, arrows.station[index], side) * side
            far = surface + symbols.ARROW * side
            tip = far if pulling else surface
            drawn.add(symbols.arrow(tip, direction, double=arrows.turning))
            ends[:, index] = far
    middle = ends.shape[1] // 2
    level = flat[middle] >= END_ON and abs(seen[0, middle]) > abs(seen[1, middle])
    if level:
        middle = int(ends[1].argmax())
    x, y = ends[:, middle]
    width = symbols.LETTER * len(arrows.text)
    if level:
        words = np.array([x, y + 6.0])
    elif ends.shape[1] > 1:  # beyond the ends of the arrows, between which there may be no room
        words = np.array([x - 0.5 * width, y + 5.0 if y > places[1, middle] else y - 11.0])
    else:
        words = np.array([x + 9.0, y if pulling else y - 8.0])
    drawn.add([symbols.text("load", words, arrows.text)], *ends.T, words, words + np.array([width, 0.0]))
    return drawn


def _pulls_an_end(rod: Rod, found: RodQuantities, station: float, direction: Array) -> bool:
    """Whether a load on an end of a rod points away from it: drawn before it, the arrow would cover the rod."""
    outward = {0.0: -found.axes[0, 2], rod.length: found.axes[-1, 2]}.get(float(station))
    return outward is not None and float(outward @ direction) > 1.0 - END_ON


def _reach(found: RodQuantities, corners: Array, plane: Array, station: float, side: Array) -> float:
    """How far the rod's section at a station reaches along a direction of the drawing."""
    axes = found.axes[int(np.argmin(np.abs(found.station - station)))]
    return float(np.max(side @ plane @ axes[:2].T @ corners.T))


def _positions(scene: Scene, quantities: Quantities, plane: Array, scale: float, base: float) -> list[str]:
    """Ticks at ends of rods, zones and beds, loads and supports, where the sketch shows a global axis level.

    Numbers that would cover one before stand a row lower.
    """
    axis = int(np.argmax(np.abs(plane[0])))
    if abs(plane[0, axis]) < 1.0 - 1e-9:
        return []
    places = [rod.position[:, end] for rod in quantities.rods for end in (0, -1)]
    for load in scene.loads:
        if not isinstance(load, Gravity):
            marked = load_arrows(load, quantities.rod(load.rod)).place
            places += [*marked[:, :1].T, *marked[:, -1:].T]
    held = [(support.rod, station_of(support, scene.rod(support.rod))) for support in scene.supports]
    held += [(bed.rod, station) for bed in scene.beds for station in (bed.start, bed.end)]
    for name, station in held:
        found = quantities.rod(name)
        places += list(between(found, found.position, np.array([station])).T)
    for pair in scene.contacts:
        found = quantities.rod(pair.first.rod)
        places += list(between(found, found.position, np.array(pair.zone)).T)
    marks = _merged(
        sorted({(round(scale * float(plane[0] @ place), 6), round(float(place[axis]), 6)) for place in places})
    )
    first, last = marks[0][0], marks[-1][0]
    parts = [f'<line class="axis" x1="{first}" y1="{base:.1f}" x2="{last}" y2="{base:.1f}"/>']
    taken = [-np.inf] * ROWS
    for x, label in marks:
        half = 0.5 * symbols.LETTER * len(f"{label:g}")
        row = next((row for row in range(ROWS) if x - half > taken[row]), int(np.argmin(taken)))
        taken[row] = x + half + 3.0
        parts.append(f'<line class="axis" x1="{x}" y1="{base - 3:.1f}" x2="{x}" y2="{base + 3:.1f}"/>')
        parts.append(f'<text class="tick" x="{x}" y="{base + 14 + 11 * row:.1f}">{label:g}</text>')
    parts.append(f'<text class="tick" x="{last + 28:.1f}" y="{base + 3:.1f}">{AXES[axis]}, mm</text>')
    return parts


def _merged(marks: list[tuple[float, float]]) -> list[tuple[float, float]]:
    """Marks along the axis, of those at all but one place that with the shortest number."""
    kept = marks[:1]
    for mark in marks[1:]:
        if mark[0] - kept[-1][0] > ONE_TICK:
            kept.append(mark)
        elif len(f"{mark[1]:g}") < len(f"{kept[-1][1]:g}"):
            kept[-1] = mark
    return kept
