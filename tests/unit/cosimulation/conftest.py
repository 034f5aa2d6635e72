"""Drives whose runs are short: from the belt as it is laid, the driver speeds up from the beginning; and a host."""

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import fmpy
import pytest
from fmpy import fmi2, fmi3

from beltdyn.model import Drive

Hosts = Callable[[Path], Any]


@pytest.fixture(scope="session")
def short(drive: Drive) -> Drive:
    speed = {"kind": "ramp", "start": 0.0, "end": 0.02, "value": 2.0}
    torque = {"kind": "constant", "value": -0.1}
    return drive.with_({"simulation.duration": 0.03, "pulley[driver].speed": speed, "pulley[driven].torque": torque})


@pytest.fixture(scope="session")
def light(short: Drive) -> Drive:
    """With a driven pulley of next to no inertia: a torque of 1e15 N m lets no step be solved."""
    return short.with_({"pulley[driven].inertia": 1e-9})


class Host:
    """A program that simulates a unit: the calls of either version under one name."""

    def __init__(self, path: Path) -> None:
        self.description = fmpy.read_model_description(str(path))
        self.folder = fmpy.extract(str(path))
        self.references = {one.name: one.valueReference for one in self.description.modelVariables}
        self.logged: list[str] = []
        self.newer = self.description.fmiVersion == "3.0"
        self.unit = (fmi3.FMU3Slave if self.newer else fmi2.FMU2Slave)(
            guid=self.description.guid,
            unzipDirectory=self.folder,
            modelIdentifier=self.description.coSimulation.modelIdentifier,
            instanceName=path.stem,
        )
        if self.newer:
            self.unit.instantiate(loggingOn=True, logMessage=fmi3.fmi3LogMessageCallback(self._log_3))
        else:
            callbacks = fmi2.fmi2CallbackFunctions()
            callbacks.logger = fmi2.fmi2CallbackLoggerTYPE(self._log_2)
            callbacks.allocateMemory = fmi2.fmi2CallbackAllocateMemoryTYPE(fmpy.calloc)
            callbacks.freeMemory = fmi2.fmi2CallbackFreeMemoryTYPE(fmpy.free)
            self.unit.instantiate(callbacks=callbacks, loggingOn=True)

    def _log_2(self, _: Any, name: bytes, status: int, category: bytes, message: bytes) -> None:
        self.logged.append(message.decode())

    def _log_3(self, _: Any, status: int, category: bytes, message: bytes) -> None:
        self.logged.append(message.decode())

    def begin(self, start: float = 0.0, tolerance: float | None = None, **limits: float) -> "Host":
        if self.newer:
            self.unit.enterInitializationMode(startTime=start, tolerance=tolerance, **limits)
        else:
            self.unit.setupExperiment(startTime=start, tolerance=tolerance, **limits)
            self.unit.enterInitializationMode()
        self.unit.exitInitializationMode()
        return self

    def put(self, name: str, value: float) -> None:
        (self.unit.setFloat64 if self.newer else self.unit.setReal)([self.references[name]], [value])

    def get(self, name: str) -> float:
        (value,) = (self.unit.getFloat64 if self.newer else self.unit.getReal)([self.references[name]])
        return float(value)

    def step(self, number: int, size: float = 1e-3, start: float = 0.0) -> None:
        self.unit.doStep(start + number * size, size)

    def outputs(self) -> dict[str, float]:
        return {one.name: self.get(one.name) for one in self.description.modelVariables if one.causality == "output"}

    def save(self) -> Any:
        return self.unit.getFMUState() if self.newer else self.unit.getFMUstate()

    def restore(self, state: Any) -> None:
        (self.unit.setFMUState if self.newer else self.unit.setFMUstate)(state)

    def to_bytes(self, state: Any) -> bytes:
        write = self.unit.serializeFMUState if self.newer else self.unit.serializeFMUstate
        return bytes(write(state))

    def from_bytes(self, data: bytes) -> Any:
        read = self.unit.deserializeFMUState if self.newer else self.unit.deSerializeFMUstate
        return read(data)


@pytest.fixture
def host() -> Iterator[Hosts]:
    made: list[Host] = []

    def make(path: Path) -> Host:
        made.append(Host(path))
        return made[-1]

    yield make
    for one in made:
        one.unit.freeInstance()
