"""Rod model, 3D reference and solvers that are not of this project side by side, as text for terminal and page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from reports.formatting import capital, count, number, rod_model, seconds
from reports.peers import NOT_ASKED, PEERS, TITLES, UNITS, PeerRun, SideBySide, difference, peer_value
from reports.runner import CaseRun, Failure

NO_VALUE = "\u2013"


@dataclass(frozen=True)
class PeerCost:
    """What a solver spent, as text; note: where its answer comes from or what became of it."""

    solver: str
    unknowns: str
    time: str
    memory: str
    note: str


@dataclass(frozen=True)
class PeersTable:
    """Texts of the table.

    Attributes
    ----------
    columns : the solvers
    rows : what is told, and the solvers' cells
    costs : of every solver that ran
    missing : sentences on those that gave no answer
    """

    columns: tuple[str, ...]
    rows: tuple[tuple[str, tuple[str, ...]], ...]
    costs: tuple[PeerCost, ...]
    missing: tuple[str, ...]


def peers_table(run: CaseRun) -> PeersTable:
    """The table of a case."""
    rod = run.rod.quantities
    answers = [(each, each.answer) for each in run.peers if each.answer is not None]
    rows = []
    for row in run.side_by_side:
        values = (row.rod, *(peer_value(row, answer, rod) for _, answer in answers))
        own, *others = (_cell(row, value) for value in values)
        rows.append((_title(row), (own, _reference(row), *others)))
    costs = [
        PeerCost(
            capital(rod_model(run.rod.level, run.rod.order)),
            count(rod.unknowns),
            seconds(run.rod.total_seconds),
            f"{run.rod.peak_memory:.0f} MB",
            rod.outcome + run.rod.origin,
        )
    ]
    if run.references:
        finest = run.references[-1]
        costs.append(
            PeerCost(
                "3D, three meshes",
                " / ".join(count(each.quantities.unknowns) for each in run.references),
                seconds(sum(each.total_seconds for each in run.references)),
                f"{finest.peak_memory:.0f} MB",
                finest.quantities.outcome + finest.origin,
            )
        )
    for each, answer in answers:
        kept = f", from the cache, computed on {each.kept_since}" if each.kept_since else ""
        costs.append(
            PeerCost(
                answer.solver,
                count(answer.unknowns),
                seconds(answer.seconds),
                f"{answer.peak_memory:.0f} MB",
                answer.outcome + kept,
            )
        )
    columns = ("Rod model", "3D of this run, extrapolated", *(answer.solver for _, answer in answers))
    return PeersTable(columns, tuple(rows), tuple(costs), _missing(run.peers))


def peers_summary(runs: Sequence[CaseRun | Failure]) -> tuple[str, ...]:
    """A sentence on every peer over all cases: how many it answered and how far from 3D, and why not the others."""
    solved = [run for run in runs if isinstance(run, CaseRun)]
    sentences = []
    for peer in PEERS:
        found = [(run, each) for run in solved for each in run.peers if each.peer == peer]
        if not found:
            sentences.append(f"{peer}: {NOT_ASKED}.")
            continue
        answered, refused, apart, reasons = 0, 0, [], []
        for run, each in found:
            if each.answer is None or each.answer.outcome != "converged":
                why = _why(each).rstrip(".")
                if why.startswith("cannot"):
                    refused += 1
                else:
                    reasons.append(why)
                continue
            answered += 1
            for row in run.side_by_side:
                away = difference(row, peer_value(row, each.answer, run.rod.quantities))
                if away is not None and row.quantity in ("contact_force", "largest_deflection"):
                    apart.append(abs(away))
        text = f"{peer} answered {answered} of {len(found)} cases"
        if apart:
            text += f"; contact forces and largest deflections differ from 3D by {100.0 * max(apart):.2g} % at most"
        if refused:
            text += (
                f". It cannot treat {refused} of them, {'whose page says' if refused == 1 else 'whose pages say'} why"
            )
        sentences.append(". ".join([text, *dict.fromkeys(reasons)]) + ".")
    return tuple(sentences)


def _missing(peers: Sequence[PeerRun]) -> tuple[str, ...]:
    if not peers:
        return tuple(f"{peer}: {NOT_ASKED}" for peer in PEERS)
    return tuple(_sentence(each.peer, _why(each)) for each in peers if each.answer is None)


def _sentence(peer: str, reason: str) -> str:
    return reason if reason.startswith(peer) else f"{peer}: {reason}"


def _why(run: PeerRun) -> str:
    return run.reason if run.answer is None else run.answer.outcome


def _title(row: SideBySide) -> str:
    where = "" if row.station is None else f" at {row.station:g} mm"
    return f"{TITLES[row.quantity]}, {row.of}{where}, {UNITS[row.quantity]}"


def _cell(row: SideBySide, value: float | None) -> str:
    """A number and, where it can be said, how far it is from the 3D reference."""
    if value is None:
        return NO_VALUE
    away = difference(row, value)
    if away is None:
        return number(value)
    # adding zero takes the sign of a zero away
    shown = round(away if row.quantity == "contact_centre" else 100.0 * away, 3) + 0.0
    text = f"{shown:{'+' if shown else ''}.3f} {'mm' if row.quantity == 'contact_centre' else '%'}"
    return f"{number(value)} ({text})".replace("-", "\u2212")


def _reference(row: SideBySide) -> str:
    if row.reference is None:
        return NO_VALUE
    if row.uncertainty is None:
        return f"{number(row.reference)}, uncertainty unknown"
    if row.quantity == "contact_centre":
        return f"{number(row.reference)} ± {row.uncertainty:.3f} mm"
    share = f"{100.0 * row.uncertainty / abs(row.reference):.3f} %" if row.reference else number(row.uncertainty)
    return f"{number(row.reference)} ± {share}"
