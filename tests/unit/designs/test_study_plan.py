"""Points of a study: values in SI units, checked at their places."""

from pathlib import Path
from typing import Any

import pytest

from beltdyn.designs.study_plan import Plan, plan_of
from beltdyn.errors import ModelError
from beltdyn.model import Drive, ParameterStudy

WIDTH = {"path": "belt.width", "values": "10, 15, 20 mm"}
SPEED = {"path": "pulley[driver].speed.value", "values": "100..120 rpm", "steps": 2}


def plan(drive: Drive, *numbers: dict[str, Any], base: Path = Path(), **more: Any) -> Plan:
    return plan_of(ParameterStudy(number=list(numbers), **more), drive, base)


def test_all_combinations_in_si_units(drive: Drive) -> None:
    found = plan(drive, WIDTH, SPEED)
    assert found.units == ("m", "rad/s")
    assert found.values.shape == (6, 2)
    assert found.values[:, 0].tolist() == [0.01, 0.01, 0.015, 0.015, 0.02, 0.02]
    assert found.values[:2, 1].tolist() == pytest.approx([10.471976, 12.566371])
    assert found.changes(2)["belt.width"] == 0.015
    assert found.base == (0.01, 12.0)


def test_a_constant_in_place_of_a_profile_is_its_value(drive: Drive) -> None:
    """The example has ramps, with several numbers each."""
    constant = drive.with_({"pulley[driver].speed": 12.0, "pulley[driven].torque": -1.0})
    found = plan(
        constant,
        {"path": "pulley[driver].speed", "values": "100..120 rpm", "steps": 2},
        {"path": "pulley[2].torque", "values": ["-1 N m", -2.0]},
    )
    assert (found.paths, found.units) == (("pulley[driver].speed.value", "pulley[2].torque.value"), ("rad/s", "N*m"))
    assert found.values[0].tolist() == pytest.approx([10.471976, -1.0])
    assert found.base == (12.0, -1.0)
    for values in ("100..120 rpm", [10.0, 12.0]):
        with pytest.raises(
            ModelError, match=r"driver\]\.speed is a group of keys.*: .*pulley\[driver\]\.speed\.value\.$"
        ):
            plan(drive, {"path": "pulley[driver].speed", "values": values})


@pytest.mark.parametrize("key", ["speed", "torque"])
def test_a_profile_that_is_not_given_has_no_number_to_vary(drive: Drive, key: str) -> None:
    load = {"kind": "fan", "rated_power": 40.0, "rated_speed": 10.0}
    loaded = drive.with_({"pulley[driven].torque": None, "pulley[driven].load": [load]})
    with pytest.raises(ModelError, match=rf"pulley\[driven\]\.{key} is not given, so it has no number to vary"):
        plan(loaded, {"path": f"pulley[driven].{key}", "values": ["-8 N m", "-5 N m"]})
    with pytest.raises(ModelError, match="is not in the catalogue"):  # a word may be varied all the same
        plan(loaded, {"path": "belt.profile", "values": ["-8 N m", "-5 N m"]})


def test_values_of_a_list_stand_as_in_a_drive_file(drive: Drive) -> None:
    found = plan(
        drive,
        {"path": "belt.elements", "values": [20, 24]},
        {"path": "belt.width", "values": ["12 mm", 0.013]},
        {"path": "contact.normal_law", "values": ["no_pull", "published"]},
        sampling="factorial",
    )
    assert found.values[0].tolist() == [20, 0.012, "no_pull"]
    assert isinstance(found.values[0, 0], int)
    assert len(found.values) == 8


def test_together_and_one_at_a_time(drive: Drive) -> None:
    speed = SPEED | {"steps": 3}
    assert len(plan(drive, WIDTH, speed, sampling="together").values) == 3
    assert len(plan(drive, WIDTH, speed, sampling="one_at_a_time").values) == 1 + 2 + 3
    with pytest.raises(ModelError, match="the same number of values for each"):
        plan(drive, WIDTH, SPEED, sampling="together")


def test_samples_lie_between_bounds_and_whole_numbers_stay_whole(drive: Drive) -> None:
    elements = {"path": "belt.elements", "values": [20, 30]}
    found = plan(drive, {"path": "belt.width", "values": "10..20 mm"}, elements, sampling="sobol", points=32)
    assert min(found.values[:, 0]) >= 0.01
    assert max(found.values[:, 0]) <= 0.02
    assert {type(one) for one in found.values[:, 1]} == {int}
    assert len(plan(drive, WIDTH | {"values": "1..2 mm"}, elements, sampling="saltelli", points=8).values) == 32


def test_rows_of_a_table_are_points(drive: Drive, tmp_path: Path) -> None:
    text = "belt.width [mm],contact.normal_law,belt.elements\n12,no_pull,20\n13,published,22\n"
    (tmp_path / "points.csv").write_text(text, encoding="utf-8")
    found = plan_of(ParameterStudy(table="points.csv"), drive, tmp_path)
    assert found.values.tolist() == [[0.012, "no_pull", 20], [0.013, "published", 22]]
    assert isinstance(found.values[0, 2], int)


@pytest.mark.parametrize(
    ("numbers", "more", "said"),
    [
        ([WIDTH | {"path": "belt.widht"}], {}, 'Did you mean "width"'),
        ([WIDTH | {"values": "10, 20"}], {}, "has no unit"),
        ([WIDTH | {"values": "10..20 kg"}], {}, "must be in units of m"),
        ([WIDTH | {"values": [-1.0]}], {}, "belt.width = -1"),
        ([{"path": "pulley[driver].speed", "values": [12.0]}], {}, "speed"),
        ([WIDTH], {"sampling": "sobol"}, "are not bounds"),
        ([WIDTH, WIDTH], {}, "is given twice"),
        ([], {}, "needs points from a table or from groups"),
        ([WIDTH], {"table": "a.csv"}, "Give one of the two"),
        ([WIDTH], {"analysis": "steady_stat"}, 'Did you mean "steady_state"'),
        (
            [{"path": f"pulley[{k}].center[{j}]", "values": "1..2 m", "steps": 90} for k in (1, 2) for j in (1, 2)],
            {},
            "points, more than the limit of 10,000,000",
        ),
    ],
)
def test_what_does_not_fit_is_told(drive: Drive, numbers: list[dict[str, Any]], more: Any, said: str) -> None:
    with pytest.raises(ModelError) as told:
        plan(drive, *numbers, **more)
    assert said in str(told.value)
