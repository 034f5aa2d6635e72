"""Fingerprints of functions outside the package, which its source hash does not cover.

Kernels of the package that call the law of a user are kept on disk under the fingerprint of that law.

Checksums around compiled kernels on disk, so that damaged ones are compiled again and never run.

A power cut leaves files short or empty, and a disk may flip bits.  What a file holds reaches the unpickler and the
processor only if it is, to the bit, what was written.

The cache folder of compiled kernels, keyed by their sources.

Numba's own cache watches the file of the compiled function only.  A kernel that calls a law from another file would
keep the old physics after that law was edited.  Here the cache lives in a folder named by a hash of every source
file that takes part in compiled code, so that an edit anywhere in them starts an empty cache.

What lies there is run as machine code.  So nobody else may write there, nor to a folder on the way there, and every
file has a checksum around it.
"""

import atexit
import dis
import errno
import hashlib
import os
import secrets
import shutil
import stat
import tempfile
import warnings
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib.metadata import version
from pathlib import Path
from types import CodeType, FunctionType, ModuleType
from typing import Any

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
        own = (folder, *(Path(entry) for entry in os.scandir(folder) if entry.is_dir()))
        fault = _fault_of_way(folder) or next(filter(None, (_fault(path, (os.getuid(),)) for path in own)), "")
        if fault:
            return fault
    with tempfile.TemporaryFile(dir=folder):
        return ""


def fault_of_file(path: Path) -> str:
    """Why others can read or change a file of this user; empty if they cannot, or the system tells no owners."""
    if not hasattr(os, "getuid"):
        return ""
    others = "" if not path.stat().st_mode & (stat.S_IRWXG | stat.S_IRWXO) else f"other users can read {path}"
    return _fault_of_way(path) or _fault(path, (os.getuid(),)) or others


def _fault_of_way(path: Path) -> str:
    """Why others can lead a path elsewhere."""
    trusted = (os.getuid(), 0)
    return next(filter(None, (_fault(step, trusted, shared=True) for step in _way_to(path))), "")


_MOST_LINKS = 40
"""Links on the way to a folder, as Linux follows them."""


def _way_to(path: Path) -> Iterator[Path]:
    """Every folder and link on the way to a path, from the root on: who can change one of them leads it elsewhere."""
    place, names, links = Path(path.anchor), list(reversed(path.absolute().parts)), 0
    while names:
        step = place / names.pop()
        if step.name == "..":
            place = place.parent
        elif step.is_symlink():
            yield step
            links += 1
            if links > _MOST_LINKS:
                raise OSError(errno.ELOOP, os.strerror(errno.ELOOP))
            names += reversed(step.readlink().parts)
        else:
            yield step
            place = step


def _fault(path: Path, owners: tuple[int, ...], *, shared: bool = False) -> str:
    """Why others can change what a folder or a link is or holds; empty if they cannot.

    In a `shared` folder, such as that of temporary files, everybody can make files, but only their owners move them.
    """
    status = path.lstat() if shared else path.stat()
    if status.st_uid not in owners:
        return f"{path} belongs to another user"
    if stat.S_ISLNK(status.st_mode) or (shared and status.st_mode & stat.S_ISVTX):
        return ""
    by_group = status.st_mode & stat.S_IWGRP and not _is_of_one(status.st_gid)
    return f"other users can write to {path}" if by_group or status.st_mode & stat.S_IWOTH else ""


@cache
def _is_of_one(group: int) -> bool:
    """Whether a group is that of this user alone, named alike: Linux lets such groups write by default."""
    import grp  # POSIX alone has them
    import pwd

    try:
        entry, user = grp.getgrgid(group), pwd.getpwuid(os.getuid()).pw_name
    except KeyError:
        return False
    return entry.gr_name == user and set(entry.gr_mem) <= {user}


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


_SIZE = 12
"""Hexadecimal digits of a fingerprint."""


def is_own(function: Any) -> bool:
    """Whether the code of a function lies outside the package."""
    return not Path(function.__code__.co_filename).is_relative_to(PACKAGE)


def fingerprint(functions: Iterable[Any]) -> str:
    """Fingerprint of functions with all that they refer to: code, constants, other functions, modules."""
    digest, seen = hashlib.sha256(), set[int]()
    for function in functions:
        _add(digest, function, seen)
    return digest.hexdigest()[:_SIZE]


def _add(digest: Any, value: Any, seen: set[int]) -> None:
    """Add a value to a digest; functions and classes of the package by name, for its sources are hashed as a whole."""
    function = getattr(value, "py_func", value)
    if isinstance(function, FunctionType):
        if id(function) not in seen:
            seen.add(id(function))
            _add_function(digest, function, seen)
    elif isinstance(value, ModuleType):
        digest.update(f"module {value.__name__} {_content(getattr(value, '__file__', None))}".encode())
    elif isinstance(value, type):
        digest.update(f"class {value.__qualname__} {getattr(value, '_fields', '')}".encode())
    elif isinstance(value, tuple | list):
        digest.update(f"{type(value).__name__} {len(value)}".encode())
        for one in value:
            _add(digest, one, seen)
    elif hasattr(value, "kernel_for"):  # the types of arguments say which kernel it calls
        digest.update(value.__name__.encode())
    elif hasattr(value, "tobytes"):
        digest.update(repr((value.dtype, value.shape)).encode() + value.tobytes())
    else:
        digest.update(repr(value).encode())


def _add_function(digest: Any, function: FunctionType, seen: set[int]) -> None:
    digest.update(function.__qualname__.encode())
    if not is_own(function):
        return
    _add_code(digest, function.__code__)
    for cell in function.__closure__ or ():
        _add(digest, cell.cell_contents, seen)
    _add(digest, function.__defaults__ or (), seen)
    for name in sorted(names_in(function.__code__)):
        if name in function.__globals__:
            digest.update(name.encode())
            _add(digest, function.__globals__[name], seen)


def _add_code(digest: Any, code: CodeType) -> None:
    """Add what code does: constants where they are used, so that documentation and `python -OO` make no difference."""
    digest.update(repr((code.co_names, code.co_varnames)).encode())
    for step in dis.get_instructions(code):
        if step.opname == "NOP":  # in the place of documentation that was left out
            continue
        digest.update(step.opname.encode())
        value = step.argval if step.opcode in dis.hasconst else step.arg
        if isinstance(value, CodeType):
            _add_code(digest, value)
        else:
            digest.update(repr(value).encode())


def names_in(code: CodeType) -> set[str]:
    """Names that code looks up, that of inner functions included."""
    inner = (constant for constant in code.co_consts if isinstance(constant, CodeType))
    return set(code.co_names).union(*map(names_in, inner))


@cache
def _content(file: str | None) -> str:
    """Hash of the source of a module; empty without one."""
    try:
        return hashlib.sha256(Path(file or "").read_bytes()).hexdigest()
    except OSError:
        return ""


# Classes of the parameters of users' laws: types of Numba know them by their names alone

_MARKS: dict[type, str] = {}
_NAMED: dict[str, type] = {}


def declare(record: type, mark: str) -> None:
    """Keep kernels that take records of a class under a mark."""
    _MARKS[record], _NAMED[mark] = mark, record


def own_classes() -> bool:
    """Whether there are such classes."""
    return bool(_MARKS)


def mark_of(value: Any) -> str | None:
    """The mark of a class; None of all others."""
    return _MARKS.get(value) if isinstance(value, type) else None


def marked(mark: str) -> type:
    """The class of a mark."""
    return _NAMED[mark]


def marks_in(types: Iterable[Any]) -> set[str]:
    """Marks of the classes in types of Numba."""
    found = set[str]()
    for one in types:
        mark = _MARKS.get(getattr(one, "instance_class", None))  # type: ignore[arg-type]
        found |= {mark} if mark else set()
        inner = getattr(one, "types", None) or ([one.dtype] if hasattr(one, "instance_class") else [])
        found |= marks_in(inner)
    return found


# Temporary settings of Numba


@contextmanager
def setting(name: str, value: Any) -> Iterator[None]:
    """Change a setting of Numba temporarily; other packages keep theirs."""
    import numba  # takes long to import, and a drive can be checked without it

    before = getattr(numba.config, name)
    setattr(numba.config, name, value)
    try:
        yield
    finally:
        setattr(numba.config, name, before)


_HEADER = b"beltdyn kernel 1\n"
_SEAL = ".sha256"
_DIGEST_SIZE = hashlib.sha256().digest_size


def read_sealed(path: Path) -> bytes | None:
    """Content of a file by `write_sealed`, or None without one.

    One that is damaged, or cannot be read, counts as none, with a warning.
    """
    content = b""
    with suppress(OSError):
        if path.is_file():
            content = path.read_bytes()
        elif not path.exists():
            return None
    start = len(_HEADER) + _DIGEST_SIZE
    if content[:start] == _HEADER + hashlib.sha256(content[start:]).digest():
        return content[start:]
    warn_of_damage(path.parent)
    return None


def write_sealed(path: Path, content: bytes) -> None:
    """Write a file with the checksum of its content, whole or not at all; if that fails, a warning says why."""
    try:
        _write_whole(path, _HEADER + hashlib.sha256(content).digest() + content)
    except OSError as error:
        _warn_of_loss(path.parent, error.strerror or str(error))


class SealedFolder:
    """A folder of Numba's own cache, with a checksum file beside each file.

    Numba reads a file whenever it likes.  So all are looked through before it reads the first, and what it adds is
    sealed after each compilation.  A file that nobody has sealed was written by a process that did not end in order.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self._sealed: dict[Path, tuple[int, int]] = {}
        damaged = False
        for entry in folder.iterdir():
            if entry.is_dir() and not entry.is_symlink():
                entry.chmod(0o700)
            else:
                _remove(entry)  # Numba would keep kernels elsewhere, where a folder cannot be made
        for path in self._files():
            expected = _written_seal(path)
            if expected == _seal(path):
                self._sealed[path] = _stamp(path)
            else:
                damaged |= expected is not None
                _remove(path)
        if damaged:
            warn_of_damage(folder)

    def seal(self) -> None:
        """Seal files written since."""
        for path in self._files():
            with suppress(OSError):  # another process may replace it meanwhile
                stamp = _stamp(path)
                if self._sealed.get(path) != stamp:
                    _write_whole(path.with_name(path.name + _SEAL), _seal(path).encode())
                    self._sealed[path] = stamp

    def _files(self) -> list[Path]:
        return [path for path in self.folder.rglob("*") if path.suffix in NUMBA_FILES]


def _write_whole(path: Path, content: bytes) -> None:
    temporary = path.with_name(f"{secrets.token_hex(8)}.tmp")
    try:
        temporary.write_bytes(content)
        if path.is_dir():
            _remove(path)
        temporary.replace(path)
    finally:
        with suppress(OSError):
            temporary.unlink(missing_ok=True)


def _seal(path: Path) -> str:
    """Checksum of a file, which for anything but a file is empty."""
    with suppress(OSError):
        return hashlib.sha256(path.read_bytes()).hexdigest() if path.is_file() else ""
    return ""


def _written_seal(path: Path) -> str | None:
    seal = path.with_name(path.name + _SEAL)
    with suppress(OSError, UnicodeDecodeError):
        return seal.read_text(encoding="ascii") if seal.is_file() else None
    return None


def _stamp(path: Path) -> tuple[int, int]:
    status = path.stat()
    return status.st_mtime_ns, status.st_size


def _remove(path: Path) -> None:
    """Remove a file, or whatever has its name."""
    with suppress(OSError):
        shutil.rmtree(path) if path.is_dir() and not path.is_symlink() else path.unlink()


@cache
def warn_of_damage(folder: Path) -> None:
    """Warn once that kernels in a folder are compiled again."""
    warnings.warn(f"Compiled kernels in {folder} are damaged and are compiled again.", KernelCacheWarning, stacklevel=3)


@cache
def _warn_of_loss(folder: Path, reason: str) -> None:
    warnings.warn(
        f"Compiled kernels cannot be kept in {folder}: {reason}. The next start compiles them again.",
        KernelCacheWarning,
        stacklevel=4,
    )
