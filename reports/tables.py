"""What `rodcheck solve` and `rodcheck compare` print for people."""

from __future__ import annotations

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

from cases.case import Case
from reports.comparison import Verdict
from reports.formatting import (
    KIND_NAMES,
    MODEL_NAMES,
    measure,
    number,
    rod_model,
    seconds,
    stretches,
    title,
    values_with_unit,
)
from reports.peers_table import peers_table
from reports.runner import CaseRun, Failure, Run
from reports.solution import Array

# Tables are never narrower than this, also where the output is a file.
WIDTH = 150
STYLES: dict[Verdict, str] = {"pass": "green", "fail": "bold red", "not resolved": "yellow"}


def console() -> Console:
    """Where tables are printed, as wide as they need where it is no terminal."""
    terminal = Console(highlight=False)
    return terminal if terminal.is_terminal else Console(highlight=False, width=WIDTH)


def _cost(run: Run) -> str:
    quantities = run.quantities
    return (
        f"{quantities.unknowns} unknowns, {seconds(quantities.setup_seconds)} set-up, "
        f"{seconds(quantities.solve_seconds)} solve, {seconds(run.total_seconds)} in all"
    )


def _model(run: Run) -> str:
    return rod_model(run.level, run.order) if run.model == "rod" else "3D reference"


def _vector(components: Array) -> str:
    """Components of a vector; those that are round-off beside the others as 0."""
    kept = np.where(np.abs(components) > 1e-9 * np.abs(components).max(), components, 0.0)
    return ", ".join(number(value, 5) for value in kept.tolist())


def print_run(case: Case, run: Run) -> None:
    """Print one model's answer to a case."""
    out, quantities = console(), run.quantities
    out.print(f"[bold]{escape(case.title)}[/] ({escape(case.name)}), {_model(run)}: {escape(quantities.outcome)}")
    out.print(f"{_cost(run)}; {quantities.contact_solutions} contact solutions, {quantities.active_sets} active sets")
    contacts = Table(
        "contact",
        "force, N",
        "centre, mm",
        "edges middle, mm",
        "edges outer, mm",
        "penetration, mm",
        "complementarity",
        "work, N mm",
    )
    for contact in quantities.contacts:
        contacts.add_row(
            contact.pair,
            number(contact.force),
            number(contact.centre),
            stretches(np.ravel(contact.edges).tolist()),
            stretches(np.ravel(contact.edges_outer).tolist()),
            f"{contact.penetration:.2g}",
            f"{contact.complementarity_residual:.1e}",
            f"{contact.work:.2g}",
        )
    rods = Table(
        "rod",
        "largest deflection, mm",
        "clamp moment (equilibrium), N mm",
        "clamp moment (stress), N mm",
        "max. bending stress M/W, MPa",
    )
    for rod in quantities.rods:
        rods.add_row(
            rod.rod,
            number(float(np.linalg.norm(rod.displacement, axis=0).max())),
            number(rod.end_moment_equilibrium),
            number(rod.end_moment_stress),
            number(rod.max_bending_stress, 5),
        )
    reactions = Table("reaction on", "at, mm", "force X, Y, Z, N", "moment X, Y, Z, N mm")
    for (name, station), found in quantities.reactions.items():
        reactions.add_row(name, f"{station:g}", _vector(found[:3]), _vector(found[3:]))
    if quantities.contacts:
        out.print(contacts)
    out.print(rods)
    out.print(reactions)
    out.print(
        f"strain energy {number(quantities.strain_energy)} N mm, "
        f"equilibrium residual {quantities.equilibrium_residual:.1e}"
    )


def print_comparison(run: CaseRun | Failure) -> None:
    """Print what a case was held against, and the verdicts."""
    out = console()
    out.print(f"[bold]{escape(run.case.title)}[/] ({escape(run.case.name)})")
    if isinstance(run, Failure):
        out.print(f"[bold red]failed[/]: {escape(run.reason)}\n")
        return
    for answer in (run.rod, *run.references[-1:]):
        outcome = "" if answer.quantities.converged else f" [bold red]{escape(answer.quantities.outcome)}[/]"
        out.print(f"{_model(answer)}: {_cost(answer)}, {answer.peak_memory:.0f} MB{answer.origin}{outcome}")
    if run.refusal:
        out.print(f"[yellow]The 3D reference cannot treat this case[/]: {escape(run.refusal)}")
    table = Table(
        "quantity", "of", "value", "against", "reference", "difference", "uncertainty", "tolerance", "verdict"
    )
    for found in run.comparisons:
        table.add_row(
            title(found),
            MODEL_NAMES[found.model],
            values_with_unit(found.quantity, found.value),
            KIND_NAMES[found.kind],
            values_with_unit(found.quantity, found.reference),
            measure(found.quantity, found.difference),
            "as printed" if found.kind == "published" else measure(found.quantity, found.uncertainty),
            measure(found.quantity, found.tolerance),
            f"[{STYLES[found.verdict]}]{found.verdict}[/]",
        )
    out.print(table)
    for verdict, reason in dict.fromkeys((found.verdict, found.reason) for found in run.comparisons if found.reason):
        out.print(f"{verdict}: {escape(reason)}")
    _print_peers(out, run)
    out.print()


def _print_peers(out: Console, run: CaseRun) -> None:
    """Print what every solver says, side by side, what it spent, and why others say nothing."""
    found = peers_table(run)
    if run.peers:
        values = Table("side by side (difference from 3D)", *found.columns)
        for title_, cells in found.rows:
            values.add_row(escape(title_), *cells)
        out.print(values)
        costs = Table("solver", "unknowns", "time", "peak memory", "outcome")
        for cost in found.costs:
            costs.add_row(cost.solver, cost.unknowns, cost.time, cost.memory, escape(cost.note))
        out.print(costs)
    for sentence in found.missing:
        out.print(escape(sentence))
