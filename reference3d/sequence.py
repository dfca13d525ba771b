"""A scene on three systematically refined meshes, for the uncertainty of what is read off the finest."""

from __future__ import annotations

from collections.abc import Callable

from cases.scene import Scene
from reference3d.solid_solution import SolidSolution
from reference3d.solution import Solution
from reference3d.solver import solve

# elements per coarse cell along each axis: element sizes fall by 2 and by 1.5
REFINEMENTS = (1, 2, 3)


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
