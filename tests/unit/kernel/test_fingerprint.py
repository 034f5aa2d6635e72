"""Damaged files of compiled kernels are compiled again: no start fails, and no byte of them is used."""

import os
import pickle
import random
import warnings
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

from beltdyn.kernel import (
    CACHE_VARIABLE,
    PLAIN_VARIABLE,
    KernelCacheWarning,
    compiler,
    compiles_quickly,
    fingerprint,
    kernel,
    kernel_cache,
)
from beltdyn.kernel.fingerprint import ENTRY, NUMBA_FILES, SealedFolder, read_sealed, write_sealed

_KEPT = (kernel_cache, compiles_quickly, compiler._sealed_folder, compiler._say_once)
_SAID = (fingerprint.warn_of_damage, fingerprint._warn_of_loss)


def tripled(x: float) -> float:
    return 3.0 * x


def empty(path: Path) -> None:
    path.write_bytes(b"")


def cut(path: Path) -> None:
    path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])


def scramble(path: Path) -> None:
    path.write_bytes(random.Random(1).randbytes(path.stat().st_size))


def flip(path: Path) -> None:
    content = bytearray(path.read_bytes())
    content[-len(content) // 3] ^= 4
    path.write_bytes(content)


def swap_for_folder(path: Path) -> None:
    path.unlink()
    path.mkdir()
    (path / "within").touch()


def swap_for_pipe(path: Path) -> None:
    path.unlink()
    os.mkfifo(path)


def swap_for_pickle(path: Path) -> None:
    """Code that an unpickler would run."""
    path.write_bytes(pickle.dumps(_Hostile()))


class _Hostile:
    def __reduce__(self) -> tuple[Any, ...]:
        return exec, ("raise SystemExit('unpickled')",)


DAMAGES = [empty, cut, scramble, flip, swap_for_folder, swap_for_pickle]
DAMAGES += [swap_for_pipe] if hasattr(os, "mkfifo") else []


def forget() -> None:
    for function in (*_KEPT, *_SAID):
        function.cache_clear()


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    monkeypatch.setenv(CACHE_VARIABLE, str(tmp_path))
    forget()
    yield tmp_path
    forget()


def start() -> bool:
    """Call a kernel as a process does that has just started; whether it came from the disk."""
    forget()
    fresh = kernel(tripled)
    assert fresh(2.0) == 6.0
    return sum(fresh.dispatcher.stats.cache_hits.values()) == 1  # type: ignore[attr-defined]


@pytest.mark.parametrize("damage", DAMAGES)
def test_every_start_succeeds(folder: Path, damage: Callable[[Path], None]) -> None:
    assert [start(), start()] == [False, True]
    (entry,) = folder.rglob(f"*{ENTRY}")
    damage(entry)
    with pytest.warns(KernelCacheWarning, match=f"kernels in {folder}.* are damaged") as said:
        assert start() is False
    assert len(said) == 1
    assert start() is True


@pytest.mark.filterwarnings("ignore::beltdyn.kernel.compiler.PlainCompilationWarning")
@pytest.mark.parametrize("damage", DAMAGES)
def test_every_start_succeeds_with_plain_compilation(
    folder: Path, damage: Callable[[Path], None], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of Numba's own cache both files are looked at; without their checksums they count as half written."""
    monkeypatch.setenv(PLAIN_VARIABLE, "1")
    assert [start(), start()] == [False, True]
    files = sorted(path for path in folder.rglob("*") if path.is_file())
    assert len(files) == 4
    for path in files:
        damage(path)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            assert start() is False
        if path.suffix in NUMBA_FILES:
            assert [f"kernels in {kernel_cache()} are damaged" in str(warning.message) for warning in said] == [True]
        assert start() is True


def test_an_entry_of_other_libraries_is_compiled_again(folder: Path) -> None:
    """Its checksum is right, and still it cannot be loaded."""
    start()
    (entry,) = folder.rglob(f"*{ENTRY}")
    key, _ = pickle.loads(read_sealed(entry) or b"")
    write_sealed(entry, pickle.dumps((key, ("what older versions kept",))))
    with pytest.warns(KernelCacheWarning, match="are damaged"):
        assert start() is False
    assert start() is True


def test_an_entry_for_other_types_under_its_name_is_not_used(folder: Path) -> None:
    start()
    (entry,) = folder.rglob(f"*{ENTRY}")
    key, stored = pickle.loads(read_sealed(entry) or b"")
    write_sealed(entry, pickle.dumps((("other", *key[1:]), stored)))
    assert start() is False


def test_left_over_locks_keep_nobody_waiting(folder: Path) -> None:
    start()
    (lock,) = folder.rglob("*.lock")
    for damage in (scramble, swap_for_folder):
        damage(lock)
        assert start() is True


def test_no_changed_bit_is_read(tmp_path: Path) -> None:
    path = tmp_path / "entry"
    write_sealed(path, b"machine code")
    assert read_sealed(path) == b"machine code"
    whole = path.read_bytes()
    damaged = [whole[:count] for count in range(len(whole))]
    for position in range(8 * len(whole)):
        flipped = bytearray(whole)
        flipped[position // 8] ^= 1 << position % 8
        damaged.append(bytes(flipped))
    fingerprint.warn_of_damage.cache_clear()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        for content in damaged:
            path.write_bytes(content)
            assert read_sealed(path) is None
    assert len(said) == 1


def test_what_cannot_be_kept_is_said_once(tmp_path: Path) -> None:
    fingerprint._warn_of_loss.cache_clear()
    with pytest.warns(KernelCacheWarning, match="cannot be kept in .*gone: No such file"):
        write_sealed(tmp_path / "gone" / "first", b"machine code")
    write_sealed(tmp_path / "gone" / "second", b"machine code")


def test_files_that_nobody_sealed_are_removed(tmp_path: Path) -> None:
    """A process that was killed may have left them half done."""
    law = tmp_path / "law"
    law.mkdir()
    for ending in NUMBA_FILES:
        (law / f"left{ending}").write_bytes(b"half")
    folder = SealedFolder(tmp_path)
    assert not list(law.iterdir())
    (law / "new.nbc").write_bytes(b"whole")
    folder.seal()
    SealedFolder(tmp_path)
    assert (law / "new.nbc").read_bytes() == b"whole"


_LAW = '''
def law(x):
    """Twice a number."""
    def inner(y):
        """As it is."""
        return 2.0 * y
    return inner(x)
'''


def test_fingerprints_do_not_depend_on_how_python_compiles(tmp_path: Path) -> None:
    """Neither of users' laws, nor of kernels of the package: `python -O` and `-OO` compile nothing anew."""
    from beltdyn.kernel.quick import _fingerprint

    file = tmp_path / "law.py"
    file.write_text(_LAW.replace("return inner", "assert x == x\n    return inner"), encoding="utf-8")
    seen, of_package = set[str](), set[tuple[Any, ...]]()
    for level in (0, 1, 2):
        names: dict[str, Any] = {}
        exec(compile(_LAW, str(file), "exec", optimize=level), names)
        seen.add(fingerprint.fingerprint([names["law"]]))
        exec(compile(file.read_text(encoding="utf-8"), str(file), "exec", optimize=level), names)
        of_package.add(_fingerprint(names["law"]))
    assert (len(seen), len(of_package)) == (1, 1)
    exec(compile(_LAW.replace("2.0", "3.0"), str(file), "exec"), names)
    assert fingerprint.fingerprint([names["law"]]) not in seen
