"""Change the sources in small ways, one at a time, and count the changes that a test notices.

    python -m tools.mutation contact results/derived --tests tests/unit/contact tests/unit/results

Kernels run as plain Python, so that a change needs no compilation.  The tests run once to find which of them execute
which line, and how long they take; those that fail as plain Python or take too long are left out.  Each mutant then
meets the tests of its line, the quickest first; one of what runs at import meets all tests.  It is killed if one of
them fails or runs without end.  Needs an operating system that can fork.
"""

import argparse
import json
import math
import os
import random
from bisect import bisect
from collections import Counter, defaultdict
from collections.abc import Callable, Iterator
from dataclasses import asdict
from functools import partial
from importlib import import_module
from itertools import accumulate
from pathlib import Path
from types import CodeType

import pytest
from hypothesis import Phase, settings

from tools.mutation.mutants import Mutant, mutants_of
from tools.mutation.traces import Trace, read_traces, traces
from tools.mutation.trial import ROOT, SOURCE, attempt, attempt_at_import, compiled, fork, functions_of, in_session

LIBRARIES = ["matplotlib.pyplot", "numba", "scipy.integrate", "scipy.optimize", "scipy.signal", "scipy.sparse.linalg"]
LIBRARIES += ["pydantic", "xarray", "h5py"]
PATIENCE = 2.5
"""A mutant whose tests take longer than this many times their usual time runs without end."""
STARTING = 2.0
"""Time to start a session, s."""


def main() -> None:
    """Read the command line, run, and print the score of each folder."""
    asked = _parser().parse_args()
    os.chdir(ROOT)
    os.environ.update(NUMBA_DISABLE_JIT="1", MPLBACKEND="Agg", OPENBLAS_NUM_THREADS="1")
    quick = (Phase.explicit, Phase.generate)  # without looking for smaller examples
    settings.register_profile("mutation", derandomize=True, database=None, max_examples=25, phases=quick)
    settings.load_profile("mutation")
    for library in LIBRARIES:
        import_module(library)
    answers, kept = asked.out.absolute(), asked.out.with_suffix(".traces.json").absolute()
    _write(answers, list(_chosen(asked)))

    def session() -> bool:
        in_session([*asked.tests, "-k", asked.select], lambda items: _try_in_functions(items, asked, answers, kept))
        return True

    os.waitpid(fork(session, math.inf), 0)  # the package is imported in a copy of this process
    mutants = [Mutant(**each) for each in json.loads(answers.read_text(encoding="utf-8"))]
    _try_at_import(mutants, asked, kept)
    _write(answers, mutants)
    for folder in asked.folders:
        _print_score(folder, [each for each in mutants if each.file.startswith(f"src/beltdyn/{folder}")])


def _try_in_functions(items: list[pytest.Item], asked: argparse.Namespace, answers: Path, kept: Path) -> None:
    """Try the mutants inside functions, which replace those of the imported modules."""
    mutants = [Mutant(**each) for each in json.loads(answers.read_text(encoding="utf-8"))]
    functions = functions_of({mutant.file for mutant in mutants})
    known = traces(items, asked.folders, asked.slowest, kept)
    print(f"{len(mutants)} mutants, {len(known)} of {len(items)} tests", flush=True)
    by_id = {item.nodeid: item for item in items}

    def work(mutant: Mutant, code: CodeType, tests: list[str]) -> Callable[[], bool]:
        return partial(attempt, code, functions[mutant.file], [by_id[test] for test in tests])

    lines: defaultdict[tuple[str, int], list[str]] = defaultdict(list)
    for test, trace in known.items():
        for file, executed in trace.lines.items():
            for line in executed:
                lines[file, line].append(test)
    inside = [each for each in mutants if not each.at_import]
    _try(inside, lambda mutant: lines[mutant.file, mutant.line], work, known, asked)
    _write(answers, mutants)


def _try_at_import(mutants: list[Mutant], asked: argparse.Namespace, kept: Path) -> None:
    """Try the mutants of what runs at import, with all tests: any of them may see a default or a bound of a field."""
    known = read_traces(kept)
    outside = [each for each in mutants if each.at_import]
    _try(
        outside,
        lambda _: list(known),
        lambda mutant, code, tests: partial(attempt_at_import, mutant, code, tests),
        known,
        asked,
    )


def _try(
    mutants: list[Mutant],
    tests_of: Callable[[Mutant], list[str]],
    work: Callable[[Mutant, CodeType, list[str]], Callable[[], bool]],
    known: dict[str, Trace],
    asked: argparse.Namespace,
) -> None:
    """Try mutants, some at a time, and note what becomes of them."""
    running: dict[int, Mutant] = {}

    def wait() -> None:
        process, status = os.wait()
        mutant = running.pop(process)
        mutant.outcome = "killed" if status else "survived"
        if not status:
            print(mutant, flush=True)

    for mutant, code in compiled(mutants):
        tests, time = _within_budget(tests_of(mutant), known, asked.budget)
        if not tests:
            mutant.outcome = "untested"
            print(mutant, flush=True)
            continue
        if len(running) == asked.jobs:
            wait()
        running[fork(work(mutant, code, tests), PATIENCE * (STARTING + time))] = mutant
    while running:
        wait()


def _within_budget(tests: list[str], known: dict[str, Trace], budget: float) -> tuple[list[str], float]:
    """The quickest tests that can be run in a time, and the time that they take."""
    quickest = sorted(tests, key=lambda test: known[test].duration)
    ends = list(accumulate(known[test].duration for test in quickest))
    number = bisect(ends, budget)
    return quickest[:number], ends[number - 1] if number else 0.0


def _write(answers: Path, mutants: list[Mutant]) -> None:
    answers.write_text(json.dumps([asdict(each) for each in mutants], indent=1), encoding="utf-8")


def _print_score(folder: str, mutants: list[Mutant]) -> None:
    count = Counter(each.outcome for each in mutants)
    share = 100.0 * count["killed"] / max(len(mutants), 1)
    print(f"{folder}: {count['killed']} of {len(mutants)} killed, {share:.1f} %; {count['untested']} untested")


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folders", nargs="+", help="folders or files below src/beltdyn")
    parser.add_argument("--tests", nargs="+", default=["tests/unit"], help="tests that may kill")
    parser.add_argument("--select", default="", help="which of these tests, as for pytest -k")
    parser.add_argument("--sample", type=int, help="try that many mutants of each folder, taken at random")
    parser.add_argument("--seed", type=int, default=1, help="seed of the sample")
    parser.add_argument("--jobs", type=int, default=1, help="mutants at a time")
    parser.add_argument("--slowest", type=float, default=3.0, help="longest time of a test as plain Python, s")
    parser.add_argument("--budget", type=float, default=20.0, help="longest time of all tests of a mutant, s")
    parser.add_argument("--out", type=Path, default=Path("mutation.json"), help="file of the answers")
    parser.add_argument(
        "--again", type=Path, help="answers of a former run of these sources, of which the survivors are tried again"
    )
    return parser


def _chosen(asked: argparse.Namespace) -> Iterator[Mutant]:
    """The mutants to try."""
    former = json.loads(asked.again.read_text(encoding="utf-8")) if asked.again else []
    survivors = {(each["file"], each["number"]) for each in former if each["outcome"] != "killed"}
    for folder in asked.folders:
        paths = sorted((SOURCE / folder).rglob("*.py")) or [SOURCE / folder]
        found = [mutant for path in paths for mutant, _ in mutants_of(path, ROOT)]
        if asked.again:
            found = [each for each in found if (each.file, each.number) in survivors]
        if asked.sample and asked.sample < len(found):
            chosen = sorted(random.Random(asked.seed).sample(range(len(found)), asked.sample))
            found = [found[index] for index in chosen]
        yield from found


if __name__ == "__main__":
    main()
