"""Sheets of conveyors and web lines, against resistances, draws, and Euler's formula by hand."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.designs.line_sheet import RESISTANCES
from beltdyn.errors import ModelError
from beltdyn.model import Drive, example, install
from beltdyn.model.installation import DEFLECTION, tension_checks
from beltdyn.show.rest_sheet import tensioning
from beltdyn.show.sheet import sheet
from beltdyn.show.tables import as_text
from beltdyn.show.verdict import verdict

TASKS = Path(__file__).parents[3] / "docs" / "tasks"


GRAVITY, BELT, GOODS, FRICTION, FACTOR, RADIUS = 9.81, 3.0, 12.0, 0.03, 1.2, np.array([0.15, 0.12])
HEAD: dict[str, Any] = {"name": "head", "center": [0.0, 1.0], "radius": RADIUS[0], "inertia": 0.5}
MOTOR = {"kind": "motor", "breakdown_torque": 150.0, "breakdown_slip": 0.2}


def conveyor(mirrored: bool, *, weight: float = 3000.0, head: dict[str, Any] | None = None) -> Drive:
    """A conveyor of 8 m that lifts goods by 1 m; mirrored it runs against the order of its pulleys."""
    sense, (upper, lower) = (-1.0 if mirrored else 1.0), (["tail", "head"], ["head", "tail"])[:: -1 if mirrored else 1]
    idlers = {"kind": "idlers", "friction": FRICTION, "secondary_factor": FACTOR, "resistance": 2.0, "linear": 5.0}
    stiffness = {"axial_stiffness": 4e5, "bending_stiffness": 0.1, "mass_per_length": BELT}
    held = {"pulley": "tail", "direction": [sense, 0.0]}
    return Drive(
        gravity=[0.0, -GRAVITY],
        belt={"width": 0.3, "thickness": 0.005, "installed_tension": None if weight else 1500.0} | stiffness,
        pulley=[
            HEAD | (head or {"speed": 4.0 * sense}),
            {"name": "tail", "center": [8.0 * sense, 0.0], "radius": RADIUS[1], "inertia": 0.3, "mass": 20.0},
        ],
        tensioner=[held | ({"kind": "sliding", "mass": 200.0, "preload": weight} if weight else {"kind": "fixed"})],
        support=[
            idlers | {"span": upper, "spacing": 1.0, "idler_mass": 5.0},
            idlers | {"span": lower, "spacing": 2.0, "idler_mass": 6.0},
        ],
        goods=[{"span": upper, "mass_per_length": GOODS}],
        contact={"friction": 0.35},
        simulation={"duration": 1.0},
        steady={"force_tolerance": 0.5},
    )


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("weight", [3000.0, 0.0])
def test_strands_and_starts_of_a_conveyor_balance(mirrored: bool, weight: float) -> None:
    """Resistances by hand, those against the pull to 1 %, and the masses that a start moves."""
    result = bd.sheet(conveyor(mirrored, weight=weight), acceleration="4 rad/s^2")
    found, names = result.dataset.isel(row=0), ["head-tail", "tail-head"]
    upper, lower = (found.sel(span=name) for name in (names if mirrored else names[::-1]))
    length, speed = float(upper.span_length), 4.0 * RADIUS[0]
    across, rising = GRAVITY * np.sqrt(1.0 - (1.0 / length) ** 2), GRAVITY * float(upper.goods_resistance)
    for one, goods, rotating in ((upper, GOODS, 5.0), (lower, 0.0, 3.0)):
        by_weight = FRICTION * length * (GRAVITY * rotating + across * (BELT + goods))
        np.testing.assert_allclose(one.main_resistance, by_weight + length * (2.0 + 5.0 * speed), rtol=2e-3)
        np.testing.assert_allclose(one.secondary_resistance, (FACTOR - 1.0) * by_weight, rtol=2e-3)
    assert rising > 0.0
    assert float(upper.slope_resistance / upper.goods_resistance) == pytest.approx(BELT / GOODS, rel=1e-9)
    np.testing.assert_allclose(found.span_strain, found.span_tension / 4e5, rtol=1e-6)
    speeds = (1.0 + found.span_strain) / (1.0 + float(lower.span_strain))  # the same belt passes everywhere
    np.testing.assert_allclose(found.draw, speeds - 1.0, atol=1e-6)
    total = found[list(RESISTANCES)].to_dataarray().sum("variable")
    pull = float((found.tension_before - found.tension_after).sel(pulley="head"))
    np.testing.assert_allclose(found.span_pull, total, atol=0.01 * pull)
    around_tail = BELT * GRAVITY * 2.0 * RADIUS[1]  # which the belt rises there, too
    assert pull == pytest.approx(float(total.sum()) + around_tail, rel=3e-3)
    assert float(found.running_pull) == pytest.approx(float(total.sum()), rel=1e-2)  # without the weight on arcs
    lift = float((found.slope_resistance + found.goods_resistance).sum())
    assert float(found.holdback_torque) == pytest.approx(lift * RADIUS[0], rel=1e-3)

    acceleration, tail = 4.0 * RADIUS[0], 0.3 / RADIUS[1] ** 2
    moved = BELT * float(found.belt_length) + length * (GOODS + 5.0 + 3.0) + tail
    assert float(found.moved_mass) == pytest.approx(moved, rel=1e-3)
    assert float(found.acceleration) == pytest.approx(acceleration, rel=1e-3)
    assert float(found.start_pull - found.running_pull) == pytest.approx(moved * acceleration, rel=2e-3)
    ahead = found.start_slack_tension - found.tension_after
    if weight:  # on the tail drum, where half of its own inertia counts to either strand
        behind = BELT * 0.5 * float(found.belt_length) + 3.0 * length + 0.5 * tail
        assert float(ahead.sel(pulley="head")) == pytest.approx(-behind * acceleration, rel=0.02)
    longer = float(found.start_stretch - found.running_stretch)
    if weight:  # both strands by the mean of what their masses add, about the tail drum, within what arcs add
        assert longer == pytest.approx(0.5 * acceleration * length**2 * (GOODS + 5.0 - 3.0) / 4e5, rel=0.05)
    else:
        assert abs(longer) < 1e-3 * float(found.running_stretch)
    wrap, driven = float(found.wrap_angle.sel(pulley="head")), found.sel(pulley="head")
    grip = np.expm1(np.array([0.7, 1.0, 1.3]) * 0.35 * wrap)
    np.testing.assert_allclose(driven.least_slack_tension, pull / grip + BELT * speed**2, rtol=1e-4)
    assert float(driven.least_start_slack_tension) == pytest.approx(float(found.start_pull) / grip[1], rel=1e-6)


def test_a_mirrored_conveyor_has_the_same_sheet() -> None:
    """It runs against the order of its pulleys; a motor starts it by what it has beyond the pull."""
    head = {"load": [MOTOR | {"synchronous_speed": 5.0}]}, {"load": [MOTOR | {"synchronous_speed": -5.0}]}
    one, other = (bd.sheet(conveyor(mirrored, head=head[mirrored])).dataset.isel(row=0) for mirrored in (False, True))
    assert (float(one.running_sense), float(other.running_sense)) == (1.0, -1.0)
    for name, values in one.data_vars.items():
        if name in ("running_sense", "hub_direction", "pulley_speed", "shaft_torque", "center") or not values.size:
            continue
        same = other[name].values[::-1] if "span" in values.dims else other[name].values
        np.testing.assert_allclose(values, same, rtol=3e-3, atol=1e-6, err_msg=str(name))
    np.testing.assert_allclose(one.shaft_torque, -other.shaft_torque, rtol=1e-3, atol=1e-3)
    radius = RADIUS[0]
    gain = (150.0 / radius - float(one.running_pull)) / (float(one.moved_mass) + 0.5 / radius**2)
    assert float(one.acceleration) == pytest.approx(gain, rel=2e-3)


@pytest.mark.parametrize("mirrored", [False, True])
def test_lifting_is_useful_and_starts_coasting_and_stops_follow_from_force_and_mass(mirrored: bool) -> None:
    """By hand: m' g h v of the goods, F / m of all that moves, v / a and v^2 / 2a, and the load of a meter of belt."""
    drive = conveyor(mirrored)
    tail = drive.pulleys[1].replace(load=[{"kind": "brake", "torque": {"kind": "step", "time": 5.0, "value": 36.0}}])
    supports = [one.replace(idler_diameter="80 mm") for one in drive.supports]
    dataset = bd.sheet(drive.replace(support=supports), acceleration="4 rad/s^2").dataset
    found = dataset.isel(row=0)
    speed, upper = 4.0 * RADIUS[0], int(np.argmax(found.goods_mass.values))
    rising = 1.0 + RADIUS[0] - RADIUS[1]  # from the top of one drum to that of the other
    assert float(found.lifting_power) == pytest.approx(GOODS * GRAVITY * rising * speed, rel=0.01)
    assert float(found.power_in) == pytest.approx(float(found.power_out + found.loss), rel=1e-3)
    assert float(found.power_out) == pytest.approx(float(found.lifting_power), rel=1e-9)
    assert 0.0 < float(found.loss) < float(found.power_in - 0.99 * found.lifting_power)

    mass = float(found.moved_mass) + 0.5 / RADIUS[0] ** 2
    start, coasting, stop = (found.sel(motion=name) for name in ("start", "coasting", "emergency stop"))
    assert float(start.motion_time) == pytest.approx(1.0, rel=2e-3)
    slowing = float(found.running_pull) / mass
    assert float(coasting.motion_rate) == pytest.approx(slowing, rel=2e-3)
    assert float(coasting.motion_travel) == pytest.approx(0.5 * speed**2 / slowing, rel=5e-3)
    assert float(coasting.motion_goods) == pytest.approx(GOODS * float(coasting.motion_travel), rel=1e-6)
    assert np.isnan(float(stop.motion_rate))  # without a brake
    braked = bd.sheet(drive.replace(pulley=[drive.pulleys[0], tail])).dataset.isel(row=0).sel(motion="emergency stop")
    assert float(braked.motion_brakes) == pytest.approx(36.0 / RADIUS[1], rel=1e-2)
    force = float(braked.running_pull + braked.motion_brakes)
    assert float(braked.motion_rate) == pytest.approx(force / mass, rel=2e-3)

    carrying, returning = 0, 1
    down = GRAVITY * np.sqrt(1.0 - (rising / float(found.span_length[upper])) ** 2)
    assert float(found.idler_load[carrying]) == pytest.approx(((BELT + GOODS) * 1.0 + 5.0) * down, rel=2e-3)
    assert float(found.idler_load[returning]) == pytest.approx((BELT * 2.0 + 6.0) * down, rel=2e-3)
    np.testing.assert_allclose(found.idler_speed, speed / 0.04, rtol=5e-3)
    assert float(found.idler_count[carrying]) == pytest.approx(float(found.span_length[upper]))


def test_a_take_up_travels_for_starts_wear_and_heat() -> None:
    """Half of stretch and elongation at a tail drum with two strands along its travel."""
    drive = conveyor(False)
    dataset = bd.sheet(drive, acceleration="4 rad/s^2", wear="0.5 %").dataset
    longer = 0.005 * float(dataset.belt_length)
    assert float(dataset.permanent_elongation) == pytest.approx(longer, rel=1e-6)
    stretch = float(dataset.start_stretch[0])
    assert float(dataset.take_up_travel) == pytest.approx((stretch + longer) / float(dataset.take_up_ratio), rel=1e-6)
    assert float(dataset.take_up_ratio) == pytest.approx(2.0, rel=0.01)
    assert "take_up_travel" not in bd.sheet(drive).dataset
    with pytest.raises(ModelError, match="wear"):
        bd.sheet(drive, wear="-1 %")


def of_class(profile: str, **changes: Any) -> Drive:
    """The conveyor with a belt by its class, 300 mm wide."""
    drive = conveyor(False)
    return drive.replace(belt={"profile": profile, "width": 0.3}, **changes)


def test_a_belt_by_its_class_is_judged_in_running_starts_and_stops() -> None:
    """Strength times width over tension; limits where there are any, or else what makers of the class use."""
    drive = of_class("EP 200/2")
    result = bd.sheet(drive, acceleration="4 rad/s^2")
    found = result.dataset.isel(row=0)
    assert float(found.belt_safety) == pytest.approx(60e3 / float(found.largest_span_tension.max()), rel=1e-9)
    np.testing.assert_allclose(found.motion_belt_safety, 60e3 / found.motion_largest_tension, rtol=1e-9)
    assert (float(found.needed_belt_safety), float(found.needed_motion_safety)) == pytest.approx((10.0, 10.0 / 1.5))
    numbers = {one.key: one for one in bd.results.key_numbers(result)}
    assert numbers["least_belt_safety"].value == pytest.approx(float(found.belt_safety))
    assert numbers["least_motion_safety"].value == pytest.approx(float(np.nanmin(found.motion_belt_safety)))
    assert not any("safety factor of the belt" in text for text in result.warnings)
    text = as_text(sheet(result))
    assert "Safety factors of the belt" in text
    assert "met" in text
    assert "EP 200/2, 300 mm wide" in text

    limits = {"least_belt_safety": 1.02 * float(found.belt_safety), "least_motion_safety": 5.0}
    strict = drive.replace(limits=limits)
    again = bd.sheet(strict, acceleration="4 rad/s^2")
    assert any("in steady running at operating point 1" in text for text in again.warnings)
    assert verdict([again])[0] == "fail"
    assert "too low" in as_text(sheet(again))
    steady = bd.steady_state(strict)
    assert "least motion safety is not judged here" in verdict([steady])[1]
    (running,) = (one for one in bd.results.key_numbers(steady) if one.key == "least_belt_safety")
    assert running.value == pytest.approx(float(found.belt_safety), rel=1e-3)
    rest = bd.equilibrium(strict)
    assert "Least belt safety is not judged here" in verdict([rest])[1]


def test_drums_that_are_too_small_for_the_class_are_named() -> None:
    """ST 1000 needs 630 mm at the driver of a fully used belt, two steps less where it carries little."""
    result = bd.sheet(of_class("ST 1000"))
    np.testing.assert_allclose(result.dataset.smallest_diameter[0], 0.4)
    texts = [text for text in result.warnings if "the belt needs 400 mm" in text]
    assert [text.split()[3] for text in texts] == ["head", "tail"]
    assert "at least mm" in as_text(sheet(result))
    assert not any("the belt needs" in text for text in bd.sheet(of_class("EP 200/2")).warnings)


@pytest.mark.parametrize("given", [{"travel": "20 mm"}, {"stops": [-0.01, 0.01], "stop_stiffness": 1e6}])
def test_the_travel_of_a_take_up_is_set_against_its_room(given: dict[str, Any]) -> None:
    """Permanent and thermal elongation of the class, or what is stated; --wear in place of both."""
    drive = of_class("ST 500")
    held = drive.tensioners[0].replace(**given)
    belt = {"temperature_range": [-20.0, 60.0], "permanent_elongation": 0.002}
    result = bd.sheet(drive.replace(tensioner=[held]).with_({f"belt.{key}": value for key, value in belt.items()}))
    found = result.dataset
    length = float(found.belt_length)
    assert float(found.permanent_elongation) == pytest.approx(0.002 * length)
    assert float(found.thermal_elongation) == pytest.approx(80.0 * 11.7e-6 * length)
    parts = float(found.largest_stretch + found.permanent_elongation + found.thermal_elongation)
    assert float(found.take_up_travel) == pytest.approx(parts / float(found.take_up_ratio))
    assert float(found.take_up_room) == pytest.approx(0.02)
    short = [text for text in result.warnings if "the take-up needs a travel" in text]
    assert bool(short) == (float(found.take_up_travel) > 0.02)
    assert short
    text = as_text(sheet(result))
    assert "permanent 0.002 of the length;" in text
    assert "by heat 1.17e-05 1/K (of the class), from -20 to 60 °C" in text
    worn = bd.sheet(drive, wear="0.1 %")
    assert float(worn.dataset.thermal_elongation) == 0.0
    assert float(worn.dataset.permanent_elongation) == pytest.approx(0.001 * float(worn.dataset.belt_length))
    assert "not stated" in as_text(sheet(worn))


def test_the_tension_of_carried_strands_is_checked_between_idlers() -> None:
    """A span of a kilometer does not deflect by 16 m."""
    drive = example("conveyor_1km")
    checks = tension_checks(drive, install(drive))
    string = 4.0 * install(drive).span_tensions * DEFLECTION
    assert (checks[0].forces > string).all()  # bending stiffness adds to a string
    np.testing.assert_allclose(checks[0].forces, string, rtol=0.2)
    table = tensioning(drive)
    assert table is None or {row[2] for row in table.table.rows} == {"48.0", "19.2"}


def test_conveyors_are_warned_of_slip_and_sag() -> None:
    """Neither with twice the weight; a motor that has nothing beyond its pull starts nothing."""
    loose, tight = (bd.sheet(conveyor(False, weight=weight), acceleration="40 rad/s^2") for weight in (800.0, 30000.0))
    for words in ("head slips in starts at operating point 1", "of the idler spacing in the span tail-head"):
        assert any(words in text for text in loose.warnings)
        assert not any(words in text for text in tight.warnings)
    needed, slack = (loose.dataset[name][0, 0] for name in ("least_start_slack_tension", "start_slack_tension"))
    assert float(slack) < float(needed)
    sag = loose.dataset.sag[0] * loose.dataset.least_span_tension[0]
    np.testing.assert_allclose(sag, 0.01 * loose.dataset.least_tension_for_sag[0], rtol=1e-9)


@pytest.mark.slow
def test_a_conveyor_has_the_pull_of_din_22101() -> None:
    """To 1 %: the sum of resistances against the pull of the head drum and the rise of tension of each span."""
    drive = example("conveyor_1km").replace(
        duty=[{"name": "full", "share": 0.9}, {"name": "empty", "share": 0.1, "load": 0.0}]
    )
    result = bd.sheet(drive)
    found = result.dataset
    # f C L g (m_R + m cos δ) and H g m of the upper strand, 1000.11 m long with a slope of 15 in 1000
    upper, lower = found.sel(span="tail-head"), found.sel(span="head-tail")
    rotating, carried = np.array([22.0 / 1.2, 22.0 / 1.2]), 25.0 + np.array([104.0, 0.0])
    friction = 1.09 * 0.02 * 9.81 * (1000.11 * rotating + 1000.0 * carried)
    np.testing.assert_allclose(upper.main_resistance + upper.secondary_resistance, friction, rtol=2e-3)
    np.testing.assert_allclose(upper.goods_resistance, [15.0 * 9.81 * 104.0, 0.0], rtol=0.02)  # rims add to the height
    parts = ("main_resistance", "secondary_resistance", "slope_resistance", "goods_resistance")
    total = found[list(parts)].to_dataarray().sum("variable")
    for one in (upper, lower):
        np.testing.assert_allclose(one.span_pull, total.sel(span=str(one.span.values)), rtol=0.01)
    pull = found.shaft_torque.sel(pulley="head") / 0.5
    np.testing.assert_allclose(pull, total.sum("span"), rtol=0.01)
    head = found.sel(pulley="head", row="full")
    wrap, least = float(head.wrap_angle), head.least_slack_tension.values
    expected = float(head.tension_before - head.tension_after) / np.expm1(np.array([0.7, 1.0, 1.3]) * 0.35 * wrap)
    np.testing.assert_allclose(least, expected + 25.0 * 3.998**2, rtol=1e-3)
    np.testing.assert_allclose(upper.sag[0] * upper.least_span_tension[0] * 8.0, 129.0 * 9.81 * 1.2, rtol=1e-3)
    # the start: belt, goods, idlers and tail drum at 0.1571 m/s^2; the tail drum takes half of the stretch up
    mass = 25.0 * 2001.4 + 1000.11 * (104.0 * np.array([1.0, 0.0]) + 22.0 / 1.2 + 18.0 / 3.0) + 60.0 / 0.4**2
    np.testing.assert_allclose(found.moved_mass, mass, rtol=2e-3)
    np.testing.assert_allclose(found.start_pull - found.running_pull, mass * 4.0 * np.pi / 80.0, rtol=3e-3)
    assert float(found.holdback_torque[0]) == pytest.approx(15.0 * 9.81 * 104.0 * 0.5, rel=0.02)
    behind = 1000.11 * (25.0 + 18.0 / 3.0) + 0.5 * 60.0 / 0.4**2
    more = found.start_slack_tension.sel(pulley="head") - found.tension_after.sel(pulley="head")
    np.testing.assert_allclose(more, -behind * 4.0 * np.pi / 80.0, rtol=0.01)
    travel = found.running_stretch / found.take_up_ratio
    assert float(travel[0] - travel[1]) == pytest.approx(
        float(found.tensioner_position[0, 0] - found.tensioner_position[1, 0]), rel=0.01
    )
    numbers = {one.key: one for one in bd.results.key_numbers(result)}
    assert numbers["largest_tension"].value == pytest.approx(float(head.tension_before), rel=1e-3)
    text = as_text(sheet(result))
    assert "Resistances of spans, operating point empty" in text
    assert "none" in text
    with pytest.raises(ModelError, match="no curves over speed"):
        bd.plot.sheet_tensions(result)
    assert bd.plot.line_tensions(result).get_legend_handles_labels()[1] == ["full", "empty"]


@pytest.mark.slow
def test_a_motor_starts_a_conveyor_by_its_breakdown_torque() -> None:
    """At fixed drums the belt keeps its stretch, and both strands share what the start adds."""
    found = bd.sheet(example("package_conveyor")).dataset.isel(row=0)
    radius, rotor = 0.5 * float(found.pitch_diameter[0]), 2.6
    moved = float(found.moved_mass)
    pull = float(found.running_pull)
    gain = (150.0 / radius - pull) / (moved + rotor / radius**2)
    assert float(found.acceleration) == pytest.approx(gain, rel=2e-3)
    assert float(found.start_pull) == pytest.approx(pull + moved * gain, rel=2e-3)
    assert float(found.holdback_torque) == 0.0
    assert float(found.start_stretch) == pytest.approx(float(found.running_stretch), rel=1e-3)
    assert float(found.stretch_at_rest) == pytest.approx(float(found.running_stretch), rel=1e-2)
    given = bd.sheet(example("package_conveyor"), acceleration="500 rad/s^2")
    assert any("drive slips in starts at operating point 1" in one for one in given.warnings)
    assert float(given.dataset.acceleration[0]) == pytest.approx(500.0 * radius, rel=1e-3)


@pytest.mark.slow
def test_a_web_line_has_the_strains_of_its_draws() -> None:
    """To 0.1 %: the draw of 0.02 % adds EA times it, and rolls turn with the moments of their tensions."""
    found = bd.sheet(bd.load(TASKS / "coater.toml"))
    dataset, stiffness = found.dataset, 4.5e9 * 1.2 * 50e-6
    spans = dataset.sel(row="1", span=["dancer-infeed", "infeed-coater"])
    assert float(spans.span_strain[1] - spans.span_strain[0]) == pytest.approx(2e-4, rel=2e-3)
    np.testing.assert_allclose(spans.span_tension, stiffness * spans.span_strain, rtol=1e-3)
    np.testing.assert_allclose(dataset.roll_torque[0], [120.0 * 0.4, 100.0 * 0.076], rtol=1e-6)
    titles = [part.title for part in sheet(found).parts]
    assert titles[:4] == ["Parts", "Pulleys as supplied", "", "Operating points"]
    assert titles[4:] == ["Pulleys", "Grip", "Spans", "Tensioners", "Rolls"]
    assert any("coater slips at operating point 1 with 0.7 times the friction" in one for one in found.warnings)


@pytest.mark.slow
def test_a_nip_is_on_the_sheet() -> None:
    found = bd.sheet(bd.load(TASKS / "press_roller.toml")).dataset
    assert found.nip.values.tolist() == ["press"]
    assert float(found.nip_force[0, 0]) > 0.0


def test_options_of_closed_belts_are_refused() -> None:
    refused: tuple[tuple[dict[str, Any], str], ...] = (
        ({"speed": "1..2 rad/s"}, "speed = 1..2 rad/s is an option for belts between pulleys alone"),
        ({"full": True}, "full = True is an option"),
    )
    for options, said in refused:
        with pytest.raises(ModelError, match=said):
            bd.sheet(example("package_conveyor"), **options)
    with pytest.raises(ModelError, match="acceleration = 2 is an option"):
        bd.sheet(bd.load(TASKS / "coater.toml"), acceleration=2)
