"""The motion of a tensioner's arm under harmonics of the crank, against a run over time."""

import numpy as np
import pytest

import beltdyn as bd

ORDER, SPEED, DURATION = 2.0, 2000.0 * np.pi / 30.0, 0.6


@pytest.mark.slow
def test_an_arm_swings_as_in_a_run() -> None:
    """To 0.5 %, without dry friction and with steps of 84 in a period; the run begins in steady running.

    Its last ten periods are fitted by the order of the excitation.
    """
    pulleys = [
        {"name": "crank", "center": [0.0, 0.0], "radius": 0.08, "speed": SPEED},
        {"name": "load", "center": [0.3, 0.0], "radius": 0.05, "inertia": 2e-3, "torque": -5.0},
        {"name": "idler", "center": [0.15, 0.09], "radius": 0.03, "side": "outside", "inertia": 1e-4, "mass": 0.2},
    ]
    pulleys[0]["harmonics"] = [{"order": ORDER, "amplitude": 0.001}]
    arm = {"kind": "rotary", "pulley": "idler", "pivot": [0.21, 0.13], "inertia": 6e-4, "preload": 12.0, "rate": 20.0}
    drive = bd.Drive(
        belt={"profile": "PK", "ribs": 6, "installed_tension": 350.0},
        contact={"friction": 0.5},
        pulley=pulleys,
        tensioner=[arm],
        simulation={"duration": DURATION, "max_step": 1.8e-4, "output_interval": 5e-4, "start": "steady"},
    )
    expected = bd.response(drive, speed=[SPEED]).dataset
    assert float(expected.amplitude_error[0]) < 1e-3
    run = bd.simulate(drive).dataset
    late = run.time.values > DURATION - 10.0 * 2.0 * np.pi / (ORDER * SPEED)
    angle = ORDER * run.shaft_angle.values[late, 0]
    columns = np.column_stack([np.cos(angle), np.sin(angle), np.ones(angle.size)])
    cosine, sine, _ = np.linalg.lstsq(columns, run.tensioner_position.values[late, 0], rcond=None)[0]
    assert np.hypot(cosine, sine) == pytest.approx(float(expected.tensioner_position_amplitude[0, 0, 0]), rel=5e-3)
    phase = float(expected.tensioner_position_phase[0, 0, 0])
    assert np.angle(complex(cosine, -sine) * np.exp(-1j * phase)) == pytest.approx(0.0, abs=0.01)
