"""What a nightly run asks of a worker."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from cases.case import Case
from cases.loader import TRUTH
from reports.code_version import code_version, data_version
from reports.peers import PEERS


@dataclass(frozen=True)
class Limits:
    """What a case may take.

    Attributes
    ----------
    memory : bytes, of all its processes together; None for an equal part of the machine's
    seconds : wall-clock time
    """

    memory: float | None
    seconds: float


@dataclass(frozen=True)
class Task:
    """A case to be run.

    Attributes
    ----------
    cache : folder of results on the worker's machine; None for none
    peers : whether solvers that are not of this project are asked
    at_once : cases that one machine runs at the same time
    version : of the code that asks (`version`), which must be the code that answers
    """

    case: Case
    cache: Path | None
    peers: bool
    limits: Limits
    at_once: int
    version: str


def version() -> str:
    """Fingerprint of all code that a case's answer and its comparison come from, and of the independent values."""
    code = code_version("reports.runner", "reports.nightly.case_process", *PEERS.values())
    return f"{code} {data_version(TRUTH)}"


def on_this_machine(case: Case) -> Case:
    """A case that came from another machine, where rodcheck may lie in another folder."""
    return case if case.independent is None else replace(case, independent=TRUTH / case.independent.name)
