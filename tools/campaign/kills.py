"""Runs that are killed at any time go on to the same results, to the last bit."""

import os
import signal
import time
import warnings
from pathlib import Path
from random import Random

import numpy as np

from beltdyn.results import Run
from beltdyn.transient.checkpoint import CheckpointWarning
from beltdyn.transient.simulate import simulate
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
