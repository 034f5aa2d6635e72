"""Compilation in a third of the time, by way of Numba's internals.

Numba optimises a kernel and turns it into machine code before it links it into its callers, which do so again.
Here a kernel is linked into its callers before optimisation.  Only the kernels that Python calls are optimised, each
with all that it calls, and kept on disk.
"""

import gc
import hashlib
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cached_property
from pathlib import Path
from typing import Any

import numba
from filelock import FileLock
from llvmlite.binding import parse_assembly
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numba.core.types.misc import unliteral

from beltdyn.kernel.setting import setting

_NO_EXTRAS = {"no_cfunc_wrapper": True, "no_rewrites": True, "_nrt": False}
"""Left away: functions for C, rewriting passes, Numba's memory management; kernels need none of them."""

_OPTIMISATION = type(numba.config.OPT)(1)
"""LLVM's level: a higher one takes a fifth longer to compile, and the code is no faster."""


class QuickDispatcher(CPUDispatcher):  # type: ignore[misc]
    """A compiled function that shows itself to other kernels as code to be optimised along with them.

    Parameters
    ----------
    function
        The function.
    options
        Numba's options.
    inline
        Whether it becomes a part of every kernel that calls it.
    folder
        Where its machine code is kept.
    """

    def __init__(self, function: Any, options: dict[str, Any], inline: bool, folder: str) -> None:
        self._options = options | _NO_EXTRAS
        super().__init__(function, targetoptions=self._options)
        self._inline = inline
        self._folder: str | None = folder

    @cached_property
    def _code(self) -> CPUDispatcher:
        """What another kernel calls."""
        inlined = {"forceinline": self._inline, "no_cpython_wrapper": True}
        return CPUDispatcher(self.py_func, {}, self._options | inlined, _CodeCompiler)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Type a call by another kernel, constants like any other number."""
        return self._code.get_call_template([unliteral(argument) for argument in args], kws)

    def get_overload(self, sig: Any) -> Any:
        """What another kernel calls, for some types of arguments."""
        return self._code.get_overload(sig)

    def compile(self, sig: Any) -> Any:
        """Compile, or load from disk, without the pauses that Python makes to look through the compiler's objects.

        Where another process compiles the same, it is waited for.
        """
        if self._folder:
            with setting("CACHE_DIR", self._folder), suppress(RuntimeError):  # no file holds what was typed
                self._cache = _Cache(self.py_func)
            self._folder = None
        collecting = gc.isenabled()
        gc.disable()
        try:
            with setting("OPT", _OPTIMISATION), _alone(self._cache, f"{self.py_func.__qualname__} {sig}"):
                return super().compile(sig)
        finally:
            if collecting:
                gc.enable()


@contextmanager
def _alone(cache: Any, task: str) -> Iterator[None]:
    """Keep other processes from a task in a folder of kernels, where there is one and its file system has locks."""
    if cache.cache_path is None:
        yield
        return
    lock = FileLock(Path(cache.cache_path) / f"{hashlib.sha256(task.encode()).hexdigest()[:16]}.lock")
    with suppress(NotImplementedError, OSError):
        lock.acquire()
    try:
        yield
    finally:
        lock.release()


def choice_type(kernel_for: Callable[..., Any]) -> Any:
    """Type of a function that stands for several kernels.

    Parameters
    ----------
    kernel_for
        Gives the kernel for the types of the arguments.
    """
    return _ChoiceType(_Choice(kernel_for))


class _Choice:
    """What another kernel calls, when it is compiled, in place of the kernel that is chosen."""

    is_compiling, nopython_signatures = False, ()

    def __init__(self, kernel_for: Callable[..., Any]) -> None:
        self._kernel_for = kernel_for

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Type a call."""
        return self._kernel_for(*args).dispatcher.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """What is called, for some types of arguments."""
        return self._kernel_for(*sig).dispatcher.get_overload(sig)


class _ChoiceType(numba.types.Dispatcher):  # type: ignore[misc]
    """A type that keeps its choice alive: Numba's holds a compiled function weakly."""

    def __init__(self, choice: _Choice) -> None:
        self._choice = choice
        super().__init__(choice)


class _Stored(CompileResultCacheImpl):  # type: ignore[misc]
    """What is kept of a compiled function: machine code and its name, without the code that others would take in."""

    def reduce(self, cres: Any) -> Any:
        """What is written."""
        (name, kind, (machine_code, _)), *rest = super().reduce(cres)
        entry = f'define void @"{cres.fndesc.llvm_cpython_wrapper_name}"() {{ ret void }}'
        return (name, kind, (machine_code, parse_assembly(entry).as_bitcode())), *rest


class _Cache(FunctionCache):  # type: ignore[misc]
    """Numba's cache, which loads machine code without filling the tables that only compilation needs.

    Its list of what it holds is read, lengthened and written by one process at a time.
    """

    _impl_class = _Stored

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for some types of arguments; None where there is none."""
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for some types of arguments."""
        with _alone(self, self._impl.filename_base):
            super().save_overload(sig, data)


class _CodeCompiler(Compiler):  # type: ignore[misc]
    """Numba's compiler, up to the code before optimisation."""

    def __init__(self, typingctx: Any, targetctx: Any, _library: Any, *choices: Any) -> None:
        super().__init__(typingctx, targetctx, _Code(targetctx.codegen(), "code"), *choices)


class _Code(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel with all that it calls, neither optimised as a whole nor turned into machine code."""

    def finalize(self) -> None:
        """Link what it calls, and no more."""
        for library in dict.fromkeys(self._linking_libraries):
            self._final_module.link_in(library._get_module_for_linking(), preserve=True)
        self._finalized = True

    def get_pointer_to_function(self, _name: str) -> int:
        """No machine code, no address."""
        self._ensure_finalized()
        return 0

    @property
    def codegen(self) -> "_Code":
        """What Numba asks to `set_env`."""
        return self

    def set_env(self, _name: str, _environment: Any) -> None:
        """Nothing to set: the environment is for Python objects, which kernels do not see."""
