"""The numbers that sum up a run."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from beltdyn.results.recorded import Recorded, names
from beltdyn.results.resolution import Resolution
from beltdyn.results.run import Run

WINDOW = 0.1
"""Part of the run, at its end, over which values are averaged."""


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
    slip : float
        Relative speed loss of the rim against the first pulley's,
        ``1 - (omega_i R_i) / (omega_0 R_0)`` of the mean speeds; NaN when the first pulley stands still.
    wrap_angle : float
        Wrap angle, rad.
    hub_load : float
        Magnitude of the mean force of the belt on the pulley, N.
    """

    name: str
    speed: float
    belt_torque: float
    shaft_torque: float
    slip: float
    wrap_angle: float
    hub_load: float


@dataclass(frozen=True, slots=True)
class SpanSummary:
    """Means of one span over the end of a run.

    Attributes
    ----------
    name : str
        Name of the span.
    tension : float
        Tension, N.
    belt_speed : float
        Speed of the belt, m/s.
    """

    name: str
    tension: float
    belt_speed: float


@dataclass(frozen=True, slots=True)
class Summary:
    """The numbers that sum up a run.

    Means are taken over the outputs of the last 10 % of the recorded time, or over the last
    output when it is the only one there.

    Attributes
    ----------
    status : str
        How the run ended.
    start, end : float
        First and last instant of the outputs that means are taken of, s.
    outputs : int
        Number of recorded outputs.
    pulleys : tuple of PulleySummary
        One for each pulley.
    spans : tuple of SpanSummary
        One for each span.
    resolution : Resolution
        How well the mesh resolves tension and contact.
    energy_closure : float
        Closure error of the energy account at the end, relative to the energy put in.
    integrator : str
        The time integrator; empty when the run's end was not recorded.
    steps, rejected_steps, newton_iterations : int
        The solver's counts; zero when the run's end was not recorded.
    wall_time : float
        Time taken, s, without `compile_time`; NaN when the run's end was not recorded.
    compile_time : float
        Time taken by compilation, s; NaN when the run's end was not recorded.
    real_time_factor : float
        Time taken over simulated time; NaN when the run's end was not recorded.
    warnings : tuple of str
        What a reader of the results has to know.
    """

    status: str
    start: float
    end: float
    outputs: int
    pulleys: tuple[PulleySummary, ...]
    spans: tuple[SpanSummary, ...]
    resolution: Resolution
    energy_closure: float
    integrator: str
    steps: int
    rejected_steps: int
    newton_iterations: int
    wall_time: float
    compile_time: float
    real_time_factor: float
    warnings: tuple[str, ...]


def summarize(run: Run) -> Summary:
    """Sum up a run.

    Parameters
    ----------
    run : Run
        The run, with at least one output.

    Returns
    -------
    Summary
        Its numbers.

    Raises
    ------
    ModelError
        If the run holds no output.
    """
    run.require_output()
    with run.recorded() as recorded:
        return _summarize(run, recorded)


def _summarize(run: Run, recorded: Recorded) -> Summary:
    time = np.asarray(recorded["time"])
    first = int(np.searchsorted(time, time[-1] - WINDOW * (time[-1] - time[0])))
    attributes = recorded.attrs

    def number(name: str, unknown: float) -> float:
        return float(np.squeeze(attributes.get(name, unknown)))  # a file holds arrays of one number

    return Summary(
        status=run.status,
        start=float(time[first]),
        end=float(time[-1]),
        outputs=len(time),
        pulleys=_pulleys(recorded, first, run.drive.path.radii),
        spans=_spans(recorded, first),
        resolution=run.resolution,
        energy_closure=float(recorded["energy_closure"][-1]),
        integrator=str(attributes.get("integrator", "")),
        steps=int(number("steps", 0)),
        rejected_steps=int(number("rejected_steps", 0)),
        newton_iterations=int(number("newton_iterations", 0)),
        wall_time=number("wall_time", np.nan),
        compile_time=number("compile_time", np.nan),
        real_time_factor=number("real_time_factor", np.nan),
        warnings=tuple(run.warnings),
    )


def _pulleys(recorded: Recorded, first: int, radii: NDArray[np.float64]) -> tuple[PulleySummary, ...]:
    speed, belt_torque, shaft_torque, wrap_angle, hub_force = _means(
        recorded, first, "pulley_speed", "pulley_torque", "shaft_torque", "wrap_angle", "hub_force"
    )
    rim_speed = speed * radii
    slip = 1.0 - rim_speed / rim_speed[0] if rim_speed[0] != 0.0 else np.full(len(radii), np.nan)
    hub_load = np.hypot(hub_force[:, 0], hub_force[:, 1])
    columns = (speed, belt_torque, shaft_torque, slip, wrap_angle, hub_load)
    return tuple(
        PulleySummary(name, *map(float, row)) for name, *row in zip(names(recorded, "pulley"), *columns, strict=True)
    )


def _spans(recorded: Recorded, first: int) -> tuple[SpanSummary, ...]:
    tension, belt_speed = _means(recorded, first, "span_tension", "belt_speed")
    return tuple(
        SpanSummary(name, *map(float, row))
        for name, *row in zip(names(recorded, "span"), tension, belt_speed, strict=True)
    )


def _means(recorded: Recorded, first: int, *variables: str) -> list[NDArray[np.float64]]:
    """Means of variables over the outputs from the first one on."""
    return [np.asarray(recorded[name][first:]).mean(axis=0) for name in variables]
