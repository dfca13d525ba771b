"""The JSON Schema of case files: true of the library, strict, and documentation in itself."""

import tomllib

import jsonschema
import pytest

from cases.loader import LIBRARY, library_names
from cases.schema import case_schema


def content(name):
    return tomllib.loads((LIBRARY / f"{name}.toml").read_text(encoding="utf-8"))


def test_the_schema_is_a_json_schema():
    jsonschema.Draft202012Validator.check_schema(case_schema())


@pytest.mark.parametrize("name", library_names())
def test_every_library_file_fits_the_schema(name):
    jsonschema.Draft202012Validator(case_schema()).validate(content(name))


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
        jsonschema.Draft202012Validator(case_schema()).validate(wrong)


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
