"""Random scenes of rods in contact: every one ends, in complementarity and equilibrium, or is refused with a reason.

The outcomes are counted and printed (pytest -rP shows them). More scenes than the suite has time for:
`RANDOM_SCENES=2000 pytest tests/test_random_scenes.py -rP`.
"""

from __future__ import annotations

import os
from collections import Counter

import numpy as np
import pytest

import rodmodel
from cases.scene import Box, Ground, Material, Rectangle, Rod, SceneError
from reports.quantities import evaluate
from tests.random_scenes import random_scene

SCENES = int(os.environ.get("RANDOM_SCENES", "24"))
# Penetration that a solution may leave, as a share of the largest displacement: a corner's, where pressure is singular.
PENETRATION = 1e-3
# Unbalanced force, as a share of the largest.
UNBALANCED = 1e-8

# What round-off may leave of forces that cancel in a rigid motion: some hundred times the precision of numbers.
ROUND_OFF = 1e-13


def axial_stiffness(solution: rodmodel.Solution, rod: Rod) -> float:
    """E A / l, N/mm, of the shortest element, and of the full outline, which is more than the section's own."""
    assert isinstance(rod.section, Rectangle | Box)
    assert isinstance(rod.material, Material)
    shortest = float(np.diff(solution.system.rods[rod.name].borders).min())
    return rod.material.young_modulus * rod.section.width * rod.section.height / shortest


def checked_outcome(seed: int) -> str:
    """How the solution of a scene ended, once what it claims is seen to be so."""
    try:
        solution = rodmodel.solve(random_scene(seed), level=2, order=4)
    except SceneError:
        return "refused as a scene"
    if solution.outcome != "converged":
        kind, _, reason = solution.outcome.partition(": ")
        assert kind in ("refused", "stagnated"), seed
        assert reason, seed
        return kind
    scene = solution.scene
    stations = {rod.name: np.linspace(0.0, rod.length, 9) for rod in scene.rods}
    moved = max(float(np.abs(solution.displacement(name, at)).max()) for name, at in stations.items())
    largest = 0.0
    for pair in scene.contacts:
        points = solution.contact_points(pair.name)
        largest = max(largest, float(points.force.sum()))
        assert (points.force >= 0.0).all(), (seed, pair.name)
        if not isinstance(pair.second, Ground) or pair.second.modulus is None:
            assert points.gap.min(initial=0.0) >= -PENETRATION * moved - 1e-6, (seed, pair.name)
    quantities = evaluate(solution)
    # Forces that cancel are large where a stiff rod is carried far by a soft one (some bend by metres under such loads)
    # and in elements between borders that edges of contact have brought close together.
    reactions = max((float(np.abs(each[:3]).max()) for each in quantities.reactions.values()), default=0.0)
    cancelling = max(axial_stiffness(solution, rod) * moved for rod in scene.rods)
    allowed = UNBALANCED + ROUND_OFF * cancelling / max(reactions, largest, 1e-12)
    assert quantities.equilibrium_residual <= allowed, seed
    return "converged, edges settled" if solution.edge_uncertainty <= 0.02 else "converged, edges on a fixed mesh"


@pytest.mark.slow
def test_every_random_scene_ends_as_it_says() -> None:
    outcomes = Counter(checked_outcome(seed) for seed in range(SCENES))

    print(f"{SCENES} scenes:", dict(outcomes))  # noqa: T201 - the count is part of what the test tells
    assert sum(outcomes.values()) == SCENES
    assert outcomes["stagnated"] <= 0.02 * SCENES
