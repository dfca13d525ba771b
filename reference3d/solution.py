"""What is kept of a scene solved as a 3D solid, and its answers: displacement, stress, reactions, contact.

`Solution` has the shape that `reports.solution` asks for. All answers are for the full section, also where
the scene's symmetry plane halved the computation. `solver` makes it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from cases.scene import ContactPair, Rod, Scene
from reference3d.field import Field, displacement, section_resultants, stress
from reference3d.frames import face_frame, rod_frame
from reference3d.scope import isotropic

Array = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
IntArray = NDArray[np.int64]


@dataclass(frozen=True)
class Cost:
    """unknowns : carried in the solution; setup, solve : wall-clock seconds, disjoint."""

    unknowns: int
    setup_seconds: float
    solve_seconds: float


@dataclass(frozen=True)
class ContactPoints:
    """Nodes of the first face of a pair (`reports.solution.ContactPoints`).

    position, normal : global, mm, shape (3, n); gap : d, mm, force : N, pressure : MPa, shape (n,) each
    """

    position: Array
    normal: Array
    gap: Array
    force: Array
    pressure: Array


@dataclass(frozen=True)
class ContactProfile:
    """Nodal pressure along a pair (`reports.solution.ContactProfile`).

    The mean is over the full width of the first face; the outer border is that of the strip where the faces
    overlap. position : global, mm, shape (3, n); the others MPa or mm, shape (n,)
    """

    station: Array
    position: Array
    middle: Array
    mean: Array
    outer: Array


@dataclass(frozen=True)
class RodResult:
    """What is kept of one rod: displacement field and nodal support forces in the local frame.

    reaction : force and moment on the rod about the section's centre at start and end, global, shape (2, 6)
    """

    rod: Rod
    field: Field
    reaction: Array


@dataclass(frozen=True)
class PairResult:
    """What is kept of one contact pair, on the full grid of contact nodes.

    station, lateral : mm, shapes (n_s,), (n_lateral,); area, mm^2, gap, mm, pressure, MPa, shape (n_s, n_lateral)
    """

    pair: ContactPair
    station: Array
    lateral: Array
    area: Array
    gap: Array
    pressure: Array


@dataclass(frozen=True)
class Solution:
    """A scene solved as a 3D solid; `reports.solution.Solution` describes the common part.

    Attributes
    ----------
    residual : largest nodal force out of balance relative to the rod's largest internal nodal force
    representative_size : cube root of the mean element volume, mm (h of ASME V&V 20)
    refinement : k of `grading`
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
    rods: dict[str, RodResult]
    pairs: dict[str, PairResult]

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        """Points of the undeformed centre line, global, mm, shape (3, n), and rows e1, e2, t there, (n, 3, 3)."""
        frame = rod_frame(self.rods[rod].rod)
        station = np.asarray(station, dtype=np.float64)
        points = frame.origin[:, None] + np.outer(frame.axes[2], station)
        return points, np.tile(frame.axes, (len(station), 1, 1))

    def displacement(self, rod: str, station: Array) -> Array:
        """Displacement of the centre line at arc lengths `station`, global, mm, shape (3, n)."""
        station = np.asarray(station, dtype=np.float64)
        return self.displacement_at(rod, np.stack([np.zeros_like(station), np.zeros_like(station), station]))

    def displacement_at(self, rod: str, points: Array) -> Array:
        """Displacement at points (x, y, s) of a rod, global components, mm; shape (3, n) to (3, n)."""
        axes = rod_frame(self.rods[rod].rod).axes
        return np.asarray(axes.T @ displacement(self.rods[rod].field, points))

    def stress(self, rod: str, points: Array) -> Array:
        """Stress in the local frame at (x, y, s): xx, yy, ss, ys, xs, xy, MPa, shape (6, n)."""
        return stress(self.rods[rod].field, isotropic(self.rods[rod].rod), np.asarray(points, dtype=np.float64))

    def section_resultants(self, rod: str, station: Array) -> Array:
        """N, Q1, Q2, M1, M2, T of the finite element stress, N and N mm, shape (6, n)."""
        return section_resultants(self.rods[rod].field, isotropic(self.rods[rod].rod), station)

    def reaction(self, rod: str, station: float) -> Array:
        """Force (N) and moment (N mm) of the clamp at an end on the rod, global, shape (6,); zero at a free end.

        station : 0 or the rod's length, mm

        Raises
        ------
        ValueError
            if the station is not an end of the rod.
        """
        length = self.rods[rod].rod.length
        if station not in (0.0, length):
            raise ValueError(f"station: found {station:g}; clamps are at 0 and at {length:g} mm")
        return np.asarray(self.rods[rod].reaction[0 if station == 0.0 else 1])

    def bed_forces(self, bed: int, borders: Array) -> NoReturn:  # noqa: ARG002 (as the protocol has it)
        """No scene with beds is solved (`scope`), so that there is none to answer for: IndexError."""
        raise IndexError(f"bed: found {bed}; the scene has none")

    def contact_points(self, pair: str) -> ContactPoints:
        """State of every contact node of a pair."""
        result = self.pairs[pair]
        s, lateral = (grid.ravel() for grid in np.meshgrid(result.station, result.lateral, indexing="ij"))
        normal = face_frame(self.scene.rod(result.pair.first.rod), result.pair.first.face).normal
        return ContactPoints(
            position=self._on_first_face(result.pair, s, lateral),
            normal=np.repeat(normal[:, None], len(s), axis=1),
            gap=result.gap.ravel(),
            force=(result.area * result.pressure).ravel(),
            pressure=result.pressure.ravel(),
        )

    def contact_profile(self, pair: str) -> ContactProfile:
        """Nodal pressure along the zone; none in the middle if the second face does not reach it."""
        result = self.pairs[pair]
        pressure, lateral = result.pressure, result.lateral
        across = result.area.sum(axis=0) / (result.pair.zone[1] - result.pair.zone[0])
        width = 2.0 * face_frame(self.scene.rod(result.pair.first.rod), result.pair.first.face).half_width
        middle = int(np.argmin(np.abs(lateral)))
        inside = lateral[0] < 1e-9 * width and lateral[-1] > -1e-9 * width
        rows = (
            pressure[:, middle] if inside else np.zeros(len(pressure)),
            pressure @ across / width,
            np.maximum(pressure[:, 0], pressure[:, -1]),
        )
        return ContactProfile(
            result.station,
            self._on_first_face(result.pair, result.station, np.zeros_like(result.station)),
            *rows,
        )

    def _on_first_face(self, pair: ContactPair, station: Array, lateral: Array) -> Array:
        rod = self.scene.rod(pair.first.rod)
        face = face_frame(rod, pair.first.face)
        corner = rod_frame(rod).origin + face.offset * face.normal
        return np.asarray(corner[:, None] + np.outer(face.tangent, station) + np.outer(face.lateral, lateral))
