"""Elements along a rod, their levels and orders."""

import numpy as np
import pytest

from cases.scene import Line, Material, Rectangle, Rod
from rodmodel.mesh import RodMesh, rod_mesh, split, stretched

ROD = Rod(
    "rod",
    Line((0.0, 0.0, 0.0), (30.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
    Rectangle(1.0, 1.0),
    Material(1.0, 0.0),
    (0.0, 10.0, 20.0, 30.0),
)


def test_one_level_goes_for_all_elements_or_each_has_its_own() -> None:
    np.testing.assert_array_equal(rod_mesh(ROD, 3, 4).levels, [3, 3, 3])
    np.testing.assert_array_equal(rod_mesh(ROD, [5, 2, 3], 4).levels, [5, 2, 3])


def test_a_level_too_many_is_refused() -> None:
    with pytest.raises(ValueError, match="found 2 for rod 'rod', which has 3 elements"):
        rod_mesh(ROD, [5, 2], 4)


@pytest.mark.parametrize(("level", "order"), [(0, 4), (2.5, 4), ([1, 2, -3], 4), (2, 1)])
def test_levels_below_one_and_orders_below_two_are_refused(level, order) -> None:
    with pytest.raises(ValueError, match="whole numbers of at least"):
        rod_mesh(ROD, level, order)


def test_parts_of_an_element_keep_its_level_and_order() -> None:
    mesh = split(rod_mesh(ROD, [5, 2, 3], [4, 6, 8]), np.array([15.0, 20.0 + 1e-9, 25.0]))
    np.testing.assert_allclose(mesh.borders, [0, 10, 15, 20, 25, 30])
    np.testing.assert_array_equal(mesh.levels, [5, 2, 2, 3, 3])
    np.testing.assert_array_equal(mesh.orders, [4, 6, 6, 8, 8])


def test_stretching_keeps_levels_and_drops_elements_of_no_length() -> None:
    mesh = RodMesh(np.array([0.0, 10.0, 20.0, 30.0]), np.array([1, 2, 3]), np.array([4, 5, 6]))
    moved = stretched(mesh, (0, 1, 3), np.array([0.0, 16.0, 30.0]))
    np.testing.assert_allclose(moved.borders, [0, 16, 23, 30])
    gone = stretched(mesh, (0, 1, 2, 3), np.array([0.0, 12.0, 12.0, 30.0]))
    np.testing.assert_allclose(gone.borders, [0, 12, 30])
    np.testing.assert_array_equal(gone.levels, [1, 3])
