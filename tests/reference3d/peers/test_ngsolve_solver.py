"""NGSolve as a peer: closed forms, equilibrium, and the paper's cases against independent 3D values."""

import json
from dataclasses import replace
from importlib.resources import files

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import (
    Bed,
    Circle,
    Clamp,
    ContactPair,
    Gravity,
    Ground,
    Helix,
    Line,
    LineLoad,
    Material,
    Pressure,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
    SectionMoment,
)
from reference3d.peers import ngsolve_solver
from reference3d.peers.answer import NotInstalled
from reference3d.peers.ngsolve_grading import COARSE, graded, is_symmetric
from reference3d.peers.ngsolve_tuned import TUNED

ngsolve_there = pytest.mark.skipif(ngsolve_solver.installed() != "", reason="NGSolve is not installed")

LENGTH, E = 120.0, 70000.0
SECTION = Rectangle(10.0, 16.0)
AREA, INERTIA = 160.0, 10.0 * 16.0**3 / 12.0


def one_rod(*loads, poisson_ratio=0.0, line=None, clamp=None, contacts=(), beds=()):
    line = line or Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0))
    rod = Rod("rod", line, SECTION, Material(E, poisson_ratio, 3e-9), (0.0, line.length))
    return Scene("one rod", (rod,), (clamp or Clamp("rod", "start"),), loads, contacts, beds=beds)


def solved(scene, stations=(LENGTH,)):
    hexahedra = graded(scene, COARSE)
    return ngsolve_solver.solve(scene, {rod.name: np.array(stations) for rod in scene.rods}, hexahedra)


@ngsolve_there
def test_bending_by_an_end_moment_askew_in_space_is_exact_without_poissons_ratio():
    tangent = np.array([2.0, 1.0, 2.0]) / 3.0
    e2 = np.array([-2.0, 2.0, 1.0]) / 3.0
    e1 = np.cross(e2, tangent)
    start = np.array([5.0, -3.0, 8.0])
    line = Line(tuple(start), tuple(start + LENGTH * tangent), tuple(e2))
    moment = 4e4
    s = np.array([30.0, 77.0, LENGTH])

    found = solved(one_rod(SectionMoment("rod", LENGTH, tuple(moment * e1)), line=line), s)

    # a positive moment about e1 turns t towards -e2; the quadratic field is within the elements' polynomials
    expected = -np.outer(e2, moment * s**2 / (2.0 * E * INERTIA))
    assert found.displacement["rod"] == pytest.approx(expected, rel=1e-8, abs=1e-10)
    reaction = np.concatenate([np.zeros(3), -moment * e1])
    assert found.reactions["rod", 0.0] == pytest.approx(reaction, rel=1e-8, abs=1e-4)


@ngsolve_there
def test_a_clamp_that_moves_takes_the_rod_along():
    displacement, rotation = np.array([0.3, -0.2, 0.1]), np.array([0.01, 0.02, -0.015])
    clamp = Clamp("rod", "end", tuple(displacement), tuple(rotation))
    s = np.array([0.0, 50.0])

    found = solved(one_rod(poisson_ratio=0.3, clamp=clamp), s)

    arm = np.array([s - LENGTH, 0.0 * s, 0.0 * s])
    expected = displacement[:, None] + np.cross(rotation, arm, axisb=0, axisc=0)
    assert found.displacement["rod"] == pytest.approx(expected, abs=1e-10)
    assert found.reactions["rod", LENGTH] == pytest.approx(np.zeros(6), abs=1e-4)


@ngsolve_there
def test_a_cantilever_sags_as_timoshenko_says():
    force = -100.0

    found = solved(one_rod(SectionForce("rod", LENGTH, (0.0, force, 0.0))))

    # kappa = 5/6: shear is 1.5 % of the deflection here; at the clamp and the free end, where the section cannot warp
    # as it would, some 0.02 % is lost
    expected = force * LENGTH**3 / (3.0 * E * INERTIA) + force * LENGTH / (5.0 / 6.0 * E / 2.0 * AREA)
    assert found.displacement["rod"][1, 0] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("load", "force", "moment"),
    [
        (SectionForce("rod", 50.0, (1.0, 2.0, 3.0)), (1.0, 2.0, 3.0), (0.0, -150.0, 100.0)),
        (SectionMoment("rod", 60.0, (400.0, 500.0, 600.0)), (0.0, 0.0, 0.0), (400.0, 500.0, 600.0)),
        (LineLoad("rod", 20.0, 60.0, (0.5, -1.0, 0.25)), (20.0, -40.0, 10.0), (0.0, -400.0, -1600.0)),
        (Pressure(RodFace("rod", "top"), 10.0, 40.0, 0.2), (0.0, -60.0, 0.0), (0.0, 0.0, -1500.0)),
        # e1 = e2 x t points against Z, so that the right face looks that way and is pushed along Z
        (Pressure(RodFace("rod", "right"), 0.0, 50.0, 0.1), (0.0, 0.0, 80.0), (0.0, -2000.0, 0.0)),
        (
            Gravity("rod", (0.0, -9810.0, 0.0)),
            (0.0, -9810.0 * 3e-9 * AREA * LENGTH, 0.0),
            (0.0, 0.0, -9810.0 * 3e-9 * AREA * LENGTH**2 / 2.0),
        ),
    ],
    ids=lambda value: type(value).__name__ if not isinstance(value, tuple) else "",
)
@ngsolve_there
def test_the_clamp_holds_every_load(load, force, moment):
    found = solved(one_rod(load, poisson_ratio=0.3))

    assert -found.reactions["rod", 0.0] == pytest.approx((*force, *moment), rel=1e-9, abs=1e-7)


@ngsolve_there
def test_half_a_section_answers_as_the_whole():
    case = "two-cantilevers-e20-g05"
    scene, half = load_case(case).scene, TUNED[case, 0.1]
    whole = replace(
        half,
        symmetric=False,
        grids={name: replace(grid, x=np.array([-7.5, 0.0, 7.5])) for name, grid in half.grids.items()},
    )
    stations = {"upper": np.array([0.0, 150.0])}

    one, other = (ngsolve_solver.solve(scene, stations, hexahedra) for hexahedra in (half, whole))

    # round-off of a penalty of 1e5 elastic moduli a section's side
    assert half.symmetric
    assert is_symmetric(scene)
    assert one.contact_force["overlap"] == pytest.approx(other.contact_force["overlap"], rel=1e-6, abs=1e-6)
    assert one.contact_centre["overlap"] == pytest.approx(other.contact_centre["overlap"], abs=1e-4)
    assert one.displacement["upper"] == pytest.approx(other.displacement["upper"], rel=1e-6, abs=1e-9)
    assert one.reactions["upper", 300.0] == pytest.approx(other.reactions["upper", 300.0], rel=1e-6, abs=1e-4)


@ngsolve_there
def test_a_rod_drawn_the_other_way_around_answers_the_same():
    scene = load_case("two-cantilevers-e20-g05").scene
    upper = scene.rod("upper")
    line = replace(upper.centre_line, start=upper.centre_line.end, end=upper.centre_line.start)
    turned = replace(
        scene,
        rods=(scene.rod("lower"), replace(upper, centre_line=line)),
        supports=(scene.supports[0], Clamp("upper", "start")),
        loads=(replace(scene.loads[0], position=300.0 - scene.loads[0].position),),
    )
    touching = {"overlap": (230.0, 260.0)}

    one, other = (ngsolve_solver.solve(of, {}, graded(of, COARSE, touching)) for of in (scene, turned))

    # the meshes differ by round-off, which a stiff contact makes more of
    assert other.contact_force["overlap"] == pytest.approx(one.contact_force["overlap"], rel=1e-6, abs=1e-6)
    assert other.reactions["upper", 0.0] == pytest.approx(one.reactions["upper", 300.0], rel=1e-6, abs=1e-3)


@pytest.mark.slow
@pytest.mark.parametrize("case", ["e50_g05", "e20_g0"])
@ngsolve_there
def test_the_papers_cases_as_other_3d_solvers_have_them(case):
    truth = json.loads(files("cases").joinpath("truth", f"{case}.json").read_text(encoding="utf-8"))
    scene = load_case(f"two-cantilevers-{case.replace('_', '-')}").scene
    curves = {"lower": (truth["deflection_bar1_mm"], 0.0), "upper": (truth["deflection_bar2_mm"], 200.0)}

    found = ngsolve_solver.solve(scene, {rod: np.array(x) - start for rod, ((x, _), start) in curves.items()})

    # what this mesh reaches at its singular clamps; the truth's own uncertainty is 0.005 %, 0.01 mm and 0.01 %
    assert found.outcome == "converged"
    assert found.contact_force["overlap"][1] == pytest.approx(truth["contact_force_N"], rel=2e-4)
    assert found.contact_centre["overlap"][0] == pytest.approx(truth["contact_centre_mm"], abs=0.015)
    clamp_moment = abs(found.reactions["upper", 300.0][5])
    assert clamp_moment == pytest.approx(truth["clamp_moment_bar2_equilibrium_Nmm"], rel=2e-4)
    for rod, ((_, deflection), _) in curves.items():
        off = np.abs(found.displacement[rod][1] - deflection).max()
        assert off < 3e-4 * np.abs(deflection).max()


@ngsolve_there
def test_rods_that_cross_press_on_each_other_in_balance():
    scene = load_case("crossed-cantilevers").scene

    found = solved(scene, (150.0,))

    # by Bernoulli's beams 81.3 N; shear, torsion and the local yielding of 3D take 1.3 % off
    force = found.contact_force["crossing"]
    assert not is_symmetric(scene)
    assert force[1] == pytest.approx(81.3, rel=0.03)
    assert found.reactions["lower", 0.0][:3] == pytest.approx(force, abs=1e-6)
    assert found.reactions["upper", 0.0][:3] == pytest.approx(np.array([0.0, 150.0, 0.0]) - force, abs=1e-6)


@ngsolve_there
def test_a_bed_that_pulls_and_one_that_cannot_carry_a_pressed_rod_alike():
    load = LineLoad("rod", 0.0, LENGTH, (0.0, -3.0, 0.0))
    face, modulus = RodFace("rod", "bottom"), 5.0
    pulling = one_rod(load, beds=(Bed(face, 0.0, LENGTH, modulus),))
    pushing = one_rod(load, contacts=(ContactPair("bed", face, Ground(modulus), (0.0, LENGTH), 0.0),))
    s = np.array([60.0, LENGTH])

    hexahedra = graded(pushing, COARSE)
    expected, found = (
        ngsolve_solver.solve(scene, {"rod": s}, hexahedra).displacement["rod"] for scene in (pulling, pushing)
    )

    # the rod is pressed down all along; both integrate with points that are exact for the polynomials
    assert expected[1].max() < -0.01
    assert found == pytest.approx(expected, rel=1e-8, abs=1e-12)


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"section": Circle(10.0)}, "rods.rod.section"),
        (
            {"centre_line": Line((0.0, 0.0, 0.0), (LENGTH, 0.0, 0.0), (0.0, 1.0, 0.0), 0.1)},
            "rods.rod.centre_line.twist",
        ),
        (
            {
                "centre_line": Helix((100.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 1.2, (0.0, 0.0, 1.0)),
            },
            "rods.rod.centre_line",
        ),
    ],
)
@ngsolve_there
def test_what_it_is_not_given_is_refused_by_key(change, key):
    scene = one_rod()
    scene = replace(scene, rods=(replace(scene.rods[0], **change),))

    with pytest.raises(SceneError) as refusal:
        ngsolve_solver.solve(scene, {})

    assert refusal.value.key == key


def test_its_absence_is_said_in_one_sentence(monkeypatch):
    monkeypatch.setattr(ngsolve_solver, "find_spec", lambda name: None)

    assert "pip install" in ngsolve_solver.installed()
    with pytest.raises(NotInstalled, match="NGSolve is not installed"):
        ngsolve_solver.solve(one_rod(), {})
