"""Section meshes: area and second moments, refinement, faces, where points lie."""

import math

import numpy as np
import pytest

from cases.scene import Box, Circle, Polygon, Rectangle, Ring
from reference3d.section_mesh import face_edges, integrals, located, section_mesh, shapes

ANGLE_IRON = Polygon(((0.0, 0.0), (30.0, 0.0), (30.0, 5.0), (5.0, 5.0), (5.0, 40.0), (0.0, 40.0)))
HOLED = Polygon(
    ((0.0, 0.0), (30.0, 0.0), (30.0, 30.0), (0.0, 30.0)), (((10.0, 10.0), (20.0, 10.0), (20.0, 20.0), (10.0, 20.0)),)
)
# section, area, int y^2 dA about the centroid
SECTIONS = {
    "rectangle": (Rectangle(10.0, 20.0), 200.0, 10.0 * 20.0**3 / 12.0),
    "box": (Box(20.0, 30.0, 2.0), 20.0 * 30.0 - 16.0 * 26.0, (20.0 * 30.0**3 - 16.0 * 26.0**3) / 12.0),
    "circle": (Circle(10.0), 25.0 * math.pi, 10.0**4 * math.pi / 64.0),
    "ring": (Ring(20.0, 16.0), 36.0 * math.pi, (20.0**4 - 16.0**4) * math.pi / 64.0),
    "thick ring": (Ring(20.0, 4.0), 96.0 * math.pi, (20.0**4 - 4.0**4) * math.pi / 64.0),
    "square with a hole": (HOLED, 800.0, (30.0**4 - 10.0**4) / 12.0),
}


@pytest.mark.parametrize("refinement", [1, 2, 3])
@pytest.mark.parametrize("name", SECTIONS)
def test_area_is_exact_and_second_moments_nearly(name, refinement):
    section, area, moment = SECTIONS[name]

    found = integrals(section_mesh(section, refinement))

    assert found.area == pytest.approx(area, rel=1e-13)
    # parabolas for arcs: exact area by construction, moments to the square of what the edge is off, h^8
    curved = isinstance(section, Circle | Ring)
    assert found.yy == pytest.approx(moment, rel=3e-4 / refinement**7 if curved else 1e-13)
    assert [found.of_x.sum(), found.of_y.sum()] == pytest.approx([0.0, 0.0], abs=1e-12 * area * 30.0)


def test_the_centroid_of_a_polygon_is_laid_on_the_origin():
    mesh = section_mesh(ANGLE_IRON, 1)

    # 30 x 5 with its middle at (15, 2.5) and 5 x 35 at (2.5, 22.5)
    centroid = (150.0 * np.array([15.0, 2.5]) + 175.0 * np.array([2.5, 22.5])) / 325.0
    np.testing.assert_allclose(mesh.nodes.min(axis=0), -centroid, atol=1e-12)


def test_refinement_divides_every_element_into_k_by_k():
    coarse, fine = (section_mesh(ANGLE_IRON, refinement) for refinement in (1, 3))

    assert len(fine.quads) == 9 * len(coarse.quads)
    assert len(fine.nodes) == len(np.unique(np.round(fine.nodes, 7), axis=0))


def test_mean_motions_see_a_rigid_motion_as_it_is():
    mesh = section_mesh(ANGLE_IRON, 1)
    x, y = mesh.nodes.T
    displacement, rotation = np.array([1.0, 2.0, 3.0]), np.array([0.1, 0.2, 0.3])

    rigid = displacement + np.cross(rotation, np.stack([x, y, np.zeros_like(x)], axis=1))

    found = np.tensordot(integrals(mesh).mean_motion(), rigid, axes=2)
    np.testing.assert_allclose(found, [*displacement, *rotation], atol=1e-13)


@pytest.mark.parametrize("name", ["rectangle", "circle", "ring", "square with a hole"])
def test_points_are_found_in_all_elements_that_hold_them(name):
    mesh = section_mesh(SECTIONS[name][0], 2)
    rng = np.random.default_rng(7)
    inside = rng.uniform(-1.0, 1.0, (2, 60))
    place = np.einsum("an,nac->nc", shapes(*inside)[0], mesh.nodes[mesh.quads[rng.integers(0, len(mesh.quads), 60)]])
    place = np.concatenate([place, mesh.nodes])  # nodes are held by up to four elements

    element, local, share = located(mesh, place)

    back = np.einsum(
        "ank,nkac->nkc", shapes(*local.reshape(-1, 2).T)[0].reshape(9, *share.shape), mesh.nodes[mesh.quads[element]]
    )
    np.testing.assert_allclose(share.sum(axis=1), 1.0)
    np.testing.assert_allclose(np.where(share[..., None] > 0.0, back - place[:, None], 0.0), 0.0, atol=1e-10)
    assert np.abs(local[share > 0.0]).max() < 1.0 + 1e-6


@pytest.mark.parametrize(("face", "length"), [("top", 20.0), ("bottom", 20.0), ("left", 30.0), ("right", 30.0)])
def test_the_edges_of_a_face_cover_it(face, length):
    mesh = section_mesh(Box(20.0, 30.0, 2.0), 2)

    edges = face_edges(mesh, Box(20.0, 30.0, 2.0), face)

    ends = mesh.nodes[edges[:, 2]] - mesh.nodes[edges[:, 0]]
    assert np.abs(ends).sum() == pytest.approx(length)
    assert (ends.sum(axis=1) > 0.0).all()
