"""Damaged files of every kind that is read: each is refused, or gives what it gave before."""

import hashlib
import pickle
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from random import Random

import numpy as np

import beltdyn as bd
from beltdyn.designs.study import study
from beltdyn.model import Drive, ParameterStudy, load
from beltdyn.results import open_result
from beltdyn.solvers.run_progress import Progress
from beltdyn.transient.checkpoint import checkpoint_file, read_checkpoint
from beltdyn.transient.simulate import simulate

_BLOCK = 512


def damaged(data: bytes, random: Random) -> bytes:
    """Flip a bit, cut, or overwrite a block with zeros, noise or another block, as disks and power cuts do."""
    place = random.randrange(len(data))
    block = min(random.choice((16, _BLOCK)), len(data))
    start = random.randrange(len(data) - block + 1)
    kind = random.choice(("bit", "bit", "bit", "bit", "cut", "zeros", "noise", "block", "longer"))
    if kind == "bit":
        return data[:place] + bytes([data[place] ^ 1 << random.randrange(8)]) + data[place + 1 :]
    if kind == "cut":
        return data[:place]
    if kind == "longer":
        return data + random.randbytes(block)
    other = random.randrange(len(data) - block + 1)
    put = {"zeros": bytes(block), "noise": random.randbytes(block), "block": data[other : other + block]}[kind]
    return data[:start] + put + data[start + block :]


@dataclass(frozen=True)
class Kind:
    """A kind of file."""

    name: str
    path: Path
    """Where an intact one is."""
    read: Callable[[Path], str]
    """What a file at its place holds, summed up."""


def two_pulley() -> Drive:
    """A drive whose analyses are short."""
    drive = load(str(files("beltdyn") / "examples" / "two_pulley.toml"))
    return drive.with_({"simulation.duration": 0.05})


def make(folder: Path) -> list[Kind]:
    """Make an intact file of each kind."""
    drive, kinds = two_pulley(), list[Kind]()
    results = {
        "equilibrium": bd.equilibrium(drive),
        "operating_map": bd.operating_map(drive, speed="60, 100 rpm", force_tolerance=0.1),
    }
    simulate(drive, folder / "run.nc")
    kinds.append(Kind("result of a run", folder / "run.nc", _of_result))
    for name, result in results.items():
        result.save(folder / f"{name}.nc")
        kinds.append(Kind(f"result of {name}", folder / f"{name}.nc", _of_result))
    simulate(drive, folder / "stopped.nc", _stop, checkpoint=1e-9)
    kinds.append(Kind("checkpoint", checkpoint_file(folder / "stopped.nc"), _of_checkpoint))
    kinds.append(Kind("result that is gone on with", folder / "stopped.nc", _resumed))
    points = ParameterStudy(
        analysis="equilibrium", number=[{"path": "belt.width", "values": "9, 10 mm"}], results=["tension"]
    )

    def studied(path: Path) -> str:
        found = study(points, drive, jobs=1, output=path.with_suffix(".nc")).dataset[["tension"]]
        return _digest(found.assign_attrs(created=""))  # when it was read

    study(points, drive, jobs=1, output=folder / "study.nc")
    kinds.append(Kind("rows of a study", folder / "study.csv", studied))
    return kinds


def _stop(progress: Progress) -> None:
    if progress.phase == "integrating" and progress.time > 0.02:
        raise KeyboardInterrupt


def _of_result(path: Path) -> str:
    result = open_result(path)
    with result.dataset as dataset:
        return _digest(dataset.load())


def _digest(dataset: object) -> str:
    """All values, names and attributes of a dataset."""
    found = hashlib.sha256()
    for name in sorted(dataset.variables):  # type: ignore[attr-defined]
        values = np.asarray(dataset[name].values)  # type: ignore[index]
        found.update(f"{name} {values.shape} {sorted(dataset[name].attrs.items())}".encode())  # type: ignore[index]
        found.update(values.astype(str).tobytes() if values.dtype == object else values.tobytes())
    found.update(str(sorted((name, str(value)) for name, value in dataset.attrs.items())).encode())  # type: ignore[attr-defined]
    return found.hexdigest()


def _of_checkpoint(path: Path) -> str:
    return hashlib.sha256(pickle.dumps(read_checkpoint(path))).hexdigest()


def _resumed(path: Path) -> str:
    whole = simulate(read_checkpoint(checkpoint_file(path)).drive, path, resume=True)
    return _digest(whole.dataset.drop_attrs().load())


def silent(kind: Kind, seed: int, intact: str, folder: Path) -> str:
    """Damage a file and read it: the fault, if it is read as another one.

    Parameters
    ----------
    kind
        Its kind.
    seed
        The same damage for the same number.
    intact
        What the intact file holds.
    folder
        With the files; it is a copy that may be changed.
    """
    path, random = folder / kind.path.name, Random(seed)
    data = path.read_bytes()
    path.write_bytes(damaged(data, random))
    found = kind.read(path)
    return "" if found == intact else "silently changed"
