"""Amplitudes of tensions and hub loads under the harmonics of the crank, against the response of finite elements."""

import numpy as np
import pytest

import beltdyn as bd
from beltdyn.model import example, prepare
from beltdyn.points.changed_drive import at_instant
from beltdyn.points.quasi_steady import QuasiSteady, torques_of
from beltdyn.state.installation import looked_at
from beltdyn.state.staying import bring_to_stand
from beltdyn.vibration.peaks import amplitudes, excitations_of


def test_amplitudes_are_those_of_the_response() -> None:
    """Below resonance, with the dry friction of the arm left out of both: within 6 % of the largest one."""
    waves = [{"order": 2, "amplitude": 0.01}]
    still = {"tensioner[tensioner].tensioning_friction": 0.0, "tensioner[tensioner].yielding_friction": 0.0}
    drive = example("alternator_drive").with_(still | {"pulley[crank].harmonics": waves})
    given = at_instant(drive, None)
    rest = bring_to_stand(prepare(given))
    steady = QuasiSteady(rest.prepared, looked_at(rest.prepared, rest.system, rest.state).installation)
    speed = 100.0
    belt = speed * float(rest.prepared.path.radii[steady.driver])
    torque = torques_of(rest.drive, steady.driver)(belt)
    states = steady.at(np.array([belt]), torque[None], np.zeros(1))
    excitations = excitations_of(given, steady.driver)
    assert [one.order for one in excitations] == [one.order for one in drive.pulleys[0].harmonics]
    found = amplitudes(rest.prepared, given, excitations, states, 0)
    other = bd.response(drive, speed=[speed]).dataset
    tension = other.span_tension_amplitude.values[0].sum(axis=0)
    np.testing.assert_allclose(found.tension, tension, atol=0.06 * tension.max())
    hub = other.hub_load_amplitude.values[0].sum(axis=0)
    np.testing.assert_allclose(found.hub_load, hub, atol=0.06 * hub.max())
    assert found.positions[0] == pytest.approx(float(other.tensioner_position_amplitude.sum()), rel=0.06)


def test_dry_friction_reduces_the_way_of_the_arm() -> None:
    drive = example("accessory_drive")
    rubbed = bd.sheet(drive, points=2).dataset.tensioner_amplitude_over_speed.values
    free = {"tensioner[tensioner].tensioning_friction": 0.0, "tensioner[tensioner].yielding_friction": 0.0}
    smooth = bd.sheet(drive.with_(free), points=2).dataset.tensioner_amplitude_over_speed.values
    assert (rubbed < smooth).all()
