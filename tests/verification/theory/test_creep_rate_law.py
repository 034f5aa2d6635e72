"""A loaded drive with friction in proportion to the slip velocity (Leamy and Wasfy), against its closed form.

M. J. Leamy and T. M. Wasfy, Analysis of belt-drive mechanics using a creep-rate-dependent friction law, J. Appl. Mech.
69 (2002) 763-771: friction is mu x times the normal force, x = v_t / v_c between -1 and 1.  Over the angle phi along
the motion, T* = T - m v^2 grows by dT* = mu T* x dphi, and with it the belt's speed.  As long as the belt creeps, the
speed is linear in T*, x - x0 = a T*, and

    dx/dphi = mu (x - x0) x,    phi = ln(x_b (x_a - x0) / x_a / (x_b - x0)) / -(mu x0),

where x0 belongs to T* = 0; where it slides, T* grows by e^(mu phi).  Each arc turns by the angle of its wrap.  An
element covers 4.5 degrees, over half of which friction changes tension by 1.6 %; slip velocities are compared four
elements away from the ends of the arcs, where contact forces have peaks (docs/verification/closed_forms.md).
"""

from collections.abc import Callable
from math import log, pi
from typing import NamedTuple

import numpy as np
import pytest
import xarray as xr
from scipy.optimize import brentq

from beltdyn import Belt, Contact, Drive, Pulley, Run, Simulation, simulate
from beltdyn.arrays import FloatArray
from beltdyn.machines import CosineRamp
from beltdyn.results import derived
from beltdyn.stretch import Green

pytestmark = pytest.mark.slow

RADIUS, SPEED, LOAD = 0.1, 100.0, 12.0
FRICTION, AXIAL, MASS = 0.4, 1e5, 0.05
LAW = Green(AXIAL)
VELOCITIES = (0.004, 0.01, 0.06)
"""v_c, m/s: the belt slides over most of the arcs, over some of them, nowhere."""
HALF_ELEMENT = 0.039
"""Half of the angle that an element covers, rad."""
LINEAR = 3.0 * LOAD / RADIUS / AXIAL
"""Relative change of the stiffness of Green's law between the spans, which theory takes as constant."""
FROM = 0.5
"""s; means are taken from here."""


class Arc(NamedTuple):
    """Creep of the belt over an arc, x = v_t / v_c as a function of T, linear."""

    begin: float
    end: float
    """x where the belt comes and goes."""
    none: float
    """x0, at T* = 0."""

    @property
    def creeping(self) -> float:
        """Angle over which the belt creeps, rad."""
        last, none = min(max(self.end, -1.0), 1.0), self.none
        return -log(last * (self.begin - none) / (self.begin * (last - none))) / (FRICTION * none)

    @property
    def sliding(self) -> float:
        """Angle over which it slides, rad."""
        last = min(max(self.end, -1.0), 1.0)
        return abs(log((self.end - self.none) / (last - self.none))) / FRICTION

    def at(self, angle: FloatArray) -> FloatArray:
        """Give x by the angle from where the belt comes: x / (x - x0) falls by e^(-mu x0 phi), then x - x0 grows."""
        creeping = np.minimum(angle, self.creeping)
        part = self.begin / (self.begin - self.none) * np.exp(-FRICTION * self.none * creeping)
        x = -self.none * part / (1.0 - part)
        sense = np.sign(self.begin)
        return np.asarray(self.none + (x - self.none) * np.exp(sense * FRICTION * (angle - creeping)))


def arc_between(begin: float, end: float, lifted: float, entering: float, slope: float) -> Arc:
    """The arc on which T goes from `begin` to `end` and x begins with `entering`; `slope` is dx/dT."""
    return Arc(entering, entering + slope * (end - begin), entering + slope * (lifted - begin))


def creep_at_entry(begin: float, end: float, lifted: float, slope: float) -> Arc:
    """The arc that turns by pi."""
    sign = 1.0 if end > begin else -1.0

    def missing(size: float) -> float:
        arc = arc_between(begin, end, lifted, sign * size, slope)
        return arc.creeping + arc.sliding - pi

    return arc_between(begin, end, lifted, sign * float(brentq(missing, 1e-12, 1.0, xtol=1e-15)), slope)


def drive(velocity: float) -> Drive:
    return Drive(
        belt=Belt(
            installed_tension=200.0,
            width=0.02,
            thickness=0.002,
            density=MASS / 4e-5,
            youngs_modulus=AXIAL / 4e-5,
            poissons_ratio=0.3,
            bending_factor=0.01,
            elements=180,
        ),
        pulley=(
            Pulley(
                name="driver",
                center=(0.0, 0.0),
                radius=RADIUS,
                speed=CosineRamp(kind="cosine_ramp", start=0.0, end=0.2, value=SPEED),
            ),
            Pulley(
                name="driven",
                center=(0.4, 0.0),
                radius=RADIUS,
                inertia=0.01,
                torque=CosineRamp(kind="cosine_ramp", start=0.0, end=0.2, value=-LOAD),
            ),
        ),
        contact=Contact(
            stiffness=1e8,
            damping=1e3,
            friction=FRICTION,
            friction_law="coefficient_slope",
            creep_velocity=velocity,
            moment_arm="point",
        ),
        simulation=Simulation(frame="travelling", duration=0.6, output_interval=1e-3, field_interval=1e-3),
    )


@pytest.fixture(scope="module", params=VELOCITIES)
def run(request: pytest.FixtureRequest) -> Run:
    return simulate(drive(request.param))


@pytest.fixture(scope="module")
def mean(run: Run) -> xr.Dataset:
    return run.dataset.sel(time=slice(FROM, None)).mean("time")


@pytest.fixture(scope="module")
def theory(run: Run, mean: xr.Dataset) -> tuple[Arc, Arc, float]:
    """Arcs of driver and driven pulley, and speed of the latter, from the tensions of the simulated spans."""
    slack, tight = (float(value) for value in mean["span_tension"].values)
    velocity = run.drive.contact.creep_velocity
    assert velocity is not None
    g_tight, g_slack = float(LAW.stretch(tight)), float(LAW.stretch(slack))
    passing = SPEED * RADIUS / g_tight
    for _ in range(3):  # the belt is slower than the rim that it runs onto, by its creep there
        slope = passing * (g_tight - g_slack) / (tight - slack) / velocity
        lifted = MASS * passing**2
        driver = creep_at_entry(tight, slack, lifted, slope)
        passing = (SPEED * RADIUS + driver.begin * velocity) / g_tight
    driven = creep_at_entry(slack, tight, lifted, slope)
    return driver, driven, (passing * g_slack - driven.begin * velocity) / RADIUS


def test_loss_of_speed(mean: xr.Dataset, theory: tuple[Arc, Arc, float], measured: Callable[..., None]) -> None:
    loss, expected = SPEED - float(mean["pulley_speed"].sel(pulley="driven")), SPEED - theory[2]
    measured(loss=loss, expected=expected, error=loss / expected - 1.0)
    assert loss == pytest.approx(expected, rel=LINEAR)


def test_slip_velocity_over_the_arcs(
    run: Run, theory: tuple[Arc, Arc, float], measured: Callable[..., None], curve: Callable[..., None]
) -> None:
    velocity = run.drive.contact.creep_velocity
    assert velocity is not None
    angle = np.linspace(0.1 * pi, 0.9 * pi, 17)
    for name, arc in (("driver", theory[0]), ("driven", theory[1])):
        expected = arc.at(angle)
        x = np.mean([_slip_velocity(run, name, angle, time) for time in np.linspace(FROM, 0.6, 41)], axis=0) / velocity
        measured(error=np.abs(x - expected).max(), begin=arc.begin, end=arc.end)
        curve(f"creep_rate_law/{name}", np.rad2deg(angle), x, f"{velocity:g} m/s", "o")
        curve(f"creep_rate_law/{name}", np.rad2deg(angle), expected, "theory", "k-")
        np.testing.assert_allclose(x, expected, atol=FRICTION * HALF_ELEMENT * abs(arc.end))


def _slip_velocity(run: Run, pulley: str, angle: FloatArray, time: float) -> FloatArray:
    """Slip velocity at angles from the inlet, m/s."""
    arc = derived.contact_arc(run, pulley, time)
    return np.asarray(np.interp(angle, arc["angle"].values, arc["slip_velocity"].values))


def test_sliding_arc(run: Run, theory: tuple[Arc, Arc, float], measured: Callable[..., None]) -> None:
    sliding = derived.sliding_arcs(run, start=FROM)["sliding_arc"].mean("time").values
    expected = np.array([theory[0].sliding, theory[1].sliding])
    measured(driver=sliding[0], expected=expected[0], driven=sliding[1], expected_driven=expected[1])
    np.testing.assert_allclose(sliding, expected, atol=HALF_ELEMENT)
