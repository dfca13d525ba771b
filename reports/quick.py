"""A quick look at a case: a rod model of low level against 3D on coarse meshes, in seconds and without a verdict.

The rod model has short elements added at supports and contacts, where long ones would count more than its level. How
far either may be off comes from a second, coarser answer of its own, with a factor of safety of 3: of the rod model by
the difference of two levels, of 3D by the grid convergence index of two meshes with the formal order (P. J. Roache,
Verification and Validation in Computational Science and Engineering, 1998, section 5.6).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Literal

from rich.markup import escape
from rich.table import Table

from cases.case import QUANTITIES, Case, Check, Grades
from cases.scene import SceneError
from reports.case_comparison import evaluation_points, extract
from reports.check.size import reference_unknowns
from reports.comparison import CURVES, magnitude
from reports.formatting import capital, measure, rod_model, seconds, values_with_unit
from reports.processes import Progress
from reports.quantities import DEFINITIONS, Quantities, evaluate
from reports.runner import run_rod
from reports.solution import Array
from reports.tables import console
from rodmodel.adapt import graded

# Level and order of the rod model, and of the one it is held against to see how far it may be off.
LEVELS, ORDERS = (2, 4), (3, 4)
# Unknowns of a 3D mesh up to which it takes seconds.
MOST_UNKNOWNS = 60_000
# Of Roache's index on two meshes; of thin-walled sections, levels 2 and 4 are closer to each other than to the truth.
SAFETY = 3.0
# Differences, as fractions or in mm, that are none.
ROUND_OFF = 1e-6

Reading = Literal["agree", "differ", "not known"]
STYLES: Mapping[Reading, str] = {"agree": "green", "differ": "bold red", "not known": "yellow"}
WHAT_IT_SAYS = (
    "'agree': apart by no more than both are uncertain, which need not be within the tolerance. 'differ': by more; "
    "look at the scene, or at its elements. Verdicts come from rodcheck compare, on three meshes and at the case's own "
    "level."
)


@dataclass(frozen=True)
class Look:
    """One quantity of a quick look.

    Attributes
    ----------
    rod, reference : values; of a curve the two magnitudes where they are farthest apart
    difference, rod_uncertainty, reference_uncertainty : fractions of the 3D value where the quantity's kind is
        relative, else in its unit; None where they are not known
    """

    check: Check
    rod: tuple[float, ...]
    reference: tuple[float, ...]
    difference: float | None
    rod_uncertainty: float | None
    reference_uncertainty: float | None

    @property
    def reading(self) -> Reading:
        """Whether the two are within the sum of their uncertainties."""
        if self.difference is None or self.rod_uncertainty is None or self.reference_uncertainty is None:
            return "not known"
        uncertain = self.rod_uncertainty + self.reference_uncertainty
        return "agree" if self.difference <= max(uncertain, ROUND_OFF) else "differ"


@dataclass(frozen=True)
class QuickLook:
    """What a quick look shows.

    Attributes
    ----------
    looks : one for each of the case's checks
    answers : what was solved and what it cost, a line each
    notes : what was left out, a sentence each
    problems : what did not converge, a sentence each
    """

    case: Case
    looks: tuple[Look, ...]
    answers: tuple[str, ...]
    notes: tuple[str, ...]
    problems: tuple[str, ...]

    @property
    def sound(self) -> bool:
        """Whether all converged and nothing differs by more than it is uncertain."""
        return not self.problems and all(look.reading != "differ" for look in self.looks)


def quick_look(case: Case, progress: Progress) -> QuickLook:
    """Solve a case roughly, both ways.

    Raises
    ------
    SceneError
        if the rod model cannot treat the scene.
    """
    import reference3d

    progress(f"{case.name}: rod model")
    refined = replace(case, scene=graded(case.scene))
    runs = [run_rod(refined, level, order) for level, order in _grades(case)]
    rods = [run.quantities for run in runs]
    references, why = _references(refined, progress)
    order = reference3d.formal_order(case.scene) if references else math.nan
    answers = [
        *(f"{capital(rod_model(run.level, run.order))}: {_cost(run.quantities)}" for run in runs),
        *(f"3D, mesh {mesh}: {_cost(found)}" for mesh, found in enumerate(references, 1)),
    ]
    problems = [
        f"{solver} did not converge: {found.outcome}"
        for solver, solved in (("The rod model", rods), ("3D", references))
        for found in solved
        if not found.converged
    ]
    return QuickLook(
        case,
        tuple(_look(check, rods, references, order) for check in case.compare),
        tuple(answers),
        (why,) if why else (),
        tuple(dict.fromkeys(problems)),
    )


def _cost(found: Quantities) -> str:
    return f"{found.unknowns} unknowns, {seconds(found.setup_seconds + found.solve_seconds)}"


def _grades(case: Case) -> list[tuple[int, int]]:
    """Level and order of the two rod models: no higher than the case's own."""
    level = min(LEVELS[1], _highest(case.rod_model.level))
    order = min(ORDERS[1], _highest(case.rod_model.order))
    return [(max(1, level - (LEVELS[1] - LEVELS[0])), max(2, order - (ORDERS[1] - ORDERS[0]))), (level, order)]


def _highest(given: Grades) -> int:
    return max(max(each) for each in given.values()) if isinstance(given, Mapping) else given


def _references(case: Case, progress: Progress) -> tuple[list[Quantities], str]:
    """Quantities of 3D on the coarse meshes that take seconds, two at most, and why they are fewer."""
    import reference3d

    points = evaluation_points(case)
    found: list[Quantities] = []
    located = None
    try:
        counts = reference_unknowns(case.scene)[:2]
        for mesh, count in enumerate(counts, 1):
            if count > MOST_UNKNOWNS:
                unknown = (
                    "it is not known how uncertain 3D is" if found else "there is nothing to hold the rod model against"
                )
                about = f"3D mesh {mesh} is left out: about {count} unknowns take too long for a quick look"
                return found, f"{about}, so that {unknown}."
            progress(f"{case.name}: 3D mesh {mesh}")
            located = reference3d.solve(case.scene, mesh, located=located)
            found.append(evaluate(located, points.stations, points.stress_points))
    except SceneError as error:
        return [], f"The 3D reference cannot treat this case: {error}."
    return found, ""


def _look(check: Check, rods: Sequence[Quantities], references: Sequence[Quantities], order: float) -> Look:
    values = [extract(rod, check) for rod in rods]
    others = [extract(reference, check) for reference in references]
    if not others or values[-1].shape != others[-1].shape:
        reference = _shown(check, others[-1], 0) if others else ()
        return Look(check, _shown(check, values[-1], 0), reference, None, None, None)
    apart = magnitude(values[-1] - others[-1])
    farthest = int(apart.argmax()) if apart.size else 0
    scale = float(magnitude(others[-1]).max(initial=0.0)) if QUANTITIES[check.quantity].relative else 1.0
    rod_change, reference_change = _change(values), _change(others)
    # The second mesh has half the element size of the first.
    index = None if reference_change is None else SAFETY * reference_change / (2.0**order - 1.0)
    return Look(
        check,
        _shown(check, values[-1], farthest),
        _shown(check, others[-1], farthest),
        _share(float(apart.max(initial=0.0)), scale),
        _share(_at_least(check, rods[-1], None if rod_change is None else SAFETY * rod_change, rod_change), scale),
        _share(_at_least(check, references[-1], index, reference_change), scale),
    )


def _change(values: Sequence[Array]) -> float | None:
    """How far the last two answers are apart; None where there are not two, or not of the same things."""
    if len(values) < 2 or values[0].shape != values[1].shape:
        return None
    return float(magnitude(values[1] - values[0]).max(initial=0.0))


def _at_least(check: Check, found: Quantities, uncertainty: float | None, change: float | None) -> float | None:
    """The uncertainty; of places of contact their change, and no less than the stations that edges lie between."""
    if uncertainty is None or change is None:
        return None
    match check.quantity:
        case "contact_edges" | "contact_centre":
            return max(change, found.contact(check.of).edges_resolution)
        case "contact_edges_outer":
            return max(change, found.contact(check.of).edges_outer_resolution)
        case _:
            return uncertainty


def _share(value: float | None, scale: float) -> float | None:
    if value is None or value == 0.0:
        return value
    return value / scale if scale > 0.0 else math.inf


def _shown(check: Check, values: Array, farthest: int) -> tuple[float, ...]:
    """The numbers to show; of a curve the magnitude at one place."""
    if check.quantity in CURVES and values.size:
        return tuple(magnitude(values)[farthest : farthest + 1].tolist())
    return tuple(values.ravel().tolist())


def print_quick_look(found: QuickLook) -> None:
    """Print the two rough answers, how far each may be off, and what that says."""
    out = console()
    out.print(f"[bold]{escape(found.case.title)}[/] ({escape(found.case.name)}): a quick look, no verdict")
    for line in (*found.answers, *found.notes):
        out.print(escape(line))
    table = Table("quantity", "rod model", "3D", "difference", "rod uncertain", "3D uncertain", "reading", "tolerance")
    for look in found.looks:
        check = look.check
        at = "" if check.point is None else f" at ({', '.join(f'{each:g}' for each in check.point)})"
        measures = (look.difference, look.rod_uncertainty, look.reference_uncertainty)
        difference, rod, reference = (measure(check.quantity, value) for value in measures)
        table.add_row(
            escape(f"{DEFINITIONS[check.quantity].title}, {check.of}{at}"),
            values_with_unit(check.quantity, look.rod),
            values_with_unit(check.quantity, look.reference),
            difference,
            rod,
            reference,
            f"[{STYLES[look.reading]}]{look.reading}[/]",
            measure(check.quantity, check.tolerance),
        )
    if found.looks:
        out.print(table)
    for problem in found.problems:
        out.print(f"[bold red]{escape(problem)}[/]")
    out.print(WHAT_IT_SAYS)
