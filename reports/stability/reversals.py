"""Load reversals: whether an answer depends on the way to it."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reports.stability.sweep import Found, Method, Picture, Sweep, curve
from reports.stability.two_bars import FORCE, answer, meshes, on_meshes, two_bars
from reports.stability.wording import number, share
from rodmodel.contact import ActiveSet

# Up, down past zero, and up again, in parts of the load
FACTORS = (0.2, 0.4, 0.6, 0.8, 1.0, 0.8, 0.6, 0.4, 0.2, -0.5, -1.0, -0.5, 0.2, 0.4, 0.6, 0.8, 1.0)
GAP = 0.5
PLAIN = Method("one contact iteration an increment", ours=False)
OURS, NO_GAP = Method("rod model, gap 0.5 mm"), Method("rod model, no gap")


def measure(values: tuple[float, ...]) -> Found:
    """Contact force at every step of the path, and how far it is from the first answer at the same load."""
    ours = [answer(two_bars(gap=GAP, force=FORCE * value)).force for value in values]
    closed = [answer(two_bars(force=FORCE * value)).force for value in values]
    plain = _incremental(values)
    steps = range(1, len(values) + 1)
    methods = {PLAIN.name: plain, OURS.name: ours, NO_GAP.name: closed}
    return {
        "path": {name: curve(steps, forces) for name, forces in methods.items()},
        "return": {name: curve(steps, _changes(values, forces)) for name, forces in methods.items()},
        "load": {NO_GAP.name: curve(steps, values)},
    }


def _changes(values: tuple[float, ...], forces: list[float]) -> list[float]:
    """Difference from the first answer at the same load, relative to the largest."""
    return [abs(force - forces[values.index(value)]) / max(forces) for value, force in zip(values, forces, strict=True)]


def _incremental(values: tuple[float, ...]) -> list[float]:
    """Contact force where every increment takes the points of the last one and corrects them once."""
    scene = two_bars(gap=GAP)
    problem = on_meshes(scene, meshes(scene), multipliers=False).problem
    joined = np.zeros(len(problem.gap), dtype=bool)
    forces = []
    for value in values:
        now = replace(problem, gap=GAP + value * (problem.gap - GAP))
        force, _ = ActiveSet(joined, now).respond(now.gap, now.motion_load)
        opening = now.gap + now.compliance @ force
        joined = np.where(joined, force > 0.0, opening < 0.0)
        force, _ = ActiveSet(joined, now).respond(now.gap, now.motion_load)
        forces.append(float(force.sum()))
    return forces


def _proportional(found: Found) -> float:
    """Largest relative deviation from proportionality of the force without a gap."""
    forces, loads = found["path"][NO_GAP.name].y, found["load"][NO_GAP.name].y
    slopes = [force / load for force, load in zip(forces, loads, strict=True) if load > 0.0]
    return max(abs(slope / slopes[0] - 1.0) for slope in slopes)


def claim(found: Found) -> str:
    """The path does not matter."""
    back, plain = found["return"], found["return"][PLAIN.name]
    same = "to the last bit" if back[OURS.name].largest == 0.0 else f"within {share(back[OURS.name].largest)}"
    return (
        f"The rod model solves every load from nothing, so that returning to a load returns to its answer {same}. "
        "Without a gap the zone does not depend on the size of the load, and the force is proportional to it within "
        f"{share(_proportional(found))}, and zero while the load pulls the bars apart. A solver that corrects its "
        f"contact points once an increment is off by up to {share(plain.largest)} on the way back, and its force can "
        f"even pull ({number(min(found['path'][PLAIN.name].y))} N)."
    )


def own_limit(found: Found) -> str:
    """None."""
    return (
        "None here: contact is frictionless and displacements are small, so there is no history to lose. What a load "
        f"history costs is one solve a load ({len(found['path'][OURS.name].x)} here)."
    )


def holds(found: Found) -> bool:
    """Ours return to the last bit and are proportional without a gap; the plain one is not path independent."""
    pulled = [
        force
        for force, load in zip(found["path"][NO_GAP.name].y, found["load"][NO_GAP.name].y, strict=True)
        if load < 0
    ]
    ours = all(found["return"][each.name].largest == 0.0 for each in (OURS, NO_GAP))
    return ours and _proportional(found) < 1e-6 and not any(pulled) and found["return"][PLAIN.name].largest > 1e-3


SWEEP = Sweep(
    "Load reversals",
    "The two cantilevers (E2 = 50 GPa): the load is put on in steps, taken off, reversed and put on again.",
    FACTORS,
    (PLAIN, OURS, NO_GAP),
    (
        Picture("path", "Contact force along the path", "step", "N", log_x=False, log_y=False),
        Picture(
            "return", "Difference from the first answer at the same load", "step", "part of the largest", log_x=False
        ),
    ),
    measure,
    claim,
    own_limit,
    holds,
)
