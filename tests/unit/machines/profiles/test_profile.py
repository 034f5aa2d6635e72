import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.errors import ModelError
from beltdyn.model import Constant, CosineRamp, CosineRampPublished, Profile, Pulley, Ramp, Step, Table

RISE = {"start": 0.05, "end": 0.6, "value": 12.0}


def test_constant() -> None:
    np.testing.assert_array_equal(Constant(value=3.0).at([-1.0, 0.0, 5.0]), 3.0)


def test_ramp_is_equation_28() -> None:
    times = np.linspace(-0.1, 1.0, 111)
    printed = [0.0 if t <= 0.05 else 12 * (t - 0.05) / 0.55 if t <= 0.6 else 12.0 for t in times]
    np.testing.assert_allclose(Ramp(**RISE).at(times), printed, atol=1e-14)


def test_published_cosine_is_equation_29() -> None:
    times = np.linspace(0.0, 1.0, 101)
    printed = [0.0 if t <= 0.05 else 6 * (1 - math.cos(math.pi * t / 0.6)) if t <= 0.6 else 12.0 for t in times]
    profile = CosineRampPublished(**RISE)
    np.testing.assert_allclose(profile.at(times), printed, atol=1e-14)
    assert profile.at(0.05 + 1e-12) / 12 == pytest.approx(0.017, abs=1e-4)


def test_cosine_ramp_is_smooth() -> None:
    profile = CosineRamp(**RISE)
    np.testing.assert_allclose(profile.at([0.05, 0.325, 0.6, 2.0]), [0, 6, 12, 12], atol=1e-14)
    np.testing.assert_allclose(profile.at([0.05 + 1e-6, 0.6 - 1e-6]), [0, 12], atol=1e-9)


def test_table_is_linear_between_its_points() -> None:
    table = Table(times=(0.0, 1.0, 3.0), values=(1.0, 2.0, -2.0))
    times = np.linspace(-1, 4, 51)
    np.testing.assert_allclose(table.at(times), np.interp(times, table.times, table.values), atol=1e-14)
    assert table.breakpoints() == ()


@pytest.mark.parametrize("times", [(0.0, 2.0, 1.0), (0.0, 1.0, 1.0), (0.0, 1.0)])
def test_a_table_is_a_function_of_time(times: tuple[float, ...]) -> None:
    with pytest.raises(ModelError, match=r"times (must increase|has 2 numbers but values has 3)"):
        Table(times=times, values=(1.0, 2.0, 3.0))


def test_step_holds_from_just_after_its_instant() -> None:
    step = Step(time=0.5, before=1.0, value=3.0)
    np.testing.assert_array_equal(step.at([-1.0, 0.5, np.nextafter(0.5, 1.0), 2.0]), [1.0, 1.0, 3.0, 3.0])
    assert step.breakpoints() == (0.5,)
    assert Step(time=0.5, value=3.0).before == 0.0


@pytest.mark.parametrize("kind", [Ramp, CosineRamp, CosineRampPublished])
def test_rises_tell_their_breakpoints(kind: type[Ramp[float]]) -> None:
    assert kind(**RISE).breakpoints() == (0.05, 0.6)


@pytest.mark.parametrize(
    "profile",
    [
        Constant(value=2.0),
        Step(time=0.3, before=-1.0, value=2.0),
        Ramp(**RISE),
        CosineRamp(**RISE),
        CosineRampPublished(**RISE),
        Table(times=(0.0, 1.0, 3.0), values=(1.0, 2.0, -2.0)),
    ],
    ids=lambda profile: profile.kind,
)
@given(time=st.floats(-2, 5))
def test_segments_give_the_value_as_documented(profile: Profile[float], time: float) -> None:
    segments = profile.segments()
    assert segments.start[0] == -math.inf
    assert segments.slope[0] == 0
    assert np.all(np.diff(segments.start) > 0)
    piece = segments[max(index for index, start in enumerate(segments.start) if start < time)]
    linear = piece.slope * (time - piece.start) if piece.slope else 0.0
    expected = piece.offset + linear + piece.amplitude * math.cos(piece.frequency * time + piece.phase)
    assert profile.at(time) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("end", [0.0, -0.5])
def test_equation_29_needs_an_end_after_time_zero(end: float) -> None:
    """Its cosine has the period 2 end."""
    with pytest.raises(ModelError, match=f"end = {end:g} s must be later than time zero"):
        CosineRampPublished(start=-1.0, end=end, value=1.0)


@pytest.mark.parametrize("kind", [Ramp, CosineRamp, CosineRampPublished])
@pytest.mark.parametrize("end", [0.2, 0.1])
def test_a_rise_takes_time(kind: type[Ramp[float]], end: float) -> None:
    with pytest.raises(ModelError, match=r"must be later than start = 0\.2 s"):
        kind(start=0.2, end=end, value=1.0)


def test_quantities_depend_on_the_use() -> None:
    speed = {"kind": "constant", "value": "60 rpm"}
    torque = {"kind": "constant", "value": "60 N mm"}
    driver = Pulley(name="driver", center=(0, 0), radius=0.1, speed=speed)
    driven = Pulley(name="driven", center=(1, 0), radius=0.1, inertia=1, torque=torque)
    assert isinstance(driver.speed, Constant)
    assert isinstance(driven.torque, Constant)
    assert driver.speed.value == pytest.approx(2 * math.pi)
    assert driven.torque.value == pytest.approx(0.06)
    with pytest.raises(ModelError, match="units of rad/s"):
        Pulley(name="driver", center=(0, 0), radius=0.1, speed=torque)


def test_profiles_are_accepted_as_objects() -> None:
    driver = Pulley(name="driver", center=(0, 0), radius=0.1, speed=Ramp(**RISE))
    assert driver.speed
    assert driver.speed.at(0.325) == pytest.approx(6)


def test_table_from_a_file(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text("# measured\ntime,torque\n0.0,1.0\n\n2.0, 3.0\n")
    table = Table.model_validate({"file": file})
    assert table.times == (0.0, 2.0)
    assert table.values == (1.0, 3.0)


def test_largest_value_sees_pulses_jumps_and_ends() -> None:
    pulse = Table(times=(0.4001, 0.4002, 0.4003), values=(1.0, -7.0, 1.0))
    assert pulse.largest(1.0) == pytest.approx(7.0)
    assert pulse.largest(0.4) == 1.0
    assert Step(time=0.5, before=9.0, value=-2.0).largest(1.0) == 9.0
    assert Step(time=0.5, before=-9.0, value=9.0).extreme(1.0) == -9.0  # the first of equal ones
    assert Step(time=0.5, before=1.0, value=-2.0).extreme(1.0) == -2.0
    assert Step(time=0.5, before=1.0, value=-2.0).largest(1.0) == 2.0
    assert Step(time=0.5, before=1.0, value=-2.0).largest(0.5) == 1.0
    assert Step(time=0.5, before=9.0, value=-2.0).extreme(1.0, 0.6) == -2.0
    assert Step(time=0.5, before=9.0, value=-2.0).extreme(1.0, 0.5) == 9.0
    assert CosineRampPublished(start=0.2, end=0.4, value=-3.0).largest(2.0) == pytest.approx(3.0)
    assert Ramp(start=0.0, end=2.0, value=3.0).largest(1.0) == pytest.approx(1.5)
