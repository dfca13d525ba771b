"""Conjugate gradients against the factor, where the factor is said not to fit into memory."""

import numpy as np
import pytest
from scipy.sparse import csr_array

from cases.scene import (
    Bed,
    Circle,
    Clamp,
    Helix,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SectionForce,
    Support,
)
from reference3d import solid_solver
from reference3d.holds import holds
from reference3d.solid_body import solid_body
from reference3d.solid_iterative import Grid, IterativeFactor, interpolation
from reference3d.solid_mirror import scene_mirrors
from reference3d.solid_responses import held_planes, share_factor
from reference3d.solid_solver import solve_solid

STEEL = Material(200e3, 0.3)
UP = (0.0, 1.0, 0.0)
SQUARE = Rectangle(6.0, 6.0)


def rod(line, section):
    return Rod("rod", line, section, STEEL, (0.0, line.length))


def supported():
    """A twisted bar with every kind of support, on a bed."""
    bar = rod(Line((0.0, 0.0, 0.0), (12.0, 0.0, 0.0), UP, 0.2), Rectangle(8.0, 6.0))
    supports = (
        Clamp("rod", "start", (0.01, 0.0, 0.0), (0.0, 0.001, 0.0)),
        Support("rod", 6.0, ("x", "turn y"), "mean", (0.002, 0.0)),
        Support("rod", 12.0, ("s",), "section"),
    )
    bed = Bed(RodFace("rod", "bottom"), 4.0, 8.0, 50.0)
    return Scene("supported", (bar,), supports, (SectionForce("rod", 9.0, (3.0, -20.0, 10.0)),), (), (), (bed,))


def say_too_large(monkeypatch):
    """Factors of planes with more unknowns than those of the coarsest mesh do not fit."""
    monkeypatch.setattr(solid_solver, "factor_bytes", lambda size, *_: 1e30 if size > 150 else 0.0)


@pytest.mark.slow
def test_conjugate_gradients_find_what_the_factor_does(monkeypatch):
    direct = solve_solid(supported(), 2)
    say_too_large(monkeypatch)

    iterated = solve_solid(supported(), 2)

    assert (direct.solver, iterated.solver) == ("direct", "conjugate gradients")
    # which takes the true residual to be small, not that of the recursion
    assert (direct.outcome, iterated.outcome) == ("converged", "converged")
    one, other = iterated.rods["rod"].nodal, direct.rods["rod"].nodal
    np.testing.assert_allclose(one, other, atol=1e-7 * np.abs(other).max())


@pytest.mark.slow
def test_a_mirrored_rod_has_the_compliance_that_its_factor_gives():
    """Of forces along the plane of symmetry on its free end, and of one on a node in its middle."""
    scene = Scene(
        "mirrored", (rod(Line((0.0, 0.0, 0.0), (12.0, 0.0, 0.0), UP), SQUARE),), (Clamp("rod", "start"),), (), ()
    )
    coarse, fine = (solid_body(scene, scene.rods[0], refinement) for refinement in (1, 2))
    mirrors = [scene_mirrors(scene, {"rod": body}, {"rod": holds(scene, body)}, [])["rod"] for body in (coarse, fine)]
    planes = [held_planes(holds(scene, body), mirror) for body, mirror in zip((coarse, fine), mirrors, strict=True)]
    factors = [share_factor(*each, []) for each in zip((coarse, fine), planes, mirrors, strict=True)]
    whole = held_planes(holds(scene, fine), None)
    iterative = IterativeFactor(Grid(fine, whole, mirrors[1]), factors[0], coarse.shape, interpolation(coarse, fine))
    load = np.zeros((3, *fine.shape))
    load[0, -1, :, 1] = load[1, -1, :, 2] = 1.0
    load[2, len(fine.points) // 2, np.argmin(np.abs(fine.section.nodes).sum(axis=1)), 1] = 1.0
    rows = csr_array(load.reshape(3, -1))

    np.testing.assert_allclose(iterative.compliance(rows), factors[1].compliance(rows), rtol=1e-6, atol=1e-12)


@pytest.mark.slow
def test_where_conjugate_gradients_do_not_converge_the_answer_is_refused(monkeypatch):
    say_too_large(monkeypatch)
    monkeypatch.setattr("reference3d.solid_iterative.MOST_STEPS", 2)

    solution = solve_solid(supported(), 2)

    assert solution.outcome.startswith("refused: forces are out of balance by")


@pytest.mark.parametrize("section", [Circle(8.0), Rectangle(8.0, 6.0)], ids=lambda each: type(each).__name__)
def test_rigid_motions_are_interpolated_and_work_is_the_same_on_both_meshes(section):
    line = Helix((30.0, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1.0), 1.0, (0.0, 0.0, 1.0))
    scene = Scene("arc", (rod(line, section),), (Clamp("rod", "start"),), (), ())
    coarse, fine = (solid_body(scene, scene.rods[0], refinement) for refinement in (1, 2))
    between = interpolation(coarse, fine)

    shift = [np.einsum("pbc,c->pb", body.axes, [1.0, 2.0, 3.0])[:, None, :, None] for body in (coarse, fine)]
    moved = [np.broadcast_to(each, (*body.shape, 1)) for each, body in zip(shift, (coarse, fine), strict=True)]
    force = np.random.default_rng(0).standard_normal((*fine.shape, 1))

    np.testing.assert_allclose(between.to_fine(moved[0]), moved[1], atol=1e-10)
    work = np.vdot(force, between.to_fine(moved[0]))
    assert np.vdot(between.to_coarse(force), moved[0]) == pytest.approx(work, rel=1e-12)
