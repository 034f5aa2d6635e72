"""Stiffness and frequency over the stroke: where the carriage may be, and what a drive needs for it."""

import pytest

import beltdyn as bd
from beltdyn.errors import ModelError
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
    assert found.damping_ratio == 0.5 * AXIS.belt.stretch_loss_factor
    for name, frequency, residual in zip(SHAPERS, found.shaper_frequency, found.shaper_residual, strict=True):
        shaper = SHAPERS[name](float(frequency), float(found.damping_ratio))
        left = residual_vibration(shaper, found.frequency.values, float(found.damping_ratio))
        assert left.max() == pytest.approx(float(residual), rel=1e-12)


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
