"""Records: place, forces, their exact derivatives, energy and losses."""

from math import inf
from typing import Any

import numpy as np
import pytest

from beltdyn.arrays import Records
from beltdyn.errors import ModelError
from beltdyn.machines import MovingTensioner
from beltdyn.machines.tensioners import tensioner_center, tensioner_force
from beltdyn.model import Belt, Path, Pulley, RotaryTensioner, SlidingTensioner
from beltdyn.model.routing import lay_path
from beltdyn.system.build_machines import machine_arrays

BELT = Belt(length=1.0, width=0.01, thickness=0.01, density=1e3, youngs_modulus=1e8, poissons_ratio=0.3)

PULLEYS = [
    Pulley(name="driver", center=(0, 0), radius=0.1, speed={"kind": "constant", "value": 1.0}),
    Pulley(name="driven", center=(1, 0), radius=0.05, inertia=1.0),
    Pulley(name="idler", center=(0.4, 0.5), radius=0.08, inertia=1.0),
]
SPRING: dict[str, Any] = {
    "preload": 20.0,
    "rate": 30.0,
    "damping": 2.0,
    "tensioning_friction": 1.5,
    "yielding_friction": 5.0,
    "creep_speed": 0.1,
    "stops": (-0.2, 0.3),
    "stop_stiffness": 500.0,
    "stop_damping": 40.0,
}
TENSIONERS: dict[str, MovingTensioner] = {
    "sliding": SlidingTensioner(kind="sliding", pulley="idler", direction=(-1.0, 3.0), **SPRING),
    "ccw": RotaryTensioner(kind="rotary", pulley="idler", pivot=(0.7, 0.55), **SPRING),
    "cw": RotaryTensioner(kind="rotary", pulley="idler", pivot=(0.1, 0.45), **SPRING),
    "bare": SlidingTensioner(kind="sliding", pulley="driven", direction=(1.0, 0.0), preload=20.0),
}
STEP = 1e-5
FLOOR = 1e-9  # of central differences of numbers of order one


def arrays(name: str) -> Records:
    return machine_arrays(PULLEYS, [TENSIONERS[name]], lay_path(PULLEYS, BELT)).tensioners


@pytest.fixture(scope="module", params=TENSIONERS)
def tensioners(request: pytest.FixtureRequest) -> Records:
    return arrays(request.param)


@pytest.mark.parametrize("q", [-0.25, 0.0, 0.1, 0.6])
def test_place_and_its_derivatives(tensioners: Records, q: float) -> None:
    places = np.array([tensioner_center(tensioners[0], q + h) for h in (-STEP, 0.0, STEP)])
    slopes = (places[2] - places[0]) / (2 * STEP)
    np.testing.assert_allclose(places[1, 2:], slopes[:4], atol=FLOOR)


def test_the_nominal_place_is_the_pulleys_center(tensioners: Records) -> None:
    center = PULLEYS[int(tensioners.pulley[0])].center
    assert tensioner_center(tensioners[0], 0.0)[:2] == pytest.approx(center, abs=1e-15)


@pytest.mark.parametrize("name", ["ccw", "cw"])
def test_an_arm_keeps_its_length(name: str) -> None:
    arm = arrays(name)
    place = np.array(tensioner_center(arm[0], 1.1)[:2]) - arm.rotary.pivot[0]
    assert np.linalg.norm(place) == pytest.approx(arm.rotary.length[0], rel=1e-15)


@pytest.mark.parametrize("name", ["sliding", "bare"])
def test_a_slide_keeps_to_its_line(name: str) -> None:
    slide = arrays(name)
    moved = np.array(tensioner_center(slide[0], 1.1)[:2]) - slide.sliding.center[0]
    assert moved == pytest.approx(1.1 * slide.sliding.direction[0], rel=1e-15)
    assert np.linalg.norm(slide.sliding.direction[0]) == pytest.approx(1.0, rel=1e-15)


def test_the_coordinate_lengthens_the_path(tensioners: Records) -> None:
    """dL/dq of the laid path by differences is (u_in - u_out) . dc/dq."""

    def path(q: float) -> Path:
        pulley = int(tensioners.pulley[0])
        moved = PULLEYS[pulley].replace(center=tensioner_center(tensioners[0], q)[:2])
        return lay_path([*PULLEYS[:pulley], moved, *PULLEYS[pulley + 1 :]], BELT)

    numeric = (path(STEP).length - path(-STEP).length) / (2 * STEP)
    here, pulley = path(0.0), int(tensioners.pulley[0])
    gradient = here.span_directions[pulley - 1] - here.span_directions[pulley]
    slope = np.array(tensioner_center(tensioners[0], 0.0)[2:4])
    assert numeric > 0.0
    assert numeric == pytest.approx(float(gradient @ slope), abs=FLOOR)


def test_the_sense_of_an_arm_is_that_in_which_it_tensions() -> None:
    assert [float(arrays(name).rotary.sense[0]) for name in ("ccw", "cw")] == [-1.0, 1.0]


@pytest.mark.parametrize("q", [-0.25, -0.1, 0.0, 0.2, 0.34])
@pytest.mark.parametrize("rate", [-3.0, -0.07, 0.05, 2.0])
def test_derivatives_of_the_force(tensioners: Records, q: float, rate: float) -> None:
    def force(position: float, speed: float) -> float:
        return float(tensioner_force(tensioners[0], position, speed).force)

    value, by_position, by_rate, _, _ = tensioner_force(tensioners[0], q, rate)
    floor = 10 * FLOOR * (1 + abs(value))
    assert by_position == pytest.approx((force(q + STEP, rate) - force(q - STEP, rate)) / (2 * STEP), abs=floor)
    # the third derivative of tanh is up to 2 f / v_c^3: 1e4, so that the truncation is 2e-7
    assert by_rate == pytest.approx((force(q, rate + STEP) - force(q, rate - STEP)) / (2 * STEP), abs=floor + 2e-7)


@pytest.mark.parametrize("q", [-0.25, -0.1, 0.0, 0.2, 0.34])
def test_the_force_at_rest_is_the_slope_of_the_energy(tensioners: Records, q: float) -> None:
    after, before = (tensioner_force(tensioners[0], q + h, 0.0)[3] for h in (STEP, -STEP))
    force, _, _, _, loss = tensioner_force(tensioners[0], q, 0.0)
    assert loss == 0.0
    assert force == pytest.approx(-(after - before) / (2 * STEP), abs=100 * FLOOR)


@pytest.mark.parametrize("q", [-0.25, -0.201, 0.0, 0.301, 0.34])
@pytest.mark.parametrize("rate", [-9.0, -0.05, 0.02, 9.0])
def test_what_is_not_stored_is_lost(tensioners: Records, q: float, rate: float) -> None:
    after, before = (tensioner_force(tensioners[0], q + h, rate)[3] for h in (STEP, -STEP))
    force, _, _, _, loss = tensioner_force(tensioners[0], q, rate)
    stored = (after - before) / (2 * STEP) * rate
    assert loss >= 0.0
    assert loss + stored == pytest.approx(-force * rate, abs=1e-7)


@pytest.mark.parametrize(("q", "depth"), [(-0.25, -0.05), (-0.1, 0.0), (0.3, 0.0), (0.34, 0.04)])
@pytest.mark.parametrize("name", ["sliding", "ccw", "cw"])
def test_stops_push_back_by_their_stiffness(name: str, q: float, depth: float) -> None:
    """Beside 20 N - 30 N/m q of the spring; forces and lengths of an arm are torques and angles."""
    assert tensioner_force(arrays(name)[0], q, 0.0).force == pytest.approx(20.0 - 30.0 * q - 500.0 * depth, rel=1e-12)


@pytest.mark.parametrize("q", [-0.25, 0.34])
@pytest.mark.parametrize("rate", [-50.0, 0.0, 50.0])
def test_stops_never_pull(q: float, rate: float) -> None:
    without = TENSIONERS["sliding"].replace(stops=None, stop_stiffness=None, stop_damping=0.0)
    free = machine_arrays(PULLEYS, [without], lay_path(PULLEYS, BELT)).tensioners
    assert (free.sliding.spring.lower[0], free.sliding.spring.upper[0]) == (-inf, inf)
    stop = tensioner_force(arrays("sliding")[0], q, rate)[0] - tensioner_force(free[0], q, rate)[0]
    assert stop * np.sign(q) <= 0.0


def test_the_force_of_a_spring() -> None:
    """20 N less 30 N/m over 0.1 m, less 2 N s/m at 0.5 m/s, less 1.5 N tanh(5) of dry friction."""
    expected = 20.0 - 3.0 - 1.0 - 1.5 * np.tanh(5.0)
    assert tensioner_force(arrays("sliding")[0], 0.1, 0.5)[0] == pytest.approx(expected, rel=1e-15)


STOPS = "stops = .* must be a lower and an upper stop on both sides of zero"


@pytest.mark.parametrize("stops", [(-0.2, 0.0), (0.0, 0.3), (-0.2, 0.3)])
@pytest.mark.parametrize("name", ["sliding", "ccw"])
def test_stops_lie_on_either_side_of_the_nominal_place(name: str, stops: tuple[float, float]) -> None:
    spring = TENSIONERS[name].replace(stops=stops).spring
    assert (spring["lower"], spring["upper"]) == stops


@pytest.mark.parametrize("stops", [(0.0, 0.0), (0.1, 0.3), (-0.3, -0.1), (0.3, -0.2)])
@pytest.mark.parametrize("name", ["sliding", "ccw"])
def test_stops_elsewhere_are_refused(name: str, stops: tuple[float, float]) -> None:
    with pytest.raises(ModelError, match=STOPS):
        TENSIONERS[name].replace(stops=stops)


@pytest.mark.parametrize(
    ("changes", "missing"),
    [
        ({"stop_stiffness": None}, "stop_stiffness is missing"),
        ({"stops": None, "stop_damping": 0.0}, "stops is missing"),
        ({"stops": None, "stop_stiffness": None}, "stops is missing"),
    ],
)
def test_stops_and_their_stiffness_belong_together(changes: dict[str, Any], missing: str) -> None:
    with pytest.raises(ModelError, match=missing):
        TENSIONERS["sliding"].replace(**changes)
