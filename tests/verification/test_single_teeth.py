"""Belts with single teeth: against spread teeth and chains of springs, backlash, energy, jumps.

Teeth without flanks hold while the belt touches the rim, as spread ones do, so that both share a load alike. Two
pulleys of 24 teeth have ten teeth in mesh.
"""

from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.model import Prepared, prepare
from beltdyn.results import Run, derived, tooth_loads
from beltdyn.show.verdict import verdict
from beltdyn.solvers import generalized_alpha
from beltdyn.state.static import find_equilibrium
from beltdyn.system.build import drive_system
from beltdyn.system.frame import centreline_places
from beltdyn.system.meshing import at_phases, fit_phases, phases, tooth_coordinates, tooth_forces
from beltdyn.system.moving_center import pulley_center
from beltdyn.system.state import laid

AXIAL, TOOTH, PITCH, TEETH = 1e5, 1e6, 8e-3, 24
SPEED, BEGUN, TENSION = 100.0, 0.02, 200.0
AGREED = TENSION / AXIAL
"""Pitch error with which the pitches of belt and pulleys agree under the installed tension."""

pytestmark = pytest.mark.slow  # kernels of a mesh that travels with teeth


def drive(
    torque: float, *, tension: float = TENSION, speed: float = SPEED, pitch_error: float = 0.0, **toothing: Any
) -> bd.Drive:
    """Two equal pulleys that reach their speed and torque in 20 ms."""

    def ramp(value: float) -> dict[str, Any]:
        return {"kind": "cosine_ramp", "start": 0.0, "end": BEGUN, "value": value}

    teeth_of = {"teeth": TEETH, "pitch_error": pitch_error}
    teeth = {"pitch": PITCH, "tooth_stiffness": TOOTH, "tooth_damping": 20.0, "law": "discrete"}
    settings = {"duration": 0.06, "output_interval": 2e-5, "field_interval": 2e-4, "frame": "travelling", "rtol": 1e-3}
    return bd.Drive(
        belt={
            "teeth": 74,
            "width": 0.02,
            "thickness": 0.004,
            "axial_stiffness": AXIAL,
            "bending_stiffness": 1e-2,
            "mass_per_length": 0.1,
            "stretch_damping_time": 2e-4,
            "installed_tension": tension,
            "toothing": teeth | toothing,
        },
        pulley=[
            {"name": "driver", "center": [0.0, 0.0], "speed": ramp(speed) if speed else 0.0} | teeth_of,
            {"name": "driven", "center": [0.2, 0.0], "inertia": 1e-3, "torque": ramp(torque)} | teeth_of,
        ],
        tensioner=[{"kind": "fixed", "pulley": "driven", "direction": [1.0, 0.0]}],
        simulation=settings,
    )


@pytest.fixture(scope="module")
def single() -> Run:
    return bd.simulate(drive(-5.0))


@pytest.fixture(scope="module")
def spread() -> Run:
    return bd.simulate(drive(-5.0, law="spread"))


LATE = slice(0.04, None)
"""When what the start has set off has died."""


def windup(run: Run) -> float:
    """Mean way by which the driven pulley is ahead of the driver, m."""
    return float(derived.transmission_error(run).sel(pulley="driven", time=LATE).mean())


def sharing(run: Run, number: int) -> FloatArray:
    """Mean loads of teeth by whole pitches from the inlet, without those that enter and leave, N."""
    instants = run.dataset["field_time"].sel(field_time=LATE).values
    seen = [tooth_loads(run, float(time))[number] for time in instants]
    places, loads = (np.concatenate([getattr(one, name) for one in seen]) for name in ("places", "loads"))
    if "tooth_force" not in run.dataset:
        middles = np.arange(1.5, 9.0)
        return np.asarray(np.mean([np.interp(middles, one.places, one.loads) for one in seen], axis=0))
    return np.array([loads[(places >= k) & (places < k + 1)].mean() for k in range(1, 9)])


@pytest.mark.parametrize("number", [0, 1])
def test_single_teeth_share_a_load_as_spread_ones(single: Run, spread: Run, number: int) -> None:
    assert tooth_loads(single)[number].in_mesh > 8.0
    own, other = sharing(single, number), sharing(spread, number)
    np.testing.assert_allclose(own, other, atol=0.03 * np.abs(other).max())


def test_single_teeth_are_as_stiff_as_spread_ones(single: Run, spread: Run) -> None:
    assert abs(windup(spread)) > 2e-4
    assert windup(single) == pytest.approx(windup(spread), rel=0.01)


def test_the_energy_account_closes(single: Run) -> None:
    assert float(np.abs(single.dataset.energy_closure).max()) < 1e-3  # the tolerance of time steps


def test_loads_of_teeth_do_not_feel_what_newtons_method_leaves(single: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(generalized_alpha, "_HELD", 0.01)
    exact = bd.simulate(drive(-5.0))
    loads, others = (run.dataset["tooth_force"].values for run in (exact, single))
    np.testing.assert_allclose(others, loads, atol=1e-3 * np.abs(loads).max())  # the tolerance of time steps
    assert single.dataset.attrs["newton_iterations"] < exact.dataset.attrs["newton_iterations"]


def test_the_ratio_is_that_of_the_teeth(single: Run) -> None:
    error = derived.transmission_error(single).sel(pulley="driven")
    early, late = (float(error.sel(time=window).mean()) for window in (slice(0.04, 0.05), slice(0.05, None)))
    # elastic creep of a smooth belt
    creep = 5.0 / (TEETH * PITCH / (2.0 * np.pi)) / AXIAL * SPEED * 0.01 * TEETH * PITCH / (2.0 * np.pi)
    assert abs(late - early) < 0.1 * creep  # windup still swings
    assert bd.results.jumps(single) == ()


def test_forces_of_teeth_carry_the_torque(single: Run) -> None:
    late = single.dataset.sel(field_time=LATE, time=LATE)
    radius = TEETH * PITCH / (2.0 * np.pi)
    for one in (0, 1):
        torque = float(late["pulley_torque"][:, one].mean())
        total = np.mean([tooth_loads(single, float(t))[one].loads.sum() for t in late["field_time"].values])
        assert -total * radius == pytest.approx(torque, rel=0.02)  # sampled at fewer instants


def test_reversal_takes_up_the_backlash() -> None:
    backlash = 2e-4

    def reversal(play: float) -> float:
        """Way from one load to the opposite one, m."""
        loads = (drive(one, speed=0.0, pitch_error=AGREED, backlash=play) for one in (3.0, -3.0))
        ahead, behind = (windup(bd.simulate(one)) for one in loads)
        return ahead - behind

    # half on each pulley to either side
    assert reversal(backlash) - reversal(0.0) == pytest.approx(2.0 * backlash, rel=0.02)


def reversing(play: float) -> float:
    """Way of the driven pulley, the driver held, as its torque goes from 3 N m to -3 N m in a run, m."""
    torque = {"kind": "table", "times": [0.0, 0.02, 0.06, 0.07, 1.0], "values": [0.0, 3.0, 3.0, -3.0, -3.0]}
    given = drive(0.0, speed=0.0, pitch_error=AGREED, backlash=play)
    loaded = [given.pulleys[0], given.pulleys[1].merged({"torque": torque})]
    run = bd.simulate(given.replace(pulley=loaded, simulation=given.simulation.replace(duration=0.12)))
    error = derived.transmission_error(run).sel(pulley="driven")
    before, after = (float(error.sel(time=window).mean()) for window in (slice(0.04, 0.06), slice(0.1, None)))
    return before - after


def test_a_torque_that_reverses_in_a_run_loses_the_backlash_of_both_pulleys() -> None:
    backlash = 2e-4
    assert reversing(backlash) - reversing(0.0) == pytest.approx(2.0 * backlash, rel=0.02)


def steep(law: str, load: Any, duration: float) -> bd.Drive:
    """Pulleys of 24 teeth with steep flanks under a load, from steady running on."""
    given = drive(-1.0, tension=100.0, speed=50.0, tooth_stiffness=2e5, flank_angle=0.6, tooth_height=2e-3, law=law)
    driver, driven = given.pulleys
    return given.replace(
        belt=given.belt.merged({"teeth": 60, "elements": 60, "stretch_damping_time": 2e-5}),
        pulley=[driver.merged({"speed": 50.0}), driven.merged({"center": [0.144, 0.0], "torque": load})],
        simulation={
            "duration": duration,
            "start": "steady",
            "rtol": 1e-3,
            "output_interval": 1e-4,
            "field_interval": 5e-4,
        },
    )


@pytest.fixture(scope="module", params=["discrete", "spread"])
def jumped(request: pytest.FixtureRequest) -> Run:
    """A torque of forty times the load for a few milliseconds."""
    load = {
        "kind": "table",
        "times": [0.0, 0.01, 0.015, 0.02, 0.025, 1.0],
        "values": [-1.0, -1.0, -40.0, -40.0, -1, -1],
    }
    return bd.simulate(steep(request.param, load, 0.06))


def test_a_rising_torque_makes_the_belt_jump_where_its_traction_curve_ends() -> None:
    """The limit is found within 2 %; at most the inertia keeps the pulley from falling a pitch back at once."""
    limit = float(bd.traction(steep("spread", -1.0, 0.06)).dataset.limit_torque)
    rate = 13.0 * limit  # N m/s
    ramp = {"kind": "table", "times": [0.0, 0.01, 0.11], "values": [0.0, 0.0, -0.1 * rate]}
    given = steep("discrete", ramp, 0.11)
    first = bd.results.jumps(bd.simulate(given))[0]
    angle, inertia = 2.0 * np.pi / TEETH, given.pulleys[1].inertia
    late = (6.0 * angle * inertia / rate) ** (1.0 / 3.0)  # free, under the torque beyond the limit
    assert 0.98 / 13.0 < first.time - 0.01 < 1.0 / 13.0 + late


def with_elements(count: int | None) -> bd.Drive:
    given = steep("spread", -1.0, 0.06)
    return given.replace(belt=given.belt.merged({"elements": count}))


def test_no_mesh_holds_the_belt_beyond_its_jump() -> None:
    """States beyond it exist, with equal loads of teeth on both arcs; the least disturbance lifts the belt off one."""
    limits = [float(bd.traction(with_elements(one), points=3).dataset.limit_torque) for one in (None, 60, 120)]
    np.testing.assert_allclose(limits, limits[2], rtol=0.02 + 0.01)  # of the search, and of the meshes
    for count in (None, 60):
        torques = limits[2] * np.array([0.0, 0.6, 0.9, 1.05, 1.25, 1.6])
        held = np.isfinite(bd.traction(with_elements(count), torque=torques).dataset.belt_speed.values)
        np.testing.assert_array_equal(held, torques < limits[2])


def test_a_belt_jumps_under_overload_and_runs_on(jumped: Run) -> None:
    events = bd.results.jumps(jumped)
    assert events
    assert all(0.01 < one.time < 0.03 for one in events)
    error = derived.transmission_error(jumped).sel(pulley="driven")
    # the driven pulley has fallen back by whole pitches; after the overload its windup swings about that of its load
    back = {"driven": 1, "driver": -1}
    lost = sum(one.teeth * back[one.name] for one in events)
    assert float(error.sel(time=slice(0.05, None)).mean()) / PITCH == pytest.approx(-lost, abs=0.1)
    assert float(jumped.dataset.pulley_speed.sel(time=slice(0.05, None)).mean("time")[1]) == pytest.approx(
        50.0, rel=0.05
    )


def test_a_jump_is_told_and_in_the_verdict(jumped: Run) -> None:
    assert any("the belt jumps" in one for one in jumped.warnings)
    assert "the belt jumped grooves of" in verdict([jumped])[1]


def test_the_energy_account_closes_over_a_jump(jumped: Run) -> None:
    assert float(np.abs(jumped.dataset.energy_closure).max()) < 1e-3


DEPTH, BENT = 2e11, 1e-7
"""Stiffness of contact (N/m^2) and bending stiffness (N m^2) of a belt that is a chain of springs."""


def chain(count: int, tension: float, pitch: float, radius: float) -> FloatArray:
    """Loads of teeth on an arc between equal tensions (N): springs EA/p between them and k to their grooves.

    The belt runs at the pitch radius less the depth T / (R k_c) of its contact.
    """
    loads: FloatArray = np.zeros(count)
    for _ in range(30):  # until the depths are those of the tensions
        spans = tension - np.concatenate([[0.0], np.cumsum(loads)])
        between = radius / (radius - spans[1:-1] / (radius * DEPTH))
        at = radius / (radius - 0.5 * (spans[1:] + spans[:-1]) / (radius * DEPTH))
        matrix, side = np.zeros((count, count)), np.zeros(count)
        for i in range(count - 1):  # way from groove to groove less that from tooth to tooth
            matrix[i, i + 1], matrix[i, i] = 1.0 / at[i + 1], -1.0 / at[i]
            matrix[i, : i + 1] -= between[i] * PITCH / AXIAL * TOOTH
            side[i] = TOOTH * (pitch - between[i] * PITCH * (1.0 + tension / AXIAL))
        matrix[-1] = 1.0
        loads = np.linalg.solve(matrix, side).astype(float)
    return loads


def unbent(error: float, elements: int, bending: float, depth: float, **toothing: Any) -> Prepared:
    """A belt at rest that hardly bends on hard pulleys of a pitch error, with so many elements a tooth."""
    given = drive(0.0, speed=0.0, pitch_error=error, tooth_damping=0.0, **toothing)
    belt = given.belt.merged({"bending_stiffness": bending, "elements": elements * 74, "discretization": "quintic"})
    return prepare(given.replace(belt=belt, contact={"friction": 0.0, "stiffness": depth}))


def off_the_chain(elements: int) -> FloatArray:
    """Loads of teeth under a pitch error of 0.5 % less those of a chain of springs, over the largest."""
    error = 5e-3
    prepared = unbent(error, elements, BENT, DEPTH)
    system = drive_system(prepared)
    start = laid(system, prepared.path)
    fit_phases(system, start)
    found = find_equilibrium(system, start)
    position, standing = found.state.position, np.zeros((1, found.state.position.size))
    forces = tooth_forces(at_phases(system, found.phases), position[None], standing)[0]
    along = tooth_coordinates(system)
    places = centreline_places(system, position, along) - np.array(pulley_center(system, 1, position))
    radius, away = prepared.radii[1], np.hypot(*places.T)
    seated = away <= radius
    first = int(np.flatnonzero(seated & ~np.roll(seated, 1))[0])
    loads = np.roll(forces, -first)[: seated.sum()]
    # of the belt in the middle of a span; EI / 2 R^2 of it bends the belt
    free = np.flatnonzero(~seated & (away > 2.5 * radius) & (away < 3.5 * radius))
    free = free[: int(np.argmax(np.diff(np.append(free, -1)) != 1)) + 1]
    lengths = np.hypot(*np.diff(places[free], axis=0).T)
    tension = AXIAL * float(np.mean(lengths) / along[1] - 1.0) - BENT / (2.0 * radius**2)
    expected = chain(loads.size, tension, PITCH * (1.0 + error), radius)
    assert np.abs(expected).max() > 50.0
    return np.asarray((loads - expected) / np.abs(expected).max())


def test_teeth_at_rest_share_a_pitch_error_as_a_chain_of_springs() -> None:
    """The stretch jumps at teeth, over which elements are smooth: the error is as large as elements are long."""
    meshes = np.array([8, 10, 12, 14])
    errors = np.array([off_the_chain(int(number)) for number in meshes])
    basis = np.stack([np.ones(meshes.size), 1.0 / meshes], axis=1)
    (limit, slope), *_ = np.linalg.lstsq(basis, errors, rcond=None)
    assert np.abs(slope / 8.0).max() > 5e-5
    np.testing.assert_allclose(errors, basis @ np.stack([limit, slope]), atol=5e-7)
    assert np.abs(limit).max() < 1e-6


def static_error(error: float) -> FloatArray:
    """Static transmission error without load over the first sixth of a pitch, m."""
    prepared = unbent(error, 4, 1e-5, 1e10, tooth_height=1e-3, flank_angle=0.4)
    system = drive_system(prepared)
    state = laid(system, prepared.path)
    fit_phases(system, state)
    first, ahead = phases(system).copy(), []
    for part in (0.0, 1.0, 2.0):
        found = find_equilibrium(at_phases(system, first + 2.0 * np.pi / TEETH * part / 12.0), state)
        state = found.state
        ahead.append(found.phases[1] - found.phases[0])
    return np.asarray((np.array(ahead) - ahead[0]) * TEETH * PITCH / (2.0 * np.pi))


def test_pitches_that_agree_under_tension_have_no_transmission_error() -> None:
    agreed, near, far = (float(np.abs(static_error(AGREED + off)).max()) for off in (0.0, 1e-3, 2e-3))
    assert near > 1e-7
    assert far > 2.0 * near  # teeth with flanks have play as they enter: more than linear
    assert agreed < 0.01 * near  # of tensions 0.2 % above that at which pitches agree


def of_half_a_pitch(error: float) -> tuple[float, float]:
    """Static transmission error of pulleys half a pitch apart, found and by the closed form, m.

    Steep flanks without backlash hold teeth on both sides, and nothing but a pitch error moves the pulleys.  Spans of
    25.5 pitches: the driver takes a tooth as it lets one go, half a pitch before the driven pulley.  A chain of springs
    holds the belt alike before and after, which is then further on by a pitch p T / EA of a span less one of an arc,
    p (T - T_p) / EA.
    """
    given = drive(0.0, speed=0.0, pitch_error=error, tooth_damping=0.0, flank_angle=0.0)
    belt = given.belt.merged({"teeth": 75, "bending_stiffness": 1e-5, "elements": 300, "discretization": "quintic"})
    prepared = prepare(given.replace(belt=belt, contact={"friction": 0.0, "stiffness": 1e10}))
    system, radius = drive_system(prepared), float(prepared.radii[0])
    state = laid(system, prepared.path)
    fit_phases(system, state)
    first, ahead = phases(system).copy(), []
    for part in (0.0, 0.05, 0.1, 0.2, 0.3, 0.4, 0.6, 0.7, 0.8):  # in small steps, for Newton's method
        found = find_equilibrium(at_phases(system, first + 2.0 * np.pi / TEETH * part), state)
        state = found.state
        ahead.append(found.phases[1] - found.phases[0])
    along = tooth_coordinates(system)
    places = centreline_places(system, state.position, along)
    free = np.abs(places[:, 0] - 0.5 * prepared.drive.centers[1, 0]) < 0.05
    pairs = np.flatnonzero(free[1:] & free[:-1])
    tension = AXIAL * float(np.mean(np.hypot(*np.diff(places, axis=0)[pairs].T)) / along[1] - 1.0)
    agree = AXIAL * ((1.0 + error) * (1.0 - tension / (radius**2 * 1e10)) - 1.0)
    return float(ahead[2] - ahead[-1]) * TEETH * PITCH / (2.0 * np.pi), PITCH * (tension - agree) / AXIAL


def test_a_transmission_error_is_in_proportion_to_a_pitch_error_without_play() -> None:
    errors = np.array([-1e-3, -5e-4, 0.0, 5e-4, 2e-3])
    found, expected = np.array([of_half_a_pitch(AGREED + error) for error in errors]).T
    largest = float(np.abs(found).max())
    np.testing.assert_allclose(found, expected, rtol=5e-3, atol=1e-4 * largest)  # strains of 0.4 %
    straight = np.polyval(np.polyfit(errors, found, 1), errors)
    np.testing.assert_allclose(found, straight, atol=1e-3 * largest)
