"""Operating points of studies."""

from pathlib import Path

import numpy as np
import pytest

from beltdyn.designs.batch import held, speed_of, study_points
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.parameter_study import Points
from validation.published.cases import better, loaded_two_pulley


@pytest.fixture(scope="module")
def loaded() -> Drive:
    return better(loaded_two_pulley())


def test_a_drive_has_one_operating_point(loaded: Drive) -> None:
    points = study_points(loaded, Points(), Path())
    assert [point.weight for point in points] == [1.0]
    there = points[0].of(held(loaded, Points()))
    assert speed_of(there, 0) == pytest.approx(120.0)


def test_speeds_and_loads(loaded: Drive) -> None:
    given = Points(speed="600..1200 rpm", count=3, load="0.5, 1")
    points = study_points(loaded, given, Path())
    assert [point.label for point in points][:2] == ["600 rpm, load 0.5", "900 rpm, load 0.5"]
    assert sum(point.weight for point in points) == pytest.approx(1.0)
    there = points[1].of(held(loaded, given))
    assert speed_of(there, 0) == pytest.approx(30.0 * np.pi)
    torque = there.pulleys[1].torque
    assert torque is not None
    assert float(torque.at([0.0])[0]) == pytest.approx(-22.5)


def test_rows_of_a_duty_table(loaded: Drive, tmp_path: Path) -> None:
    (tmp_path / "duty.csv").write_text("duration [s], driver speed [rpm]\n30, 600\n10, 900\n", encoding="utf-8")
    points = study_points(loaded, Points(table="duty.csv"), tmp_path)
    assert [(point.label, point.weight) for point in points] == [("row 1", 0.75), ("row 2", 0.25)]
    assert speed_of(points[1].of(held(loaded, Points())), 0) == pytest.approx(30.0 * np.pi)


def test_an_unknown_pulley(loaded: Drive) -> None:
    with pytest.raises(ModelError, match="pulley = 'idler' is not in this drive"):
        study_points(loaded, Points(speed="600 rpm", pulley="idler"), Path())
