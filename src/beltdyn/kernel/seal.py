"""Checksums around compiled kernels on disk, so that damaged ones are compiled again and never run.

A power cut leaves files short or empty, and a disk may flip bits.  What a file holds reaches the unpickler and the
processor only if it is, to the bit, what was written.
"""

import hashlib
import secrets
import shutil
import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

import numba

from beltdyn.kernel.cache import NUMBA_FILES, KernelCacheWarning

# Temporary settings of Numba


@contextmanager
def setting(name: str, value: Any) -> Iterator[None]:
    """Change a setting of Numba temporarily; other packages keep theirs."""
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
