"""Contact nodes, the complementarity problem and the contact patch test."""

from dataclasses import replace
from typing import get_args

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import nnls

from cases.scene import Clamp, ContactPair, Ground, Line, Material, Rectangle, Rod, RodFace, Scene, Support
from reference3d.contact import PointsOf, contact_nodes, near_contact, solve_complementarity, solve_nested
from reference3d.grading import Borders, rod_borders
from reference3d.quadratic import line_nodes, nodal_weights
from reference3d.solver import solve


def nodes_of(scene, refinement=1, symmetric=False):
    borders = {rod.name: rod_borders(scene, rod, refinement, symmetric) for rod in scene.rods}
    return contact_nodes(scene, scene.contacts[0], borders, symmetric), borders


def rigid_motion(borders, motion):
    s, y, x = np.meshgrid(*(line_nodes(axis) for axis in (borders.s, borders.y, borders.x)), indexing="ij")
    return np.stack(np.broadcast_arrays(*motion(x, y, s)), axis=-1).ravel()


def test_the_areas_are_those_of_the_zone(two_cantilevers):
    nodes, _ = nodes_of(two_cantilevers(50000.0, 0.0, pair={"zone": (210.0, 280.0)}))

    assert nodes.area.sum() == pytest.approx(70.0 * 15.0)
    assert (nodes.area > 0.0).all()
    assert (nodes.station[0], nodes.station[-1]) == pytest.approx((210.0, 280.0))
    # the end of the zone carries the weight of one element, not of the one beyond
    length = nodes.station[2] - nodes.station[0]
    assert nodes.area[0].sum() == pytest.approx(length / 6.0 * 15.0)


@pytest.mark.parametrize("of", ["second nodes", "first Gauss points"])
def test_other_contact_points_have_the_area_of_the_zone_too(two_cantilevers, of):
    # the upper bar points against the lower one and lies 4 mm aside: 11 mm of the widths overlap
    scene = two_cantilevers(50000.0, 0.0, upper=Line((500.0, 15.0, 4.0), (200.0, 15.0, 4.0), (0.0, 1.0, 0.0)))
    borders = {rod.name: rod_borders(scene, rod, 2, False) for rod in scene.rods}

    nodes = contact_nodes(scene, scene.contacts[0], borders, False, of)

    assert nodes.area.sum() == pytest.approx(100.0 * 11.0)
    assert (np.diff(nodes.station) > 0.0).all()
    assert (np.diff(nodes.lateral) > 0.0).all()
    assert nodes.area.ravel() @ np.repeat(nodes.station, len(nodes.lateral)) == pytest.approx(250.0 * 1100.0)


def test_on_matching_meshes_either_face_may_bear_the_nodes_and_gauss_points_share_the_force_alike(two_cantilevers):
    scene = two_cantilevers(20000.0, 0.0)

    first, second, gauss = (solve(scene, 1, contact_of=of) for of in get_args(PointsOf))

    points = [found.contact_points("lower-upper") for found in (first, second, gauss)]
    np.testing.assert_allclose(points[1].force, points[0].force, rtol=1e-6, atol=1e-6)
    # where the pressure acts within an element is seen differently on this coarse mesh
    assert points[2].force.sum() == pytest.approx(points[0].force.sum(), rel=1e-4)
    assert gauss.outcome == "converged"
    # resultant of the profile: it integrates the mean over the width along the zone
    profile = gauss.contact_profile("lower-upper")
    assert 15.0 * np.trapezoid(profile.mean, profile.station) == pytest.approx(points[2].force.sum(), rel=0.05)


def test_ground_has_no_nodes_and_other_scenes_no_other_points(two_cantilevers, cantilever):
    scene = two_cantilevers(50000.0, 0.0)
    on_ground = replace(scene, contacts=(replace(scene.contacts[0], second=Ground()),))
    free = replace(cantilever((0.0, 1.0, 0.0)), supports=(Support("rod", 0.0, ("x", "y", "s"), "section"),))

    with pytest.raises(ValueError, match="ground and has no nodes"):
        solve(on_ground, 1, contact_of="second nodes")
    with pytest.raises(ValueError, match="only clamped, parallel bars"):
        solve(free, 1, contact_of="first Gauss points")


def test_a_half_carries_half_the_area(two_cantilevers):
    nodes, _ = nodes_of(two_cantilevers(50000.0, 0.0), symmetric=True)

    assert nodes.area.sum() == pytest.approx(100.0 * 7.5)


@pytest.mark.parametrize(
    "upper",
    [
        Line((200.0, 15.0, 0.0), (500.0, 15.0, 0.0), (0.0, 1.0, 0.0)),
        Line((500.0, 15.0, 0.0), (200.0, 15.0, 0.0), (0.0, 1.0, 0.0)),
        Line((200.0, 15.0, 4.0), (500.0, 15.0, 4.0), (0.0, 1.0, 0.0)),
    ],
    ids=["as in the paper", "drawn the other way round", "moved sideways"],
)
def test_a_tilted_second_face_opens_by_its_rotation(two_cantilevers, upper):
    """u_Y = 0.01 (X - 250) + 0.02 Z of the second rod, the first at rest: d is that value at the node."""
    scene = two_cantilevers(50000.0, 0.0, upper=upper)
    nodes, borders = nodes_of(scene)
    tangent = 1.0 if upper.start[0] < upper.end[0] else -1.0

    def motion(x, y, s):
        # e1 = e2 x t is along -Z for a tangent along X
        at_x, at_z = upper.start[0] + tangent * s, upper.start[2] - tangent * x
        return 0 * x, 0.01 * (at_x - 250.0) + 0.02 * at_z, 0 * x

    opening = (nodes.second @ rigid_motion(borders["upper"], motion)).reshape(nodes.area.shape)

    expected = 0.01 * (nodes.station[:, None] - 250.0) - 0.02 * nodes.lateral
    np.testing.assert_allclose(opening, expected, atol=1e-12)


def test_moving_the_first_face_along_its_normal_closes_the_gap(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0)
    nodes, borders = nodes_of(scene)

    closing = nodes.first @ rigid_motion(borders["lower"], lambda x, y, s: (0 * x, 0.3 + 0 * x, 0 * x))

    np.testing.assert_allclose(closing, -0.3, rtol=1e-12)


@given(seed=st.integers(0, 10_000), size=st.integers(1, 25))
def test_complementarity_agrees_with_nonnegative_least_squares(seed, size):
    """min |L^T F + L^-1 offset| over F >= 0 has the same optimality conditions (SciPy's Lawson-Hanson)."""
    random = np.random.default_rng(seed)
    factor = np.tril(random.normal(size=(size, size))) + 2.0 * np.eye(size)
    offset = random.normal(size=size)
    expected, _ = nnls(factor.T, -np.linalg.solve(factor, offset))

    found = solve_complementarity(factor @ factor.T, offset, offset < 0.0)

    assert found.outcome == "converged"
    np.testing.assert_allclose(found.force, expected, atol=1e-8 * max(1.0, expected.max()))


def test_a_matrix_on_which_block_pivoting_alone_cycles_is_solved():
    # found by searching small matrices of whole numbers; offsets of both signs, strong couplings
    matrix = np.array([[1.0, -1.0, 3.0], [-1.0, 2.0, -6.0], [3.0, -6.0, 19.0]])
    offset = np.array([1.0, -2.0, -2.0])
    visited = _block_sets(matrix, offset)
    assert len(visited) > len(set(visited))

    found = solve_complementarity(matrix, offset, np.zeros(3, dtype=bool))

    assert found.outcome == "converged"
    w = offset + matrix @ found.force
    assert min(found.force.min(), w.min()) > -1e-12
    assert found.force @ w == pytest.approx(0.0, abs=1e-12)


def _block_sets(matrix, offset, steps=8):
    active, visited = np.zeros(len(offset), dtype=bool), []
    for _ in range(steps):
        visited.append(tuple(active))
        force = np.zeros(len(offset))
        force[active] = np.linalg.solve(matrix[np.ix_(active, active)], -offset[active])
        w = offset + matrix @ force
        active = np.where(active, force >= 0.0, w < 0.0)
    return visited


@pytest.mark.parametrize("shapes", [[(40, 1)], [(31, 3), (17, 2)], [(5, 4)]])
def test_starting_on_every_other_station_changes_only_the_way(shapes):
    size = sum(stations * across for stations, across in shapes)
    random = np.random.default_rng(3)
    factor = np.tril(random.normal(size=(size, size))) * 0.2 + np.eye(size)
    matrix, offset = factor @ factor.T, random.normal(size=size)

    nested = solve_nested(matrix, offset, shapes)
    direct = solve_complementarity(matrix, offset, offset < 0.0)

    assert nested.outcome == "converged"
    np.testing.assert_allclose(nested.force, direct.force, atol=1e-12 * direct.force.max())


def test_no_node_near_contact_if_none_touches():
    assert not near_contact(np.array([1.0, 2.0]), np.zeros(0), 5.0).any()


def test_nodes_within_the_margin_are_near():
    near = near_contact(np.array([0.0, 2.0, 4.0, 9.0]), np.array([3.0]), 1.0)

    np.testing.assert_array_equal(near, [False, True, True, False])


def pressed_blocks(layered_box, dense_matrix, second_s, penalty, of="first nodes"):
    """Two blocks on one another under a uniform pressure of 10 MPa, all nodes in contact.

    Returns the pressure at the contact nodes and the nodes' tributary areas. The first block's bottom rests on a
    smooth table; the planes x = 0 and s = 0 of both slide, so that the exact stress is uniaxial.
    """
    side, section = 6.0, Rectangle(6.0, 6.0)
    lines = {
        "first": Line((0, 0, 0), (side, 0, 0), (0, 1, 0)),
        "second": Line((0, side, 0), (side, side, 0), (0, 1, 0)),
    }
    rods = tuple(Rod(name, line, section, Material(1000.0, 0.3), (0.0, side)) for name, line in lines.items())
    pair = ContactPair("pair", RodFace("first", "top"), RodFace("second", "bottom"), (0.0, side), 0.0, penalty)
    scene = Scene("blocks", rods, (Clamp("first", "start"),), (), (pair,))
    across = np.array([-3.0, 0.0, 3.0])
    borders = {
        "first": Borders(across, across, np.array([0.0, 2.0, 4.0, 6.0])),
        "second": Borders(across, across, np.asarray(second_s)),
    }
    nodes = contact_nodes(scene, pair, borders, False, of)

    blocks, loads, fixed = [], [], []
    for name in ("first", "second"):
        axes = borders[name]
        blocks.append(dense_matrix(layered_box(axes, Material(1000.0, 0.3))))
        shape = (2 * len(axes.s) - 1, 5, 5, 3)
        load, held = np.zeros(shape), np.zeros(shape, dtype=bool)
        held[:, :, 2, 0] = True
        held[0, :, :, 2] = True
        if name == "first":
            held[:, 0, :, 1] = True
        else:
            load[:, -1, :, 1] = -10.0 * np.outer(nodal_weights(axes.s, 0.0, side), nodal_weights(across, -3.0, 3.0))
        loads.append(load.ravel())
        fixed.append(held.ravel())
    size = len(loads[0])
    matrix = np.zeros((size + len(loads[1]),) * 2)
    matrix[:size, :size], matrix[size:, size:] = blocks
    rows = np.concatenate([nodes.first.toarray(), nodes.second.toarray()], axis=1)
    matrix += rows.T @ (penalty * nodes.area.ravel()[:, None] * rows)
    free = ~np.concatenate(fixed)
    displacement = np.zeros(len(free))
    displacement[free] = np.linalg.solve(matrix[np.ix_(free, free)], np.concatenate(loads)[free])
    return -penalty * (rows @ displacement), nodes.area.ravel()


def test_contact_patch_test_is_passed_on_matching_meshes(layered_box, dense_matrix):
    pressure, _ = pressed_blocks(layered_box, dense_matrix, [0.0, 2.0, 4.0, 6.0], penalty=1e5)

    # uniform to round-off, amplified by penalty / stiffness
    np.testing.assert_allclose(pressure, 10.0, rtol=1e-9)


# kind: frozen; largest relative error of the nodal pressure, from this code on 2026-11-22
@pytest.mark.parametrize(
    ("of", "penalty", "largest_error"),
    [
        ("first nodes", 1e3, 0.0253),
        ("first nodes", 1e5, 0.0460),
        ("second nodes", 1e3, 0.1840),
        ("second nodes", 1e5, 0.2622),
    ],
)
def test_contact_patch_test_error_on_non_matching_meshes(layered_box, dense_matrix, of, penalty, largest_error):
    """Node-to-surface contact does not pass it; this states by how much, for 3 elements on 2 unequal ones.

    The nodes of the coarser face, whose pressures jump less in bending, are farther off than those of the finer one.
    The resultant is exact, as every node's force is applied opposite it.
    """
    pressure, area = pressed_blocks(layered_box, dense_matrix, [0.0, 3.5, 6.0], penalty, of)

    assert pressure @ area == pytest.approx(10.0 * 36.0, rel=1e-10)
    assert np.abs(pressure / 10.0 - 1.0).max() == pytest.approx(largest_error, rel=0.01)
