"""The table of section properties: each section once, with its rods, closed forms and how far J has settled."""

import math
from dataclasses import replace

import pytest

from cases.loader import load_case
from cases.scene import Box, Circle, Polygon, Rectangle, Rod, Section
from reports.section_table import SectionTable, section_table
from reports.site import DrawnPicture, case_pages

ANGLE = Polygon(((0.0, 0.0), (30.0, 0.0), (30.0, 5.0), (5.0, 5.0), (5.0, 30.0), (0.0, 30.0)))


def rods_with(*sections: Section) -> list[Rod]:
    rod = load_case("two-cantilevers-e50-g0").scene.rods[0]
    return [replace(rod, name=f"rod {n}", section=section) for n, section in enumerate(sections, 1)]


def values(table: SectionTable, start: str) -> list[list[float]]:
    """The numbers in the row whose name starts so, section by section."""
    cells = next(cells for what, cells in table.rows if str(what).startswith(start))
    return [[float(part.replace("−", "-")) for part in cell.split(",")] for cell in cells]


def test_each_section_has_one_column_with_the_rods_that_have_it() -> None:
    table = section_table(rods_with(Rectangle(20.0, 10.0), Circle(10.0), Rectangle(20.0, 10.0)))

    assert table.columns == (("20 x 10 mm", "rod 1, rod 3"), ("diameter 10 mm", "rod 2"))
    assert all(len(cells) == 2 for _, cells in table.rows)


def test_a_rectangle_and_a_circle_have_the_properties_of_the_textbook() -> None:
    table = section_table(rods_with(Rectangle(20.0, 10.0), Circle(10.0)))

    digits = 1e-5  # six are written
    assert values(table, "Area") == [[200.0], [pytest.approx(25.0 * math.pi, rel=digits)]]
    assert values(table, "Principal")[0] == pytest.approx([10.0 * 20.0**3 / 12.0, 20.0 * 10.0**3 / 12.0], rel=digits)
    assert values(table, "Angle")[0] == [90.0]  # the strong axis of a flat rectangle is y
    assert values(table, "Section moduli")[0] == pytest.approx([10.0 * 20.0**2 / 6.0, 20.0 * 10.0**2 / 6.0], rel=digits)
    torsion = values(table, "Torsion")
    assert torsion[0] == [pytest.approx(0.229 * 20.0 * 10.0**3, rel=2e-3)]  # three digits in Timoshenko and Goodier
    assert torsion[1] == [pytest.approx(math.pi * 10.0**4 / 32.0, rel=digits)]
    assert next(cells for what, cells in table.rows if what.startswith("Shear centre")) == ("centroid", "centroid")


def test_an_angle_has_its_shear_centre_near_the_corner_and_a_torsion_constant_said_to_be_unsettled() -> None:
    table = section_table(rods_with(ANGLE))

    x, y = values(table, "Shear centre")[0]
    corner = 2.5 - ANGLE.centroid[0]  # where the middle lines of the walls meet
    assert (x, y) == pytest.approx((corner, corner), abs=0.15 * 5.0)  # of thin walls; these are thick
    assert abs(values(table, "Angle")[0][0]) == pytest.approx(45.0)
    assert "took 2 % off it" in table.note


def test_a_section_too_thin_for_the_highest_degree_is_told_with_a_lower_one(monkeypatch: pytest.MonkeyPatch) -> None:
    from rodmodel import section_properties

    def refusing(section: Section, degree: int):
        if degree > 6:
            raise ValueError("too thin")
        return section_properties(section, degree)

    monkeypatch.setattr("reports.section_table.section_properties", refusing)

    assert "degree 6:" in section_table(rods_with(Box(31.0, 20.0, 2.0))).note


def test_the_case_page_shows_the_sections_of_its_rods(case_run) -> None:
    name = case_run.case.name
    page = case_pages([case_run], {name: DrawnPicture("iVBORw0KGgo=", 1800, 700, "10", "")})[name]

    assert "I<sub>x</sub>" in page
    assert page.count('<table class="sections">') == 1
    assert '<td class="n">4218.75</td>' in page  # 15^4 / 12
