"""Gap from deep interference to never touching."""

from __future__ import annotations

import math
from itertools import pairwise

from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import RATIO, Answer, answer, beam_theory, two_bars
from reports.stability.wording import number, share

GAPS: tuple[float, ...] = (-14.0, -12.0, -10.0, -7.0, -5.0, -3.0, -2.0, -1.0, -0.5, -0.2, 0.0, 0.2, 0.5, 0.8, 1.0)
GAPS += (2.0, 4.0, 6.0, 8.0, 9.0, 10.0, 10.5, 11.0, 12.0, 15.0)
SOFT = 1e4
BEAMS = Method("beams touching at a corner", ours=False)
PLAIN = Method("plain penalty, 10⁴ N/mm³", ours=False)
OURS = Method("multipliers")


def measure(values: tuple[float, ...]) -> Found:
    """Contact force, contact solutions and the edge against the gap."""
    ours = [answer(two_bars(gap=value)) for value in values]
    plain = [answer(two_bars(gap=value, penalty=SOFT), multipliers=False) for value in values]
    return {
        "force": {
            BEAMS.name: curve(values, (beam_theory(RATIO, value) for value in values)),
            PLAIN.name: curve(values, (each.force for each in plain)),
            OURS.name: curve(values, (each.force for each in ours)),
        },
        "apart": {
            BEAMS.name: curve(
                values, (_apart(beam_theory(RATIO, value), each) for value, each in zip(values, ours, strict=True))
            ),
            PLAIN.name: curve(values, (_apart(one.force, each) for one, each in zip(plain, ours, strict=True))),
        },
        "edge": {
            PLAIN.name: curve(values, (each.edge for each in plain)),
            OURS.name: curve(values, (each.edge for each in ours)),
        },
        "solutions": {
            PLAIN.name: curve(values, (each.solutions for each in plain)),
            OURS.name: curve(values, (each.solutions for each in ours)),
        },
        "converged": {OURS.name: curve(values, (float(each.outcome == "converged") for each in ours))},
    }


def _apart(force: float, ours: Answer) -> float:
    """Relative difference of a contact force from ours; nan where there is none."""
    return abs(force / ours.force - 1.0) if ours.force > 0.0 else math.nan


def _ends(found: Found) -> tuple[float, float]:
    """Largest gap with contact and smallest without."""
    ours = found["force"][OURS.name]
    touching = max(x for x, y in zip(ours.x, ours.y, strict=True) if y > 0.0)
    return touching, min((x for x in ours.x if x > touching), default=math.inf)


def claim(found: Found) -> str:
    """The force falls steadily to zero."""
    ours, solutions, edge = found["force"][OURS.name], found["solutions"][OURS.name], found["edge"]
    touching, open_ = _ends(found)
    apart = max(
        abs(one - other)
        for one, other in zip(edge[OURS.name].y, edge[PLAIN.name].y, strict=True)
        if not math.isnan(one) and not math.isnan(other)
    )
    return (
        f"From an interference of {-ours.x[0]:g} mm to a gap of {ours.x[-1]:g} mm the contact force falls steadily "
        f"from {ours.y[0]:.0f} N to exactly 0, which it is from a gap between {touching:g} and {open_:g} mm on; "
        f"{sum(found['converged'][OURS.name].y):.0f} of {len(ours.x)} solves converge, in {min(solutions.y):.0f} to "
        f"{solutions.largest:.0f} contact solutions, while the stretch in contact goes from the end of the lower bar "
        f"to that of the upper. Where corners touch, beam theory is within {share(_off_beams(found))} of the largest "
        f"force. A plain penalty has its edge up to {number(apart)} mm elsewhere."
    )


def _off_beams(found: Found) -> float:
    """Largest difference from beam theory where it has an answer, relative to the largest force."""
    ours, beams = found["force"][OURS.name], found["force"][BEAMS.name]
    pairs = zip(ours.y, beams.y, strict=True)
    return max((abs(one - other) for one, other in pairs if not math.isnan(other)), default=0.0) / ours.largest


def own_limit(found: Found) -> str:
    """What small displacements leave out."""
    solutions = found["solutions"][OURS.name]
    most = max(zip(solutions.y, solutions.x, strict=True))
    return (
        f"The search takes most contact solutions, {most[0]:.0f}, at a gap of {most[1]:g} mm. Displacements count as "
        f"small: an interference of {-solutions.x[0]:g} mm, more than the bars are thick, is solved without a word, "
        "though it makes no sense. Nothing detects that."
    )


def holds(found: Found) -> bool:
    """All converge; the force falls steadily to zero and agrees with beam theory at corners."""
    ours = found["force"][OURS.name]
    falling = all(after < before or after == before == 0.0 for before, after in pairwise(ours.y))
    return falling and ours.y[-1] == 0.0 and all(found["converged"][OURS.name].y) and _off_beams(found) < 0.02


SWEEP = Sweep(
    "Gap",
    "The two cantilevers (E2 = 50 GPa): the gap from −14 mm, an interference nearly as deep as the bars are high, to "
    "15 mm, where they never touch.",
    GAPS,
    (BEAMS, PLAIN, OURS),
    (
        Picture("force", "Contact force", "gap, mm", "N", log_x=False, log_y=False),
        Picture("apart", "How far the others are from multipliers", "gap, mm", "relative difference", log_x=False),
        Picture("edge", "Farther edge of contact", "gap, mm", "X, mm", log_x=False, log_y=False),
        Picture("solutions", "Contact solutions", "gap, mm", "solutions", log_x=False, log_y=False),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
