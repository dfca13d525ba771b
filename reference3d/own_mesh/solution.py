"""What is kept of a scene solved on a mesh made elsewhere, and its answers (`reports.solution.Solution`)."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from reference3d.centre_line import frames, points
from reference3d.facing import face_place, surface
from reference3d.own_mesh.arc_length import arc_lengths
from reference3d.own_mesh.body import OwnBody
from reference3d.own_mesh.contact import OwnContact
from reference3d.own_mesh.elements import KINDS
from reference3d.section_mesh import located, section_mesh
from reference3d.solution import ContactPoints, ContactProfile, Cost

Array = NDArray[np.float64]

# stations on both sides of a width at which pressure is told
HALF_WIDTH = 8
# how far off an element of the section its centroid may be found, in its own coordinates
INSIDE = 1e-6


@dataclass(frozen=True, eq=False)
class OwnRod:
    """Displacement of a rod's nodes, global, mm, shape (n_nodes, 3)."""

    body: OwnBody
    nodal: Array

    @cached_property
    def hollow(self) -> bool:
        """Whether there is no material at the centroid of the section."""
        _, local, share = located(section_mesh(self.body.mesh.rod.section, 1), np.zeros((1, 2)))
        return bool(np.abs(local[0, int(np.argmax(share[0]))]).max() > 1.0 + INSIDE)

    def nodal_stress(self) -> tuple[Array, Array]:
        """Mean stress of the elements at every node, xx, yy, ss, ys, xs, xy, MPa, and the frames that it is in.

        Returns
        -------
        stress, axes : shapes (6, n_nodes) and (n_nodes, 3, 3)
        """
        mesh = self.body.mesh
        axes = frames(mesh.rod.centre_line, arc_lengths(mesh.rod, mesh.nodes))
        return self.body.stress(self.nodal, self.body.find(mesh.nodes), axes), axes

    def displacement_at(self, position: Array) -> Array:
        """Displacement at points, global, mm, shape (n, 3) to (n, 3)."""
        rows = self.body.interpolation(self.body.find(position))
        return np.asarray((rows @ self.nodal.ravel()).reshape(-1, 3))


@dataclass(frozen=True, eq=False)
class OwnPair:
    """Distance of the faces, mm, and force, N, at the corners of a contact pair, shape (n,) each."""

    contact: OwnContact
    gap: Array
    force: Array


@dataclass(frozen=True)
class OwnMeshSolution:
    """A scene solved on a mesh made elsewhere.

    Attributes
    ----------
    residual : largest nodal force out of balance relative to the rod's largest internal nodal force
    representative_size : cube root of the mean element volume, mm (h of ASME V&V 20)
    reactions : force (N) and moment (N mm) of every clamp, by rod and arc length, global, shape (6,)
    """

    scene: Scene
    outcome: str
    contact_solutions: int
    active_sets: int
    strain_energy: float
    cost: Cost
    residual: float
    representative_size: float
    rods: Mapping[str, OwnRod]
    reactions: Mapping[tuple[str, float], Array]
    pairs: Mapping[str, OwnPair]

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        """Points of the undeformed centre line, global, mm, shape (3, n), and rows e1, e2, t there, (n, 3, 3)."""
        line, station = self.scene.rod(rod).centre_line, np.asarray(station, dtype=np.float64)
        return points(line, station).T, frames(line, station)

    def displacement(self, rod: str, station: Array) -> Array:
        """Displacement of the centre line at arc lengths `station`, global, mm, shape (3, n).

        Of sections without material at their centroid it is the mean over the section.
        """
        found, station = self.rods[rod], np.asarray(station, dtype=np.float64)
        if not found.hollow:
            return found.displacement_at(self.frame(rod, station)[0].T).T
        area = found.body.section_points[1]
        position = found.body.in_sections(station)
        moved = found.displacement_at(position.reshape(-1, 3)).reshape(position.shape)
        return np.asarray(np.einsum("sng,n->gs", moved, area / area.sum()))

    def stress(self, rod: str, points: Array) -> Array:
        """Stress in the local frame at (x, y, s): xx, yy, ss, ys, xs, xy, MPa, shape (6, n).

        points : mm, shape (3, n); where elements meet, the stress is their mean
        """
        points = np.asarray(points, dtype=np.float64)
        centre, axes = self.frame(rod, points[2])
        position = centre.T + np.einsum("cn,ncg->ng", points[:2], axes[:, :2])
        found = self.rods[rod]
        return found.body.stress(found.nodal, found.body.find(position), axes)

    def section_resultants(self, rod: str, station: Array) -> Array:
        """N, Q1, Q2, M1, M2, T of the finite element stress, N and N mm, shape (6, n)."""
        found, station = self.rods[rod], np.asarray(station, dtype=np.float64)
        place, area = found.body.section_points
        position = found.body.in_sections(station).reshape(-1, 3)
        axes = np.repeat(frames(found.body.mesh.rod.centre_line, station), len(area), axis=0)
        stress = found.body.stress(found.nodal, found.body.find(position), axes)
        _, _, ss, ys, xs, _ = stress.reshape(6, len(station), len(area))
        x, y = place.T
        return np.stack([ss @ area, xs @ area, ys @ area, ss @ (area * y), -ss @ (area * x), (ys * x - xs * y) @ area])

    def reaction(self, rod: str, station: float) -> Array:
        """Force (N) and moment (N mm) of the clamp at an end on the rod, global, shape (6,); zero at a free end.

        station : 0 or the rod's length, mm

        Raises
        ------
        ValueError
            if the station is not an end of the rod.
        """
        length = self.scene.rod(rod).length
        if station not in (0.0, length):
            raise ValueError(f"station: found {station:g}; clamps are at 0 and at {length:g} mm")
        return np.asarray(self.reactions.get((rod, station), np.zeros(6)))

    def bed_forces(self, bed: int, borders: Array) -> NoReturn:  # noqa: ARG002 (as the protocol has it)
        """No scene with beds is solved on a mesh made elsewhere: IndexError."""
        raise IndexError(f"bed: found {bed}; the scene has none")

    def contact_points(self, pair: str) -> ContactPoints:
        """State of every corner of the first face's facets that takes part."""
        found = self.pairs[pair]
        contact, pressure = found.contact, found.force / found.contact.area
        return ContactPoints(contact.position.T, contact.normal.T, found.gap, found.force, pressure)

    def contact_profile(self, pair: str) -> ContactProfile:
        """Pressure along the zone, at stations as far apart as facets are long in the mean."""
        found = self.pairs[pair]
        contact, face = found.contact, found.contact.pair.first
        rod, body = self.scene.rod(face.rod), self.rods[face.rod].body
        place = face_place(rod, face.face)
        start, end = contact.pair.zone
        size = float(np.sqrt(contact.area.sum() / len(contact.nodes)))
        station = np.linspace(start, end, max(3, round((end - start) / size) + 1))
        lateral = place.half_width * np.linspace(-1.0, 1.0, 2 * HALF_WIDTH + 1)
        grid = np.repeat(station, len(lateral)), np.tile(lateral, len(station))
        corner_pressure = np.zeros(len(body.mesh.nodes))
        corner_pressure[contact.nodes] = found.force / contact.area
        places = body.find(surface(rod, face.face, *grid))
        corners = body.mesh.elements[places.element, : body.mesh.kind.corners]
        linear = KINDS["tetra" if body.mesh.kind.is_simplex else "hexahedron"].functions(places.local)
        values = (linear * corner_pressure[corners]).sum(axis=1) * places.share
        found_pressure = np.zeros(places.count)
        np.add.at(found_pressure, places.point, values)
        pressure = found_pressure.reshape(len(station), len(lateral))
        weight = np.full(len(lateral), 1.0 / (2 * HALF_WIDTH))
        weight[[0, -1]] *= 0.5
        return ContactProfile(
            station,
            surface(rod, face.face, station, np.zeros(len(station))).T,
            pressure[:, HALF_WIDTH],
            pressure @ weight,
            np.maximum(pressure[:, 0], pressure[:, -1]),
        )
