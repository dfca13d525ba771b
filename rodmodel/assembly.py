"""One rod ready to be loaded: its condensed elements, its factorised chain, and linear functionals on it.

A functional (the normal displacement of a contact point, a load) is condensed as the elements are: a part on the
nodes, and for the elements it lies in, a part on their bubbles. Compliances are inner products of such halves.
"""

from __future__ import annotations

from collections.abc import Hashable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
from numpy.typing import NDArray

from cases.scene import Rod, Scene
from rodmodel.axial import shape_functions
from rodmodel.centre_line import darboux
from rodmodel.chain import Chain
from rodmodel.section import Fields, section_stiffness
from rodmodel.stiffness import Element, ElementFamily, condensed_element, element_family

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(eq=False)
class ElementStore:
    """Elements and factors made so far, so that none is made twice: neighbours, rods and border positions share them.

    Parameters
    ----------
    order : polynomial order p along the rods

    Attributes
    ----------
    chains : last chain of every rod, by name
    """

    order: int
    _families: dict[Hashable, ElementFamily] = field(default_factory=dict)
    _elements: dict[Hashable, Element] = field(default_factory=dict)
    chains: dict[str, Chain] = field(default_factory=dict)

    def element(self, rod: Rod, fields: Fields, length: float) -> Element:
        """Condensed element of the rod for unit Young's modulus; `length` in mm."""
        turning = darboux(rod.centre_line)
        kind = (rod.section, rod.material.poisson_ratio, fields, turning)
        if kind not in self._families:
            section = section_stiffness(rod.section, replace(rod.material, young_modulus=1.0), fields, turning)
            self._families[kind] = element_family(self.order, fields, section, reversible=turning[2] == 0.0)
        # Lengths that differ only by the round-off of the borders they come from are one length.
        key = (*kind, float(f"{length:.11e}"))
        if key not in self._elements:
            self._elements[key] = condensed_element(self._families[kind], length)
        return self._elements[key]


@dataclass(frozen=True, eq=False)
class AssembledRod:
    """A rod with its elements and factorised stiffness.

    Attributes
    ----------
    borders : element borders, arc length, mm, shape (n_elements + 1,)
    """

    rod: Rod
    fields: Fields
    order: int
    borders: Array
    elements: tuple[Element, ...]
    chain: Chain

    @property
    def unknowns(self) -> int:
        """Degrees of freedom that are not held: free nodes and all bubbles, times the fields."""
        return self.fields.count * (len(self.chain.nodes) + len(self.elements) * (self.order - 1))

    def locate(self, station: Array) -> tuple[IntArray, Array]:
        """Element index and xi of stations (mm); a station on a border belongs to the element before it."""
        index = np.clip(np.searchsorted(self.borders, station, side="left") - 1, 0, len(self.elements) - 1)
        left, right = self.borders[index], self.borders[index + 1]
        return index, (2.0 * station - left - right) / (right - left)


def assembled_rod(scene: Scene, rod: Rod, fields: Fields, borders: Array, store: ElementStore) -> AssembledRod:
    """Make (or fetch from `store`) the elements between `borders` and factorise the chain."""
    clamped = {support.end for support in scene.supports if support.rod == rod.name}
    elements = tuple(store.element(rod, fields, float(length)) for length in np.diff(borders))
    chain = Chain(
        elements,
        rod.material.young_modulus,
        "start" in clamped,
        "end" in clamped,
        previous=store.chains.get(rod.name),
    )
    store.chains[rod.name] = chain
    return AssembledRod(rod, fields, store.order, borders, elements, chain)


@dataclass(frozen=True, eq=False)
class Functionals:
    """m linear functionals on the degrees of freedom of an assembled rod, condensed and half solved.

    Attributes
    ----------
    nodal : L^-1 (c_n - K_nb K_bb^-1 c_b) with the chain's factor L, shape (n_nodes, n_fields, m)
    ends : the condensed functionals on the first and the last node, held or not, shape (2, n_fields, m)
    bubbles : for each element with bubbles involved: its index, the functionals' numbers, L_bb^-1 c_b of shape
        (n_bubbles, how many)
    """

    nodal: Array
    ends: Array
    bubbles: tuple[tuple[int, IntArray, Array], ...]


@dataclass(frozen=True, eq=False)
class Part:
    """Share of one element in functionals: their coefficients on its nodes and bubbles.

    Attributes
    ----------
    element : its index
    columns : numbers of the functionals
    values : shape (order + 1, n_fields, len(columns))
    """

    element: int
    columns: IntArray
    values: Array


def point_parts(assembled: AssembledRod, station: Array, direction: Array) -> list[Part]:
    """Displacement at points of the rod, one functional a point.

    station : arc length of the points, mm, shape (m,)
    direction : value of every field at the points, in the direction asked for, shape (n_fields, m)
    """
    index, xi = assembled.locate(station)
    along = shape_functions(assembled.order, xi)
    # Shape functions vanish on the nodes only up to round-off; there, nothing need be asked of the bubbles.
    along[2:, np.abs(xi) > 1.0 - 1e-12] = 0.0
    parts = []
    for element in np.unique(index):
        members = np.flatnonzero(index == element)
        parts.append(Part(int(element), members, along[:, None, members] * direction[None, :, members]))
    return parts


def functionals(assembled: AssembledRod, parts: Sequence[Part], count: int) -> Functionals:
    """Condense `count` functionals, given by the shares of the elements, and half solve them."""
    n_fields = assembled.fields.count
    nodal = np.zeros((len(assembled.borders), n_fields, count))
    bubbles = []
    for part in parts:
        element = assembled.elements[part.element]
        on_nodes = part.values[:2].copy()
        inner = np.flatnonzero(part.values[2:].any(axis=(0, 1)))
        if len(inner):
            half = element.bubbles.half_solve(part.values[2:, :, inner].reshape(len(element.half_coupling), -1))
            on_nodes[:, :, inner] -= (element.half_coupling.T @ half).reshape(2, n_fields, -1)
            bubbles.append((part.element, part.columns[inner], half / np.sqrt(assembled.rod.material.young_modulus)))
        nodal[part.element : part.element + 2, :, part.columns] += on_nodes
    return Functionals(assembled.chain.half_solve(nodal), nodal[[0, -1]], tuple(bubbles))


def combined(functionals: Functionals, weights: Array) -> Functionals:
    """Linear combinations of functionals; weights of shape (m, m_new)."""
    n_new = weights.shape[1]
    bubbles = tuple((index, np.arange(n_new), half @ weights[members]) for index, members, half in functionals.bubbles)
    return Functionals(functionals.nodal @ weights, functionals.ends @ weights, bubbles)


def compliance(functionals: Functionals) -> Array:
    """F^T K^-1 F, shape (m, m): the displacement of each functional under each as a load."""
    n_nodal = functionals.nodal.shape[0] * functionals.nodal.shape[1]
    nodal = functionals.nodal.reshape(n_nodal, -1)
    result = nodal.T @ nodal
    for index, members, half in functionals.bubbles:
        for other_index, other_members, other_half in functionals.bubbles:
            if index == other_index:
                result[np.ix_(members, other_members)] += half.T @ other_half
    return np.asarray(result)


def coefficients(assembled: AssembledRod, load: Functionals) -> Array:
    """Degrees of freedom under a load (m = 1), element by element, shape (n_elements, order + 1, n_fields)."""
    n_elements, n_fields = len(assembled.elements), assembled.fields.count
    nodes = assembled.chain.back_solve(load.nodal)[:, :, 0]
    result = np.empty((n_elements, assembled.order + 1, n_fields))
    result[:, 0], result[:, 1] = nodes[:-1], nodes[1:]
    root = np.sqrt(assembled.rod.material.young_modulus)
    halves: dict[int, Array] = {}
    for index, _, half in load.bubbles:
        halves[index] = halves.get(index, 0.0) + half[:, 0] / root
    for index, element in enumerate(assembled.elements):
        right = halves.get(index, 0.0) - element.half_coupling @ result[index, :2].ravel()
        bubbles = element.bubbles.back_solve(right[:, None])
        result[index, 2:] = bubbles.reshape(-1, n_fields)
    return result
