"""Settings of a run: duration, outputs, start and integrator."""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from importlib import import_module
from math import floor, inf
from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple, Self

import numpy as np
from pydantic import Discriminator, Field, Tag, ValidationInfo, field_validator, model_validator

from beltdyn.arrays import BoolArray, FloatArray, IntArray
from beltdyn.elements import ANCF, QUINTIC
from beltdyn.kinds import Registry, register
from beltdyn.model.belt import Belt
from beltdyn.model.contact import Contact
from beltdyn.model.toothing import DISCRETE
from beltdyn.parts.kind_fields import NameOf
from beltdyn.parts.messages import apart
from beltdyn.parts.part import Part
from beltdyn.parts.quantity import Force, Length, Ratio, Time

# The state of an earlier run as initial state: its result file, and an instant


class EarlierRun(Part):
    """The state of an earlier run as initial state: positions and velocities of belt and bodies."""

    file: str = Field(description="the result file of the earlier run, relative to the folder of the drive file")
    time: Time | None = Field(
        None,
        ge=0,
        description="the instant of a field output of the earlier run, in s; by default the last one",
    )

    def __str__(self) -> str:
        return self.file if self.time is None else f"{self.file} at {self.time:g} s"

    @field_validator("file", mode="before")
    @classmethod
    def _starts_at_the_drive_file(cls, file: Any, info: ValidationInfo) -> Any:
        """The whole path, with which the drive means the same wherever its text goes."""
        if isinstance(file, Path):
            file = str(file)
        if not isinstance(file, str) or not file.strip() or "\0" in file:
            raise ValueError("must be the path of a result file, as text")
        base = (info.context or {}).get("base")
        return str((base or Path()).absolute() / file)


def _which(given: Any) -> str:
    """What is given, by the name of the part, or the type in JSON."""
    return EarlierRun.__name__ if isinstance(given, Mapping | EarlierRun) else "string"


Start = Annotated[
    Annotated[Literal["equilibrium", "laid", "steady"], Tag("string")] | Annotated[EarlierRun, Tag("EarlierRun")],
    Discriminator(_which),
]
"""The initial state of a run: a name, or an earlier run."""


# Output instants, counted but never listed as a whole

SAME = 1e-11
"""Instants closer than this coincide, s."""


@dataclass(frozen=True)
class Instants:
    """Multiples of an interval from the start, and the end; fields along the belt are kept at some of them."""

    interval: float
    """s."""
    end: float
    """s; a multiple that is nearer to it than a billionth of it is left out."""
    stride: int = 1
    """Number of instants from one at which fields are recorded to the next; the end is one too."""
    begin: float = 0.0
    """The first of them, s."""

    @property
    def count(self) -> int:
        """The number of instants."""
        length = self.end - self.begin
        multiples = int(np.floor(length / self.interval * (1.0 + 1e-12)))
        return multiples + 1 + (length - multiples * self.interval > 1e-9 * self.end)

    @property
    def fields(self) -> int:
        """The number of field outputs."""
        return (self.count - 1) // self.stride + 1 + ((self.count - 1) % self.stride > 0)

    def has_fields(self, numbers: IntArray) -> BoolArray:
        """Whether fields are recorded at instants, by their numbers."""
        return np.asarray((numbers % self.stride == 0) | (numbers == self.count - 1))

    def __getitem__(self, numbers: IntArray) -> FloatArray:
        """Some of them, s, by their numbers."""
        return np.where(numbers < self.count - 1, self.begin + self.interval * numbers, self.end)

    def until(self, time: float) -> int:
        """The number of instants up to a time (s)."""
        return int(self.counts_until(np.array([time]))[0])

    def counts_until(self, times: FloatArray) -> IntArray:
        """The number of instants up to each of several times (s)."""
        multiples = np.floor((times - self.begin + SAME) / self.interval) + 1.0
        before_end = np.clip(multiples, 0.0, self.count - 1.0).astype(np.int64)
        return np.where(times >= self.end - SAME, self.count, before_end)


# The mesh of steady running


class Steady(Part):
    """The mesh of steady running, of maps and of all other analyses based on it.

    Examples
    --------
    >>> bd.Steady(force_tolerance=0.02).force_tolerance
    0.02
    """

    mesh: Literal["auto", "uniform"] = Field(
        "auto",
        description="the mesh: graded towards the ends of arcs and refined by the solution, or `belt.elements` equal "
        "elements, as published",
    )
    force_tolerance: Ratio | None = Field(
        None,
        gt=0,
        lt=1,
        description="the error of contact forces, over the largest force on a pulley, to which the mesh is refined, "
        "below 1; 0.01 by default",
    )

    @model_validator(mode="after")
    def _is_refined_or_not(self) -> Self:
        if self.mesh == "uniform" and self.force_tolerance is not None:
            raise ValueError(
                f'force_tolerance = {self.force_tolerance:g} is incompatible with mesh = "uniform", which is not '
                'refined. Remove it, or set mesh = "auto"'
            )
        return self


# Limits of the results of a drive


class Limits(Part):
    """Limits of results, checked by reports. They do not affect computed results.

    Examples
    --------
    >>> bd.Limits(largest_hub_load="0.8 kN", largest_slip=0.01).largest_hub_load
    800.0
    """

    largest_slip: Ratio | None = Field(
        None, gt=0, lt=1, description="the largest slip of a pulley against the first one, over its speed"
    )
    largest_hub_load: Force | None = Field(None, gt=0, description="the largest hub load at any time, in N")
    largest_tension: Force | None = Field(None, gt=0, description="the largest span tension at any time, in N")
    least_tension: Force | None = Field(None, ge=0, description="the least span tension at any time, in N")
    least_slip_safety: Ratio | None = Field(
        None, gt=0, description="the least slip safety: the factor on all loads at which gross slip begins"
    )
    least_belt_safety: Ratio | None = Field(
        None,
        gt=0,
        description="the least safety factor of a conveyor belt in steady running: strength times width over the "
        "largest tension",
    )
    least_motion_safety: Ratio | None = Field(
        None, gt=0, description="the least safety factor of a conveyor belt in starts and stops"
    )
    largest_tooth_load: Force | None = Field(
        None, gt=0, description="the largest force on a tooth of a toothed belt at any time, in N"
    )
    least_jump_margin: Ratio | None = Field(
        None, gt=0, description="the least margin of a tooth to a jump: what presses it on over what pushes it off"
    )
    largest_carriage_error: Length | None = Field(
        None, gt=0, description="the largest error of position of the carriage of an axis at any time, in m"
    )
    largest_utilization: Ratio | None = Field(
        None, gt=0, description="the largest utilization of a pulley: design power over the rated power of the belt"
    )
    least_cord_life: Time | None = Field(None, gt=0, description="the least life of the cords, such as 5000 h, in s")
    least_rib_life: Time | None = Field(None, gt=0, description="the least life of the ribs, in s")
    service_factor: Ratio | None = Field(
        None, gt=0, le=5, description="the service factor, design power over power, in the utilization; by default 1"
    )

    @model_validator(mode="after")
    def _leave_room(self) -> Self:
        least, largest = self.least_tension, self.largest_tension
        if least is not None and largest is not None and not least < largest:
            raise ValueError(
                f"least_tension = {least:g} N must be below largest_tension = {largest:g} N. Change one of them"
            )
        return self


_MAX_OUTPUTS = 1_000_000
"""Largest number of outputs of a run; more are refused: a safeguard against an interval in a wrong unit."""
_MAX_STEPS = 1_000_000_000
"""Largest number of steps of a run at `max_step`; more would take days of computing time, and are refused."""

_DEFAULT_INTERVAL, _MIN_DEFAULT_OUTPUTS, _MAX_DEFAULT_OUTPUTS = 1e-3, 100, 100_000
"""Default time between outputs, s, and the least and largest number of outputs that it leads to."""
_FIELDS = 100
"""Approximate number of field outputs without a given interval."""


# The time integrators that a drive may name


class IntegratorKind(NamedTuple):
    """A time integrator, for `register`."""

    name: str
    """Its name in a drive file."""
    make: str | Callable[["Simulation"], Any]
    """From the settings of a run an object of the protocol `Integrator`; as "MODULE:FUNCTION" it is imported at its
    first use."""

    def made(self, settings: "Simulation") -> Any:
        """The integrator for the settings of a run."""
        if not isinstance(self.make, str):
            return self.make(settings)
        module, _, function = self.make.partition(":")
        return getattr(import_module(module), function)(settings)


INTEGRATORS = Registry[IntegratorKind]("integrator", IntegratorKind)
"""All integrators by name."""

for _kind in (
    IntegratorKind("generalized_alpha", "beltdyn.transient.simulate:generalized_alpha"),
    *(IntegratorKind(name, "beltdyn.transient.simulate:standard") for name in ("cvode", "ida", "bdf", "radau")),
    # one line each
):
    register(_kind)


_LOOKED_AT = 10.0
"""Time after which machines have usually started, s."""


class Simulation(Part):
    """Settings of a transient simulation, from time zero or a later instant.

    Examples
    --------
    >>> drive.replace(simulation=drive.simulation.replace(duration="200 ms")).simulation.duration
    0.2
    """

    given_duration: Time | None = Field(
        None,
        alias="duration",
        gt=0,
        description="the simulated time, in s; runs over time need it, other analyses look at speeds and loads up to "
        "then, by default 10 s",
    )
    given_interval: Time | None = Field(
        None,
        alias="output_interval",
        gt=0,
        description="the time between two outputs, in s; by default 1 ms, adjusted if needed to give between 100 and "
        "100,000 outputs",
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
    integrator: Annotated[str, NameOf(INTEGRATORS)] = Field("generalized_alpha", description="the time integrator")
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
    def duration(self) -> float:
        """The simulated time, s; without one the time up to which analyses look at what is prescribed."""
        return _LOOKED_AT if self.given_duration is None else self.given_duration

    @property
    def output_interval(self) -> float:
        """The time between two outputs, s, as given or chosen."""
        if self.given_interval is not None:
            return self.given_interval
        return min(max(_DEFAULT_INTERVAL, self.duration / _MAX_DEFAULT_OUTPUTS), self.duration / _MIN_DEFAULT_OUTPUTS)

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
        if self.given_duration is None:
            return self
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
        if self.duration / self.output_interval > _MAX_OUTPUTS:
            raise ValueError(
                f"output_interval = {self.output_interval:g} s requires {self.duration / self.output_interval:.3g} "
                f"outputs; the limit is {_MAX_OUTPUTS:,}. Lengthen the interval"
            )
        if self.max_step is not None and self.duration / self.max_step > _MAX_STEPS:
            raise ValueError(
                f"max_step = {self.max_step:g} s requires at least {self.duration / self.max_step:.3g} time steps; the "
                f"limit is {_MAX_STEPS:,}. Increase it, or omit it: rtol controls the step size"
            )
        return self


# The mesh of runs over time: staying in place, or travelling with the belt

FrameName = Literal["staying", "travelling"]
"""The kind of mesh: staying or travelling."""


class Frame(NamedTuple):
    """The mesh of a run over time."""

    name: FrameName
    reason: str
    """The reason; empty for the default."""

    @property
    def stays(self) -> bool:
        """Whether the belt flows through the mesh."""
        return self.name == "staying"

    @property
    def words(self) -> str:
        """The name and the reason."""
        return f"{self.name}, {self.reason}" if self.reason else self.name


def choose_frame(simulation: Simulation, belt: Belt, contact: Contact, has_ends: bool) -> Frame:
    """Choose the mesh of a run: staying, unless the drive needs features of the travelling mesh."""
    if simulation.frame is not None:
        return Frame(simulation.frame, "as given")
    misfits = [("simulation", *one[:2]) for one in simulation.misfits_staying]
    reasons = [
        *["the belt is open"] * has_ends,
        *[_written("belt.toothing", "law", DISCRETE)] * belt.has_single_teeth,
        *(_written(*one) for one in (*misfits, *element_settings(belt, contact))),
    ]
    return Frame("travelling", f"since {reasons[0]}") if reasons else Frame("staying", "")


def element_settings(belt: Belt, contact: Contact) -> Iterator[tuple[str, str, Any]]:
    """Settings of elements and quadrature without effect on a staying mesh: group, key and value."""
    if belt.other_elements is not None:
        yield "belt", "discretization", belt.other_elements
    for group, part, keys in (
        ("belt", belt, ("integration", "quadrature_points")),
        ("contact", contact, ("sampling", "integration", "quadrature_points")),
    ):
        for key in keys:
            value = getattr(part, key)
            if value != type(part).model_fields[key].default:
                yield group, key, value


def unused_settings(belt: Belt, contact: Contact) -> list[str]:
    """Settings of elements that a staying mesh does not use, such as 'belt.discretization = "truss"'."""
    return [_written(*one) for one in element_settings(belt, contact)]


def element_of(belt: Belt, frame: Frame) -> str:
    """Name of the elements of a belt on a mesh; the arcs of toothed pulleys are short, and few quintics follow them."""
    usual = ANCF if belt.teeth is None else QUINTIC
    return QUINTIC.name if frame.stays else belt.discretization or usual.name


def _written(group: str, key: str, value: Any) -> str:
    """A key and its value, as in a drive file."""
    return f'{group}.{key} = "{value}"' if isinstance(value, str) else f"{group}.{key} = {value}"
