"""Stiffness and frequency over the stroke: where the carriage may be, and what a drive needs for it."""

import numpy as np
import pytest
from scipy.linalg import eigh

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import ModelError
from beltdyn.results.free_decay import free_decay
from beltdyn.theory.input_shaping import SHAPERS, residual_vibration

AXIS = bd.example("printer_axis")


@pytest.mark.slow
def test_it_is_stiffer_nearer_to_the_driver_and_swings_faster() -> None:
    """Spans in series with the way back: EA (1 / L1 + 1 / L2), softest at the idler; strings are quicker at 30 N."""
    tight = AXIS.replace(belt=AXIS.belt.replace(installed_tension=30.0))
    found = bd.stroke(tight, places="-100, 0, 100 mm").dataset
    assert found.place.values == pytest.approx([-0.1, 0.0, 0.1])
    assert (found.stiffness.diff("place") > 0.0).all()
    assert (found.frequency.diff("place") > 0.0).all()
    assert (found.lowest_frequency <= found.frequency + 1e-9).all()
    taken_up = 0.3256
    spans = AXIS.belt.axial_stiffness * (1.0 / 0.135 + 1.0 / (taken_up - 0.165 + taken_up))
    assert 0.8 * spans < float(found.stiffness[1]) < spans  # arcs and teeth yield too
    assert found.tension.values == pytest.approx(30.0, rel=5e-3)
    assert (found.mode_frequency.values[:, 0] == found.lowest_frequency.values).all()
    assert (found.mode_frequency.diff("mode") > 0.0).all()
    halfway = found.sel(place=0.0)
    assert halfway.mode_part.values.tolist()[:2] == ["carriage", "belt"]
    assert float(halfway.mode_frequency[0]) == float(halfway.frequency)
    speed = (30.0 / AXIS.belt.mass_per_length) ** 0.5
    assert float(halfway.mode_frequency[1]) == pytest.approx(speed / (2.0 * taken_up), rel=0.01)  # the long way back
    assert AXIS.carriage is not None
    guide = AXIS.carriage.damping * found.carriage_share / (4.0 * np.pi * found.frequency * AXIS.carriage.mass)
    np.testing.assert_allclose(found.damping_ratio, 0.5 * AXIS.belt.stretch_loss_factor + guide, rtol=1e-3)
    np.testing.assert_allclose(found.decay_rate, 2.0 * np.pi * found.frequency * found.damping_ratio, rtol=1e-12)
    np.testing.assert_allclose(found.friction_step, 4.0 * AXIS.carriage.friction / found.stiffness, rtol=1e-9)
    damping = float(found.damping_ratio.mean())
    for name, frequency, residual in zip(SHAPERS, found.shaper_frequency, found.shaper_residual, strict=True):
        shaper = SHAPERS[name](float(frequency), damping)
        left = residual_vibration(shaper, found.frequency.values, damping)
        assert left.max() == pytest.approx(float(residual), rel=1e-12)


AXIAL, TOOTH, PITCH, TEETH = 1e5, 1e5, 8e-3, 20
RADIUS = TEETH * PITCH / (2.0 * np.pi)
DISTANCE, LENGTH, MASS, INERTIA = 0.298736, 0.02, 5.0, 1e-3
DAMPING_TIME = 1e-4


def short() -> bd.Drive:
    """A light belt of few elements, stretched by 0.2 % around two equal pulleys, with a carriage on its upper span."""
    size = {"teeth": 92, "width": 0.02, "thickness": 4e-3, "toothing": {"pitch": PITCH, "tooth_stiffness": TOOTH}}
    law = {
        "axial_stiffness": AXIAL,
        "bending_stiffness": 1e-5,
        "mass_per_length": 1e-3,
        "elements": 40,
        "stretch_damping_time": DAMPING_TIME,
    }
    return bd.Drive(
        belt=size | law,
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "teeth": TEETH, "speed": 5.0},
            {"name": "idler", "center": [DISTANCE, 0.0], "teeth": TEETH, "inertia": INERTIA},
        ],
        carriage={"center": [0.15, RADIUS], "direction": [-1.0, 0.0], "length": LENGTH, "mass": MASS},
        contact={"friction": 0.0},
        simulation={"duration": 0.1, "frame": "travelling", "output_interval": 1e-3},
    )


def springs(first: float, last: float) -> FloatArray:
    """Stiffness of carriage and rim of the idler, N/m, by lengths of the spans on both sides of the carriage.

    Spans are rods, and belts on arcs rods on the springs of the teeth: s^2 = p EA / c.  The ends of arcs have no mass.
    """
    share = np.sqrt(PITCH * AXIAL / TOOTH)
    near, far = AXIAL / share / np.tanh(np.pi * RADIUS / share), -AXIAL / share / np.sinh(np.pi * RADIUS / share)
    whole = np.zeros((6, 6))  # carriage, rim of the idler, ends of the motor's arc, ends of the idler's
    for i, j, length in ((0, 2, first), (3, 4, DISTANCE), (5, 0, last)):
        whole[np.ix_([i, j], [i, j])] += AXIAL / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    arc = np.array([[near, far], [far, near]])
    slip = np.array([[0, -1, 0, 0, 1, 0], [0, -1, 0, 0, 0, 1]])
    whole[2:4, 2:4] += arc
    whole += slip.T @ arc @ slip
    return np.asarray(whole[:2, :2] - whole[:2, 2:] @ np.linalg.solve(whole[2:, 2:], whole[2:, :2]))


def test_a_carriage_and_an_idler_on_springs() -> None:
    """Within what 40 elements tell of arcs that have four each; the strings of the light belt are far above.

    At both ends of the default range, which leaves out a twentieth of the free way before each pulley.
    """
    found = bd.stroke(short(), points=2, count=3).dataset
    first, last = 0.14, DISTANCE - 0.16
    np.testing.assert_allclose(found.place, [0.05 * first - 0.95 * last, 0.95 * first - 0.05 * last], rtol=1e-9)
    for row, place in enumerate(found.place.values):
        there, held = found.isel(place=row), springs(first - place, last + place)
        squares, ways = eigh(held, np.diag([MASS, INERTIA / RADIUS**2]))
        frequencies = np.sqrt(squares) / (2.0 * np.pi)
        assert float(there.stiffness) == pytest.approx(1.0 / np.linalg.inv(held)[0, 0], rel=0.04)
        np.testing.assert_allclose(there.mode_frequency[:2], frequencies, rtol=0.03)
        assert float(there.frequency) == float(there.lowest_frequency) == float(there.mode_frequency[0])
        assert float(there.carriage_share) == pytest.approx(MASS * ways[0, 0] ** 2, abs=0.01)
        assert there.mode_part.values.tolist() == ["carriage", "idler", "belt"]
    np.testing.assert_allclose(found.damping_ratio, np.pi * found.frequency * DAMPING_TIME)
    assert not found.attrs["warnings"]  # the guide runs along the belt, which keeps its tension


def test_places_are_within_the_free_way() -> None:
    with pytest.raises(ModelError, match="where a clamp of the carriage reaches a pulley"):
        bd.stroke(AXIS, places="0, 140 mm")


def test_it_needs_a_carriage_and_a_held_pulley_and_modes() -> None:
    with pytest.raises(ModelError, match="count = 0 must be at least 1"):
        bd.stroke(AXIS, count=0)
    with pytest.raises(ModelError, match="a stroke needs a carriage"):
        bd.stroke(bd.example("two_pulley"))
    motor = AXIS.pulleys[0].replace(speed=None, inertia=1e-5, torque={"kind": "constant", "value": 0.01})
    with pytest.raises(ModelError, match="no pulley holds the belt"):
        bd.stroke(AXIS.replace(pulley=[motor, AXIS.pulleys[1]]))


@pytest.mark.slow
@pytest.mark.parametrize("guide", [8.0, 25.0])
def test_the_decay_is_that_of_a_run(guide: float) -> None:
    """The carriage rings after a move as the mode does, with short steps: frequency to 1 %, decay to 5 %."""
    assert AXIS.carriage is not None
    stop = {"kind": "table", "times": [0.0, 0.02, 0.1, 0.102], "values": ["0 rpm", "200 rpm", "200 rpm", "0 rpm"]}
    axis = AXIS.replace(
        carriage=AXIS.carriage.replace(friction=0.0, damping=guide),
        pulley=[AXIS.pulleys[0].replace(speed=stop), AXIS.pulleys[1]],
        simulation={"duration": 0.4, "max_step": 2e-4, "output_interval": 5e-4},
    )
    run = bd.simulate(axis)
    after = run.dataset.sel(time=slice(0.11, None))
    decay = free_decay(after.time.values, after.carriage_error.values[:, 0])
    assert decay is not None
    found = bd.stroke(axis, places=[float(run.dataset.carriage_position[-1, 0])]).dataset
    assert decay.frequency == pytest.approx(float(found.frequency[0]), rel=0.01)
    assert decay.rate == pytest.approx(float(found.decay_rate[0]), rel=0.05)
