"""Squeal in words, by states of friction, and growing motions of a few bodies."""

import numpy as np
import pytest
from scipy.sparse import csc_array

import beltdyn as bd
from beltdyn.errors import ModelError
from beltdyn.model import Drive
from beltdyn.model.friction_state import FRICTION_STATES
from beltdyn.solvers.eigenvalues import growing_swings, pencil
from beltdyn.vibration.squeal import AS_GIVEN, SelfExcited, Squeal, in_state

QUIET = SelfExcited(1.0, np.nan, np.nan, "", np.nan, np.nan)
LOUD = SelfExcited(1.0, 900.0, 2000.0, "fan", 7.0, 0.25)


def test_a_mass_on_a_sliding_belt_grows_by_falling_friction() -> None:
    """(c + N dmu/dv) / 2m of bodies of 2 kg, 20 kN/m, and slopes -6 and 2 N s/m; growth alone is returned."""
    mass, slopes = 2.0, np.array([-6.0, 2.0])
    given = pencil(
        csc_array(np.diag([2e4, 2e4])), csc_array(np.diag(slopes)), csc_array(mass * np.eye(2)), np.zeros((2, 0))
    )
    values, vectors = growing_swings(given, 1e4)
    assert values.real == pytest.approx([6.0 / (2.0 * mass)])
    assert values.imag == pytest.approx([np.sqrt(1e4 - 1.5**2)])
    assert abs(given.coordinates(values, vectors)[1, 0]) < 1e-9
    assert growing_swings(given, 50.0)[0].size == 0  # beyond the frequencies asked for


def test_many_bodies_grow_as_by_all_eigenvalues() -> None:
    """A chain of 120 bodies, of which some are fed: the same as by the QZ algorithm."""
    draw, count = np.random.default_rng(4), 120
    stiffness = csc_array(1e6 * (2.0 * np.eye(count) - np.eye(count, k=1) - np.eye(count, k=-1)))
    damping = csc_array(np.diag(draw.uniform(-60.0, 60.0, count)))
    given = pencil(stiffness, damping, csc_array(np.eye(count)), np.zeros((count, 0)))
    values = np.linalg.eigvals(
        np.block([[np.zeros((count, count)), np.eye(count)], [-stiffness.toarray(), -damping.toarray()]])
    )
    expected = np.sort(values[(values.real > 0.0) & (values.imag > 0.0)].real)[::-1]
    assert expected.size > 2
    np.testing.assert_allclose(growing_swings(given, 2500.0)[0].real, expected, rtol=1e-6)


@pytest.mark.parametrize(
    ("squeal", "words"),
    [
        (Squeal((QUIET,), None, 3.0, AS_GIVEN), "no up to 1 times the loads; gross slip from 3 times the loads. With"),
        (Squeal((QUIET,), LOUD._replace(load=1.4), 3.0, "wet"), "wet (friction 0.2, falling to 0.14): not under these"),
        (Squeal((LOUD,), LOUD._replace(load=0.6), 3.0, "wet"), "yes, at 2000 Hz, fed by friction on fan, which takes"),
        (Squeal((LOUD._replace(load=0.6),), LOUD._replace(load=0.5), 0.7, "dry"), "the belt slips under its loads;"),
        (Squeal((LOUD,), LOUD, np.nan, AS_GIVEN), "yes, at 2000 Hz, fed by friction on fan, which takes 7 N m and"),
    ],
    ids=("no", "later", "yes", "slips", "unloaded"),
)
def test_the_answer_in_words(squeal: Squeal, words: str) -> None:
    assert words in squeal.words


def test_small_growth_does_not_count() -> None:
    assert LOUD.squeals
    assert not LOUD._replace(growth=100.0).squeals  # 0.8 % of the angular frequency
    assert not QUIET.squeals


def test_states_of_friction(drive: Drive) -> None:
    wet = in_state(drive.replace(pulley=[drive.pulleys[0].replace(friction=0.5), *drive.pulleys[1:]]), "wet")
    assert wet.pulleys[0].friction == FRICTION_STATES["wet"].friction
    assert (wet.contact.friction_law, wet.contact.kinetic_ratio) == ("stribeck", 0.7)
    assert in_state(wet, "dry").contact.friction_law == "relative_creep"
    assert in_state(drive, AS_GIVEN) is drive
    with pytest.raises(ModelError, match=r"squeal = 'damp' is not a state of friction\. Give one of"):
        in_state(drive, "damp")


def test_squeal_is_of_steady_running_and_of_friction(drive: Drive) -> None:
    with pytest.raises(ModelError, match="squeal = 'wet' requires about = \"steady\""):
        bd.modes(drive, about="rest", squeal="wet")
    with pytest.raises(ModelError, match="the belt is not held by friction"):
        bd.modes(bd.example("timing_drive"), squeal="wet")


@pytest.mark.slow
def test_an_accessory_drive_squeals_wet_and_not_dry() -> None:
    alternator = bd.example("alternator_drive")
    wet, dry = (bd.modes(alternator, count=1, squeal=state) for state in ("wet", "dry"))
    assert str(wet.dataset.squeal.values).startswith("wet (friction 0.2, falling to 0.14): yes")
    assert 0.0 < float(wet.dataset.squeal_from) < 1.0 < float(wet.dataset.slip_from)
    assert str(dry.dataset.squeal.values).startswith("dry (friction 0.35): no")
    assert np.isnan(float(dry.dataset.squeal_from))
    ax = bd.plot.squeal(wet)
    assert f"squeal from {float(wet.dataset.squeal_from):.3g} on" in [line.get_label() for line in ax.lines]
