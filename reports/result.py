"""The JSON object that `rodcheck solve --json` prints; `rodcheck schema result` prints its JSON Schema."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Field

from cases.case import Grades
from reports.quantities import DEFINITIONS, ContactQuantities, Quantities, RodQuantities
from reports.solution import Model

Triple = Annotated[list[float], Field(min_length=3, max_length=3)]
Stretch = Annotated[list[float], Field(min_length=2, max_length=2)]

_GRADES = "{}; by rod one for each of its elements, where they differ; null for the reference."


def _described(name: str) -> str:
    definition = DEFINITIONS[name]
    return f"{definition.text} Unit: {definition.unit or 'none'}."


class _Object(BaseModel):
    """No unknown keys, no NaN and no infinity anywhere."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False)


class Seconds(_Object):
    """Wall-clock time, s."""

    setup: float = Field(description="Everything before the contact iteration that the solver counts as set-up, s.")
    solve: float = Field(description="The solution itself, disjoint from set-up, s.")
    total: float = Field(description="From the scene to all quantities of this object, s.")


class Pressure(_Object):
    """Contact pressure along the zone, at the solver's own stations."""

    position: list[float] = Field(
        description="Coordinate along the global axis to which the first rod is most nearly parallel in the middle of "
        "the zone, mm."
    )
    middle: list[float] = Field(description=_described("pressure_middle"))
    mean: list[float] = Field(description=_described("pressure_mean"))
    outer: list[float] = Field(description=_described("pressure_outer"))


class Contact(_Object):
    """What one contact pair transmits."""

    pair: str = Field(description="Name of the contact pair in the case file.")
    force: float = Field(description=_described("contact_force"))
    resultant: Triple = Field(description="The contact force on the second rod or ground, global components, N.")
    centre: float | None = Field(description=_described("contact_centre") + " Null without contact.")
    edges: list[Stretch] = Field(description=_described("contact_edges"))
    edges_outer: list[Stretch] = Field(description=_described("contact_edges_outer"))
    edges_resolution: float = Field(
        description="Widest interval of the solver's stations that holds one of the edges in the middle, mm."
    )
    penetration: float = Field(description=_described("penetration"))
    complementarity_residual: float = Field(description=_described("complementarity_residual"))
    work: float = Field(description=_described("contact_work"))
    pressure: Pressure


class Reaction(_Object):
    """What a support or a joint exerts on a rod."""

    rod: str = Field(description="Name of the rod in the case file.")
    station: float = Field(description="Where it acts, arc length from the rod's start, mm.")
    force: Triple = Field(description="Global components, N.")
    moment: Triple = Field(description="About the centre of the section, global components, N mm.")


class RodCurves(_Object):
    """Deflection and bending moment along one rod."""

    station: list[float] = Field(description="Arc length from the rod's start, both ends included, mm.")
    position: list[Triple] = Field(description="Undeformed centre line at the stations, global [X, Y, Z], mm.")
    displacement: list[Triple] = Field(description=_described("deflection"))
    moment: list[float] = Field(description=_described("bending_moment"))
    moment_stress: list[float] = Field(description=_described("bending_moment_stress"))
    end_moment_equilibrium: float | None = Field(
        description=_described("end_moment_equilibrium") + " Null without a clamp."
    )
    end_moment_stress: float | None = Field(description=_described("end_moment_stress") + " Null without a clamp.")
    max_bending_stress: float | None = Field(description=_described("max_bending_stress") + " Null without a clamp.")


class GoalEstimate(_Object):
    """A quantity that the solver watched, and how far its own limit may be from it."""

    kind: str = Field(description="'contact force', largest 'deflection', 'clamp moment', 'contact edge' or 'energy'.")
    of: str = Field(description="Name of the rod or contact pair.")
    unit: str
    value: float
    error: float | None = Field(description="Estimated, in the unit; null where nothing is known of it.")


class ElementChoice(_Object):
    """An element of the last step."""

    start: float = Field(description="Arc length from the rod's start, mm.")
    end: float = Field(description="Arc length from the rod's start, mm.")
    level: int
    order: int
    reason: str = Field(description="Why it has this level and order.")


class StepCost(_Object):
    """One solution on the way to the tolerance."""

    level: int = Field(description="Highest level of any element.")
    unknowns: int
    seconds: float = Field(description="Wall-clock time, s.")


class Choice(_Object):
    """Levels, orders and elements of the solver's own choice."""

    tolerance: float = Field(description="Asked for: relative, of contact forces, largest deflections, clamp moments.")
    outcome: str = Field(description="'converged', or why the tolerance is not met.")
    estimates: list[GoalEstimate]
    elements: dict[str, list[ElementChoice]]
    steps: list[StepCost]


class Result(_Object):
    """One case solved by one model. Units: N, mm, MPa, s."""

    case: str = Field(description="Name of the case.")
    model: str = Field(description="'rod' or 'reference'.", pattern="^(rod|reference)$")
    level: Grades | None = Field(description=_GRADES.format("Level of the rod model"))
    order: Grades | None = Field(description=_GRADES.format("Order along the axis"))
    unknowns: int = Field(description="Unknowns carried in the solution.")
    converged: bool
    outcome: str = Field(description="'converged', or why not.")
    contact_solutions: int = Field(description="Contact problems solved, one a mesh or set of element borders.")
    active_sets: int = Field(description="Sets of touching points tried in all contact problems.")
    seconds: Seconds
    strain_energy: float = Field(description=_described("strain_energy"))
    equilibrium_residual: float = Field(description=_described("equilibrium_residual"))
    contacts: list[Contact]
    rods: dict[str, RodCurves]
    reactions: list[Reaction]
    choice: Choice | None = Field(description="Null where level and order were given, and for the reference.")


def result(
    case: str,
    model: Model,
    level: Grades | None,
    order: Grades | None,
    quantities: Quantities,
    total_seconds: float,
    choice: Choice | None = None,
) -> Result:
    """The result object of a solved case.

    Raises
    ------
    pydantic.ValidationError
        if a number is not finite.
    """
    return Result(
        case=case,
        model=model,
        level=level,
        order=order,
        unknowns=quantities.unknowns,
        converged=quantities.converged,
        outcome=quantities.outcome,
        contact_solutions=quantities.contact_solutions,
        active_sets=quantities.active_sets,
        seconds=Seconds(setup=quantities.setup_seconds, solve=quantities.solve_seconds, total=total_seconds),
        strain_energy=quantities.strain_energy,
        equilibrium_residual=quantities.equilibrium_residual,
        contacts=[_contact(contact) for contact in quantities.contacts],
        rods={rod.rod: _rod(rod) for rod in quantities.rods},
        reactions=[
            Reaction(rod=rod, station=station, force=found[:3].tolist(), moment=found[3:].tolist())
            for (rod, station), found in quantities.reactions.items()
        ],
        choice=choice,
    )


def _contact(contact: ContactQuantities) -> Contact:
    pressure = contact.pressure
    return Contact(
        pair=contact.pair,
        force=contact.force,
        resultant=contact.resultant.tolist(),
        centre=contact.centre,
        edges=[list(stretch) for stretch in contact.edges],
        edges_outer=[list(stretch) for stretch in contact.edges_outer],
        edges_resolution=contact.edges_resolution,
        penetration=contact.penetration,
        complementarity_residual=contact.complementarity_residual,
        work=contact.work,
        pressure=Pressure(
            position=pressure.position.tolist(),
            middle=pressure.middle.tolist(),
            mean=pressure.mean.tolist(),
            outer=pressure.outer.tolist(),
        ),
    )


def _rod(rod: RodQuantities) -> RodCurves:
    return RodCurves(
        station=rod.station.tolist(),
        position=rod.position.T.tolist(),
        displacement=rod.displacement.T.tolist(),
        moment=rod.moment.tolist(),
        moment_stress=rod.stress[3].tolist(),
        end_moment_equilibrium=rod.end_moment_equilibrium,
        end_moment_stress=rod.end_moment_stress,
        max_bending_stress=rod.max_bending_stress,
    )
