"""Scenes and small helpers shared by the tests of `reference3d`."""

from __future__ import annotations

import json
from functools import cache
from importlib.resources import files

import numpy as np
import pytest

from cases.scene import Clamp, ContactPair, Line, Material, Rectangle, Rod, RodFace, Scene, SectionForce
from reference3d.elasticity import layered_stiffness
from reference3d.grading import Borders
from reference3d.mesh import box_mesh
from reference3d.solver import solve

SECTION = Rectangle(15.0, 15.0)

# name of the truth file: Young's modulus of the upper rod (MPa), gap (mm)
PAPER_CASES = {
    "e50_g0": (50000.0, 0.0),
    "e50_g05": (50000.0, 0.5),
    "e20_g0": (20000.0, 0.0),
    "e20_g05": (20000.0, 0.5),
}


def make_two_cantilevers(upper_modulus, gap, penalty=1e6, lower=None, upper=None, pair=None, load=(0.0, -1000.0, 0.0)):
    """The paper's two bars; `lower`, `upper` replace their centre lines, `pair` the contact pair's fields."""
    rods = (
        Rod(
            "lower",
            lower or Line((0.0, 0.0, 0.0), (300.0, 0.0, 0.0), (0.0, 1.0, 0.0)),
            SECTION,
            Material(200000.0, 0.3),
            (0.0, 300.0),
        ),
        Rod(
            "upper",
            upper or Line((200.0, 15.0, 0.0), (500.0, 15.0, 0.0), (0.0, 1.0, 0.0)),
            SECTION,
            Material(upper_modulus, 0.3),
            (0.0, 300.0),
        ),
    )
    fields = {
        "name": "lower-upper",
        "first": RodFace("lower", "top"),
        "second": RodFace("upper", "bottom"),
        "zone": (200.0, 300.0),
        "gap": gap,
        "penalty": penalty,
    }
    return Scene(
        name="two cantilevers",
        rods=rods,
        supports=(Clamp("lower", "start"), Clamp("upper", "end")),
        loads=(SectionForce("upper", 500.0 / 3.0, load),),
        contacts=(ContactPair(**{**fields, **(pair or {})}),),
    )


def make_cantilever(force, poisson_ratio=0.3, length=300.0, section=SECTION, up=(0.0, 1.0, 0.0), end=None):
    """A rod along X clamped at its start with a force on its end section."""
    line = Line((0.0, 0.0, 0.0), end or (length, 0.0, 0.0), up)
    rod = Rod("rod", line, section, Material(200000.0, poisson_ratio), (0.0, line.length))
    load = SectionForce("rod", line.length, force)
    return Scene("cantilever", (rod,), (Clamp("rod", "start"),), (load,), ())


@cache
def solve_paper_case(name, refinement=2):
    """Solution of a paper case, computed once for all tests that read it."""
    return solve(make_two_cantilevers(*PAPER_CASES[name]), refinement)


def read_truth(name):
    """Independent 3D values of a paper case (cases/truth/README.md)."""
    return json.loads((files("cases") / "truth" / f"{name}.json").read_text(encoding="utf-8"))


def make_layered_box(borders: Borders, material: Material):
    """Stiffness by layers of a box with given element borders."""
    return layered_stiffness(box_mesh(borders.x, borders.y, borders.s), borders, material)


def make_dense_matrix(stiffness):
    """The layered stiffness as one dense matrix, for comparison with other ways to use it."""
    size, layers = stiffness.plane_size, len(stiffness.kind)
    matrix = np.zeros(((2 * layers + 1) * size,) * 2)
    for layer, kind in enumerate(stiffness.kind):
        block = slice(2 * layer * size, (2 * layer + 3) * size)
        matrix[block, block] += stiffness.matrices[kind]
    return matrix


@pytest.fixture
def two_cantilevers():
    return make_two_cantilevers


@pytest.fixture
def cantilever():
    return make_cantilever


@pytest.fixture
def truth():
    return read_truth


@pytest.fixture
def layered_box():
    return make_layered_box


@pytest.fixture
def dense_matrix():
    return make_dense_matrix


@pytest.fixture
def graded_borders():
    """A small box with elements of different sizes along every axis."""
    return Borders(
        x=np.array([-3.0, -1.0, 4.0]),
        y=np.array([-2.0, 0.5, 1.0, 2.0]),
        s=np.array([0.0, 1.0, 3.0, 4.0, 8.0]),
    )


@pytest.fixture
def paper_solution():
    return solve_paper_case


@pytest.fixture(params=PAPER_CASES)
def paper_case(request):
    """Name of each of the paper's four cases."""
    return request.param


@pytest.fixture
def paper_scene(paper_case):
    return make_two_cantilevers(*PAPER_CASES[paper_case])
