"""A scene from the side as SVG: rods, clamps, loads, candidate zones and the positions that matter, in mm."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from markupsafe import Markup, escape

from cases.scene import Load, Material, Rod, Scene, SectionMoment
from reports.geometry import AXES
from reports.quantities import Quantities, RodQuantities
from reports.sections import described, outline
from reports.solution import Array
from reports.view import between, load_places, load_text, load_vector, view_plane

MARGIN = 46.0
# Scenes are drawn this wide, and at most half as high, whatever their size; the text is made for it.
WIDTH = 500.0
ARROW = 34.0
# An arrow whose part in the plane of the drawing is less than this of its length is drawn end on.
END_ON = 0.3


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


def scene_sketch(scene: Scene, quantities: Quantities) -> Markup:
    """SVG of the scene in the plane of `view_plane`."""
    plane = view_plane(scene, quantities)
    across, upwards = np.ptp(plane @ np.hstack([rod.position for rod in quantities.rods]), axis=1)
    scale = WIDTH / max(float(across), 2.0 * float(upwards))
    bands = {rod.name: _band(rod, quantities.rod(rod.name), scale * plane) for rod in scene.rods}
    points = np.hstack([band.border for band in bands.values()])
    low, high = points.min(axis=1), points.max(axis=1)
    for load in scene.loads:
        tails = _tails(load, quantities.rod(load.rod), outline(scene.rod(load.rod).section), scale * plane)
        low[1] = min(low[1], tails[1].min())
    base = float(-low[1]) + 12.0
    parts = [_bar(rod, bands[rod.name]) for rod in scene.rods]
    parts += _zones(scene, quantities, scale * plane)
    parts += _clamps(scene, bands)
    for load in scene.loads:
        parts += _load(load, scene.rod(load.rod), quantities.rod(load.rod), scale * plane)
    parts += _positions(scene, quantities, plane, scale, base)
    spare = max(0.0, WIDTH - float(high[0] - low[0])) / 2.0  # text keeps its size beside a slim scene
    left, top = low[0] - MARGIN - spare, -high[1] - 48.0
    width, height = high[0] - low[0] + 2 * (MARGIN + spare), base + 30.0 - top
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
    return f"{rod.name}, E = {modulus / 1000.0:g} GPa"


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
    x, y = band.border.mean(axis=1)
    text = _named(rod)
    return (
        f'<polygon class="bar" points="{corners}"/>'
        f'<text class="name" x="{x:.1f}" y="{-y + 3.2:.1f}">{escape(text)}</text>'
    )


def _zones(scene: Scene, quantities: Quantities, plane: Array) -> list[str]:
    """A heavy line on the first face along each candidate zone."""
    parts = []
    for pair in scene.contacts:
        found = quantities.rod(pair.first.rod)
        axis, side = {"top": (1, 1.0), "bottom": (1, -1.0), "right": (0, 1.0), "left": (0, -1.0)}[pair.first.face]
        offset = outline(scene.rod(pair.first.rod).section)[:, axis].max() * side * found.axes[0, axis]
        start, end = (plane @ (between(found, found.position, np.array(pair.zone)) + offset[:, None])).T
        parts.append(_line("zone", start, end))
    return parts


def _clamps(scene: Scene, bands: dict[str, _Band]) -> list[str]:
    parts = []
    for clamp in scene.supports:
        band, index = bands[clamp.rod], 0 if clamp.end == "start" else -1
        outward = band.tangent[:, index] * (-1.0 if clamp.end == "start" else 1.0)
        across = 0.9 * (band.left[index] - band.right[index]) * band.normal[:, index]
        centre = band.centre[:, index]
        for share in np.linspace(-1.0, 1.0, 7):
            foot = centre + share * across
            tip = foot + 6.0 * outward - 4.0 * across / np.linalg.norm(across)
            parts.append(_line("hatch", foot, tip))
        parts.append(_line("wall", centre - across, centre + across))
    return parts


def _load(load: Load, rod: Rod, found: RodQuantities, plane: Array) -> list[str]:
    """Arrows of a load; a turning arrow for a moment; a ringed dot or cross for what points out of or into the page."""
    vector = load_vector(load)
    size = float(np.linalg.norm(vector))
    if size == 0.0:
        return []
    vector /= size
    scale = float(np.linalg.norm(plane[0]))
    seen = plane @ vector / scale
    towards = float(np.cross(plane[0], plane[1]) @ vector) / scale**2
    flat = float(np.linalg.norm(seen))
    middle = load_places(load, found)
    parts = []
    for place in (plane @ middle).T:
        if isinstance(load, SectionMoment) and abs(towards) > flat:
            parts += _turning(place, towards > 0.0)
        elif flat < END_ON:
            parts += _end_on(place, towards > 0.0)
        else:
            direction = seen / flat
            reach = float(_reach(found, outline(rod.section), plane, place[:, None], direction)[0])
            tip = place - reach * direction
            parts += _arrow(tip, direction, double=isinstance(load, SectionMoment))
    x, y = _tails(load, found, outline(rod.section), plane)[:, len(middle.T) // 2]
    x, y = (x, y + 6.0) if flat >= END_ON and abs(seen[0]) > abs(seen[1]) else (x + 9.0, y - 8.0)
    parts.append(f'<text class="load" x="{x:.1f}" y="{-y:.1f}">{load_text(load)}</text>')
    return parts


def _tails(load: Load, found: RodQuantities, corners: Array, plane: Array) -> Array:
    """Where the arrows of a load begin; at its places where it is drawn end on; shape (2, n)."""
    places = plane @ load_places(load, found)
    seen = plane @ load_vector(load)
    flat = float(np.linalg.norm(seen))
    if flat < END_ON * float(np.linalg.norm(load_vector(load)) * np.linalg.norm(plane[0])) or flat == 0.0:
        return places
    return places - np.outer(seen / flat, _reach(found, corners, plane, places, seen / flat) + ARROW)


def _reach(found: RodQuantities, corners: Array, plane: Array, places: Array, direction: Array) -> Array:
    """How far the rod's sections at some places reach along a direction of the drawing, shape (n,)."""
    centre = plane @ found.position
    nearest = np.abs(centre[:, None, :] - places[:, :, None]).sum(axis=0).argmin(axis=1)
    offsets = np.einsum("xi,nai,ca->xnc", plane, found.axes[nearest][:, :2], corners)
    reach: Array = np.einsum("xnc,x->nc", offsets, direction).max(axis=1)
    return reach


def _arrow(tip: Array, direction: Array, *, double: bool) -> list[str]:
    """A straight arrow; with two heads for a moment about its direction."""
    parts = [_line("force", tip - ARROW * direction, tip - 9.0 * direction)]
    side = np.array([-direction[1], direction[0]])
    for point in (tip, tip - 8.0 * direction)[: 2 if double else 1]:
        head = [point, point - 10.0 * direction + 3.6 * side, point - 10.0 * direction - 3.6 * side]
        corners = " ".join(f"{x:.2f},{-y:.2f}" for x, y in head)
        parts.append(f'<polygon class="force-head" points="{corners}"/>')
    return parts


def _turning(centre: Array, anticlockwise: bool) -> list[str]:
    """Three quarters of a circle with a head."""
    sense = 1.0 if anticlockwise else -1.0
    angle = np.linspace(0.25, 1.6, 25) * np.pi * sense
    x, y = centre[:, None] + 15.0 * np.array([np.cos(angle), np.sin(angle)])
    path = " ".join(f"{a:.2f},{-b:.2f}" for a, b in zip(x, y, strict=True))
    direction = sense * np.array([-np.sin(angle[-1]), np.cos(angle[-1])])
    head = _arrow(np.array([x[-1], y[-1]]) + 6.0 * direction, direction, double=False)[1:]
    return [f'<polyline class="force" fill="none" points="{path}"/>', *head]


def _end_on(centre: Array, towards: bool) -> list[str]:
    """A ring with a dot (out of the page) or a cross (into it)."""
    x, y = centre
    ring = f'<circle class="force" fill="none" cx="{x:.2f}" cy="{-y:.2f}" r="6"/>'
    if towards:
        return [ring, f'<circle class="force-head" cx="{x:.2f}" cy="{-y:.2f}" r="2"/>']
    arm = 6.0 / np.sqrt(2.0) * np.array([[1.0, 1.0], [1.0, -1.0]])
    return [ring, *(_line("force", centre - each, centre + each) for each in arm)]


def _positions(scene: Scene, quantities: Quantities, plane: Array, scale: float, base: float) -> list[str]:
    """Ticks at rod ends, loads and zone ends, where the sketch shows a global axis level."""
    axis = int(np.argmax(np.abs(plane[0])))
    if abs(plane[0, axis]) < 1.0 - 1e-9:
        return []
    places = [rod.position[:, end] for rod in quantities.rods for end in (0, -1)]
    places += [place for load in scene.loads for place in load_places(load, quantities.rod(load.rod)).T[[0, -1]]]
    for pair in scene.contacts:
        found = quantities.rod(pair.first.rod)
        places += list(between(found, found.position, np.array(pair.zone)).T)
    marks = sorted({(round(scale * float(plane[0] @ place), 6), round(float(place[axis]), 6)) for place in places})
    first, last = marks[0][0], marks[-1][0]
    parts = [f'<line class="axis" x1="{first}" y1="{base:.1f}" x2="{last}" y2="{base:.1f}"/>']
    for x, label in marks:
        parts.append(f'<line class="axis" x1="{x}" y1="{base - 3:.1f}" x2="{x}" y2="{base + 3:.1f}"/>')
        parts.append(f'<text class="tick" x="{x}" y="{base + 14:.1f}">{label:g}</text>')
    parts.append(f'<text class="tick" x="{last + 28:.1f}" y="{base + 3:.1f}">{AXES[axis]}, mm</text>')
    return parts


def _line(kind: str, start: Array, end: Array) -> str:
    (x1, y1), (x2, y2) = start, end
    return f'<line class="{kind}" x1="{x1:.2f}" y1="{-y1:.2f}" x2="{x2:.2f}" y2="{-y2:.2f}"/>'
