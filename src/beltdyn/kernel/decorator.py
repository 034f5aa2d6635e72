"""The one decorator of compiled code.  Numba is imported at the first call of a kernel, not where it is written."""

import functools
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, Generic, ParamSpec, TypeVar, cast, overload
from weakref import WeakSet

P = ParamSpec("P")
R = TypeVar("R")
_COMPILE, _INTERPRET, _LOAD = range(3)
_mode = ContextVar("_mode", default=_COMPILE)
_kernels: WeakSet["Kernel[..., Any]"] = WeakSet()


class Kernel(Generic[P, R]):
    """A function compiled at its first call, or inlined in the kernels that call it."""

    def __init__(self, function: Callable[P, R], inline: bool) -> None:
        self.py_func, self.inline = function, inline
        functools.update_wrapper(self, function)
        _kernels.add(self)

    def __call__(self, *args: P.args, **kwargs: P.kwargs) -> R:
        """Call the compiled function, or inside of `interpreted` the function itself."""
        if mode := _mode.get():
            if mode == _INTERPRET:
                return self.py_func(*args, **kwargs)
            if not self._is_kept(args):
                raise _NotCompiledError
        return cast(R, self.dispatcher(*args, **kwargs))

    def _is_kept(self, args: tuple[Any, ...]) -> bool:
        """Whether a call needs no compilation; Numba's own decorator does not say."""
        is_kept = getattr(self.dispatcher, "is_kept", None)
        return is_kept(args) if is_kept is not None else self.dispatcher is self.py_func

    def __reduce__(self) -> tuple[type["Kernel[P, R]"], tuple[Callable[P, R], bool]]:
        return Kernel, (self.py_func, self.inline)

    @functools.cached_property
    def dispatcher(self) -> Any:
        """Numba's dispatcher of the function."""
        from beltdyn.kernel.compiler import new_dispatcher

        return new_dispatcher(self.py_func, self.inline)

    @property
    def _numba_type_(self) -> Any:
        """Type by which other kernels know this one."""
        return self.dispatcher._numba_type_


def forget_compiled() -> None:
    """Compile all kernels anew where they are called next."""
    for one in _kernels:
        vars(one).pop("dispatcher", None)


@overload
def kernel(function: Callable[P, R], /) -> Callable[P, R]: ...
@overload
def kernel(*, inline: bool = False) -> Callable[[Callable[P, R]], Callable[P, R]]: ...
def kernel(function: Callable[..., Any] | None = None, /, *, inline: bool = False) -> Any:
    """Compile a function with Numba at its first call and keep the machine code on disk."""
    if function is None:
        return functools.partial(Kernel, inline=inline)
    return Kernel(function, inline)


def interpreted(function: Callable[P, R]) -> Callable[P, R]:
    """Let Python run a kernel and those that it calls, for a few calls where nothing is to be compiled.

    What is below the least number is zero, as in compiled code, whatever NumPy is told to do then.
    """
    from numpy import errstate

    def run(*args: P.args, **kwargs: P.kwargs) -> R:
        with _in_mode(_INTERPRET), errstate(under="ignore"):
            return function(*args, **kwargs)

    return run


def runs_compiled(function: Callable[P, object], *args: P.args, **kwargs: P.kwargs) -> bool:
    """Run a function up to the first call that needs compilation; whether there is none, with plain compilation no."""
    try:
        with _in_mode(_LOAD):
            function(*args, **kwargs)
    except _NotCompiledError:
        return False
    return True


class _NotCompiledError(Exception):
    """A kernel is not compiled for its arguments."""


@contextmanager
def _in_mode(mode: int) -> Iterator[None]:
    token = _mode.set(mode)
    try:
        yield
    finally:
        _mode.reset(token)
