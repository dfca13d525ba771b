"""What a case is held against: the 3D reference of this run, independent 3D values, published values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cases.case import Case, Check, Published
from cases.scene import Vector
from reports.comparison import (
    CURVES,
    Comparison,
    Estimate,
    Extrapolate,
    compare,
    edges_estimate,
    sequence_estimate,
    untreated,
)
from reports.geometry import AXES
from reports.quantities import Quantities
from reports.solution import Array, Model
from reports.truth import SOURCE, IndependentValues, independent_values

REFERENCE_SOURCE = "the 3D reference of this run, extrapolated from three meshes where they converge"


@dataclass(frozen=True)
class EvaluationPoints:
    """Where a case wants its quantities besides the default stations (arguments of `quantities.evaluate`)."""

    stations: Mapping[str, Array]
    stress_points: tuple[tuple[str, Vector], ...]


def evaluation_points(case: Case) -> EvaluationPoints:
    """Stations of the independent deflections and the points whose stress is compared.

    Raises
    ------
    OSError, ValueError
        if the file of independent values cannot be read.
    """
    stations = {} if case.independent is None else dict(independent_values(case.independent, case.scene).stations)
    for published in case.published:
        if published.position is not None:
            stations[published.of] = np.append(stations.get(published.of, np.empty(0)), published.position)
    points = tuple((check.of, check.point) for check in case.compare if check.point is not None)
    return EvaluationPoints(stations, points)


def extract(quantities: Quantities, check: Check) -> Array:
    """The values of a check's quantity: numbers, shape (n,), or vectors along a rod, shape (3, n).

    Nothing to report (the centre without contact, a clamp moment without a clamp) is an empty array.
    """
    values: object
    match check.quantity:
        case "contact_force":
            values = quantities.contact(check.of).force
        case "contact_centre":
            values = quantities.contact(check.of).centre
        case "contact_edges":
            values = quantities.contact(check.of).edges
        case "contact_edges_outer":
            values = quantities.contact(check.of).edges_outer
        case "deflection":
            return quantities.rod(check.of).displacement
        case "bending_moment":
            values = quantities.rod(check.of).moment
        case "end_moment_equilibrium":
            values = quantities.rod(check.of).end_moment_equilibrium
        case "max_bending_stress":
            values = quantities.rod(check.of).max_bending_stress
        case "stress_s":
            assert check.point is not None  # the loader asks for it
            values = quantities.point_stresses[check.of, check.point]
    return np.empty(0) if values is None else np.atleast_1d(np.asarray(values, dtype=float)).ravel()


def case_comparisons(
    case: Case, rod: Quantities, references: Sequence[Quantities], extrapolate: Extrapolate
) -> tuple[Comparison, ...]:
    """All comparisons of a case, in the order: 3D reference, independent values, published values.

    Parameters
    ----------
    rod, references : quantities of the rod model and of the 3D reference on three meshes, coarse to fine, all
        evaluated at the case's `evaluation_points`
    """
    found = _against_reference(case, rod, references, extrapolate)
    if case.independent is not None:
        truth = independent_values(case.independent, case.scene)
        found += _against_truth(case, "rod", rod, truth)
        found += _against_truth(case, "reference", references[-1], truth)
    return (*found, *_against_published(case, rod))


def comparisons_without_reference(case: Case, rod: Quantities) -> tuple[Comparison, ...]:
    """All comparisons of a case whose scene the 3D reference cannot treat, in the order of `case_comparisons`."""
    reason = "the 3D reference cannot treat this case"
    found = [
        untreated(check, extract(rod, check), reason, kind="reference", source=REFERENCE_SOURCE)
        for check in case.compare
    ]
    if case.independent is not None:
        found += _against_truth(case, "rod", rod, independent_values(case.independent, case.scene))
    return (*found, *_against_published(case, rod))


def _against_reference(
    case: Case, rod: Quantities, references: Sequence[Quantities], extrapolate: Extrapolate
) -> list[Comparison]:
    return [
        compare(
            check,
            "rod",
            extract(rod, check),
            _reference_estimate(check, references, extrapolate),
            kind="reference",
            source=REFERENCE_SOURCE,
            outcomes=[rod.outcome, *(reference.outcome for reference in references)],
        )
        for check in case.compare
    ]


def _against_published(case: Case, rod: Quantities) -> list[Comparison]:
    found = []
    for published in case.published:
        point = None if published.position is None else (0.0, 0.0, published.position)
        check = Check(published.quantity, published.of, published.tolerance, point)
        found.append(
            compare(
                check,
                "rod",
                _as_published(rod, published, check),
                Estimate(np.array(published.value, dtype=float), 0.0),
                kind="published",
                source=published.source,
                outcomes=[rod.outcome],
                axis=published.axis,
            )
        )
    return found


def _as_published(quantities: Quantities, published: Published, check: Check) -> Array:
    """The values of a published quantity; of a deflection, the one component at the one place that is published."""
    if published.position is None or published.axis is None:
        return extract(quantities, check)
    found = quantities.rod(published.of)
    nearest = int(np.argmin(np.abs(found.station - published.position)))  # `evaluation_points` asks for it
    component: Array = found.displacement[AXES.index(published.axis)]
    return component[[nearest]]


def _reference_estimate(check: Check, references: Sequence[Quantities], extrapolate: Extrapolate) -> Estimate:
    values = [extract(reference, check) for reference in references]
    if check.quantity == "contact_edges":
        return edges_estimate(values, references[-1].contact(check.of).edges_resolution)
    if check.quantity == "contact_edges_outer":
        return edges_estimate(values, references[-1].contact(check.of).edges_outer_resolution)
    return sequence_estimate(values, extrapolate, curve=check.quantity in CURVES)


def _against_truth(case: Case, model: Model, quantities: Quantities, truth: IndependentValues) -> list[Comparison]:
    """The case's own checks, with their tolerances, for those quantities that the independent values hold."""
    found = []
    for check in case.compare:
        estimate = truth.estimates.get((check.quantity, check.of))
        if estimate is None:
            continue
        if check.quantity == "deflection":
            rod = quantities.rod(check.of)
            at = np.searchsorted(rod.station, truth.stations[check.of] - 1e-6 * rod.station[-1])
            value = rod.displacement[1, at]
        else:
            value = extract(quantities, check)
        found.append(
            compare(
                check,
                model,
                value,
                estimate,
                kind="3d converged",
                source=SOURCE,
                outcomes=[quantities.outcome],
            )
        )
    return found
