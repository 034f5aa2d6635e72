"""Checkpoints of a run: its complete state in a file beside the results, for resuming it.

A checkpoint is read by the version that wrote it, on the same kernels: a line that tells of that, and behind it what
`packing` makes of records, arrays and the text of the drive, with a checksum and the signature of the user.
"""

import hashlib
import time
import warnings
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path
from typing import Any

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
from beltdyn.model import Drive
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
from beltdyn.transient.packing import ForeignError, Packing

_HEAD = "beltdyn checkpoint"
_LONGEST_HEAD = 200
"""Bytes of the first line that are read, at most: name, version and hashes fit in, and a foreign file without line ends
is not read as one line."""

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
                stacklevel=7,  # where an analysis was called
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
    except ForeignError as error:
        raise ModelError(f"{path} {error}, or run the drive again.") from error
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
