"""A heavy tensioner on a belt that slides without friction: its eigenfrequency, and how it swings when it is let go.

The belt has one tension T(q) wherever the tensioner stands, from its length: with the stretch g on a path of the length
L(q) around circles R into which it sinks by d = T g / (R k_p), lambda^2 = d R,

    g L0 = L - sum theta d + 2 sum 5/12 lambda d / R    (the arcs, and their ends; see theory/static_tension.py).

The tensioner feels its spring, the belt's stiffness and the change of the leverage,

    k = rate + dT/dq dL/dq + T d2L/dq2,

with dT/dq = EA / L0 dL/dq where nothing sinks in and strains are small.  What is left are terms of higher order in
lambda / R, which is 0.09 on the tensioner's pulley, of what the contact yields: 17 % of k; and the belt that moves
along with the tensioner, which has 5e-4 of the energy.
"""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, curve_fit

from beltdyn.model import Drive
from beltdyn.model.carrier import Carrier, carriers_of, moved
from beltdyn.model.simulation import Instants
from beltdyn.solvers.generalized_alpha import GeneralizedAlpha
from beltdyn.solvers.trajectory import Chunk, Statistics, Task
from beltdyn.system.state import State

Make = Callable[..., Drive]
Measured = Callable[..., None]

CRANK = {"name": "crank", "center": (0.0, 0.0), "radius": 0.08, "speed": {"kind": "constant", "value": 0.0}}
IDLER = {"name": "idler", "center": (0.15, -0.12), "radius": 0.04, "inertia": 1e-4}
DRIVEN = {"name": "driven", "center": (0.3, 0.02), "radius": 0.06, "inertia": 1e-3}
KINDS: dict[str, dict[str, Any]] = {
    "sliding": {"kind": "sliding", "direction": (0.2, -1.0), "mass": 40.0, "preload": 600.0, "rate": 5e4},
    "rotary": {"kind": "rotary", "pivot": (0.24, -0.15), "inertia": 0.4, "preload": 55.0, "rate": 1500.0},
}
FREE = {"friction": 0.0, "friction_law": "coefficient_slope", "creep_velocity": 0.1, "creep_rate_factor": None}
"""No friction: with the law `force_slope` it would have its slope, though no force, where nothing slips."""


@pytest.fixture(scope="module")
def drive(make: Make) -> Callable[..., Drive]:
    def of(kind: str, elements: int = 60, stiffness: float = 3e7, **keys: float) -> Drive:
        return make(
            [CRANK, IDLER, DRIVEN],
            tensioner=[{"pulley": "idler"} | KINDS[kind] | keys],
            belt={"length": 1.0945, "elements": elements, "bending_factor": 1e-3},
            contact=FREE | {"damping": 0.0, "stiffness": stiffness},
        )

    return of


def stiffness(drive: Drive, q: float) -> float:
    """k about the place q, by differences over 1e-4 m or rad."""
    (carrier,) = carriers_of(drive.tensioners, [pulley.name for pulley in drive.pulleys], drive.path)
    h, tensioner = 1e-4, drive.moving_tensioners[0]
    before, here, after = (moved(drive.path, [carrier], np.array([q + step])).length for step in (-h, 0.0, h))
    tensions = [tension(drive, carrier, q + step) for step in (-h, 0.0, h)]
    slope, bend = (after - before) / (2 * h), (after - 2 * here + before) / h**2
    return tensioner.spring["rate"] + (tensions[2] - tensions[0]) / (2 * h) * slope + tensions[1] * bend


def tension(drive: Drive, carrier: Carrier, q: float) -> float:
    """T(q) with the belt's sinking in."""
    path, belt = moved(drive.path, [carrier], np.array([q])), drive.belt

    def excess(stretch: float) -> float:
        pull = float(belt.stretch_parameters.tension(stretch))
        depth = pull * stretch / (drive.contact_stiffness * path.radii)
        sunk = path.wrap_angles @ depth - 10 / 12 * float(np.sum(np.sqrt(depth * path.radii) * depth / path.radii))
        return stretch * belt.given_length - path.length + float(sunk)

    found = float(brentq(excess, 1.0, path.length / belt.given_length, xtol=1e-14))
    return float(belt.stretch_parameters.tension(found))


@pytest.mark.parametrize(
    ("stiff", "error"),
    [(3e7, 3e-3), pytest.param(3e8, 1e-3, marks=pytest.mark.slow)],
    ids=["soft contact", "stiff contact"],
)
@pytest.mark.parametrize("kind", KINDS)
def test_eigenfrequency(
    drive: Callable[..., Drive],
    at_rest: Callable[..., Any],
    motions: Callable[..., Any],
    measured: Measured,
    kind: str,
    stiff: float,
    error: float,
) -> None:
    """Of the assembled matrices; the error falls with lambda as it must, and the spring alone is far away."""
    given = drive(kind, 60, stiff)
    system, state = at_rest(given)
    motion = motions(system, state)
    found, inertia = motion.of(system.bodies.size - 1), float(system.bodies.inertia[-1])
    hand = np.sqrt(stiffness(given, float(state.position[-1])) / inertia)
    spring = np.sqrt(KINDS[kind]["rate"] / inertia)
    rigid = np.sqrt(stiffness(drive(kind, 60, 1e12), float(state.position[-1])) / inertia)
    share = motion.shares[-1].max()
    measured(found=found.imag, error=found.imag / hand - 1, spring=spring, rigid=rigid, belt=1 - share)
    assert share > 0.999
    assert abs(found.real) < 1e-6 * found.imag
    assert found.imag == pytest.approx(hand, rel=error)
    assert abs(spring / hand - 1) > 50 * error
    assert abs(rigid / hand - 1) > 5 * error


@pytest.mark.slow
@pytest.mark.parametrize("kind", KINDS)
def test_let_go(
    drive: Callable[..., Drive],
    at_rest: Callable[..., Any],
    motions: Callable[..., Any],
    measured: Measured,
    kind: str,
) -> None:
    """From the equilibrium under 5 % more preload, with tolerance 1e-4: the frequency of the assembled matrices."""
    given = drive(kind)
    system, state = at_rest(given)
    period = 2 * np.pi / motions(system, state).of(system.bodies.size - 1).imag
    _, aside = at_rest(drive(kind, preload=1.05 * KINDS[kind]["preload"]))
    instants = Instants(2.0 * period / 80, 2.0 * period)
    times = instants[np.arange(81)]
    start = State(aside.position, aside.velocity, np.zeros_like(aside.position))
    task = Task(system, start, instants, (), 0.1, Statistics())
    chunks = Chunk.join(list(GeneralizedAlpha(0.8, 1e-4)(task)))
    q = chunks.at(times)[0][:, -1] - state.position[-1]
    (amplitude, omega), _ = curve_fit(lambda t, a, w: a * np.cos(w * t), times, q, [q[0], 2 * np.pi / period])
    rest = np.abs(q - amplitude * np.cos(omega * times)).max() / amplitude
    measured(amplitude=amplitude, error=omega * period / (2 * np.pi) - 1, rest=rest)
    assert omega * period == pytest.approx(2 * np.pi, rel=1e-3)
    assert amplitude == pytest.approx(q[0], rel=5e-3)
    assert rest < 5e-3  # the belt's own vibrations, let go too
