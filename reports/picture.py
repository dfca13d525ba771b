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

from cases.scene import Rod, Scene
from reports.geometry import centre_line_points, frame
from reports.quantities import Quantities, RodQuantities
from reports.solution import Array

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


def extent(scene: Scene) -> float:
    """Diagonal of the box around the scene's centre lines, mm."""
    ends = np.array([end for rod in scene.rods for end in (rod.centre_line.start, rod.centre_line.end)])
    return float(np.linalg.norm(np.ptp(ends, axis=0)))


def magnification(scene: Scene, quantities: Quantities) -> float:
    """A round factor, at least 1, by which displacements are drawn larger."""
    largest = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in quantities.rods)
    if largest <= 0.0:
        return 1.0
    return max(1.0, round_below(DRAWN_DISPLACEMENT * extent(scene) / largest))


def deformed_surface(rod: Rod, quantities: RodQuantities, factor: float, shift: Array) -> Array:
    """Corners of the rod's sections after deformation, global, mm, shape (3, n, 4).

    Parameters
    ----------
    factor : magnification of the displacement
    shift : added to every point, mm, shape (3,)
    """
    first, second, tangent = frame(rod)
    half = np.array([rod.section.width, rod.section.height]) / 2.0
    signs = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    offset = (signs * half) @ np.array([first, second])
    slope = np.gradient(quantities.displacement, quantities.station, axis=1, edge_order=2)
    # a section turned by theta = t x u' moves its points by theta x offset = -(u' . offset) t
    turned = -np.multiply.outer(tangent, slope.T @ offset.T)
    moved = quantities.position + factor * quantities.displacement + shift[:, None]
    corners: Array = moved[:, :, None] + offset.T[:, None, :] + factor * turned
    return corners


def drawn_shifts(scene: Scene, factor: float) -> dict[str, Array]:
    """How far each rod is moved so that gaps are magnified like displacements, mm.

    The second rod of a pair is moved along the first face's normal from the drawn to the magnified given gap.
    """
    shifts = {rod.name: np.zeros(3) for rod in scene.rods}
    for pair in scene.contacts:
        first, second = scene.rod(pair.first.rod), scene.rod(pair.second.rod)
        normal, half = _face(first, pair.first.face)
        _, other_half = _face(second, pair.second.face)
        apart = np.subtract(second.centre_line.start, first.centre_line.start)
        drawn = float(normal @ apart) - half - other_half
        shifts[second.name] = shifts[first.name] + (factor * pair.gap - drawn) * normal
    return shifts


def _face(rod: Rod, face: str) -> tuple[Array, float]:
    """Outward normal of a face and its distance from the centre line, mm."""
    first, second, _ = frame(rod)
    directions = {"top": second, "bottom": -second, "right": first, "left": -first}
    across = rod.section.height if face in ("top", "bottom") else rod.section.width
    return directions[face], across / 2.0


def draw(scene: Scene, quantities: Quantities) -> Picture:
    """Draw the deformed bars, their undeformed outlines, clamps and loads.

    Raises
    ------
    RuntimeError
        where there is no way to draw off screen. VTK may also end the process then.
    """
    # VTK says on standard error that there is no X server and then draws without one.
    pyvista.vtk_verbosity("off")
    factor = magnification(scene, quantities)
    shifts = drawn_shifts(scene, factor)
    limit = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in quantities.rods)
    plotter: Any = pyvista.Plotter(off_screen=True, window_size=list(SIZE))
    plotter.set_background("white")
    for rod in scene.rods:
        found = quantities.rod(rod.name)
        corners = deformed_surface(rod, found, factor, shifts[rod.name])
        bar = _closed(corners, np.linalg.norm(found.displacement, axis=0))
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
        outline = _closed(still[:, [0, -1]], np.zeros(2)).extract_feature_edges(40.0)
        plotter.add_mesh(outline, color="#8a94a0", line_width=1.5, opacity=0.7)
    _add_supports(plotter, scene, shifts)
    _add_loads(plotter, scene, quantities, factor, shifts)
    _add_scale(plotter, scene)
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
    first, second, tangent = frame(scene.rods[0])
    lowered = -0.03 * extent(scene) * second
    plotter.view_vector(-1.0 * first + 0.30 * second - 0.10 * tangent, viewup=second)
    plotter.reset_camera()
    plotter.camera.parallel_scale = 0.5 * 1.15 * extent(scene) * SIZE[1] / SIZE[0]
    plotter.camera.focal_point = np.asarray(plotter.camera.focal_point) + lowered
    plotter.camera.position = np.asarray(plotter.camera.position) + lowered
    stream = io.BytesIO()
    plotter.screenshot(stream)
    plotter.close()
    return Picture(stream.getvalue(), factor)


def _closed(corners: Array, values: Array) -> pyvista.PolyData:
    """Surface of a bar with both end sections; corners has shape (3, n, 4)."""
    count = corners.shape[1]
    points = corners.transpose(1, 2, 0).reshape(-1, 3)
    index = np.arange(4 * count).reshape(count, 4)
    around = np.roll(index, -1, axis=1)
    sides = np.stack([index[:-1], around[:-1], around[1:], index[1:]], axis=-1).reshape(-1, 4)
    faces = np.vstack([sides, index[0, ::-1], index[-1]])
    bar = pyvista.PolyData(points, np.insert(faces, 0, 4, axis=1).ravel())
    bar["displacement"] = np.repeat(values, 4)
    return bar


def _add_supports(plotter: pyvista.Plotter, scene: Scene, shifts: dict[str, Array]) -> None:
    """A plate behind each clamped end."""
    for clamp in scene.supports:
        rod = scene.rod(clamp.rod)
        axes = frame(rod)
        outward = -axes[2] if clamp.end == "start" else axes[2]
        end = rod.centre_line.start if clamp.end == "start" else rod.centre_line.end
        side = max(rod.section.width, rod.section.height)
        size = np.array([1.0, 2.2, 2.2]) * side * np.array([0.25, 1.0, 1.0])
        plate = pyvista.Cube(center=(0.0, 0.0, 0.0), x_length=size[0], y_length=size[1], z_length=size[2])
        place = np.eye(4)
        place[:3, :3] = np.column_stack([outward, axes[1], np.cross(outward, axes[1])])
        place[:3, 3] = np.asarray(end) + shifts[rod.name] + outward * size[0] / 2.0
        plotter.add_mesh(plate.transform(place, inplace=False), color="#b8c0c8", show_edges=False)


def _add_loads(
    plotter: pyvista.Plotter, scene: Scene, quantities: Quantities, factor: float, shifts: dict[str, Array]
) -> None:
    """An arrow for each load, its tip on the bar's surface."""
    for load in scene.loads:
        rod, found = scene.rod(load.rod), quantities.rod(load.rod)
        size = float(np.linalg.norm(load.force))
        if size == 0.0:
            continue
        direction = np.asarray(load.force) / size
        moved = [np.interp(load.position, found.station, component) for component in found.displacement]
        centre = centre_line_points(rod, np.array([load.position]))[:, 0] + factor * np.array(moved)
        half = np.abs(frame(rod)[:2] @ direction) @ np.array([rod.section.width, rod.section.height]) / 2.0
        length = 0.09 * extent(scene)
        tip = centre + shifts[rod.name] - half * direction
        arrow = pyvista.Arrow(
            start=tip - length * direction,
            direction=direction,
            scale=length,
            shaft_radius=0.035,
            tip_radius=0.10,
            tip_length=0.32,
        )
        plotter.add_mesh(arrow, color=INK)
        plotter.add_point_labels(
            [tip - 1.12 * length * direction],
            [f"{size:g} N"],
            show_points=False,
            shape=None,
            text_color=INK,
            font_size=26,
            justification_horizontal="center",
            always_visible=True,
        )


def _add_scale(plotter: pyvista.Plotter, scene: Scene) -> None:
    """A bar of round length below the first rod's start, labelled in mm."""
    rod = scene.rods[0]
    _, second, tangent = frame(rod)
    length = round_below(0.25 * extent(scene))
    below = np.asarray(rod.centre_line.start) - second * (0.13 * extent(scene)) + 0.02 * tangent * extent(scene)
    ends = np.array([below, below + length * tangent])
    tick = second * 0.008 * extent(scene)
    for line in (ends, [ends[0] - tick, ends[0] + tick], [ends[1] - tick, ends[1] + tick]):
        plotter.add_mesh(pyvista.Line(*line), color=INK, line_width=4)
    plotter.add_point_labels(
        [ends.mean(axis=0) + 2.0 * tick],
        [f"{length:g} mm"],
        show_points=False,
        shape=None,
        text_color=INK,
        font_size=26,
        justification_horizontal="center",
        always_visible=True,
    )
