"""Penalty over ten decades: plain springs, multipliers on top of the same springs, and the solver left alone."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np

import rodmodel
from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import LEVEL, ORDER, Answer, answer, said, two_bars
from reports.stability.wording import number, share
from rodmodel.contact import unilateral_contact
from rodmodel.system import ContactSystem

PENALTIES = tuple(float(10.0**power) for power in range(1, 12))
PLAIN, SAME, OURS = (
    Method("plain penalty", ours=False),
    Method("multipliers on the same springs"),
    Method("the solver's default"),
)
# Plain springs as stiff as this are next to rigid; what the others find is held against them.
RIGID = 1e12
# Edges this near each other are the same, mm.
NEAR_ENOUGH = 0.05

QUANTITIES: dict[str, Callable[[Answer, Answer], float]] = {
    "force": lambda found, best: max(abs(found.force / best.force - 1.0), np.finfo(float).eps),
    "edge": lambda found, best: max(abs(found.edge - best.edge), 1e-6),
    "penetration": lambda found, _: found.penetration,
    "condition": lambda found, _: found.condition,
    "sets": lambda found, _: float(found.active_sets),
}


def measure(values: tuple[float, ...]) -> Found:
    """Everything of all methods."""
    best = answer(two_bars(penalty=RIGID), multipliers=False)
    borders = rodmodel.solve(two_bars(), LEVEL, ORDER)
    answers = {
        PLAIN.name: [answer(two_bars(penalty=value), multipliers=False) for value in values],
        SAME.name: [_on_springs(borders.system, value) for value in values],
        OURS.name: [answer(two_bars(penalty=value)) for value in values],
    }
    return {
        key: {
            name: curve(values, (quantity(each, best) for each in found))
            for name, found in answers.items()
            # Of multipliers on fixed borders there is no edge.
            if not (key == "edge" and name == SAME.name)
        }
        for key, quantity in QUANTITIES.items()
    } | {
        "refused": {
            name: curve(values, (float(each.outcome != "converged") for each in found))
            for name, found in answers.items()
        },
        "solutions": {OURS.name: curve(values, (each.solutions for each in answers[OURS.name]))},
    }


def _on_springs(system: ContactSystem, penalty: float) -> Answer:
    """Contact on the borders of a solution with multipliers on springs of this penalty."""
    weight = system.grids["overlap"].weight.ravel()
    problem = replace(system.problem, spring=penalty * weight, rigid=np.ones(len(weight), dtype=bool))
    found = unilateral_contact(problem)
    return said(found.outcome, problem, found.force, math.nan, 1)


def claim(found: Found) -> str:
    """By how much results depend on the penalty."""
    force, edge, sets = found["force"], found["edge"], found["sets"]
    plain, ours = force[PLAIN.name], force[OURS.name]
    refused = sum(found["refused"][PLAIN.name].y)
    spread = ours.largest - min(ours.y)
    changed = f"changes by {share(spread)}" if spread else "is the same to the last bit"
    return (
        f"Plain springs of {number(plain.x[0])} N/mm³ give a contact force {share(plain.y[0])} off and an edge "
        f"{number(edge[PLAIN.name].y[0])} mm off ({refused:.0f} of the softest are refused for that); the edge needs "
        "stiffer springs than the force. Multipliers on the same springs take the penetration away: their force is "
        f"within {share(force[SAME.name].largest)} at any penalty, with up to {sets[SAME.name].largest:.0f} active "
        f"sets (plain springs: {sets[PLAIN.name].largest:.0f}). What the solver gives by default {changed} over all "
        f"{math.log10(ours.x[-1] / ours.x[0]):.0f} decades, with up to {sets[OURS.name].largest:.0f} active sets. The "
        "condition of plain springs' matrix grows with the penalty, to "
        f"{number(found['condition'][PLAIN.name].largest)}; the default's is at most "
        f"{number(found['condition'][OURS.name].largest)}."
    )


def own_limit(found: Found) -> str:
    """Edges, and solutions."""
    edge, solutions = found["edge"][OURS.name], found["solutions"][OURS.name]
    least, most = min(solutions.y), solutions.largest
    count = f"{most:.0f}" if least == most else f"{least:.0f} to {most:.0f}"
    spent = f"The default takes {count} contact solutions for one edge"
    if edge.largest <= NEAR_ENOUGH:
        return f"{spent}, and its edge is within {number(edge.largest)} mm of that of next to rigid springs."
    return (
        f"{spent}, and its edge is up to {number(edge.largest)} mm from that of next to rigid springs, more than the "
        "0.01 mm that the search aims at: multipliers stop when force and energy have settled, before the pressure at "
        "the edge has. Nothing says so."
    )


def holds(found: Found) -> bool:
    """Plain force and edge depend on the penalty; multipliers' force does not, by 0.01 % over all decades."""
    force, edge = found["force"], found["edge"]
    plain = force[PLAIN.name].y[0] > 1e-3 and edge[PLAIN.name].y[0] > 1.0
    ours = not any(found["refused"][OURS.name].y) and force[OURS.name].largest < 1e-4
    return plain and ours and force[SAME.name].largest < 1e-3


SWEEP = Sweep(
    "Penalty",
    "The paper's two cantilevers (E2 = 50 GPa, no gap): the penalty from 10 to 10¹¹ N/mm³. What is off is so from "
    "plain springs of 10¹² N/mm³, which are next to rigid. Multipliers on the same springs are on borders that stay.",
    PENALTIES,
    (PLAIN, SAME, OURS),
    (
        Picture("force", "Contact force", "penalty, N/mm³", "relative difference"),
        Picture("edge", "Edge of contact", "penalty, N/mm³", "difference, mm"),
        Picture("penetration", "Penetration", "penalty, N/mm³", "largest, mm"),
        Picture("condition", "Contact matrix", "penalty, N/mm³", "condition"),
        Picture("sets", "Active sets tried", "penalty, N/mm³", "sets", log_y=False),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
