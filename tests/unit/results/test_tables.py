import csv
from pathlib import Path

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Run, summarize, write_csv
from beltdyn.results.derived import mid_span_displacements, slip_safety, slips

OVER_TIME = ["pulleys.csv", "spans.csv", "energy.csv", "contact.csv"]
SUMMARIES = ["pulley_summary.csv", "span_summary.csv", "losses.csv"]


def _rows(path: Path) -> tuple[list[str], list[list[str]]]:
    with path.open(newline="", encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    return heading, rows


def _read(path: Path) -> dict[str, list[float]]:
    heading, rows = _rows(path)
    return {name: [float(row[i]) for row in rows] for i, name in enumerate(heading)}


def test_tables_hold_the_results(tmp_path: Path, run: Run) -> None:
    paths = write_csv(run, tmp_path / "new" / "folder")
    assert [path.name for path in paths] == OVER_TIME + SUMMARIES
    pulleys, spans, energy, contact = map(_read, paths[:4])
    dataset = run.dataset
    np.testing.assert_allclose(pulleys["time [s]"], dataset["time"], rtol=1e-9)
    np.testing.assert_allclose(pulleys["pulley_speed driven [rad/s]"], dataset["pulley_speed"][:, 1], rtol=1e-9)
    np.testing.assert_allclose(pulleys["hub_force driver x [N]"], dataset["hub_force"][:, 0, 0], rtol=1e-9)
    np.testing.assert_allclose(spans["span_tension driven-driver [N]"], dataset["span_tension"][:, 1], rtol=1e-9)
    np.testing.assert_allclose(energy["friction_loss [J]"], dataset["friction_loss"], rtol=1e-9)
    np.testing.assert_allclose(contact["belt_coordinate [m]"], dataset["belt_coordinate"], rtol=1e-9)
    np.testing.assert_allclose(contact["contact_position y [m]"], dataset["contact_position"][-1, :, 1], rtol=1e-9)
    np.testing.assert_array_equal(contact["contact_pulley [1]"], dataset["contact_pulley"][-1])


def test_tables_hold_what_is_derived(tmp_path: Path, run: Run) -> None:
    pulleys, spans = (_read(path) for path in write_csv(run, tmp_path)[:2])
    np.testing.assert_allclose(pulleys["slip driven [%]"], slips(run)["slip"][:, 1], rtol=1e-9)
    np.testing.assert_allclose(pulleys["slip_safety driver [1]"], slip_safety(run)[:, 0], rtol=1e-9)
    np.testing.assert_allclose(pulleys["power_in driver [W]"][-1], 12.0 * 30.0 * 0.08125)
    displacement = mid_span_displacements(run)[:, 0]
    np.testing.assert_allclose(spans["mid_span_displacement driver-driven [m]"], displacement, rtol=1e-9)


def test_summary_as_tables(tmp_path: Path, run: Run) -> None:
    """A row for each pulley, span and cause; every heading has its column."""
    heading, rows = _rows(write_csv(run, tmp_path)[4])
    assert [row[0] for row in rows] == ["driver", "driven"]
    driven = dict(zip(heading, rows[1], strict=True))
    summary = summarize(run)
    assert float(driven["slip [1]"]) == pytest.approx(0.005)
    assert float(driven["slip safety [1]"]) == pytest.approx(summary.pulleys[1].slip_safety)
    assert float(driven["hub load [N]"]) == pytest.approx(90.0)
    heading, rows = _rows(tmp_path / "span_summary.csv")
    assert float(dict(zip(heading, rows[1], strict=True))["largest tension [N]"]) == pytest.approx(60.0)
    heading, rows = _rows(tmp_path / "losses.csv")
    friction = dict(zip(heading, rows[0], strict=True))
    assert friction["cause"] == "friction"
    assert float(friction["power [W]"]) == pytest.approx(0.09 * 12.0)
    assert float(friction["share of the power input [1]"]) == pytest.approx(0.09 / (30.0 * 0.08125))
    assert float(friction["energy since the start [J]"]) == pytest.approx(float(run.dataset["friction_loss"][-1]))


def test_tensioners_have_a_table_of_their_own(tmp_path: Path, run: Run) -> None:
    place = run.dataset["shaft_angle"][:, :1].rename(pulley="tensioner").assign_attrs(units="m, rad")
    tensioned = run.dataset.assign(tensioner_position=place, tensioner_speed=place)
    paths = write_csv(Run(tensioned, run.drive), tmp_path)
    assert [path.name for path in paths] == [*OVER_TIME[:3], "tensioners.csv", "contact.csv", *SUMMARIES]
    table = _read(tmp_path / "tensioners.csv")
    np.testing.assert_allclose(table["tensioner_position driver [m, rad]"], place[:, 0], rtol=1e-9)


def test_unwritable_folder_is_a_model_error(tmp_path: Path, run: Run) -> None:
    (tmp_path / "file").write_text("not a folder")
    with pytest.raises(ModelError, match="cannot be written"):
        write_csv(run, tmp_path / "file")


def test_failure_leaves_nothing_half_written(tmp_path: Path, run: Run) -> None:
    (tmp_path / "spans.csv").mkdir()
    with pytest.raises(ModelError, match="is a folder"):
        write_csv(run, tmp_path)
    assert [path.name for path in tmp_path.iterdir()] == ["spans.csv"]
