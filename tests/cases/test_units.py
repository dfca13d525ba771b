"""Numbers with units: what is accepted, what it means, and what is refused."""

import contextlib
import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cases.units import UnitError, to_unit


@pytest.mark.parametrize(
    ("written", "unit", "meant"),
    [
        (15, "mm", 15.0),
        (0.5, "mm", 0.5),
        ("0.5 mm", "mm", 0.5),
        ("0.5mm", "mm", 0.5),
        (" 1.5e-2 m ", "mm", 15.0),
        ("1 in", "mm", 25.4),
        ("500 µm", "mm", 0.5),
        ("-1 kN", "N", -1000.0),
        ("200 GPa", "MPa", 200000.0),
        ("0.2 TPa", "MPa", 200000.0),
        ("2e5 N/mm^2", "MPa", 200000.0),
        ("2e5 N/mm**2", "MPa", 200000.0),
        ("1e6 N/mm^3", "N/mm^3", 1e6),
        ("1 TPa/m", "N/mm^3", 1e3),
        ("2 kN m", "N mm", 2e6),
        ("2 kN*m", "N mm", 2e6),
        ("2 kN/m", "N/mm", 2.0),
        ("7850 kg/m^3", "t/mm^3", 7.85e-9),
        ("7.85 g/cm^3", "t/mm^3", 7.85e-9),
        ("7.85e-9 t/mm^3", "t/mm^3", 7.85e-9),
        ("-9.81 m/s^2", "mm/s^2", -9810.0),
        ("9810 mm/s^2", "mm/s^2", 9810.0),
        (0, "mm/s^2", 0.0),
        ("180 deg", "rad", math.pi),
        ("1080 deg", "rad", 6.0 * math.pi),
        ("0.25 rad", "rad", 0.25),
        (0.25, "rad", 0.25),
        ("0.1 %", "%", 0.001),
        ("0.1%", "%", 0.001),
    ],
)
def test_a_number_is_taken_in_its_unit(written, unit, meant):
    # Decimal arithmetic in between: the same double as the one typed, not merely close to it.
    assert to_unit(written, unit) == meant


@pytest.mark.parametrize(
    ("written", "unit"),
    [
        ("200 kg", "mm"),
        ("1 GPa", "mm"),
        ("5 foo", "mm"),
        ("15", "mm"),
        ("mm", "mm"),
        ("", "mm"),
        ("1,5 mm", "mm"),  # pint alone reads 15 mm
        ("1 5 mm", "mm"),
        ("2*3 mm", "mm"),
        ("1 mm mm", "mm"),
        ("1 mm/", "mm"),
        ("1 mm; 2 mm", "mm"),
        ("0.1 mm", "%"),
        ("1 mm/m", "%"),
        ("1 deg", "%"),
        ("1 mm/m", "rad"),
        ("10 %", "rad"),
        ("90", "rad"),
        ("9.81 m/s", "mm/s^2"),
        ("9.81", "mm/s^2"),
        (9.81, "mm/s^2"),
        (7850, "t/mm^3"),
        ("77 kN/m^3", "t/mm^3"),
        (False, "mm/s^2"),
        (0.1, "%"),
        ("nan mm", "mm"),
        ("inf mm", "mm"),
        ("1e999 mm", "mm"),
        ("1e400 mm", "mm"),
        (math.nan, "mm"),
        (math.inf, "mm"),
        (10**400, "mm"),
        (True, "mm"),
        (None, "mm"),
        ([1], "mm"),
        ({"a": 1}, "mm"),
    ],
)
def test_anything_else_is_refused_with_a_remedy(written, unit):
    with pytest.raises(UnitError, match=r"is needed, such as|must be finite"):
        to_unit(written, unit)


finite = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12)


@given(value=finite)
def test_a_number_written_in_the_own_unit_keeps_every_digit(value):
    assert to_unit(f"{value!r} mm", "mm") == value == to_unit(value, "mm")


@given(value=finite, prefix=st.sampled_from([("k", 1e-3), ("M", 1.0), ("G", 1e3), ("T", 1e6)]))
def test_prefixes_scale_by_powers_of_ten(value, prefix):
    symbol, factor = prefix

    stress = to_unit(f"{value!r} {symbol}Pa", "MPa")

    assert stress == pytest.approx(value * factor, rel=4e-16)  # the product on the right rounds


@given(text=st.text(max_size=30))
def test_no_text_raises_anything_but_a_unit_error(text):
    for written in (text, f"1 {text}", f"1 mm{text}"):
        with contextlib.suppress(UnitError):
            assert math.isfinite(to_unit(written, "mm"))
