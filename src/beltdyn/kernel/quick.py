"""Compilation in a third of the time, by way of Numba's internals.

Numba optimizes a kernel and turns it into machine code before it links it into its callers, which do so again.
Here a kernel is linked into its callers before optimization.  Only the kernels that Python calls are optimized, each
with all that it calls, and kept on disk.
"""

import gc
import hashlib
import io
import pickle
import re
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from functools import cache, cached_property
from pathlib import Path
from typing import Any

import numba
from filelock import FileLock
from llvmlite.binding import parse_assembly
from numba.core.caching import NullCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompileResult
from numba.core.registry import CPUDispatcher
from numba.core.serialize import NumbaPickler
from numba.core.types.misc import unliteral

from beltdyn.kernel.cache import ENTRY, PACKAGE
from beltdyn.kernel.fingerprint import fingerprint, is_own, mark_of, marked, marks_in
from beltdyn.kernel.lowering import TARGET, KernelCompiler
from beltdyn.kernel.seal import read_sealed, setting, warn_of_damage, write_sealed

_NO_EXTRAS = {"no_cfunc_wrapper": True, "no_rewrites": True, "_nrt": False}
"""Left away: functions for C, rewriting passes, Numba's memory management; kernels need none of them."""

_PATIENCE = 600.0
"""Seconds after which a kernel is compiled although another process is said to compile it: none takes so long."""

_OPTIMISATION = type(numba.config.OPT)(1)
"""LLVM's level: a higher one takes a fifth longer to compile, and the code is no faster."""


class _Callee(CPUDispatcher):  # type: ignore[misc]
    """A kernel as others call it."""

    targetdescr = TARGET


class QuickDispatcher(CPUDispatcher):  # type: ignore[misc]
    """A compiled function that shows itself to other kernels as code to be optimized along with them."""

    targetdescr = TARGET

    def __init__(self, function: Any, options: dict[str, Any], inline: bool, folder: Path) -> None:
        self._options = options | _NO_EXTRAS
        super().__init__(function, {}, self._options, KernelCompiler)
        self._inline = inline
        self._folder = folder

    @cached_property
    def _code(self) -> CPUDispatcher:
        """What another kernel calls."""
        inlined = {"forceinline": self._inline, "no_cpython_wrapper": True}
        return _Callee(self.py_func, {}, self._options | inlined, _CodeCompiler)

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
        entry = self._entry(sig)
        collecting = gc.isenabled()
        gc.disable()
        try:
            with setting("OPT", _OPTIMISATION), _alone(entry):
                return super().compile(sig)
        finally:
            if collecting:
                gc.enable()

    def is_kept(self, arguments: tuple[Any, ...]) -> bool:
        """Whether a call with these arguments needs no compilation."""
        sig = tuple(map(self.typeof_pyval, arguments))
        entry = self._entry(sig)
        return sig in self.overloads or (entry is not None and entry.is_file())

    @cached_property
    def _files(self) -> "_Cache | None":
        """Where its machine code is kept; nowhere without a file that its source comes from."""
        with suppress(OSError):
            return _Cache(self.py_func, self._folder)
        return None

    def _entry(self, sig: Any) -> Path | None:
        if self._files is None:
            return None
        self._cache = self._files
        return self._files.entry(sig, self.targetctx)


@contextmanager
def _alone(entry: Path | None) -> Iterator[None]:
    """Keep other processes from what is done for an entry of the cache, where its file system has locks."""
    if entry is None:
        yield
        return
    lock = FileLock(entry.with_suffix(".lock"), timeout=_PATIENCE)
    with suppress(NotImplementedError, OSError):  # of which a lock that was waited for in vain is one
        lock.acquire()
    try:
        yield
    finally:
        with suppress(OSError):
            lock.release()


def choice_type(kernel_for: Callable[..., Any]) -> Any:
    """Type of a function with several kernels."""
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


class _Cache(NullCache):  # type: ignore[misc]
    """Machine code on disk, a sealed file for a kernel and some types of arguments.

    It loads without filling the tables that only compilation needs.
    """

    def __init__(self, function: Any, folder: Path) -> None:
        file = Path(function.__code__.co_filename)
        self._folder = folder
        stem, name = (re.sub("[^A-Za-z0-9_.]", "", text)[-80:] for text in (file.stem, function.__qualname__))
        self._name = f"{stem}.{name}"
        origin = (str(file), fingerprint([function])) if is_own(function) else (file.relative_to(PACKAGE).as_posix(),)
        self._source = (numba.__version__, sys.version_info[:3], *origin, *_fingerprint(function))

    @property
    def cache_path(self) -> str:
        """Folder of the entries."""
        return str(self._folder)

    def entry(self, sig: Any, target_context: Any) -> Path:
        """File of the code for some types of arguments."""
        digest = hashlib.sha256(repr(self._key(sig, target_context)).encode()).hexdigest()
        return self._folder / f"{self._name}-{digest[:16]}{ENTRY}"

    def _key(self, sig: Any, target_context: Any) -> tuple[Any, ...]:
        return sig, target_context.codegen().magic_tuple(), self._source, sorted(marks_in(sig))

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for some types of arguments; None where there is none."""
        path = self.entry(sig, target_context)
        content = read_sealed(path)
        if content is None:
            return None
        try:
            key, stored = _Unpickler(io.BytesIO(content)).load()
            return CompileResult._rebuild(target_context, *stored) if key == self._key(sig, target_context) else None
        except Exception:  # whatever an entry of other libraries lets the unpickler or LLVM raise
            warn_of_damage(path.parent)
            return None

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep the machine code for some types of arguments, without what only its compiler needs."""
        if data.lifted or data.library.has_dynamic_globals:
            return
        (name, kind, (machine_code, _)), *rest = data._replace(type_annotation="")._reduce()
        entry = f'define void @"{data.fndesc.llvm_cpython_wrapper_name}"() {{ ret void }}'
        stored = (name, kind, (machine_code, parse_assembly(entry).as_bitcode())), *rest
        write_sealed(self.entry(sig, data.target_context), dumps((self._key(sig, data.target_context), stored)))


class _Pickler(NumbaPickler):  # type: ignore[misc]
    """Numba's, by which classes of users' laws are kept by their marks: those of a script have no other name."""

    def persistent_id(self, value: Any) -> str | None:
        """The mark of a class."""
        return mark_of(value)


class _Unpickler(pickle.Unpickler):
    """Finds classes by their marks."""

    def persistent_load(self, mark: str) -> type:
        """The class of a mark."""
        return marked(mark)


def dumps(value: Any) -> bytes:
    """Bytes of a value."""
    with io.BytesIO() as buffer:
        _Pickler(buffer, protocol=4).dump(value)
        return buffer.getvalue()


def _fingerprint(function: Any) -> tuple[Any, ...]:
    """What tells the code of a function from that of others, and from that of its file before an edit."""
    code, closure = function.__code__, function.__closure__
    cells = dumps(tuple(cell.cell_contents for cell in closure)) if closure else b""
    parts = _content(code.co_filename), code.co_code, cells
    return code.co_firstlineno, code.co_names, *(hashlib.sha256(part).hexdigest() for part in parts)


@cache
def _content(file: str) -> bytes:
    return Path(file).read_bytes()


class _CodeCompiler(KernelCompiler):
    """Numba's compiler, up to the code before optimization."""

    def __init__(self, typingctx: Any, targetctx: Any, _library: Any, *choices: Any) -> None:
        super().__init__(typingctx, targetctx, _Code(targetctx.codegen(), "code"), *choices)


class _Code(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel with all that it calls, neither optimized as a whole nor turned into machine code."""

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
