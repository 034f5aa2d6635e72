"""Linear axes against closed forms: stiffness and frequency over the stroke, the way of a turn, energy, motion."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.arrays import FloatArray
from beltdyn.results.mechanics import MESH_BESIDE, centerline, present_lengths, recorded_kind

pytestmark = pytest.mark.slow  # kernels of axes

AXIAL, TOOTH, PITCH, TEETH = 1e5, 1e6, 8e-3, 30
RADIUS = TEETH * PITCH / (2.0 * np.pi)
DISTANCE, LENGTH, MASS, TENSION = 0.8, 0.1, 5.0, 200.0
BELT = {
    "teeth": 218,
    "width": 0.02,
    "thickness": 0.004,
    "axial_stiffness": AXIAL,
    "bending_stiffness": 1e-5,
    "mass_per_length": 0.05,
    "installed_tension": TENSION,
    "toothing": {"pitch": PITCH, "tooth_stiffness": TOOTH},
}


def axis(speed: Any = 0.0, light: bool = False, duration: float = 0.12, **carriage: Any) -> bd.Drive:
    """Two equal pulleys, the first one driven, and a carriage on the upper span; a light belt has a light idler."""
    return bd.Drive(
        belt=BELT | ({"mass_per_length": 1e-3} if light else {}),
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "teeth": TEETH, "speed": speed},
            {"name": "idler", "center": [DISTANCE, 0.0], "teeth": TEETH, "inertia": 1e-7 if light else 1e-4},
        ],
        carriage={"center": [0.4, RADIUS], "direction": [-1.0, 0.0], "length": LENGTH, "mass": MASS, **carriage},
        contact={"friction": 0.0},
        tensioner=[{"kind": "fixed", "pulley": "idler", "direction": [1.0, 0.0]}],
        simulation={"duration": duration, "rtol": 1e-3, "output_interval": 1e-3},
    )


RUBBING = 20.0
"""Friction of the guide that keeps teeth on their flanks, N."""
REVERSED = {
    "kind": "s_curve",
    "times": [0.01, 0.23],
    "angles": [np.pi, 0.0],
    "speed": 20.0,
    "acceleration": 400.0,
    "jerk": 4e4,
}
"""Half a turn there and back, with constant speed in between."""
THERE, BACK = slice(0.09, 0.16), slice(0.31, 0.38)


def reversal(backlash: float, law: str) -> float:
    """Difference of the error of position at constant speed there and back, with friction of the guide, m."""
    given = axis(REVERSED, duration=0.4, friction=RUBBING)
    agreed = [one.merged({"pitch_error": TENSION / AXIAL}) for one in given.pulleys]
    toothing = {"pitch": PITCH, "tooth_stiffness": TOOTH, "tooth_damping": 20.0, "backlash": backlash, "law": law}
    belt = BELT | {"toothing": toothing, "stretch_damping_time": 1e-3}
    error = bd.simulate(given.replace(belt=belt, pulley=agreed)).dataset.carriage_error[:, 0]
    return float(error.sel(time=BACK).mean() - error.sel(time=THERE).mean())


@pytest.mark.parametrize("law", ["spread", "discrete"])
def test_an_axis_that_turns_back_loses_the_backlash(law: str) -> None:
    """The pitches agree, and the idler turns freely: the play of the driver's teeth alone is taken up.

    Within the play fewer teeth hold the arc: it gives by the stretch over which these share the friction, at most.
    """
    backlash, share = 2e-4, np.sqrt(PITCH * AXIAL / TOOTH)
    assert reversal(backlash, law) - reversal(0.0, law) == pytest.approx(backlash, abs=RUBBING / AXIAL * share)


def at_teeth(run: bd.Run, window: slice) -> tuple[FloatArray, FloatArray]:
    """Cycles for each tooth of the driver, and amplitudes of the error of position, m."""
    part = run.dataset.sel(time=window)
    passed = np.abs(part.pulley_angle.values[:, 0]) / (2.0 * np.pi) * float(run.drive.pulleys[0].teeth or 0)
    error = part.carriage_error.values[:, 0]
    even = passed[0] + np.arange(4096) / 4096 * np.floor(passed[-1] - passed[0])
    laid = np.interp(even, passed, error - np.polyval(np.polyfit(passed, error, 2), passed))
    weights, orders = np.hanning(even.size), np.arange(0.2, 4.0, 0.05)
    waves = np.exp(-2j * np.pi * orders[:, None] * even)
    return orders, 2.0 * np.abs(waves @ (weights * laid)) / weights.sum()


def test_single_teeth_of_a_printer_leave_bands_a_pitch_apart() -> None:
    """Vertical banding: at 300 mm/s the meshing frequency is 150 Hz, whatever the speed a wave of 2 mm on the print."""
    changes = {"simulation.duration": 0.35, "simulation.output_interval": 2e-4, "simulation.rtol": 1e-3}
    single = bd.simulate(bd.example("printer_axis").with_({"belt.toothing.law": "discrete", **changes}))
    orders, found = at_teeth(single, slice(0.14, 0.34))
    near = np.abs(orders - 1.0) < 0.15
    assert orders[near][np.argmax(found[near])] == pytest.approx(1.0, abs=0.05)
    _, without = at_teeth(bd.simulate(bd.example("printer_axis").with_(changes)), slice(0.14, 0.34))
    assert found[near].max() > 3.0 * without[near].max()


def arc(length: float) -> FloatArray:
    """Stiffness of a belt on an arc that its teeth hold, by the tension over the displacement at both ends."""
    share = np.sqrt(PITCH * AXIAL / TOOTH)
    own, other = 1.0 / np.tanh(length / share), 1.0 / np.sinh(length / share)
    return np.asarray(AXIAL / share * np.array([[own, -other], [-other, own]]))


def stiffness_of(first: float, last: float, back: float) -> float:
    """Stiffness at the carriage: spans beside it, and the way back over an idler that turns."""
    whole = np.zeros((6, 6))  # carriage, both ends of the driver's arc, both of the idler's, and its rim
    for i, j, length in ((0, 1, first), (2, 3, back), (4, 0, last)):
        whole[np.ix_([i, j], [i, j])] += AXIAL / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    whole[1:3, 1:3] += arc(np.pi * RADIUS)
    slips = np.array([[0, 0, 0, 1, 0, -1], [0, 0, 0, 0, 1, -1]])
    whole += slips.T @ arc(np.pi * RADIUS) @ slips
    return float(whole[0, 0] - whole[0, 1:] @ np.linalg.solve(whole[1:, 1:], whole[1:, 0]))


def test_stiffness_and_frequency_over_the_stroke() -> None:
    """EA / L of the spans in series with arcs and teeth; without the mass of belt and idler."""
    held = axis(light=True)
    found = bd.stroke(held, places="-0.2, 0, 0.2 m").dataset
    taken_up = float(bd.check(held).drive.centers[1, 0])
    for place, stiffness, frequency, share in zip(
        *(found[name].values for name in ("place", "stiffness", "frequency", "carriage_share")), strict=True
    ):
        first, last = 0.4 - place - 0.5 * LENGTH, taken_up - 0.4 + place - 0.5 * LENGTH
        expected = stiffness_of(first, last, taken_up)
        assert stiffness == pytest.approx(expected, rel=0.01)
        assert frequency == pytest.approx(np.sqrt(expected / MASS) / (2.0 * np.pi), rel=0.01)
        assert share > 0.99


@pytest.fixture(scope="module")
def moved() -> bd.Run:
    """A turn of the driver and back, with limited jerk."""
    move = {
        "kind": "s_curve",
        "times": [0.01],
        "angles": [np.pi],
        "speed": 20.0,
        "acceleration": 300.0,
        "jerk": 2e4,
    }
    return bd.simulate(axis(move, duration=0.27, friction=20.0, damping=30.0))


def test_the_way_of_a_turn_is_that_of_the_teeth_of_a_stretched_belt(moved: bd.Run) -> None:
    """A pulley passes teeth; the belt that leaves it under T is 1 + T / EA times as long as its unstretched pitches."""
    dataset, belt = moved.dataset, moved.prepared.belt
    strain = float(dataset.span_tension.values[-1, -1]) / AXIAL
    way = 0.5 * TEETH * belt.given_pitch * (1.0 + strain)
    assert float(dataset.carriage_position[-1, 0]) == pytest.approx(way, rel=3e-4)
    assert float(dataset.carriage_error[-1, 0]) == pytest.approx(
        float(dataset.carriage_position[-1, 0]) - np.pi * RADIUS, abs=1e-12
    )


def test_both_ends_stay_on_the_carriage(moved: bd.Run) -> None:
    dataset = moved.dataset
    ends = dataset.node_position.values[:, [0, -1]]
    way = dataset.carriage_position.sel(time=dataset.field_time.values, method="nearest").values
    begin = np.array([[0.4 - 0.5 * LENGTH, RADIUS], [0.4 + 0.5 * LENGTH, RADIUS]])
    assert np.abs(ends - begin - way[:, :, None] * np.array([-1.0, 0.0])).max() < 1e-9


def test_the_belt_gives_what_mass_and_guide_take(moved: bd.Run) -> None:
    """Newton's law of the carriage: m a = T1 - T2 - friction; tensions are means of spans, right to 0.5 % at rest."""
    dataset = moved.dataset
    time, speed = dataset.time.values, dataset.carriage_speed.values[:, 0]
    moving = speed > 0.1
    rate = np.gradient(speed, time)
    tension = dataset.span_tension.values
    pull = tension[:, 2] - tension[:, 1]
    taken = MASS * rate + 30.0 * speed + 20.0 * np.tanh(speed / 1e-3)
    assert pull[moving].mean() == pytest.approx(taken[moving].mean(), abs=0.005 * TENSION)
    assert float(np.sqrt(np.mean((pull - taken)[moving] ** 2))) < 0.05 * np.abs(taken).max()


def test_energy_closes(moved: bd.Run) -> None:
    assert float(np.abs(moved.dataset.energy_closure).max()) < 2.0 * moved.prepared.simulation.rtol


def test_a_force_over_time_swings_the_carriage_at_its_frequency() -> None:
    """Driver held: a step of force swings it about F / k, with the frequency of the closed form."""
    held = axis(force={"kind": "step", "time": 0.01, "value": 50.0})
    run = bd.simulate(held)
    taken_up = float(run.drive.centers[1, 0])
    stiffness = stiffness_of(0.4 - 0.5 * LENGTH, taken_up - 0.4 - 0.5 * LENGTH, taken_up)
    way, time = run.dataset.carriage_position.values[:, 0], run.dataset.time.values
    after = time > 0.01
    frequency = np.sqrt(stiffness / MASS) / (2.0 * np.pi)
    expected = 50.0 / stiffness * (1.0 - np.cos(2.0 * np.pi * frequency * (time[after] - 0.01)))
    first = time[after] < 0.01 + 2.0 / frequency
    assert way[after][first] == pytest.approx(expected[first], abs=0.05 * expected.max())


LAND = 4e-3


def on_lands(teeth: int, stiffness: float, land: float | None = LAND) -> bd.Drive:
    """An axis that creeps over two pitches, with a smooth idler, and a belt that hardly bends and stretches."""
    radius, pace = teeth * PITCH / (2.0 * np.pi), 0.05
    toothing = {"pitch": PITCH, "tooth_stiffness": TOOTH, "tooth_damping": 20.0, "law": "discrete", "land_radius": land}
    flanks = {"flank_angle": 0.3, "tooth_height": 3e-3}
    motor = {"kind": "cosine_ramp", "start": 0.0, "end": 0.1, "value": -pace / radius}
    agreed = TENSION / AXIAL
    return bd.Drive(
        belt=BELT
        | {
            "teeth": 62,
            "elements": 248,
            "bending_stiffness": 1e-6,
            "mass_per_length": 1e-2,
            "stretch_damping_time": 1e-3,
            "toothing": toothing | flanks,
        },
        pulley=[
            {"name": "motor", "center": [0.0, 0.0], "teeth": teeth, "speed": motor, "pitch_error": agreed},
            {"name": "idler", "center": [0.2, 0.0], "radius": radius, "inertia": 1e-6},
        ],
        carriage={"center": [0.1, radius], "direction": [1.0, 0.0], "length": 0.02, "mass": 0.05},
        contact={"friction": 0.0, "stiffness": stiffness},
        tensioner=[{"kind": "fixed", "pulley": "idler", "direction": [1.0, 0.0]}],
        simulation={"duration": 0.48, "rtol": 1e-3, "output_interval": 5e-4},
    )


def wave(teeth: FloatArray, speed: FloatArray) -> float:
    """Amplitude of a speed once a tooth, by least squares with its multiples."""
    turned = 2j * np.pi * teeth[:, None] * np.arange(1, 6)
    basis = np.concatenate([np.ones((teeth.size, 1)), np.cos(turned.imag), np.sin(turned.imag)], axis=1)
    fitted = np.linalg.lstsq(basis, speed, rcond=None)[0]
    return float(np.hypot(fitted[1], fitted[6]))


def on_a_polygon(teeth: int) -> FloatArray:
    """Speed of the belt over that of the pulley, m, over a tooth."""
    groove = 2.0 * np.pi / teeth
    corner = 0.5 * groove * (teeth * PITCH * (1.0 + TENSION / AXIAL) / (2.0 * np.pi) - LAND) / np.sin(0.5 * groove)
    return np.asarray(LAND + corner * np.cos((np.arange(1000) / 1000 - 0.5) * groove))


def in_a_run(teeth: int, stiffness: float, land: float | None = LAND) -> tuple[FloatArray, FloatArray]:
    """Teeth that have passed, and the speed of the carriage over that of the motor, m."""
    late = bd.simulate(on_lands(teeth, stiffness, land)).dataset.sel(time=slice(0.15, 0.47))
    passed = np.abs(late.pulley_angle.values[:, 0]) * teeth / (2.0 * np.pi)
    return passed, np.abs(late.carriage_speed.values[:, 0] / late.pulley_speed.values[:, 0])


@pytest.mark.parametrize(("teeth", "stiffness"), [(12, 1e10), (20, 1e11)])
def test_a_belt_that_runs_straight_from_land_to_land_has_the_ripple_of_a_polygon(teeth: int, stiffness: float) -> None:
    passed, speed = in_a_run(teeth, stiffness)
    expected = on_a_polygon(teeth)
    assert speed.max() == pytest.approx(expected.max(), rel=1e-3)  # half of the strain
    # depths in the lands, and teeth that enter, round the cusps
    assert np.ptp(speed) == pytest.approx(np.ptp(expected), rel=0.05)
    assert wave(passed, speed) == pytest.approx(wave(np.arange(1000) / 1000, expected), rel=0.08)


def test_a_belt_on_a_circle_has_no_ripple_of_a_polygon() -> None:
    assert wave(*in_a_run(20, 1e10, None)) < 0.03 * wave(np.arange(1000) / 1000, on_a_polygon(20))


def test_teeth_between_lands_are_in_mesh() -> None:
    """Half of the twelve grooves, with the force of each."""
    run = bd.simulate(on_lands(12, 1e10).with_({"simulation.duration": 0.12}))
    motor = bd.results.tooth_loads(run)[0]
    assert motor.in_mesh == pytest.approx(6.0, abs=0.6)  # an arc ends at lands
    forces = run.fields_at().tooth_force.values
    assert np.sort(motor.loads) == pytest.approx(np.sort(-forces[forces != 0.0]))  # along the belt, which runs back


# The mesh that stays at both arcs, against the one that travels with the belt

TOOTHED: dict[str, Any] = {}
FLAT: dict[str, Any] = {
    "belt": {**BELT, "teeth": None, "toothing": None, "width": 0.02, "installed_tension": 4.0 * TENSION},
    "pulley": [
        {"name": "motor", "center": [0.0, 0.0], "diameter": 2.0 * RADIUS - 4e-3, "speed": REVERSED},
        {"name": "idler", "center": [DISTANCE, 0.0], "diameter": 2.0 * RADIUS - 4e-3, "inertia": 1e-4},
    ],
    "contact": {"friction": 0.4},
}


def on_both_meshes(changes: dict[str, Any]) -> tuple[bd.Run, bd.Run]:
    """The same reversal on the mesh that stays at arcs, and on one that travels."""
    given = axis(REVERSED, duration=0.2, friction=RUBBING)
    belt = {**BELT, "stretch_damping_time": 1e-4, "bending_loss_factor": 0.1} | changes.get("belt", {})
    parts = {**changes, "belt": {name: value for name, value in belt.items() if value is not None}}
    stays = given.replace(**parts).with_({"simulation.rtol": 1e-4})
    travels = stays.with_({"simulation.frame": "travelling", "belt.discretization": "quintic", "belt.elements": 200})
    return bd.simulate(stays), bd.simulate(travels)


@pytest.mark.parametrize("changes", [TOOTHED, FLAT], ids=["toothed", "flat"])
def test_two_meshes_move_a_carriage_alike(changes: dict[str, Any]) -> None:
    """Spans of the one become longer and shorter, nodes of the other pass the ends of arcs.

    The mesh that travels has wrap angles, sliding and losses of bending to some per cent; on 400 elements to one.
    """
    one, other = on_both_meshes(changes)
    assert (one.dataset.attrs["mesh_frame"], other.dataset.attrs["mesh_frame"]) == ("staying", "travelling")
    assert one.dataset.sizes["element"] < 50
    for name, tolerance in {
        "carriage_position": 5e-5,
        "span_tension": 2e-3,
        "hub_force": 2e-3,
        "strain_energy": 1e-3,
        "driver_work": 2e-3,
        "pulley_torque": 2e-2,
        "wrap_angle": 1e-2,
    }.items():
        mine, theirs = one.dataset[name].values, other.dataset[name].values
        assert np.sqrt(np.mean((mine - theirs) ** 2)) < tolerance * np.sqrt(np.mean(theirs**2)), name
    for run in (one, other):
        assert float(np.abs(run.dataset.energy_closure).max()) < 3e-4
    loss, expected = (float(run.dataset.material_loss[-1]) for run in (one, other))
    assert loss == pytest.approx(expected, rel=0.12)


def test_friction_falls_on_the_same_belt_on_both_meshes() -> None:
    """The belt passes the arcs of the one by as much as the carriage moves; pieces of spans are long there."""
    shares = []
    for run in on_both_meshes(FLAT):
        work = np.abs(run.dataset.friction_work_on_belt.values[:, 1:].sum(axis=(0, 1)))
        ends = np.append(run.dataset.node_coordinate.values, run.drive.belt_length)[: work.size + 1]
        shares.append(np.interp(np.linspace(0.0, ends[-1], 200), ends, np.append(0.0, np.cumsum(work) / work.sum())))
    assert np.abs(shares[0] - shares[1]).max() < 0.1


def test_the_mesh_of_an_axis_goes_over_to_another_run(tmp_path: Path) -> None:
    """A run that goes on where another one ended has its mesh, whatever its driver does next."""
    drive = axis(REVERSED, duration=0.1, friction=RUBBING).with_({"simulation.rtol": 1e-4})
    whole = bd.simulate(drive.with_({"simulation.duration": 0.12}))
    first = bd.simulate(drive, tmp_path / "first.nc").dataset.attrs
    start = {"file": str(tmp_path / "first.nc")}
    after = bd.simulate(drive.with_({"simulation.start": start, "simulation.duration": 0.02}))
    way = whole.dataset.carriage_position.sel(time=after.dataset.time.values, method="nearest").values
    np.testing.assert_allclose(after.dataset.carriage_position.values, way, atol=2e-6)
    for name in MESH_BESIDE:
        np.testing.assert_array_equal(after.dataset.attrs[name], first[name])
        assert np.size(first[name]) == whole.dataset.sizes["node"]  # files hold attributes of 64 KB at most


def test_pictures_show_spans_as_long_as_they_are() -> None:
    """At every instant the points of the belt follow each other, and none of them lies beyond the carriage."""
    run = bd.simulate(axis(REVERSED, duration=0.12))
    for time in (0.0, 0.06, 0.12):
        instant = run.fields_at(time)
        lengths = present_lengths(instant, run.drive.belt_length)
        assert lengths.sum() == pytest.approx(run.drive.belt_length, rel=1e-12)
        points = centerline(recorded_kind(run.dataset, run.prepared), instant["nodal_coordinates"].values, lengths)
        ways = np.linalg.norm(np.diff(points, axis=1), axis=-1)
        assert ways.sum() == pytest.approx(run.drive.belt_length * (1.0 + TENSION / AXIAL), rel=1e-3)
        np.testing.assert_allclose(ways, (lengths[:, None] / ways.shape[1]) * np.ones_like(ways), rtol=0.02)
