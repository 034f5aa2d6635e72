"""Operating points of a duty in the drive file."""

from typing import Any

import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, DutyPoint, dumps, loads
from beltdyn.model.parameter_study import PASS, columns_of

IDLE: dict[str, Any] = {"share": "30 %", "speed": "900 rpm", "power": {"driven": "20 W"}}
FULL: dict[str, Any] = {"share": 0.7, "load": 0.5, "temperature": "90 degC"}


def test_points_are_read_written_and_made_columns(drive: Drive) -> None:
    given = drive.replace(duty=[IDLE, FULL])
    assert loads(dumps(given)).duty == given.duty
    assert {key: list(values) for key, values in columns_of(given.duty).items()} == {
        ("duration", ""): pytest.approx([0.3 * PASS, 0.7 * PASS]),
        ("load", ""): [None, 0.5],
        ("temperature", ""): [None, 90.0],
        ("speed", ""): [pytest.approx(94.2478), None],
        ("power", "driven"): [20.0, None],
    }
    assert given.with_({"duty[1].speed": "950 rpm"}).duty[0].speed == pytest.approx(99.4838)


@pytest.mark.parametrize(
    ("duty", "said"),
    [
        ([IDLE | {"power": {"drive": 1.0}}], r'duty\[1\]\.power names "drive", .* Choose from driver, driven'),
        ([IDLE, {"duration": "1 h"}], "has points with share and points with duration"),
        ([{"share": 0.0}], "duty has no time"),
        ([{"speed": 100.0}], "needs either share or duration"),
        ([IDLE | {"power": {"driven": "-1 kW"}}], "must be at least 0"),
        ([IDLE | {"speed": "-900 rpm"}], "must be greater than 0"),
    ],
)
def test_a_faulty_duty_is_refused(drive: Drive, duty: list[dict[str, Any]], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        drive.replace(duty=duty)


def test_a_point_by_its_duration() -> None:
    assert DutyPoint(duration="2 h").weight == 7200.0
