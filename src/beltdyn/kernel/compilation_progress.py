"""Progress of compilation: how many of the kernels that a call needs are compiled."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock
from types import FunctionType, ModuleType
from typing import Any

from beltdyn.kernel.by_type import Dispatch
from beltdyn.kernel.fingerprint import names_in

CompilationReport = Callable[[int, int], None]
"""Called with the number of kernels compiled so far and that of those needed so far."""

_lock = Lock()
_reports: list[CompilationReport] = []
_counts: dict[object, tuple[int, int]] = {}
"""Kernels compiled and needed, by this process and by those that compile for it."""


def observe_compilation(report: CompilationReport) -> None:
    """Report the compilation of kernels from now on; see `watch_compilation`."""
    _reports.append(report)


@contextmanager
def watch_compilation(report: CompilationReport) -> Iterator[None]:
    """Report kernels compiled and needed at each compilation; the last report has equal numbers.

    The second number is counted in advance from the sources, and grows where another call needs more kernels.
    """
    observe_compilation(report)
    try:
        yield
    finally:
        _reports.remove(report)


def report_compilation(source: object, done: int, total: int) -> None:
    """Report the number of kernels that a source, such as a process, has compiled, and of those that it needs."""
    with _lock:  # another process is heard in a thread of its own
        _counts[source] = done, total
        done, total = map(sum, zip(*_counts.values(), strict=True))
        for report in _reports:
            report(done, total)


class CompilationCount:
    """Counts kernels as they are compiled, those within others too."""

    def __init__(self) -> None:
        self._depth = self._done = self._total = 0

    def begin(self, function: Callable[..., Any], classes: frozenset[type]) -> None:
        """Note that a function is compiled for arguments of some classes of named tuples."""
        if not self._depth:
            self._total = self._done + len(_kernels_below(function, classes))
        self._depth += 1
        report_compilation(self, self._done, self._total)

    def end(self) -> None:
        """Note that the function begun last is compiled."""
        self._depth -= 1
        self._done = min(self._done + 1, self._total - 1) if self._depth else self._total
        report_compilation(self, self._done, self._total)


def _kernels_below(function: Callable[..., Any], classes: frozenset[type]) -> set[Callable[..., Any]]:
    """A function with all kernels that it calls, whose choices are made for some classes of arguments."""
    known, ahead = {function}, [function]
    while ahead:
        for value in _globals_of(ahead.pop()):
            for called in _called(value, classes):
                if called not in known:
                    known.add(called)
                    ahead.append(called)
    return known


def _called(value: Any, classes: frozenset[type]) -> list[Callable[..., Any]]:
    """Functions of the kernels that a global value stands for."""
    kernels = value.kernels_for(classes) if isinstance(value, Dispatch) else [value]
    return [one.py_func for one in kernels if isinstance(getattr(one, "py_func", None), FunctionType)]


def _globals_of(function: Callable[..., Any]) -> list[Any]:
    """Values of the names that a function takes from its module, from other modules by attribute, and its closure."""
    names, known = names_in(function.__code__), function.__globals__
    values = [known[name] for name in names if name in known]
    modules = [value for value in values if isinstance(value, ModuleType)]
    cells = [cell.cell_contents for cell in function.__closure__ or ()]
    return [*values, *cells, *(getattr(one, name, None) for one in modules for name in names)]
