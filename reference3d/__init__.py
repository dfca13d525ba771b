"""The 3D reference: a scene as a solid of 27-node hexahedra with node-to-surface penalty contact.

    solutions = solve_sequence(scene)
    convergence = grid_convergence(values, sizes, formal_order(scene))

`Solution` has the shape that `reports.solution` asks for. gmsh is imported only when a mesh is made.
"""

from reference3d.sequence import REFINEMENTS, formal_order, solve_sequence
from reference3d.solution import Solution
from reference3d.solver import DEFAULT_REFINEMENT, solve
from reference3d.uncertainty import GridConvergence, clamp_singularity_exponent, grid_convergence

__all__ = [
    "DEFAULT_REFINEMENT",
    "REFINEMENTS",
    "GridConvergence",
    "Solution",
    "clamp_singularity_exponent",
    "formal_order",
    "grid_convergence",
    "solve",
    "solve_sequence",
]
