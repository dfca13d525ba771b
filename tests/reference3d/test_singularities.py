"""Singular exponents solve the equations they come from, and the formal order is that of the worst of them."""

from dataclasses import replace

import numpy as np
import pytest

from cases.scene import Box, Circle, Material, Polygon, Rectangle, Ring
from reference3d.singularities import clamp_singularity_exponent, contact_corner_exponent, formal_order


def displacement(kappa, a, b, exponent, z):
    """2 mu (u + i v) of a z^lambda and b z^lambda (Kolosov; N. I. Muskhelishvili, 1953, section 32)."""
    phi, slope, psi = a * z**exponent, a * exponent * z ** (exponent - 1.0), b * z**exponent
    return kappa * phi - z * np.conj(slope) - np.conj(psi)


def resultant(a, b, exponent, z):
    """Force on the line from the corner to z, up to a factor."""
    phi, slope, psi = a * z**exponent, a * exponent * z ** (exponent - 1.0), b * z**exponent
    return phi + z * np.conj(slope) + np.conj(psi)


HEXAGON = Polygon(tuple((5.0 * np.cos(turn), 5.0 * np.sin(turn)) for turn in np.arange(6) * np.pi / 3.0))
POTENTIALS = ((1.0, 0.0), (1j, 0.0), (0.0, 1.0), (0.0, 1j))


@pytest.mark.parametrize("ratio", [0.1, 0.3, 0.45])
def test_at_a_clamp_displacements_and_tractions_of_r_to_the_lambda_can_vanish(ratio):
    exponent, kappa = clamp_singularity_exponent(ratio), 3.0 - 4.0 * ratio

    columns = []
    for a, b in POTENTIALS:
        clamped, free = displacement(kappa, a, b, exponent, 1.0 + 0j), resultant(a, b, exponent, 1j)
        columns.append([clamped.real, clamped.imag, free.real, free.imag])
    singular_values = np.linalg.svd(np.array(columns), compute_uv=False)

    assert 0.5 < exponent < 1.0
    assert singular_values[-1] < 1e-12 * singular_values[0]


def test_without_lateral_contraction_a_clamp_is_not_singular():
    assert clamp_singularity_exponent(0.0) == 1.0


@pytest.mark.parametrize("ratio", [0.1, 1.0, 5.0])
def test_a_corner_on_a_face_presses_without_friction_and_nothing_opens(ratio):
    """The corner fills 0 to 90 degrees, the body below it -180 to 0 degrees; they meet at 0 degrees."""
    exponent, kappa = contact_corner_exponent(ratio), 3.0 - 4.0 * 0.3
    columns = []
    # -0.0: the face of the lower body is met at -180 degrees
    for free_face, share, place in ((1j, ratio, 0), (complex(-1.0, -0.0), -1.0, 3)):
        for a, b in POTENTIALS:
            free, meeting = resultant(a, b, exponent, free_face), resultant(a, b, exponent, 1.0 + 0j)
            moved = share * displacement(kappa, a, b, exponent, 1.0 + 0j)
            column = np.zeros(8)
            # a free face and no friction on each body alone; pressures and displacements across the face are equal
            column[place : place + 3] = free.real, free.imag, meeting.imag
            column[6:] = np.sign(share) * meeting.real, moved.imag
            columns.append(column)
    singular_values = np.linalg.svd(np.array(columns), compute_uv=False)

    assert 0.5 < exponent < 1.0
    assert singular_values[-1] < 1e-12 * singular_values[0]


def test_a_rigid_corner_is_a_punch_and_a_rigid_face_takes_the_singularity_away():
    assert contact_corner_exponent(1e-9) == pytest.approx(0.5, abs=1e-6)
    assert contact_corner_exponent(1e9) == pytest.approx(1.0, abs=1e-6)
    # r^-0.226 of equal bodies (Dundurs and Lee, table 1)
    assert contact_corner_exponent(1.0) == pytest.approx(0.774, abs=5e-4)


@pytest.mark.parametrize("section", [Rectangle(15.0, 15.0), Circle(10.0), Ring(10.0, 7.0)])
def test_grading_restores_the_order_that_the_clamp_takes(cantilever, section):
    assert formal_order(cantilever((0.0, 1.0, 0.0), section=section)) == pytest.approx(
        4.0 * clamp_singularity_exponent(0.3)
    )
    assert formal_order(cantilever((0.0, 1.0, 0.0), poisson_ratio=0.0)) == 4.0


@pytest.mark.parametrize(("section", "order"), [(HEXAGON, 2.0), (Box(10.0, 10.0, 2.0), 4.0 / 3.0)])
def test_meshes_of_other_sections_are_not_graded_towards_their_faces_and_corners(cantilever, section, order):
    scene = cantilever((0.0, 1.0, 0.0), section=section, poisson_ratio=0.0)

    # without lateral contraction the clamp is not singular; the inner corners of a box are
    assert formal_order(scene) == pytest.approx(order)


def test_contact_edges_inside_elements_and_stiff_ends_on_soft_faces_limit_the_order(two_cantilevers):
    scene = two_cantilevers(200000.0, 0.0)
    without = tuple(replace(rod, material=Material(200000.0, 0.0)) for rod in scene.rods)
    stiff = (without[0], replace(without[1], material=Material(2e8, 0.0)))

    assert formal_order(replace(scene, rods=without)) == 3.0
    assert formal_order(replace(scene, rods=stiff)) == pytest.approx(4.0 * contact_corner_exponent(1e-3))
