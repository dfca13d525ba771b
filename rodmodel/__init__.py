"""Hierarchic rod model h1, h2, ...: p-version rods in frictionless penalty contact.

    import rodmodel as rm
    solution = rm.solve(rm.Scene(...), level=5, order=6)

Needs numpy, scipy and the plain data of `cases.scene`, whose names it re-exports.
"""

from cases.scene import (
    Bed,
    Box,
    Circle,
    Clamp,
    ContactPair,
    GapTable,
    Gravity,
    Ground,
    Helix,
    Joint,
    Line,
    LineLoad,
    Material,
    Orthotropic,
    Path,
    Polygon,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RodEnd,
    RodFace,
    RoundGap,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
    Spline,
    Support,
)
from rodmodel.adaptive import AdaptiveSolution, Estimate, solve_to
from rodmodel.section_properties import SectionProperties, section_properties
from rodmodel.solution import ContactPoints, Cost, Solution
from rodmodel.solver import solve

__all__ = [
    "AdaptiveSolution",
    "Bed",
    "Box",
    "Circle",
    "Clamp",
    "ContactPair",
    "ContactPoints",
    "Cost",
    "Estimate",
    "GapTable",
    "Gravity",
    "Ground",
    "Helix",
    "Joint",
    "Line",
    "LineLoad",
    "Material",
    "Orthotropic",
    "Path",
    "Polygon",
    "Pressure",
    "Rectangle",
    "Ring",
    "Rod",
    "RodEnd",
    "RodFace",
    "RoundGap",
    "Scene",
    "SceneError",
    "SectionForce",
    "SectionMoment",
    "SectionProperties",
    "Solution",
    "Spline",
    "Support",
    "section_properties",
    "solve",
    "solve_to",
]
