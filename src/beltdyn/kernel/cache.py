"""The cache folder of compiled kernels, keyed by their sources.

Numba's own cache watches the file of the compiled function only.  A kernel that calls a law from another file would
keep the old physics after that law was edited.  Here the cache lives in a folder named by a hash of every source
file that takes part in compiled code, so that an edit anywhere in them starts an empty cache.

What lies there is run as machine code.  So nobody else may write there, and `beltdyn.kernel.fingerprint` puts a
checksum around every file.
"""

import atexit
import hashlib
import os
import shutil
import stat
import tempfile
import warnings
from contextlib import suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path

import platformdirs

# The way of compilation: quick for known versions of Numba, otherwise by its public decorator

PLAIN_VARIABLE = "BELTDYN_PLAIN_COMPILATION"
"""Environment variable that, if set and not empty, asks for Numba's public decorator."""

_OLDEST, _NEWEST = (0, 60), (0, 68)
"""Versions of Numba whose internals `beltdyn.kernel.quick` was tested with."""


@cache
def compiles_quickly() -> bool:
    """Whether kernels are compiled by way of Numba's internals; they are never compiled again where they are kept."""
    if os.environ.get(PLAIN_VARIABLE):
        return False
    major, minor = version("numba").split(".")[:2]
    return _OLDEST <= (int(major), int(minor)) <= _NEWEST


PACKAGE = Path(__file__).parents[1]

CACHE_VARIABLE = "BELTDYN_CACHE_DIR"
"""Environment variable that moves the kernel cache (default: the user's cache folder)."""

_SHIPPED = PACKAGE / "kernel" / "shipped"
"""Where a wheel for one system has usual kernels, compiled; a new cache begins with those of its sources."""

ENTRY, NUMBA_FILES = ".kernel", (".nbi", ".nbc")
"""Endings of the files of kernels: ours, and those of Numba's decorator."""

_WRITABLE_BY_OTHERS = stat.S_IWGRP | stat.S_IWOTH


class KernelCacheWarning(UserWarning):
    """Compiled kernels cannot be kept or reused."""


@cache
def kernel_cache() -> Path:
    """Folder of the compiled kernels of exactly these sources, created if needed."""
    chosen = Path(os.environ.get(CACHE_VARIABLE) or platformdirs.user_cache_path("beltdyn"))
    name = source_hash(PACKAGE) + ("" if compiles_quickly() else "-plain")
    try:
        fault = _prepare(chosen, name)
    except OSError as error:
        fault = f"it cannot be written ({error.strerror or error})"
    if not fault:
        return chosen / name
    warnings.warn(
        f"The kernel cache {chosen} is not usable: {fault}. Kernels are compiled again at every start. "
        f"Correct this, or set {CACHE_VARIABLE} to a folder of your own.",
        KernelCacheWarning,
        stacklevel=3,
    )
    temporary = tempfile.mkdtemp(prefix="beltdyn-")
    atexit.register(shutil.rmtree, temporary, ignore_errors=True)
    os.environ[CACHE_VARIABLE] = temporary  # for the processes that this one starts
    folder = Path(temporary, name)
    folder.mkdir()
    return folder


def _prepare(chosen: Path, name: str) -> str:
    """Make a folder within the chosen one, for this user alone; what speaks against it, if anything does."""
    if not chosen.is_dir():
        chosen.parent.mkdir(parents=True, exist_ok=True)
        chosen.mkdir(mode=0o700, exist_ok=True)
    folder = chosen / name
    if not folder.exists() and (_SHIPPED / name).is_dir():
        _copy(_SHIPPED / name, folder)
    folder.mkdir(mode=0o700, exist_ok=True)
    if hasattr(os, "getuid"):
        trusted = (os.getuid(), 0)
        for path in (chosen, folder, *(Path(entry) for entry in os.scandir(folder) if entry.is_dir())):
            status = path.stat()
            if status.st_uid not in (trusted if path == chosen else trusted[:1]):
                return f"{path} belongs to another user"
            shared = path == chosen and status.st_mode & stat.S_ISVTX  # as /tmp: only owners move what is theirs
            if status.st_mode & _WRITABLE_BY_OTHERS and not shared:
                return f"other users can write to {path}"
    with tempfile.TemporaryFile(dir=folder):
        return ""


def _copy(source: Path, folder: Path) -> None:
    """Copy a folder, whole or not at all; another process may do the same."""
    with tempfile.TemporaryDirectory(dir=folder.parent) as temporary, suppress(OSError):
        shutil.copytree(source, copied := Path(temporary, folder.name), copy_function=shutil.copyfile)
        copied.chmod(0o700)
        copied.rename(folder)


def holds_kernels(folder: Path) -> bool:
    """Whether a folder has any compiled kernel."""
    return any(path.suffix in (ENTRY, *NUMBA_FILES) for path in folder.rglob("*"))


def source_hash(package: Path) -> str:
    """Hash of all sources below a folder that take part in compiled code, that is, that name this package."""
    digest = hashlib.sha256()
    for path in sorted(package.rglob("*.py")):
        source = path.read_bytes()
        if b"beltdyn.kernel" in source:
            digest.update(path.relative_to(package).as_posix().encode())
            digest.update(source)
    return digest.hexdigest()[:16]
