"""A 3D picture of the deformed bars, drawn by pyvista off screen from the centre lines' displacement.

Sections are drawn plane and turned with the centre line, which is all that a picture needs; the colour is the
length of the centre line's displacement.
"""

from __future__ import annotations

import io
from dataclasses import dataclass
from typing import Any

import numpy as np
import pyvista

from cases.scene import Clamp, ContactPair, Polygon, Rod, RodFace, Scene, given_gap
from reports.geometry import face_extent
from reports.quantities import Quantities, RodQuantities
from reports.sections import outline
from reports.solution import Array
from reports.view import (
    SPRINGS,
    between,
    drawn_shifts,
    extent,
    face_normals,
    held_directions,
    load_arrows,
    magnification,
    round_below,
    view_plane,
)

SIZE = (1800, 700)
INK = "#1f2933"
HOLD = "#b8c0c8"
# Rods before they are solved, one after the other, and the borders of where they may touch.
COLOURS = ("#7fa8d1", "#e0b06c", "#8fbf9a", "#c79ac2", "#d1908a", "#9aa7b5")
ZONE = "#b3261e"


@dataclass(frozen=True)
class Picture:
    """A PNG image and what must be said beside it.

    Attributes
    ----------
    magnification : factor by which displacements and gaps are drawn larger
    """

    png: bytes
    magnification: float


def deformed_surface(rod: Rod, quantities: RodQuantities, factor: float, shift: Array) -> Array:
    """Corners of the outlines of the rod's sections after deformation, global, mm, shape (3, n, corners).

    Parameters
    ----------
    factor : magnification of the displacement
    shift : added to every point, mm, shape (3,)
    """
    offset = np.einsum("nai,ca->inc", quantities.axes[:, :2], outline(rod.section))
    slope = np.gradient(quantities.displacement, quantities.station, axis=1, edge_order=2)
    # a section turned by theta = t x u' moves its points by theta x offset = -(u' . offset) t
    turned = -quantities.axes[:, 2].T[:, :, None] * np.einsum("in,inc->nc", slope, offset)
    moved = quantities.position + factor * quantities.displacement + shift[:, None]
    corners: Array = moved[:, :, None] + offset + factor * turned
    return corners


def draw(scene: Scene, quantities: Quantities) -> Picture:
    """Draw the deformed bars, their undeformed outlines, supports, joints, beds and loads.

    Raises
    ------
    RuntimeError
        where there is no way to draw off screen. VTK may also end the process then.
    """
    factor = magnification(quantities)
    shifts = drawn_shifts(scene, quantities, factor)
    limit = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in quantities.rods)
    plotter: Any = _plotter()
    for rod in scene.rods:
        found = quantities.rod(rod.name)
        corners = deformed_surface(rod, found, factor, shifts[rod.name])
        concave = isinstance(rod.section, Polygon)
        bar = _closed(corners, np.linalg.norm(found.displacement, axis=0), concave)
        coloured = plotter.add_mesh(
            bar,
            scalars="displacement",
            cmap="viridis",
            clim=(0.0, limit or 1.0),
            show_scalar_bar=False,
            smooth_shading=False,
            ambient=0.35,
            diffuse=0.7,
        )
        plotter.add_mesh(bar.extract_feature_edges(40.0), color=INK, line_width=2)
        still = deformed_surface(rod, found, 0.0, np.zeros(3))
        before = _closed(still, np.zeros(still.shape[1]), concave).extract_feature_edges(40.0)
        plotter.add_mesh(before, color="#8a94a0", line_width=1.5, opacity=0.7)
    _add_surroundings(plotter, scene, quantities, factor, shifts)
    plotter.add_scalar_bar(
        title="Displacement of the centre line, mm\n",
        mapper=coloured.mapper,
        n_labels=5,
        fmt="{:.3g}",
        color=INK,
        title_font_size=24,
        label_font_size=22,
        position_x=0.30,
        position_y=0.03,
        width=0.40,
        height=0.13,
    )
    return Picture(_photographed(plotter, scene, quantities, below=0.03), factor)


def draw_undeformed(scene: Scene, quantities: Quantities) -> Picture:
    """Draw the rods as they are before anything moves, each named, with all that holds and loads them and may touch.

    Raises
    ------
    RuntimeError
        as `draw`.
    """
    plotter, shifts = _plotter(), {rod.name: np.zeros(3) for rod in scene.rods}
    for number, rod in enumerate(scene.rods):
        found = quantities.rod(rod.name)
        corners = deformed_surface(rod, found, 0.0, np.zeros(3))
        bar = _closed(corners, np.zeros(corners.shape[1]), isinstance(rod.section, Polygon))
        plotter.add_mesh(bar, color=COLOURS[number % len(COLOURS)], ambient=0.35, diffuse=0.7)
        plotter.add_mesh(bar.extract_feature_edges(40.0), color=INK, line_width=2)
        _add_text(plotter, found.position[:, len(found.station) // 3], rod.name)
    for pair in scene.contacts:
        for sign in (-1.0, 1.0):
            plotter.add_mesh(_zone_border(scene, quantities, pair, sign), color=ZONE, line_width=6)
    _add_surroundings(plotter, scene, quantities, 1.0, shifts)
    return Picture(_photographed(plotter, scene, quantities, below=-0.01), 1.0)


def _zone_border(scene: Scene, quantities: Quantities, pair: ContactPair, sign: float) -> pyvista.PolyData:
    """One border of the candidate zone, where the first face ends sideways."""
    rod, found = scene.rod(pair.first.rod), quantities.rod(pair.first.rod)
    station = np.linspace(*pair.zone, 101)
    normal = face_normals(found, pair.first.face, station)
    away, width = face_extent(rod, pair.first.face)
    across = np.cross(between(found, found.axes[:, 2].T, station), normal, axis=0)
    middle = between(found, found.position, station) + away * normal
    return pyvista.lines_from_points((middle + 0.5 * sign * width * across).T)


def _plotter() -> pyvista.Plotter:
    """An empty picture that is drawn off screen."""
    # VTK says on standard error that there is no X server and then draws without one.
    pyvista.vtk_verbosity("off")
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.set_background("white")
    empty: pyvista.Plotter = plotter
    return empty


def _add_surroundings(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """All that holds and loads the rods."""
    _add_supports(plotter, scene, quantities, factor, shifts)
    _add_joints(plotter, scene, quantities, factor, shifts)
    _add_beds(plotter, scene, quantities, factor, shifts)
    _add_ground(plotter, scene, quantities, factor, shifts)
    _add_loads(plotter, scene, quantities, factor, shifts)


def _photographed(drawn: pyvista.Plotter, scene: Scene, quantities: Quantities, below: float) -> bytes:
    """The picture as PNG, seen across the plane that shows most, with a scale; the plotter is closed.

    below : room that is left below the scene for what stands there, as a part of its extent
    """
    plotter: Any = drawn  # some of its methods are wrapped in a way that hides their arguments
    right, up = view_plane(scene, quantities)
    size = extent(quantities)
    # Sections that are not small beside the scene, with their clamps, need more room.
    stout = max(0.0, 2.2 * max(float(np.ptp(outline(rod.section), axis=0).max()) for rod in scene.rods) - 0.1 * size)
    _add_scale(plotter, quantities, right, up, stout)
    plotter.enable_parallel_projection()
    plotter.enable_anti_aliasing("ssaa")
    lowered = -below * size * up
    plotter.view_vector(np.cross(right, up) + 0.30 * up - 0.10 * right, viewup=up)
    plotter.reset_camera()
    high = float(np.ptp(up @ np.hstack([rod.position for rod in quantities.rods])))
    plotter.camera.parallel_scale = 0.5 * max(
        (1.15 * size + 2.0 * stout) * SIZE[1] / SIZE[0], 1.3 * high + 0.35 * size + stout
    )
    plotter.camera.focal_point = np.asarray(plotter.camera.focal_point) + lowered
    plotter.camera.position = np.asarray(plotter.camera.position) + lowered
    stream = io.BytesIO()
    plotter.screenshot(stream)
    plotter.close()
    return stream.getvalue()


def _closed(corners: Array, values: Array, concave: bool) -> pyvista.PolyData:
    """Surface of a bar with both end sections; corners has shape (3, n, corners)."""
    _, count, around_section = corners.shape
    points = corners.transpose(1, 2, 0).reshape(-1, 3)
    index = np.arange(count * around_section).reshape(count, around_section)
    around = np.roll(index, -1, axis=1)
    sides = np.stack([index[:-1], around[:-1], around[1:], index[1:]], axis=-1).reshape(-1, 4)
    ends = np.vstack([index[0, ::-1], index[-1]])
    faces = [np.insert(part, 0, part.shape[1], axis=1).ravel() for part in (sides, ends)]
    bar = pyvista.PolyData(points, np.concatenate(faces))
    bar["displacement"] = np.repeat(values, around_section)
    return bar.triangulate() if concave else bar


def _add_supports(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """A plate behind each clamped end; a cone for each held displacement, a collar around what is kept from turning."""
    up = view_plane(scene, quantities)[1]
    for support in scene.supports:
        rod, found = scene.rod(support.rod), quantities.rod(support.rod)
        side = float(np.ptp(outline(rod.section), axis=0).max())
        if isinstance(support, Clamp):
            index = 0 if support.end == "start" else -1
            outward = found.axes[index, 2] * (-1.0 if support.end == "start" else 1.0)
            place = _moved(found, index, factor) + shifts[rod.name] + 0.125 * side * outward
            _add_plate(plotter, place, outward, found.axes[index, 1], 0.25 * side, 2.2 * side)
            continue
        index = int(np.argmin(np.abs(found.station - support.position)))
        centre, axes = _moved(found, index, factor) + shifts[rod.name], found.axes[index]
        moves, turns = held_directions(support, found)
        for direction in moves.T:
            along = abs(direction @ axes[2]) > 0.5
            beneath = direction if direction @ up < 0.0 else -direction
            if along:
                beneath = direction if support.position > 0.5 * rod.length else -direction
            height = 0.8 * side
            reach = 0.0 if along else float((outline(rod.section) @ axes[:2] @ beneath).max())
            start = centre
            if along and 0 < index < len(found.station) - 1:
                # Within the rod it would not be seen.
                over = axes[1] if axes[1] @ up > 0.0 else -axes[1]
                start = centre + (float((outline(rod.section) @ axes[:2] @ over).max()) + 0.4 * side) * over
            cone = pyvista.Cone(
                center=start + (reach + 0.5 * height) * beneath,
                direction=-beneath,
                height=height,
                radius=0.4 * side,
                resolution=24,
            )
            plotter.add_mesh(cone, color=HOLD)
        if turns.size:
            _add_plate(plotter, centre, axes[2], axes[1], 0.12 * side, 1.5 * side)


def _moved(found: RodQuantities, index: int, factor: float) -> Array:
    """A point of the deformed centre line as it is drawn, without its rod's shift."""
    place: Array = found.position[:, index] + factor * found.displacement[:, index]
    return place


def _add_plate(
    plotter: pyvista.Plotter, centre: Array, normal: Array, upright: Array, thickness: float, side: float
) -> None:
    plate = pyvista.Cube(center=(0.0, 0.0, 0.0), x_length=thickness, y_length=side, z_length=side)
    place = np.eye(4)
    place[:3, :3] = np.column_stack([normal, upright, np.cross(normal, upright)])
    place[:3, 3] = centre
    plotter.add_mesh(plate.transform(place, inplace=False), color=HOLD, show_edges=False)


def _add_joints(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """A ball that holds the ends of the rods of a joint."""
    for joint in scene.joints:
        sides = [float(np.ptp(outline(scene.rod(end.rod).section), axis=0).max()) for end in joint.ends]
        end = joint.ends[0]
        centre = _moved(quantities.rod(end.rod), 0 if end.end == "start" else -1, factor) + shifts[end.rod]
        plotter.add_mesh(pyvista.Sphere(radius=0.8 * max(sides), center=centre), color=HOLD, smooth_shading=True)


def _add_beds(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """Springs from the deformed face to where the ground stands still."""
    for bed in scene.beds:
        rod, found = scene.rod(bed.rod), quantities.rod(bed.rod)
        side = float(np.ptp(outline(rod.section), axis=0).max())
        station = np.linspace(bed.start, bed.end, SPRINGS)
        normal = face_normals(found, bed.face.face, station)
        still = between(found, found.position, station) + face_extent(rod, bed.face.face)[0] * normal
        still = still + shifts[rod.name][:, None]
        face = still + factor * between(found, found.displacement, station)
        depth = side + float(np.maximum(0.0, np.einsum("in,in->n", face - still, normal)).max())
        ground = still + depth * normal
        _add_springs(plotter, face, ground, between(found, found.axes[:, 2].T, station), 0.15 * side)
        plotter.add_mesh(pyvista.lines_from_points(ground.T), color=HOLD, line_width=8)


def _add_springs(plotter: pyvista.Plotter, tops: Array, feet: Array, sideways: Array, swing: float) -> None:
    """Springs between points, swinging along given directions; shape (3, n) each."""
    share = np.concatenate([[0.0], np.linspace(0.2, 0.8, 7), [1.0]])
    swings = swing * np.array([0.0, 0.0, 1.0, -1.0, 1.0, -1.0, 1.0, 0.0, 0.0])
    for top, foot, direction in zip(tops.T, feet.T, sideways.T, strict=True):
        along = np.outer(1.0 - share, top) + np.outer(share, foot)
        plotter.add_mesh(pyvista.lines_from_points(along + np.outer(swings, direction)), color=INK, line_width=2)


def _add_ground(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """A strip at the magnified gap from the undeformed face; under it, for a bed, springs where it is not lifted off.

    What is farther than three section heights is left out, or drawn there if all of it is.
    """
    for pair in scene.contacts:
        if isinstance(pair.second, RodFace) or pair.gap == "drawn":
            continue
        rod, found = scene.rod(pair.first.rod), quantities.rod(pair.first.rod)
        side = float(np.ptp(outline(rod.section), axis=0).max())
        station = np.linspace(*pair.zone, 4 * SPRINGS - 3)
        normal = face_normals(found, pair.first.face, station)
        still = between(found, found.position, station) + face_extent(rod, pair.first.face)[0] * normal
        still = still + shifts[rod.name][:, None]
        height = np.minimum(factor * given_gap(pair.gap, station), 3.0 * side)
        tangent = between(found, found.axes[:, 2].T, station)
        if pair.second.modulus is not None:
            pressed = factor * np.einsum("in,in->n", between(found, found.displacement, station), normal)
            top = np.maximum(height, pressed)
            feet, some = still + (top.max() + side) * normal, slice(None, None, 4)
            _add_springs(plotter, (still + top * normal)[:, some], feet[:, some], tangent[:, some], 0.15 * side)
            plotter.add_mesh(pyvista.lines_from_points(feet.T), color=HOLD, line_width=8)
            continue
        across = side * np.cross(tangent, normal, axis=0)
        ground = still + height * normal
        points = np.hstack([ground - across, ground + across]).T
        count = len(station)
        near = height < 3.0 * side
        first = np.flatnonzero((near[:-1] & near[1:]) | ~near.any())
        quads = np.stack([np.full(len(first), 4), first, first + 1, count + first + 1, count + first], axis=1)
        plotter.add_mesh(pyvista.PolyData(points, quads.ravel()), color=HOLD, ambient=0.4, diffuse=0.6)


def _add_loads(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """Arrows for each load, ending or beginning on the rod's surface; one with two heads along the axis of a moment."""
    length = 0.09 * extent(quantities)
    for load in scene.loads:
        rod, found = scene.rod(load.rod), quantities.rod(load.rod)
        arrows = load_arrows(load, found)
        if len(arrows.station) == 0:
            continue
        centres = arrows.place + factor * between(found, found.displacement, arrows.station) + shifts[rod.name][:, None]
        ends = []
        for station, centre, direction in zip(arrows.station, centres.T, arrows.direction.T, strict=True):
            axes = found.axes[int(np.argmin(np.abs(found.station - station)))]
            side = direction if arrows.pulling else -direction
            surface = centre + float((outline(rod.section) @ axes[:2] @ side).max()) * side
            ends.append(surface + 1.12 * length * side)
            start = surface if arrows.pulling else surface - length * direction
            for back in (0.0, 0.3)[: 2 if arrows.turning else 1]:
                arrow = pyvista.Arrow(
                    start=start - back * length * direction,
                    direction=direction,
                    scale=length,
                    shaft_radius=0.035,
                    tip_radius=0.10,
                    tip_length=0.32,
                )
                plotter.add_mesh(arrow, color=INK)
        _add_text(plotter, ends[len(ends) // 2], arrows.text)


def _add_scale(plotter: pyvista.Plotter, quantities: Quantities, right: Array, up: Array, stout: float) -> None:
    """A bar of round length below the rods, from their left end, labelled in mm; `stout` mm lower for thick ones."""
    size = extent(quantities)
    points = np.hstack([rod.position for rod in quantities.rods])
    length = round_below(0.25 * size)
    low_right, low_up = (right @ points).min(), (up @ points).min()
    away = np.cross(right, up)
    depth = float(away @ quantities.rods[0].position[:, 0])
    below = (low_right + 0.02 * size) * right + (low_up - 0.13 * size - 0.5 * stout) * up + depth * away
    ends = np.array([below, below + length * right])
    tick = up * 0.008 * size
    for line in (ends, [ends[0] - tick, ends[0] + tick], [ends[1] - tick, ends[1] + tick]):
        plotter.add_mesh(pyvista.Line(*line), color=INK, line_width=4)
    _add_text(plotter, ends.mean(axis=0) + 2.0 * tick, f"{length:g} mm")


def _add_text(plotter: pyvista.Plotter, place: Array, text: str) -> None:
    plotter.add_point_labels(
        [place],
        [text],
        show_points=False,
        shape=None,
        text_color=INK,
        font_size=26,
        justification_horizontal="center",
        always_visible=True,
    )
