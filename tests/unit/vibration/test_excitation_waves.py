"""Waves in speeds and torques, against functions whose waves are known."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import Drive
from beltdyn.vibration.excitation import averaged, speed_waves, torque_orders, torque_waves
from validation.published.cases import loaded_two_pulley

MEAN, SWING = -12.0, 3.0


@pytest.fixture(scope="module")
def waving() -> Drive:
    """A driver with two waves; a load with a wave, half on, beside a torque over the angle."""
    driver, driven = loaded_two_pulley().pulleys
    waves = [{"order": 2, "amplitude": 0.02}, {"order": 2, "amplitude": 0.01, "phase": 0.5}]
    angles = np.linspace(0.0, 2.0 * np.pi, 240, endpoint=False)
    table = {
        "kind": "angle_table",
        "angles": angles.tolist(),
        "torques": (MEAN + SWING * np.cos(3.0 * angles)).tolist(),
    }
    half = {"kind": "constant", "value": 0.5}
    load = {"kind": "resistance", "constant": 8.0, "schedule": half, "harmonics": [{"order": 5, "amplitude": 0.1}]}
    drive = loaded_two_pulley()
    return drive.replace(pulley=[driver.replace(harmonics=waves), driven.replace(torque=None, load=[load, table])])


def test_waves_of_an_angle_are_those_of_the_speed_over_the_order(waving: Drive) -> None:
    """a cos(2 theta + phi) of the speed makes a / 2 sin(2 theta + phi) of the angle, over the mean speed."""
    found = speed_waves(waving, 0)
    theta = np.linspace(0.0, 6.0, 7)
    expected = 0.01 * np.sin(2.0 * theta) + 0.005 * np.sin(2.0 * theta + 0.5)
    np.testing.assert_allclose(np.real(found[2.0] * np.exp(2j * theta)), expected, atol=1e-15)


def test_waves_of_torques(waving: Drive) -> None:
    """A resistance brakes; the table is a cosine, to the error of its interpolation."""
    found = torque_waves(waving, 1, 50.0)
    assert found[5.0] == pytest.approx(-0.5 * 8.0 * 0.1)
    assert found[3.0] == pytest.approx(SWING, rel=1e-2)
    assert list(found) == [5.0, 3.0]
    assert torque_orders(waving.pulleys[1].load[1]) == [3.0]


def test_means_over_the_angle(waving: Drive) -> None:
    _, mean = steady = averaged(waving).pulleys[1].load
    assert [one.kind for one in steady] == ["resistance", "table"]
    assert isinstance(mean, bd.model.LoadTable)
    np.testing.assert_allclose(mean.torques, MEAN, rtol=1e-3)
    assert averaged(loaded_two_pulley()) == loaded_two_pulley()
