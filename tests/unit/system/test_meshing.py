"""Unknowns of belts with teeth in steady running, and phases of grooves from one mesh or state to another."""

from typing import Any

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.contact.surface import MeshingRims, RoundRims, ToothedRims
from beltdyn.contact.surface.toothed import PHASE, SPEED
from beltdyn.model import Prepared, prepare
from beltdyn.state.static import only_tensioners
from beltdyn.state.staying import laid_state
from beltdyn.system.arrays import System
from beltdyn.system.build import drive_system, staying_system
from beltdyn.system.constant_drive import with_speeds_unknown
from beltdyn.system.meshing import (
    TOOTH_PHASES,
    fit_phases,
    has_teeth,
    led_by,
    mesh_speeds,
    on_lengths,
    phases,
    stopped,
    tooth_phases,
    tooth_rows,
    toothed_pulleys,
    turned_as,
    turning,
    unloaded,
    without_teeth,
)
from beltdyn.system.state import State
from beltdyn.system.state import laid as laid_on_path

BELT = {"profile": "HTD 8M", "width": "20 mm", "teeth": 100}


@pytest.fixture(scope="module")
def prepared() -> Prepared:
    driver = {"name": "driver", "center": [0.0, 0.0], "teeth": 24, "speed": 100.0}
    driven = {"name": "driven", "center": [0.28, 0.0], "teeth": 36, "inertia": 1e-3, "torque": -5.0}
    idler = {"name": "idler", "center": [0.14, 0.055], "radius": 0.02, "side": "outside", "inertia": 1e-4}
    return prepare(bd.Drive(belt=BELT, pulley=[driver, driven, idler], simulation={"duration": 1.0}))


@pytest.fixture
def laid(prepared: Prepared) -> tuple[System, State]:
    system = staying_system(prepared, prepared.graded_lengths(0.5))
    return system, laid_state(prepared.laid, system, np.zeros(0))


def test_only_belts_with_teeth_have_them(prepared: Prepared, laid: tuple[System, State]) -> None:
    belt = {"profile": "flat-aramid", "width": 0.02, "length": 0.8}
    pulleys = [{"name": n, "center": [x, 0.0], "radius": 0.04, "speed": 1.0} for n, x in (("a", 0.0), ("b", 0.28))]
    smooth = prepare(bd.Drive(belt=belt, pulley=pulleys, simulation={"duration": 1.0}))
    system = staying_system(smooth, smooth.equal_lengths(20))
    assert isinstance(system.rims, RoundRims)
    assert phases(system).size == 0
    assert has_teeth(laid[0])


def test_phases_are_unknown_in_place_of_speeds(laid: tuple[System, State]) -> None:
    system = led_by(with_speeds_unknown(laid[0]), 0)
    assert isinstance(system.rims, MeshingRims)
    assert system.bodies.unknown.tolist() == [-1, 0, 1]
    assert system.rims.unknown.tolist()[1:] == [PHASE, SPEED]
    velocity = laid[1].velocity.copy()
    velocity[system.first_body] = 100.0
    mesh_speeds(system, velocity)
    assert velocity[system.first_body :].tolist() == pytest.approx([100.0, 100.0 * 24 / 36, 0.0], rel=1e-12)
    pitch = float(np.sum(system.length)) / 100
    assert system.frame.speed[0] == pytest.approx(100.0 * 24 / (2 * np.pi) * pitch, rel=1e-12)


def test_teeth_have_the_play_of_their_grooves(prepared: Prepared) -> None:
    """From flank to flank the backlash; pulleys without teeth have no stiffness of teeth."""
    toothing: Any = {"toothing": {"law": "discrete", "backlash": 4e-4}}
    rows = tooth_rows(prepare(prepared.drive.replace(belt=bd.Belt(**BELT | toothing))))
    np.testing.assert_allclose(2.0 * rows.half_gap, 4e-4)
    assert (rows.stiffness > 0.0).tolist() == [True, True, False]


def test_grooves_are_turned_under_the_teeth(laid: tuple[System, State]) -> None:
    system, state = laid
    fit_phases(system, state)
    found = phases(system).copy()
    other = on_lengths(system.rims, system.length)
    other.phase[:] = 0.0
    fit_phases(system._replace(rims=other), state)
    np.testing.assert_allclose(other.phase, found, atol=1e-12)
    assert found[2] == 0.0  # no teeth


def test_phases_turn_with_pulleys(laid: tuple[System, State]) -> None:
    system, state = laid
    fit_phases(system, state)
    state.position[system.first_body :] = 0.3, 0.2, 0.1
    over_time = turning(system, state)
    assert isinstance(over_time.rims, ToothedRims)
    again = stopped(over_time, state.position[system.first_body :], 0.0)
    np.testing.assert_allclose(phases(again), phases(system), atol=1e-15)
    passed = 2.0 * np.pi / float(over_time.rims.table.rate[0])  # the length of a turn of the driver
    turned = state.position[system.first_body :] + np.array([2.0 * np.pi, 0.0, 0.0])
    later = stopped(over_time, turned, passed)
    assert phases(later)[0] == pytest.approx(phases(system)[0], abs=1e-12)


def travelling(prepared: Prepared) -> System:
    settings = prepared.simulation.replace(frame="travelling")
    return drive_system(prepare(prepared.drive.replace(simulation=settings)))


def test_teeth_travel_with_the_belt(prepared: Prepared) -> None:
    system = travelling(prepared)
    assert isinstance(system.rims, ToothedRims)
    assert toothed_pulleys(system).tolist() == [0, 1]
    assert isinstance(without_teeth(system).rims, RoundRims)
    np.testing.assert_allclose(system.rims.start, np.cumsum(system.length) - system.length)


def test_teeth_stand_alike_in_grooves_on_both_meshes(prepared: Prepared, laid: tuple[System, State]) -> None:
    system, state = travelling(prepared), laid_on_path(travelling(prepared), prepared.path)
    fit_phases(system, state)
    fit_phases(*laid)
    found, other = (np.asarray(one)[:2] for one in (tooth_phases(system)[TOOTH_PHASES], phases(laid[0])))
    ahead = (found - other) / (2.0 * np.pi / np.array([24, 36]))  # pitches between the first nodes of both
    assert abs(ahead[1] - ahead[0] - np.round(ahead[1] - ahead[0])) < 1e-3  # belts are laid on arcs a little apart


def test_grooves_are_taken_over_from_another_mesh(prepared: Prepared, laid: tuple[System, State]) -> None:
    fit_phases(*laid)
    taken = turned_as(travelling(prepared), turning(*laid))
    np.testing.assert_allclose(tooth_phases(taken)[TOOTH_PHASES], phases(laid[0]))


def test_grooves_of_the_first_pulley_hold_a_mesh_that_travels(prepared: Prepared) -> None:
    system = travelling(prepared)
    free = unloaded(system._replace(bodies=only_tensioners(system)))
    assert free.bodies.unknown.tolist() == [-1, 0, -1]
    phases(free)[:] = 1.0
    assert not np.any(phases(system))  # they turn without those of the system
