"""The first commands of a newcomer: with an empty kernel cache, with the kernels of a wheel, and after `compile`.

Processor time includes that of the second process that compiles; without it the time on one core would be the same.
"""

import argparse
import os
import resource
import shutil
import subprocess
import sys
import time
from pathlib import Path
from tempfile import TemporaryDirectory

from rich.console import Console
from rich.table import Table

from beltdyn.kernel import PACKAGE

MAIN = "from beltdyn.cli import main; main()"
COMMANDS = {
    "help": ["--help"],
    "check": ["check", "drive.toml", "--no-equilibrium"],
    "steady-state": ["steady-state", "drive.toml"],
    "simulate": ["simulate", "drive.toml"],
    "modes": ["modes", "drive.toml"],
    "demo": ["demo"],
}


def main() -> None:
    """Print a row for each command."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").split("\n", maxsplit=1)[0])
    parser.add_argument("commands", nargs="*", default=list(COMMANDS), help=", ".join(COMMANDS))
    parser.add_argument("--example", default="alternator_drive")
    given = parser.parse_args()
    table = Table("command", "empty cache s", "processor s", "kernels", "wheel s", "compiled s", title="First start")
    with TemporaryDirectory() as kept, TemporaryDirectory() as installed:
        shutil.copytree(PACKAGE, copied := Path(installed, PACKAGE.name))
        wall, processor = _started(["compile"], Path(kept))
        table.add_row("compile", f"{wall:.1f}", f"{processor:.1f}", str(_kernels(Path(kept))), "", "")
        shutil.copytree(kept, copied / "kernel" / "shipped")  # as `make wheel` has them
        for name in given.commands:
            with TemporaryDirectory() as empty:
                wall, processor = _started(COMMANDS[name], Path(empty), given.example)
                count = _kernels(Path(empty))
            with TemporaryDirectory() as empty:
                wheel, _ = _started(COMMANDS[name], Path(empty), given.example, installed)
            again, _ = _started(COMMANDS[name], Path(kept), given.example)
            table.add_row(name, f"{wall:.1f}", f"{processor:.1f}", str(count), f"{wheel:.1f}", f"{again:.1f}")
    Console().print(table)


def _started(words: list[str], kernels: Path, example: str = "", package: str = "") -> tuple[float, float]:
    """Elapsed and processor time of a command in a new folder, s, of a package elsewhere where one is named."""
    environment = {**os.environ, "BELTDYN_CACHE_DIR": str(kernels)}
    if package:
        environment["PYTHONPATH"] = package
    with TemporaryDirectory() as folder:
        if example:
            new = [sys.executable, "-c", MAIN, "new", "drive.toml", "--example", example]
            subprocess.run(new, cwd=folder, capture_output=True, check=True)
        begun, before = time.perf_counter(), _processor()
        subprocess.run(
            [sys.executable, "-c", MAIN, *words], cwd=folder, env=environment, capture_output=True, check=True
        )
        return time.perf_counter() - begun, _processor() - before


def _processor() -> float:
    """Processor time of the processes started so far, s."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def _kernels(folder: Path) -> int:
    """Number of kernels that Python calls, each compiled with all that it calls."""
    return len(list(folder.rglob("*.kernel")))


if __name__ == "__main__":
    main()
