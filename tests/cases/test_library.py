"""The library: the paper's four cases as paper and design state them, and what every case must say of itself."""

import json

import pytest

from cases.case import QUANTITIES
from cases.loader import LIBRARY, TRUTH, library_names, load_case
from cases.scene import Clamp, ContactPair, Material, Rectangle, RodFace, SectionForce

# E2 (MPa), gap (mm), contact zone (mm) and largest bending stress of the upper rod (MPa) as published.
PAPER = {
    "two-cantilevers-e50-g0": (50000.0, 0.0, (200.0, 221.71), 117.15),
    "two-cantilevers-e50-g05": (50000.0, 0.5, (200.0, 207.47), 124.40),
    "two-cantilevers-e20-g0": (20000.0, 0.0, (237.52, 262.05), 100.71),
    "two-cantilevers-e20-g05": (20000.0, 0.5, (232.69, 257.29), 104.85),
}

every_case = pytest.mark.parametrize("name", PAPER)


def test_the_library_has_the_papers_cases():
    assert set(PAPER) <= set(library_names())


@every_case
def test_rods_are_the_papers(name):
    young_modulus, gap, _, _ = PAPER[name]

    scene = load_case(name).scene

    lower, upper = scene.rod("lower"), scene.rod("upper")
    assert lower.material == Material(200000.0, 0.3)
    assert upper.material == Material(young_modulus, 0.3)
    assert lower.section == upper.section == Rectangle(15.0, 15.0)
    assert (lower.centre_line.start, lower.centre_line.end) == ((0, 0, 0), (300, 0, 0))
    assert (upper.centre_line.start, upper.centre_line.end) == ((200, 15 + gap, 0), (500, 15 + gap, 0))
    assert lower.centre_line.up == upper.centre_line.up == (0, 1, 0)
    assert lower.element_borders == (0, 66.67, 133.33, 200, 233.33, 266.67, 300)
    assert upper.element_borders == (0, 33.33, 66.67, 100, 166.67, 233.33, 300)


@every_case
def test_supports_load_and_contact_are_the_papers(name):
    _, gap, _, _ = PAPER[name]

    scene = load_case(name).scene

    overlap = ContactPair("overlap", RodFace("lower", "top"), RodFace("upper", "bottom"), (200.0, 300.0), gap, 1e6)
    assert scene.supports == (Clamp("lower", "start"), Clamp("upper", "end"))
    assert scene.loads == (SectionForce("upper", 166.67, (0.0, -1000.0, 0.0)),)
    assert scene.contacts == (overlap,)


@every_case
def test_the_rod_model_is_h5_with_p_6(name):
    settings = load_case(name).rod_model

    assert (settings.level, settings.order) == (5, 6)


@every_case
def test_published_values_are_the_papers(name):
    _, _, edges, stress = PAPER[name]

    published = {(each.quantity, each.of): each for each in load_case(name).published}

    assert published["contact_edges", "overlap"].value == edges
    assert published["contact_edges", "overlap"].tolerance == 1.0
    assert published["max_bending_stress", "upper"].value == (stress,)
    assert published["max_bending_stress", "upper"].tolerance == 0.001
    assert all("figure" in each.source for each in published.values())


@every_case
def test_every_comparable_quantity_is_compared(name):
    compared = {check.quantity for check in load_case(name).compare}

    assert compared == {quantity for quantity, kind in QUANTITIES.items() if kind.comparable}


@every_case
def test_the_independent_values_are_of_the_same_rods_and_gap(name):
    case = load_case(name)
    assert case.independent is not None

    truth = json.loads(case.independent.read_text())

    assert truth["E2_MPa"] == case.scene.rod("upper").material.young_modulus
    assert truth["gap_mm"] == case.scene.contact("overlap").gap


@pytest.mark.parametrize("name", library_names())
def test_every_library_case_loads_under_its_own_name(name):
    case = load_case(name)

    assert case.name == case.scene.name == name
    assert case.title
    assert "\n" not in case.title


@pytest.mark.parametrize("name", library_names())
def test_every_library_case_says_what_it_shows_and_why_its_tolerances_are_what_they_are(name):
    case = load_case(name)
    text = (LIBRARY / f"{name}.toml").read_text(encoding="utf-8")

    judged = text.partition("[rod_model]")[2]

    assert len(case.description.split()) > 20
    assert case.compare
    assert "\n# " in judged  # a comment of its own


def test_every_library_case_has_a_title_of_its_own():
    titles = [load_case(name).title for name in library_names()]

    assert len(set(titles)) == len(titles) >= 30


@pytest.mark.parametrize(("name", "load", "axes"), [("out-of-plane", "out_of_plane", "Z"), ("radial", "radial", "XY")])
def test_the_quarter_rings_are_held_against_the_independent_values(name, load, axes):
    truth = json.loads((TRUTH / "quarter_ring_r100.json").read_text(encoding="utf-8"))
    case = load_case(f"quarter-ring-{name}")

    end, (force,) = truth["loads"][load]["end_face_mean_displacement_mm"], case.scene.loads

    assert isinstance(force, SectionForce)
    assert list(force.force) == truth["loads"][load]["force_N"]
    assert {found.axis: found.value[0] for found in case.published} == {axis: end["XYZ".index(axis)] for axis in axes}
    (rod,) = case.scene.rods
    assert rod.material == Material(truth["E_MPa"], truth["nu"])
    assert all(found.position == rod.length for found in case.published)
