"""Independent 3D values (`cases/truth/*.json`, see its README) as estimates of the compared quantities."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from cases.scene import Line, Rod, Scene
from reports.comparison import Estimate
from reports.quantities import PressureProfile
from reports.solution import Array

SOURCE = "3D values made outside this project"


@dataclass(frozen=True)
class IndependentValues:
    """What an independent 3D solution says of a scene.

    Attributes
    ----------
    estimates : by quantity and the rod or pair it belongs to; a deflection is u_Y, mm, shape (n,)
    stations : of each deflection, arc length from the rod's start, mm, shape (n,)
    pressure : by pair
    """

    estimates: Mapping[tuple[str, str], Estimate]
    stations: Mapping[str, Array]
    pressure: Mapping[str, PressureProfile]


def independent_values(path: Path, scene: Scene) -> IndependentValues:
    """Read the values that `path` holds for a scene: bar N is the scene's N-th rod, the pair its first.

    Raises
    ------
    OSError, ValueError
        if the file cannot be read or is not of the described form.
    """
    data: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    doubt = data["uncertainty"]
    estimates: dict[tuple[str, str], Estimate] = {}
    stations: dict[str, Array] = {}
    pressure: dict[str, PressureProfile] = {}
    for number, rod in enumerate(scene.rods, start=1):
        if (curve := data.get(f"deflection_bar{number}_mm")) is not None:
            position, deflection = np.array(curve, dtype=float)
            stations[rod.name] = _stations(rod, position, path)
            uncertainty = doubt["deflection_relative"] * float(np.abs(deflection).max())
            estimates["deflection", rod.name] = Estimate(deflection, uncertainty)
    if scene.contacts and "contact_force_N" in data:
        name = scene.contacts[0].name
        force, centre = data["contact_force_N"], data["contact_centre_mm"]
        force_doubt, centre_doubt = doubt["contact_force_relative"] * force, doubt["contact_centre_mm"]
        estimates["contact_force", name] = Estimate(np.array([force]), force_doubt)
        estimates["contact_centre", name] = Estimate(np.array([centre]), centre_doubt)
        edges = np.ravel(data["edges_middle_mm"]).astype(float)
        estimates["contact_edges", name] = Estimate(edges, doubt["edges_middle_mm"])
        edges = np.ravel(data["edges_outer_mm"]).astype(float)
        estimates["contact_edges_outer", name] = Estimate(edges, doubt["edges_outer_mm"])
        columns = ("position_mm", "middle_MPa", "mean_MPa", "outer_MPa")
        pressure[name] = PressureProfile(*(np.array(data["pressure"][column], dtype=float) for column in columns))
    return IndependentValues(estimates, stations, pressure)


def _stations(rod: Rod, position: Array, path: Path) -> Array:
    """Arc lengths of the points of a rod along X whose X is given, mm."""
    line = rod.centre_line
    if not isinstance(line, Line) or line.start[1:] != line.end[1:]:
        raise ValueError(f"{path.name} holds values along X, but the centre line of rod '{rod.name}' is not along X")
    return np.abs(position - line.start[0])
