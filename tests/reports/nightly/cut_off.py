"""Nightly runs that end without a word before one change to the disk after the other, as by power cuts.

A process of its own, which forks one for every run: nothing of a run is left in the next, and modules are loaded once.
Arguments: a folder, a file with a pickled `CaseRun` that answers every case, and how many changes later each run is cut
off. Prints a line of JSON for every run, until one had no change left to be cut off at.
"""

from __future__ import annotations

import json
import os
import pickle
import shutil
import signal
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import redirect_stdout
from dataclasses import replace
from pathlib import Path
from typing import Any

import reference3d.peers.answer  # noqa: F401 (for all that are forked)
from cases.loader import load_case
from reports.command_line import run
from reports.nightly import run as nightly_run
from reports.nightly.history import read_history
from reports.nightly.task import Task, version
from reports.runner import CaseRun
from reports.store import write_whole

CASES = ("crossed-cantilevers", "two-cantilevers-e20-g0")
CHANGES = {"os.chmod", "os.mkdir", "os.remove", "os.rename", "os.rmdir"}
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT


def cut_off_at(place: int) -> None:
    """Kill this process before its change of that number to the disk, from 0."""
    left = place

    def hook(event: str, arguments: tuple[Any, ...]) -> None:
        nonlocal left
        if event in CHANGES or (event == "open" and isinstance(arguments[2], int) and arguments[2] & WRITING):
            if left == 0:
                os.kill(os.getpid(), signal.SIGKILL)
            left -= 1

    sys.addaudithook(hook)


def forked(work: Callable[[], object]) -> object:
    """What the work returns in a process of its own; minus the signal that ended it, if one did."""
    reading, writing = os.pipe()
    pid = os.fork()
    if pid == 0:
        os.write(writing, json.dumps(work()).encode())
        os._exit(0)
    os.close(writing)
    with os.fdopen(reading, "rb") as stream:
        said = stream.read()
    code = os.waitstatus_to_exitcode(os.waitpid(pid, 0)[1])
    return json.loads(said) if code == 0 else code


def answer_with(found: CaseRun, asked: Path) -> None:
    """Answer every case with the same run and tell its name in a file; the report is a word."""

    def run_tasks(tasks: Sequence[Task], *_: object) -> Iterator[CaseRun]:
        for task in tasks:
            with asked.open("a") as stream:
                stream.write(f"{task.case.name}\n")
            yield replace(found, case=task.case)

    nightly_run.run_tasks = run_tasks
    nightly_run.write_report = lambda _runs, output, *_: write_whole(output / "index.html", "report")


def nightly(output: Path) -> int:
    with Path(os.devnull).open("w") as nowhere, redirect_stdout(nowhere):
        return run(["nightly", *CASES, "--no-peers", "--no-cache", "--output", str(output)])


def seen(folder: Path) -> dict[str, object]:
    """What the history says, and which files are not whole."""
    history = read_history(folder / "history")
    return {
        "notes": history.notes,
        "runs": {case: sorted({row.run for row in history.rows(case)}) for case in history.cases()},
        "broken": [path.name for path in folder.rglob("[!.]*.json") if not _whole(path)],
        "hidden": [path.name for path in folder.rglob(".*")],
        "unfinished": (folder / "unfinished" / "run.json").exists(),
        "files": sorted(path.name for path in folder.iterdir()) if folder.is_dir() else [],
    }


def _whole(path: Path) -> bool:
    try:
        json.loads(path.read_text().splitlines()[-1])
    except (IndexError, ValueError):
        return False
    return True


def main() -> None:
    """Cut runs off, later each time, and go on with each."""
    top, answers, step = Path(sys.argv[1]), Path(sys.argv[2]), int(sys.argv[3])
    found: CaseRun = pickle.loads(answers.read_bytes())
    version()  # for all that are forked, as is what reading cases imports
    load_case(CASES[0])
    code: object = -signal.SIGKILL
    for place in range(0, 1000, step):
        output, asked = top / f"output-{place}", top / f"asked-{place}"
        answer_with(found, asked)
        code = forked(lambda output=output, place=place: (cut_off_at(place), nightly(output))[1])  # type: ignore[misc]
        after = forked(lambda output=output: seen(output))  # type: ignore[misc]
        again = forked(lambda output=output: nightly(output))  # type: ignore[misc]
        end = forked(lambda output=output: seen(output))  # type: ignore[misc]
        names = asked.read_text().split()
        print(json.dumps({"code": code, "after": after, "again": again, "end": end, "asked": names}), flush=True)  # noqa: T201 (what it is for)
        shutil.rmtree(output)
        if code != -signal.SIGKILL:
            return


if __name__ == "__main__":
    main()
