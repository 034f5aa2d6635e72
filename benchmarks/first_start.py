"""The first start: what compiling the kernels takes on one core, how much of it is LLVM, and the command on all cores.

Each start has a new folder for machine code. Where LLVM took no time at all, the rest would still be spread over the
cores at best: that is the least that the first start of a process for each core can take.
"""

import argparse
import os
import subprocess
import sys
import time
from importlib.resources import files
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

from beltdyn import load

COMMAND = "from beltdyn.cli import main; main()"
ONE_CORE = """
import os, sys, time
begun = time.process_time()
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, {min(os.sched_getaffinity(0))})
from llvmlite.binding import ffi
spent, call = [0.0], ffi._lib_fn_wrapper.__call__
def timed(self, *arguments):
    start = time.process_time()
    try:
        return call(self, *arguments)
    finally:
        spent[0] += time.process_time() - start
ffi._lib_fn_wrapper.__call__ = timed
import beltdyn
beltdyn.simulate(beltdyn.load(sys.argv[1]))
print(time.process_time() - begun, spent[0])
"""
"""Processor time of a short run with a cold start, and of all calls of LLVM in it, s."""


def main() -> None:
    """Print a row for each drive."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("examples", nargs="*", default=["two_pulley", "alternator_drive"])
    cores = os.cpu_count() or 1
    table = Table(
        "example", "one core s", "of it LLVM s", "the rest s", f"command on {cores} cores s", title="First start"
    )
    for name in parser.parse_args().examples:
        drive = load(str(files("beltdyn") / "examples" / f"{name}.toml"))
        short = drive.replace(simulation=drive.simulation.replace(duration=0.01))
        with TemporaryDirectory() as folder:
            file = Path(folder) / "drive.toml"
            file.write_text(short.text, encoding="utf-8")
            total, llvm = map(float, _started([sys.executable, "-c", ONE_CORE, str(file)], folder, "one").split())
            begun = time.perf_counter()
            _started([sys.executable, "-c", COMMAND, "simulate", str(file)], folder, "all")
            wall = time.perf_counter() - begun
        table.add_row(name, *(f"{value:.1f}" for value in (total, llvm, total - llvm, wall)))
    Console().print(table)


def _started(words: list[str], folder: str, kernels: str) -> str:
    """What a process prints that finds no machine code in a folder of its own."""
    environment = {**os.environ, "BELTDYN_CACHE_DIR": str(Path(folder) / kernels)}
    return subprocess.run(words, env=environment, capture_output=True, text=True, check=True).stdout


if __name__ == "__main__":
    main()
