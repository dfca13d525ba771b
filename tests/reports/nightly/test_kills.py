"""A run that is killed, before any of its changes to the disk or at any time, goes on where it was and loses nothing.

More than the suite has time for, at every change and many times:
`NIGHTLY_KILLS=50 pytest tests/reports/nightly/test_kills.py`.
"""

from __future__ import annotations

import json
import os
import pickle
import random
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import pytest

from reports.nightly.history import read_history
from reports.runner import CaseRun
from tests.reports.nightly import cut_off

KILLS = int(os.environ.get("NIGHTLY_KILLS", "1"))
# `rodcheck nightly` but for what takes long: cases are answered with what a file holds, and the report is a word.
DRIVER = """
from reports.nightly import run, work
from reports.command_line import main
from reports.store import write_whole
work.CASE_PROCESS = "answer_of_the_test"
run.write_report = lambda _runs, output, *_: write_whole(output / "index.html", "report")
main()
"""
ANSWER = """
import pickle, sys
from dataclasses import replace
task = pickle.load(sys.stdin.buffer)
found = pickle.load(open({path!r}, "rb"))
sys.stdout.buffer.write(pickle.dumps(replace(found, case=task.case)))
"""


@pytest.fixture
def answers(tmp_path: Path, case_run: CaseRun) -> Path:
    """A file with a case that passed."""
    passed = tuple(replace(found, verdict="pass") for found in case_run.comparisons)
    path = tmp_path / "answers"
    path.write_bytes(pickle.dumps(replace(case_run, comparisons=passed)))
    return path


@pytest.mark.slow
def test_a_run_cut_off_before_any_of_its_changes_to_the_disk_goes_on(tmp_path: Path, answers: Path) -> None:
    step = 1 if KILLS > 1 else 5  # a file takes four changes
    command = [sys.executable, "-m", "tests.reports.nightly.cut_off", str(tmp_path), str(answers), str(step)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)

    cuts = [json.loads(line) for line in done.stdout.splitlines()]
    assert [cut["code"] for cut in cuts] == [-signal.SIGKILL] * (len(cuts) - 1) + [0]
    # a file of each case, the run's name, history, report and summary: each made, opened, its rights set, renamed
    assert step * len(cuts) > 4 * 6
    for place, cut in enumerate(cuts):
        for state in (cut["after"], cut["end"]):
            assert (state["notes"], state["broken"]) == ([], []), place
        assert cut["again"] == 0, place
        assert cut["end"]["hidden"] == [], place
        assert cut["end"]["files"] == ["history", "index.html", "lock", "summary.txt"], place
        runs = [cut["end"]["runs"][case] for case in cut_off.CASES]
        assert runs[0] == runs[1], place
        # at its end the run is forgotten, and what is called a resumption is another night
        assert len(runs[0]) == (1 if cut["after"]["unfinished"] or not cut["after"]["runs"] else 2), place
        assert all(set(cut["after"]["runs"].get(case, ())) <= set(runs[0]) for case in cut_off.CASES), place
        # of two cases, only the one at work is answered again
        assert len(cut["asked"]) <= 2 * len(runs[0]) + 1, place


@pytest.mark.slow
def test_a_run_killed_at_any_time_goes_on_where_it_was(tmp_path: Path, answers: Path) -> None:
    (tmp_path / "answer_of_the_test.py").write_text(ANSWER.format(path=str(answers)))
    environment = os.environ | {"PYTHONPATH": os.pathsep.join((str(tmp_path), str(Path.cwd())))}
    kills, seconds, chance = 0, 0.0, random.Random(7)
    for number in range(KILLS):
        output = tmp_path / str(number)
        command = [sys.executable, "-c", DRIVER, "nightly", *cut_off.CASES, "--no-peers", "--no-cache"]
        command += ["--output", str(output)]
        while True:
            begin = time.monotonic()
            with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
                if kills == number:  # one a run; the first as soon as a case is kept, which is when most is at stake
                    if number == 0:
                        _wait_for(output / "unfinished", process)
                    else:
                        time.sleep(chance.uniform(0.0, seconds))
                    process.kill()
                    kills += 1
                _, said = process.communicate()
            _require_whole(output)
            if process.returncode != -signal.SIGKILL:
                seconds = time.monotonic() - begin
                break

        assert process.returncode == 0, said.decode()
        assert said == b""
        history = read_history(output / "history")
        assert history.cases() == list(cut_off.CASES)
        assert sorted(path.name for path in output.iterdir()) == ["history", "index.html", "lock", "summary.txt"]
    assert kills == KILLS


def _wait_for(folder: Path, process: subprocess.Popen[bytes]) -> None:
    """Wait until the first case is kept."""
    while process.poll() is None and not list(folder.glob("case-*.json")):
        time.sleep(0.02)
    assert process.poll() is None


def _require_whole(output: Path) -> None:
    state = cut_off.seen(output)
    assert (state["notes"], state["broken"]) == ((), [])
