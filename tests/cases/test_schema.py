"""The JSON Schema of case files: true of the library, strict, and documentation in itself."""

import copy
import tomllib
from pathlib import Path

import jsonschema
import pytest

from cases.building import case_from
from cases.form import FormError, checked_form
from cases.loader import LIBRARY, TRUTH, library_names
from cases.schema import case_schema

VALIDATOR = jsonschema.Draft202012Validator(case_schema())


def content(name):
    return tomllib.loads((LIBRARY / f"{name}.toml").read_text(encoding="utf-8"))


def test_the_schema_is_a_json_schema():
    jsonschema.Draft202012Validator.check_schema(case_schema())


@pytest.mark.parametrize("name", library_names())
def test_every_library_file_fits_the_schema(name):
    VALIDATOR.validate(content(name))


@pytest.mark.parametrize(
    ("table", "key", "value"),
    [
        ("rod_model", "level", 13),
        ("rod_model", "level", 5.5),
        ("rod_model", "levle", 5),
        ("rods", "<b>", {}),
        ("materials", "steel", {"young_modulus": "200 GPa"}),
    ],
)
def test_the_schema_refuses_what_the_loader_refuses(table, key, value):
    wrong = content("two-cantilevers-e50-g0")
    wrong[table][key] = value

    with pytest.raises(jsonschema.ValidationError):
        VALIDATOR.validate(wrong)


ONE_OF_EACH = {
    "title": "One of each",
    "materials": {"steel": {"young_modulus": "200 GPa", "poisson_ratio": 0.3}},
    "sections": {
        "wire": {"shape": "circle", "diameter": "4 mm"},
        "tube": {"shape": "ring", "outer_diameter": 4, "inner_diameter": 2},
        "beam": {"shape": "box", "width": 20, "height": 10, "wall": "1 mm"},
        "angle": {"shape": "polygon", "outer": [[0, 0], [9, 0], [0, "9 mm"]], "holes": [[[1, 1], [2, 1], [1, 2]]]},
    },
    "rods": {
        "bow": {
            "section": "wire",
            "material": "steel",
            "element_borders": [0, 157.08],
            "centre_line": {
                "shape": "arc",
                "start": [100, 0, 0],
                "centre": [0, 0, 0],
                "axis": [0, 0, 1],
                "angle": "90 deg",
                "up": [0, 0, 1],
            },
        },
        "drill": {
            "section": "angle",
            "material": "steel",
            "element_borders": [0, 60],
            "centre_line": {"shape": "line", "start": [0, 0, 9], "end": [60, 0, 9], "up": [0, 1, 0], "twist": 1.5},
        },
    },
    "supports": [{"kind": "clamp", "rod": "bow", "end": "start"}, {"kind": "clamp", "rod": "drill", "end": "end"}],
    "loads": [
        {"kind": "section moment", "rod": "bow", "position": 157.08, "moment": [0, 0, "1 N m"]},
        {"kind": "line load", "rod": "drill", "start": 0, "end": 30, "force": [0, "-2 kN/m", 0]},
    ],
    "rod_model": {"level": 3, "order": 5},
}


EVERYTHING = tomllib.loads(Path(__file__).with_name("everything.toml").read_text(encoding="utf-8"))


def changed(*place, value, content=ONE_OF_EACH):
    """`ONE_OF_EACH`, or another case, with another value at a place."""
    content = copy.deepcopy(content)
    table = content
    for key in place[:-1]:
        table = table[key]
    table[place[-1]] = value
    return content


def test_every_shape_and_load_fits_the_schema():
    VALIDATOR.validate(ONE_OF_EACH)

    assert case_from("each", checked_form(ONE_OF_EACH), TRUTH).scene.rods[1].centre_line.twist == 1.5


def test_the_case_that_uses_everything_fits_the_schema():
    VALIDATOR.validate(EVERYTHING)


def elsewhere(*place, value):
    return changed(*place, value=value, content=EVERYTHING)


@pytest.mark.parametrize(
    "wrong",
    [
        pytest.param(elsewhere("materials", "steel", "density", value=7850), id="bare density"),
        pytest.param(elsewhere("materials", "rubber", "law", value="orthotropic"), id="keys of another law"),
        pytest.param(elsewhere("materials", "spruce", "young_moduli", value=[1, 2]), id="two moduli"),
        pytest.param(elsewhere("supports", 2, "components", value=["turn x"]), id="turn of a whole section"),
        pytest.param(elsewhere("supports", 4, "components", value=[]), id="no component"),
        pytest.param(elsewhere("supports", 4, "kind", value="clamp"), id="keys of another support"),
        pytest.param(elsewhere("supports", 1, "rotation", value=[0, 0]), id="rotation with two components"),
        pytest.param(elsewhere("joints", 0, "ends", value=[{"rod": "post", "end": "end"}]), id="joint of one end"),
        pytest.param(elsewhere("beds", 0, "face", "face", value="below"), id="unknown face"),
        pytest.param(elsewhere("loads", 0, "rods", value=[]), id="weight of no rod"),
        pytest.param(elsewhere("loads", 0, "acceleration", value=[0, -9.81, 0]), id="bare acceleration"),
        pytest.param(
            elsewhere("rods", "snake", "centre_line", "points", value=[[0, 0, 0], [1, 0, 0]]), id="two points"
        ),
        pytest.param(elsewhere("rods", "hook", "centre_line", "pieces", value=[]), id="path of nothing"),
        pytest.param(elsewhere("rod_model", "levels", "beam", value=[5, 4, 13]), id="level too high"),
        pytest.param(elsewhere("rod_model", "orders", "beam", value=1), id="order too low"),
        pytest.param(changed("sections", "wire", "shape", value="circel"), id="unknown shape"),
        pytest.param(changed("sections", "wire", "shape", value="ring"), id="keys of another shape"),
        pytest.param(changed("sections", "angle", "outer", value=[[0, 0, 0]]), id="corner with three coordinates"),
        pytest.param(changed("rods", "bow", "centre_line", "pitch", value=3), id="arc with a pitch"),
        pytest.param(changed("loads", 0, "kind", value="line load"), id="keys of another load"),
        pytest.param(changed("loads", 1, "force", value=[0, 1]), id="force with two components"),
    ],
)
def test_schema_and_loader_refuse_the_same_files(wrong):
    with pytest.raises(jsonschema.ValidationError):
        VALIDATOR.validate(wrong)
    with pytest.raises(FormError):
        checked_form(wrong)


def test_every_key_is_described():
    schema = case_schema()
    tables = {"the file": schema, **schema["$defs"]}

    bare = [
        f"{name}.{key}"
        for name, table in tables.items()
        for key, field in table.get("properties", {}).items()
        if not field.get("description")
    ]

    assert bare == []
