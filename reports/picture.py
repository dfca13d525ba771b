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

from cases.scene import Polygon, Rod, Scene, SectionMoment
from reports.quantities import Quantities, RodQuantities
from reports.sections import outline
from reports.solution import Array
from reports.view import between, extent, load_places, load_stations, load_text, load_vector, view_plane

# The largest displacement is drawn about this long, as a part of the scene's extent.
DRAWN_DISPLACEMENT = 0.08
SIZE = (1800, 700)
INK = "#1f2933"


@dataclass(frozen=True)
class Picture:
    """A PNG image and what must be said beside it.

    Attributes
    ----------
    magnification : factor by which displacements and gaps are drawn larger
    """

    png: bytes
    magnification: float


def round_below(value: float) -> float:
    """The largest of 1, 2 or 5 times a power of ten that is not above a positive value."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(power * max(step for step in (1.0, 2.0, 5.0) if step * power <= value * (1.0 + 1e-12)))


def magnification(quantities: Quantities) -> float:
    """A round factor, at least 1, by which displacements are drawn larger."""
    largest = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in quantities.rods)
    if largest <= 0.0:
        return 1.0
    return max(1.0, round_below(DRAWN_DISPLACEMENT * extent(quantities) / largest))


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


def drawn_shifts(scene: Scene, quantities: Quantities, factor: float) -> dict[str, Array]:
    """How far each rod is moved so that gaps are magnified like displacements, mm.

    The second rod of a pair is moved along the first face's normal from the drawn to the magnified given gap.
    """
    shifts = {rod.name: np.zeros(3) for rod in scene.rods}
    for pair in scene.contacts:
        first, second = scene.rod(pair.first.rod), scene.rod(pair.second.rod)
        normal, half = _face(first, quantities.rod(first.name), pair.first.face)
        _, other_half = _face(second, quantities.rod(second.name), pair.second.face)
        apart = np.subtract(second.centre_line.start, first.centre_line.start)
        drawn = float(normal @ apart) - half - other_half
        shifts[second.name] = shifts[first.name] + (factor * pair.gap - drawn) * normal
    return shifts


def _face(rod: Rod, found: RodQuantities, face: str) -> tuple[Array, float]:
    """Outward normal of a face of a straight rod and its distance from the centre line, mm."""
    first, second, _ = found.axes[0]
    directions = {"top": second, "bottom": -second, "right": first, "left": -first}
    across = outline(rod.section)[:, 1 if face in ("top", "bottom") else 0]
    return directions[face], float(across.max())


def draw(scene: Scene, quantities: Quantities) -> Picture:
    """Draw the deformed bars, their undeformed outlines, clamps and loads.

    Raises
    ------
    RuntimeError
        where there is no way to draw off screen. VTK may also end the process then.
    """
    # VTK says on standard error that there is no X server and then draws without one.
    pyvista.vtk_verbosity("off")
    factor = magnification(quantities)
    shifts = drawn_shifts(scene, quantities, factor)
    limit = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in quantities.rods)
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.set_background("white")
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
    _add_supports(plotter, scene, quantities, shifts)
    _add_loads(plotter, scene, quantities, factor, shifts)
    right, up = view_plane(scene, quantities)
    size = extent(quantities)
    # Sections that are not small beside the scene, with their clamps, need more room.
    stout = max(0.0, 2.2 * max(float(np.ptp(outline(rod.section), axis=0).max()) for rod in scene.rods) - 0.1 * size)
    _add_scale(plotter, quantities, right, up, stout)
    plotter.add_scalar_bar(
        title="Displacement of the centre line, mm\n",
        mapper=coloured.mapper,
        n_labels=5,
        fmt="{:.2f}",
        color=INK,
        title_font_size=24,
        label_font_size=22,
        position_x=0.30,
        position_y=0.03,
        width=0.40,
        height=0.13,
    )
    plotter.enable_parallel_projection()
    plotter.enable_anti_aliasing("ssaa")
    lowered = -0.03 * size * up
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
    return Picture(stream.getvalue(), factor)


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


def _add_supports(plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, shifts: dict[str, Array]) -> None:
    """A plate behind each clamped end."""
    for clamp in scene.supports:
        rod = scene.rod(clamp.rod)
        index = 0 if clamp.end == "start" else -1
        axes, end = quantities.rod(rod.name).axes[index], quantities.rod(rod.name).position[:, index]
        outward = -axes[2] if clamp.end == "start" else axes[2]
        side = float(np.ptp(outline(rod.section), axis=0).max())
        size = np.array([1.0, 2.2, 2.2]) * side * np.array([0.25, 1.0, 1.0])
        plate = pyvista.Cube(center=(0.0, 0.0, 0.0), x_length=size[0], y_length=size[1], z_length=size[2])
        place = np.eye(4)
        place[:3, :3] = np.column_stack([outward, axes[1], np.cross(outward, axes[1])])
        place[:3, 3] = end + shifts[rod.name] + outward * size[0] / 2.0
        plotter.add_mesh(plate.transform(place, inplace=False), color="#b8c0c8", show_edges=False)


def _add_loads(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """Arrows for each load, their tips on the rod's surface; one with two heads along the axis of a moment."""
    length = 0.09 * extent(quantities)
    for load in scene.loads:
        rod, found = scene.rod(load.rod), quantities.rod(load.rod)
        size = float(np.linalg.norm(load_vector(load)))
        if size == 0.0:
            continue
        direction = load_vector(load) / size
        stations = load_stations(load)
        centres = load_places(load, found) + factor * between(found, found.displacement, stations)
        tips = []
        for station, centre in zip(stations, centres.T, strict=True):
            axes = found.axes[int(np.argmin(np.abs(found.station - station)))]
            reach = float((outline(rod.section) @ axes[:2] @ direction).max())
            tips.append(centre + shifts[rod.name] - reach * direction)
            for back in (0.0, 0.3)[: 2 if isinstance(load, SectionMoment) else 1]:
                arrow = pyvista.Arrow(
                    start=tips[-1] - (1.0 + back) * length * direction,
                    direction=direction,
                    scale=length,
                    shaft_radius=0.035,
                    tip_radius=0.10,
                    tip_length=0.32,
                )
                plotter.add_mesh(arrow, color=INK)
        _add_text(plotter, tips[len(tips) // 2] - 1.12 * length * direction, load_text(load))


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
