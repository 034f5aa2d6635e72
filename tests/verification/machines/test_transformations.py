"""The same drive turned, shifted, mirrored, run backwards, relabeled, or written in other units.

An accessory drive with everything: harmonics on the crank, a load over angle, an isolator and a one-way clutch, an
idler on the belt's back on a rotary tensioner with weight and dry friction.  Its circles are changed a little until
the arc of the crank, and the way from there to where the belt leaves the next pulley, are whole numbers of elements of
the belt from which equilibrium is sought: nodes fall on nodes then, and the discrete systems are the same.  With equal
steps rounding has no choices to turn, and what is left is how contact, friction and clutches amplify it.
"""

import re
from collections.abc import Callable
from functools import cache
from typing import Any

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy.optimize import fsolve

from beltdyn import simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Drive, Path, install, loads

Data = dict[str, Any]
Make = Callable[..., Drive]
Measured = Callable[..., None]
Reference = Callable[[float], xr.Dataset]

ELEMENTS, ARC, OFFSET = 60, 12, 19
"""Elements of the belt, on the crank, and from there to where the belt leaves the compressor."""
TURN = np.radians(37.0)
MATRIX = np.array([[np.cos(TURN), -np.sin(TURN)], [np.sin(TURN), np.cos(TURN)]])
MIRROR = np.diag([1.0, -1.0])
SHIFT = np.array([0.7, -0.3])
ROUNDING = 1e-9
"""Relative to the largest value of a variable."""


def data(x: float, radius: float, sense: float = 1.0) -> Data:
    """Drive with the compressor at x and a crank of some radius; with a negative sense it runs backwards."""
    clutch = {
        "kind": "one_way_clutch", "locking_damping": 20.0, "drag_torque": 0.1, "inertia": 2e-3,
        "drives": "forward" if sense > 0 else "backward",
    }  # fmt: skip
    speed = {"kind": "cosine_ramp", "start": 0.0, "end": 0.06, "value": sense * 30.0}
    load = {"kind": "resistance", "constant": 2.0, "creep_speed": 1.0, "quadratic": 1e-3}
    return {
        "pulley": [
            {"name": "crank", "center": (0.0, 0.0), "radius": radius, "speed": speed,
             "harmonics": [{"order": 2, "amplitude": 0.1, "phase": 0.3 * sense}]},
            {"name": "compressor", "center": (x, -0.03), "radius": 0.06, "inertia": 2e-3,
             "torque": {"kind": "step", "time": 0.05, "value": -2.0 * sense},
             "load": [load | {"harmonics": [{"order": 3, "amplitude": 0.4, "phase": 0.5 * sense}]}]},
            {"name": "alternator", "center": (0.22, 0.2), "radius": 0.03, "inertia": 3e-4,
             "hub": [{"kind": "isolator", "stiffness": 60.0, "damping": 0.01, "inertia": 3e-4}, clutch],
             "load": [{"kind": "resistance", "linear": 0.01}]},
            {"name": "idler", "center": (0.06, 0.16), "radius": 0.035, "side": "outside", "inertia": 1e-4, "mass": 0.4},
        ],
        "tensioner": [
            {"kind": "rotary", "pulley": "idler", "pivot": (0.12, 0.24), "inertia": 5e-4, "mass": 0.3, "preload": 23.0,
             "rate": 40.0, "damping": 0.05, "tensioning_friction": 1.0, "yielding_friction": 3.0,
             "stops": (-0.3, 0.3), "stop_stiffness": 1e4},
        ],
        "gravity": (1.0, -9.7),
    }  # fmt: skip


@pytest.fixture(scope="module")
def build(make: Make) -> Callable[..., Drive]:
    """Equal steps of 25 us: the tolerance does not shorten them."""
    return lambda changes, elements=ELEMENTS: make(
        belt={"elements": elements, "installed_tension": 500.0, "pitch_offset": 0.0015, "back_offset": 0.002}
        | {"wedge_angle": 0.7},
        contact={"friction": 0.4},
        simulation={"duration": 0.1, "output_interval": 1e-3, "rtol": 1e-2, "max_step": 2.5e-5},
        pulleys=changes["pulley"],
        **{key: value for key, value in changes.items() if key != "pulley"},
    )


@pytest.fixture(scope="module")
def places(build: Callable[[Data], Drive]) -> tuple[float, float]:
    """Where the compressor stands, and the radius of the crank, when nodes fall on nodes."""

    def missing(place: FloatArray) -> list[float]:
        found = install(build(data(*place)))
        path = found.path
        radii = path.radii - np.sign(path.radii) * np.min(found.penetrations)
        drawn = Path(path.centers, radii)
        element = drawn.length / ELEMENTS
        arcs = drawn.wrap_angles * np.abs(drawn.radii)
        return [arcs[0] / element - ARC, (drawn.span_lengths[0] + arcs[1]) / element - OFFSET]

    solved = fsolve(missing, [0.26, 0.083], xtol=1e-11)
    return float(solved[0]), float(solved[1])


def moved(given: Data, matrix: FloatArray, shift: FloatArray) -> Data:
    """All places and directions in another frame."""
    pulleys = [pulley | {"center": tuple(matrix @ pulley["center"] + shift)} for pulley in given["pulley"]]
    arms = [arm | {"pivot": tuple(matrix @ arm["pivot"] + shift)} for arm in given["tensioner"]]
    return given | {"pulley": pulleys, "tensioner": arms, "gravity": tuple(matrix @ given["gravity"])}


def reordered(given: Data, order: list[int]) -> Data:
    return given | {"pulley": [given["pulley"][k] for k in order]}


BACK = [0, 3, 2, 1]
CASES: dict[str, Any] = {
    # sense of the run that it is held against, what is done to it, order of its pulleys and of its spans, frame, sense
    "turned and shifted": (1.0, lambda x, r: moved(data(x, r), MATRIX, SHIFT), [0, 1, 2, 3], [0, 1, 2, 3], MATRIX, 1.0),
    "mirrored": (
        1.0, lambda x, r: reordered(moved(data(x, r, -1.0), MIRROR, SHIFT), BACK), BACK, [3, 2, 1, 0], MIRROR, -1.0
    ),
    "backwards, mirrored": (
        -1.0, lambda x, r: reordered(moved(data(x, r), MIRROR, SHIFT), BACK), BACK, [3, 2, 1, 0], MIRROR, -1.0
    ),
    "relabelled": (1.0, lambda x, r: reordered(data(x, r), [1, 2, 3, 0]), [1, 2, 3, 0], [1, 2, 3, 0], np.eye(2), 1.0),
}  # fmt: skip
SIGNED = ("pulley_speed", "shaft_speed", "pulley_torque", "shaft_torque")
PLAIN = ("wrap_angle", "friction_power", "contact_damping_power")
SCALARS = (
    "kinetic_energy", "strain_energy", "penalty_energy", "spring_energy", "driver_work", "torque_work", "friction_loss",
    "damping_loss", "tensioner_loss", "coupling_loss", "tensioner_position", "tensioner_speed",
)  # fmt: skip


@pytest.fixture(scope="module")
def reference(build: Callable[[Data], Drive], places: tuple[float, float]) -> Reference:
    """The run in a sense."""
    return cache(lambda sense: simulate(build(data(*places, sense))).dataset)


def difference(values: NDArray[Any], expected: NDArray[Any]) -> float:
    return float(np.max(np.abs(values - expected)) / np.max(np.abs(expected)))


@pytest.mark.parametrize("case", [pytest.param(one, marks=[pytest.mark.slow] * (one != "relabelled")) for one in CASES])
def test_results_follow(
    build: Callable[[Data], Drive],
    places: tuple[float, float],
    reference: Reference,
    measured: Measured,
    case: str,
) -> None:
    sense, change, order, spans, frame, sign = CASES[case]
    other, run = reference(sense), simulate(build(change(*places))).dataset
    found = {name: difference(run[name].values, other[name].values) for name in SCALARS}
    for names, factor in ((SIGNED, sign), (PLAIN, 1.0)):
        found |= {name: difference(run[name].values, factor * other[name].values[:, order]) for name in names}
    found["hub_force"] = difference(run.hub_force.values, other.hub_force.values[:, order] @ frame.T)
    found["span_tension"] = difference(run.span_tension.values, other.span_tension.values[:, spans])
    worst = max(found, key=lambda name: found[name])
    measured(worst=found[worst], speeds=found["shaft_speed"], tensions=found["span_tension"], hubs=found["hub_force"])
    assert found[worst] < ROUNDING, found


@pytest.mark.slow
def test_nodes_elsewhere(
    build: Callable[..., Drive], places: tuple[float, float], reference: Reference, measured: Measured
) -> None:
    """Named from the alternator on, the drive has its nodes elsewhere, and differs less than from one of half the mesh.

    Not with 60 elements: without friction the belt slides to equilibrium, where a mesh has few places to rest, and its
    nodes come to the same places again.
    """
    order = [2, 3, 0, 1]
    fine, run = (
        simulate(build(given, 2 * ELEMENTS)).dataset for given in (data(*places), reordered(data(*places), order))
    )
    apart = np.linalg.norm(fine.node_position.values[0] - run.node_position.values[0, :1], axis=1).min()
    names = ("shaft_speed", "span_tension", "wrap_angle", "hub_force")
    found = {name: difference(run[name].values, fine[name].values[:, order]) for name in names}
    mesh = {name: difference(reference(1.0)[name].values, fine[name].values) for name in names}
    measured(apart=apart, **found)
    measured(**{f"mesh_{name}": value for name, value in mesh.items()})
    assert apart > 1e-3
    for name in names:
        assert found[name] < mesh[name]
        assert found[name] < 5e-3


@pytest.mark.slow
def test_the_run_has_all_that_it_should(reference: Reference) -> None:
    """Equal steps, a clutch that overruns and drives, a tensioner that moves, and two runs that differ."""
    runs = {sense: reference(sense) for sense in (1.0, -1.0)}
    for sense, run in runs.items():
        np.testing.assert_allclose(run.step_size[2:], 2.5e-5, rtol=1e-6)
        ahead = sense * (run.shaft_speed - run.pulley_speed).values[:, 2]
        assert ahead.max() > 1.0
        assert ahead.min() < 0.0
        assert float(run.coupling_loss[-1]) > 0.0
        assert np.ptp(run.tensioner_position.values) > 0.01
    speeds = [run.shaft_speed.values[:, 2] for run in runs.values()]
    assert difference(-speeds[1], speeds[0]) > 0.01


UNITS: dict[str, tuple[float, str]] = {
    # what turns the number into that of the unit
    "length": (1e3, "mm"), "width": (1e2, "cm"), "thickness": (1e6, "um"), "density": (1e-3, "g/cm^3"),
    "youngs_modulus": (1e-6, "MPa"), "center": (1e3, "mm"), "pivot": (1e2, "cm"), "radius": (1e3, "mm"),
    "inertia": (1e4, "kg*cm^2"), "mass": (1e3, "g"), "preload": (1e3, "N*mm"), "rate": (np.pi / 180, "N*m/deg"),
    "drag_torque": (1e2, "N*cm"), "wedge_angle": (180 / np.pi, "deg"), "gravity": (1e3, "mm/s^2"),
    "duration": (1e3, "ms"), "output_interval": (1e6, "us"), "end": (1e3, "ms"), "max_step": (1e6, "us"),
    "creep_speed": (30 / np.pi, "rpm"), "stops": (180 / np.pi, "deg"),
}  # fmt: skip


def in_other_units(text: str) -> str:
    """Every number of a drive file whose key is known, also in lists that go over several lines."""
    lines, within = [], None
    for line in text.splitlines():
        found = re.fullmatch(r"(?:(\w+) = |\s+)(-?[\d.e+-]+)(,?)", line)
        opened = re.fullmatch(r"(\w+) = \[", line)
        within = opened[1] if opened else None if line == "]" else within
        key = (found[1] or within) if found else None
        if found and key in UNITS:
            factor, unit = UNITS[key]
            value = f'"{float(found[2]) * factor!r} {unit}"'
            line = f"{key} = {value}" if found[1] else f"    {value},"
        lines.append(line)
    return "\n".join(lines)


@pytest.mark.slow
def test_units(
    build: Callable[[Data], Drive], places: tuple[float, float], reference: Reference, measured: Measured
) -> None:
    """A drive file with other units, which are turned into SI by factors that round."""
    text = in_other_units(build(data(*places)).text)
    assert text.count('"') > 80
    run, other = simulate(loads(text)).dataset, reference(1.0)
    names = (*SCALARS, *SIGNED, *PLAIN, "hub_force", "span_tension")
    found = {name: difference(run[name].values, other[name].values) for name in names}
    measured(worst=max(found.values()))
    assert max(found.values()) < ROUNDING, found
