"""What is seen in a nip: its width and tensions at its ends are those of the state, its forces those on the hub."""

import numpy as np
import pytest

import beltdyn as bd
from tests.unit.model.test_nip import pressed


@pytest.fixture(scope="module")
def run() -> bd.Run:
    return bd.steady_state(pressed())


def test_the_forces_at_points_add_up_to_that_on_the_hub(run: bd.Run) -> None:
    last, nip = run.dataset.isel(time=-1, field_time=-1), bd.derived.nips(run).isel(nip=0)
    assert float(np.hypot(*last.hub_force.sel(pulley="press"))) == pytest.approx(2000.0, rel=1e-5)
    along = last.belt_coordinate.values
    normal = last.nip_normal_force.values[0]
    assert float(np.trapezoid(normal, along)) == pytest.approx(2000.0, rel=5e-3)
    assert np.ptp(along[normal > 0.0]) == pytest.approx(float(nip.width), rel=0.05)


def test_tensions_at_the_ends_differ_by_the_pulls_in_the_nip(run: bd.Run) -> None:
    """Pulls along the running belt take tension off from behind to before."""
    nip = bd.derived.nips(run).isel(nip=0)
    assert float(nip.tension_before - nip.tension_after) == pytest.approx(float(nip.pull.sum()), rel=0.05)


def test_friction_limits_the_pulls_of_both_sides(run: bd.Run) -> None:
    nip = bd.derived.nips(run).isel(nip=0)
    assert float(nip.grip_limit.sel(side="roller")) == pytest.approx(0.4 * 2000.0, rel=1e-3)
    np.testing.assert_allclose(nip.grip, np.abs(nip.pull) / nip.grip_limit)


def test_a_nip_has_no_span(run: bd.Run) -> None:
    last = run.dataset.isel(time=-1)
    assert last.span.values.tolist() == ["drum-tail", "tail-drum"]
    assert np.isfinite(last.span_tension).all()
    assert np.isfinite(last.mid_span_displacement).all()


def test_a_profile_has_both_faces_from_entry_to_exit(run: bd.Run) -> None:
    profile = bd.derived.nip_profile(run, "press")
    assert profile.face.values.tolist() == ["press", "drum"]
    assert np.all(np.diff(profile.distance) > 0.0)
    assert float(profile.distance.mean()) == pytest.approx(0.0, abs=2e-4)
    friction = 0.4 * profile.pressure
    assert bool((np.abs(profile.shear) <= (1.0 + 1e-6) * friction).all())


def test_the_other_sense_of_rotation_mirrors_a_nip(run: bd.Run) -> None:
    pulleys = [one.replace(speed=-6.6) if one.name == "drum" else one for one in pressed().pulleys]
    pulleys[1] = pulleys[1].replace(torque=30.0)
    other = bd.steady_state(pressed(pulley=pulleys))
    one, two = (bd.derived.nips(each).isel(nip=0) for each in (run, other))
    for name in ("width", "peak_pressure", "tension_before", "tension_after", "speed_ratio"):
        assert float(two[name]) == pytest.approx(float(one[name]), rel=2e-3)
    assert float(two.pull.sel(side="pulley")) == pytest.approx(float(one.pull.sel(side="pulley")), rel=0.05)
    mine, its = (bd.derived.nip_profile(each, "press").sel(face="drum").shear for each in (run, other))
    assert float(its.interp(distance=0.0)) == pytest.approx(float(mine.interp(distance=0.0)), rel=0.05)


def test_figures_have_both_faces(run: bd.Run) -> None:
    ax = bd.plot.nip_pressure(run)
    assert ax.get_xlabel() == "Distance from the line of centers [mm]"
    names = [str(line.get_label()) for line in ax.lines]
    assert names[:4] == ["pressure, press", "shear, press", "pressure, drum", "shear, drum"]


def test_without_nips_there_is_nothing_to_derive() -> None:
    class Without:
        prepared = bd.model.prepare(bd.example("two_pulley"))

    with pytest.raises(bd.ModelError, match="the drive has no nip"):
        bd.derived.nips(Without())  # type: ignore[arg-type]
