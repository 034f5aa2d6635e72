"""The search for steady running."""

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import FloatArray
from beltdyn.errors import ConvergenceError, ModelError
from beltdyn.model import Drive, prepare
from beltdyn.solvers.continuation import Solution
from beltdyn.state import search as search_module
from beltdyn.state.search import SteadySearch
from beltdyn.state.slip_limit import Setting
from beltdyn.state.staying import _lying, stand
from beltdyn.state.steady import steady_beside, steady_state
from beltdyn.state.way import Way
from beltdyn.system.build import loses_in_bending, staying_system
from beltdyn.system.web import content, set_content


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


def unsolved(drive: Drive, elements: int = 12) -> SteadySearch:
    """A search that has not begun: the belt lies in its pulleys, and nothing turns."""
    prepared = prepare(drive)
    system = staying_system(prepared, prepared.equal_lengths(elements))
    return SteadySearch(prepared, system, _lying(prepared, system, 1.0), drive.simulation.end)


def two(torque: float = -8.0, **settings: Any) -> Drive:
    """Two equal pulleys that transmit about 12 N m."""
    driver = {"name": "motor", "center": (0.0, 0.0), "radius": 0.05, "speed": 100.0}
    driven = {"name": "driven", "center": (0.3, 0.0), "radius": 0.05, "inertia": 0.01, "torque": torque}
    belt = {"profile": "PK", "ribs": 4, "installed_tension": 200.0}
    drive = Drive(belt=belt, pulley=[driver, driven], simulation={"duration": 1.0, "output_interval": 1e-2})
    return drive.with_(settings)


@pytest.fixture
def loaded() -> SteadySearch:
    """Two pulleys in steady running."""
    return solved(two())


def solved(drive: Drive, elements: int = 30) -> SteadySearch:
    rest = stand(prepare(drive), elements)
    result = SteadySearch(rest.prepared, rest.system, rest.state, drive.simulation.end)
    result.run(rest)
    return result


def torque_of(search: SteadySearch, pulley: int) -> float:
    """Of the belt on a pulley, N m."""
    return float(search.work.equations.forces.shaft[pulley])


def test_a_setting_that_is_there_is_reached_without_a_search(loaded: SteadySearch) -> None:
    before, iterations = loaded.unknowns(), loaded.iterations
    assert loaded._reach(loaded.setting)
    assert loaded._reaches(loaded.setting)
    assert loaded.iterations == iterations
    np.testing.assert_array_equal(loaded.unknowns(), before)


def test_settings_are_reached_up_to_what_the_belt_transmits(loaded: SteadySearch) -> None:
    """12 N m; where the way ends the search stays at the last solution."""
    lighter, heavier = loaded.setting._replace(load=0.5), loaded.setting._replace(load=9.0)
    assert loaded._reaches(lighter)
    assert loaded.setting == lighter
    assert torque_of(loaded, 1) == pytest.approx(-4.0, rel=1e-6)
    assert not loaded._reaches(heavier)
    assert not loaded._reach(heavier)
    assert 10.0 < -torque_of(loaded, 1) < 30.0
    assert loaded.setting.load == pytest.approx(-torque_of(loaded, 1) / 8.0, rel=0.01)


def test_what_is_sought_begins_with_its_guess(loaded: SteadySearch) -> None:
    """That of the solution itself is confirmed in one iteration, and from elsewhere the search takes more."""
    start, setting = loaded.unknowns(), loaded.setting
    lighter = setting._replace(load=0.2)
    result = loaded.solve(lighter, start, 1.0)
    assert result is not None
    taken = list[int]()
    for guess in (result, start):
        loaded.place(start)
        before = loaded.iterations
        assert loaded.solve(lighter, guess, 1.0) is not None
        taken.append(loaded.iterations - before)
    assert taken[0] == 1 < taken[1]


def test_a_search_that_fails_is_as_it_was(loaded: SteadySearch, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also before clutches are let slip, and behind."""
    before, seen = loaded.unknowns(), list[Any]()

    def lost(*_: object) -> bool:
        loaded.state.position[:] *= 1.5
        loaded.state.velocity[:] *= 0.5
        loaded.constant.frame.speed[0] += 1.0
        return False

    def slips(*_: object) -> bool:
        seen.append(loaded.unknowns())
        return True

    monkeypatch.setattr(loaded, "_converges", lost)
    monkeypatch.setattr(loaded, "_lets_slip", slips)
    loaded._has_clutches = True
    assert not loaded._try(loaded.setting._replace(load=0.5))
    assert loaded.solve(loaded.setting._replace(load=0.5), 2.0 * before, 1.0) is None
    np.testing.assert_array_equal(seen, [before, 2.0 * before])
    np.testing.assert_array_equal(loaded.unknowns(), before)
    assert loaded.setting == Setting()


@pytest.mark.parametrize(("change", "result"), [(0.02, True), (0.2, False)])
def test_behind_a_clutch_that_slips_the_belt_keeps_its_speed(
    loaded: SteadySearch, change: float, result: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A solution with another speed is one of another branch."""
    tried = iter([False, True])

    def converges(*_: object) -> bool:
        loaded.constant.frame.speed[0] *= 1.0 + change
        return next(tried)

    monkeypatch.setattr(loaded, "_converges", converges)
    monkeypatch.setattr(loaded, "_lets_slip", lambda _: True)
    loaded._has_clutches = True
    assert loaded._try(Setting()) is result


@pytest.mark.parametrize("first", range(3))
def test_a_belt_begins_to_run_in_other_ways_where_one_fails(first: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """Without loads, with a twentieth of them, with smoother friction: each at full speed, smoother, and slowly."""
    search, begun = unsolved(two()), list[Setting]()
    ways = [Setting(load=0.0), Setting(load=0.05), Setting(load=0.0, smoothing=30.0)]

    def start(place: object, speed: float, setting: Setting) -> bool:
        assert speed == 5.0
        begun.append(setting)
        return len(begun) > 3 * first

    monkeypatch.setattr(search, "_start", start)
    reached = list[Setting]()

    def reach(target: Setting) -> bool:
        reached.append(target)
        return True

    monkeypatch.setattr(search, "_reach", reach)
    assert search._run_up(search.state.position, 5.0, 7.0)
    expected = [
        setting
        for way in ways
        for setting in (way, way._replace(smoothing=7.0), way._replace(smoothing=7.0, speed=0.01))
    ]
    assert begun == expected[: 3 * first + 1]
    assert reached == [ways[first], ways[first]._replace(load=1.0), Setting()]


def test_the_curve_is_followed_from_the_last_solution_without_gross_slip(
    loaded: SteadySearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And then from the last one of all, and from one before; where all lead nowhere the search stays as it was."""
    way = Way(loaded, loaded.setting._replace(load=0.0), loaded.setting)
    begin, placed = loaded.unknowns(), list[Any]()
    way.solutions = [Solution(place, (1.0 - 1e-3 * place) * begin) for place in (0.0, 0.2, 0.4, 0.6)]

    def followed(way: Way, place: float, allowed: float, is_lost: Any) -> list[Solution]:
        assert allowed == pytest.approx(1e-6 * float(loaded.prepared.radii.min()))
        placed.append((place, way.unknowns(), is_lost()))
        return [Solution(place, way.unknowns())]

    monkeypatch.setattr(search_module, "turn", followed)
    slips = np.array([[0.0, 0.0], [0.0, 0.001], [0.0, 0.02], [0.0, 0.3]])
    monkeypatch.setattr(search_module, "gross_slips", lambda passed: slips[: len(passed)] if len(passed) > 2 else slips)
    assert not loaded._turn(way)
    assert [place for place, *_ in placed] == [0.2, 0.6, 0.0]
    for (_, unknowns, _), solution in zip(placed, (way.solutions[number] for number in (1, 3, 0)), strict=True):
        np.testing.assert_allclose(unknowns, solution.unknowns, rtol=1e-12)
    assert [lost for *_, lost in placed] == [True, False, True]
    np.testing.assert_allclose(loaded.unknowns(), begin)
    assert len(loaded._passed) == 2


@pytest.mark.parametrize(
    ("torque", "change", "tangent"), [(-8.0, "load", True), (-8.0, "smoothing", False), (-5.0, "load", False)]
)
def test_tangents_serve_where_loads_grow(
    torque: float, change: str, tangent: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Not where friction is smoothed, by factors, nor on teeth, which meet their flanks."""
    search, served = unsolved(toothed() if torque == -5.0 else two()), list[bool]()

    def follow(solve: Any, *solutions: Solution, tangent: Any) -> list[Solution]:
        served.append(tangent is not None)
        return list(solutions)

    monkeypatch.setattr(search_module, "follow", follow)
    search.setting = Setting(load=0.5)
    assert search._reach(search.setting._replace(**{change: 0.7}))
    assert served == [tangent]


@pytest.mark.parametrize(
    ("rims", "used", "slip", "stalls"),
    [
        ([100.0, 10.0], [0.2, 0.95], 0.9, True),
        ([100.0, -10.0], [0.2, 0.95], 0.9, True),
        ([100.0, 10.0], [0.95, 0.5], 0.9, False),
        ([100.0, 60.0], [0.2, 0.95], 0.9, False),
        ([100.0, 10.0], [0.2, 0.95], 0.4, False),
    ],
    ids=["stalled", "turns back", "friction left", "turns", "had slipped before"],
)
def test_a_pulley_stalls_with_all_of_its_friction(
    rims: list[float], used: list[float], slip: float, stalls: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    search = unsolved(two())
    search.state.velocity[search.system.first_body :][:2] = rims
    search._uniform = np.array([100.0, 100.0])
    monkeypatch.setattr(search, "_here", lambda: SimpleNamespace(used=np.array(used)))
    monkeypatch.setattr(search, "_largest_slip", lambda: slip)
    assert not search._stalls()  # nothing was loaded
    search._loading = Way(search, Setting(load=0.0), Setting())
    search._passed = [SimpleNamespace()]  # type: ignore[list-item]
    assert search._stalls() is stalls


@pytest.mark.parametrize(("part", "slips"), [(0.99, False), (0.8, True), (-1.0, True)])
def test_a_clutch_slips_where_its_hub_turns_slower(part: float, slips: bool, monkeypatch: pytest.MonkeyPatch) -> None:
    search = unsolved(two())
    speeds = search.state.velocity[search.system.first_body :][:2]
    speeds[:] = 100.0, 50.0

    def guess(system: object, velocity: FloatArray) -> None:
        velocity[search.system.first_body + 1] *= part

    monkeypatch.setattr(search_module, "guess_hubs", guess)
    assert search._lets_slip(search.system) is slips


def test_friction_is_smoothed_to_a_third_of_the_speed() -> None:
    """And not at all where the belt creeps along, or nothing rubs; the pulley of least slip counts."""
    search = unsolved(two())
    friction = search.system.pulleys["friction"]
    assert search._gentle(1e-9, 200.0) == 1.0
    for speed in (200.0, -400.0):
        limits = search.system.law.friction.saturation(200.0 / search.prepared.radii, friction, speed)
        assert search._gentle(speed, 200.0) * limits.min() == pytest.approx(0.3 * abs(speed))
    rough = search._gentle(200.0, 200.0)
    friction[0] = 0.0
    assert search._gentle(200.0, 200.0) == pytest.approx(rough)
    friction[:] = 0.0
    assert search._gentle(200.0, 200.0) == 1.0


def offsets(search: SteadySearch, setting: Setting) -> Any:
    return search.at(setting).profiles.segment.offset[:2]


def test_loads_and_speeds_are_a_part_of_those_required() -> None:
    """A support is a torque of its own, which a motor gets until its own one serves."""
    search = unsolved(two())
    np.testing.assert_allclose(offsets(search, Setting()), [100.0, -8.0])
    np.testing.assert_allclose(offsets(search, Setting(load=0.25)), [100.0, -2.0])
    search._uniform = np.array([100.0, 100.0])
    np.testing.assert_allclose(offsets(search, Setting(load=0.0, speed=0.01)), [1.0, 0.0], atol=1e-12)
    search._supported, search._support = 1, 3.0
    np.testing.assert_allclose(offsets(search, Setting(support=0.5)), [100.0, -6.5])
    search._held, search._held_speed = 1, 70.0
    np.testing.assert_allclose(offsets(search, Setting(speed=0.1)), [10.0, 7.0])


@pytest.mark.parametrize("part", [1.0, 0.5, 0.0])
def test_bending_loses_a_part_of_what_it_does(part: float) -> None:
    """Of the belt's own; nothing is changed at its full loss."""
    search = unsolved(two().with_({"belt.bending_loss_factor": 0.1}))
    system = search.at(Setting(bending_loss=part))
    assert loses_in_bending(search.system)
    assert loses_in_bending(system) is (part > 0.0)
    whole = search.system.element.section.bending_hysteresis
    assert system.element.section.bending_hysteresis == pytest.approx(part * whole)
    assert (system.element is search.system.element) is (part == 1.0)


@pytest.mark.parametrize(("faster", "shares"), [(1.02, (1.01, 1.0)), (1.2, (1.2, 0.5))])
def test_rims_of_other_speeds_than_the_belt_s_are_led_there_or_begin_to_rub(
    faster: float, shares: tuple[float, float]
) -> None:
    """A small difference of prescribed speeds grows with the loads; on a rim that slides friction does."""
    drive = two().with_({"pulley[driven].torque": None, "pulley[driven].speed": 100.0 * faster})
    search = unsolved(drive)
    search._uniform = np.array([100.0, 100.0])
    speed, friction = shares
    np.testing.assert_allclose(offsets(search, Setting(load=0.5)), [100.0, 100.0 * speed])
    np.testing.assert_allclose(
        search.at(Setting(load=0.5)).pulleys["friction"] / search.system.pulleys["friction"], [1.0, friction]
    )


# A belt with teeth, driven by a motor whose speed is not known

MOTOR = {"kind": "motor", "breakdown_torque": 20.0, "breakdown_slip": 0.1, "synchronous_speed": 20.0}


def toothed(torque: float = -5.0) -> Drive:
    return Drive(
        belt={"profile": "HTD 8M", "width": "20 mm", "teeth": 100, "installed_tension": 400.0},
        pulley=[
            {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "inertia": 1e-3, "load": [MOTOR]},
            {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "inertia": 1e-3, "torque": torque},
        ],
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation={"duration": 4e-3, "output_interval": 1e-4},
    )


def of_motor(speed: float) -> float:
    """Torque by Kloss's formula, N m."""
    slip = (1.0 - speed / 20.0) / 0.1
    return 2.0 * 20.0 / (slip + 1.0 / slip)


def requires_what_the_motor_gives(search: SteadySearch, torque: float) -> None:
    """At its speed; the other pulley turns 24/36 as fast, and its load and the losses of the belt are all."""
    speed, driven = (search._speed_of(pulley) for pulley in (0, 1))
    assert driven == pytest.approx(24.0 / 36.0 * speed, rel=1e-9)
    required = abs(torque_of(search, 0))
    assert required == pytest.approx(of_motor(speed), rel=1e-6)
    assert required == pytest.approx(torque * 24.0 / 36.0, rel=0.01)


@pytest.fixture
def geared() -> SteadySearch:
    return solved(toothed(), 40)


def test_a_motor_drives_a_toothed_belt_at_the_speed_where_torques_balance(geared: SteadySearch) -> None:
    requires_what_the_motor_gives(geared, 5.0)


def test_on_a_finer_mesh_the_speed_of_the_motor_is_found_again(geared: SteadySearch) -> None:
    geared.move_to(geared.prepared.equal_lengths(56))
    assert geared.constant.nodes == 56
    requires_what_the_motor_gives(geared, 5.0)


@pytest.mark.parametrize(("torque", "result"), [(-7.0, True), (-50.0, False)])
def test_under_another_load_the_motor_turns_slower(torque: float, result: bool) -> None:
    """From the steady running of its neighbor, on its mesh; not with more than it can give."""
    run = steady_state(toothed(), elements=40)
    beside = steady_beside(run.drive.with_({"pulley[driven].torque": torque}), run)
    assert (beside is not None) is result
    if beside is not None:
        requires_what_the_motor_gives(beside.search, -torque)
        assert beside.search._speed_of(0) < float(run.dataset.shaft_speed[-1, 0])


def test_a_toothed_belt_of_a_given_speed_has_a_neighbor_too() -> None:
    """Whose search leaves the speed as it is."""
    driver, driven = toothed().pulleys
    drive = toothed().replace(pulley=[driver.replace(load=(), speed=20.0), driven])
    beside = steady_beside(drive.with_({"pulley[driven].torque": -7.0}), steady_state(drive, elements=40))
    assert beside is not None
    assert beside.search._speed_of(0) == pytest.approx(20.0)
    assert abs(torque_of(beside.search, 0)) == pytest.approx(7.0 * 24.0 / 36.0, rel=0.01)


def test_a_motor_has_no_speed_where_the_belt_does_not_run(
    geared: SteadySearch, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(geared, "_try", lambda _: False)
    assert not geared._balance(0)


def test_a_motor_whose_torque_does_not_converge_is_told(geared: SteadySearch, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(geared, "_balance", lambda _: False)
    assert not geared._resume_with_motor()
    with pytest.raises(ConvergenceError, match=r"the search ends at 100\.0% of the loads"):
        geared.move_to(geared.prepared.equal_lengths(56))


# A web, which has ends, and the content of its line

WEB = {"axial_stiffness": 2e4, "bending_stiffness": 1e-4, "mass_per_length": 0.05, "thickness": 1e-4, "width": 0.2}
SET_FORCE, RATE = 180.0, 1e6
CELL = {"sensor": "cell", "set_force": SET_FORCE, "force_gain": 1e-3, "integral_time": 0.1}


def web(speed: float = 40.0) -> Drive:
    """A roller that drives a web, a load cell, and a roller that trims its torque by it."""
    trim = {"kind": "torque_trim", "torque": 2.0} | CELL
    cell = {"kind": "sliding", "pulley": "cell", "direction": [0, 1], "rate": RATE, "preload": SET_FORCE}
    return Drive(
        belt=WEB,
        unwinder={"point": [0.0, 0.3], "tension": 100.0},
        winder={"point": [2.0, 0.0], "tension": 120.0},
        pulley=[
            {"name": "first", "center": [0.5, 0.0], "radius": 0.05, "speed": speed},
            {"name": "cell", "center": [1.0, 0.3], "radius": 0.05, "side": "outside", "inertia": 1e-4, "mass": 0.2},
            {"name": "last", "center": [1.5, 0.0], "radius": 0.05, "inertia": 0.5, "load": [trim]},
        ],
        tensioner=[cell | {"damping": 20.0}],
        contact={"friction": 0.4},
        simulation={"duration": 1.0},
    )


@pytest.fixture(scope="module")
def line() -> SteadySearch:
    return unsolved(web())


@pytest.mark.parametrize(
    ("ratio", "away"), [(-1.0, True), (0.0, True), (0.5, False), (1.0, False), (1.04, False), (1.06, True)]
)
def test_a_web_runs_forward_and_hardly_faster_than_the_roller_that_drives_it(
    line: SteadySearch, ratio: float, away: bool
) -> None:
    line.constant.frame.speed[0] = ratio * 40.0 * 0.05
    assert line._runs_away() is away


def test_a_closed_belt_does_not_run_away() -> None:
    search = unsolved(two())
    search.constant.frame.speed[0] = -9.0
    assert not search._runs_away()


def test_the_content_of_a_web_becomes_the_length_of_its_belt() -> None:
    """Nothing changes but what counts as its unstretched length: elements keep theirs, and the content is one."""
    search = unsolved(web())
    before = search.prepared.belt_length
    search._keep_content()
    assert search.prepared.belt_length == before
    set_content(search.constant.carriage, search.constant, 1.003)
    lengths = search.constant.length.copy()
    np.testing.assert_allclose(lengths.sum(), 1.003 * before)
    search._keep_content()
    assert search.prepared.belt_length == pytest.approx(1.003 * before, rel=1e-12)
    np.testing.assert_array_equal(content(search.constant), [1.0])
    np.testing.assert_allclose(search.constant.length, lengths)
    np.testing.assert_allclose(search.system.length, lengths)


def test_an_integrating_controller_begins_with_what_it_sees_at_rest(line: SteadySearch) -> None:
    """Its error grows with the loads to that of the required state; at rest the cell is 40 um from where it is set."""
    place, loads = line.state.position.copy(), line.constant.shaft_loads
    place[-1] = 4e-5
    (row, _) = loads.table
    errors = line._errors_at(place)
    assert errors.item() == pytest.approx(row.sensor_rate * 4e-5 + row.sensor_zero)
    assert abs(errors.item()) == pytest.approx(RATE * 4e-5, rel=1e-9)
    line._errors = errors
    try:
        assert line._with_set_values(loads, 1.0) is loads
        for load in (0.0, 0.25):
            shifted = line._with_set_values(loads, load).table[0]
            assert shifted.sensor_rate * 4e-5 + shifted.sensor_zero == pytest.approx(load * errors.item(), abs=1e-12)
    finally:
        line._errors = np.zeros(1)
    assert line._with_set_values(loads, 0.5) is loads
