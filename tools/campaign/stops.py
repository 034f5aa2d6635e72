"""Commands that are told to end, by Ctrl-C or by SIGTERM, at any instant of their start, work and end."""

import os
import re
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from importlib.resources import files
from pathlib import Path
from typing import NamedTuple

from beltdyn.results import open_result

PROGRAM = "import sys; sys.stdout.write('begun\\n'); sys.stdout.flush(); from beltdyn.cli import main; sys.exit(main())"
"""The command as its script starts it, which says when Python has started and the first import begins."""

_LONGEST = 120.0
"""Time on the clock that the end of a command may take beside other work, s."""
_TOLD = "error: interrupted\n", "Interrupted."
"""What a command says on standard error before there are results, and on standard output with them."""

_BAR = re.compile("[━╸╺]|-:--:--")

_DRIVE = files("beltdyn").joinpath("examples", "two_pulley.toml")
_STUDY = """
drive = "drive.toml"
analysis = "equilibrium"
results = ["tension"]
[[number]]
path = "belt.width"
values = "8..12 mm"
steps = 8
"""
COMMANDS = {
    "check": ("check", "drive.toml"),
    "simulate": ("simulate", "drive.toml"),
    "equilibrium of two drives": ("equilibrium", "drive.toml", "other.toml", "-j", "2"),
    "study": ("study", "study.toml", "-j", "2"),
}
"""What is told to end, by name."""


class Ending(NamedTuple):
    """How a command has ended."""

    code: int
    output: str
    errors: str
    seconds: float
    """From its first import to its end."""


def prepare(folder: Path) -> None:
    """Write the files of the commands into a folder."""
    text = _DRIVE.read_text(encoding="utf-8").replace("duration = 1.0", "duration = 0.1")
    for name in ("drive", "other"):
        (folder / f"{name}.toml").write_text(text, encoding="utf-8")
    (folder / "study.toml").write_text(_STUDY, encoding="utf-8")


def run(words: tuple[str, ...], folder: Path, stop: tuple[float, signal.Signals] | None = None) -> Ending:
    """Run a command in a folder; it may be told to end after a time (s).

    SIGINT goes to all processes of the command, as from a terminal, other signals to the first one alone.
    """
    process = subprocess.Popen(
        [sys.executable, "-c", PROGRAM, *words],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    assert process.stdout is not None
    try:
        process.stdout.readline()
        begun = time.perf_counter()
        if stop is not None:
            time.sleep(stop[0])
            with suppress(ProcessLookupError):
                (os.killpg if stop[1] == signal.SIGINT else os.kill)(process.pid, stop[1])
        output, errors = process.communicate(timeout=_LONGEST)
        return Ending(process.returncode, output, errors, time.perf_counter() - begun)
    finally:
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()


def fault_of(ending: Ending, number: signal.Signals) -> str:
    """What is wrong with the end of a command that was told to end, or of one that was faster; empty if nothing is."""
    told = sum((_TOLD[0] in ending.errors, _TOLD[1] in ending.output))
    left = "".join(_lines_of(ending.errors)).replace(_TOLD[0], "", 1)
    if left:
        return f"exit code {ending.code}, and more than a line on standard error: {left[-600:]}"
    if ending.code not in (0, 128 + number):
        return f"exit code {ending.code}"
    if told != (ending.code != 0):
        return f"exit code {ending.code}, and {told} lines that say so"
    return ""


def _lines_of(errors: str) -> list[str]:
    """Lines of standard error but those of bars, which show how far a command was."""
    return [line for line in errors.splitlines(keepends=True) if line.strip() and not _BAR.search(line)]


def leftovers(folder: Path) -> list[str]:
    """Temporary files and locks that nobody holds any more."""
    return sorted(path.name for path in folder.iterdir() if path.name.startswith("."))


def stopped(words: tuple[str, ...], instant: float, number: signal.Signals, folder: Path, again: bool = True) -> str:
    """Tell a command to end after a time (s), and then let it do its work: the fault, if there is one."""
    prepare(folder)
    fault = fault_of(run(words, folder, (instant, number)), number)
    if fault or not again:
        return fault
    if left := leftovers(folder):
        return f"left behind: {', '.join(left)}"
    ending = run(words, folder)
    if ending.code or _lines_of(ending.errors):
        return f"begun again: exit code {ending.code}, {ending.errors[-600:]}"
    for path in folder.glob("*.nc"):
        result = open_result(path)
        with result.dataset:
            if result.status != "completed":
                return f"begun again: {path.name} is {result.status}"
    return ""


def instants(seconds: float, count: int) -> list[tuple[float, signal.Signals]]:
    """Instants of a command that takes some time (s), a little after its end too, with signals in turn."""
    numbers = (signal.SIGINT, signal.SIGTERM)
    return [(1.05 * seconds * (place + 0.5) / count, numbers[place % 2]) for place in range(count)]


def trials(count: int, emptied: Callable[[Path], Path], folder: Path) -> Iterator[tuple[str, Callable[[], str]]]:
    """All commands, each told to end at so many instants: label and trial."""
    for name, words in COMMANDS.items():
        prepare(emptied(folder))
        run(words, folder)  # with kernels compiled
        prepare(emptied(folder))
        seconds = run(words, folder).seconds
        for instant, number in instants(seconds, count):
            yield (
                f"{name}, {number.name} at {instant:.2f} of {seconds:.2f} s",
                lambda words=words, instant=instant, number=number: stopped(words, instant, number, emptied(folder)),  # type: ignore[misc]
            )
