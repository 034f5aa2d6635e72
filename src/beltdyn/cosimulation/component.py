"""A drive as a component of a co-simulation, independent of the standard."""

import json
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import nan
from pathlib import Path
from typing import NamedTuple, Self

from beltdyn import __version__
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Pulley, RotaryTensioner, load
from beltdyn.parts.messages import suggest
from beltdyn.results import RECORDED
from beltdyn.solvers.run_progress import Report
from beltdyn.transient.checkpoint import STATE
from beltdyn.transient.packing import ForeignError, Packing
from beltdyn.transient.simulator import Simulator, SimulatorState, output_names

_FILE = "interface.json"

TOLERANCE = "simulation.rtol"
"""The parameter that a host may set before it initializes a drive."""

_SPEED_UNIT, _TORQUE_UNIT, _CENTER_UNIT = "rad/s", "N m", "m"


class Input(NamedTuple):
    """An input of the drive."""

    name: str
    """Its path in the drive file: ``pulley[NAME].speed``, ``pulley[NAME].torque``, or a coordinate of the center,
    ``pulley[NAME].center[1]``."""
    pulley: str
    """Name of the pulley."""
    unit: str
    """rad/s, N m, or m."""
    meaning: str
    """In words."""
    start: float
    """By the drive file at the beginning; zero where it gives no torque."""

    @property
    def is_speed(self) -> bool:
        """Whether it is the speed of a pulley."""
        return self.unit == _SPEED_UNIT

    @property
    def coordinate(self) -> int | None:
        """Which coordinate of the center of a pulley it is, from zero; None of speeds and torques."""
        return int(self.name[-2]) - 1 if self.unit == _CENTER_UNIT else None


class Output(NamedTuple):
    """An output of the drive."""

    name: str
    """That of `Simulator.outputs`."""
    unit: str
    """SI."""
    meaning: str
    """In words."""


class Interface(NamedTuple):
    """The interface of a drive."""

    title: str
    """What the drive is."""
    identifier: str
    """Name of the files of the unit: letters, digits and underscores."""
    begin: float
    """Begin of the run of the drive file, s."""
    end: float
    """End of the run of the drive file, s."""
    interval: float
    """Time between outputs of the drive file, s."""
    tolerance: float
    """``simulation.rtol`` of the drive file."""
    inputs: tuple[Input, ...]
    """Variables that a host sets."""
    outputs: tuple[Output, ...]
    """Variables that a host reads."""
    version: str = __version__
    """That of beltdyn."""

    def write(self, folder: Path) -> Path:
        """Write it into a folder, where `read` finds it."""
        file = folder / _FILE
        file.write_text(json.dumps(self._asdict()), encoding="utf-8")
        return file

    @classmethod
    def read(cls, folder: Path) -> Self:
        """What `write` wrote into a folder."""
        data = json.loads((folder / _FILE).read_text(encoding="utf-8"))
        data["inputs"] = tuple(Input(*one) for one in data["inputs"])
        data["outputs"] = tuple(Output(*one) for one in data["outputs"])
        return cls(**data)


def inputs_of(drive: Drive) -> dict[str, Input]:
    """What can be set of a drive.

    That is the speed of each pulley whose speed is prescribed, the torque of each other one, and the coordinates of
    the center of each pulley that no tensioner with a spring carries.
    """
    made = [_input(pulley, drive.simulation.begin) for pulley in drive.counter_clockwise_pulleys]
    sprung = {one.pulley for one in drive.moving_tensioners}
    made += [
        Input(f"pulley[{one.name}].center[{place}]", one.name, _CENTER_UNIT, f"Center, {axis}: {one.name}", value)
        for one in drive.pulleys
        if one.name not in sprung
        for place, (axis, value) in enumerate(zip("xy", one.center, strict=True), 1)
    ]
    return {one.name: one for one in made}


def _input(pulley: Pulley, begin: float) -> Input:
    """What can be set of a pulley, with its value at the beginning (s)."""
    given = pulley.speed or pulley.torque
    key, unit = ("speed", _SPEED_UNIT) if pulley.prescribed else ("torque", _TORQUE_UNIT)
    meaning = "Prescribed speed of the shaft" if pulley.prescribed else "Torque applied to the shaft"
    start = float(given.at(begin)) if given else 0.0
    return Input(f"pulley[{pulley.name}].{key}", pulley.name, unit, f"{meaning}: {pulley.name}", start)


def choose_inputs(drive: Drive, names: Sequence[str] | None) -> tuple[Input, ...]:
    """The inputs of some names."""
    known = inputs_of(drive)
    if names is None:
        given = {pulley.name for pulley in drive.pulleys if pulley.speed or pulley.torque}
        return tuple(one for one in known.values() if one.pulley in given and one.coordinate is None)
    _require_known("an input", names, known)
    return tuple(known[name] for name in dict.fromkeys(names))


def choose_outputs(drive: Drive, names: Sequence[str] | None) -> tuple[Output, ...]:
    """The outputs of some names."""
    families: dict[str, list[str]] = {}
    for name in output_names(drive):
        families.setdefault(name.partition("[")[0], []).append(name)
    choices = {name: [name] for family in families.values() for name in family} | families
    wanted = list(families) if names is None else names
    _require_known("an output", wanted, choices)
    chosen = dict.fromkeys(name for one in wanted for name in choices[one])
    return tuple(_output(drive, name) for name in chosen)


def _require_known(what: str, names: Sequence[str], known: Iterable[str]) -> None:
    """Make sure that there is what is named."""
    every = list(known)
    for name in names:
        if name not in every:
            remedy = "Give the file with -o" if name.endswith(".fmu") else suggest(name, every)
            raise ModelError(f"{name!r} is not {what} of this drive. {remedy.removesuffix('.')}.".replace("?.", "?"))


def _output(drive: Drive, name: str) -> Output:
    """Unit and meaning of what a simulator gives."""
    family, _, of = name.removesuffix("]").partition("[")
    if family == "hub_load":
        unit, meaning = "N", "Hub load, magnitude"
    else:
        unit, meaning = RECORDED[family].units, RECORDED[family].long_name
    if family == "tensioner_position":
        turns = any(one.pulley == of and isinstance(one, RotaryTensioner) for one in drive.tensioners)
        unit = "rad" if turns else "m"
    return Output(name, unit, f"{meaning}: {of}" if of else meaning)


DRIVE_FILE = "drive.toml"

_ROUNDING = 1e-6
"""Part of a step by which a host may miss an instant: it adds up steps."""

_INSTANT = 1e-9
"""A step that is taken back, s: kernels are compiled by their first use."""


class ComponentState(NamedTuple):
    """Where a component is, from `Component.state`."""

    tolerance: float
    """With which it began."""
    wanted: dict[str, float]
    """Inputs that were set."""
    applied: dict[str, float]
    """Inputs that the drive has taken."""
    offset: float | None
    """Time of the host less that of the drive, s; None before the first step."""
    simulator: SimulatorState | None
    """None before the beginning."""

    def to_bytes(self) -> bytes:
        """All of it, with a checksum and a signature."""
        return _PACKING.pack(self)

    @classmethod
    def from_bytes(cls, data: bytes) -> "ComponentState":
        """The state of some bytes."""
        try:
            found = _PACKING.unpack(data)
        except ForeignError as error:
            raise ModelError(f"the state {error}, or begin the unit anew.") from error
        except ModelError as error:
            raise ModelError(f"the state is damaged ({error}). Give the bytes of a state unchanged.") from error
        if not isinstance(found, cls):
            raise ModelError("the bytes are not a state of a drive. Give the bytes of a state unchanged.")
        return found


_PACKING = Packing((ComponentState, SimulatorState, *STATE))


@dataclass
class Component:
    """A drive in the hands of a host.

    A step that fails changes nothing: the component stays where it was, and can be stepped anew or set back.
    """

    drive: Drive
    interface: Interface
    tolerance: float = field(init=False)
    """Relative tolerance of time steps, to be set before the beginning."""
    stop: float | None = field(init=False, default=None)
    """Instant of the host after which no step may end, s."""

    def __post_init__(self) -> None:
        self.tolerance = self.interface.tolerance
        self._inputs = {one.name: one for one in self.interface.inputs}
        self._wanted: dict[str, float] = {}
        self._applied: dict[str, float] = {}
        self._offset: float | None = None
        self._simulator: Simulator | None = None
        self._outputs: dict[str, float] = {}

    @classmethod
    def read(cls, folder: Path) -> "Component":
        """The component whose drive file and interface are in a folder."""
        return cls(load(folder / DRIVE_FILE), Interface.read(folder))

    def begin(self, progress: Report | None = None) -> None:
        """Find the state at the beginning, and compile what steps need where that is not on the disk yet."""
        self._simulator = None
        simulator = Simulator(self.drive.with_({TOLERANCE: self.tolerance}), progress)
        start = simulator.save()
        simulator.step(simulator.time + _INSTANT)
        simulator.restore(start)
        self._simulator, self._outputs = simulator, simulator.outputs()

    @property
    def time(self) -> float:
        """Time of the host, s; of the drive before the first step."""
        now = self._simulator.time if self._simulator else self.interface.begin
        return now + (self._offset or 0.0)

    def set(self, name: str, value: float) -> None:
        """Set an input for the steps to come."""
        self._wanted[name] = value

    def get(self, name: str) -> float:
        """An input as it was set, or an output; nan before the beginning."""
        if name in self._inputs:
            return self._wanted.get(name, self._inputs[name].start)
        if self._simulator is None:
            return nan
        if not self._outputs:
            self._outputs = self._simulator.outputs()
        return self._outputs[name]

    def step(self, time: float, size: float) -> None:
        """Simulate a step of the host."""
        before = self.state()
        try:
            self._step(time, size)
        except Exception:
            self.restore(before)
            raise

    def _step(self, time: float, size: float) -> None:
        """A step that leaves behind how far it has come if it fails."""
        if self._simulator is None:
            raise ModelError(
                "the drive is not initialized. Initialize the unit before its first step; if that failed, its "
                "error message gives the remedy."
            )
        slack = _ROUNDING * abs(size)
        if self._offset is None:
            self._offset = time - self._simulator.time
        if not abs(time - self.time) <= slack:
            raise ModelError(
                f"a step is requested from t = {time:g} s, but the drive is at t = {self.time:g} s. Continue "
                "from there, or set the state of that instant first."
            )
        if self.stop is not None and time + size > self.stop + slack:
            raise ModelError(
                f"a step would end at t = {time + size:g} s, after the stop time {self.stop:g} s. End it there, "
                "or set a later stop time at initialization."
            )
        self._take_inputs(self._simulator)
        self._outputs = {}
        self._simulator.step(time + size - self._offset)

    def _take_inputs(self, simulator: Simulator) -> None:
        """Hand on inputs that have changed: each change takes new accelerations, and short steps after it."""
        moved = dict[str, list[float]]()
        for name, value in self._wanted.items():
            if value != self._applied.get(name):
                one = self._inputs[name]
                if one.coordinate is None:
                    (simulator.set_speed if one.is_speed else simulator.set_torque)(one.pulley, value)
                else:
                    moved.setdefault(one.pulley, list(simulator.center(one.pulley)))[one.coordinate] = value
                self._applied[name] = value
        for pulley, center in moved.items():
            simulator.set_center(pulley, center)

    def state(self) -> ComponentState:
        """Where it is, to which `restore` goes back; what follows is the same to the last bit."""
        simulator = self._simulator.save() if self._simulator else None
        return ComponentState(self.tolerance, dict(self._wanted), dict(self._applied), self._offset, simulator)

    def restore(self, state: ComponentState) -> None:
        """Go to a state of this component, or of another one of the same drive, in this process or another one."""
        begun = state.simulator is not None
        if begun and (self._simulator is None or self.tolerance != state.tolerance):
            self.tolerance, self._simulator = state.tolerance, None
            self.begin()
        wanted, applied = dict(state.wanted), dict(state.applied)
        if self._simulator is not None and state.simulator is not None:
            self._simulator.restore(state.simulator)
        else:
            self._simulator = None
        self.tolerance, self._offset = state.tolerance, state.offset
        self._wanted, self._applied, self._outputs = wanted, applied, {}
