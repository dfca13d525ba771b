"""Stretches in contact and their ends."""

import numpy as np
import pytest

from cases.loader import load_case
from rodmodel.assembly import ElementStore
from rodmodel.borders import natural_mesh
from rodmodel.contact import unilateral_contact
from rodmodel.stretches import Stretch, moved, moving_edges, same_topology, stretches_in_contact
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import contact_system


def test_ends_of_the_zone_are_not_edges() -> None:
    scene = load_case("two-cantilevers-e50-g0").scene
    edges, positions = moving_edges(scene, (Stretch("overlap", 200.0, 300.0),))
    assert edges == ()
    assert len(positions) == 0


def test_stretches_take_their_moved_ends() -> None:
    scene = load_case("two-cantilevers-e20-g0").scene
    stretches = (Stretch("overlap", 220.0, 230.0), Stretch("overlap", 250.0, 300.0))
    edges, positions = moving_edges(scene, stretches)
    np.testing.assert_array_equal(positions, [220.0, 230.0, 250.0])
    after = moved(stretches, edges, positions + 1.0)
    assert after == (Stretch("overlap", 221.0, 231.0), Stretch("overlap", 251.0, 300.0))
    assert same_topology(stretches, after)
    assert not same_topology(stretches, after[:1])


def test_ripples_inside_an_element_are_not_stretches() -> None:
    scene = load_case("two-cantilevers-e50-g0").scene
    meshes = {rod.name: natural_mesh(scene, rod, 3, 4) for rod in scene.rods}
    system = contact_system(scene, scene_mirrors(scene), meshes, ElementStore())
    forces = unilateral_contact(system.problem)
    closed = (forces.force.reshape(system.grids["overlap"].weight.shape)[:, :, 0] > 0.0).ravel()
    closed_runs = np.count_nonzero(np.diff(np.concatenate([[0], closed.astype(int)])) == 1)
    assert closed_runs > 1  # the mesh does show openings
    assert len(stretches_in_contact(system, forces)) == 1


def test_the_lowest_level_shows_where_contact_ends() -> None:
    """Within a contact point's distance of 4 mm, by how the gap opens beyond; h5 on moved borders says 221.68 mm."""
    scene = load_case("two-cantilevers-e50-g0").scene
    meshes = {rod.name: natural_mesh(scene, rod, 1, 6) for rod in scene.rods}
    system = contact_system(scene, scene_mirrors(scene), meshes, ElementStore())
    (stretch,) = stretches_in_contact(system, unilateral_contact(system.problem, settled=False))
    assert stretch.start == 200.0
    assert stretch.end == pytest.approx(221.68, abs=1.2)
    assert abs(stretch.end - 221.68) < stretch.slack
