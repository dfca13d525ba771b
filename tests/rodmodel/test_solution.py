"""What a solved scene says of one bar, against closed forms of beam theory and equilibrium."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

import rodmodel as rm
from rodmodel.adapt import graded
from rodmodel.section import elasticity_matrix

AREA, MOMENT_OF_AREA, YOUNG = 15.0**2, 15.0**4 / 12.0, 200e3


def test_stretched_bar(cantilever: Callable[..., rm.Scene]) -> None:
    """F L / (E A); without lateral contraction no clamp disturbs it."""
    solution = rm.solve(cantilever((5000.0, 0.0, 0.0), poisson=0.0), level=2, order=2)
    end = solution.displacement("bar", np.array([300.0]))[:, 0]
    np.testing.assert_allclose(end, [5000.0 * 300.0 / (YOUNG * AREA), 0.0, 0.0], atol=1e-12)


@pytest.mark.parametrize("force", [(0.0, -1000.0, 0.0), (0.0, 0.0, 700.0)])
def test_bent_bar_follows_timoshenko(cantilever: Callable[..., rm.Scene], force: tuple[float, float, float]) -> None:
    """F L^3 / (3 E I) + F L / (k G A) with k = 5/6, Timoshenko's value for the rectangle at nu = 0."""
    solution = rm.solve(cantilever(force, poisson=0.0), level=3, order=4)
    end = solution.displacement("bar", np.array([300.0]))[:, 0]
    size = 300.0**3 / (3.0 * YOUNG * MOMENT_OF_AREA) + 300.0 / (5.0 / 6.0 * YOUNG / 2.0 * AREA)
    np.testing.assert_allclose(end, np.array(force) * size, rtol=2e-5, atol=1e-14)  # the clamp holds the warping


@pytest.mark.parametrize("level", [1, 2, 5])
def test_slender_bar_does_not_lock(cantilever: Callable[..., rm.Scene], level: int) -> None:
    """L / h = 1000; the clamp's hold on the contraction reaches one h far: short elements there, and 0.1 % is left."""
    solution = rm.solve(graded(cantilever((0.0, -0.01, 0.0), length=15000.0)), level=level, order=4)
    end = solution.displacement("bar", np.array([15000.0]))[1, 0]
    assert end == pytest.approx(-0.01 * 15000.0**3 / (3.0 * YOUNG * MOMENT_OF_AREA), rel=1e-3)


def test_first_level_locks_with_the_full_law(
    cantilever: Callable[..., rm.Scene], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without the quadratic terms the section cannot contract: sigma_s = (lambda + 2 mu) eps, 1.346 E at nu = 0.3."""
    scene = cantilever((0.0, -1000.0, 0.0), length=3000.0)
    reduced = rm.solve(scene, level=1, order=4).displacement("bar", np.array([3000.0]))[1, 0]
    monkeypatch.setattr("rodmodel.section.elasticity_matrix", lambda material, level: elasticity_matrix(material, 2))
    full = rm.solve(scene, level=1, order=4).displacement("bar", np.array([3000.0]))[1, 0]
    assert full / reduced == pytest.approx(1.3 * 0.4 / 0.7, rel=1e-3)  # shear, which does not lock, is 1e-4 of it


def test_resultants_balance_the_load(cantilever: Callable[..., rm.Scene]) -> None:
    """Stations in a middle element, where what the clamp disturbs has died away; it leaves 1e-5 on this mesh."""
    solution = rm.solve(graded(cantilever((300.0, -1000.0, 0.0), elements=6)), level=3, order=6)
    station = np.array([170.0, 180.0])
    normal, shear_1, shear_2, moment_1, moment_2, torque = solution.section_resultants("bar", station)
    # e1 = -Z, e2 = Y, t = X: the force's components on the cut are N = 300, Q2 = -1000
    np.testing.assert_allclose(normal, 300.0, rtol=1e-5)
    np.testing.assert_allclose(shear_2, -1000.0, rtol=1e-5)
    np.testing.assert_allclose(moment_1, 1000.0 * (300.0 - station), rtol=1e-5)
    np.testing.assert_allclose([shear_1, moment_2, torque], 0.0, atol=1e-6)


def test_reaction_balances_the_load_to_round_off(cantilever: Callable[..., rm.Scene]) -> None:
    solution = rm.solve(cantilever((300.0, -1000.0, 50.0)), level=3, order=4)
    expected = [-300.0, 1000.0, -50.0, 0.0, 50.0 * 300.0, 1000.0 * 300.0]
    np.testing.assert_allclose(solution.reaction("bar", 0.0), expected, rtol=1e-9, atol=1e-5)


def test_energy_is_half_the_work_of_the_load(cantilever: Callable[..., rm.Scene]) -> None:
    solution = rm.solve(cantilever((0.0, -1000.0, 0.0)), level=3, order=4)
    end = solution.displacement("bar", np.array([300.0]))[1, 0]
    # The load works on the mean over the section; the centre moves a little otherwise where the load bulges it.
    assert solution.strain_energy == pytest.approx(-0.5 * 1000.0 * end, rel=1e-6)


@pytest.mark.parametrize("section", [rm.Ring(20.0, 16.0), rm.Box(20.0, 15.0, 2.0)])
def test_the_deflection_of_a_hollow_section_is_its_mean(
    cantilever: Callable[..., rm.Scene], section: rm.Ring | rm.Box
) -> None:
    """The mean is what an evenly spread force works on: the energy is half of force times it."""
    scene = cantilever((300.0, -1000.0, 200.0), length=60.0)
    hollow = replace(scene, rods=(replace(scene.rods[0], section=section),))

    solution = rm.solve(hollow, level=4, order=5)

    end = solution.displacement("bar", np.array([60.0]))[:, 0]
    assert solution.strain_energy == pytest.approx(0.5 * np.array([300.0, -1000.0, 200.0]) @ end, rel=1e-10)


def test_bending_stress_on_the_surface(cantilever: Callable[..., rm.Scene]) -> None:
    solution = rm.solve(graded(cantilever((0.0, -1000.0, 0.0), elements=6)), level=3, order=6)
    stress = solution.stress("bar", np.array([[0.0], [7.5], [175.0]]))[:, 0]
    expected = 1000.0 * 125.0 * 7.5 / MOMENT_OF_AREA
    # Normal stresses alone: Saint-Venant's shear over a square is no polynomial, and h3 misses it by a tenth there.
    np.testing.assert_allclose(stress[:3], [0.0, 0.0, expected], atol=1e-5 * expected)  # rest of the clamp


def test_displacement_is_continuous_and_clamped(cantilever: Callable[..., rm.Scene]) -> None:
    solution = rm.solve(cantilever((0.0, -1000.0, 0.0)), level=4, order=4)
    points = np.array([[3.0, 3.0, 2.0, 2.0], [7.0, 7.0, -4.0, -4.0], [100.0 - 1e-9, 100.0 + 1e-9, 0.0, 0.0]])
    moved = solution.displacement_at("bar", points)
    np.testing.assert_allclose(moved[:, 0], moved[:, 1], atol=1e-9)
    np.testing.assert_array_equal(moved[:, 2], 0.0)


def test_an_unheld_rod_is_refused_by_name(cantilever: Callable[..., rm.Scene]) -> None:
    loose = replace(cantilever((0.0, -1.0, 0.0)), supports=())
    with pytest.raises(rm.SceneError, match="'bar'"):
        rm.solve(loose)


def test_a_rod_in_another_direction_gives_the_same_answer(cantilever: Callable[..., rm.Scene]) -> None:
    """Rotating scene and load rotates the displacement."""
    angle = 0.7
    turn = np.array([[np.cos(angle), -np.sin(angle), 0.0], [np.sin(angle), np.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    scene = cantilever((100.0, -1000.0, 70.0))
    line = rm.Line((0.0, 0.0, 0.0), tuple(turn @ [300.0, 0.0, 0.0]), tuple(turn @ [0.0, 1.0, 0.0]))
    load = replace(scene.loads[0], force=tuple(turn @ scene.loads[0].force))
    turned = replace(scene, rods=(replace(scene.rods[0], centre_line=line),), loads=(load,))
    station = np.array([50.0, 300.0])
    here = rm.solve(scene, level=2, order=4).displacement("bar", station)
    there = rm.solve(turned, level=2, order=4).displacement("bar", station)
    np.testing.assert_allclose(there, turn @ here, atol=1e-9)
