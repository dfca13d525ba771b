"""Hierarchic rod model h1, h2, ...: p-version rods in frictionless penalty contact.

    import rodmodel as rm
    solution = rm.solve(rm.Scene(...), level=5, order=6)

Needs numpy, scipy and the plain data of `cases.scene`, whose names it re-exports.
"""

from cases.scene import (
    Box,
    Circle,
    Clamp,
    ContactPair,
    Helix,
    Line,
    LineLoad,
    Material,
    Orthotropic,
    Polygon,
    Rectangle,
    Ring,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
)
from rodmodel.section_properties import SectionProperties, section_properties
from rodmodel.solution import ContactPoints, Cost, Solution
from rodmodel.solver import solve

__all__ = [
    "Box",
    "Circle",
    "Clamp",
    "ContactPair",
    "ContactPoints",
    "Cost",
    "Helix",
    "Line",
    "LineLoad",
    "Material",
    "Orthotropic",
    "Polygon",
    "Rectangle",
    "Ring",
    "Rod",
    "RodFace",
    "Scene",
    "SceneError",
    "SectionForce",
    "SectionMoment",
    "SectionProperties",
    "Solution",
    "section_properties",
    "solve",
]
