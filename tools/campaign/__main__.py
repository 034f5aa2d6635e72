"""Try beltdyn with random wrong, odd, damaged and hostile input and with kills, and print the figures.

    python -m tools.campaign --seed 1 --mutants 20000 --damaged 2000 --odd 500 --kills 16
    python -m tools.campaign --stops 20 --killed-commands 5 --decoys

The same numbers give the same trials. Ends with 1 if any ended in a traceback, took too long, or was silently changed.
Needs an operating system that can fork.
"""

import argparse
import os
import shutil
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Iterator
from contextlib import suppress
from functools import partial
from importlib.resources import files
from pathlib import Path
from random import Random

os.environ.setdefault("OMP_NUM_THREADS", "1")

from beltdyn.errors import BeltdynError
from beltdyn.model import Drive
from beltdyn.transient.simulate import simulate
from tools.campaign import damage, decoys, hostile, kills, stops
from tools.campaign.analyses import WORKS
from tools.campaign.crossed_examples import crossed
from tools.campaign.drive_mutations import bases
from tools.campaign.mutants import try_mutant
from tools.campaign.odd_drives import odd_drive
from tools.campaign.trial import Outcome, attempt

FAULTS = ("traceback", "died", "fault")
_LONGEST = 10.0
"""Processor time of a trial, s."""
_WAITING = 30.0
"""Time on the clock after which a hostile file counts as one that is waited for, s."""
_PATIENT = 1800.0
"""Time on the clock after which commands in processes of their own count as those that hang, s."""
_SHOWN = 12
"""Faults of a part that are printed."""

Trial = tuple[str, Outcome]


def mutants(seed: int, count: int, folder: Path) -> Iterator[Trial]:
    """Wrong drive files, checked."""
    originals = bases()
    for number in range(seed * 1_000_000, seed * 1_000_000 + count):
        yield f"mutant {number}", try_mutant(number, originals, folder)


def odd(seed: int, count: int, folder: Path) -> Iterator[Trial]:
    """Odd drives, each with all analyses in turn."""
    for name, compiles in WORKS.items():  # before the clock of a trial starts
        with suppress(BeltdynError):
            compiles(_usual(), _emptied(folder / "odd"))
        sys.stderr.write(f"\r{name} is compiled  ")
    names = list(WORKS)
    for number in range(count):
        name = names[number % len(names)]

        def work(number: int = number, name: str = name) -> str:
            drive = odd_drive(seed * 1_000_000 + number // len(names))
            WORKS[name](drive, _emptied(folder / "odd"))
            return ""

        yield f"{name} of drive {seed * 1_000_000 + number // len(names)}", attempt(work, _LONGEST)


def damaged(seed: int, count: int, folder: Path) -> Iterator[Trial]:
    """Damaged files of all kinds in turn."""
    intact = _emptied(folder / "intact")
    kinds = damage.make(intact)
    held = {}
    for kind in kinds:
        shutil.copytree(intact, folder / "copy", dirs_exist_ok=True)
        held[kind] = kind.read(folder / "copy" / kind.path.name)
    for number in range(count):
        kind = kinds[number % len(kinds)]
        shutil.copytree(intact, folder / "copy", dirs_exist_ok=True)
        work = partial(damage.silent, kind, seed * 1_000_000 + number, held[kind], folder / "copy")
        yield f"{kind.name}, damage {seed * 1_000_000 + number}", attempt(work, _LONGEST)


def killed(seed: int, count: int, folder: Path) -> Iterator[Trial]:
    """Runs that are killed and resumed."""
    drive, begun = damage.two_pulley(), time.perf_counter()
    whole, seconds = simulate(drive, checkpoint=1e-9), time.perf_counter() - begun
    for number in range(seed * 1_000_000, seed * 1_000_000 + count):
        work = partial(kills.killed_and_resumed, number, whole, seconds, _emptied(folder / "kills"))
        yield f"kill {number}", attempt(work, 10.0 * _LONGEST)


def hostiles(folder: Path) -> Iterator[Trial]:
    """Hostile files."""
    damage.make(_emptied(folder / "intact"))
    head = (folder / "intact" / "stopped.checkpoint").read_bytes()[:200].partition(b"\n")[0] + b"\n"
    for case in hostile.cases(head):
        yield case[0], attempt(partial(hostile.give, case, _emptied(folder / "hostile")), _LONGEST, _WAITING)


def stopped(count: int, folder: Path) -> Iterator[Trial]:
    """Commands that are told to end, and are begun again."""
    for label, work in stops.trials(count, _emptied, folder / "stops"):
        yield label, attempt(work, _PATIENT, _PATIENT)


def killed_commands(count: int, folder: Path) -> Iterator[Trial]:
    """Commands that are killed, and are begun again."""
    for label, work in kills.trials(count, _emptied, folder / "killed"):
        yield label, attempt(work, _PATIENT, _PATIENT)


def decoyed(folder: Path) -> Iterator[Trial]:
    """Commands in a folder with modules of other names, each with an empty cache of kernels."""
    for route in decoys.ROUTES:
        yield route, attempt(partial(decoys.trial, route, _emptied, folder / "decoys"), _PATIENT, _PATIENT)


def main(words: list[str] | None = None) -> int:
    """Read the command line, try, and print what came of it."""
    asked = _parser().parse_args(words)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        parts: dict[str, Iterator[Trial]] = {}
        if asked.hostile:
            parts["hostile files"] = hostiles(folder)
        parts |= {
            "mutated drive files": mutants(asked.seed, asked.mutants, folder),
            "damaged files": damaged(asked.seed, asked.damaged, folder) if asked.damaged else iter(()),
            "commands told to end": stopped(asked.stops, folder) if asked.stops else iter(()),
            "killed commands": killed_commands(asked.killed_commands, folder) if asked.killed_commands else iter(()),
            "folders of modules": decoyed(folder) if asked.decoys else iter(()),
            "killed and resumed runs": killed(asked.seed, asked.kills, folder) if asked.kills else iter(()),
            "odd drives, analyses": odd(asked.seed, asked.odd, folder) if asked.odd else iter(()),
            "results, consumers": crossed(asked.seed, examples(asked.examples), _emptied(folder / "crossed")),
        }
        ended = [report(name, trials) for name, trials in parts.items()]
        return max(ended)


def report(name: str, trials: Iterator[Trial]) -> int:
    """Print what came of the trials of a part: 1 if something is wrong, or else 0."""
    counts, slowest, total, wrong = Counter[str](), (0.0, "none"), 0.0, list[str]()
    for label, outcome in trials:
        sys.stderr.write(f"\r{label[:70]:70}" if sys.stderr.isatty() else "")
        counts[outcome.kind] += 1
        slowest, total = max(slowest, (outcome.seconds, label)), total + outcome.seconds
        if outcome.kind not in ("fine", "refused"):
            wrong.append(f"{label}: {outcome.kind}: {outcome.text}")
    if not counts:
        return 0
    silent = sum("silent" in one or "differs" in one or "no word" in one for one in wrong)
    print(
        f"{name}: {counts.total()} tried, {counts['fine']} taken, {counts['refused']} refused, "
        f"{sum(counts[kind] for kind in FAULTS) - silent} tracebacks or faults, {silent} silent, "
        f"{counts['too long']} longer than {_LONGEST:g} s; the longest {slowest[0]:.2f} s ({slowest[1]}), "
        f"{total:.0f} s in all",
        flush=True,
    )
    for one in wrong[:_SHOWN]:
        print(f"    {one}", flush=True)
    return int(bool(wrong))


def examples(names: str) -> list[str]:
    """Names of examples, separated by commas, or all."""
    if names == "all":
        return sorted(one.name.removesuffix(".toml") for one in files("beltdyn").joinpath("examples").iterdir())
    return [name.strip() for name in names.split(",") if name.strip()]


def _usual() -> Drive:
    """The first odd drive that is one."""
    for seed in range(1000):
        with suppress(BeltdynError):
            return odd_drive(Random(seed).randrange(10**6))
    raise AssertionError("no odd drive is a drive")


def _emptied(folder: Path) -> Path:
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    return folder


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser("python -m tools.campaign", description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--seed", type=int, default=1, help="other numbers give other trials")
    parser.add_argument("--mutants", type=int, default=1000, help="wrong drive files that are checked")
    parser.add_argument("--damaged", type=int, default=140, help="damaged files")
    parser.add_argument("--odd", type=int, default=51, help="analyses of odd drives")
    parser.add_argument("--kills", type=int, default=4, help="runs that are killed")
    parser.add_argument("--examples", default="", help="examples whose results all consumers read; all for every one")
    parser.add_argument("--stops", type=int, default=0, help="instants at which each of four commands is told to end")
    parser.add_argument("--killed-commands", type=int, default=0, help="instants at which four others are killed")
    parser.add_argument("--decoys", action="store_true", help="try folders of modules, and compile all for each route")
    parser.add_argument("--hostile", action=argparse.BooleanOptionalAction, default=True, help="try hostile files")
    return parser


if __name__ == "__main__":
    sys.exit(main())
