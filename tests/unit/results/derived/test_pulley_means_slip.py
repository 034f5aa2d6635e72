"""Slip and sliding arcs on results made by formulas, in which the belt creeps by 0.5 %."""

from collections.abc import Callable

import numpy as np
import pytest

from beltdyn.results import Run
from beltdyn.results.derived import sliding_arcs, slips

MakeRun = Callable[..., Run]
RIM = 12.0 * 0.08125
WRAP = np.pi


def sliding_on(run: Run, pulley: int, beyond: float) -> np.ndarray:
    """Slip velocities with which the whole arc of a pulley slides by this much beyond creep."""
    dataset, contact = run.dataset, run.drive.contact
    assert contact.creep_rate_factor is not None
    creep = run.drive.frictions[0] * dataset["normal_force"].values / contact.creep_rate_factor
    on = dataset["contact_pulley"].values == pulley
    return np.where(on, np.sign(beyond) * creep + beyond, dataset["slip_velocity"].values)


SINGLE = 2.4e-7
"""Rounding of slip velocities, taken from a result and put into one."""


def test_a_belt_that_creeps_does_not_slide(run: Run) -> None:
    parts, arcs = slips(run, start=0.7), sliding_arcs(run, start=0.7)
    np.testing.assert_allclose(parts["slip"], np.tile([0.0, 0.5], (31, 1)), atol=1e-9)
    np.testing.assert_array_equal(parts["creep"], parts["slip"])
    causes = parts[["elastic_creep", "radial", "bending", "regularization"]].to_dataarray().sum("variable")
    np.testing.assert_allclose(causes, parts["creep"])
    assert not parts["sliding"].any()
    assert not arcs["sliding_arc"].any()
    assert parts["slip"].attrs == {"units": "%", "long_name": "Slip"}


@pytest.mark.parametrize(("pulley", "sign"), [(0, -1.0), (1, 1.0)])
def test_what_slides_on_either_pulley_counts_for_the_driven_one(
    make_run: MakeRun, run: Run, pulley: int, sign: float
) -> None:
    """A belt that is slower than the driver, or faster than the driven rim, by 2 % of the rim's speed."""
    slid = make_run(slip_velocity=sliding_on(run, pulley, sign * 0.02 * RIM))
    parts, arcs = slips(slid, start=0.7), sliding_arcs(slid, start=0.7)
    rolled = run.drive.radii[0] / run.drive.rolling_radii[0]
    np.testing.assert_allclose(parts["sliding"], np.tile([0.0, 2.0 * rolled], (31, 1)), rtol=SINGLE)
    np.testing.assert_allclose(parts["creep"] + parts["sliding"], parts["slip"], rtol=1e-9)
    np.testing.assert_allclose(arcs["sliding_arc"][:, pulley], WRAP)
    assert not arcs["sliding_arc"][:, 1 - pulley].any()


def test_half_of_an_arc(make_run: MakeRun, run: Run) -> None:
    """What slides only where the belt is on the right of the driven pulley's center creeps as a whole."""
    places, center = run.dataset["contact_position"].values, run.drive.pulleys[1].center
    upper = places[..., 1] > center[1]
    velocity = np.where(upper, sliding_on(run, 1, 0.5), run.dataset["slip_velocity"].values)
    slid = make_run(slip_velocity=velocity)
    share = sliding_arcs(slid, start=0.7)["sliding_share"][:, 1]
    np.testing.assert_allclose(share, 0.5, atol=0.03)  # the arc holds 20 points
    assert not slips(slid, start=0.7)["sliding"].any()


def test_slip_of_a_drive_at_rest_is_unknown(run: Run) -> None:
    assert np.isnan(slips(run, end=0.04)["slip"]).all()
    assert np.isnan(slips(run, end=0.04, turns=False)["slip"]).all()


@pytest.mark.parametrize("unit", [1e-3, 1.0, 1e3])
def test_slip_does_not_depend_on_the_unit_of_speed(make_run: MakeRun, run: Run, unit: float) -> None:
    """The drive counts as standing, too, where it does at any other speed: below a hundredth of its largest.

    The belt is so slack that it runs further than it is stretched.
    """
    speed, slack = run.dataset["pulley_speed"].values, 1e-3 * run.dataset["span_tension"].values
    made, scaled = (
        slips(make_run(pulley_speed=factor * speed, span_tension=slack), turns=False)["slip"] for factor in (1.0, unit)
    )
    np.testing.assert_allclose(scaled[60:, 1], 0.5, atol=1e-9)
    np.testing.assert_allclose(scaled, made, rtol=1e-9)


@pytest.mark.parametrize(("ratio", "slip"), [(0.005, 99.5), (500.0, -49900.0)])
def test_the_first_pulley_alone_decides_what_stands(make_run: MakeRun, run: Run, ratio: float, slip: float) -> None:
    """A driven pulley at half a percent of the driver's speed slips by the rest; a racing one hides no slip."""
    speed = run.dataset["pulley_speed"].values.copy()
    speed[:, 1] = ratio * speed[:, 0]
    np.testing.assert_allclose(slips(make_run(pulley_speed=speed), turns=False)["slip"][60:, 1], slip, rtol=1e-9)


@pytest.mark.parametrize(("share", "known"), [(0.009, False), (0.015, True)])
def test_a_drive_stands_below_a_hundredth_of_its_largest_speed(
    make_run: MakeRun, run: Run, share: float, known: bool
) -> None:
    speed = run.dataset["pulley_speed"].values.copy()
    speed[80:] = share * speed[70]
    slack = 1e-3 * run.dataset["span_tension"].values
    slip = slips(make_run(pulley_speed=speed, span_tension=slack), turns=False)["slip"][80:, 1]
    np.testing.assert_allclose(slip, 0.5 if known else np.nan, atol=1e-9)


def test_elastic_creep_is_the_difference_of_stretch(run: Run) -> None:
    """The tight span of 60 N reaches the driver, the slack one of 30 N the driven pulley: 30 N / EA."""
    elastic = slips(run, start=0.7)["elastic_creep"]
    np.testing.assert_allclose(elastic[:, 1], 100.0 * 30.0 / run.drive.belt.axial_stiffness, rtol=0.02)
    assert not elastic[:, 0].any()


def test_slip_of_the_instant_swings_where_its_mean_does_not(make_run: MakeRun, run: Run) -> None:
    speed = run.dataset["pulley_speed"].values.copy()
    speed[60:, 1] *= 1.0 + 0.01 * (-1.0) ** np.arange(41)
    shaken = make_run(pulley_speed=speed)
    assert float(np.ptp(slips(shaken, start=0.8, turns=False)["slip"].values[:, 1])) == pytest.approx(2.0, rel=0.01)
    assert float(np.ptp(slips(shaken, start=0.8)["slip"].values[:, 1])) < 0.2
