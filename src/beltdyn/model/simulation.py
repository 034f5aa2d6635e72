"""Settings of a run: duration, outputs, start and integrator."""

from math import floor, inf
from typing import Literal, Self

from pydantic import Field, model_validator

from beltdyn.model.earlier_run import EarlierRun, Start
from beltdyn.model.instants import Instants
from beltdyn.parts.messages import apart
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Ratio, Time

_MOST_OUTPUTS = 1_000_000
_MOST_STEPS = 1_000_000_000
"""Steps of some days of computing time."""

_INTERVAL, _FEWEST, _MANY = 1e-3, 100, 100_000
"""Time between outputs, s, and least and largest number of them, unless an interval is given."""
_FIELDS = 100
"""Approximate number of field outputs without a given interval."""


class Simulation(Part):
    """Settings of a transient simulation, from time zero or a later instant.

    Examples
    --------
    >>> drive.replace(simulation=drive.simulation.replace(duration="200 ms")).simulation.duration
    0.2
    """

    duration: Time = Field(gt=0, description="the simulated time, in s")
    given_interval: Time | None = Field(
        None,
        alias="output_interval",
        gt=0,
        description="the time between two outputs, in s; by default 1 ms, or as much longer or shorter as it takes for "
        "100 to 100,000 outputs",
    )
    field_interval: Time | None = Field(
        None,
        gt=0,
        description="the time between two outputs of fields along the belt, in s; by default a hundredth of the "
        "duration",
    )
    frame: Literal["staying", "travelling"] | None = Field(
        None,
        description="the frame of the mesh: staying in place while the belt flows through it, or travelling with the "
        "belt; by default staying, unless the drive needs features of the travelling mesh",
    )
    mesh: Literal["auto", "uniform"] = Field(
        "auto",
        description="the staying mesh: graded towards the ends of arcs, or of `belt.elements` equal elements, as "
        "published",
    )
    force_tolerance: Ratio | None = Field(
        None,
        gt=0,
        lt=1,
        description="the error of contact forces at the start, over the largest force on a pulley, to which the "
        "staying mesh is refined, below 1; by default the mesh has the given or chosen number of elements",
    )
    start: Start = Field(
        "equilibrium",
        description="the initial state: static equilibrium, the belt laid on its path, steady running with the speeds "
        'and loads of that instant, or the state of an earlier run, { file = "run.nc", time = "0.5 s" }',
    )
    start_at: Time | None = Field(
        None,
        ge=0,
        lt=inf,
        description="the time of speeds, torques and schedules at the start of a run from steady running or from an "
        "earlier run, in s; by default 0, or the instant of the earlier run",
    )
    integrator: Literal["generalized_alpha", "cvode", "ida", "bdf", "radau"] = Field(
        "generalized_alpha", description="the time integrator"
    )
    spectral_radius: Ratio = Field(
        0.6, ge=0, le=1, description="the spectral radius of generalized_alpha at infinite frequency, 0 to 1"
    )
    rtol: Ratio = Field(1e-4, gt=0, lt=1, description="the relative tolerance of a time step, below 1")
    max_step: Time | None = Field(None, gt=0, description="the longest time step, in s")
    joint: Literal["shared_node", "multipliers"] = Field(
        "shared_node",
        description="the joint of the belt's ends: a shared node, or Lagrange multipliers",
    )

    @property
    def instants(self) -> Instants:
        """Output instants; fields along the belt are recorded at least as often as requested."""
        wanted = self.duration / _FIELDS if self.field_interval is None else self.field_interval
        stride = max(1, floor(wanted / self.output_interval * (1.0 + 1e-9)))
        return Instants(self.output_interval, self.end, stride, self.begin)

    @property
    def output_interval(self) -> float:
        """The time between two outputs, s, as given or chosen."""
        if self.given_interval is not None:
            return self.given_interval
        return min(max(_INTERVAL, self.duration / _MANY), self.duration / _FEWEST)

    @property
    def begin(self) -> float:
        """The start of the run, s; zero for an earlier run whose last instant is not yet known."""
        if self.start_at is None and isinstance(self.start, EarlierRun):
            return self.start.time or 0.0
        return self.start_at or 0.0

    @property
    def end(self) -> float:
        """The end of the run, s."""
        return self.begin + self.duration

    @model_validator(mode="after")
    def _begins_later_in_motion(self) -> Self:
        if self.start_at and self.start in ("equilibrium", "laid"):
            raise ValueError(
                f'start_at = {self.start_at:g} s is incompatible with start = "{self.start}", a belt at rest. '
                'Set start = "steady", or remove start_at'
            )
        return self

    @property
    def misfits_staying(self) -> list[tuple[str, str, str]]:
        """Settings that need a travelling mesh: key, value, and the value for a staying mesh."""
        settings = (
            ("start", self.start, ("equilibrium", "steady")),
            ("integrator", self.integrator, ("generalized_alpha",)),
            ("joint", self.joint, ("shared_node",)),
        )
        return [
            (key, value, fits[0])
            for key, value, fits in settings
            if not (isinstance(value, EarlierRun) or value in fits)
        ]

    @model_validator(mode="after")
    def _is_refined_or_not(self) -> Self:
        other = 'frame = "travelling"' if self.frame == "travelling" else 'mesh = "uniform"'
        if self.force_tolerance is not None and (self.frame == "travelling" or self.mesh == "uniform"):
            raise ValueError(
                f"force_tolerance = {self.force_tolerance:g} is incompatible with {other}, which is not refined. "
                'Remove it, or set frame = "staying" and mesh = "auto"'
            )
        return self

    @model_validator(mode="after")
    def _fits_the_frame(self) -> Self:
        if self.frame == "staying":
            for key, value, fit in self.misfits_staying:
                raise ValueError(
                    f'{key} = "{value}" is incompatible with frame = "staying". Set {key} = "{fit}", or frame = '
                    '"travelling"'
                )
        return self

    @model_validator(mode="after")
    def _outputs_fit_the_duration(self) -> Self:
        if self.output_interval > self.duration:
            interval, duration = apart(self.output_interval, self.duration)
            raise ValueError(
                f"output_interval = {interval} s is longer than duration = {duration} s. "
                "Shorten the interval, or simulate longer"
            )
        if self.field_interval is not None and self.field_interval < self.output_interval * (1.0 - 1e-9):
            fields, outputs = apart(self.field_interval, self.output_interval)
            raise ValueError(
                f"field_interval = {fields} s is shorter than output_interval = {outputs} s. Lengthen it, or shorten "
                "output_interval"
            )
        if self.duration / self.output_interval > _MOST_OUTPUTS:
            raise ValueError(
                f"output_interval = {self.output_interval:g} s requires {self.duration / self.output_interval:.3g} "
                f"outputs; the limit is {_MOST_OUTPUTS:,}. Lengthen the interval"
            )
        if self.max_step is not None and self.duration / self.max_step > _MOST_STEPS:
            raise ValueError(
                f"max_step = {self.max_step:g} s requires at least {self.duration / self.max_step:.3g} time steps; the "
                f"limit is {_MOST_STEPS:,}. Increase it, or omit it: rtol controls the step size"
            )
        return self
