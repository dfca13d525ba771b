"""One rod ready to be loaded: its condensed elements, its factorised chain, and linear functionals on it.

A functional (the normal displacement of a contact point, a load) is condensed as the elements are: a part on the
nodes, and for the elements it lies in, a part on their bubbles. Compliances are inner products of such halves.
"""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import Rod, Scene
from rodmodel.axial import shape_functions
from rodmodel.centre_line import by_turning, constant_turnings, knots, turning_at
from rodmodel.chain import Chain, node_fields
from rodmodel.face import Springs, bed_stiffness, springs_under
from rodmodel.holds import Held, Hold, extended, held_sections, hold, restricted
from rodmodel.mesh import SAME_BORDER, RodMesh
from rodmodel.section import Darboux, Fields, axial_modulus, per_axial_modulus, section_stiffness
from rodmodel.stiffness import (
    Element,
    ElementFamily,
    axial_quadrature,
    condensed_element,
    element_family,
    varying_element,
)

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
# Whether the solution is its own mirror image in x = 0, in y = 0 of the section.
Mirrors = tuple[bool, bool]


@dataclass(eq=False)
class ElementStore:
    """Elements and factors made so far, so that none is made twice: neighbours, rods and border positions share them.

    Attributes
    ----------
    chains : last chain of every rod, by name
    """

    _families: dict[Hashable, ElementFamily] = field(default_factory=dict)
    _elements: dict[Hashable, Element] = field(default_factory=dict)
    chains: dict[str, Chain] = field(default_factory=dict)

    def elements(self, rod: Rod, under: Sequence[Springs], fields: Sequence[Fields], mesh: RodMesh) -> list[Element]:
        """Condensed elements of the rod on its mesh, for unit axial modulus.

        under : beds under the faces of each element, their moduli in units of the axial modulus
        fields : of each element over the section
        """
        turnings = constant_turnings(rod.centre_line, mesh.borders)
        families: dict[Hashable, ElementFamily] = {}
        result = []
        for turning, springs, of_element, order, ends in zip(
            turnings, under, fields, mesh.orders.tolist(), pairwise(mesh.borders.tolist()), strict=True
        ):
            if turning is None:
                result.append(self._varying(rod, springs, of_element, order, ends))
                continue
            # Elements of a rod mostly are of few kinds: only these are looked up by all that they depend on.
            kind = (turning, springs, of_element, order)
            if kind not in families:
                families[kind] = self._family(rod, *kind)
            result.append(self._constant(families[kind], ends[1] - ends[0]))
        return result

    def _family(self, rod: Rod, turning: Darboux, springs: Springs, fields: Fields, order: int) -> ElementFamily:
        material = per_axial_modulus(rod.material)
        kind = (rod.section, material, fields, order, turning, springs)
        if kind not in self._families:
            section = section_stiffness(rod.section, material, fields, turning)
            if springs:
                section = replace(section, s00=section.s00 + bed_stiffness(rod.section, springs, fields, turning))
            self._families[kind] = element_family(order, fields, section, reversible=turning[2] == 0.0)
        return self._families[kind]

    def _constant(self, family: ElementFamily, length: float) -> Element:
        # Lengths that differ only by the round-off of the borders they come from are one length.
        key = (family, float(f"{length:.11e}"))
        if key not in self._elements:
            self._elements[key] = condensed_element(family, length)
        return self._elements[key]

    def forget(self, most: int) -> None:
        """Let go of the oldest elements beyond so many."""
        for key in list(self._elements)[:-most]:
            del self._elements[key]

    def _varying(self, rod: Rod, springs: Springs, fields: Fields, order: int, ends: tuple[float, float]) -> Element:
        material, line = per_axial_modulus(rod.material), rod.centre_line
        key = (line, rod.section, material, fields, order, springs, ends)
        if key not in self._elements:
            quadrature = axial_quadrature(order, *ends, knots(line))
            turning = turning_at(line, ends[0] + 0.5 * (ends[1] - ends[0]) * (1.0 + quadrature[0]))
            section = section_stiffness(rod.section, material, fields, turning)
            if springs:
                beds = by_turning(turning, lambda rates: bed_stiffness(rod.section, springs, fields, rates))
                section = replace(section, s00=section.s00 + beds)
            self._elements[key] = varying_element(order, fields, ends[1] - ends[0], quadrature, section)
        return self._elements[key]


@dataclass(frozen=True, eq=False)
class AssembledRod:
    """A rod with its elements and factorised stiffness.

    Attributes
    ----------
    borders : element borders, arc length, mm, shape (n_elements + 1,)
    holds : how nodes are held, by their number from 0 at the start
    """

    rod: Rod
    borders: Array
    elements: tuple[Element, ...]
    holds: Mapping[int, Hold]
    chain: Chain

    @property
    def unknowns(self) -> int:
        """Degrees of freedom that are not held: those carried by the nodes, and all bubbles."""
        return self.chain.size + sum(len(element.half_coupling) for element in self.elements)

    @property
    def level(self) -> int:
        """Highest level of any element."""
        return max(element.fields.level for element in self.elements)

    @property
    def order(self) -> int:
        """Highest order of any element."""
        return max(element.order for element in self.elements)

    def node_places(self, element: int, side: int) -> IntArray:
        """Where the fields of the node before (side 0) or after an element stand among the element's fields."""
        return self.chain.fields[element + side].within(self.elements[element].fields)

    def locate(self, station: Array) -> tuple[IntArray, Array]:
        """Element index and xi of stations (mm); a station on a border belongs to the element before it."""
        index = np.clip(np.searchsorted(self.borders, station, side="left") - 1, 0, len(self.elements) - 1)
        left, right = self.borders[index], self.borders[index + 1]
        return index, (2.0 * station - left - right) / (right - left)


def assembled_rod(
    scene: Scene, rod: Rod, mirrors: Mirrors, mesh: RodMesh, store: ElementStore, stays: Sequence[Held] = ()
) -> AssembledRod:
    """Make (or fetch from `store`) the elements of the mesh and factorise the chain.

    stays : sections held beside those that the scene says
    """
    levels = {level: Fields(level, *mirrors) for level in set(mesh.levels.tolist())}
    of_elements = [levels[level] for level in mesh.levels.tolist()]
    elements = tuple(store.elements(rod, springs_under(scene, rod, mesh.borders), of_elements, mesh))
    fields = node_fields(elements)
    holds = {}
    for held in (*held_sections(scene, rod), *stays):
        node = int(np.abs(mesh.borders - held.station).argmin())
        if abs(mesh.borders[node] - held.station) > SAME_BORDER:
            raise ValueError(f"rod '{rod.name}': no element border at the support at {held.station:g} mm")
        holds[node] = hold(scene, rod, held, fields[node])
    chain = Chain(
        elements,
        axial_modulus(rod.material),
        {node: each.free for node, each in holds.items()},
        previous=store.chains.get(rod.name),
    )
    store.chains[rod.name] = chain
    return AssembledRod(rod, mesh.borders, elements, holds, chain)


@dataclass(frozen=True, eq=False)
class Functionals:
    """m linear functionals on the degrees of freedom of an assembled rod, condensed and half solved.

    Attributes
    ----------
    nodal : L^-1 (c_n - K_nb K_bb^-1 c_b) with the chain's factor L, shape (n_carried, m)
    held : the condensed functionals on all fields of every node that is held, by node, shape (n_fields, m) each
    bubbles : for each element with bubbles involved: its index, the functionals' numbers, L_bb^-1 c_b of shape
        (n_bubbles, how many)
    """

    nodal: Array
    held: Mapping[int, Array]
    bubbles: tuple[tuple[int, IntArray, Array], ...]


@dataclass(frozen=True, eq=False)
class Part:
    """Share of one element in functionals: their coefficients on its nodes and bubbles.

    Attributes
    ----------
    element : its index
    columns : numbers of the functionals
    values : shape (order + 1, n_fields, len(columns)), order and fields being those of the element
    """

    element: int
    columns: IntArray
    values: Array


def point_parts(assembled: AssembledRod, station: Array, direction: Callable[[Fields], Array]) -> list[Part]:
    """Displacement at points of the rod, one functional a point.

    station : arc length of the points, mm, shape (m,)
    direction : gives the value of every field at the points, in the direction asked for, shape (n_fields, m)
    """
    index, xi = assembled.locate(station)
    directions: dict[Fields, Array] = {}
    along: dict[int, Array] = {}
    parts = []
    for number in np.unique(index):
        element = assembled.elements[number]
        if element.fields not in directions:
            directions[element.fields] = direction(element.fields)
        if element.order not in along:
            along[element.order] = shape_functions(element.order, xi)
            # They vanish on the nodes only up to round-off; there, nothing need be asked of the bubbles.
            along[element.order][2:, np.abs(xi) > 1.0 - 1e-12] = 0.0
        columns = np.flatnonzero(index == number)
        members = _as_slice(columns)
        values = along[element.order][:, None, members] * directions[element.fields][None, :, members]
        parts.append(Part(int(number), columns, values))
    return parts


def _as_slice(numbers: IntArray) -> slice | IntArray:
    """Ascending numbers as a slice where they follow one another: views cost less than copies."""
    start, end = int(numbers[0]), int(numbers[-1]) + 1
    return slice(start, end) if end - start == len(numbers) else numbers


def add_to(matrix: Array, numbers: IntArray, block: Array) -> None:
    """Add a block to the rows and columns of a matrix with ascending numbers."""
    if len(numbers):
        chosen = _as_slice(numbers)
        matrix[(chosen, chosen) if isinstance(chosen, slice) else np.ix_(chosen, chosen)] += block


def functionals(assembled: AssembledRod, parts: Sequence[Part], count: int) -> Functionals:
    """Condense `count` functionals, given by the shares of the elements, and half solve them."""
    chain = assembled.chain
    nodal = np.zeros((chain.size, count))
    held = {node: np.zeros((len(each.given), count)) for node, each in assembled.holds.items()}
    root = np.sqrt(axial_modulus(assembled.rod.material))
    bubbles = []
    for part in parts:
        element, columns = assembled.elements[part.element], _as_slice(part.columns)
        on_nodes, on_bubbles = part.values[:2], part.values[2:]
        if on_bubbles.any():
            half = element.bubbles.half_solve(on_bubbles.reshape(len(element.half_coupling), -1))
            on_nodes = on_nodes - (element.half_coupling.T @ half).reshape(on_nodes.shape)
            bubbles.append((part.element, part.columns, half / root))
        for side in (0, 1):
            node = part.element + side
            nodal[chain.rows[node]][:, columns] += restricted(on_nodes[side], chain.ends[part.element][side])
            if node in held:
                held[node][:, columns] += on_nodes[side, assembled.node_places(part.element, side)]
    return Functionals(chain.half_solve(nodal), held, tuple(bubbles))


def combined(functionals: Functionals, weights: Array) -> Functionals:
    """Linear combinations of functionals; weights of shape (m, m_new)."""
    n_new = weights.shape[1]
    bubbles = tuple((index, np.arange(n_new), half @ weights[members]) for index, members, half in functionals.bubbles)
    held = {node: values @ weights for node, values in functionals.held.items()}
    return Functionals(functionals.nodal @ weights, held, bubbles)


def added(first: Functionals, second: Functionals) -> Functionals:
    """Sum of as many functionals on the same rod."""
    held = {node: values + second.held[node] for node, values in first.held.items()}
    return Functionals(first.nodal + second.nodal, held, (*first.bubbles, *second.bubbles))


def compliance(functionals: Functionals) -> Array:
    """F^T K^-1 F, shape (m, m): the displacement of each functional under each as a load."""
    return cross_compliance(functionals, functionals)


def cross_compliance(first: Functionals, second: Functionals) -> Array:
    """F_1^T K^-1 F_2 of functionals on the same rod, shape (m_1, m_2)."""
    # Nodes between a clamp and the first load know nothing of the load.
    rows = np.flatnonzero(first.nodal.any(axis=1))
    known = slice(rows[0], rows[-1] + 1) if len(rows) else slice(0)
    result = first.nodal[known].T @ second.nodal[known]
    for index, members, half in first.bubbles:
        for other_index, other_members, other_half in second.bubbles:
            if index == other_index:
                result[np.ix_(members, other_members)] += half.T @ other_half
    return np.asarray(result)


def scaled(functionals: Functionals, factor: float) -> Functionals:
    """The functionals, half solved, on a rod whose modulus is 1 / factor^2 times that of theirs."""
    bubbles = tuple((index, members, half * factor) for index, members, half in functionals.bubbles)
    return Functionals(functionals.nodal * factor, functionals.held, bubbles)


def last_replaced(functionals: Functionals, load: Functionals) -> Functionals:
    """The functionals with another one (m = 1) in the last one's place, which has shares in elements of its own."""
    last = functionals.nodal.shape[1] - 1
    bubbles = [entry for entry in functionals.bubbles if entry[1][0] != last]
    bubbles += [(index, np.array([last]), half) for index, _, half in load.bubbles]
    held = {node: np.column_stack([values[:, :-1], load.held[node]]) for node, values in functionals.held.items()}
    return Functionals(np.column_stack([functionals.nodal[:, :-1], load.nodal]), held, tuple(bubbles))


def held_parts(assembled: AssembledRod, displacement: Mapping[int, Array]) -> list[Part]:
    """Stiffness times displacements of held nodes, m functionals as shares of the elements.

    displacement : of the fields of some nodes, by node, shape (n_fields, m) each
    """
    modulus = axial_modulus(assembled.rod.material)
    parts = []
    for index, element in enumerate(assembled.elements):
        moved = [side for side in (0, 1) if index + side in displacement]
        if not moved:
            continue
        count = displacement[index + moved[0]].shape[1]
        nodal = np.zeros((2, element.fields.count, count))
        for side in moved:
            nodal[side, assembled.node_places(index, side)] = displacement[index + side]
        values = np.zeros((element.order + 1, element.fields.count, count))
        values[:2] = (modulus * element.condensed @ nodal.reshape(-1, count)).reshape(2, -1, count)
        parts.append(Part(index, np.arange(count), values))
    return parts


def given_displacement(assembled: AssembledRod) -> dict[int, Array]:
    """What supports prescribe other than zero, by node, shape (n_fields,) each."""
    return {node: each.given for node, each in assembled.holds.items() if each.given.any()}


def prescribed_parts(assembled: AssembledRod, column: int) -> list[Part]:
    """What the prescribed displacements do to the rest of the rod, as functional number `column`."""
    given = {node: -displacement[:, None] for node, displacement in given_displacement(assembled).items()}
    return [replace(part, columns=np.array([column])) for part in held_parts(assembled, given)]


def on_given(assembled: AssembledRod, functionals: Functionals) -> Array:
    """What the functionals make of the prescribed displacements alone, shape (m,)."""
    result = np.zeros(functionals.nodal.shape[1])
    for node, displacement in given_displacement(assembled).items():
        result += displacement @ functionals.held[node]
    return result


def coefficients(assembled: AssembledRod, load: Functionals, held: Mapping[int, Array]) -> tuple[Array, ...]:
    """Degrees of freedom under each of m loads, element by element, shape (order + 1, n_fields, m) each.

    held : displacements of held nodes where they are not zero, by node, shape (n_fields, m) each; their part in the
        load, -K held, is in `load` already
    """
    chain = assembled.chain
    carried = chain.back_solve(load.nodal)
    root = np.sqrt(axial_modulus(assembled.rod.material))
    halves = bubble_halves(load)
    result = []
    for index, element in enumerate(assembled.elements):
        count = element.fields.count
        values = np.zeros((element.order + 1, count, carried.shape[1]))
        for side in (0, 1):
            node = index + side
            values[side] = extended(carried[chain.rows[node]], chain.ends[index][side], count)
            if node in held:
                values[side, assembled.node_places(index, side)] += held[node]
        right = halves.get(index, 0.0) / root - element.half_coupling @ values[:2].reshape(2 * count, -1)
        values[2:] = element.bubbles.back_solve(right).reshape(values[2:].shape)
        result.append(values)
    return tuple(result)


def bubble_halves(load: Functionals) -> dict[int, Array]:
    """L_bb^-1 c_b of m loads that all have shares in the same elements, by element, shape (n_bubbles, m) each."""
    halves: dict[int, Array] = {}
    for index, _, half in load.bubbles:
        halves[index] = halves.get(index, 0.0) + half
    return halves


def stored_energy(assembled: AssembledRod, load: Functionals, values: Sequence[Array]) -> float:
    """Elastic energy of a rod and the beds under it in one state, N mm; `values` of shape (order + 1, n_fields)."""
    energy = sum(0.5 * float(np.vdot(half, half)) for half in bubble_halves(load).values())
    modulus = axial_modulus(assembled.rod.material)
    for element, each in zip(assembled.elements, values, strict=True):
        nodal = each[:2].ravel()
        energy += 0.5 * modulus * float(nodal @ element.condensed @ nodal)
    return energy
