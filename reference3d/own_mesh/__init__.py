"""A researcher's own mesh instead of ours: read with its named groups, checked against the scene, and solved.

solution = solve_own_mesh(scene, Path("bars.msh"))
"""

from reference3d.own_mesh.solution import OwnMeshSolution
from reference3d.own_mesh.solver import solve_own_mesh

__all__ = ["OwnMeshSolution", "solve_own_mesh"]
