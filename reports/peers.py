"""Solvers that this project did not write, asked about a case, and their answers beside ours.

Each is run in a process of its own where it is installed; one that is absent, refuses a scene or fails is named with
the reason. Their answers carry no verdict: each is of one mesh, so that nobody knows how sure it is.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from importlib import import_module
from importlib.metadata import PackageNotFoundError, version
from typing import Any, Literal, Protocol

import numpy as np

from cases.case import Case
from cases.scene import Clamp, Scene, SceneError, station_of
from reports.cache import Cache
from reports.code_version import code_version
from reports.comparison import Estimate, Extrapolate, sequence_estimate
from reports.processes import ProcessFailed, Progress, failure_reason, in_own_process
from reports.quantities import Quantities
from reports.solution import Array

# Name of every peer and the module that runs it, which has `installed` and `solve` (see `reference3d.peers`).
PEERS: Mapping[str, str] = {
    "CalculiX": "reference3d.peers.calculix",
    "NGSolve": "reference3d.peers.ngsolve_solver",
}
NOT_ASKED = "not asked (--no-peers)"

Beside = Literal["contact_force", "contact_centre", "largest_deflection", "clamp_moment"]
TITLES: Mapping[Beside, str] = {
    "contact_force": "Contact force",
    "contact_centre": "Centre of contact",
    "largest_deflection": "Largest deflection",
    "clamp_moment": "Moment in the clamp",
}
UNITS: Mapping[Beside, str] = {
    "contact_force": "N",
    "contact_centre": "mm",
    "largest_deflection": "mm",
    "clamp_moment": "N mm",
}


class Answer(Protocol):
    """What a peer says of a scene: `reference3d.peers.answer.PeerAnswer`, which says what each part is.

    That module is imported only where a peer is asked, as the 3D reference comes with it.
    """

    solver: str
    outcome: str
    unknowns: int
    seconds: float
    peak_memory: float
    contact_force: Mapping[str, Array]
    contact_centre: Mapping[str, Array]
    displacement: Mapping[str, Array]
    reactions: Mapping[tuple[str, float], Array]


@dataclass(frozen=True, eq=False)
class PeerRun:
    """What came of asking a peer.

    Attributes
    ----------
    answer : None where there is none
    reason : then why, in one sentence; else ''
    kept_since : the day it was computed on, YYYY-MM-DD, if it comes from the cache; else ''
    """

    peer: str
    answer: Answer | None
    reason: str = ""
    kept_since: str = ""


@dataclass(frozen=True)
class SideBySide:
    """One number that every solver can tell.

    Attributes
    ----------
    of : the pair or rod
    station : of a clamp, arc length, mm; else None
    rod : the rod model's; None where there is none, as the centre without contact
    reference : the 3D reference's, extrapolated from its meshes where they converge
    uncertainty : of the reference; None where it is unknown
    """

    quantity: Beside
    of: str
    station: float | None
    rod: float | None
    reference: float | None
    uncertainty: float | None


def ask_peers(
    scene: Scene, stations: Mapping[str, Array], progress: Progress = lambda _: None, cache: Cache | None = None
) -> tuple[PeerRun, ...]:
    """Ask every peer.

    Parameters
    ----------
    stations : by rod, arc lengths at which displacements are wanted, mm, shape (n,)
    cache : where answers are looked for and kept
    """
    found = []
    for peer in PEERS:
        try:
            found.append(_ask(peer, scene, stations, progress, cache))
        except Exception as error:  # noqa: BLE001 (whatever is wrong with a peer, the case has its own answers)
            found.append(PeerRun(peer, None, f"failed: {failure_reason(error)}"))
    return tuple(found)


def _ask(peer: str, scene: Scene, stations: Mapping[str, Array], progress: Progress, cache: Cache | None) -> PeerRun:
    module = PEERS[peer]
    absent: str = import_module(module).installed()
    if absent:
        return PeerRun(peer, None, absent)
    question = code_version(module), _version(module), scene, dict(stations)
    kinds = (import_module("reference3d.peers.answer").PeerAnswer,)
    kept = None if cache is None else cache.find(peer.lower(), question, kinds)
    if kept is not None:
        return PeerRun(peer, kept.value, kept_since=kept.date)
    progress(peer)
    try:
        found = in_own_process(partial(_solved, module, scene), stations)
    except ProcessFailed as error:
        return PeerRun(peer, None, f"failed: {error}")
    if isinstance(found, str):
        return PeerRun(peer, None, f"cannot treat this case: {found}")
    # what took too long once may not take it again
    if cache is not None and found.outcome == "converged":
        cache.keep(peer.lower(), question, found)
    return PeerRun(peer, found)


def _version(module: str) -> str:
    """What tells that a peer is another one than before."""
    if module.endswith("calculix"):
        told: str = import_module(module).version()
        return told
    try:
        return version("ngsolve")
    except PackageNotFoundError:
        return ""


def _solved(module: str, scene: Scene, stations: Mapping[str, Array], _progress: Progress) -> Answer | str:
    """The peer's answer, or why it refuses the scene."""
    try:
        answer: Answer = import_module(module).solve(scene, stations)
    except SceneError as error:
        return " ".join(str(error).split())
    return answer


def side_by_side(
    case: Case, rod: Quantities, references: Sequence[Quantities], extrapolate: Extrapolate | None
) -> tuple[SideBySide, ...]:
    """Contact force and centre of every pair, largest deflection of every rod, and the moment in every clamp.

    Parameters
    ----------
    references : on three meshes, coarse to fine; none where the 3D reference cannot treat the scene
    """
    scene = case.scene
    wanted: list[tuple[Beside, str, float | None]] = []
    for pair in scene.contacts:
        wanted += [("contact_force", pair.name, None), ("contact_centre", pair.name, None)]
    wanted += [("largest_deflection", each.name, None) for each in scene.rods]
    for support in scene.supports:
        if isinstance(support, Clamp):
            wanted.append(("clamp_moment", support.rod, station_of(support, scene.rod(support.rod))))
    rows = []
    for quantity, of, station in wanted:
        numbers = [_own(quantity, of, station, found) for found in references]
        estimate = Estimate(np.empty(0), None)
        if extrapolate is not None and references:
            arrays = [np.array([] if value is None else [value]) for value in numbers]
            estimate = sequence_estimate(arrays, extrapolate, curve=False)
        reference = float(estimate.value[0]) if estimate.value.size else None
        uncertainty = None if reference is None else estimate.uncertainty
        rows.append(SideBySide(quantity, of, station, _own(quantity, of, station, rod), reference, uncertainty))
    return tuple(rows)


def _own(quantity: Beside, of: str, station: float | None, found: Quantities) -> float | None:
    """One of our solvers' number."""
    match quantity:
        case "contact_force":
            return found.contact(of).force
        case "contact_centre":
            return found.contact(of).centre
        case "largest_deflection":
            return float(np.linalg.norm(found.rod(of).displacement, axis=0).max())
        case "clamp_moment":
            assert station is not None  # as `side_by_side` asks
            return float(np.linalg.norm(found.reactions[of, station][3:]))


def peer_value(row: SideBySide, answer: Answer, rod: Quantities) -> float | None:
    """A peer's number; None where it has none, as after a run that did not converge.

    rod : quantities of the rod model, which say along which axis a centre is given
    """
    value: float | None = None
    if row.quantity == "contact_force" and row.of in answer.contact_force:
        value = float(np.linalg.norm(answer.contact_force[row.of]))
    elif row.quantity == "contact_centre" and row.of in answer.contact_centre:
        value = float(answer.contact_centre[row.of][rod.contact(row.of).axis])
    elif row.quantity == "largest_deflection" and row.of in answer.displacement:
        value = float(np.linalg.norm(answer.displacement[row.of], axis=0).max())
    elif row.station is not None and (row.of, row.station) in answer.reactions:
        value = float(np.linalg.norm(answer.reactions[row.of, row.station][3:]))
    return value if value is not None and math.isfinite(value) else None


def difference(row: SideBySide, value: float | None) -> float | None:
    """How far a number is from the 3D reference's: in mm for a centre, else a fraction; None where there is none."""
    if value is None or row.reference is None:
        return None
    apart = value - row.reference
    if row.quantity == "contact_centre":
        return apart
    return apart / row.reference if row.reference else None


def stations_of(rod: Quantities) -> dict[str, Array]:
    """Where our solvers' deflections are evaluated, arc lengths by rod, mm."""
    return {found.rod: found.station for found in rod.rods}


def as_json(rows: Sequence[SideBySide], peers: Sequence[PeerRun], rod: Quantities) -> dict[str, Any]:
    """What a file of results says of the peers; numbers in N, mm, s and MB."""
    solvers = {}
    for run in peers:
        told: dict[str, Any] = {"reason": run.reason, "kept_since": run.kept_since}
        if run.answer is not None:
            answer = run.answer
            told |= {
                "solver": answer.solver,
                "outcome": answer.outcome,
                "unknowns": answer.unknowns,
                "seconds": answer.seconds,
                "peak_memory": answer.peak_memory,
            }
        solvers[run.peer] = told
    values = [
        asdict(row)
        | {"unit": UNITS[row.quantity]}
        | {"peers": {run.peer: peer_value(row, run.answer, rod) for run in peers if run.answer is not None}}
        for row in rows
    ]
    return {"peers": solvers, "side_by_side": values}
