"""Means of pulleys, spans and tensioners over the averaging window of a run."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from beltdyn.arrays import BoolArray, FloatArray
from beltdyn.model import Drive, Prepared
from beltdyn.model.path import span_directions, wrap_angles
from beltdyn.model.rating import PowerRating
from beltdyn.model.toothing import MeshRating
from beltdyn.results.cycles import Window, mean_window
from beltdyn.results.mechanics import SpanTension, rim_speeds
from beltdyn.results.schema import Recorded, names
from beltdyn.results.slip_safety import grip_of, slip_parts, slip_safety_of

_LOADED = 0.01
"""Share of the largest power from which a pulley transmits power; idlers take less by friction."""
ROUNDING = 1e-9
"""Relative, of speeds and diameters at the ends of a rating."""


def rate(
    prepared: Prepared, speeds: FloatArray, powers: FloatArray, centers: FloatArray
) -> PowerRating | MeshRating | None:
    """Rate the belt of a drive; None where its profile has no rating.

    Wrap angles are those of straight spans, as in catalogues. NaN for pulleys on the back of the belt, for which
    catalogues have no rating, and of a toothed belt for those without teeth. Zero outside the rating: beyond its
    largest belt speed, and on pulleys smaller than the smallest one of the profile.
    """
    belt = prepared.drive.rated_belt
    if belt is None:
        return None
    sizes = np.abs(powers)
    loaded = sizes > _LOADED * np.nanmax(sizes, initial=0.0)
    speed = float(abs(speeds[prepared.reference] * prepared.radii[prepared.reference]))
    wraps = wrap_angles(span_directions(centers, *prepared.path.shape), *prepared.path.shape)
    found = belt.on(2.0 * prepared.radii, wraps, speed, loaded)
    fast = speed > belt.rating.largest_speed * (1.0 + ROUNDING)
    found = found.outside(fast | smaller_than_rated(prepared.drive))
    by_teeth = prepared.belt.teeth is not None
    inside = np.array([one.side == "inside" for one in prepared.pulleys])
    return found.on(prepared.toothed if by_teeth else inside)


def smaller_than_rated(drive: Drive) -> BoolArray:
    """Which pulleys are smaller than the smallest one for which the profile of the belt is rated, shape (n,)."""
    least = (drive.belt.smallest_diameter or 0.0) * (1.0 - ROUNDING)
    return np.array([2.0 * one.radius < least for one in drive.pulleys])


def utilization(drive: Drive, rated: FloatArray, powers: FloatArray) -> FloatArray:
    """Design power over rated power at each pulley, with the drive's service factor; inf outside the rating."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.asarray((drive.limits.service_factor or 1.0) * np.abs(powers) / rated)


@dataclass(frozen=True, slots=True)
class PulleySummary:
    """Means of one pulley over the averaging window.

    Examples
    --------
    >>> driver = bd.summarize(run).pulleys[0]
    >>> print(f"{driver.name}: {driver.hub_load:.1f} N")
    driver: 54.8 N
    """

    name: str
    """Name of the pulley."""
    speed: float
    """Speed, rad/s, positive in the sense of `Drive.rotation`, as are the torques."""
    belt_torque: float
    """Torque of the belt on the pulley, N m."""
    shaft_torque: float
    """External torque on the shaft, N m."""
    power: float
    """Power of that torque into the drive, W."""
    slip: float
    """Relative speed loss of the rim against the driver's (`Drive.reference`), ``1 - v_i / v_d`` of the mean rim
    speeds along the belt; NaN when the driver stands still."""
    elastic_creep: float
    """Part of the slip due to elastic creep, as with Coulomb friction."""
    radial: float
    """Part of the slip due to the sinking of the cord into the belt's rubber; zero with slip taken at the rim."""
    bending: float
    """Part of the slip due to the stretch lost in bending and its hysteresis before contact."""
    regularization: float
    """Part of the slip due to the slope of the friction law: the remainder."""
    sliding: float
    """Part of the slip that is gross slip: the belt slides on the whole arc of this pulley or of the driver."""
    sliding_speed: float
    """Sliding speed of the whole arc of this pulley, m/s along the belt; zero while part of it creeps."""
    sliding_arc: float
    """Angle over which friction is fully used, rad."""
    slip_safety: float
    """Factor on all loads of the drive at gross slip of this pulley, if the others hold; NaN without load."""
    own_load_safety: float
    """Factor on the load of this pulley alone at its gross slip; for the driver that on all loads. NaN without load."""
    tension_ratio: float
    """Tension ratio (T1 - m v^2) / (T2 - m v^2), with the larger tension T1; infinite where a span is slack."""
    allowed_tension_ratio: float
    """Tension ratio that friction allows, exp(mu theta); 1 where teeth or guides hold the belt."""
    wrap_angle: float
    """Wrap angle, rad."""
    hub_load: float
    """Magnitude of the mean force of the belt on the pulley, N."""
    rated_power: float
    """Rated power of the belt on the pulley, W; NaN without a rating of its profile, and on the back of the belt."""
    utilization: float
    """Design power over rated power; NaN as above."""

    @property
    def least_safety(self) -> float:
        """The lesser slip safety, by all loads or by the pulley's own; NaN without load."""
        return float(np.fmin(self.slip_safety, self.own_load_safety))


@dataclass(frozen=True, slots=True)
class TensionerSummary:
    """Means of one tensioner over the averaging window.

    Examples
    --------
    >>> slide = {"kind": "sliding", "pulley": "driven", "direction": [1, 0], "mass": 1.0, "preload": 60.0}
    >>> found = bd.summarize(bd.steady_state(drive.replace(tensioner=[slide]))).tensioners[0]
    >>> found.name, found.rotary, round(found.position, 4)  # m, along its direction
    ('driven', False, 0.0002)
    """

    name: str
    """Name of the pulley that it carries."""
    rotary: bool
    """Whether it turns, so that its positions are angles."""
    position: float
    """Mean position, m or rad."""
    lowest: float
    """Minimum position, m or rad."""
    highest: float
    """Maximum position, m or rad."""


@dataclass(frozen=True, slots=True)
class SpanSummary:
    """Means of one span over the averaging window.

    Examples
    --------
    >>> span = bd.summarize(run).spans[0]
    >>> print(f"{span.name}: {span.lowest:.1f} to {span.highest:.1f} N")
    driver-driven: 27.4 to 27.7 N
    """

    name: str
    """Name of the span."""
    tension: float
    """Mean tension over the span and time, N."""
    lowest: float
    """Least tension anywhere along the span at any time, N."""
    highest: float
    """Largest tension anywhere along the span at any time, N."""
    at_start: float
    """Mean tension where the belt leaves the first pulley of the name, N."""
    at_end: float
    """Mean tension where it reaches the second one, N."""
    belt_speed: float
    """Mean speed of the belt, m/s, positive in the sense in which the driver moves it."""


def pulley_means(recorded: Recorded, prepared: Prepared) -> tuple[PulleySummary, ...]:
    """Average the pulleys over the averaging window."""
    window = mean_window(recorded, prepared)
    means = partial(window.mean, recorded)
    belt_torque, shaft_torque, wrap_angle, hub_force, centers = map(
        means, ("pulley_torque", "shaft_torque", "wrap_angle", "hub_force", "pulley_center")
    )
    single = len(window.time) == 1
    speed = means("pulley_speed") if single else window.rate(recorded, "pulley_angle")
    gross, share = map(means, ("sliding_speed", "sliding_share"))
    elapsed = window.end - window.start
    parts = slip_parts(rim_speeds(speed, prepared), SpanTension.of(means), gross, elapsed, prepared)
    power = window.product(recorded, "shaft_torque", "shaft_speed")
    rating = rate(prepared, speed, power, centers)
    rated = np.full(speed.size, np.nan) if rating is None else rating.power
    sense = prepared.drive.positive_sense
    columns = (
        sense * speed,
        sense * belt_torque,
        sense * shaft_torque,
        power,
        *parts,
        gross,
        share * wrap_angle,
        *slip_safety_of(means, prepared),
        *grip_of(means, prepared),
        wrap_angle,
        np.hypot(hub_force[:, 0], hub_force[:, 1]),
        rated,
        utilization(prepared.drive, rated, power),
    )
    return tuple(
        PulleySummary(name, *map(float, row)) for name, *row in zip(names(recorded, "pulley"), *columns, strict=True)
    )


def tensioner_means(
    recorded: Recorded, prepared: Prepared, window: Window | None = None
) -> tuple[TensionerSummary, ...]:
    """Average the moving tensioners over a window."""
    moving = prepared.moving_tensioners
    if not moving:
        return ()
    window = mean_window(recorded, prepared) if window is None else window
    place = np.asarray(recorded["tensioner_position"][window.first :])
    columns = (window.mean(recorded, "tensioner_position"), place.min(axis=0), place.max(axis=0))
    return tuple(
        TensionerSummary(one.pulley, one.turns, *map(float, row)) for one, *row in zip(moving, *columns, strict=True)
    )


def span_means(recorded: Recorded, prepared: Prepared, window: Window | None = None) -> tuple[SpanSummary, ...]:
    """Average the spans over a window."""
    window = mean_window(recorded, prepared) if window is None else window
    start, end, mean = SpanTension.of(partial(window.mean, recorded))
    least, largest = (
        find(np.asarray(recorded[name][window.first :]), axis=0)
        for find, name in ((np.min, "least_span_tension"), (np.max, "largest_span_tension"))
    )
    belt_speed, speed = (window.mean(recorded, name) for name in ("belt_speed", "pulley_speed"))
    backward = speed[prepared.reference] * prepared.pulleys[prepared.reference].turning < 0.0
    columns = (mean, least, largest, start, end, -belt_speed if backward else belt_speed)
    return tuple(
        SpanSummary(name, *map(float, row)) for name, *row in zip(names(recorded, "span"), *columns, strict=True)
    )
