"""What a chart shows: configurations of methods as points, the reference they are held against, and their errors."""

from __future__ import annotations

import math
import statistics
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from cases.scene import Clamp, Scene, station_of
from reports.chart.beams import BeamAnswer
from reports.comparison import Estimate, Extrapolate, edges_estimate, sequence_estimate
from reports.geometry import AXES
from reports.peers import Answer
from reports.quantities import ContactQuantities, Quantities
from rodmodel import Estimate as GoalEstimate

Charted = Literal["contact_force", "largest_deflection", "contact_edges", "clamp_moment", "peak_pressure"]
TITLES: Mapping[Charted, str] = {
    "contact_force": "Contact force",
    "largest_deflection": "Largest deflection",
    "contact_edges": "Contact edges in the middle of the width",
    "clamp_moment": "Moment in the clamp",
    "peak_pressure": "Peak pressure in the middle of the width",
}
# Errors of lengths are lengths, mm; all others are fractions of the reference.
LENGTHS: frozenset[Charted] = frozenset({"contact_edges"})
# By quantity and pair, rod or clamp.
Values = Mapping[tuple[Charted, str], tuple[float, ...]]
# Moments below this part of the largest one are round-off.
NO_MOMENT = 1e-6

ROD_OWN, ROD_GRADED, ROD_AUTO = "rod model, own elements", "rod model, graded elements", "rod model, its own choice"
SOLID = "3D"
CALCULIX, NGSOLVE = "CalculiX", "NGSolve"
NGSOLVE_TUNED, NGSOLVE_BOUNDARY = "NGSolve, tuned and condensed", "NGSolve, ContactBoundary"


@dataclass(frozen=True, eq=False)
class Point:
    """One configuration of a method.

    Attributes
    ----------
    method, label : who, and with which settings
    outcome : 'converged', or why not
    seconds : of each run, in the order they were run
    clock : 'processor' or 'wall'
    values : what it says
    estimates : how far off it believes itself to be, for those of the values that it says so of, in the same measure as
        errors: parts of the value, edges in mm
    chosen : levels that it chose for itself, step by step, in words; '' where it had no choice
    """

    method: str
    label: str
    outcome: str
    unknowns: int
    seconds: tuple[float, ...]
    clock: Literal["processor", "wall"]
    values: Values
    estimates: Values = field(default_factory=dict)
    chosen: str = ""

    @property
    def median(self) -> float:
        """Median of the runs, s."""
        return statistics.median(self.seconds)


@dataclass(frozen=True)
class Reference:
    """What a quantity is held against.

    Attributes
    ----------
    values : by pair, rod or clamp; empty where there is nothing to hold it against
    uncertainty : in the measure of its errors, the largest; None where one is unknown
    reason : why there are no values, or what else the reader must know; may be empty
    uncertainties : by pair, rod or clamp
    """

    values: Mapping[str, tuple[float, ...]]
    uncertainty: float | None
    reason: str = ""
    uncertainties: Mapping[str, float | None] = field(default_factory=dict)


@dataclass(frozen=True)
class Chart:
    """All configurations of a case.

    Attributes
    ----------
    notes : what was left out and why, and where seconds come from, a sentence each
    """

    title: str
    points: tuple[Point, ...]
    references: Mapping[Charted, Reference]
    notes: tuple[str, ...]

    def error(self, quantity: Charted, point: Point) -> float | None:
        """The largest error over pairs, rods or clamps, each relative to its own reference; lengths in mm.

        None where the point does not tell the quantity, did not converge, or touches over another number of stretches.
        """
        if point.outcome != "converged" or not self.references[quantity].values:
            return None
        errors = [self.error_of(quantity, of, point) for of in self.references[quantity].values]
        known = [error for error in errors if error is not None]
        return max(known) if len(known) == len(errors) else None

    def error_of(self, quantity: Charted, of: str, point: Point) -> float | None:
        """The error of one pair, rod or clamp, as `error` has it, whatever the outcome."""
        wanted, found = self.references[quantity].values[of], point.values.get((quantity, of), ())
        if len(found) != len(wanted):
            return None
        apart = max(abs(one - other) for one, other in zip(found, wanted, strict=True))
        error = apart if quantity in LENGTHS else apart / abs(wanted[0])
        return error if math.isfinite(error) else None


def own_values(scene: Scene, found: Quantities) -> Values:
    """What one of our solvers says."""
    values: dict[tuple[Charted, str], tuple[float, ...]] = {}
    for contact in found.contacts:
        values["contact_force", contact.pair] = (contact.force,)
        values["contact_edges", contact.pair] = tuple(float(edge) for stretch in contact.edges for edge in stretch)
        values["peak_pressure", contact.pair] = (float(contact.pressure.middle.max(initial=0.0)),)
    for rod in found.rods:
        values["largest_deflection", rod.rod] = (float(np.linalg.norm(rod.displacement, axis=0).max()),)
    for (rod_name, station), reaction in found.reactions.items():
        if (rod_name, station) in _clamps(scene):
            values["clamp_moment", _clamp_name(rod_name, station)] = (float(np.linalg.norm(reaction[3:])),)
    return values


def own_estimates(estimates: Iterable[GoalEstimate], values: Values) -> Values:
    """The rod model's estimates for what a chart shows; of a rod's clamps, those of the one with the largest moment."""
    found: dict[tuple[Charted, str], tuple[float, ...]] = {}
    for each in estimates:
        name = each.goal.of
        match each.goal.kind:
            case "contact force":
                found["contact_force", name] = (each.relative,)
            case "deflection":
                found["largest_deflection", name] = (each.relative,)
            case "clamp moment":
                clamps = [key for key in values if key[0] == "clamp_moment" and key[1].rpartition(" at ")[0] == name]
                found[max(clamps, key=lambda key: values[key])] = (each.relative,)
            case "contact edge":
                found["contact_edges", name] = (*found.get(("contact_edges", name), ()), each.error)
    return found


def peer_values(answer: Answer) -> Values:
    """What a peer says: neither edges nor pressures."""
    values: dict[tuple[Charted, str], tuple[float, ...]] = {}
    for pair, force in answer.contact_force.items():
        values["contact_force", pair] = (float(np.linalg.norm(force)),)
    for rod, displacement in answer.displacement.items():
        values["largest_deflection", rod] = (float(np.linalg.norm(displacement, axis=0).max()),)
    for (rod, station), reaction in answer.reactions.items():
        values["clamp_moment", _clamp_name(rod, station)] = (float(np.linalg.norm(reaction[3:])),)
    return values


def beam_values(answer: BeamAnswer) -> Values:
    """What beam theory says: its beams touch in points and lines, so that there is no pressure."""
    values: dict[tuple[Charted, str], tuple[float, ...]] = {}
    for pair, force in answer.contact_force.items():
        values["contact_force", pair] = (force,)
        values["contact_edges", pair] = answer.edges[pair]
    for rod, deflection in answer.largest_deflection.items():
        values["largest_deflection", rod] = (deflection,)
    for (rod, station), moment in answer.clamp_moment.items():
        values["clamp_moment", _clamp_name(rod, station)] = (moment,)
    return values


def references_of(scene: Scene, meshes: Sequence[Quantities], extrapolate: Extrapolate) -> dict[Charted, Reference]:
    """References of all quantities that the scene has, from the 3D reference on three meshes, coarse to fine.

    Rods, pairs and clamps whose reference vanishes are left out: nothing can be relative to them.
    """
    each = [own_values(scene, mesh) for mesh in meshes]
    singular = {
        pair.name: where
        for pair in scene.contacts
        if not pair.on_bed and (where := _singular_at(meshes[-1].contact(pair.name)))
    }
    found: dict[Charted, Reference] = {}
    for quantity in TITLES:
        names = [of for kind, of in each[-1] if kind == quantity]
        if not names:
            continue
        reasons = []
        if quantity == "peak_pressure" and singular:
            names = [name for name in names if name not in singular]
            reasons = [
                f"{pair}: singular at {where}, so that no mesh gives its value" for pair, where in singular.items()
            ]
        estimates = {of: _estimate(quantity, of, each, meshes, extrapolate) for of in names}
        largest = max((float(np.abs(one.value).max(initial=0.0)) for one in estimates.values()), default=0.0)
        values: dict[str, tuple[float, ...]] = {}
        uncertain: dict[str, float | None] = {}
        for of, estimate in estimates.items():
            size = float(np.abs(estimate.value).max(initial=0.0))
            if size == 0.0 or (quantity == "clamp_moment" and size < NO_MOMENT * largest):
                continue
            values[of] = tuple(estimate.value.tolist())
            scale = 1.0 if quantity in LENGTHS else size
            uncertain[of] = None if estimate.uncertainty is None else estimate.uncertainty / scale
        if not values and not reasons:
            reasons = ["it vanishes: there is nothing to hold it against"]
        known = [part for part in uncertain.values() if part is not None]
        uncertainty = max(known) if known and len(known) == len(uncertain) else None
        found[quantity] = Reference(values, uncertainty, "; ".join(reasons), uncertain)
    return found


def _estimate(
    quantity: Charted, of: str, each: Sequence[Values], meshes: Sequence[Quantities], extrapolate: Extrapolate
) -> Estimate:
    numbers = [np.array(values.get((quantity, of), ())) for values in each]
    if quantity == "contact_edges":
        return edges_estimate(numbers, meshes[-1].contact(of).edges_resolution)
    return sequence_estimate(numbers, extrapolate, curve=False)


def _singular_at(contact: ContactQuantities) -> str:
    """Where contact runs to the end of its zone or of a rod, whose corner presses singularly; '' where it does not."""
    position = contact.pressure.position
    ends = float(position.min()), float(position.max())
    edges = {edge for stretch in contact.edges for edge in stretch}
    reached = [end for end in ends if any(abs(edge - end) < 1e-6 * (ends[1] - ends[0]) for edge in edges)]
    return " and ".join(f"{AXES[contact.axis]} = {end:g} mm" for end in reached)


def _clamps(scene: Scene) -> set[tuple[str, float]]:
    return {
        (support.rod, station_of(support, scene.rod(support.rod)))
        for support in scene.supports
        if isinstance(support, Clamp)
    }


def _clamp_name(rod: str, station: float) -> str:
    return f"{rod} at {station:g} mm"
