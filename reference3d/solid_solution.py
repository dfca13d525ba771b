"""What is kept of a scene of rods of any kind solved as 3D solids, and its answers.

`SolidSolution` has the shape that `reports.solution` asks for. `solid_solver` makes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from reference3d.centre_line import frames, points
from reference3d.faces import face_points, normal_rows
from reference3d.facing import surface
from reference3d.quadratic import Side, locate, nodal_weights, shape_functions
from reference3d.section_mesh import face_edges, gauss_square, located, shapes
from reference3d.solid_body import SolidBody
from reference3d.solid_contact import SolidContact
from reference3d.solid_elasticity import functions, gradients, strain_matrix
from reference3d.solution import ContactPoints, ContactProfile, Cost

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

SIDES: tuple[Side, Side] = ("left", "right")
# Gauss points across every element edge, and along every piece, of a bed
ACROSS, ALONG = 3, 4
# how far off an element the centroid may be found, in its own coordinates and over the size of the section
INSIDE = 1e-6


@dataclass(frozen=True)
class BedForces:
    """Forces of a bed on its rod (`reports.solution.BedForces`).

    station : mm, shape (n,); position : on the face, global, mm, shape (3, n); force : N, shape (3, n)
    """

    station: Array
    position: Array
    force: Array


@dataclass(frozen=True, eq=False)
class SolidRod:
    """Displacement of one rod, components in the frames of the planes, mm, shape (n_planes, n_nodes, 3)."""

    body: SolidBody
    nodal: Array

    @cached_property
    def centre(self) -> Array:
        """Weights of the section's nodes for the displacement of the centre line, shape (n_nodes,).

        That is the displacement at x = y = 0; where there is no material there, the mean of the section, int u dA / A.
        """
        section = self.body.section
        element, local, share = located(section, np.zeros((1, 2)))
        holding = int(np.argmax(share[0]))
        quad = section.quads[element[0, holding]]
        values = shapes(*local[0, holding][:, None])[0][:, 0]
        inside = np.abs(local[0, holding]).max() < 1.0 + INSIDE
        if not inside or np.linalg.norm(values @ section.nodes[quad]) > INSIDE * np.ptp(section.nodes):
            return self.body.integrals.even / self.body.integrals.area
        weights = np.zeros(len(section.nodes))
        weights[quad] = values
        return weights

    def stress_at(self, layer: IntArray, zeta: Array, quads: IntArray, local: Array) -> Array:
        """Stress in the local frame in given elements: xx, yy, ss, ys, xs, xy, MPa, shape (6, n).

        Parameters
        ----------
        layer, zeta : layer and place in it, -1 to 1, shape (n,)
        quads, local : element of the section and (xi, eta) in it, shapes (n,) and (n, 2)
        """
        body = self.body
        planes, nodes = 2 * layer[:, None] + np.arange(3), body.section.quads[quads]
        axes = body.axes[planes]
        across = np.einsum("nac,npcd->npad", body.section.nodes[nodes], axes[:, :, :2])
        position = (body.points[planes][:, :, None] + across).reshape(-1, 27, 3)
        slopes = functions(local[:, 0], local[:, 1], zeta)[1]
        gradient = gradients(position, slopes[:, None])[0][:, 0]
        start, end = body.borders[layer], body.borders[layer + 1]
        here = frames(body.rod.centre_line, 0.5 * (start + end) + 0.5 * (end - start) * zeta)
        turned = here[:, None] @ np.swapaxes(axes, 2, 3)
        strain = strain_matrix(gradient @ np.swapaxes(here, 1, 2), turned)
        nodal = self.nodal[planes[:, :, None], nodes[:, None]].reshape(len(layer), 81)
        return np.asarray(body.hooke @ np.einsum("nij,nj->in", strain, nodal))

    @cached_property
    def resultants(self) -> Array:
        """N, Q1, Q2, M1, M2, T at two Gauss points along every layer, shape (n_layers, 2, 6)."""
        body = self.body
        xi, eta, weight = gauss_square()
        values, slopes = shapes(xi, eta)
        corners = body.section.nodes[body.section.quads]
        area = (np.linalg.det(np.einsum("eac,adg->egcd", corners, slopes)) * weight).ravel()
        x, y = np.moveaxis(np.einsum("ag,eac->egc", values, corners), 2, 0).reshape(2, -1)
        quads = np.repeat(np.arange(len(corners)), len(xi))
        local = np.tile(np.stack([xi, eta], axis=1), (len(corners), 1))
        found = np.empty((len(body.kind), 2, 6))
        for layer in range(len(body.kind)):
            for index, zeta in enumerate((-1.0 / np.sqrt(3.0), 1.0 / np.sqrt(3.0))):
                same = np.full(len(quads), layer)
                _, _, ss, ys, xs, _ = self.stress_at(same, np.full(len(quads), zeta), quads, local) * area
                found[layer, index] = [ss.sum(), xs.sum(), ys.sum(), ss @ y, -(ss @ x), (ys @ x) - (xs @ y)]
        return found


def _located(found: SolidRod, points: Array) -> tuple[IntArray, Array, Array]:
    """`located` for points (x, y, s), shape (3, n), many of which may lie at the same place of their sections."""
    places, which = np.unique(points[:2].T, axis=0, return_inverse=True)
    element, local, share = located(found.body.section, places)
    which = which.ravel()
    return element[which], local[which], share[which]


@dataclass(frozen=True, eq=False)
class SolidPair:
    """What is kept of one contact pair: distance of the faces, mm, and force, N, at its nodes, shape (n,) each."""

    contact: SolidContact
    gap: Array
    force: Array


@dataclass(frozen=True)
class SolidSolution:
    """A scene solved as 3D solids; `reports.solution.Solution` describes the common part.

    Attributes
    ----------
    residual : largest nodal force out of balance relative to the rod's largest internal nodal force
    representative_size : cube root of the mean element volume, mm (h of ASME V&V 20)
    refinement : k of `section_mesh` and `layers`
    solver : 'direct', or 'conjugate gradients' where a factor would not have fitted into memory
    reactions : force and moment of what holds a rod at a layer border, by rod and number of the border, global
    """

    scene: Scene
    outcome: str
    contact_solutions: int
    active_sets: int
    strain_energy: float
    cost: Cost
    residual: float
    representative_size: float
    refinement: int
    solver: str
    rods: dict[str, SolidRod]
    reactions: dict[tuple[str, int], Array]
    pairs: dict[str, SolidPair]

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        """Points of the undeformed centre line, global, mm, shape (3, n), and rows e1, e2, t there, (n, 3, 3)."""
        line, station = self.rods[rod].body.rod.centre_line, np.asarray(station, dtype=np.float64)
        return points(line, station).T, frames(line, station)

    def displacement(self, rod: str, station: Array) -> Array:
        """Displacement of the centre line at arc lengths `station`, global, mm, shape (3, n).

        Of sections without material at their centroid it is the mean over the section, int u dA / A.
        """
        found = self.rods[rod]
        layer, zeta = locate(found.body.borders, np.asarray(station, dtype=np.float64))
        planes = 2 * layer + np.arange(3)[:, None]
        local = np.einsum("n,pknc->pkc", found.centre, found.nodal[planes])
        return np.asarray(np.einsum("pk,pkb,pkbc->ck", shape_functions(zeta), local, found.body.axes[planes]))

    def displacement_at(self, rod: str, points: Array) -> Array:
        """Displacement at points (x, y, s) of a rod, global components, mm; shape (3, n) to (3, n)."""
        found = self.rods[rod]
        element, local, share = _located(found, points)
        holding = np.arange(len(share)), np.argmax(share, axis=1)
        nodes, (xi, eta) = found.body.section.quads[element[holding]], local[holding].T
        layer, zeta = locate(found.body.borders, points[2])
        planes = 2 * layer[:, None] + np.arange(3)
        values = functions(xi, eta, zeta)[0].reshape(-1, 3, 9)
        nodal = found.nodal[planes[:, :, None], nodes[:, None]]
        return np.asarray(np.einsum("npa,npab,npbc->cn", values, nodal, found.body.axes[planes]))

    def stress(self, rod: str, points: Array) -> Array:
        """Stress in the local frame at (x, y, s): xx, yy, ss, ys, xs, xy, MPa, shape (6, n).

        points : mm, shape (3, n); where elements meet, the stress is their mean
        """
        found, points = self.rods[rod], np.asarray(points, dtype=np.float64)
        element, local, share = _located(found, points)
        candidates = element.shape[1]
        holding = np.flatnonzero(share.ravel() > 0.0)
        quads, inside = element.ravel()[holding], local.reshape(-1, 2)[holding]
        point, weight = holding // candidates, share.ravel()[holding]
        result = np.zeros((6, points.shape[1]))
        for side in SIDES:
            layer, zeta = locate(found.body.borders, points[2], side)
            part = found.stress_at(layer[point], zeta[point], quads, inside) * (0.5 * weight)
            np.add.at(result.T, point, part.T)
        return result

    def section_resultants(self, rod: str, station: Array) -> Array:
        """N, Q1, Q2, M1, M2, T of the finite element stress, N and N mm, shape (6, n).

        Taken at the two Gauss points along a layer, where it is most accurate (J. Barlow, International Journal for
        Numerical Methods in Engineering 10 (1976) 243-251), and linear in between; where layers meet, the mean.
        """
        found, place = self.rods[rod], 1.0 / np.sqrt(3.0)
        result = np.zeros((6, len(np.asarray(station))))
        for side in SIDES:
            layer, zeta = locate(found.body.borders, np.asarray(station, dtype=np.float64), side)
            before, after = found.resultants[layer, 0].T, found.resultants[layer, 1].T
            result += 0.5 * (0.5 * (before + after) + (after - before) * (zeta / (2.0 * place)))
        return result

    def reaction(self, rod: str, station: float) -> Array:
        """Force (N) and moment (N mm) of the support or joint at a station on the rod, global, shape (6,); zero at a
        free end.

        Raises
        ------
        ValueError
            if the station is neither held nor an end of the rod.
        """
        body = self.rods[rod].body
        border = body.border_at(station)
        if abs(body.borders[border] - station) <= 1e-9 * body.rod.length:
            if (rod, border) in self.reactions:
                return self.reactions[rod, border]
            if border in (0, len(body.kind)):
                return np.zeros(6)
        raise ValueError(f"station: found {station:g}; nothing holds rod '{rod}' there")

    def bed_forces(self, bed: int, borders: Array) -> BedForces:
        """Forces of a bed at Gauss points between the given borders (arc lengths, mm) and those of the layers."""
        lying = self.scene.beds[bed]
        found = self.rods[lying.rod]
        body = found.body
        cuts = np.unique(np.concatenate([body.borders, np.asarray(borders, dtype=np.float64)]))
        inside = (cuts > lying.start) & (cuts < lying.end)
        cuts = np.concatenate([[lying.start], cuts[inside], [lying.end]])
        root, weight = np.polynomial.legendre.leggauss(ALONG)
        root_across, weight_across = np.polynomial.legendre.leggauss(ACROSS)
        edges = face_edges(body.section, body.rod.section, lying.face.face)
        stations, positions, forces = [], [], []
        for start, end in pairwise(cuts.tolist()):
            station = 0.5 * (start + end) + 0.5 * (end - start) * root
            layer = int(np.clip(np.searchsorted(body.borders, 0.5 * (start + end)) - 1, 0, len(body.kind) - 1))
            length = body.borders[layer + 1] - body.borders[layer]
            zeta = (2.0 * station - body.borders[layer] - body.borders[layer + 1]) / length
            planes = np.arange(2 * layer, 2 * layer + 3)
            axes = body.axes[planes]
            grid = np.repeat(zeta, ACROSS), np.tile(root_across, ALONG)
            strip = face_points(body.section, edges, lying.face.face, body.points[planes], axes, *grid)
            nodal = found.nodal[planes[:, None], edges[:, None, :]].reshape(len(edges), 27)
            outward = np.einsum("eqi,ei->eq", normal_rows(strip, axes), nodal)
            share = np.repeat(weight, ACROSS) * np.tile(weight_across, ALONG) * ((end - start) / length)
            push = -lying.modulus * outward * share  # times the area vector, whose length counts the area
            stations.append(np.tile(np.repeat(station, ACROSS), len(edges)))
            positions.append(strip.position.reshape(-1, 3))
            forces.append((push[..., None] * strip.area).reshape(-1, 3))
        return BedForces(np.concatenate(stations), np.concatenate(positions).T, np.concatenate(forces).T)

    def contact_points(self, pair: str) -> ContactPoints:
        """State of every node of the first face that has a point of the second opposite."""
        found = self.pairs[pair]
        contact, pressure = found.contact, found.force / found.contact.area
        return ContactPoints(contact.position.T, contact.normal.T, found.gap, found.force, pressure)

    def contact_profile(self, pair: str) -> ContactProfile:
        """Nodal pressure along the zone; none where the faces do not lie opposite."""
        found = self.pairs[pair]
        contact, first = found.contact, found.contact.pair.first
        shape = len(contact.station), len(contact.lateral)
        pressure, taking_part = np.zeros(shape), np.zeros(shape, dtype=bool)
        pressure.flat[contact.place] = found.force / contact.area
        taking_part.flat[contact.place] = True
        across = nodal_weights(contact.lateral[::2], float(contact.lateral[0]), float(contact.lateral[-1]))
        row = np.arange(shape[0])
        borders = np.argmax(taking_part, axis=1), shape[1] - 1 - np.argmax(taking_part[:, ::-1], axis=1)
        return ContactProfile(
            contact.station,
            surface(self.scene.rod(first.rod), first.face, contact.station, np.zeros(shape[0])).T,
            pressure[:, int(np.argmin(np.abs(contact.lateral)))],
            pressure @ across / np.ptp(contact.lateral),
            np.maximum(pressure[row, borders[0]], pressure[row, borders[1]]),
        )
