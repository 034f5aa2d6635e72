"""Change the sources in small ways, one at a time, and count the changes that a test notices.

    python -m tools.mutation contact results/derived --sample 150

The tests run once to find which of them execute which line, and how long they take; those that fail or take too long
are left out.  Each mutant then meets the tests of its line: those that killed another mutant of the file, then one test
of each function, the quickest first.  A mutant of what runs at import meets the tests of its file, then others.  It is
killed if one of them fails or runs without end.

Kernels run as plain Python in the trials of files that have kernels, so that a change needs no compilation; in those of
all other files they are compiled.  In every file that is tried a function first raises an error: where no test notices
this control, or where a change reaches no function, the run ends with an error.  Needs an operating system that can
fork.
"""

import argparse
import json
import math
import os
import random
import tempfile
from collections import Counter, defaultdict
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict
from functools import partial
from importlib import import_module
from itertools import count
from pathlib import Path
from pkgutil import walk_packages
from types import CodeType

import pytest
from hypothesis import Phase, settings

from tools.mutation.mutants import Mutant, control, has_kernels, mutants_of
from tools.mutation.traces import Trace, left_out, read_traces, traces
from tools.mutation.trial import (
    FAULT,
    MAX_TESTS,
    NOT_IMPORTED,
    ROOT,
    SOURCE,
    Replacements,
    attempt,
    attempt_at_import,
    compiled,
    fits,
    fork,
    functions_of,
    in_session,
    replacements,
)

LIBRARIES = ["matplotlib.pyplot", "numba", "scipy.integrate", "scipy.optimize", "scipy.signal", "scipy.sparse.linalg"]
LIBRARIES += ["pydantic", "xarray", "h5py"]
PATIENCE = 2.5
"""A mutant whose tests take longer than this many times their usual time runs without end."""
NOT_TRIED = {"__main__", "app", "cosimulation"}
"""Programs on top of the package, which are not imported for trials."""
STARTING = 2.0
"""Time to start a session, s."""

Attempt = Callable[[Mutant, CodeType, list[str]], Callable[[], int]]


def main() -> None:
    """Read the command line, run, and print the score of each folder."""
    asked = _parser().parse_args()
    os.chdir(ROOT)
    os.environ.update(MPLBACKEND="Agg", OPENBLAS_NUM_THREADS="1")
    quick = (Phase.explicit, Phase.generate)  # without looking for smaller examples
    settings.register_profile("mutation", derandomize=True, database=None, max_examples=25, phases=quick)
    settings.load_profile("mutation")
    for library in LIBRARIES:
        import_module(library)
    mutants = list(_sample(asked))
    with tempfile.TemporaryDirectory() as folder:
        tempfile.tempdir = folder
        _try_all(mutants, asked)
    asked.out.write_text(json.dumps([asdict(each) for each in mutants], indent=1), encoding="utf-8")
    for folder in asked.folders:
        _print_score(folder, [each for each in mutants if each.file.startswith(f"src/beltdyn/{folder}")])


def _try_all(mutants: list[Mutant], asked: argparse.Namespace) -> None:
    """Try mutants of files with kernels as plain Python, then those of other files with compiled kernels."""
    for kernels_interpreted in (True, False):
        group = [each for each in mutants if has_kernels(ROOT / each.file) is kernels_interpreted]
        if group:
            _interpret_kernels(kernels_interpreted)
            _try_group(group, asked, "plain" if kernels_interpreted else "compiled")


def _mirror(folder: str) -> list[Path]:
    """Tests of a folder, or of a file, by their names."""
    path = Path("tests/unit", folder)
    return [path] if path.is_dir() else sorted(path.parent.glob(f"test_{path.stem}*.py"))


def _interpret_kernels(interpreted: bool) -> None:
    """Let Python run kernels, or Numba compile them, in copies of this process, which has not imported the package."""
    import numba

    numba.config.DISABLE_JIT = int(interpreted)
    os.environ["NUMBA_DISABLE_JIT"] = str(int(interpreted))


def _try_group(mutants: list[Mutant], asked: argparse.Namespace, name: str) -> None:
    """Try mutants in a copy of this process, which imports the package, and note what becomes of them."""
    answers = asked.out.with_suffix(f".{name}.json").absolute()
    kept = asked.out.with_suffix(f".{name}.traces.json").absolute()
    tests = asked.tests or [str(test) for folder in asked.folders for test in _mirror(folder)]

    def session() -> int:
        if not in_session([*tests, "-k", asked.select], lambda items: _try_in_functions(items, mutants, asked, kept)):
            raise SystemExit("The tests cannot be collected.")
        answers.write_text(json.dumps([asdict(each) for each in mutants]), encoding="utf-8")
        return 0

    if os.waitstatus_to_exitcode(os.waitpid(fork(session, math.inf), 0)[1]):
        raise SystemExit(1)
    tried = [Mutant(**each) for each in json.loads(answers.read_text(encoding="utf-8"))]
    answers.unlink()
    for mutant, result in zip(mutants, tried, strict=True):
        mutant.outcome, mutant.killed_by, mutant.at_import = result.outcome, result.killed_by, result.at_import
    _try_at_import(mutants, asked, kept)


def _try_in_functions(items: list[pytest.Item], mutants: list[Mutant], asked: argparse.Namespace, kept: Path) -> None:
    """Try the mutants inside functions, which replace those of the imported modules."""
    items = _spread_cases(items, asked.cases)
    _warm_up(os.environ["NUMBA_DISABLE_JIT"] == "0")
    functions = functions_of({mutant.file for mutant in mutants})
    known = traces(items, asked.folders, asked.slowest, kept)
    print(f"{len(mutants)} mutants, {len(known)} of {len(items)} tests", flush=True)
    for reason, tests in Counter(left_out(kept).values()).items():
        print(f"{tests} left out: {reason}", flush=True)
    by_id = {item.nodeid: item for item in items}
    lines = _tests_of_lines(known)

    def work(mutant: Mutant, code: CodeType, tests: list[str]) -> Callable[[], int]:
        return partial(attempt, altered_by(mutant, code), [by_id[test] for test in tests])

    def altered_by(mutant: Mutant, code: CodeType) -> Replacements:
        altered = replacements(mutant.file, code, functions[mutant.file])
        if not altered:
            raise SystemExit(f"No function has this change: {mutant}")
        return altered

    trials = _Trials(known, asked, work)
    for file in sorted({each.file for each in mutants}):
        error = control(ROOT / file, ROOT, {line for path, line in lines if path == file})
        if error:
            mutant, tree = error
            trials.start(mutant, compile(tree, str(ROOT / file), "exec"), lines[file, mutant.line])
            trials.finish()
            if mutant.outcome != "killed":
                raise SystemExit(f"No test notices the control: {mutant}")
    for mutant, code in compiled([each for each in mutants if not each.at_import]):
        if fits(altered_by(mutant, code)):
            trials.start(mutant, code, lines[mutant.file, mutant.line])
        else:
            mutant.at_import = True
    trials.finish()


def _try_at_import(mutants: list[Mutant], asked: argparse.Namespace, kept: Path) -> None:
    """Try the mutants of what runs at import, with the tests that execute something of their files, then with others.

    What is only read, as the default of a key, leaves no trace.
    """
    known = read_traces(kept)
    files: defaultdict[str, list[str]] = defaultdict(list)
    for test, trace in known.items():
        for file in trace.lines:
            files[file].append(test)
    trials = _Trials(known, asked, lambda mutant, code, tests: partial(attempt_at_import, mutant, code, tests))
    for mutant, code in compiled([each for each in mutants if each.at_import]):
        trials.start(mutant, code, files[mutant.file], known)
    trials.finish()


class _Trials:
    """Tries mutants, some at a time, and notes what becomes of them."""

    def __init__(self, known: dict[str, Trace], asked: argparse.Namespace, work: Attempt) -> None:
        self.known, self.asked, self.work = known, asked, work
        self.running: dict[int, tuple[Mutant, list[str]]] = {}
        self.kills: defaultdict[str, Counter[str]] = defaultdict(Counter)

    def start(self, mutant: Mutant, code: CodeType, candidates: Iterable[str], others: Iterable[str] = ()) -> None:
        """Begin with a mutant when there is a process left for it; other tests follow the candidates."""
        tests, time = self._within_budget(candidates, others, self.kills[mutant.file])
        if not tests:
            mutant.outcome = "untested"
            print(mutant, flush=True)
            return
        if len(self.running) == self.asked.jobs:
            self._wait()
        process = fork(self.work(mutant, code, tests), PATIENCE * (STARTING + time))
        self.running[process] = mutant, tests

    def finish(self) -> None:
        """Wait for all that is under way."""
        while self.running:
            self._wait()

    def _wait(self) -> None:
        process, status = os.wait()
        mutant, tests = self.running.pop(process)
        number = os.waitstatus_to_exitcode(status)
        if number == FAULT:
            raise SystemExit(f"This tool failed in the trial of {mutant}")
        mutant.outcome = "killed" if number else "survived"
        if number == NOT_IMPORTED:
            mutant.outcome = "untested"
            print(mutant, flush=True)
        elif number > 0:
            mutant.killed_by = tests[number - 1]
            self.kills[mutant.file][mutant.killed_by] += 1
        elif number < 0:
            mutant.killed_by = "time"
        else:
            print(mutant, flush=True)

    def _within_budget(
        self, candidates: Iterable[str], others: Iterable[str], kills: Counter[str]
    ) -> tuple[list[str], float]:
        """The most promising tests that can be run in a time, and the time that they take."""
        places: defaultdict[str, Iterator[int]] = defaultdict(count)
        first = set(candidates)
        turn = {  # of each function first the quickest case, then the second
            test: next(places[test.partition("[")[0]])
            for test in sorted({*first, *others}, key=lambda test: self.known[test].duration)
        }
        chosen: list[str] = []
        time = 0.0
        for test in sorted(
            turn, key=lambda test: (-kills[test], turn[test], test not in first, self.known[test].duration)
        ):
            if time + self.known[test].duration <= self.asked.budget and len(chosen) < MAX_TESTS:
                chosen.append(test)
                time += self.known[test].duration
        return chosen, time


def _spread_cases(items: list[pytest.Item], number: int) -> list[pytest.Item]:
    """Cases of each test function from its first to its last, evenly spread: parameters vary slowly or quickly."""
    cases: defaultdict[str, list[int]] = defaultdict(list)
    for place, item in enumerate(items):
        cases[item.nodeid.partition("[")[0]].append(place)
    chosen = set[int]()
    for places in cases.values():
        kept = min(number, len(places))
        chosen |= {places[round(k * (len(places) - 1) / max(kept - 1, 1))] for k in range(kept)}
    return [items[place] for place in sorted(chosen)]


def _tests_of_lines(known: dict[str, Trace]) -> defaultdict[tuple[str, int], list[str]]:
    """Tests that execute a line of a file."""
    lines: defaultdict[tuple[str, int], list[str]] = defaultdict(list)
    for test, trace in known.items():
        for file, executed in trace.lines.items():
            for line in executed:
                lines[file, line].append(test)
    return lines


def _warm_up(kernels: bool) -> None:
    """Import the package, prepare a drive, and load the usual kernels if they are compiled, once for all copies."""
    import beltdyn
    from beltdyn.system.build import drive_system
    from beltdyn.system.state import laid

    for module in walk_packages(beltdyn.__path__, "beltdyn."):
        if module.name.split(".")[1] not in NOT_TRIED:
            import_module(module.name)
    drive = beltdyn.example("two_pulley")
    prepared = beltdyn.model.prepare(drive)
    laid(drive_system(prepared), prepared.path)
    if kernels:
        beltdyn.simulate(drive.replace(simulation=drive.simulation.replace(duration=1e-3, output_interval=1e-3)))
        beltdyn.steady_state(drive)


def _print_score(folder: str, mutants: list[Mutant]) -> None:
    outcomes = Counter(each.outcome for each in mutants)
    share = 100.0 / max(len(mutants), 1)
    endless = sum(each.killed_by == "time" for each in mutants)
    print(
        f"{folder}: {outcomes['killed']} of {len(mutants)} killed, {share * outcomes['killed']:.1f} %"
        f" ({endless} without end); {outcomes['untested']} untested, {share * outcomes['untested']:.1f} %"
    )


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", help="folders or files below src/beltdyn")
    parser.add_argument("--tests", nargs="+", help="tests that may kill; by default those of the folders in tests/unit")
    parser.add_argument("--select", default="", help="which of these tests, as for pytest -k")
    parser.add_argument("--sample", type=int, help="try that many mutants of each folder, taken at random")
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample")
    parser.add_argument("--jobs", type=int, default=1, help="mutants at a time")
    parser.add_argument("--cases", type=int, default=100, help="cases of each test function that are tried")
    parser.add_argument("--slowest", type=float, default=3.0, help="longest time of a test, s")
    parser.add_argument("--budget", type=float, default=10.0, help="longest time of all tests of a mutant, s")
    parser.add_argument("--out", type=Path, default=Path("mutation.json"), help="file of the answers")
    parser.add_argument(
        "--again", type=Path, help="answers of a former run of these sources, of which the survivors are tried again"
    )
    return parser


def _sample(asked: argparse.Namespace) -> Iterator[Mutant]:
    """The mutants to try."""
    former = json.loads(asked.again.read_text(encoding="utf-8")) if asked.again else []
    survivors = {(each["file"], each["number"]) for each in former if each["outcome"] != "killed"}
    for folder in asked.folders:
        paths = sorted((SOURCE / folder).rglob("*.py")) or [SOURCE / folder]
        changes = [mutant for path in paths for mutant, _ in mutants_of(path, ROOT)]
        if asked.again:
            changes = [each for each in changes if (each.file, each.number) in survivors]
        if asked.sample and asked.sample < len(changes):
            chosen = sorted(random.Random(asked.seed).sample(range(len(changes)), asked.sample))
            changes = [changes[index] for index in chosen]
        yield from changes


if __name__ == "__main__":
    main()
