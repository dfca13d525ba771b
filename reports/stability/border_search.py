"""The search for the edge of contact from bad starts, against letting borders creep to where the gap opens."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cases.scene import Scene
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import END, START, meshes, on_meshes, two_bars
from reports.stability.wording import number
from rodmodel.assembly import ElementStore
from rodmodel.borders import Edge, Rates, border_plan, edge_rates, placed_meshes
from rodmodel.contact import unilateral_contact
from rodmodel.edges import EDGE_TOLERANCE, find_edges
from rodmodel.stretches import Stretch, moving_edges
from rodmodel.system import ContactSystem

Array = NDArray[np.float64]

STARTS = tuple(float(at) for at in range(202, 299, 12))
# The plain search gives up after so many contact solutions.
MOST = 25
# Which border follows the edge depends on the guess, and the edge a little on the mesh: the same edge within this, mm.
SAME_EDGE = 0.3
CREEP = Method("to the zero of the gap", ours=False)
ONE, TWO = Method("edge pressure, one edge"), Method("edge pressure, two edges")
# Contact at the end of the upper bar, one edge; and within the zone, two edges
ONE_EDGE, TWO_EDGES = {"ratio": 0.25}, {"ratio": 0.1}


def measure(values: tuple[float, ...]) -> Found:
    """Contact solutions spent, and where each search ends, from every start."""
    names = (CREEP.name, ONE.name, TWO.name)
    solutions: dict[str, list[float]] = {name: [] for name in names}
    ends: dict[str, list[float]] = {name: [] for name in names}
    one, two = two_bars(**ONE_EDGE), two_bars(**TWO_EDGES)
    for value in values:
        spent, end = _search(one, (Stretch("overlap", START, value),))
        crept, creeping = _creep(one, value)
        # A guess of a stretch as wide as it will be in the end, wherever it may be.
        middle = min(max(value, START + 13.0), END - 13.0)
        both, last = _search(two, (Stretch("overlap", middle - 12.0, middle + 12.0),))
        for name, count, at in zip(names, (crept, spent, both), (creeping, end, last), strict=True):
            solutions[name].append(count)
            ends[name].append(at)
    return {
        "solutions": {name: curve(values, found) for name, found in solutions.items()},
        "end": {
            name: curve(values, np.maximum(np.abs(np.array(found) - _home(ends[reference])), 1e-4))
            for name, found, reference in (
                (CREEP.name, ends[CREEP.name], ONE.name),
                (ONE.name, ends[ONE.name], ONE.name),
                (TWO.name, ends[TWO.name], TWO.name),
            )
        },
    }


def _home(ends: list[float]) -> float:
    """Where most searches end."""
    return float(np.nanmedian(ends))


def _search(scene: Scene, stretches: tuple[Stretch, ...]) -> tuple[float, float]:
    """Contact solutions of the rod model's search, and where the last edge ends; nan if the search gave up."""
    edges, positions = moving_edges(scene, stretches)
    store = ElementStore()
    plan = border_plan(scene, meshes(scene), edges, positions)

    def system_at(at: Array) -> tuple[ContactSystem, dict[str, Rates]]:
        return on_meshes(scene, placed_meshes(plan, at), store), edge_rates(plan, at)

    found = find_edges(scene, stretches, edges, positions, system_at)
    return float(len(found.steps)), float(found.positions[-1]) if found.outcome == "converged" else float("nan")


def _creep(scene: Scene, start: float) -> tuple[float, float]:
    """The plain search: the border goes to where the gap, straight between contact points, opens."""
    edges, at, store = (Edge("overlap", 0, 1),), np.array([start]), ElementStore()
    for count in range(1, MOST + 1):
        plan = border_plan(scene, meshes(scene), edges, at)
        system = on_meshes(scene, placed_meshes(plan, at), store, multipliers=False)
        problem, grid = system.problem, system.grids["overlap"]
        force = unilateral_contact(problem, settled=False).force
        opening = (problem.gap + problem.compliance @ force).reshape(grid.weight.shape)[:, :, grid.middle].ravel()
        station = grid.station.ravel()
        last = int(np.flatnonzero(opening < 0.0)[-1])
        nxt = last + 1
        while nxt < len(station) - 1 and station[nxt] <= station[last]:
            nxt += 1
        part = opening[last] / (opening[last] - opening[nxt]) if opening[nxt] > opening[last] else 0.0
        new = float(station[last] + part * (station[nxt] - station[last]))
        new = min(max(new, START + 0.3), END - 0.3)
        if abs(new - at[0]) < EDGE_TOLERANCE:
            return float(count), new
        at = np.array([new])
    return float(MOST), float(at[0])


def claim(found: Found) -> str:
    """How many solutions, and whether all end at the same edge."""
    solutions, end = found["solutions"], found["end"]
    starts = len(end[ONE.name].x)
    arrived = {name: sum(error < SAME_EDGE for error in each.y) for name, each in end.items()}
    crept = sum(count < MOST for count in solutions[CREEP.name].y)
    return (
        f"From {starts} starts all over the zone the search on the edge's pressure ends at one and the same edge, "
        f"within {number(end[ONE.name].largest)} mm, {arrived[ONE.name]} times, in {min(solutions[ONE.name].y):.0f} to "
        f"{solutions[ONE.name].largest:.0f} contact solutions; with two edges at once {arrived[TWO.name]} times, "
        f"within {number(end[TWO.name].largest)} mm, in {min(solutions[TWO.name].y):.0f} to "
        f"{solutions[TWO.name].largest:.0f}. Borders that go to the zero of the gap come to rest within {MOST} "
        f"solutions from {crept} of the starts, and end {number(min(end[CREEP.name].sizes))} to "
        f"{number(end[CREEP.name].largest)} mm away."
    )


def own_limit(found: Found) -> str:
    """What the guess leaves in the result, and starts from which the search gives up."""
    end = found["end"]
    lost = sum(len(end[each.name].x) - len(end[each.name].sizes) for each in (ONE, TWO))
    mesh = (
        f"The edge is found to {EDGE_TOLERANCE:g} mm on the mesh that there is, but the guess decides which border "
        f"follows it: between such meshes it differs by {number(end[ONE.name].largest)} mm. That is not part of the "
        "stated uncertainty."
    )
    if not lost:
        return mesh
    return (
        f"{mesh} From {lost} of the starts the search gives up (its edge leaves the zone or does not settle); the "
        "solver then starts anew from what the last contact solution shows, up to three times, and otherwise leaves "
        "the borders and states how far the edge may be."
    )


def holds(found: Found) -> bool:
    """Where our search says that it converged it is at the same edge, from nearly all starts; creeping is not."""
    end = found["end"]
    same = all(error < SAME_EDGE for each in (ONE, TWO) for error in end[each.name].sizes)
    often = len(end[ONE.name].sizes) >= 0.9 * len(end[ONE.name].x)
    return same and often and end[CREEP.name].largest > 2.0 * SAME_EDGE


SWEEP = Sweep(
    "Border search",
    "The two cantilevers with one edge (E2 = 50 GPa) and with two (20 GPa): the first guess of the edge is put "
    "anywhere in the zone of 100 mm.",
    STARTS,
    (CREEP, ONE, TWO),
    (
        Picture("solutions", "Contact solutions", "first guess, mm", "solutions", log_x=False, log_y=False),
        Picture("end", "Where the search ends", "first guess, mm", "mm from the edge (0 at 10⁻⁴)", log_x=False),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
