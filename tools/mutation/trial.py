"""Runs tests in forked copies of one pytest session, so that a test costs its own time and nothing else."""

import gc
import importlib.machinery
import math
import os
import resource
import signal
import traceback
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
SETUP = "set up"
"""Context of lines that fixtures execute."""


class _Loop:
    """Replaces pytest's loop over the collected tests; tells when fixtures are set up."""

    def __init__(self, loop: Callable[[list[pytest.Item]], None]) -> None:
        self.loop = loop

    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        session.config._tmp_path_factory.getbasetemp()  # type: ignore[attr-defined]  # one for all copies
        self.loop(session.items)
        return True

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self, item: pytest.Item) -> Iterator[None]:
        tool = coverage.Coverage.current()
        if tool:
            tool.switch_context(SETUP)
        yield
        if tool:
            tool.switch_context(item.nodeid)


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
                limit = math.ceil(seconds)
                resource.setrlimit(resource.RLIMIT_CPU, (limit, limit))
                signal.alarm(10 * limit)
                silence()
            good = work()
        except Exception:
            traceback.print_exc()
        finally:
            os._exit(0 if good else 1)
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
    for function in gc.get_objects():
        if isinstance(function, FunctionType):
            file = function.__code__.co_filename.removeprefix(f"{ROOT}/")
            functions.get(file, []).append(function)
    gc.freeze()  # copies of this process share its memory as long as no collection walks through it
    return functions


def attempt(code: CodeType, functions: list[FunctionType], items: list[pytest.Item]) -> bool:
    """Put a change into the functions of an imported module and run tests.

    Parameters
    ----------
    code : CodeType
        The changed module.
    functions : list[FunctionType]
        All functions of the file.
    items : list[pytest.Item]
        The tests.

    Returns
    -------
    bool
        Whether all of them pass.
    """
    changed = {(each.co_qualname, each.co_firstlineno): each for each in _codes(code)}
    for function in functions:
        function.__code__ = changed[function.__code__.co_qualname, function.__code__.co_firstlineno]
    return passes(items)


def attempt_at_import(mutant: Mutant, code: CodeType, tests: list[str]) -> bool:
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
    bool
        Whether all of them pass.
    """
    path = str(ROOT / mutant.file)
    original = importlib.machinery.SourceFileLoader.get_code

    def get_code(loader: importlib.machinery.SourceFileLoader, fullname: str) -> CodeType | None:
        return code if loader.path == path else original(loader, fullname)

    importlib.machinery.SourceFileLoader.get_code = get_code  # type: ignore[method-assign,assignment]
    outcome: list[bool] = []
    in_session(tests, lambda items: outcome.append(passes(items)))
    return outcome == [True]


def compiled(mutants: list[Mutant]) -> Iterator[tuple[Mutant, CodeType]]:
    """Mutants in their order, which is that of their files, each with its changed module."""
    for file, group in groupby(mutants, lambda mutant: mutant.file):
        wanted = {mutant.number: mutant for mutant in group}
        for each, tree in mutants_of(ROOT / file, ROOT):
            if each.number in wanted:
                yield wanted[each.number], compile(tree, str(ROOT / file), "exec")


def _codes(code: CodeType) -> Iterator[CodeType]:
    yield code
    for constant in code.co_consts:
        if isinstance(constant, CodeType):
            yield from _codes(constant)
