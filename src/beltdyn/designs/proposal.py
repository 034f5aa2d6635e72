"""A drive that carries a power: what it has to do, what is proposed, and its drive file."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from math import pi
from pathlib import Path
from typing import NamedTuple

import tomlkit

from beltdyn.model import Drive, loads
from beltdyn.parts.messages import listing
from beltdyn.parts.quantity import RPM

_RIM_DENSITY, _RIM_SHARE = 7200.0, 0.5
"""Of cast iron, kg/m^3, and inertia of a pulley over that of a full disc of its face width: an estimate."""


_NEAREST, _FARTHEST = 0.7, 2.0
"""Usual center distance over the sum of the diameters (GB/T 13575.1)."""


class Task(NamedTuple):
    """What a drive has to do, in SI units."""

    power: float
    speed: float
    """Of the driver, rad/s."""
    driven_speed: float
    service_factor: float
    distances: tuple[float, float] | None
    """Least and largest center distance, m."""
    largest: tuple[float, float]
    """Largest diameters of driver and driven pulley, m."""
    tolerance: float
    """Of the ratio."""
    most_belts: int

    @property
    def design_power(self) -> float:
        """W."""
        return self.power * self.service_factor

    @property
    def ratio(self) -> float:
        """Faster over slower speed."""
        return max(self.speed / self.driven_speed, self.driven_speed / self.speed)

    def distances_for(self, diameters: float) -> tuple[float, float]:
        """Least and largest center distance, m, of pulleys with a sum of diameters, m."""
        return self.distances or (_NEAREST * diameters, _FARTHEST * diameters)

    @property
    def slows(self) -> bool:
        """Whether the driver is the faster, smaller pulley."""
        return self.speed >= self.driven_speed


@dataclass(frozen=True)
class Proposal:
    """A drive that carries the power.

    Examples
    --------
    >>> best = bd.select(power="7.5 kW", speed="1450 rpm", driven_speed="700 rpm", service_factor=1.2)[0]
    >>> best.drive.belt.value_of("profile") == best.profile
    True
    """

    profile: str
    """Name in the catalogue."""
    belts: int
    """Ribs, or V-belts side by side; one toothed belt."""
    driver_diameter: float
    """Diameter of the driver as sold, m."""
    driven_diameter: float
    """Diameter of the driven pulley as sold, m."""
    nominal_length: float
    """Standard length of the belt, m."""
    distance: float
    """Center distance, m."""
    driven_speed: float
    """rad/s, without slip."""
    belt_speed: float
    """m/s."""
    rated_power: float
    """Of all belts, W."""
    utilization: float
    """Design power over rated power."""
    tension: float
    """At rest, of all belts, run in, N; `RUN_IN` times the least one by the formula that requires most."""
    hub_load: float
    """At rest, N."""
    frequency: float
    """First frequency of a span at rest, Hz."""
    face_width: float
    """Ribs times width, the measure of the price, m."""
    task: Task
    catalogue: str | None = None
    teeth: tuple[int, int, int] | None = None
    """Of a toothed belt, its driver and its driven pulley."""
    tensions: Mapping[str, float] = field(default_factory=dict)
    """Tension at rest by the formulas of makers, N."""
    doubt: str = ""
    """What limits the rating, in words."""

    @property
    def text(self) -> str:
        """The drive file."""
        return _drive_file(self)

    @cached_property
    def drive(self) -> Drive:
        """The drive of the file."""
        return loads(self.text)


def _quoted(text: str) -> str:
    """A text as a drive file has it."""
    return tomlkit.string(text).as_string()


def _belt(one: Proposal) -> str:
    """Size and length of the belt."""
    if one.teeth:
        return f'width = "{1e3 * one.face_width:.6g} mm"\nteeth = {one.teeth[0]}'
    return f'ribs = {one.belts}\nnominal_length = "{1e3 * one.nominal_length:.6g} mm"'


def _drive_file(one: Proposal) -> str:
    """The drive file of a proposal."""
    task, radius = one.task, 0.5 * one.driven_diameter
    inertia = _RIM_SHARE * 0.5 * pi * _RIM_DENSITY * max(one.face_width, 0.02) * radius**4
    torque = task.power / one.driven_speed
    teeth, belt = one.teeth or (0, 0, 0), _belt(one)
    sizes = [
        f"teeth = {count}" if count else f'diameter = "{1e3 * diameter:.6g} mm"'
        for count, diameter in zip(teeth[1:], (one.driver_diameter, one.driven_diameter), strict=True)
    ]
    formulas = listing([f"{tension:.4g} N by {name}" for name, tension in one.tensions.items()])
    state = f" {'' if one.teeth else 'of a run-in belt, '}{formulas};" if formulas else ""
    own = "" if one.catalogue is None else f"catalogue = {_quoted(Path(one.catalogue).as_posix())}"
    return f"""\
# {1e-3 * task.power:.4g} kW at {RPM * task.speed:.4g} rpm, {RPM * one.driven_speed:.4g} rpm driven; service factor \
{task.service_factor:.3g}.
# Rated power {1e-3 * one.rated_power:.4g} kW, {one.utilization:.0%} used; belt speed {one.belt_speed:.3g} m/s.
{f"# {one.doubt}" if one.doubt else ""}
[belt]
profile = {_quoted(one.profile)}
{belt}
installed_tension = "{one.tension:.4g} N"      #{state} the take-up of the driven pulley gives it
{own}
[[pulley]]
name = "driver"
center = [0.0, 0.0]
{sizes[0]}
speed = "{RPM * task.speed:.6g} rpm"

[[pulley]]
name = "driven"
center = ["{1e3 * one.distance:.5g} mm", 0.0]
{sizes[1]}
inertia = "{inertia:.3g} kg m^2"               # estimate of the pulley alone
torque = {{ kind = "constant", value = "{-torque:.5g} N m" }}

[[tensioner]]
kind = "fixed"
pulley = "driven"
direction = [1, 0]

[simulation]
duration = 1.0
start = "steady"

[limits]
service_factor = {task.service_factor:.4g}
largest_utilization = 1.0
"""
