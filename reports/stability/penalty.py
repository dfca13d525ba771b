"""Penalty over ten decades: plain springs against multipliers on top of them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import Answer, answer, two_bars
from reports.stability.wording import number, share

PENALTIES = tuple(float(10.0**power) for power in range(1, 12))
PLAIN, OURS = Method("plain penalty", ours=False), Method("multipliers")
# Force and edge by multipliers with this penalty are what the others are held against.
BEST = 1e8
# The decades over which the force should not change.
FROM = 1e3
# Edges this near each other are the same, mm.
NEAR_ENOUGH = 0.05

QUANTITIES: dict[str, Callable[[Answer, Answer], float]] = {
    "force": lambda found, best: abs(found.force / best.force - 1.0),
    "edge": lambda found, best: abs(found.edge - best.edge),
    "penetration": lambda found, _: found.penetration,
    "condition": lambda found, _: found.condition,
    "sets": lambda found, _: float(found.active_sets),
}


def measure(values: tuple[float, ...]) -> Found:
    """Everything of both methods."""
    best = answer(two_bars(penalty=BEST))
    plain, ours = (
        [answer(two_bars(penalty=value), multipliers=multipliers) for value in values] for multipliers in (False, True)
    )
    chosen = answer(two_bars(penalty=None))
    return {
        key: {
            PLAIN.name: curve(values, (quantity(each, best) for each in plain)),
            OURS.name: curve(values, (quantity(each, best) for each in ours)),
        }
        for key, quantity in QUANTITIES.items()
    } | {
        "refused": {PLAIN.name: curve(values, (float(each.outcome.startswith("refused")) for each in plain))},
        "automatic": {
            "force": curve((0.0,), (abs(chosen.force / best.force - 1.0),)),
            "edge": curve((0.0,), (abs(chosen.edge - best.edge),)),
            "solutions": curve((0.0,), (chosen.solutions,)),
        },
    }


def _stiff(found: Found, key: str, method: Method) -> list[float]:
    """Numbers from the penalty on from which results should not depend on it."""
    chosen = found[key][method.name]
    return [y for x, y in zip(chosen.x, chosen.y, strict=True) if x >= FROM]


def claim(found: Found) -> str:
    """By how much results depend on the penalty."""
    plain, ours = found["force"][PLAIN.name], found["force"][OURS.name]
    edge, sets = found["edge"], found["sets"]
    refused = sum(found["refused"][PLAIN.name].y)
    decades = np.log10(ours.x[-1] / FROM)
    return (
        f"Plain springs of {number(plain.x[0])} N/mm³ give a contact force {share(plain.y[0])} off and an edge "
        f"{number(edge[PLAIN.name].y[0])} mm off ({refused:.0f} of the softest are refused for that); the edge needs "
        "stiffer springs than the force. With multipliers the force changes by "
        f"{share(max(_stiff(found, 'force', OURS)))} over the {decades:.0f} decades from {number(FROM)} on, and by "
        f"{share(ours.largest)} over all; soft springs cost them up to {sets[OURS.name].largest:.0f} active sets instead "
        "of one. The condition of the contact matrix grows with the penalty, to "
        f"{number(found['condition'][OURS.name].largest)}."
    )


def own_limit(found: Found) -> str:
    """Edges with soft springs."""
    edge, automatic = found["edge"][OURS.name], found["automatic"]
    bad = [(x, y) for x, y in zip(edge.x, edge.y, strict=True) if y > NEAR_ENOUGH]
    chosen = (
        f"The penalty that the solver chooses by itself gives the force within {share(automatic['force'].y[0])} and the edge "
        f"within {number(automatic['edge'].y[0])} mm, in {automatic['solutions'].y[0]:.0f} contact solutions."
    )
    if not bad:
        return chosen
    softest, worst = max(bad, key=lambda each: each[1])
    return (
        f"With multipliers on soft springs the edge is not right yet: {number(worst)} mm off at {number(softest)} N/mm³, and "
        f"more than {NEAR_ENOUGH:g} mm up to {number(max(x for x, _ in bad))} N/mm³. The multipliers stop when the force has "
        f"settled, before the pressure at the edge has; nothing says so. {chosen}"
    )


def holds(found: Found) -> bool:
    """The plain force and edge depend on the penalty, ours not over the decades from `FROM` on."""
    plain = found["force"][PLAIN.name].y[0] > 1e-3 and found["edge"][PLAIN.name].y[0] > 1.0
    return plain and max(_stiff(found, "force", OURS)) < 1e-4 and found["edge"][OURS.name].at(1e6) < NEAR_ENOUGH


SWEEP = Sweep(
    "Penalty",
    "The paper's two cantilevers (E2 = 50 GPa, no gap): the penalty from 10 to 10¹¹ N/mm³. What is off is so from the "
    "answer with multipliers at 10⁸ N/mm³.",
    PENALTIES,
    (PLAIN, OURS),
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
