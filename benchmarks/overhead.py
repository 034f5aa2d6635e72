"""Cost of a warm `beltdyn simulate` besides integration: a run of ten steps in its own process, kernels on the disk."""

import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from rich.console import Console

from validation.published import better, two_pulley

ROUNDS = 10
COMMAND = "from beltdyn.cli import main; main()"


def processor_time() -> float:
    """Of all child processes so far, user and system, s."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


def main() -> None:
    """Print medians; the first run, which may have to compile, is left out."""
    drive = better(two_pulley(), duration=2e-3)
    elapsed, processor = [], []
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "drive.toml"
        file.write_text(drive.text, encoding="utf-8")
        for _ in range(ROUNDS + 1):
            before, begun = processor_time(), time.perf_counter()
            subprocess.run([sys.executable, "-c", COMMAND, "simulate", file], capture_output=True, check=True)
            elapsed.append(time.perf_counter() - begun)
            processor.append(processor_time() - before)
    clock, cores = (statistics.median(times[1:]) for times in (elapsed, processor))
    Console().print(f"a warm `beltdyn simulate` of a few steps: {clock:.2f} s, {cores:.2f} s of processor time")


if __name__ == "__main__":
    main()
