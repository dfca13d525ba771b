"""A case: a scene, the rod model's settings for it, and what its results are held against.

Case files are read by `cases.loader`; what a quantity is and how it is evaluated stands in `reports`.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from cases.scene import Scene, Vector

Quantity = Literal[
    "contact_force",
    "contact_centre",
    "contact_edges",
    "contact_edges_outer",
    "deflection",
    "bending_moment",
    "end_moment_equilibrium",
    "max_bending_stress",
    "stress_s",
]


@dataclass(frozen=True)
class QuantityKind:
    """How a case file speaks of a quantity.

    Attributes
    ----------
    of : whether it belongs to a rod or to a contact pair
    unit : of its values
    relative : whether its tolerance is a fraction (of the value; of a curve's largest value) or a length
    comparable : whether rod and 3D reference may be held against each other by it. The largest bending stress
        is not: it is the stress of a finite element solution at a singular section, and grows without bound.
    publishable : whether a number or a list of numbers states it; of the deflection, one of its components at a place
    """

    of: Literal["rod", "contact"]
    unit: Literal["N", "mm", "N mm", "MPa"]
    relative: bool
    comparable: bool = True
    publishable: bool = True


QUANTITIES: Mapping[Quantity, QuantityKind] = {
    "contact_force": QuantityKind("contact", "N", relative=True),
    "contact_centre": QuantityKind("contact", "mm", relative=False),
    "contact_edges": QuantityKind("contact", "mm", relative=False),
    "contact_edges_outer": QuantityKind("contact", "mm", relative=False),
    "deflection": QuantityKind("rod", "mm", relative=True),
    "bending_moment": QuantityKind("rod", "N mm", relative=True, publishable=False),
    "end_moment_equilibrium": QuantityKind("rod", "N mm", relative=True),
    "max_bending_stress": QuantityKind("rod", "MPa", relative=True, comparable=False),
    "stress_s": QuantityKind("rod", "MPa", relative=True, publishable=False),
}


Axis = Literal["X", "Y", "Z"]


# A level or an order: the same everywhere, or by the name of every rod one for each element.
Grades = int | Mapping[str, tuple[int, ...]]


@dataclass(frozen=True)
class RodModelSettings:
    """How the rod model solves the case.

    Parameters
    ----------
    level : k of h_k, the degree of the polynomials over the section; by rod name, one for each element, where they
        differ
    order : p, the order of the shape functions along the rod; likewise
    """

    level: Grades
    order: Grades


@dataclass(frozen=True)
class Check:
    """A quantity by which the rod model is held against the 3D reference.

    Parameters
    ----------
    quantity : its name
    of : name of the rod or contact pair it belongs to
    tolerance : largest difference that passes: a fraction where `QUANTITIES[quantity].relative`, else in mm
    point : (x, y, s) in the rod's section coordinates and arc length, mm; for `stress_s` alone
    """

    quantity: Quantity
    of: str
    tolerance: float
    point: Vector | None = None


@dataclass(frozen=True)
class Published:
    """A value printed in a source, kept as printed.

    Parameters
    ----------
    quantity : its name
    of : name of the rod or contact pair it belongs to
    value : in the quantity's unit; one number, or start and end of each stretch in contact in turn
    tolerance : as in `Check`
    source : where it is printed
    position : arc length where a deflection is published, mm; None for other quantities
    axis : global axis along which it is
    """

    quantity: Quantity
    of: str
    value: tuple[float, ...]
    tolerance: float
    source: str
    position: float | None = None
    axis: Axis | None = None


@dataclass(frozen=True)
class Case:
    """A scene and what its results are held against.

    Parameters
    ----------
    name : of the case file, without folder and ending
    title : one line
    description : a paragraph, may be empty
    compare : what rod model and 3D reference are held against each other by
    published : values from the literature
    independent : file in `cases/truth` with 3D values made outside this project, if there is one
    text : the case file itself; '' for a case that was made otherwise
    """

    name: str
    title: str
    description: str
    scene: Scene
    rod_model: RodModelSettings
    compare: tuple[Check, ...]
    published: tuple[Published, ...]
    independent: Path | None
    text: str = ""
