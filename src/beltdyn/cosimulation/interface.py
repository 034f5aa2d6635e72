"""Inputs and outputs of a drive for a host: names, units and meanings."""

import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple, Self

from beltdyn import __version__
from beltdyn.errors import ModelError
from beltdyn.model import Drive, Pulley, RotaryTensioner
from beltdyn.parts.messages import suggest
from beltdyn.results import RECORDED
from beltdyn.transient.simulator import output_names

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
