"""Pressure at the edges of contact and its derivatives."""

from dataclasses import replace

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import LineLoad, Rectangle, Scene, SectionForce
from rodmodel.assembly import ElementStore
from rodmodel.borders import Rates, border_plan, edge_rates, natural_mesh, placed_meshes
from rodmodel.edge_pressure import EdgePressures, edge_pressures, edge_slopes
from rodmodel.stretches import Stretch, moved, moving_edges
from rodmodel.symmetry import scene_mirrors
from rodmodel.system import ContactSystem, contact_system

LEVEL, ORDER = 3, 5


def scene_with(change: str) -> Scene:
    """The paper's third case, changed so that each term of the derivatives matters."""
    scene = load_case("two-cantilevers-e20-g0").scene
    lower, upper = scene.rods
    if change == "load in the zone":
        # It holds a border of the upper rod alone: contact points slide along the other's elements.
        return replace(scene, loads=(SectionForce("upper", 50.0, (0.0, -500.0, 0.0)),))
    if change == "spread load":
        return replace(scene, loads=(*scene.loads, LineLoad("lower", 200.0, 300.0, (0.0, 8.0, 0.0))))
    if change == "soft springs":
        return replace(scene, contacts=(replace(scene.contacts[0], penalty=1e3),))
    if change == "second rod runs against the first":
        line = replace(upper.centre_line, start=(500.0, 15.0, 0.0), end=(200.0, 15.0, 0.0))
        supports = (scene.supports[0], replace(scene.supports[1], end="start"))
        load = SectionForce("upper", 300.0 - 166.67, (0.0, -1000.0, 0.0))
        borders = tuple(round(300.0 - border, 2) for border in reversed(upper.element_borders))
        turned = replace(upper, centre_line=line, element_borders=borders)
        return replace(scene, rods=(lower, turned), supports=supports, loads=(load,))
    if change == "narrower second rod":
        return replace(scene, rods=(lower, replace(upper, section=Rectangle(12.0, 15.0))))
    return scene


@pytest.mark.parametrize(
    "change",
    [
        "nothing",
        "load in the zone",
        "spread load",
        "soft springs",
        "second rod runs against the first",
        "narrower second rod",
    ],
)
@pytest.mark.parametrize("ends", [(236.0, 262.5), (200.0, 245.0)])
def test_slopes_are_those_of_pressures_with_moved_edges(change: str, ends: tuple[float, float]) -> None:
    scene = scene_with(change)
    mirrors, store = scene_mirrors(scene), ElementStore()
    natural = {rod.name: natural_mesh(scene, rod, LEVEL, ORDER) for rod in scene.rods}
    stretches = (Stretch("overlap", *ends),)
    edges, positions = moving_edges(scene, stretches)
    plan = border_plan(scene, natural, edges, positions)

    def system_at(at: np.ndarray) -> tuple[ContactSystem, dict[str, Rates]]:
        meshes = placed_meshes(plan, at)
        return contact_system(scene, mirrors, meshes, store, multipliers=False), edge_rates(plan, at)

    def pressures(at: np.ndarray) -> np.ndarray:
        return edge_pressures(system_at(at)[0], moved(stretches, edges, at), edges).value

    system, rates = system_at(positions)
    slopes = edge_slopes(edge_pressures(system, stretches, edges), edges, rates)

    step = 1e-3 * np.eye(len(edges))
    differences = np.array([(pressures(positions + each) - pressures(positions - each)) / 2e-3 for each in step]).T
    # Central differences over 1e-3 mm: round-off of pressures, about 1e-8 MPa, makes 1e-5 MPa/mm.
    np.testing.assert_allclose(slopes, differences, rtol=1e-4, atol=5e-5)


def test_with_multipliers_slopes_at_the_end_of_a_short_stretch_are_close() -> None:
    """Adjoint forces of rigid points, as the forces are: with those of the springs the slope is 14 % off."""
    scene = load_case("two-cantilevers-e50-g05").scene
    mirrors, store = scene_mirrors(scene), ElementStore()
    natural = {rod.name: natural_mesh(scene, rod, 5, 6) for rod in scene.rods}
    stretches = (Stretch("overlap", 200.0, 207.4),)
    edges, positions = moving_edges(scene, stretches)
    plan = border_plan(scene, natural, edges, positions)

    def pressures(shift: float) -> EdgePressures:
        at = positions + shift
        system = contact_system(scene, mirrors, placed_meshes(plan, at), store)
        return edge_pressures(system, moved(stretches, edges, at), edges)

    slope = edge_slopes(pressures(0.0), edges, edge_rates(plan, positions))
    difference = (pressures(0.02).value - pressures(-0.02).value) / 0.04
    # Three steps of the multipliers; more would bring it closer, and no edge sooner.
    assert slope[0, 0] == pytest.approx(difference[0], rel=0.03)
