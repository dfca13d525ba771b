"""Solvers that are not of this project: asked in processes of their own, and shown beside ours whatever came of it."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from reports import peers as peers_module
from reports.cache import Cache
from reports.comparison import Extrapolation
from reports.peers import NOT_ASKED, PEERS, PeerRun, as_json, ask_peers, difference, peer_value, side_by_side
from reports.peers_table import NO_VALUE, peers_summary, peers_table
from reports.processes import ProcessFailed, failure_reason
from reports.runner import CaseRun

PEER = """
import numpy as np
from cases.scene import SceneError
from reference3d.peers.answer import PeerAnswer

def installed():
    return {installed!r}

def solve(scene, stations):
    {body}
    displacement = {{name: np.full((3, len(station)), 0.5) for name, station in stations.items()}}
    force, centre = np.array([0.0, 3.0, 4.0]), np.array([250.0, 7.5, 0.0])
    pairs = [pair.name for pair in scene.contacts]
    return PeerAnswer("Peer 1.0", {outcome!r}, 42, 1.5, 12.0, dict.fromkeys(pairs, force), dict.fromkeys(pairs, centre),
                      displacement, {{("lower", 0.0): np.array([1.0, 2.0, 3.0, 0.0, 0.0, -7.0])}})
"""


# A module is imported once by its name.
NUMBERS = count()


@pytest.fixture
def peer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Makes a module that the peers' own processes can import the only peer."""

    def make(body: str = "pass", installed: str = "", outcome: str = "converged") -> None:
        name = f"peer_of_the_test_{next(NUMBERS)}"
        (tmp_path / f"{name}.py").write_text(PEER.format(body=body, installed=installed, outcome=outcome))
        monkeypatch.setattr(peers_module, "PEERS", {"Peer": name})

    monkeypatch.syspath_prepend(str(tmp_path))
    return make


@pytest.fixture
def here(monkeypatch: pytest.MonkeyPatch) -> None:
    """Peers are asked in this process, which is quicker."""

    def in_this_process(work, given):
        try:
            return work(given, lambda _: None)
        except Exception as error:
            raise ProcessFailed(failure_reason(error)) from error

    monkeypatch.setattr(peers_module, "in_own_process", in_this_process)


@pytest.fixture
def beside(case_run: CaseRun) -> CaseRun:
    """The solved case with the numbers that every solver can tell."""
    references = [run.quantities for run in case_run.references]
    rows = side_by_side(
        case_run.case, case_run.rod.quantities, references, lambda _one, _two, fine: Extrapolation(fine, 0.5, 2.0)
    )
    return replace(case_run, side_by_side=rows)


def ask(run: CaseRun, cache: Cache | None = None) -> PeerRun:
    (found,) = ask_peers(run.case.scene, {"lower": np.zeros(2), "upper": np.zeros(3)}, cache=cache)
    return found


@pytest.mark.slow
def test_a_peer_answers_in_another_process_and_may_crash_there(case_run: CaseRun, peer) -> None:
    peer()
    answered = ask(case_run)
    peer("import os; os._exit(3)")
    crashed = ask(case_run)

    assert answered.answer is not None
    assert answered.answer.displacement["upper"].shape == (3, 3)
    assert (crashed.answer, crashed.reason) == (None, "failed: its process ended early with exit code 3")


@pytest.mark.usefixtures("here")
@pytest.mark.parametrize(
    ("answer", "reason"),
    [
        ({"installed": "Peer is not installed: buy it"}, "Peer is not installed: buy it"),
        ({"body": "raise SceneError('rods.a', 'a knot', 'untie it')"}, "cannot treat this case: rods.a: found a knot"),
        ({"body": "raise ValueError('no idea')"}, "failed: ValueError: no idea"),
    ],
)
def test_a_peer_without_an_answer_says_why(case_run: CaseRun, peer, answer: dict[str, str], reason: str) -> None:
    peer(**answer)

    found = ask(case_run)

    assert found.answer is None
    assert found.reason.startswith(reason)


def test_a_peer_that_cannot_even_be_asked_costs_the_case_nothing(
    case_run: CaseRun, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(peers_module, "PEERS", {"Peer": "no_such_module"})

    assert ask(case_run).reason.startswith("failed: ModuleNotFoundError")


@pytest.mark.usefixtures("here")
def test_an_answer_is_kept_and_one_that_did_not_converge_is_not(case_run: CaseRun, peer, tmp_path: Path) -> None:
    for outcome, kept in (("converged", True), ("refused: not done within 1 s", False)):
        peer(outcome=outcome)
        ask(case_run, Cache(tmp_path / outcome[:9]))

        again = ask(case_run, Cache(tmp_path / outcome[:9]))

        assert bool(again.kept_since) == kept
        assert again.answer is not None
        assert again.answer.outcome == outcome
        assert again.answer.reactions["lower", 0.0][5] == -7.0


@pytest.mark.usefixtures("here")
def test_every_number_of_a_peer_stands_beside_ours(beside: CaseRun, peer) -> None:
    peer()
    run = replace(beside, peers=(ask(beside),))
    rod = run.rod.quantities

    values = {(row.quantity, row.of): peer_value(row, run.peers[0].answer, rod) for row in run.side_by_side}

    assert values == {
        ("contact_force", "overlap"): 5.0,
        ("contact_centre", "overlap"): 250.0,
        ("largest_deflection", "lower"): pytest.approx(0.5 * 3**0.5),
        ("largest_deflection", "upper"): pytest.approx(0.5 * 3**0.5),
        ("clamp_moment", "lower"): 7.0,
        ("clamp_moment", "upper"): None,
    }


def test_ours_are_the_quantities_of_the_case_and_the_extrapolated_reference(beside: CaseRun) -> None:
    force, centre = beside.side_by_side[:2]

    assert force.rod == pytest.approx(320.0)
    assert (force.reference, force.uncertainty) == (pytest.approx(319.75), 0.5)
    assert difference(force, 319.75 * 1.01) == pytest.approx(0.01)
    assert difference(centre, centre.reference + 0.25) == pytest.approx(0.25)  # in mm
    assert difference(force, None) is None


@pytest.mark.usefixtures("here")
def test_the_table_has_a_column_for_each_answer_and_a_sentence_for_each_other_peer(beside: CaseRun, peer) -> None:
    peer()
    run = replace(beside, peers=(ask(beside), PeerRun("Other", None, "Other is not installed")))

    table = peers_table(run)

    assert table.columns[-1] == "Peer 1.0"
    assert table.rows[0][0] == "Contact force, overlap, N"
    assert table.rows[0][1][1:] == ("319.750 \u00b1 0.156 %", "5.00000 (\u221298.436 %)")
    assert table.rows[1][1][0] == "250.000 (0.000 mm)"  # no sign where there is no difference
    assert table.rows[-1][1][-1] == NO_VALUE
    assert [cost.solver for cost in table.costs][-1] == "Peer 1.0"
    assert table.missing == ("Other is not installed",)
    assert json.loads(json.dumps(as_json(run.side_by_side, run.peers, run.rod.quantities), allow_nan=False))


@pytest.mark.usefixtures("here")
def test_the_summary_names_every_peer_how_far_it_is_and_why_it_is_silent(beside: CaseRun, peer) -> None:
    peer()
    answered = replace(beside, peers=(replace(ask(beside), peer="CalculiX"), PeerRun("NGSolve", None, "It is absent.")))
    refused = replace(beside, peers=tuple(PeerRun(name, None, "It is absent.") for name in PEERS))

    curved = replace(refused, peers=(refused.peers[0], PeerRun("NGSolve", None, "cannot treat this case: a helix")))

    calculix, ngsolve = peers_summary([answered, refused, curved])

    assert calculix.startswith(
        "CalculiX answered 1 of 3 cases; contact forces and largest deflections differ from 3D by"
    )
    assert calculix.endswith("It is absent.")
    assert ngsolve == "NGSolve answered 0 of 3 cases. It cannot treat 1 of them, whose page says why. It is absent."


def test_peers_that_were_not_asked_are_said_to_be(beside: CaseRun) -> None:
    assert peers_table(beside).missing == tuple(f"{name}: {NOT_ASKED}" for name in PEERS)
    assert all(NOT_ASKED in sentence for sentence in peers_summary([beside]))


@pytest.mark.parametrize("module", PEERS.values())
def test_peers_have_what_they_are_asked_by(module: str) -> None:
    from importlib import import_module

    loaded = import_module(module)

    assert isinstance(loaded.installed(), str)
    assert callable(loaded.solve)
