"""A view of the deformed rods that turns in the browser: rod model and 3D side by side, stress or contact pressure.

Only surfaces go onto the page, their numbers rounded to 16 bits and both models on the same skin.
"""

from __future__ import annotations

import base64
from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
from markupsafe import Markup

from cases.scene import Scene
from reports.formatting import capital, number, rod_model
from reports.html import script_json
from reports.runner import CaseRun, Run
from reports.solution import Array
from reports.surface import IntArray, Skin, Surface, skin
from reports.view import drawn_shifts, magnification, view_plane

# Largest number of 16 bits with a sign.
LARGEST = 32767
# Colours end at the stress that this share of all points keeps within: at clamped corners stress is singular.
SHARE_OF_POINTS = 0.99


def turning_part(run: CaseRun) -> dict[str, Any] | None:
    """What the template `pages/turning.html.jinja` and its script need to know; None where nothing was kept to draw."""
    named = [(capital(rod_model(run.rod.level, run.rod.order)), run.rod)]
    named += [("3D, finest mesh", finest) for finest in run.references[-1:]]
    models = [(name, answer, answer.surface) for name, answer in named if answer.surface is not None]
    if not models:
        return None
    scene, factor = run.case.scene, magnification(run.rod.quantities)
    shifts = drawn_shifts(scene, run.rod.quantities, factor)
    skins = [skin(rod) for rod in scene.rods]
    drawn = [_drawn(scene, answer, kept, skins, shifts, factor) for _, answer, kept in models]
    points = np.hstack([part["position"] for parts in drawn for part in chain(parts["rods"], parts["faces"])])
    middle, half = 0.5 * (points.max(axis=1) + points.min(axis=1)), 0.5 * float(np.ptp(points, axis=1).max())
    stress = np.abs(np.concatenate([part["value"] for parts in drawn for part in parts["rods"]]))
    limit = float(np.quantile(stress, SHARE_OF_POINTS))
    pressures = [pressure for pressure in map(_largest_pressure, drawn) if pressure > 0.0]
    pressure = min(pressures, default=0.0)
    right, up = view_plane(scene, run.rod.quantities)

    def packed(part: dict[str, Array]) -> dict[str, Any]:
        scale = float(np.abs(part["value"]).max(initial=0.0)) or 1.0
        return {
            "position": _text(np.rint((part["position"] - middle[:, None]) / half * LARGEST).T, "<i2"),
            "value": _text(np.rint(part["value"] / scale * LARGEST), "<i2"),
            "scale": float(f"{scale:.6g}"),
        }

    data = {
        "reach": (np.ptp(points, axis=1) / (2.0 * half)).tolist(),
        "stress": limit or 1.0,
        "pressure": pressure or 1.0,
        "up": up.tolist(),
        "towards": _towards(right, up).tolist(),
        "size": [float(np.ptp(axis @ points)) / (2.0 * half) for axis in (right, up, np.cross(right, up))],
        "skins": [
            {
                "name": rod.name,
                "sections": len(found.station),
                "loops": found.loops,
                "cap": _text(found.cap, "<u4"),
                "corners": found.corners.tolist(),
            }
            for rod, found in zip(scene.rods, skins, strict=True)
        ],
        "models": [
            {
                "name": name,
                "rods": [packed(part) for part in parts["rods"]],
                "faces": [
                    packed(part) | {"triangles": _text(part["triangles"], "<u4")}
                    for part in parts["faces"]
                    if part["triangles"].size
                ],
            }
            for (name, _, _), parts in zip(models, drawn, strict=True)
        ],
    }
    text: Markup = script_json(data)
    return {
        "data": text,
        "factor": f"{factor:g}",
        "stress": number(limit, 3),
        "pressure": number(pressure, 3) if pressures else "",
        "alt": _alternative(models, drawn),
        "rows": _rows(models, drawn),
    }


def _drawn(
    scene: Scene, answer: Run, kept: Surface, skins: Sequence[Skin], shifts: dict[str, Array], factor: float
) -> dict[str, list[dict[str, Array]]]:
    """Deformed positions, as they are drawn, and values of all rods and faces of a model."""
    rods = []
    for rod, where, found in zip(scene.rods, skins, kept.rods, strict=True):
        along = answer.quantities.rod(rod.name)
        at = np.searchsorted(along.station, where.station - 1e-6 * rod.length)
        offset = np.einsum("nai,ca->inc", along.axes[at, :2], where.border)
        still = (along.position[:, at, None] + offset).reshape(3, -1)
        position = still + factor * found.displacement + shifts[rod.name][:, None]
        rods.append({"position": position, "value": found.stress_s})
    faces = [
        {
            "position": face.position + factor * face.displacement + shifts[pair.first.rod][:, None],
            "value": face.pressure,
            "triangles": face.triangles,
        }
        for pair, face in zip(scene.contacts, kept.faces, strict=True)
    ]
    return {"rods": rods, "faces": faces}


def _towards(right: Array, up: Array) -> Array:
    """From where the whole is seen, a unit vector: a little from above, as in the picture."""
    direction = np.cross(right, up) + 0.30 * up - 0.10 * right
    return np.asarray(direction / np.linalg.norm(direction))


def _largest_pressure(parts: dict[str, list[dict[str, Array]]]) -> float:
    return max((float(part["value"].max(initial=0.0)) for part in parts["faces"]), default=0.0)


def _text(values: Array | IntArray, kind: str) -> str:
    """Whole numbers, little-endian, in base 64."""
    return base64.b64encode(values.astype(kind).tobytes()).decode("ascii")


def _rows(
    models: Sequence[tuple[str, Run, Surface]], drawn: Sequence[dict[str, list[dict[str, Array]]]]
) -> list[tuple[str, str, str, str]]:
    """Of each model: smallest and largest stress along the rods, largest pressure."""
    rows = []
    for (name, _, _), parts in zip(models, drawn, strict=True):
        stress = np.concatenate([part["value"] for part in parts["rods"]])
        low, high, pressure = float(stress.min()), float(stress.max()), _largest_pressure(parts)
        rows.append((name, number(low, 4), number(high, 4), number(pressure, 4)))
    return rows


def _alternative(models: Sequence[tuple[str, Run, Surface]], drawn: Sequence[dict[str, list[dict[str, Array]]]]) -> str:
    names = " and ".join(name for name, _, _ in models)
    told = "; ".join(
        f"{name}: stress along the rods from {low} to {high} MPa, pressure up to {pressure} MPa"
        for name, low, high, pressure in _rows(models, drawn)
    )
    return f"Deformed rods in 3D, {names}. {told}."
