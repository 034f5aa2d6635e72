"""Clockwise drives: the mirror image of a counter-clockwise one has its numbers, and signs are those of the file."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure

import beltdyn as bd
from beltdyn.machines import Load
from beltdyn.model import Drive, OneWayClutch, Pulley, prepare
from beltdyn.show.sheet import run_sheet
from beltdyn.show.tables import Table, as_text

OTHER = {"clockwise": "counter-clockwise", "counter-clockwise": "clockwise"}
PLACES = {"center", "pivot", "direction", "gravity"}


def mirrored(given: Any) -> Any:
    """Values of a drive file, seen from behind: x and senses change sign, speeds and torques do not."""
    if isinstance(given, Mapping):
        found = {key: mirrored(one) for key, one in given.items()}
        for key in PLACES & found.keys():
            found[key] = [-found[key][0], found[key][1]]
        return found | {key: OTHER[found[key]] for key in ("sense", "self_energizing") if key in found}
    return [mirrored(one) for one in given] if isinstance(given, list) else given


def clockwise(drive: Drive) -> Drive:
    """The mirror image of a counter-clockwise drive; the order of pulleys stays that of counter-clockwise motion."""
    data = mirrored(drive.data)
    first, *others = data["pulley"]
    return Drive(**data | {"pulley": [first, *others[::-1]], "rotation": "clockwise"})


@pytest.fixture(scope="module")
def drives() -> tuple[Drive, Drive]:
    """A drive with a motor's crank, a duty, a rotary tensioner and an alternator, and its mirror image."""
    given = bd.example("alternator_drive").with_(
        {
            "pulley[crank].speed": "1500 rpm",
            "pulley[crank].harmonics": [{"order": 2, "amplitude": 0.02, "phase": 0.4}],
            "duty": [
                {"share": 0.25, "speed": "800 rpm", "power": {"alternator": "0.8 kW"}},
                {"share": 0.75, "speed": "3000 rpm", "power": {"alternator": "2 kW"}},
            ],
        }
    )
    return given, clockwise(given)


# What a sheet says


def test_check_shows_the_numbers_of_the_mirror_image(drives: tuple[Drive, Drive]) -> None:
    found = [as_text(bd.check(drive, equilibrium=False).sheet).splitlines() for drive in drives]
    rows = [{line.split()[0]: line.split() for line in lines if "free" in line or "presc" in line} for lines in found]
    assert list(rows[0]) == ["crank", "tensioner", "alternator"]
    for name, row in rows[0].items():
        assert rows[1][name][:2] == row[:2]
        assert {rows[1][name][2], row[2]} == {"cw", "ccw"}
        assert rows[1][name][3:-1] == row[3:-1]


def test_steady_running_has_the_numbers_of_the_mirror_image(drives: tuple[Drive, Drive]) -> None:
    first, second = (bd.summarize(bd.steady_state(drive)) for drive in drives)
    others = {one.name: one for one in second.pulleys}
    assert first.pulleys[0].speed > 0.0 > first.pulleys[1].speed
    for one in first.pulleys:
        other = others[one.name]
        for name in ("speed", "belt_torque", "shaft_torque", "power", "hub_load"):
            assert getattr(other, name) == pytest.approx(getattr(one, name), rel=1e-5, abs=1e-6), name
        assert other.slip_safety == pytest.approx(one.slip_safety, rel=2e-6, nan_ok=True)
        assert np.isnan(one.slip_safety) == (one.name == "tensioner")  # which has no load of its own to multiply
    assert all(one.belt_speed > 0.0 for one in second.spans)


def test_the_drive_sheet_has_the_numbers_of_the_mirror_image(drives: tuple[Drive, Drive]) -> None:
    first, second = (bd.sheet(drive).dataset for drive in drives)
    second = second.sel(pulley=first["pulley"].values)
    tight = 1e-5  # the tension at rest is met to 1e-6
    for name in ("pulley_speed", "shaft_torque", "power", "slip_safety", "hub_load", "peak_hub_load"):
        np.testing.assert_allclose(second[name], first[name], rtol=tight, atol=1e-9, err_msg=name)
    np.testing.assert_allclose(second["mode_frequency"], first["mode_frequency"], rtol=1e-6)


@pytest.mark.slow
def test_an_operating_map_and_a_run_up_go_clockwise(drives: tuple[Drive, Drive]) -> None:
    mapped = bd.operating_map(drives[1], speed="900 rpm").dataset
    assert mapped["pulley_speed"].sel(pulley="crank").item() == pytest.approx(900 * np.pi / 30)
    run = bd.sweep(drives[1], pulley="crank", from_="10 rpm", to="20 rpm", duration="2 ms")
    assert run.dataset["pulley_speed"].sel(pulley="crank")[-1] < 0.0


# Signs


def test_words_keep_their_meaning() -> None:
    data = bd.example("two_pulley").data | {"rotation": "clockwise"}
    for text, sense in (("800 rpm", -1.0), ("800 rpm clockwise", -1.0), ("800 rpm ccw", 1.0), ("-800 rpm", 1.0)):
        data["pulley"][0] |= {"speed": text}
        drive = Drive(**data)
        there = prepare(drive).pulleys[0].speed
        assert there is not None
        assert there.at([0.0])[0] == pytest.approx(sense * 800 * np.pi / 30), text
        assert bd.loads(bd.dumps(drive)) == drive


def test_a_changed_speed_is_read_like_one_of_the_file() -> None:
    drive = bd.example("two_pulley").with_({"rotation": "clockwise"})
    for text in ("50 rpm", "50 rpm clockwise"):
        changed = drive.with_({"pulley[driver].speed": text})
        assert changed.running_sense == -1
        assert prepare(changed).pulleys[0].driven_speed() == pytest.approx(50 * np.pi / 30)


LOADS: list[dict[str, Any]] = [
    {"kind": "resistance", "constant": 1.0, "linear": 0.1},
    {"kind": "fan", "rated_power": "1 kW", "rated_speed": "1000 rpm"},
    {"kind": "motor", "breakdown_torque": 12.0, "breakdown_slip": 0.2, "synchronous_speed": "-1500 rpm"},
    {
        "kind": "induction_motor",
        "rated_power": "1 kW",
        "rated_speed": "1440 rpm",
        "frequency": "50 Hz",
        "locked_rotor_ratio": 2.0,
        "breakdown_ratio": 2.6,
    },
    {
        "kind": "servo_motor",
        "speed": {"kind": "step", "time": 0.5, "before": -30.0, "value": 60.0},
        "proportional_gain": 0.1,
        "integral_time": 0.1,
        "torque_limit": 20.0,
    },
    {"kind": "table", "speeds": [-20.0, 10.0, 90.0], "torques": [3.0, -1.0, -5.0]},
    {"kind": "power", "speeds": [100.0], "powers": [500.0]},
    {"kind": "angle_table", "angles": [-0.3, 1.0, 2.5], "torques": [-1.0, 4.0, -7.0]},
    {
        "kind": "angle_speed_table",
        "angles": [0.2, 1.0, 2.5],
        "speeds": [-10.0, 30.0, 80.0],
        "torques": [[1.0, 2.0, 3.0], [-4.0, -3.0, -1.0], [0.0, -6.0, 2.0]],
    },
    {"kind": "function", "function": lambda time, angle, speed: angle**2 - 0.2 * speed + time},
]


@pytest.mark.parametrize("given", LOADS, ids=lambda given: str(given["kind"]))
def test_a_reversed_load_has_the_opposite_torque_at_the_opposite_angle_and_speed(given: dict[str, Any]) -> None:
    load: Load = Pulley(name="one", center=(0, 0), radius=1, inertia=1, load=[given]).load[0]
    angles = np.linspace(-4.0, 5.0, 7)
    for speed in (-70.0, -3.0, 25.0):
        torque = load.torque_over(angles, speed, 0.3)
        np.testing.assert_allclose(load.reversed().torque_over(-angles, -speed, 0.3), -torque, rtol=1e-9, atol=1e-12)
        assert np.abs(torque).max() > 0.0
    np.testing.assert_allclose(load.reversed().reversed().torque_over(angles, 8.0), load.torque_over(angles, 8.0))


@pytest.mark.parametrize(
    "given",
    [
        {"kind": "constant", "value": 3.0},
        {"kind": "step", "time": 0.1, "before": -1.0, "value": 2.0},
        {"kind": "ramp", "start": 0.1, "end": 0.3, "value": 2.0},
        {"kind": "cosine_ramp", "start": 0.1, "end": 0.3, "value": 2.0},
        {"kind": "cosine_ramp_published", "start": 0.1, "end": 0.3, "value": 2.0},
        {"kind": "table", "times": [0.0, 0.2, 0.3], "values": [1.0, -2.0, 4.0]},
    ],
    ids=lambda given: str(given["kind"]),
)
def test_a_reversed_profile_has_the_opposite_values(given: dict[str, Any]) -> None:
    profile = Pulley(name="one", center=(0, 0), radius=1, speed=given).speed
    assert profile is not None
    times = np.linspace(-0.1, 0.5, 13)
    np.testing.assert_allclose(profile.reversed().at(times), -profile.at(times))
    assert np.abs(profile.at(times)).max() > 0.0


def test_a_one_way_clutch_drives_in_the_running_sense() -> None:
    clutch = OneWayClutch(kind="one_way_clutch", locking_damping=1.0, inertia=1e-3)
    assert clutch.reversed().values(1)["sense"] == -clutch.values(1)["sense"]


@pytest.mark.slow
def test_a_run_equals_that_with_negative_numbers() -> None:
    given = bd.example("accessory_drive").with_({"simulation.duration": 1e-3, "simulation.output_interval": 5e-4})
    by_key = given.with_({"rotation": "clockwise"})
    by_numbers = given.replace(pulley=[one.reversed() for one in given.pulleys])
    first, second = (bd.simulate(drive).dataset for drive in (by_key, by_numbers))
    assert float(np.abs(first["pulley_speed"]).max()) > 0.0
    for name in ("pulley_speed", "pulley_torque", "shaft_torque", "span_tension"):
        np.testing.assert_array_equal(first[name], second[name], err_msg=name)


def test_positive_numbers_in_what_is_told_of_a_run() -> None:
    drive = bd.example("two_pulley").with_({"rotation": "clockwise"})
    run = bd.steady_state(drive)
    speed = run.dataset["pulley_speed"].sel(pulley="driver")[-1].item()
    assert speed == pytest.approx(-12.0)
    assert np.asarray(bd.plot.speeds(run, Figure().add_subplot()).lines[0].get_ydata())[-1] == pytest.approx(12.0)
    table = run_sheet(run).parts[0]
    assert isinstance(table, Table)
    assert float(table.rows[0][1]) == pytest.approx(12.0 * 30 / np.pi, rel=1e-4)
