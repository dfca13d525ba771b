"""Scenes solved as solids: beam theory, equilibrium, symmetry, contact conditions, refusals."""

import dataclasses
from dataclasses import replace

import numpy as np
import pytest

from cases.scene import (
    Clamp,
    ContactPair,
    Ground,
    Line,
    Material,
    Rectangle,
    Rod,
    RodFace,
    Scene,
    SceneError,
    SectionForce,
)
from reference3d import SolidSolution, body, solver
from reference3d.field import displacement
from reference3d.solver import solve

UP = (0.0, 1.0, 0.0)


def timoshenko_tip(force, length, section, modulus, ratio):
    """F L^3 / (3 E I) + F L / (kappa G A), kappa of G. R. Cowper, Journal of Applied Mechanics 33 (1966)."""
    inertia, area = section.width * section.height**3 / 12.0, section.width * section.height
    kappa = 10.0 * (1.0 + ratio) / (12.0 + 11.0 * ratio)
    shear_modulus = modulus / (2.0 * (1.0 + ratio))
    return force * length**3 / (3.0 * modulus * inertia) + force * length / (kappa * shear_modulus * area)


# nu = 0: the clamp does not hinder bending, only the warping of shear, a part h/L of the shear term;
# nu = 0.3: it hinders the lateral strain over a length of about h/4: 3 h / (4 L) nu^2 of the deflection
@pytest.mark.parametrize(("ratio", "tolerance"), [(0.0, 2e-4), (0.3, 3.5e-3)])
def test_a_cantilever_bends_as_beam_theory_with_shear_says(cantilever, ratio, tolerance):
    scene = cantilever((0.0, -100.0, 0.0), poisson_ratio=ratio)
    expected = timoshenko_tip(-100.0, 300.0, Rectangle(15.0, 15.0), 200000.0, ratio)

    tip = solve(scene).displacement("rod", np.array([300.0]))[1, 0]

    assert tip == pytest.approx(expected, rel=tolerance)


def test_a_pulled_rod_without_lateral_contraction_is_solved_exactly(cantilever):
    solution = solve(cantilever((500.0, 0.0, 0.0), poisson_ratio=0.0), 1)
    station = np.array([0.0, 100.0, 300.0])

    np.testing.assert_allclose(
        solution.displacement("rod", station)[0], 500.0 * station / (200000.0 * 225.0), rtol=1e-9, atol=1e-15
    )
    np.testing.assert_allclose(solution.section_resultants("rod", station)[0], 500.0, rtol=1e-9)


@pytest.mark.slow
def test_energy_of_a_cantilever_converges_as_the_clamp_singularity_allows(cantilever):
    """Energy error C h^(2 lambda), lambda = 0.711 at nu = 0.3: three meshes must show an order above 1.3.

    The grading towards the clamp improves the constant and, until it is exhausted, the order.
    """
    scene = cantilever((0.0, -100.0, 0.0), length=60.0)

    energies = [solve(scene, refinement).strain_energy for refinement in (1, 2, 4)]

    assert energies[0] < energies[1] < energies[2]  # a conforming method is too stiff
    assert np.log2((energies[1] - energies[0]) / (energies[2] - energies[1])) > 1.3


def test_work_of_the_load_is_twice_the_energy(cantilever):
    solution = solve(cantilever((0.0, -100.0, 30.0)), 1)
    nodal = solution.rods["rod"].field.nodal[-1]  # uniform traction: the mean displacement of the end section
    mean = _section_mean(solution.rods["rod"].field.borders, nodal)

    # local axes of this rod: e1 = -Z, e2 = Y
    assert 2.0 * solution.strain_energy == pytest.approx(-100.0 * mean[1] - 30.0 * mean[0], rel=1e-9)


def _section_mean(borders, nodal):
    # tensor product of Simpson's rule over the elements, exact for biquadratic fields
    weights = []
    for axis in (borders.y, borders.x):
        weight = np.zeros(2 * len(axis) - 1)
        for element, length in enumerate(np.diff(axis)):
            weight[2 * element : 2 * element + 3] += length * np.array([1.0, 4.0, 1.0]) / 6.0
        weights.append(weight / weight.sum())
    return np.einsum("j,i,jia->a", *weights, nodal)


@pytest.mark.parametrize(
    ("end", "up"), [((0.0, 0.0, 80.0), UP), ((48.0, 64.0, 0.0), (0.0, 0.0, 1.0)), ((-80.0, 0.0, 0.0), (0.0, 1.0, 1.0))]
)
def test_the_answer_does_not_depend_on_how_the_rod_lies_in_space(cantilever, end, up):
    line = Line((0.0, 0.0, 0.0), end, up)
    tangent = np.array(end) / 80.0
    e2 = np.array(up) - (np.array(up) @ tangent) * tangent
    e2 /= np.linalg.norm(e2)
    e1 = np.cross(e2, tangent)
    force = 30.0 * e1 - 100.0 * e2 + 50.0 * tangent
    reference = solve(cantilever((50.0, -100.0, -30.0), length=80.0), 1)  # there e1 = -Z, e2 = Y, t = X

    turned = solve(cantilever(tuple(force), end=line.end, up=up), 1)

    station = np.array([10.0, 80.0])
    in_reference = np.stack([[0.0, 0.0, -1.0], UP, [1.0, 0.0, 0.0]]) @ reference.displacement("rod", station)
    in_turned = np.stack([e1, e2, tangent]) @ turned.displacement("rod", station)
    np.testing.assert_allclose(in_turned, in_reference, atol=1e-10 * np.abs(in_reference).max())


def test_contact_forces_loads_and_reactions_are_in_equilibrium(paper_case, paper_solution):
    solution = paper_solution(paper_case, 1)

    contact = solution.contact_points("lower-upper")
    resultant = contact.normal @ contact.force
    moment = np.cross(contact.position.T, contact.normal.T).T @ contact.force
    lower, upper = solution.reaction("lower", 0.0), solution.reaction("upper", 300.0)

    # residuals of 1e-12 of nodal forces that are 1e5 N and act at up to 500 mm
    force, couple = 1e-6, 1e-3
    # the lower rod carries the contact force alone
    np.testing.assert_allclose(lower[:3], resultant, atol=force)
    np.testing.assert_allclose(lower[3:], moment, atol=couple)
    # the upper rod balances load, contact and clamp; moments about the clamp's section (500, 15, 0)
    np.testing.assert_allclose(upper[:3] + resultant + [0.0, -1000.0, 0.0], 0.0, atol=force)
    about_clamp = moment - np.cross([500.0, 15.0, 0.0], resultant)
    load_moment = np.cross([200.0 + 500.0 / 3.0 - 500.0, 0.0, 0.0], [0.0, -1000.0, 0.0])
    np.testing.assert_allclose(upper[3:] + about_clamp + load_moment, 0.0, atol=couple)
    assert solution.residual < 1e-10


@pytest.mark.slow
def test_moments_from_stress_and_from_equilibrium_agree(paper_solution):
    solution = paper_solution("e50_g0")
    contact = solution.contact_points("lower-upper")
    station = np.array([0.0, 3.0, 50.0, 100.0, 150.0])
    # about e1 = -Z: the contact force beyond the station presses the lower rod along -Y, top in tension
    expected = [contact.force @ (contact.position[0] - s) for s in station]

    found = solution.section_resultants("lower", station)

    # second order in elements of 9 mm; the shear force of a stress linear along the element is exact
    np.testing.assert_allclose(found[3], expected, rtol=2e-3)
    np.testing.assert_allclose(found[2], -contact.force.sum(), rtol=1e-6)


def test_the_symmetric_half_gives_the_full_solution(two_cantilevers, paper_solution, monkeypatch):
    scene, half = two_cantilevers(50000.0, 0.0), paper_solution("e50_g0", 1)
    monkeypatch.setattr(solver, "is_symmetric", lambda _: False)

    full = solve(scene, 1)

    assert full.cost.unknowns > 1.5 * half.cost.unknowns
    for rod in ("lower", "upper"):
        # displacements of 1 mm, round-off times the condition of a slender rod
        np.testing.assert_allclose(half.rods[rod].field.nodal, full.rods[rod].field.nodal, atol=1e-9)
        # moments of 5e4 N mm, sums of nodal forces of 1e5 N that carry residuals of 1e-12
        np.testing.assert_allclose(half.rods[rod].reaction, full.rods[rod].reaction, atol=1e-4)
    ours, theirs = half.contact_points("lower-upper"), full.contact_points("lower-upper")
    np.testing.assert_allclose(ours.position, theirs.position, atol=1e-9)
    np.testing.assert_allclose(ours.force, theirs.force, atol=1e-6)
    assert half.strain_energy == pytest.approx(full.strain_energy, rel=1e-10)


def test_contact_conditions_hold_at_every_node(paper_case, paper_solution):
    solution = paper_solution(paper_case, 1)
    contact = solution.contact_points("lower-upper")
    profile = solution.contact_profile("lower-upper")

    closed = contact.force > 0.0
    assert solution.outcome == "converged"
    assert closed.any()
    assert (contact.gap[~closed] >= 0.0).all()
    # the springs' penetration of 1e-5 mm is taken away; forces stay to 1e-6 of their sum
    assert np.abs(contact.gap[closed]).max() < 1e-9
    assert (profile.middle >= 0.0).all()
    assert (profile.station[0], profile.station[-1]) == pytest.approx((200.0, 300.0))


def test_gaps_are_those_of_the_displaced_faces(paper_solution):
    solution = paper_solution("e20_g05", 1)
    contact = solution.contact_points("lower-upper")
    at_middle = np.abs(contact.position[2]) < 1e-9
    x = contact.position[0, at_middle]

    faces = []
    for rod, offset, height in (("lower", 0.0, 7.5), ("upper", 200.0, -7.5)):
        field = solution.rods[rod].field
        points = np.stack([0 * x, np.full_like(x, height), x - offset])
        faces.append(displacement(field, points)[1])

    # round-off of displacements of 1 mm through the condition of the stiffness
    np.testing.assert_allclose(faces[1] - faces[0] + 0.5, contact.gap[at_middle], atol=1e-9)


def test_the_pressure_integrates_to_the_force(paper_case, paper_solution):
    solution = paper_solution(paper_case, 1)
    profile, points = solution.contact_profile("lower-upper"), solution.contact_points("lower-upper")

    # Simpson's rule over the elements, as the nodes' areas
    length = np.diff(profile.station[::2])
    integral = np.sum(length / 6.0 * (profile.mean[:-1:2] + 4.0 * profile.mean[1::2] + profile.mean[2::2]))

    assert 15.0 * integral == pytest.approx(points.force.sum(), rel=1e-12)


def test_where_contact_is_looked_for_does_not_change_the_answer(two_cantilevers, paper_solution, monkeypatch):
    scene, near = two_cantilevers(20000.0, 0.0), paper_solution("e20_g0", 1)
    monkeypatch.setattr(solver, "_candidates", lambda pair, nodes, located: np.zeros(nodes.area.size, dtype=bool))

    found_late = solve(scene, 1)

    assert found_late.outcome == "converged"
    np.testing.assert_allclose(
        found_late.contact_points("lower-upper").force, near.contact_points("lower-upper").force, atol=1e-8
    )


def test_forces_out_of_balance_are_refused(two_cantilevers, monkeypatch):
    original = solver.solve_layers
    monkeypatch.setattr(solver, "solve_layers", lambda factor, force: original(factor, force) * (1.0 + 1e-6))

    assert solve(two_cantilevers(50000.0, 0.0), 1).outcome.startswith("refused: forces are out of balance by")


def test_contact_forces_that_do_not_fit_the_displacements_are_refused(two_cantilevers, monkeypatch):
    original = solver.compliance
    monkeypatch.setattr(solver, "compliance", lambda factor, forces: original(factor, forces) * (1.0 + 1e-4))

    outcome = solve(two_cantilevers(50000.0, 0.5), 1).outcome

    assert outcome.startswith("refused: contact forces and displacements disagree by")


@pytest.mark.parametrize("penalty", [1e2, 1e4, 1e8, None])
def test_the_contact_force_does_not_depend_on_the_penalty(two_cantilevers, paper_solution, penalty):
    """Springs of 1e2 N/mm^3 alone would be off by 0.3 %; what is left is that forces stay to 1e-6 of their sum."""
    solutions = paper_solution("e50_g0", 1), solve(two_cantilevers(50000.0, 0.0, penalty=penalty), 1)

    rigid, found = (each.contact_points("lower-upper").force.sum() for each in solutions)
    assert found == pytest.approx(rigid, rel=1e-4)


def test_a_penalty_that_changes_the_answer_is_refused(two_cantilevers):
    """At 0.01 N/mm^3 even what the multipliers leave is too much."""
    outcome = solve(two_cantilevers(50000.0, 0.0, penalty=0.01), 1).outcome

    assert outcome.startswith("refused: the penalty is too soft")


def _on(scene, second, gap, zone=(20.0, 300.0), force=(0.0, -1000.0, 0.0)):
    """The lower rod alone on ground, under a force in the middle."""
    pair = ContactPair("rest", RodFace("lower", "bottom"), second, zone, gap)
    lower = scene.rod("lower")
    load = SectionForce("lower", 150.0, force)
    return replace(scene, rods=(lower,), supports=(Clamp("lower", "start"),), loads=(load,), contacts=(pair,))


def test_a_rod_pressed_on_rigid_ground_rests_on_it_as_on_a_prop(two_cantilevers):
    """A cantilever propped at b = 290 mm, where the zone begins, by a prop that is lower by the gap.

    R = F a^2 (3 b - a) / (2 b^3) - 3 E I gap / b^3 under a force at a (any textbook).
    """
    scene = _on(two_cantilevers(50000.0, 0.0), Ground(), 0.1, (290.0, 300.0))

    solution = solve(scene, 1)

    prop, rigidity = 290.0, 200000.0 * 15.0**4 / 12.0
    expected = 1000.0 * 150.0**2 * (3.0 * prop - 150.0) / (2.0 * prop**3) - 3.0 * rigidity * 0.1 / prop**3
    contact = solution.contact_points("rest")
    assert solution.outcome == "converged"
    # beam theory leaves out shear, (h / L)^2 = 0.3 %
    assert contact.force.sum() == pytest.approx(expected, rel=3e-3)
    assert solution.reaction("lower", 0.0)[1] + contact.force.sum() == pytest.approx(1000.0, rel=1e-9)


def test_ground_pulls_nothing(two_cantilevers):
    solution = solve(_on(two_cantilevers(50000.0, 0.0), Ground(5.0), 0.0, force=(0.0, 1000.0, 0.0)), 1)

    assert solution.outcome == "converged"
    assert solution.contact_points("rest").force.max() < 1.0  # the clamp tilts the bottom of the first sections down


def test_a_bed_gives_way_as_its_modulus_says(two_cantilevers):
    solution = solve(_on(two_cantilevers(50000.0, 0.0), Ground(5.0), 0.0), 1)
    contact, result = solution.contact_points("rest"), solution.pairs["rest"]

    pressed = contact.force > 0.0
    assert solution.outcome == "converged"
    assert pressed.any()
    assert not pressed.all()  # the tip lifts off
    np.testing.assert_allclose(result.pressure, 5.0 * np.maximum(-result.gap, 0.0), rtol=1e-12)
    # where the tip is lifted off the gap is that of the displaced face
    assert contact.gap.max() == pytest.approx(float(solution.displacement("lower", np.array([300.0]))[1, 0]), rel=1e-2)


def test_an_interference_presses_rods_apart(two_cantilevers):
    scene = replace(two_cantilevers(200000.0, -0.1), loads=())

    solution = solve(scene, 1)

    contact = solution.contact_points("lower-upper")
    touching = contact.position[0, (contact.force > 0.0) & (np.abs(contact.position[2]) < 1e-9)]
    top, bottom = (np.stack([0.0 * touching, side + 0.0 * touching]) for side in (7.5, -7.5))
    lower = displacement(solution.rods["lower"].field, np.vstack([top, touching]))[1]
    upper = displacement(solution.rods["upper"].field, np.vstack([bottom, touching - 200.0]))[1]
    assert len(touching)
    np.testing.assert_allclose(upper - lower, 0.1, rtol=1e-6)


def test_a_gap_that_does_not_close_leaves_the_rods_alone(two_cantilevers):
    solution = solve(two_cantilevers(50000.0, 50.0), 1)

    assert solution.outcome == "converged"
    assert not solution.contact_points("lower-upper").force.any()
    assert not solution.rods["lower"].field.nodal.any()


def test_drawing_a_rod_the_other_way_round_changes_nothing(two_cantilevers, paper_solution):
    turned = two_cantilevers(50000.0, 0.0, upper=Line((500.0, 15.0, 0.0), (200.0, 15.0, 0.0), UP))
    turned = dataclasses.replace(
        turned,
        supports=(Clamp("lower", "start"), Clamp("upper", "start")),
        loads=(dataclasses.replace(turned.loads[0], position=300.0 - 500.0 / 3.0),),
    )

    solutions = paper_solution("e50_g0", 1), solve(turned, 1)
    forces = [each.contact_points("lower-upper").force for each in solutions]

    # borders of the mirrored rod are rounded differently
    np.testing.assert_allclose(forces[1], forces[0], atol=1e-5)


def test_swapping_first_and_second_changes_the_force_only_by_the_interpolation(two_cantilevers, paper_solution):
    """Which face carries the nodes matters only on non-matching meshes; here they match."""
    swapped = two_cantilevers(
        50000.0,
        0.0,
        pair={"first": RodFace("upper", "bottom"), "second": RodFace("lower", "top"), "zone": (0.0, 100.0)},
    )

    solutions = paper_solution("e50_g0", 1), solve(swapped, 1)
    forces = [each.contact_points("lower-upper").force.sum() for each in solutions]

    assert forces[1] == pytest.approx(forces[0], rel=1e-8)


def test_non_matching_meshes_agree_with_matching_ones(two_cantilevers, paper_solution, monkeypatch):
    scene, matching = two_cantilevers(20000.0, 0.0), paper_solution("e20_g0", 1)
    original = body.rod_borders

    def shifted(scene, rod, refinement, symmetric):
        borders = original(scene, rod, refinement, symmetric)
        if rod.name == "lower":
            return borders
        inside = (borders.s > 1.0) & (borders.s < 99.0)
        moved = np.where(inside, borders.s + 0.4 * np.sin(np.pi * borders.s / 50.0), borders.s)
        return dataclasses.replace(borders, s=moved)

    monkeypatch.setattr(body, "rod_borders", shifted)
    non_matching = solve(scene, 1)

    forces = [each.contact_points("lower-upper").force.sum() for each in (matching, non_matching)]
    # nodal pressures err by the patch test, resultants by far less
    assert forces[1] == pytest.approx(forces[0], rel=1e-4)


@pytest.mark.slow
def test_a_rod_that_contact_cannot_balance_is_refused_by_name(two_cantilevers):
    """The upper bar, without its clamp, would tip about the end of the lower one."""
    scene = dataclasses.replace(two_cantilevers(50000.0, 0.0), supports=(Clamp("lower", "start"),))

    outcome = solve(scene, refinement=1).outcome

    assert outcome == "refused: contact cannot balance the loads on 'upper', which nothing else holds"


def test_a_nearly_incompressible_rod_is_refused_by_name(cantilever):
    scene = cantilever((0.0, -1.0, 0.0), poisson_ratio=0.49995)

    with pytest.raises(SceneError, match=r"rods\.rod\.material\.poisson_ratio: found 0\.49995; .*at most 0\.4999"):
        solve(scene)


def test_bars_whose_factors_would_not_fit_into_memory_are_solved_as_other_solids_are(cantilever, monkeypatch):
    monkeypatch.setattr(solver, "physical_memory", lambda: 1e6)

    solution = solve(cantilever((0.0, -100.0, 0.0)), 1)

    assert isinstance(solution, SolidSolution)
    assert solution.outcome == "converged"


def test_a_refinement_below_one_is_refused(cantilever):
    with pytest.raises(ValueError, match="refinement: found 0"):
        solve(cantilever((0.0, -1.0, 0.0)), 0)


def test_a_rod_clamped_at_both_ends_carries_half_the_load_at_each(cantilever):
    line = Line((0.0, 0.0, 0.0), (120.0, 0.0, 0.0), UP)
    rod = Rod("rod", line, Rectangle(10.0, 20.0), Material(200000.0, 0.3), (0.0, 120.0))
    load = dataclasses.replace(cantilever((0.0, -80.0, 0.0)).loads[0], position=60.0)
    scene = Scene("both ends", (rod,), (Clamp("rod", "start"), Clamp("rod", "end")), (load,), ())

    solution = solve(scene, 1)

    start, end = solution.reaction("rod", 0.0), solution.reaction("rod", 120.0)
    np.testing.assert_allclose(start[:3], [0.0, 40.0, 0.0], atol=1e-8)
    np.testing.assert_allclose(end[:3], [0.0, 40.0, 0.0], atol=1e-8)
    # F L / 8, less the part that shear deflection takes: none by symmetry
    assert start[5] == pytest.approx(80.0 * 120.0 / 8.0, rel=0.01)
    assert end[5] == pytest.approx(-start[5], rel=1e-8)
