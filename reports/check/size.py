"""How many unknowns a case will have, counted without assembling anything."""

from __future__ import annotations

import numpy as np

from cases.case import Case
from cases.scene import Clamp, Rod, Scene, SceneError
from reference3d import REFINEMENTS
from reference3d.frames import is_symmetric, pair_overlap
from reference3d.grading import rod_borders
from reference3d.layers import layer_borders
from reference3d.scope import require_treatable
from reference3d.section_mesh import section_mesh
from rodmodel.borders import natural_mesh
from rodmodel.section import Fields
from rodmodel.solver import grades_of
from rodmodel.symmetry import scene_mirrors


def rod_unknowns(case: Case) -> int:
    """Unknowns of the rod model on the case's elements, before contact moves their borders or adds some.

    Ends that are clamped carry none; what other supports and joints hold is left in.
    """
    mirrors, clamped = scene_mirrors(case.scene), _clamped(case.scene)
    total = 0
    for rod in case.scene.rods:
        level, order = grades_of(case.rod_model.level, rod), grades_of(case.rod_model.order, rod)
        mesh = natural_mesh(case.scene, rod, level, order)
        fields = np.array([Fields(int(each), *mirrors[rod.name]).count for each in mesh.levels])
        # A node carries the fields of the richer of its two elements.
        nodes = np.maximum(np.append(fields, 0), np.append(0, fields))
        nodes[[0, -1]] *= [(rod.name, "start") not in clamped, (rod.name, "end") not in clamped]
        total += int(nodes.sum() + ((np.asarray(mesh.orders) - 1) * fields).sum())
    return total


def reference_unknowns(scene: Scene) -> tuple[int, ...]:
    """About how many unknowns the 3D reference will have on each of its meshes, coarse to fine.

    Raises
    ------
    SceneError
        if nothing lies opposite a face that may touch.
    """
    if _is_clamped_bars(scene):
        symmetric = is_symmetric(scene)
        return tuple(
            sum(_bar_unknowns(scene, rod, refinement, symmetric) for rod in scene.rods) for refinement in REFINEMENTS
        )
    halves = any(any(planes) for planes in scene_mirrors(scene).values())
    found = []
    for refinement in REFINEMENTS:
        nodes = sum(
            len(section_mesh(rod.section, refinement).nodes) * (2 * len(layer_borders(scene, rod, refinement)) - 1)
            for rod in scene.rods
        )
        # One plane of symmetry leaves half of the unknowns.
        found.append(3 * nodes // 2 if halves else 3 * nodes)
    return tuple(found)


def _is_clamped_bars(scene: Scene) -> bool:
    """Whether the 3D reference treats the rods as boxes, on a grid of their own, if memory is enough."""
    try:
        require_treatable(scene)
        for pair in scene.contacts:
            pair_overlap(scene, pair)
    except SceneError:
        return False
    return {rod.name for rod in scene.rods} == {name for name, _ in _clamped(scene)}


def _bar_unknowns(scene: Scene, rod: Rod, refinement: int, symmetric: bool) -> int:
    borders = rod_borders(scene, rod, refinement, symmetric)
    return 3 * (2 * len(borders.x) - 1) * (2 * len(borders.y) - 1) * (2 * len(borders.s) - 1)


def _clamped(scene: Scene) -> set[tuple[str, str]]:
    return {(support.rod, support.end) for support in scene.supports if isinstance(support, Clamp)}
