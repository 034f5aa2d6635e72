"""Time integration: order, numerical damping and energy of generalized-alpha, and agreement of all integrators.

Generalized-alpha after Chung and Hulbert (1993): second order, spectral radius at infinite frequency as prescribed, and
for a radius of one no dissipation.  The smooth problem is the first axial mode of a clamped bar, cos(c k t) sin(k x),
k = pi / 2L.
"""

from collections.abc import Callable, Sequence

import numpy as np
import pytest
import xarray as xr

from beltdyn import simulate
from beltdyn.arrays import FloatArray
from beltdyn.model import Belt, Drive
from beltdyn.solvers.alpha_advance import REACHED
from beltdyn.solvers.engine import advance
from beltdyn.solvers.integrator_state import Settings, empty_steps, new_state
from beltdyn.system.arrays import System
from beltdyn.system.build import belt_system
from beltdyn.system.observe import observe
from beltdyn.system.state import straight
from beltdyn.system.steady_assembly import new_equations

Change = Callable[..., Drive]
Measured = Callable[..., None]
FixedSteps = Callable[[System, FloatArray, float, int, FloatArray], tuple[FloatArray, FloatArray]]

LENGTH, STRAIN, DURATION = 0.5, 1e-3, 0.1
BAR = Belt(
    length=LENGTH,
    width=0.02,
    thickness=0.05,
    density=1e3,
    youngs_modulus=1e6,
    poissons_ratio=0.3,
    elements=8,
)
WAVE = np.sqrt(BAR.axial_stiffness / BAR.mass_per_length)
NUMBER = np.pi / (2 * LENGTH)
REFERENCE = 1e-6
"""Tolerance of the run that others are compared with."""


@pytest.fixture(scope="module")
def bar() -> System:
    return belt_system(BAR, fixed=[(0, c) for c in (0, 1, 3, 4, 5)])


@pytest.fixture(scope="module")
def stretched(bar: System) -> FloatArray:
    position = straight(bar).position
    along = position[::6].copy()
    position[::6] += STRAIN * LENGTH * np.sin(NUMBER * along)
    position[2::6] += STRAIN * LENGTH * NUMBER * np.cos(NUMBER * along)
    return position


@pytest.mark.parametrize("radius", [0.0, 0.5, 0.8, 1.0])
def test_second_order(
    fixed_steps: FixedSteps,
    bar: System,
    stretched: FloatArray,
    order: Callable[[Sequence[int], Sequence[float]], float],
    measured: Measured,
    curve: Measured,
    radius: float,
) -> None:
    def places(steps: int) -> FloatArray:
        return fixed_steps(bar, stretched, radius, steps, np.array([DURATION]))[0][0, ::6]

    converged, steps = places(6400), [200, 400, 800]
    errors = [float(np.max(np.abs(places(n) - converged))) for n in steps]
    measured(order=order(steps, errors), coarsest=errors[0])
    curve("generalized_alpha/order", steps, np.array(errors) / (STRAIN * LENGTH), f"ρ∞ = {radius:g}")
    assert order(steps, errors) == pytest.approx(2.0, abs=0.1)  # the third order is not gone yet at rho = 0


def test_converges_to_the_axial_mode(fixed_steps: FixedSteps, bar: System, stretched: FloatArray) -> None:
    times = np.linspace(0.0, DURATION, 51)[1:]
    tip = fixed_steps(bar, stretched, 1.0, 1600, times)[0][:, -6] - LENGTH
    expected = STRAIN * LENGTH * np.cos(WAVE * NUMBER * times)
    np.testing.assert_allclose(tip, expected, atol=5 * STRAIN * STRAIN * LENGTH)  # the strain measure is quadratic


@pytest.mark.parametrize("radius", [0.0, 0.3, 0.6, 0.8, 1.0])
def test_spectral_radius_at_infinite_frequency(measured: Measured, curve: Measured, radius: float) -> None:
    """Amplification of the thickness stretch of a node, the only free coordinate, by steps 1e5 over its frequency."""
    free = (1, 5)
    held = [(node, c) for node in range(4) for c in range(6) if (node, c) != free]
    system = belt_system(BAR.replace(elements=3), fixed=held)
    rest, own = straight(system).position, 6 * free[0] + free[1]
    step, small = 100.0, 1e-7
    settings = Settings(radius, 1e30, 1e-46, step)
    scales = np.array([1.0, 1 / step, 1 / step**2, 1 / step**2])
    amplification = np.empty((4, 4))
    for column in range(4):
        integration = new_state(system, 0.0, step, rest, np.zeros_like(rest))
        arrays = (integration.position, integration.velocity, integration.acceleration, integration.auxiliary)
        arrays[column][own] += small * scales[column]
        none = empty_steps(system, 0)
        assert advance(system, settings, integration, new_equations(system), step, 1, none)[0] == REACHED
        assert integration.counts.steps == 1
        state = np.array([array[own] for array in arrays])
        state[0] -= rest[own]
        amplification[:, column] = state / (small * scales)
    found = float(np.max(np.abs(np.linalg.eigvals(amplification))))
    measured(radius=found)
    curve("generalized_alpha/radius", [radius], [found], "", "ko")
    assert found == pytest.approx(radius, abs=0.01)  # the root is threefold: the cube root of a rounding of 1e-7


def energies(system: System, states: tuple[FloatArray, FloatArray]) -> FloatArray:
    seen = observe(system, np.zeros(len(states[0])), *states)
    return np.asarray(seen.kinetic_energy + seen.strain_energy)


def test_energy_without_numerical_damping(
    fixed_steps: FixedSteps, bar: System, stretched: FloatArray, measured: Measured
) -> None:
    """Four periods; the error of the energy swings without drift and falls with the square of the step."""
    times = np.linspace(0.0, 0.25, 101)[1:]
    swings, drifts = [], []
    initial = energies(bar, fixed_steps(bar, stretched, 1.0, 1, np.array([1e-9])))[0]
    for steps in (100, 200):
        error = energies(bar, fixed_steps(bar, stretched, 1.0, steps, times)) / initial - 1.0
        swings.append(float(np.max(np.abs(error))))
        drifts.append(float(abs(error[-1])))
    measured(swing_100=swings[0], swing_200=swings[1], drift_200=drifts[1])
    assert swings[0] < 1e-4
    assert swings[1] == pytest.approx(swings[0] / 4, rel=0.1)
    assert drifts[1] < 0.1 * swings[1]


def test_numerical_damping_takes_energy(fixed_steps: FixedSteps, bar: System, stretched: FloatArray) -> None:
    times = np.linspace(0.0, 0.25, 101)[1:]
    last = [energies(bar, fixed_steps(bar, stretched, radius, 100, times))[-1] for radius in (1.0, 0.8, 0.5, 0.0)]
    assert np.all(np.diff(last) < 0.0)


@pytest.fixture(scope="module")
def short(small: Drive, change: Change) -> Drive:
    return change(small, simulation={"duration": 0.02})


@pytest.fixture(scope="module")
def converged(short: Drive, change: Change) -> xr.Dataset:
    """By CVODE, which is there in two seconds; Radau, whose order is the highest, takes two minutes for 1e-5."""
    return simulate(change(short, simulation={"integrator": "cvode", "rtol": REFERENCE})).dataset


@pytest.mark.slow
@pytest.mark.parametrize(
    ("integrator", "rtols"),
    [
        ("generalized_alpha", (1e-3, 1e-4, 1e-5)),
        ("cvode", (1e-3, 1e-4, 1e-5)),
        ("ida", (1e-3, 1e-4, 1e-5)),
        ("bdf", (1e-3, 1e-4)),
        ("radau", (1e-3, 1e-4)),
    ],
)
def test_integrators_agree_and_approach_each_other(
    short: Drive,
    change: Change,
    converged: xr.Dataset,
    measured: Measured,
    curve: Measured,
    integrator: str,
    rtols: tuple[float, ...],
) -> None:
    errors = {}
    for rtol in rtols:
        run = simulate(change(short, simulation={"integrator": integrator, "rtol": rtol})).dataset
        speed = float(np.max(np.abs(run.pulley_speed - converged.pulley_speed))) / 12.0
        place = float(np.max(np.abs(run.node_position - converged.node_position))) / short.belt_length
        errors[rtol] = max(speed, place)
    measured(**{f"rtol_{rtol:.0e}": error for rtol, error in errors.items()})
    curve("integrators", list(errors), list(errors.values()), integrator)
    for rtol, error in errors.items():
        assert error < 2.0 * rtol, (
            f"{integrator} at {rtol}"
        )  # a local tolerance per unit of time, over a fraction of a second
    settled = REFERENCE  # where the error of the reference counts too: Radau is there at every tolerance
    assert errors[rtols[-1]] < max(0.3 * errors[rtols[0]], settled)


@pytest.mark.parametrize("start", ["laid", "equilibrium"])
def test_start_modes(short: Drive, change: Change, start: str) -> None:
    """Equilibrium is at rest; the laid belt is not, and springs into its pulleys."""
    run = simulate(change(short, simulation={"start": start, "duration": 0.001, "output_interval": 1e-4})).dataset
    assert run.kinetic_energy[0] == 0.0
    assert float(run.time[0]) == 0.0
    if start == "laid":
        np.testing.assert_allclose(run.node_position[0], short.path.position(short.path.length / 10 * np.arange(10)))
        assert run.kinetic_energy.max() > 0.1 * run.strain_energy[0]
    else:
        # the driver's rim has moved by 1e-6 m after 1 ms
        assert run.kinetic_energy.max() < 1e-3 * run.strain_energy[0]
        np.testing.assert_allclose(run.node_position[-1], run.node_position[0], atol=1e-5)
