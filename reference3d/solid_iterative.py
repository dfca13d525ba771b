"""Conjugate gradients for meshes whose factor would not fit into memory, preconditioned by a coarser mesh of the rod.

One step of the preconditioner smooths on the mesh by polynomials of its 3 x 3 diagonal blocks (of Chebyshev's fourth
kind: J. Lottes, Numerical Linear Algebra with Applications 30 (2023) e2518), corrects by the direct solution on the
coarser mesh, and smooths again. Stiffness is applied element by element and never assembled. What is held is kept at
zero by projection. The answer is not judged here: `solid_solver` sees to the balance of forces.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csr_array

from reference3d.plane_chain import HeldPlane
from reference3d.quadratic import locate, shape_functions
from reference3d.section_mesh import located, shapes
from reference3d.solid_body import SolidBody
from reference3d.solid_mirror import Mirror
from reference3d.solid_responses import Factor

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# matrix products of one smoothing, and steps and margin of the power iteration for its largest eigenvalue
SMOOTHING, POWER_STEPS, POWER_MARGIN = 4, 20, 1.15
# residual over the load at which a solution is good, and steps at most
RESIDUAL, MOST_STEPS = 1e-10, 400
# loads that are solved for at once, and arrays of unknowns kept for each
AT_ONCE, ARRAYS = 16, 12


@dataclass(frozen=True, eq=False)
class Grid:
    """A rod's mesh, and what of its motions is possible.

    Attributes
    ----------
    held : by number of the plane, of all its unknowns
    mirror : if motions are symmetric
    """

    body: SolidBody
    held: Mapping[int, HeldPlane]
    mirror: Mirror | None

    @cached_property
    def gather(self) -> csr_array:
        """From the section's nodes to those of its elements, shape (9 n_elements, n_nodes)."""
        nodes = self.body.section.quads.ravel()
        shape = len(nodes), len(self.body.section.nodes)
        return csr_array(coo_array((np.ones(len(nodes)), (np.arange(len(nodes)), nodes)), shape=shape))

    def possible(self, values: Array) -> Array:
        """The part of values (n_planes, n_nodes, 3, n) that motions can have."""
        planes, nodes, _, count = values.shape
        found = values.reshape(planes, -1, count)
        if self.mirror is not None:
            found = self.mirror.out_of(self.mirror.into(found))
        for number, plane in self.held.items():
            found[number] = plane.out_of(plane.into(found[number]))
        return np.asarray(found.reshape(planes, nodes, 3, count))

    def apply(self, displacement: Array) -> Array:
        """Nodal forces of displacements, arrays of unknowns with one more axis."""
        body = self.body
        planes, nodes, _, count = displacement.shape
        quads = len(body.section.quads)
        by_node = displacement.transpose(1, 0, 2, 3).reshape(nodes, -1)
        force = np.zeros((quads * 9, planes, 3, count))
        moved = (self.gather @ by_node).reshape(quads, 9, planes, 3, count)
        for kind, layer in enumerate(body.layers):
            first = 2 * np.flatnonzero(body.kind == kind)
            between = first[:, None] + np.arange(3)
            # element, plane, node, component; layer, load
            own = moved[:, :, between].transpose(0, 3, 1, 4, 2, 5).reshape(quads, 81, -1)
            found = (layer.stiffness @ own).reshape(quads, 3, 9, 3, len(first), count)
            view = force.reshape(quads, 9, planes, 3, count)
            for plane in range(3):
                view[:, :, first + plane] += found[:, plane].transpose(0, 1, 3, 2, 4)
        summed = self.gather.T @ force.reshape(quads * 9, -1)
        result = np.ascontiguousarray(summed.reshape(nodes, planes, 3, count).transpose(1, 0, 2, 3))
        for kind, all_springs in enumerate(body.springs):
            between = 2 * np.flatnonzero(body.kind == kind)[:, None] + np.arange(3)
            for springs in all_springs:
                place = between[:, None, :, None], springs.edges[None, :, None, :]
                own = displacement[place].reshape(len(between), len(springs.edges), -1, count)
                pushed = np.einsum("eij,lejn->lein", springs.stiffness, own)
                np.add.at(result, place, pushed.reshape(len(between), len(springs.edges), 3, -1, 3, count))
        return result

    @cached_property
    def inverse_diagonal(self) -> Array:
        """Inverse of the 3 x 3 blocks of the nodes, shape (n_planes, n_nodes, 3, 3)."""
        body = self.body
        planes, nodes, _ = body.shape
        blocks = np.zeros((planes, nodes, 3, 3))
        for kind, layer in enumerate(body.layers):
            between = 2 * np.flatnonzero(body.kind == kind)[:, None] + np.arange(3)
            _add_diagonal(blocks, between, body.section.quads, layer.stiffness)
            for springs in body.springs[kind]:
                _add_diagonal(blocks, between, springs.edges, springs.stiffness)
        return np.asarray(np.linalg.inv(blocks))

    def relaxed(self, force: Array) -> Array:
        """Inverse of the blocks times forces, of what is possible."""
        return self.possible(np.einsum("pnab,pnbk->pnak", self.inverse_diagonal, force))

    @cached_property
    def largest(self) -> float:
        """A bound of the eigenvalues of the stiffness relaxed."""
        vector = self.possible(np.random.default_rng(2).standard_normal((*self.body.shape, 1)))
        value = 0.0
        for _ in range(POWER_STEPS):
            vector = vector / np.linalg.norm(vector)
            vector = self.relaxed(self.apply(vector))
            value = float(np.linalg.norm(vector))
        return POWER_MARGIN * value

    def smoothed(self, force: Array) -> tuple[Array, Array]:
        """Displacements that take off the rough part of forces, and the forces that are left."""
        step = self.relaxed(force) * (4.0 / (3.0 * self.largest))
        moved = step
        for number in range(1, SMOOTHING):
            force = force - self.apply(step)
            more = self.relaxed(force) * ((8.0 * number + 4.0) / ((2.0 * number + 3.0) * self.largest))
            step = step * ((2.0 * number - 1.0) / (2.0 * number + 3.0)) + more
            moved = moved + step
        return moved, force - self.apply(step)


def _add_diagonal(blocks: Array, planes: IntArray, nodes: IntArray, matrices: Array) -> None:
    """Add the diagonal blocks of elements on `nodes` (n, k) between the planes of layers (n_layers, 3)."""
    count = nodes.shape[1]
    own = matrices.reshape(len(nodes), 3 * count, 3, 3 * count, 3)
    diagonal = np.einsum("eiaib->eiab", own).reshape(len(nodes), 3, count, 3, 3)
    np.add.at(blocks, (planes[:, None, :, None], nodes[None, :, None, :]), diagonal[None])


@dataclass(frozen=True, eq=False)
class Interpolation:
    """Between two meshes of a rod.

    along : from the planes of the coarse one to those of the fine one, shape (3 n_fine, 3 n_coarse)
    across : from node to node of the sections, shape (n_fine, n_coarse)
    """

    along: csr_array
    across: csr_array

    def to_fine(self, values: Array) -> Array:
        """Displacements (n_planes, n_nodes, 3, n) between the nodes of the coarse mesh."""
        return _product(self.along, self.across, values)

    def to_coarse(self, forces: Array) -> Array:
        """Forces of the same work."""
        return _product(self.along.T.tocsr(), self.across.T.tocsr(), forces)


def _product(along: csr_array, across: csr_array, values: Array) -> Array:
    planes, nodes, _, count = values.shape
    found = across @ values.transpose(1, 0, 2, 3).reshape(nodes, -1)
    found = found.reshape(-1, 3 * planes, count).transpose(1, 0, 2)
    result = along @ found.reshape(3 * planes, -1)
    return np.asarray(result.reshape(along.shape[0] // 3, 3, across.shape[0], count).transpose(0, 2, 1, 3))


def interpolation(coarse: SolidBody, fine: SolidBody) -> Interpolation:
    """Interpolation between two meshes of one rod."""
    layer, zeta = locate(coarse.borders, fine.stations)
    plane = 2 * layer[:, None] + np.arange(3)
    turned = np.einsum("pf,fac,fpbc->fpab", shape_functions(zeta), fine.axes, coarse.axes[plane])
    row = 3 * np.arange(len(layer))[:, None, None, None] + np.arange(3)[:, None]
    column = 3 * plane[:, :, None, None] + np.arange(3)
    row, column = np.broadcast_arrays(row, column)
    shape = 3 * len(layer), 3 * len(coarse.points)
    along = csr_array(coo_array((turned.ravel(), (row.ravel(), column.ravel())), shape=shape))
    element, local, share = located(coarse.section, fine.section.nodes)
    holding = np.argmax(share, axis=1)
    node = np.arange(len(holding))
    values = shapes(*local[node, holding].T)[0].T
    quads = coarse.section.quads[element[node, holding]]
    place = np.repeat(node, 9), quads.ravel()
    across = csr_array(coo_array((values.ravel(), place), shape=(len(node), len(coarse.section.nodes))))
    return Interpolation(along, across)


@dataclass(frozen=True, eq=False)
class IterativeFactor:
    """What solves a rod by conjugate gradients where `solid_responses.Factor` does by its factor.

    Attributes
    ----------
    coarse : factor of the coarser mesh
    coarse_shape : of its arrays of unknowns
    """

    grid: Grid
    coarse: Factor
    coarse_shape: tuple[int, int, int]
    between: Interpolation

    @property
    def mirror(self) -> Mirror | None:
        """Of the motions that are solved for."""
        return self.grid.mirror

    def solve(self, force: Array) -> Array:
        """Displacements under loads (N), shape (n_planes, m, n); as far as it came where it did not converge."""
        shape, count = self.grid.body.shape, force.shape[2]
        found = np.zeros((*shape, count))
        loads = force.reshape(*shape, count)
        for start in range(0, count, AT_ONCE):
            part = slice(start, start + AT_ONCE)
            found[..., part] = self._conjugate_gradients(self.grid.possible(loads[..., part].copy()))
        return found.reshape(force.shape)

    def compliance(self, loads: csr_array) -> Array:
        """Work of every load on the displacement of every other, shape (n_loads, n_loads)."""
        planes, nodes, _ = self.grid.body.shape
        result = np.zeros((loads.shape[0],) * 2)
        for start in range(0, loads.shape[0], AT_ONCE):
            part = loads[start : start + AT_ONCE].toarray().T.reshape(planes, 3 * nodes, -1)
            result[:, start : start + AT_ONCE] = loads @ self.solve(part).reshape(loads.shape[1], -1)
        return 0.5 * (result + result.T)

    def _conjugate_gradients(self, load: Array) -> Array:
        """Solutions of several loads side by side."""

        def product(one: Array, other: Array) -> Array:
            return np.asarray(np.einsum("pnck,pnck->k", one, other, optimize=True))

        goal = RESIDUAL * np.sqrt(product(load, load))
        moved, left = np.zeros_like(load), load
        direction, before = np.zeros_like(load), np.ones(load.shape[3])
        for _ in range(MOST_STEPS):
            if (np.sqrt(product(left, left)) <= goal).all():
                return moved
            better = self._preconditioned(left)
            work = product(better, left)
            direction = better + direction * (work / before)
            force = self.grid.possible(self.grid.apply(direction))
            # loads that are solved, or zero, stay as they are
            share = np.divide(work, product(direction, force), out=np.zeros_like(work), where=work > 0.0)
            moved, left = moved + share * direction, left - share * force
            before = np.where(work > 0.0, work, 1.0)
        return moved

    def _preconditioned(self, force: Array) -> Array:
        grid = self.grid
        moved, left = grid.smoothed(force)
        down = self.between.to_coarse(grid.possible(left))
        corrected = self.coarse.solve(down.reshape(down.shape[0], -1, down.shape[3]))
        fine = grid.possible(self.between.to_fine(corrected.reshape(*self.coarse_shape, -1)))
        moved, left = moved + fine, left - grid.apply(fine)
        return moved + grid.smoothed(left)[0]


def iterative_bytes(unknowns: int) -> float:
    """Memory that solving takes besides the coarse factor and element matrices, for so many unknowns of the rod."""
    return 8.0 * unknowns * (ARRAYS * AT_ONCE + 6.0)
