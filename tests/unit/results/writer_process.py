"""Write outputs without end, each filled with its number; the test kills this process.

It pauses between writes for a fifth of the time that a simulation computes between two of its own.
"""

import sys
import time
from pathlib import Path

import numpy as np

from beltdyn.results import FileRecorder, Layout
from beltdyn.results.schema import TIMES

PERIOD = 100
PAUSE = 0.05


def write(path: Path, outputs: int) -> None:
    layout = Layout(("a", "b"), ("a-b", "b-a"), np.arange(20.0), np.arange(20.0), np.arange(100.0), ("r_x", "r_y"))
    recorder = FileRecorder(path, layout, {"drive": ""})
    start = 0
    while True:
        numbers = np.arange(start, start + outputs) % PERIOD
        chunk = {}
        for name, variable in layout.recorded.items():
            shape = layout.shape(variable, outputs)
            chunk[name] = np.broadcast_to(numbers.reshape(-1, *(1,) * (len(shape) - 1)), shape)
        for name in TIMES:
            chunk[name] = np.arange(start, start + outputs)
        recorder.append(chunk)
        if not start:
            sys.stdout.write("ready\n")
            sys.stdout.flush()
        time.sleep(PAUSE)
        start += outputs


if __name__ == "__main__":
    write(Path(sys.argv[1]), int(sys.argv[2]))
