"""Stiffness ratio of the two bars over eight decades."""

from __future__ import annotations

import math

from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import answer, beam_theory, two_bars
from reports.stability.wording import number, share

RATIOS = tuple(float(10.0 ** (0.5 * half)) for half in range(-8, 9))
SOFT = 1e4
BEAMS = Method("beams touching at a corner", ours=False)
PLAIN = Method("plain penalty, 10⁴ N/mm³", ours=False)
OURS = Method("multipliers")


def measure(values: tuple[float, ...]) -> Found:
    """Contact force, contact solutions and penetration against the ratio."""
    ours = [answer(two_bars(ratio=value)) for value in values]
    plain = [answer(two_bars(ratio=value, penalty=SOFT), multipliers=False) for value in values]
    return {
        "force": {
            BEAMS.name: curve(values, (beam_theory(value, 0.0) for value in values)),
            PLAIN.name: curve(values, (each.force for each in plain)),
            OURS.name: curve(values, (each.force for each in ours)),
        },
        "apart": {
            BEAMS.name: curve(
                values,
                (abs(beam_theory(value, 0.0) / each.force - 1.0) for value, each in zip(values, ours, strict=True)),
            ),
            PLAIN.name: curve(
                values, (abs(one.force / each.force - 1.0) for one, each in zip(plain, ours, strict=True))
            ),
        },
        "solutions": {
            PLAIN.name: curve(values, (each.solutions for each in plain)),
            OURS.name: curve(values, (each.solutions for each in ours)),
        },
        "penetration": {
            PLAIN.name: curve(values, (each.penetration for each in plain)),
            OURS.name: curve(values, (each.penetration for each in ours)),
        },
        "converged": {
            PLAIN.name: curve(values, (float(each.outcome == "converged") for each in plain)),
            OURS.name: curve(values, (float(each.outcome == "converged") for each in ours)),
        },
    }


def _off_beams(found: Found) -> float:
    """Largest relative difference from beam theory where it has an answer."""
    ours, beams = found["force"][OURS.name], found["force"][BEAMS.name]
    return max(
        abs(one / other - 1.0)
        for one, other in zip(ours.y, beams.y, strict=True)
        if not math.isnan(other) and other > 0.0
    )


def claim(found: Found) -> str:
    """Nothing happens."""
    force, solutions = found["force"][OURS.name], found["solutions"][OURS.name]
    return (
        f"From E2 / E1 = {number(force.x[0])}, where the upper bar hangs over the end of the lower one, to "
        f"{number(force.x[-1])}, where its own end just touches, the contact force falls from {force.y[0]:.0f} N to "
        f"{number(force.y[-1])} N; {sum(found['converged'][OURS.name].y):.0f} of {len(force.x)} solves converge, in "
        f"{min(solutions.y):.0f} to {solutions.largest:.0f} contact solutions. Where beams touch at a corner, beam "
        f"theory differs by at most {share(_off_beams(found))} (it leaves out shear). A plain penalty that suits one "
        "ratio does not suit another: it lets the bars penetrate by up to "
        f"{number(found['penetration'][PLAIN.name].largest)} mm, multipliers by "
        f"{number(found['penetration'][OURS.name].largest)} mm."
    )


def own_limit(found: Found) -> str:
    """Corners."""
    corners = len(found["force"][BEAMS.name].sizes)
    return (
        f"At {corners} of the {len(found['force'][OURS.name].x)} ratios the bars touch at a corner. Contact there is a "
        "point with a singular pressure: what is said of its stretch is the shortest length that is looked for, 0.2 "
        "mm here, and its pressure means nothing. The force holds."
    )


def holds(found: Found) -> bool:
    """All converge and agree with beam theory within what shear adds."""
    return (
        all(found["converged"][OURS.name].y)
        and _off_beams(found) < 0.05
        and found["penetration"][PLAIN.name].largest > 1e3 * found["penetration"][OURS.name].largest
    )


SWEEP = Sweep(
    "Stiffness ratio",
    "The two cantilevers without a gap: Young's modulus of the upper one over that of the lower one from 10⁻⁴ to 10⁴.",
    RATIOS,
    (BEAMS, PLAIN, OURS),
    (
        Picture("force", "Contact force", "E2 / E1", "N"),
        Picture("apart", "How far the others are from multipliers", "E2 / E1", "relative difference"),
        Picture("solutions", "Contact solutions", "E2 / E1", "solutions", log_y=False),
        Picture("penetration", "Penetration", "E2 / E1", "largest, mm"),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
