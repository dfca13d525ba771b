"""`rodcheck sweep`: keys and ranges are understood or refused in one sentence, rows are those of single solutions."""

from __future__ import annotations

import csv
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
import pytest

import rodmodel as rm
from reports.command_line import run
from reports.quantities import evaluate
from reports.sweep.keys import SweepError, sweep_points, variation
from reports.sweep.run import sweep_rows

CASE = "two-cantilevers-e50-g0"


def test_ranges_have_units_counts_and_even_steps_or_ratios() -> None:
    even = variation("rods.upper.E=20..200GPa:10")
    ratios = variation("contacts.overlap.penalty = 1e4 .. 1e6 N/mm^3 : 3 : log")
    components = variation("loads.1.force.2=-2..-0.1 kN:2")

    np.testing.assert_allclose(even.values, np.arange(20.0, 201.0, 20.0), rtol=1e-14)
    assert (even.key, even.unit) == ("rods.upper.E", "GPa")
    np.testing.assert_allclose(ratios.values, [1e4, 1e5, 1e6], rtol=1e-14)
    assert ratios.unit == "N/mm^3"
    assert components.values == (-2.0, -0.1)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("rods.upper.E", "write KEY=FIRST..LAST UNIT:COUNT"),
        ("rods.upper.E=20GPa:30", "write KEY=FIRST..LAST UNIT:COUNT"),
        ("rods.upper.E=20..200GPa:1", "found 1 values; a sweep has 2"),
        ("rods.upper.E=20..20GPa:5", "give two different"),
        ("rods.upper.E=0..20GPa:5:log", "both must be above zero"),
        ("rods.upper.E=20MPa..20GPa:5", "write one, at the end"),
        ("rods.upper.Q=20..200GPa:3", "the nearest are rods.upper."),
        ("rods.uper.E=20..200GPa:3", "the nearest are rods.upper.E"),
        ("loads.2.force.2=-2..-1kN:3", "the nearest are loads.1."),
        ("loads.1.force=-2..-1kN:3", "which is a list; name one of its numbers, such as loads.1.force.1"),
        ("rods.upper.section=1..2:3", "name a key that holds a number"),
        ("compare=1..2:3", "which is a list; name a key that holds a number"),
        ("rods.upper.E=20..200mm:3", 'a stress is needed, such as 200000 (MPa) or "200 GPa"'),
        ("rods.upper.E=-20..200GPa:3", "Young's modulus"),
        ("sections.square.width=-15..15mm:3", "sections.square.width = -15 mm does not make a case"),
    ],
)
def test_what_cannot_be_swept_is_refused_in_one_sentence(
    text: str, says: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "sweep"

    code = run(["sweep", CASE, "--vary", text, "--output", str(output)])

    message = capsys.readouterr().err
    assert code == 2
    assert says in message
    assert message.count("\n") == 1
    assert not output.exists()


def test_a_key_of_a_rod_changes_that_rod_alone() -> None:
    # Both rods have the one section of the file.
    points = sweep_points(CASE, [variation("rods.upper.width=10..14mm:2")])

    widths = [[rod.section.width for rod in point.case.scene.rods] for point in points]
    assert widths == [[15.0, 10.0], [15.0, 14.0]]


def test_several_keys_make_all_combinations() -> None:
    varied = [variation("rods.upper.nu=0.2..0.3:2"), variation("contacts.overlap.gap=0..0.2mm:3")]

    points = sweep_points(CASE, varied)

    assert [point.values for point in points] == [(nu, gap) for nu in (0.2, 0.3) for gap in (0.0, 0.1, 0.2)]
    assert [point.case.scene.contacts[0].gap for point in points] == 2 * [0.0, 0.1, 0.2]


def test_one_key_by_two_names_is_refused() -> None:
    varied = [variation("rods.upper.E=20..40GPa:2"), variation("materials.upper.young_modulus=1..2GPa:2")]

    with pytest.raises(SweepError, match=r"twice, once as rods\.upper\.E;"):
        sweep_points(CASE, varied)


def test_levels_can_be_swept() -> None:
    points = sweep_points(CASE, [variation("rod_model.level=1..3:3")])

    assert [point.case.rod_model.level for point in points] == [1, 2, 3]
    assert [rows[0].outcome for rows in sweep_rows(points, [variation("rod_model.level=1..3:3")])] == 3 * ["converged"]


def test_rows_hold_the_quantities_of_single_solutions() -> None:
    varied = [variation("rods.upper.E=45..60GPa:3")]
    points = sweep_points(CASE, varied, level=2, order=4)

    for point, rows in zip(points, sweep_rows(points, varied), strict=True):
        solution = rm.solve(point.case.scene, 2, 4)
        own = evaluate(solution, stress_points=[("upper", (0.0, 7.5, 285.0))])
        found = {(row.quantity, row.of, row.part): row.value for row in rows}
        contact, rod = own.contacts[0], own.rod("upper")
        deflection = float(np.linalg.norm(rod.displacement, axis=0).max())
        # the borders of both lie within 0.01 mm of the edge
        for key, value, tolerance in (
            (("contact_force", "overlap", ""), contact.force, 1e-6),
            (("contact_centre", "overlap", ""), contact.centre, 1e-5),
            (("contact_borders", "overlap", "end 1"), solution.stretches[0].end, 0.02 / 200.0),
            (("deflection", "upper", "largest"), deflection, 2e-6),
            (("end_moment_equilibrium", "upper", ""), rod.end_moment_equilibrium, 2e-6),
            (("max_bending_stress", "upper", ""), rod.max_bending_stress, 2e-6),
            (("stress_s", "upper", "at (0, 7.5, 285)"), own.point_stresses["upper", (0.0, 7.5, 285.0)], 2e-6),
            (("strain_energy", "", ""), own.strain_energy, 2e-6),
        ):
            assert found[key] == pytest.approx(value, rel=tolerance), key
        assert found["equilibrium_residual", "", ""] < 1e-9


def test_writes_tables_that_agree_and_a_page_that_fetches_nothing(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = ["--vary", "contacts.overlap.gap=0..0.2mm:3", "--level", "2", "--order", "4"]

    code = run(["sweep", CASE, *arguments, "--output", str(tmp_path)])

    assert code == 0
    paths = [tmp_path / f"{CASE}.{ending}" for ending in ("csv", "parquet", "html")]
    assert capsys.readouterr().out.splitlines() == [str(path) for path in paths]
    assert sorted(tmp_path.iterdir()) == sorted(paths)
    with paths[0].open(encoding="utf-8", newline="") as stream:
        written = list(csv.DictReader(stream))
    table = pq.read_table(paths[1]).to_pylist()
    assert [float(row["value"]) for row in written] == [row["value"] for row in table]
    forces = [row for row in table if row["quantity"] == "contact_force"]
    assert [row["contacts.overlap.gap, mm"] for row in forces] == [0.0, 0.1, 0.2]
    assert [row["number"] for row in forces] == [1, 2, 3]
    # the wider the gap, the less is carried through it
    assert np.all(np.diff([row["value"] for row in forces]) < 0.0)
    page = paths[2].read_text(encoding="utf-8")
    assert "default-src 'none'" in page
    assert "contacts.overlap.gap, mm from 0 to 0.2, 3 values" in page


def test_an_interrupted_sweep_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupted(*_: object) -> Callable[[], None]:
        raise KeyboardInterrupt

    monkeypatch.setattr("reports.sweep.run.sweep_quantities", interrupted)

    code = run(["sweep", CASE, "--vary", "contacts.overlap.gap=0..0.2mm:3", "--output", str(tmp_path / "new")])

    assert code == 130
    assert not (tmp_path / "new").exists()


def test_unknown_keys_of_other_tables_are_not_offered() -> None:
    with pytest.raises(SweepError) as raised:
        sweep_points(CASE, [variation("compare.1.tolerence=1..2mm:2")])

    assert "compare" not in str(raised.value).partition("nearest")[2]
