"""Kernels that kernels call: compile-time dispatch on the first argument's type, and the count of those needed."""

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from functools import cached_property
from threading import Lock
from types import FunctionType, ModuleType
from typing import Any, ClassVar

from beltdyn.kernel.fingerprint import compiles_quickly, names_in


class Dispatch(ABC):
    """Several kernels with one name."""

    unregistered: ClassVar[list["Dispatch"]] = []
    """Those not yet registered with plain compilation."""

    def __init__(self, name: str) -> None:
        self.__name__ = name
        self.unregistered.append(self)

    @abstractmethod
    def kernel_for(self, subject: Any, *_rest: Any) -> Any:
        """The kernel for a Numba type of the first argument."""

    @abstractmethod
    def kernels_for(self, classes: frozenset[type]) -> Iterable[Any]:
        """The kernels that it may call in kernels whose arguments are of some classes of named tuples."""

    @property
    def _numba_type_(self) -> Any:
        """Type by which kernels know this choice; plain compilation asks `numba.extending` instead."""
        if not compiles_quickly():
            raise AttributeError("_numba_type_")
        return self._quick_type

    @cached_property
    def _quick_type(self) -> Any:
        from beltdyn.kernel.quick import choice_type

        return choice_type(self.kernel_for)


class ByType(Dispatch):
    """Kernels for classes of named tuples; classes may be added later."""

    def __init__(self, kernels: Mapping[type, Callable[..., Any]], name: str) -> None:
        super().__init__(name)
        self.kernels: Mapping[Any, Any] = kernels

    def __call__(self, subject: Any, *rest: Any) -> Any:
        """Call the kernel for the type of the first argument."""
        return self.kernels[type(subject)](subject, *rest)

    def kernel_for(self, subject: Any, *_rest: Any) -> Any:
        """The kernel for a Numba type of the first argument."""
        chosen = self.kernels.get(getattr(subject, "instance_class", None))
        if chosen is None:
            known = ", ".join(kind.__name__ for kind in self.kernels)
            raise TypeError(f"{self.__name__} takes {known}, not {subject}. Register a kernel for it.")
        return chosen

    def kernels_for(self, classes: frozenset[type]) -> Iterable[Any]:
        """Those of the classes."""
        return [kernel for kind, kernel in self.kernels.items() if kind in classes]


def by_type(kernels: Mapping[type, Callable[..., Any]], name: str) -> Callable[..., Any]:
    """Combine several kernels under one name, chosen by the type of the first argument.

    Where a kernel calls it, the choice is made as the caller is compiled, for the types of its arguments; it costs
    nothing at run time, and what is not chosen is not compiled.

    Examples
    --------
    >>> from typing import NamedTuple
    >>> from beltdyn.kernel import by_type, kernel
    >>> class Disc(NamedTuple):
    ...     radius: float
    >>> class Square(NamedTuple):
    ...     side: float
    >>> @kernel
    ... def disc_area(disc):
    ...     return 3.14159 * disc.radius**2
    >>> @kernel
    ... def square_area(square):
    ...     return square.side**2
    >>> area = by_type({Disc: disc_area, Square: square_area}, "area")
    >>> area(Square(2.0))
    4.0
    """
    return ByType(kernels, name)


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
