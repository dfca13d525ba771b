"""Meshes of straight bars as a researcher might bring them: by gmsh, with named groups."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from reference3d.gmsh_model import new_model

Box = tuple[float, float, float, float, float, float]
# whether an element is a hexahedron, its order, and whether it has nodes in its faces
KINDS = {
    "hexahedron": (True, 1, True),
    "hexahedron20": (True, 2, False),
    "hexahedron27": (True, 2, True),
    "tetra": (False, 1, True),
    "tetra10": (False, 2, True),
}


def _mesh(path: Path, bars: dict[str, Box], kind: str, size: float) -> Path:
    hexahedra, order, complete = KINDS[kind]
    options = {
        "Mesh.MeshSizeMin": size,
        "Mesh.MeshSizeMax": size,
        "Mesh.ElementOrder": order,
        "Mesh.SecondOrderIncomplete": 0 if complete else 1,
    }
    with new_model("bars", options) as gmsh:
        for name, (x0, x1, y0, y1, z0, z1) in bars.items():
            volume = gmsh.model.occ.addBox(x0, y0, z0, x1 - x0, y1 - y0, z1 - z0)
            gmsh.model.occ.synchronize()
            gmsh.model.addPhysicalGroup(3, [volume], name=name)
            # rods along X with up = Y, so that e1 = -Z
            places = {
                "start": (0, x0),
                "end": (0, x1),
                "bottom": (1, y0),
                "top": (1, y1),
                "right": (2, z0),
                "left": (2, z1),
            }
            for _, face in gmsh.model.getBoundary([(3, volume)], oriented=False):
                centre = gmsh.model.occ.getCenterOfMass(2, face)
                group = next(group for group, (axis, at) in places.items() if abs(centre[axis] - at) < 1e-9)
                gmsh.model.addPhysicalGroup(2, [face], name=f"{name}.{group}")
                if hexahedra:
                    for _, edge in gmsh.model.getBoundary([(2, face)], oriented=False):
                        length = gmsh.model.occ.getMass(1, edge)
                        gmsh.model.mesh.setTransfiniteCurve(edge, round(length / size) + 1)
                    gmsh.model.mesh.setTransfiniteSurface(face)
                    gmsh.model.mesh.setRecombine(2, face)
            if hexahedra:
                gmsh.model.mesh.setTransfiniteVolume(volume)
        gmsh.model.mesh.generate(3)
        gmsh.write(str(path))
    return path


@pytest.fixture
def bars(tmp_path: Path) -> Callable[..., Path]:
    """The file with a mesh of bars, by name and (X, Y, Z from and to, mm), of elements of a kind and a size, mm."""

    def build(boxes: dict[str, Box], kind: str = "hexahedron27", size: float = 5.0) -> Path:
        return _mesh(tmp_path / "bars.msh", boxes, kind, size)

    return build
