"""The 3D reference: a scene as solids of 27-node hexahedra, with node-to-surface contact.

    solutions = solve_sequence(scene)
    convergence = grid_convergence(values, sizes, formal_order(scene))

`Solution` and `SolidSolution` have the shape that `reports.solution` asks for. gmsh is imported only when a mesh is
made.
"""

from reference3d.sequence import REFINEMENTS, solve_sequence
from reference3d.singularities import clamp_singularity_exponent, contact_corner_exponent, formal_order
from reference3d.solid_solution import SolidSolution
from reference3d.solution import Solution
from reference3d.solver import DEFAULT_REFINEMENT, solve
from reference3d.uncertainty import GridConvergence, grid_convergence

__all__ = [
    "DEFAULT_REFINEMENT",
    "REFINEMENTS",
    "GridConvergence",
    "SolidSolution",
    "Solution",
    "clamp_singularity_exponent",
    "contact_corner_exponent",
    "formal_order",
    "grid_convergence",
    "solve",
    "solve_sequence",
]
