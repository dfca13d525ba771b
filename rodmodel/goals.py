"""The few numbers that a solution is wanted for: contact forces, largest deflections, clamp moments, contact edges."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from cases.scene import Clamp, Rod, Scene, station_of
from rodmodel.solution import Solution

Array = NDArray[np.float64]

# Even steps along a rod at which its deflection is looked at; a parabola finds the largest in between.
STEPS = 32
# Deflections below this part of the turning of sections are none.
ROUND_OFF = 1e-9
# Moments in clamps below this part of force times length are none: where the line of action passes through a curved
# rod's clamp, polynomials along the rod leave some 1e-4.
NO_MOMENT = 1e-3


@dataclass(frozen=True)
class Goal:
    """A number that a solution is wanted for.

    Attributes
    ----------
    kind : resultant of a pair's contact pressure (N); largest displacement of a rod's centre line (mm); largest moment
        that a clamp exerts on a rod (N mm); end of a stretch in contact (mm along the pair's first rod); elastic energy
        (N mm) of a scene that has none of these
    of : name of the pair, the rod or the scene
    number : of the edge, from 0 at the zone's start
    """

    kind: Literal["contact force", "deflection", "clamp moment", "contact edge", "energy"]
    of: str
    number: int = 0

    @property
    def unit(self) -> str:
        """Of its value."""
        return {"contact force": "N", "clamp moment": "N mm", "energy": "N mm"}.get(self.kind, "mm")


def goals(solution: Solution) -> Mapping[Goal, float]:
    """The values of all goals of a solution."""
    scene = solution.scene
    found: dict[Goal, float] = {}
    for pair in scene.contacts:
        points = solution.contact_points(pair.name)
        found[Goal("contact force", pair.name)] = float(np.linalg.norm(points.normal @ points.force))
    for rod in scene.rods:
        moved = solution.displacement(rod.name, np.linspace(0.0, rod.length, 1 + STEPS))
        deflection = _peak(np.linalg.norm(moved, axis=0))
        if deflection > ROUND_OFF * max(np.abs(each).max() for each in solution.states[rod.name].coefficients):
            found[Goal("deflection", rod.name)] = deflection
        moment = clamp_moment(solution, scene, rod)
        if moment > 0.0:
            found[Goal("clamp moment", rod.name)] = moment
    if not found:
        # a rod that is twisted about its centre line, which stays
        found[Goal("energy", scene.name)] = solution.stored_energy
    for pair in scene.contacts:
        ends = [at for each in solution.stretches if each.pair == pair.name for at in (each.start, each.end)]
        found |= {Goal("contact edge", pair.name, number): end for number, end in enumerate(ends)}
    return found


def clamp_moment(solution: Solution, scene: Scene, rod: Rod) -> float:
    """Largest of the moments that the rod's clamps exert on it, N mm; 0 where they are none (`NO_MOMENT`)."""
    stations = [
        station_of(support, rod) for support in scene.supports if isinstance(support, Clamp) and support.rod == rod.name
    ]
    reactions = np.array([solution.reaction(rod.name, station) for station in stations]).reshape(-1, 2, 3)
    forces, moments = np.linalg.norm(reactions, axis=2).max(axis=0, initial=0.0)
    return float(moments) if moments > NO_MOMENT * forces * rod.length else 0.0


def _peak(values: Array) -> float:
    """Largest of values at even steps, by the parabola through the largest and its neighbours."""
    top = int(values.argmax())
    if top in (0, len(values) - 1):
        return float(values[top])
    before, at, after = values[top - 1 : top + 2]
    bend = before - 2.0 * at + after
    return float(at - 0.125 * (after - before) ** 2 / bend) if bend < 0.0 else float(at)
