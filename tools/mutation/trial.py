"""Runs tests in forked copies of one pytest session, so that a test costs its own time and nothing else."""

import functools
import gc
import importlib.machinery
import math
import os
import resource
import signal
import sys
import tempfile
import traceback
from collections import defaultdict
from collections.abc import Callable, Iterable, Iterator
from importlib import import_module
from itertools import groupby
from pathlib import Path
from types import CodeType, FunctionType

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
FAULT = 255
"""Status of a copy of the process in which this tool failed."""
NOT_IMPORTED = 254
"""Status of a copy of the process in which no test imports the changed module."""
MAX_TESTS = 253
"""Most tests of a mutant: the status of a copy tells which of them failed."""
SETUP = "set up"
"""Context of lines that fixtures execute."""


class _Loop:
    """Replaces pytest's loop over the collected tests; tells when fixtures are set up."""

    def __init__(self, loop: Callable[[list[pytest.Item]], None]) -> None:
        self.loop = loop
        self.has_run = False
        self.error: BaseException | None = None
        self.reason = ""

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.failed:
            self.reason = str(report.longrepr).splitlines()[-1]

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        session.config._tmp_path_factory.getbasetemp()  # type: ignore[attr-defined]  # one for all copies
        self.has_run = True
        try:
            self.loop(session.items)
        except BaseException as error:
            self.error = error  # pytest would report it as its own
        return True

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Iterator[None]:
        tool = coverage.Coverage.current()
        if tool:
            tool.switch_context(SETUP)
        yield
        if tool:
            tool.switch_context(item.nodeid)


def in_session(tests: Iterable[str], loop: Callable[[list[pytest.Item]], None]) -> bool:
    """Collect tests and hand them to a loop; False where they cannot be collected.

    Parameters
    ----------
    tests : iterable of str
        Files, folders or ids of tests.
    loop : Callable
        Takes the list of collected tests.
    """
    plugin, folder = _Loop(loop), tempfile.mkdtemp()  # that of other sessions may be removed by them
    pytest.main([*OPTIONS, f"--basetemp={folder}/tests", *tests], plugins=[plugin])
    if plugin.error:
        raise plugin.error
    return plugin.has_run


def reason_of_failure(item: pytest.Item) -> str:
    """Last line of the report of the last test that failed in the session of a test."""
    return next(each for each in item.config.pluginmanager.get_plugins() if isinstance(each, _Loop)).reason


def first_failure(items: list[pytest.Item]) -> int:
    """Run tests one after the other in this process up to the first that fails; its number from 1, 0 if all pass."""
    for number, (item, following) in enumerate(zip(items, [*items[1:], None], strict=True), 1):
        item.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
        if item.session.testsfailed:
            return number
    return 0


def fork(work: Callable[[], int], seconds: float) -> int:
    """Start a copy of this process that does some work and ends with what that returns, or with `FAULT`.

    Parameters
    ----------
    work : Callable
        What to do; returns 0 to `NOT_IMPORTED`.
    seconds : float
        Processor time after which it is ended, as it is after 100 times that time on the clock.  A copy with a limit
        is silent.

    Returns
    -------
    int
        Number of the process.
    """
    process = os.fork()
    if process == 0:
        status = FAULT
        try:
            if math.isfinite(seconds):
                limit = math.ceil(seconds)
                resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
                signal.alarm(100 * limit)
                silence()
            status = work()
        except SystemExit as error:
            print(error, file=sys.stderr)
        except BaseException:
            traceback.print_exc()
        finally:
            os._exit(status)
    return process


def silence() -> None:
    """Send what this process writes nowhere."""
    nowhere = os.open(os.devnull, os.O_RDWR)
    for stream in range(3):
        os.dup2(nowhere, stream)


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
    gc.unfreeze()  # the tests freeze what collection makes, and frozen objects are not listed
    for function in gc.get_objects():
        kind = type(function)  # of a weak reference too, whose object may be gone
        if issubclass(kind, functools._lru_cache_wrapper):
            function.cache_clear()  # of results without a change
        if issubclass(kind, FunctionType):
            file = function.__code__.co_filename.removeprefix(f"{ROOT}/")
            functions.get(file, []).append(function)
    gc.freeze()  # copies of this process share its memory as long as no collection walks through it
    return functions


Replacements = list[tuple[FunctionType, CodeType]]
"""Functions, each with its new code."""


def replacements(file: str, code: CodeType, functions: list[FunctionType]) -> Replacements:
    """The functions that a change of their file alters, each with its new code.

    Parameters
    ----------
    file : str
        Path of the file below the root of the repository.
    code : CodeType
        The changed module.
    functions : list[FunctionType]
        All functions of the file.
    """
    original = _codes_by_place(compile((ROOT / file).read_text(encoding="utf-8"), str(ROOT / file), "exec"))
    changed = _codes_by_place(code)
    altered = []
    for function in functions:
        place = _place(function.__code__)
        if function.__code__ in original[place]:
            following = changed[place][original[place].index(function.__code__)]
            if following != function.__code__:
                altered.append((function, following))
    return altered


def fits(altered: Replacements) -> bool:
    """Whether functions can take their new code: without `super`, say, it closes over other names."""
    return all(function.__code__.co_freevars == code.co_freevars for function, code in altered)


def attempt(altered: Replacements, items: list[pytest.Item]) -> int:
    """Put a change into functions and run tests: the number of the first that fails, or 0."""
    for function, code in altered:
        function.__code__ = code
    return first_failure(items)


def attempt_at_import(mutant: Mutant, code: CodeType, tests: list[str]) -> int:
    """Import the package with a changed module and run tests.

    Parameters
    ----------
    mutant : Mutant
        The change.
    code : CodeType
        The changed module.
    tests : list[str]
        Ids of the tests.

    Returns
    -------
    int
        Number of the first test that fails, 0 if all pass, 1 if the package cannot be imported, `NOT_IMPORTED` if it is
        imported without this module.
    """
    path = str(ROOT / mutant.file)
    original = importlib.machinery.SourceFileLoader.get_code
    imported = [False]

    def get_code(loader: importlib.machinery.SourceFileLoader, fullname: str) -> CodeType | None:
        if loader.path != path:
            return original(loader, fullname)
        imported[0] = True
        return code

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[method-assign,assignment]
    outcome: list[int] = []
    in_session(tests, lambda items: outcome.append(first_failure(items)))
    return (outcome[0] if outcome else 1) if imported[0] else NOT_IMPORTED


def compiled(mutants: list[Mutant]) -> Iterator[tuple[Mutant, CodeType]]:
    """Mutants in their order, which is that of their files, each with its changed module."""
    for file, group in groupby(mutants, lambda mutant: mutant.file):
        wanted = {mutant.number: mutant for mutant in group}
        for each, tree in mutants_of(ROOT / file, ROOT):
            if each.number in wanted:
                yield wanted[each.number], compile(tree, str(ROOT / file), "exec")


def _codes_by_place(code: CodeType) -> defaultdict[tuple[str, int], list[CodeType]]:
    """Code objects by `_place`: several lambdas may stand in a line."""
    codes: defaultdict[tuple[str, int], list[CodeType]] = defaultdict(list)
    waiting = [code]
    while waiting:
        each = waiting.pop()
        codes[_place(each)].append(each)
        waiting += [constant for constant in each.co_consts if isinstance(constant, CodeType)]
    return codes


def _place(code: CodeType) -> tuple[str, int]:
    return code.co_qualname, code.co_firstlineno
