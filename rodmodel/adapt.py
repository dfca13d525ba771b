"""Borders where solutions are steep: short elements at supports, joints and at the ends of contact zones.

At a clamped section and under the end of another rod the three-dimensional solution is singular or nearly so; it decays
over about one section height (Saint-Venant). Elements of a fifth of the height and of one height next to it, instead of
one long one, take the error of the paper's mesh from 0.1 % to 0.02 % at the same order. Under the end of another rod
the element beyond it counts as much as the one below it: a long one there makes 0.1 %.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from cases.scene import Rod, Scene
from rodmodel.holds import held_sections
from rodmodel.pairing import on_second
from rodmodel.shape import extents

# Distances from a support or joint and from a zone's end, in section heights.
FROM_SUPPORT = (0.2, 1.0)
FROM_ZONE_END = (1.0 / 3.0,)


def graded(scene: Scene) -> Scene:
    """The scene with short elements added at supports, joints and at zone ends; no border is taken away."""
    return replace(scene, rods=tuple(_graded_rod(scene, rod) for rod in scene.rods))


def _graded_rod(scene: Scene, rod: Rod) -> Rod:
    x_min, x_max, y_min, y_max = extents(rod.section)
    height = max(x_max - x_min, y_max - y_min)
    length = rod.element_borders[-1]
    new = list(rod.element_borders)
    for held in held_sections(scene, rod):
        new += [held.station + sign * height * part for sign in (-1.0, 1.0) for part in FROM_SUPPORT]
    for pair in scene.contacts:
        if rod.name not in [face.rod for face in pair.faces]:
            continue
        zone = np.array(pair.zone)
        start, end = sorted(zone if rod.name == pair.first.rod else on_second(scene, pair, zone))
        new += [start, end]
        new += [at + sign * height * part for at in (start, end) for sign in (-1.0, 1.0) for part in FROM_ZONE_END]
    # A border closer to a given one than the shortest element asked for would add nothing but a sliver.
    kept = list(rod.element_borders)
    for border in sorted(new):
        if 0.0 < border < length and min(abs(border - other) for other in kept) > 0.5 * height * FROM_SUPPORT[0]:
            kept.append(float(border))
    return replace(rod, element_borders=tuple(sorted(kept)))
