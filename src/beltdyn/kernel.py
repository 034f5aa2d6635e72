"""The one decorator of compiled code: Numba options and an on-disk cache that cannot go stale.

Numba's own cache watches the file of the compiled function only.  A kernel that inlines a law from another file would
keep the old physics after that law was edited.  Here the cache lives in a folder named by a hash of every source
file that takes part in compiled code, so that an edit anywhere in them starts an empty cache.

Numba also optimises a kernel and turns it into machine code before it links it into its callers, which do so again.
Here kernels take each other in as they were written; only those that Python calls are optimised, whole, and kept.
"""

import atexit
import gc
import hashlib
import os
import shutil
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache, cached_property
from pathlib import Path
from typing import Any, ParamSpec, TypeVar, cast

import numba
import platformdirs
from llvmlite.binding import parse_assembly
from numba.core.caching import CompileResultCacheImpl, FunctionCache
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler
from numba.core.registry import CPUDispatcher
from numba.core.types.misc import unliteral

P = ParamSpec("P")
R = TypeVar("R")

PACKAGE = Path(__file__).parent

CACHE_VARIABLE = "BELTDYN_CACHE_DIR"
"""Environment variable that moves the kernel cache (default: the user's cache folder)."""


_OPTIONS = {
    "nopython": True,
    "nogil": True,
    "error_model": "numpy",
    "fastmath": {"contract", "nsz"},
    "no_cfunc_wrapper": True,
    "no_rewrites": True,
    "_nrt": False,
}


_OPTIMISATION = type(numba.config.OPT)(1)
"""LLVM's level: a higher one takes a fifth longer to compile, and the code is no faster."""


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function with Numba at its first call and keep the machine code on disk.

    Parameters
    ----------
    function
        A function of scalars, arrays and named tuples of them, that makes no arrays.  Everything that it calls must be
        a kernel too.  A private one (leading underscore) is inlined wherever it is called.

    Returns
    -------
    Callable
        The compiled function, with the signature of the given one.
    """
    return cast(Callable[P, R], _Kernel(function, str(kernel_cache())))


class _Kernel(CPUDispatcher):  # type: ignore[misc]
    """A compiled function that shows itself to other kernels as code to be optimised along with them."""

    def __init__(self, function: Any, folder: str) -> None:
        super().__init__(function, targetoptions=_OPTIONS)
        self._folder: str | None = folder

    @cached_property
    def _code(self) -> CPUDispatcher:
        """What another kernel calls."""
        inlined = {"forceinline": self.py_func.__name__.startswith("_"), "no_cpython_wrapper": True}
        return CPUDispatcher(self.py_func, None, {**_OPTIONS, **inlined}, _CodeCompiler)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Type a call by another kernel, constants like any other number."""
        return self._code.get_call_template([unliteral(argument) for argument in args], kws)

    def get_overload(self, sig: Any) -> Any:
        """What another kernel calls, for some types of arguments."""
        return self._code.get_overload(sig)

    def compile(self, sig: Any) -> Any:
        """Compile, or load from disk, without the pauses that Python makes to look through the compiler's objects."""
        if self._folder:
            with _setting("CACHE_DIR", self._folder):
                self._cache = _Cache(self.py_func)
            self._folder = None
        collecting = gc.isenabled()
        gc.disable()
        try:
            with _setting("OPT", _OPTIMISATION):
                return super().compile(sig)
        finally:
            if collecting:
                gc.enable()


class _Stored(CompileResultCacheImpl):  # type: ignore[misc]
    """What is kept of a compiled function: machine code and its name, without the code that others would take in."""

    def reduce(self, cres: Any) -> Any:
        """What is written."""
        (name, kind, (machine_code, _)), *rest = super().reduce(cres)
        entry = f'define void @"{cres.fndesc.llvm_cpython_wrapper_name}"() {{ ret void }}'
        return (name, kind, (machine_code, parse_assembly(entry).as_bitcode())), *rest


class _Cache(FunctionCache):  # type: ignore[misc]
    """Numba's cache, which loads machine code without filling the tables that only compilation needs."""

    _impl_class = _Stored

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Load the machine code for some types of arguments; None where there is none."""
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)


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


@cache
def kernel_cache() -> Path:
    """Folder of the compiled kernels of exactly these sources, made if need be.

    Returns
    -------
    Path
        Below ``$BELTDYN_CACHE_DIR`` or the user's cache folder; where neither can be written a temporary folder, which
        is gone at the end.
    """
    chosen = os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_path("beltdyn")
    folder = Path(chosen) / source_hash(PACKAGE)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        temporary = tempfile.mkdtemp(prefix="beltdyn-")
        atexit.register(shutil.rmtree, temporary, ignore_errors=True)
        return Path(temporary)


def source_hash(package: Path) -> str:
    """Hash of all sources below a folder that take part in compiled code, that is, that import this module.

    Parameters
    ----------
    package
        The folder to search for Python files.

    Returns
    -------
    str
        Sixteen hexadecimal digits.
    """
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if b"beltdyn.kernel" in source or path.name == "kernel.py":
            digest.update(path.relative_to(package).as_posix().encode())
            digest.update(source)
    return digest.hexdigest()[:16]


@contextmanager
def _setting(name: str, value: Any) -> Iterator[None]:
    """Change a setting of Numba for a while; other packages keep theirs."""
    before = getattr(numba.config, name)
    setattr(numba.config, name, value)
    try:
        yield
    finally:
        setattr(numba.config, name, before)
