"""A scene on three systematically refined meshes, for the uncertainty of what is read off the finest."""

from __future__ import annotations

from collections.abc import Callable

from cases.scene import Scene
from reference3d.scope import isotropic
from reference3d.solution import Solution
from reference3d.solver import solve
from reference3d.uncertainty import clamp_singularity_exponent

# elements per coarse cell along each axis: element sizes fall by 2 and by 1.5
REFINEMENTS = (1, 2, 3)


def solve_sequence(scene: Scene, progress: Callable[[int, int], None] | None = None) -> tuple[Solution, ...]:
    """Solutions on three meshes, coarse to fine, with element sizes in the ratio 6 : 3 : 2.

    Parameters
    ----------
    progress : called with the number of meshes done and of all before each solve

    Raises
    ------
    SceneError
        as `solver.solve`.
    """
    solutions: list[Solution] = []
    for done, refinement in enumerate(REFINEMENTS):
        if progress is not None:
            progress(done, len(REFINEMENTS))
        solutions.append(solve(scene, refinement, located=solutions[0] if solutions else None))
    return tuple(solutions)


def formal_order(scene: Scene) -> float:
    """Order with which forces and deflections converge on uniformly refined meshes, 2 lambda.

    Clamps make the stress singular at their edges; whatever the order of the elements, the energy error then
    falls as h^(2 lambda) (G. Strang, G. J. Fix, An Analysis of the Finite Element Method, 1973, chapter 8).
    """
    return 2.0 * min(clamp_singularity_exponent(isotropic(rod).poisson_ratio) for rod in scene.rods)
