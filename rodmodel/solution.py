"""A solved scene: displacement, strain, stress, resultants, reactions and contact at any point of any rod."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache, partial

import numpy as np
from numpy.typing import NDArray

from cases.scene import Material, Orthotropic, Scene, Section
from rodmodel.assembly import AssembledRod
from rodmodel.axial import shape_function_slopes, shape_functions
from rodmodel.beds import BedForces, bed_forces
from rodmodel.centre_line import by_turning, centre_points, frames, global_points, turning_at
from rodmodel.mesh import SAME_BORDER
from rodmodel.pairing import NO_SHARE, facing_points
from rodmodel.profile import ContactProfile, pressure_profile
from rodmodel.resultants import rigid_motions
from rodmodel.section import (
    Darboux,
    Fields,
    U,
    V,
    W,
    axial_modulus,
    elasticity_matrix,
    per_axial_modulus,
    product_quadrature,
    section_values,
    strain_operators,
)
from rodmodel.shape import has_centre, section_quadrature
from rodmodel.stretches import Stretch
from rodmodel.system import ContactSystem, RodState

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Cost:
    """What a solution cost.

    Attributes
    ----------
    unknowns : degrees of freedom carried by all rods
    setup_seconds : sections, elements and the contact system that tells where contact is; wall clock
    solve_seconds : contact, border search and the final coefficients; wall clock
    """

    unknowns: int
    setup_seconds: float
    solve_seconds: float


@dataclass(frozen=True, eq=False)
class ContactPoints:
    """State of the contact points of a pair, for the full width.

    Attributes
    ----------
    position : on the first face, global, mm, shape (3, n)
    normal : outward normal of the first face, shape (3, n)
    gap : d, mm, shape (n,)
    force : compressive, N, shape (n,)
    pressure : force over the point's share of the face, MPa, shape (n,)
    """

    position: Array
    normal: Array
    gap: Array
    force: Array
    pressure: Array


@dataclass(frozen=True, eq=False)
class Solution:
    """Displacements of all rods and the contact between them.

    Attributes
    ----------
    scene : what was solved
    outcome : 'converged', 'stagnated: ...' or 'refused: ...'
    contact_solutions : contact problems solved, one a set of border positions
    active_sets : sets of touching points tried in all of them
    stretches : parts of the zones found in contact, and how far the edges may be from their ends
    system : rods and contact points on the final borders
    force : at every contact point of the system, N
    free_motion : how far loose rods move in the system's free motions
    states : by rod name, what acts on it in all, and its degrees of freedom
    stored_energy : of all rods and beds, N mm
    cost : unknowns and seconds
    """

    scene: Scene
    outcome: str
    contact_solutions: int
    active_sets: int
    stretches: tuple[Stretch, ...]
    system: ContactSystem
    force: Array
    free_motion: Array
    states: Mapping[str, RodState]
    stored_energy: float
    cost: Cost

    @property
    def edge_uncertainty(self) -> float:
        """How far the edges of contact may be from the ends of `stretches`, mm."""
        return max((stretch.slack for stretch in self.stretches), default=0.0)

    @property
    def strain_energy(self) -> float:
        """Elastic energy of all rods, without that of beds and contact, N mm."""
        beds = (self.bed_forces(number, np.empty(0)).energy.sum() for number in range(len(self.scene.beds)))
        return self.stored_energy - float(sum(beds))

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        """Points of the centre line, global, mm, shape (3, n), and frames there, rows e1, e2, t, shape (n, 3, 3)."""
        line = self.scene.rod(rod).centre_line
        station = np.atleast_1d(np.asarray(station, dtype=float))
        return centre_points(line, station), frames(line, station)

    def displacement(self, rod: str, station: Array) -> Array:
        """Displacement of the centre line, global components, mm, shape (3, n); station in mm along the rod.

        That of the point x = y = 0; where a section has no material there, the mean of the section, int u dA / A.
        """
        assembled = self.system.rods[rod]
        station = np.atleast_1d(np.asarray(station, dtype=float))
        local = np.empty((3, len(station)))
        for fields, members, xi, values in self._alike(assembled, station):
            moved = values @ _mean_motion(assembled.rod.section, fields)
            local[:, members] = np.einsum("an,nac->cn", shape_functions(values.shape[1] - 1, xi), moved)
        return self._globally(assembled, station, local)

    def displacement_at(self, rod: str, points: Array) -> Array:
        """Displacement at points (x, y, s) of a rod, global components, mm; shape (3, n) to (3, n)."""
        assembled = self.system.rods[rod]
        local = np.empty((3, points.shape[1]))
        for fields, members, psi, _ in self._axial(assembled, points[2]):
            moved = section_values(assembled.rod.section, fields, *points[:2, members]) * psi
            local[:, members] = [moved[fields.indices(component)].sum(axis=0) for component in (U, V, W)]
        return self._globally(assembled, points[2], local)

    def _globally(self, assembled: AssembledRod, station: Array, local: Array) -> Array:
        """Vectors at stations in global components instead of those of the frame there, shape (3, n) both."""
        axes = frames(assembled.rod.centre_line, np.asarray(station, dtype=float))
        return np.asarray(np.einsum("ncg,cn->gn", axes, local))

    def strain(self, rod: str, points: Array) -> Array:
        """Strain in the local frame at points (x, y, s): xx, yy, ss, ys, xs, xy (shears as gamma), shape (6, n)."""
        return self._strain_and_level(rod, points)[0]

    def stress(self, rod: str, points: Array) -> Array:
        """Stress in the local frame at points (x, y, s), MPa, ordered as the strain, shape (6, n)."""
        strain, levels = self._strain_and_level(rod, points)
        stress = np.empty_like(strain)
        for level in np.unique(levels):
            members = levels == level
            stress[:, members] = elasticity_matrix(self.scene.rod(rod).material, int(level)) @ strain[:, members]
        return stress

    def section_resultants(self, rod: str, station: Array) -> Array:
        """N, Q1, Q2 (N), M1, M2, T (N mm) from the stress in the sections at `station`, shape (6, n).

        M1 = int sigma_s y, M2 = -int sigma_s x, T = int (x tau_ys - y tau_xs).
        """
        assembled = self.system.rods[rod]
        station = np.atleast_1d(np.asarray(station, dtype=float))
        result = np.empty((6, len(station)))
        for fields, members, psi, slope in self._axial(assembled, station):
            turning = turning_at(assembled.rod.centre_line, station[members])
            of_rod = partial(
                _resultant_operators, assembled.rod.section, per_axial_modulus(assembled.rod.material), fields
            )
            sums = axial_modulus(assembled.rod.material) * by_turning(turning, of_rod)
            result[:, members] = np.einsum("nrf,fn->rn", sums, np.concatenate([psi, slope]))
        return result

    def reaction(self, rod: str, station: float) -> Array:
        """Force (N) and moment about the section's centre (N mm) of a support or joint on the rod, global, shape (6,).

        station : of the section that is held, mm

        The residual of the section's equations: exact in the sense of virtual work. Zero where nothing holds the rod.
        """
        assembled, state = self.system.rods[rod], self.states[rod]
        node = int(np.abs(assembled.borders - station).argmin())
        if node not in assembled.holds or abs(assembled.borders[node] - station) > SAME_BORDER:
            return np.zeros(6)
        fields = assembled.chain.fields[node]
        residual = -state.load.held[node][:, 0]
        for index, side in ((node - 1, 1), (node, 0)):
            if not 0 <= index < len(assembled.elements):
                continue
            element, nodal = assembled.elements[index], state.coefficients[index][:2].copy()
            for each in (0, 1):
                if index + each in state.held:
                    nodal[each, assembled.node_places(index, each)] -= state.held[index + each]
            rows = element.condensed.reshape(2, element.fields.count, -1)[side, assembled.node_places(index, side)]
            residual += axial_modulus(assembled.rod.material) * (rows @ nodal.ravel())
        axes = frames(assembled.rod.centre_line, assembled.borders[[node]])[0]
        local = rigid_motions(assembled.rod.section, fields) @ residual
        return np.concatenate([axes.T @ local[:3], axes.T @ local[3:]])

    def bed_forces(self, bed: int, borders: Array) -> BedForces:
        """Forces of the scene's bed number `bed` on its rod, as points: several between every two of `borders` (mm)."""
        under = self.scene.beds[bed]
        assembled = self.system.rods[under.rod]
        cuts = np.concatenate([borders, assembled.borders])

        def displacement_at(points: Array) -> Array:
            return self.displacement_at(under.rod, points)

        return bed_forces(under, assembled.rod, displacement_at, cuts, assembled.level, assembled.order)

    def contact_points(self, pair: str) -> ContactPoints:
        """State of every contact point of the pair, mirrored where symmetry carried one half."""
        if pair not in self._contact_points:
            self._contact_points[pair] = self._points_of(pair)
        return self._contact_points[pair]

    @cached_property
    def _contact_points(self) -> dict[str, ContactPoints]:
        return {}

    def _points_of(self, pair: str) -> ContactPoints:
        contact, grid = self.scene.contact(pair), self.system.grids[pair]
        points = self.system.points[pair]
        force = self.force[points]
        problem = self.system.problem
        gap = problem.gap[points] + problem.compliance[points] @ self.force + problem.motion[points] @ self.free_motion
        station, across = grid.flat()
        share = grid.weight.ravel()
        shared = share > NO_SHARE * share.max()
        pressure = np.divide(force, share, out=np.zeros_like(force), where=shared)
        if grid.symmetric:
            beyond = across > grid.across.min(axis=2, keepdims=True).repeat(grid.across.shape[2], axis=2).ravel()
            station, across = (
                np.concatenate([station, station[beyond]]),
                np.concatenate([across, -across[beyond]]),
            )
            force = np.where(beyond, 0.5 * force, force)
            force, gap = np.concatenate([force, force[beyond]]), np.concatenate([gap, gap[beyond]])
            shared, pressure = np.concatenate([shared, shared[beyond]]), np.concatenate([pressure, pressure[beyond]])
        # At the corners of what the faces share, points may have no share of it.
        station, across, force, gap, pressure = (each[shared] for each in (station, across, force, gap, pressure))
        facing = facing_points(self.scene, contact, station, across)
        position = global_points(self.scene.rod(contact.first.rod), facing.first)
        return ContactPoints(position, facing.normal, gap, force, pressure)

    def contact_profile(self, pair: str) -> ContactProfile:
        """Pressure along the zone of the pair."""
        return pressure_profile(
            self.scene,
            self.scene.contact(pair),
            self.system.grids[pair],
            self.force[self.system.points[pair]],
        )

    def _strain_and_level(self, rod: str, points: Array) -> tuple[Array, IntArray]:
        assembled = self.system.rods[rod]
        turning = turning_at(assembled.rod.centre_line, points[2])
        strain, levels = np.empty((6, points.shape[1])), np.empty(points.shape[1], dtype=np.int64)
        for fields, members, psi, slope in self._axial(assembled, points[2]):
            x, y = points[:2, members]
            b0, b1, _ = strain_operators(assembled.rod.section, fields, x, y, turning[:, members])
            strain[:, members] = np.einsum("pcf,fp->cp", b0, psi) + np.einsum("pcf,fp->cp", b1, slope)
            levels[members] = fields.level
        return strain, levels

    def _axial(self, assembled: AssembledRod, station: Array) -> Iterator[tuple[Fields, IntArray, Array, Array]]:
        """For elements of the same kind: their fields, which stations lie in them, psi and psi' there (n_fields, n)."""
        for fields, members, xi, values in self._alike(assembled, station):
            order = values.shape[1] - 1
            index, _ = assembled.locate(station[members])
            psi = np.einsum("an,naf->fn", shape_functions(order, xi), values)
            slope = np.einsum("an,naf->fn", shape_function_slopes(order, xi), values)
            yield fields, members, psi, slope * (2.0 / np.diff(assembled.borders)[index])

    def _alike(self, assembled: AssembledRod, station: Array) -> Iterator[tuple[Fields, IntArray, Array, Array]]:
        """For elements of the same kind: their fields, which stations lie in them, at which xi, and what moves there.

        The last are the degrees of freedom of each station's element, shape (n, order + 1, n_fields).
        """
        index, xi = assembled.locate(station)
        kinds: dict[tuple[Fields, int], list[int]] = {}
        for number in np.unique(index).tolist():
            element = assembled.elements[number]
            kinds.setdefault((element.fields, element.order), []).append(number)
        place = np.empty(len(assembled.elements), dtype=np.int64)
        for (fields, _), numbers in kinds.items():
            place[:] = -1
            place[numbers] = np.arange(len(numbers))
            members = np.flatnonzero(place[index] >= 0)
            values = np.stack([self.states[assembled.rod.name].coefficients[number] for number in numbers])
            yield fields, members, xi[members], values[place[index[members]]]


@lru_cache(maxsize=64)
def _mean_motion(section: Section, fields: Fields) -> Array:
    """Displacement u, v, w by every field at x = y = 0, or where no material is its mean, shape (n_fields, 3)."""
    if has_centre(section):
        value = section_values(section, fields, np.zeros(1), np.zeros(1))[:, 0]
    else:
        x, y, weight = section_quadrature(section, fields.level)
        value = section_values(section, fields, x, y) @ weight / weight.sum()
    return np.where(fields.table[0][:, None] == (U, V, W), value[:, None], 0.0)


@lru_cache(maxsize=64)
def _resultant_operators(section: Section, material: Material | Orthotropic, fields: Fields, turning: Darboux) -> Array:
    """What psi and then psi' of every field add to N, Q1, Q2, M1, M2, T, shape (6, 2 n_fields)."""
    x, y, weight = product_quadrature(section, fields.level, turning)
    b0, b1, _ = strain_operators(section, fields, x, y, turning)
    # What each stress component at a point adds to each resultant; components xx, yy, xy add nothing.
    lever = np.zeros((6, 6, len(x)))
    lever[0, 2], lever[1, 4], lever[2, 3] = 1.0, 1.0, 1.0
    lever[3, 2], lever[4, 2], lever[5, 3], lever[5, 4] = y, -x, x, -y
    sums = np.einsum("rcp,cd,p->rpd", lever, elasticity_matrix(material, fields.level), weight).reshape(6, -1)
    return np.concatenate([sums @ b0.reshape(-1, fields.count), sums @ b1.reshape(-1, fields.count)], axis=1)
