"""Stiffness of layers of 27-node boxes."""

import numpy as np
import pytest
from skfem import Basis, BilinearForm, ElementHex2, ElementVector
from skfem.helpers import ddot, div, eye, sym_grad

from cases.scene import Material
from reference3d.elasticity import element_stiffness, lame_parameters
from reference3d.field import Field, displacement, stress
from reference3d.grading import Borders
from reference3d.mesh import box_mesh
from reference3d.quadratic import line_nodes

STEEL = Material(200000.0, 0.3)


def nodal_field(borders, function):
    """Values of a function of (x, y, s) with 3 components at the nodes, shape (n_planes, n_y, n_x, 3)."""
    s, y, x = np.meshgrid(*(line_nodes(axis) for axis in (borders.s, borders.y, borders.x)), indexing="ij")
    return np.stack(function(x, y, s), axis=-1)


def forces(layered_box, borders, nodal, material=STEEL):
    planes = len(nodal)
    return layered_box(borders, material).apply(nodal.reshape(planes, -1)).reshape(nodal.shape)


def test_element_matrices_are_those_of_scikit_fem_own_assembly(graded_borders):
    mesh = box_mesh(graded_borders.x, graded_borders.y, graded_borders.s)
    lam, mu = lame_parameters(STEEL)

    @BilinearForm
    def weak_form(u, v, _):
        strain = sym_grad(u)
        return ddot(lam * eye(div(u), 3) + 2.0 * mu * strain, sym_grad(v))

    one = mesh.restrict(np.array([7]))
    basis = Basis(one, ElementVector(ElementHex2()), intorder=5)
    unknowns = basis.element_dofs[:, 0]
    expected = weak_form.assemble(basis).toarray()[np.ix_(unknowns, unknowns)]

    found = element_stiffness(mesh, np.array([7]), STEEL)[0]

    # scikit-fem orders the unknowns of a vector element by node, then component, as ours
    np.testing.assert_allclose(found, expected, atol=1e-10 * np.abs(expected).max())


@pytest.mark.parametrize(
    "motion",
    [
        lambda x, y, s: (1.0 + 0 * x, 0 * x, 0 * x),
        lambda x, y, s: (0 * x, 1.0 + 0 * x, 0 * x),
        lambda x, y, s: (0 * x, 0 * x, 1.0 + 0 * x),
        lambda x, y, s: (0 * x, -s, y),
        lambda x, y, s: (s, 0 * x, -x),
        lambda x, y, s: (-y, x, 0 * x),
    ],
    ids=["along x", "along y", "along s", "about x", "about y", "about s"],
)
def test_rigid_motions_cause_no_force_and_no_stress(layered_box, graded_borders, motion):
    nodal = nodal_field(graded_borders, motion)
    scale = np.abs(layered_box(graded_borders, STEEL).matrices).max() * np.abs(nodal).max()

    force = forces(layered_box, graded_borders, nodal)
    stresses = stress(Field(graded_borders, nodal), STEEL, np.array([[0.3, -1.0], [0.1, 0.5], [2.2, 3.0]]))

    assert np.abs(force).max() < 1e-13 * scale
    # strains of size 1 are resolved to round-off: 200000 MPa x 1e-14
    assert np.abs(stresses).max() < 1e-8


def test_constant_stress_is_reproduced_to_round_off(layered_box, graded_borders):
    """Patch test on a graded mesh: the nodal forces of a constant stress are its tractions, inside there are none."""
    strain = np.array([[3.0, 1.0, -2.0], [1.0, -1.0, 0.5], [-2.0, 0.5, 2.0]]) * 1e-4
    lam, mu = lame_parameters(STEEL)
    tensor = 2.0 * mu * strain + lam * np.trace(strain) * np.eye(3)
    nodal = nodal_field(graded_borders, lambda x, y, s: np.einsum("ab,b...->a...", strain, np.stack([x, y, s])))

    force = forces(layered_box, graded_borders, nodal)
    found = stress(Field(graded_borders, nodal), STEEL, np.array([[0.3, -1.0], [0.1, 0.5], [2.2, 3.0]]))

    largest = np.abs(force).max()
    assert np.abs(force[1:-1, 1:-1, 1:-1]).max() < 1e-12 * largest
    area = 7.0 * 4.0
    np.testing.assert_allclose(
        force[-1, 1:-1, 1:-1].sum(axis=(0, 1)) / tensor[:, 2] / area, _inner_share(graded_borders), rtol=1e-10
    )
    expected = tensor[[0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]
    np.testing.assert_allclose(found, np.stack([expected, expected], axis=1), rtol=1e-10)


def _inner_share(borders):
    """Part of the area of the end face that belongs to nodes off its edges."""
    from reference3d.quadratic import nodal_weights

    shares = [
        nodal_weights(axis, axis[0], axis[-1])[1:-1].sum() / (axis[-1] - axis[0]) for axis in (borders.x, borders.y)
    ]
    return shares[0] * shares[1]


def test_strains_of_a_smooth_solution_converge_with_the_second_power_of_the_mesh_size(layered_box, dense_matrix):
    """Manufactured solution: a harmonic potential's gradient, which needs no body force for any material."""

    def exact(x, y, s):
        # u = grad(phi), phi = exp(x) sin(0.6 y) sin(0.8 s): div u = 0 and the Laplacian of u vanishes
        ex = np.exp(x)
        return (
            ex * np.sin(0.6 * y) * np.sin(0.8 * s),
            0.6 * ex * np.cos(0.6 * y) * np.sin(0.8 * s),
            0.8 * ex * np.sin(0.6 * y) * np.cos(0.8 * s),
        )

    energies = []
    for elements in (1, 2, 4):
        line = np.linspace(0.0, 1.5, elements + 1)
        borders = Borders(line, line, line)
        nodal = nodal_field(borders, exact)
        inside = np.zeros(nodal.shape, dtype=bool)
        inside[1:-1, 1:-1, 1:-1] = True
        inside, flat = inside.ravel(), nodal.ravel().copy()
        matrix = dense_matrix(layered_box(borders, Material(1.0, 0.3)))
        flat[inside] = np.linalg.solve(matrix[np.ix_(inside, inside)], -matrix[np.ix_(inside, ~inside)] @ flat[~inside])
        places = np.linspace(0.05, 1.45, 12)
        points = np.stack([grid.ravel() for grid in np.meshgrid(places, places, places)])
        field = Field(borders, flat.reshape(nodal.shape))
        error = displacement(field, points) - np.stack(exact(*points))
        step = 1e-4
        strains = [
            (displacement(field, points + step * axis[:, None]) - displacement(field, points - step * axis[:, None]))
            - (np.stack(exact(*(points + step * axis[:, None]))) - np.stack(exact(*(points - step * axis[:, None]))))
            for axis in np.eye(3)
        ]
        energies.append((np.sqrt(np.mean(error**2)), np.sqrt(np.mean(np.square(strains))) / (2.0 * step)))
    rates = np.log2(np.array(energies[:-1]) / np.array(energies[1:]))

    # theory: 3 for displacements, 2 for gradients; 0.3 for meshes that are not yet fine
    assert (rates[-1] > [2.7, 1.7]).all(), rates


def test_equal_thicknesses_share_one_layer_matrix(layered_box):
    borders = Borders(np.array([0.0, 1.0]), np.array([0.0, 1.0]), np.array([0.0, 2.0, 3.0, 5.0, 6.0]))

    stiffness = layered_box(borders, STEEL)

    assert len(stiffness.matrices) == 2
    assert stiffness.kind[0] == stiffness.kind[2] != stiffness.kind[1] == stiffness.kind[3]
