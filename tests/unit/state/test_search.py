"""The search for steady running."""

import pytest

from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive
from beltdyn.state.steady import steady_state


def test_a_drive_without_a_machine_is_told_which_pulleys_could_have_one() -> None:
    belt = {"profile": "PK", "ribs": 6, "installed_tension": 300.0}
    pulleys = [
        {"name": name, "center": [x, 0.0], "radius": 0.05, "inertia": 0.01} for name, x in (("a", 0.0), ("b", 0.3))
    ]
    idle = Drive(belt=belt, pulley=pulleys, contact={"friction": 0.4}, simulation={"duration": 1.0})
    with pytest.raises(ModelError, match='no machine drives the belt: "a" and "b" have neither a speed nor a motor'):
        steady_state(idle)


@pytest.mark.parametrize("breakdown", [130.0, 220.0])
def test_a_motor_too_weak_for_what_the_belt_carries_is_named(breakdown: float) -> None:
    """A guide under goods takes mu m g L R = 147 N m, which the loads of the shafts do not show."""
    motor = {"kind": "motor", "breakdown_torque": breakdown, "breakdown_slip": 0.1, "synchronous_speed": 10.0}
    strand = {"span": ["tail", "head"]}
    drive = Drive(
        gravity=[0.0, -9.81],
        belt={
            "installed_tension": 3000.0,
            "width": 0.4,
            "thickness": 0.005,
            "axial_stiffness": 1e6,
            "bending_stiffness": 0.1,
            "mass_per_length": 1.0,
        },
        pulley=[
            {"name": "head", "center": [0.0, 0.0], "radius": 0.2, "inertia": 1.0, "load": [motor]},
            {"name": "tail", "center": [10.0, 0.0], "radius": 0.2, "inertia": 1.0},
        ],
        support=[strand | {"kind": "guide", "friction": 0.3}],
        goods=[strand | {"mass_per_length": 24.0}],
        contact={"friction": 0.4},
        simulation={"duration": 1.0},
    )
    if breakdown > 150.0:
        assert float(steady_state(drive).dataset.shaft_torque[-1, 0]) == pytest.approx(147.0, rel=0.02)
        return
    with pytest.raises(ConvergenceError, match=r"the machine of `head`, .* at most 130 N m .* of the 14\d") as failure:
        steady_state(drive)
    assert "Use a larger motor" in str(failure.value)
