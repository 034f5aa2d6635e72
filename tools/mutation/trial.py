"""Runs tests in forked copies of one pytest session, so that a test costs its own time and nothing else."""

import ast
import gc
import hashlib
import importlib.machinery
import json
import math
import os
import resource
import signal
import tempfile
import time
import traceback
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import asdict, dataclass
from importlib import import_module
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import coverage
import pytest
from tools.mutation.mutants import Mutant, mutants_of

ROOT = Path(__file__).parents[2]
SOURCE = ROOT / "src" / "beltdyn"
OPTIONS = [
    "-q",
    "-m",
    "not slow",
    "-s",
    "--assert=plain",
    "-p",
    "no:cacheprovider",
    "-o",
    "tmp_path_retention_policy=none",
]


@dataclass
class Trace:
    """What a test does.

    Attributes
    ----------
    duration : float
        Processor time, s.
    lines : dict[str, list[int]]
        Lines that it executes, by file.
    """

    duration: float
    lines: dict[str, list[int]]


class _Loop:
    """Replaces pytest's loop over the collected tests."""

    def __init__(self, loop: Callable[[list[pytest.Item]], None]) -> None:
        self.loop = loop

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        session.config._tmp_path_factory.getbasetemp()  # type: ignore[attr-defined]  # one for all copies
        self.loop(session.items)
        return True


def in_session(tests: Iterable[str], loop: Callable[[list[pytest.Item]], None]) -> None:
    """Collect tests and hand them to a loop.

    Parameters
    ----------
    tests : iterable of str
        Files, folders or ids of tests.
    loop : Callable
        Takes the list of collected tests.
    """
    pytest.main([*OPTIONS, *tests], plugins=[_Loop(loop)])


def passes(items: list[pytest.Item]) -> bool:
    """Run tests one after the other up to the first that fails, in this process."""
    for item, following in zip(items, [*items[1:], None], strict=True):
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if item.session.testsfailed:
            return False
    return True


def fork(work: Callable[[], bool], seconds: float) -> int:
    """Start a copy of this process that does some work and ends with 0 if that returns true.

    Parameters
    ----------
    work : Callable
        What to do.
    seconds : float
        Processor time after which it is ended, as it is after ten times that time on the clock.  A copy with a limit
        is silent.

    Returns
    -------
    int
        Number of the process.
    """
    process = os.fork()
    if process == 0:
        good = False
        try:
            if math.isfinite(seconds):
                _limit(math.ceil(seconds))
            good = work()
        except Exception:
            traceback.print_exc()
        finally:
            os._exit(0 if good else 1)
    return process


def _limit(seconds: int) -> None:
    """Bound the time of this process and silence it."""
    resource.setrlimit(resource.RLIMIT_CPU, (seconds, seconds))
    signal.alarm(10 * seconds)
    silence = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(silence, stream)


def traces(items: list[pytest.Item], folders: list[str], seconds: float, kept: Path) -> dict[str, Trace]:
    """Find out what each test executes, unless it is known.

    Parameters
    ----------
    items : list[pytest.Item]
        The tests.
    folders : list[str]
        Folders below the package whose lines are wanted.
    seconds : float
        Processor time after which a test is given up.
    kept : Path
        File with what is known, which is brought up to date.

    Returns
    -------
    dict[str, Trace]
        By the id of a test; without those that fail or take too long.
    """
    common = _digest(*sorted(SOURCE.rglob("*.py")), *sorted((ROOT / "tests").rglob("conftest.py"))) + str(folders)
    known = json.loads(kept.read_text(encoding="utf-8")) if kept.exists() else {}
    digests = {path: common + _digest(path) for path in {item.path for item in items}}
    found: dict[str, Any] = {}
    for item in items:
        digest = digests[item.path]
        before = known.get(item.nodeid, {"digest": ""})
        found[item.nodeid] = before if before["digest"] == digest else {"digest": digest, "trace": None}
        if before["digest"] != digest:
            trace = _trace(item, folders, seconds)
            found[item.nodeid]["trace"] = asdict(trace) if trace else None
    kept.write_text(json.dumps(found), encoding="utf-8")
    return read_traces(kept)


def read_traces(kept: Path) -> dict[str, Trace]:
    """What is known of tests, by their ids, from a file of `traces`."""
    known = json.loads(kept.read_text(encoding="utf-8"))
    return {test: Trace(**each["trace"]) for test, each in known.items() if each["trace"]}


def _trace(item: pytest.Item, folders: list[str], seconds: float) -> Trace | None:
    with tempfile.NamedTemporaryFile("r", encoding="utf-8") as answer:

        def work() -> bool:
            tool = coverage.Coverage(
                data_file=None, config_file=False, include=[f"{SOURCE / folder}/*" for folder in folders]
            )
            tool.start()
            good = passes([item])
            tool.stop()
            warnings.simplefilter("ignore")  # a test may execute nothing of the folders
            data = tool.get_data()
            lines = {Path(file).relative_to(ROOT).as_posix(): data.lines(file) for file in data.measured_files()}
            Path(answer.name).write_text(json.dumps({"duration": time.process_time(), "lines": lines}), "utf-8")
            return good

        _, status = os.waitpid(fork(work, seconds), 0)
        return Trace(**json.load(answer)) if status == 0 else None


def _digest(*paths: Path) -> str:
    return hashlib.sha256(b"".join(path.read_bytes() for path in paths)).hexdigest()[:16]


def functions_of(files: Iterable[str]) -> dict[str, list[FunctionType]]:
    """Import files of the package and list their functions.

    Parameters
    ----------
    files : iterable of str
        Paths below the root of the repository.

    Returns
    -------
    dict[str, list[FunctionType]]
        Functions that were made by ``def`` or ``lambda``, by file.
    """
    functions: dict[str, list[FunctionType]] = {}
    for file in files:
        functions[file] = []
        module = (ROOT / file).relative_to(SOURCE.parent).with_suffix("")
        import_module(".".join(module.parts).removesuffix(".__init__"))
    for function in gc.get_objects():
        if isinstance(function, FunctionType):
            file = function.__code__.co_filename.removeprefix(f"{ROOT}/")
            functions.get(file, []).append(function)
    gc.freeze()  # copies of this process share its memory as long as no collection walks through it
    return functions


def attempt(mutant: Mutant, functions: list[FunctionType], items: list[pytest.Item]) -> bool:
    """Put a change into the functions of an imported module and run tests.

    Parameters
    ----------
    mutant : Mutant
        A change inside a function.
    functions : list[FunctionType]
        All functions of the file.
    items : list[pytest.Item]
        The tests.

    Returns
    -------
    bool
        Whether all of them pass.
    """
    changed = {(code.co_qualname, code.co_firstlineno): code for code in _codes(_compiled(mutant))}
    for function in functions:
        function.__code__ = changed[function.__code__.co_qualname, function.__code__.co_firstlineno]
    return passes(items)


def attempt_at_import(mutant: Mutant, tests: list[str]) -> bool:
    """Import the package with a changed module and run tests.

    Parameters
    ----------
    mutant : Mutant
        The change.
    tests : list[str]
        Ids of the tests.

    Returns
    -------
    bool
        Whether all of them pass.
    """
    path, code = str(ROOT / mutant.file), _compiled(mutant)
    original = importlib.machinery.SourceFileLoader.get_code

    def get_code(loader: importlib.machinery.SourceFileLoader, fullname: str) -> CodeType | None:
        return code if loader.path == path else original(loader, fullname)

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[method-assign,assignment]
    outcome: list[bool] = []
    in_session(tests, lambda items: outcome.append(passes(items)))
    return outcome == [True]


def _compiled(mutant: Mutant) -> CodeType:
    tree: ast.Module = next(tree for each, tree in mutants_of(ROOT / mutant.file, ROOT) if each.number == mutant.number)
    return compile(tree, str(ROOT / mutant.file), "exec")


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)
