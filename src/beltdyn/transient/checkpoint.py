"""Checkpoints of a run: its complete state in a file beside the results, for resuming it.

A checkpoint is read by the version that wrote it, on the same kernels: a line that tells of that, and behind it what
`packing` makes of records, arrays and the text of the drive, with a checksum.
"""

import hashlib
import json
import re
import time
import warnings
from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from math import prod
from pathlib import Path
from typing import Any, Literal

import numpy as np

from beltdyn.contact.friction import LAWS as FRICTION_LAWS
from beltdyn.contact.friction import CommonFriction
from beltdyn.contact.law import ContactLaw
from beltdyn.contact.normal import LAWS as NORMAL_LAWS
from beltdyn.contact.surface import PolygonRims, RoundRims, ShapedRims, ToothedRims
from beltdyn.elements import ELEMENTS, Section
from beltdyn.errors import ModelError
from beltdyn.kernel.fingerprint import PACKAGE, source_hash
from beltdyn.kernel.rows import own_labels
from beltdyn.machines.loads.shaft import ShaftLoads
from beltdyn.machines.profiles.functions import Profiles
from beltdyn.model import Drive, Prepared, prepare
from beltdyn.model.drive import drive_of_text
from beltdyn.model.simulation import Instants
from beltdyn.observation.band_limit import BandLimit
from beltdyn.observation.observer import EnergyAccount, Observer, SlipThrough
from beltdyn.observation.recording import Recording
from beltdyn.parts.text_file import open_file
from beltdyn.quadrature import Quadrature
from beltdyn.results.atomic import atomic_path, remove_leftovers, target_of
from beltdyn.results.friction_work import FrictionWork, MaterialWork, WorkSoFar
from beltdyn.signals import uninterrupted
from beltdyn.solvers.flutter import FlutterWatch
from beltdyn.solvers.generalized_alpha import AlphaIntegration, GeneralizedAlpha
from beltdyn.solvers.integrator_state import IntegratorState, Settings, Trial
from beltdyn.solvers.trajectory import Chunk, Statistics, Task
from beltdyn.stretch import LAWS as STRETCH_LAWS
from beltdyn.stretch import CommonStretch
from beltdyn.system.arrays import Bare, BodyForces, Carrying, NoCarriage, Supports, System
from beltdyn.system.frame import ArcMesh, Flowing, FlowingByArcs, Staying, StayingByArcs, Travelling
from beltdyn.system.guide import Guided
from beltdyn.system.meshing import JumpWatch
from beltdyn.system.running_web import RunningWeb
from beltdyn.system.state import State
from beltdyn.system.web import WebEnds

# Objects as bytes and back: JSON, arrays behind it, and a checksum before both

_DIGEST = hashlib.sha256().digest_size
_LENGTH = 8
"""Bytes that tell how long the JSON is."""
_ALIGNED = 16
_NUMBERS = re.compile(r"[<>|][biufc]\d{1,2}")
"""Types of numbers, as NumPy writes them."""
_PLAIN = (type(None), bool, int, float, str)


class Packing:
    """Packs objects of some classes: named tuples, dataclasses, and others whose objects are their attributes."""

    def __init__(self, classes: Iterable[type]) -> None:
        self.classes = {cls.__name__: cls for cls in classes}

    def pack(self, value: Any) -> bytes:
        """Bytes of an object."""
        writer = _Writer(self)
        tree = json.dumps(writer.node(value), separators=(",", ":")).encode()
        content = b"".join([len(tree).to_bytes(_LENGTH, "little"), tree, *writer.arrays])
        return hashlib.sha256(content).digest() + content

    def unpack(self, data: bytes) -> Any:
        """The object of some bytes."""
        digest, content = data[:_DIGEST], memoryview(data)[_DIGEST:]
        if hashlib.sha256(content).digest() != digest:
            raise ModelError("its checksum does not match its content")
        try:
            end = _LENGTH + int.from_bytes(content[:_LENGTH], "little")
            return _Reader(self, content[end:]).value(json.loads(bytes(content[_LENGTH:end])))
        except ModelError:
            raise
        except Exception as error:  # a tree of others may be wrong in any way
            raise ModelError(f"{type(error).__name__}: {error}") from error


class _Writer:
    """Turns objects into a tree of JSON, and collects arrays."""

    def __init__(self, packing: Packing) -> None:
        self._packing = packing
        self.arrays: list[bytes] = []
        self._seen: dict[int, tuple[int, Any]] = {}

    def node(self, value: Any) -> Any:
        if type(value) in _PLAIN:
            return value
        if id(value) in self._seen:
            return {"is": "again", "of": self._seen[id(value)][0]}
        self._seen[id(value)] = len(self._seen), value  # which stays alive, so that no other gets its number
        return self._of_kind(value)

    def _of_kind(self, value: Any) -> dict[str, Any]:
        kind = type(value)
        if kind is list or kind is tuple:
            return {"is": kind.__name__, "of": [self.node(one) for one in value]}
        if kind is dict:
            return {"is": "dict", "of": [[self.node(key), self.node(one)] for key, one in value.items()]}
        if kind is complex:
            return {"is": "complex", "of": [value.real, value.imag]}
        if isinstance(value, np.ndarray):
            return {"is": "rows" if isinstance(value, np.recarray) else "array"} | self._array(value)
        if isinstance(value, np.generic):
            return {"is": "row" if isinstance(value, np.record) else "scalar"} | self._array(np.asarray(value))
        if kind is Drive or kind is Prepared:
            return {"is": kind.__name__.lower(), "of": (value.drive if kind is Prepared else value).text}
        return self._record(value)

    def _record(self, value: Any) -> dict[str, Any]:
        name = type(value).__name__
        if type(value) is not self._packing.classes.get(name):
            raise ModelError(f"{type(value).__module__}.{name} is not among the classes that are kept.")
        if isinstance(value, tuple):
            return {"is": name, "of": [self.node(one) for one in value]}
        state: Any = value.__getstate__()
        return {"is": name, "of": {key: self.node(one) for key, one in state.items()}}

    def _array(self, array: np.ndarray[Any, Any]) -> dict[str, Any]:
        order: Literal["C", "F"] = "F" if array.flags.f_contiguous and not array.flags.c_contiguous else "C"
        self.arrays.append(array.tobytes(order).ljust(_padded(array.nbytes), b"\0"))
        return {"type": _type_node(array.dtype), "shape": array.shape, "order": order}


class _Reader:
    """Makes objects of a tree, in the order in which they were written."""

    def __init__(self, packing: Packing, arrays: memoryview) -> None:
        self._packing, self._arrays, self._place = packing, arrays, 0
        self._made: list[Any] = []

    def value(self, node: Any) -> Any:
        if not isinstance(node, dict):
            if type(node) in _PLAIN:
                return node
            raise ModelError("a list stands where an object should")
        kind, content = node["is"], node.get("of")
        made: Any
        if kind == "again":
            return self._made[int(content or 0)]
        number = len(self._made)
        self._made.append(None)
        self._made[number] = made = self._of_kind(kind, node, content)
        return made

    def _of_kind(self, kind: str, node: dict[str, Any], content: Any) -> Any:
        if kind in ("list", "tuple"):
            items = [self.value(one) for one in content]
            return items if kind == "list" else tuple(items)
        if kind == "dict":
            return {self.value(key): self.value(one) for key, one in content}
        if kind == "complex":
            return complex(*content)
        if kind in ("array", "rows", "row", "scalar"):
            return self._array(kind, node)
        if kind == "drive":
            return drive_of_text(content)
        if kind == "prepared":
            return prepare(drive_of_text(content))
        if kind not in self._packing.classes:
            raise ModelError(f"{kind} has no place in it")
        cls = self._packing.classes[kind]
        if issubclass(cls, tuple):
            return cls(*(self.value(one) for one in content))
        made, state = cls.__new__(cls), {key: self.value(one) for key, one in content.items()}
        if hasattr(made, "__setstate__"):
            made.__setstate__(state)
        else:
            vars(made).update(state)
        return made

    def _array(self, kind: str, node: dict[str, Any]) -> Any:
        dtype, shape, order = _type(node["type"]), tuple(node["shape"]), node["order"]
        size = prod(shape) * dtype.itemsize
        stored = self._arrays[self._place : self._place + size]
        self._place += _padded(size)
        if len(stored) != size or size < 0:
            raise ModelError("an array ends behind its content")
        made = np.ndarray(shape, dtype, bytearray(stored), order=order).copy(order)
        if kind == "array":
            return made
        if kind == "scalar":
            return made[()]
        return made.view(np.recarray) if kind == "rows" else made.reshape(1).view(np.recarray)[0]


def _padded(size: int) -> int:
    """Bytes that an array takes, so that the next one is aligned."""
    return -(-size // _ALIGNED) * _ALIGNED


def _type_node(dtype: np.dtype[Any]) -> Any:
    """A type of numbers or of rows in JSON."""
    if dtype.subdtype is not None:
        base, shape = dtype.subdtype
        return {"base": _type_node(base), "shape": shape}
    if dtype.names is None:
        if not _NUMBERS.fullmatch(dtype.str):
            raise ModelError(f"an array of {dtype} is not among what is kept.")
        return dtype.str
    fields = [dtype.fields[name] for name in dtype.names]  # type: ignore[index]
    return {
        "names": dtype.names,
        "formats": [_type_node(field[0]) for field in fields],
        "offsets": [field[1] for field in fields],
        "itemsize": dtype.itemsize,
        "aligned": dtype.isalignedstruct,
    }


def _type(node: Any) -> np.dtype[Any]:
    """The type of a node."""
    if isinstance(node, str):
        if not _NUMBERS.fullmatch(node):
            raise ModelError(f"an array of {node} has no place in it")
        return np.dtype(node)
    if "base" in node:
        return np.dtype((_type(node["base"]), tuple(node["shape"])))
    layout = {key: node[key] for key in ("names", "offsets", "itemsize")}
    formats = {"formats": [_type(one) for one in node["formats"]]}
    made: np.dtype[Any] = np.dtype(layout | formats, align=bool(node["aligned"]))  # type: ignore[call-overload]
    return made


_HEAD = "beltdyn checkpoint"
_LONGEST_HEAD = 200

STATE = (IntegratorState, Trial, Profiles)
"""What an integration changes as it goes."""

_SYSTEM = (
    *(System, Supports, Section, Quadrature, ContactLaw, RoundRims, ShapedRims, ToothedRims, PolygonRims),
    *(ShaftLoads,),
    *(Travelling, Staying, Flowing, StayingByArcs, FlowingByArcs, ArcMesh, Bare, Carrying, State),
    *(NoCarriage, Guided, RunningWeb, WebEnds),
)
_INTEGRATION = (AlphaIntegration, GeneralizedAlpha, Settings, Task, Statistics, Instants, Chunk, BodyForces)
_RECORDING = (
    Observer,
    FrictionWork,
    WorkSoFar,
    MaterialWork,
    EnergyAccount,
    FlutterWatch,
    BandLimit,
    SlipThrough,
    JumpWatch,
)


class CheckpointWarning(UserWarning):
    """A checkpoint could not be written; the run continues."""


@dataclass(frozen=True)
class Checkpoint:
    """A run on its way."""

    drive: Drive
    """As it was given."""
    integration: AlphaIntegration
    recording: dict[str, Any]
    """From `Recording.keep`."""
    compare_steady: bool


class Keeper:
    """Writes checkpoints of a run, at intervals of computing time (s); none of a run in memory.

    `resumes` if a checkpoint that is there is of this run, and not of an earlier one.
    """

    def __init__(
        self, path: Path | None, every: float, drive: Drive, compare_steady: bool, *, resumes: bool = False
    ) -> None:
        self._path, self._every, self._own = path, every, resumes
        self._drive, self._compare = drive, compare_steady
        self._last = time.perf_counter()
        self._warned = False

    def look(self, recording: Recording, integration: AlphaIntegration) -> None:
        """Write a checkpoint if it is time; what is on its way is complete.

        One of an earlier run is removed as soon as the results of that are replaced. A checkpoint that cannot be
        written is tried again when the next one is due, and the one before stays; the first time a
        `CheckpointWarning` says so.
        """
        if self._path is None:
            return
        with uninterrupted():
            kept = recording.keep() if time.perf_counter() - self._last > self._every else None
            if recording.file is None:
                return
            if not self._own:
                self.remove()
                self._own = True
            if kept is not None:
                self._write(checkpoint_file(self._path), Checkpoint(self._drive, integration, kept, self._compare))
                self._last = time.perf_counter()

    def _write(self, path: Path, point: Checkpoint) -> None:
        """Write a checkpoint, or warn once that it cannot be written."""
        try:
            write_checkpoint(path, point)
        except ModelError as error:
            if self._warned:
                return
            self._warned = True
            since = "the previous checkpoint" if is_checkpoint(path) else "its beginning"
            warnings.warn(
                f"the run continues without this checkpoint: {error} Results are not affected, but if the run "
                f"is interrupted or killed now, it will resume from {since}. Another checkpoint is attempted every "
                f"{self._every:g} s.",
                CheckpointWarning,
                stacklevel=4,
            )

    def remove(self) -> None:
        """Remove the checkpoint, of a run that is complete or of an earlier one."""
        path = None if self._path is None else checkpoint_file(self._path)
        if path is not None:
            remove_leftovers(target_of(path))
            if is_checkpoint(path):
                with suppress(OSError):
                    path.unlink(missing_ok=True)


def checkpoint_file(path: Path) -> Path:
    """The checkpoint of a result file, beside it."""
    return path.with_name(f"{path.stem}.checkpoint")


def write_checkpoint(path: Path, point: Checkpoint) -> None:
    """Write a checkpoint."""
    with atomic_path(path, is_checkpoint) as temporary:
        temporary.write_bytes(f"{_HEAD} {_made_by()}\n".encode() + packing().pack(point))


def read_checkpoint(path: Path) -> Checkpoint:
    """Read a checkpoint."""
    try:
        with open_file(path) as file:
            head, content = file.readline(_LONGEST_HEAD), file.read()
    except ValueError as error:
        raise ModelError(f"{path} is not a checkpoint of a run: {error}. Run the drive again.") from error
    except OSError as error:
        raise ModelError(
            f"the checkpoint {path} does not exist: the run is complete, ended before its first checkpoint, or "
            "is a run-up, which writes no checkpoints. Run the drive again, or start another run where this "
            f"one ended with simulation.start = {{ file = ... }}."
        ) from error
    made_by = head.decode(errors="replace").removeprefix(_HEAD).strip()
    if made_by != _made_by():
        raise ModelError(
            f"{path} was written by another version than this one ({version('beltdyn')}), or with other kinds of your "
            "own, and a run can only be resumed by the same. Use those that started the run, or run the drive again."
        )
    try:
        point = packing().unpack(content)
    except ModelError as error:
        raise ModelError(f"{path} is damaged ({error}). Run the drive again.") from error
    if not isinstance(point, Checkpoint):
        raise ModelError(f"{path} is not a checkpoint of a run. Run the drive again.")
    return point


def is_checkpoint(path: Path) -> bool:
    """Tell whether a file is a checkpoint of beltdyn."""
    with suppress(OSError, ValueError), open_file(path) as file:
        return file.read(len(_HEAD)) == _HEAD.encode()
    return False


def _made_by() -> str:
    """What tells apart versions whose runs go on differently."""
    own = hashlib.sha256(" ".join(sorted(own_labels())).encode()).hexdigest()[:16]
    return " ".join([version("beltdyn"), source_hash(PACKAGE), *([own] if own_labels() else [])])


def packing() -> Packing:
    """With the classes of all laws and elements that are registered."""
    laws = (law.record for laws in (FRICTION_LAWS, NORMAL_LAWS, STRETCH_LAWS) for law in laws.values())
    elements = (kind.element for kind in ELEMENTS.values())
    common = (CommonFriction, CommonStretch)
    return Packing((Checkpoint, *laws, *common, *elements, *STATE, *_SYSTEM, *_INTEGRATION, *_RECORDING))
