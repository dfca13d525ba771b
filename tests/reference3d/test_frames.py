"""Frames of rods, overlap of faces, symmetry of scenes."""

from dataclasses import replace

import numpy as np
import pytest

from cases.scene import GapTable, Line, RoundGap, SceneError
from reference3d.frames import gaps, is_symmetric, pair_overlap, rod_frame
from reference3d.scope import penalty

UP = (0.0, 1.0, 0.0)


def test_the_frame_is_right_handed_with_e2_along_up(two_cantilevers):
    frame = rod_frame(two_cantilevers(50000.0, 0.0).rod("lower"))

    # e1 = e2 x t = Y x X = -Z
    np.testing.assert_allclose(frame.axes, [[0, 0, -1], [0, 1, 0], [1, 0, 0]], atol=1e-15)
    np.testing.assert_allclose(np.cross(frame.axes[0], frame.axes[1]), frame.axes[2])


def test_the_overlap_is_the_zone_in_the_coordinates_of_both(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0, pair={"zone": (210.0, 280.0)})

    overlap = pair_overlap(scene, scene.contact("lower-upper"))

    assert overlap.first == ((210.0, 280.0), (-7.5, 7.5))
    assert overlap.second == ((10.0, 80.0), (-7.5, 7.5))


def test_a_rod_moved_sideways_overlaps_over_part_of_the_width(two_cantilevers):
    # e1 points along -Z
    scene = two_cantilevers(50000.0, 0.0, upper=Line((200.0, 15.0, 4.0), (500.0, 15.0, 4.0), UP))

    overlap = pair_overlap(scene, scene.contact("lower-upper"))

    assert overlap.first[1] == (-7.5, 3.5)
    assert overlap.second[1] == (-3.5, 7.5)


def test_a_rod_drawn_the_other_way_round_overlaps_at_its_end(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0, upper=Line((500.0, 15.0, 0.0), (200.0, 15.0, 0.0), UP))

    overlap = pair_overlap(scene, scene.contact("lower-upper"))

    assert overlap.second == ((200.0, 300.0), (-7.5, 7.5))
    np.testing.assert_allclose(overlap.sign * [210.0, 5.0] + overlap.shift, [290.0, -5.0])


@pytest.mark.parametrize(
    ("upper_end", "up", "key", "sentence"),
    [
        ((480.0, 15.0, 40.0), UP, "second.rod", "'upper' at 8.13 degrees to 'lower'"),
        ((480.0, 30.0, 0.0), UP, "second.face", "turned by 176.9 degrees"),
        ((480.0, 15.0, 0.0), (0.0, 1.0, 0.1), "second.face", "turned by 174.3 degrees"),
    ],
    ids=["rods at an angle", "faces at an angle", "rolled"],
)
def test_pairs_that_are_not_parallel_are_refused_by_name(two_cantilevers, upper_end, up, key, sentence):
    start = np.array([200.0, 15.0, 0.0])
    direction = (np.array(upper_end) - start) / np.linalg.norm(np.array(upper_end) - start)
    line = Line(tuple(start), tuple(start + 300.0 * direction), up)
    scene = two_cantilevers(50000.0, 0.0, upper=line, pair={"zone": (200.0, 250.0)})

    with pytest.raises(SceneError, match=sentence) as refused:
        pair_overlap(scene, scene.contact("lower-upper"))

    assert refused.value.key == f"contacts.lower-upper.{key}"


def test_the_paper_case_is_symmetric(two_cantilevers):
    assert is_symmetric(two_cantilevers(50000.0, 0.0))


@pytest.mark.parametrize(
    "change",
    [
        {"load": (0.0, -1000.0, 1.0)},
        {"upper": Line((200.0, 15.0, 1.0), (500.0, 15.0, 1.0), UP)},
    ],
    ids=["load across", "moved sideways"],
)
def test_what_breaks_the_symmetry_is_seen(two_cantilevers, change):
    assert not is_symmetric(two_cantilevers(50000.0, 0.0, **change))


def test_gaps_are_those_given_or_drawn(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0)
    station = np.array([200.0, 215.0, 250.0])

    def found(gap):
        return gaps(scene, replace(scene.contacts[0], gap=gap), station)

    np.testing.assert_allclose(found(0.3), 0.3)
    np.testing.assert_allclose(found(GapTable((210.0, 220.0), (0.1, 0.3))), [0.1, 0.2, 0.3])
    # a circle of radius 500: (s - 200)^2 / 1000 to second order, next term 2500^2 / (8 * 500^3)
    np.testing.assert_allclose(found(RoundGap(500.0, 200.0, 0.1)), [0.1, 0.325, 2.6], atol=0.01)
    np.testing.assert_allclose(found(RoundGap(-500.0, 200.0, 0.1)), [0.1, -0.125, -2.4], atol=0.01)
    np.testing.assert_allclose(found("drawn"), 0.0, atol=1e-12)  # bars 15 mm thick with axes 15 mm apart


def test_a_pair_without_a_penalty_has_a_stiff_one(two_cantilevers):
    scene = two_cantilevers(50000.0, 0.0)

    assert penalty(scene, scene.contacts[0]) == 1e6
    assert penalty(scene, replace(scene.contacts[0], penalty=None)) == pytest.approx(1e3 * 50000.0 / 15.0)
