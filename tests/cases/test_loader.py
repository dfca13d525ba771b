"""What a person sees who made a mistake in a case file: one sentence with file, key, find and remedy.

Every mistake is a small edit of a case of the library, or of the case that uses everything.
"""

import math
import re
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases.loader import LIBRARY, CaseError, library_names, load_case
from cases.scene import Box, Circle, Helix, Line, LineLoad, Polygon, Ring, SectionForce, SectionMoment

GOOD = (LIBRARY / "two-cantilevers-e50-g05.toml").read_text(encoding="utf-8")
EVERYTHING = Path(__file__).with_name("everything.toml").read_text(encoding="utf-8")


@pytest.fixture
def message(tmp_path):
    """The message of loading a case file of this content."""

    def load(content):
        path = tmp_path / "mine.toml"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        with pytest.raises(CaseError) as caught:
            load_case(path)
        return str(caught.value).replace(str(tmp_path) + "/", "")

    return load


def edited(*edits, text=GOOD):
    """The good case, or another one, with every (old, new) replaced once."""
    for old, new in edits:
        assert old in text
        text = text.replace(old, new, 1)
    return text


# (what is wrong, edits, key, found, remedy)
MISTAKES = [
    # keys
    ("title missing", [('title = "Two', '# title = "Two')], "title", "no such key", "One line that says"),
    ("section missing", [('section = "square"\n', "")], "rods.lower.section", "no such key", "the [sections]"),
    ("rods missing", [("rods.lower", "x.lower"), ("rods.lower", "x.lower")], "x", "unknown key", "the keys"),
    ("load without force", [("force = [", "# [")], "loads #1.force", "no such key", "three components"),
    (
        "misspelt key",
        [("young_modulus", "youngs_modulus")],
        "materials.lower.youngs_modulus",
        "an unknown key",
        "did you mean 'young_modulus'?",
    ),
    (
        "misspelt table",
        [("[[supports]]", "[[support]]"), ("[[supports]]", "[[support]]")],
        "support",
        "an unknown key",
        "did you mean 'supports'?",
    ),
    (
        "unknown key",
        [("[rod_model]", "[rod_model]\ncolour = 3")],
        "rod_model.colour",
        "an unknown key",
        "'level', 'order'",
    ),
    # values
    ("mass for a length", [('width = "15 mm"', 'width = "200 kg"')], "sections.square.width", '"200 kg"', '"0.5 mm"'),
    ("stress for a gap", [('gap = "0.5 mm"', 'gap = "0.5 GPa"')], "contacts.overlap.gap", '"0.5 GPa"', "length"),
    ("unknown unit", [('"200 GPa"', '"200 gpa"')], "materials.lower.young_modulus", '"200 gpa"', '"200 GPa"'),
    ("decimal comma", [('"0.5 mm"', '"0,5 mm"')], "contacts.overlap.gap", '"0,5 mm"', "length"),
    ("negative width", [('width = "15 mm"', 'width = "-15 mm"')], "sections.square.width", "-15", "must be positive"),
    ("no height", [('height = "15 mm"', "height = 0")], "sections.square.height", "0", "must be positive"),
    ("no kind of gap", [('"0.5 mm"', '"draw"')], "contacts.overlap.gap", '"draw"', 'write "drawn"'),
    (
        "gap table without gaps",
        [('"0.5 mm"', "{ stations = [0, 1] }")],
        "contacts.overlap.gap.gaps",
        "no such key",
        "one length for each",
    ),
    (
        "gap at one station",
        [('"0.5 mm"', "{ stations = [0], gaps = [0] }")],
        "contacts.overlap.gap.stations",
        "[0]",
        "at least two",
    ),
    (
        "bad gap in a table",
        [('"0.5 mm"', "{ stations = [200, 300], gaps = [0, '1 N'] }")],
        "contacts.overlap.gap.gaps #2",
        '"1 N"',
        "a length",
    ),
    (
        "gaps that are too few",
        [('"0.5 mm"', "{ stations = [200, 250, 300], gaps = [0, 1] }")],
        "contacts.overlap.gap",
        "3 stations and 2 gaps",
        "as many of both",
    ),
    (
        "round gap nowhere",
        [('"0.5 mm"', "{ radius = 500 }")],
        "contacts.overlap.gap.station",
        "no such key",
        "Where the gap is least",
    ),
    (
        "keys of two gaps",
        [('"0.5 mm"', "{ radius = 500, stations = [0, 1], gaps = [0, 1] }")],
        "contacts.overlap.gap.radius",
        "unknown key",
        "it belongs to a table of 'radius', 'station', 'least'",
    ),
    # ground
    (
        "unknown ground",
        [('second = { rod = "upper", face = "bottom" }', 'second = { ground = "sand" }')],
        "contacts.overlap.second.ground",
        '"sand"',
        "'bed', 'rigid'",
    ),
    (
        "bed without modulus",
        [('second = { rod = "upper", face = "bottom" }', 'second = { ground = "bed" }')],
        "contacts.overlap.second.modulus",
        "no such key",
        '"50 N/mm^3"',
    ),
    (
        "rigid ground with a modulus",
        [('second = { rod = "upper", face = "bottom" }', 'second = { ground = "rigid", modulus = 50 }')],
        "contacts.overlap.second.modulus",
        "unknown key",
        'it belongs to ground = "bed"',
    ),
    (
        "face of ground",
        [('second = { rod = "upper", face', 'second = { ground = "rigid", face')],
        "contacts.overlap.second.face",
        "unknown key",
        "the keys here are 'ground'",
    ),
    (
        "misspelt ground",
        [('second = { rod = "upper", face = "bottom" }', 'second = { grund = "rigid" }')],
        "contacts.overlap.second.grund",
        "unknown key",
        "did you mean 'ground'?",
    ),
    (
        "ground that attracts",
        [('second = { rod = "upper", face = "bottom" }', 'second = { ground = "bed", modulus = -1 }')],
        "contacts.overlap.second.modulus",
        "-1",
        "must be positive",
    ),
    (
        "ground as drawn",
        [('second = { rod = "upper", face = "bottom" }', 'second = { ground = "rigid" }'), ('"0.5 mm"', '"drawn"')],
        "contacts.overlap.gap",
        "drawn",
        "say its gap",
    ),
    ("infinite length", [('width = "15 mm"', "width = inf")], "sections.square.width", "inf", "must be finite"),
    ("not a number", [("= 0.3", "= nan")], "materials.lower.poisson_ratio", "nan", "a number"),
    ("truth value for a number", [("= 0.3", "= true")], "materials.lower.poisson_ratio", "true", "a number"),
    ("truth value for a length", [('width = "15 mm"', "width = true")], "sections.square.width", "true", "a length"),
    ("ratio out of range", [("= 0.3", "= 0.5")], "materials.lower.poisson_ratio", "0.5", "between -1 and 0.5"),
    ("no stiffness", [('"200 GPa"', "0")], "materials.lower.young_modulus", "0", "must be positive"),
    ("no penalty", [('"1e6 N/mm^3"', "0")], "contacts.overlap.penalty", "0", "must be positive"),
    ("two components", [('["0 N", "-1 kN", "0 N"]', "[0, 1]")], "loads #1.force", "[0, 1]", "three components"),
    ("four numbers", [("[300, 0, 0]", "[3, 0, 0, 0]")], "rods.lower.centre_line.end", "[3, 0, 0, 0]", "three"),
    ("bad component", [('"-1 kN"', '"-1 km"')], "loads #1.force #2", '"-1 km"', "a force"),
    ("number for a table", [("first = {", "first = 3 #")], "contacts.overlap.first", "3", "such as { rod"),
    ("text for a list", [("zone = [", 'zone = "200" # [')], "contacts.overlap.zone", '"200"', "two rising"),
    ("unknown shape", [('"rectangle"', '"rectangel"')], "sections.square.shape", '"rectangel"', "mean 'rectangle'?"),
    ("shape of another kind", [('"rectangle"', "3")], "sections.square.shape", "3", "'box', 'circle', 'polygon'"),
    ("no shape", [('shape = "rectangle"', "")], "sections.square.shape", "no such key", "'rectangle', 'ring'"),
    ("keys of another shape", [('"rectangle"', '"circle"')], "sections.square.width", "unknown key", "'diameter'"),
    ("unknown line", [('shape = "line"', 'shape = "spiral"')], "rods.lower.centre_line.shape", '"spiral"', "'helix'"),
    (
        "twist as length",
        [("end = [300", 'twist = "3 mm"\nend = [300')],
        "rods.lower.centre_line.twist",
        "mm",
        '"90 deg"',
    ),
    ("unknown load", [('"section force"', '"line laod"')], "loads #1.kind", '"line laod"', "did you mean 'line load'?"),
    (
        "keys of another load",
        [('"section force"', '"line load"')],
        "loads #1.position",
        "unknown key",
        "'start', 'end'",
    ),
    (
        "force for a moment",
        [('"section force"', '"section moment"'), ("force = ", "moment = ")],
        "loads #1.moment #1",
        '"0 N"',
        '"1 N m"',
    ),
    ("unknown face", [('"top"', '"upper"')], "contacts.overlap.first.face", '"upper"', "'top', 'bottom'"),
    ("unknown end", [('end = "start"', 'end = "left"')], "supports #1.end", '"left"', "'start' or 'end'"),
    ("level 0", [("level = 5", "level = 0")], "rod_model.level", "0", "from 1 to 12"),
    ("level 13", [("level = 5", "level = 13")], "rod_model.level", "13", "from 1 to 12"),
    ("half a level", [("level = 5", "level = 2.5")], "rod_model.level", "2.5", "whole number"),
    ("level in words", [("level = 5", 'level = "h5"')], "rod_model.level", '"h5"', "whole number"),
    ("order 1", [("order = 6", "order = 1")], "rod_model.order", "1", "from 2 to 20"),
    ("a name that is markup", [("[sections.square]", '[sections."<b>"]')], "sections", '"<b>"', "letters"),
    # the scene
    (
        "unknown section",
        [('section = "square"', 'section = "sqare"')],
        "rods.lower.section",
        '"sqare"',
        "did you mean 'square'?",
    ),
    (
        "unknown material",
        [('material = "lower"', 'material = "wood"')],
        "rods.lower.material",
        '"wood"',
        "the [materials] are 'lower', 'upper'",
    ),
    (
        "unknown rod clamped",
        [('kind = "clamp"\nrod = "lower"', 'kind = "clamp"\nrod = "lowr"')],
        "supports #1.rod",
        '"lowr"',
        "the [rods] are 'lower', 'upper'; did you mean 'lower'?",
    ),
    (
        "unknown rod loaded",
        [('cross-section\nrod = "upper"', 'cross-section\nrod = "middle"')],
        "loads #1.rod",
        '"middle"',
        "the [rods] are 'lower', 'upper'",
    ),
    (
        "unknown rod in contact",
        [('{ rod = "lower"', '{ rod = "low"')],
        "contacts.overlap.first.rod",
        '"low"',
        "the [rods] are 'lower', 'upper'",
    ),
    (
        "rod against itself",
        [('{ rod = "upper"', '{ rod = "lower"')],
        "contacts.overlap.second.rod",
        "'lower'",
        "two different rods",
    ),
    (
        "borders out of order",
        [("[0, 66.67, 133.33", "[0, 133.33, 66.67")],
        "rods.lower.element_borders",
        "[0.0, 133.33, 66.67",
        "must increase",
    ),
    (
        "borders that end early",
        [("266.67, 300]", "266.67]")],
        "rods.lower.element_borders",
        "0 .. 266.67",
        "from 0 to 300 mm",
    ),
    ("one border", [("[0, 66.67, 133.33, 200, 233.33, 266.67, 300]", "[0]")], "rods.lower", "[0.0]", "two ends"),
    (
        "rod without length",
        [("end = [300, 0, 0]", "end = [0, 0, 0]")],
        "rods.lower.centre_line.end",
        "[0.0, 0.0, 0.0]",
        "must differ",
    ),
    (
        "up along the rod",
        [("up = [0, 1, 0]", "up = [1, 0, 0]")],
        "rods.lower.centre_line.up",
        "[1.0, 0.0, 0.0]",
        "not along the line",
    ),
    (
        "clamped twice",
        [('rod = "upper"\nend = "end"', 'rod = "lower"\nend = "start"')],
        "supports #2",
        "lower start again",
        "once",
    ),
    ("load outside", [('"166.67 mm"', '"0.4 m"')], "loads #1.position", "400", "from 0 to 300 mm"),
    ("load before", [('"166.67 mm"', '"-1 mm"')], "loads #1.position", "-1", "from 0 to 300 mm"),
    (
        "zone beyond the first rod",
        [('["200 mm", "300 mm"]', '["200 mm", "320 mm"]')],
        "contacts.overlap.zone",
        "200 .. 320",
        "from 0 to 300 mm",
    ),
    (
        "zone beyond the second rod",
        [('["200 mm", "300 mm"]', '["180 mm", "300 mm"]')],
        "contacts.overlap.zone",
        "180 .. 300",
        "rod 'upper' lies opposite rod 'lower' from 200 to 300 mm",
    ),
    (
        "zone backwards",
        [('["200 mm", "300 mm"]', '["300 mm", "200 mm"]')],
        "contacts.overlap.zone",
        "300 .. 200",
        "must rise",
    ),
    (
        "faces that look the same way",
        [('face = "bottom"', 'face = "top"')],
        "contacts.overlap.second.face",
        "'top', whose outward normal is turned by 0 degrees",
        "face each other",
    ),
    (
        "faces that look away from each other",
        [('face = "top"', 'face = "x"'), ('face = "bottom"', 'face = "top"'), ('"x"', '"bottom"')],
        "contacts.overlap.first.face",
        "'bottom', while rod 'upper' is drawn on the other side",
        "towards the second rod",
    ),
    (
        "rods side by side",
        [("[200, 15.5, 0]", "[200, 15.5, 15]"), ("[500, 15.5, 0]", "[500, 15.5, 15]")],
        "contacts.overlap.second.rod",
        "'upper', drawn 15 mm aside",
        "less than 15 mm",
    ),
    # what is compared
    (
        "unknown quantity",
        [('quantity = "contact_force"', 'quantity = "force"')],
        "compare #1.quantity",
        '"force"',
        "'contact_force'",
    ),
    (
        "a stress that does not converge",
        [('quantity = "end_moment_equilibrium"', 'quantity = "max_bending_stress"')],
        "compare #9.quantity",
        '"max_bending_stress"',
        "does not converge",
    ),
    (
        "a rod for a quantity of a contact",
        [('"contact_force"\ncontact = "overlap"', '"contact_force"\nrod = "upper"')],
        "compare #1.rod",
        '"upper"',
        "contact_force is of a contact",
    ),
    (
        "a quantity of nothing",
        [('"contact_force"\ncontact = "overlap"', '"contact_force"')],
        "compare #1.contact",
        "no such key",
        "one of 'overlap'",
    ),
    (
        "unknown contact",
        [('"contact_force"\ncontact = "overlap"', '"contact_force"\ncontact = "overlp"')],
        "compare #1.contact",
        '"overlp"',
        "did you mean 'overlap'?",
    ),
    ("absolute for relative", [('"0.3 %"', '"0.3 mm"')], "compare #1.tolerance", '"0.3 mm"', "relative"),
    ("bare tolerance", [('"0.3 %"', "0.3")], "compare #1.tolerance", "0.3", "with its unit"),
    ("no tolerance", [('"0.3 %"', '"0 %"')], "compare #1.tolerance", '"0 %"', "must be positive"),
    ("stress nowhere", [("point = ", "# ")], "compare #10.point", "no such key", "[x, y, s]"),
    ("stress outside", [("[0, 7.5, 285]", "[0, 8, 285]")], "compare #10.point", "[0.0, 8.0, 285.0]", "+-7.5"),
    (
        "compared twice",
        [('quantity = "contact_edges" ', 'quantity = "contact_centre" '), ('"1 mm"', '"1 mm"')],
        "compare #3",
        "contact_centre of overlap again",
        "once",
    ),
    # what is published
    ("odd edges", [('["200 mm", "207.47 mm"]', '["200 mm"]')], "published #1.value", '["200 mm"]', "in turn"),
    ("edges as stress", [('"207.47 mm"', '"207.47 MPa"')], "published #1.value", "MPa", "a length"),
    ("two stresses", [('"124.40 MPa"', "[1, 2]")], "published #2.value", "[1, 2]", "one value"),
    ("no source", [("source = ", "# ")], "published #1.source", "no such key", "Where the value is printed"),
    (
        "a deflection published nowhere",
        [('quantity = "max_bending_stress"', 'quantity = "deflection"'), ('"124.40 MPa"', "1")],
        "published #2.position",
        "no such key",
        "where on the rod",
    ),
    (
        "a deflection published off the rod",
        [
            ('quantity = "max_bending_stress"', 'quantity = "deflection"\nposition = 301\naxis = "Y"'),
            ('"124.40 MPa"', "1"),
        ],
        "published #2.position",
        "301",
        "from 0 to 300 mm",
    ),
    (
        "a place of a stress",
        [('quantity = "max_bending_stress"', 'quantity = "max_bending_stress"\nposition = 300')],
        "published #2.position",
        "300",
        "only a deflection",
    ),
    ("unknown truth", [('"e50_g05.json"', '"e5.json"')], "independent", '"e5.json"', "'e50_g05.json'"),
    ("truth elsewhere", [('"e50_g05.json"', '"../x.json"')], "independent", '"../x.json"', "'e50_g05.json'"),
]


# (what is wrong, edits of the case that uses everything, key, found, remedy)
MISTAKES_ANYWHERE = [
    # materials
    ("bare density", [('"7850 kg/m^3"', "7850")], "materials.steel.density", "7850", '"7850 kg/m^3"'),
    ("weight for mass", [('"7850 kg/m^3"', '"77 kN/m^3"')], "materials.steel.density", "kN", "a density with its unit"),
    ("thousand times too dense", [('"7850 kg/m^3"', '"7850 g/cm^3"')], "materials.steel.density", "7.85e-06", "denser"),
    ("no density", [('density = "7850 kg/m^3"\n', "")], "materials.steel.density", "no such key", "'beam' has weight"),
    ("unknown law", [('"orthotropic"', '"orthotrop"')], "materials.spruce.law", '"orthotrop"', "mean 'orthotropic'?"),
    ("law without name", [('law = "isotropic"', "law = 3")], "materials.rubber.law", "3", "'isotropic', 'orthotropic'"),
    (
        "keys of a law that was not named",
        [('law = "orthotropic"\n', "")],
        "materials.spruce.young_moduli",
        "an unknown key",
        "it belongs to law = \"orthotropic\"; did you mean 'young_modulus'?",
    ),
    ("one modulus", [('["0.8 GPa", "0.5 GPa", "11 GPa"]', '"11 GPa"')], "materials.spruce.young_moduli", "11", "three"),
    (
        "soft modulus",
        [('"0.5 GPa", "11 GPa"', '0, "11 GPa"')],
        "materials.spruce.young_moduli",
        "[800.0, 0.0",
        "positive",
    ),
    ("length as modulus", [('"11 GPa"', '"11 km"')], "materials.spruce.young_moduli #3", '"11 km"', "a stress"),
    ("ratios without energy", [("0.03, 0.02]", "0.03, 2]")], "materials.spruce.poisson_ratios", "2.0", "an energy"),
    # supports
    ("unknown support", [('kind = "mean"', 'kind = "pin"')], "supports #5.kind", '"pin"', "'clamp', 'mean', 'section'"),
    ("support of nothing", [('"mean"\nrod = "beam"', '"mean"\nrod = "bean"')], "supports #5.rod", '"bean"', "'beam'?"),
    ("support off the rod", [('"0.4 m"', '"0.5 m"')], "supports #5.position", "500", "from 0 to 400 mm"),
    (
        "keys of another support",
        [('position = "0.4 m"', 'end = "end"')],
        "supports #5.end",
        "an unknown key",
        'it belongs to kind = "clamp"',
    ),
    (
        "turn of a whole section",
        [('["y", "s"]', '["y", "turn s"]')],
        "supports #3.components #2",
        '"turn s"',
        "hold its mean rotation with kind = 'mean'",
    ),
    ("global axis", [('["y", "s"]', '["Y", "s"]')], "supports #3.components #1", '"Y"', "write 'x', 'y' or 's'"),
    (
        "turn about nothing",
        [('"turn x"]', '"turn z"]')],
        "supports #5.components #2",
        '"turn z"',
        "'turn y' or 'turn s'",
    ),
    ("component twice", [('["y", "s"]', '["y", "y"]')], "supports #3.components", "['y', 'y']", "name each once"),
    ("no component", [('["y", "s"]', "[]")], "supports #3.components", "[]", "at least one"),
    ("component without list", [('["y", "s"]', '"y"')], "supports #3.components", '"y"', "a list of at least one"),
    ("displacements missing", [('[-0.5, "1 deg"]', "[-0.5]")], "supports #5.displacement", "[-0.5]", "'y', 'turn x'"),
    ("length of a turn", [('"1 deg"]', '"1 mm"]')], "supports #5.displacement #2", '"1 mm"', "for 'turn x' an angle"),
    ("angle of a length", [("[-0.5,", '["1 deg",')], "supports #5.displacement #1", '"1 deg"', "for 'y' a length"),
    (
        "turn in degrees",
        [('[-0.5, "1 deg"]', "[-0.5, 5]")],
        "supports #5.displacement",
        "[-0.5, 5.0]",
        "1 deg is 0.01745",
    ),
    ("clamp in degrees", [('["0.5 deg", 0, 0]', "[5, 0, 0]")], "supports #2.rotation", "[5.0, 0.0", "1 deg is 0.01745"),
    ("turned by a length", [('["0.5 deg", 0', '["5 mm", 0')], "supports #2.rotation #1", '"5 mm"', "an angle"),
    ("moved by an angle", [('[0, "-1 mm", 0]', '[0, "1 deg", 0]')], "supports #2.displacement #2", "deg", "a length"),
    (
        "supported twice",
        [('rod = "strip"\nposition = 0', 'rod = "post"\nposition = 0')],
        "supports #3",
        "post at 0 mm again",
        "once",
    ),
    # joints
    (
        "one end",
        [('joints]]\nends = [{ rod = "post", end = "end" }, ', "joints]]\nends = [] # ")],
        "joints #1.ends",
        "[]",
        "two",
    ),
    (
        "unknown end",
        [('"brace", end = "start"', '"brace", end = "top"')],
        "joints #1.ends #3.end",
        '"top"',
        "'start' or",
    ),
    (
        "joint of nothing",
        [('"brace", end', '"brase", end')],
        "joints #1.ends #3.rod",
        '"brase"',
        "did you mean 'brace'?",
    ),
    (
        "joined afar",
        [('"brace", end = "start"', '"brace", end = "end"')],
        "joints #1.ends #3",
        "424.264 mm",
        "one point",
    ),
    (
        "joined twice",
        [('"brace", end = "start"', '"post", end = "end"')],
        "joints #1.ends #3",
        "post end again",
        "once",
    ),
    (
        "joined and supported",
        [('rod = "beam"\nposition = "0.4 m"', 'rod = "beam"\nposition = 0')],
        "joints #1.ends #2",
        "beam start, which has a support",
        "elsewhere",
    ),
    ("joint as one table", [("[[joints]]", "[joints]")], "joints", "a table", "one [[joints]] for each"),
    # beds
    ("wall like foil", [('wall = "2 mm"', 'wall = "2e-5 mm"')], "sections.hollow.wall", "2e-05 mm thick", "1e-05 of"),
    ("tube like foil", [("_diameter = 8", "_diameter = 9.9999")], "sections.tube.inner_diameter", "thick", "1e-05 of"),
    ("flat as paper", [('height = "2 cm"', "height = 1e9")], "sections.square.width", "20 mm thick", "1e-05 of"),
    (
        "pinched",
        [("[9, 0], [0, 9]", "[9, 0], [9, 3], [3, 3], [3, 1e-30], [0, 9]")],
        "sections.angle.",
        "thick",
        "1e-05",
    ),
    ("bed on a wire", [('"beam", face = "b', '"spring", face = "b')], "beds #1.face.rod", "a circle", "flat faces"),
    (
        "bed of nothing",
        [('"beam", face = "b', '"bean", face = "b')],
        "beds #1.face.rod",
        '"bean"',
        "did you mean 'beam'?",
    ),
    ("bed below", [('face = "bottom"', 'face = "below"')], "beds #1.face.face", '"below"', "'top', 'bottom'"),
    ("bed backwards", [('"200 mm"', '"350 mm"')], "beds #1.start", "350 .. 300", "a rising stretch"),
    ("stiffness for modulus", [('"0.05 N/mm^3"', '"5 N/mm"')], "beds #1.modulus", '"5 N/mm"', "a stress per length"),
    ("bed that pushes", [('"0.05 N/mm^3"', "-1")], "beds #1.modulus", "-1", "must be positive"),
    # loads
    (
        "pressure on a wire",
        [('"strip", face = "t', '"snake", face = "t')],
        "loads #5.face.rod",
        "a circle",
        "flat faces",
    ),
    (
        "pressure nowhere",
        [('"strip", face = "t', '"stripe", face = "t')],
        "loads #5.face.rod",
        '"stripe"',
        "mean 'strip'?",
    ),
    (
        "pressure without face",
        [('face = { rod = "strip", face = "top" }', 'rod = "strip"')],
        "loads #5.rod",
        "an unknown key",
        'it belongs to kind = "line load", "section force", "section moment"',
    ),
    # gravity stands for two loads of the scene, so the file's number is not the scene's
    ("pressure beyond the end", [("end = 300", "end = 401")], "loads #5.start", "100 .. 401", "from 0 to 400 mm"),
    ("force as pressure", [('"2 bar"', '"2 N"')], "loads #5.pressure", '"2 N"', "a stress"),
    ("bare gravity", [('"-9.81 m/s^2"', "-9.81")], "loads #1.acceleration #2", "-9.81", '"9.81 m/s^2"'),
    ("gravity as speed", [('"-9.81 m/s^2"', '"-9.81 m/s"')], "loads #1.acceleration #2", '"-9.81 m/s"', "acceleration"),
    ("gravity without direction", [('[0, "-9.81 m/s^2", 0]', '"1 m/s^2"')], "loads #1.acceleration", '"1', "three"),
    (
        "weight of a material without",
        [('"post", "beam"]', '"strip"]')],
        "materials.rubber.density",
        "no such",
        "'strip'",
    ),
    ("weight of all", [('rods = ["post", "beam"]\n', "")], "materials.rubber.density", "no such key", "'strip' has"),
    ("weight of nothing", [('["post", "beam"]', '["post", "bean"]')], "loads #1.rods #2", '"bean"', "mean 'beam'?"),
    ("weight twice", [('["post", "beam"]', '["post", "post"]')], "loads #1.rods #2", '"post"', "each rod once"),
    ("weight of none", [('["post", "beam"]', "[]")], "loads #1.rods", "[]", "at least one"),
    # centre lines
    (
        "two points",
        [(', [100, 0, 2000], [150, 0, 2020], ["20 cm", 0, 2000]]', "]")],
        "rods.snake.centre_line.points",
        "[[0",
        "three",
    ),
    ("point twice", [("[50, 20, 2000]", "[0, 0, 2000]")], "rods.snake.centre_line.points #2", "again", "must differ"),
    (
        "point in a plane",
        [("[50, 20, 2000]", "[50, 20]")],
        "rods.snake.centre_line.points #2",
        "[50, 20]",
        "three lengths",
    ),
    (
        "mass in a point",
        [("[50, 20, 2000]", '["1 kg", 20, 2000]')],
        "rods.snake.centre_line.points #2 #1",
        "kg",
        "length",
    ),
    (
        "unknown frame",
        [('frame = "up"', 'frame = "fixed"')],
        "rods.snake.centre_line.frame",
        '"fixed"',
        "minimal rotation",
    ),
    (
        "path within a path",
        [('shape = "arc"', 'shape = "path"')],
        "rods.hook.centre_line.pieces #2.shape",
        '"path"',
        "'arc', 'helix', 'line', 'spline'",
    ),
    (
        "piece that cannot be",
        [("axis = [0, 0, 1]", "axis = [0, 0, 0]")],
        "rods.hook.centre_line.pieces #2.axis",
        "[0.0, 0.0, 0.0]",
        "a direction",
    ),
    (
        "pieces apart",
        [('"arc"\nstart = [100, 0, 900]', '"arc"\nstart = [101, 0, 900]')],
        "rods.hook.centre_line.pieces #2",
        "1 mm from the end of piece #1",
        "[100, 0, 900]",
    ),
    # levels and orders
    ("levels missing", [("[5, 4, 3]", "[5, 4]")], "rod_model.levels.beam", "[5, 4]", "rod 'beam' has 3"),
    ("level too high", [("[5, 4, 3]", "[5, 4, 13]")], "rod_model.levels.beam", "[5, 4, 13]", "from 1 to 12"),
    ("half a level", [("[5, 4, 3]", "[5, 4.5, 3]")], "rod_model.levels.beam", "[5, 4.5, 3]", "a whole number"),
    ("level of nothing", [("beam = [5", "bean = [5")], "rod_model.levels.bean", '"bean"', "did you mean 'beam'?"),
    (
        "levels in words",
        [("[5, 4, 3]", '"high"')],
        "rod_model.levels.beam",
        '"high"',
        "a list with one for each element",
    ),
    ("order too low", [("[6, 4, 4]", "1")], "rod_model.orders.beam", "1", "from 2 to 20"),
    ("no level for the others", [("level = 3\n", "")], "rod_model.level", "no such key", "[rod_model.levels]"),
]


@pytest.mark.parametrize(
    ("text", "edits", "key", "found", "remedy"),
    [pytest.param(GOOD, *mistake[1:], id=mistake[0]) for mistake in MISTAKES]
    + [pytest.param(EVERYTHING, *mistake[1:], id=f"anywhere: {mistake[0]}") for mistake in MISTAKES_ANYWHERE],
)
def test_a_mistake_is_named_with_file_key_find_and_remedy(message, text, edits, key, found, remedy):
    sentence = message(edited(*edits, text=text))

    start, _, rest = sentence.partition(": found ")
    assert start.startswith(f"mine.toml: {key}")
    assert found in rest.partition("; ")[0]
    assert remedy in rest.partition("; ")[2]
    assert "\n" not in sentence


def test_a_case_that_nothing_holds_is_refused(message):
    start, _, rest = EVERYTHING.partition("[[supports]]")
    no_supports = start + "[[loads]]" + rest.partition("[[loads]]")[2]
    no_supports = no_supports.partition("[contacts.rest]")[0] + "[rod_model]" + rest.partition("[rod_model]")[2]

    assert message(no_supports).startswith("mine.toml: supports: found no such key; needed: one [[supports]] for each")


def test_a_bed_alone_may_hold_a_case(scene):
    start, _, rest = EVERYTHING.partition("[[supports]]")

    assert scene(start + "[[beds]]" + rest.partition("[[beds]]")[2]).supports == ()


def test_contact_alone_may_hold_a_case(scene):
    start, _, rest = EVERYTHING.partition("[[supports]]")

    assert scene(start + "[[loads]]" + rest.partition("[[loads]]")[2]).supports == ()


def test_a_case_with_no_mistake_loads(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_text(GOOD, encoding="utf-8")

    case = load_case(path)

    assert case.name == case.scene.name == "mine"
    assert case.scene.rods == load_case("two-cantilevers-e50-g05").scene.rods


def test_a_small_edit_makes_a_new_case(tmp_path):
    path = tmp_path / "stiffer.toml"
    path.write_text(edited(('"50 GPa"', '"0.1 TPa"'), ('gap = "0.5 mm"', "gap = 0.25")), encoding="utf-8")

    scene = load_case(str(path)).scene

    assert scene.rod("upper").material.young_modulus == 100000.0
    assert scene.contact("overlap").gap == 0.25


def test_of_several_problems_the_first_is_told_and_the_others_counted(message):
    text = message(edited(('"200 GPa"', '"200 kg"'), ("level = 5", "level = 0"), ('width = "15 mm"', 'width = "15 s"')))

    assert text.startswith("mine.toml: materials.lower.young_modulus: found ")
    assert text.endswith(" (and 2 more problems)")


def test_a_misspelt_key_is_not_reported_as_missing_too(message):
    text = message(edited(("poisson_ratio", "poison_ratio")))

    assert text == ("mine.toml: materials.lower.poison_ratio: found an unknown key; did you mean 'poisson_ratio'?")


ARC = """shape = "arc"
start = [100, 0, 0]
centre = [0, 0, 0]
axis = [0, 0, 1]
angle = "90 deg"
up = [0, 0, 1]"""
SQUARE = '''shape = "rectangle"
width = "10 mm"
height = "10 mm"'''
FORCE = """kind = "section force"
rod = "spring"
position = "50 mm"
force = [0, 0, "-2 N"]"""


def single(section=SQUARE, line=ARC, load=FORCE, borders="[0, 157.08]", more=""):
    """A case of one rod."""
    return f"""
title = "One rod"
[materials.steel]
young_modulus = "200 GPa"
poisson_ratio = 0.3
[sections.profile]
{section}
[rods.spring]
section = "profile"
material = "steel"
element_borders = {borders}
[rods.spring.centre_line]
{line}
[[supports]]
kind = "clamp"
rod = "spring"
end = "start"
[[loads]]
{load}
[rod_model]
level = 3
order = 5
{more}
"""


@pytest.fixture
def scene(tmp_path):
    """The scene of a case file of this content."""

    def load(content):
        path = tmp_path / "mine.toml"
        path.write_text(content, encoding="utf-8")
        return load_case(path).scene

    return load


@pytest.mark.parametrize(
    ("section", "meant"),
    [
        ('shape = "circle"\ndiameter = "1 cm"', Circle(10.0)),
        ('shape = "ring"\nouter_diameter = 10\ninner_diameter = 8', Ring(10.0, 8.0)),
        ('shape = "box"\nwidth = 10\nheight = 20\nwall = "1 mm"', Box(10.0, 20.0, 1.0)),
        (
            'shape = "polygon"\nouter = [[0, 0], ["9 mm", 0], [0, 9]]\nholes = [[[1, 1], [2, 1], [1, 2]]]',
            Polygon(((0.0, 0.0), (9.0, 0.0), (0.0, 9.0)), (((1.0, 1.0), (2.0, 1.0), (1.0, 2.0)),)),
        ),
    ],
)
def test_every_section_can_be_written(scene, section, meant):
    assert scene(single(section=section)).rods[0].section == meant


@pytest.mark.parametrize(
    ("line", "borders", "meant"),
    [
        (ARC, "[0, 157.08]", Helix((100, 0, 0), (0, 0, 0), (0, 0, 1), math.pi / 2, (0, 0, 1))),
        (
            ARC.replace("arc", "helix").replace("90", "1080") + "\npitch = -30",
            "[0, 1887.1]",
            Helix((100, 0, 0), (0, 0, 0), (0, 0, 1), 6 * math.pi, (0, 0, 1), -30.0),
        ),
        (
            'shape = "line"\nstart = [0, 0, 0]\nend = [60, 0, 0]\nup = [0, 1, 0]\ntwist = "-45 deg"',
            "[0, 60]",
            Line((0, 0, 0), (60, 0, 0), (0, 1, 0), -math.pi / 4),
        ),
    ],
)
def test_every_centre_line_can_be_written(scene, line, borders, meant):
    rod = scene(single(line=line, borders=borders)).rods[0]

    assert rod.centre_line == meant
    assert rod.element_borders[-1] == meant.length  # the rounded border is set to it


@pytest.mark.parametrize(
    ("load", "meant"),
    [
        (FORCE, SectionForce("spring", 50.0, (0.0, 0.0, -2.0))),
        (
            FORCE.replace("force", "moment").replace("-2 N", "3 N m"),
            SectionMoment("spring", 50.0, (0.0, 0.0, 3000.0)),
        ),
        (
            'kind = "line load"\nrod = "spring"\nstart = 0\nend = "50 mm"\nforce = [0, "2 kN/m", 0]',
            LineLoad("spring", 0.0, 50.0, (0.0, 2.0, 0.0)),
        ),
    ],
)
def test_every_load_can_be_written(scene, load, meant):
    assert scene(single(load=load)).loads == (meant,)


HOLLOW = 'shape = "ring"\nouter_diameter = 10\ninner_diameter = 8'
POLYGON = 'shape = "polygon"\nouter = [[0, 0], [9, 0], [9, 9], [0, 9]]'
LINE_LOAD = 'kind = "line load"\nrod = "spring"\nstart = 20\nend = 40\nforce = [0, 2, 0]'


def stress_at(point):
    return f'[[compare]]\nquantity = "stress_s"\nrod = "spring"\npoint = {point}\ntolerance = "1 %"'


@pytest.mark.parametrize(
    ("content", "key", "found", "remedy"),
    [
        (
            single(section=HOLLOW.replace("= 8", "= 12")),
            "sections.profile.outer_diameter",
            "10",
            "larger than",
        ),
        (
            single(section=POLYGON.replace("[9, 9], [0, 9]", "[0, 9], [9, 9]")),
            "sections.profile.outer",
            "cross",
            "order",
        ),
        (single(section=POLYGON.replace(", [9, 9], [0, 9]", "")), "sections.profile.outer", "2 corners", "three"),
        (single(section=POLYGON.replace("[9, 9]", "[9]")), "sections.profile.outer #3", "[9]", "pairs of lengths"),
        (single(section=POLYGON.replace("[9, 9]", '["9 kg", 9]')), "sections.profile.outer #3 #1", "kg", "a length"),
        (
            single(section=POLYGON + "\nholes = [[[8, 8], [12, 8], [8, 12]]]"),
            "sections.profile.holes #1",
            "beyond the outer edges",
            "within",
        ),
        (single(section=SQUARE.replace('"10 mm"', "300")), "rods.spring.centre_line", "100 mm", "larger than"),
        (single(line=ARC.replace("[100, 0, 0]", "[0, 0, 5]")), "rods.spring.centre_line.start", "[0", "on the axis"),
        (single(line=ARC.replace('"90 deg"', '"-90 deg"')), "rods.spring.centre_line.angle", "-1.5708", "positive"),
        (single(line=ARC.replace('"90 deg"', '"90 mm"')), "rods.spring.centre_line.angle", '"90 mm"', '"90 deg"'),
        (single(line=ARC.replace("up = [0, 0, 1]", "up = [0, 1, 0]")), "rods.spring.centre_line.up", "[0", "along"),
        (single(line=ARC.replace("arc", "helix")), "rods.spring.centre_line.pitch", "no such key", "one full turn"),
        (single(line=ARC + "\npitch = 3"), "rods.spring.centre_line.pitch", "unknown key", "'angle'"),
        (single(borders="[0, 150]"), "rods.spring.element_borders", "0 .. 150", "157.08"),
        (single(load=LINE_LOAD.replace("40", "10")), "loads #1.start", "20 .. 10", "rising stretch"),
        (single(load=LINE_LOAD.replace("40", "400")), "loads #1.start", "20 .. 400", "runs from 0 to 157.08 mm"),
        (single(load=LINE_LOAD.replace("2, 0]", '"2 N", 0]')), "loads #1.force #2", '"2 N"', "force per length"),
        (single(section=HOLLOW, more=stress_at("[0, 3, 9]")), "compare #1.point", "[0.0, 3.0, 9.0]", "between 4 and 5"),
        (single(section=POLYGON, more=stress_at("[5, 0, 9]")), "compare #1.point", "[5.0", "counted from the centroid"),
    ],
)
def test_a_mistake_in_any_shape_or_load_is_named_likewise(message, content, key, found, remedy):
    text = message(content)

    start, _, rest = text.partition(": found ")
    assert start == f"mine.toml: {key}"
    assert found in rest.partition("; ")[0]
    assert remedy in rest.partition("; ")[2]


@pytest.mark.parametrize(
    ("section", "point"),
    [
        (SQUARE, "[5, -5, 0]"),
        (HOLLOW, "[0, -4, 0]"),
        ('shape = "circle"\ndiameter = 10', "[3, 4, 0]"),
        ('shape = "box"\nwidth = 10\nheight = 20\nwall = 1', "[4, 0, 0]"),
        (POLYGON, "[4.5, 4.5, 0]"),
        (POLYGON + "\nholes = [[[4, 4], [5, 4], [5, 5], [4, 5]]]", "[0.5, 0.5, 0]"),
    ],
)
def test_a_stress_may_be_asked_for_on_the_border_of_a_section(scene, section, point):
    assert scene(single(section=section, more=stress_at(point))).rods


LINE_OF_LOADS = f"line {GOOD.splitlines().index('[[loads]]') + 1}"


@pytest.mark.parametrize(
    ("content", "found", "remedy"),
    [
        pytest.param("", "an empty file", "copy a case of the library", id="empty"),
        pytest.param("# nothing yet\n", "an empty file", "copy a case of the library", id="comments only"),
        pytest.param("a = \n", "text that is not TOML", "line 1", id="not TOML"),
        pytest.param(edited(("[[loads]]", "[[loads]")), "text that is not TOML", LINE_OF_LOADS, id="broken table"),
        pytest.param(GOOD + "\n[rods.lower]\n", "text that is not TOML", "'rods', 'lower'", id="rod declared twice"),
        pytest.param(edited(("0.3", "0.3\npoisson_ratio = 0.3")), "text that is not TOML", "line", id="key twice"),
        pytest.param("a = " + "[" * 100000, "tables or lists nested", "30 levels", id="nested too deeply"),
        pytest.param(".".join(["a"] * 5000) + " = 1", "tables or lists nested", "30 levels", id="deep key"),
        pytest.param("a = [{" + ".".join(["b"] * 29) + " = 1}]", "tables or lists nested", "30", id="deep in a list"),
        pytest.param(GOOD + "#" * 1_000_000, "1 MB", "at most 1 MB", id="too large"),
        pytest.param("a = 1" + "0" * 5000, "text that is not TOML", "digits", id="endless number"),
        pytest.param(b"\x89PNG\r\n\x1a\n\x00\xff", "something other than text", "TOML", id="binary"),
    ],
)
def test_a_file_that_is_no_case_is_named(message, content, found, remedy):
    text = message(content)

    assert text.startswith("mine.toml: found ")
    assert found in text
    assert remedy in text
    assert "\n" not in text


@pytest.mark.parametrize(
    ("old", "new", "found"),
    [
        ('title = "Two', 'title = "Two\\nlines and', '"Two\\nlines and'),
        ('title = "Two', 'title = "\\u001b[2JTwo', '"\\u001b[2JTwo'),
        ('title = "Two', 'title = "\u202eTwo', '"\\u202eTwo'),
        ("Two cantilevers overlap", "\\u0007Two cantilevers overlap", '"\\u0007Two'),
        ("[materials.lower]", '"\\u009b2J" = 1\n[materials.lower]', "an unknown key"),
        ("[materials.lower]", "x" * 3000 + " = 1\n[materials.lower]", "an unknown key"),
    ],
)
def test_what_would_steer_a_terminal_is_refused_and_not_passed_on(message, old, new, found):
    text = message(edited((old, new)))

    assert f"found {found}" in text or found in text
    assert text.isprintable()
    assert len(text) < 600


@pytest.mark.parametrize(
    "name", ["<script>alert(1)</script>", ".hidden", "a\nb", "..", "--output", "x" * 150, "a'b", "%2e"]
)
def test_a_file_name_that_pages_and_results_cannot_have_is_refused(tmp_path, name):
    path = tmp_path / f"{name}.toml".replace("/", "")
    path.write_text(GOOD, encoding="utf-8")

    with pytest.raises(CaseError, match=r"found the file name .*; rename it with letters") as caught:
        load_case(path)

    assert str(caught.value).isprintable()


def test_a_file_name_may_be_of_any_alphabet(tmp_path):
    path = tmp_path / "Träger 梁, E = 50 (2).toml"
    path.write_text(GOOD, encoding="utf-8")

    assert load_case(path).name == "Träger 梁, E = 50 (2)"


def test_line_ends_and_byte_order_mark_of_other_systems_do_not_matter(tmp_path):
    path = tmp_path / "mine.toml"
    path.write_bytes(b"\xef\xbb\xbf" + GOOD.replace("\n", "\r\n").encode())

    assert load_case(path).scene.rods == load_case("two-cantilevers-e50-g05").scene.rods


def test_an_unreadable_file_is_named(tmp_path, monkeypatch):
    path = tmp_path / "mine.toml"
    path.write_text(GOOD, encoding="utf-8")

    def refuse(*_args, **_kwargs):
        raise PermissionError(13, "Permission denied")

    # Tests may run as root, for whom every file is readable.
    monkeypatch.setattr("pathlib.Path.read_text", refuse)

    with pytest.raises(CaseError, match=r"cannot be read \(Permission denied\); give a readable one"):
        load_case(path)


def test_a_folder_is_not_a_case(tmp_path):
    with pytest.raises(CaseError, match="found a folder; give the path of a case file"):
        load_case(tmp_path)


@pytest.mark.parametrize(
    "name", ["two-cantilever-e50-g0", "two-cantilevers-e50-g0.tml", "cases/two-cantilevers-e50-g0"]
)
def test_an_unknown_name_brings_the_nearest_one_and_the_hint_that_paths_work(name):
    sentence = f'"{name}": found neither a case of the library nor a file; '
    hint = "did you mean 'two-cantilevers-e50-g0', and a path will do too"

    with pytest.raises(CaseError, match=re.escape(sentence + hint)):
        load_case(name)


@pytest.mark.parametrize("name", ["", "zzz", "a\0b", "x" * 5000, "../nowhere/zzz.toml"])
def test_a_name_like_no_other_is_refused_in_one_line(name):
    with pytest.raises(CaseError, match="`rodcheck list`") as caught:
        load_case(name)

    assert "\n" not in str(caught.value)
    assert len(str(caught.value)) < 250


def test_a_library_case_is_found_from_any_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)

    assert load_case(library_names()[0]).name == library_names()[0]


CURVED = single(
    section=POLYGON + "\nholes = [[[1, 1], [2, 1], [1, 2]]]",
    line=ARC.replace("arc", "helix") + "\npitch = 0",
    load=LINE_LOAD,
    more=stress_at("[0, 4, 9]"),
)


@pytest.mark.slow
@given(data=st.data())
def test_no_edit_of_a_line_gives_anything_but_a_case_or_a_sentence(data, tmp_path_factory):
    lines = data.draw(st.sampled_from([GOOD, CURVED, EVERYTHING])).splitlines()
    index = data.draw(st.integers(0, len(lines) - 1))
    key = lines[index].partition("=")[0]
    value = data.draw(
        st.sampled_from(["", "0", "-1", "1e300", "nan", "true", '""', "[]", "{}", "[[1]]", "1979-05-27", '"9 mm"'])
    )
    new = data.draw(st.sampled_from(["", f"{key}= {value}", f"x = {value}", f"[{value}]"]))
    path = tmp_path_factory.mktemp("edited") / "mine.toml"
    path.write_text("\n".join([*lines[:index], new, *lines[index + 1 :]]), encoding="utf-8")

    try:
        load_case(path)
    except CaseError as error:
        assert len(str(error).splitlines()) == 1  # noqa: PT017 - a case is an answer too
