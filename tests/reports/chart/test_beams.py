"""Classical beams in contact, against closed forms (any textbook) and against what equilibrium and contact ask for."""

from __future__ import annotations

from dataclasses import replace

import pytest

from cases.loader import load_case
from cases.scene import Clamp, ContactPair, Line, LineLoad, Material, Rectangle, Rod, RodFace, Scene, SectionForce
from reports.chart.beams import THEORIES, NotBeams, Theory, solve_beams
from reports.stability.two_bars import beam_theory, two_bars

YOUNG, NU, SIDE, LENGTH = 200_000.0, 0.3, 15.0, 300.0
BENDING = YOUNG * SIDE**4 / 12.0
# k by Cowper for a rectangle, G = E / (2 (1 + nu))
SHEARING = 10.0 * (1.0 + NU) / (12.0 + 11.0 * NU) * YOUNG / (2.0 * (1.0 + NU)) * SIDE**2
FLEXIBLE = {"Euler-Bernoulli": 0.0, "Timoshenko": 1.0}


def bar(name: str, start: float, end: float, height: float = 0.0, up: tuple[float, float, float] = (0, 1, 0)) -> Rod:
    line = Line((start, height, 0.0), (end, height, 0.0), up)
    return Rod(name, line, Rectangle(SIDE, SIDE), Material(YOUNG, NU), (0.0, abs(end - start)))


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("drawn", [(0.0, LENGTH), (LENGTH, 0.0)], ids=["along X", "against X"])
def test_a_cantilever_bends_as_in_closed_form(theory: Theory, drawn: tuple[float, float]) -> None:
    rod = bar("rod", *drawn)
    force, line = 100.0, 0.5
    scene = Scene(
        "cantilever",
        (rod,),
        (Clamp("rod", "start"),),
        (SectionForce("rod", LENGTH, (0.0, -force, 0.0)), LineLoad("rod", 0.0, LENGTH, (0.0, -line, 0.0))),
        (),
    )

    found = solve_beams(scene, theory, 2)

    bent = force * LENGTH**3 / (3.0 * BENDING) + line * LENGTH**4 / (8.0 * BENDING)
    sheared = FLEXIBLE[theory] * (force * LENGTH + line * LENGTH**2 / 2.0) / SHEARING
    # exact elements: round-off alone
    assert found.largest_deflection["rod"] == pytest.approx(bent + sheared, rel=1e-9)
    assert found.clamp_moment["rod", 0.0] == pytest.approx(force * LENGTH + line * LENGTH**2 / 2.0, rel=1e-9)


def test_a_force_next_to_a_node_acts_there() -> None:
    """1e-4 mm beside the middle: nearer to the node there than nodes may be to one another."""
    place, force = 0.5 * LENGTH + 1e-4, 100.0
    load = SectionForce("rod", place, (0.0, -force, 0.0))
    scene = Scene("cantilever", (bar("rod", 0.0, LENGTH),), (Clamp("rod", "start"),), (load,), ())

    found = solve_beams(scene, "Euler-Bernoulli", 2)

    bent = force * place**2 * (3.0 * LENGTH - place) / (6.0 * BENDING)
    assert found.largest_deflection["rod"] == pytest.approx(bent, rel=1e-5)  # a force moved by 7e-7 of its arm


@pytest.mark.parametrize("theory", THEORIES)
def test_cantilevers_that_touch_at_a_tip_share_the_load_as_in_closed_form(theory: Theory) -> None:
    """The upper one reaches 100 mm over the lower one's tip and is pushed down at its own: they touch at that tip."""
    lower, upper = bar("lower", 0.0, 200.0), bar("upper", 0.0, LENGTH, SIDE)
    pair = ContactPair("pair", RodFace("lower", "top"), RodFace("upper", "bottom"), (0.0, 200.0), 0.0)
    load = SectionForce("upper", LENGTH, (0.0, -100.0, 0.0))
    scene = Scene("leaves", (lower, upper), (Clamp("lower", "start"), Clamp("upper", "start")), (load,), (pair,))

    found = solve_beams(scene, theory, 11)

    tip, shear = 200.0, FLEXIBLE[theory] / SHEARING
    at_tip = tip**2 * (3.0 * LENGTH - tip) / (6.0 * BENDING) + shear * tip
    own = tip**3 / (3.0 * BENDING) + shear * tip
    assert found.outcome == "converged"  # also with the point that both clamps hold
    assert found.contact_force["pair"] == pytest.approx(100.0 * at_tip / (2.0 * own), rel=1e-8)
    assert found.edges["pair"] == pytest.approx((tip, tip))


def test_the_papers_bars_touch_at_a_corner_where_beam_theory_says_so() -> None:
    """A gap that is nearly as wide as the free bar bends leaves a corner to touch."""
    scene = two_bars(gap=1.6)

    found = solve_beams(scene, "Euler-Bernoulli", 41)

    wanted = beam_theory(0.25, 1.6)
    assert wanted > 0.0
    assert found.contact_force["overlap"] == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("theory", THEORIES)
@pytest.mark.parametrize("name", ["two-cantilevers-e50-g05", "two-cantilevers-e20-g0", "three-leaf-spring"])
def test_clamps_carry_what_loads_and_contact_leave(name: str, theory: Theory) -> None:
    """Of the bar that the load is on: moments of load and contact about its clamp."""
    scene = load_case(name).scene

    found = solve_beams(scene, theory, 21)

    assert found.outcome == "converged"
    assert all(force > 0.0 for force in found.contact_force.values())
    if name == "three-leaf-spring":
        # each touches the next at a tip, 200 and 100 mm from the clamps, loaded by 1 kN at 300 mm
        assert found.clamp_moment["first", 0.0] == pytest.approx(3e5 - 200.0 * found.contact_force["upper"], rel=1e-6)
        assert found.clamp_moment["third", 0.0] == pytest.approx(100.0 * found.contact_force["lower"], rel=1e-6)
    else:
        least, most = (found.contact_force["overlap"] * edge for edge in found.edges["overlap"])
        assert least <= found.clamp_moment["lower", 0.0] <= most


def test_an_open_gap_leaves_the_bars_alone() -> None:
    found = solve_beams(two_bars(gap=50.0), "Timoshenko", 21)

    assert found.contact_force["overlap"] == 0.0
    assert found.edges["overlap"] == ()
    assert found.largest_deflection["lower"] == 0.0


@pytest.mark.parametrize(
    ("name", "why"),
    [
        ("crossed-cantilevers", "not parallel"),
        ("curved-bar-on-straight-bar", "not straight"),
        ("bar-lifting-off-a-bed", "bed"),
    ],
)
def test_other_scenes_are_refused_with_the_reason(name: str, why: str) -> None:
    with pytest.raises(NotBeams, match=why):
        solve_beams(load_case(name).scene, "Timoshenko", 6)


def test_a_load_across_the_plane_of_contact_is_refused() -> None:
    scene = two_bars()
    scene = replace(scene, loads=(*scene.loads, SectionForce("upper", 100.0, (0.0, 0.0, 5.0))))

    with pytest.raises(NotBeams, match="one plane"):
        solve_beams(scene, "Timoshenko", 6)
