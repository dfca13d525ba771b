"""What a solution of a scene must be able to say, whoever computed it.

`rodmodel` and `reference3d` share no code; both return an object of this shape, and `reports.quantities` turns
either into the compared quantities with the same few lines. Everything is for the full section, also where a
solver used a symmetry plane. Sections and faces: `cases.scene`.
"""

from __future__ import annotations

from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene

Array = NDArray[np.float64]


class ContactPoints(Protocol):
    """The discrete contact of one pair, one entry a contact point.

    Attributes
    ----------
    position : point on the first face, global coordinates, mm, shape (3, n)
    normal : n_c, outward normal of the first face, shape (3, n)
    gap : d, distance of the faces after deformation (negative: penetration), mm, shape (n,)
    force : compressive contact force carried by the point, N, never negative, shape (n,); it acts along
        -normal on the first rod and +normal on the second
    pressure : force over the point's share of the face, MPa, shape (n,)
    """

    @property
    def position(self) -> Array: ...
    @property
    def normal(self) -> Array: ...
    @property
    def gap(self) -> Array: ...
    @property
    def force(self) -> Array: ...
    @property
    def pressure(self) -> Array: ...


class ContactProfile(Protocol):
    """Contact pressure along the zone of a pair, at the solver's own stations.

    Attributes
    ----------
    station : arc length along the first rod, mm, ascending, shape (n,); covers the whole zone
    position : points in the middle of the first face, global coordinates, mm, shape (3, n)
    middle, mean, outer : pressure p_n in the middle of the width, averaged over the width, and at its outer
        border (the larger of the two borders where they differ), MPa, shape (n,); zero where the faces are apart
    """

    @property
    def station(self) -> Array: ...
    @property
    def position(self) -> Array: ...
    @property
    def middle(self) -> Array: ...
    @property
    def mean(self) -> Array: ...
    @property
    def outer(self) -> Array: ...


class BedForces(Protocol):
    """What a Winkler bed exerts on its rod, as forces at points.

    Attributes
    ----------
    station : arc length of the sections in which they act, mm, shape (n,)
    position : points of the undeformed face, global coordinates, mm, shape (3, n)
    force : on the rod, global components, N, shape (3, n)
    """

    @property
    def station(self) -> Array: ...
    @property
    def position(self) -> Array: ...
    @property
    def force(self) -> Array: ...


class Cost(Protocol):
    """unknowns: carried in the solution; setup, solve: wall-clock seconds, disjoint."""

    @property
    def unknowns(self) -> int: ...
    @property
    def setup_seconds(self) -> float: ...
    @property
    def solve_seconds(self) -> float: ...


class Solution(Protocol):
    """A solved scene.

    Attributes
    ----------
    scene : what was solved
    outcome : 'converged', or why not: 'cycling', 'stagnated', 'refused: reason'. A solution that did not converge
        still answers, so that one can look at it.
    contact_solutions : contact problems solved, one a mesh or set of element borders
    active_sets : sets of touching points tried in all of them
    strain_energy : elastic energy of all rods, N mm
    cost : see `Cost`
    """

    @property
    def scene(self) -> Scene: ...
    @property
    def outcome(self) -> str: ...
    @property
    def contact_solutions(self) -> int: ...
    @property
    def active_sets(self) -> int: ...
    @property
    def strain_energy(self) -> float: ...
    @property
    def cost(self) -> Cost: ...

    def frame(self, rod: str, station: Array) -> tuple[Array, Array]:
        """The undeformed centre line: points, global, mm, shape (3, n), and rows e1, e2, t there, shape (n, 3, 3).

        station : arc length from the rod's start, mm, shape (n,)
        """
        ...

    def displacement(self, rod: str, station: Array) -> Array:
        """Displacement of the centre line, global components, mm, shape (3, n).

        That of the point x = y = 0; of a section without material there, the mean of the section, int u dA / A.

        station : arc length from the rod's start, mm, shape (n,)
        """
        ...

    def stress(self, rod: str, points: Array) -> Array:
        """Stress in the local frame (e1, e2, t), MPa: xx, yy, ss, ys, xs, xy, shape (6, n).

        points : (x, y, s), mm, shape (3, n)
        """
        ...

    def section_resultants(self, rod: str, station: Array) -> Array:
        """Integrals of the stress over the section, shape (6, n).

        N = int sigma_s, Q1 = int tau_xs, Q2 = int tau_ys (N), M1 = int sigma_s y, M2 = -int sigma_s x,
        T = int (x tau_ys - y tau_xs) (N mm): force and moment in the local frame that the part beyond s exerts
        on the part before it.
        """
        ...

    def reaction(self, rod: str, station: float) -> Array:
        """What the support or joint at an arc length (mm) exerts on the rod, global, shape (6,).

        Force (N) and moment about the section's centre (N mm).
        """
        ...

    def bed_forces(self, bed: int, borders: Array) -> BedForces:
        """Forces of the scene's bed number `bed` (from 0) on its rod.

        borders : arc lengths, mm, ascending, shape (n,); there are several points between every two of them, and
            their sum is the bed's resultant there
        """
        ...

    def contact_points(self, pair: str) -> ContactPoints:
        """State of every contact point of the pair."""
        ...

    def contact_profile(self, pair: str) -> ContactProfile:
        """Pressure along the zone of the pair."""
        ...


Model = Literal["rod", "reference"]
