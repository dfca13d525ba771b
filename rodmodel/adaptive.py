"""The solver's own choice of level, order and elements for a wanted tolerance, and what error it then expects.

Solve at a low level on elements that are short where fields are steep, with contact on their borders as they are: that
is cheap, and shows where energy is and how far orders fall short. Move the borders onto the edges of contact at the
next level. What energy fields of each degree hold there tells how much all further levels would add, goal by goal in
proportion to what levels have changed so far, and which level is enough: go there on the same borders. Nothing outside
the rod model is asked.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from numpy.typing import NDArray

from cases.scene import Box, Polygon, Scene
from rodmodel.adapt import graded
from rodmodel.assembly import ElementStore
from rodmodel.borders import natural_mesh
from rodmodel.goals import Goal, goals
from rodmodel.indicators import RodIndicators, elements_near_corners, indicators, pressed_elements
from rodmodel.mesh import RodMesh, split
from rodmodel.remaining import Share
from rodmodel.solution import Solution
from rodmodel.solver import checked, moved_contact, solution_of, systems, unmoved_contact
from rodmodel.stretches import Stretch

Array = NDArray[np.float64]
IntArray = NDArray[np.int64]
BoolArray = NDArray[np.bool_]

FIRST_LEVEL, FIRST_ORDER = 2, 4
LEVEL_STEP = 2
HIGHEST_LEVEL, HIGHEST_ORDER = 10, 10
MOST_STEPS = 4
# From this tolerance on borders need not move onto the edges of contact, but of beds, whose edges are far from borders:
# what that changes is some 0.01 %, of small moments 0.3 %.
UNMOVED_ENOUGH = 5e-3
# How near to the edges of contact borders need to be, as a part of a stretch's length, over the root of the tolerance:
# forces between rods are off by some thousandth of its square, small moments beside a bed by half of it.
EDGE_SHARE, EDGE_SHARE_ON_BED = 3.0, 0.2
# Power by which the error falls with the level: near corners; away from them where level 4 tells nothing yet, in smooth
# sections and in walls that meet in corners; and its limits where higher levels tell it.
CORNERS, SMOOTH, WALLS = 2.0, 4.0, 1.5
SLOWEST, FASTEST = 1.0, 8.0
# Under concentrated contact: usually, at least and at most.
INDENTED = (1.0, 0.5, 2.0)
# What a level is expected to leave, as a part of the tolerance, and what of that away from corners.
ENOUGH, AWAY = 0.8, 0.1
# By how much the highest level may be expected to miss the tolerance and still be tried, where two pairs of degrees
# tell how errors fall, and at the level where they do not yet.
HOPELESS, PROBED, EARLY = 1.5, 4, 10.0
# Energy in highest functions that need not be raised, as a part of the tolerance: over the section, along the rods.
BUDGET, ALONG = 0.1, 0.1
# Orders are raised by so many at most at once. Series that fall by less with each order have a corner, where an element
# is split, this part of it from the end with the shorter neighbour.
MOST_ORDERS, SLOW, SPLIT = 4, 0.5, 0.15
# A goal that levels so far happen to have changed by less than this part of the energy they found counts with it.
LEAST_CHANGE, FIXED = 0.05, 1e-7
# The least part of what further orders would find that counts for a goal.
LEAST_SHARE = 0.2
# Tolerances that make sense: below, round-off and the tolerance of contact edges show; above, nothing is asked for.
SMALLEST, LARGEST = 1e-5, 0.2


@dataclass(frozen=True)
class Estimate:
    """A goal, its value in the last step, and how far the rod model's limit may be from it, in the goal's unit."""

    goal: Goal
    value: float
    error: float
    scale: float

    @property
    def relative(self) -> float:
        """The error as a part of the goal's scale: its value, or that of the largest of its kind where it is tiny."""
        return self.error / self.scale


@dataclass(frozen=True, eq=False)
class Step:
    """One solution on the way.

    Attributes
    ----------
    meshes : elements by rod name, as contact moved them
    values : of the goals
    seconds : that it took, wall clock
    """

    meshes: Mapping[str, RodMesh]
    values: Mapping[Goal, float]
    outcome: str
    unknowns: int
    seconds: float

    @property
    def level(self) -> int:
        """Highest level of any element."""
        return max(int(mesh.levels.max()) for mesh in self.meshes.values())


@dataclass(frozen=True, eq=False)
class AdaptiveSolution:
    """What `solve_to` found.

    Attributes
    ----------
    solution : of the last step
    tolerance : asked for, relative
    outcome : 'converged', 'refused: ...' where the tolerance cannot be reached, or that of a solution that did not
        converge
    estimates : of every goal
    steps : all solutions
    """

    solution: Solution
    tolerance: float
    outcome: str
    estimates: tuple[Estimate, ...]
    steps: tuple[Step, ...]

    @property
    def seconds(self) -> float:
        """Of all steps."""
        return sum(step.seconds for step in self.steps)


def solve_to(scene: Scene, tolerance: float) -> AdaptiveSolution:
    """Solve a scene to a tolerance, with levels, orders and elements of the solver's choice.

    Parameters
    ----------
    tolerance : largest relative error of every contact force, largest deflection and clamp moment; contact edges come
        with an estimate, too, but ask for nothing

    Raises
    ------
    SceneError
        if supports, joints and beds leave a rod loose that no contact could hold.
    ValueError
        if the tolerance is out of reach.
    """
    if not SMALLEST <= tolerance <= LARGEST:
        raise ValueError(f"tolerance: found {tolerance:g}; give {SMALLEST:g} to {LARGEST:g}")
    finer = graded(scene)
    meshes = {rod.name: natural_mesh(finer, rod, FIRST_LEVEL, FIRST_ORDER) for rod in finer.rods}
    system_on = systems(scene, ElementStore())
    on_bed = any(pair.on_bed for pair in scene.contacts)
    edge_share = (EDGE_SHARE_ON_BED if on_bed else EDGE_SHARE) * tolerance**0.5
    steps: list[Step] = []
    stretches: tuple[Stretch, ...] = ()
    while True:
        begin = time.perf_counter()
        if len(steps) == 0 or (tolerance > UNMOVED_ENOUGH and not on_bed):
            contact = unmoved_contact(system_on(meshes))
        else:
            contact = moved_contact(scene, meshes, stretches, system_on, edge_share=edge_share)
        solution = solution_of(scene, contact, begin, begin)
        stretches = on_zone_ends(scene, solution.stretches)
        meshes = {name: _mesh_of(solution, name) for name in meshes}
        seen = look_at(solution)
        unknowns, found = solution.cost.unknowns, goals(solution)
        steps.append(Step(meshes, found, solution.outcome, unknowns, time.perf_counter() - begin))
        if solution.outcome != "converged":
            return AdaptiveSolution(solution, tolerance, solution.outcome, (), tuple(steps))
        if len(steps) == 1:
            levels = FIRST_LEVEL + LEVEL_STEP, FIRST_LEVEL + LEVEL_STEP
            meshes = next_meshes(meshes, seen, tolerance, levels)
            continue
        estimates = estimated(steps, seen)
        worst = max((each for each in estimates if each.goal.kind != "contact edge"), key=lambda each: each.relative)
        if worst.relative <= tolerance:
            solution = checked(solution)
            return AdaptiveSolution(solution, tolerance, solution.outcome, estimates, tuple(steps))
        levels, at_best = levels_for(seen, worst.relative, tolerance)
        raised = next_meshes(meshes, seen, tolerance, levels)
        limit = tolerance * (1.0 if seen.level == HIGHEST_LEVEL else HOPELESS if seen.level > PROBED else EARLY)
        if len(steps) == MOST_STEPS or at_best > limit or not _is_more(raised, meshes):
            outcome = _refusal(worst, seen.level, at_best)
            return AdaptiveSolution(solution, tolerance, outcome, estimates, tuple(steps))
        meshes = raised


@dataclass(frozen=True, eq=False)
class Look:
    """What a solution shows of where it falls short.

    Attributes
    ----------
    shown : by rod name
    pressed, near : elements that contact presses on, and those near corners, by rod name
    shares : energy by degree of elements that are alike, without the following
    indented : energy by degree of elements that edges of contact press on: concentrated forces sink in by what other
        energy does not tell
    """

    shown: Mapping[str, RodIndicators]
    pressed: Mapping[str, BoolArray]
    near: Mapping[str, BoolArray]
    shares: tuple[Share, ...]
    indented: tuple[Share, ...]

    @property
    def along(self) -> float:
        """Energy that further orders would find."""
        return float(sum(each.along.sum() for each in self.shown.values()))

    @property
    def level(self) -> int:
        """The highest."""
        return max(share.level for share in (*self.shares, *self.indented))

    def left_over(self) -> float:
        """Energy that further levels would find."""
        return sum(share.left_at(share.level) for share in self.shares)

    def indentation(self, level: int = FIRST_LEVEL) -> float:
        """Error by concentrated contact with elements at this level or, where it is higher, their own."""
        return sum(share.left_at(max(level, share.level)) for share in self.indented)


def look_at(solution: Solution) -> Look:
    """Look at a solution."""
    shown, near, pressed = indicators(solution), elements_near_corners(solution), pressed_elements(solution)
    sums: dict[tuple[bool, bool, bool, int], Array] = {}
    for name, each in shown.items():
        smooth = not isinstance(solution.system.rods[name].rod.section, Box | Polygon)
        indented = near[name] & pressed[name]
        kinds = zip(near[name].tolist(), indented.tolist(), each.levels.tolist(), each.by_degree, strict=True)
        for at, under, level, energy in kinds:
            key = smooth, at, under, level
            sums[key] = sums.get(key, 0.0) + energy[: level + 1]
    shares, concentrated = [], []
    for (smooth, at, under, level), energy in sums.items():
        if under:
            concentrated.append(Share(level, energy, True, *INDENTED))
        else:
            shares.append(Share(level, energy, at, *_powers(at, smooth)))
    return Look(shown, pressed, near, tuple(shares), tuple(concentrated))


def _powers(near: bool, smooth: bool) -> tuple[float, float, float]:
    """By which power of the level errors fall: where nothing is known of it, at least, and at most.

    smooth : whether the section has no corner that points into it, which polynomials resolve slowly
    """
    if near:
        return (CORNERS, CORNERS if smooth else SLOWEST, CORNERS)
    return (SMOOTH, SLOWEST, FASTEST) if smooth else (WALLS, SLOWEST, WALLS)


def levels_for(seen: Look, error: float, tolerance: float) -> tuple[tuple[int, int], float]:
    """The lowest levels near corners and elsewhere that would do, and the error that the highest would leave.

    error : of the goal that is the least certain
    """
    by_level = max(error - seen.along - seen.indentation(), 0.0) / (seen.left_over() or 1.0)

    def error_at(level: int, elsewhere: int) -> float:
        left = sum(share.left_at(max(level if share.near else elsewhere, share.level)) for share in seen.shares)
        return by_level * left + seen.indentation(level)

    def away(level: int) -> float:
        return by_level * sum(share.left_at(max(level, share.level)) for share in seen.shares if not share.near)

    def lowest(levels: range, error: Callable[[int], float], limit: float) -> int:
        return next((level for level in levels if error(level) <= limit), levels[-1])

    # Where nothing tells yet how fast errors fall away from corners and under contact, the next level will.
    highest = min(PROBED + LEVEL_STEP if seen.level <= PROBED else HIGHEST_LEVEL, HIGHEST_LEVEL)
    elsewhere = lowest(range(seen.level, highest + 1, LEVEL_STEP), away, AWAY * tolerance)
    highest = highest if away(elsewhere) + seen.indentation(highest) > 0.5 * tolerance else HIGHEST_LEVEL
    near = lowest(
        range(seen.level, highest + 1, LEVEL_STEP), partial(error_at, elsewhere=elsewhere), ENOUGH * tolerance
    )
    return (near, elsewhere), error_at(HIGHEST_LEVEL, HIGHEST_LEVEL)


def _is_more(raised: Mapping[str, RodMesh], meshes: Mapping[str, RodMesh]) -> bool:
    return any(
        len(raised[name].levels) > len(mesh.levels)
        or (raised[name].levels > mesh.levels).any()
        or (raised[name].orders > mesh.orders).any()
        for name, mesh in meshes.items()
    )


def on_zone_ends(scene: Scene, stretches: Sequence[Stretch]) -> tuple[Stretch, ...]:
    """The stretches, ends next to those of their zone set to these: low levels leave points in corners open.

    Where that is wrong, the search for the edges says so, as contact then pulls there.
    """
    result = []
    for each in stretches:
        (first, last), near = scene.contact(each.pair).zone, 0.5 * each.slack
        start, end = (
            (first if each.start - first < near else each.start),
            (last if last - each.end < near else each.end),
        )
        result.append(replace(each, start=start, end=end))
    return tuple(result)


def _mesh_of(solution: Solution, rod: str) -> RodMesh:
    assembled = solution.system.rods[rod]
    levels = np.array([element.fields.level for element in assembled.elements])
    return RodMesh(assembled.borders, levels, np.array([element.order for element in assembled.elements]))


def _refusal(worst: Estimate, level: int, at_best: float) -> str:
    found = f"the {worst.goal.kind} of '{worst.goal.of}' is uncertain by {_percent(worst.relative)} at h{level}"
    best = f" and would be by {_percent(at_best)} at h{HIGHEST_LEVEL}" if level < HIGHEST_LEVEL else ""
    return f"refused: {found}{best}; polynomials over the section do not get there, a 3D solution is needed"


def _percent(share: float) -> str:
    return f"{100.0 * share:.2g} %" if share < 1.0 else "100 % or more"


def estimated(steps: Sequence[Step], seen: Look) -> tuple[Estimate, ...]:
    """Every goal of the last step with its estimated error.

    What levels so far have changed of a goal is to what is left of its error as the energy they found is to the energy
    left over. What further orders would find, and what concentrated contact hides, counts in full for the goal that
    levels have changed most, and in proportion for others. Nothing is known of an edge that has just appeared.

    seen : the last step
    """
    first, last = steps[0].values, steps[-1].values
    found = float(sum(share.by_degree[FIRST_LEVEL + 1 :].sum() for share in seen.shares))
    left = seen.left_over() / found if found > 0.0 else 0.0
    rest = seen.along + seen.indentation()
    scales = {goal: _scale(goal, last) for goal in last}
    changes = {}
    for goal, value in last.items():
        # a rod that contact had not reached had no deflection
        before = first.get(goal, np.inf if goal.kind == "contact edge" else 0.0)
        changes[goal] = abs(value - before) / scales[goal]
    most = max((change for goal, change in changes.items() if goal.kind != "contact edge"), default=0.0)
    estimates = []
    for goal, value in last.items():
        change, scale = changes[goal], scales[goal]
        if goal.kind == "contact edge":
            error = left * change
        elif change < FIXED:
            # What no level changes is fixed by equilibrium, and so by no order.
            error = change
        else:
            error = left * max(change, LEAST_CHANGE * found) + rest * max(change / most, LEAST_SHARE)
        estimates.append(Estimate(goal, value, error * scale, scale))
    return tuple(estimates)


def _scale(goal: Goal, values: Mapping[Goal, float]) -> float:
    if goal.kind == "contact edge":
        return 1.0
    alike = max(abs(value) for other, value in values.items() if other.kind == goal.kind)
    return max(abs(values[goal]), 1e-3 * alike) or 1.0


def next_meshes(
    meshes: Mapping[str, RodMesh], seen: Look, tolerance: float, levels_wanted: tuple[int, int]
) -> dict[str, RodMesh]:
    """Levels and orders raised where much energy is in the highest functions, elements split where orders do not help.

    Elements that contact presses on are raised in any case: they hold little energy but shape the pressure.

    levels_wanted : to which to raise near corners, and elsewhere
    """
    over_section = np.concatenate([each.over_section for each in seen.shown.values()])
    along = np.concatenate([each.along for each in seen.shown.values()])
    limit, limit_along = _limit(over_section, BUDGET * tolerance), _limit(along, ALONG * tolerance)
    result = {}
    for name, mesh in meshes.items():
        shown, near = seen.shown[name], seen.near[name]
        wanted = np.where(near, *levels_wanted)
        levels = np.where((shown.over_section > limit) | seen.pressed[name], wanted, 0)
        short = shown.along > limit_along
        orders = np.where(short, _orders_to_add(shown, ALONG * tolerance / len(along)), 0)
        orders = np.minimum(mesh.orders + orders, np.maximum(mesh.orders, HIGHEST_ORDER))
        raised = RodMesh(mesh.borders, np.maximum(mesh.levels, levels), orders)
        result[name] = split(raised, _splits(mesh, short & (shown.fall > SLOW)))
    return result


def _orders_to_add(shown: RodIndicators, limit: float) -> IntArray:
    """How many more orders bring each element's rest down to a limit, going by how it falls."""
    with np.errstate(divide="ignore"):
        needed = np.ceil(np.log(limit / shown.along) / np.log(shown.fall))
    return np.where(shown.fall > SLOW, 0, np.clip(needed, 1, MOST_ORDERS)).astype(np.int64)


def _splits(mesh: RodMesh, chosen: BoolArray) -> Array:
    """Where to split elements: near the end next to which the shorter neighbour lies."""
    lengths = np.diff(mesh.borders)
    around = np.concatenate([[np.inf], lengths, [np.inf]])
    at_start = around[:-2] <= around[2:]
    part = np.where(at_start, SPLIT, 1.0 - SPLIT)
    return np.asarray((mesh.borders[:-1] + part * lengths)[chosen])


def _limit(energy: Array, budget: float) -> float:
    """Energy of a single element up to which all together hold no more than the budget."""
    ascending = np.sort(energy)
    kept = np.flatnonzero(np.cumsum(ascending) <= budget)
    return float(ascending[kept[-1]]) if len(kept) else -1.0
