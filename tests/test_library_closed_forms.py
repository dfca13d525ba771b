"""Cases of the library whose beam theory is known in closed form: the rod model against the formula, computed here.

Beams of textbooks have no grip of clamps and no pressure across, so that each tolerance says what they leave out.
Sources: S. P. Timoshenko, Strength of Materials I (1955); M. Hetényi, Beams on Elastic Foundation (1946); shear
coefficients of G. R. Cowper, Journal of Applied Mechanics 33 (1966) 335-340.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import pytest
from scipy.optimize import brentq

from cases.case import Case
from cases.loader import load_case
from cases.scene import (
    Gravity,
    Ground,
    LineLoad,
    Material,
    Orthotropic,
    Pressure,
    Rectangle,
    Ring,
    Rod,
    RoundGap,
    SectionForce,
    SectionMoment,
)
from reports.quantities import Quantities
from reports.runner import run_rod
from reports.verification.published import curved_beam_reference, straight_beam_reference

INCH = 25.4


@cache
def solved(name: str) -> tuple[Case, Quantities]:
    """A case and the rod model's answer with the case's own level and order."""
    case = load_case(name)
    quantities = run_rod(case).quantities
    assert quantities.converged
    return case, quantities


def stiffness(rod: Rod) -> tuple[float, float]:
    """E I about the x axis of a rectangle (N mm^2) and k G A along its y axis (N)."""
    section, material = rod.section, rod.material
    assert isinstance(section, Rectangle)
    area = section.width * section.height
    if isinstance(material, Orthotropic):
        return material.young_moduli[2] * area * section.height**2 / 12.0, 5.0 / 6.0 * material.shear_moduli[0] * area
    young, nu = material.young_modulus, material.poisson_ratio
    cowper = 10.0 * (1.0 + nu) / (12.0 + 11.0 * nu)
    return young * area * section.height**2 / 12.0, cowper * young / (2.0 * (1.0 + nu)) * area


def at(quantities: Quantities, rod: str, station: float) -> int:
    """Index of a station of a rod's quantities."""
    stations = quantities.rod(rod).station
    index = int(np.argmin(np.abs(stations - station)))
    assert stations[index] == pytest.approx(station, abs=1e-6)
    return index


def test_a_bar_in_tension_grows_by_its_force_over_its_stiffness():
    case, found = solved("bar-in-tension")
    (bar,), (force,) = case.scene.rods, case.scene.loads
    assert isinstance(force, SectionForce)
    assert isinstance(bar.material, Material)
    assert isinstance(bar.section, Rectangle)

    stress = force.force[0] / (bar.section.width * bar.section.height)

    # exact in theory and in both solvers; round-off
    assert found.rod("bar").displacement[0, -1] == pytest.approx(
        stress * bar.length / bar.material.young_modulus, rel=1e-9
    )
    assert list(found.point_stresses.values()) == pytest.approx([stress], rel=1e-9)


def test_a_bar_in_pure_bending_takes_the_shape_of_a_parabola():
    case, found = solved("bar-in-pure-bending")
    (bar,), (moment,) = case.scene.rods, case.scene.loads
    assert isinstance(moment, SectionMoment)

    curvature = moment.moment[2] / stiffness(bar)[0]

    deflection = found.rod("bar").displacement[1]
    # exact in theory and in both solvers, but for where the mean of the held section is; round-off
    assert deflection - deflection[0] == pytest.approx(curvature * found.rod("bar").station ** 2 / 2.0, abs=1e-9)


def test_a_settled_clamp_makes_the_moments_of_a_beam_with_shear():
    case, found = solved("settled-clamp")
    (beam,) = case.scene.rods
    bending, shear = stiffness(beam)

    moment = 6.0 * bending * 0.5 / beam.length**2 / (1.0 + 12.0 * bending / (shear * beam.length**2))

    # clamps hold the section's contraction as well: their grip makes the beam 0.1 heights shorter at either end
    assert np.abs(found.rod("beam").moment).max() == pytest.approx(moment, rel=3.0 * 0.1 * 10.0 / beam.length)


@pytest.mark.parametrize("name", ["spruce-beam", "strip-under-its-own-weight"])
def test_beams_clamped_at_both_ends_sag_by_bending_and_shear(name):
    case, found = solved(name)
    (beam,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(beam.section, Rectangle)
    if isinstance(load, Gravity):
        assert beam.material.density is not None
        spread = beam.material.density * beam.section.width * beam.section.height * load.acceleration[1]
    else:
        assert isinstance(load, LineLoad)
        spread = load.force[1]
    bending, shear = stiffness(beam)

    sag = spread * beam.length**4 / (384.0 * bending) + spread * beam.length**2 / (8.0 * shear)

    middle = at(found, beam.name, beam.length / 2.0)
    # the grip of either clamp takes 0.1 larger sides off the length, whose fourth power counts
    grip = 0.1 * max(beam.section.width, beam.section.height)
    assert found.rod(beam.name).displacement[1, middle] == pytest.approx(sag, rel=8.0 * grip / beam.length)


def test_a_strip_under_pressure_sags_by_bending_and_shear():
    case, found = solved("strip-under-pressure")
    (strip,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(load, Pressure)
    assert isinstance(strip.section, Rectangle)
    bending, shear = stiffness(strip)
    spread = load.pressure * strip.section.width

    sag = 5.0 * spread * strip.length**4 / (384.0 * bending) + spread * strip.length**2 / (8.0 * shear)

    # where the moment changes, the strip's width b keeps it from bending across as it would: nu (b / l)^2
    assert isinstance(strip.material, Material)
    across = strip.material.poisson_ratio * (strip.section.width / strip.length) ** 2
    assert -found.rod("strip").displacement[1].min() == pytest.approx(sag, rel=across)


def test_the_middle_support_of_two_spans_has_the_moment_of_beams_with_shear():
    case, found = solved("two-span-beam")
    (beam,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(load, SectionForce)
    bending, shear = stiffness(beam)
    span = beam.length / 2.0

    moment = 3.0 * load.force[1] * span / 32.0 / (1.0 + 3.0 * bending / (shear * span**2))

    # supports spread over a section's height round the kink of the moment off
    middle = at(found, "beam", span)
    assert abs(found.rod("beam").moment[middle]) == pytest.approx(abs(moment), rel=2e-3)


def test_a_beam_on_a_bed_sinks_as_hetenyi_says():
    case, found = solved("beam-on-a-bed")
    (beam,), (load,), (bed,) = case.scene.rods, case.scene.loads, case.scene.beds
    assert isinstance(load, SectionForce)
    assert isinstance(beam.section, Rectangle)
    bending, shear = stiffness(beam)
    springs = bed.modulus * beam.section.width
    parameter = (springs / (4.0 * bending)) ** 0.25
    length = parameter * beam.length

    divisor = math.sinh(length) + math.sin(length)
    sunk = load.force[1] * parameter / (2.0 * springs) * (math.cosh(length) + math.cos(length) + 2.0) / divisor

    # shear, which he leaves out, adds the square of the ratio of its length to the bed's
    left_out = 2.0 * parameter**2 * bending / shear
    middle = at(found, "beam", beam.length / 2.0)
    assert found.rod("beam").displacement[1, middle] == pytest.approx(sunk, rel=1.5 * left_out)


def test_a_bar_parts_from_a_bed_where_a_beam_does():
    """Half of the beam: free next to the clamp, on the bed next to the force, not pressed where it parts from it."""
    case, found = solved("bar-lifting-off-a-bed")
    (bar,), (load,) = case.scene.rods, case.scene.loads
    ground = case.scene.contact("bed").second
    assert isinstance(load, SectionForce)
    assert isinstance(ground, Ground)
    assert ground.modulus is not None
    assert isinstance(bar.section, Rectangle)
    bending, shear = stiffness(bar)
    half, springs, force = bar.length / 2.0, ground.modulus * bar.section.width, load.force[1]

    def parted(flexible):  # where, with so much of a beam's shear flexibility
        squared = np.roots([1.0, -flexible * springs / shear, springs / bending])[0]  # of waves e^(root s)
        wave = np.sqrt(squared)
        root = np.array([wave, -wave.conjugate()])

        def on_bed(place):  # waves that die out away from the force and from the clamp
            waves = np.exp(root * (place - np.array([half, 0.0])))
            turned = (root - flexible * springs / shear / root) * waves
            rows = np.array([waves, turned, root * turned, root**2 * turned])
            return np.hstack([rows.real, rows.imag])

        def free(place):  # cubic polynomials
            sheared = -2.0 * flexible * bending / shear * place
            deflection = [1.0, place, place**2 / 2.0, place**3 / 3.0 + sheared]
            return np.array([deflection, [0, 1, place, place**2], [0, 0, 1, 2.0 * place], [0, 0, 0, 2]])

        def deflection(edge):  # if they meet there: deflection, rotation and its two derivatives, moment and shear
            nothing = np.zeros((4, 4))
            meet = np.hstack([free(edge), -on_bed(edge)])
            rows = np.vstack([np.hstack([free(0.0), nothing])[:2], meet, np.hstack([nothing, on_bed(half)])[[1, 3]]])
            shares = np.linalg.solve(rows, [*np.zeros(7), -force / (2.0 * bending)])
            return float(free(edge)[0] @ shares[:4])

        return brentq(deflection, 0.4 * half, 0.6 * half)

    assert half - parted(0.0) == pytest.approx(158.6, abs=0.05)  # as the case says
    # edges are read between stations, where pressure fades away
    contact, edge = found.contact("bed"), parted(1.0)
    assert contact.edges[0] == pytest.approx((edge, bar.length - edge), abs=contact.edges_resolution)


def test_an_interference_fit_presses_as_two_cantilevers_do():
    case, found = solved("interference-fit")
    lower, _ = case.scene.rods
    bending, shear = stiffness(lower)
    arm = 100.0  # from either clamp to the middle of the overlap

    gap = case.scene.contact("fit").gap
    assert isinstance(gap, float)
    force = -gap / (2.0 * (arm**3 / (3.0 * bending) + arm / shear))

    # they touch over 14 mm, and clamps grip 0.1 heights
    assert found.contact("fit").force == pytest.approx(force, rel=0.02)


def test_a_tube_sags_by_bending_and_shear():
    case, found = solved("tube-cantilever")
    (tube,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(load, SectionForce)
    assert isinstance(tube.section, Ring)
    assert isinstance(tube.material, Material)
    outer, inner = tube.section.outer_diameter / 2.0, tube.section.inner_diameter / 2.0
    young, nu, hollow = tube.material.young_modulus, tube.material.poisson_ratio, (inner / outer) ** 2
    cowper = 6.0 * (1.0 + nu) * (1.0 + hollow) ** 2
    cowper /= (7.0 + 6.0 * nu) * (1.0 + hollow) ** 2 + (20.0 + 12.0 * nu) * hollow
    bending = young * math.pi / 4.0 * (outer**4 - inner**4)
    shear = cowper * young / (2.0 * (1.0 + nu)) * math.pi * (outer**2 - inner**2)

    sag = load.force[1] * (tube.length**3 / (3.0 * bending) + tube.length / shear)

    # the clamp grips 0.1 diameters
    assert found.rod("tube").displacement[1, -1] == pytest.approx(sag, rel=0.1 * 2.0 * outer / tube.length)


def test_a_slender_cantilever_is_a_beam():
    case, found = solved("slender-cantilever")
    (beam,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(load, SectionForce)
    bending, shear = stiffness(beam)

    sag = load.force[1] * (beam.length**3 / (3.0 * bending) + beam.length / shear)

    # the clamp grips 0.1 heights
    assert found.rod("beam").displacement[1, -1] == pytest.approx(sag, rel=0.1 * 5.0 / beam.length)


def test_a_clip_opens_by_the_energy_of_its_bending():
    case, found = solved("clip")
    (clip,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(load, SectionForce)
    leg, radius = 20.0, 10.0
    bending, _ = stiffness(clip)

    arc = radius * (math.pi * leg**2 + 4.0 * leg * radius + math.pi * radius**2 / 2.0)
    opened = load.force[1] / bending * (2.0 * leg**3 / 3.0 + arc)

    # by Castigliano, of a thin rod: (h / 2 R)^2 = 0.02 and shear are left out
    assert found.rod("clip").displacement[1, -1] == pytest.approx(opened, rel=0.02)


@pytest.mark.parametrize(
    ("name", "pair", "rod"), [("beam-over-a-round-support", "support", "beam"), ("beam-in-a-hollow", "hollow", "beam")]
)
def test_where_a_beam_lies_on_round_ground_it_has_the_moment_of_that_curvature(name, pair, rod):
    case, found = solved(name)
    beam, gap = case.scene.rod(rod), case.scene.contact(pair).gap
    assert isinstance(gap, RoundGap)

    moment = stiffness(beam)[0] / abs(gap.radius)

    # contact is but three and six heights long, and its edges reach a height in
    middle = at(found, rod, gap.station)
    assert abs(found.rod(rod).moment[middle]) == pytest.approx(moment, rel=0.05)


def test_ground_under_a_sinking_cantilever_carries_what_beam_theory_says():
    case, found = solved("cantilever-on-rigid-ground")
    (bar,), (load,) = case.scene.rods, case.scene.loads
    assert isinstance(load, LineLoad)
    bending, _ = stiffness(bar)
    spread, gap = -load.force[1], case.scene.contact("ground").gap
    assert isinstance(gap, float)

    # level and without curvature at the edge: a third of the free part's load is a single force there
    free = (72.0 * bending * gap / spread) ** 0.25
    force = spread * (bar.length - free) + spread * free / 3.0

    # shear, left out, makes the free part 4 % shorter
    assert found.contact("ground").force == pytest.approx(force, rel=0.01)
    assert found.contact("ground").edges[0][0] == pytest.approx(free, rel=0.05)


def test_macneal_and_harders_curved_beam_is_that_of_plane_elasticity():
    _, found = solved("macneal-curved-beam-in-plane")
    reference = curved_beam_reference()

    assert found.rod("beam").displacement[1, -1] / INCH == pytest.approx(reference.value, abs=reference.uncertainty)


def test_macneal_and_harders_straight_beam_is_timoshenkos():
    _, found = solved("macneal-straight-beam")
    reference = straight_beam_reference("in plane")

    assert found.rod("beam").displacement[1, -1] / INCH == pytest.approx(reference.value, abs=reference.uncertainty)
