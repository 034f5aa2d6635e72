"""Linearized drives at rest: what turns freely, what sticks, and tensioners that are held."""

import numpy as np
import pytest

from beltdyn.errors import ModelError
from beltdyn.model import Drive, Path, prepare
from beltdyn.model.resolution import Laid
from beltdyn.state.linearized import SmallMotions
from beltdyn.state.staying import Standing, laid_state
from beltdyn.system.arrays import Carrying
from beltdyn.system.build import staying_system
from beltdyn.vibration.small_motions import about_rest, about_standing, dry_tensioners
from tests.unit.model.test_carrying import conveyor

RADIUS = 0.06
CONTACT = {
    "stiffness": 1e8,
    "damping": 10.0,
    "friction": 0.8,
    "friction_law": "force_slope",
    "creep_rate_factor": 1e5,
}


def loose(**tensioner: float) -> Drive:
    """Three pulleys that turn freely, one of them on a slide."""
    slide = {"kind": "sliding", "pulley": "slide", "direction": [0.0, 1.0], "mass": 0.5, "preload": 400.0, "rate": 2e4}
    centers = {"left": [0.0, 0.0], "right": [0.4, 0.0], "slide": [0.2, 0.25]}
    return Drive(
        belt={
            "width": 0.02,
            "thickness": 2e-3,
            "density": 1200.0,
            "youngs_modulus": 2e9,
            "poissons_ratio": 0.3,
            "installed_tension": 230.0,
        },
        pulley=[{"name": name, "center": at, "radius": RADIUS, "inertia": 2e-3} for name, at in centers.items()],
        tensioner=[slide | tensioner],
        contact=CONTACT,
        simulation={"duration": 1.0, "output_interval": 0.1},
    )


@pytest.fixture(scope="module")
def rest() -> SmallMotions:
    return about_rest(loose(tensioning_friction=5.0))


def test_the_belt_turns_all_pulleys_freely(rest: SmallMotions) -> None:
    free = rest.free
    assert free.shape == (rest.stiffness.shape[0], 1)
    rims = free[rest.bodies[:3], 0]
    np.testing.assert_allclose(RADIUS * rims / free[rest.bodies[-2], 0], 1.0, rtol=0.02)


def test_a_pulley_that_sticks_to_the_belt_is_held(rest: SmallMotions) -> None:
    own = rest.stiffness.diagonal()[rest.bodies[:3]]
    springs = RADIUS**2 * 2.0 * 2e9 * 0.02 * 2e-3 / 0.4
    assert own.min() > 10.0 * springs


def test_a_stuck_tensioner_is_no_unknown(rest: SmallMotions) -> None:
    held = rest.with_stuck(dry_tensioners(prepare(rest.drive)))
    assert held.stiffness.shape[0] == rest.stiffness.shape[0] - 1
    assert held.bodies[-1] == -1
    np.testing.assert_array_equal(held.bodies[:-1], rest.bodies[:-1] - (rest.bodies[:-1] > rest.bodies[-1]))
    assert held.free.shape[1] == 1


def test_hysteresis_is_left_out_at_rest() -> None:
    """Its stress has no tangent at rest: the slope of the smoothed law stopped spans, with 0.97 of critical damping."""
    drive = loose()
    lossy = drive.replace(belt=drive.belt.replace(bending_loss_factor=0.15, stretch_loss_factor=0.1))
    plain, left_out = about_rest(drive), about_rest(lossy)
    scale = abs(plain.damping).max()
    np.testing.assert_allclose(left_out.damping.toarray(), plain.damping.toarray(), atol=1e-9 * scale)


def test_supports_resist_nothing_at_rest() -> None:
    """The resistance of idlers has a sense only while the belt passes."""
    prepared = prepare(conveyor())
    staying, path = staying_system(prepared, prepared.equal_lengths(40)), prepared.path
    laid = laid_state(Laid.on(Path(path.centers, path.radii - 1e-3), prepared.belt_length, 0), staying, np.zeros(0))
    motions = about_standing(Standing(prepared, staying, laid, laid.position, 2e3, 0.01, 1.0))
    assert isinstance(staying.carrying, Carrying)
    assert isinstance(motions.system.carrying, Carrying)
    assert (np.asarray(staying.carrying.supports.resisting) == 1.0).all()
    assert (np.asarray(motions.system.carrying.supports.resisting) == 0.0).all()


def test_dry_tensioners() -> None:
    assert dry_tensioners(prepare(loose())).size == 0
    np.testing.assert_array_equal(dry_tensioners(prepare(loose(yielding_friction=1.0))), [0])


def test_an_open_belt_has_none(drive: Drive) -> None:
    from importlib.resources import files

    import beltdyn as bd

    with pytest.raises(ModelError, match="the belt is open"):
        about_rest(bd.load(str(files("beltdyn") / "examples" / "band_brake.toml")))
