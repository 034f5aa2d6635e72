"""Checksums behind a file: the last set that is whole counts, and files without any are told apart."""

import io
import os
import time
from pathlib import Path

import numpy as np
import pytest

from beltdyn.results.staged_file import PAGE, Checksums, DamageError, StagedFile, find_checksums, page_count, verify

CONTENT = np.random.default_rng(3).bytes(5 * PAGE + 77)


@pytest.fixture
def path(tmp_path: Path) -> Path:
    """A file with checksums."""
    path = tmp_path / "file"
    path.write_bytes(CONTENT)
    with StagedFile(path) as staged:
        staged.commit(reserve=0, owner="/folder/.file.lock")
    return path


def a_set(number: int, place: int) -> Checksums:
    return Checksums(number, place, 100, np.array([7], np.uint32), {0: 9}, "owner")


def found_in(data: bytes) -> Checksums | None:
    return find_checksums(io.BytesIO(data))


def test_a_set_is_found_again() -> None:
    one = a_set(4, 120)
    found = found_in(bytes(120) + one.to_bytes() + b"behind")
    assert found is not None
    assert found._replace(pages=0) == one._replace(pages=0)  # type: ignore[arg-type]
    assert found.pages.tolist() == [7]
    assert len(one.to_bytes()) == one.size


def test_the_higher_number_counts_wherever_it_stands() -> None:
    first, second = a_set(4, 400).to_bytes(), a_set(5, 150).to_bytes()
    both = bytes(150) + second + bytes(400 - 150 - len(second)) + first
    found = found_in(both)
    assert found is not None
    assert found.number == 5
    for place in range(150, 150 + len(second)):
        torn = bytearray(both)
        torn[place] ^= 1
        older = found_in(bytes(torn))
        assert older is not None
        assert older.number == 4


def test_a_set_in_another_place_is_none() -> None:
    assert found_in(bytes(121) + a_set(4, 120).to_bytes()) is None
    assert found_in(bytes(120) + a_set(4, 120).to_bytes()[:-1]) is None
    assert found_in(b"") is None


def test_files_are_verified(path: Path) -> None:
    assert verify(path)
    assert path.stat().st_size < len(CONTENT) + 200
    other = path.with_name("other")
    other.write_bytes(CONTENT)
    assert not verify(other)


@pytest.mark.parametrize("place", [0, PAGE - 1, PAGE, len(CONTENT) - 1])
def test_damage_is_told_by_its_place(path: Path, place: int) -> None:
    data = bytearray(path.read_bytes())
    data[place] ^= 128
    path.write_bytes(data)
    first = place // PAGE * PAGE
    with pytest.raises(DamageError, match=f"{first:,} to {min(first + PAGE, len(CONTENT)):,} differ from"):
        verify(path)


def test_pages() -> None:
    assert [page_count(end) for end in (0, 1, PAGE, PAGE + 1)] == [0, 1, 1, 2]


@pytest.mark.parametrize("jump", [-1e5, 0.0, 1e5])
def test_files_are_verified_whatever_the_clock_says(path: Path, tmp_path: Path, jump: float) -> None:
    """Times of files may lie in the past or in the future, with a clock that was set, or of another computer."""
    bare, damaged = tmp_path / "bare", tmp_path / "damaged"
    bare.write_bytes(bytes(3 * PAGE))
    damaged.write_bytes(bytes([path.read_bytes()[0] ^ 1]) + path.read_bytes()[1:])
    for file in (path, bare, damaged):
        os.utime(file, (time.time() + jump,) * 2)
    assert (verify(path), verify(bare)) == (True, False)
    with pytest.raises(DamageError):
        verify(damaged)
