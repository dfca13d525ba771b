"""A sweep carried out: every case solved, and its quantities as rows of a table, one for each value and quantity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from cases.case import Grades
from cases.scene import Rod, Scene, SectionForce, SectionMoment, Vector
from reports.applied_forces import applied_forces, reactions
from reports.equilibrium import equilibrium_residual
from reports.quantities import (
    DEFINITIONS,
    ContactQuantities,
    Definition,
    RodQuantities,
    contact_quantities,
    default_stations,
    rod_quantities,
    stress_s,
)
from reports.solution import Array
from reports.sweep.keys import SweepPoint, Variation
from rodmodel.solution import Solution
from rodmodel.sweep import sweep

# All quantities of a sweep. What `contact_edges` reads off the pressure depends on which points next to the edge touch,
# and may jump from value to value; where the search has put the borders does not.
SWEPT: Mapping[str, Definition] = {
    **DEFINITIONS,
    "contact_borders": Definition(
        "Contact edges, as searched for",
        "mm",
        "Start and end of each stretch in contact, along the global axis that the first rod is most nearly parallel to "
        "in the middle of the zone: where the rod model's search has found the pressure in the middle of the width to "
        "vanish, to 0.01 mm; where it did not settle, where the contact points show an edge.",
    ),
}


@dataclass(frozen=True)
class Row:
    """One quantity for one combination of values.

    Attributes
    ----------
    number : of the combination, from 1
    values : of the varied keys, in the units of the variations
    quantity : one of `SWEPT`
    of : rod or contact pair; empty for the whole scene
    part : which of several, such as 'start 1' of the first stretch in contact; empty where there is one
    value : in the unit of the quantity's definition
    outcome : the solver's: 'converged', or why not
    followed : whether the search for contact began where the values before led, and did not begin anew
    """

    number: int
    values: tuple[float, ...]
    quantity: str
    of: str
    part: str
    value: float
    unit: str
    outcome: str
    followed: bool


def sweep_rows(points: Sequence[SweepPoint], variations: Sequence[Variation]) -> Iterator[list[Row]]:
    """The rows of every point, solved in turn at the level and order of its case.

    Raises
    ------
    SceneError
        if a scene leaves a rod loose that no contact could hold.
    """
    logarithmic = variations[-1].logarithmic
    along = [np.log(abs(point.values[-1])) if logarithmic else point.values[-1] for point in points]
    number = 0
    for settings, first, last in _runs_of_settings(points):
        run = points[first:last]
        scenes = ((at, point.case.scene) for at, point in zip(along[first:last], run, strict=True))
        for point, swept in zip(run, sweep(scenes, *settings), strict=True):
            number += 1
            stress_points = [(check.of, check.point) for check in point.case.compare if check.point is not None]
            yield [
                Row(
                    number,
                    point.values,
                    quantity,
                    of,
                    part,
                    value,
                    SWEPT[quantity].unit,
                    swept.solution.outcome,
                    swept.followed,
                )
                for quantity, of, part, value in sweep_quantities(swept.solution, stress_points)
            ]


def _runs_of_settings(points: Sequence[SweepPoint]) -> Iterator[tuple[tuple[Grades, Grades], int, int]]:
    """Level and order, and which points in a row have them."""
    settings = [(point.case.rod_model.level, point.case.rod_model.order) for point in points]
    changes = [0, *(index + 1 for index, (a, b) in enumerate(pairwise(settings)) if a != b), len(points)]
    for first, last in pairwise(changes):
        yield settings[first], first, last


def sweep_quantities(
    solution: Solution, stress_points: Sequence[tuple[str, Vector]]
) -> Iterator[tuple[str, str, str, float]]:
    """What of `reports.quantities.evaluate` is a number: quantity, what it is of, which part of that, and the value.

    Deflections are the largest of a rod, in any direction. Nothing of a curve is evaluated.
    """
    scene = solution.scene
    held = reactions(solution)
    at = {rod.name: _cuts(scene, rod) for rod in scene.rods}
    applied = {rod.name: applied_forces(solution, rod, at[rod.name], held) for rod in scene.rods}
    largest = {
        rod.name: float(np.linalg.norm(solution.displacement(rod.name, default_stations(rod)), axis=0).max())
        for rod in scene.rods
    }
    contacts = [contact_quantities(solution, pair, max(largest.values())) for pair in scene.contacts]
    for contact in contacts:
        yield from _of_contact(contact)
        yield from _borders(solution, contact)
    for rod in scene.rods:
        yield "deflection", rod.name, "largest", largest[rod.name]
        yield from _of_rod(rod_quantities(solution, rod, applied[rod.name], at[rod.name]))
    for name, point in stress_points:
        value = float(stress_s(solution, name, np.array([point]).T)[0])
        yield "stress_s", name, f"at ({', '.join(f'{each:g}' for each in point)})", value
    yield "strain_energy", "", "", float(solution.strain_energy)
    pressing = max((contact.force for contact in contacts), default=0.0)
    yield "equilibrium_residual", "", "", equilibrium_residual(scene, applied, held, pressing)


def _cuts(scene: Scene, rod: Rod) -> Array:
    """Stations between which loads are summed up: loads along the rod need as many as curves have."""
    if any(load.rod == rod.name and not isinstance(load, SectionForce | SectionMoment) for load in scene.loads):
        return default_stations(rod)
    return np.array([0.0, rod.length])


def _of_contact(contact: ContactQuantities) -> Iterator[tuple[str, str, str, float]]:
    yield "contact_force", contact.pair, "", contact.force
    if contact.centre is not None:
        yield "contact_centre", contact.pair, "", contact.centre
    for quantity, stretches in (("contact_edges", contact.edges), ("contact_edges_outer", contact.edges_outer)):
        for number, (start, end) in enumerate(stretches, 1):
            yield quantity, contact.pair, f"start {number}", start
            yield quantity, contact.pair, f"end {number}", end
    yield "penetration", contact.pair, "", contact.penetration


def _borders(solution: Solution, contact: ContactQuantities) -> Iterator[tuple[str, str, str, float]]:
    first = solution.scene.contact(contact.pair).first.rod
    stretches = [stretch for stretch in solution.stretches if stretch.pair == contact.pair]
    for number, stretch in enumerate(stretches, 1):
        ends = solution.frame(first, np.array([stretch.start, stretch.end]))[0][contact.axis]
        yield "contact_borders", contact.pair, f"start {number}", float(ends.min())
        yield "contact_borders", contact.pair, f"end {number}", float(ends.max())


def _of_rod(rod: RodQuantities) -> Iterator[tuple[str, str, str, float]]:
    for quantity, value in (
        ("end_moment_equilibrium", rod.end_moment_equilibrium),
        ("end_moment_stress", rod.end_moment_stress),
        ("max_bending_stress", rod.max_bending_stress),
    ):
        if value is not None:
            yield quantity, rod.rod, "", value
