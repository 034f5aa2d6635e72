"""The one decorator of compiled code: Numba options and an on-disk cache that cannot go stale.

Numba's own cache watches the file of the compiled function only.  A kernel that inlines a law from another file would
keep the old physics after that law was edited.  Here the cache lives in a folder named by a hash of every source
file that takes part in compiled code, so that an edit anywhere in them starts an empty cache.
"""

import hashlib
import os
import tempfile
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import ParamSpec, TypeVar

import numba
import platformdirs

P = ParamSpec("P")
R = TypeVar("R")

PACKAGE = Path(__file__).parent

CACHE_VARIABLE = "BELTDYN_CACHE_DIR"
"""Environment variable that moves the kernel cache (default: the user's cache folder)."""


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function with Numba at its first call and keep the machine code on disk.

    Parameters
    ----------
    function
        A function of scalars, arrays and named tuples of them.  Everything that it calls must be a kernel too.  A
        private one (leading underscore) becomes a part of its callers and cannot be called from Python.

    Returns
    -------
    Callable
        The compiled function, with the signature of the given one.
    """
    private = function.__name__.startswith("_")
    with _cache_folder(str(kernel_cache())):
        compiled: Callable[P, R] = numba.njit(
            cache=True,
            nogil=True,
            error_model="numpy",
            fastmath={"contract", "nsz"},
            forceinline=private,
            no_cpython_wrapper=private,
            no_cfunc_wrapper=private,
        )(function)
    return compiled


@cache
def kernel_cache() -> Path:
    """Folder of the compiled kernels of exactly these sources, made if need be.

    Returns
    -------
    Path
        Below ``$BELTDYN_CACHE_DIR`` or the user's cache folder; a temporary folder where neither can be written.
    """
    chosen = os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_path("beltdyn")
    folder = Path(chosen) / source_hash(PACKAGE)
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            return folder
    except OSError:
        return Path(tempfile.mkdtemp(prefix="beltdyn-"))


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
def _cache_folder(folder: str) -> Iterator[None]:
    """Point Numba at a cache folder while a function is decorated; other packages keep theirs."""
    before = numba.config.CACHE_DIR
    numba.config.CACHE_DIR = folder
    try:
        yield
    finally:
        numba.config.CACHE_DIR = before
