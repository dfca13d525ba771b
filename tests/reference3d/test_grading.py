"""Where element borders lie."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import GapTable, Line, LineLoad, RodFace, SectionForce
from reference3d.grading import rod_borders


@pytest.fixture
def scene(two_cantilevers):
    return two_cantilevers(50000.0, 0.0)


@pytest.mark.parametrize(("rod", "places"), [("lower", (0, 200, 300)), ("upper", (0, 100, 500 / 3, 300))])
def test_supports_loads_and_zone_ends_are_borders(scene, rod, places):
    borders = rod_borders(scene, scene.rod(rod), 2, symmetric=True).s

    for place in places:
        assert np.abs(borders - place).min() < 1e-9


@pytest.mark.parametrize(
    "more",
    [
        (),
        (SectionForce("lower", 249.3, (0.0, -1.0, 0.0)),),
        (LineLoad("upper", 31.0, 77.7, (0.0, -1.0, 0.0)), SectionForce("upper", 50.0, (0.0, 1.0, 0.0))),
    ],
    ids=["nothing in the zone", "force on the first rod", "loads on the second rod"],
)
@pytest.mark.parametrize("refinement", [1, 3])
def test_parallel_rods_have_matching_nodes_in_the_zone(scene, more, refinement):
    loaded = replace(scene, loads=(*scene.loads, *more))

    lower, upper = (rod_borders(loaded, rod, refinement, symmetric=True) for rod in loaded.rods)

    in_lower = lower.s[lower.s > 200.0 - 1e-9] - 200.0
    in_upper = upper.s[upper.s < 100.0 + 1e-9]
    np.testing.assert_allclose(in_lower, in_upper, atol=1e-9)
    np.testing.assert_array_equal(lower.x, upper.x)


def test_nodes_meet_nodes_through_a_stack_of_rods():
    """The force on the uppermost bar, 30 mm into both zones, is a border of the lowest, which is drawn backwards."""
    scene = load_case("bar-between-two-others").scene

    lower, middle, upper = (rod_borders(scene, rod, 2, symmetric=True).s for rod in scene.rods)

    stack = 60.0 + middle[middle < 60.0 + 1e-9]
    np.testing.assert_allclose(np.sort(120.0 - lower)[-len(stack) :], stack, atol=1e-9)
    np.testing.assert_allclose(upper[-len(stack) :], stack, atol=1e-9)
    assert np.abs(stack - 90.0).min() < 1e-9


def test_refinement_divides_every_coarse_cell(scene):
    rod = scene.rod("upper")
    coarse, fine = (rod_borders(scene, rod, k, symmetric=False) for k in (1, 3))

    for axis in ("x", "y", "s"):
        np.testing.assert_allclose(getattr(fine, axis)[::3], getattr(coarse, axis), atol=1e-9)


def test_neighbouring_elements_do_not_differ_much_in_length(scene):
    for rod in scene.rods:
        lengths = np.diff(rod_borders(scene, rod, 1, symmetric=True).s)

        # growth 0.5 per distance: at most 1 + 0.5 from cell to cell, and rounding of the number of cells
        assert max(max(a / b, b / a) for a, b in pairwise(lengths)) < 2.5


def test_the_half_is_half_of_the_full_width(scene):
    rod = scene.rod("lower")

    half, full = (rod_borders(scene, rod, 2, symmetric=choice).x for choice in (True, False))

    np.testing.assert_allclose(np.concatenate([-half[:0:-1], half]), full, atol=1e-12)


def test_the_border_of_a_narrower_overlap_is_a_border_of_elements(two_cantilevers):
    # upper bar moved sideways by 4 mm: the faces overlap over 11 mm of the width
    line = Line((200.0, 15.0, 4.0), (500.0, 15.0, 4.0), (0.0, 1.0, 0.0))
    scene = two_cantilevers(50000.0, 0.0, upper=line)

    x = rod_borders(scene, scene.rod("lower"), 1, symmetric=False).x

    # e1 points along -Z: the overlap runs from Z = -3.5, x = 3.5, to Z = 7.5, x = -7.5
    assert np.abs(x - 3.5).min() < 1e-9


def test_a_side_face_divides_the_height(two_cantilevers):
    # e1 points along -Z, so that a rod at larger Z lies left of the lower one
    line = Line((200.0, 4.0, 15.0), (500.0, 4.0, 15.0), (0.0, 1.0, 0.0))
    pair = {"first": RodFace("lower", "left"), "second": RodFace("upper", "right")}
    scene = two_cantilevers(50000.0, 0.0, upper=line, pair=pair, load=(0.0, 0.0, -1000.0))

    y = rod_borders(scene, scene.rod("lower"), 1, symmetric=False).y

    assert np.abs(y + 3.5).min() < 1e-9


def test_stations_of_a_gap_table_are_borders_of_both_rods(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0)
    (pair,) = scene.contacts
    gap = GapTable((150.0, 223.0, 271.0, 310.0), (0.5, 0.0, 0.2, 0.5))
    scene = replace(scene, contacts=(replace(pair, gap=gap),))

    lower, upper = (rod_borders(scene, rod, 2, symmetric=True).s for rod in scene.rods)

    for station in (223.0, 271.0):  # those in the zone; along the second rod they count from X = 200
        assert np.abs(lower - station).min() < 1e-9
        assert np.abs(upper - (station - 200.0)).min() < 1e-9
    assert np.abs(lower - 150.0).min() > 1e-3
