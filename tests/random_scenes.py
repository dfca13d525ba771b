"""Random scenes of rods in contact, seeded: stacks of two to four bars, some loose, some on ground, some crossing."""

from __future__ import annotations

from typing import Any

import numpy as np

from cases.scene import (
    Box,
    Clamp,
    ContactPair,
    Gravity,
    Ground,
    Line,
    LineLoad,
    Material,
    Rectangle,
    Rod,
    RodFace,
    RoundGap,
    Scene,
    SectionForce,
    Support,
)

# Log10 of the range of Young's moduli, MPa.
MODULI = (1.5, 5.5)
# What a bar may be held by: nothing at all is left to contact.
HOLDS = ("start", "end", "start", "end", "both", "none")


def random_scene(seed: int) -> Scene:
    """A scene for a seed; every bar lies on the one before it, or across it."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 5))
    rods: list[Rod] = []
    top = 0.0
    start = 0.0
    for number in range(count):
        length = float(rng.uniform(60.0, 300.0))
        width, height = (float(size) for size in rng.uniform(5.0, 20.0, 2))
        crossing = number == count - 1 and rng.random() < 0.15
        line = _line(rng, rods, start, length, top + 0.5 * height, crossing)
        wall = 0.25 * min(width, height)
        section = Box(width, height, wall) if rng.random() < 0.2 else Rectangle(width, height)
        material = Material(float(10.0 ** rng.uniform(*MODULI)), float(rng.uniform(0.0, 0.45)), density=7.85e-9)
        elements = int(rng.integers(2, 7))
        borders = tuple(np.linspace(0.0, line.length, elements + 1).tolist())
        rods.append(Rod(f"bar {number}", line, section, material, borders))
        top += height
        start += float(rng.uniform(-0.4, 0.4)) * length
    pairs = [pair for number in range(1, count) for pair in _pair(rng, rods[number - 1], rods[number])]
    if rng.random() < 0.4:
        pairs.append(_on_ground(rng, rods[0]))
    return Scene(f"random {seed}", tuple(rods), _supports(rng, rods), _loads(rng, rods), tuple(pairs))


def _line(
    rng: np.random.Generator, rods: list[Rod], start: float, length: float, height: float, crossing: bool
) -> Line:
    if crossing:
        below = rods[-1].centre_line.end_points
        middle = below[0][0] + float(rng.uniform(0.2, 0.8)) * (below[1][0] - below[0][0])
        angle = float(rng.uniform(0.6, 2.5))
        along = 0.5 * length * np.array([np.cos(angle), 0.0, np.sin(angle)])
        centre = np.array([middle, height, float(rng.uniform(-3.0, 3.0))])
        return Line(tuple((centre - along).tolist()), tuple((centre + along).tolist()), (0.0, 1.0, 0.0))
    aside = float(rng.choice([0.0, 0.0, rng.uniform(-2.0, 2.0)]))
    ends = (start, height, aside), (start + length, height, aside)
    return Line(*(ends if rng.random() < 0.7 else ends[::-1]), (0.0, 1.0, 0.0))


def _pair(rng: np.random.Generator, lower: Rod, upper: Rod) -> list[ContactPair]:
    """Contact over a part of what the bars share; nothing where they share next to nothing."""
    ends = np.array(lower.centre_line.end_points)[:, 0]
    sense = np.sign(ends[1] - ends[0])
    along = np.sort(sense * (np.array(upper.centre_line.end_points)[:, 0] - ends[0]))
    low, high = max(0.0, along[0]), min(lower.length, along[1])
    crossing = abs(upper.centre_line.end_points[1][2] - upper.centre_line.end_points[0][2]) > 1.0
    if crossing:
        low, high = 0.0, lower.length
    if high - low < 8.0:
        return []
    if not crossing and rng.random() < 0.5:
        share = np.sort(rng.uniform(0.0, 1.0, 2))
        low, high = low + share * (high - low) if np.ptp(share) > 0.2 else (low, high)
    gap: Any = float(rng.choice([0.0, rng.uniform(0.0, 0.5), -0.01 * rng.random()]))
    if rng.random() < 0.1:
        gap = RoundGap(float(10.0 ** rng.uniform(3.0, 4.0)), float(rng.uniform(low, high)))
    penalty = None if rng.random() < 0.7 else float(10.0 ** rng.uniform(3.0, 7.0))
    faces = RodFace(lower.name, "top"), RodFace(upper.name, "bottom")
    return [ContactPair(f"{lower.name} and {upper.name}", *faces, (float(low), float(high)), gap, penalty)]


def _on_ground(rng: np.random.Generator, rod: Rod) -> ContactPair:
    ground = Ground(None if rng.random() < 0.5 else float(10.0 ** rng.uniform(-1.0, 3.0)))
    gap = float(rng.choice([0.0, rng.uniform(0.0, 1.0)]))
    return ContactPair("ground", RodFace(rod.name, "bottom"), ground, (0.0, rod.length), gap)


def _supports(rng: np.random.Generator, rods: list[Rod]) -> tuple[Clamp | Support, ...]:
    supports: list[Clamp | Support] = []
    for rod in rods:
        hold = str(rng.choice(HOLDS))
        if hold == "none":
            # Loose but for sliding and turning away, which frictionless contact cannot hold.
            supports.append(Support(rod.name, 0.5 * rod.length, ("x", "s", "turn y"), "mean"))
        else:
            supports += [Clamp(rod.name, "start")] if hold in ("start", "both") else []
            supports += [Clamp(rod.name, "end")] if hold in ("end", "both") else []
    return tuple(supports)


def _loads(rng: np.random.Generator, rods: list[Rod]) -> tuple[SectionForce | LineLoad | Gravity, ...]:
    loads: list[SectionForce | LineLoad | Gravity] = []
    for _ in range(int(rng.integers(1, 4))):
        rod = rods[int(rng.integers(0, len(rods)))]
        size = float(10.0 ** rng.uniform(-1.0, 3.0)) * (-1.0 if rng.random() < 0.8 else 1.0)
        across = float(rng.choice([0.0, 0.0, 0.1 * size]))
        if rng.random() < 0.7:
            loads.append(SectionForce(rod.name, float(rng.uniform(0.0, rod.length)), (0.0, size, across)))
        else:
            start, end = np.sort(rng.uniform(0.0, rod.length, 2)).tolist()
            if end - start > 1.0:
                loads.append(LineLoad(rod.name, start, end, (0.0, size / rod.length, 0.0)))
    if rng.random() < 0.3:
        loads += [Gravity(rod.name, (0.0, -9810.0, 0.0)) for rod in rods]
    return tuple(loads)
