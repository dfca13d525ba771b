"""A run at work: its lock, its name, and the cases it has finished, so that a killed run goes on where it was."""

from __future__ import annotations

import fcntl
import json
import secrets
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from importlib import import_module
from pathlib import Path

from reports.cache import Cache
from reports.comparison import Comparison
from reports.nightly.task import Task
from reports.peers import PeerRun, SideBySide
from reports.runner import KINDS, CaseRun, Failure
from reports.store import write_whole

TIME = "%Y%m%dT%H%M%SZ"
# A run that was interrupted longer ago is another night's: its results are still in the cache, its name is not used.
RESUMED = timedelta(hours=20)


class Busy(Exception):
    """Another run is at work in the folder."""


@contextmanager
def locked(folder: Path) -> Iterator[None]:
    """The folder for this process alone; a process that is killed leaves no lock.

    Raises
    ------
    Busy
        if another process has it.
    OSError
        if the folder cannot be written.
    """
    folder.mkdir(parents=True, exist_ok=True)
    with (folder / "lock").open("a") as stream:
        try:
            fcntl.flock(stream, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise Busy from None
        yield


class Unfinished:
    """The finished cases of a run that is not yet at its end.

    Attributes
    ----------
    run : name of the run: when it began, UTC, and a random part
    """

    def __init__(self, folder: Path, now: datetime) -> None:
        """Go on with the run in the folder if there is one, else begin one.

        Raises
        ------
        OSError
            if the folder cannot be written.
        """
        self._folder = folder
        self._name = folder / "run.json"
        run = _begun(self._name, now)
        if run is None:
            shutil.rmtree(folder, ignore_errors=True)
            run = f"{now.strftime(TIME)}-{secrets.token_hex(4)}"
            write_whole(self._name, json.dumps({"run": run}) + "\n")
        self.run = run
        self._cache = Cache(folder)
        self._cache.clean()

    @property
    def notes(self) -> tuple[str, ...]:
        """What the user should know of the folder, a sentence each."""
        return tuple(note.replace("cache:", "unfinished run:", 1) for note in self._cache.notes)

    def find(self, task: Task) -> CaseRun | Failure | None:
        """What came of a case, if it is finished; a failure counts under the same limits alone."""
        kinds = (*KINDS, Comparison, SideBySide, PeerRun, import_module("reference3d.peers.answer").PeerAnswer)
        kept = self._cache.find("case", self._question(task), kinds)
        if kept is not None:
            return CaseRun(task.case, *kept.value)
        kept = self._cache.find("failure", (*self._question(task), task.limits), ())
        return None if kept is None else Failure(task.case, kept.value)

    def keep(self, run: CaseRun | Failure, task: Task) -> None:
        """Keep what came of a case.

        Raises
        ------
        OSError
            if it cannot be written.
        """
        if isinstance(run, Failure):
            self._cache.write("failure", (*self._question(task), task.limits), run.reason)
        else:
            value = (run.rod, run.references, run.comparisons, run.refusal, run.side_by_side, run.peers, run.notes)
            self._cache.write("case", self._question(task), value)

    def end(self) -> None:
        """Forget the run: all that it had to write is written."""
        self._name.unlink(missing_ok=True)
        shutil.rmtree(self._folder, ignore_errors=True)

    def _question(self, task: Task) -> tuple[object, ...]:
        """All that the answer to a case depends on in this run."""
        values = "" if task.case.independent is None else task.case.independent.name
        return self.run, task.version, replace(task.case, independent=None), values, task.peers


def _begun(name: Path, now: datetime) -> str | None:
    """Name of the run that a file tells of; None if there is none to go on with."""
    try:
        run = str(json.loads(name.read_text(encoding="utf-8"))["run"])
        began = datetime.strptime(run.partition("-")[0], TIME).replace(tzinfo=UTC)
    except (FileNotFoundError, KeyError, TypeError, ValueError):
        return None
    return run if timedelta(0) <= now - began <= RESUMED else None
