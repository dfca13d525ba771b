"""CalculiX on decks: how its words are read, how failures are told, and its answers beside the 3D reference's."""

import json
import math
from importlib.resources import files

import numpy as np
import pytest

from cases.loader import load_case
from cases.scene import (
    Bed,
    Clamp,
    ContactPair,
    Ground,
    Helix,
    Joint,
    Line,
    Material,
    Orthotropic,
    Rectangle,
    Rod,
    RodEnd,
    RodFace,
    Scene,
    SectionForce,
    SectionMoment,
    Support,
)
from reference3d.peers import calculix
from reference3d.peers.answer import NotInstalled
from reference3d.peers.calculix_output import complaint, increments, read_dat, unknowns
from reference3d.solid_solver import solve_solid

with_ccx = pytest.mark.skipif(calculix.installed() != "", reason=calculix.MISSING)

STEEL = Material(2e5, 0.3, 7.85e-9)
SQUAT = Rectangle(8.0, 10.0)
WOOD = Orthotropic((500.0, 900.0, 11000.0), (700.0, 600.0, 50.0), (0.4, 0.02, 0.03))

DAT = """
 displacements (vx,vy,vz) for set ALL_NODES and time  0.5000000E+00

         1  1.000000E+00  1.000000E+00  1.000000E+00

 displacements (vx,vy,vz) for set ALL_NODES and time  0.1000000E+01

         1  0.000000E+00  2.000000E-03 -1.500000-101
         3  1.000000E+00  0.000000E+00  0.000000E+00

 forces (fx,fy,fz) for set ALL_NODES and time  0.1000000E+01

         1 -5.000000E-01  0.000000E+00  0.000000E+00

 statistics for slave set FIRST_A, master set SECOND_B and time  0.1000000E+01

   total surface force (fx,fy,fz) and moment about the origin (mx,my,mz)

    0.000000E+00 -4.000000E+00  0.000000E+00  0.000000E+00  0.000000E+00 -8.000000E+02

   center of gravity and mean normal

    1.900000E+02  7.500000E+00  1.000000E+00  0.000000E+00  1.000000E+00  0.000000E+00

   moment about the center of gravity(mx,my,mz)

    1.000000E+00  1.000000E+00  1.000000E+00

   area,  normal force (+ = tension) and shear force (size)

    1.000000E+02 -4.000000E+00  1.000000E-16
"""


def test_the_last_increment_is_read_node_by_node(tmp_path):
    (tmp_path / "deck.dat").write_text(DAT)

    found = read_dat(tmp_path / "deck.dat")

    assert found.displacements[1] == pytest.approx([0.0, 2e-3, -1.5e-101])
    assert found.displacements[3] == pytest.approx([1.0, 0.0, 0.0])
    assert np.isnan(found.displacements[2]).all()
    assert found.forces[1] == pytest.approx([-0.5, 0.0, 0.0])
    contact = found.contacts["FIRST_A"]
    assert contact.force == pytest.approx([0.0, -4.0, 0.0])
    assert contact.moment == pytest.approx([0.0, 0.0, -800.0])
    assert contact.middle == pytest.approx([190.0, 7.5, 1.0])


def test_a_file_without_displacements_is_no_answer(tmp_path):
    (tmp_path / "deck.dat").write_text("\n")

    with pytest.raises(ValueError, match="no displacements"):
        read_dat(tmp_path / "deck.dat")


def test_only_increments_that_converged_count(tmp_path):
    (tmp_path / "deck.sta").write_text(
        "SUMMARY OF JOB INFORMATION\n  STEP      INC     ATT  ITRS     TOT TIME     STEP TIME      INC TIME\n"
        "     1          1     1    14  0.100000E+01  0.100000E+01  0.100000E+01\n"
        "     1          2     1U   60  0.999999E+00  0.999999E+00  0.100000E-05\n"
    )

    assert increments(tmp_path / "deck.sta") == [1.0]


def test_errors_and_numbers_of_equations_are_found_in_what_it_says():
    told = " number of equations\n 15960\n\n *ERROR: increment size smaller\n         than minimum\n best solution\n"

    assert unknowns(told) == 15960
    assert complaint(told) == "increment size smaller than minimum best solution"
    assert complaint("Job finished") == ""


@pytest.fixture
def program(tmp_path, monkeypatch):
    """Puts a shell script in the place of ccx."""

    def install(script):
        path = tmp_path / "bin" / "ccx"
        path.parent.mkdir()
        path.write_text(f"#!/bin/sh\n{script}\n")
        path.chmod(0o755)
        monkeypatch.setenv("PATH", f"{path.parent}:/usr/bin:/bin")

    return install


@pytest.mark.parametrize(
    ("script", "outcome"),
    [
        ("echo ' *ERROR reading *STEP: no such thing'; exit 201", "refused: reading *STEP: no such thing"),
        ("exit 3", "refused: CalculiX ended early with exit code 3"),
        ("exec sleep 20", "refused: not done within 0.3 s"),
        ("echo 'zero-size increment is appended'; echo 'Job finished'", "refused: CalculiX found tension in contact"),
    ],
)
def test_a_run_that_fails_says_what_happened(program, tmp_path, script, outcome):
    program(script)

    run = calculix.run_deck("*HEADING\n", tmp_path, time_limit=0.3)

    assert run.outcome == outcome


def test_without_the_program_it_says_how_to_get_it(monkeypatch, tmp_path):
    monkeypatch.setenv("PATH", str(tmp_path))

    assert "calculix-ccx" in calculix.installed()
    with pytest.raises(NotInstalled, match="apt-get install calculix-ccx"):
        calculix.solve(Scene("none", (bar("bar"),), (Clamp("bar", "start"),), (), ()), {"bar": np.zeros(1)})


def bar(name, end=(60.0, 0.0, 0.0), start=(0.0, 0.0, 0.0), section=SQUAT, material=STEEL):
    line = Line(start, end, (0.0, 1.0, 0.0))
    return Rod(name, line, section, material, (0.0, line.length))


def cantilever():
    loads = (SectionForce("bar", 60.0, (3.0, -100.0, 30.0)), SectionMoment("bar", 40.0, (500.0, 0.0, 100.0)))
    return Scene("cantilever", (bar("bar"),), (Clamp("bar", "start"),), loads, ())


def askew():
    """A bar that lies along no axis, moved by its clamp, held in its own frame and by a mean, on a bed."""
    rod = bar("bar", (60.0, 30.0, 20.0))
    supports = (
        Clamp("bar", "start", (0.1, 0.0, 0.0), (0.0, 0.0, 1e-3)),
        Support("bar", 40.0, ("x", "y"), displacement=(0.0, 0.05)),
        Support("bar", rod.length, ("y", "turn s"), "mean", (0.2, 0.01)),
    )
    loads = (SectionForce("bar", 55.0, (10.0, -100.0, 30.0)),)
    return Scene("askew", (rod,), supports, loads, (), (), (Bed(RodFace("bar", "bottom"), 10.0, 30.0, 5.0),))


def joined():
    """A bar and an arc of wood, joined at right angles."""
    rod = bar("bar")
    arc = Rod("arc", Helix((60, 0, 0), (60, 0, 40), (1, 0, 0), 1.0, (1, 0, 0)), Rectangle(6.0, 6.0), WOOD, (0.0, 40.0))
    joint = Joint((RodEnd("bar", "end"), RodEnd("arc", "start")))
    loads = (SectionForce("arc", 40.0, (1.0, -10.0, 3.0)),)
    return Scene("joined", (rod, arc), (Clamp("bar", "start"),), loads, (), (joint,))


# Largest differences, of the largest value: bricks with 20 nodes and reduced integration against 27 nodes on one mesh.
# Forces on sections that are held inside a rod follow the mesh, by 5e-3 to the next finer one. The axes of the arc's
# wood turn in steps from layer to layer, which makes 1.6e-2, and a quarter of that on the next finer mesh.
@pytest.mark.slow
@with_ccx
@pytest.mark.parametrize(
    ("scene", "tolerance", "of_reactions"), [(cantilever(), 2e-4, 1e-5), (askew(), 2e-4, 2e-3), (joined(), 2e-2, 1e-5)]
)
def test_without_contact_it_agrees_with_the_3d_reference_on_the_same_mesh(scene, tolerance, of_reactions):
    stations = {rod.name: np.linspace(0.0, rod.length, 7) for rod in scene.rods}

    found, ours = calculix.solve(scene, stations), solve_solid(scene, 1)

    assert found.outcome == "converged"
    for name, station in stations.items():
        expected = ours.displacement(name, station)
        assert np.abs(found.displacement[name] - expected).max() < tolerance * np.abs(expected).max()
    reaction, expected = found.reactions["bar", 0.0], ours.reaction("bar", 0.0)
    for part in (slice(3), slice(3, 6)):
        assert np.abs(reaction[part] - expected[part]).max() < of_reactions * np.abs(expected[part]).max()
    assert found.peak_memory > 1.0
    assert found.unknowns > 1000


@with_ccx
@pytest.mark.slow
def test_on_a_bed_that_cannot_pull_it_agrees_with_the_3d_reference():
    pair = ContactPair("bed", RodFace("bar", "bottom"), Ground(3.0), (20.0, 60.0), 0.01)
    scene = Scene("bed", (bar("bar"),), (Clamp("bar", "start"),), (SectionForce("bar", 60.0, (0, -500, 30)),), (pair,))

    found, ours = calculix.solve(scene, {"bar": np.array([60.0])}), solve_solid(scene, 1)

    points = ours.contact_points("bed")
    centre = points.position @ points.force / points.force.sum()
    assert found.outcome == ours.outcome == "converged"
    # as without contact: on the same bed and mesh other elements give 2e-5
    assert found.contact_force["bed"] == pytest.approx(points.normal @ points.force, rel=1e-4, abs=1e-3)
    # normal to the force
    assert found.contact_centre["bed"][[0, 2]] == pytest.approx(centre[[0, 2]], abs=1e-3)
    assert found.displacement["bar"] == pytest.approx(ours.displacement("bar", np.array([60.0])), rel=1e-4, abs=1e-5)


@with_ccx
@pytest.mark.slow
def test_the_papers_bars_with_a_gap_come_out_as_elsewhere():
    case = load_case("two-cantilevers-e20-g05")
    truth = json.loads(files("cases").joinpath("truth", "e20_g05.json").read_text(encoding="utf-8"))
    curve = np.array(truth["deflection_bar2_mm"])

    found = calculix.solve(case.scene, {"lower": np.zeros(1), "upper": curve[0] - 200.0})

    assert found.outcome == "converged"
    # the coarsest of our meshes, in other elements: 0.024 % in force, 0.003 mm in its centre, 0.05 % in
    # deflection
    assert np.linalg.norm(found.contact_force["overlap"]) == pytest.approx(truth["contact_force_N"], rel=5e-4)
    assert found.contact_centre["overlap"][0] == pytest.approx(truth["contact_centre_mm"], abs=0.1)
    assert found.displacement["upper"][1] == pytest.approx(curve[1], abs=1e-3 * np.abs(curve[1]).max())
    moment = found.reactions["upper", 300.0][5]
    assert abs(moment) == pytest.approx(abs(truth["clamp_moment_bar2_equilibrium_Nmm"]), rel=5e-4)
    assert math.isclose(found.contact_force["overlap"][1] - 1000.0, -found.reactions["upper", 300.0][1], rel_tol=1e-5)
