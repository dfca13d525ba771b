"""The deck of a scene: words both readers know, a mesh in their order, loads and holds that mean what it says."""

import re
from collections import defaultdict

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import (
    Bed,
    Clamp,
    ContactPair,
    GapTable,
    Gravity,
    Ground,
    Helix,
    Joint,
    Line,
    LineLoad,
    Material,
    Orthotropic,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    RoundGap,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
    Support,
)
from reference3d.peers.deck import deck_text, make_deck

# Keywords and their parameters that the decks may use: those of the Abaqus Keywords Reference Manual, all of which
# CalculiX reads.
ABAQUS = {
    "HEADING": set(),
    "NODE": {"NSET"},
    "ELEMENT": {"TYPE", "ELSET"},
    "MATERIAL": {"NAME"},
    "ELASTIC": {"TYPE"},
    "ORIENTATION": {"NAME", "SYSTEM"},
    "SOLID SECTION": {"ELSET", "MATERIAL", "ORIENTATION"},
    "ELSET": {"ELSET"},
    "NSET": {"NSET"},
    "SPRING": {"ELSET"},
    "SURFACE": {"NAME", "TYPE"},
    "SURFACE INTERACTION": {"NAME"},
    "SURFACE BEHAVIOR": {"PRESSURE-OVERCLOSURE"},
    "CONTACT PAIR": {"INTERACTION", "TYPE", "SMALL SLIDING"},
    "CLEARANCE": {"MASTER", "SLAVE", "VALUE"},
    "EQUATION": set(),
    "BOUNDARY": set(),
    "STEP": set(),
    "STATIC": set(),
    "CONTROLS": {"PARAMETERS"},
    "CLOAD": set(),
    "NODE PRINT": {"NSET"},
    "CONTACT PRINT": {"SLAVE", "MASTER"},
    "NODE FILE": set(),
    "EL FILE": set(),
    "END STEP": set(),
}
# Nodes of the faces of a 20-node brick, Abaqus Elements Guide.
FACES = {
    "S3": (1, 5, 6, 2, 17, 13, 18, 9),
    "S4": (2, 6, 7, 3, 18, 14, 19, 10),
    "S5": (3, 7, 8, 4, 19, 15, 20, 11),
    "S6": (4, 8, 5, 1, 20, 16, 17, 12),
}
STEEL = Material(2e5, 0.3, 7.85e-9)
SQUAT = Rectangle(8.0, 10.0)
WOOD = Orthotropic((500.0, 900.0, 11000.0), (700.0, 600.0, 50.0), (0.4, 0.02, 0.03))


def bar(name="bar", end=(60.0, 0.0, 0.0), start=(0.0, 0.0, 0.0), section=SQUAT, material=STEEL):
    line = Line(start, end, (0.0, 1.0, 0.0))
    return Rod(name, line, section, material, (0.0, line.length))


def scene(*rods, supports=None, loads=(), contacts=(), joints=(), beds=()):
    held = tuple(Clamp(rod.name, "start") for rod in rods) if supports is None else supports
    return Scene("of the test", rods, held, tuple(loads), tuple(contacts), tuple(joints), tuple(beds))


def everything():
    """A scene with one of almost everything."""
    askew = bar("a b", (50.0, 20.0, 10.0), material=WOOD)
    arc = Rod("a-b", Helix((0, 0, 90), (0, 40, 90), (0, 0, 1), 1.0, (0, 1, 0)), Ring(9.0, 5.0), WOOD, (0.0, 40.0))
    table = bar("table", start=(0.0, 40.0, 0.0), end=(60.0, 40.0, 0.0))
    second = bar("leaf", start=(0.0, 50.0, 0.0), end=(60.0, 50.0, 0.0))
    branch = bar("branch", start=(60.0, 50.0, 0.0), end=(80.0, 60.0, 0.0), section=Rectangle(5.0, 5.0))
    return scene(
        askew,
        arc,
        table,
        second,
        branch,
        supports=(
            Clamp("a b", "start", (0.1, 0.0, 0.0)),
            Clamp("a-b", "end"),
            Clamp("table", "start"),
            Clamp("leaf", "start"),
            Support("a b", 30.0, ("x", "y"), displacement=(0.01, 0.0)),
            Support("a b", askew.length, ("y", "turn s"), "mean"),
            Support("table", 60.0, ("y",)),
        ),
        loads=(SectionForce("branch", 20.0, (1.0, -20.0, 3.0)), Gravity("table", (0.0, -9810.0, 0.0))),
        contacts=(
            ContactPair("over", RodFace("table", "top"), RodFace("leaf", "bottom"), (20.0, 60.0), 0.1, 1e9),
            ContactPair("under", RodFace("table", "bottom"), Ground(), (30.0, 60.0), RoundGap(500.0, 40.0)),
        ),
        joints=(Joint((RodEnd("leaf", "end"), RodEnd("branch", "start"))),),
        beds=(Bed(RodFace("leaf", "top"), 0.0, 20.0, 3.0),),
    )


def keywords(text):
    """Every keyword line as its name and parameters."""
    for line in text.splitlines():
        if line.startswith("*") and not line.startswith("**"):
            name, *parameters = (part.strip() for part in line[1:].split(","))
            yield name, dict([*part.split("="), ""][:2] for part in parameters)


def blocks(text, keyword):
    """Parameters and data lines of every block of a keyword."""
    plain = re.sub(r"^\*\*.*\n", "", text, flags=re.MULTILINE)
    for block in re.split(r"^(?=\*)", plain, flags=re.MULTILINE)[1:]:
        head, *data = block.splitlines()
        if head.split(",")[0] == f"*{keyword}":
            yield head, data


def read_mesh(text):
    """Nodes by number and elements by set, read as the solvers read them."""
    nodes = {}
    for _, data in blocks(text, "NODE"):
        for line in data:
            number, *place = line.split(",")
            nodes[int(number)] = np.array([float(value) for value in place])
    elements = defaultdict(dict)
    for head, data in blocks(text, "ELEMENT"):
        if "C3D20" in head:
            for first, second in zip(data[::2], data[1::2], strict=True):
                number, *corners = (int(value) for value in (first + second).split(","))
                elements[head.split("ELSET=")[1]][number] = corners
    return nodes, elements


@pytest.fixture(scope="module")
def deck_of_everything():
    return make_deck(everything())


@pytest.mark.slow
def test_every_word_is_one_of_abaqus(deck_of_everything):
    text = deck_text(deck_of_everything)

    for name, parameters in keywords(text):
        assert set(parameters) <= ABAQUS[name]
    assert {"EQUATION", "SPRING", "CLEARANCE", "ORIENTATION"} <= {name for name, _ in keywords(text)}
    assert text.isascii()
    # names have 80 characters at most, lines 256
    assert max(len(value) for _, parameters in keywords(text) for value in parameters.values()) <= 80
    assert max(map(len, text.splitlines())) <= 256


def test_names_come_from_the_scene_and_each_is_given_once(deck_of_everything):
    deck = deck_of_everything

    sets = [parameters["ELSET"] for name, parameters in keywords(deck_text(deck)) if name in ("ELEMENT", "ELSET")]
    assert {deck.name("rod", "a b"), deck.name("rod", "a-b")} == {"ROD_A_B", "ROD_A_B_2"}
    assert len(sets) == len(set(sets))


@pytest.mark.parametrize("face", ["top", "bottom", "left", "right"])
def test_elements_are_turned_right_and_surfaces_lie_on_their_faces(face):
    rod = bar()
    pair = ContactPair("p", RodFace("bar", face), Ground(), (20.0, 60.0), 0.25)

    nodes, elements = read_mesh(text := deck_text(make_deck(scene(rod, contacts=[pair]))))

    for corners in (corners for one in elements.values() for corners in one.values()):
        place = np.array([nodes[number] for number in corners])
        along = [place[1] - place[0], place[3] - place[0], place[4] - place[0]]
        assert np.linalg.det(along) > 0.0
        assert place[8] == pytest.approx(0.5 * (place[0] + place[1]), abs=1e-9)
    # e2 is Y and e1 = e2 x t is -Z; ground lies across the gap
    axis, away = {"top": (1, 5.0), "bottom": (1, -5.0), "right": (2, -4.0), "left": (2, 4.0)}[face]
    by_number = {number: corners for one in elements.values() for number, corners in one.items()}
    listed = {head.split("ELSET=")[1]: data for head, data in blocks(text, "ELSET")}
    for expected, (_, data) in zip((away, away + 0.25 * np.sign(away)), blocks(text, "SURFACE"), strict=True):
        for name, side in (line.split(", ") for line in data):
            numbers = [int(number) for line in listed[name] for number in line.split(",")]
            places = [nodes[by_number[number][local - 1]] for number in numbers for local in FACES[side]]
            assert np.array(places)[:, axis] == pytest.approx(expected, abs=1e-9)
    zone = np.array(places)[:, 0]
    assert zone.min() < 20.0  # ground reaches a little farther than the zone
    assert zone.max() > 60.0


@pytest.mark.parametrize("section", [Rectangle(8.0, 10.0), Ring(12.0, 6.0)])
def test_what_the_20_nodes_of_bricks_can_say_is_expanded_exactly(section):
    rod = make_deck(scene(bar(section=section))).rods["bar"]
    mesh = rod.mesh
    corner = mesh.number > 0
    grid = mesh.position[..., 0] if isinstance(section, Ring) else mesh.position @ np.array([1.0, 2.0, -0.5])

    field = grid + 0.1 * grid**2 if isinstance(section, Rectangle) else grid
    expanded = mesh.expansion @ field[corner]

    # quadratic polynomials where elements are boxes; on curved ones only what does not vary over them
    if isinstance(section, Rectangle):
        assert expanded == pytest.approx(field.ravel(), rel=1e-12)
    else:
        assert mesh.expansion @ np.ones(corner.sum()) == pytest.approx(np.ones(corner.size), rel=1e-14)


@pytest.mark.parametrize(
    ("load", "force", "moment"),
    [
        (SectionForce("bar", 30.0, (1.0, -2.0, 3.0)), (1.0, -2.0, 3.0), (0.0, -90.0, -60.0)),
        (SectionMoment("bar", 30.0, (10.0, 20.0, -30.0)), (0.0, 0.0, 0.0), (10.0, 20.0, -30.0)),
        (LineLoad("bar", 20.0, 40.0, (0.0, -1.0, 0.5)), (0.0, -20.0, 10.0), (0.0, -300.0, -600.0)),
        (Pressure(RodFace("bar", "top"), 10.0, 30.0, 2.0), (0.0, -320.0, 0.0), (0.0, 0.0, -6400.0)),
        (Gravity("bar", (0.0, 0.0, 1e6)), (0.0, 0.0, 37.68), (0.0, -1130.4, 0.0)),
    ],
)
def test_loads_become_nodal_forces_of_the_same_resultant(load, force, moment):
    text = deck_text(make_deck(scene(bar(), loads=[load]), scale=0.5))

    nodes, _ = read_mesh(text)
    found, turning = np.zeros(3), np.zeros(3)
    for _, data in blocks(text, "CLOAD"):
        for number, axis, value in (line.split(",") for line in data):
            vector = float(value) * np.eye(3)[int(axis) - 1]
            found, turning = found + vector, turning + np.cross(nodes[int(number)], vector)
    assert found == pytest.approx(0.5 * np.array(force), abs=1e-8)
    assert turning == pytest.approx(0.5 * np.array(moment), abs=1e-6)


def test_equations_hold_in_rigid_motions_and_eliminate_each_unknown_once():
    askew = bar("askew", (50.0, 20.0, 10.0))
    other = bar("other", start=askew.centre_line.end, end=(80.0, 60.0, 30.0), section=Rectangle(5.0, 5.0))
    middle = Support("askew", 30.0, ("x", "s", "turn y"), "mean")
    deck = make_deck(
        scene(
            askew,
            other,
            supports=(Clamp("askew", "start"), middle),
            joints=[Joint((RodEnd("askew", "end"), RodEnd("other", "start")))],
        )
    )
    moved, turned = np.array([0.3, -0.2, 0.5]), np.array([0.01, 0.02, -0.03])
    place = dict(deck.holds.points)
    for rod in deck.rods.values():
        place |= dict(enumerate(rod.mesh.coordinates, rod.mesh.first_node))
    values = {node: moved + np.cross(turned, at) for node, at in place.items()}
    # points beyond the mesh: mean motions of the section in its frame, then displacement and rotation of the joint
    e1, e2, t = askew_axes = deck.rods["askew"].body.axes[0]
    *means, _, rotation = deck.holds.points
    section = values[means[0]]
    assert np.allclose(askew_axes @ askew_axes.T, np.eye(3))
    for point, value in zip(means, (e1 @ section, t @ section, e2 @ turned), strict=True):
        values[point] = np.array([value, 0.0, 0.0])
    values[rotation] = turned

    sums = [sum(term.coefficient * values[term.node][term.axis - 1] for term in row) for row in deck.holds.equations]

    assert np.abs(sums).max() < 1e-9
    eliminated = [(row[0].node, row[0].axis) for row in deck.holds.equations]
    others = {(term.node, term.axis) for row in deck.holds.equations for term in row[1:]}
    assert len(set(eliminated)) == len(eliminated)
    assert others.isdisjoint(eliminated)


@pytest.mark.slow
def test_given_gaps_stand_for_the_drawn_distance_and_drawn_ones_do_not():
    leaves = bar("one"), bar("two", start=(0.0, 10.5, 0.0), end=(60.0, 10.5, 0.0))

    def clearances(gap):
        pair = ContactPair("p", RodFace("one", "top"), RodFace("two", "bottom"), (20.0, 60.0), gap)
        text = deck_text(make_deck(scene(*leaves, contacts=[pair]), scale=0.1))
        return [parameters["VALUE"] for name, parameters in keywords(text) if name == "CLEARANCE"]

    assert clearances(0.2) == ["0.02"]
    assert clearances("drawn") == []


def test_a_penalty_that_calculix_does_not_bear_is_lowered_and_said():
    text = deck_text(make_deck(load_case("two-cantilevers-e50-g0").scene))

    ((_, (stiffness, *_)),) = blocks(text, "SURFACE BEHAVIOR")
    assert float(stiffness) < 1e5
    assert "** Wanted is 1e+06" in text


@pytest.mark.parametrize("gap", [GapTable((20.0, 60.0), (0.0, 0.1)), RoundGap(500.0, 40.0)])
def test_a_gap_that_varies_between_rods_is_refused(gap):
    leaves = bar("one"), bar("two", start=(0.0, 10.0, 0.0), end=(60.0, 10.0, 0.0))
    pair = ContactPair("p", RodFace("one", "top"), RodFace("two", "bottom"), (20.0, 60.0), gap)

    with pytest.raises(SceneError, match=r"contacts\.p\.gap.*drawn"):
        make_deck(scene(*leaves, contacts=[pair]))


def test_a_rod_that_nothing_holds_is_refused():
    with pytest.raises(SceneError, match="nothing that holds 'bar'"):
        make_deck(scene(bar(), supports=()))
