"""A chart made up by hand, so that what must come of it is plain."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from reports.chart.points import NGSOLVE_TUNED, ROD_GRADED, SOLID, Chart, Point, Reference


def made_up(method: str, label: str, seconds: float, force: float, deflection: float, unknowns: int = 100) -> Point:
    values = {("contact_force", "pair"): (force,), ("largest_deflection", "rod"): (deflection,)}
    return Point(method, label, "converged", unknowns, (seconds, 2.0 * seconds, 0.5 * seconds), "processor", values)


@pytest.fixture
def point() -> Callable[..., Point]:
    """Makes a configuration."""
    return made_up


@pytest.fixture
def chart() -> Chart:
    """References 100 N, certain to 0.01 %, and 2 mm, certain to 0.05 %; peak pressures are singular."""
    points = (
        made_up(ROD_GRADED, "h1, p = 3, graded", 0.010, 100.5, 2.001, 300),
        made_up(ROD_GRADED, "h3, p = 3, graded", 0.020, 100.05, 2.001, 900),
        made_up(ROD_GRADED, "h5, p = 3, graded", 0.040, 100.02, 2.0001, 1500),
        made_up(NGSOLVE_TUNED, "mesh tuned to 0.1 %", 0.080, 100.005, 2.001, 800),
        made_up(SOLID, "mesh 3 of 3", 5.0, 100.001, 2.0, 90_000),
    )
    references = {
        "contact_force": Reference({"pair": (100.0,)}, 1e-4),
        "largest_deflection": Reference({"rod": (2.0,)}, 5e-4),
        "peak_pressure": Reference({}, None, "pair: singular at X = 0 mm, so that no mesh gives its value"),
    }
    return Chart("Made <up>", points, references, ("A note.",))
