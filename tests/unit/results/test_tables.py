import csv
from pathlib import Path

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.results import Run, write_csv


def _read(path: Path) -> dict[str, list[float]]:
    with path.open(newline="", encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    return {name: [float(row[i]) for row in rows] for i, name in enumerate(heading)}


def test_tables_hold_the_results(tmp_path: Path, run: Run) -> None:
    paths = write_csv(run, tmp_path / "new" / "folder")
    assert [path.name for path in paths] == ["pulleys.csv", "spans.csv", "energy.csv", "contact.csv"]
    pulleys, spans, energy, contact = map(_read, paths)
    dataset = run.dataset
    np.testing.assert_allclose(pulleys["time [s]"], dataset["time"], rtol=1e-9)
    np.testing.assert_allclose(pulleys["pulley_speed driven [rad/s]"], dataset["pulley_speed"][:, 1], rtol=1e-9)
    np.testing.assert_allclose(pulleys["hub_force driver x [N]"], dataset["hub_force"][:, 0, 0], rtol=1e-9)
    np.testing.assert_allclose(spans["span_tension driven-driver [N]"], dataset["span_tension"][:, 1], rtol=1e-9)
    np.testing.assert_allclose(energy["friction_loss [J]"], dataset["friction_loss"], rtol=1e-9)
    np.testing.assert_allclose(contact["belt_coordinate [m]"], dataset["belt_coordinate"], rtol=1e-9)
    np.testing.assert_allclose(contact["contact_position y [m]"], dataset["contact_position"][-1, :, 1], rtol=1e-9)
    np.testing.assert_array_equal(contact["contact_pulley [1]"], dataset["contact_pulley"][-1])


def test_unwritable_folder_is_a_model_error(tmp_path: Path, run: Run) -> None:
    (tmp_path / "file").write_text("not a folder")
    with pytest.raises(ModelError, match="cannot be made"):
        write_csv(run, tmp_path / "file")


def test_failure_leaves_nothing_half_written(tmp_path: Path, run: Run) -> None:
    (tmp_path / "spans.csv").mkdir()
    with pytest.raises(ModelError, match="cannot be written"):
        write_csv(run, tmp_path)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["pulleys.csv", "spans.csv"]
