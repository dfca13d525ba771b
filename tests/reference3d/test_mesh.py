"""Structured meshes of boxes from gmsh."""

import subprocess
import sys

import numpy as np
import pytest
from skfem import Basis, ElementHex1

from reference3d.mesh import box_mesh


@pytest.fixture
def mesh(graded_borders):
    return box_mesh(graded_borders.x, graded_borders.y, graded_borders.s)


def test_the_mesh_has_the_borders_asked_for(mesh, graded_borders):
    for coordinates, borders in zip(mesh.p, (graded_borders.x, graded_borders.y, graded_borders.s), strict=True):
        # gmsh stores the borders as fractions of the length
        np.testing.assert_allclose(np.unique(np.round(coordinates, 9)), borders, atol=1e-9)


def test_elements_are_ordered_with_x_fastest_and_s_slowest(mesh, graded_borders):
    centres = mesh.p[:, mesh.t].mean(axis=1)
    middles = [0.5 * (axis[1:] + axis[:-1]) for axis in (graded_borders.x, graded_borders.y, graded_borders.s)]

    s, y, x = (grid.ravel() for grid in np.meshgrid(*middles[::-1], indexing="ij"))

    np.testing.assert_allclose(centres, [x, y, s], atol=1e-9)


def test_reference_axes_lie_along_x_y_and_s(mesh):
    jacobian = Basis(mesh, ElementHex1(), intorder=1).mapping.DF(np.full((3, 1), 0.5))[:, :, :, 0]

    off_diagonal = jacobian[~np.eye(3, dtype=bool)]

    assert (np.einsum("aae->ae", jacobian) > 0.0).all()
    assert np.abs(off_diagonal).max() < 1e-9


def test_the_volume_is_that_of_the_box(mesh):
    volume = Basis(mesh, ElementHex1(), intorder=2).dx.sum()

    assert volume == pytest.approx(7.0 * 4.0 * 8.0, rel=1e-12)


@pytest.mark.slow
def test_importing_the_package_does_not_import_gmsh():
    code = "import sys, reference3d; assert 'gmsh' not in sys.modules"

    finished = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=False)

    assert finished.returncode == 0, finished.stderr
