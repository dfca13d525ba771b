"""Points straight across the gap between faces of any rods, and the patches in which there are some."""

import math

import numpy as np
import pytest

from cases.scene import ContactPair, Ground, Helix, Line, Material, Rectangle, Rod, RodFace, RoundGap, Scene, SceneError
from reference3d.facing import opposite, patches, surface, surface_normal

SIDE = 10.0
BAR = Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0))


def rod(name, line):
    return Rod(name, line, Rectangle(SIDE, SIDE), Material(200e3, 0.3), (0.0, line.length))


def arch():
    """An arc of radius 90 at the underside, lowest over the middle of the bar, which it touches there."""
    start = (50.0 - 85.0 * math.sin(0.5), 95.0 - 85.0 * math.cos(0.5), 0.0)
    return rod("other", Helix(start, (50.0, 95.0, 0.0), (0.0, 0.0, 1.0), 1.0, (0.0, 1.0, 0.0)))


def scene(other, gap="drawn", zone=(0.0, 100.0), second=None):
    pair = ContactPair("pair", RodFace("bar", "top"), second or RodFace("other", "bottom"), zone, gap)
    return Scene("pair", (rod("bar", BAR), *([other] if other else [])), (), (), (pair,))


def test_under_an_arc_the_gap_is_its_sagitta():
    bar, station = rod("bar", BAR), np.array([30.0, 50.0, 62.0])
    lateral = np.array([-5.0, 1.0, 3.0])
    grid = station, lateral

    found = opposite(surface(bar, "top", *grid), surface_normal(bar, "top", *grid), arch(), "bottom")

    assert found.found.all()
    np.testing.assert_allclose(found.distance, 90.0 - np.sqrt(90.0**2 - (station - 50.0) ** 2), atol=1e-9)
    np.testing.assert_allclose(found.station, 42.5 + 85.0 * np.arcsin((station - 50.0) / 90.0), atol=1e-9)
    np.testing.assert_allclose(np.abs(found.lateral), np.abs(lateral), atol=1e-9)


def test_a_normal_of_a_twisted_face_is_square_to_it():
    twisted = rod("bar", Line((0.0, 0.0, 0.0), (100.0, 0.0, 0.0), (0.0, 1.0, 0.0), 2.0))
    station, lateral = np.array([0.0, 33.0, 100.0]), np.array([4.0, -5.0, 5.0])

    normal = surface_normal(twisted, "right", station, lateral)

    # it leans against the rod by the twist times the distance from the middle of the face; at the ends the slope is
    # that of 1e-4 of the length inside
    np.testing.assert_allclose(np.abs(normal[:, 0]), np.sin(np.arctan(0.02 * np.abs(lateral))), atol=3e-5)
    np.testing.assert_allclose(np.linalg.norm(normal, axis=1), 1.0)


def test_the_patch_of_crossing_rods_is_as_wide_as_they_are():
    across = Line((80.0, SIDE, -60.0), (80.0, SIDE, 20.0), (0.0, 1.0, 0.0))

    own, other = patches(scene(rod("other", across)), scene(rod("other", across)).contacts[0])

    # a point still counts as on a face 1e-6 of half a width beyond its border
    assert (own.start, own.end) == pytest.approx((75.0, 85.0), abs=1e-5)
    assert (other.start, other.end) == pytest.approx((55.0, 65.0), abs=1e-5)
    assert own.least is None


def test_a_gap_that_varies_is_least_where_it_is():
    curved = scene(arch(), zone=(30.0, 70.0))
    rounded = scene(None, RoundGap(4000.0, 37.5), (0.0, 100.0), Ground())

    own, other = patches(curved, curved.contacts[0])
    (alone,) = patches(rounded, rounded.contacts[0])

    assert (own.least, other.least) == pytest.approx((50.0, 42.5))
    assert (own.start, own.end) == (30.0, 70.0)
    assert (alone.start, alone.end, alone.least) == pytest.approx((0.0, 100.0, 37.5))


def test_a_zone_with_nothing_opposite_is_refused():
    across = Line((80.0, SIDE, -60.0), (80.0, SIDE, 20.0), (0.0, 1.0, 0.0))
    aside = scene(rod("other", across), zone=(0.0, 60.0))

    with pytest.raises(SceneError, match=r"contacts\.pair\.zone: found 0 \.\. 60; no point of rod 'other' lies"):
        patches(aside, aside.contacts[0])
