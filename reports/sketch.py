"""A side view of a scene as SVG: bars, clamps, loads, candidate zones and the positions that matter, in mm."""

from __future__ import annotations

import numpy as np
from markupsafe import Markup, escape

from cases.scene import Rod, Scene
from reports.geometry import AXES, centre_line_points, frame
from reports.solution import Array

MARGIN = 46.0


def scene_sketch(scene: Scene) -> Markup:
    """SVG of the scene, seen along -e1 of its first rod: its tangent to the right, its e2 up."""
    _, up, right = frame(scene.rods[0])
    plane = np.array([right, up])
    outlines = [_outline(rod, plane) for rod in scene.rods]
    points = np.hstack(outlines)
    low, high = points.min(axis=1), points.max(axis=1)
    base = float(-low[1]) + 12.0
    parts = [_bar(rod, outline) for rod, outline in zip(scene.rods, outlines, strict=True)]
    parts += _zones(scene, plane)
    parts += _clamps(scene, plane)
    parts += _loads(scene, plane)
    parts += _positions(scene, plane, base)
    left, top = low[0] - MARGIN, -high[1] - 48.0
    width, height = high[0] - low[0] + 2 * MARGIN, base + 30.0 - top
    label = f"Side view of the scene {scene.name}: " + "; ".join(_described(rod) for rod in scene.rods)
    body = "".join(parts)
    return Markup(
        f'<svg class="sketch" role="img" aria-label="{escape(label)}" '
        f'viewBox="{left:.1f} {top:.1f} {width:.1f} {height:.1f}">{body}</svg>'
    )


def _described(rod: Rod) -> str:
    section, modulus = rod.section, rod.material.young_modulus / 1000.0
    return f"{rod.name}, E = {modulus:g} GPa, {section.width:g} x {section.height:g} mm, {rod.length:g} mm long"


def _outline(rod: Rod, plane: Array) -> Array:
    """Corners of a bar's side in the plane of the drawing, shape (2, 4)."""
    half = 0.5 * rod.section.height * frame(rod)[1][:, None]
    start, end = centre_line_points(rod, np.array([0.0, rod.length])).T[:, :, None]
    outline: Array = plane @ np.hstack([start - half, end - half, end + half, start + half])
    return outline


def _bar(rod: Rod, outline: Array) -> str:
    corners = " ".join(f"{x:.2f},{-y:.2f}" for x, y in outline.T)
    x, y = outline.mean(axis=1)
    text = f"{rod.name}, E = {rod.material.young_modulus / 1000.0:g} GPa"
    return (
        f'<polygon class="bar" points="{corners}"/>'
        f'<text class="name" x="{x:.1f}" y="{-y + 3.2:.1f}">{escape(text)}</text>'
    )


def _zones(scene: Scene, plane: Array) -> list[str]:
    """A heavy line on the first face along each candidate zone."""
    parts = []
    for pair in scene.contacts:
        rod = scene.rod(pair.first.rod)
        first, second, _ = frame(rod)
        sides = {"top": second, "bottom": -second, "right": first, "left": -first}
        across = rod.section.height if pair.first.face in ("top", "bottom") else rod.section.width
        face = centre_line_points(rod, np.array(pair.zone)) + 0.5 * across * sides[pair.first.face][:, None]
        (x0, x1), (y0, y1) = plane @ face
        parts.append(f'<line class="zone" x1="{x0:.2f}" y1="{-y0:.2f}" x2="{x1:.2f}" y2="{-y1:.2f}"/>')
    return parts


def _clamps(scene: Scene, plane: Array) -> list[str]:
    parts = []
    for clamp in scene.supports:
        rod = scene.rod(clamp.rod)
        outward = plane @ frame(rod)[2] * (-1.0 if clamp.end == "start" else 1.0)
        across = plane @ frame(rod)[1] * 0.9 * rod.section.height
        end = rod.centre_line.start if clamp.end == "start" else rod.centre_line.end
        centre = plane @ np.asarray(end)
        for share in np.linspace(-1.0, 1.0, 7):
            foot = centre + share * across
            tip = foot + 6.0 * outward - 4.0 * across / np.linalg.norm(across)
            parts.append(_line("hatch", foot, tip))
        parts.append(_line("wall", centre - across, centre + across))
    return parts


def _loads(scene: Scene, plane: Array) -> list[str]:
    parts = []
    for load in scene.loads:
        rod = scene.rod(load.rod)
        force = plane @ np.asarray(load.force)
        size = float(np.linalg.norm(force))
        if size == 0.0:
            continue
        direction = force / size
        centre = (plane @ centre_line_points(rod, np.array([load.position])))[:, 0]
        tip = centre - 0.5 * rod.section.height * direction
        tail = tip - 34.0 * direction
        side = np.array([-direction[1], direction[0]])
        head = [tip, tip - 10.0 * direction + 3.6 * side, tip - 10.0 * direction - 3.6 * side]
        corners = " ".join(f"{x:.2f},{-y:.2f}" for x, y in head)
        x, y = tail + 9.0 * np.array([1.0, 0.0])
        parts.append(_line("force", tail, tip - 9.0 * direction))
        parts.append(f'<polygon class="force-head" points="{corners}"/>')
        amount = float(np.linalg.norm(load.force))
        parts.append(f'<text class="load" x="{x:.1f}" y="{-y + 8:.1f}">{amount:g} N</text>')
    return parts


def _positions(scene: Scene, plane: Array, base: float) -> list[str]:
    """Ticks at rod ends, loads and zone ends, labelled with the global coordinate along the first rod."""
    rods = scene.rods
    places = [end for rod in rods for end in centre_line_points(rod, np.array([0.0, rod.length])).T]
    places += [centre_line_points(scene.rod(load.rod), np.array([load.position]))[:, 0] for load in scene.loads]
    places += [
        point
        for pair in scene.contacts
        for point in centre_line_points(scene.rod(pair.first.rod), np.array(pair.zone)).T
    ]
    axis = int(np.argmax(np.abs(frame(rods[0])[2])))
    marks = sorted({(round(float((plane @ place)[0]), 6), round(float(place[axis]), 6)) for place in places})
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
