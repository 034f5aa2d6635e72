"""Verified: web lines over time and their vibrations: transport of strain, waves, a dancer, and control of tension.

The web between two rollers that grip it has the content L/g.  What enters has the stretch g_0 of the span before, so
that d(L/g)/dt = v_1/g_0 - v_2/g: 1/g goes to its steady value with the rate v_2/L.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid, solve_ivp
from scipy.optimize import brentq, least_squares, newton, root

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Drive
from beltdyn.results import Run
from beltdyn.results.energy_balance import largest_closure

pytestmark = pytest.mark.slow

RADIUS, SPEED, STIFFNESS, TENSION = 0.05, 2.0, 2e4, 100.0
FRICTION, MASS, THICKNESS = 0.8, 0.05, 1e-4
UNWINDS = {"core_radius": 0.01, "radius": 0.012}
WINDS = {"core_radius": 0.01, "length": 0.0, "core_inertia": 1e-4}
RISE, DRAW = (0.05, 0.10), 5e-4


def line(rollers: list[dict[str, Any]], end: float, mass: float = MASS, **more: Any) -> Drive:
    """Rollers between an unwinder and a winder with the same tension."""
    return Drive(
        belt={
            "axial_stiffness": STIFFNESS,
            "bending_stiffness": 1e-4,
            "mass_per_length": mass,
            "thickness": THICKNESS,
            "width": 0.2,
        },
        unwinder={"point": [0.0, 0.3], "tension": TENSION, "roll": UNWINDS},
        pulley=[{"radius": RADIUS} | one for one in rollers],
        winder={"point": [end, 0.3], "tension": TENSION, "roll": WINDS},
        contact={"friction": FRICTION, "creep_ratio": 3e-5},  # a fifth of the default: near Coulomb's law
        **more,
    )


@pytest.fixture(scope="module")
def stepped() -> Run:
    """A line of two driven rollers, of which the second gets faster by a draw."""
    faster = SPEED / RADIUS * np.array([1.0, 1.0, 1.0 + DRAW, 1.0 + DRAW])
    rising = {"kind": "table", "times": [0.0, *RISE, 10.0], "values": faster.tolist()}
    drive = line(
        [
            {"name": "first", "center": [0.5, 0.0], "speed": SPEED / RADIUS},
            {"name": "last", "center": [1.5, 0.0], "speed": rising},
        ],
        2.0,
        simulation={"duration": 1.1, "start": "steady", "output_interval": 5e-3, "rtol": 1e-4},
    )
    return bd.simulate(drive)


def test_a_draw_is_transported(stepped: Run, curve: Callable[..., None]) -> None:
    """The tension follows the content of the span and of the arc that slides on the first roller.

    To 0.1 % of the change of the draw.
    """
    law, time = stepped.prepared.belt.stretch_parameters, stepped.dataset.time.values
    length = float(stepped.prepared.path.span_lengths[0])
    tension = np.linspace(TENSION, TENSION + 1.2 * STIFFNESS * DRAW, 2001)
    thin = 1.0 / law.stretch(tension)
    slides = RADIUS / FRICTION * (thin - thin[0]) / (tension - MASS * SPEED**2)
    content = length * thin + cumulative_trapezoid(slides, tension, initial=0)

    def flow(at: float, held: FloatArray) -> FloatArray:
        part = np.clip((at - RISE[0]) / (RISE[1] - RISE[0]), 0.0, 1.0)
        return np.asarray(SPEED * (thin[0] - (1.0 + DRAW * part) * np.interp(held, content[::-1], thin[::-1])))

    found = solve_ivp(flow, (0.0, time[-1]), [content[0]], t_eval=time, rtol=1e-10, atol=1e-13, max_step=0.01)
    expected = np.interp(found.y[0], content[::-1], tension[::-1])
    assert expected[-1] - TENSION == pytest.approx(STIFFNESS * DRAW * (1.0 - np.exp(-2.0)), rel=0.02)
    tensions = stepped.dataset.span_tension.values[:, 0]
    curve("web_draw", time, tensions, "found", "-")
    curve("web_draw", time[::10], expected[::10], "closed form", ".")
    later = time > 0.2
    assert np.abs(tensions - expected)[later].max() < 1e-3 * STIFFNESS * DRAW


def test_the_account_of_energy_closes_with_the_flow_through_the_ends(stepped: Run) -> None:
    """To the tolerance of the steps."""
    assert abs(largest_closure(stepped.dataset).error) < 1e-4
    assert abs(stepped.dataset.numerical_loss.values[-1]) < 1e-4 * stepped.dataset.torque_work.values[-1]


def test_rolls_shrink_and_grow_by_what_passes(stepped: Run) -> None:
    """R^2 = R_0^2 + h l / pi and T R: what is unwound is v t / g to 1e-5, what is wound up less the change of the line.

    The content of the span between the rollers, and of the arc behind it, to which the web sticks, changes by the
    stretch; what slides is left out, to 1 % of that.
    """
    found, time = stepped.dataset, stepped.dataset.time.values
    stretch = stepped.prepared.belt.stretch_parameters.stretch
    length, radius = found.roll_length.values, found.roll_radius.values
    begins = np.pi * (UNWINDS["radius"] ** 2 - UNWINDS["core_radius"] ** 2) / THICKNESS
    passed = SPEED * time / float(stretch(TENSION))
    assert begins - length[:, 0] == pytest.approx(passed, rel=1e-5, abs=1e-6)
    np.testing.assert_allclose(radius**2, 0.01**2 + THICKNESS / np.pi * np.maximum(length, 0.0), rtol=1e-12)
    np.testing.assert_allclose(found.roll_torque.values, TENSION * radius, rtol=1e-12)
    path = stepped.prepared.path
    held = path.span_lengths[0] + RADIUS * path.wrap_angles[1]
    between = held / stretch(found.span_tension.values[[0, -1], 0])
    assert length[-1].sum() - begins == pytest.approx(between[0] - between[1], rel=0.01)
    mass = MASS * length[-1, 1]
    expected = WINDS["core_inertia"] + mass * (radius[-1, 1] ** 2 + 0.01**2) / 2.0
    assert found.roll_inertia.values[-1, 1] == pytest.approx(expected, rel=1e-12)
    assert found.roll_speed.values[0, 0] == pytest.approx(SPEED / radius[0, 0], rel=1e-5)
    (told,) = [one for one in stepped.warnings if "empty" in one]
    assert f"the roll of the unwinder is empty from t = {time[np.argmax(length[:, 0] < 0.0)]:.4g} s on" in told


def test_steady_running_stays(stepped: Run) -> None:
    """Before the draw changes, tensions stay as they begin to a millionth."""
    before = stepped.dataset.span_tension.values[stepped.dataset.time.values < RISE[0]]
    assert np.abs(before - before[0]).max() < 1e-6 * TENSION


def test_stretch_waves(stepped: Run) -> None:
    """To 0.5 %: half a wave between gripping rollers, a quarter between one and a held tension."""
    drive = stepped.drive.replace(pulley=[one.replace(speed=SPEED / RADIUS) for one in stepped.drive.pulleys])
    found = bd.modes(drive, count=60).dataset
    free = np.array(drive.path.span_lengths)
    stretch = 1.0 + TENSION / STIFFNESS
    speed = np.sqrt(STIFFNESS / MASS) * stretch
    longitudinal = found.frequency.values[found.belt_share.values.ravel() > 0.9]
    assert longitudinal[:3] == pytest.approx(np.sort(speed / free / np.array([2.0, 4.0, 4.0])), rel=5e-3)


def test_a_varying_draw_varies_the_tension(curve: Callable[..., None]) -> None:
    """Amplitude and phase to 1 % up to half of the span's wave frequency c / 2 L: dv / g over v / g^2 EA + i w C.

    An eccentric roller varies its rim speed alike, with order 1.
    """
    orders, part, faster = np.array([0.02, 0.05, 0.2, 1.0, 3.0, 10.0, 25.0]), 1e-5, SPEED * (1.0 + DRAW)
    waves = [{"order": one, "amplitude": part} for one in orders.tolist()]
    drive = line(
        [
            {"name": "first", "center": [0.5, 0.0], "speed": SPEED / RADIUS},
            {"name": "last", "center": [1.5, 0.0], "speed": faster / RADIUS, "harmonics": waves},
        ],
        2.0,
        simulation={"duration": 1.0, "start": "steady"},
    )
    found = bd.response(drive, speed=[faster / RADIUS], pulley="last").dataset.isel(speed=0, span=0)
    length, tension = float(drive.path.span_lengths[0]), float(found.span_tension)
    before, stretch = 1.0 + np.array([TENSION, tension]) / STIFFNESS
    thinner = 1.0 / STIFFNESS / stretch**2
    content = length * thinner + RADIUS / FRICTION * (1.0 / before - 1.0 / stretch) / (tension - MASS * SPEED**2)
    turning = orders * faster / RADIUS
    assert turning.max() < 0.51 * np.pi * np.sqrt(STIFFNESS / MASS) * stretch / length
    expected = part * faster / stretch / (faster * thinner + 1j * turning * content)
    amplitude = found.span_tension_amplitude.values
    curve("web_ripple", turning / 2.0 / np.pi, amplitude, "found", "o")
    curve("web_ripple", turning / 2.0 / np.pi, np.abs(expected), "closed form", "-")
    assert amplitude * np.exp(1j * found.span_tension_phase.values) == pytest.approx(expected, rel=0.01)


def test_a_dancer() -> None:
    """To 0.5 %: frequency and damping by the equations of transport, with the inertia of the roller."""
    mass, rate, damping, inertia, span = 8.0, 500.0, 60.0, 1e-3, 2.0
    apart = np.hypot(span, 0.3)
    length = np.sqrt(apart**2 - (2.0 * RADIUS) ** 2)
    rise = np.sin(np.arctan2(0.3, span) + np.arcsin(2.0 * RADIUS / apart))
    dancer = {"name": "dancer", "center": [2.0 * span, 0.3], "side": "outside", "inertia": inertia, "mass": mass}
    driven = ({"name": name, "center": [x, 0.0], "speed": SPEED / RADIUS} for name, x in (("a", span), ("b", 3 * span)))
    first, last = driven
    slide = {"kind": "sliding", "pulley": "dancer", "direction": [0, 1], "rate": rate, "damping": damping}
    slide["preload"] = 2.0 * TENSION * rise
    drive = line(
        [first, dancer, last], 4.0 * span, mass=1e-3, tensioner=[slide], simulation={"duration": 1.0, "start": "steady"}
    )
    along, flow = STIFFNESS / length, SPEED / length
    sideways = 2.0 * TENSION * (1.0 - rise**2) / length
    turning = RADIUS**2 / inertia
    motion = np.array(
        [
            [0.0, 1.0, 0.0, 0.0, 0.0],
            [-(rate + sideways) / mass, -damping / mass, 0.0, -rise / mass, -rise / mass],
            [0.0, 0.0, 0.0, -turning, turning],
            [0.0, along * rise, along, -flow, 0.0],
            [0.0, along * rise, -along, flow, -flow],
        ]
    )
    values = np.linalg.eigvals(motion)
    slow = values[np.argmin(np.abs(values.imag - 2.0 * np.pi * 2.0))]
    found = bd.modes(drive, count=3).dataset
    assert found.kind.values[0] == "tensioner"
    assert 2.0 * np.pi * found.frequency.values[0] == pytest.approx(slow.imag, rel=5e-3)
    assert found.growth_rate.values[0] == pytest.approx(slow.real, rel=5e-3)


@pytest.mark.parametrize("inertia", [1e-3, 5e-3])
@pytest.mark.parametrize("creep_ratio", [None, 4e-4])
def test_what_the_friction_law_adds_to_the_damping_of_a_fast_dancer(inertia: float, creep_ratio: float | None) -> None:
    """Its roller swings at 35 and 16 Hz: damping less that part as of arcs that adhere, to 5 % of the damping.

    The web leaves an arc with the stretch that it had a time R phi / v before; 3 % are what slides on the arcs.
    """
    mass, rate, damping, span = 8.0, 500.0, 60.0, 2.0
    apart = np.hypot(span, 0.3)
    length = np.sqrt(apart**2 - (2.0 * RADIUS) ** 2)
    rise = np.sin(np.arctan2(0.3, span) + np.arcsin(2.0 * RADIUS / apart))
    slide = {"kind": "sliding", "pulley": "dancer", "direction": [0, 1], "rate": rate, "damping": damping}
    drive = line(
        [
            {"name": "a", "center": [span, 0.0], "speed": SPEED / RADIUS},
            {"name": "dancer", "center": [2.0 * span, 0.3], "side": "outside", "inertia": inertia, "mass": mass},
            {"name": "b", "center": [3.0 * span, 0.0], "speed": SPEED / RADIUS},
        ],
        4.0 * span,
        mass=1e-3,
        tensioner=[slide | {"preload": 2.0 * TENSION * rise}],
        simulation={"duration": 1.0, "start": "steady"},
    )
    drive = drive.replace(contact={"friction": FRICTION} | ({"creep_ratio": creep_ratio} if creep_ratio else {}))
    along, flow, delay = STIFFNESS / length, SPEED / length, RADIUS * float(drive.path.wrap_angles[1]) / SPEED
    sideways = 2.0 * TENSION * (1.0 - rise**2) / length

    def equations(value: complex) -> complex:
        return complex(
            np.linalg.det(
                np.array(
                    [
                        [value, -1.0, 0.0, 0.0, 0.0],
                        [(rate + sideways) / mass, value + damping / mass, 0.0, rise / mass, rise / mass],
                        [0.0, 0.0, value * inertia / RADIUS**2, 1.0, -1.0],
                        [0.0, -along * rise, -along, value + flow, 0.0],
                        [0.0, -along * rise, along, -flow * np.exp(-value * delay), value + flow],
                    ]
                )
            )
        )

    found = bd.modes(drive, count=4)
    (turning,) = np.flatnonzero(found.dataset.kind.values == "rotational")
    at = found.dataset.isel(mode=turning)
    size = 2.0 * np.pi * float(at.frequency)
    adhering: complex = newton(equations, 1j * size, tol=1e-10)  # type: ignore[call-overload]
    assert size == pytest.approx(adhering.imag, rel=5e-3)
    damped = float(at.damping_ratio)
    assert damped - float(at.creep_damping) == pytest.approx(-adhering.real / size, abs=0.05 * damped)
    told = any(f"of that of mode {int(at.mode)}" in text for text in found.warnings)
    assert told == (float(at.creep_damping) > 0.05 * damped)


# Control of tension: a load cell before a roller, whose speed or torque a PI controller trims

DRIVE, RISES = 0.5, {"speed": 0.02, "torque": 0.1}
"""Inertia of the last roller, kg m^2; integral times, s."""
SPEED_GAIN, TORQUE, CELL, SET_FORCE = 5.0, 2.0, 1e6, 180.0


def controlled(trimmed: str, gain: float, first: Any = SPEED / RADIUS, **more: Any) -> Drive:
    """A load cell between two rollers, of which it trims the last by its speed or its torque."""
    own = {"speed": {"speed": SPEED / RADIUS, "speed_gain": SPEED_GAIN}, "torque": {"torque": TORQUE}}[trimmed]
    sensor = {"sensor": "cell", "set_force": SET_FORCE, "force_gain": gain, "integral_time": RISES[trimmed]}
    rollers: list[dict[str, Any]] = [
        {"name": "first", "center": [0.5, 0.0], "speed": first},
        {"name": "cell", "center": [1.0, 0.3], "side": "outside", "inertia": 1e-4, "mass": 0.2},
        {
            "name": "last",
            "center": [1.5, 0.0],
            "inertia": DRIVE,
            "load": [{"kind": f"{trimmed}_trim"} | own | sensor],
        },
    ]
    cell = {"kind": "sliding", "pulley": "cell", "direction": [0, 1], "rate": CELL, "preload": SET_FORCE}
    return line(
        rollers,
        2.0,
        mass=0.01,
        tensioner=[cell | {"damping": 20.0}],
        simulation={"duration": 2.5, "start": "steady", "output_interval": 5e-3, "rtol": 1e-4} | more,
    )


def swings(trimmed: str, gain: float) -> complex:
    """The slow eigenvalue by the equations of transport.

    The web that sticks to the cell leaves it with the stretch that it had a time R phi / v before.  The content of the
    web includes what slides on the first roller, and the yielding of the cell.  With G the gain of the loop, the
    characteristic equation of a trimmed speed is
    s (L s + v (2 - exp(-s R phi / v))) (J s + K) + EA R (G (s + 1/T) + R s) = 0, that of a torque the same without K.
    """
    path = controlled(trimmed, 1e-5).path
    rise = np.sin(np.arctan2(0.3, 0.5) + np.arcsin(2.0 * RADIUS / np.hypot(0.5, 0.3)))
    seen, held = 2.0 * rise, SET_FORCE / (2.0 * rise)
    length = float(sum(path.span_lengths[:2])) + RADIUS / FRICTION * (1.0 - TENSION / held)
    length, delay = length + STIFFNESS * seen**2 / CELL, RADIUS * path.wrap_angles[1] / SPEED
    own, arm = (SPEED_GAIN, SPEED_GAIN * SPEED / RADIUS) if trimmed == "speed" else (0.0, TORQUE)
    pull, loop = STIFFNESS * RADIUS, STIFFNESS * RADIUS * arm * seen * gain

    def missing(parts: FloatArray) -> FloatArray:
        s = complex(*parts)
        web = s * (length * s + SPEED * (2.0 - np.exp(-s * delay))) * (DRIVE * s + own)
        left = web + pull * RADIUS * s + loop * (s + 1.0 / RISES[trimmed])
        return np.array([left.real, left.imag])

    first = np.roots(
        [DRIVE * length, own * length + DRIVE * SPEED, own * SPEED + pull * RADIUS + loop, loop / RISES[trimmed]]
    )
    begin = max(first, key=lambda one: (round(one.real, 9), one.imag))
    return complex(*root(missing, [begin.real, begin.imag], tol=1e-12).x)


def limit(trimmed: str) -> float:
    """The largest stable gain, 1/N."""
    low, high = {"speed": (2e-5, 2e-4), "torque": (2e-3, 2e-2)}[trimmed]
    return float(brentq(lambda gain: swings(trimmed, gain).real, low, high))


@pytest.mark.parametrize("trimmed", ["speed", "torque"])
@pytest.mark.parametrize("part", [0.8, 1.25])
def test_gains_below_and_above_the_limit(trimmed: str, part: float) -> None:
    """To 0.5 % of the eigenvalue; steady running says whether it is stable."""
    gain = part * limit(trimmed)
    drive = controlled(trimmed, gain)
    run = bd.steady_state(drive)
    cell = run.dataset.hub_force.isel(time=-1, pulley=1).values
    assert np.hypot(*cell) == pytest.approx(SET_FORCE, rel=1e-3)
    found = bd.modes(drive, about=run, count=1).dataset
    expected = swings(trimmed, gain)
    slow = complex(found.growth_rate.values[0], 2.0 * np.pi * found.frequency.values[0])
    assert abs(slow - expected) < 0.005 * abs(expected)
    told = [one for one in run.warnings if "steady running is unstable" in one]
    assert bool(told) == (part > 1.0) == (expected.real > 0.0)
    if told:
        assert f"grows by {slow.real:.3g} 1/s with {slow.imag / 2.0 / np.pi:.3g} Hz" in told[0]


@pytest.mark.parametrize("part", [0.8, 1.25])
def test_a_disturbance_grows_or_decays_by_the_eigenvalue(part: float, curve: Callable[..., None]) -> None:
    """After a bump of the first roller's speed; to 2 % of the eigenvalue, with the mesh of a run."""
    gain = part * limit("speed")
    bump = SPEED / RADIUS * np.array([1.0, 1.0, 1.0002, 1.0, 1.0])
    first = {"kind": "table", "times": [0.0, 0.05, 0.1, 0.15, 10.0], "values": bump.tolist()}
    run = bd.simulate(controlled("speed", gain, first))
    time, tension = run.dataset.time.values, run.dataset.span_tension.values[:, 1]
    curve("web_control", time, tension, f"{part:g} of the limit", "-")
    later = time > 0.6

    def rest(guess: FloatArray) -> FloatArray:
        swings = np.exp(complex(*guess) * time[later])
        basis = np.column_stack([swings.real, swings.imag, np.ones(swings.size)])
        return np.asarray(basis @ np.linalg.lstsq(basis, tension[later], rcond=None)[0] - tension[later])

    expected = swings("speed", gain)
    found = complex(*least_squares(rest, [0.0, 11.0]).x)
    assert abs(found - expected) < 0.02 * abs(expected)
    assert found.real * expected.real > 0.0


def test_a_gain_of_the_wrong_sign_runs_away() -> None:
    """It grows without swinging, with the real eigenvalue to 1 %."""
    drive, expected = controlled("speed", -7e-5), swings("speed", -7e-5).real
    run = bd.steady_state(drive)
    (told,) = [one for one in run.warnings if "unstable" in one]
    assert "without swinging" in told
    assert "Reverse the sign" in told
    assert run.dataset.attrs["growth"] == pytest.approx([expected, 0.0], rel=1e-2, abs=1e-6)
    assert any("without swinging" in one for one in bd.modes(drive, about=run, count=1).warnings)


def test_a_trim_beyond_its_limit_is_refused() -> None:
    drive = controlled("speed", 1e-5)
    last = drive.pulleys[2]
    less = last.replace(load=[last.load[0].replace(largest_trim=1e-3)])
    with pytest.raises(ConvergenceError, match=r'controller of "last" holds its set value with a trim of 0\.0113'):
        bd.steady_state(drive.replace(pulley=[*drive.pulleys[:2], less]))


# Idlers that slip, and two rollers in an S

LITTLE, DRY, VISCOUS = 0.1, 0.3, 0.02
"""Friction of an idler; torque of its bearings, N m and N m s/rad."""


def with_idler(speed: Any, dry: float, viscous: float, inertia: float = 2e-3, **more: Any) -> Drive:
    """Two driven rollers, and an idler with friction in its bearings between them."""
    bearing = {"kind": "resistance", "constant": dry, "linear": viscous}
    idler = {"name": "idler", "center": [1.0, 0.3], "side": "outside", "inertia": inertia, "friction": LITTLE}
    ends = ({"name": name, "center": [x, 0.0], "speed": speed} for name, x in (("first", 0.5), ("last", 1.5)))
    first, last = ends
    settings = {"duration": 0.24, "start": "steady", "output_interval": 1e-3, "rtol": 1e-4} | more
    return line([first, idler | {"load": [bearing]}, last], 2.0, simulation=settings)


def largest_moment(run: Run, tension: Any, speed: Any) -> Any:
    """Moment that the web can give to the idler behind a tension (N), by the capstan, N m."""
    grip = np.exp(LITTLE * run.prepared.path.wrap_angles[1]) - 1.0
    return RADIUS * (tension - MASS * speed**2) * grip


def test_an_idler_slips_where_its_bearings_take_more_than_the_capstan_gives() -> None:
    """To 0.1 %: M_0 + c w = R (T - m v^2) (exp(mu phi) - 1); with less friction it runs with the web."""
    run = bd.steady_state(with_idler(SPEED / RADIUS, DRY, VISCOUS))
    last = run.dataset.isel(time=-1)
    speed = (largest_moment(run, float(last.span_tension[0]), SPEED) - DRY) / VISCOUS
    assert speed < 0.5 * SPEED / RADIUS
    assert -float(last.pulley_speed[1]) == pytest.approx(speed, rel=1e-3)
    free = bd.steady_state(with_idler(SPEED / RADIUS, 0.02, 2e-3)).dataset.isel(time=-1)
    assert -float(free.pulley_speed[1]) == pytest.approx(SPEED / RADIUS, rel=1e-3)


def test_an_idler_slips_in_a_ramp_where_its_inertia_is_too_large() -> None:
    """To 1 % of how far it stays behind: J dw/dt = R (T - m v^2) (exp(mu phi) - 1) - M_0 - c w."""
    speeds = SPEED / RADIUS * np.array([1.0, 1.0, 1.5, 1.5])
    ramp = {"kind": "table", "times": [0.0, 0.05, 0.15, 10.0], "values": speeds.tolist()}
    run = bd.simulate(with_idler(ramp, 0.02, 2e-3, inertia=6e-3))
    slides = run.dataset.time.values > 0.06
    found = run.dataset.isel(time=slides)
    speed, web = -found.pulley_speed.values[:, 1], RADIUS * found.pulley_speed.values[:, 0]
    assert found.sliding_share.values[:, 1] == pytest.approx(1.0)
    gives = largest_moment(run, found.span_tension.values[:, 0], web)
    rate = (gives - 0.02 - 2e-3 * speed) / 6e-3
    expected = speed[0] + cumulative_trapezoid(rate, found.time.values, initial=0)
    behind = float((web / RADIUS - speed).max())
    assert behind > 10.0
    assert np.abs(speed - expected).max() < 0.01 * behind


def test_two_rollers_in_an_s_hold_by_the_sum_of_their_arcs() -> None:
    """To 0.1 % of the ratio of tensions: Euler and Eytelwein over both faces of the web."""
    slow: dict[str, Any] = {"speed": 0.98 * SPEED / RADIUS, "friction": 0.2}
    other: dict[str, Any] = {"side": "outside", "speed": -0.98 * SPEED / RADIUS, "friction": 0.2}
    rollers: list[dict[str, Any]] = [
        {"name": "one", "center": [0.5, 0.0]} | slow,
        {"name": "two", "center": [0.8, 0.3]} | other,
        {"name": "last", "center": [1.5, 0.0], "speed": SPEED / RADIUS},
    ]
    run = bd.steady_state(line(rollers, 2.0, simulation={"duration": 1.0}))
    carried = MASS * float(run.dataset.attrs["belt_parameter"]) ** 2
    before, after = run.dataset.span_tension.values[-1, [3, 1]] - carried
    assert after / before == pytest.approx(np.exp(0.2 * sum(run.prepared.path.wrap_angles[:2])), rel=1e-3)


# Rolls with torques: masses J/R^2 at the ends of the line

BRAKE = {"core_radius": 0.05, "radius": 0.1, "core_inertia": 2e-3}
PULLS = {"core_radius": 0.01, "length": 0.0, "core_inertia": 1e-4}
STOP = (0.2, 0.6)
"""When the line slows down to half of its speed."""


def rolled(speed: Any, **more: Any) -> Drive:
    """Two driven rollers between a roll with a brake and one with a motor, both of the same tension at first."""
    rollers = [{"name": name, "center": [x, 0.0], "speed": speed} for name, x in (("first", 0.5), ("last", 1.5))]
    settings = {"duration": 1.0, "start": "steady", "output_interval": 2e-3, "rtol": 1e-4} | more
    return line(rollers, 2.0, simulation=settings).replace(
        unwinder={"point": [0.0, 0.3], "torque": TENSION * BRAKE["radius"], "roll": BRAKE},
        winder={"point": [2.0, 0.3], "torque": TENSION * PULLS["core_radius"], "roll": PULLS},
    )


@pytest.fixture(scope="module")
def stopping() -> Run:
    times = np.linspace(*STOP, 81)
    slower = SPEED / RADIUS * (0.75 + 0.25 * np.cos(np.pi * (times - STOP[0]) / (STOP[1] - STOP[0])))
    table = {"kind": "table", "times": [0.0, *times, 10.0], "values": [slower[0], *slower, slower[-1]]}
    return bd.simulate(rolled(table, rtol=1e-5))


def test_rolls_with_torques_in_a_stop(stopping: Run) -> None:
    """Tensions at both ends, to 1 % of their largest change, by roll radii, J/R^2 dv/dt and the contents of spans.

    Half of the web of a span moves with its roll; a span has what slides where it leaves its roller.
    """
    drive, time = stopping.drive, stopping.dataset.time.values
    law, spans = stopping.prepared.belt.stretch_parameters, stopping.prepared.path.span_lengths
    lengths = np.array([spans[2], spans[0], spans[1]])
    begins = np.array([one.roll.length_of(THICKNESS) for one in drive.rolls if one.roll is not None])
    cores, sense = np.array([0.05, 0.01]), np.array([-1.0, 1.0])
    core_inertias, torques = np.array([2e-3, 1e-4]), TENSION * np.array([0.1, 0.01])
    speed = drive.pulleys[0].speed
    assert speed is not None

    def rolls(wound: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        square = cores**2 + THICKNESS * wound / np.pi
        inertia = core_inertias + 0.5 * MASS * wound * (square + cores**2)
        return np.sqrt(square), inertia / square, 0.5 * THICKNESS / np.pi / square

    def spans_of(contents: FloatArray) -> tuple[FloatArray, FloatArray]:
        stretch = lengths / contents
        for _ in range(2):
            tension, thin = law.tension(stretch), 1.0 / stretch
            slides = 0.5 * RADIUS / FRICTION * np.diff(thin) * np.abs(np.diff(tension)) / tension[1:]
            stretch = lengths / (contents - np.append(0.0, slides))
        return stretch, np.asarray(law.tension(stretch))

    def rates(at: float, state: FloatArray) -> FloatArray:
        contents, moves, wound = state[:3], state[3:5], state[5:]
        stretch, tension = spans_of(contents)
        flow = moves / stretch[[0, 2]]
        radius, mass, grows = rolls(wound)
        roller = RADIUS * float(speed.at(at))
        passes = np.array([flow[0], roller / stretch[0], roller / stretch[1], flow[1]])
        push = sense * (torques / radius - tension[[0, 2]])
        gains = (push + sense * mass * grows * flow * moves) / (mass + 0.5 * MASS * lengths[[0, 2]])
        return np.array([*(passes[:-1] - passes[1:]), *gains, *(sense * flow)])

    first = np.concatenate([lengths / float(law.stretch(TENSION)), [SPEED, SPEED], begins])
    found = solve_ivp(rates, (0.0, time[-1]), first, t_eval=time, rtol=1e-9, atol=1e-12, max_step=1e-3)
    expected = np.array([spans_of(one)[1] for one in found.y[:3].T])[:, [0, 2]]
    tensions = stopping.dataset.span_tension.values[:, [2, 1]]
    change = np.abs(expected - TENSION).max(axis=0)
    assert np.all(np.abs(tensions - expected).max(axis=0) < 0.01 * change)


def test_energy_of_a_stop_with_rolls(stopping: Run) -> None:
    """To 1e-6, with the kinetic energy of the rolls, of which steps lose little: a fifth of their tolerance at most."""
    found = stopping.dataset
    assert abs(largest_closure(found).error) < 1e-6
    kinetic, speed = found.kinetic_energy.values, found.roll_speed.values
    assert kinetic == pytest.approx((0.5 * found.roll_inertia.values * speed**2).sum(axis=1), rel=0.05)
    lost = np.abs(found.numerical_loss.values) / kinetic[0]
    assert lost.max() < 0.2 * stopping.drive.simulation.rtol
    assert lost[-1] < 1e-6


def test_modes_of_a_line_between_rolls() -> None:
    """To 0.5 %: a roll on its span, which at the winder loses what flows through it.

    m dv = -/+ EA dg, and the content of the span L/g changes by dv/g, less v dg/g^2 where it is wound.
    """
    drive = rolled(SPEED / RADIUS)
    stretch, spans = 1.0 + TENSION / STIFFNESS, drive.path.span_lengths
    found = bd.modes(drive, count=8).dataset
    values = found.growth_rate.values + 2j * np.pi * found.frequency.values
    for end, span in ((0, 2), (1, 1)):
        roll = drive.rolls[end].roll
        assert roll is not None
        length = np.array([roll.length_of(THICKNESS)])
        mass = float(roll.inertia_at(length, THICKNESS, MASS)[0] / roll.radius_at(length, THICKNESS)[0] ** 2)
        mass += MASS * spans[span] / 3.0
        decay, rate = end * SPEED / spans[span], STIFFNESS * stretch / spans[span] / mass
        expected = np.roots([1.0, decay, rate])[0]
        assert np.abs(values - expected).min() < 5e-3 * abs(expected)


@pytest.mark.parametrize("braked", [False, True])
def test_a_dancer_beside_an_unwinder(braked: bool) -> None:
    """To 0.2 %, with a kept tension and with a roll of the mass J/R^2 on a brake."""
    mass, rate, damping, inertia, span = 8.0, 500.0, 60.0, 1e-3, 2.0
    dancer = {"name": "dancer", "center": [span, 0.3], "side": "outside", "inertia": inertia, "mass": mass}
    slide = {"kind": "sliding", "pulley": "dancer", "direction": [0, 1], "rate": rate, "damping": damping}
    rollers: list[dict[str, Any]] = [dancer, {"name": "last", "center": [2.0 * span, 0.0], "speed": SPEED / RADIUS}]
    settings = {"duration": 1.0, "start": "steady"}
    path = line(rollers, 3.0 * span, mass=1e-3, simulation=settings).path
    rises = np.array([path.span_directions[2][1], -path.span_directions[0][1]])
    lengths = np.array([path.span_lengths[2], path.span_lengths[0]])
    slide["preload"] = TENSION * float(rises.sum())
    drive = line(rollers, 3.0 * span, mass=1e-3, tensioner=[slide], simulation=settings)
    roll, held = {"core_radius": 0.05, "length": 0.0, "core_inertia": 0.02}, 0.0
    if braked:
        drive = drive.replace(unwinder={"point": [0.0, 0.3], "torque": 0.05 * TENSION, "roll": roll})
        held = 0.05**2 / 0.02
    along, sideways = STIFFNESS / lengths, float(np.sum(TENSION * (1.0 - rises**2) / lengths))
    turning, flow = RADIUS**2 / inertia, SPEED / lengths[1]
    motion = np.array(
        [
            [0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [-(rate + sideways) / mass, -damping / mass, 0.0, -rises[0] / mass, -rises[1] / mass, 0.0],
            [0.0, 0.0, 0.0, -turning, turning, 0.0],
            [0.0, along[0] * rises[0] * braked, along[0] * braked, 0.0, 0.0, -along[0] * braked],
            [0.0, along[1] * rises[1], -along[1], flow, -flow, 0.0],
            [0.0, 0.0, 0.0, held, 0.0, 0.0],
        ]
    )
    expected = np.linalg.eigvals(motion)
    slow = expected[expected.imag > 1.0][np.argmin(expected[expected.imag > 1.0].imag)]
    found = bd.modes(drive, count=3).dataset
    value = complex(found.growth_rate.values[0], 2.0 * np.pi * found.frequency.values[0])
    assert abs(value - slow) < 2e-3 * abs(slow)
