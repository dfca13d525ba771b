"""The JSON object of `rodcheck solve --json` and its schema."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace

import jsonschema
import numpy as np
import pytest

from reports.quantities import SolutionError, evaluate
from reports.result import Result, result
from reports.runner import CaseRun
from reports.solution import Solution


@pytest.fixture
def printed(case_run: CaseRun) -> dict:
    """The object as a reader of the JSON sees it."""
    text = result("two-cantilevers", "rod", 5, 6, case_run.rod.quantities, 0.06).model_dump_json()
    return json.loads(text)


def test_the_object_satisfies_its_schema(printed: dict) -> None:
    jsonschema.validate(printed, Result.model_json_schema())


def test_the_schema_refuses_an_object_with_a_missing_or_an_unknown_key(printed: dict) -> None:
    missing = {key: value for key, value in printed.items() if key != "contacts"}
    for wrong in (missing, {**printed, "force": 1.0}):
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate(wrong, Result.model_json_schema())


def test_the_keys_are_those_promised(printed: dict) -> None:
    promised = {"case", "model", "level", "order", "unknowns", "converged", "seconds", "contacts", "rods"}
    of_contacts = {"pair", "force", "centre", "edges", "edges_outer", "penetration", "pressure"}
    of_rods = {
        "station",
        "position",
        "displacement",
        "moment",
        "end_moment_equilibrium",
        "end_moment_stress",
        "max_bending_stress",
    }

    assert promised <= printed.keys()
    assert printed["seconds"].keys() == {"setup", "solve", "total"}
    assert of_contacts <= printed["contacts"][0].keys()
    assert printed["contacts"][0]["pressure"].keys() == {"position", "middle", "mean", "outer"}
    assert set(printed["rods"]) == {"lower", "upper"}
    assert of_rods <= printed["rods"]["upper"].keys()


def test_rods_are_given_station_by_station(printed: dict) -> None:
    upper = printed["rods"]["upper"]

    assert (upper["station"][0], upper["station"][-1]) == (0.0, 300.0)
    assert upper["position"][0] == [200.0, 15.0, 0.0]
    assert len(upper["station"]) == len(upper["displacement"]) == len(upper["moment"])
    assert all(len(vector) == 3 for vector in upper["displacement"])
    assert upper["moment"][-1] == pytest.approx(upper["end_moment_equilibrium"])


def test_reactions_are_those_of_both_clamps(printed: dict) -> None:
    lower, upper = printed["reactions"]

    # the contact force of 320 N, centred at 250 mm, on the lower rod; on the upper one the load of 1 kN against it
    assert (lower["rod"], lower["station"]) == ("lower", 0.0)
    assert lower["force"] == pytest.approx([0.0, 320.0, 0.0])
    assert lower["moment"] == pytest.approx([0.0, 0.0, 320.0 * 250.0])
    assert (upper["rod"], upper["station"]) == ("upper", 300.0)
    assert upper["force"] == pytest.approx([0.0, 680.0, 0.0])


def test_without_contact_the_centre_is_null_and_there_is_no_edge(case_run: CaseRun) -> None:
    contact = replace(case_run.rod.quantities.contacts[0], force=0.0, centre=None, edges=(), edges_outer=())
    quantities = replace(case_run.rod.quantities, contacts=(contact,))

    printed = json.loads(result("apart", "reference", None, None, quantities, 1.0).model_dump_json())

    assert printed["contacts"][0]["centre"] is None
    assert printed["contacts"][0]["edges"] == []
    jsonschema.validate(printed, Result.model_json_schema())


def test_a_solution_that_is_not_finite_has_no_result(beam_solution: Callable[..., Solution]) -> None:
    solution = beam_solution(outcome="stagnated", strain_energy=np.nan)

    with pytest.raises(SolutionError, match=r"not finite \(stagnated\)"):
        evaluate(solution)
