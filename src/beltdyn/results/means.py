"""Means of pulleys and spans over the end of a run, from plain arrays."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltdyn.model import Drive
from beltdyn.results.mechanics import (
    capstan_margin,
    cells,
    gross_sliding,
    pressing,
    relative_loss,
    rim_speeds,
    sliding_shares,
    sliding_velocity,
    slip,
)
from beltdyn.results.recorded import Recorded, names

FloatArray = NDArray[np.float64]

WINDOW = 0.1
"""Part of the run, at its end, over which values are averaged."""

_INSTANTS = 20
"""Outputs at which contact along the arcs is looked at, at most."""


@dataclass(frozen=True, slots=True)
class PulleySummary:
    """Means of one pulley over the end of a run.

    Attributes
    ----------
    name : str
        Name of the pulley.
    speed : float
        Speed, rad/s, counter-clockwise positive.
    belt_torque : float
        Torque of the belt on the pulley, N m.
    shaft_torque : float
        Torque on the shaft from outside, N m.
    power : float
        Power of that torque into the drive, W.
    slip : float
        Relative speed loss of the rim against the first pulley's,
        ``1 - v_i / v_0`` of the mean rim speeds along the belt; NaN when the first pulley stands still.
    sliding : float
        Part of the slip that is no creep: the belt slides on the whole arc of this pulley or of the first one.
    sliding_speed : float
        Velocity at which the belt slides on the whole arc of this pulley, m/s along the belt; zero as long as it creeps
        somewhere.
    sliding_arc : float
        Angle over which friction is fully used, rad.
    margin : float
        Capstan margin: how many times its load it could transmit before the whole arc slides; infinite without load.
    wrap_angle : float
        Wrap angle, rad.
    hub_load : float
        Magnitude of the mean force of the belt on the pulley, N.
    """

    name: str
    speed: float
    belt_torque: float
    shaft_torque: float
    power: float
    slip: float
    sliding: float
    sliding_speed: float
    sliding_arc: float
    margin: float
    wrap_angle: float
    hub_load: float


@dataclass(frozen=True, slots=True)
class TensionerSummary:
    """Where a tensioner stands over the end of a run.

    Attributes
    ----------
    name : str
        Name of the pulley that it carries.
    rotary : bool
        Whether it turns, so that its positions are angles.
    position, lowest, highest : float
        Mean, least and largest position, m or rad.
    """

    name: str
    rotary: bool
    position: float
    lowest: float
    highest: float


@dataclass(frozen=True, slots=True)
class SpanSummary:
    """One span over the end of a run.

    Attributes
    ----------
    name : str
        Name of the span.
    tension : float
        Mean tension, N.
    lowest, highest : float
        Least and largest tension, N.
    belt_speed : float
        Mean speed of the belt, m/s.
    """

    name: str
    tension: float
    lowest: float
    highest: float
    belt_speed: float


def first_of_window(time: FloatArray) -> int:
    """Number of the first output that means are taken over."""
    return int(np.searchsorted(time, time[-1] - WINDOW * (time[-1] - time[0])))


def pulley_means(recorded: Recorded, drive: Drive) -> tuple[PulleySummary, ...]:
    """Sum up the pulleys over the end of a run.

    Parameters
    ----------
    recorded : Recorded
        What was recorded, with at least one output.
    drive : Drive
        The drive.

    Returns
    -------
    tuple of PulleySummary
        One for each pulley.
    """
    first = first_of_window(np.asarray(recorded["time"]))
    speed, belt_torque, shaft_torque, wrap_angle, hub_force, tension, belt_speed = _means(
        recorded,
        first,
        *("pulley_speed", "pulley_torque", "shaft_torque", "wrap_angle", "hub_force", "span_tension", "belt_speed"),
    )
    power = np.asarray(recorded["shaft_torque"][first:]) * np.asarray(recorded["shaft_speed"][first:])
    rim = rim_speeds(speed, drive)
    gross, share = _sliding(recorded, drive, first)
    columns = (
        speed,
        belt_torque,
        shaft_torque,
        power.mean(axis=0),
        slip(rim),
        relative_loss(gross - gross[:1], rim),
        gross,
        share * wrap_angle,
        capstan_margin(tension, belt_speed, wrap_angle, drive),
        wrap_angle,
        np.hypot(hub_force[:, 0], hub_force[:, 1]),
    )
    return tuple(
        PulleySummary(name, *map(float, row)) for name, *row in zip(names(recorded, "pulley"), *columns, strict=True)
    )


def tensioner_means(recorded: Recorded, drive: Drive) -> tuple[TensionerSummary, ...]:
    """Sum up the tensioners that move over the end of a run.

    Parameters
    ----------
    recorded : Recorded
        What was recorded, with at least one output.
    drive : Drive
        The drive.

    Returns
    -------
    tuple of TensionerSummary
        One for each tensioner that moves.
    """
    moving = [one for one in drive.tensioners if one.kind != "fixed"]
    if not moving:
        return ()
    place = np.asarray(recorded["tensioner_position"][first_of_window(np.asarray(recorded["time"])) :])
    columns = (place.mean(axis=0), place.min(axis=0), place.max(axis=0))
    return tuple(
        TensionerSummary(one.pulley, one.kind == "rotary", *map(float, row))
        for one, *row in zip(moving, *columns, strict=True)
    )


def span_means(recorded: Recorded) -> tuple[SpanSummary, ...]:
    """Sum up the spans over the end of a run.

    Parameters
    ----------
    recorded : Recorded
        What was recorded, with at least one output.

    Returns
    -------
    tuple of SpanSummary
        One for each span.
    """
    first = first_of_window(np.asarray(recorded["time"]))
    tension = np.asarray(recorded["span_tension"][first:])
    (belt_speed,) = _means(recorded, first, "belt_speed")
    columns = (tension.mean(axis=0), tension.min(axis=0), tension.max(axis=0), belt_speed)
    return tuple(
        SpanSummary(name, *map(float, row)) for name, *row in zip(names(recorded, "span"), *columns, strict=True)
    )


def _sliding(recorded: Recorded, drive: Drive, first: int) -> tuple[FloatArray, FloatArray]:
    """Mean velocity at which whole arcs slide, m/s, and mean share of the arcs that slides, shape (pulleys,)."""
    rows = np.unique(np.linspace(first, len(recorded["time"]) - 1, _INSTANTS).round().astype(int))
    touched, normal, velocity = (
        np.asarray(recorded[name][rows]) for name in ("contact_pulley", "normal_force", "slip_velocity")
    )
    sliding = sliding_velocity(velocity, normal, touched, drive)
    pressed = pressing(normal, touched, len(drive.pulleys))
    cell = cells(np.asarray(recorded["belt_coordinate"]), drive.belt.length)
    return gross_sliding(sliding, pressed, drive).mean(axis=0), sliding_shares(sliding, pressed, cell).mean(axis=0)


def _means(recorded: Recorded, first: int, *variables: str) -> list[FloatArray]:
    """Means of variables over the outputs from the first one on."""
    return [np.asarray(recorded[name][first:]).mean(axis=0) for name in variables]
