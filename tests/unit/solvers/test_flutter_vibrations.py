"""Vibrations against all eigenvalues of the equations of motion as a first-order system."""

from importlib.resources import files

import numpy as np
import pytest

from beltdyn.model import Drive, Path, install, loads, prepare
from beltdyn.solvers.flutter import Vibrations
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system
from beltdyn.system.first_order import FirstOrder
from beltdyn.system.state import State, laid

TIME = 1.0
"""When all drivers turn, s; the belt stands still, and slides on their whole arcs."""
DEPTH = 3e-5
"""To which it is pressed into the pulleys, m."""
DAMPING = 10.0
"""Of contact, N s/m^2: so little that vibrations grow."""
SHIFT = 0.02 + 1j
"""Over the angular frequency of the belt on its penalty springs."""
NEAR = 0.3
"""Frequencies compared, from this part below that frequency to as much above."""
DRIVES = {
    "shared node": ("two_pulley", 20, "shared_node"),
    "multipliers": ("two_pulley", 20, "multipliers"),
    "sliding tensioner": ("flat_belt_idler", 40, "shared_node"),
    "rotary tensioner and hub chains": ("accessory_drive", 40, "shared_node"),
}


@pytest.fixture(params=[pytest.param(one, marks=[pytest.mark.slow] * ("tensioner" in one)) for one in DRIVES])
def drive(request: pytest.FixtureRequest) -> Drive:
    name, elements, joint = DRIVES[request.param]
    drive = loads(files("beltdyn").joinpath("examples", f"{name}.toml").read_text(encoding="utf-8"))
    return drive.replace(
        belt=drive.belt.replace(elements=elements),
        contact=drive.contact.replace(damping=DAMPING),
        simulation=drive.simulation.replace(joint=joint),
    )


def sliding(drive: Drive) -> tuple[System, State]:
    system, installation = drive_system(prepare(drive)), install(drive)
    path = installation.path
    pressed = Path(path.centers, path.radii - DEPTH * np.sign(path.radii))
    state = laid(system, pressed, installation.tensioner_positions)
    FirstOrder(system).body_forces_at(np.array([TIME]), state.position[None], state.velocity[None])
    return system, state


def frequency_of(system: System) -> float:
    """Angular frequency of the belt on its penalty springs, 1/s."""
    return float(np.sqrt(system.law.normal.stiffness / system.element.section.mass))


def test_fastest_growing(drive: Drive) -> None:
    system, state = sliding(drive)
    equations, size = FirstOrder(system), 2 * state.position.size
    values = np.linalg.eigvals(equations.jacobian(TIME, equations.pack(state))[:size, :size])
    frequency = frequency_of(system)
    near = values[abs(values.imag - frequency) < NEAR * frequency]
    expected = near[np.argmax(near.real)]
    found = Vibrations(system).fastest_growing(TIME, state.position, state.velocity, SHIFT * frequency)
    assert found == pytest.approx(expected, rel=1e-6)


def test_the_state_is_kept(drive: Drive) -> None:
    system, state = sliding(drive)
    before = state.position.copy(), state.velocity.copy()
    Vibrations(system).tangents(TIME, state.position, state.velocity)
    np.testing.assert_array_equal((state.position, state.velocity), before)
