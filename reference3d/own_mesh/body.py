"""A rod of any elements as an elastic body: stiffness, points found in it, displacement and stress there, loads.

Loads are spread over cross-sections by quadrature points that are looked up in the mesh, so that no layer of elements
need begin where one acts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import coo_array, csc_array, csr_array

from cases.scene import Gravity, LineLoad, Load, Material, SceneError, SectionForce, SectionMoment
from reference3d.centre_line import frames, points
from reference3d.elasticity import lame_parameters
from reference3d.own_mesh.reading import RodMesh, parts
from reference3d.section_mesh import gauss_square, section_mesh, shapes

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]

# of the sections' quadrature (k of `section_mesh`), and Gauss points in every piece of a line load
SECTION_REFINEMENT, ALONG = 2, 4
# Newton's steps at most, and what change ends them
MOST_STEPS, STILL = 25, 1e-12
# how far outside an element, in its own coordinates, a point counts as in it, and how far one may be in none
INSIDE, OUTSIDE, FAR = 1e-8, 0.3, 1.0
# points looked up at a time
AT_A_TIME = 1000


@dataclass(frozen=True, eq=False)
class Places:
    """Points in a mesh; where elements meet, in all of them.

    Attributes
    ----------
    count : of the points
    point, element, local : point, element and place in it of every find, shapes (m,), (m,), (m, 3)
    share : of the finds of a point, together one, shape (m,)
    """

    count: int
    point: IntArray
    element: IntArray
    local: Array
    share: Array


@dataclass(frozen=True, eq=False)
class OwnBody:
    """A rod's mesh with its material."""

    mesh: RodMesh
    material: Material

    @property
    def unknowns(self) -> int:
        """Three for each node."""
        return 3 * len(self.mesh.nodes)

    @cached_property
    def _boxes(self) -> tuple[Array, Array]:
        """Corners of boxes around the elements, a little larger as faces may bulge."""
        nodes = self.mesh.nodes[self.mesh.elements]
        low, high = nodes.min(axis=1), nodes.max(axis=1)
        margin = 0.1 * (high - low).max(axis=1, keepdims=True)
        return low - margin, high + margin

    def gradients(self, elements: IntArray, place: Array) -> tuple[Array, Array]:
        """Derivatives of the functions by global X, Y, Z, and the Jacobians.

        Parameters
        ----------
        elements : nodes, shape (n, n_nodes)
        place : in each of them, the same for all, shape (q, 3), or one for each, shape (n, 1, 3)

        Returns
        -------
        gradients, jacobians : shapes (n, q, n_nodes, 3) and (n, q)
        """
        shape = (-1, place.shape[-2], elements.shape[1], 3)
        slopes = self.mesh.kind.slopes(place.reshape(-1, 3)).reshape(shape)
        mapping = np.einsum(
            "enc,eqnd->eqcd", self.mesh.nodes[elements], np.broadcast_to(slopes, (len(elements), *slopes.shape[1:]))
        )
        return slopes @ np.linalg.inv(mapping), np.linalg.det(mapping)

    def stiffness(self) -> csc_array:
        """K_ai,bj = int lam G_ai G_bj + mu (G_aj G_bi + delta_ij G_a . G_b), all elements of a part at once."""
        lam, mu = lame_parameters(self.material)
        place, weight = self.mesh.kind.quadrature
        total = csc_array((self.unknowns, self.unknowns))
        for elements in parts(self.mesh.elements):
            gradient, jacobian = self.gradients(elements, place)
            count, nodes = elements.shape
            flat = gradient.reshape(count, len(weight), 3 * nodes)
            product = np.swapaxes(flat * (jacobian * weight)[:, :, None], 1, 2) @ flat
            product = product.reshape(count, nodes, 3, nodes, 3)
            matrix = lam * product + mu * product.transpose(0, 1, 4, 3, 2)
            dots = mu * np.einsum("eaibi->eab", product)
            for axis in range(3):
                matrix[:, :, axis, :, axis] += dots
            unknown = (3 * elements[:, :, None] + np.arange(3)).reshape(count, -1)
            shape = (count, 3 * nodes, 3 * nodes)
            rows, columns = (
                np.broadcast_to(each, shape).ravel() for each in (unknown[:, :, None], unknown[:, None, :])
            )
            total = total + coo_array((matrix.ravel(), (rows, columns)), shape=total.shape).tocsc()
        return total

    def find(self, position: Array) -> Places:
        """Look up points, global, mm, shape (n, 3), in the mesh.

        Raises
        ------
        SceneError
            if one lies clearly outside.
        """
        found = [self._find(position[start : start + AT_A_TIME], start) for start in range(0, len(position), AT_A_TIME)]
        point, element, local = (np.concatenate([part[number] for part in found]) for number in range(3))
        often = np.bincount(point, minlength=len(position))
        return Places(len(position), point, element, local, 1.0 / often[point])

    def _find(self, position: Array, start: int) -> tuple[IntArray, IntArray, Array]:
        low, high = self._boxes
        near = np.flatnonzero(((high >= position.min(axis=0)) & (low <= position.max(axis=0))).all(axis=1))
        inside = (position[:, None] >= low[near]) & (position[:, None] <= high[near])
        point, chosen = np.nonzero(inside.all(axis=2))
        element = near[chosen]
        kind, nodes = self.mesh.kind, self.mesh.nodes[self.mesh.elements[element]]
        local = np.full((len(point), 3), 0.25 if kind.is_simplex else 0.0)
        moving = np.arange(len(point))
        for _ in range(MOST_STEPS):
            here = local[moving]
            missing = position[point[moving]] - np.einsum("mn,mnc->mc", kind.functions(here), nodes[moving])
            mapping = np.einsum("mnc,mnd->mcd", nodes[moving], kind.slopes(here))
            step = np.linalg.solve(mapping, missing[:, :, None])[:, :, 0]
            local[moving] = np.clip(here + step, -2.0, 2.0)
            # a point that is far outside after a step or two is so in the end
            moving = moving[(np.abs(step).max(axis=1) > STILL) & (kind.beyond(local[moving]) < FAR)]
            if len(moving) == 0:
                break
        beyond = kind.beyond(local)
        beyond[moving] = np.maximum(beyond[moving], OUTSIDE)
        least = np.full(len(position), np.inf)
        np.minimum.at(least, point, beyond)
        if not (least < OUTSIDE).all():
            rod = self.mesh.rod.name
            where = ", ".join(f"{value:.4g}" for value in position[int(np.argmax(least))])
            raise SceneError(f"group '{rod}'", f"no element at ({where}) mm", f"the mesh is to fill rod '{rod}'")
        holding = beyond <= np.maximum(INSIDE, least[point])
        return point[holding] + start, element[holding], local[holding]

    def interpolation(self, places: Places) -> csr_array:
        """Rows that make the displacement at points, three after another, of the nodes'; shape (3 n, unknowns)."""
        functions = self.mesh.kind.functions(places.local) * places.share[:, None]
        nodes = self.mesh.elements[places.element]
        rows = 3 * places.point[:, None, None] + np.arange(3)
        columns = 3 * nodes[:, :, None] + np.arange(3)
        shape = columns.shape
        values = np.broadcast_to(functions[:, :, None], shape).ravel()
        entries = (np.broadcast_to(rows, shape).ravel(), columns.ravel())
        return coo_array((values, entries), shape=(3 * places.count, self.unknowns)).tocsr()

    def stress(self, displacement: Array, places: Places, axes: Array) -> Array:
        """Stress in given frames: xx, yy, ss, ys, xs, xy, MPa, shape (6, n).

        displacement : of the nodes, mm, shape (n_nodes, 3); axes : rows of the frame at every point, shape (n, 3, 3)
        """
        lam, mu = lame_parameters(self.material)
        result = np.zeros((places.count, 6))
        for part in np.array_split(np.arange(len(places.point)), max(1, len(places.point) // AT_A_TIME)):
            elements = self.mesh.elements[places.element[part]]
            gradient = self.gradients(elements, places.local[part][:, None])[0][:, 0]
            here = axes[places.point[part]]
            moved = np.einsum("mnc,mnd->mcd", displacement[elements], gradient)
            strain = here @ (0.5 * (moved + np.swapaxes(moved, 1, 2))) @ np.swapaxes(here, 1, 2)
            tensor = 2.0 * mu * strain + lam * np.einsum("mcc->m", strain)[:, None, None] * np.eye(3)
            picked = tensor[:, [0, 1, 2, 1, 0, 0], [0, 1, 2, 2, 2, 1]]
            np.add.at(result, places.point[part], picked * places.share[part, None])
        return result.T

    @cached_property
    def section_points(self) -> tuple[Array, Array]:
        """Quadrature points (x, y) of the section, mm, shape (n, 2), and their areas, mm^2, shape (n,)."""
        mesh = section_mesh(self.mesh.rod.section, SECTION_REFINEMENT)
        xi, eta, weight = gauss_square()
        values, slopes = shapes(xi, eta)
        corners = mesh.nodes[mesh.quads]
        jacobian = np.linalg.det(np.einsum("eac,adg->egcd", corners, slopes))
        place = np.einsum("ag,eac->egc", values, corners)
        return np.reshape(place, (-1, 2)), np.ravel(jacobian * weight)

    def in_sections(self, station: Array) -> Array:
        """The quadrature points of sections in space, global, mm, shape (n_stations, n, 3)."""
        line, (place, _) = self.mesh.rod.centre_line, self.section_points
        offset = np.einsum("nc,scg->sng", place, frames(line, station)[:, :2])
        return np.asarray(points(line, station)[:, None] + offset)

    def loads(self, loads: Sequence[Load]) -> Array:
        """All loads on the rod as forces of its nodes, N, shape (unknowns,).

        Raises
        ------
        SceneError
            if there is a load of a kind that is not spread over a mesh of one's own.
        """
        force = np.zeros(self.unknowns)
        for number, load in enumerate(loads, 1):
            if load.rod != self.mesh.rod.name:
                continue
            match load:
                case SectionForce():
                    area = self.section_points[1]
                    traction = np.outer(area / area.sum(), load.force)
                    force += self._spread(np.array([load.position]), traction[None])
                case SectionMoment():
                    force += self._spread(np.array([load.position]), self._moment(load)[None])
                case LineLoad():
                    root, weight = np.polynomial.legendre.leggauss(ALONG)
                    pieces = np.linspace(load.start, load.end, 2 * len(self.mesh.rod.element_borders) + 1)
                    half = 0.5 * np.diff(pieces)[:, None]
                    station = (0.5 * (pieces[1:] + pieces[:-1])[:, None] + half * root).ravel()
                    area = self.section_points[1]
                    share = np.multiply.outer((half * weight).ravel(), area / area.sum())
                    force += self._spread(station, np.multiply.outer(share, np.array(load.force)))
                case Gravity():
                    force += self._weight(load)
                case _:
                    found = type(load).__name__.lower()
                    remedy = "a mesh of one's own takes section forces, section moments, line loads and gravity"
                    raise SceneError(f"loads #{number}.kind", f"a {found}", remedy)
        return force

    def _spread(self, station: Array, force: Array) -> Array:
        """Forces at the quadrature points of sections, N, shape (n_stations, n, 3), as forces of the nodes."""
        places = self.find(self.in_sections(station).reshape(-1, 3))
        return np.asarray(self.interpolation(places).T @ force.ravel())

    def _moment(self, load: SectionMoment) -> Array:
        """Forces of a moment at the section's quadrature points, global, N, shape (n, 3).

        Normal traction a x + b y with int t y = M1, -int t x = M2, and a turning one (-y, x) M3 / polar moment.
        """
        rod = self.mesh.rod
        (x, y), area = self.section_points[0].T, self.section_points[1]
        xx, xy, yy = (float((one * other * area).sum()) for one, other in ((x, x), (x, y), (y, y)))
        axes = frames(rod.centre_line, np.array([load.position]))[0]
        m1, m2, m3 = axes @ np.array(load.moment)
        slopes = np.linalg.solve(np.array([[xy, yy], [-xx, -xy]]), np.array([m1, m2]))
        turning = m3 / (xx + yy)
        local = np.stack([-y * turning, x * turning, slopes[0] * x + slopes[1] * y], axis=1)
        return np.asarray(area[:, None] * (local @ axes))

    def _weight(self, load: Gravity) -> Array:
        assert self.material.density is not None  # a scene with gravity asks for it
        jacobian, _ = self.mesh.volumes()
        place, weight = self.mesh.kind.quadrature
        nodal = (jacobian * weight) @ self.mesh.kind.functions(place)
        share = np.bincount(self.mesh.elements.ravel(), nodal.ravel(), len(self.mesh.nodes))
        return np.outer(share, self.material.density * np.array(load.acceleration)).ravel()
