"""Runs that are killed at any time go on to the same results, to the last bit; commands that are, leave whole files."""

import os
import signal
import time
import warnings
import zipfile
from collections.abc import Callable, Iterator
from pathlib import Path
from random import Random

import numpy as np

from beltdyn.errors import BeltdynError
from beltdyn.model import load
from beltdyn.results import Run, open_result
from beltdyn.transient.checkpoint import CheckpointWarning
from beltdyn.transient.simulate import simulate
from tools.campaign import stops
from tools.campaign.damage import two_pulley

_OFTEN = 1e-9
"""Computing time between two checkpoints, s: one after each chunk of steps."""


def killed_and_resumed(seed: int, whole: Run, seconds: float, folder: Path) -> str:
    """Kill a run once or more, and let it go on: the fault, if it ends otherwise than one that nobody disturbs.

    Parameters
    ----------
    seed
        The same instants for the same number, but for the haste of the machine.
    whole
        The undisturbed run.
    seconds
        How long it takes, s.
    folder
        Where files are written.
    """
    random, path, drive = Random(seed), folder / f"killed{seed}.nc", two_pulley()
    warnings.simplefilter("ignore", CheckpointWarning)  # which says that a run begins anew
    for _ in range(random.choice((1, 1, 2))):
        process = os.fork()
        if process == 0:
            try:
                simulate(drive, path, checkpoint=_OFTEN, resume=True)
            finally:
                os._exit(0)
        time.sleep(seconds * random.random())
        os.kill(process, signal.SIGKILL)
        os.waitpid(process, 0)
    simulate(drive, path, resume=True).dataset.close()
    complete = path.read_bytes()
    found = simulate(drive, path, resume=True)
    if path.read_bytes() != complete:
        return "a complete run was changed"
    for name, variable in whole.dataset.variables.items():
        if not np.array_equal(found.dataset[name].values, variable.values, equal_nan=variable.dtype.kind == "f"):
            return f"{name} differs after a kill"
    return ""


_LOADED = (
    ("length = 1.2727 ", "installed_tension = 600.0 "),
    ('torque = { kind = "cosine_ramp", start = 0.05, end = 0.6, value = 0.0 }', "torque = -3.0"),
)
"""Changes of the example that give it a load to slip under, and a tension to choose."""
_OPTIMUM = """
goal = { result = "hub_load" }
points = { load = "0.5, 1" }
[[number]]
path = "belt.installed_tension"
least = "200 N"
largest = "900 N"
[[requirement]]
result = "slip_safety"
at_least = 20.0
"""
_FIT = """
[[number]]
path = "belt.youngs_modulus"
least = "50 MPa"
largest = "300 MPa"
[[measurement]]
table = "slip.csv"
"""
_SLIPS = "driven torque [N m], pulley_slip[driven] [%]\n-2, 2.17\n-3, 3.26\n-4, 4.34\n"

_RUN_UP = ("--pulley", "driver", "--from", "5 rad/s", "--to", "10 rad/s", "--duration", "0.3", "--settling", "0.1")
COMMANDS = {
    "sweep": ("sweep", "drive.toml", *_RUN_UP),
    "optimize": ("optimize", "drive.toml", "--study", "optimum.toml"),
    "calibrate": ("calibrate", "drive.toml", "--study", "fit.toml"),
    "fmu": ("fmu", "drive.toml"),
}
"""What is killed, by name."""


def prepare(folder: Path) -> None:
    """Write the files of the commands into a folder."""
    stops.prepare(folder)
    text = (folder / "drive.toml").read_text(encoding="utf-8")
    for old, new in _LOADED:
        assert old in text, old
        text = text.replace(old, new)
    for name, content in (("drive", text), ("optimum", _OPTIMUM), ("fit", _FIT)):
        (folder / f"{name}.toml").write_text(content, encoding="utf-8")
    (folder / "slip.csv").write_text(_SLIPS, encoding="utf-8")


def killed_and_repeated(words: tuple[str, ...], instant: float, files: set[str], folder: Path) -> str:
    """Kill a command after a time (s), and then let it do its work, to end with its files alone: the fault, if any."""
    prepare(folder)
    stops.run(words, folder, (instant, signal.SIGKILL))
    if fault := unreadable(folder):
        return f"killed: {fault}"
    ending = stops.run(words, folder)
    if ending.code:
        return f"begun again: exit code {ending.code}, {ending.errors[-600:]}"
    left = {path.name for path in folder.iterdir()} ^ files
    return f"begun again: more or fewer files: {', '.join(sorted(left))}" if left else unreadable(folder, "completed")


def unreadable(folder: Path, status: str = "") -> str:
    """What is wrong with the files of a folder, but hidden ones; results may have to have a status."""
    for path in sorted(folder.iterdir()):
        if path.name.startswith("."):
            continue
        try:
            if path.suffix == ".nc":
                result = open_result(path)
                with result.dataset:
                    if result.status != (status or result.status):
                        return f"{path.name} is {result.status}"
            elif path.suffix == ".toml" and path.name.startswith("drive"):
                load(path)
            elif path.suffix == ".fmu" and zipfile.ZipFile(path).testzip() is not None:
                return f"{path.name} is damaged"
        except (BeltdynError, zipfile.BadZipFile) as error:
            return f"{path.name}: {error}"
    return ""


def trials(count: int, emptied: Callable[[Path], Path], folder: Path) -> Iterator[tuple[str, Callable[[], str]]]:
    """All commands, each killed at so many instants: label and trial."""
    for name, words in COMMANDS.items():
        for _ in range(2):  # first with kernels compiled
            prepare(emptied(folder))
            seconds = stops.run(words, folder).seconds
        files = {path.name for path in folder.iterdir()}
        for instant, _ in stops.instants(seconds, count):
            yield (
                f"{name}, killed at {instant:.2f} of {seconds:.2f} s",
                lambda words=words, instant=instant, files=files: killed_and_repeated(  # type: ignore[misc]
                    words, instant, files, emptied(folder)
                ),
            )
