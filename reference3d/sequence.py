"""A scene on three systematically refined meshes, for the uncertainty of what is read off the finest."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from cases.scene import Box, Material, Polygon, Rod, Scene
from reference3d.solid_solution import SolidSolution
from reference3d.solution import Solution
from reference3d.solver import solve
from reference3d.uncertainty import clamp_singularity_exponent

# elements per coarse cell along each axis: element sizes fall by 2 and by 1.5
REFINEMENTS = (1, 2, 3)
# Poisson's ratio for the singularity at a clamp of what is not isotropic
ORDINARY_RATIO = 0.3


def solve_sequence(
    scene: Scene, progress: Callable[[int, int], None] | None = None
) -> tuple[Solution | SolidSolution, ...]:
    """Solutions on three meshes, coarse to fine, with element sizes in the ratio 6 : 3 : 2.

    Parameters
    ----------
    progress : called with the number of meshes done and of all before each solve

    Raises
    ------
    SceneError
        as `solver.solve`.
    """
    solutions: list[Solution | SolidSolution] = []
    for done, refinement in enumerate(REFINEMENTS):
        if progress is not None:
            progress(done, len(REFINEMENTS))
        solutions.append(solve(scene, refinement, located=solutions[0] if solutions else None))
    return tuple(solutions)


def formal_order(scene: Scene) -> float:
    """Order with which forces and deflections converge on uniformly refined meshes, 2 lambda.

    Clamps make the stress singular at their edges; whatever the order of the elements, the energy error then
    falls as h^(2 lambda) (G. Strang, G. J. Fix, An Analysis of the Finite Element Method, 1973, chapter 8). So do
    re-entrant corners of a section of interior angle omega in torsion and shear, where lambda is pi / omega.
    """
    return 2.0 * min(_singularity_exponent(rod) for rod in scene.rods)


def _singularity_exponent(rod: Rod) -> float:
    ratio = rod.material.poisson_ratio if isinstance(rod.material, Material) else ORDINARY_RATIO
    return min(clamp_singularity_exponent(ratio), math.pi / max(math.pi, _widest_corner(rod)))


def _widest_corner(rod: Rod) -> float:
    """Largest interior angle at a corner of the rod's section, rad."""
    if isinstance(rod.section, Box):
        return 1.5 * math.pi
    if not isinstance(rod.section, Polygon):
        return 0.5 * math.pi
    widest = 0.0
    for number, loop in enumerate((rod.section.outer, *rod.section.holes)):
        corners = np.array(loop)
        before, after = corners - np.roll(corners, 1, axis=0), np.roll(corners, -1, axis=0) - corners
        enclosed = np.sum(corners[:, 0] * np.roll(corners[:, 1], -1) - corners[:, 1] * np.roll(corners[:, 0], -1))
        turned = np.arctan2(before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0], np.sum(before * after, axis=1))
        inside = np.sign(enclosed) * (1.0 if number == 0 else -1.0)
        widest = max(widest, float((math.pi - inside * turned).max()))
    return widest
