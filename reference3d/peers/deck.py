"""A scene as an input file for Abaqus and CalculiX: 20-node hexahedra, contact of surfaces, one linear step.

Both read every line. Where they differ the file says so, and is written as CalculiX needs it. Loads of every kind are
given as the nodal forces that they do the same work as.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, GapTable, Ground, Line, Material, Orthotropic, RodFace, RoundGap, Scene, SceneError
from reference3d.facing import patches
from reference3d.holds import holds, require_held, structures
from reference3d.peers.deck_holds import Holds, deck_holds
from reference3d.peers.deck_mesh import GROUND_SIDE, Hexahedra, HexRod, hex_ground, hex_rod
from reference3d.scope import on_bed, penalty
from reference3d.solid_body import solid_body

Array = NDArray[np.float64]

# numbers and terms of equations in a line, and names' longest part that comes from a scene
IN_LINE, TERMS_IN_LINE, LONGEST_NAME = 16, 4, 32
# penalty, over the one that `scope` would choose, beyond which CalculiX takes ever more iterations to settle on what
# touches, and in the end does not; of the paper's bars the contact force then is off by less than 1e-5
STIFFEST = 5e-3
# largest correction of the displacements, over their increment, at which iterations may end; the usual 1e-2 ends them
# while what touches still changes, and contact forces are off by several per cent
CORRECTION = 1e-4
# name of the set of all nodes
ALL_NODES = "ALL_NODES"


@dataclass(frozen=True, eq=False)
class Surfaces:
    """The two surfaces of a contact pair: elements by the name of their face."""

    pair: ContactPair
    first: dict[str, list[int]]
    second: dict[str, list[int]]


@dataclass(frozen=True, eq=False)
class Deck:
    """Everything a deck says, with the numbers by which results are found again.

    Attributes
    ----------
    scale : by which loads, gaps and prescribed displacements are multiplied, and results with them
    rods : meshed, by name
    ground : by name of the contact pair
    """

    scene: Scene
    scale: float
    rods: Mapping[str, HexRod]
    ground: Mapping[str, Hexahedra]
    holds: Holds
    surfaces: tuple[Surfaces, ...]
    names: Mapping[tuple[str, str], str]

    def name(self, kind: str, of: str) -> str:
        """What the deck calls the 'rod', 'pair', 'first' or 'second' surface of a pair, ... of a name in the scene."""
        return self.names[kind, of]


def make_deck(scene: Scene, refinement: int = 1, scale: float = 1.0) -> Deck:
    """Mesh a scene for its deck.

    Parameters
    ----------
    refinement : k of `section_mesh` and `layers`
    scale : as in `Deck`

    Raises
    ------
    SceneError
        if a rod is held by nothing but contact, or both readers have no words for a gap.
    ValueError
        if `refinement` is below 1.
    """
    if refinement < 1:
        raise ValueError(f"refinement: found {refinement}; a whole number of at least 1 is needed")
    for pair in scene.contacts:
        _require_constant_gap(pair)
    bodies = {rod.name: solid_body(scene, rod, refinement) for rod in scene.rods}
    held = {name: holds(scene, body) for name, body in bodies.items()}
    require_held(scene, bodies, held, structures(scene))
    node, element = 1, 1
    rods: dict[str, HexRod] = {}
    ground: dict[str, Hexahedra] = {}
    for name, body in bodies.items():
        rods[name] = hex_rod(body, node, element)
        node, element = node + rods[name].mesh.node_count, element + rods[name].mesh.element_count
    for pair in scene.contacts:
        if isinstance(pair.second, Ground):
            mesh = hex_ground(scene, pair, rods[pair.first.rod], scale, node, element)
            ground[pair.name] = mesh
            node, element = node + mesh.node_count, element + mesh.element_count
    surfaces = tuple(_surfaces(scene, pair, rods, ground) for pair in scene.contacts)
    return Deck(scene, scale, rods, ground, deck_holds(scene, rods, scale, node), surfaces, _names(scene))


def _require_constant_gap(pair: ContactPair) -> None:
    if isinstance(pair.second, RodFace) and isinstance(pair.gap, GapTable | RoundGap):
        found = "a table" if isinstance(pair.gap, GapTable) else "a round gap"
        remedy = 'between rods a deck has one gap for all of a zone; draw the rods with theirs and write "drawn"'
        raise SceneError(f"contacts.{pair.name}.gap", found, remedy)


def _surfaces(scene: Scene, pair: ContactPair, rods: Mapping[str, HexRod], ground: Mapping[str, Hexahedra]) -> Surfaces:
    """Element faces that may touch: of the first rod those in the zone, of the second those opposite, and next ones."""
    first = rods[pair.first.rod]
    own = first.face(pair.first.face, first.layers(*pair.zone))
    if isinstance(pair.second, Ground):
        mesh = ground[pair.name]
        layers = np.arange(len(mesh.position) // 2)
        return Surfaces(pair, own, mesh.on_sides(layers, np.array(list(GROUND_SIDE.values()))))
    second = rods[pair.second.rod]
    opposite = patches(scene, pair)[1]
    reach = min(first.body.section.nodes.max(), second.body.section.nodes.max())
    other = second.face(pair.second.face, second.layers(opposite.start - reach, opposite.end + reach))
    return Surfaces(pair, own, other)


def _names(scene: Scene) -> dict[tuple[str, str], str]:
    """Names that both readers take: letters, digits and underscores, each one once whatever its case."""
    wanted = {("rod", rod.name): rod.name for rod in scene.rods}
    for pair in scene.contacts:
        second = f"{pair.second.rod}_{pair.second.face}" if isinstance(pair.second, RodFace) else "ground"
        wanted["pair", pair.name] = pair.name
        wanted["first", pair.name] = f"{pair.first.rod}_{pair.first.face}_{pair.name}"
        wanted["second", pair.name] = f"{second}_{pair.name}"
    names: dict[tuple[str, str], str] = {}
    for key, text in wanted.items():
        plain = re.sub(r"[^A-Z0-9_]", "_", text.upper())[:LONGEST_NAME]
        name, number = f"{key[0].upper()}_{plain}", 1
        while name in names.values():
            number += 1
            name = f"{key[0].upper()}_{plain}_{number}"
        names[key] = name
    return names


def deck_text(deck: Deck) -> str:
    """The input file."""
    return "\n".join(_lines(deck)) + "\n"


def _lines(deck: Deck) -> Iterator[str]:
    yield from _heading(deck)
    yield "*NODE, NSET=" + ALL_NODES
    for mesh in _meshes(deck).values():
        yield from _coordinates(mesh.first_node + np.arange(mesh.node_count), mesh.coordinates)
    for point, place in deck.holds.points.items():
        yield from _coordinates(np.array([point]), place[None])
    for name, mesh in _meshes(deck).items():
        yield f"*ELEMENT, TYPE=C3D20R, ELSET={name}"
        elements = mesh.elements.reshape(-1, 20)
        for number, nodes in enumerate(elements.tolist(), mesh.first_element):
            yield f"{number}, " + ", ".join(map(str, nodes[:10])) + ","
            yield ", ".join(map(str, nodes[10:]))
    for name, rod in deck.rods.items():
        yield from _material(deck, name, rod)
    for pair in deck.ground:
        # it does not move, so that its stiffness has no meaning
        section = _ground_name(deck, pair)
        yield from (f"*MATERIAL, NAME=M_{section}", "*ELASTIC", "1., 0.")
        yield f"*SOLID SECTION, ELSET={section}, MATERIAL=M_{section}"
    yield from _springs(deck)
    yield from _contacts(deck)
    yield from _restraints(deck)
    yield from _step(deck)


def _heading(deck: Deck) -> Iterator[str]:
    yield "*HEADING"
    yield " ".join(f"rodcheck: {deck.scene.name}".encode("ascii", "replace").decode().split())[:80]
    yield "** N, mm, MPa. Read by Abaqus and by CalculiX."
    if deck.scale != 1.0:
        yield f"** Loads, gaps and prescribed displacements are multiplied by {deck.scale:g}; so are the results."
    if deck.scene.contacts:
        yield "** One increment, as CalculiX pairs the surfaces anew in each, on the deformed shape. Small sliding"
        yield "** is for Abaqus, which then keeps the pairs of the undeformed shape, and takes *CLEARANCE with it"
        yield "** alone; CalculiX warns that it does without."


def _meshes(deck: Deck) -> dict[str, Hexahedra]:
    """Meshes by the name of their element set."""
    rods = {deck.name("rod", name): rod.mesh for name, rod in deck.rods.items()}
    return rods | {_ground_name(deck, pair): mesh for pair, mesh in deck.ground.items()}


def _ground_name(deck: Deck, pair: str) -> str:
    return f"GROUND_{deck.name('pair', pair)}"


def _coordinates(numbers: Array | NDArray[np.int64], places: Array) -> Iterator[str]:
    for number, (x, y, z) in zip(numbers.tolist(), places.tolist(), strict=True):
        yield f"{number}, {x:.12g}, {y:.12g}, {z:.12g}"


def _material(deck: Deck, name: str, rod: HexRod) -> Iterator[str]:
    elset, material, line = deck.name("rod", name), rod.body.rod.material, rod.body.rod.centre_line
    yield f"*MATERIAL, NAME=M_{elset}"
    if isinstance(material, Material):
        yield from ("*ELASTIC", f"{material.young_modulus:.12g}, {material.poisson_ratio:.12g}")
        yield f"*SOLID SECTION, ELSET={elset}, MATERIAL=M_{elset}"
        return
    yield from _orthotropic(material)
    if isinstance(line, Line) and line.twist == 0.0:
        yield from _orientation(f"O_{elset}", rod.body.axes[0])
        yield f"*SOLID SECTION, ELSET={elset}, MATERIAL=M_{elset}, ORIENTATION=O_{elset}"
        return
    yield "** The axes of the material turn along the rod; every layer of elements has those of its middle."
    for layer in range(len(rod.body.kind)):
        part = f"L{layer + 1}_{elset}"
        yield f"*ELSET, ELSET={part}"
        yield from _in_lines(rod.mesh.element_numbers(np.array([layer])).ravel().tolist())
        yield from _orientation(f"O_{part}", rod.body.axes[2 * layer + 1])
        yield f"*SOLID SECTION, ELSET={part}, MATERIAL=M_{elset}, ORIENTATION=O_{part}"


def _orthotropic(material: Orthotropic) -> Iterator[str]:
    (e1, e2, e3), (g23, g13, g12) = material.young_moduli, material.shear_moduli
    nu12, nu13, nu23 = material.poisson_ratios
    yield "*ELASTIC, TYPE=ENGINEERING CONSTANTS"
    yield ", ".join(f"{value:.12g}" for value in (e1, e2, e3, nu12, nu13, nu23, g12, g13)) + ","
    yield f"{g23:.12g}"


def _orientation(name: str, axes: Array) -> Iterator[str]:
    yield f"*ORIENTATION, NAME={name}, SYSTEM=RECTANGULAR"
    yield ", ".join(f"{value:.12g}" for value in axes[:2].ravel().tolist())


def _springs(deck: Deck) -> Iterator[str]:
    element = sum(mesh.element_count for mesh in _meshes(deck).values()) + 1
    for bed, nodes in deck.holds.springs.items():
        name = f"BED_{bed + 1}"
        yield f"*ELEMENT, TYPE=SPRING1, ELSET={name}"
        for number, node in enumerate(nodes, element):
            yield f"{number}, {node}"
        element += len(nodes)
        # CalculiX tells a stiffness from a direction by its decimal point
        yield from (f"*SPRING, ELSET={name}", "1", f"{deck.scene.beds[bed].modulus:.12e}")


def _contacts(deck: Deck) -> Iterator[str]:
    for surfaces in deck.surfaces:
        pair = surfaces.pair
        first, second, name = (deck.name(kind, pair.name) for kind in ("first", "second", "pair"))
        for surface, faces in ((first, surfaces.first), (second, surfaces.second)):
            for side, elements in faces.items():
                yield f"*ELSET, ELSET={side}_{surface}"
                yield from _in_lines(elements)
            yield f"*SURFACE, NAME={surface}, TYPE=ELEMENT"
            for side in faces:
                yield f"{side}_{surface}, {side}"
        yield f"*SURFACE INTERACTION, NAME=I_{name}"
        yield "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR"
        stiffness = contact_stiffness(deck.scene, pair)
        yield f"{stiffness:.12g}"
        if pair.penalty is not None and stiffness < pair.penalty:
            yield f"** Wanted is {pair.penalty:g}; CalculiX does not settle on what touches with so stiff a penalty."
        yield f"*CONTACT PAIR, INTERACTION=I_{name}, TYPE=SURFACE TO SURFACE, SMALL SLIDING"
        yield f"{first}, {second}"
        if isinstance(pair.second, RodFace) and isinstance(pair.gap, int | float):
            yield f"*CLEARANCE, MASTER={second}, SLAVE={first}, VALUE={deck.scale * pair.gap:.12g}"


def contact_stiffness(scene: Scene, pair: ContactPair) -> float:
    """Slope of pressure over penetration, N/mm^3: a bed's modulus, or the penalty as far as CalculiX bears it."""
    if on_bed(pair):
        return penalty(scene, pair)
    return min(penalty(scene, pair), STIFFEST * penalty(scene, replace(pair, penalty=None)))


def _restraints(deck: Deck) -> Iterator[str]:
    """Equations, sets of nodes that are held, and zero displacements."""
    if deck.holds.equations:
        yield "*EQUATION"
    for terms in deck.holds.equations:
        yield str(len(terms))
        for start in range(0, len(terms), TERMS_IN_LINE):
            part = terms[start : start + TERMS_IN_LINE]
            yield ", ".join(f"{term.node}, {term.axis}, {term.coefficient:.12g}" for term in part)
    for (rod, station), nodes in deck.holds.clamped.items():
        yield f"*NSET, NSET={clamp_name(deck, rod, station)}"
        yield from _in_lines(nodes.tolist())
    for pair, mesh in deck.ground.items():
        yield f"*NSET, NSET=N_{_ground_name(deck, pair)}"
        yield from _in_lines((mesh.first_node + np.arange(mesh.node_count)).tolist())
    yield "*BOUNDARY"
    for pair in deck.ground:
        yield f"N_{_ground_name(deck, pair)}, 1, 3"
    zeros = {key for key, value in deck.holds.given.items() if value == 0.0}
    for (rod, station), nodes in deck.holds.clamped.items():
        own = {(node, axis) for node in nodes.tolist() for axis in (1, 2, 3)}
        if own <= zeros:
            yield f"{clamp_name(deck, rod, station)}, 1, 3"
            zeros -= own
    for node, axis in sorted(zeros):
        yield f"{node}, {axis}, {axis}"


def clamp_name(deck: Deck, rod: str, station: float) -> str:
    """Name of the set of nodes of a clamped section."""
    return f"HELD_{list(deck.holds.clamped).index((rod, station)) + 1}_{deck.name('rod', rod)}"


def _step(deck: Deck) -> Iterator[str]:
    yield from ("*STEP", "*STATIC", "1., 1., 1., 1.")
    if deck.surfaces:
        yield "** Iterations end where nothing changes; the usual tolerance is met while what touches still does."
        yield from ("*CONTROLS, PARAMETERS=FIELD", f"0.005, {CORRECTION:g}")
    moved = sorted((key, value) for key, value in deck.holds.given.items() if value != 0.0)
    if moved:
        yield "*BOUNDARY"
        yield from (f"{node}, {axis}, {axis}, {value:.12g}" for (node, axis), value in moved)
    loads = list(_cloads(deck))
    if loads:
        yield "*CLOAD"
        yield from loads
    yield from (f"*NODE PRINT, NSET={ALL_NODES}", "U, RF")
    for surfaces in deck.surfaces:
        first, second = (deck.name(kind, surfaces.pair.name) for kind in ("first", "second"))
        yield from (f"*CONTACT PRINT, SLAVE={first}, MASTER={second}", "CFN")
    yield from ("*NODE FILE", "U", "*EL FILE", "S", "*END STEP")


def _cloads(deck: Deck) -> Iterator[str]:
    for rod in deck.rods.values():
        forces = deck.scale * rod.forces(deck.scene.loads)
        largest = float(np.abs(forces).max(initial=0.0))
        for index, axis in np.argwhere(np.abs(forces) > 1e-15 * largest).tolist():
            yield f"{rod.mesh.first_node + index}, {axis + 1}, {forces[index, axis]:.12g}"


def _in_lines(numbers: Iterable[int]) -> Iterator[str]:
    given = list(numbers)
    for start in range(0, len(given), IN_LINE):
        yield ", ".join(map(str, given[start : start + IN_LINE]))
