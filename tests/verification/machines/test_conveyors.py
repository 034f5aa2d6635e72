"""Belts that carry, against DIN 22101, Euler's limit, the wave equation, and their energy account."""

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError
from beltdyn.model import Prepared

LENGTH, LIFT, GRAVITY = 1000.0, 20.0, 9.81
EA, BELT = 72e6, 25.0
CARRYING, RETURN = (1.2, 22.0), (3.0, 18.0)
"""Spacing (m) and rotating mass (kg) of idlers."""
STRIP = {
    "width": 1.0,
    "thickness": 0.016,
    "axial_stiffness": EA,
    "bending_stiffness": 20.0,
    "mass_per_length": BELT,
}
"""A steel-cord belt."""
PRELOAD, RADIUS = 90e3, 0.5
COEFFICIENT = 0.02


def idlers(first: str, second: str, line: tuple[float, float], friction: float) -> dict[str, Any]:
    return {
        "kind": "idlers",
        "span": [first, second],
        "spacing": line[0],
        "idler_mass": line[1],
        "friction": friction,
    }


def conveyor(
    *, lift: float = LIFT, goods: float = 104.0, friction: float = COEFFICIENT, grip: float = 0.4, **more: Any
) -> bd.Drive:
    """A conveyor of a kilometer, whose head drum drives and whose tail drum a weight pulls."""
    carrying, returning = more.pop("lines", (CARRYING, RETURN))
    pulleys = [
        {"name": "head", "center": [0.0, lift], "radius": RADIUS, "speed": more.pop("speed", 8.0)},
        {"name": "tail", "center": [LENGTH, 0.0], "radius": RADIUS}
        | more.pop("tail", {"inertia": 40.0, "mass": 800.0}),
    ]
    slide = {"kind": "sliding", "pulley": "tail", "direction": [1.0, 0.0], "mass": more.pop("slide", 2000.0)}
    return bd.Drive(
        gravity=[0.0, -GRAVITY],
        belt=STRIP | {"contact_stiffness": 2e8},
        pulley=pulleys,
        tensioner=[slide | {"preload": PRELOAD, "damping": more.pop("damping", 2e4)}],
        support=[idlers("tail", "head", carrying, friction), idlers("head", "tail", returning, friction)],
        goods=[{"span": ["tail", "head"], "mass_per_length": goods}] if goods else [],
        contact={"friction": grip, "standstill_creep": 1e-4},
        simulation={"duration": 60.0} | more.pop("simulation", {}),
        **more,
    )


def main_resistance(lift: float, goods: float) -> float:
    """DIN 22101: C f L g (m_R + (2 m_G + m_L) cos delta) + H g m_L, with C = 1, N."""
    rotating = CARRYING[1] / CARRYING[0] + RETURN[1] / RETURN[0]
    slope = math.hypot(LENGTH, lift)
    carried = (2.0 * BELT + goods) * LENGTH / slope
    return COEFFICIENT * slope * GRAVITY * (rotating + carried) + lift * GRAVITY * goods


@pytest.mark.parametrize(("lift", "goods"), [(0.0, 104.0), (LIFT, 104.0), (LIFT, 0.0), (-LIFT, 104.0)])
def test_the_pull_is_the_sum_of_resistances_of_din_22101(lift: float, goods: float) -> None:
    run = bd.steady_state(conveyor(lift=lift, goods=goods))
    speed = float(run.dataset.belt_speed[-1].mean())
    power = float(run.dataset.shaft_torque[-1, 0] * run.dataset.shaft_speed[-1, 0])
    assert power / speed == pytest.approx(main_resistance(lift, goods), rel=0.01)


@pytest.mark.parametrize("lift", [LIFT, -LIFT])
def test_the_closed_form_at_rest_holds_goods_on_the_slope_by_the_driver(lift: float) -> None:
    """Supports bear what is across the slope: hub loads together bear the weight along it.

    No goods lie where the take-up has moved its drum towards them.
    """
    drive = conveyor(lift=lift)
    hand, found = bd.model.estimate_at_rest(bd.model.prepare(drive))[1], bd.equilibrium(drive).dataset
    upper, lower = hand.span_tensions[1], hand.span_tensions[0]
    expected = 0.5 * GRAVITY * lift * 104.0 + 2.0 * RADIUS * GRAVITY * BELT
    assert upper - lower == pytest.approx(expected, rel=1e-3)
    np.testing.assert_allclose(hand.span_tensions, found.span_tension.values, rtol=1e-3)
    np.testing.assert_allclose(np.linalg.norm(hand.hub_loads, axis=1), found.hub_load.values, rtol=1e-3)
    slope = math.hypot(LENGTH, lift)
    carried = slope + min(float(found.tensioner_position.item()), 0.0)
    mass = BELT * float(found.belt_length) + 104.0 * carried
    along = found.hub_force.values.sum(axis=0) @ np.array([-LENGTH, lift]) / slope
    assert along == pytest.approx(-mass * GRAVITY * lift / slope, rel=1e-6)


def test_tensions_follow_the_height_of_a_drum() -> None:
    """That of a meter of belt and goods in the middle of a strand, half as high; spans of drums alike are as long."""
    names = [f"pulley[{one}].center[2]" for one in ("head", "tail")]
    found = bd.sensitivity(conveyor(), of=["span_tension[tail-head]", "span_tension[head-tail]"], numbers=names)
    for name, sign in zip(names, (1.0, -1.0), strict=True):
        hand = sign * 0.5 * GRAVITY * np.array([BELT + 104.0, BELT])
        np.testing.assert_allclose(found.dataset.derivative.sel(number=name), hand, rtol=0.01)


def test_the_load_of_a_conveyor_is_that_of_its_goods() -> None:
    found = bd.operating_map(conveyor(), load=[0.0, 1.0]).dataset
    torques = found.shaft_torque.sel(pulley="head").values / RADIUS
    np.testing.assert_allclose(torques, [main_resistance(LIFT, 0.0), main_resistance(LIFT, 104.0)], rtol=0.01)


def drum_tensions(run: bd.Run) -> tuple[float, float]:
    """Tight and slack tension at the head drum, from the elements next to its arc, N."""
    seen = run.dataset.isel(field_time=-1)
    touching = seen.contact_pulley.values.reshape(seen.sizes["element"], -1)
    on = np.flatnonzero((touching == 0).any(axis=1))
    tension = seen.belt_tension.values
    ends = tension[(on.min() - 1) % tension.size], tension[(on.max() + 1) % tension.size]
    return float(max(ends)), float(min(ends))


def test_the_drum_slips_beyond_eulers_limit() -> None:
    run = bd.steady_state(conveyor())
    tight, slack = drum_tensions(run)
    needed = math.log(tight / slack) / float(run.dataset.wrap_angle[-1, 0])
    assert needed > 0.2
    assert tight - slack == pytest.approx(main_resistance(LIFT, 104.0), rel=0.01)
    bd.steady_state(conveyor(grip=1.02 * needed))
    with pytest.raises(ConvergenceError, match="head"):
        bd.steady_state(conveyor(grip=0.98 * needed))


HANDRAIL = Path(__file__).parents[3] / "docs" / "tasks" / "handrail.toml"
LIMBER = 0.02
"""Bending stiffness (N m^2) of a handrail that closed forms without it are compared with."""


def rubbing(drive: bd.Drive, span: int, hanging: float = 0.0) -> float:
    """Friction of a guide along a span, N, with a part of the weight of what hangs before and behind it.

    A guide carries half of that, 1.6 of 460 N of a handrail; as much as pulleys lose of their friction, where the belt
    that hangs down from them touches them less.
    """
    weight = -drive.belt.mass_per_length * drive.gravity[1]
    whole, level = drive.path.span_lengths[span], abs(float(drive.path.span_directions[span, 0]))
    for one in drive.supports:
        if isinstance(one, bd.model.Guide) and one.span == drive.spans[span]:
            length = (one.end or whole) - one.start
            return float(
                one.friction * (one.pressing * length + weight * level * (length + hanging * (whole - length)))
            )
    return 0.0


def tensions_by_hand(prepared: Prepared, slack: float) -> FloatArray:
    """Tensions in the middle of the spans from that behind the driver, N.

    Weight and guides along spans; on arcs dT = mu (T / R + weight outwards) ds, Euler's formula without weight.
    """
    drive, path, found, parts = prepared.drive, prepared.path, [slack], 2000
    weight = -drive.belt.mass_per_length * drive.gravity[1]

    def of_half(span: int) -> float:
        return 0.5 * float(weight * path.span_directions[span, 1] * path.span_lengths[span] + rubbing(drive, span))

    tension = slack + of_half(0)
    for p in range(1, path.count):
        radius, step = path.radii[p], path.wrap_angles[p] / parts
        friction = drive.frictions[p] if drive.guides[p] else 0.0
        level, up = path.span_directions[p - 1]
        for angle in math.atan2(up, level) + np.sign(radius) * step * (np.arange(parts) + 0.5):
            pressing = tension - weight * radius * math.cos(angle)
            tension += step * (abs(radius) * weight * math.sin(angle) + friction * pressing)
        found.append(tension + of_half(p))
        tension += 2.0 * of_half(p)
    return np.array(found)


@pytest.mark.parametrize("gravity", [0.0, GRAVITY])
def test_a_handrail_is_pulled_through_its_guides(gravity: float) -> None:
    """Straight guides by friction on weight and pressing, newels by Euler's formula, and power by their sum."""
    given = bd.load(HANDRAIL)
    drive = given.replace(gravity=[0.0, -gravity], belt=given.belt.replace(bending_stiffness=LIMBER))
    run = bd.steady_state(drive)
    found, slipping = run.dataset.span_tension[-1].values, run.dataset.friction_power[-1].values
    expected = tensions_by_hand(run.prepared, float(found[0]))
    np.testing.assert_allclose(found, expected, rtol=2e-3)
    speed = float(run.dataset.belt_speed[-1].mean())
    power = float(run.dataset.shaft_torque[-1, 0] * run.dataset.shaft_speed[-1, 0])
    straight = sum(rubbing(drive, span, hanging=0.5) for span in range(4))
    assert power / speed == pytest.approx(slipping.sum() / speed + straight, rel=1e-3)
    safeties = [one.slip_safety for one in bd.summarize(run).pulleys]
    assert np.isnan(safeties[2:]).all()
    assert safeties[0] > 1.5
    slip = bd.results.key_numbers(run)[0]
    assert (slip.name, slip.where) == ("largest slip", "roller")


@pytest.mark.slow
def test_a_handrail_breaks_away_and_runs_steadily() -> None:
    drive = bd.load(HANDRAIL)
    run = bd.simulate(drive)
    time, tension = run.dataset.time.values, run.dataset.span_tension.values
    steady = bd.steady_state(drive).dataset.span_tension[-1].values
    np.testing.assert_allclose(tension[time > 3.5].mean(axis=0), steady, rtol=5e-3)
    assert float(np.abs(run.dataset.energy_closure).max()) < 2e-4
    assert not any("gross slip" in warning for warning in bd.summarize(run).warnings)


@pytest.mark.slow
def test_the_first_longitudinal_mode_is_that_of_two_rods_and_the_take_up() -> None:
    line, mass, inertia = (1.2, 12.0), 2800.0, 40.0
    drive = conveyor(
        lift=0.0, goods=0.0, friction=0.0, lines=(line, line), damping=0.0, tail={"inertia": inertia, "mass": 800.0}
    )
    found = bd.modes(drive, count=4).dataset
    along = BELT + line[1] / line[0]
    speed = math.sqrt(EA / along)

    def frequency(end: float) -> float:
        """Least root of end w^2 = 2 EA k cot(k L) with k = w / c, Hz."""
        from scipy.optimize import brentq

        def imbalance(phase: float) -> float:
            rate = phase * speed / LENGTH
            return end * rate**2 - 2.0 * EA * phase / LENGTH / math.tan(phase)

        return float(brentq(imbalance, 1e-6, math.pi / 2.0)) * speed / LENGTH / (2.0 * math.pi)

    expected = sorted((frequency(mass), frequency(inertia / RADIUS**2)))
    np.testing.assert_allclose(np.sort(found.frequency.values)[:2], expected, rtol=0.005)
    moving = float(found.tensioner_share.values[np.argmin(np.abs(found.frequency.values - frequency(mass))), 0])
    wave = 2.0 * math.pi * frequency(mass) / speed
    of_belt = along * (LENGTH - math.sin(2.0 * wave * LENGTH) / (2.0 * wave))
    of_arm = mass * math.sin(wave * LENGTH) ** 2
    assert moving == pytest.approx(of_arm / (of_arm + of_belt), rel=0.01)
    over_speed = bd.campbell(drive, speed=[4.0, 8.0], count=2).dataset.frequency
    np.testing.assert_allclose(over_speed[:, :2], [expected, expected], rtol=0.005)


@pytest.mark.slow
def test_a_sheet_has_the_pull_and_the_slack_tension_of_a_start() -> None:
    """To 1 % of what they change by, of a short and stiff conveyor on a slope, that gains speed smoothly."""
    begin, end, rise = 2.0, 8.0, (0.1, 1.5)
    instants = np.linspace(*rise, 81)
    speeds = begin + (end - begin) * 0.5 * (1.0 - np.cos(math.pi * (instants - rise[0]) / (rise[1] - rise[0])))
    pulleys = [
        {
            "name": "head",
            "center": [0.0, 2.0],
            "radius": 0.25,
            "speed": {"kind": "table", "times": [0.0, *instants], "values": [begin, *speeds]},
        },
        {"name": "tail", "center": [20.0, 0.0], "radius": 0.25, "inertia": 2.0},
    ]
    drive = bd.Drive(
        gravity=[0.0, -GRAVITY],
        belt=STRIP | {"axial_stiffness": 2e7, "mass_per_length": 12.0, "installed_tension": 2e4},
        pulley=pulleys,
        tensioner=[{"kind": "fixed", "pulley": "tail", "direction": [1.0, 0.0]}],
        support=[idlers("tail", "head", CARRYING, COEFFICIENT), idlers("head", "tail", CARRYING, COEFFICIENT)],
        goods=[{"span": ["tail", "head"], "mass_per_length": 60.0}],
        contact={"friction": 0.4},
        simulation={"duration": 1.7, "output_interval": 2e-3, "start": "steady"},
    )
    sheet, run = bd.sheet(drive).dataset.isel(row=0), bd.simulate(drive).dataset
    pull = run.shaft_torque.values[:, 0] / (0.5 * float(sheet.pitch_diameter[0]))
    at = int(np.argmin(np.abs(run.time.values - np.mean(rise))))
    found = float(np.mean(pull[at - 75 : at + 76]))  # over a period of the longitudinal vibration, near the steepest
    spread = np.sin(0.15 * math.pi / 1.4) / (0.15 * math.pi / 1.4)
    gained = float(sheet.start_pull - sheet.running_pull)
    assert found - float(sheet.running_pull) == pytest.approx(gained * spread, rel=0.01)


@pytest.mark.slow
@pytest.mark.parametrize("ends", [(0.0, 0.2), (0.2, 0.0)], ids=["start", "stop"])
def test_the_wave_of_a_start_or_stop_arrives_at_the_tail_after_the_length_over_its_speed(
    ends: tuple[float, float], curve: Callable[..., None], measured: Callable[..., None]
) -> None:
    """A tail drum almost without inertia changes its speed twice as much, as the free end of a rod."""
    line, rise = (1.2, 12.0), 0.1
    instants = np.linspace(0.1, 0.1 + rise, 41)
    ramp = ends[0] + (ends[1] - ends[0]) * 0.5 * (1.0 - np.cos(math.pi * (instants - 0.1) / rise))
    drive = conveyor(
        lift=0.0,
        goods=0.0,
        friction=0.0,
        lines=(line, line),
        speed={"kind": "table", "times": instants.tolist(), "values": ramp.tolist()},
        damping=0.0,
        tail={"inertia": 0.1, "mass": 1.0},
        slide=1e5,
        simulation={
            "duration": 1.0,
            "output_interval": 1e-3,
            "max_step": 2e-3,
            "start": "steady" if ends[0] else "equilibrium",
        },
    )
    run = bd.simulate(drive)
    time, (driving, turning) = run.dataset.time.values, run.dataset.pulley_speed.values.T
    first, plateau = turning[0], float(turning[(time > 0.95)].mean())
    risen = (turning - first) / (plateau - first)
    arrival = float(np.interp(0.5, risen[time < 0.9], time[time < 0.9]))
    wave = math.sqrt(EA / (BELT + line[1] / line[0]))
    panel = "conveyor/" + ("stop" if ends[0] else "start")
    curve(panel, time, RADIUS * driving, "head", "-")
    curve(panel, time, RADIUS * turning, "tail", "-")
    later = np.interp(time - LENGTH / wave, time, driving)
    curve(panel, time, RADIUS * (2.0 * later - driving[0]), "twice the change, L/c later", "k--")
    measured(arrival=arrival - (0.1 + 0.5 * rise), by_hand=LENGTH / wave)
    assert arrival - (0.1 + 0.5 * rise) == pytest.approx(LENGTH / wave, rel=0.005)


@pytest.mark.slow
def test_a_batch_moves_in_with_the_belt(monkeypatch: pytest.MonkeyPatch) -> None:
    """20 m of goods whose front gets on after 10 m of belt; by hand resistance and lift of what is on the belt."""
    length, lift, mass = 100.0, 5.0, 104.0
    monkeypatch.setattr(f"{__name__}.LENGTH", length)
    settings = {"duration": 10.0, "start": "steady", "output_interval": 0.02}
    drive = conveyor(lift=lift, goods=0.0, simulation=settings)
    drive = drive.replace(goods=[{"span": ["tail", "head"], "mass_per_length": mass, "batch": [-30.0, -10.0]}])
    run = bd.simulate(drive).dataset
    pull, time = run.shaft_torque.values[:, 0] / RADIUS, run.time.values
    on = np.clip(float(run.belt_speed.mean()) * time - 10.0, 0.0, 20.0)
    slope = math.hypot(length, lift)
    hand = main_resistance(lift, 0.0) + mass * on * GRAVITY * (COEFFICIENT * length + lift) / slope
    for begin in range(0, len(time) - 50, 50):
        part = slice(begin, begin + 50)
        assert pull[part].mean() == pytest.approx(hand[part].mean(), rel=5e-3)
    assert float(np.abs(run.energy_closure).max()) < 1e-5


@pytest.mark.slow
def test_energy_is_accounted_for_while_goods_are_loaded_on_a_slope() -> None:
    """In steps that the tolerance sets: at the default one rounding decides on them, and one alone errs by 5e-4."""
    ramp = {"kind": "cosine_ramp", "start": 0.2, "end": 1.2, "value": 5.0}
    drive = bd.Drive(
        gravity=[0.0, -GRAVITY],
        belt={"profile": "flat-polyester-fabric", "width": "400 mm", "length": "17.3 m"},
        pulley=[
            {"name": "head", "center": [0.0, 1.0], "radius": 0.2, "speed": ramp},
            {"name": "tail", "center": [8.0, 0.0], "radius": 0.2, "inertia": 0.15, "mass": 20.0},
        ],
        tensioner=[
            {
                "kind": "sliding",
                "pulley": "tail",
                "direction": [1.0, 0.0],
                "preload": 2500.0,
                "damping": 2e3,
                "mass": 10.0,
            }
        ],
        support=[idlers("tail", "head", (0.5, 1.0), 0.03), idlers("head", "tail", (2.0, 1.0), 0.03)],
        goods=[
            {
                "span": ["tail", "head"],
                "mass_per_length": 30.0,
                "schedule": {"kind": "cosine_ramp", "start": 1.3, "end": 1.8, "value": 1.0},
            }
        ],
        contact={"friction": 0.4},
        simulation={"duration": 2.5, "rtol": 5e-6},
    )
    run = bd.simulate(drive)
    assert float(np.abs(run.dataset.energy_closure).max()) < 2e-4
    assert float(run.dataset.carrying_loss[-1]) > 0.5 * float(run.dataset.driver_work[-1])
