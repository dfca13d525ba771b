"""The compared quantities, each defined once and evaluated the same way for both solvers.

Everything here asks a `reports.solution.Solution` and knows nothing of how it was computed. `DEFINITIONS`
gives every quantity its unit and its definition in words; the page and the JSON Schema take them from there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cases.scene import CentreLine, Clamp, ContactPair, Helix, Line, Path, Rod, Spline, Vector
from reports.applied_forces import AppliedForces, applied_forces, reactions
from reports.contact_edges import contact_stretches, edge_resolution
from reports.equilibrium import equilibrium_residual, equilibrium_resultants
from reports.geometry import contact_limits, pair_axis
from reports.sections import section_modulus
from reports.solution import Array, ContactProfile, Solution

# Moments of two clamps that differ by less than this part of them are alike.
ALIKE = 1e-3


class SolutionError(Exception):
    """A solution that has no quantities; the message says why, in one sentence."""


@dataclass(frozen=True)
class Definition:
    """What a quantity is: its title, its unit ('' for none) and its definition in words."""

    title: str
    unit: str
    text: str


DEFINITIONS: Mapping[str, Definition] = {
    "contact_force": Definition(
        "Contact force",
        "N",
        "Magnitude of the resultant of the contact pressure on the second rod of the pair, or on ground.",
    ),
    "contact_centre": Definition(
        "Centre of contact",
        "mm",
        "Mean position of the contact force, weighted with the force, along the global axis to which the "
        "first rod is most nearly parallel in the middle of the zone.",
    ),
    "contact_edges": Definition(
        "Contact edges, middle",
        "mm",
        "Start and end of each stretch in contact in the middle of the width, along the global axis to "
        "which the first rod is most nearly parallel in the middle of the zone. Near an edge the pressure goes "
        "like the square root of the distance, so the edge is the zero of the straight line through the squared "
        "pressure of the last two stations in contact, at most the next open station; where contact runs to the "
        "end of the zone or of a rod, it is that end.",
    ),
    "contact_edges_outer": Definition(
        "Contact edges, outer",
        "mm",
        "Start and end of each stretch in contact at the outer border of the width, found as in the middle.",
    ),
    "penetration": Definition(
        "Penetration",
        "mm",
        "Largest overlap of the faces at any contact point; on a bed, how far it is pressed in.",
    ),
    "complementarity_residual": Definition(
        "Complementarity residual",
        "",
        "Largest product of force and distance of the faces at any contact point, relative to the sum of the "
        "pair's contact forces times the largest displacement of a centre line: zero where forces act only between "
        "faces that touch without overlap. On a bed only distances above zero count, as there overlap is meant.",
    ),
    "contact_work": Definition(
        "Work of contact",
        "N mm",
        "Energy that contact keeps: half the sum of force times overlap over all contact points. Frictionless faces "
        "that do not overlap keep none; a bed keeps what its springs hold.",
    ),
    "pressure_middle": Definition("Pressure, middle", "MPa", "Contact pressure in the middle of the width."),
    "pressure_mean": Definition("Pressure, mean", "MPa", "Contact pressure averaged over the width."),
    "pressure_outer": Definition("Pressure, outer", "MPa", "Contact pressure at the outer border of the width."),
    "deflection": Definition(
        "Deflection",
        "mm",
        "Displacement of the centre line (x = y = 0) at the stations, global axes; where a section has no material "
        "there, the mean displacement of the section.",
    ),
    "bending_moment": Definition(
        "Bending moment",
        "N mm",
        "M1 = integral of sigma_s y over the section, from equilibrium of all that acts on the rod on one side of "
        "it: loads, contact forces, beds, and the reactions on that side, which is the one with fewer of them.",
    ),
    "bending_moment_stress": Definition(
        "Bending moment from stress",
        "N mm",
        "M1 = integral of sigma_s y over the section, of the computed stress.",
    ),
    "end_moment_equilibrium": Definition(
        "Clamp moment, equilibrium",
        "N mm",
        "M1 in the clamped section from equilibrium; where both ends are clamped, the larger of the two, and the "
        "start's if they are alike.",
    ),
    "end_moment_stress": Definition(
        "Clamp moment, stress",
        "N mm",
        "M1 in the same clamped section, integrated from the computed stress there.",
    ),
    "max_bending_stress": Definition(
        "Maximum bending stress",
        "MPa",
        "|M1| / W in the clamped section, M1 integrated from the computed stress there, "
        "W = I_x / y_max of the section (width height^2 / 6 of a rectangle). This is the paper's definition; its "
        "statically exact moment is several per cent smaller.",
    ),
    "stress_s": Definition("Stress along the rod", "MPa", "sigma_s at a stated point (x, y, s) of a rod."),
    "strain_energy": Definition(
        "Strain energy", "N mm", "Elastic energy of all rods, without that of the contact penalty and of beds."
    ),
    "equilibrium_residual": Definition(
        "Equilibrium residual",
        "",
        "Largest unbalanced force, or moment about a rod's start over its length, of the loads, contact and bed "
        "forces and reactions on any rod, and of the reactions at any joint; relative to the sum of the loads' "
        "magnitudes (distributed ones in all, moments over the rod's length), or to the largest reaction where that "
        "or the force of a contact pair is larger, as where supports are moved without any load.",
    ),
    "stress_residual": Definition(
        "Moment residual",
        "",
        "Largest difference of the bending moment from equilibrium and from stress over all stations of a "
        "rod, relative to the largest bending moment of the rod.",
    ),
}


@dataclass(frozen=True)
class PressureProfile:
    """Contact pressure along the zone.

    Attributes
    ----------
    position : coordinate along the pair's axis, mm, shape (n,)
    middle, mean, outer : pressure, MPa, shape (n,)
    """

    position: Array
    middle: Array
    mean: Array
    outer: Array


@dataclass(frozen=True)
class ContactQuantities:
    """What one contact pair transmits.

    Attributes
    ----------
    axis : index of the global axis along which centre, edges and profile are given
    resultant : contact force on the second rod or ground, global components, N, shape (3,)
    force : its magnitude, N
    centre : where it acts along the axis, mm; None without contact
    edges, edges_outer : (start, end) of each stretch in contact, ascending, mm
    edges_resolution, edges_outer_resolution : widest interval of stations that holds one of the edges, mm
    penetration : largest overlap, mm
    complementarity_residual : see `DEFINITIONS`
    work : energy that contact keeps, N mm
    """

    pair: str
    axis: int
    resultant: Array
    force: float
    centre: float | None
    edges: tuple[tuple[float, float], ...]
    edges_outer: tuple[tuple[float, float], ...]
    edges_resolution: float
    edges_outer_resolution: float
    penetration: float
    complementarity_residual: float
    work: float
    pressure: PressureProfile


@dataclass(frozen=True)
class RodQuantities:
    """Deflection and resultants along one rod.

    Attributes
    ----------
    station : arc length from the rod's start, mm, shape (n,)
    position : undeformed centre line, global, mm, shape (3, n)
    axes : rows e1, e2, t of the undeformed frames, shape (n, 3, 3)
    displacement : of the centre line, global components, mm, shape (3, n)
    equilibrium, stress : N, Q1, Q2 (N), M1, M2, T (N mm) from equilibrium and from stress, shape (6, n)
    end_moment_equilibrium, end_moment_stress : M1 at the clamp, N mm; None for a rod without a clamp
    max_bending_stress : |end_moment_stress| / W, MPa; None for a rod without a clamp
    """

    rod: str
    station: Array
    position: Array
    axes: Array
    displacement: Array
    equilibrium: Array
    stress: Array
    end_moment_equilibrium: float | None
    end_moment_stress: float | None
    max_bending_stress: float | None

    @property
    def moment(self) -> Array:
        """Bending moment M1 from equilibrium, N mm, shape (n,)."""
        moment: Array = self.equilibrium[3]
        return moment


@dataclass(frozen=True)
class Quantities:
    """All compared quantities of one solution.

    Attributes
    ----------
    outcome : the solver's: 'converged', or why not
    point_stresses : sigma_s at stated points, by rod and (x, y, s), MPa
    reactions : force (N) and moment (N mm) of each support and joint on its rods, by rod and arc length (mm),
        global, shape (6,) each
    equilibrium_residual : see `DEFINITIONS`
    setup_seconds, solve_seconds : the solver's own, disjoint
    """

    outcome: str
    contacts: tuple[ContactQuantities, ...]
    rods: tuple[RodQuantities, ...]
    point_stresses: Mapping[tuple[str, Vector], float]
    reactions: Mapping[tuple[str, float], Array]
    strain_energy: float
    equilibrium_residual: float
    unknowns: int
    contact_solutions: int
    active_sets: int
    setup_seconds: float
    solve_seconds: float

    @property
    def converged(self) -> bool:
        """Whether the solver says it converged."""
        return self.outcome == "converged"

    def contact(self, pair: str) -> ContactQuantities:
        """The contact quantities of `pair`; KeyError if there is none."""
        for contact in self.contacts:
            if contact.pair == pair:
                return contact
        raise KeyError(pair)

    def rod(self, name: str) -> RodQuantities:
        """The quantities of the rod `name`; KeyError if there is none."""
        for rod in self.rods:
            if rod.rod == name:
                return rod
        raise KeyError(name)


def evaluate(
    solution: Solution,
    stations: Mapping[str, Array] | None = None,
    stress_points: Sequence[tuple[str, Vector]] = (),
) -> Quantities:
    """All quantities of a solution.

    Parameters
    ----------
    stations : further stations per rod, arc length, mm, added to `default_stations`
    stress_points : rod and (x, y, s), mm, where sigma_s is wanted

    Raises
    ------
    SolutionError
        if the solution holds numbers that are not finite.
    """
    scene = solution.scene
    extra = stations or {}
    at = {rod.name: merged_stations(rod, extra.get(rod.name, np.empty(0))) for rod in scene.rods}
    held = reactions(solution)
    applied = {rod.name: applied_forces(solution, rod, at[rod.name], held) for rod in scene.rods}
    rods = tuple(rod_quantities(solution, rod, applied[rod.name], at[rod.name]) for rod in scene.rods)
    moved = max(float(np.linalg.norm(rod.displacement, axis=0).max()) for rod in rods)
    contacts = tuple(contact_quantities(solution, pair, moved) for pair in scene.contacts)
    pressing = max((contact.force for contact in contacts), default=0.0)
    quantities = Quantities(
        outcome=solution.outcome,
        contacts=contacts,
        rods=rods,
        point_stresses={
            (rod, point): float(stress_s(solution, rod, np.array([point]).T)[0]) for rod, point in stress_points
        },
        reactions=held,
        strain_energy=float(solution.strain_energy),
        equilibrium_residual=equilibrium_residual(scene, applied, held, pressing),
        unknowns=solution.cost.unknowns,
        contact_solutions=solution.contact_solutions,
        active_sets=solution.active_sets,
        setup_seconds=solution.cost.setup_seconds,
        solve_seconds=solution.cost.solve_seconds,
    )
    _require_finite(quantities)
    return quantities


def _require_finite(quantities: Quantities) -> None:
    numbers = [np.array([quantities.strain_energy, quantities.equilibrium_residual])]
    numbers += [np.array(list(quantities.point_stresses.values())), *quantities.reactions.values()]
    for rod in quantities.rods:
        numbers += [rod.displacement, rod.equilibrium, rod.stress]
    for contact in quantities.contacts:
        pressure = contact.pressure
        numbers += [contact.resultant, pressure.middle, pressure.mean, pressure.outer]
        numbers += [np.array([contact.complementarity_residual, contact.work])]
    if not all(np.isfinite(array).all() for array in numbers):
        raise SolutionError(f"the solution holds numbers that are not finite ({quantities.outcome})")


def default_stations(rod: Rod) -> Array:
    """60 even steps (more on long helices and splines), both ends, and the element borders, mm, ascending."""
    return merged_stations(rod, np.empty(0))


def merged_stations(rod: Rod, extra: Array) -> Array:
    """`default_stations` and further ones, those closer than 1e-9 of the length merged."""
    even = np.linspace(0.0, rod.length, 1 + max(60, _steps(rod.centre_line)))
    station = np.sort(np.concatenate([even, rod.element_borders, extra]))
    station = np.clip(station, 0.0, rod.length)
    keep = np.concatenate([[True], np.diff(station) > 1e-9 * rod.length])
    merged: Array = station[keep]
    return merged


def _steps(line: CentreLine) -> int:
    """How many even steps show the shape of a line: 48 a turn of a helix, 12 between two points of a spline."""
    match line:
        case Path():
            return sum(_steps(piece) for piece in line.pieces)
        case Helix():
            return math.ceil(48.0 * line.angle / (2.0 * math.pi))
        case Spline():
            return 12 * (len(line.points) - 1)
        case Line():
            return 0


def contact_quantities(solution: Solution, pair: ContactPair, moved: float) -> ContactQuantities:
    """Resultant, centre, edges, residuals and pressure of one pair.

    moved : largest displacement of a centre line, mm
    """
    axis = pair_axis(solution, pair)
    points = solution.contact_points(pair.name)
    resultant = np.asarray(points.normal @ points.force)
    total = float(points.force.sum())
    profile = solution.contact_profile(pair.name)
    apart = points.force * (np.maximum(points.gap, 0.0) if pair.on_bed else np.abs(points.gap))
    edges, resolution = _edges(solution, pair, profile, profile.middle)
    edges_outer, outer_resolution = _edges(solution, pair, profile, profile.outer)
    return ContactQuantities(
        pair=pair.name,
        axis=axis,
        resultant=resultant,
        force=float(np.linalg.norm(resultant)),
        centre=float(points.position[axis] @ points.force) / total if total > 0.0 else None,
        edges=edges,
        edges_outer=edges_outer,
        edges_resolution=resolution,
        edges_outer_resolution=outer_resolution,
        penetration=float(max(0.0, -points.gap.min(initial=0.0))),
        complementarity_residual=float(apart.max(initial=0.0)) / (total * moved) if total * moved > 0.0 else 0.0,
        work=-0.5 * float(points.force @ points.gap),
        pressure=PressureProfile(profile.position[axis], profile.middle, profile.mean, profile.outer),
    )


def _edges(
    solution: Solution, pair: ContactPair, profile: ContactProfile, pressure: Array
) -> tuple[tuple[tuple[float, float], ...], float]:
    """Stretches in contact, in the global coordinate of the pair's axis, and their edges' resolution, mm."""
    axis, limits = pair_axis(solution, pair), contact_limits(pair, profile.station)
    stretches = contact_stretches(profile.station, pressure, limits)
    ends = [solution.frame(pair.first.rod, np.array(stretch))[0][axis] for stretch in stretches]
    along = tuple(sorted((float(min(pair_ends)), float(max(pair_ends))) for pair_ends in ends))
    return along, edge_resolution(profile.station, stretches, limits)


def rod_quantities(solution: Solution, rod: Rod, applied: AppliedForces, station: Array) -> RodQuantities:
    """Deflection and resultants of one rod.

    Parameters
    ----------
    applied : all forces on the rod, by `applied_forces` with the same stations
    station : arc length, mm, from 0 to the rod's length, shape (n,)
    """
    equilibrium = equilibrium_resultants(solution, rod, applied, station)
    stress = solution.section_resultants(rod.name, station)
    clamped = [
        0 if support.end == "start" else -1
        for support in solution.scene.supports
        if isinstance(support, Clamp) and support.rod == rod.name
    ]
    end_moment_equilibrium = end_moment_stress = max_bending_stress = None
    if clamped:
        # of two that are alike always the start's, as their signs may differ
        alike = (1.0 - ALIKE) * max(abs(float(equilibrium[3, index])) for index in clamped)
        end = max(index for index in clamped if abs(float(equilibrium[3, index])) >= alike)
        end_moment_equilibrium, end_moment_stress = float(equilibrium[3, end]), float(stress[3, end])
        max_bending_stress = abs(end_moment_stress) / section_modulus(rod.section)
    position, axes = solution.frame(rod.name, station)
    return RodQuantities(
        rod=rod.name,
        station=station,
        position=position,
        axes=axes,
        displacement=solution.displacement(rod.name, station),
        equilibrium=equilibrium,
        stress=stress,
        end_moment_equilibrium=end_moment_equilibrium,
        end_moment_stress=end_moment_stress,
        max_bending_stress=max_bending_stress,
    )


def stress_residual(rod: RodQuantities) -> float:
    """Largest difference of M1 from equilibrium and from stress, relative to the largest M1 of the rod."""
    largest = float(np.abs(rod.moment).max())
    difference = float(np.abs(rod.stress[3] - rod.moment).max())
    return difference / largest if largest > 0.0 else difference


def stress_s(solution: Solution, rod: str, points: Array) -> Array:
    """sigma_s at points (x, y, s) of a rod, MPa, shape (n,); points has shape (3, n), mm."""
    stress: Array = solution.stress(rod, points)[2]
    return stress
