"""What the parts of a scene check themselves with: in one sentence, what is wrong and what would be right."""

from __future__ import annotations

import math

import numpy as np

Vector = tuple[float, float, float]


class SceneError(ValueError):
    """A scene that cannot be what its author meant, said in one sentence.

    Attributes
    ----------
    key : where in the scene, as one would say it of the case file: "rods.lower.element_borders", or
        "loads #1.force" for the first of the loads
    found : what was found there
    remedy : what would be right
    """

    def __init__(self, key: str, found: str, remedy: str) -> None:
        super().__init__(f"{key}: found {found}; {remedy}")
        self.key = key
        self.found = found
        self.remedy = remedy


def require(condition: bool, key: str, found: object, remedy: str) -> None:
    """Raise a SceneError unless the condition holds."""
    if not condition:
        raise SceneError(key, str(found), remedy)


def require_positive(value: float, key: str, what: str) -> None:
    """Raise a SceneError unless the value is finite and positive."""
    require(math.isfinite(value) and value > 0.0, key, f"{value:g}", f"{what} must be positive")


def require_finite(vector: Vector, key: str) -> None:
    """Raise a SceneError unless the vector has three finite components."""
    ok = len(vector) == 3 and bool(np.all(np.isfinite(vector)))
    require(ok, key, list(vector), "three finite numbers are needed")
