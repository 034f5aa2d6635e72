"""Compiled profiles against `Profile.at` for every kind, and against Eqs. 28 and 29 as printed; their integrals."""

from math import cos, pi

import numpy as np
import pytest

from beltdyn.machines.profiles.functions import (
    Profiles,
    prescribed_motion,
    profile_bend,
    profile_integral,
    profile_rows,
    profile_value,
)
from beltdyn.model import Constant, CosineRamp, CosineRampPublished, Harmonic, Profile, Pulley, Ramp, Step, Table
from beltdyn.system.build_machines import machine_arrays

START, END, VALUE = 0.05, 0.6, 12.0
RISE = {"start": START, "end": END, "value": VALUE}
PROFILES: dict[str, Profile] = {
    "constant": Constant(value=3.0),
    "step": Step(time=0.2, before=-1.0, value=VALUE),
    "ramp": Ramp(**RISE),
    "cosine_ramp": CosineRamp(**RISE),
    "cosine_ramp_published": CosineRampPublished(**RISE),
    "table": Table(times=(0.0, 0.05, 0.2, 0.6), values=(1.0, -2.0, 5.0, 4.0)),
    "early table": Table(times=(-0.5, -0.2, 0.15), values=(1.0, -2.0, 4.0)),
}
TIMES = [-1.0, 0.0, 0.05, 0.05 + 1e-9, 0.1, 0.2, 0.33, 0.6 - 1e-9, 0.6, 0.6 + 1e-9, 5.0]
HARMONICS = (Harmonic(order=2, amplitude=0.1, phase=0.3), Harmonic(order=0.5, amplitude=-0.05))
ROUNDING = 1e-13


@pytest.fixture(scope="module")
def profiles() -> Profiles:
    """One pulley of prescribed speed for each profile, a free one with its torque, the first ones with harmonics."""
    prescribed = [Pulley(name=k, center=(0, 0), radius=1, speed=p) for k, p in PROFILES.items()]
    free = Pulley(name="free", center=(0, 0), radius=1, inertia=2.0, torque=PROFILES["ramp"])
    wavy = [pulley.replace(harmonics=HARMONICS) for pulley in prescribed]
    return machine_arrays([*prescribed, free, *wavy]).profiles


@pytest.fixture(scope="module", params=list(enumerate(PROFILES)), ids=list(PROFILES))
def case(request: pytest.FixtureRequest) -> tuple[int, Profile]:
    number, name = request.param
    return number, PROFILES[name]


@pytest.mark.parametrize("time", TIMES)
def test_value(profiles: Profiles, case: tuple[int, Profile], time: float) -> None:
    number, profile = case
    assert profile_value(profiles, number, time)[0] == pytest.approx(float(profile.at(time)), abs=ROUNDING)


@pytest.mark.parametrize("time", [-1.0, 0.02, 0.1, 0.33, 0.59, 5.0])
def test_rate(profiles: Profiles, case: tuple[int, Profile], time: float) -> None:
    number, profile = case
    step = 1e-5
    difference = (profile.at(time + step) - profile.at(time - step)) / (2 * step)
    assert profile_value(profiles, number, time)[1] == pytest.approx(float(difference), abs=1e-7)  # truncation


@pytest.mark.parametrize("time", np.linspace(0.0, 1.0, 21))
def test_equations_28_and_29_as_printed(profiles: Profiles, time: float) -> None:
    ramp = 0.0 if time <= START else VALUE * (time - START) / (END - START) if time <= END else VALUE
    cosine = 0.0 if time <= START else VALUE / 2 * (1 - cos(pi * time / END)) if time <= END else VALUE
    numbers = list(PROFILES)
    assert profile_value(profiles, numbers.index("ramp"), time)[0] == pytest.approx(ramp, abs=ROUNDING)
    published = numbers.index("cosine_ramp_published")
    assert profile_value(profiles, published, time)[0] == pytest.approx(cosine, abs=ROUNDING)


def test_equation_29_jumps_by_1_7_percent_after_its_start(profiles: Profiles) -> None:
    published = list(PROFILES).index("cosine_ramp_published")
    before, after = (profile_value(profiles, published, t)[0] for t in (START, np.nextafter(START, 1.0)))
    assert before == 0.0
    assert after / VALUE == pytest.approx(0.5 * (1 - cos(pi / 12)), rel=1e-12)
    assert after / VALUE == pytest.approx(0.017, abs=5e-4)  # the three digits of the issue


@pytest.mark.parametrize("time", TIMES)
def test_angle_is_the_integral(profiles: Profiles, case: tuple[int, Profile], time: float) -> None:
    """Gauss points between kinks and jumps; 16 of them integrate half a cosine exactly."""
    number, profile = case
    kinks = profile.segments().start[1:]
    low, high = sorted((0.0, time))
    ends = np.unique([low, *kinks[(kinks > low) & (kinks < high)], high])
    points, weights = np.polynomial.legendre.leggauss(16)
    half = np.diff(ends)[:, None] / 2
    expected = np.sum(half * weights * profile.at(ends[:-1, None] + half * (1 + points))) * np.sign(time)
    assert profile_integral(profiles, number, time) == pytest.approx(
        float(expected), abs=ROUNDING * (1 + abs(expected))
    )


@pytest.mark.parametrize("time", TIMES)
def test_harmonics_ride_on_the_angle_of_the_mean(profiles: Profiles, case: tuple[int, Profile], time: float) -> None:
    number, _ = case
    mean, rate = profile_value(profiles, number, time)
    angle = profile_integral(profiles, number, time)
    orders = np.array([2.0, 0.5])
    amplitudes, phases = np.array([0.1, -0.05]), np.array([0.3, 0.0])
    waves = amplitudes * np.exp(1j * (orders * angle + phases))
    turned = angle + np.sum((waves.imag - amplitudes * np.sin(phases)) / orders)
    factor, change = 1 + np.sum(waves.real), np.sum(orders * waves.imag)
    expected = turned, mean * factor, rate * factor - mean**2 * change
    found = prescribed_motion(profiles, len(PROFILES) + 1 + number, time)
    assert found == pytest.approx(expected, rel=1e-13, abs=ROUNDING)


@pytest.mark.parametrize("time", [-1.0, 0.02, 0.1, 0.33, 0.59, 5.0])
def test_speed_and_acceleration_are_rates(profiles: Profiles, case: tuple[int, Profile], time: float) -> None:
    number, step = len(PROFILES) + 1 + case[0], 1e-5
    before, after = (np.array(prescribed_motion(profiles, number, time + h)[:2]) for h in (-step, step))
    truncation = step**2 * (10 + abs(profile_value(profiles, number, time)[0])) ** 4 / 6  # third derivative: a k^3 m^4
    rates = prescribed_motion(profiles, number, time)[1:]
    np.testing.assert_allclose(rates, (after - before) / (2 * step), atol=truncation, rtol=0)


def test_without_harmonics_the_speed_is_the_profile(profiles: Profiles, case: tuple[int, Profile]) -> None:
    assert prescribed_motion(profiles, case[0], 0.3)[1:] == profile_value(profiles, case[0], 0.3)


KINKS: dict[str, list[float]] = {
    "constant": [],
    "step": [0.2],
    "ramp": [START, END],
    "cosine_ramp": [START, END],
    "cosine_ramp_published": [START, END],
    "table": [0.0, 0.05, 0.2, 0.6],
    "early table": [-0.5, -0.2, 0.15],
}
WAVES = {"cosine_ramp": pi / (END - START), "cosine_ramp_published": pi / END}
"""Half a wave from start to end, and from zero to the end as Eq. 29 is printed, rad/s."""


@pytest.mark.parametrize("name", PROFILES)
@pytest.mark.parametrize("time", TIMES)
def test_next_kink_and_the_wave_until_then(profiles: Profiles, name: str, time: float) -> None:
    """At a kink the next one is that which follows."""
    kink, frequency = profile_bend(profiles, list(PROFILES).index(name), time)
    later = [instant for instant in KINKS[name] if instant > time]
    assert kink == (min(later) if later else np.inf)
    rising = START <= time < END
    assert frequency == pytest.approx(WAVES.get(name, 0.0) if rising else 0.0, rel=1e-12)


@pytest.mark.parametrize("kind", [CosineRamp, CosineRampPublished])
@pytest.mark.parametrize("value", [-2.0, 1e-3, 2.0])
def test_the_wave_of_a_rise_is_as_quick_however_high_it_is(kind: type[CosineRamp], value: float) -> None:
    rise = profile_rows([kind(start=START, end=END, value=value)], [()])
    assert profile_bend(rise, 0, 0.3)[1] == pytest.approx(WAVES[kind.model_fields["kind"].default], rel=1e-12)
