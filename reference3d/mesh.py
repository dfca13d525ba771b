"""Meshes of boxes: gmsh extrudes a point to a line, a rectangle and a solid of structured hexahedra.

Where the element borders lie is decided in `grading`; this module only makes the mesh from them.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from skfem import MeshHex

from reference3d.gmsh_model import new_model

Array = NDArray[np.float64]

GMSH_HEXAHEDRON = 5

# corners of a hexahedron in scikit-fem's order, as (x, y, s) of the unit cube (skfem.refdom.RefHex)
_CORNERS = np.array(
    [[1, 1, 1], [1, 1, 0], [1, 0, 1], [0, 1, 1], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]], dtype=np.int64
)


def box_mesh(x: Array, y: Array, s: Array) -> MeshHex:
    """Structured hexahedra between given borders.

    Elements are ordered with x running fastest and s slowest, and the axes of scikit-fem's reference cube lie
    along x, y and s.

    Parameters
    ----------
    x, y, s : element borders along the three axes, ascending, mm, shapes (nx + 1,), (ny + 1,), (ns + 1,)

    Raises
    ------
    RuntimeError
        if gmsh does not return the mesh that was asked for.
    """
    points, hexahedra = _extrude(x, y, s)
    expected = (len(x) - 1) * (len(y) - 1) * (len(s) - 1)
    if len(hexahedra) != expected:
        raise RuntimeError(f"gmsh made {len(hexahedra)} hexahedra where {expected} were asked for")
    centre = points[:, hexahedra].mean(axis=2)
    upper = points[:, hexahedra] > centre[:, :, None]
    code = np.array([4, 2, 1]) @ upper.reshape(3, -1).astype(np.int64)
    rank = np.argsort(code.reshape(expected, 8), axis=1)
    corners = np.take_along_axis(hexahedra, rank[:, _CORNERS @ np.array([4, 2, 1])], axis=1)
    order = np.lexsort((np.searchsorted(x, centre[0]), np.searchsorted(y, centre[1]), np.searchsorted(s, centre[2])))
    return MeshHex(np.ascontiguousarray(points), np.ascontiguousarray(corners[order].T))


def _extrude(x: Array, y: Array, s: Array) -> tuple[Array, NDArray[np.int64]]:
    """Points, shape (3, n), and hexahedra, shape (m, 8), of the box in gmsh's order."""
    with new_model("box", {}) as gmsh:
        geometry = gmsh.model.geo
        entities: list[tuple[int, int]] = [(0, geometry.addPoint(x[0], y[0], s[0]))]
        for axis, borders in enumerate((x, y, s)):
            length = borders[-1] - borders[0]
            heights = (borders[1:] - borders[0]) / length
            layers: dict[str, Any] = {
                "numElements": [1] * len(heights),
                "heights": heights,
                "recombine": True,
            }
            made = geometry.extrude(entities, *(length * np.eye(3)[axis]), **layers)
            entities = [entity for entity in made if entity[0] == axis + 1]
        geometry.synchronize()
        gmsh.model.mesh.generate(3)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        _, corners = gmsh.model.mesh.getElementsByType(GMSH_HEXAHEDRON)
    number = np.zeros(int(tags.max()) + 1, dtype=np.int64)
    number[tags] = np.arange(len(tags))
    return coordinates.reshape(-1, 3).T.copy(), number[corners].reshape(-1, 8)
