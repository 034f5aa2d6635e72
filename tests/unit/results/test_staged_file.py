"""A staged file is read and written as a file in memory is, and changes on the disk as a whole or not at all."""

import io
import os
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from beltdyn.results import staged_file
from beltdyn.results.staged_file import PAGE, RESERVE, DamageError, StagedFile, find_checksums, identity, verify

BLOCK = 16384
CONTENTS = bytes(range(256)) * 200
"""Three blocks and a part."""
PLACES = st.integers(0, len(CONTENTS) + BLOCK)
ACTIONS = st.lists(
    st.one_of(
        st.tuples(st.just("write"), PLACES, st.binary(min_size=1, max_size=64).map(lambda data: data * 400)),
        st.tuples(st.just("read"), PLACES, st.integers(0, 3 * BLOCK)),
    ),
    max_size=6,
)


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("staged") / "file"


def contents(path: Path) -> bytes:
    """What a file holds before its checksums, which must be right."""
    assert verify(path)
    with path.open("rb") as file:
        found = find_checksums(file)
    assert found is not None
    assert path.stat().st_size == found.place + found.size
    return path.read_bytes()[: found.end]


@given(actions=ACTIONS)
def test_it_behaves_as_a_file_in_memory(path: Path, actions: list[tuple[str, int, Any]]) -> None:
    path.write_bytes(CONTENTS)
    memory = io.BytesIO(CONTENTS)
    with StagedFile(path) as staged:
        for action, place, what in actions:
            for one in (staged, memory):
                one.seek(place)
            if action == "write":
                assert staged.write(memoryview(what)) == memory.write(what)
            else:
                assert staged.read(what) == memory.read(what)
            assert staged.tell() == memory.tell()
        assert staged.seek(0, io.SEEK_END) == memory.seek(0, io.SEEK_END)
        assert path.read_bytes() == CONTENTS
        staged.commit(reserve=0)
    assert contents(path) == memory.getvalue()


def test_what_was_not_committed_is_dropped(path: Path) -> None:
    path.write_bytes(CONTENTS)
    with StagedFile(path) as staged:
        staged.write(memoryview(b"other"))
    assert path.read_bytes() == CONTENTS


def test_a_file_grows_by_many_commits(tmp_path: Path) -> None:
    """Whatever changes, checksums are right, and take little space: those of earlier commits are overwritten."""
    path, random = tmp_path / "file", Random(7)
    path.touch()
    held = bytearray()
    for _ in range(60):
        with StagedFile(path) as staged:
            for _ in range(random.randrange(6)):
                place, data = random.randrange(len(held) + 1), random.randbytes(random.choice((10, 5000, 30000)))
                staged.seek(place)
                staged.write(memoryview(data))
                held[place : place + len(data)] = data
            staged.commit()
        assert contents(path) == held
        assert path.stat().st_size < len(held) + 3 * RESERVE
    with StagedFile(path) as staged:
        staged.commit(reserve=0)
    assert contents(path) == held
    assert path.stat().st_size < len(held) * 1.003 + 100


def test_a_writer_that_is_killed_leaves_old_or_new_pages(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """After any of its writes, and of the last one any number of pages."""
    path, writing, left = tmp_path / "file", staged_file._write_all, 0

    def killed(file: io.FileIO, pieces: list[tuple[int, bytes]]) -> None:
        nonlocal left
        for place, data in pieces:
            for first in range(0, len(data), PAGE - place % PAGE):
                if not left:
                    raise SystemExit
                left -= 1
                writing(file, [(place + first, data[first : first + PAGE - place % PAGE])])

    before, after = bytes(CONTENTS), bytes(reversed(CONTENTS))
    for reserve in (RESERVE, 0):
        for count in range(100):
            path.write_bytes(before)
            with StagedFile(path) as staged:
                staged.commit()
            monkeypatch.setattr(staged_file, "_write_all", killed)
            left = count
            with StagedFile(path) as staged, suppress(SystemExit):
                staged.write(memoryview(after))
                staged.commit(reserve)
            monkeypatch.setattr(staged_file, "_write_all", writing)
            assert verify(path)
            if left:
                break
        assert 3 < count < 99
        assert path.read_bytes()[: len(after)] == after


def test_damage_below_a_change_is_not_sealed(tmp_path: Path) -> None:
    """What is added to a page that the disk gives otherwise than it was written is refused."""
    path = tmp_path / "file"
    path.write_bytes(CONTENTS)
    with StagedFile(path) as staged:
        staged.commit()
    data = bytearray(path.read_bytes())
    data[100] ^= 1
    path.write_bytes(data)
    with StagedFile(path) as staged, pytest.raises(OSError, match=r"bytes 0 to 4,096 differ from what was written"):
        staged.write(memoryview(b"new"))
    with pytest.raises(DamageError, match=r"the page of bytes 0 to 4,096"):
        verify(path)


def test_a_growing_file_holds_a_reserve_behind_its_contents(path: Path) -> None:
    path.write_bytes(CONTENTS)
    with StagedFile(path) as staged:
        staged.seek(0, io.SEEK_END)
        staged.write(memoryview(b"more"))
        staged.commit()
    assert contents(path) == CONTENTS + b"more"
    assert path.stat().st_size > len(CONTENTS) + RESERVE


def test_an_end_that_is_nearer_cuts_the_file(path: Path) -> None:
    path.write_bytes(CONTENTS)
    with StagedFile(path) as staged:
        staged.truncate(1000)
        staged.commit(reserve=0)
    assert contents(path) == CONTENTS[:1000]


@pytest.mark.parametrize("refused", [0, 1])
def test_a_disk_that_refuses_leaves_the_old_contents(path: Path, monkeypatch: pytest.MonkeyPatch, refused: int) -> None:
    """Whether it refuses what is new behind the end, or what changes before it."""
    path.write_bytes(CONTENTS)
    writing, calls = staged_file._write_all, []

    def refuse(file: io.FileIO, pieces: list[tuple[int, bytes]]) -> None:
        calls.append(len(pieces))
        writing(file, pieces[:1])  # a part of them, as a full disk does
        if len(calls) == refused + 1:
            raise OSError("no space left")
        writing(file, pieces[1:])

    monkeypatch.setattr(staged_file, "_write_all", refuse)
    with StagedFile(path) as staged:
        for place in (10, 2 * BLOCK, len(CONTENTS) + 5):
            staged.seek(place)
            staged.write(memoryview(b"changed"))
        with pytest.raises(OSError, match="no space left"):
            staged.commit()
    assert path.read_bytes() == CONTENTS


@pytest.mark.skipif(os.name == "nt", reason="an open file cannot be replaced there")
def test_another_file_of_the_same_name_is_another_file(path: Path) -> None:
    path.write_bytes(CONTENTS)
    with StagedFile(path) as staged:
        assert staged.identity() == identity(path.stat())
        other = path.with_name("other")
        other.write_bytes(CONTENTS)
        other.replace(path)
        assert staged.identity() != identity(path.stat())
