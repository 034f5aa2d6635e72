"""A belt with ends as arrays: what is held and pulled, masses at the ends, and spans from end to end."""

from typing import Any

import numpy as np
import pytest

from beltdyn.model import Drive, prepare
from beltdyn.solvers.engine import accelerate
from beltdyn.system.arrays import Motion
from beltdyn.system.build import belt_system, drive_system
from beltdyn.system.first_order import FirstOrder, mass_matrix
from beltdyn.system.observe import observe
from beltdyn.system.state import curve_lengths, laid, straight
from beltdyn.system.steady_assembly import new_equations, no_multipliers

SPEED = 2.0


def strap(drive: Drive, **second: Any) -> Drive:
    """A belt of twelve elements over half of a drum, clamped at its first end."""
    radius = 0.1
    ends = (
        {"name": "first", "kind": "fixed", "point": (radius, -0.4), "clamped": True},
        {"name": "second"} | second,
    )
    return drive.replace(
        belt=drive.belt.replace(elements=12, length=1.3, installed_tension=None),
        pulley=[{"name": "drum", "center": (0.0, 0.0), "radius": radius, "speed": {"kind": "constant", "value": 0.0}}],
        contact=drive.contact.replace(stiffness=1e7),
        gravity=(0.0, -10.0),
        end=ends,
    )


@pytest.fixture
def pulled(drive: Drive) -> Drive:
    return strap(drive, kind="pulled", direction=(0.0, -1.0), tension=20.0)


def test_ends_are_held_and_pulled(drive: Drive, pulled: Drive) -> None:
    """Place and section r_y of a clamp; the second end moves, and its force adds to the belt's weight."""
    system, weightless = drive_system(prepare(pulled)), drive_system(prepare(pulled.replace(gravity=(0.0, 0.0))))
    assert (system.nodes, system.closed, system.joint) == (13, False, False)
    assert np.flatnonzero(system.supports.fixed).tolist() == [0, 1, 4, 5]
    forces = weightless.supports.force.reshape(13, 6)
    np.testing.assert_array_equal(forces[-1], [0.0, -20.0, 0.0, 0.0, 0.0, 0.0])
    assert not np.any(forces[:-1])
    both = strap(drive, kind="fixed", point=(-0.1, -0.6))
    assert np.flatnonzero(drive_system(prepare(both)).supports.fixed).tolist() == [0, 1, 4, 5, 72, 73]


def test_a_weight_moves_with_its_end(drive: Drive) -> None:
    bare, heavy = (drive_system(prepare(strap(drive, kind="weight", mass=mass))) for mass in (2.0, 5.0))
    more = mass_matrix(heavy) - mass_matrix(bare)
    places = [72, 73]
    np.testing.assert_allclose(more[places, places], 3.0)
    assert np.count_nonzero(more) == 2
    force = heavy.supports.force - bare.supports.force
    np.testing.assert_allclose(force[places], [0.0, -30.0], atol=1e-12)
    assert np.count_nonzero(force) == 1


def test_a_mass_at_the_first_end(drive: Drive) -> None:
    more = mass_matrix(belt_system(drive.belt, masses=[(0, 2.0)])) - mass_matrix(belt_system(drive.belt))
    np.testing.assert_allclose(more[[0, 1], [0, 1]], 2.0)
    assert np.count_nonzero(more) == 2


def test_the_laid_belt_runs_from_end_to_end(pulled: Drive) -> None:
    system = drive_system(prepare(pulled))
    nodes = laid(system, pulled.path).nodes(system)
    assert pulled.path.ends is not None
    np.testing.assert_allclose(nodes[[0, -1], :2], pulled.path.ends, atol=1e-14)


def test_held_coordinates_have_no_acceleration_in_the_first_order_form(pulled: Drive) -> None:
    """And the others have that of the solution with the tangent's rows of the clamp."""
    system = drive_system(prepare(pulled))
    state, equations = laid(system, pulled.path), FirstOrder(system)
    rates = equations.unpack(equations.rates(0.0, equations.pack(state)))[1]
    acceleration = np.empty_like(rates)
    work = new_equations(system)
    motion = Motion(0.0, state.position, state.velocity.copy(), acceleration)
    accelerate(system, motion, no_multipliers(system), work)
    assert not np.any(rates[: system.first_body][system.supports.fixed])
    np.testing.assert_allclose(rates, acceleration, atol=1e-9 * np.abs(acceleration).max())  # rounding


def test_spans_of_an_open_belt(pulled: Drive) -> None:
    """The first half of the belt is stretched by 1 %, the second by 2 %, and all of it runs along itself.

    The last span is that before the drum.
    """
    system = drive_system(prepare(pulled))
    state = laid(system, pulled.path)
    nodes = state.nodes(system)
    along = np.concatenate([[0.0], np.cumsum(curve_lengths(system))])
    top = 0.5 * along[-1]
    grown = np.where(along < top, 1.01 * along, 1.01 * top + 1.02 * (along - top))
    nodes[:, 0], nodes[:, 1] = grown - 1.01 * top, 0.1
    nodes[:, 2:4] = np.where(along < top, 1.01, 1.02)[:, None] * [1.0, 0.0]
    nodes[:, 4:] = [0.0, 1.0]
    state.velocity[: system.first_body : 6] = SPEED
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    assert seen.span_tension.shape == seen.belt_speed.shape == (1, 2)
    np.testing.assert_allclose(seen.belt_speed, SPEED)
    axial = pulled.belt.axial_stiffness
    tensions = [0.5 * axial * (g * g - 1.0) * g for g in (1.02, 1.01)]
    np.testing.assert_allclose(seen.span_tension[0], tensions, rtol=0.02)  # the element in which the stretch changes


def test_a_belt_without_pulleys_is_one_span(drive: Drive) -> None:
    system = belt_system(drive.belt, closure="open")
    state = straight(system)
    state.nodes(system)[:, :4] *= 1.01
    seen = observe(system, np.zeros(1), state.position[None], state.velocity[None])
    tension = 0.5 * drive.belt.axial_stiffness * (1.01**2 - 1.0) * 1.01
    np.testing.assert_allclose(seen.span_tension, [[tension]], rtol=1e-9)
