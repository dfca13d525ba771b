"""A mesh is taken if it is the scene's, and refused in one sentence if it cannot be."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import meshio
import numpy as np
import pytest

from cases.scene import Clamp, ContactPair, Face, Ground, Line, Material, Rectangle, Rod, RodFace, Scene, SceneError
from reference3d.own_mesh.reading import read_rods

BAR = {"bar": (0.0, 40.0, -5.0, 5.0, -4.0, 4.0)}
HEXAHEDRON = np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)])


@pytest.fixture
def scene() -> Scene:
    line = Line((0.0, 0.0, 0.0), (40.0, 0.0, 0.0), (0.0, 1.0, 0.0))
    rod = Rod("bar", line, Rectangle(8.0, 10.0), Material(200_000.0, 0.3), (0.0, 40.0))
    return Scene("bar", (rod,), (Clamp("bar", "start"),), (), ())


def written(
    path: Path, points: np.ndarray, cells: list[tuple[str, list[list[int]]]], sets: dict[str, list[int]]
) -> Path:
    """A file of Abaqus, whose node sets name the faces and whose element set names the rod."""
    chosen = {"bar": [np.arange(len(block)) for _, block in cells]}
    points_of = {name: np.array(nodes) for name, nodes in sets.items()}
    mesh = meshio.Mesh(points, cells, cell_sets=chosen, point_sets=points_of)
    mesh.write(path, file_format="abaqus")
    return path


def two_bricks() -> tuple[np.ndarray, list[list[int]]]:
    """Two bricks one behind the other that fill the bar, nodes not merged."""
    first = HEXAHEDRON * (20.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    return np.concatenate([first, first + np.array([20.0, 0.0, 0.0])]), [list(range(8)), list(range(8, 16))]


@pytest.mark.parametrize("kind", ["hexahedron", "hexahedron20", "hexahedron27", "tetra", "tetra10"])
def test_elements_and_faces_are_found_by_name(bars: Callable[..., Path], scene: Scene, kind: str) -> None:
    mesh = read_rods(scene, bars(BAR, kind))["bar"]

    assert mesh.kind.name == kind
    jacobians, _ = mesh.volumes()
    assert (jacobians * mesh.kind.quadrature[1]).sum() == pytest.approx(3200.0)
    nodes = mesh.group_nodes("start")
    assert set(nodes) == set(np.flatnonzero(np.abs(mesh.nodes[:, 0]) < 1e-9))


def test_a_face_may_be_a_set_of_nodes(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], {"bar.start": [0, 3, 4, 7]})

    mesh = read_rods(scene, path)["bar"]

    assert sorted(mesh.group_nodes("start")) == [0, 3, 4, 7]


def test_a_missing_group_is_named_beside_those_there_are(bars: Callable[..., Path], scene: Scene) -> None:
    path = bars({"beam": BAR["bar"]}, "hexahedron", 10.0)

    with pytest.raises(SceneError, match=r"bars.msh: found no group 'bar', but 'beam', 'beam.bottom'"):
        read_rods(scene, path)


def test_a_missing_face_is_named(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], {"bar.end": [1, 2, 5, 6]})

    with pytest.raises(SceneError, match=r"no group 'bar.start', but 'bar', 'bar.end'"):
        read_rods(scene, path)


def test_a_face_that_is_none_of_the_surface_is_refused(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], {"bar.start": [0, 3]})

    with pytest.raises(SceneError, match=r"group 'bar.start': found no face of the rod's surface in it"):
        read_rods(scene, path)


def test_a_face_under_the_name_of_another_is_refused(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], {"bar.start": [1, 2, 5, 6]})

    with pytest.raises(SceneError, match=r"group 'bar.start': found nodes 40 mm off the face of rod 'bar'"):
        read_rods(scene, path)


@pytest.mark.parametrize(("face", "right"), [("top", True), ("bottom", False), ("left", False)])
def test_a_lateral_face_lies_where_the_scene_has_it(tmp_path: Path, scene: Scene, face: Face, right: bool) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    sets = {"bar.start": [0, 3, 4, 7], f"bar.{face}": [2, 3, 6, 7]}
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], sets)
    pair = ContactPair("floor", RodFace("bar", face), Ground(), (0.0, 40.0), 0.0)
    lying = Scene("lying", scene.rods, scene.supports, (), (pair,))

    if right:
        assert read_rods(lying, path)["bar"].groups[face].element.tolist() == [0]
    else:
        with pytest.raises(SceneError, match=f"group 'bar.{face}': found nodes .* mm off the face"):
            read_rods(lying, path)


def test_other_elements_are_refused(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    cells = [("wedge", [[0, 1, 3, 4, 5, 7], [1, 2, 3, 5, 6, 7]])]
    path = written(tmp_path / "bar.inp", points, cells, {"bar.start": [0, 3, 4, 7]})

    with pytest.raises(SceneError, match="found wedge; give one kind of element to a rod: one of hexahedron, "):
        read_rods(scene, path)


def test_lengths_in_metres_are_refused_by_the_volume(tmp_path: Path, scene: Scene) -> None:
    points = 1e-3 * (HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0))
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], {"bar.start": [0, 3, 4, 7]})

    with pytest.raises(SceneError, match=r"a volume of 3.2e-06 mm\^3; section times length of rod 'bar' is 3200 mm\^3"):
        read_rods(scene, path)


def test_a_body_in_pieces_is_refused(tmp_path: Path, scene: Scene) -> None:
    points, bricks = two_bricks()
    path = written(tmp_path / "bar.inp", points, [("hexahedron", bricks)], {"bar.start": [0, 3, 4, 7]})

    with pytest.raises(SceneError, match="2 pieces that share no node; a rod is one body"):
        read_rods(scene, path)


def test_elements_turned_inside_out_are_refused(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 5.0, 4.0)
    turned = [("hexahedron", [[4, 5, 6, 7, 0, 1, 2, 3]])]
    path = written(tmp_path / "bar.inp", points, turned, {"bar.start": [0, 3, 4, 7]})

    with pytest.raises(SceneError, match="1 of 1 elements turned inside out"):
        read_rods(scene, path)


def test_a_mesh_at_another_place_is_refused(tmp_path: Path, scene: Scene) -> None:
    points = HEXAHEDRON * (40.0, 10.0, 8.0) - (0.0, 4.0, 4.0)
    path = written(tmp_path / "bar.inp", points, [("hexahedron", [list(range(8))])], {"bar.start": [0, 3, 4, 7]})

    with pytest.raises(SceneError, match="centroid is 1 mm from that of the rod"):
        read_rods(scene, path)


@pytest.mark.parametrize(("name", "text"), [("bar.msh", "not a mesh"), ("bar.txt", "text"), ("none.msh", None)])
def test_what_is_no_mesh_is_refused(tmp_path: Path, scene: Scene, name: str, text: str | None) -> None:
    path = tmp_path / name
    if text is not None:
        path.write_text(text)

    with pytest.raises(SceneError, match=rf"{name}: found .*; give a mesh that meshio reads"):
        read_rods(scene, path)
